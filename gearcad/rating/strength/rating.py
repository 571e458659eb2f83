"""StrengthRating: whether a pair holds, for how long, and what it would bear."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from gearcad.geometry import GearPair, RackPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.notice import Notice, texts
from gearcad.per_gear import PerGear, Role
from gearcad.rating.iso6336_5 import EnduranceLimits
from gearcad.rating.load_factors import LoadFactors
from gearcad.rating.options import RatingOptions
from gearcad.rating.rate import Rating
from gearcad.rating.scuffing import Risk, Scuffing
from gearcad.rating.strength.duty import LoadCase
from gearcad.rating.strength.part import Part, PartStrength
from gearcad.rating.tolerances import GearTolerances
from gearcad.reprs import Pictured
from gearcad.verdict import NOT_ASKED_WORDS, Verdict, strength_verdict

__all__ = ["StrengthRating"]


@dataclass(frozen=True, kw_only=True)
class StrengthRating(Pictured):
    """The full rating of a pair by ISO 6336 or DIN 3990: of each flank and root stress, strength and safety.

    `nominal` is the rating by geometry and torque alone, with K_A. `load_factors` are those of the load, of a spectrum those of
    its nominal torque, and `cases` its loads; None where they are not known, for the reason that the parts have. `governing` is
    the load with the greatest torque: stresses, speed factors and what is told of load factors are of it, safeties and lives of
    the whole spectrum. `assumed` says in words what was not given, `verify` has the symbols of what rests on one source or on
    memory. Gears of a set have `own_names`.
    """

    pair: GearPair | RackPair
    materials: PerGear[Material]
    load: Load
    options: RatingOptions
    nominal: Rating
    limits: PerGear[EnduranceLimits]
    load_factors: LoadFactors | None
    cases: tuple[LoadCase, ...]
    governing: LoadCase | None
    flank: PerGear[PartStrength]
    root: PerGear[PartStrength]
    scuffing: Scuffing | None
    tolerances: PerGear[GearTolerances[float] | None]
    assumed: tuple[str, ...]
    verify: tuple[str, ...]
    notices: tuple[Notice, ...]
    own_names: PerGear[str] | None = None

    def __repr__(self) -> str:
        return f"<StrengthRating of {self.pair.name!r} at {self.load.torque:g} N·m: {self.verdict}>"

    @property
    def name(self) -> str:
        """That of the pair."""
        return self.pair.name

    @property
    def names(self) -> PerGear[str]:
        """Under what documents have the values of both gears."""
        return self.nominal.names

    @property
    def gear_names(self) -> PerGear[str]:
        """What both gears are called where a rating is told: pinion and wheel, or as in their set."""
        return self.own_names or self.names

    @property
    def contact_ratio(self) -> float:
        """eps_gamma."""
        return self.pair.total_contact_ratio

    @property
    def parts(self) -> Mapping[Part, PerGear[PartStrength]]:
        """Flanks and roots."""
        return {Part.FLANK: self.flank, Part.ROOT: self.root}

    @property
    def every(self) -> Iterator[tuple[str, PartStrength]]:
        """Each part with its name, such as "flank of the pinion"."""
        for part, both in self.parts.items():
            for role in Role:
                yield f"{part.value} of the {self.gear_names.pick(role)}", both.pick(role)

    # ------------------------------------------------------------------ the least

    @property
    def permissible_torque(self) -> float | None:
        """Torque on the pinion (N·m) at which all parts that were judged have their required safety."""
        return _least(each.permissible_torque for _, each in self.every)

    @property
    def life(self) -> float | None:
        """Hours until the first part that was judged fails, with the required safeties; can be infinite."""
        return _least(each.life for _, each in self.every)

    @property
    def least(self) -> Mapping[Part, float | None]:
        """The lower safety of flanks, and of roots."""
        return {part: _least(each.safety for each in both) for part, both in self.parts.items()}

    # ------------------------------------------------------------------ the verdict

    @property
    def scuffing_verdict(self) -> Verdict:
        """Whether both safeties against scuffing are as large as is required; not judged where none is."""
        required, found = self.options.required_safety_scuffing, self.scuffing
        known = [] if found is None else [each for each in (found.integral_safety, found.flash_safety) if each is not None]
        if required is None or not known:
            return Verdict.NOT_JUDGED
        return Verdict.PASSED if min(known) >= required else Verdict.FAILED

    @property
    def scuffing_unasked(self) -> str:
        """What is to be said of flanks that may scuff where no safety is required; "" where there is nothing to say."""
        found = self.scuffing
        if self.options.required_safety_scuffing is not None or found is None or found.risk in (None, Risk.LOW):
            return ""
        safeties = {"S_int": found.integral_safety, "S_B": found.flash_safety}
        known = "".join(f", {symbol} {value:.2f}" for symbol, value in safeties.items() if value is not None)
        return f"scuffing not judged (no required_safety_scuffing): risk {found.risk.value}{known}"

    @property
    def told_load(self) -> str:
        """Of a spectrum, in words: of which load the stresses and load factors are that are told; "" without one."""
        if not self.options.bins or self.governing is None:
            return ""
        load = self.governing.load
        at = f"{self.halves * load.torque:.6g} N·m, {load.speed:.6g} rpm, the greatest torque"
        return f"stresses, load factors and Z_v are of load {self.governing_number}: {at}; safeties and lives of all loads"

    @property
    def governing_number(self) -> int | None:
        """Which of `cases` it is, counted from 1."""
        return next((number for number, case in enumerate(self.cases, 1) if case is self.governing), None)

    @property
    def halves(self) -> int:
        """Of how many pairs `cases` have one: of a double helical pair each half has its share of the torque."""
        return 2 if self.pair.pinion.double_helix.present else 1

    @property
    def asked(self) -> bool:
        """Whether a limit or a quality of a material, or a required safety, asks for a verdict on strength."""
        return self.options.asks_strength or any(each.asks_strength for each in self.materials)

    @property
    def required_verdicts(self) -> tuple[Verdict, ...]:
        """Verdicts of flanks and roots of both gears, and of scuffing where its safety is required."""
        scuffing = () if self.options.required_safety_scuffing is None else (self.scuffing_verdict,)
        return (*(each.verdict for _, each in self.every), *scuffing)

    @property
    def strength(self) -> Verdict:
        """The verdict on strength by `strength_verdict`."""
        return strength_verdict(self.asked, self.required_verdicts)

    @property
    def passed(self) -> bool | None:
        """Whether strength is passed or failed; None where it was not judged, or not asked for."""
        return {Verdict.PASSED: True, Verdict.FAILED: False}.get(self.strength)

    @property
    def not_judged(self) -> Mapping[str, str]:
        """What was not, and why."""
        found = {name: each.reason for name, each in self.every if each.safety is None}
        if self.options.required_safety_scuffing is not None and self.scuffing_verdict is Verdict.NOT_JUDGED:
            found["scuffing"] = "its temperatures are not known" if self.scuffing is None else self.scuffing.reason
        return found

    @property
    def verdict(self) -> str:
        """In one line."""
        if self.strength is Verdict.NOT_ASKED:
            return f"strength {NOT_ASKED_WORDS}"
        if self.strength is Verdict.NOT_JUDGED:
            return f"strength not judged: {'; '.join(dict.fromkeys(self.not_judged.values()))}"
        failed = [name for name, each in self.every if each.verdict is Verdict.FAILED]
        failed += ["scuffing"] if self.scuffing_verdict is Verdict.FAILED else []
        words = "strength passed" if not failed else f"strength NOT passed: {', '.join(failed)}"
        words += f"; not judged: {', '.join(self.not_judged)}" if self.not_judged else ""
        return f"{words}; {self.scuffing_unasked}" if self.scuffing_unasked else words

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> dict[str, Any]:
        """What rate.json holds, but for kind and name."""
        from gearcad.rating.strength.document import strength_document

        return strength_document(self)


def _least(values: Iterator[float | None]) -> float | None:
    """Of those that are known."""
    return min((value for value in values if value is not None), default=None)
