"""The tooth as a beam: its section across the lines of contact, the load on its flank, and integrals along its centre line.

The section is that of the virtual spur gear in the normal section (ISO 6336-3:2006, 6.2.2); a spur gear is its own.
x runs along the centre line of the tooth from the gear's axis, h is the half thickness there (mm). Angles in radians: these
are the locals of the formulas of beam methods.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Chebyshev

from gearcad.arrays import Floats
from gearcad.geometry import Gear, ToothProfile
from gearcad.geometry.curves import Curve, Fillet, Involute
from gearcad.geometry.involute import involute_at_roll
from gearcad.geometry.profile import base_half_angle
from gearcad.rating.virtual import VirtualGear
from gearcad.rating.virtual_tool import virtual_tool

__all__ = ["BeamLoad", "BeamTooth"]


_GAUSS = np.polynomial.legendre.leggauss(24)
_DEGREE = 48
"""Of the polynomial for the fillet's x: its slope is right to 1e-11."""

_TABLE, _NEWTON = 128, 5
"""Steps of a curve's table, and of Newton's rule in one of them."""

Slope = Callable[[Floats], Floats]
"""dx/ds at s."""


@dataclass(frozen=True)
class BeamLoad:
    """Loads normal to the flank, each (n,): contact point (x, h) in mm, angle to the normal of the centre line (rad).

    `crossing` is the x where the line of the force crosses the centre line (mm).
    """

    x: Floats
    h: Floats
    angle: Floats

    @property
    def crossing(self) -> Floats:
        """u = x_c - h_c tan alpha_F."""
        result: Floats = self.x - self.h * np.tan(self.angle)
        return result

    @property
    def to_centre_line(self) -> Floats:
        """k = h_c/cos alpha_F: distance from the contact to the centre line along the force (mm)."""
        result: Floats = self.h / np.cos(self.angle)
        return result


@dataclass(frozen=True)
class BeamTooth:
    """A tooth between its root circle and its tip form circle."""

    base_radius: float
    base_half_angle: float
    root_radius: float
    fillet: Fillet
    flank: Involute

    @classmethod
    def from_gear(cls, gear: Gear) -> BeamTooth:
        """The tooth of a gear. Raises GeometryError where the virtual gear has no tooth."""
        profile = gear.profile if not gear.helix_angle else _virtual_profile(gear)
        fillet = next(curve for curve in profile.curves if isinstance(curve, Fillet))
        flank = next(curve for curve in profile.curves if isinstance(curve, Involute))
        base = profile.base_diameter / 2
        return cls(base, math.radians(profile.base_half_angle), profile.root_diameter / 2, fillet, flank)

    # ------------------------------------------------------------------ the root

    @cached_property
    def root_half_angle(self) -> float:
        """theta_f: half tooth angle on the root circle, where the fillet leaves it (rad)."""
        return float(self.fillet.polar(0.0)[1])

    @cached_property
    def root_chord(self) -> tuple[float, float]:
        """x and h where the fillet leaves the root circle (mm)."""
        x, h = self.fillet.points(0.0)
        return float(x), float(h)

    # ------------------------------------------------------------------ the load

    def load_at(self, curvature: Floats) -> BeamLoad:
        """The load where the involute's radius of curvature is `curvature` (n,) in mm, at the tip for one beyond it.

        At the tip circle a helical flank has a radius of curvature up to 1 % larger than that of its virtual gear.
        """
        roll = np.minimum(curvature / self.base_radius, self.flank.last)
        half = self.base_half_angle - involute_at_roll(roll)
        radius = self.base_radius * np.hypot(1.0, roll)
        return BeamLoad(radius * np.cos(half), radius * np.sin(half), np.arctan(roll) - half)

    # ------------------------------------------------------------------ integrals along the centre line

    def integrals(self, upper: Floats, crossing: Floats) -> tuple[Floats, Floats]:
        """int (crossing - x)^2/h^3 dx and int dx/h, each (n,), from the root to `upper` (n,) in mm.

        Both are 0 for an upper end below the root.
        """
        bend = float(self.flank.points(0.0)[0])
        below = np.where(upper < bend, _place(self.fillet, self._fillet_slope, np.minimum(upper, bend)), 1.0)
        above = np.where(upper > bend, _place(self.flank, self._flank_slope, np.maximum(upper, bend)), 0.0)
        # All loads beyond the fillet share its points: they are (1, m) then.
        ends = below if (below < 1).any() else np.ones(1)
        pieces = ((self.fillet, self._fillet_slope, ends), (self.flank, self._flank_slope, above))
        found = [_piece(curve, slope, end, crossing) for curve, slope, end in pieces]
        return found[0][0] + found[1][0], found[0][1] + found[1][1]

    @cached_property
    def _fillet_slope(self) -> Slope:
        """dx/ds of the fillet."""
        fit: Slope = Chebyshev.interpolate(lambda s: self.fillet.points(s)[..., 0], _DEGREE, domain=[0, 1]).deriv()
        return fit

    def _flank_slope(self, s: Floats) -> Floats:
        roll = self.flank.roll(s)
        rate = self.flank.last - self.flank.first
        result: Floats = self.base_radius * roll * np.cos(self.base_half_angle - roll) * rate
        return result


def _piece(curve: Curve, slope: Slope, ends: Floats, crossing: Floats) -> tuple[Floats, Floats]:
    """Both integrals along a curve from s = 0 to `ends`."""
    node, weight = (_GAUSS[0] + 1) / 2, _GAUSS[1] / 2
    # Two panels, points dense towards the end: there the tooth is thinnest.
    v = np.r_[node / 2, node / 2 + 0.5]
    spread, rate = v * (2 - v), np.r_[weight, weight] * (1 - v)
    s = ends[:, None] * spread
    points = curve.points(s)
    x, inverse = points[..., 0], 1 / points[..., 1]
    along = slope(s) * inverse * (ends[:, None] * rate)
    cubic: Floats = (along * ((crossing[:, None] - x) * inverse) ** 2).sum(-1)
    return cubic, along.sum(-1)


def _place(curve: Curve, slope: Slope, x: Floats) -> Floats:
    """s in [0, 1] where the curve is at x (n,), its nearer end where it is nowhere: Newton's rule within a table's steps."""
    table = np.linspace(0.0, 1.0, _TABLE + 1)
    known = curve.points(table)[:, 0]
    step = np.clip(np.searchsorted(known, x) - 1, 0, _TABLE - 1)
    low, high = table[step], table[step + 1]
    s = np.clip(np.interp(x, known, table), low, high)
    for _ in range(_NEWTON):
        rate = slope(s)
        s = np.clip(s - (curve.points(s)[:, 0] - x) / np.where(rate > 0, rate, 1.0), low, high)
    return s


def _virtual_profile(gear: Gear) -> ToothProfile:
    """The tooth that the gear's own tool would cut on the virtual spur gear of z_n teeth (ISO 6336-3:2006, (21) ... (27))."""
    virtual = VirtualGear.of(gear)
    d_n = virtual.reference_diameter
    return ToothProfile(
        teeth=virtual.teeth,
        reference_diameter=d_n,
        base_diameter=virtual.base_diameter,
        tip_diameter=virtual.tip_diameter,
        root_diameter=d_n + gear.root_diameter - gear.reference_diameter,
        base_half_angle=base_half_angle(virtual.teeth, gear.normal_tooth_thickness, gear.normal_module, virtual.pressure_angle),
        tool=virtual_tool(gear, virtual),
    )
