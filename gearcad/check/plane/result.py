"""PlaneCheck: what a check in the plane found out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from gearcad.check.options import Model
from gearcad.check.plane.summary import PlaneSummary
from gearcad.check.result import CheckResult
from gearcad.contact.plane.cycle import PlaneCycle

__all__ = ["PlaneCheck"]


@dataclass(frozen=True, kw_only=True, repr=False)
class PlaneCheck(CheckResult):
    """A check in the transverse section through the middle of the common face width."""

    cycle: PlaneCycle
    summary: PlaneSummary

    model: ClassVar[Model] = Model.PLANE
