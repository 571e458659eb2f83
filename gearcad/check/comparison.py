"""One comparison of the check: what was computed, beside what it is held against."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from enum import Enum
from typing import Any

__all__ = ["Comparison", "Role", "Subject", "Verdict", "against", "at_most", "verdict"]


class Role(Enum):
    """A gate decides the verdict; information does not."""

    GATE = "gate"
    INFORMATION = "information"


class Subject(Enum):
    """What a comparison is about."""

    NUMERICS = "numerics"
    """Whether the numbers are those of the model: equilibrium, Hertz, the error of mesh and positions."""

    STRENGTH = "strength"
    """Limits of the material."""

    STANDARD = "standard"
    """What ISO 6336 has for it."""


class Verdict(Enum):
    """What the gates about one subject say together."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_JUDGED = "not judged"


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """`computed` and `reference` in `unit`; `tolerance` is relative, 0.01 for 1 %, None where the reference is a limit.

    None stands for what could not be evaluated, for the `reason`; a number that is not finite is none. Such a comparison is
    never passed.
    """

    quantity: str
    computed: float | None
    reference: float | None
    tolerance: float | None
    unit: str
    source: str
    role: Role
    subject: Subject
    note: str = ""
    reason: str = ""

    def __post_init__(self) -> None:
        for name in ("computed", "reference"):
            value = getattr(self, name)
            if value is not None and not math.isfinite(value):
                object.__setattr__(self, name, None)
        if self.deviation is None and not self.reason:
            object.__setattr__(self, "reason", "what was computed, or what it is held against, is not a finite number")

    @property
    def deviation(self) -> float | None:
        """Relative difference from the reference; None where there is none to tell."""
        if self.computed is None or not self.reference:
            return None
        return self.computed / self.reference - 1

    @property
    def evaluated(self) -> bool:
        """False if there is nothing to compare, for the `reason`."""
        return self.deviation is not None

    @property
    def passed(self) -> bool:
        """Inside the tolerance, or not above the limit."""
        deviation = self.deviation
        if deviation is None:
            return False
        return deviation <= 0 if self.tolerance is None else abs(deviation) <= self.tolerance

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        words = {"role": self.role.value, "subject": self.subject.value}
        found = {"deviation": self.deviation, "evaluated": self.evaluated, "passed": self.passed}
        return asdict(self) | words | found


def verdict(comparisons: Iterable[Comparison], subject: Subject) -> Verdict:
    """What the gates about a subject say: one that is not passed, or could not be evaluated, fails it."""
    gates = [each for each in comparisons if each.role is Role.GATE and each.subject is subject]
    if not gates:
        return Verdict.NOT_JUDGED
    return Verdict.PASSED if all(each.passed for each in gates) else Verdict.FAILED


def against(
    quantity: str,
    computed: float | None,
    reference: float | None,
    tolerance: float,
    unit: str,
    source: str,
    role: Role,
    note: str = "",
    reason: str = "",
) -> Comparison:
    """A comparison with a value: as a gate of the numerics, as information of the standard."""
    return Comparison(
        quantity=quantity,
        computed=computed,
        reference=reference,
        tolerance=tolerance,
        unit=unit,
        source=source,
        role=role,
        subject=Subject.NUMERICS if role is Role.GATE else Subject.STANDARD,
        note=note,
        reason=reason,
    )


def at_most(
    quantity: str,
    computed: float | None,
    limit: float,
    unit: str,
    source: str,
    note: str = "",
    subject: Subject = Subject.NUMERICS,
    reason: str = "",
) -> Comparison:
    """A gate that is a limit."""
    return Comparison(
        quantity=quantity,
        computed=computed,
        reference=limit,
        tolerance=None,
        unit=unit,
        source=source,
        role=Role.GATE,
        subject=subject,
        note=note,
        reason=reason,
    )
