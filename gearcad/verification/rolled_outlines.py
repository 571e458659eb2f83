"""Outlines of two gears, or a gear and a rack, that roll on each other: backlash, contact ratio and interference.

Nothing here knows that a flank is an involute: outlines touch where their points meet first.
Lengths in mm, angles in radians, points of a section are complex numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.core.records import Floats
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.curves import parameters_within
from gearcad.geometry.rack import RackProfile
from gearcad.verification.outline_gauges import fine_chord, half_outline
from gearcad.verification.tool_teeth import Complexes, peaks_of

_POSITIONS = 8
"""Positions over a pitch at which whole outlines are held together."""

_FAR = 1e9
"""Clearance (rad or mm) of what is beyond a flank."""

_NEAR = 12
"""Positions beside an end of the contact within which it is looked for."""

_NARROWER = 0.3
"""Factor on the width of a parabola from one to the next: it is skew beside a base circle."""

_TURNS = 501
"""Positions of the pinion at which an end of a flank is looked at."""

_BEYOND = 0.3
_TOUCH = 1e-6
"""Shares of a flank by which it is taken to go on beyond its ends, and by which a contact may be beyond an end."""


@dataclass(frozen=True)
class ToothOutline:
    """Half a tooth of a gear or a rack as a chart: how wide the tooth is at each radius of a gear, or height of a rack.

    `reach` (n,) rises with the radius (mm) or height (mm); `half` (n,) is half the tooth's angle (rad) or its half thickness
    (mm) there; `flank` are the first and last index of the flank between root and tip. `pitch` is that of the teeth (rad or
    mm), `scale` the length (mm) of one unit of `half` on the working circle.
    """

    reach: Floats
    half: Floats
    flank: tuple[int, int]
    pitch: float
    scale: float

    @classmethod
    def of_gear(cls, gear: Gear, working: float) -> ToothOutline:
        """Return the chart of a gear with a working radius (mm)."""
        profile, points = gear.profile, half_outline(gear, fine_chord(gear.normal_module))
        radii, angles = np.abs(points), np.angle(points)
        ends = sorted((profile.form_diameter / 2, profile.tip_form_diameter / 2))
        return cls._of(radii, angles, (ends[0], ends[1]), 2 * math.pi / gear.tooth_count, working)

    @classmethod
    def of_rack(cls, profile: RackProfile, chord_error: float) -> ToothOutline:
        """Return the chart of a rack."""
        points = rack_points(profile, chord_error)
        ends = (-profile.form_depth, profile.tip_form_height)
        return cls._of(points.imag, -points.real, ends, profile.pitch, 1.0)

    @classmethod
    def _of(cls, reach: Floats, half: Floats, ends: tuple[float, float], pitch: float, scale: float) -> ToothOutline:
        # Inside the lands, which have one radius, there is nothing to touch.
        steps = np.abs(np.diff(reach)) > 1e-12 * np.abs(reach).max()
        kept = np.r_[False, steps] | np.r_[steps, False]
        reach, half = reach[kept], half[kept]
        if reach[0] > reach[-1]:
            reach, half = reach[::-1], half[::-1]
        slack = 1e-9 * np.abs(reach).max()
        first, last = int(np.searchsorted(reach, ends[0] - slack)), int(np.searchsorted(reach, ends[1] + slack)) - 1
        return cls(reach, half, (first, last), pitch, scale)

    @cached_property
    def flank_at(self) -> Callable[[Floats], Floats]:
        """Smooth function of the radius or height that gives half the tooth on its flank and beyond both ends."""
        from scipy.interpolate import CubicSpline

        part = slice(self.flank[0], self.flank[1] + 1)
        spline: Any = CubicSpline(self.reach[part], self.half[part])
        return lambda reach: np.asarray(spline(reach), float)

    @property
    def flank_points(self) -> tuple[Floats, Floats]:
        """Radii or heights of the flank's points, and half the tooth there."""
        part = slice(self.flank[0], self.flank[1] + 1)
        return self.reach[part], self.half[part]


def rack_points(profile: RackProfile, chord_error: float) -> Complexes:
    """Return points (n,) of the left half of a rack's tooth, root to tip, along the rack and upwards."""
    pieces = [curve.points(_at_least(parameters_within(curve, chord_error))) for curve in profile.curves]
    points = np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])
    result: Complexes = points[:, 0] + 1j * points[:, 1]
    return result


def _at_least(share: Floats, count: int = 1000) -> Floats:
    """Return parameters of a curve, which are many on a straight line too."""
    return share if len(share) > count else np.linspace(0.0, 1.0, count)


@dataclass(frozen=True)
class RolledPair:
    """Outlines of a pinion and its mate that roll: a gear at `distance` (mm, negative for a ring) or a rack.

    `ratio` is how far the mate turns (rad), or moves (mm), for one rad of the pinion; `start` the place of its tooth 0 (rad
    or mm) where a space of it faces the pinion's tooth 0.
    """

    pinion: ToothOutline
    mate: ToothOutline
    distance: float
    ratio: float
    start: float
    rack: bool

    @classmethod
    def of(cls, pair: GearPair | RackPair, distance: float | None = None) -> RolledPair:
        """Return the outlines of a pair, at its own centre distance or another (mm)."""
        if isinstance(pair, RackPair):
            working = pair.pinion.teeth * pair.pinion.transverse_module / 2
            mate = ToothOutline.of_rack(pair.rack.profile, fine_chord(pair.pinion.normal_module))
            own = ToothOutline.of_gear(pair.pinion, working)
            return cls(own, mate, distance or pair.mounting_distance, working, mate.pitch / 2, True)
        distance = distance or pair.centre_distance
        one, two = pair.pinion.teeth, pair.wheel.teeth
        radii = [abs(distance * each / (one + two)) for each in (one, two)]
        own, mate = (ToothOutline.of_gear(gear, radius) for gear, radius in zip(pair.gears, radii, strict=True))
        start = math.pi / abs(two) + (math.pi if two > 0 else 0.0)
        return cls(own, mate, distance, -one / two, start, False)

    def in_mate(self, points: Complexes, turn: Floats) -> tuple[Floats, Floats]:
        """Return points of the pinion (its tooth 0 on the real axis) as the mate has them when the pinion has turned by `turn`.

        Radius or height, and angle or place from the middle of the mate's tooth 0.
        """
        placed = points * np.exp(1j * turn)
        if self.rack:
            return self.distance - placed.real, placed.imag - self.ratio * turn - self.start
        seen = placed - self.distance
        return np.abs(seen), np.angle(seen * np.exp(-1j * (self.start + self.ratio * turn)))

    def in_pinion(self, reach: float, place: float, turn: Floats) -> tuple[Floats, Floats]:
        """Return a point of the mate, at a radius or height, and an angle or length `place` from the middle of its tooth 0.

        The pinion, turned by `turn` (n,), has it at radii (mm) and angles (rad) from the middle of its tooth 0.
        """
        if self.rack:
            placed = self.distance - reach + 1j * (place + self.start + self.ratio * turn)
        else:
            placed = self.distance + reach * np.exp(1j * (place + self.start + self.ratio * turn))
        return np.abs(placed), np.angle(placed * np.exp(-1j * turn))

    # ------------------------------------------------------------------ backlash

    def gaps(self, turn: float) -> Floats:
        """Return how far (2,) in mm the mate can turn, ahead of its teeth and behind them, until outlines touch.

        Lengths are those at its working circle.

        The pinion has turned by `turn`. Negative where the outlines overlap.
        """
        own, mate = self.pinion, self.mate
        near = own.pitch * np.arange(-self._near, self._near + 1)
        points = own.reach * np.exp(1j * (np.stack([own.half, -own.half])[:, None, :] + near[None, :, None]))
        level, place = self.in_mate(points.ravel(), np.array(turn))
        inside = (level >= mate.reach[0]) & (level <= mate.reach[-1])
        level, place = level[inside], place[inside]
        place = place - mate.pitch * np.rint(place / mate.pitch)
        clear = np.abs(place) - np.interp(level, mate.reach, mate.half)
        sides = [clear[side] for side in (place > 0, place < 0)]
        return np.array([float(side.min()) * mate.scale if len(side) else math.inf for side in sides])

    @property
    def _near(self) -> int:
        """Number of teeth on each side of the line of centres that could touch."""
        return int(min(math.ceil(math.pi / self.pinion.pitch) - 1, 6))

    def gaps_over_roll(self, positions: int = _POSITIONS) -> Floats:
        """Return the gaps (positions, 2) in mm of the whole outlines at positions over a pitch of the pinion."""
        turns = self.pinion.pitch * (np.arange(positions) + 0.5) / positions
        return np.array([self.gaps(float(turn)) for turn in turns])

    @cached_property
    def _run(self) -> tuple[Floats, Floats] | None:
        """Turns (n,) of the pinion (rad), root first, while the flanks of its tooth 0 and the mate's touch between their ends.

        And the gaps (n, 2) in mm between these flanks, ahead of the mate's teeth and behind them. None if they never touch.
        """
        turns = self._turns
        gaps, places = self._flank_gaps(turns, 1)
        inside = np.flatnonzero(places > 0)
        if not len(inside):
            return None
        runs = np.split(inside, 1 + np.flatnonzero(np.diff(inside) > 1))
        longest = max(runs, key=len)
        if places[longest[0]] > places[longest[-1]]:
            longest = longest[::-1]
        other, _ = self._flank_gaps(-turns[longest], -1)
        return turns[longest], np.stack([other, gaps[longest]], -1)

    @cached_property
    def _turns(self) -> Floats:
        """Turns of the pinion (rad) at which tooth 0 is looked at."""
        return np.linspace(-1.0, 1.0, _TURNS) * min(4.0 * self.pinion.pitch, math.pi / 2)

    @property
    def flank_gaps(self) -> Floats | None:
        """Gaps (n, 2) in mm at the working circle between flanks, ahead and behind, as they roll; None if they never meet."""
        return None if self._run is None else self._run[1]

    @property
    def _side(self) -> int:
        """Side of the pinion's tooth 0 that the mate's tooth 0 touches, which is behind the mate's tooth: 1 is the left one."""
        return 1 if self.rack or self.distance < 0 else -1

    def _flank_gaps(self, turns: Floats, side: int) -> tuple[Floats, NDArray[np.int_]]:
        """Return gaps (n,) in mm between flanks of tooth 0 and the mate's, and which of the pinion's points is nearest.

        `side` is 1 for the flanks behind the mate's tooth 0, -1 for those ahead of the tooth before it. The point's number is 0
        where an end of either flank is nearest.
        """
        reach, half = self.pinion.flank_points
        level, place = self.in_mate(reach * np.exp(1j * side * self._side * half), turns[:, None])
        first, last = (self.mate.reach[each] for each in self.mate.flank)
        if side < 0:
            place = -(place + self.mate.pitch)
        if not self.rack:
            place = place - 2 * math.pi * np.rint(place / (2 * math.pi))
        inside = (level >= first) & (level <= last)
        clear = np.where(inside, -place - self.mate.flank_at(np.clip(level, first, last)), np.inf)
        rows, nearest = np.arange(len(turns)), clear.argmin(axis=1)
        gaps = -peaks_of(-clear.T) * self.mate.scale
        between = (nearest > 0) & (nearest < len(reach) - 1)
        around = inside[rows, np.maximum(nearest - 1, 0)] & inside[rows, np.minimum(nearest + 1, len(reach) - 1)]
        return gaps, np.where(between & around, nearest, 0)

    def normal_share(self, twist: float) -> float:
        """Return how far flanks part along their normal (mm) for 1 mm at the working circle, by the mate's outline.

        `twist` of the mate's teeth along z is in its units of angle or place per mm.
        """
        middle = (self.mate.flank[0] + self.mate.flank[1]) // 2
        level, half = (values[middle - 3 : middle + 4 : 6] for values in (self.mate.reach, self.mate.half))
        arm = 1.0 if self.rack else float(level.mean())
        up, along = float(np.diff(level)[0]), arm * float(np.diff(half)[0])
        across = arm * up / math.hypot(up, along)  # movement along the normal for one unit of turn or travel
        return abs(across) / math.hypot(1.0, across * twist) / self.mate.scale

    # ------------------------------------------------------------------ contact ratio

    def contact_ratios(self) -> tuple[float | None, float]:
        """Return the contact ratio between the tips, and the usable one; the first is None if a tip finds no flank to touch.

        Contact begins and ends where an end of one flank comes nearest to the other while the teeth roll. The tips decide,
        and the root of a flank where the mate's tip has passed it.
        """
        if self._run is None:
            return None, 0.0
        turns, gaps = self._run
        shift = -float(gaps[:, 1].min()) / self.mate.scale
        forward = math.copysign(1.0, turns[-1] - turns[0])
        begin = [self._contact(turns[0], shift, True, -1), self._contact(turns[0], shift, False, 0)]
        end = [self._contact(turns[-1], shift, False, -1), self._contact(turns[-1], shift, True, 0)]
        first = max((forward * turn for turn in begin if turn is not None), default=math.nan)
        last = min((forward * turn for turn in end if turn is not None), default=math.nan)
        by_tips = begin[0] is not None and forward * begin[0] == first and end[0] is not None and forward * end[0] == last
        ratio = (last - first) / self.pinion.pitch
        if ratio <= 0:  # shorter than the steps
            return None, math.nan
        return (ratio if by_tips else None), ratio

    def _contact(self, near: float, shift: float, of_mate: bool, tip: int) -> float | None:
        """Return the turn of the pinion (rad), near another, at which an end of a flank touches its mate's, or None.

        `tip` is -1 for the tip and 0 for the root. The mate's tooth 0, moved by `shift` until it touches, meets tooth 0 of
        the pinion.
        """
        own, other = (self.mate, self.pinion) if of_mate else (self.pinion, self.mate)
        side, ring = self._side, of_mate and self.distance < 0 and not self.rack
        at = own.flank[0 if bool(tip) == ring else 1]
        reach, half = float(own.reach[at]), float(own.half[at])
        first, last = (float(other.reach[each]) for each in other.flank)
        margin = _BEYOND * (last - first)

        def seen(turn: Floats) -> tuple[Floats, Floats]:
            if of_mate:
                level, place = self.in_pinion(reach, shift - half, turn)
                return level, side * place
            level, place = self.in_mate(np.array(reach * np.exp(1j * side * half)), turn)
            return level, shift - place

        def clearance(turn: Floats) -> Floats:
            level, place = seen(turn)
            there = (level > first - margin) & (level < last + margin)
            return np.where(there, place - other.flank_at(np.clip(level, first - margin, last + margin)), _FAR)

        step = float(self._turns[1] - self._turns[0])
        turn = _lowest(clearance, near - _NEAR * step, near + _NEAR * step)
        if turn is None:
            return None
        level, slack = float(seen(np.array([turn]))[0][0]), _TOUCH * (last - first)
        return turn if first - slack <= level <= last + slack else None


def _lowest(function: Callable[[Floats], Floats], low: float, high: float) -> float | None:
    """Return where between two places a smooth function touches zero from above; None if it has no minimum between them."""
    places = np.linspace(low, high, 193)
    values = function(places)
    minima = 1 + np.flatnonzero((values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:]) & (values[1:-1] < _FAR))
    if not len(minima):
        return None
    best = minima[np.abs(values[minima]).argmin()]  # beyond the ends of a flank it may be cut
    step = (places[1] - places[0]) / 2
    middle = float(places[best])
    for _ in range(3):
        before, here, after = function(middle + step * np.array([-1.0, 0.0, 1.0]))
        bend = before - 2 * here + after
        if bend <= 0 or after >= _FAR or before >= _FAR:
            return middle
        middle -= float(np.clip((after - before) / (2 * bend), -2.0, 2.0)) * step
        step *= _NARROWER
    return middle
