"""Comparisons of a check: computed values beside references, and safeties by the stresses of finite elements."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING

from gearcad.check.options import Model
from gearcad.check.task import CheckTask
from gearcad.core.records import JsonObject, PerGear, Role, Verdict
from gearcad.rating.load_factors import LoadFactors
from gearcad.rating.strength import PartStrength, RatedPart, StrengthRating
from gearcad.rating.strength.duty import stresses_of

if TYPE_CHECKING:
    from gearcad.check.summary import Summary


class ComparisonRole(Enum):
    """A gate decides the verdict; information does not."""

    GATE = "gate"
    INFORMATION = "information"


class Subject(Enum):
    """Subject of a comparison."""

    NUMERICS = "numerics"
    """Numerics of the model: equilibrium, agreement with Hertz, errors of mesh and positions."""

    STRENGTH = "strength"
    """Limits of the material."""

    STANDARD = "standard"
    """Value of ISO 6336 for the quantity."""


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
        """Whether there is something to compare; if not, `reason` says why."""
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

    def to_dict(self) -> JsonObject:
        """Return the comparison as `check.json` has it."""
        words = {"role": self.role.value, "subject": self.subject.value}
        found = {"deviation": self.deviation, "evaluated": self.evaluated, "passed": self.passed}
        return asdict(self) | words | found


def verdict(comparisons: Iterable[Comparison], subject: Subject) -> Verdict:
    """Return the verdict of the gates about a subject.

    A gate that is not passed, or could not be evaluated, fails it. Without gates it is not judged.
    """
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
    """Return a gate of the numerics: a value that its reference has too."""
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
    """Return information: a value beside the standard's, which leaves other things out."""
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
    """Return a gate that is an upper limit."""
    return Comparison(quantity, computed, limit, None, unit, source, note, reason, role=ComparisonRole.GATE, subject=subject)


def at_least(quantity: str, computed: float | None, limit: float, source: str, note: str = "", reason: str = "") -> Comparison:
    """Return a gate of strength: a safety and the least one that is permitted."""
    gate, strength = ComparisonRole.GATE, Subject.STRENGTH
    return Comparison(quantity, computed, limit, None, "", source, note, reason, role=gate, subject=strength, least=True)


def beside_limit(
    quantity: str, computed: float | None, limit: float | None, unit: str, source: str, note: str = "", reason: str = ""
) -> Comparison:
    """Return information on strength: a local stress beside a limit that is not its own, None where there is none."""
    information, strength = ComparisonRole.INFORMATION, Subject.STRENGTH
    return Comparison(quantity, computed, limit, None, unit, source, note, reason, role=information, subject=strength)


def beside_required(
    quantity: str, computed: float | None, limit: float, source: str, note: str = "", reason: str = ""
) -> Comparison:
    """Return information on strength: a safety beside the least one that is required, which another decides."""
    information, strength = ComparisonRole.INFORMATION, Subject.STRENGTH
    return Comparison(quantity, computed, limit, None, "", source, note, reason, role=information, subject=strength, least=True)


_FE = "finite elements"


@dataclass(frozen=True, kw_only=True)
class FoundStrength:
    """Safety of one flank or root: `stress` by finite elements (MPa), and `raised` by the load factors that the model lacks.

    `rated` is what the rating says of it, `rated_stress` its stress under that load: of a spectrum under its nominal torque.
    Without a `safety` it was not judged, for the `reason`.
    """

    rated: PartStrength
    rated_stress: float | None
    stress: float | None
    raised: float | None
    missing: str = ""

    @cached_property
    def safety(self) -> float | None:
        """The rating's safety times sigma by the rating over that by finite elements: of one load sigma_G over the stress."""
        if self.rated.safety is None or self.rated_stress is None or not self.raised:
            return None
        return self.rated.safety * self.rated_stress / self.raised

    @property
    def reason(self) -> str:
        """Why there is no safety."""
        return self.rated.reason or ("" if self.raised else self.missing)

    @property
    def below(self) -> bool:
        """Whether finite elements give less than the safety that is required."""
        return self.safety is not None and self.safety < self.rated.required

    def to_dict(self) -> dict[str, float | str | None]:
        """Return stresses and safeties by both, finite elements and the rating."""
        rated = self.rated
        return {
            "fe_stress": self.stress,
            "fe_stress_with_factors": self.raised,
            "rated_stress": self.rated_stress,
            "strength": rated.strength,
            "required": rated.required,
            "fe_safety": self.safety,
            "rated_safety": rated.safety,
            **({"reason": self.reason} if self.reason else {}),
        }


SECTION = "a transverse section of helical teeth is no model of the gears: their lines of contact run across the flanks"
"""Reason why a section judges no strength."""


@dataclass(frozen=True, kw_only=True)
class CheckStrength:
    """Strength by finite elements and by the rating, side by side."""

    task: CheckTask
    summary: Summary
    rating: StrengthRating

    @classmethod
    def of(cls, task: CheckTask, summary: Summary) -> CheckStrength:
        """Return the strength of a task by the summary of its check. Raises what `rate_strength` raises."""
        return cls(task=task, summary=summary, rating=task.strength_rating)

    @cached_property
    def contained(self) -> Mapping[str, str]:
        """Load factors that are in the model already, and how."""
        mounting = self.task.mounting
        found = {"K_A": "the torque has it"}
        if self.task.model is Model.SOLID and mounting.tilted:
            found |= dict.fromkeys(("K_Hbeta", "K_Fbeta"), "the bodies stand as misaligned as [mounting] says")
        if mounting.pitch_error:
            found |= dict.fromkeys(("K_Halpha", "K_Falpha"), "a pair of teeth stands proud by the pitch error of [mounting]")
        return found

    @cached_property
    def own(self) -> Mapping[str, float]:
        """Face load factors of the model itself, aligned: its peaks have them, so those of the rating come in as far as they
        exceed them. A tilted model has them all."""
        return {symbol: value for symbol, value in self.summary.own_face_factors.items() if symbol not in self.contained}

    @cached_property
    def applied(self) -> Mapping[RatedPart, Mapping[str, float]]:
        """Load factors that raise the stresses of flanks, and of roots."""
        factors = self.rating.load_factors
        if factors is None:
            return {part: {} for part in RatedPart}
        return {
            part: {k: self._lacking(k, v) for k, v in _factors(factors, part).items() if k not in self.contained}
            for part in RatedPart
        }

    def _lacking(self, symbol: str, factor: float) -> float:
        """Return the part of a factor, at least 1, that is still to be applied beyond the model's own factor."""
        return max(factor / self.own[symbol], 1.0) if symbol in self.own else factor

    def applied_words(self, part: RatedPart) -> str:
        """Return in words the factors by which the stress of a part is multiplied."""
        of_flank = {"Z_eps": self.contact_ratio_factor} if part is RatedPart.FLANK else {}
        factors = {**self.applied[part], **of_flank}
        words = (f"{name}{' beyond its own' if name in self.own else ''} {value:.4g}" for name, value in factors.items())
        return ", ".join(words)

    @property
    def below_required(self) -> tuple[str, ...]:
        """Safeties by finite elements that are less than required, in words."""
        names = self.rating.names
        return tuple(
            f"S_{part.index} of the {names.pick(role)} is {found.safety:.3g}, below {found.rated.required:.3g} required"
            for part, both in self.parts.items()
            for role, found in both.items()
            if found.below
        )

    @cached_property
    def contact_ratio_factor(self) -> float:
        """Part of Z_eps that is no load sharing of the model: sqrt((4 - eps_alpha)/3 (1 - eps_beta) + eps_beta).

        Tests gave sigma_Hlim by the standard's stress, which has Z_eps. For spur gears it relieves the one pair of teeth that
        carries all. With eps_beta from 1 on it is the length of the lines of contact, which solid bodies have.
        """
        pair = self.task.pair
        overlap = min(pair.overlap_ratio, 1.0)
        return math.sqrt((4 - pair.transverse_contact_ratio) / 3 * (1 - overlap) + overlap)

    @property
    def flank(self) -> PerGear[FoundStrength]:
        """Strength of the flank of each gear by the greatest pressure, which is that of both flanks."""
        missing = self.summary.missing.get("contact_pressure", "")
        return PerGear.each(lambda role: self._found(RatedPart.FLANK, role, self.summary.contact_pressure, missing))

    @property
    def root(self) -> PerGear[FoundStrength]:
        """Strength of the root of each gear by the greatest tension in its fillets."""
        return PerGear.each(lambda role: self._found(RatedPart.ROOT, role, self.summary.root_tension.pick(role)))

    @property
    def parts(self) -> Mapping[RatedPart, PerGear[FoundStrength]]:
        """Flanks and roots."""
        return {RatedPart.FLANK: self.flank, RatedPart.ROOT: self.root}

    def _found(self, part: RatedPart, role: Role, stress: float | None, missing: str = "") -> FoundStrength:
        """Return the strength of a part by finite elements: pressure rises with the square root of the load, tension with the
        load. Pressure contains its part of Z_eps, too.
        """
        raised = rated_stress = None
        factors = self.rating.load_factors
        if self.task.is_section:
            stress, missing = None, SECTION
        if stress is not None and factors is not None and not factors.unknown:
            product = math.prod(self.applied[part].values())
            raised = stress * (math.sqrt(product) * self.contact_ratio_factor if part is RatedPart.FLANK else product)
            rated_stress = stresses_of(self.rating.nominal, factors)[part].pick(role)
        rated = self.rating.parts[part].pick(role)
        return FoundStrength(rated=rated, rated_stress=rated_stress, stress=stress, raised=raised, missing=missing)

    @property
    def judged(self) -> bool:
        """Whether the strength of any part was judged."""
        return any(each.rated.safety is not None for both in self.parts.values() for each in both)

    def to_dict(self) -> JsonObject:
        """Return the strength as `check.json` has it."""
        parts = {part.value: {role.value: each.to_dict() for role, each in both.items()} for part, both in self.parts.items()}
        applied = {part.value: dict(factors) for part, factors in self.applied.items()}
        applied["flank"] |= {"Z_eps": self.contact_ratio_factor}
        return {
            **parts,
            "factors_applied": applied,
            "factors_contained": dict(self.contained),
            "factors_of_model": dict(self.own),
            "below_required": list(self.below_required),
        }


def _scuffing_comparisons(rating: StrengthRating) -> Iterator[Comparison]:
    """Yield the safeties against scuffing that were judged, where one is required: gates."""
    required, found = rating.options.required_safety_scuffing, rating.scuffing
    if required is None or found is None:
        return
    for words, safety in (
        ("S_int, integral temperature", found.integral_safety),
        ("S_B, flash temperature", found.flash_safety),
    ):
        if safety is not None:
            yield at_least(words, safety, required, "scuffing temperature of the oil over that of the teeth")


def _factors(of: LoadFactors, part: RatedPart) -> dict[str, float]:
    """Return all but K_A, which every model contains, by symbols."""
    common = {"K_gamma": of.mesh_load, "K_v": of.dynamic}
    if part is RatedPart.FLANK:
        return {**common, "K_Hbeta": of.face_flank, "K_Halpha": of.transverse_flank}
    return {**common, "K_Fbeta": of.face_root, "K_Falpha": of.transverse_root}


def strength_comparisons(strength: CheckStrength) -> Iterator[Comparison]:
    """Yield the safeties of all parts that were judged, against those required: gates by the standard, information by finite
    elements.

    What a material endures was told from tests by the standard's own stress, so the standard decides.
    """
    edition = strength.rating.options.standard
    for part, both in strength.parts.items():
        symbol, clause = f"S_{part.index}", edition.dated_part(2 if part is RatedPart.FLANK else 3)
        where = f"by {_FE}, of both flanks" if part is RatedPart.FLANK else f"by {_FE}"
        for role, found in both.items():
            rated = found.rated
            if rated.safety is None:
                continue
            words = f"{symbol} of the {strength.rating.names.pick(role)}"
            note = f"sigma_{part.index} = {rated.stress:.5g} MPa against {rated.strength:.5g} MPa"
            yield at_least(f"{words}, {edition.part(2)[:-2]}", rated.safety, rated.required, f"{clause}, 5", note)
            raised = "" if found.raised is None else f", {found.raised:.5g} MPa with {strength.applied_words(part)}"
            note = "" if found.stress is None else f"{found.stress:.5g} MPa {where}{raised}"
            source = f"required; stress by {_FE}, strength by {clause}"
            yield beside_required(f"{words}, {_FE}", found.safety, rated.required, source, note, found.reason)
    yield from _scuffing_comparisons(strength.rating)
