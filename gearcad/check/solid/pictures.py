"""What pictures of a check of solid bodies show: the cells of all lines of contact, and the surface of a tooth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.check.shown import ShownContact
from gearcad.contact.solid.contact import SolidPairContact
from gearcad.contact.solid.cycle import SolidCycle, SolidPosition
from gearcad.contact.solid.field import SolidField, shown_stress, worst_field, write_vtu
from gearcad.geometry import Gear
from gearcad.per_gear import PerGear, Role

__all__ = [
    "Cells",
    "Shown",
    "ToothStress",
    "ToothSurface",
    "loaded_cells",
    "tooth_stresses",
    "tooth_surface",
]

Shown: TypeAlias = ShownContact[SolidPosition, SolidPairContact]

_BELOW = 2.0
"""How much of the body below the root circle is shown, in normal modules."""

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
        """Some of the cells."""
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
        """As a .vtu."""
        write_vtu(self.field, path, self.end)


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
    """All of a cycle."""
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
    """Of both gears, each where its root tension is greatest."""
    return PerGear.each(lambda role: _tooth_stress(cycle, role))


def _tooth_stress(cycle: SolidCycle, role: Role) -> ToothStress:
    field = worst_field(cycle, role)
    return ToothStress(field, shown_stress(cycle, role, field))


def tooth_surface(stress: ToothStress, gear: Gear) -> ToothSurface:
    """A tooth with the body just below it; a ring's is turned about its axis, so that its tip is where others' are."""
    field, root, below = stress.field, gear.profile.root_diameter / 2, _BELOW * gear.normal_module
    faces = (field.between(0.0, root + below) if gear.internal else field.between(root - below, math.inf)).surface
    used, index = np.unique(faces, return_inverse=True)
    triangles = index.reshape(faces.shape)[:, _PARTS].reshape(-1, 3)
    points = field.points[used]
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    upright = np.array([-1.0, -1.0, 1.0]) if gear.internal else 1.0
    return ToothSurface((points - middle) * upright, triangles, field.von_mises[used], stress.end)
