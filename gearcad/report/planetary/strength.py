"""Whether a train holds, as tables: safeties of its gears in all meshes, load factors, temperatures."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.dynamics.planetary.strength import TrainStrength
from gearcad.plots.paper import short
from gearcad.rating.strength import StrengthRating
from gearcad.report.dynamics.tables import WordTable
from gearcad.report.planetary.sections import Section, Table, said

__all__ = ["section_of_strength"]

_NONE = "–"  # an en dash where there is no value
_LONGEST_LIFE = 1e6
"""Hours above which a life is told as more than that."""

_GEARS = ("gear", "mesh", "S_H", "S_F", "σ_H, MPa", "σ_HG, MPa", "σ_F, MPa", "σ_FG, MPa", "load cycles", "life, h")
_FACTORS = ("mesh", "K_A", "K_γ", "K_v", "K_Hβ", "K_Fβ", "K_Hα", "K_Fα")
_SCUFFING = ("mesh", "risk", "θ_int, °C", "θ_intS, °C", "S_int", "Θ_B, °C", "Θ_S, °C", "S_B")


def section_of_strength(strength: TrainStrength) -> Section:
    """Safeties, load factors, scuffing; what was assumed, and what was not judged."""
    factors = [(mesh, *_load_factors(each)) for mesh, each in strength.meshes.items() if each.load_factors is not None]
    scuffed = [(mesh, *_scuffing(each)) for mesh, each in strength.meshes.items() if each.scuffing is not None]
    tables = [Table("", grid=WordTable(_GEARS, list(_rows(strength)), 2), symbols=True)]
    if factors:
        tables.append(Table("Load factors", grid=WordTable(_FACTORS, factors), symbols=True))
    if scuffed:
        tables.append(Table("Scuffing", grid=WordTable(_SCUFFING, scuffed, 2), symbols=True))
    missing = tuple(said("not_judged", name, why) for name, why in strength.not_judged.items())
    words = tuple(filter(None, (said("strength_words", strength), *missing, said("strength_note", strength))))
    return Section("Strength", words=words, tables=tuple(tables) if strength.meshes else ())


def _rows(strength: TrainStrength) -> Iterator[tuple[str, ...]]:
    for name, gear in strength.members.items():
        for mesh, flank in gear.flank.items():
            root = gear.root[mesh]
            stresses = (flank.stress, flank.strength, root.stress, root.strength)
            known = [each.life for each in (flank, root) if each.life is not None]
            yield (
                name,
                mesh,
                *map(_text, (flank.safety, root.safety, *stresses, flank.cycles)),
                _hours(min(known, default=None)),
            )


def _load_factors(rating: StrengthRating) -> Iterator[str]:
    of = None if rating.governing is None else rating.governing.factors
    if of is not None:
        values = of.to_dict()
        names = ("K_A", "K_gamma", "K_v", "K_Hbeta", "K_Fbeta", "K_Halpha", "K_Falpha")
        yield from (_text(values[name]) for name in names)


def _scuffing(rating: StrengthRating) -> Iterator[str]:
    found = rating.scuffing
    if found is None:
        return
    limits, integral, flash = found.limits, found.integral, found.flash
    yield _NONE if found.risk is None else found.risk.value
    yield from map(_text, (None if integral is None else float(integral.value), None if limits is None else limits.integral))
    yield _text(found.integral_safety)
    yield from map(
        _text, (None if flash is None else flash.value, None if limits is None else limits.flash, found.flash_safety)
    )


def _text(value: float | None) -> str:
    return _NONE if value is None else short(value)


def _hours(value: float | None) -> str:
    if value is None or math.isinf(value):
        return _NONE if value is None else "infinite"
    return f"> {_LONGEST_LIFE:.0e}".replace("e+0", "e") if value > _LONGEST_LIFE else short(value)
