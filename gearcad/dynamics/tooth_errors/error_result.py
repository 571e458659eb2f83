"""Result of an error study: the distribution of K_v over speed for random tooth errors, and its confidence."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Bools, Floats, JsonObject, Notice, freeze
from gearcad.dynamics.trains.tooth_deviations import ErrorDistribution

BAND = (0.05, 0.95)
"""The quantiles that are drawn."""

_SURE = 0.9
"""Probability with which a quantile lies between its ranks."""


class ToothLaw(Enum):
    """Law of load sharing between pairs of teeth."""

    SMOOTH = "smooth"
    """Teeth as one spring, whose error changes gradually from one pair to the next: the law of the other charts."""

    SINGLE = "single teeth"
    """Each pair as its own spring, which begins to carry where the deflected teeth meet: early or late."""


class Ranks(NamedTuple):
    """Ranks of the rising values of a sample between which a quantile lies, counted from 1; None where no value bounds it."""

    low: int | None
    high: int | None


def quantile_ranks(count: int, quantile: float) -> Ranks:
    """Return the ranks between which a quantile of `count` independent values lies with a probability of 90 %.

    The quantile is equally probable below and above them. The ranks follow from the binomial distribution.
    """
    from scipy.stats import binom

    side = (1 - _SURE) / 2
    # The value of rank r is below the quantile if at least r values are: their number is binomial.
    low = int(binom.ppf(side, count, quantile))
    high = int(binom.ppf(1 - side, count, quantile)) + 1
    return Ranks(low if low >= 1 else None, high if high <= count else None)


class GreatestWithErrors(NamedTuple):
    """Greatest K_v of a mesh over speed: of the `median`, the upper quantile and all samples, each with its speed (rpm)."""

    mesh: str
    median: float
    median_speed: float
    upper: float
    upper_speed: float
    most: float
    most_speed: float


@dataclass(frozen=True, kw_only=True, eq=False)
class ErrorStudy:
    """K_v `factors` (n, s, m) of n samples of teeth at `speeds` (s,) in rpm of the first pinion, running up.

    `nominal` (s, m) is K_v of teeth without errors by the same law. `settled` (n, s): whether the greatest force repeated in
    the next period. At every speed `teeth` teeth of the first mesh are evaluated; `whole`: whether they are the whole period.
    """

    law: ToothLaw
    speeds: Floats
    factors: Floats
    nominal: Floats
    settled: Bools
    nominal_settled: Bools
    teeth: int
    whole: bool
    grade: int | None
    distribution: ErrorDistribution
    seed: int
    mesh_names: tuple[str, ...]
    assumed: tuple[Notice, ...]

    def __post_init__(self) -> None:
        freeze(self)

    def __repr__(self) -> str:
        return f"<ErrorStudy: {len(self.factors)} samples at {len(self.speeds)} speeds, {self.law.value}>"

    @property
    def samples(self) -> int:
        """Number of samples."""
        return len(self.factors)

    # ------------------------------------------------------------------ over all samples

    def quantile(self, quantile: float) -> Floats:
        """Return a quantile of K_v (s, m), by a straight line between neighbouring samples."""
        return np.asarray(np.quantile(self.factors, quantile, axis=0), float)

    @cached_property
    def median(self) -> Floats:
        """Median of K_v (s, m)."""
        return self.quantile(0.5)

    @cached_property
    def band(self) -> tuple[Floats, Floats]:
        """Quantiles of K_v that are drawn, lower and upper, (s, m) each."""
        lower, upper = (self.quantile(each) for each in BAND)
        return lower, upper

    @property
    def least(self) -> Floats:
        """Least K_v of all samples (s, m)."""
        return np.asarray(self.factors.min(axis=0), float)

    @property
    def most(self) -> Floats:
        """Greatest K_v of all samples (s, m)."""
        return np.asarray(self.factors.max(axis=0), float)

    @property
    def restless(self) -> Bools:
        """Speeds (s,) at which more than half of the samples did not settle: chaotic, of a longer period, or hardly damped."""
        return np.asarray((~self.settled).mean(axis=0) > 0.5, bool)

    @property
    def unsettled(self) -> float:
        """Share of all motions that did not settle."""
        return float((~self.settled).mean())

    @cached_property
    def greatest(self) -> tuple[GreatestWithErrors, ...]:
        """Greatest K_v over speed of each mesh."""
        found = []
        for mesh, name in enumerate(self.mesh_names):
            values: list[float] = []
            for curve in (self.median[:, mesh], self.band[1][:, mesh], self.most[:, mesh]):
                row = int(curve.argmax())
                values += [float(curve[row]), float(self.speeds[row])]
            found.append(GreatestWithErrors(name, *values))
        return tuple(found)

    @property
    def ranks(self) -> Ranks:
        """Ranks of the samples between which the upper quantile lies."""
        return quantile_ranks(self.samples, BAND[1])

    # ------------------------------------------------------------------ documents

    @property
    def _curves(self) -> dict[str, Floats]:
        """Curves of K_v over speed (s, m), by their names in documents."""
        lower, upper = self.band
        return {
            "median": self.median,
            "lower_quantile": lower,
            "upper_quantile": upper,
            "least": self.least,
            "most": self.most,
            "nominal": self.nominal,
        }

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before the study is used: what is assumed, and motions that are not settled or not complete."""
        return (*self.assumed, *self._of_motions())

    def _of_motions(self) -> Iterator[Notice]:
        if self.unsettled:
            text = (
                f"{100 * self.unsettled:.3g} % of the motions with tooth errors did not settle: the greatest force of a period"
                " was another than that of the period before (chaotic, of a longer period, or hardly damped)"
            )
            yield Notice("errors-unsettled", text)
        if not self.whole:
            text = (
                f"the errors of all teeth come again only after more than {self.teeth} teeth of the first mesh: so many were"
                " looked at, and whether they had settled is not known"
            )
            yield Notice("errors-not-whole", text)
        if 1 < self.samples and self.ranks.high is None:
            share = 100 * BAND[1]
            text = (
                f"{self.samples} samples give no upper bound of the {share:g} % quantile of K_v: it may lie above all of them"
            )
            yield Notice("few-samples", text)

    def to_dict(self) -> JsonObject:
        """Return the study as a dictionary for `dynamics.json`: curves over speed of each mesh."""
        return {
            "law": self.law.value,
            "samples": self.samples,
            "distribution": self.distribution.value,
            "accuracy_grade": self.grade,
            "seed": self.seed,
            "quantiles": list(BAND),
            "upper_quantile_ranks": list(self.ranks),
            "teeth": self.teeth,
            "whole_period": self.whole,
            "speed": self.speeds.tolist(),
            "kv": {
                name: {key: curve[:, mesh].tolist() for key, curve in self._curves.items()}
                for mesh, name in enumerate(self.mesh_names)
            },
            "settled": self.settled.mean(axis=0).tolist(),
            "greatest": [each._asdict() for each in self.greatest],
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def columns(self) -> dict[str, Floats]:
        """Return the columns of the CSV file by their headings: curves over speed, and after them every sample."""
        found = {"speed (rpm)": self.speeds}
        for mesh, name in enumerate(self.mesh_names):
            found |= {f"kv_{key}.{name}": curve[:, mesh] for key, curve in self._curves.items()}
        found["settled"] = self.settled.mean(axis=0)
        for mesh, name in enumerate(self.mesh_names):
            found |= {f"kv_sample_{number + 1}.{name}": each[:, mesh] for number, each in enumerate(self.factors)}
        return found

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by their names."""
        return {
            "errors_speed": self.speeds,
            "errors_kv": self.factors,
            "errors_kv_nominal": self.nominal,
            "errors_settled": self.settled.astype(float),
        }
