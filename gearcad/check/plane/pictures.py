"""What pictures of a check in the plane show: stresses in the teeth at a contact, along the fillets, and below the flank."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np

from gearcad.arrays import Floats
from gearcad.check.shown import ShownContact
from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact, PlanePosition, root_loads
from gearcad.contact.plane.elasticity import Plane
from gearcad.contact.plane.field import ToothField, contact_frame, tooth_field
from gearcad.contact.plane.subsurface import strip_stresses
from gearcad.meshing.section.outline import Side
from gearcad.per_gear import PerGear, Role
from gearcad.rating.hertz import LineContact, Stresses

__all__ = [
    "DepthProfile",
    "FilletCurve",
    "FilletCurves",
    "Shown",
    "StressField",
    "depth_profile",
    "fillet_curves",
    "stress_field",
]

Shown: TypeAlias = ShownContact[PlanePosition, PlanePairContact]

_DEEPEST = 4.0
"""Depth of the profiles in half widths of contact."""


class FilletCurve(NamedTuple):
    """Stress (n,) in MPa along a fillet, over the tangent's `angles` (n,) in deg to the middle of the tooth."""

    angles: Floats
    stresses: Floats


class FilletCurves(NamedTuple):
    """Those of both fillets of a tooth: under the loaded flank, and behind it."""

    tension: FilletCurve
    compression: FilletCurve


@dataclass(frozen=True)
class StressField:
    """Stresses in three teeth of each gear at a contact with its centre at `x`, `y` (mm) in the frame of the fields."""

    fields: tuple[ToothField, ...]
    x: float
    y: float

    @property
    def greatest(self) -> float:
        """Von Mises stress (MPa)."""
        return max(float(field.von_mises.max()) for field in self.fields)


@dataclass(frozen=True)
class DepthProfile:
    """Stresses of a half-plane below the middle of a contact, by the pressures `found`, and by Hertz."""

    found: Stresses
    hertz: Stresses
    hertz_contact: LineContact


def stress_field(cycle: PlaneCycle, shown: Shown) -> StressField:
    """The teeth in contact, and those beside them."""
    (x, y), _ = contact_frame(cycle, shown.contact)
    teeth = range(shown.contact.tooth - 1, shown.contact.tooth + 2)
    fields = tuple(tooth_field(cycle, shown.position, role, tooth) for role in Role for tooth in teeth)
    return StressField(fields, float(x), float(y))


def fillet_curves(cycle: PlaneCycle) -> PerGear[FilletCurves]:
    """Of the most stressed tooth of each gear when the gear's tension is greatest."""
    return PerGear.each(lambda role: _fillets_of(cycle, role))


def _fillets_of(cycle: PlaneCycle, role: Role) -> FilletCurves:
    fillets = cycle.model.fillets.pick(role)
    seen = root_loads(cycle.worst_position(role).contacts, role)
    worst = max(seen, key=lambda loads: fillets.greatest(Side.LEFT_FILLET, loads).stress)

    def curve(side: Side) -> FilletCurve:
        angles = fillets.places(side)[1]
        order = np.argsort(angles)
        return FilletCurve(angles[order], fillets.stresses(side, worst)[order])

    return FilletCurves(curve(Side.LEFT_FILLET), curve(Side.RIGHT_FILLET))


def depth_profile(cycle: PlaneCycle, contact: PlanePairContact) -> DepthProfile:
    """Of a contact, some half widths deep."""
    elasticity = cycle.model.pinion.elasticity
    # In plane strain; in plane stress there is no sigma_y.
    ratio = elasticity.material.poisson_ratio if elasticity.plane is Plane.STRAIN else 0.0
    depth = contact.hertz_half_width * np.linspace(0.02, _DEEPEST, 200)
    hertz = LineContact(load_per_width=contact.force, radius=contact.pair.radius, modulus=contact.modulus, poisson_ratio=ratio)
    return DepthProfile(_below(contact, depth, ratio), hertz.stresses(depth), hertz)


def _below(contact: PlanePairContact, depth: Floats, poisson_ratio: float) -> Stresses:
    """Below the centre of the pressures, in the directions of `Stresses`."""
    cells = contact.pair.cells
    middle = float((cells.place * contact.pressures).sum() / contact.pressures.sum())
    across, down, shear = strip_stresses(np.full_like(depth, middle), depth, cells.place, cells.width, contact.pressures)
    along = poisson_ratio * (across + down)
    half, centre = np.hypot((across - down) / 2, shear), (across + down) / 2
    largest = (np.maximum(centre + half, along) - np.minimum(centre - half, along)) / 2
    mises = np.sqrt(((across - down) ** 2 + (down - along) ** 2 + (along - across) ** 2) / 2 + 3 * shear**2)
    return Stresses(depth, across, along, down, largest, mises)
