"""The surfaces that the pieces of tooth 0 sweep along the face width, as Bezier poles.

Exact flanks are S(u, z) = R(kappa z) C(u): the section's poles times those of (cos, sin) over the twist, so nothing is
approximated twice. Modified flanks are S(u, z) = R(kappa z + turn(u, z)) C(u), interpolated in u and z on every stretch of
the face width on which the depth is smooth. Either way neighbours have their common poles in common.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import SolverError
from gearcad.geometry.gear import Gear
from gearcad.geometry.helix import twist
from gearcad.solids.exact import bezier
from gearcad.solids.exact.outline import FlankSpan, Piece, accuracy_for

__all__ = ["ModifiedSweep", "Sweep", "required", "sweep_of"]


_SPLIT_DEGREE = 14
"""A stretch of the face width that needs a higher degree is halved instead."""

_PROBES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
"""Where across a modified surface the degree along it is found; it is too smooth to need more in between."""

_SHARE = 0.1
"""Share of the section's tolerance for either direction of a modified surface: together they stay below a half."""


def required(poles: Floats | None, what: str) -> Floats:
    """The poles; SolverError if there are none."""
    if poles is None:
        raise SolverError(f"{what} needs a higher degree than the CAD kernel has ({bezier.MOST_DEGREE})")
    return poles


def sweep_of(gear: Gear, pieces: Sequence[Piece]) -> Sweep:
    """How the pieces of a gear's tooth 0 are swept: as exact screws, or modified."""
    return ModifiedSweep(gear, pieces) if gear.modification.present else Sweep(gear)


class Sweep:
    """The screw of unmodified flanks. `heights` (mm) part the face width into stretches, here one."""

    def __init__(self, gear: Gear) -> None:
        self.gear, self.width = gear, gear.face_width
        self.tolerance = accuracy_for(gear)
        self.rate = twist(gear)
        self.heights: tuple[float, ...] = (0.0, gear.face_width)

    def turn(self, piece: FlankSpan, u: Floats, z: Floats) -> Floats:
        """Angle (rad) by which the point at u of a piece is turned at height z (mm); u and z broadcast."""
        return self.rate * z

    def patches(self, piece: FlankSpan) -> list[Floats]:
        """Poles (n + 1, m + 1, 3) of the surface of a piece on every stretch."""
        return [self._screwed(piece.poles)]

    def section(self, piece: FlankSpan, which: int) -> Floats:
        """Poles (n + 1, 3) of a piece on the plane of the lower (0) or upper (1) end."""
        z = which * self.width
        cosine, sine = math.cos(self.rate * z), math.sin(self.rate * z)
        x, y = piece.poles.T
        return np.stack([cosine * x - sine * y, sine * x + cosine * y, np.full(len(x), z)], -1)

    def side(self, piece: FlankSpan, u: int, place: tuple[float, float], stretch: int) -> tuple[Floats, Floats]:
        """Poles (m + 1, 3) of the edge along the tooth at the end u = 0 or 1 of a piece, and those of its polar angle (rad).

        `place` is that end's radius (mm) and polar angle (rad).
        """
        radius, angle = place
        point = np.array([[radius * math.cos(angle), radius * math.sin(angle)]])
        return self._screwed(point)[0], np.array([angle, angle + self.rate * self.width])

    @cached_property
    def _rotation(self) -> Floats:
        """Bezier poles (m + 1, 2) of (cos, sin) of the twist over 0 ... width, to a quarter of the section's tolerance."""
        twist = self.rate * self.width
        if twist == 0:
            return np.array([[1.0, 0.0], [1.0, 0.0]])

        def rotation(t: Floats) -> Floats:
            return np.stack([np.cos(twist * t), np.sin(twist * t)], -1)

        def error(values: Floats, t: Floats) -> Floats:
            return np.asarray(np.abs(values - rotation(t)).max(-1))

        bound = 0.25 * self.tolerance / (self.gear.profile.outer_diameter / 2)
        return required(bezier.fit(rotation, error, bound), "the twist of the teeth")

    def _screwed(self, poles: Floats) -> Floats:
        """Poles (n, m + 1, 3) of the screw surface through section poles (n, 2)."""
        x, y = poles[:, :1], poles[:, 1:]
        cosine, sine = self._rotation.T
        heights = np.broadcast_to(np.linspace(0, self.width, len(cosine)), (len(poles), len(cosine)))
        return np.stack([x * cosine - y * sine, x * sine + y * cosine, heights], -1)


class ModifiedSweep(Sweep):
    """The sweep of modified flanks: a stretch ends where the depth is not smooth along z, or its degree would be high."""

    def __init__(self, gear: Gear, pieces: Sequence[Piece]) -> None:
        super().__init__(gear)
        self.form = gear.flank_form
        spans = [piece for piece in pieces if isinstance(piece, FlankSpan)]
        breaks = (0.0, *self.form.height_breaks, self.width)
        found = [stretch for low, high in pairwise(breaks) for stretch in self._stretches(spans, low, high)]
        self.heights = (*(low for low, _, _ in found), self.width)
        self._degrees = [degree for _, _, degree in found]
        self._patches = {span: self._fitted(span) for span in spans}

    def turn(self, piece: FlankSpan, u: Floats, z: Floats) -> Floats:
        return self.rate * z + piece.turn(self.form, u, z)

    def _points(self, piece: FlankSpan, u: Floats, z: Floats) -> Floats:
        """Exact points (n, m, 2) of the modified surface at u (n,) and z (m,)."""
        radius, angle = (value[:, None] for value in piece.polar(u))
        angle = angle + self.turn(piece, u[:, None], z)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)

    def _degree(self, function: Callable[[Floats], Floats], least: int, most: int) -> int | None:
        """Degree, from `least` to `most`, that a function of [0, 1] -> (n, k), in mm, needs; None if that is not enough."""

        def error(values: Floats, t: Floats) -> Floats:
            return np.asarray(np.abs(values - function(t)).max(-1))

        poles = bezier.fit(function, error, _SHARE * self.tolerance, least=least, most=most)
        return None if poles is None else len(poles) - 1

    def _stretches(self, spans: list[FlankSpan], low: float, high: float) -> list[tuple[float, float, int]]:
        """Stretches from `low` to `high` with their degrees along z, the same one for all pieces."""

        def along(t: Floats) -> Floats:
            z = low + t * (high - low)
            return np.concatenate([np.swapaxes(self._points(span, _PROBES, z), 0, 1).reshape(len(t), -1) for span in spans], 1)

        degree = self._degree(along, 2, _SPLIT_DEGREE)
        if degree is not None:
            return [(low, high, degree)]
        middle = (low + high) / 2
        return self._stretches(spans, low, middle) + self._stretches(spans, middle, high)

    def patches(self, piece: FlankSpan) -> list[Floats]:
        return self._patches[piece]

    def section(self, piece: FlankSpan, which: int) -> Floats:
        patch = self.patches(piece)[-which]
        return patch[:, -which]

    def side(self, piece: FlankSpan, u: int, place: tuple[float, float], stretch: int) -> tuple[Floats, Floats]:
        low, high = self.heights[stretch : stretch + 2]
        # A depth is a parabola along z, so three of its values give its poles.
        first, middle, last = place[1] + self.turn(piece, np.array(float(u)), np.array([low, (low + high) / 2, high]))
        return self.patches(piece)[stretch][-u], np.array([first, 2 * middle - (first + last) / 2, last])

    def _fitted(self, piece: FlankSpan) -> list[Floats]:
        """Poles of the surface of a piece on every stretch, of one degree along u."""
        places = np.concatenate([low + _PROBES * (high - low) for low, high in pairwise(self.heights)])

        def across(u: Floats) -> Floats:
            return self._points(piece, u, places).reshape(len(u), -1)

        degree = self._degree(across, len(piece.poles) - 1, bezier.MOST_DEGREE)
        if degree is None:
            raise SolverError(f"a modified flank needs a higher degree than the CAD kernel has ({bezier.MOST_DEGREE})")
        return [self._patch(piece, degree, stretch) for stretch in range(len(self._degrees))]

    def _patch(self, piece: FlankSpan, degree: int, stretch: int) -> Floats:
        low, high = self.heights[stretch : stretch + 2]
        along = self._degrees[stretch]

        def surface(u: Floats, t: Floats) -> Floats:
            return self._points(piece, u, low + t * (high - low))

        poles = bezier.interpolate_surface(surface, (degree, along))
        height = np.broadcast_to(np.linspace(low, high, along + 1), poles.shape[:2])
        return np.concatenate([poles, height[..., None]], -1)
