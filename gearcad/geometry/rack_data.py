"""RackData: what one gives of a rack, and the sizes that follow from it by formula (ISO 21771: a gear of infinite diameter)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated

from gearcad.geometry.basic_rack import ISO53_A, BasicRack
from gearcad.geometry.derived import NOT_GIVEN
from gearcad.geometry.diametral import NormalDiametralPitch, NormalModule
from gearcad.ranges import Range, Whole
from gearcad.schema import Words

__all__ = ["RackData"]

_LENGTH = Range("mm", 0, None, ends="(]")
_FEATURE = Range("mm", 0, None)

WHOLE_PITCH = 1e-9
"""Share of a pitch by which a given length may miss a whole number of them, as printed lengths do."""


@dataclass(frozen=True, kw_only=True)
class RackData:
    """The fields of a `Rack`, unchecked, and sizes that need no outline of a tooth. Lengths in mm, angles in degrees."""

    name: Annotated[str, Words("name")] = "rack"
    teeth: Annotated[int | None, Whole(1, 2000), Words("number of teeth (whole pitches)", "z")] = None
    length: Annotated[float, _LENGTH, Words("length", "L")] = NOT_GIVEN
    normal_module: NormalModule = NOT_GIVEN
    normal_diametral_pitch: NormalDiametralPitch = NOT_GIVEN
    helix_angle: Annotated[float, Range("deg", -75, 75), Words("helix angle (right hand +)", "β", "4.2")] = 0.0
    face_width: Annotated[float, Range("mm", 0, 10000, ends="(]"), Words("face width", "b", "4.1")]
    height: Annotated[float, Range("mm", 0, 10000, ends="(]"), Words("height, back to reference line", "H_0")]
    tip_alteration: Annotated[float, Range("", -5, 5), Words("tip alteration coefficient", "k", "4.5")] = 0.0
    tooth_thinning: Annotated[float, Range("mm", 0, None), Words("tooth thinning (normal)", "A_sn", "7.3")] = 0.0
    tip_chamfer: Annotated[float, _FEATURE, Words("tip chamfer, height", "h_K", "6.1")] = 0.0
    rack: BasicRack = field(default=ISO53_A)

    @property
    def root_radius(self) -> float:
        """Radius of the fillets in normal modules, with "full" resolved."""
        if self.rack.root_radius == "full":
            return self.rack.full_root_radius(thinning=self.tooth_thinning / self.normal_module)
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

    @property
    def normal_pitch(self) -> float:
        """p_n = pi m_n, square to the teeth."""
        return math.pi * self.normal_module

    @property
    def transverse_pitch(self) -> float:
        """p_t = pi m_t, along the rack."""
        return math.pi * self.transverse_module

    @property
    def transverse_base_pitch(self) -> float:
        """p_bt = p_t cos alpha_t."""
        return self.transverse_pitch * math.cos(math.radians(self.transverse_pressure_angle))

    @property
    def normal_tooth_thickness(self) -> float:
        """s_n = pi m_n/2 - thinning, on the reference line."""
        return self.normal_module * math.pi / 2 - self.tooth_thinning

    @property
    def transverse_tooth_thickness(self) -> float:
        """s_t = s_n / cos beta, on the reference line."""
        return self.normal_tooth_thickness / math.cos(math.radians(self.helix_angle))

    @property
    def tip_height(self) -> float:
        """h_a = m_n (h_aP + k), above the reference line."""
        return self.normal_module * (self.rack.addendum + self.tip_alteration)

    @property
    def tip_form_height(self) -> float:
        """Where the straight flank ends, above the reference line: the tip less its chamfer."""
        return self.tip_height - self.tip_chamfer

    @property
    def root_depth(self) -> float:
        """h_f = m_n h_fP, below the reference line."""
        return self.normal_module * self.rack.dedendum

    @property
    def form_depth(self) -> float:
        """h_Ff = h_f - rho_f (1 - sin alpha_n): where the straight flank begins, below the reference line."""
        radius = self.root_radius * self.normal_module
        return self.root_depth - radius * (1 - math.sin(math.radians(self.rack.pressure_angle)))

    @property
    def tip_thickness(self) -> float:
        """s_an = s_n - 2 h_a tan alpha_n: normal tooth thickness at the tip, before a tip chamfer."""
        return self.normal_tooth_thickness - 2 * self.tip_height * math.tan(math.radians(self.rack.pressure_angle))

    @property
    def total_height(self) -> float:
        """From the back to the tips."""
        return self.height + self.tip_height

    @property
    def whole_pitches(self) -> int:
        """How many pitches the length holds."""
        return math.floor(self.length / self.transverse_pitch + WHOLE_PITCH)

    @property
    def drift(self) -> float:
        """How far a tooth moves along +x (mm) per mm of height z: -tan beta, as a right-hand tooth on +y does."""
        return 0.0 - math.tan(math.radians(self.helix_angle))
