"""Where neither plane strain nor plane stress is what a gear is in, and where flanks are no cylinders.

A tooth that is thinner along the axis than across is free to swell: solid bodies show plane stress there, but plane strain in
the contact, which is narrow against any face width.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact
from gearcad.contact.plane.elasticity import Plane
from gearcad.contact.shared.conformal import HollowContact, conformal_notices
from gearcad.geometry import GearPair
from gearcad.material import Materials, of_both
from gearcad.notice import Notice

__all__ = ["conformal", "plane_pressure", "thin_faces", "wide_contacts"]


def conformal(contact: PlanePairContact) -> bool:
    """Whether a contact in a hollow flank is too wide for two cylinders."""
    return contact.pair.lengths.wheel < 0 and _hollow(contact).conformal


def wide_contacts(cycle: PlaneCycle) -> Iterator[Notice]:
    """Rings whose contact is conformal."""
    if cycle.model.pair.internal:
        yield from conformal_notices(_hollow(contact) for _, contact in cycle.interior_contacts)


def _hollow(contact: PlanePairContact) -> HollowContact:
    return HollowContact(contact.hertz_half_width, contact.pair.lengths.pinion)


def thin_faces(pair: GearPair, material: Materials, plane: Plane) -> Iterator[Notice]:
    """Gears that are too thin for plane strain."""
    if plane is Plane.STRESS:
        return
    for role, gear in pair.gears.items():
        stiffer = 100 * of_both(material).pick(role).poisson_ratio ** 2
        width, thickness = gear.face_width, gear.transverse_tooth_thickness
        if width < thickness:
            text = (
                f"the {role.value}'s face width of {width:.4g} mm is below its tooth thickness, {thickness:.4g} mm: so thin a "
                "body is nearer to plane stress than to plane strain, which "
                f"makes it up to {stiffer:.2g} % too stiff; plane stress or solid bodies (3d) show it"
            )
            yield Notice("thin-face", text)


def plane_pressure(material: Materials, plane: Plane) -> Iterator[Notice]:
    """What plane stress does to the pressure."""
    if plane is Plane.STRAIN:
        return
    higher = 100 * (1 / math.sqrt(1 - max(of.poisson_ratio for of in of_both(material)) ** 2) - 1)
    text = f"plane stress: the contact itself stays in plane strain, where its pressure is up to {higher:.2g} % higher"
    yield Notice("plane-stress-pressure", text)
