"""Volume, mass and inertia of exact solids, by the divergence theorem over their boundaries.

The fields (x, y, 0) / 2 and r² (x, y, 0) / 4 have the divergences 1 and r² = x² + y². They flow along level planes, and
a turn about z and a lift leave what flows through a face as it is: forms at many places are integrated once.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Floats
from gearcad.geometry import Gear, Rack
from gearcad.solids.exact.boundary import (
    BezierCurve,
    BezierOnSurface,
    BezierSurface,
    Boundary,
    BoundaryEdge,
    BoundaryFace,
    CircleCurve,
    ConeSurface,
    CurveForm,
    CylinderSurface,
    EllipseCurve,
    Frame,
    LineOnSurface,
    OnSurface,
    PlaneSurface,
    StraightLine,
    SurfaceForm,
    Turn,
    bernstein,
)
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.exact.solid import gear_boundary

_NODES = 64
"""Gauss points along an edge, and from there across the face: the fields on a surface of degree 25 have degree 124."""


class Moments(NamedTuple):
    """Volume (mm³), and its second moment about the z axis (mm⁵)."""

    volume: float
    polar: float


class _Run(NamedTuple):
    """An edge of a face: its curve on the surface, or for a plane in space and there as seen `from_face`; and its ends."""

    curve: OnSurface | CurveForm
    first: float
    last: float
    from_face: Turn


def moments(boundary: Boundary) -> Moments:
    """Return the moments of the solid within a closed boundary."""
    laid = {
        (edge, surface, place): curves
        for edges, surface, places, curves in boundary.laid
        for edge, place in zip(edges, places, strict=True)
    }
    flows: dict[tuple[SurfaceForm, _Run], Floats] = {}
    total = np.zeros(2)
    for face in boundary.faces:
        surface = face.surface
        if isinstance(surface, PlaneSurface) and surface.frame.axis[:2] == (0.0, 0.0):
            continue
        for edge, along in (run for loop in face.loops for run in loop):
            run = _run(boundary, face, edge, along, laid.get((edge, surface, face.place), ()))
            if isinstance(run.curve, LineOnSurface) and run.curve.dv == 0:
                continue
            if (surface, run) not in flows:
                flows[surface, run] = _flow(surface, run)
            total += flows[surface, run] if face.outward else -flows[surface, run]
    return Moments(float(total[0]), float(total[1]))


def _run(boundary: Boundary, face: BoundaryFace, number: int, along: bool, laid: tuple[OnSurface, ...]) -> _Run:
    """Return the run of a loop of a face along an edge: its curve, ends and turn."""
    edge: BoundaryEdge = boundary.edges[number]
    ends = (edge.first, edge.last) if along else (edge.last, edge.first)
    if laid:
        return _Run(laid[0 if along else -1], *ends, Turn(0.0, 0.0))
    here, there = boundary.places[face.place], boundary.places[edge.place]
    return _Run(edge.curve, *ends, Turn(there.z - here.z, there.angle - here.angle))


def _flow(surface: SurfaceForm, run: _Run) -> Floats:
    """Return the flows (2,) that an edge adds to both fields through a face.

    By Green: ∮ (∫ F·(S_u x S_v) du from u = 0) dv.
    """
    nodes, weights = _gauss()
    length = run.last - run.first
    t = run.first + length * nodes
    match run.curve:
        case LineOnSurface() | BezierOnSurface() as curve:
            (u, v), (_, rate) = _on_surface(curve, t)
        case _ as curve:
            assert isinstance(surface, PlaneSurface)  # a curve on any other surface is laid there
            u, v, rate = _on_plane(surface.frame, curve, t, run.from_face)
    x, y, normal_x, normal_y = _points(surface, u[:, None] * nodes, v[:, None])
    flow = (x * normal_x + y * normal_y) / 2
    fields = np.stack([flow, flow * (x * x + y * y) / 2])
    return np.asarray((fields @ weights) @ (weights * u * rate * length))


@cache
def _gauss() -> tuple[Floats, Floats]:
    """Return the points and weights on 0 ... 1."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    return (nodes + 1) / 2, weights / 2


def _on_surface(curve: OnSurface, t: Floats) -> tuple[Floats, Floats]:
    """(u, v) and its derivative (2, n) at the parameters t (n,)."""
    if isinstance(curve, LineOnSurface):
        start, along = np.array([[curve.u], [curve.v]]), np.array([[curve.du], [curve.dv]])
        return start + along * t, np.broadcast_to(along, (2, len(t)))
    point, rate = _bezier(curve.poles, (t - curve.first) / (curve.last - curve.first))
    return point.T, rate.T / (curve.last - curve.first)


def _on_plane(frame: Frame, curve: CurveForm, t: Floats, place: Turn) -> tuple[Floats, Floats, Floats]:
    """u, v and the derivative of v (n,) on the plane of a frame; the curve stands at a place."""
    point, rate = _in_space(curve, t)
    cosine, sine = math.cos(place.angle), math.sin(place.angle)
    turn = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    local = point @ turn + [0.0, 0.0, place.z] - frame.origin
    across = np.cross(frame.axis, frame.along)
    return local @ frame.along, local @ across, rate @ turn @ across


def _in_space(curve: CurveForm, t: Floats) -> tuple[Floats, Floats]:
    """Return the points and derivatives (n, 3) of a curve at the parameters t (n,)."""
    match curve:
        case StraightLine(start, direction):
            return np.add(start, np.multiply.outer(t, direction)), np.broadcast_to(direction, (len(t), 3))
        case CircleCurve(frame, radius):
            return _ellipse(frame, radius, radius, t)
        case EllipseCurve(frame, major, minor):
            return _ellipse(frame, major, minor, t)
        case BezierCurve(poles, first, last):
            point, rate = _bezier(poles, (t - first) / (last - first))
            return point, rate / (last - first)


def _ellipse(frame: Frame, major: float, minor: float, t: Floats) -> tuple[Floats, Floats]:
    axes = np.array([frame.along, np.cross(frame.axis, frame.along)]) * [[major], [minor]]
    cosine, sine = np.cos(t), np.sin(t)
    return frame.origin + np.stack([cosine, sine], -1) @ axes, np.stack([-sine, cosine], -1) @ axes


def _bezier(poles: Floats, t: Floats) -> tuple[Floats, Floats]:
    """Return the points and derivatives (n, k) of a Bezier span at t (n,) in 0 ... 1."""
    degree = len(poles) - 1
    return bernstein(degree, t) @ poles, bernstein(degree - 1, t) @ (degree * np.diff(poles, axis=0))


def _points(surface: SurfaceForm, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """x and y of the points at u (n, k) and v (n, 1), and those of S_u x S_v."""
    match surface:
        case PlaneSurface(frame):
            point, normal = _laid_out(frame, u, v, 0.0), np.array(frame.axis)[:, None, None] * np.ones_like(u)
        case CylinderSurface(frame, radius):
            cosine, sine = np.cos(u), np.sin(u)
            point = _laid_out(frame, radius * cosine, radius * sine, v)
            normal = _laid_out(_at_origin(frame), radius * cosine, radius * sine, 0.0)
        case ConeSurface(frame, radius, half_angle):
            cosine, sine, widening, rising = np.cos(u), np.sin(u), math.sin(half_angle), math.cos(half_angle)
            reach = radius + v * widening
            point = _laid_out(frame, reach * cosine, reach * sine, v * rising)
            normal = reach * _laid_out(_at_origin(frame), rising * cosine, rising * sine, -widening)
        case BezierSurface(poles, low, high):
            point, by_u, by_v = _on_bezier(poles, u, (v[:, 0] - low) / (high - low))
            normal = np.cross(by_u, by_v / (high - low), axis=0)
    return point[0], point[1], normal[0], normal[1]


def _at_origin(frame: Frame) -> Frame:
    return frame._replace(origin=(0.0, 0.0, 0.0))


def _laid_out(frame: Frame, x: Floats, y: Floats, z: Floats | float) -> Floats:
    """Return the points (3, n, k) from their coordinates in a frame."""
    axes = np.array([frame.along, np.cross(frame.axis, frame.along), frame.axis])
    return np.array(frame.origin)[:, None, None] + np.tensordot(axes.T, np.stack(np.broadcast_arrays(x, y, z)), 1)


def _on_bezier(poles: Floats, u: Floats, s: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the points (3, n, k) of a Bezier surface at u (n, k) and s (n,) in 0 ... 1, and their derivatives by both."""
    along, across = poles.shape[1] - 1, len(poles) - 1
    curves = np.einsum("nj,ijc->nic", bernstein(along, s), poles)  # of constant v, one for each s
    slopes = np.einsum("nj,ijc->nic", bernstein(along - 1, s), along * np.diff(poles, axis=1))
    in_u = bernstein(across, u.ravel()).reshape(*u.shape, -1)
    by_u = bernstein(across - 1, u.ravel()).reshape(*u.shape, -1) @ (across * np.diff(curves, axis=1))
    return np.moveaxis(in_u @ curves, -1, 0), np.moveaxis(by_u, -1, 0), np.moveaxis(in_u @ slopes, -1, 0)


class MassProperties(NamedTuple):
    """Mass in kg, moment of inertia about the gear's axis in kg·m²."""

    mass: float
    inertia: float


def mass_properties(gear: Gear, density: float) -> MassProperties:
    """Return the mass properties of a gear made of a material of `density` (kg/m³). Raises what `gear_boundary` raises."""
    found = moments(gear_boundary(gear))
    return MassProperties(found.volume * density * 1e-9, found.polar * density * 1e-15)


def rack_mass(rack: Rack, density: float) -> float:
    """Return the mass (kg) of a rack made of a material of `density` (kg/m³)."""
    return moments(rack_boundary(rack)).volume * density * 1e-9
