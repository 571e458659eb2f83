"""SolidCheck: what a check of solid bodies found out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from gearcad.check.options import Model
from gearcad.check.result import CheckResult
from gearcad.check.solid.summary import SolidSummary
from gearcad.contact.solid.cycle import SolidCycle

__all__ = ["SolidCheck"]


@dataclass(frozen=True, kw_only=True, repr=False)
class SolidCheck(CheckResult):
    """A check of solid bodies; under a negative torque `cycle` is that of the mirrored pair."""

    cycle: SolidCycle
    summary: SolidSummary

    model: ClassVar[Model] = Model.SOLID
