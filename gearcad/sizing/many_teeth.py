"""The teeth of many external gears at once: Gear's formulas (ISO 21771) as arrays.

Lengths in mm, angles in radians, but for the helix angle, which is in degrees as in a Gear. Teeth are hobbed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import BasicRack
from gearcad.sizing.columns import Numbers

__all__ = ["ManyTeeth", "form_reach", "involute_of", "tip_thickness"]


def involute_of(angle: Numbers) -> Numbers:
    """Involute of an angle in radians."""
    result: Numbers = np.tan(angle) - angle
    return result


def form_reach(diameter: Numbers, transverse_angle: Numbers, depth: Numbers) -> Floats:
    """r sin alpha_t - h/sin alpha_t: length of the base tangent out to the root form circle that a hob leaves.

    `depth` h is that of the end of its straight flanks (mm) below the reference circle. Below 0 the tooth is undercut.
    """
    sine = np.sin(transverse_angle)
    result: Floats = diameter / 2 * sine - depth / sine
    return result


def tip_thickness(
    diameter: Numbers, base: Numbers, tip: Numbers, thickness: Numbers, transverse_angle: Numbers, helix_angle: Numbers
) -> Floats:
    """s_at = d_a (s_t/d + inv alpha_t - inv alpha_at), times cos beta_a; below 0 the flanks meet before.

    `thickness` s_t is that on the reference circle.
    """
    at_tip = np.arccos(np.minimum(base / tip, 1.0))
    transverse = tip * (thickness / diameter + involute_of(transverse_angle) - involute_of(at_tip))
    result: Floats = transverse / np.hypot(1.0, np.tan(np.radians(helix_angle)) * tip / diameter)
    return result


@dataclass(frozen=True, kw_only=True)
class ManyTeeth:
    """Gears by what one gives of them: numbers, or arrays that go together; helix angles in degrees, thinning in mm.

    `given_tip` and `given_root` are diameters (mm) that do not follow from the profile shift.
    """

    teeth: Numbers
    normal_module: float
    helix_angle: Numbers
    shift: Numbers
    rack: BasicRack
    tip_alteration: Numbers = 0.0
    thinning: float = 0.0
    tip_chamfer: float = 0.0
    given_tip: float | None = None
    given_root: float | None = None

    @cached_property
    def transverse_angle(self) -> Numbers:
        """alpha_t."""
        result: Numbers = np.arctan(math.tan(math.radians(self.rack.pressure_angle)) / self._cosine)
        return result

    @property
    def _cosine(self) -> Numbers:
        result: Numbers = np.cos(np.radians(self.helix_angle))
        return result

    @cached_property
    def diameter(self) -> Numbers:
        """d."""
        return self.teeth * self.normal_module / self._cosine

    @cached_property
    def base_diameter(self) -> Numbers:
        """d_b."""
        result: Numbers = self.diameter * np.cos(self.transverse_angle)
        return result

    @cached_property
    def tip_diameter(self) -> Numbers:
        """d_a."""
        if self.given_tip is not None:
            return self.given_tip
        return self.diameter + 2 * self.normal_module * (self.rack.addendum + self.shift + self.tip_alteration)

    @cached_property
    def root_diameter(self) -> Numbers:
        """d_f."""
        return self.diameter - 2 * self.normal_module * (self.dedendum - self.shift)

    @property
    def dedendum(self) -> Numbers:
        """h_fP of the tool in normal modules, where the root circle is given that which cuts it."""
        if self.given_root is None:
            return self.rack.dedendum
        return (self.diameter - self.given_root) / (2 * self.normal_module) + self.shift

    @property
    def root_radius(self) -> Numbers:
        """rho_fP in normal modules, with "full" resolved."""
        if self.rack.root_radius != "full":
            return float(self.rack.root_radius)
        full = self.rack.full_root_radius(thinning=self.thinning / self.normal_module)
        angle = math.radians(self.rack.pressure_angle)
        return full - (self.dedendum - self.rack.dedendum) * math.sin(angle) / (1 - math.sin(angle))

    @cached_property
    def form_reach(self) -> Floats:
        """Length of the base tangent out to the root form circle; below 0 the tooth is undercut."""
        straight = self.dedendum - self.root_radius * (1 - math.sin(math.radians(self.rack.pressure_angle)))
        return form_reach(self.diameter, self.transverse_angle, self.normal_module * (straight - self.shift))

    @cached_property
    def tip_reach(self) -> Floats:
        """Length of the base tangent out to where the flank ends: the tip circle, less a chamfer."""
        end, base = self.tip_diameter - 2 * self.tip_chamfer, self.base_diameter
        result: Floats = np.sqrt(np.maximum((end - base) * (end + base), 0.0)) / 2
        return result

    @property
    def tooth_thickness(self) -> Numbers:
        """s_t on the reference circle."""
        tangent = math.tan(math.radians(self.rack.pressure_angle))
        return (self.normal_module * (math.pi / 2 + 2 * self.shift * tangent) - self.thinning) / self._cosine

    @cached_property
    def tip_thickness(self) -> Floats:
        """s_an, before a tip chamfer."""
        parts = (self.diameter, self.base_diameter, self.tip_diameter, self.tooth_thickness)
        return tip_thickness(*parts, self.transverse_angle, self.helix_angle)
