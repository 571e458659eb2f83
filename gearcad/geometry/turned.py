"""The flanks of a gear as smooth curves, each with the roll lengths whose depth of modification turns it about the axis."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.geometry.curves import Curve, CurveKind, Fillet, Involute, Land
from gearcad.geometry.gear import Gear
from gearcad.geometry.modification import FlankForm
from gearcad.geometry.profile import LEAST_LAND

__all__ = ["FlankCurve", "TurnedCurve", "flank_curves", "middle_section"]


_HEIGHTS = 65
"""Places over the face width at which the width of the root land is looked at."""

_STEP = 1e-5
"""Step of a curve's parameter over which its speed is taken."""


_NOTHING = 1e-9
"""Length (mm) of a curve that is but a point."""


@dataclass(frozen=True)
class FlankCurve:
    """A smooth piece of half a tooth's side, root to tip. Its end s = 0 is turned as the flank at roll length `first` (mm),
    s = 1 as at `last`, in proportion between them.

    `fading`: of that turn there is nothing at s = 0, and all of it, with no corner, at s = 1.
    """

    curve: Curve
    first: float
    last: float
    fading: bool = False

    def lengths(self, s: Floats) -> Floats:
        """Roll lengths (mm) whose depth turns the points at s."""
        return self.first + s * (self.last - self.first)

    def turn(self, form: FlankForm, s: ArrayLike, z: ArrayLike, *, left: bool) -> Floats:
        """Angle (rad) by which the point at s is turned at height z (mm); s and z broadcast."""
        s = np.asarray(s, float)
        turn = form.turn(self.lengths(s), z, left=left)
        return turn * s**2 * (3 - 2 * s) if self.fading else turn


def flank_curves(gear: Gear) -> list[FlankCurve]:
    """Fillet, involute and tip chamfer; the involute of a modified gear in the pieces on which the depth is smooth.

    Fillet and chamfer turn with the end of the involute that they join; sharp corners of a form root have no fillet. Fillets
    that meet in the middle of the space, or would after turning, do not turn at the root circle.
    """
    form, found = gear.flank_form, list[FlankCurve]()
    for curve in gear.profile.curves:
        if isinstance(curve, Fillet):
            if _is_point(curve):
                continue
            found.append(FlankCurve(curve, form.first, form.first, gear.modification.present and not _root_land_stays(gear)))
        elif curve.kind is CurveKind.CHAMFER:
            found.append(FlankCurve(curve, form.last, form.last))
        elif isinstance(curve, Involute):
            breaks = form.roll_breaks if gear.modification.present else ()
            lengths = [form.first, *breaks, form.last]
            rolls = [curve.first, *(abs(length) / curve.base_radius for length in breaks), curve.last]
            pieces = [replace(curve, first=first, last=last) for first, last in pairwise(rolls)]
            found += [FlankCurve(piece, *ends) for piece, ends in zip(pieces, pairwise(lengths), strict=True)]
    return found


def _is_point(curve: Curve) -> bool:
    """Whether there is nothing of a curve, as of the fillet of a form root with sharp corners."""
    start, end = curve.points(np.array([0.0, 1.0]))
    return math.dist(start, end) < _NOTHING


def _root_land_stays(gear: Gear) -> bool:
    """True if there is some root land at every height when both fillets have turned."""
    land = gear.profile.curves[0]
    if land.kind is not CurveKind.ROOT:
        return False
    form = gear.flank_form
    z = np.union1d(np.linspace(0.0, gear.half_width, _HEIGHTS), form.height_breaks)
    right, left = (form.turn(form.first, z, left=side) for side in (False, True))
    width = 2 * (math.pi / gear.tooth_count - float(land.polar(1.0)[1])) + right - left
    return float(width.min()) * gear.profile.root_diameter / 2 >= LEAST_LAND


# ---------------------------------------------------------------------- the section at mid face width


def middle_section(gear: Gear) -> tuple[Curve, ...]:
    """Curves of half a tooth in the section at mid face width, not turned by the helix: `profile.curves`, as modified.

    There lead crowning, end relief, helix modification and twist are nothing, and so both flanks are alike.
    """
    if not gear.modification.on_profile:
        return gear.profile.curves
    flank = [TurnedCurve.of(gear, piece) for piece in flank_curves(gear)]
    lands = {curve.kind: curve for curve in gear.profile.curves if isinstance(curve, Land)}
    tip = replace(lands[CurveKind.TIP], first=float(flank[-1].polar(1.0)[1]))
    root = lands.get(CurveKind.ROOT)
    return (*([replace(root, last=float(flank[0].polar(0.0)[1]))] if root else []), *flank, tip)


@dataclass(frozen=True)
class TurnedCurve:
    """A curve whose points are turned: by (a + b s + c s^2) times s^2 (3 - 2 s) if it is fading; angles in radians."""

    curve: Curve
    turn: Polynomial

    @classmethod
    def of(cls, gear: Gear, piece: FlankCurve) -> TurnedCurve:
        """A piece of the left flank at mid face width. Over a piece the depth is a parabola, so three places give it."""
        s = np.array([0.0, 0.5, 1.0])
        at = gear.flank_form.turn(piece.lengths(s), gear.half_width / 2)
        slope = at[2] - at[0]
        bend = 2 * (at[0] - 2 * at[1] + at[2])
        turn = Polynomial([at[0], slope - bend, bend])
        return cls(piece.curve, turn * Polynomial([0, 0, 3, -2]) if piece.fading else turn)

    @property
    def kind(self) -> CurveKind:
        return self.curve.kind

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        radius, angle = self.curve.polar(s)
        return radius, angle + self.turn(np.asarray(s, float))

    def points(self, s: ArrayLike) -> Floats:
        radius, angle = self.polar(s)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)

    def direction(self, s: ArrayLike) -> Floats:
        """That of the curve, and a sideways step by what the turn grows."""
        s = np.asarray(s, float)
        heading, (radius, angle) = self.curve.direction(s), self.curve.polar(s)
        low, high = np.clip(s - _STEP, 0, 1), np.clip(s + _STEP, 0, 1)
        speed = np.hypot(*np.moveaxis(self.curve.points(high) - self.curve.points(low), -1, 0)) / (high - low)
        sideways = radius * self.turn.deriv()(s)
        across = angle + np.pi / 2 - heading  # from the heading to where a turn moves a point
        tilt: Floats = np.arctan2(sideways * np.sin(across), speed + sideways * np.cos(across))
        return heading + tilt + self.turn(s)
