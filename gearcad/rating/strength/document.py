"""What rate.json holds of a rating: values under their symbols, those of one gear under "pinion" and "wheel"."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from gearcad import symbols
from gearcad.geometry import RackPair
from gearcad.per_gear import PerGear, Role
from gearcad.rating.factors import citations
from gearcad.rating.strength.part import Part, PartStrength, told
from gearcad.rating.strength.rating import StrengthRating
from gearcad.rating.strength.root import Y_ST

__all__ = ["strength_document"]

_OF_ROOTS = ("Y_F", "Y_S", "Y_beta", "Y_B", "Y_DT")


def strength_document(of: StrengthRating) -> dict[str, Any]:
    """Everything of a rating but its kind and name; what is not known is null."""
    factors, stresses = _factors(of), _stresses(of)
    return {
        "standard": of.options.standard.value,
        **({} if of.own_names is None else {"gears": _gears(of, of.own_names)}),
        "load": asdict(of.load),
        "materials": _gears(of, of.materials.map(asdict)),
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
        "required": {
            "flank": of.options.required_safety_flank,
            "root": of.options.required_safety_root,
            "scuffing": of.options.required_safety_scuffing,
        },
        "not_judged": dict(of.not_judged),
        "strength": of.strength.value,
        "passed": of.passed,
        "notices": [notice.to_dict() for notice in of.notices],
        "warnings": list(of.warnings),
        "nominal": of.nominal.to_dict(),
    }


def _tolerances(of: StrengthRating) -> dict[str, Any]:
    """Of both gears; of a pair with allowances the limits of its backlash."""
    backlash = None if isinstance(of.pair, RackPair) else of.pair.backlash_limits
    gears = _gears(of, PerGear(*(_tolerances_of(of, role) for role in Role)))
    return gears if backlash is None else gears | {"backlash_limits": backlash._asdict()}


def _tolerances_of(of: StrengthRating, role: Role) -> dict[str, Any] | None:
    """Those of the flanks of a gear, and what an allowance leaves of its tooth thickness; None of a rack."""
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
    """As JSON has them, which knows no infinite numbers."""
    return {key: _plain(value) if isinstance(value, Mapping) else told(value) for key, value in details.items()}


def _gears(of: StrengthRating, values: PerGear[Any]) -> dict[str, Any]:
    return {of.names.pick(role): value for role, value in values.items()}


def _by_part(of: StrengthRating, value: Callable[[PartStrength], Any]) -> dict[str, dict[str, Any]]:
    return {part.value: _gears(of, both.map(value)) for part, both in of.parts.items()}


def _by_symbol(of: StrengthRating, values: PerGear[Any]) -> dict[str, Any]:
    """What both gears have under symbols, None of one that has it not, each under the gears' names."""
    keys = dict.fromkeys(key for each in values for key in each)
    return {key: _gears(of, PerGear(*(each.get(key) for each in values))) for key in keys}


def _factors(of: StrengthRating) -> dict[str, Any]:
    """Load factors, those of the contact stress, and of each gear those of root stress and of what it bears."""
    roots = of.nominal.roots.map(lambda root: root.to_dict())
    permissible = {part: both.map(lambda each: each.factors) for part, both in of.parts.items()}

    flank = of.nominal.flank.to_dict()
    flank.pop("sigma_H0")
    return {
        **({} if of.governing is None else of.governing.factors.to_dict()),
        **flank,
        **_by_symbol(of, permissible[Part.FLANK]),
        **_by_symbol(of, roots.map(lambda root: {key: root[key] for key in _OF_ROOTS})),
        "Y_ST": Y_ST,
        **_by_symbol(of, permissible[Part.ROOT]),
    }


def _stresses(of: StrengthRating) -> dict[str, Any]:
    found: dict[str, Any] = {
        "sigma_Hlim": _gears(of, of.limits.map(lambda each: each.contact)),
        "sigma_H0": of.nominal.flank.nominal_stress,
        "sigma_Flim": _gears(of, of.limits.map(lambda each: each.root)),
        "sigma_F0": _gears(of, of.nominal.roots.map(lambda root: root.nominal_stress)),
    }
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
    """The load of a spectrum, counted from 1, of which stresses and load factors are; None without a spectrum."""
    if not of.options.bins or of.governing is None:
        return None
    load = of.governing.load
    return {"load": of.governing_number, "torque": load.torque * of.halves, "speed": load.speed}


def _spectrum(of: StrengthRating) -> list[dict[str, Any]] | None:
    """Each load of a spectrum: shares, its load factors, stresses of both gears."""
    if not of.options.bins:
        return None
    return [
        {
            "life_share": case.life_share,
            "cycle_share": case.cycle_share,
            "torque": case.load.torque,
            "speed": case.load.speed,
            **case.factors.to_dict(),
            **{f"sigma_{part.index}": _gears(of, case.stresses[part]) for part in Part},
        }
        for case in of.cases
    ]
