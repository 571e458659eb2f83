"""A solid gear under the loads along lines of contact that our own check has found, as a deck."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TextIO

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.shared.engaged import roll_lengths
from gearcad.contact.solid.places import Places
from gearcad.decks.calculix import number
from gearcad.decks.solid import SolidDecks
from gearcad.decks.tooth import ToothDeck
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.bodies.interpolation import shape_values
from gearcad.meshing.bodies.mesh import joined
from gearcad.meshing.bodies.names import rises
from gearcad.per_gear import Role

__all__ = ["SolidToothDeck", "solid_tooth_deck"]


_MIRRORED = np.array([1.0, -1.0, 1.0])
"""Mirrors vectors: our solution has every loaded flank on the side y > 0 of its tooth."""


@dataclass(frozen=True)
class SolidToothDeck(ToothDeck):
    """Forces (n, 3) in N on `nodes` (n,) of a body."""

    nodes: Wholes
    forces: Floats

    def write_loads(self, file: TextIO) -> None:
        """Forces on nodes."""
        file.write("*CLOAD\n")
        for node, force in zip(self.nodes.tolist(), self.forces.tolist(), strict=True):
            file.writelines(f"{node + 1}, {axis}, {number(part)}\n" for axis, part in enumerate(force, 1) if part)


def solid_tooth_deck(decks: SolidDecks, roll_angle: float, role: Role) -> SolidToothDeck:
    """A gear at a roll angle (deg), in coordinates of its own. Raises SolverError and GeometryError."""
    position, gear = decks.cycle.solve(roll_angle), decks.pair.gears.pick(role)
    mesh = joined({role.value: decks.mesh(role, {})})
    exact, forces = decks.cycle.model.bodies.pick(role).flank, np.zeros_like(mesh.points)
    for contact in position.contacts:
        tooth, places = decks.tooth(role, contact.tooth), contact.line.places.pick(role)
        pressing = contact.forces[:, None] * exact.inward(places)
        if not rises(gear, decks.flank_side):
            pressing = pressing * _MIRRORED
        turned = _turned(pressing, 2 * math.pi * tooth / gear.tooth_count)
        _lay(forces, mesh, decks.side(role, tooth, "flank"), exact.base_radius, places, turned)
    nodes = np.flatnonzero(forces.any(axis=1))
    return SolidToothDeck(decks, role, mesh, position, nodes, forces[nodes])


def _lay(forces: Floats, mesh: ElementMesh, flank: str, base_radius: float, places: Places, pressing: Floats) -> None:
    """Add forces `pressing` (n, 3) in N at places of a flank to those of the nodes (nodes, 3), as shape functions share them.

    On a face of a swept flank the height goes with one local coordinate, the square of the roll length with the other: nodes
    between vertices are half-way in arc length.
    """
    nodes = mesh.face_cells(flank)
    corners = mesh.points[nodes[:, :4]]
    squares = roll_lengths(np.hypot(corners[..., 0], corners[..., 1]), base_radius) ** 2
    along, up = (places[0] ** 2)[:, None], places[1][:, None]
    across = 2 * (along - squares[:, 0]) / (squares[:, 1] - squares[:, 0]) - 1
    above = 2 * (up - corners[:, 0, 2]) / (corners[:, 3, 2] - corners[:, 0, 2]) - 1
    face = np.argmin(np.maximum(np.abs(across), np.abs(above)), axis=1)
    every = np.arange(len(face))
    local = np.clip(np.stack([across[every, face], above[every, face]], -1), -1, 1)
    shares = shape_values(mesh.element.shape.face, local)
    np.add.at(forces, nodes[face], shares[:, :, None] * pressing[:, None])


def _turned(vectors: Floats, angle: float) -> Floats:
    """Vectors (n, 3) turned about the z axis by an angle (rad)."""
    cosine, sine = math.cos(angle), math.sin(angle)
    result: Floats = vectors @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return result
