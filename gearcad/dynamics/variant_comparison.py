"""Comparison of variants of a train or pair: models or values, in one chart and one table."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats, JsonObject, Notice, Pictured, joined, texts
from gearcad.dynamics.result_tables import Tables, stacked
from gearcad.dynamics.time_domain.spectra import outstanding
from gearcad.dynamics.tooth_errors.error_result import ErrorStudy
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.trains.train import Train
from gearcad.dynamics.trains.train_modes import NaturalModes

_PROMINENCE = 0.005
"""Least fall of K_v on both sides of a maximum that counts."""

_REACH = 0.1
"""Relative difference in speed above which two resonances are not the same."""


_ALIKE = 0.25
"""Least square of the cosine between two mode shapes, by kinetic energy, from which they count as the same mode."""


class Peak(NamedTuple):
    """A maximum of K_v at a `speed` (rpm of the first pinion)."""

    speed: float
    factor: float


def envelope(study: TrainStudy) -> Floats:
    """Return the greater K_v (s, m) of running up and down, at the speeds of the charts."""
    return np.asarray(np.max([chart.factors for _, chart in study.charts.directions()], axis=0), float)


def peaks_of(study: TrainStudy, mesh: int, prominence: float = _PROMINENCE) -> list[Peak]:
    """Return maxima of K_v of a mesh, running up or down, by speed, that stand out from both sides by the `prominence`."""
    factors, speeds = envelope(study)[:, mesh], study.speeds
    return [Peak(float(speeds[row]), float(factors[row])) for row in outstanding(factors, prominence)]


def joined_peaks(listed: Sequence[Sequence[Peak]], first: int) -> list[tuple[Peak | None, ...]]:
    """Return the same maxima of several charts side by side; the chart `first` is matched before all others."""
    groups: list[list[Peak | None]] = []
    for chart in sorted(range(len(listed)), key=lambda each: each != first):
        pairs = sorted(
            (apart, row, column)
            for row, group in enumerate(groups)
            for column, peak in enumerate(listed[chart])
            if (apart := _apart(group, peak)) is not None
        )
        taken = set[int]()
        for _, row, column in pairs:
            if groups[row][chart] is None and column not in taken:
                groups[row][chart] = listed[chart][column]
                taken.add(column)
        for column, peak in enumerate(listed[chart]):
            if column not in taken:
                groups.append([peak if each == chart else None for each in range(len(listed))])
    return [tuple(group) for group in groups]


def _apart(group: Sequence[Peak | None], peak: Peak) -> float | None:
    """Return how far a maximum differs from the first of a group in speed and height; None if it is out of reach."""
    known = next(each for each in group if each is not None)
    off = abs(math.log(peak.speed / known.speed)) / math.log(1 + _REACH)
    return off + abs(math.log(peak.factor / known.factor)) if off <= 1 else None


def joined_modes(studies: Sequence[TrainStudy], first: int) -> list[tuple[int | None, ...]]:
    """Return elastic modes (from 0) of several trains side by side, those that move alike; others are matched to the train
    `first`.

    The order is that of frequency, by the frequency of the first train for modes that it has.
    """
    of = studies[first].modes
    groups: list[list[int | None]] = []
    for mode in range(of.rigid, len(of)):
        groups.append([mode if each == first else None for each in range(len(studies))])
    more: list[list[int | None]] = []
    for place, study in enumerate(studies):
        if place == first:
            continue
        matched = _matched(studies[first], study)
        for row, mode in matched.items():
            groups[row - of.rigid][place] = mode
        for mode in range(study.modes.rigid, len(study.modes)):
            if mode not in matched.values():
                more.append([mode if each == place else None for each in range(len(studies))])
    every = [*groups, *more]
    every.sort(key=lambda group: next(float(studies[at].modes.circular[mode]) for at, mode in _group_members(group, first)))
    return [tuple(group) for group in every]


def _group_members(group: Sequence[int | None], first: int) -> list[tuple[int, int]]:
    """Return which trains have the mode, and its number in each: the train `first` before others."""
    given = [(place, mode) for place, mode in enumerate(group) if mode is not None]
    return sorted(given, key=lambda each: each[0] != first)


def _matched(of: TrainStudy, other: TrainStudy) -> dict[int, int]:
    """Return the modes of a train with the modes of another one that move alike, one to one."""
    from scipy.optimize import linear_sum_assignment

    alike = _alikeness(of, other)
    alike[: of.modes.rigid] = alike[:, : other.modes.rigid] = 0.0
    rows, columns = linear_sum_assignment(-alike)
    return {int(row): int(column) for row, column in zip(rows, columns, strict=True) if alike[row, column] >= _ALIKE}


def _alikeness(of: TrainStudy, other: TrainStudy) -> Floats:
    """Return the squares (n, k) of the cosine between modes, by kinetic energy; what one train lacks stands still there."""
    products = [
        _product(a, b, of.train) for a, b in ((of.modes, other.modes), (of.modes, of.modes), (other.modes, other.modes))
    ]
    both, own, others = products
    whole = np.outer(np.diag(own), np.diag(others))
    return np.asarray(np.divide(both**2, whole, out=np.zeros_like(both), where=whole > 0), float)


def _product(one: NaturalModes, two: NaturalModes, train: Train) -> Floats:
    """Return the sums (n, k) of the products of inertia and both rotations over the parts that both trains have."""
    found = np.zeros((len(one), len(two)))
    for inertia in train.inertias:
        if inertia.name in one.inertias and inertia.name in two.inertias:
            turns = (each.shape[:, each.inertias.index(inertia.name)] for each in (one, two))
            found += inertia.inertia * np.outer(*turns)
    for shaft in train.shafts:
        if shaft.name in one.shafts and shaft.name in two.shafts:
            a, b = (each.shaft_shape[:, each.shafts.index(shaft.name)] for each in (one, two))
            found += shaft.inertia * np.trapezoid(a[:, None] * b, one.places, axis=2)
    return found


_MOST = 8
"""Resonances of a mesh that are held against each other: the highest."""


class GreatestOfMesh(NamedTuple):
    """The greatest K_v of a `mesh` in the study `label`, running up or down, and its `speed` (rpm)."""

    label: str
    mesh: str
    factor: float
    speed: float
    stable: bool


class GreatestOfShaft(NamedTuple):
    """The greatest overload of a `shaft` in the study `label`, running up or down, and its `speed` (rpm)."""

    label: str
    shaft: str
    factor: float
    speed: float


class SameResonance(NamedTuple):
    """A maximum of K_v of a `mesh` in each of the studies, None in those that have none near it."""

    mesh: str
    shown: tuple[Peak | None, ...]

    def moved(self, study: int, reference: int) -> float | None:
        """Return the relative difference of its speed in a study from that of the reference; None if either has no maximum."""
        own, other = self.shown[study], self.shown[reference]
        return None if own is None or other is None else own.speed / other.speed - 1


@dataclass(frozen=True, kw_only=True, eq=False)
class SideBySide(Pictured):
    """Studies of a train `name` that differ in `what`, in words; `labels` say how, one for each.

    Where labels are values of one key of the spec, that is the `key`: else it is "".

    Raises ParameterError unless there are as many labels as studies, all different, and the same meshes in all.
    """

    name: str
    what: str
    labels: tuple[str, ...]
    studies: tuple[TrainStudy, ...]
    key: str = ""

    def __post_init__(self) -> None:
        if len(self.labels) != len(self.studies) or len(set(self.labels)) != len(self.labels) or not self.labels:
            raise ParameterError("labels", self.labels, f"must be one for each of {len(self.studies)} studies, all different")
        if len({study.up.mesh_names for study in self.studies}) > 1:
            raise ParameterError("studies", self.labels, "must have the same meshes, to be compared")

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.name!r}: {self.what} {', '.join(self.labels)}>"

    def title(self, label: str) -> str:
        """Return the title of a label for charts and headings."""
        return f"{self.key} = {label}" if self.key else label

    @property
    def titles(self) -> tuple[str, ...]:
        """Titles of all studies."""
        return tuple(map(self.title, self.labels))

    @property
    def reference(self) -> int:
        """Index of the study with which the others are compared: the first."""
        return 0

    @property
    def mesh_names(self) -> tuple[str, ...]:
        """Names of the meshes, the same in all studies."""
        return self.studies[0].up.mesh_names

    @property
    def shaft_names(self) -> tuple[str, ...]:
        """Shafts that have an overload in any of the studies."""
        return tuple(dict.fromkeys(name for study in self.studies for name in study.shaft_overloads))

    @property
    def errors(self) -> dict[str, ErrorStudy]:
        """K_v with errors of teeth, by the labels of the studies that have it."""
        each = zip(self.labels, self.studies, strict=True)
        return {label: study.errors for label, study in each if study.errors is not None}

    # ------------------------------------------------------------------ held against each other

    @cached_property
    def greatest(self) -> tuple[GreatestOfMesh, ...]:
        """Greatest K_v, mesh by mesh and study by study."""
        found = []
        for mesh, name in enumerate(self.mesh_names):
            for label, study in zip(self.labels, self.studies, strict=True):
                chart = max((each for _, each in study.charts.directions()), key=lambda each: each.factors[:, mesh].max())
                row = int(chart.factors[:, mesh].argmax())
                factor, speed = float(chart.factors[row, mesh]), float(study.speeds[row])
                found.append(GreatestOfMesh(label, name, factor, speed, bool(chart.stable[row])))
        return tuple(found)

    @cached_property
    def shaft_overloads(self) -> tuple[GreatestOfShaft, ...]:
        """Greatest overloads, shaft by shaft, of the studies that have the shaft's overload."""
        found = []
        for name in self.shaft_names:
            for label, study in zip(self.labels, self.studies, strict=True):
                if name not in study.shaft_overloads:
                    continue
                column = study.up.shaft_names.index(name)
                overload = np.max([chart.shaft_factors[:, column] for _, chart in study.charts.directions()], axis=0)
                row = int(overload.argmax())
                found.append(GreatestOfShaft(label, name, float(overload[row]), float(study.speeds[row])))
        return tuple(found)

    @cached_property
    def resonances(self) -> tuple[SameResonance, ...]:
        """Highest resonances of each mesh, in order of speed."""
        found = []
        for mesh, name in enumerate(self.mesh_names):
            groups = joined_peaks([peaks_of(study, mesh) for study in self.studies], self.reference)
            groups.sort(key=lambda group: -max(peak.factor for peak in group if peak is not None))
            kept = sorted(groups[:_MOST], key=lambda group: min(peak.speed for peak in group if peak is not None))
            found += [SameResonance(name, group) for group in kept]
        return tuple(found)

    @cached_property
    def natural_frequencies(self) -> tuple[tuple[float | None, ...], ...]:
        """Natural frequencies (1/s) of elastic modes that move alike, one of each study; None where a study has none."""
        return tuple(
            tuple(
                None if mode is None else float(study.modes.circular[mode])
                for study, mode in zip(self.studies, group, strict=True)
            )
            for group in joined_modes(self.studies, self.reference)
        )

    # ------------------------------------------------------------------ documents

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before using the results: those of all studies, then those of some studies with their labels."""
        every = [notice for notice in self.studies[0].notices if all(notice in study.notices for study in self.studies)]
        some = [
            notice.within(label)
            for label, study in zip(self.labels, self.studies, strict=True)
            for notice in study.notices
            if notice not in every
        ]
        return (*dict.fromkeys(every), *joined(some))

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> JsonObject:
        """Return the document for `dynamics.json`: `studies` are documents of their own, in the order of the labels."""
        return {
            "what": self.what,
            "labels": list(self.labels),
            "reference": self.labels[self.reference],
            "greatest": [each._asdict() for each in self.greatest],
            "shaft_overloads": [each._asdict() for each in self.shaft_overloads],
            "resonances": [self._resonance_dict(each) for each in self.resonances],
            "natural_frequencies": [dict(zip(self.labels, each, strict=True)) for each in self.natural_frequencies],
            "studies": [study.to_dict() for study in self.studies],
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def _resonance_dict(self, resonance: SameResonance) -> JsonObject:
        shown = [
            None if peak is None else {**peak._asdict(), "moved": resonance.moved(study, self.reference)}
            for study, peak in enumerate(resonance.shown)
        ]
        return {"mesh": resonance.mesh, "shown": dict(zip(self.labels, shown, strict=True))}

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file: those of each study, with its label and a slash before their names."""
        return {
            f"{label}/{key}": array
            for label, study in zip(self.labels, self.studies, strict=True)
            for key, array in study.arrays().items()
        }

    def tables(self) -> Tables:
        """Return the tables of the CSV files: those of the studies under each other."""
        return stacked(self.what, self.labels, [study.tables() for study in self.studies])
