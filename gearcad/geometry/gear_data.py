"""GearData: what one gives of a gear, and the sizes that follow from it by formula (ISO 21771)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated

from gearcad.geometry.basic_rack import ISO53_A, BasicRack
from gearcad.geometry.body import Body
from gearcad.geometry.cutter import ShaperCutter
from gearcad.geometry.derived import NOT_GIVEN, Derived, is_given
from gearcad.geometry.diametral import NormalDiametralPitch, NormalModule
from gearcad.geometry.double_helix import DoubleHelix
from gearcad.geometry.modification import FlankModification
from gearcad.geometry.tooth_allowance import ToothAllowance, tooth_thickness_allowance
from gearcad.ranges import Range, Whole
from gearcad.schema import Words

__all__ = ["GearData"]


_COEFFICIENT = Range("", -5, 5)

_TEETH = Whole(3, 2000, negative=(-10, "internal gear"))

_DIAMETER = Range("mm", -2e6, 2e6)
"""Of circles that are given, negative on a ring: no permitted teeth and module make a larger gear."""


_ROUGHNESS = Range("µm", 0.01, 1000)

_NO_THINNING = Derived(0.0)

_GAP_DEPTH = 0.5
"""How much less the diameter between the halves of a double helical gear is than the root circle's, in normal modules."""


@dataclass(frozen=True, kw_only=True)
class GearData:
    """The fields of a `Gear`, unchecked, and sizes that need no outline of a tooth. Lengths in mm, angles in degrees.

    Those of an internal gear have the signs of ISO 21771: teeth and diameters are negative.
    """

    name: Annotated[str, Words("name")] = "gear"
    teeth: Annotated[int, _TEETH, Words("number of teeth", "z", "4.1")]
    normal_module: NormalModule = NOT_GIVEN
    normal_diametral_pitch: NormalDiametralPitch = NOT_GIVEN
    face_width: Annotated[float, Range("mm", 0, 10000, ends="(]"), Words("face width", "b", "4.1")]
    helix_angle: Annotated[float, Range("deg", -75, 75), Words("helix angle (right hand +)", "β", "4.2")] = 0.0
    profile_shift: Annotated[float, _COEFFICIENT, Words("profile shift coefficient", "x", "4.2")] = 0.0
    tip_alteration: Annotated[float, _COEFFICIENT, Words("tip alteration coefficient", "k", "4.5")] = 0.0
    tooth_thinning: Annotated[float, Range("mm", 0, None), Words("tooth thinning (normal)", "A_sn", "7.3")] = _NO_THINNING
    tooth_allowance: Annotated[str | None, Words("tooth thickness allowance", "", "DIN 3967")] = None
    accuracy_grade: Annotated[int | None, Whole(0, 12), Words("accuracy grade", "", "ISO 1328-1")] = None
    flank_roughness: Annotated[float | None, _ROUGHNESS, Words("roughness of the flanks", "Rz")] = None
    root_roughness: Annotated[float | None, _ROUGHNESS, Words("roughness of the roots", "Rz")] = None
    rack: BasicRack = field(default=ISO53_A)
    cutter: ShaperCutter = field(default=ShaperCutter())
    double_helix: DoubleHelix = field(default=DoubleHelix())
    body: Body = field(default=Body())
    modification: FlankModification = field(default=FlankModification())
    tip_diameter: Annotated[float, _DIAMETER, Words("tip diameter", "d_a", "4.5")] = NOT_GIVEN
    root_diameter: Annotated[float, _DIAMETER, Words("root diameter", "d_f", "4.5")] = NOT_GIVEN

    @property
    def internal(self) -> bool:
        """Whether it is an internal gear (a ring): z < 0."""
        return self.teeth < 0

    @property
    def tooth_count(self) -> int:
        """|z|."""
        return abs(self.teeth)

    @property
    def profile_shift_khk(self) -> float | None:
        """The profile shift of a ring as KHK and many programs read it, with the opposite sign; None for an external gear."""
        return 0.0 - self.profile_shift if self.internal else None

    @property
    def standard_tip_diameter(self) -> float:
        """d_a = d + 2 m_n (h_aP + x + k)."""
        rise = self.rack.addendum + self.profile_shift + self.tip_alteration
        return self.reference_diameter + 2 * self.normal_module * rise

    @property
    def standard_root_diameter(self) -> float:
        """d_f = d - 2 m_n (h_fP - x)."""
        return self.reference_diameter - 2 * self.normal_module * (self.rack.dedendum - self.profile_shift)

    @property
    def dedendum(self) -> float:
        """Dedendum h_fP of the tool in normal modules: the rack's, or (d - d_f)/(2 m_n) + x for a given root circle."""
        if not is_given(self.root_diameter):
            return self.rack.dedendum
        return (self.reference_diameter - self.root_diameter) / (2 * self.normal_module) + self.profile_shift

    @property
    def root_radius(self) -> float:
        """Tip radius of a hob in normal modules, with "full" resolved for this gear."""
        if self.rack.root_radius == "full":
            return self.rack.full_root_radius(self.dedendum, self.tooth_thinning / self.normal_module)
        return float(self.rack.root_radius)

    @cached_property
    def transverse_module(self) -> float:
        """m_t = m_n / cos beta."""
        return self.normal_module / math.cos(math.radians(self.helix_angle))

    @cached_property
    def transverse_pressure_angle(self) -> float:
        """tan alpha_t = tan alpha_n / cos beta."""
        tangent = math.tan(math.radians(self.rack.pressure_angle))
        return math.degrees(math.atan(tangent / math.cos(math.radians(self.helix_angle))))

    @cached_property
    def base_helix_angle(self) -> float:
        """sin beta_b = sin beta cos alpha_n; signed like the helix angle."""
        sine = math.sin(math.radians(self.helix_angle)) * math.cos(math.radians(self.rack.pressure_angle))
        return math.degrees(math.asin(sine))

    @cached_property
    def reference_diameter(self) -> float:
        """d = z m_t."""
        return self.teeth * self.transverse_module

    @cached_property
    def base_diameter(self) -> float:
        """d_b = d cos alpha_t."""
        return self.reference_diameter * math.cos(math.radians(self.transverse_pressure_angle))

    @property
    def normal_tooth_thickness(self) -> float:
        """s_n = m_n (pi/2 + 2 x tan alpha_n) - thinning, on the reference circle."""
        tangent = math.tan(math.radians(self.rack.pressure_angle))
        return self.normal_module * (math.pi / 2 + 2 * self.profile_shift * tangent) - self.tooth_thinning

    @cached_property
    def thickness_allowance(self) -> ToothAllowance | None:
        """A_sne and A_sni of `tooth_allowance`; None without one, whose thinning is exact."""
        if self.tooth_allowance is None:
            return None
        return tooth_thickness_allowance(self.tooth_allowance, self.reference_diameter, self.tooth_thinning)

    @property
    def transverse_tooth_thickness(self) -> float:
        """s_t = s_n / cos beta, on the reference circle."""
        return self.normal_tooth_thickness / math.cos(math.radians(self.helix_angle))

    @property
    def transverse_pitch(self) -> float:
        """p_t = pi m_t."""
        return math.pi * self.transverse_module

    @property
    def transverse_base_pitch(self) -> float:
        """p_bt = pi m_t cos alpha_t."""
        return math.pi * self.base_diameter / self.teeth

    @property
    def lead(self) -> float:
        """Lead p_z = pi d / tan |beta|; infinite for a spur gear."""
        if self.helix_angle == 0:
            return math.inf
        return math.pi * abs(self.reference_diameter) / math.tan(math.radians(abs(self.helix_angle)))

    @property
    def gap_diameter(self) -> float:
        """Diameter between the halves of a double helical gear (mm)."""
        if self.double_helix.gap_diameter is not None:
            return self.double_helix.gap_diameter
        return self.root_diameter - _GAP_DEPTH * self.normal_module

    @property
    def half_width(self) -> float:
        """Width of teeth of one hand (mm): of one half of a double helical gear, b_B = (b - b_g)/2, else b."""
        gap = self.double_helix.gap_width
        return self.face_width if gap is None else (self.face_width - gap) / 2

    @property
    def twist(self) -> float:
        """Rotation of the section over the width of one hand in degrees (magnitude): 360 b / p_z."""
        return 0.0 if self.helix_angle == 0 else 360 * self.half_width / self.lead

    @property
    def virtual_teeth(self) -> float:
        """z_n = z / (cos^2 beta_b cos beta)."""
        base, helix = math.radians(self.base_helix_angle), math.radians(self.helix_angle)
        return self.teeth / (math.cos(base) ** 2 * math.cos(helix))
