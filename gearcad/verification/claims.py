"""Claims: what is said of a design or of its files, what a judge found instead, and whether that is permitted."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from time import perf_counter
from typing import Annotated, Any

from gearcad.core.quantities import Member, Range, Words, require_fields
from gearcad.core.records import concise


class VerificationLevel(Enum):
    """Extent of a verification: each level includes those before it."""

    FILES = "files"
    STRENGTH = "strength"
    FULL = "full"

    def includes(self, other: VerificationLevel) -> bool:
        """Return whether a verification at this level has the claims of the other level."""
        levels = list(VerificationLevel)
        return levels.index(other) <= levels.index(self)


TOLERANCE = 1e-6
"""Relative change of a figure from a baseline that is no change, unless another is given."""


@dataclass(frozen=True, kw_only=True)
class VerificationOptions:
    """Options of a verification: what is judged, and the relative change of a figure from a baseline that is no change.

    Raises ParameterError.
    """

    level: Annotated[str, Member(VerificationLevel), Words("extent of the verification")] = VerificationLevel.FILES.value
    tolerance: Annotated[float, Range("", 0.0, 0.999), Words("relative change from a baseline that is no change")] = TOLERANCE

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)


class ClaimSubject(Enum):
    """Subject of a claim; the value is its name in verify.json."""

    STEP = "STEP"
    STL = "STL"
    THREE_MF = "3MF"
    GLB = "GLB"
    DXF = "DXF"
    DRAWING = "drawing"
    MESH = "mesh"
    GEOMETRY = "geometry"
    CONTACT = "contact"
    ROOT = "root stress"
    STIFFNESS = "stiffness"
    STRENGTH = "strength"
    CALCULIX = "CalculiX"


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One claim: a `quantity` of a part or file, as the program says (`computed`) and as the judge finds (`reference`).

    `deviation` and `permitted` are in `unit`. `passed` is None where nothing was judged; `reason` then says why, and of a claim
    that failed at which place. `judge` names the program or the method that judged; `seconds` is how long it took.
    """

    subject: ClaimSubject
    level: VerificationLevel
    where: str
    quantity: str
    judge: str
    computed: float | str | None = None
    reference: float | str | None = None
    deviation: float | None = None
    permitted: float | None = None
    unit: str = ""
    passed: bool | None
    reason: str = ""
    seconds: float = 0.0

    @property
    def text(self) -> str:
        """The claim in one line: what, where, the deviation beside what is permitted, and the reason."""
        if self.subject is ClaimSubject.STRENGTH and isinstance(self.computed, float):
            said = f": {self.computed:.4g} of {self.reference} required"
        elif self.deviation is not None and self.permitted is not None:
            said = f": {self.deviation:.4g} of {self.permitted:.4g} {self.unit} permitted".replace("  ", " ")
        elif self.computed is not None or self.reference is not None:
            said = f": {self.computed} told, {self.reference} found"
        else:
            said = ""
        return f"{self.subject.value}, {self.where}: {self.quantity}{said}{f' ({self.reason})' if self.reason else ''}"

    def to_dict(self) -> dict[str, Any]:
        """Return the claim as an entry of verify.json."""
        return {
            "claim": self.subject.value,
            "level": self.level.value,
            "where": self.where,
            "quantity": self.quantity,
            "computed": self.computed,
            "reference": self.reference,
            "deviation": _finite(self.deviation),
            "permitted": self.permitted,
            "unit": self.unit,
            "judge": self.judge,
            "passed": self.passed,
            "reason": self.reason,
            "seconds": round(self.seconds, 4),
        }


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


@dataclass(frozen=True)
class Judge:
    """Maker of the claims that one judge decides: on a `subject`, at a `level`, about one part or file `where`."""

    subject: ClaimSubject
    level: VerificationLevel
    where: str
    name: str

    def near(
        self,
        quantity: str,
        computed: float,
        reference: float,
        permitted: float,
        unit: str = "",
        *,
        relative: bool = False,
        place: str = "",
    ) -> Claim:
        """Return the claim that a figure is the judge's: the difference, or its share of the reference, is at most `permitted`.

        A difference that is not a number fails.
        """
        deviation = computed - reference
        if relative:
            deviation = deviation / abs(reference) if reference else (0.0 if deviation == 0.0 else math.inf)
        return self._claim(quantity, computed, reference, deviation, permitted, unit, abs(deviation) <= permitted, place)

    def below(self, quantity: str, deviation: float, permitted: float, unit: str, *, place: str = "") -> Claim:
        """Return the claim that the greatest deviation found, of a figure that should be zero, is at most `permitted`."""
        return self._claim(quantity, None, None, deviation, permitted, unit, abs(deviation) <= permitted, place)

    def equal(self, quantity: str, computed: float | str, reference: float | str, *, place: str = "") -> Claim:
        """Return the claim that a count or a text is exactly the judge's."""
        return self._claim(quantity, computed, reference, None, None, "", computed == reference, place)

    def holds(self, quantity: str, true: bool, *, place: str = "") -> Claim:
        """Return the claim that a statement is true."""
        return self._claim(quantity, None, None, None, None, "", bool(true), place)

    def not_judged(self, quantity: str, reason: str) -> Claim:
        """Return the claim that nothing was judged, with the reason."""
        return Claim(
            subject=self.subject,
            level=self.level,
            where=self.where,
            quantity=quantity,
            judge=self.name,
            passed=None,
            reason=reason,
        )

    def _claim(
        self,
        quantity: str,
        computed: float | str | None,
        reference: float | str | None,
        deviation: float | None,
        permitted: float | None,
        unit: str,
        passed: bool,
        place: str,
    ) -> Claim:
        return Claim(
            subject=self.subject,
            level=self.level,
            where=self.where,
            quantity=quantity,
            judge=self.name,
            computed=computed,
            reference=reference,
            deviation=deviation,
            permitted=permitted,
            unit=unit,
            passed=bool(passed),
            reason="" if passed else place,
        )


def timed(claims: Iterable[Claim]) -> Iterator[Claim]:
    """Yield the claims, each with the seconds that its judge took."""
    started = perf_counter()
    for claim in claims:
        yield replace(claim, seconds=perf_counter() - started)
        started = perf_counter()


def passed(claims: Iterable[Claim]) -> bool | None:
    """Return the verdict of claims: False if one failed, True if some passed and none failed, None if nothing was judged."""
    verdicts = [claim.passed for claim in claims if claim.passed is not None]
    return all(verdicts) if verdicts else None


def counted(claims: Iterable[Claim]) -> Mapping[str, int]:
    """Return the number of claims that passed, failed and were not judged."""
    verdicts = [claim.passed for claim in claims]
    return {"passed": verdicts.count(True), "failed": verdicts.count(False), "not judged": verdicts.count(None)}
