"""Sizes of teeth by formula (ISO 21771), that gears and racks share: of one part, or arrays of many variants.

Lengths in mm, angles in degrees; teeth and diameters of an internal gear are negative.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import Generic

from gearcad.core.values import Values, arcsin, arctan, cos, degrees, radians, sin
from gearcad.geometry.gear_parts import BasicRack, full_root_radius
from gearcad.geometry.profile import base_half_angle


class Toothed(Generic[Values]):
    """What gears and racks have in common: sizes that follow from module, helix angle and basic rack."""

    normal_module: Values
    helix_angle: Values
    rack: BasicRack

    @property
    def normal_tooth_thickness(self) -> Values:
        """Normal tooth thickness s_n on the reference circle or line."""
        raise NotImplementedError

    @cached_property
    def transverse_module(self) -> Values:
        """m_t = m_n / cos beta."""
        return self.normal_module / cos(radians(self.helix_angle))

    @cached_property
    def transverse_pressure_angle(self) -> Values:
        """tan alpha_t = tan alpha_n / cos beta."""
        tangent = math.tan(math.radians(self.rack.pressure_angle))
        return degrees(arctan(tangent / cos(radians(self.helix_angle))))

    @cached_property
    def base_helix_angle(self) -> Values:
        """sin beta_b = sin beta cos alpha_n; signed like the helix angle."""
        return degrees(arcsin(sin(radians(self.helix_angle)) * math.cos(math.radians(self.rack.pressure_angle))))

    @property
    def transverse_pitch(self) -> Values:
        """Transverse pitch p_t = pi m_t (mm)."""
        return math.pi * self.transverse_module

    @property
    def transverse_tooth_thickness(self) -> Values:
        """s_t = s_n / cos beta, on the reference circle or line."""
        return self.normal_tooth_thickness / cos(radians(self.helix_angle))


class GearSizes(Toothed[Values]):
    """Sizes of gears that follow by formula from what is given of their teeth."""

    teeth: Values
    profile_shift: Values
    tip_alteration: Values
    tooth_thinning: float

    @property
    def tip_form_diameter(self) -> Values:
        """d_Fa: the tip circle less the tip chamfers."""
        raise NotImplementedError

    @cached_property
    def reference_diameter(self) -> Values:
        """Reference diameter d = z m_t (mm)."""
        return self.teeth * self.transverse_module

    @cached_property
    def base_diameter(self) -> Values:
        """d_b = d cos alpha_t."""
        return self.reference_diameter * cos(radians(self.transverse_pressure_angle))

    @property
    def standard_tip_diameter(self) -> Values:
        """d_a = d + 2 m_n (h_aP + x + k)."""
        rise = self.rack.addendum + self.profile_shift + self.tip_alteration
        return self.reference_diameter + 2 * self.normal_module * rise

    @property
    def standard_root_diameter(self) -> Values:
        """d_f = d - 2 m_n (h_fP - x)."""
        return self.reference_diameter - 2 * self.normal_module * (self.rack.dedendum - self.profile_shift)

    @property
    def given_root_diameter(self) -> Values | None:
        """Root diameter d_f that is prescribed; None where it follows from the rack."""
        raise NotImplementedError

    @property
    def dedendum(self) -> Values:
        """Dedendum h_fP of the tool in normal modules: the rack's, or (d - d_f)/(2 m_n) + x for a given root circle."""
        given = self.given_root_diameter
        if given is None:
            return self.rack.dedendum
        return (self.reference_diameter - given) / (2 * self.normal_module) + self.profile_shift

    @property
    def root_radius(self) -> Values:
        """Tip radius of a hob in normal modules, with "full" resolved for this gear."""
        if self.rack.root_radius == "full":
            return full_root_radius(self.rack.pressure_angle, self.dedendum, self.tooth_thinning / self.normal_module)
        return float(self.rack.root_radius)

    @property
    def normal_tooth_thickness(self) -> Values:
        """s_n = m_n (pi/2 + 2 x tan alpha_n) - thinning, on the reference circle."""
        tangent = math.tan(math.radians(self.rack.pressure_angle))
        return self.normal_module * (math.pi / 2 + 2 * self.profile_shift * tangent) - self.tooth_thinning

    @property
    def base_half_angle(self) -> Values:
        """Half tooth angle on the base circle in degrees, signed like the diameters: s_n/(m_n z) + inv alpha_t (ISO 21771)."""
        return base_half_angle(self.teeth, self.normal_tooth_thickness, self.normal_module, self.transverse_pressure_angle)

    @property
    def transverse_base_pitch(self) -> Values:
        """p_bt = pi m_t cos alpha_t."""
        return math.pi * self.base_diameter / self.teeth

    @property
    def virtual_teeth(self) -> Values:
        """z_n = z / (cos^2 beta_b cos beta)."""
        return self.teeth / (cos(radians(self.base_helix_angle)) ** 2 * cos(radians(self.helix_angle)))
