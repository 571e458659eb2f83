"""How far the sides of a mesh that are no flanks are from those of its gear: lands, tip chamfers, bore, hub and ends."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import Gear
from gearcad.meshing.bodies.exactness import chamfer_distances, face_samples
from gearcad.meshing.bodies.mesh import ElementMesh
from gearcad.meshing.bodies.names import GAP, body_side

__all__ = ["SideDeviations", "matched_distance", "side_deviations"]

_Distances = Callable[[Floats], Floats]
"""Distances (n,) in mm of points (n, 3)."""


@dataclass(frozen=True)
class SideDeviations:
    """Greatest distances from the exact sides: of nodes (mm), of which `worst` is the side, and of faces between them (µm)."""

    nodes: float
    between: float
    worst: str

    def to_dict(self) -> dict[str, Any]:
        """As mesh.json has it."""
        return {"nodes": self.nodes, "between_nodes": self.between, "worst": self.worst}


def side_deviations(mesh: ElementMesh, gear: Gear, held_radius: float) -> SideDeviations:
    """Measure root lands and tips, the bore, or a ring's rim, at `held_radius` (mm), hub and ends; not keyway and end chamfers.

    Flat ends are as flat between their nodes as at these.
    """
    nodes, between, worst = 0.0, 0.0, ""
    for name, distances, flat in _sides(mesh, gear, held_radius):
        off = float(distances(mesh.points[mesh.nodes(name)]).max())
        if not off <= nodes or not worst:
            nodes, worst = off, name
        if not flat:
            between = max(between, *(1000 * float(distances(samples).max()) for samples in face_samples(mesh, name)))
    return SideDeviations(nodes, between, worst)


def matched_distance(mesh: ElementMesh, gear: Gear, teeth: int) -> float:
    """Greatest distance (mm) of nodes ahead from those behind that are turned by so many teeth; 0 without cuts."""
    turn = 2 * math.pi * teeth / gear.tooth_count
    cosine, sine = math.cos(turn), math.sin(turn)
    turned = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    every = (mesh.points[pairs[:, 0]] @ turned.T - mesh.points[pairs[:, 1]] for pairs in mesh.matched.values())
    return max((float(np.linalg.norm(off, axis=-1).max()) for off in every), default=0.0)


def _sides(mesh: ElementMesh, gear: Gear, held_radius: float) -> Iterator[tuple[str, _Distances, bool]]:
    """The sides that are measured, how, and whether they are flat."""
    back, front = gear.body.hub_ends
    radii = {body_side(gear): held_radius, "hub": gear.body.hub_diameter / 2}
    if gear.double_helix.gap_width:
        radii[GAP] = gear.gap_diameter / 2
    heights = {
        "end_back": 0.0,
        "end_front": gear.face_width,
        "gap_back": gear.half_width,
        "gap_front": gear.face_width - gear.half_width,
        "hub_back": -back,
        "hub_front": gear.face_width + front,
    }
    solid = mesh.element.shape.dimension == 3
    for name, faces in mesh.sides.items():
        if not len(faces):
            continue
        kind, _, tooth = name.rpartition("_")
        if name in heights:
            yield name, partial(_from_height, heights[name]), True
        elif name in radii:
            yield name, partial(_from_radius, radii[name]), False
        elif kind in ("left_root", "right_root"):
            yield name, partial(_from_radius, gear.profile.root_diameter / 2), False
        elif kind == "tip":
            yield name, partial(_from_tip, gear, int(tooth), solid), False


def _from_height(height: float, points: Floats) -> Floats:
    distances: Floats = np.abs(points[:, 2] - height)
    return distances


def _from_radius(radius: float, points: Floats) -> Floats:
    distances: Floats = np.abs(np.hypot(points[:, 0], points[:, 1]) - radius)
    return distances


def _from_tip(gear: Gear, tooth: int, solid: bool, points: Floats) -> Floats:
    """From the tip circle or a tip chamfer of the tooth, whichever is nearer."""
    every = [_from_radius(gear.profile.tip_diameter / 2, points), *chamfer_distances(gear, tooth, points, solid=solid)]
    nearest: Floats = np.minimum.reduce(every)
    return nearest
