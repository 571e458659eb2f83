"""The root of a rack's tooth: that of an external gear of infinitely many teeth, whose fillet is an arc.

The standard has no clause on racks. Its equations of external gears have this limit: tangents at 30 degrees to the middle of
the tooth, in the normal section, and a load that leans by the pressure angle. Lengths in mm, angles in degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcad.errors import GeometryError
from gearcad.geometry import Rack
from gearcad.rating.root_section import RootSection
from gearcad.rating.virtual import LoadPoint, VirtualGear

__all__ = ["RackLoadPoint", "rack_load_point", "rack_section", "virtual_rack"]

_LEAN = math.radians(30)


@dataclass(frozen=True, kw_only=True)
class RackLoadPoint(LoadPoint):
    """Outer point of single pair contact on a rack, `height` (mm) above its reference line."""

    height: float

    def to_dict(self) -> dict[str, float]:
        """Values under their symbols: there is no diameter."""
        return {"h_en": self.height, "alpha_Fen": self.load_angle}


def virtual_rack(rack: Rack) -> VirtualGear:
    """The normal section of a rack: a gear of infinite size."""
    return VirtualGear(
        normal_module=rack.normal_module,
        pressure_angle=rack.rack.pressure_angle,
        teeth=math.inf,
        reference_diameter=math.inf,
        base_diameter=math.inf,
        tip_diameter=math.inf,
        tooth_angle=0.0,
    )


def rack_load_point(rack: Rack, virtual_contact_ratio: float) -> RackLoadPoint:
    """Where a single pair carries at the greatest lever: eps_alphan - 1 base pitches down the line of action from the tip."""
    angle = math.radians(rack.rack.pressure_angle)
    down = (virtual_contact_ratio - 1) * rack.normal_pitch * math.cos(angle) * math.sin(angle)
    return RackLoadPoint(
        diameter=math.inf,
        pressure_angle=rack.rack.pressure_angle,
        half_angle=0.0,
        load_angle=rack.rack.pressure_angle,
        height=rack.tip_form_height - down,
    )


def rack_section(rack: Rack, load: RackLoadPoint) -> RootSection:
    """The section at the 30-degree tangents, and the arm at which the load bends it.

    The middle of the fillet's arc is u = s_n/2 + (h_f - rho) tan alpha_n + rho/cos alpha_n from the middle of the tooth. Raises
    GeometryError for a rack without fillets, or whose load passes below the section.
    """
    angle, rho = math.radians(rack.rack.pressure_angle), rack.root_radius * rack.normal_module
    if rho <= 0:
        raise GeometryError("rack.rack.root_radius", 0.0, "must be above 0 for a rating: stress has no limit in a sharp corner")
    depth = rack.root_depth - rho
    u = rack.normal_tooth_thickness / 2 + depth * math.tan(angle) + rho / math.cos(angle)
    half_chord, foot = u - rho * math.cos(_LEAN), -depth - rho * math.sin(_LEAN)
    half_thickness = rack.normal_tooth_thickness / 2 - load.height * math.tan(angle)
    arm = load.height - half_thickness * math.tan(angle) - foot
    if arm <= 0:
        permitted = "must be less for a rating: the load passes below the root section, and does not bend the tooth"
        raise GeometryError("rack.rack.pressure_angle", rack.rack.pressure_angle, permitted, "deg")
    return RootSection(
        tangent_angle=90 - math.degrees(_LEAN),
        chord=2 * half_chord,
        fillet_radius=rho,
        moment_arm=arm,
        on_fillet=angle <= _LEAN,
    )
