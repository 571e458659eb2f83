"""The same train several times, with something different each time - its model, or a value: in one chart and one table."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.same import Peak, joined_modes, joined_peaks, peaks_of
from gearcad.dynamics.tables import Tables, stacked
from gearcad.dynamics.tooth_errors.result import ErrorStudy
from gearcad.dynamics.train_result import TrainStudy
from gearcad.errors import ParameterError
from gearcad.notice import Notice, joined, texts
from gearcad.reprs import Pictured

__all__ = ["GreatestOfMesh", "GreatestOfShaft", "SameResonance", "SideBySide"]


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
        """How far (relative) its speed is off that of the reference."""
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
            raise ParameterError("studies", self.labels, "must have the same meshes, to be held against each other")

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.name!r}: {self.what} {', '.join(self.labels)}>"

    def title(self, label: str) -> str:
        """What a label stands for, as charts and headings have it."""
        return f"{self.key} = {label}" if self.key else label

    @property
    def titles(self) -> tuple[str, ...]:
        """Of all studies."""
        return tuple(map(self.title, self.labels))

    @property
    def reference(self) -> int:
        """The study that the others are held against: the first."""
        return 0

    @property
    def mesh_names(self) -> tuple[str, ...]:
        """Of all studies."""
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
        """Mesh by mesh, study by study."""
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
        """Shaft by shaft, of the studies that have it."""
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
        """Of each mesh the highest, by speed."""
        found = []
        for mesh, name in enumerate(self.mesh_names):
            groups = joined_peaks([peaks_of(study, mesh) for study in self.studies], self.reference)
            groups.sort(key=lambda group: -max(peak.factor for peak in group if peak is not None))
            kept = sorted(groups[:_MOST], key=lambda group: min(peak.speed for peak in group if peak is not None))
            found += [SameResonance(name, group) for group in kept]
        return tuple(found)

    @cached_property
    def natural_frequencies(self) -> tuple[tuple[float | None, ...], ...]:
        """Of elastic modes in 1/s, one that moves alike of each study; None where a study has none."""
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
        """What to know before trusting it: what is true of all studies, then what of some, and of which."""
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

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it: `studies` are documents of their own, in the order of the labels."""
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

    def _resonance_dict(self, resonance: SameResonance) -> dict[str, Any]:
        shown = [
            None if peak is None else {**peak._asdict(), "moved": resonance.moved(study, self.reference)}
            for study, peak in enumerate(resonance.shown)
        ]
        return {"mesh": resonance.mesh, "shown": dict(zip(self.labels, shown, strict=True))}

    def arrays(self) -> dict[str, Floats]:
        """As the .npz file has them: those of each study, its label and a slash before their names."""
        return {
            f"{label}/{key}": array
            for label, study in zip(self.labels, self.studies, strict=True)
            for key, array in study.arrays().items()
        }

    def tables(self) -> Tables:
        """As the CSV files have them: those of the studies under each other."""
        return stacked(self.what, self.labels, [study.tables() for study in self.studies])
