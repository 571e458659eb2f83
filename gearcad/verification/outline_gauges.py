"""Gauges on the outlines of teeth: base tangent lengths, and dimensions over balls and pins, from the points of outlines.

Nothing here knows that a flank is an involute: planes, balls and pins touch the points of an outline where they reach them
first. Lengths in mm, angles in radians, points of a section are complex numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.core.records import Floats
from gearcad.geometry import Gear
from gearcad.verification.tool_teeth import Complexes, peak_of, peaks_of

CHORD_SHARE = 1e-6
"""Chord error of the outlines that are measured, in normal modules."""

MOST_CHORD = 1e-5
"""The greatest chord error (mm) of these outlines."""

_GAUGE_CHORD = 0.1
"""Share of these chord errors for gauges, which rest on steep flanks."""

_HEIGHTS = 81
_GAUGE_HEIGHTS = 17
_GAUGE_ROUNDS = 6
"""Heights of sections that a gauge touches, and how often they close in on the place where it does."""

_LEAN = 1e-6
"""Angle (rad) to which the lean of a pin at rest is found; the radius of its axis changes with the square of it."""


def fine_chord(module: float) -> float:
    """Return the chord error (mm) of an outline that is measured, for a normal module (mm)."""
    return min(CHORD_SHARE * module, MOST_CHORD)


def half_outline(gear: Gear, chord_error: float) -> Complexes:
    """Return points (n,) of the left half of tooth 0, root to tip; the tooth is centred on the real axis."""
    x, y = gear.profile.points(chord_error).T
    left: Complexes = (x + 1j * y)[len(x) // 2 :][::-1]
    return left


def _on_flank(gear: Gear, outline: Complexes) -> Complexes:
    """Return the points of half a tooth that are between the form circles at its root and its tip."""
    ends = sorted((gear.profile.form_diameter / 2, gear.profile.tip_form_diameter / 2))
    slack, radii = 1e-9 * ends[1], np.abs(outline)
    flank: Complexes = outline[(radii >= ends[0] - slack) & (radii <= ends[1] + slack)]
    on_land = np.r_[False, np.abs(np.diff(np.abs(flank))) < slack]  # the tip land has the radius of the flank's end
    kept: Complexes = flank[~on_land]
    return kept


@dataclass(frozen=True)
class OutlineGauges:
    """Gauges on the teeth of a gear: `outline` (n,) is half a tooth, root to tip, and screws with `twist` (rad/mm) along z.

    `flank` (m,) are the points of it between root and tip.
    """

    outline: Complexes
    flank: Complexes
    teeth: int
    twist: float
    internal: bool

    @classmethod
    def of(cls, gear: Gear) -> OutlineGauges:
        """Return the gauges on the outline of a gear."""
        reference = gear.tooth_count * gear.normal_module / math.cos(math.radians(gear.helix_angle)) / 2
        outline = half_outline(gear, _GAUGE_CHORD * fine_chord(gear.normal_module))
        twist = math.tan(math.radians(gear.helix_angle)) / reference
        return cls(outline, _on_flank(gear, outline), gear.tooth_count, twist, gear.internal)

    @property
    def _pitch(self) -> float:
        return 2 * math.pi / self.teeth

    def span(self, count: int, height: float) -> float:
        """Return the least distance (mm) of two parallel planes outside `count` teeth, or inside the spaces of a ring.

        The planes lean so that they touch along lines, at sections about the `height` (mm) over the middle, one above and the
        other below it.
        """
        half = self._pitch / 2 - np.angle(self.flank) if self.internal else np.angle(self.flank)
        turned = np.abs(self.flank) * np.exp(1j * (half + (count - 1) / 2 * self._pitch))
        if not self.twist:
            return 2 * peak_of(turned.imag)
        radii = np.abs(self.flank)
        helix = math.atan(abs(self.twist) * float(radii.mean()))
        reach = 3 * float(np.ptp(radii)) / math.sin(helix)
        hand = -math.copysign(1.0, self.twist)
        heights = np.linspace(height - reach, height + reach, _HEIGHTS)
        for _ in range(2):  # the second time where the planes touch between the ends of the flanks
            sections = (turned[:, None] * np.exp(1j * self.twist * hand * heights)).imag
            nearest = sections.argmax(axis=0)
            touching = np.flatnonzero((nearest > 0) & (nearest < len(turned) - 1))
            if len(touching) < 3:
                return math.nan
            across, touched = peaks_of(sections[:, touching]), heights[touching]
            heights = np.linspace(touched[0], touched[-1], _HEIGHTS)
        # A plane touches a screwed flank along a straight line and leans as that line does. Half a turn gives the other.
        middle = touched - touched.mean()
        lean = -math.atan(float(middle @ across) / float(middle @ middle))
        return 2 * float((across * math.cos(lean) + touched * math.sin(lean)).max())

    def ball_centre(self, diameter: float) -> float:
        """Return the radius (mm) of the centre of a ball at rest in a space, put in from outside, or from inside a ring."""
        return self._rest(diameter, lambda across, z: across**2 + z**2, diameter / 2)

    def pin_centre(self, diameter: float) -> float:
        """Return the radius (mm) of the axis of a pin at rest in a space of an external gear, inclined freely."""
        from scipy.optimize import minimize_scalar

        if not self.twist:
            return self.ball_centre(diameter)
        hand = math.copysign(1.0, self.twist)

        def resting(lean: float) -> float:
            cosine, sine = math.cos(lean), hand * math.sin(lean)
            return self._rest(diameter, lambda across, z: (across * cosine - z * sine) ** 2, diameter)

        least = minimize_scalar(resting, bounds=(0.0, math.radians(85)), method="bounded", options={"xatol": _LEAN})
        return float(least.fun)

    @cached_property
    def _side(self) -> Complexes:
        """One side of a space that is centred on the real axis."""
        side: Complexes = self.outline * np.exp(-1j * self._pitch / 2)
        return side

    def _rest(self, diameter: float, square: Callable[[Floats, Floats], Floats], reach: float) -> float:
        """Return the radius (mm) of the centre of a gauge that touches the space.

        `square` is the square of the distance from the gauge's middle, across the radius, of points at (y, z), the same at
        (-y, -z); it touches within heights z of `reach` (mm). So it touches the other side of the space at the same radius.
        """
        side = -1.0 if self.internal else 1.0
        low, high, found = -reach, reach, -math.inf
        for _ in range(_GAUGE_ROUNDS):
            heights = np.linspace(low, high, _GAUGE_HEIGHTS) if self.twist else np.zeros(1)
            points = self._side[:, None] * np.exp(1j * self.twist * heights)
            room = diameter**2 / 4 - square(points.imag, heights[None, :])
            values = np.where(room >= 0, side * points.real + np.sqrt(np.maximum(room, 0.0)), -np.inf)
            centres = peaks_of(values)
            best = int(centres.argmax())
            found = max(found, float(centres[best]))
            if not self.twist:
                break
            low, high = heights[max(best - 1, 0)], heights[min(best + 1, len(heights) - 1)]
        return side * found
