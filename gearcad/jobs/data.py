"""Data: every derived quantity of a design."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Unpack

from gearcad.designs.design import Design, DesignKind
from gearcad.jobs.job import Job
from gearcad.jobs.subject import Subject, as_design
from gearcad.notice import Notice
from gearcad.progress import Progress

if TYPE_CHECKING:
    from gearcad.designs import Inputs
    from gearcad.dynamics.trains.train import Train
    from gearcad.load import Load

__all__ = ["Data", "data"]


@dataclass(frozen=True, kw_only=True)
class Data(Job[Design, Design]):
    """The data sheet. Its result is the design itself, whose gears, pair or train know their derived properties."""

    verb = "data"
    accepts = tuple(DesignKind)
    why = "every kind has derived quantities"
    solves = False

    def _run(self, design: Design, _progress: Progress | None) -> Design:
        return design

    def document(self, result: Design) -> dict[str, Any]:
        """What data.json holds: inputs and derived properties under their field names (mm, degrees)."""
        return result.to_dict()

    def notices(self, result: Design) -> Sequence[Notice]:
        return result.notices


def data(subject: Subject | Train, load: Load | None = None, **inputs: Unpack[Inputs]) -> dict[str, Any]:
    """Every derived quantity of a gear, a rack, a pair or a train with its inputs, nested as data.json has it: mm, degrees.

    >>> from gearcad import Gear
    >>> data(Gear(teeth=20, normal_module=2, face_width=20))["gear"]["reference_diameter"]
    40.0
    """
    from gearcad.designs import TrainDesign
    from gearcad.dynamics.trains.train import Train

    job, design = Data(), TrainDesign(name=subject.name, train=subject) if isinstance(subject, Train) else subject
    return job.document(job.run(as_design(design, load, **inputs)))
