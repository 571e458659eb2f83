"""One comparison of the check: what was computed, beside what it is held against."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from enum import Enum
from typing import Any

from gearcad.verdict import Verdict

__all__ = [
    "Comparison",
    "ComparisonRole",
    "Subject",
    "agrees",
    "at_least",
    "at_most",
    "beside",
    "beside_limit",
    "beside_required",
    "verdict",
]


class ComparisonRole(Enum):
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


@dataclass(frozen=True)
class Comparison:
    """`computed` and `reference` in `unit`; `tolerance` is relative, 0.01 for 1 %, None where the reference is a limit: the
    greatest, or the `least` value that is permitted.

    None stands for what could not be evaluated, for the `reason`; a number that is not finite is none. Such a comparison is
    never passed.
    """

    quantity: str
    computed: float | None
    reference: float | None
    tolerance: float | None
    unit: str
    source: str
    role: ComparisonRole = field(kw_only=True)
    subject: Subject = field(kw_only=True)
    note: str = ""
    reason: str = ""
    least: bool = field(default=False, kw_only=True)

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
        """Inside the tolerance, or not beyond the limit."""
        deviation = self.deviation
        if deviation is None:
            return False
        if self.tolerance is not None:
            return abs(deviation) <= self.tolerance
        return deviation >= 0 if self.least else deviation <= 0

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        words = {"role": self.role.value, "subject": self.subject.value}
        found = {"deviation": self.deviation, "evaluated": self.evaluated, "passed": self.passed}
        return asdict(self) | words | found


def verdict(comparisons: Iterable[Comparison], subject: Subject) -> Verdict:
    """What the gates about a subject say: one that is not passed, or could not be evaluated, fails it."""
    gates = [each for each in comparisons if each.role is ComparisonRole.GATE and each.subject is subject]
    if not gates:
        return Verdict.NOT_JUDGED
    return Verdict.PASSED if all(each.passed for each in gates) else Verdict.FAILED


def agrees(
    quantity: str,
    computed: float | None,
    reference: float | None,
    tolerance: float,
    unit: str,
    source: str,
    note: str = "",
    reason: str = "",
) -> Comparison:
    """A gate of the numerics: a value that its reference has too."""
    gate, numerics = ComparisonRole.GATE, Subject.NUMERICS
    return Comparison(quantity, computed, reference, tolerance, unit, source, note, reason, role=gate, subject=numerics)


def beside(
    quantity: str,
    computed: float | None,
    reference: float | None,
    band: float,
    unit: str,
    source: str,
    note: str = "",
    reason: str = "",
) -> Comparison:
    """Information: a value beside the standard's, which leaves other things out."""
    information, standard = ComparisonRole.INFORMATION, Subject.STANDARD
    return Comparison(quantity, computed, reference, band, unit, source, note, reason, role=information, subject=standard)


def at_most(
    quantity: str,
    computed: float | None,
    limit: float,
    unit: str,
    source: str,
    note: str = "",
    reason: str = "",
    *,
    subject: Subject = Subject.NUMERICS,
) -> Comparison:
    """A gate that is a limit."""
    return Comparison(quantity, computed, limit, None, unit, source, note, reason, role=ComparisonRole.GATE, subject=subject)


def at_least(quantity: str, computed: float | None, limit: float, source: str, note: str = "", reason: str = "") -> Comparison:
    """A gate of strength: a safety and the least one that is permitted."""
    gate, strength = ComparisonRole.GATE, Subject.STRENGTH
    return Comparison(quantity, computed, limit, None, "", source, note, reason, role=gate, subject=strength, least=True)


def beside_limit(
    quantity: str, computed: float | None, limit: float | None, unit: str, source: str, note: str = "", reason: str = ""
) -> Comparison:
    """Information on strength: a local stress beside a limit that is not its own, None where there is none."""
    information, strength = ComparisonRole.INFORMATION, Subject.STRENGTH
    return Comparison(quantity, computed, limit, None, unit, source, note, reason, role=information, subject=strength)


def beside_required(
    quantity: str, computed: float | None, limit: float, source: str, note: str = "", reason: str = ""
) -> Comparison:
    """Information on strength: a safety beside the least one that is required, which another decides."""
    information, strength = ComparisonRole.INFORMATION, Subject.STRENGTH
    return Comparison(quantity, computed, limit, None, "", source, note, reason, role=information, subject=strength, least=True)
