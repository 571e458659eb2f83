"""What gears and racks share: sizes of teeth by formula (ISO 21771), types of fields, and checks of what is given.

The formulas take one part, or arrays of many variants. The checks raise ParameterError or GeometryError, whose limits can be
used as they are printed. Lengths in mm, angles in degrees; teeth and diameters of an internal gear are negative.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Annotated, Generic

from gearcad.core.errors import GeometryError, ParameterError, at_least, at_most, require_name
from gearcad.core.quantities import Range, Words, require_fields
from gearcad.core.records import Notice, texts
from gearcad.core.values import Values, arcsin, arctan, cos, degrees, radians, sin
from gearcad.geometry.gear_parts import BasicRack, full_root_radius
from gearcad.geometry.involute import base_half_angle

FaceWidth = Annotated[float, Range("mm", 0, 10000, ends="(]"), Words("face width", "b", "4.1")]
HelixAngle = Annotated[float, Range("deg", -75, 75), Words("helix angle (right hand +)", "β", "4.2")]
TipAlteration = Annotated[float, Range("", -5, 5), Words("tip alteration coefficient", "k", "4.5")]
ToothThinning = Annotated[float, Range("mm", 0, None), Words("tooth thinning (normal)", "A_sn", "7.3")]

LEAST_HELIX = 1e-6
"""Smallest helix angle (degrees) of helical teeth; less moves a tooth by less than 2e-8 of the face width."""

THIN_TIP = 0.2
"""Normal tip thickness below which the data sheet warns, in normal modules (0.4 for case-hardened teeth)."""


class Toothed(Generic[Values]):
    """What gears and racks have in common: sizes that follow from module, helix angle, thinning and basic rack."""

    normal_module: Values
    helix_angle: Values
    tooth_thinning: float
    rack: BasicRack

    @property
    def normal_tooth_thickness(self) -> Values:
        """Normal tooth thickness s_n on the reference circle or line."""
        raise NotImplementedError

    @property
    def dedendum(self) -> Values:
        """Dedendum h_fP of the tool in normal modules."""
        return self.rack.dedendum

    @property
    def root_radius(self) -> Values:
        """Radius of the tool's tip, or of a rack's fillets, in normal modules, with "full" resolved."""
        if self.rack.root_radius == "full":
            return full_root_radius(self.rack.pressure_angle, self.dedendum, self.tooth_thinning / self.normal_module)
        return float(self.rack.root_radius)

    @cached_property
    def helix_cosine(self) -> Values:
        """Cosine of the helix angle beta."""
        return cos(radians(self.helix_angle))

    @cached_property
    def transverse_module(self) -> Values:
        """m_t = m_n / cos beta."""
        return self.normal_module / self.helix_cosine

    @cached_property
    def transverse_pressure_angle(self) -> Values:
        """tan alpha_t = tan alpha_n / cos beta."""
        tangent = math.tan(math.radians(self.rack.pressure_angle))
        return degrees(arctan(tangent / self.helix_cosine))

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
        return self.normal_tooth_thickness / self.helix_cosine


class GearSizes(Toothed[Values]):
    """Sizes of gears that follow by formula from what is given of their teeth."""

    teeth: Values
    profile_shift: Values
    tip_alteration: Values

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
    def residual_undercut(self) -> Values | float:
        """s_pr (mm): how far the tool's tip reaches into the finished flank; 0 where one tool makes the whole tooth."""
        return 0.0

    @property
    def tool_addendum(self) -> Values | float:
        """Addendum of the tool in normal modules: the dedendum h_fP of the rack, unless another tool cuts first."""
        return self.rack.dedendum

    @property
    def standard_root_diameter(self) -> Values:
        """d_f = d - 2 m_n (h_fP - x)."""
        return self.reference_diameter - 2 * self.normal_module * (self.tool_addendum - self.profile_shift)

    @property
    def given_root_diameter(self) -> Values | None:
        """Root diameter d_f that is prescribed; None where it follows from the rack."""
        raise NotImplementedError

    @property
    def dedendum(self) -> Values:
        """Dedendum h_fP of the tool in normal modules: the rack's, or (d - d_f)/(2 m_n) + x for a given root circle."""
        given = self.given_root_diameter
        if given is None:
            return self.tool_addendum
        return (self.reference_diameter - given) / (2 * self.normal_module) + self.profile_shift

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
        return self.teeth / (cos(radians(self.base_helix_angle)) ** 2 * self.helix_cosine)


class ToothedPart(Toothed[float]):
    """A gear or a rack as it is given: what the checks below need, and its notices in words."""

    name: str
    face_width: float

    def with_stock(self, stock: float) -> ToothedPart:
        """Return the part cut with another stock (mm). Raises GeometryError where the tools leave no such root."""
        raise NotImplementedError

    def can_have_stock(self, stock: float) -> bool:
        """Return whether the tools leave a root with a stock (mm)."""
        try:
            self.with_stock(stock)
        except GeometryError:
            return False
        return True

    @property
    def tip_thickness(self) -> float:
        """Normal tooth thickness s_an at the tip, before a tip chamfer."""
        raise NotImplementedError

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices about this part that an engineer should read before making it."""
        raise NotImplementedError

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)


def check_fields(part: ToothedPart) -> None:
    """Raise ParameterError for a field that is not permitted by itself."""
    require_name("name", part.name)
    require_fields(part)
    if 0 < abs(part.helix_angle) < LEAST_HELIX:
        raise ParameterError("helix_angle", part.helix_angle, f"must be 0 or at least {LEAST_HELIX:g} deg", "deg")
    if not isinstance(part.rack, BasicRack):
        raise ParameterError("rack", part.rack, "must be a BasicRack")


def check_width(part: ToothedPart, width: float) -> None:
    """Raise GeometryError unless the width (mm) of teeth of one hand fits the module."""
    if width < 0.01 * part.normal_module:
        least = at_least(0.01 * part.normal_module)
        raise GeometryError("face_width", part.face_width, f"must be at least {least} mm (0.01 m_n)", "mm")


def check_thickness(part: ToothedPart) -> None:
    """Raise GeometryError unless the thinning leaves some tooth on the reference circle or line."""
    if part.normal_tooth_thickness <= 0:
        most = at_most(part.normal_tooth_thickness + part.tooth_thinning)
        raise GeometryError("tooth_thinning", part.tooth_thinning, f"must be below {most} mm, the normal tooth thickness", "mm")


def most_dedendum(part: ToothedPart) -> float | None:
    """Return the dedendum in normal modules at which the flanks of the rack's space meet; None if its own is less."""
    thinning = part.tooth_thinning / part.normal_module
    if part.rack.full_root_radius(part.dedendum, thinning) >= 0:
        return None
    return (math.pi / 4 + thinning / 2) / math.tan(math.radians(part.rack.pressure_angle))


def check_root_radius(part: ToothedPart) -> None:
    """Raise GeometryError unless the root radius fits between the flanks of the rack's space."""
    radius, angle = part.rack.root_radius, part.rack.pressure_angle
    full = part.rack.full_root_radius(part.dedendum, part.tooth_thinning / part.normal_module)
    if radius != "full" and float(radius) > full:
        thinning = f"thinning {part.tooth_thinning:g} mm" if part.tooth_thinning else "no thinning"
        terms = f"for dedendum {part.dedendum:.6g}, pressure angle {angle:g} deg, {thinning}"
        raise GeometryError("rack.root_radius", radius, f"must be at most {at_most(full, 4)} (full radius) {terms}")


def tip_notices(part: ToothedPart) -> Iterator[Notice]:
    """Yield a notice if the tips are thin."""
    if part.tip_thickness < THIN_TIP * part.normal_module:
        thickness = f"normal thickness {part.tip_thickness:.4f} mm is below {THIN_TIP} m_n"
        yield Notice("thin-tip", f"thin tip: {thickness} (0.4 m_n if case-hardened)")
