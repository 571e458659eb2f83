"""Teeth of tools from their definitions: a rack in its normal section, and a shaper cutter whose flanks a rack leaves.

Lengths in mm, angles in radians, points of a plane are complex numbers. No formula of an involute is used: the straight flank
of a rack rolls past every circle in small steps, and what it leaves is the flank of the cutter.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from gearcad.core.records import Floats

Complexes = NDArray[np.complex128]

_FINE = 9
_ROUNDS = 11
"""Steps in a bracket of a minimum, and how often it is narrowed to the two steps beside the least."""

_CUTTER_POINTS = 500
"""Points of the flank of a cutter with a module of 1 mm; their number grows with the root of the module."""

_LAND_POINTS = 400
"""Points of half the tip land of a cutter."""


def least_of(function: Callable[[Floats], Floats], low: Floats, high: Floats, steps: int = _FINE) -> tuple[Floats, Floats]:
    """Return where between `low` and `high` (n,) a function is least, and the values there, each (n,).

    The function takes and gives (n, k). Each bracket is narrowed to the steps beside the least, so it should have one minimum.
    """
    share, rows = np.linspace(0.0, 1.0, steps), np.arange(len(low))
    for _ in range(_ROUNDS):
        places = low[:, None] + (high - low)[:, None] * share
        values = function(places)
        best = values.argmin(axis=1)
        low, high = places[rows, np.maximum(best - 1, 0)], places[rows, np.minimum(best + 1, steps - 1)]
    return places[rows, best], values[rows, best]


def peaks_of(values: Floats) -> Floats:
    """Return the greatest values (k,) in the columns of values (n, k) at equal steps, between the steps by a parabola."""
    columns, at = np.arange(values.shape[1]), values.argmax(axis=0)
    here = values[at, columns]
    before, after = (values[np.clip(at + step, 0, len(values) - 1), columns] for step in (-1, 1))
    known = np.isfinite(here) & np.isfinite(before) & np.isfinite(after) & (at > 0) & (at < len(values) - 1)
    low, middle, high = (np.where(known, each, 0.0) for each in (before, here, after))
    bend = low - 2 * middle + high
    result: Floats = here - (high - low) ** 2 / (8 * np.where(bend < 0, bend, -np.inf))
    return result


def peak_of(values: Floats) -> float:
    """Return the greatest of values (n,) at equal steps, between the steps by a parabola."""
    return float(peaks_of(values[:, None])[0])


def rolled_half_angle(radii: Floats, reference: float, angle: float, thickness: float) -> Floats:
    """Return half the angle (n,) of a tooth at `radii` (n,) mm that the straight flank of a rack leaves.

    The rack rolls on the circle of radius `reference` (mm), where the tooth has a transverse `thickness` (mm); `angle` is the
    transverse pressure angle. The flank crosses a circle at the angle t from the line of centres in one roll; the least angle
    in the tooth over all t is what remains.
    """

    def crossing(t: Floats) -> Floats:
        along, height = radii[:, None] * np.sin(t), radii[:, None] * np.cos(t) - reference
        left: Floats = (thickness / 2 - height * math.tan(angle) - along) / reference + t
        return left

    return least_of(crossing, np.full_like(radii, -angle), np.full_like(radii, math.pi / 2 - angle), 33)[1]


class ToolTooth(Protocol):
    """A tooth of a tool in its own frame."""

    def distance(self, points: Complexes) -> Floats:
        """Return signed distances (mm) of points from the tool, negative inside it."""


@dataclass(frozen=True, kw_only=True)
class RackTooth:
    """A tooth of a rack-shaped tool in the normal section, centred on the imaginary axis, which points away from the gear.

    `half_thickness` (mm) at the height `line`, the tip land at the height `tip`, its corners rounded by `radius`. Points come
    in the transverse section, which is wider by 1/`cosine`; distances are those in the normal section.
    """

    half_thickness: float
    line: float
    tip: float
    radius: float
    angle: float
    cosine: float
    pitch: float

    @cached_property
    def corner(self) -> tuple[float, float]:
        """Position of the centre of the rounded corner, across and along the tooth (mm)."""
        height = self.tip + self.radius
        across = self.half_thickness + (height - self.line) * math.tan(self.angle) - self.radius / math.cos(self.angle)
        return across, height

    def distance(self, points: Complexes) -> Floats:
        """Return signed distances (mm) from the teeth: those from the tooth without its rounding, less the radius."""
        across = points.real * self.cosine
        across = np.abs(across - self.pitch * np.rint(across / self.pitch)) - self.corner[0]
        along = points.imag - self.corner[1]
        sine, cosine = math.sin(self.angle), math.cos(self.angle)
        sides = np.maximum(across * cosine - along * sine, -along)
        at_corner = (across > 0) & (across * sine + along * cosine < 0)
        result: Floats = np.where(at_corner, np.hypot(across, along), sides) - self.radius
        return result


@dataclass(frozen=True)
class JoinedTeeth:
    """A tooth of a tool that is the union of others: a flank, a protuberance, a ramp."""

    teeth: tuple[ToolTooth, ...]

    def distance(self, points: Complexes) -> Floats:
        """Return signed distances (mm) from the nearest of the teeth."""
        nearest: Floats = np.minimum.reduce([tooth.distance(points) for tooth in self.teeth])
        return nearest


@dataclass(frozen=True, kw_only=True)
class CutterTooth:
    """A tooth of a shaper cutter, or of the counterpart of a ring, centred on the real axis with its axis at the origin.

    `outline` (n,) is half the tooth from the middle of its tip on.
    """

    teeth: int
    outline: Complexes

    @cached_property
    def _tree(self) -> Any:
        from scipy.spatial import cKDTree

        return cKDTree(np.column_stack([self.outline.real, self.outline.imag]))

    def distance(self, points: Complexes) -> Floats:
        """Return signed distances (mm) from the teeth: from the two chords beside the nearest point of the convex outline."""
        flat = points.ravel()
        pitch, angle = 2 * math.pi / self.teeth, np.angle(flat)
        folded = np.abs(flat) * np.exp(1j * np.abs(angle - pitch * np.rint(angle / pitch)))
        at = self._tree.query(np.column_stack([folded.real, folded.imag]))[1]
        at = np.clip(at, 1, len(self.outline) - 2)
        away, side = np.full(len(flat), np.inf), np.full(len(flat), -np.inf)
        for first in (at - 1, at):
            chord = self.outline[first + 1] - self.outline[first]
            local = (folded - self.outline[first]) / chord
            away = np.minimum(away, np.abs((local - np.clip(local.real, 0.0, 1.0)) * chord))
            side = np.maximum(side, -local.imag)
        result: Floats = np.where(side > 0, away, -away).reshape(points.shape)
        return result


@dataclass(frozen=True, kw_only=True)
class CutterBlank:
    """A cutter before its tip is known: `reference` radius (mm), transverse pressure `angle`, and tooth `thickness` (mm)."""

    teeth: int
    module: float
    reference: float
    angle: float
    thickness: float
    cosine: float

    @property
    def innermost(self) -> float:
        """Radius (mm) at which the flank that the rack leaves begins."""
        return self.reference * math.cos(self.angle)

    def half_angle(self, radii: Floats) -> Floats:
        """Return half the angle of the tooth at radii (mm); infinite where there is no flank."""
        found = np.full(radii.shape, np.inf)
        there = radii >= self.innermost
        found[there] = rolled_half_angle(radii[there], self.reference, self.angle, self.thickness)
        return found

    def flank(self, outermost: float) -> Complexes:
        """Return points (n,) of the flank from a radius (mm) inwards, dense where it bends."""
        count = 20 + int(_CUTTER_POINTS * math.sqrt(max(self.module, 1.0)))
        way = np.linspace(math.sqrt(max(outermost**2 - self.innermost**2, 0.0)), 0.0, count)
        radii = np.hypot(self.innermost, way)
        flank: Complexes = radii * np.exp(1j * self.half_angle(np.maximum(radii, self.innermost)))
        return flank

    def corner(self, share: Floats, tip: float, radius: float) -> Complexes:
        """Return points of the rounded corner, its middle on the real axis, at angles `share` (rad) from the tip circle."""
        corner: Complexes = tip - radius + radius * np.cos(share) + 1j * radius / self.cosine * np.sin(share)
        return corner

    def join(self, tip: float, radius: float) -> tuple[float, float]:
        """Return where on a corner of a radius (mm) it touches the flank, and the angle of its middle in the tooth."""

        def room(share: Floats) -> Floats:
            points = self.corner(share, tip, radius)
            return (self.half_angle(np.abs(points).ravel()) - np.angle(points).ravel()).reshape(points.shape)

        coarse = np.linspace(0.0, math.pi / 2, 65)
        best = int(np.argmin(room(coarse[None])))
        low, high = coarse[max(best - 1, 0)], coarse[min(best + 1, 64)]
        at, angle = least_of(room, np.array([low]), np.array([high]))
        return float(at[0]), float(angle[0])

    def full_radius(self, tip: float) -> float:
        """Return the radius (mm) of the corner for which both corners of the tip meet."""
        low, high = 0.0, tip - self.innermost
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (middle, high) if self.join(tip, middle)[1] > 0 else (low, middle)
        return low

    def bulge(self, tip: float, radius: float, last: float, own: CutterBlank) -> CutterTooth:
        """Return the tooth of a protuberance, whose rounded corner touches this flank and runs on to an angle `last` (rad).

        From there it goes on in a straight line to where that meets the flank of the cutter's `own` teeth.
        """
        _, middle = self.join(tip, radius)
        land = tip * np.exp(1j * np.linspace(0.0, max(middle, 0.0), _LAND_POINTS))
        count = 20 + int(_CUTTER_POINTS * math.sqrt(max(radius, 0.1)))
        corner = self.corner(np.linspace(0.0, last, count), tip, radius) * np.exp(1j * middle)
        heading = (-math.sin(last) + 1j * math.cos(last) / self.cosine) * np.exp(1j * middle)
        straight = corner[-1] + np.linspace(0.0, 2 * self.module, 401)[1:] * heading / abs(heading)
        inside = np.flatnonzero(np.angle(straight) < own.half_angle(np.abs(straight)))
        straight = straight[: inside[0] + 1] if len(inside) else straight
        pieces = np.concatenate([land, corner, straight, straight[-1:] * 0.9])
        kept = np.r_[True, np.abs(np.diff(pieces)) > 1e-12 * tip]
        return CutterTooth(teeth=self.teeth, outline=pieces[kept])

    def tooth(self, tip: float, radius: float) -> CutterTooth:
        """Return the tooth with its tip circle at a radius (mm), its corners rounded by a radius (mm).

        Below the flank it goes on towards the axis in a straight line.
        """
        share, middle = self.join(tip, radius) if radius else (0.0, float(self.half_angle(np.array([tip]))[0]))
        land = tip * np.exp(1j * np.linspace(0.0, max(middle, 0.0), _LAND_POINTS))
        count = 20 + int(_CUTTER_POINTS * math.sqrt(max(radius, 0.1)))
        corner = self.corner(np.linspace(0.0, share, count), tip, radius) * np.exp(1j * middle)
        flank = self.flank(float(np.abs(corner[-1])))
        pieces = np.concatenate([land, corner, flank, flank[-1:] * 0.9])
        kept = np.r_[True, np.abs(np.diff(pieces)) > 1e-12 * tip]
        return CutterTooth(teeth=self.teeth, outline=pieces[kept])
