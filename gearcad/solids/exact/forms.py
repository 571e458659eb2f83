"""Curves and surfaces of boundary representations as plain data: lines, conics, Bezier spans; planes, cylinders, cones.

Lengths in mm, angles in rad. What they are parametrised by is what ISO 10303-42 and the OpenCASCADE kernel say.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats

__all__ = [
    "ORIGIN",
    "BezierCurve",
    "BezierOnSurface",
    "BezierSurface",
    "CircleCurve",
    "ConeSurface",
    "CurveForm",
    "CylinderSurface",
    "EllipseCurve",
    "Frame",
    "LineOnSurface",
    "OnSurface",
    "PlaneSurface",
    "Point",
    "StraightLine",
    "SurfaceForm",
    "Vector",
    "cone_about_z",
    "cylinder_along_z",
    "level_circle",
    "level_frame",
    "level_plane",
    "straight_line",
    "unit",
    "upright_plane",
    "vector",
]

Point = tuple[float, float]
Vector = tuple[float, float, float]

ORIGIN: Point = (0.0, 0.0)


class Frame(NamedTuple):
    """A right-handed frame: its origin, and unit vectors along its z (`axis`) and x (`along`)."""

    origin: Vector
    axis: Vector
    along: Vector


@dataclass(frozen=True, eq=False)
class StraightLine:
    """From `start` along the unit vector `direction`; its parameter is the distance."""

    start: Vector
    direction: Vector


@dataclass(frozen=True, eq=False)
class CircleCurve:
    """In the xy plane of its frame; its parameter is the angle from the frame's x."""

    frame: Frame
    radius: float


@dataclass(frozen=True, eq=False)
class EllipseCurve:
    """In the xy plane of its frame, its longer half axis `major` along x: major cos t, minor sin t."""

    frame: Frame
    major: float
    minor: float


@dataclass(frozen=True, eq=False)
class BezierCurve:
    """One span with `poles` (n + 1, 3), parameter `first` ... `last`."""

    poles: Floats
    first: float = 0.0
    last: float = 1.0


@dataclass(frozen=True, eq=False)
class PlaneSurface:
    """The xy plane of its frame."""

    frame: Frame


@dataclass(frozen=True, eq=False)
class CylinderSurface:
    """About the z axis of its frame; u is the angle from its x, v the height, the normal points outwards."""

    frame: Frame
    radius: float


@dataclass(frozen=True, eq=False)
class ConeSurface:
    """About the z axis of its frame, of `radius` at its origin, widening along z; v is the slant."""

    frame: Frame
    radius: float
    half_angle: float


@dataclass(frozen=True, eq=False)
class BezierSurface:
    """One span with `poles` (n + 1, m + 1, 3), parameters u in 0 ... 1 and v in `low` ... `high`."""

    poles: Floats
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class LineOnSurface:
    """In the parameters of a surface: from a point on, along a unit vector."""

    u: float
    v: float
    du: float
    dv: float


@dataclass(frozen=True, eq=False)
class BezierOnSurface:
    """In the parameters of a surface: one span with `poles` (n + 1, 2), parameter `first` ... `last`."""

    poles: Floats
    first: float = 0.0
    last: float = 1.0


CurveForm = StraightLine | CircleCurve | EllipseCurve | BezierCurve
SurfaceForm = PlaneSurface | CylinderSurface | ConeSurface | BezierSurface
OnSurface = LineOnSurface | BezierOnSurface


def vector(values: Sequence[float] | Floats) -> Vector:
    """Three numbers as plain floats."""
    x, y, z = (float(value) for value in values)
    return x, y, z


def unit(direction: Vector) -> Vector:
    """A direction as a vector of length 1."""
    x, y, z = direction
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def level_frame(z: float, *, up: bool = True, axis: Point = ORIGIN) -> Frame:
    """At height z on an axis through the point (x, y), its x along +x and its z along +z or -z."""
    return Frame((axis[0], axis[1], z), (0.0, 0.0, 1.0 if up else -1.0), (1.0, 0.0, 0.0))


def level_circle(radius: float, z: float, axis: Point = ORIGIN) -> CircleCurve:
    """At height z about an upright axis."""
    return CircleCurve(level_frame(z, axis=axis), radius)


def straight_line(start: Sequence[float], end: Sequence[float]) -> tuple[StraightLine, float]:
    """The line through two points, and the parameter (distance) of the second."""
    step = np.subtract(end, start)
    length = float(np.linalg.norm(step))
    return StraightLine(vector(start), vector(step / length)), length


def cylinder_along_z(radius: float, axis: Point = ORIGIN) -> CylinderSurface:
    """About an upright axis, v = 0 at z = 0."""
    return CylinderSurface(level_frame(0.0, axis=axis), radius)


def cone_about_z(radius: float, sine: float, z: float, *, up: bool) -> ConeSurface:
    """Of `radius` at height z, widening upwards (or downwards); `sine` of its half angle."""
    return ConeSurface(level_frame(z, up=up), radius, math.asin(sine))


def level_plane(z: float) -> PlaneSurface:
    """At height z, its normal along +z."""
    return PlaneSurface(level_frame(z))


def upright_plane(start: Sequence[float], along: Sequence[float]) -> PlaneSurface:
    """Through a point, containing the horizontal direction `along` (x, y) and z; normal along x z."""
    length = math.hypot(*along)
    x, y = along[0] / length, along[1] / length
    return PlaneSurface(Frame(vector(start), (y, -x, 0.0), (x, y, 0.0)))
