"""One comparison of the check: what was computed, beside what it is held against."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from enum import Enum
from typing import Any

__all__ = ["Comparison", "Role", "against", "at_most"]


class Role(Enum):
    """A gate decides the verdict; information does not."""

    GATE = "gate"
    INFORMATION = "information"


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """`computed` and `reference` in `unit`; `tolerance` is relative, 0.01 for 1 %, None where the reference is a limit."""

    quantity: str
    computed: float
    reference: float
    tolerance: float | None
    unit: str
    source: str
    role: Role
    note: str = ""

    @property
    def deviation(self) -> float:
        """Relative difference from the reference."""
        return self.computed / self.reference - 1 if self.reference else math.copysign(math.inf, self.computed)

    @property
    def passed(self) -> bool:
        """Inside the tolerance, or not above the limit."""
        if self.tolerance is None:
            return self.computed <= self.reference
        return abs(self.deviation) <= self.tolerance

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        return asdict(self) | {"role": self.role.value, "deviation": self.deviation, "passed": self.passed}


def against(
    quantity: str, computed: float, reference: float, tolerance: float, unit: str, source: str, role: Role, note: str = ""
) -> Comparison:
    """A comparison with a value."""
    return Comparison(
        quantity=quantity,
        computed=computed,
        reference=reference,
        tolerance=tolerance,
        unit=unit,
        source=source,
        role=role,
        note=note,
    )


def at_most(quantity: str, computed: float, limit: float, unit: str, source: str, note: str = "") -> Comparison:
    """A gate that is a limit."""
    return Comparison(
        quantity=quantity,
        computed=computed,
        reference=limit,
        tolerance=None,
        unit=unit,
        source=source,
        role=Role.GATE,
        note=note,
    )
