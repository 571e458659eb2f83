"""Loops: scenes that turn as their teeth make them, until all looks as at first."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from gearcad.notice import Notice
from gearcad.solids.files.part import Part
from gearcad.solids.files.pictures.plain import looks_alike_after, plain_gear, plain_pair
from gearcad.solids.files.products import GearProduct, PairProduct
from gearcad.solids.files.rack_products import RackPairProduct

__all__ = [
    "FRAMES_PER_SECOND",
    "MOST_FRAMES",
    "QUICK",
    "Loop",
    "come_round",
    "frames_for",
    "gear_loop",
    "pair_loop",
    "rack_loop",
    "simpler",
]

FRAMES_PER_SECOND = 25

_SMOOTH, _SHORT = 24, 96
"""Frames a tooth pitch, and up to how many frames that is: a longer loop is quicker."""

QUICK, _QUICKEST = 4.0, 2.5
"""Frames a pitch of the gear whose teeth pass fastest, and the least: with 2 nobody sees which way it turns."""

MOST_FRAMES = 480
"""Of the longest loop."""

_SWING = 2.0
"""Pitches that a rack goes either way at the most; the pinion stays on the rack."""


@dataclass(frozen=True)
class Loop:
    """A motion: the `scene` at a share of it, 0 ... 1, in so many `frames` (the last one ends where the first begins).

    `pitches` pass on the gear whose teeth pass fastest. It `closes` where all then looks as at first.
    """

    scene: Callable[[float], Sequence[Part]]
    frames: int
    pitches: float
    closes: bool = True
    notices: tuple[Notice, ...] = ()

    @property
    def seconds(self) -> float:
        """How long it lasts."""
        return self.frames / FRAMES_PER_SECOND

    @property
    def turns(self) -> dict[str, float]:
        """Turns of each part over the loop, counter-clockwise positive."""
        begun, ended = self.scene(0.0), self.scene(1.0)
        return {one.name: (other.rotation - one.rotation) / 360 for one, other in zip(begun, ended, strict=True)}


def come_round(passed: Iterable[Fraction]) -> Fraction:
    """After how many times all that passes so much each time has passed whole numbers; at least one passes anything."""
    moving = [each for each in passed if each]
    return Fraction(math.lcm(*(each.denominator for each in moving)), math.gcd(*(each.numerator for each in moving)))


def frames_for(pitches: float) -> int | None:
    """Frames of a loop in which so many pitches pass; None where that is too long."""
    if pitches * _QUICKEST > MOST_FRAMES:
        return None
    wanted = min(_SMOOTH * pitches, max(_SHORT, min(QUICK * pitches, MOST_FRAMES)))
    return math.ceil(round(wanted, 6))  # pitches that are whole but for rounding


def gear_loop(product: GearProduct) -> Loop:
    """A gear about its axis: by one pitch, or as many as bring a keyway or bolt holes round."""
    gear = product.gear
    pitches = gear.tooth_count // looks_alike_after(gear)
    if (frames := frames_for(pitches)) is None:
        return simpler(gear_loop(replace(product, gear=plain_gear(gear))))
    return Loop(lambda share: product.scene(360 * share * pitches / gear.tooth_count), frames, pitches)


def pair_loop(product: PairProduct) -> Loop:
    """A pair by one pitch, or by as many as bring keyways and bolt holes round."""
    gears = list(product.pair.gears)
    pitches = int(come_round(Fraction(looks_alike_after(gear), gear.tooth_count) for gear in gears))
    if (frames := frames_for(pitches)) is None:
        return simpler(pair_loop(replace(product, pair=plain_pair(product.pair))))
    return Loop(lambda share: product.scene(360 * share * pitches / gears[0].tooth_count), frames, pitches)


def rack_loop(product: RackPairProduct) -> Loop:
    """A rack has ends: it goes forth and back from where it stands, and its pinion with it."""
    rack, pinion = product.pair.rack, product.pair.pinion
    pitches = min(_SWING, max(rack.length / rack.transverse_pitch / 2 - 1, 0.5))
    turn = 360 * pitches / pinion.tooth_count
    return Loop(lambda share: product.scene(turn * math.sin(math.tau * share)), _SHORT, 4 * pitches)


def simpler(loop: Loop) -> Loop:
    """A loop of gears without keyways and bolt holes, which says so."""
    text = f"keyways and bolt holes are left out: with them it would come round in more than {MOST_FRAMES} frames only"
    return replace(loop, notices=(Notice("features-left-out", text, where="turning"), *loop.notices))
