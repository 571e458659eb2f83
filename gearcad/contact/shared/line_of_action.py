"""Line of action and the flanks that meet on it, in the transverse section: where they face each other, and the gap.

A position of the mesh is where the middle pair of teeth touches: its roll length on the pinion, in mm from T1. T1T2, and
along a ring's flank roll lengths and the radius of the base circle, are negative, and the same formulas hold.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from gearcad.core.records import Floats, PerGear
from gearcad.geometry import FlankForm, FlankModification, Gear, GearPair, Rack, RackPair, ReliefShape


def loaded_left(pair: GearPair, torque: float) -> GearPair:
    """Return the pair if a torque on its pinion loads the pinion's left flanks, else its mirror image."""
    return pair if torque > 0 else replace(pair, pinion=mirrored(pair.pinion), wheel=mirrored(pair.wheel))


@lru_cache(16)
def gears_loaded_left(pair: GearPair) -> PerGear[Gear]:
    """Return both gears of a pair whose pinion's left flanks carry. The pinion presses on flanks of a ring with y < 0, so a
    ring is mirrored.

    Then its teeth, too, follow each other the other way round than the pinion's, and its hand is the opposite one. The
    result is cached, because every position asks for it.
    """
    return PerGear(pair.pinion, mirrored(pair.wheel) if pair.internal else pair.wheel)


def mirrored(gear: Gear) -> Gear:
    """Return the mirror image in the plane x-z."""
    if gear.helix_angle:
        return replace(gear, helix_angle=-gear.helix_angle)
    if not gear.modification.helix_angle_modification:
        return gear
    # A spur gear has no hand of its own, so that of its modification turns over.
    change = replace(gear.modification, helix_angle_modification=-gear.modification.helix_angle_modification)
    return replace(gear, modification=change)


LEAST_LENGTH = 0.01
"""Least roll length (mm per mm of normal module) at which a flank still has a curvature to speak of."""

_ROUNDS = 6
_SETTLED = 1e-9
"""Newton steps for the turn (rad) of flanks that face each other, and the last one: the next would be its square."""

_POSITIONS = 13
"""Number of positions of one base pitch at which nearby pairs are counted."""

_SAMPLES = 1201
"""Places on a pair of flanks among which the nearest is sought: 5 µm apart on teeth of module 2, 0.001 µm of the gap."""


AS_PLACED = PerGear(0.0, 0.0)
"""Turns of gears that stand where the unloaded ones do."""


@dataclass(frozen=True)
class TransverseFlank:
    """A flank in the transverse section at the height `height` (mm) of its gear; places on it are roll lengths (mm)."""

    form: FlankForm
    height: float

    @property
    def base_radius(self) -> float:
        """Radius of the base circle (mm), of the sign of the roll lengths."""
        return math.copysign(self.form.base_radius, self.form.first)

    @property
    def first(self) -> float:
        """Roll length (mm) at which the involute begins."""
        return self.form.first

    @property
    def last(self) -> float:
        """Roll length (mm) at which the involute ends."""
        return self.form.last

    @property
    def even(self) -> tuple[float, float]:
        """Roll lengths (mm) where a parabolic root relief ends and a parabolic tip relief begins.

        Beyond them the curvature is another.
        """
        of = self.form.modification
        root, tip = (
            amount and form is ReliefShape.PARABOLIC
            for amount, form in ((of.root_relief, of.root_relief_shape), (of.tip_relief, of.tip_relief_shape))
        )
        return (
            self.first + of.root_relief_length if root else self.first,
            self.last - of.tip_relief_length if tip else self.last,
        )

    def depth(self, lengths: Floats) -> Floats:
        """Return the distance (mm) along the line of action of the flank behind the points of the involute at roll lengths.

        The point that is there now has moved along the flank with its turn. It comes from nearer to the root by as much as it
        lies behind.
        """
        return self.form.depth(lengths - self.form.depth(lengths, self.height), self.height)

    def along_tangent(self, contact: Any, length: float) -> Any:
        """Return the place (mm) along the common tangent of the flank's point at roll length `length`, if it touches at
        `contact` (mm).

        The place is a scalar or an array, as `contact` is.
        """
        turn = (length - contact) / self.base_radius
        return self.base_radius * np.cos(turn) + length * np.sin(turn) - self.base_radius

    def facing(self, contact: float | Floats, place: Floats) -> tuple[Floats, Floats]:
        """Return the roll lengths at places along the tangent (towards the tip), and how far the flank lies behind the tangent
        (mm).
        """
        base = self.base_radius
        turn = (np.copysign(np.sqrt(np.maximum(contact**2 + 2 * base * place, 1e-12)), base) - contact) / base
        for _ in range(_ROUNDS):
            cosine, length = np.cos(turn), contact + base * turn
            step = (base * cosine + length * np.sin(turn) - base - place) / (length * cosine)
            turn = turn - step
            if np.abs(step).max() < _SETTLED:
                break
        length = contact + base * turn
        return length, contact - (length * np.cos(turn) - base * np.sin(turn))

    def turned(self, away: Any) -> Any:
        """Return the angle (rad) by which the flank's normals turn over a distance (mm) of roll, a scalar or an array."""
        return away / self.base_radius

    def turn_of(self, slid: float, contact: float) -> float:
        """Return the turn (mm along the line of action) that slides a flank so far (mm) towards its tip where it touches."""
        return slid * self.base_radius / contact

    def arms(self, place: Floats, along: Floats, slope: Floats) -> Floats:
        """Return the lever arms, over the base radius, of forces tilted by `slope` (rad).

        They act on points at `place` (mm) along the tangent and `along` (mm) the line of action.
        """
        arms: Floats = ((self.base_radius + place) * np.cos(slope) - along * np.sin(slope)) / self.base_radius
        return arms


@dataclass(frozen=True)
class StraightFlank(TransverseFlank):
    """A straight flank of a rack in the transverse section: the limit of a wheel's as its number of teeth grows.

    Places on it are heights over the reference line over sin alpha_t (mm): so they grow as evenly along the line of action as
    roll lengths do, but from the reference line on. `slope` is tan alpha_t.
    """

    slope: float

    @classmethod
    def of(cls, rack: Rack, height: float) -> StraightFlank:
        """Return the flanks of a rack at a height (mm) over its face width."""
        angle = math.radians(rack.transverse_pressure_angle)
        first, last = -rack.profile.form_depth / math.sin(angle), rack.profile.tip_form_height / math.sin(angle)
        hand = -1 if rack.helix_angle < 0 else 1
        form = FlankForm(FlankModification(), first, last, rack.face_width, math.inf, hand, rack.normal_module)
        return cls(form, height, math.tan(angle))

    def depth(self, lengths: Floats) -> Floats:
        """Return zeros: flanks of a rack are not modified."""
        return np.zeros_like(lengths)

    def along_tangent(self, contact: Any, length: float) -> Any:
        return (length - contact) * self.slope

    def facing(self, contact: float | Floats, place: Floats) -> tuple[Floats, Floats]:
        return contact + place / self.slope, np.zeros_like(place)

    def turned(self, away: Any) -> Any:
        return 0.0 * away

    def turn_of(self, slid: float, contact: float) -> float:
        return slid / self.slope

    def arms(self, place: Floats, along: Floats, slope: Floats) -> Floats:
        # The part of the force along the pitch line, over that of a normal force.
        arms: Floats = np.cos(slope) - self.slope * np.sin(slope)
        return arms


@dataclass(frozen=True, eq=False)
class LineOfAction:
    """The line of action of a pair: its length T1T2 and the base pitch (mm), and both flanks.

    A line equals itself only: what is known of one is found without looking at all that it is made of.
    `proud` (mm) is how much further than the others the flanks of the middle pair stand out.
    """

    whole: float
    pitch: float
    flanks: PerGear[TransverseFlank]
    module: float
    proud: float = 0.0

    @cached_property
    def exact(self) -> bool:
        """True if all flanks are exact involutes in their places."""
        return not (self.proud or any(flank.form.modification.present for flank in self.flanks))

    def lengths(self, pinion_length: float, turns: PerGear[float] = AS_PLACED) -> PerGear[float]:
        """Return the roll lengths of both flanks (mm) on the line of action, which touch at `pinion_length` (mm from T1).

        By `turns` (mm along the line of action) both gears have turned on, each by itself.
        """
        return PerGear(pinion_length + turns.pinion, self.whole - pinion_length - turns.wheel)

    def radius(self, length: float) -> float:
        """Return the reduced radius of curvature (mm) of both involutes where they touch at a roll length (mm) of either."""
        return length * (self.whole - length) / self.whole

    def bulge(self, pinion_length: float, place: float) -> float:
        """Return the gap (mm) between two involutes that touch at `pinion_length`, at a place along the tangent (mm)."""
        return place**2 * self.whole / 2 / pinion_length / (self.whole - pinion_length)

    def curved(self, pinion_length: float) -> bool:
        """Return whether both flanks have a curvature to speak of where they touch at `pinion_length` (mm from T1)."""
        rest = math.copysign(1.0, self.flanks.wheel.base_radius) * (self.whole - pinion_length)
        return min(pinion_length, rest) > LEAST_LENGTH * self.module

    def taken_back(self, tooth: int, lengths: PerGear[Floats]) -> Floats:
        """Return the gap (mm) that modifications and pitch errors add between the flanks of a pair of teeth at roll lengths."""
        if self.exact:
            return np.zeros_like(lengths.pinion)
        pinion, wheel = (flank.depth(each) for flank, each in zip(self.flanks, lengths, strict=True))
        depth = pinion + wheel
        return depth - self.proud if tooth == 0 else depth


@dataclass(frozen=True, eq=False)
class RackLine(LineOfAction):
    """The line of action of a pinion and a rack, whose flanks are straight: `whole` is where the places of both add up to."""

    def radius(self, length: float) -> float:
        return length

    def bulge(self, pinion_length: float, place: float) -> float:
        return place**2 / 2 / pinion_length

    def curved(self, pinion_length: float) -> bool:
        return pinion_length > LEAST_LENGTH * self.module


def _rack_line(pair: RackPair, pitch_error: float) -> RackLine:
    """Return the line of action of a pinion and a rack in the section through the middle of both faces."""
    pinion, sine = pair.pinion, math.sin(math.radians(pair.working_transverse_pressure_angle))
    flanks = PerGear(
        TransverseFlank(pinion.flank_form, pinion.face_width / 2), StraightFlank.of(pair.rack, pair.rack.face_width / 2)
    )
    whole = pair.path_of_contact.C + pair.pitch_line_height / sine
    return RackLine(whole, pinion.transverse_base_pitch, flanks, pinion.normal_module, pitch_error / 1000)


@lru_cache(16)
def line_of_action(pair: GearPair | RackPair, pitch_error: float = 0.0) -> LineOfAction:
    """Return the line of action of a pair in the transverse section through the middle of its common face width; left flanks of
    the pinion carry.

    `pitch_error` (µm) is how far the flanks of the middle pair of teeth stand proud, both together.
    """
    if isinstance(pair, RackPair):
        return _rack_line(pair, pitch_error)
    middle = pair.common_width.offset
    forms = gears_loaded_left(pair).map(lambda gear: gear.flank_form)
    pinion = TransverseFlank(forms.pinion, pair.pinion.face_width / 2 + middle)
    wheel = TransverseFlank(forms.wheel, pair.wheel.face_width / 2 + middle - pair.axial_offset)
    pitch, module = pair.pinion.transverse_base_pitch, pair.pinion.normal_module
    return LineOfAction(pair.base_tangent.length, pitch, PerGear(pinion, wheel), module, pitch_error / 1000)


def rigid_approach(line: LineOfAction, pinion_length: float, *, single: bool = False) -> float:
    """Return the approach (mm) of rigid gears along the line of action until the first pair of teeth touches.

    It counts from where exact involutes touch. The middle pair touches at `pinion_length` (mm from T1); `single` lets no other
    pair touch. It is the transmission error of an unloaded pair, negative where teeth stand proud.
    """
    if line.exact:
        return 0.0
    return min((gap for tooth, (gap, _) in facing_pairs(line, pinion_length).items() if not (single and tooth)), default=0.0)


def facing_teeth(line: LineOfAction) -> range:
    """Return every pair of teeth whose flanks can face each other."""
    reach = math.ceil(sum(max(flank.last, -flank.first) for flank in line.flanks) / line.pitch)
    return range(-reach, reach + 1)


def pairs_within(line: LineOfAction, pinion_length: float, gap: float) -> int:
    """Return the most pairs of teeth whose flanks come as near as a gap (mm) at once, over one base pitch.

    The middle pair touches about `pinion_length` (mm from T1).
    """
    found = 0
    for length in (pinion_length + line.pitch * np.linspace(-0.5, 0.5, _POSITIONS)).tolist():
        found = max(found, sum(near <= gap for near, _ in facing_pairs(line, length).values()))
    return found


@lru_cache(1024)
def facing_pairs(line: LineOfAction, pinion_length: float) -> dict[int, tuple[float, float]]:
    """`nearest` of every pair of teeth whose flanks face each other as the middle pair touches at `pinion_length` (mm from T1).

    Known for the last positions: every torque and every step of its solution asks for it again.
    """
    found = ((tooth, nearest(line, tooth, pinion_length + tooth * line.pitch)) for tooth in facing_teeth(line))
    return {tooth: near for tooth, near in found if near is not None}


def overlap(line: LineOfAction, pinion_length: float, turns: PerGear[float] = AS_PLACED) -> tuple[float, float]:
    """Return the range along the tangent (mm) in which two flanks face each other. The range is empty if its first end is not
    below the second.
    """
    touching, tips = line.lengths(pinion_length, turns), tip_places(line, pinion_length, turns)
    one, other = line.flanks
    if not line.curved(touching.pinion):
        return 0.0, 0.0
    return (
        max(one.along_tangent(touching.pinion, one.first), tips.wheel),
        min(tips.pinion, -other.along_tangent(touching.wheel, other.first)),
    )


def tip_places(line: LineOfAction, pinion_length: float, turns: PerGear[float] = AS_PLACED) -> PerGear[float]:
    """Return the places of both gears' tips along the tangent (mm), towards the pinion's."""
    touching, (one, other) = line.lengths(pinion_length, turns), line.flanks
    pinion, wheel = one.along_tangent(touching.pinion, one.last), other.along_tangent(touching.wheel, other.last)
    return PerGear(float(pinion), -float(wheel))


def nearest(line: LineOfAction, tooth: int, pinion_length: float) -> tuple[float, float] | None:
    """Return the least gap (mm) between the flanks of a pair of teeth, and its place along the tangent; None if they do not
    face.
    """
    low, high = overlap(line, pinion_length)
    if low >= high:
        return None
    if line.exact:
        place = min(max(0.0, low), high)
        return line.bulge(pinion_length, place), place
    places = np.linspace(low, high, _SAMPLES)
    _, gap = facing_gap(line, tooth, pinion_length, places)
    # The top of a parabola between the samples: else contact would jump from one to the next as gears roll.
    least = min(max(int(gap.argmin()), 1), _SAMPLES - 2)
    before, at, after = gap[least - 1 : least + 2]
    bend = before - 2 * at + after
    aside = float(np.clip((before - after) / (2 * bend), -1, 1)) if bend > 0 else 0.0
    return float(at - (before - after) * aside / 2 + bend * aside**2 / 2), float(
        places[least] + aside * (places[1] - places[0])
    )


def facing_gap(
    line: LineOfAction, tooth: int, pinion_length: float, place: Floats, turns: PerGear[float] = AS_PLACED
) -> tuple[PerGear[Floats], Floats]:
    """Return the roll lengths (n,) of both flanks that face each other at places along the tangent, and the gap between them
    (mm), less the `turns` of both gears.
    """
    touching = line.lengths(pinion_length, turns)
    (lengths, behind), (wheel_lengths, wheel_behind) = (
        flank.facing(length, sense * place) for flank, length, sense in zip(line.flanks, touching, (1, -1), strict=True)
    )
    facing = PerGear(lengths, wheel_lengths)
    return facing, behind + wheel_behind + line.taken_back(tooth, facing)
