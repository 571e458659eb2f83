"""Distance of a mesh from the exact gear: flanks, fillets, other sides, and the size of the exact gear."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial.chebyshev import chebpts1
from numpy.polynomial.legendre import leggauss

from gearcad.core.records import Floats, JsonObject
from gearcad.geometry import Gear
from gearcad.geometry.curves import Chamfer, Curve, CurveKind, Involute, parameter_at
from gearcad.geometry.gear import FlankCurve, flank_curves, middle_section
from gearcad.geometry.gear_data import height_in_half, section_turn, twist
from gearcad.meshing.bodies.element_mesh import GAP, ElementMesh, body_side, rises
from gearcad.meshing.fem import shape_values

_DEGREE = 48
"""Degree of the polynomials that stand for a curve's radius and angle: they come within rounding of all of them."""

_PLACES, _WEIGHTS = leggauss(16)


def exact_area(gear: Gear, held_radius: float) -> float:
    """Return the area (mm²) of one tooth and its share of the body up to `held_radius` (mm), at mid face width."""
    return _body(gear, middle_section(gear), held_radius)


def exact_volume(gear: Gear, held_radius: float) -> float:
    """Return the volume (mm³) of one tooth and its share of the body over the face width, with flanks modified as they are."""
    plain = _body(gear, gear.profile.curves, held_radius) * gear.face_width
    if not gear.modification.present:
        return plain
    taken = sum(_taken(gear, left=left) for left in (True, False))
    return plain - (2 * taken if gear.double_helix.present else taken)


def _body(gear: Gear, curves: Iterable[Curve], held_radius: float) -> float:
    """Return the area (mm²) between the curves of half a tooth, twice, and the circle where the body ends."""
    between = _area(curves) - math.pi / gear.tooth_count * held_radius**2
    return -between if gear.internal else between


def _area(curves: Iterable[Curve]) -> float:
    """Return the area (mm²) from the curves of half a tooth, twice, down to the centre."""
    area = 0.0
    for curve in curves:
        radius, angle = _polar(curve)
        swept = (radius**2 * angle.deriv()).integ()
        area += float(swept(0.0) - swept(1.0))  # angles fall from the middle of the space to that of the tooth
    return area


def _polar(curve: Curve) -> tuple[Chebyshev, Chebyshev]:
    """Return the radius (mm) and half tooth angle (rad) along a curve."""
    places = (1 + chebpts1(_DEGREE + 1)) / 2
    radius, angle = (Chebyshev.fit(places, values, _DEGREE, domain=[0, 1]) for values in curve.polar(places))
    return radius, angle


def _taken(gear: Gear, *, left: bool) -> float:
    """Volume (mm³) that modifications take from one side of a tooth, of one half: each point goes its turn times its radius."""
    form, taken = gear.flank_form, 0.0
    sense = (-1 if left else 1) * (-1 if gear.internal else 1)  # radii of a ring fall along its curves
    for low, high in pairwise(sorted((0.0, *form.height_breaks, gear.half_width / 2, gear.half_width))):
        z = (low + high) / 2 + (high - low) / 2 * _PLACES
        for piece in flank_curves(gear):
            radius, _ = _polar(piece.curve)
            s = (1 + _PLACES) / 2
            moved = sense * piece.turn(form, s[:, None], z[None], left=left)
            lever = radius(s) * radius.deriv()(s) * _WEIGHTS / 2
            taken += float(lever @ moved @ _WEIGHTS) * (high - low) / 2
    return taken


_SIDE = re.compile(r"(left|right)_(flank|fillet)_(\d+)")

_STEPS = 3
"""Newton's steps from the curve's point on the same radius: a point that is nearly on it is there after one."""

_SMALL = 1e-6
"""Step of a curve's parameter over which its speed is taken."""

_CHUNK = 20_000
"""Faces that are looked at together."""

_CUBIC = 1 / math.sqrt(3)
"""Place, from -1 to 1, where a parabola through the ends and the middle of a cubic deviates most; a straight line deviates most
at 0.
"""


Distances = Callable[[Floats], Floats]
"""Distances (n,) in mm of points (n, 3)."""


@dataclass(frozen=True)
class Deviations:
    """Greatest distances from the exact, modified flanks and fillets: of nodes (mm), and of faces between them (µm).

    `worst` is the side of the latter, "" if the mesh has neither flanks nor fillets.
    """

    nodes: float
    between: float
    worst: str

    def to_dict(self) -> JsonObject:
        """Return the deviations as an entry of mesh.json."""
        return {"nodes": self.nodes, "between_nodes": self.between, "worst": self.worst}


_ALIKE = 1e-6
"""Relative difference by rounding of the deviations of both sides of a symmetric tooth, of which the first is named."""


def deviations(mesh: ElementMesh, gear: Gear) -> Deviations:
    """Measure the flanks and fillets of a gear's section, which is that at mid face width, or body; distances are normal ones.

    Faces are looked at on a grid of 5 x 5 places.
    """
    solid = mesh.element.shape.dimension == 3
    return greatest_deviations(mesh, ((name, each.distances) for name, each in _surfaces(mesh, gear, solid=solid)))


def greatest_deviations(mesh: ElementMesh, sides: Iterable[tuple[str, Distances]]) -> Deviations:
    """Return the greatest distances of sides that functions measure: of their nodes, and of their faces between them."""
    nodes, between, worst = 0.0, 0.0, ""
    for name, distances in sides:
        nodes = max(nodes, float(distances(mesh.points[mesh.nodes(name)]).max()))
        off = 1000 * max(float(distances(samples).max()) for samples in face_samples(mesh, name))
        if off > between * (1 + _ALIKE) or not worst:
            worst = name
        between = max(between, off)
    return Deviations(nodes, between, worst)


def face_samples(mesh: ElementMesh, name: str) -> Iterator[Floats]:
    """Yield the places (n, 3) on the faces of a side, some thousand faces at a time."""
    faces = mesh.face_cells(name)
    shapes = shape_values(mesh.element.shape.face, _places(mesh.element.shape.face))
    for start in range(0, len(faces), _CHUNK):
        yield np.einsum("pa,mac->mpc", shapes, mesh.points[faces[start : start + _CHUNK]]).reshape(-1, 3)


def chamfer_distances(gear: Gear, tooth: int, points: Floats, *, solid: bool) -> list[Floats]:
    """Return the distances (n,) in mm of points (n, 3) near them from the left and the right tip chamfer of a tooth, if it has
    them.
    """
    place = 2 * math.pi * tooth / gear.tooth_count
    chamfers = [each for each in flank_curves(gear) if each.curve.kind is CurveKind.CHAMFER]
    return [_Surface(gear, each, left, place, solid).distances(points) for each in chamfers for left in (True, False)]


def _surfaces(mesh: ElementMesh, gear: Gear, *, solid: bool) -> Iterator[tuple[str, _Surfaces]]:
    """Yield the named flanks and fillets, with the exact surfaces that they should lie on."""
    form = gear.flank_form
    parts = {
        "fillet": [each for each in flank_curves(gear) if each.curve.kind is CurveKind.FILLET],
        "flank": [FlankCurve(gear.profile.involute, form.first, form.last)],
    }
    for name, faces in mesh.sides.items():
        if (match := _SIDE.fullmatch(name)) and len(faces):
            side, part, tooth = match.groups()
            place = 2 * math.pi * int(tooth) / gear.tooth_count
            yield name, _Surfaces([_Surface(gear, each, rises(gear, side), place, solid) for each in parts[part]])


class _Surfaces(NamedTuple):
    """Surfaces of one side of a mesh, of which each of its nodes is on one."""

    pieces: list[_Surface]

    def distances(self, points: Floats) -> Floats:
        """Return the distances (n,) in mm of points (n, 3) from the nearest piece."""
        nearest: Floats = np.min([piece.distances(points) for piece in self.pieces], axis=0)
        return nearest


@dataclass(frozen=True)
class _Surface:
    """One flank or fillet of the tooth at `place` (rad), of a body, or of the section at mid face width."""

    gear: Gear
    piece: FlankCurve
    left: bool
    place: float
    solid: bool

    def distances(self, points: Floats) -> Floats:
        """Return the distances (n,) in mm of points (n, 3) that are near the surface."""
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
        """Return the parameters (n,) of the curve's points on these radii (mm), or of its ends."""
        curve = self.piece.curve
        if isinstance(curve, Involute):
            base = curve.base_radius
            roll = np.sqrt(np.maximum((radius - base) * (radius + base), 0.0)) / base
            found = (roll - curve.first) / (curve.last - curve.first)
        elif isinstance(curve, Chamfer):
            run = (np.sqrt(np.maximum(2 * radius**2 - curve.radius**2, 0.0)) - curve.radius) / 2
            found = np.abs(run) / curve.run
        else:
            found = parameter_at(curve, radius)
        on_curve: Floats = np.clip(found, 0.0, 1.0)
        return on_curve

    def _speed(self, s: Floats) -> Floats:
        """Return the length (mm) per parameter."""
        low, high = np.maximum(s - _SMALL, 0.0), np.minimum(s + _SMALL, 1.0)
        curve = self.piece.curve
        step = np.hypot(*(curve.points(high) - curve.points(low)).T)
        speed: Floats = np.maximum(step / np.maximum(high - low, _SMALL), 1e-9)
        return speed


@cache
def _places(face: str) -> Floats:
    """Local places (n, dimension) at which a face is looked at: on its edges and inside."""
    line = (1 + np.array([-1.0, -_CUBIC, 0.0, _CUBIC, 1.0])) / 2
    if face == "line3":
        return line[:, None]
    if face == "tri6":
        return np.array([[a, b] for a in line for b in line if a + b <= 1 + 1e-12])
    return np.array([[a, b] for a in line for b in line])


@dataclass(frozen=True)
class SideDeviations:
    """Greatest distances from the exact sides: of nodes (mm), of which `worst` is the side, and of faces between them (µm)."""

    nodes: float
    between: float
    worst: str

    def to_dict(self) -> JsonObject:
        """Return the deviations as an entry of mesh.json."""
        return {"nodes": self.nodes, "between_nodes": self.between, "worst": self.worst}


def side_deviations(mesh: ElementMesh, gear: Gear, held_radius: float) -> SideDeviations:
    """Measure root lands and tips, the bore, or a ring's rim, at `held_radius` (mm), hub and ends; not keyway and end chamfers.

    Flat ends are as flat between their nodes as at these.
    """
    return greatest_of_sides(mesh, _sides(mesh, gear, held_radius))


def greatest_of_sides(mesh: ElementMesh, sides: Iterable[tuple[str, Distances, bool]]) -> SideDeviations:
    """Return the greatest distances of sides that functions measure; those of flat ones between nodes are left out."""
    nodes, between, worst = 0.0, 0.0, ""
    for name, distances, flat in sides:
        off = float(distances(mesh.points[mesh.nodes(name)]).max())
        if not off <= nodes or not worst:
            nodes, worst = off, name
        if not flat:
            between = max(between, *(1000 * float(distances(samples).max()) for samples in face_samples(mesh, name)))
    return SideDeviations(nodes, between, worst)


def matched_distance(mesh: ElementMesh, gear: Gear, teeth: int) -> float:
    """Return the greatest distance (mm) of nodes ahead from those behind that are turned by so many teeth; 0 without cuts."""
    turn = 2 * math.pi * teeth / gear.tooth_count
    cosine, sine = math.cos(turn), math.sin(turn)
    turned = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    every = (mesh.points[pairs[:, 0]] @ turned.T - mesh.points[pairs[:, 1]] for pairs in mesh.matched.values())
    return max((float(np.linalg.norm(off, axis=-1).max()) for off in every), default=0.0)


def _sides(mesh: ElementMesh, gear: Gear, held_radius: float) -> Iterator[tuple[str, Distances, bool]]:
    """Yield the sides that are measured, the functions that measure them, and whether they are flat."""
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
    """Return the distances (mm) of points from the tip circle or a tip chamfer of the tooth, whichever is nearer."""
    every = [_from_radius(gear.profile.tip_diameter / 2, points), *chamfer_distances(gear, tooth, points, solid=solid)]
    nearest: Floats = np.minimum.reduce(every)
    return nearest
