"""StrengthRating: whether a pair holds, for how long, and what it would bear; its document for rate.json."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

from gearcad.core import symbols
from gearcad.core.quantities import inputs_document
from gearcad.core.records import NOT_ASKED_WORDS, JsonObject, Notice, PerGear, Pictured, Role, Verdict, strength_verdict, texts
from gearcad.geometry import GearPair, RackPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.rating.factors import citations
from gearcad.rating.friction import MeshEfficiency
from gearcad.rating.load_factors import LoadFactors
from gearcad.rating.material_limits import EnduranceLimits
from gearcad.rating.nominal_rating import Rating
from gearcad.rating.options import RatingOptions
from gearcad.rating.scuffing import Risk, Scuffing
from gearcad.rating.strength.duty import LoadCase, PartStrength, RatedPart, told
from gearcad.rating.strength.permissible import Y_ST
from gearcad.rating.strength.plastic import PlasticProof, PlasticRating
from gearcad.rating.tolerances import GearTolerances


class FactorGroup(Enum):
    """Groups of factors, by what they belong to: the load, a stress, or what flanks and roots bear."""

    LOAD = "load factors"
    CONTACT_STRESS = "contact stress"
    FLANK_STRENGTH = "flanks bear"
    ROOT_STRESS = "root stress"
    ROOT_STRENGTH = "roots bear"


@dataclass(frozen=True, kw_only=True)
class StrengthRating(Pictured):
    """The full rating of a pair by ISO 6336 or DIN 3990: of each flank and root stress, strength and safety.

    `nominal` is the rating by geometry and torque alone, with K_A. `load_factors` are those of the load, of a spectrum those of
    its nominal torque, and `cases` its loads; None where they are not known, for the reason that the parts have. `governing` is
    the load with the greatest torque: stresses, speed factors and what is told of load factors are of it, safeties and lives of
    the whole spectrum. `plastic` has what VDI 2736-2 says of a pair with a gear of plastic. `assumed` says in words what was
    not given, `verify` has the symbols of what rests on one source or on memory. Gears of a set have `own_names`.
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
    plastic: PlasticRating | None = None
    efficiency: MeshEfficiency | None = None

    def __repr__(self) -> str:
        return f"<StrengthRating of {self.pair.name!r} at {self.load.torque:g} N·m: {self.verdict}>"

    @property
    def name(self) -> str:
        """Name of the pair."""
        return self.pair.name

    @property
    def names(self) -> PerGear[str]:
        """Keys of both gears in documents."""
        return self.nominal.names

    @property
    def gear_names(self) -> PerGear[str]:
        """Names of both gears in texts: pinion and wheel, or their names in a set."""
        return self.own_names or self.names

    @property
    def contact_ratio(self) -> float:
        """Total contact ratio eps_gamma."""
        return self.pair.total_contact_ratio

    @property
    def parts(self) -> Mapping[RatedPart, PerGear[PartStrength]]:
        """Flanks and roots."""
        return {RatedPart.FLANK: self.flank, RatedPart.ROOT: self.root}

    @property
    def every(self) -> Iterator[tuple[str, PartStrength]]:
        """Each part with its name, such as "flank of the pinion"."""
        for part, both in self.parts.items():
            for role in Role:
                yield f"{part.value} of the {self.gear_names.pick(role)}", both.pick(role)

    @property
    def factors(self) -> Mapping[FactorGroup, Mapping[str, Any]]:
        """All factors under their symbols, by group: one number, or those of both gears under their keys in documents.

        Screen, data sheet, page, reports and rate.json show what is in here, in this order.
        """
        flank, root = (both.map(lambda each: each.factors) for both in (self.flank, self.root))
        return {
            FactorGroup.LOAD: {} if self.governing is None else self.governing.factors.to_dict(),
            FactorGroup.CONTACT_STRESS: self.nominal.flank.factors,
            FactorGroup.FLANK_STRENGTH: _by_symbol(self, flank),
            FactorGroup.ROOT_STRESS: _by_symbol(self, self.nominal.roots.map(lambda each: each.factors)),
            FactorGroup.ROOT_STRENGTH: {"Y_ST": Y_ST, **_by_symbol(self, root)},
        }

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
    def least(self) -> Mapping[RatedPart, float | None]:
        """The lower safety of flanks, and of roots."""
        return {part: _least(each.safety for each in both) for part, both in self.parts.items()}

    # ------------------------------------------------------------------ the verdict

    @property
    def scuffing_verdict(self) -> Verdict:
        """Whether both safeties against scuffing are as large as is required; not judged where none is."""
        required, found = self.options.required_safety_scuffing, self.scuffing
        if required is None or found is None or not found.safeties:
            return Verdict.NOT_JUDGED
        return Verdict.PASSED if min(found.safeties.values()) >= required else Verdict.FAILED

    @property
    def scuffing_unasked(self) -> str:
        """Sentence on the scuffing risk where no safety is required; "" if the risk is low or not known."""
        found = self.scuffing
        if self.options.required_safety_scuffing is not None or found is None or found.risk in (None, Risk.LOW):
            return ""
        known = "".join(f", {symbol} {value:.2f}" for symbol, value in found.safeties.items())
        return f"scuffing not judged (no required_safety_scuffing): risk {found.risk.value}{known}"

    @property
    def told_load(self) -> str:
        """Sentence that names the load of a spectrum to which stresses and load factors belong; "" without a spectrum."""
        if not self.options.bins or self.governing is None:
            return ""
        load = self.governing.load
        at = f"{self.halves * load.torque:.6g} N·m, {load.speed:.6g} rpm, the greatest torque"
        return f"stresses, load factors and Z_v are of load {self.governing_number}: {at}; safeties and lives of all loads"

    @property
    def governing_number(self) -> int | None:
        """Number of the governing load among `cases`, counted from 1."""
        return next((number for number, case in enumerate(self.cases, 1) if case is self.governing), None)

    @property
    def halves(self) -> int:
        """Number of halves of the pair: 2 if double helical, else 1; `cases` are the loads of one half."""
        return 2 if self.pair.pinion.double_helix.present else 1

    @property
    def asked(self) -> bool:
        """Whether a limit or a quality of a material, or a required safety, requires a verdict on strength."""
        return self.options.asks_strength or any(each.asks_strength for each in self.materials)

    @property
    def required_verdicts(self) -> tuple[Verdict, ...]:
        """Verdicts of flanks and roots of both gears, and of scuffing where its safety is required."""
        scuffing = () if self.options.required_safety_scuffing is None else (self.scuffing_verdict,)
        return (*(each.verdict for _, each in self.every), *scuffing, *(each.verdict for each in self.proofs.values()))

    @property
    def proofs(self) -> Mapping[str, PlasticProof]:
        """Wear and static load of gears of plastic, by name."""
        return {} if self.plastic is None else self.plastic.proofs

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
        """Reason for each part that was not judged, under its name."""
        found = {name: each.reason for name, each in self.every if each.safety is None}
        if self.options.required_safety_scuffing is not None and self.scuffing_verdict is Verdict.NOT_JUDGED:
            found["scuffing"] = "its temperatures are not known" if self.scuffing is None else self.scuffing.reason
        not_judged = {name: each for name, each in self.proofs.items() if each.verdict is Verdict.NOT_JUDGED}
        return found | {name: each.reason or "its limit is as recalled: confirm it" for name, each in not_judged.items()}

    @property
    def verdict(self) -> str:
        """Verdict on strength in one line."""
        if self.strength is Verdict.NOT_ASKED:
            return f"strength {NOT_ASKED_WORDS}"
        if self.strength is Verdict.NOT_JUDGED:
            return f"strength not judged: {'; '.join(dict.fromkeys(self.not_judged.values()))}"
        failed = [name for name, each in self.every if each.verdict is Verdict.FAILED]
        failed += ["scuffing"] if self.scuffing_verdict is Verdict.FAILED else []
        failed += [name for name, each in self.proofs.items() if each.verdict is Verdict.FAILED]
        words = "strength passed" if not failed else f"strength NOT passed: {', '.join(failed)}"
        words += f"; not judged: {', '.join(self.not_judged)}" if self.not_judged else ""
        return f"{words}; {self.scuffing_unasked}" if self.scuffing_unasked else words

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> JsonObject:
        """Return the content of rate.json without its kind and name."""

        return strength_document(self)


def _least(values: Iterator[float | None]) -> float | None:
    """Return the least of the values that are known; None if none is."""
    return min((value for value in values if value is not None), default=None)


_ROLES = re.compile(rf"(?<!\w)({'|'.join(role.value for role in Role)})(?!\w)")


def called(rating: StrengthRating, names: PerGear[str]) -> StrengthRating:
    """Return the rating with `names` in all that it says; documents keep values under "pinion" and "wheel"."""
    by_role = {role.value: name for role, name in names.items()}

    def said(text: str) -> str:
        return _ROLES.sub(lambda role: by_role[role[0]], text)

    def of_part(part: PartStrength) -> PartStrength:
        return replace(part, reason=said(part.reason))

    return replace(
        rating,
        own_names=names,
        flank=rating.flank.map(of_part),
        root=rating.root.map(of_part),
        assumed=tuple(map(said, rating.assumed)),
        verify=tuple(map(said, rating.verify)),
        notices=tuple(replace(each, text=said(each.text), where=said(each.where)) for each in rating.notices),
    )


def strength_document(of: StrengthRating) -> JsonObject:
    """Return everything of a rating but its kind and name; unknown values are null."""
    factors = {symbol: value for group in of.factors.values() for symbol, value in group.items()}
    stresses = _stresses(of)
    return {
        "standard": of.options.standard.value,
        **({} if of.own_names is None else {"gears": _gears(of, of.own_names)}),
        "load": inputs_document(of.load),
        "materials": _gears(of, of.materials.map(inputs_document)),
        "factors": factors,
        "stresses": stresses,
        "load_cycles": _by_part(of, lambda each: each.cycles),
        "safety": {**_by_part(of, lambda each: each.safety), "scuffing": _scuffing_safety(of)},
        "permissible_torque": {**_by_part(of, lambda each: each.permissible_torque), "least": of.permissible_torque},
        "life": {**_by_part(of, lambda each: told(each.life)), "least": told(of.life)},
        "damage": _by_part(of, lambda each: told(each.damage)),
        "spectrum": _spectrum(of),
        "governing": _governing(of),
        "load_factors": None if of.governing is None else _plain(of.governing.factors.details),
        "scuffing": None if of.scuffing is None else of.scuffing.to_dict(),
        "tolerances": _tolerances(of),
        "sources": _sources(of, (*factors, *stresses)),
        "assumed": list(of.assumed),
        "verify": list(of.verify),
        "unconfirmed": list(of.verify),
        "required": _required(of),
        "not_judged": dict(of.not_judged),
        "strength": of.strength.value,
        "passed": of.passed,
        "notices": [notice.to_dict() for notice in of.notices],
        "warnings": list(of.warnings),
        **({} if of.plastic is None else {"plastic": of.plastic.to_dict()}),
        **({} if of.efficiency is None else {"mesh_efficiency": of.efficiency.to_dict()}),
        "nominal": of.nominal.to_dict(),
    }


def _required(of: StrengthRating) -> dict[str, Any]:
    """Return the required safeties: one of both gears, or in a pair with a gear of plastic that of each."""
    scuffing = {"scuffing": of.options.required_safety_scuffing}
    if of.plastic is not None:
        return _by_part(of, lambda each: each.required) | scuffing
    return {"flank": of.options.required_safety_flank, "root": of.options.required_safety_root} | scuffing


def _tolerances(of: StrengthRating) -> dict[str, Any]:
    """Return the tolerances of both gears; for a pair with allowances also the limits of its backlash."""
    backlash = None if isinstance(of.pair, RackPair) else of.pair.backlash_limits
    gears = _gears(of, PerGear(*(_tolerances_of(of, role) for role in Role)))
    return gears if backlash is None else gears | {"backlash_limits": backlash._asdict()}


def _tolerances_of(of: StrengthRating, role: Role) -> dict[str, Any] | None:
    """Return the flank tolerances of a gear and the tooth thickness limits under its allowance; None if it has neither."""
    if isinstance(of.pair, RackPair):
        limits = of.pair.pinion.thickness_limits if role is Role.PINION else None
    else:
        limits = of.pair.gears.pick(role).thickness_limits
    flanks = of.tolerances.pick(role)
    found = {} if flanks is None else flanks.to_dict(of.contact_ratio)
    if limits is not None:
        found["thickness_limits"] = limits.to_dict()
    return found or None


def _sources(of: StrengthRating, keys: tuple[str, ...]) -> dict[str, str]:
    """Clauses: of load factors those by which they were found."""
    found = {} if of.governing is None else of.governing.factors.sources
    limits = {
        "sigma_Hlim": of.limits.map(lambda each: each.contact_source),
        "sigma_Flim": of.limits.map(lambda each: each.root_source),
    }
    told_of = {key: "; ".join(dict.fromkeys(both)) for key, both in limits.items()}
    clauses = {**citations(of.options.standard), **told_of, **found}
    return {key: clauses.get(key, symbols.STRENGTH[key].source) for key in keys if key in symbols.STRENGTH}


def _plain(details: Mapping[str, Any]) -> dict[str, Any]:
    """Return details as JSON can hold them, with a word in place of infinite numbers."""
    return {key: _plain(value) if isinstance(value, Mapping) else told(value) for key, value in details.items()}


def _gears(of: StrengthRating, values: PerGear[Any]) -> dict[str, Any]:
    return {of.names.pick(role): value for role, value in values.items()}


def _by_part(of: StrengthRating, value: Callable[[PartStrength], Any]) -> dict[str, dict[str, Any]]:
    return {part.value: _gears(of, both.map(value)) for part, both in of.parts.items()}


def _by_symbol(of: StrengthRating, values: PerGear[Any]) -> dict[str, Any]:
    """Return the values of both gears by symbol, each under the gears' names; None for a gear without that symbol."""
    keys = dict.fromkeys(key for each in values for key in each)
    return {key: _gears(of, PerGear(*(each.get(key) for each in values))) for key in keys}


def _stresses(of: StrengthRating) -> JsonObject:
    found: dict[str, Any] = {
        "sigma_Hlim": _gears(of, of.limits.map(lambda each: each.contact)),
        "sigma_H0": of.nominal.flank.nominal_stress,
        "sigma_Flim": _gears(of, of.limits.map(lambda each: each.root)),
        "sigma_F0": _gears(of, of.nominal.roots.map(lambda root: root.nominal_stress)),
    }
    if (plastic := of.plastic) is not None:  # whose load is at the tip
        found["sigma_F0"] |= {of.names.pick(role): plastic.nominal_root_stresses.pick(role) for role in plastic.plastic_roles}
    for both in of.parts.values():
        found |= _by_symbol(of, both.map(lambda each: each.stresses()))
    return found


def _scuffing_safety(of: StrengthRating) -> dict[str, float | None]:
    found = of.scuffing
    return {
        "integral": None if found is None else found.integral_safety,
        "flash": None if found is None else found.flash_safety,
    }


def _governing(of: StrengthRating) -> dict[str, Any] | None:
    """Return the load of a spectrum, counted from 1, of which stresses and load factors are; None without a spectrum."""
    if not of.options.bins or of.governing is None:
        return None
    load = of.governing.load
    return {"load": of.governing_number, "torque": load.torque * of.halves, "speed": load.speed}


def _spectrum(of: StrengthRating) -> list[dict[str, Any]] | None:
    """Return each load of a spectrum: shares, its load factors, stresses of both gears."""
    if not of.options.bins:
        return None
    return [
        {
            "life_share": case.life_share,
            "cycle_share": case.cycle_share,
            "torque": case.load.torque,
            "speed": case.load.speed,
            **case.factors.to_dict(),
            **{f"sigma_{part.index}": _gears(of, case.stresses[part]) for part in RatedPart},
        }
        for case in of.cases
    ]
