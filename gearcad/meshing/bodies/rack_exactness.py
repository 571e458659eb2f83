"""Distances of a strip of a rack from the exact teeth, and its exact area, in the frame of `rack_section`."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import partial

import numpy as np

from gearcad.core.records import Floats
from gearcad.geometry import Rack
from gearcad.geometry.rack_root import FilletArc, RackCurve, RackCurveKind, Straight
from gearcad.meshing.bodies.element_mesh import BACK, ElementMesh
from gearcad.meshing.bodies.exactness import Deviations, Distances, SideDeviations, greatest_deviations, greatest_of_sides

_STEPS, _STARTS = 8, 65
"""Newton steps to the nearest point of an arc, and places among which they begin."""

_KINDS = {"flank": RackCurveKind.FLANK, "fillet": RackCurveKind.FILLET, "root": RackCurveKind.ROOT}
"""Pieces of the outline by the names of sides."""


def exact_strip_area(rack: Rack, teeth: int) -> float:
    """Return the area (mm²) of so many teeth of a rack and of the body below them, down to the back."""
    depth, half = rack.root_depth, 0.0
    for curve in rack.profile.curves:
        if isinstance(curve, FilletArc):
            ends = [
                curve.radius
                * curve.stretch
                * ((curve.y + depth) * math.sin(at) - curve.radius * (at / 2 + math.sin(2 * at) / 4))
                for at in (curve.first, curve.last)
            ]
            half += ends[1] - ends[0]
        else:
            assert isinstance(curve, Straight)
            (x, y), (to_x, to_y) = curve.start, curve.end
            half += (to_x - x) * (depth + (y + to_y) / 2)
    return teeth * (rack.transverse_pitch * (rack.height - depth) + 2 * half)


def strip_deviations(mesh: ElementMesh, rack: Rack) -> Deviations:
    """Measure the flanks and fillets of a strip as `deviations` does those of gears."""
    return greatest_deviations(mesh, ((name, each) for name, kind, each in _toothed(mesh, rack) if kind in ("flank", "fillet")))


def strip_side_deviations(mesh: ElementMesh, rack: Rack) -> SideDeviations:
    """Measure root lands, tips, the back and the ends of a strip as `side_deviations` does the sides of gears."""
    return greatest_of_sides(mesh, _others(mesh, rack))


def _others(mesh: ElementMesh, rack: Rack) -> Iterator[tuple[str, Distances, bool]]:
    yield BACK, partial(_from_line, 0, -rack.height), True
    for name in ("end_behind", "end_ahead"):
        if name in mesh.sides:
            along = mesh.points[mesh.nodes(name), 1]
            ends = (np.round(along.mean() / rack.transverse_pitch - 0.5) + 0.5) * rack.transverse_pitch
            yield name, partial(_from_line, 1, float(ends)), True
    yield from ((name, each, True) for name, kind, each in _toothed(mesh, rack) if kind in ("root", "tip"))


def _toothed(mesh: ElementMesh, rack: Rack) -> Iterator[tuple[str, str, Distances]]:
    """Yield the sides of teeth, the kind of each, and the function that measures it."""
    for name, faces in mesh.sides.items():
        kind = name.rpartition("_")[0].rpartition("_")[2]
        if not len(faces) or (kind not in _KINDS and kind != "tip"):
            continue
        wanted = (RackCurveKind.TIP, RackCurveKind.CHAMFER) if kind == "tip" else (_KINDS[kind],)
        yield name, kind, partial(_from_curves, rack, wanted)


def _from_line(axis: int, place: float, points: Floats) -> Floats:
    distances: Floats = np.abs(points[:, axis] - place)
    return distances


def _from_curves(rack: Rack, kinds: Iterable[RackCurveKind], points: Floats) -> Floats:
    """Return the distances (n,) in mm of points (n, 3) from the nearest of the curves of these kinds."""
    pitch = rack.transverse_pitch
    aside = np.abs(points[:, 1] - pitch * np.round(points[:, 1] / pitch))
    local = np.stack([-aside, points[:, 0]], -1)  # as the profile has the left half
    nearest: Floats = np.minimum.reduce([_from_curve(curve, local) for curve in rack.profile.curves if curve.kind in kinds])
    return nearest


def _from_curve(curve: RackCurve, points: Floats) -> Floats:
    """Return the distances (n,) in mm of points (n, 2) from a curve."""
    if isinstance(curve, FilletArc):
        return _from_arc(curve, points)
    assert isinstance(curve, Straight)
    first, along = np.array(curve.start), np.array(curve.end) - np.array(curve.start)
    share = np.clip((points - first) @ along / (along @ along), 0.0, 1.0)
    distances: Floats = np.hypot(*(points - first - share[:, None] * along).T)
    return distances


def _from_arc(arc: FilletArc, points: Floats) -> Floats:
    """Return the distances (n,) from an arc that the transverse section stretches."""
    begin = np.linspace(0.0, 1.0, _STARTS)
    away = points[:, None] - arc.points(begin)[None]
    theta = arc.first + begin[np.argmin((away**2).sum(-1), axis=1)] * (arc.last - arc.first)

    def placed(at: Floats) -> Floats:
        return np.stack([(arc.x + arc.radius * np.sin(at)) * arc.stretch, arc.y - arc.radius * np.cos(at)], -1)

    for _ in range(_STEPS):
        off = placed(theta) - points
        speed = arc.radius * np.stack([np.cos(theta) * arc.stretch, np.sin(theta)], -1)
        bend = arc.radius * np.stack([-np.sin(theta) * arc.stretch, np.cos(theta)], -1)
        slope, curvature = (off * speed).sum(-1), (speed**2).sum(-1) + (off * bend).sum(-1)
        theta = np.clip(theta - slope / np.where(curvature > 0, curvature, np.inf), arc.first, arc.last)
    distances: Floats = np.hypot(*(placed(theta) - points).T)
    return distances
