"""Where neither plane strain nor plane stress is what a gear is in.

A tooth that is thinner along the axis than across is free to swell: solid bodies show plane stress there, but plane strain in
the contact, which is narrow against any face width.
"""

from __future__ import annotations

import math

from gearcad.contact.plane.elasticity import Plane, PlaneElasticity
from gearcad.geometry import GearPair

__all__ = ["plane_pressure", "thin_faces"]


def thin_faces(pair: GearPair, elasticity: PlaneElasticity) -> list[str]:
    """Gears that are too thin for plane strain, in words."""
    if elasticity.plane is Plane.STRESS:
        return []
    stiffer = 100 * elasticity.material.poisson_ratio**2
    return [
        f"the {owner}'s face width of {gear.face_width:.4g} mm is below its tooth thickness, "
        f"{gear.transverse_tooth_thickness:.4g} mm: so thin a body is nearer to plane stress than to plane strain, which makes "
        f"it up to {stiffer:.2g} % too stiff; plane stress or solid bodies (3d) show it"
        for owner, gear in (("pinion", pair.pinion), ("wheel", pair.wheel))
        if gear.face_width < gear.transverse_tooth_thickness
    ]


def plane_pressure(elasticity: PlaneElasticity) -> list[str]:
    """What plane stress does to the pressure, in words."""
    if elasticity.plane is Plane.STRAIN:
        return []
    higher = 100 * (1 / math.sqrt(1 - elasticity.material.poisson_ratio**2) - 1)
    return [f"plane stress: the contact itself stays in plane strain, where its pressure is up to {higher:.2g} % higher"]
