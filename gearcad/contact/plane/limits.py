"""Where neither plane strain nor plane stress is what a gear is in, and where flanks are no cylinders.

A tooth that is thinner along the axis than across is free to swell: solid bodies show plane stress there, but plane strain in
the contact, which is narrow against any face width. In a ring with few more teeth than its pinion flanks are nearly alike, one
hollow, one round, and the contact can be as wide as their radii.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact
from gearcad.contact.plane.elasticity import Plane, PlaneElasticity
from gearcad.geometry import GearPair
from gearcad.notice import Notice

__all__ = ["conformal", "plane_pressure", "thin_faces", "wide_contacts"]

_WIDE = 0.04
"""Half width over the pinion's radius of curvature up to which Hertz's pressure is within 1 % of that in a ring, for as few as
ten teeth of difference; contact between external gears is that good up to 0.1.
"""


def conformal(contact: PlanePairContact) -> bool:
    """Whether a contact in a hollow flank is too wide for two cylinders."""
    pinion, wheel = contact.pair.lengths
    return wheel < 0 and contact.hertz_half_width > _WIDE * pinion


def wide_contacts(cycle: PlaneCycle) -> Iterator[Notice]:
    """Rings whose contact is conformal."""
    wide = [contact for _, contact in cycle.interior_contacts if conformal(contact)]
    if wide:
        worst = max(wide, key=lambda contact: contact.hertz_half_width / contact.place)
        text = (
            f"the contact is up to {2 * worst.hertz_half_width:.3g} mm wide in the ring's hollow flank, where the pinion has a "
            f"radius of {worst.place:.3g} mm: that is no contact of two cylinders, and Hertz can be more than 1 % off"
        )
        yield Notice("conformal-contact", text)


def thin_faces(pair: GearPair, elasticity: PlaneElasticity) -> Iterator[Notice]:
    """Gears that are too thin for plane strain."""
    if elasticity.plane is Plane.STRESS:
        return
    stiffer = 100 * elasticity.material.poisson_ratio**2
    for role, gear in pair.gears.items():
        width, thickness = gear.face_width, gear.transverse_tooth_thickness
        if width < thickness:
            text = (
                f"the {role.value}'s face width of {width:.4g} mm is below its tooth thickness, {thickness:.4g} mm: so thin a "
                "body is nearer to plane stress than to plane strain, which "
                f"makes it up to {stiffer:.2g} % too stiff; plane stress or solid bodies (3d) show it"
            )
            yield Notice("thin-face", text)


def plane_pressure(elasticity: PlaneElasticity) -> Iterator[Notice]:
    """What plane stress does to the pressure."""
    if elasticity.plane is Plane.STRAIN:
        return
    higher = 100 * (1 / math.sqrt(1 - elasticity.material.poisson_ratio**2) - 1)
    text = f"plane stress: the contact itself stays in plane strain, where its pressure is up to {higher:.2g} % higher"
    yield Notice("plane-stress-pressure", text)
