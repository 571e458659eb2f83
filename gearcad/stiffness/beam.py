"""Mesh stiffness with the tooth as a beam on an elastic body: potential energy, and Weber and Banaschek.

The section is that of the virtual spur gear in the normal section (ISO 6336-3:2006, 6.2.2); a spur gear is its own.
x runs along the centre line of the tooth from its root to its tip, 0 on the gear's axis, h is the half thickness there (mm);
on the tooth of a ring x is negative. Angles in radians: these are the locals of the formulas of beam methods.

In a helical pair a slice is cut across the lines of contact: the tooth's normal section under F_n/l = F_bt/b, whose
deflection delta_n is delta_t = delta_n/cos beta_b along the transverse line of action. Compliances of the section over
cos beta_b are so those of the transverse section - the factor cos beta of ISO 6336-1 (80).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.polynomial import Chebyshev

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Floats, Notice, PerGear, Role
from gearcad.geometry import Gear, ToothProfile
from gearcad.geometry.curves import Curve, Involute
from gearcad.geometry.involute import base_half_angle, involute_at_roll
from gearcad.load import Load
from gearcad.material import Material
from gearcad.rating.root_section import VirtualGear, virtual_tool
from gearcad.rating.tooth_stiffness import RIM_LIMIT
from gearcad.stiffness.method import SinglePair, SliceMethod

_GAUSS = np.polynomial.legendre.leggauss(24)
_DEGREE = 48
"""Degree of the polynomial for the fillet's x: its slope is right to 1e-11."""

_TABLE, _NEWTON = 128, 5
"""Steps of a curve's table, and of Newton's rule in one of them."""

Slope = Callable[[Floats], Floats]
"""Function for the slope dx/ds at s."""


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
    """A tooth between its root circle and its tip form circle; `side` is 1, and -1 on a ring, whose teeth point to its axis."""

    base_radius: float
    base_half_angle: float
    root_radius: float
    fillet: Curve
    flank: Involute
    side: int = 1

    @classmethod
    def from_gear(cls, gear: Gear) -> BeamTooth:
        """Return the tooth of a gear. Raises GeometryError where the virtual gear has no tooth."""
        if gear.internal and gear.helix_angle:
            permitted = "must be 0 for weber-banaschek on a ring: its beam is that of spur teeth"
            raise GeometryError("pair.helix_angle", gear.helix_angle, permitted, "deg")
        profile = gear.profile if not gear.helix_angle else _virtual_profile(gear)
        fillet, flank = profile.fillet, profile.involute
        base = profile.base_diameter / 2
        side = -1 if gear.internal else 1
        return cls(base, math.radians(profile.base_half_angle), profile.root_diameter / 2, fillet, flank, side)

    # ------------------------------------------------------------------ the root

    @cached_property
    def root_half_angle(self) -> float:
        """theta_f: half tooth angle on the root circle, where the fillet leaves it (rad)."""
        return float(self.fillet.polar(0.0)[1])

    @cached_property
    def root_chord(self) -> tuple[float, float]:
        """x and h where the fillet leaves the root circle (mm)."""
        x, h = self._points(self.fillet, np.array(0.0))
        return float(x), float(h)

    def _points(self, curve: Curve, s: Floats) -> Floats:
        """Return x and h (..., 2) of a curve (mm)."""
        points: Floats = curve.points(s) * np.array([self.side, 1.0])
        return points

    # ------------------------------------------------------------------ the load

    def load_at(self, curvature: Floats) -> BeamLoad:
        """Return the load where the involute's radius of curvature is `curvature` (n,) in mm, at the tip for one beyond it.

        At the tip circle a helical flank has a radius of curvature up to 1 % larger than that of its virtual gear.
        """
        beyond = np.maximum if self.side < 0 else np.minimum
        roll = beyond(np.abs(curvature) / self.base_radius, self.flank.last)
        half = self.base_half_angle - self.side * involute_at_roll(roll)
        radius = self.base_radius * np.hypot(1.0, roll)
        return BeamLoad(self.side * radius * np.cos(half), radius * np.sin(half), np.arctan(roll) - self.side * half)

    # ------------------------------------------------------------------ integrals along the centre line

    def integrals(self, upper: Floats, crossing: Floats) -> tuple[Floats, Floats]:
        """int (crossing - x)^2/h^3 dx and int dx/h, each (n,), from the root to `upper` (n,) in mm.

        Both are 0 for an upper end below the root.
        """
        bend = float(self._points(self.flank, np.array(0.0))[0])
        below = np.where(upper < bend, self._place(self.fillet, self._fillet_slope, np.minimum(upper, bend)), 1.0)
        above = np.where(upper > bend, self._place(self.flank, self._flank_slope, np.maximum(upper, bend)), 0.0)
        # All loads beyond the fillet share its points: they are (1, m) then.
        ends = below if (below < 1).any() else np.ones(1)
        pieces = ((self.fillet, self._fillet_slope, ends), (self.flank, self._flank_slope, above))
        found = [self._piece(curve, slope, end, crossing) for curve, slope, end in pieces]
        return found[0][0] + found[1][0], found[0][1] + found[1][1]

    @cached_property
    def _fillet_slope(self) -> Slope:
        """Slope dx/ds of the fillet."""
        fit: Slope = Chebyshev.interpolate(lambda s: self._points(self.fillet, s)[..., 0], _DEGREE, domain=[0, 1]).deriv()
        return fit

    def _flank_slope(self, s: Floats) -> Floats:
        roll = self.flank.roll(s)
        rate = self.side * (self.flank.last - self.flank.first)
        result: Floats = self.base_radius * roll * np.cos(self.base_half_angle - self.side * roll) * rate
        return result

    def _piece(self, curve: Curve, slope: Slope, ends: Floats, crossing: Floats) -> tuple[Floats, Floats]:
        """Return both integrals along a curve from s = 0 to `ends`."""
        node, weight = (_GAUSS[0] + 1) / 2, _GAUSS[1] / 2
        # Two panels, points dense towards the end: there the tooth is thinnest.
        v = np.r_[node / 2, node / 2 + 0.5]
        spread, rate = v * (2 - v), np.r_[weight, weight] * (1 - v)
        s = ends[:, None] * spread
        points = self._points(curve, s)
        x, inverse = points[..., 0], 1 / points[..., 1]
        along = slope(s) * inverse * (ends[:, None] * rate)
        cubic: Floats = (along * ((crossing[:, None] - x) * inverse) ** 2).sum(-1)
        return cubic, along.sum(-1)

    def _place(self, curve: Curve, slope: Slope, x: Floats) -> Floats:
        """Return s in [0, 1] where the curve is at x (n,), its nearer end where it is nowhere: Newton's rule in a table."""
        table = np.linspace(0.0, 1.0, _TABLE + 1)
        known = self._points(curve, table)[:, 0]
        step = np.clip(np.searchsorted(known, x) - 1, 0, _TABLE - 1)
        low, high = table[step], table[step + 1]
        s = np.clip(np.interp(x, known, table), low, high)
        for _ in range(_NEWTON):
            rate = slope(s)
            s = np.clip(s - (self._points(curve, s)[:, 0] - x) / np.where(rate > 0, rate, 1.0), low, high)
        return s


def _virtual_profile(gear: Gear) -> ToothProfile:
    """Return the tooth that the gear's own tool would cut on the virtual spur gear of z_n teeth (ISO 6336-3:2006, (21) ...
    (27)).
    """
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


_SAINSOT = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)
"""A ... F of L*, M*, P*, Q* (Sainsot, Velex and Duverger 2004, table 1)."""

_ANGLES, _RIMS = (0.01, 0.12), (1.4, 7.0)
"""Ranges of theta_f (rad) and h_f to which the series was fitted."""


def sainsot_foundation(tooth: BeamTooth, load: BeamLoad, material: Material, rim: float) -> Floats:
    """1/(k_f) (n,) of an elastic ring under a tooth (Sainsot, Velex, Duverger, J. Mech. Des. 126 (2004), (3) ... (5)).

    cos^2 a_F/E [L* (u/S)^2 + M* u/S + P* (1 + Q* tan^2 a_F)], u from the root circle to where the force crosses the centre
    line, S = 2 r_f theta_f; `rim` h_f = r_f/r_i is the root radius over that where the body is held.
    """
    angle = tooth.root_half_angle
    series = _SAINSOT @ np.array([1 / angle**2, rim**2, rim / angle, 1 / angle, rim, 1.0])
    lever = (load.crossing - tooth.root_radius) / (2 * tooth.root_radius * angle)
    return _polynomial(load, lever, *series) / material.youngs_modulus


def sainsot_range(tooth: BeamTooth, rim: float) -> Iterator[Notice]:
    """Yield a notice for each figure of the tooth that is outside the range of the series."""
    for name, value, (low, high) in (("theta_f", tooth.root_half_angle, _ANGLES), ("h_f", rim, _RIMS)):
        if not low <= value <= high:
            text = f"{name} = {value:.4g} is outside the {low:g} ... {high:g} of Sainsot's foundation"
            yield Notice("foundation-range", text)


def weber_foundation(tooth: BeamTooth, load: BeamLoad, material: Material) -> Floats:
    """Compliance (n,) of an elastic half-plane under the root chord (Weber and Banaschek 1953).

    (1 - nu^2) cos^2 a_F/E [18/pi (u/S)^2 + 2 (1 - 2 nu)/(1 - nu) u/S + 4.8/pi (1 + (1 - nu)/2.4 tan^2 a_F)].
    """
    x, h = tooth.root_chord
    nu = material.poisson_ratio
    factors = (18 / math.pi, 2 * (1 - 2 * nu) / (1 - nu), 4.8 / math.pi, (1 - nu) / 2.4)
    return _polynomial(load, (load.crossing - x) / (2 * h), *factors) * (1 - nu**2) / material.youngs_modulus


def _polynomial(load: BeamLoad, lever: Floats, square: float, linear: float, shear: float, axial: float) -> Floats:
    """cos^2 a_F [square lever^2 + linear lever + shear (1 + axial tan^2 a_F)]."""
    across, along = np.cos(load.angle) ** 2, np.sin(load.angle) ** 2
    result: Floats = across * (square * lever**2 + linear * lever + shear) + shear * axial * along
    return result


@dataclass(frozen=True, kw_only=True)
class BeamMethod(SliceMethod):
    """A method in closed form: compliances of both teeth and of their contact at any place on the line of action."""

    @cached_property
    def teeth(self) -> PerGear[BeamTooth]:
        """The teeth of both gears as beams."""
        return PerGear(*map(BeamTooth.from_gear, self.mounted.gears))

    def single(self, lengths: Floats, load: Load) -> SinglePair:
        """Return one pair of teeth that carries all of the load, at places (n,) from T1 on the line of action (mm)."""
        parts: dict[str, Floats] = {}
        curvatures = self.curvatures(lengths)
        loads = PerGear.each(lambda role: self.teeth.pick(role).load_at(curvatures.pick(role)))
        for role, pressed in loads.items():
            parts |= {f"{role.value} {name}": part for name, part in self.tooth_parts(role, pressed).items()}
        parts["contact"] = self.contact(lengths, loads, load)
        self._refuse_negative(parts, load)
        factor = self.to_transverse
        return SinglePair(lengths, {name: factor * part for name, part in parts.items()}, factor * self.tangent_less)

    def _refuse_negative(self, parts: dict[str, Floats], load: Load) -> None:
        """Raise ParameterError or GeometryError if a formula, far outside its range, gives a contact or foundation that is not
        flexible.
        """
        if (parts["contact"] <= 0).any():
            permitted = "must be lower: the contact by Hertz's formula would be as wide as the teeth are thick"
            raise ParameterError("load.torque", load.torque, permitted, "N·m")
        for role, gear in self.mounted.gears.items():
            if (parts[f"{role.value} foundation"] <= 0).any():
                permitted = (
                    "must leave another ring below the teeth: Sainsot's series gives a negative flexibility for this one"
                )
                raise GeometryError(f"{role.value}.body.bore", gear.body.bore, permitted, "mm")

    @abstractmethod
    def tooth_parts(self, role: Role, load: BeamLoad) -> dict[str, Floats]:
        """Compliances (n,) of a tooth of a gear in its section, per width (mm²/N)."""

    @abstractmethod
    def contact(self, lengths: Floats, loads: PerGear[BeamLoad], load: Load) -> Floats:
        """Compliance (n,) of the contact of both flanks, per width (mm²/N)."""

    @property
    def tangent_less(self) -> float:
        """Difference (mm²/N) by which the tangent compliance is below the secant one, per width."""
        return 0.0


@dataclass(frozen=True, kw_only=True)
class PotentialEnergy(BeamMethod):
    """Bending, shear and axial energy of the true tooth (Yang and Lin 1987, Tian 2004) on Sainsot's elastic ring (2004).

    1/k_b = 12/(8 E b) int (u - x)^2 cos^2 a_F/h^3 dx,  1/k_s = 1.2 cos^2 a_F/(2 G b) int dx/h,
    1/k_a = sin^2 a_F/(2 E b) int dx/h, from the root circle along trochoid and involute to the contact,
    and 1/k_h = 4 (1 - nu^2)/(pi E b) whatever the load.
    """

    name = "potential-energy"
    title = "Potential energy"
    holds = ("contact, whatever the load", "bending", "shear", "axial", "foundation in an elastic ring")
    load_dependent: ClassVar[bool] = False
    no_internal_form: ClassVar[str] = "Sainsot's elastic ring lies inside the teeth, held at its bore, not outside them"

    @cached_property
    def rims(self) -> PerGear[float]:
        """h_f = r_f/r_i: root radius over that where the body is held."""
        gears, held = self.mounted.gears, self.body.inner_radii(self.mounted)
        return PerGear.each(lambda role: gears.pick(role).root_diameter / 2 / held.pick(role))

    def tooth_parts(self, role: Role, load: BeamLoad) -> dict[str, Floats]:
        material, tooth = self.materials.pick(role), self.teeth.pick(role)
        e, nu = material.youngs_modulus, material.poisson_ratio
        across, along = np.cos(load.angle) ** 2, np.sin(load.angle) ** 2
        cubic, plain = tooth.integrals(load.x, load.crossing)
        return {
            "bending": 1.5 / e * across * cubic,
            "shear": 1.2 * (1 + nu) / e * across * plain,
            "axial": along / (2 * e) * plain,
            "foundation": sainsot_foundation(tooth, load, material, self.rims.pick(role)),
        }

    def contact(self, lengths: Floats, loads: PerGear[BeamLoad], load: Load) -> Floats:
        return np.full(len(lengths), _hertz(self))

    def notices(self, load: Load) -> Iterator[Notice]:
        for role, tooth in self.teeth.items():
            yield from (notice.within(role.value) for notice in sainsot_range(tooth, self.rims.pick(role)))
        yield from super().notices(load)


@dataclass(frozen=True, kw_only=True)
class WeberBanaschek(BeamMethod):
    """Tooth on its root chord, an elastic half-plane below it, and Hertz's flattening (Weber and Banaschek 1953).

    The tooth of a ring is the same beam, which points to the axis, on a half-plane outside its root; spur rings only.

    Beam: (1 - nu^2) cos^2 a_F/E [12 int (u - y)^2/(2 h)^3 dy + (2.4/(1 - nu) + tan^2 a_F) int dy/(2 h)] from the root chord to
    where the force crosses the centre line; contact, once for both teeth: 4 (1 - nu^2)/(pi E)
    [ln(2 sqrt(k_1 k_2)/a) - nu/(2 (1 - nu))] with the half width a under all of the load; of two materials half of either's.
    """

    name = "weber-banaschek"
    title = "Weber-Banaschek"
    holds = ("contact under all of the load", "bending", "shear", "axial", "foundation in a half-plane")

    def tooth_parts(self, role: Role, load: BeamLoad) -> dict[str, Floats]:
        material, tooth = self.materials.pick(role), self.teeth.pick(role)
        e, nu = material.youngs_modulus, material.poisson_ratio
        across, along = np.cos(load.angle) ** 2, np.sin(load.angle) ** 2
        cubic, plain = tooth.integrals(load.crossing, load.crossing)
        factor = (1 - nu**2) / e
        return {
            "bending": 1.5 * factor * across * cubic,
            "shear": 1.2 * (1 + nu) / e * across * plain,
            "axial": 0.5 * factor * along * plain,
            "foundation": weber_foundation(tooth, load, material),
        }

    def contact(self, lengths: Floats, loads: PerGear[BeamLoad], load: Load) -> Floats:
        first, second = self.curvatures(lengths)
        radius = first * second / (first + second)
        # a^2 = 8 F rho (1 - nu^2)/(pi E b): the load per length of the line is F_bt/b
        half_width = np.sqrt(2 * self.force(load) / self.width * radius * _hertz(self))
        to_centre = loads.map(lambda load: load.to_centre_line)
        depth = np.sqrt(to_centre.pinion * to_centre.wheel)
        pinion, wheel = (_flattening(material) for material in self.materials)
        across = [material.poisson_ratio / (2 * (1 - material.poisson_ratio)) for material in self.materials]
        mean = across[0] + (across[1] - across[0]) * wheel / (pinion + wheel)
        result: Floats = _hertz(self) * (np.log(2 * depth / half_width) - mean)
        if pinion != wheel:
            result = result + (pinion - wheel) / 4 * np.log(to_centre.pinion / to_centre.wheel)
        return result

    @property
    def tangent_less(self) -> float:
        """d(F ln(1/sqrt F))/dF: half of the factor before the logarithm."""
        return _hertz(self) / 2

    def notices(self, load: Load) -> Iterator[Notice]:
        yield from self._thin_rims()
        ends = self.curvatures(np.array(self.slices.path))
        for role, tooth in self.teeth.items():
            if (tooth.load_at(ends.pick(role)).crossing < tooth.root_chord[0]).any():
                text = "near the root the force crosses the centre line below the root chord: no beam there"
                yield Notice("below-root-chord", text, role.value)
        yield from super().notices(load)

    def _thin_rims(self) -> Iterator[Notice]:
        """Bodies that are no half-plane to their teeth."""
        for role, radius in self.body.inner_radii(self.mounted).items():
            gear = self.mounted.gears.pick(role)
            root, tip = (math.copysign(each, gear.teeth) for each in (gear.root_diameter, gear.tip_diameter))
            height = (root - math.copysign(2 * radius, gear.teeth)) / (tip - root)
            if height < RIM_LIMIT:
                text = f"only {height:.3g} tooth heights of body lie under the root, where the method has a half-plane"
                yield Notice("thin-rim", text, role.value)


def _hertz(method: BeamMethod) -> float:
    """4 (1 - nu^2)/(pi E) in mm²/N, the mean of both gears."""
    pinion, wheel = (_flattening(material) for material in method.materials)
    return (pinion + wheel) / 2


def _flattening(material: Material) -> float:
    return 4 * (1 - material.poisson_ratio**2) / (math.pi * material.youngs_modulus)
