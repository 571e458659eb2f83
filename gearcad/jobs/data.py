"""Data: every derived quantity of a design."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Unpack

from gearcad.designs import Design, GearDesign, GearedDesign, Inputs, PairDesign
from gearcad.geometry import Gear, GearPair
from gearcad.jobs.job import Job
from gearcad.jobs.subject import as_design
from gearcad.load import Load
from gearcad.notice import Notice
from gearcad.progress import Progress

__all__ = ["Data", "data"]


@dataclass(frozen=True, kw_only=True)
class Data(Job[GearedDesign, GearedDesign]):
    """The data sheet. Its result is the design itself, whose gears and pair know their derived properties."""

    verb = "data"
    accepts = (GearDesign, PairDesign)
    why = "there are no teeth"
    solves = False

    def _run(self, design: GearedDesign, _progress: Progress | None) -> GearedDesign:
        return design

    def document(self, result: GearedDesign) -> dict[str, Any]:
        """What data.json holds: inputs and derived properties under their field names (mm, degrees)."""
        return result.to_dict()

    def notices(self, result: GearedDesign) -> Sequence[Notice]:
        return result.notices


def data(subject: Design | GearPair | Gear, load: Load | None = None, **inputs: Unpack[Inputs]) -> dict[str, Any]:
    """Every derived quantity of a gear or a pair with its inputs, nested as data.json has it: mm, degrees.

    >>> from gearcad import Gear
    >>> data(Gear(teeth=20, normal_module=2, face_width=20))["gear"]["reference_diameter"]
    40.0

    Raises ParameterError for a train.
    """
    job = Data()
    return job.document(job.run(as_design(subject, load, **inputs)))
