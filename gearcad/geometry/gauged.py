"""The teeth of a gear as gauges meet them: the Inspection that its data make."""

from __future__ import annotations

from gearcad.geometry.gear_data import GearData
from gearcad.geometry.inspection import Inspection
from gearcad.geometry.internal_inspection import InternalInspection
from gearcad.geometry.profile import base_half_angle

__all__ = ["inspection_of"]


def inspection_of(gear: GearData, middle_diameter: float) -> Inspection:
    """That of a gear, external or internal, whose gauges had best touch on a diameter (mm, signed as its own).

    Of data whose tip diameter is not known yet it gives everything but chordal heights.
    """
    kind = InternalInspection if gear.internal else Inspection
    thickness, angle = gear.normal_tooth_thickness, gear.transverse_pressure_angle
    return kind(
        teeth=gear.teeth,
        normal_module=gear.normal_module,
        pressure_angle=gear.rack.pressure_angle,
        helix_angle=gear.helix_angle,
        transverse_pressure_angle=angle,
        base_helix_angle=gear.base_helix_angle,
        base_diameter=gear.base_diameter,
        normal_tooth_thickness=thickness,
        base_half_angle=base_half_angle(gear.teeth, thickness, gear.normal_module, angle),
        middle_diameter=middle_diameter,
        addendum=(gear.tip_diameter - gear.reference_diameter) / 2,
        lead=gear.lead,
    )
