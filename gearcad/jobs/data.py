"""Data: every derived quantity of a design."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Unpack

from gearcad.designs import GearDesign, Inputs, PairDesign, PlanetaryDesign, RackDesign, RackPairDesign, ToothedDesign
from gearcad.jobs.job import Job
from gearcad.jobs.subject import Subject, as_design
from gearcad.load import Load
from gearcad.notice import Notice
from gearcad.progress import Progress

__all__ = ["Data", "data"]


@dataclass(frozen=True, kw_only=True)
class Data(Job[ToothedDesign, ToothedDesign]):
    """The data sheet. Its result is the design itself, whose gears and pair know their derived properties."""

    verb = "data"
    accepts = (GearDesign, PairDesign, RackDesign, RackPairDesign, PlanetaryDesign)
    why = "there are no teeth"
    solves = False

    def _run(self, design: ToothedDesign, _progress: Progress | None) -> ToothedDesign:
        return design

    def document(self, result: ToothedDesign) -> dict[str, Any]:
        """What data.json holds: inputs and derived properties under their field names (mm, degrees)."""
        return result.to_dict()

    def notices(self, result: ToothedDesign) -> Sequence[Notice]:
        return result.notices


def data(subject: Subject, load: Load | None = None, **inputs: Unpack[Inputs]) -> dict[str, Any]:
    """Every derived quantity of a gear, a rack or a pair with its inputs, nested as data.json has it: mm, degrees.

    >>> from gearcad import Gear
    >>> data(Gear(teeth=20, normal_module=2, face_width=20))["gear"]["reference_diameter"]
    40.0

    Raises ParameterError for a train.
    """
    job = Data()
    return job.document(job.run(as_design(subject, load, **inputs)))
