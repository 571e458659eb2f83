"""The gears of a pair as contact looks at them: on both, the flank with y > 0 of a tooth on +x is the one that carries."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from gearcad.geometry import Gear, GearPair
from gearcad.per_gear import PerGear

__all__ = ["gears_loaded_left", "loaded_left", "mirrored"]


def loaded_left(pair: GearPair, torque: float) -> GearPair:
    """The pair if a torque on its pinion loads the pinion's left flanks, else its mirror image."""
    return pair if torque > 0 else replace(pair, pinion=mirrored(pair.pinion), wheel=mirrored(pair.wheel))


@lru_cache(16)
def gears_loaded_left(pair: GearPair) -> PerGear[Gear]:
    """Both gears of a pair whose pinion's left flanks carry: they press on a ring's with y < 0, so it is seen mirrored.

    Then its teeth, too, follow each other the other way round than the pinion's, and its hand is the opposite one. Known for
    the last pairs: every position asks for it again.
    """
    return PerGear(pair.pinion, mirrored(pair.wheel) if pair.internal else pair.wheel)


def mirrored(gear: Gear) -> Gear:
    """The mirror image in the plane x-z."""
    if gear.helix_angle:
        return replace(gear, helix_angle=-gear.helix_angle)
    if not gear.modification.helix_angle_modification:
        return gear
    # A spur gear has no hand of its own, so that of its modification turns over.
    change = replace(gear.modification, helix_angle_modification=-gear.modification.helix_angle_modification)
    return replace(gear, modification=change)
