"""What pictures of a train call its parts, and in which colours they draw them."""

from __future__ import annotations

from collections.abc import Mapping

from gearcad.geometry import Gear
from gearcad.per_gear import Role
from gearcad.planetary import PairStage, PlanetaryTrain, Rim
from gearcad.planetary.power import PowerFlow
from gearcad.plots.paper import DARK, SERIES

__all__ = ["PLANETS", "colour_of", "placed_stages", "power_ways", "rim_words", "role_of", "role_words", "signed", "stage_gear"]

PLANETS = SERIES[3]
"""Colour of the planets."""

_ROUNDING = 1e-9
"""Of the greatest power: what is no power."""


def colour_of(train: PlanetaryTrain, name: str) -> str:
    """Colour of a member, of a rim, or of the shaft of a stage."""
    if name in train.members:
        return SERIES[train.members.index(name)]
    return PLANETS if any(rim.name == name for rim in train.rims) else DARK


def role_of(train: PlanetaryTrain, name: str) -> str:
    """What a member or shaft is to the train: "input", "output", "fixed", or nothing of these."""
    return {train.input: "input", train.output: "output", train.fixed: "fixed"}.get(name, "")


def power_ways(train: PlanetaryTrain, flow: PowerFlow | None) -> dict[str, str]:
    """Of members and shafts: "in" where power goes into the train, "out" where it leaves; by input and output if none flows."""
    powers = {} if flow is None else flow.powers
    least = _ROUNDING * max(map(abs, powers.values()), default=0.0)
    found = {name: "in" if power > 0 else "out" for name, power in powers.items() if abs(power) > least}
    return found or {train.input: "in", train.output: "out"}


def role_words(train: PlanetaryTrain, name: str, ways: Mapping[str, str]) -> str:
    """What it is to the train, and which way power goes there where that does not say it, such as "power in"."""
    role, way = role_of(train, name), ways.get(name, "")
    said = not way or role == f"{way}put"
    return ", ".join(each for each in (role, "" if said else f"power {way}") if each)


def rim_words(train: PlanetaryTrain, rim: Rim) -> str:
    """Such as "3 × planet"."""
    return f"{train.planets} × {rim.name}" if train.planets > 1 else rim.name


def signed(gear: Gear) -> str:
    """Its number of teeth as formulas have it, with a minus for a ring."""
    return f"z = {gear.teeth}".replace("-", "−")


def stage_gear(stage: PairStage, role: Role) -> str:
    """Name of a gear of a stage, or what it is of the stage where both gears are called alike."""
    names = stage.pair.gears.map(lambda gear: gear.name)
    return names.pick(role) if names.pinion != names.wheel else f"{stage.name}, {role.value}"


def placed_stages(train: PlanetaryTrain) -> list[tuple[PairStage, str, str]]:
    """Stages from the set outwards, each with the shaft towards the set, and with the one that it adds."""
    known, waiting, found = set(train.members), list(train.stages), []
    while waiting:
        near = next((each for each in waiting if {each.pinion, each.wheel} & known), waiting[0])
        waiting.remove(near)
        inner, outer = (near.pinion, near.wheel) if near.pinion in known else (near.wheel, near.pinion)
        found.append((near, inner, outer))
        known |= {inner, outer}
    return found
