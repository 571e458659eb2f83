"""How far a mesh is from the exact flanks and fillets of its gear: at its nodes, and on its faces between them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import Gear
from gearcad.geometry.curves import Chamfer, CurveKind, Fillet, Involute
from gearcad.geometry.helix import height_in_half, section_turn, twist
from gearcad.geometry.turned import FlankCurve, flank_curves
from gearcad.meshing.bodies.interpolation import shape_values
from gearcad.meshing.bodies.mesh import ElementMesh
from gearcad.meshing.bodies.names import rises

__all__ = ["Deviations", "chamfer_distances", "deviations", "face_samples"]


_SIDE = re.compile(r"(left|right)_(flank|fillet)_(\d+)")

_STEPS = 3
"""Newton's steps from the curve's point on the same radius: a point that is nearly on it is there after one."""

_SMALL = 1e-6
"""Step of a curve's parameter over which its speed is taken."""

_CHUNK = 20_000
"""Faces that are looked at together."""

_CUBIC = 1 / math.sqrt(3)
"""Where a parabola through the ends and the middle of a cubic is farthest off, from -1 to 1; a straight line is at 0."""


@dataclass(frozen=True)
class Deviations:
    """Greatest distances from the exact, modified flanks and fillets: of nodes (mm), and of faces between them (µm).

    `worst` is the side of the latter, "" if the mesh has neither flanks nor fillets.
    """

    nodes: float
    between: float
    worst: str

    def to_dict(self) -> dict[str, Any]:
        """As mesh.json has it."""
        return {"nodes": self.nodes, "between_nodes": self.between, "worst": self.worst}


def deviations(mesh: ElementMesh, gear: Gear) -> Deviations:
    """Measure the flanks and fillets of a gear's section, which is that at mid face width, or body; distances are normal ones.

    Faces are looked at on a grid of 5 x 5 places.
    """
    nodes, between, worst = 0.0, 0.0, ""
    solid = mesh.element.shape.dimension == 3
    for name, surface in _surfaces(mesh, gear, solid=solid):
        nodes = max(nodes, float(surface.distances(mesh.points[mesh.nodes(name)]).max()))
        off = 1000 * max(float(surface.distances(samples).max()) for samples in face_samples(mesh, name))
        if off > between or not worst:
            between, worst = off, name
    return Deviations(nodes, between, worst)


def face_samples(mesh: ElementMesh, name: str) -> Iterator[Floats]:
    """Places (n, 3) on the faces of a side, some thousand faces at a time."""
    faces = mesh.face_cells(name)
    shapes = shape_values(mesh.element.shape.face, _places(mesh.element.shape.face))
    for start in range(0, len(faces), _CHUNK):
        yield np.einsum("pa,mac->mpc", shapes, mesh.points[faces[start : start + _CHUNK]]).reshape(-1, 3)


def chamfer_distances(gear: Gear, tooth: int, points: Floats, *, solid: bool) -> list[Floats]:
    """Distances (n,) in mm of points (n, 3) near them from the left and the right tip chamfer of a tooth, if it has them."""
    place = 2 * math.pi * tooth / gear.tooth_count
    chamfers = [each for each in flank_curves(gear) if each.curve.kind is CurveKind.CHAMFER]
    return [_Surface(gear, each, left, place, solid).distances(points) for each in chamfers for left in (True, False)]


def _surfaces(mesh: ElementMesh, gear: Gear, *, solid: bool) -> Iterator[tuple[str, _Surface]]:
    """The named flanks and fillets, and what they should be."""
    form, curves = gear.flank_form, {each.curve.kind: each for each in flank_curves(gear)}
    flank = next(curve for curve in gear.profile.curves if isinstance(curve, Involute))
    parts = {"fillet": curves[CurveKind.FILLET], "flank": FlankCurve(flank, form.first, form.last)}
    for name, faces in mesh.sides.items():
        if (match := _SIDE.fullmatch(name)) and len(faces):
            side, part, tooth = match.groups()
            yield name, _Surface(gear, parts[part], rises(gear, side), 2 * math.pi * int(tooth) / gear.tooth_count, solid)


@dataclass(frozen=True)
class _Surface:
    """One flank or fillet of the tooth at `place` (rad), of a body, or of the section at mid face width."""

    gear: Gear
    piece: FlankCurve
    left: bool
    place: float
    solid: bool

    def distances(self, points: Floats) -> Floats:
        """Distances (n,) in mm of points (n, 3) that are near the surface."""
        curve, sense = self.piece.curve, 1 if self.left else -1
        x, y, z = points.T
        gear, middle = self.gear, self.gear.half_width / 2
        height = height_in_half(gear, z) if self.solid else np.full_like(z, middle)
        rate, helix = (twist(gear), section_turn(gear, z)) if self.solid else (0.0, 0.0)
        radius, angle = np.hypot(x, y), sense * (np.arctan2(y, x) - self.place - helix)
        s = self._on_radius(radius)
        for _ in range(_STEPS):
            turned = angle - sense * self.piece.turn(self.gear.flank_form, s, height, left=self.left)
            off = np.stack([radius * np.cos(turned), radius * np.sin(turned)], -1) - curve.points(s)
            heading = curve.direction(s)
            along = off[:, 0] * np.cos(heading) + off[:, 1] * np.sin(heading)
            across = off[:, 1] * np.cos(heading) - off[:, 0] * np.sin(heading)
            s = s + along / self._speed(s)
        # The section cuts the surface at a slant: the way to it in space is shorter than in the section.
        slant = rate * radius * np.cos(heading - curve.polar(s)[1])
        distance: Floats = np.abs(across) / np.hypot(1.0, slant)
        return distance

    def _on_radius(self, radius: Floats) -> Floats:
        """Parameters (n,) of the curve's points on these radii (mm), or of its ends."""
        curve = self.piece.curve
        if isinstance(curve, Involute):
            base = curve.base_radius
            roll = np.sqrt(np.maximum((radius - base) * (radius + base), 0.0)) / base
            found = (roll - curve.first) / (curve.last - curve.first)
        elif isinstance(curve, Chamfer):
            run = (np.sqrt(np.maximum(2 * radius**2 - curve.radius**2, 0.0)) - curve.radius) / 2
            found = np.abs(run) / curve.run
        else:
            assert isinstance(curve, Fillet)
            theta = curve.tool.theta_at(radius, curve.last)
            found = np.arcsinh(np.tan(theta)) / math.asinh(math.tan(curve.last))
        on_curve: Floats = np.clip(found, 0.0, 1.0)
        return on_curve

    def _speed(self, s: Floats) -> Floats:
        """Length (mm) per parameter."""
        low, high = np.maximum(s - _SMALL, 0.0), np.minimum(s + _SMALL, 1.0)
        curve = self.piece.curve
        step = np.hypot(*(curve.points(high) - curve.points(low)).T)
        speed: Floats = np.maximum(step / np.maximum(high - low, _SMALL), 1e-9)
        return speed


@cache
def _places(face: str) -> Floats:
    """Local places (n, dimension) at which a face is looked at: on its edges and inside."""
    line = np.array([-1.0, -_CUBIC, 0.0, _CUBIC, 1.0])
    if face == "line3":
        return line[:, None]
    if face == "tri6":
        share = (1 + line) / 2
        return np.array([[a, b] for a in share for b in share if a + b <= 1 + 1e-12])
    return np.array([[a, b] for a in line for b in line])
