"""Gears whose bodies look the same after every tooth: without keyways and bolt holes."""

from __future__ import annotations

import math
from dataclasses import replace

from gearcad.geometry import Gear, GearPair
from gearcad.planetary import PlanetaryTrain

__all__ = ["looks_alike_after", "plain_gear", "plain_pair", "plain_train"]


def looks_alike_after(gear: Gear) -> int:
    """Of how many equal parts a turn of the gear is: its teeth, fewer with bolt holes, one with a keyway."""
    body = gear.body
    return 1 if body.keyway_width else math.gcd(gear.tooth_count, body.bolt_holes)


def plain_gear(gear: Gear) -> Gear:
    """The gear without keyway and bolt holes."""
    plain = replace(gear.body, keyway=False, keyway_width=0.0, keyway_depth=0.0)
    return replace(gear, body=replace(plain, bolt_circle=0.0, bolt_holes=0, bolt_diameter=0.0))


def plain_pair(pair: GearPair) -> GearPair:
    """Both gears without them."""
    return replace(pair, pinion=plain_gear(pair.pinion), wheel=plain_gear(pair.wheel))


def plain_train(train: PlanetaryTrain) -> PlanetaryTrain:
    """All gears of a train without them."""
    return replace(
        train,
        centrals=tuple(replace(each, gear=plain_gear(each.gear)) for each in train.centrals),
        rims=tuple(replace(each, gear=plain_gear(each.gear)) for each in train.rims),
        stages=tuple(replace(each, pair=plain_pair(each.pair)) for each in train.stages),
    )
