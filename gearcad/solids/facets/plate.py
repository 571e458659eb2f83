"""Bolt holes in the end of a ring, as triangles between a circle inside them and one outside, in the plane.

Around each hole a window reaches from circle to circle, as wide as the centre of the hole sees of the inner one, or up to the
next window. Where a side of the window is nearest to that centre, the hole has a vertex for it, and every corner of the
window is joined to the vertices between those of its two sides: no line can cross the hole. Angles are radians in here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.geometry import Body
from gearcad.solids.facets.tolerance import arc_step

__all__ = ["Plate", "bolt_plate"]


_WALL_SHARE = 0.25
"""Most of a wall that the chords of the two circles may take up."""

_ONE = 0.02
"""Vertices of a hole closer than this share of its step are one."""


@dataclass(frozen=True)
class Plate:
    """`angles` (n,) of the points on both circles, of radius `inner` and `outer` (mm), and the outlines of all `holes`
    (holes, m, 2) in mm, counter-clockwise. `faces` number the inner circle's points, the outer one's, then the holes'.
    """

    angles: Floats
    inner: float
    outer: float
    holes: Floats
    faces: Wholes

    @property
    def circle(self) -> Floats:
        """Points (n, 2) of the inner circle in mm."""
        return self.inner * _directions(self.angles)

    @property
    def points(self) -> Floats:
        """All points (2 n + holes m, 2) in mm."""
        around = _directions(self.angles)
        return np.concatenate([self.inner * around, self.outer * around, self.holes.reshape(-1, 2)])


def bolt_plate(body: Body, free: float, rim: float, step: float, parts: int) -> Plate:
    """The plate of a ring whose teeth and cones end at the radius `free` (mm) and whose rim has the radius `rim` (mm).

    `step` (rad) of the chords of a hole; those of the two circles are parted into `parts` each.
    """
    count, middle, radius = body.bolt_holes, body.bolt_circle / 2, body.bolt_diameter / 2
    walls = middle - radius - free, rim - middle - radius
    inner, outer = middle - radius - min(walls[0] / 2, radius), middle + radius + min(walls[1] / 2, radius)
    half, between = _window(math.pi / count, math.asin(radius / middle), math.acos(inner / middle))
    chord = min(half, *(arc_step(at, _WALL_SHARE * wall) for at, wall in zip((inner, outer), walls, strict=True))) / parts
    across, apart = math.ceil(2 * half / chord), math.ceil(2 * between / chord)
    first = np.concatenate([np.linspace(-half, half, across + 1), np.linspace(half, half + 2 * between, apart + 1)[1:]])
    pitch, each = 2 * math.pi / count, across + apart
    angles = (first[:each] + pitch * np.arange(count)[:, None]).ravel()
    window = _directions(first[: across + 1])
    corners = np.concatenate([inner * window[:1], outer * window, inner * window[:0:-1]]) - [middle, 0.0]
    outline, collar = _collar(corners, radius, step)
    low, beyond = np.arange(across, each), each + 1  # points of the outer circle are numbered from `beyond` on, holes' after
    high = low + beyond
    window_and_hole = (
        np.zeros(1, int),
        beyond + np.arange(across + 1),
        np.arange(across, 0, -1),
        2 * beyond + np.arange(len(outline)),
    )
    faces = np.concatenate(
        [
            np.concatenate(window_and_hole)[collar],
            np.stack([low, high, high + 1], -1),
            np.stack([low, high + 1, low + 1], -1),
        ]
    )
    kind = np.minimum(faces // beyond, 2)
    index, hole = faces - kind * beyond, np.arange(count)[:, None, None]
    on_circle = (index + hole * each) % len(angles) + kind * len(angles)
    numbers = np.where(kind < 2, on_circle, 2 * len(angles) + hole * len(outline) + index)
    holes = np.stack([(outline + np.array([middle, 0.0])) @ _turn(angle) for angle in pitch * np.arange(count)])
    return Plate(angles, inner, outer, holes, numbers.reshape(-1, 3))


def _window(share: float, least: float, most: float) -> tuple[float, float]:
    """Half the angle of a window about the axis, and half of what lies between two windows.

    `share` of a hole is half a pitch, `least` what the hole itself takes, `most` what its centre sees of the inner circle.
    """
    half = (least + most) / 2
    return (share, 0.0) if share <= (half + most) / 2 else (half, share - half)


def _collar(corners: Floats, radius: float, step: float) -> tuple[Floats, Wholes]:
    """Outline (m, 2) of a hole about (0, 0), and faces between it and the corners (n, 2) of a window around it.

    Faces number the corners, then the outline.
    """
    sides = np.roll(corners, -1, axis=0) - corners
    along = np.clip(-np.sum(corners * sides, -1) / np.sum(sides**2, -1), 0.0, 1.0)
    nearest = corners + along[:, None] * sides
    foot = np.unwrap(np.arctan2(nearest[:, 1], nearest[:, 0]))
    before = np.r_[foot[-1] - 2 * math.pi, foot[:-1]]
    chords = np.where(foot - before < _ONE * step, 0, np.ceil((foot - before) / step)).astype(int)  # up to the foot of a side
    total, ends = int(chords.sum()), np.cumsum(chords)
    stretches = zip(before, foot, chords, strict=True)
    angles = np.concatenate([np.linspace(start, end, n, endpoint=False) for start, end, n in stretches])
    count = len(corners)
    side = np.arange(count)
    fans = np.repeat(side, chords)
    outline = np.arange(total)
    faces = np.concatenate(
        [
            np.stack([side, (side + 1) % count, count + ends % total], -1),
            np.stack([count + outline, fans, count + (outline + 1) % total], -1),
        ]
    )
    return radius * _directions(angles), faces


def _directions(angle: Floats) -> Floats:
    return np.stack([np.cos(angle), np.sin(angle)], -1)


def _turn(angle: float) -> Floats:
    """By which points (n, 2) are multiplied to turn them counter-clockwise."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, sine], [-sine, cosine]])
