"""Data of the pictures of a check: stresses in teeth, along fillets and face width, below flanks, on lines of contact."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np

from gearcad.check.task import ShownContact
from gearcad.contact.plane.cycle import (
    PlaneCycle,
    PlanePairContact,
    PlanePosition,
    ToothField,
    contact_frame,
    root_loads,
    strip_stresses,
    tooth_field,
)
from gearcad.contact.plane.sector import Plane
from gearcad.contact.solid.cycle import (
    SolidCycle,
    SolidField,
    SolidPairContact,
    SolidPosition,
    shown_stress,
    worst_field,
    write_field,
)
from gearcad.core.records import Bools, Floats, JsonObject, PerGear, Role, Wholes
from gearcad.geometry import Gear
from gearcad.meshing.outline import OutlineSide
from gearcad.rating.contact_stress import LineContact, Stresses

ShownPlane: TypeAlias = ShownContact[PlanePosition, PlanePairContact]

_DEEPEST = 4.0
"""Depth of the profiles in half widths of contact."""


class FilletCurve(NamedTuple):
    """Stress (n,) in MPa along a fillet, over the tangent's `angles` (n,) in deg to the middle of the tooth."""

    angles: Floats
    stresses: Floats


class FilletCurves(NamedTuple):
    """Stress along both fillets of a tooth: under the loaded flank, and behind it."""

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
        """Greatest von Mises stress (MPa)."""
        return max(float(field.von_mises.max()) for field in self.fields)


@dataclass(frozen=True)
class DepthProfile:
    """Stresses of a half-plane below the middle of a contact, by the pressures `found`, and by Hertz."""

    found: Stresses
    hertz: Stresses
    hertz_contact: LineContact


def stress_field(cycle: PlaneCycle, shown: ShownPlane) -> StressField:
    """Return the stress field of the teeth in contact, and of those beside them."""
    (x, y), _ = contact_frame(cycle, shown.contact)
    teeth = range(shown.contact.tooth - 1, shown.contact.tooth + 2)
    fields = tuple(tooth_field(cycle, shown.position, role, tooth) for role in Role for tooth in teeth)
    return StressField(fields, float(x), float(y))


def fillet_curves(cycle: PlaneCycle) -> PerGear[FilletCurves]:
    """Return the stresses along the fillets of the most stressed tooth of each gear, when the gear's tension is greatest."""
    return PerGear.each(lambda role: _fillets_of(cycle, role))


def _fillets_of(cycle: PlaneCycle, role: Role) -> FilletCurves:
    fillets = cycle.model.fillets.pick(role)
    seen = root_loads(cycle.worst_position(role).contacts, role)
    worst = max(seen, key=lambda loads: fillets.greatest(OutlineSide.LEFT_FILLET, loads).stress)

    def curve(side: OutlineSide) -> FilletCurve:
        angles = fillets.places(side)[1]
        order = np.argsort(angles)
        return FilletCurve(angles[order], fillets.stresses(side, worst)[order])

    return FilletCurves(curve(OutlineSide.LEFT_FILLET), curve(OutlineSide.RIGHT_FILLET))


def depth_profile(cycle: PlaneCycle, contact: PlanePairContact) -> DepthProfile:
    """Return the stresses below the middle of a contact, some half widths deep."""
    elasticity = cycle.model.pinion.elasticity
    # In plane strain; in plane stress there is no sigma_y.
    ratio = elasticity.material.poisson_ratio if elasticity.plane is Plane.STRAIN else 0.0
    depth = contact.hertz_half_width * np.linspace(0.02, _DEEPEST, 200)
    hertz = LineContact(load_per_width=contact.force, radius=contact.pair.radius, modulus=contact.modulus, poisson_ratio=ratio)
    return DepthProfile(_below(contact, depth, ratio), hertz.stresses(depth), hertz)


def _below(contact: PlanePairContact, depth: Floats, poisson_ratio: float) -> Stresses:
    """Return the stresses below the centre of the pressures at each depth (mm), in the directions of `Stresses`."""
    cells = contact.pair.cells
    middle = float((cells.place * contact.pressures).sum() / contact.pressures.sum())
    across, down, shear = strip_stresses(np.full_like(depth, middle), depth, cells.place, cells.width, contact.pressures)
    along = poisson_ratio * (across + down)
    half, centre = np.hypot((across - down) / 2, shear), (across + down) / 2
    largest = (np.maximum(centre + half, along) - np.minimum(centre - half, along)) / 2
    mises = np.sqrt(((across - down) ** 2 + (down - along) ** 2 + (along - across) ** 2) / 2 + 3 * shear**2)
    return Stresses(depth, across, along, down, largest, mises)


ShownSolid: TypeAlias = ShownContact[SolidPosition, SolidPairContact]

_BELOW = 2.0
"""Depth of the body that is shown below the root circle, in normal modules."""

_PARTS = np.array([[0, 4, 7], [1, 5, 4], [2, 6, 5], [3, 7, 6], [4, 5, 6], [4, 6, 7]])
"""A face of four corners and four middles in triangles."""


class Cells(NamedTuple):
    """Cells of all lines of all positions (n,): places on the line of action (mm from T1) and across the common width (mm),
    roll lengths and heights on pinion and wheel (mm), line load (N/mm), pressure (MPa).

    `interior` cells are away from all edges; at those `on_edge` the edge of a tip faces the other's flank.
    """

    place: Floats
    across: Floats
    rolls: PerGear[Floats]
    heights: PerGear[Floats]
    line_load: Floats
    pressure: Floats
    interior: Bools
    on_edge: Bools

    def only(self, chosen: Bools) -> Cells:
        """Return the chosen cells."""
        return Cells(
            self.place[chosen],
            self.across[chosen],
            self.rolls.map(lambda of: of[chosen]),
            self.heights.map(lambda of: of[chosen]),
            self.line_load[chosen],
            self.pressure[chosen],
            self.interior[chosen],
            self.on_edge[chosen],
        )


class ToothStress(NamedTuple):
    """The stress field of the most stressed tooth of a gear, and where the colours of its pictures `end` (MPa)."""

    field: SolidField
    end: float

    def write(self, path: Path) -> None:
        """Write the field as a .vtu file."""
        write_field(self.field, path, self.end)


@dataclass(frozen=True)
class ToothSurface:
    """Points (n, 3) in mm from the middle of the sector, triangles (m, 3) seen from outside, von Mises stress (n,) in MPa.

    Colours end at `most` (MPa), a little above the greatest of the fillets.
    """

    points: Floats
    triangles: Wholes
    von_mises: Floats
    most: float


def loaded_cells(cycle: SolidCycle) -> Cells:
    """Return the cells of all lines of contact of a cycle."""
    contacts = [contact for position in cycle.every for contact in position.contacts]
    lines = [contact.line for contact in contacts]
    places = PerGear.each(lambda role: np.concatenate([line.places.pick(role) for line in lines], axis=1))
    return Cells(
        np.concatenate([line.nominal for line in lines]),
        np.concatenate([line.across for line in lines]),
        places.map(lambda of: of[0]),
        places.map(lambda of: of[1]),
        np.concatenate([contact.line_loads for contact in contacts]),
        np.concatenate([contact.pressures for contact in contacts]),
        np.concatenate([contact.interior for contact in contacts]),
        np.concatenate([line.on_edge for line in lines]),
    )


def tooth_stresses(cycle: SolidCycle) -> PerGear[ToothStress]:
    """Return the stress fields of the most stressed teeth of both gears, each where its root tension is greatest."""
    return PerGear.each(lambda role: _tooth_stress(cycle, role))


def _tooth_stress(cycle: SolidCycle, role: Role) -> ToothStress:
    field = worst_field(cycle, role)
    return ToothStress(field, shown_stress(cycle, role, field))


def tooth_surface(stress: ToothStress, gear: Gear) -> ToothSurface:
    """Return a tooth with the body just below it; a ring's is turned about its axis, so that its tip is where others' are."""
    field, root, below = stress.field, gear.profile.root_diameter / 2, _BELOW * gear.normal_module
    faces = (field.between(0.0, root + below) if gear.internal else field.between(root - below, math.inf)).surface
    used, index = np.unique(faces, return_inverse=True)
    triangles = index.reshape(faces.shape)[:, _PARTS].reshape(-1, 3)
    points = field.points[used]
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    upright = np.array([-1.0, -1.0, 1.0]) if gear.internal else 1.0
    return ToothSurface((points - middle) * upright, triangles, field.von_mises[used], stress.end)


class RootAlongFace(NamedTuple):
    """The greatest root tension `stress` (n,) in MPa of a cycle at `heights` (n,) in mm of a gear.

    The common face width is from `low` to `high` (mm).
    """

    heights: Floats
    stress: Floats
    low: float
    high: float

    @property
    def across(self) -> Floats:
        """The heights (n,) from the middle of the common width."""
        result: Floats = self.heights - (self.low + self.high) / 2
        return result

    @property
    def common(self) -> Bools:
        """Heights (n,) of the common width."""
        result: Bools = (self.heights >= self.low) & (self.heights <= self.high)
        return result


class AlongFace(NamedTuple):
    """Load per width (n,) in N/mm, transverse, mean of all positions, at places `across` (n,) in mm from the middle of the
    common face width; each gear's root tension.
    """

    across: Floats
    load: Floats
    roots: PerGear[RootAlongFace]

    @property
    def mean(self) -> float:
        """Mean of the load (N/mm)."""
        return float(np.mean(self.load))

    def to_dict(self) -> JsonObject:
        """Return the curves as `check.json` has them."""
        return {
            "across": self.across.tolist(),
            "load": self.load.tolist(),
            **{
                role.value: {"height": root.heights.tolist(), "root_tension": root.stress.tolist()}
                for role, root in self.roots.items()
            },
        }


def along_face(cycle: SolidCycle) -> AlongFace:
    """Return the load and the root stresses of a cycle along the face."""

    def root(role: Role) -> RootAlongFace:
        return RootAlongFace(*cycle.root_along_face(role), *cycle.model.common_heights(role))

    return AlongFace(*cycle.load_along_face, PerGear.each(root))
