"""Cutaways of parts, and the direction and extent of a view."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Bools, Floats, Indices, Wholes
from gearcad.solids.facets.tessellation import Facets
from gearcad.solids.files.scenes import ScenePart

_SAME = 1e-9
"""Distance between levels that counts as none, as a share of the extent."""


class CutSection(NamedTuple):
    """Strips: lower left, lower right, upper left, upper right (n, 4, 2) as (u, v), left and right on lines, u the level."""

    strips: Floats

    @property
    def lowest(self) -> Floats:
        """The lower sides (k, 2, 2) of the strips at the lowest level."""
        sides: Floats = self.strips[self.strips[:, 0, 0] == self.strips[:, 0, 0].min(initial=np.inf)][:, :2]
        return sides


def section_of(lines: Floats) -> CutSection:
    """Return the section that lines (m, 2, 2), ends as (u, v), enclose by the even-odd rule. Lines may be open at a level.

    Between two neighbouring levels no line begins or ends, and the lines that cross stand in pairs. No topology is needed, so
    neither slim triangles nor thousands of teeth do harm.
    """
    levels, places = _levels(lines[..., 0])
    upward = np.take_along_axis(lines, np.argsort(places, axis=1)[..., None], axis=1)
    low, high = np.sort(places, axis=1).T
    line = np.repeat(np.arange(len(lines)), high - low)
    slab = np.arange(len(line)) - np.repeat(np.cumsum(high - low) - (high - low), high - low) + low[line]
    ends = np.stack([_at(upward[line], levels, low[line], high[line], slab + step) for step in (0, 1)], axis=1)
    order = np.lexsort((ends.sum(axis=1), slab))
    slab, ends = slab[order], ends[order]
    whole = np.isin(slab, np.flatnonzero(np.bincount(slab, minlength=1) % 2 == 0))
    slab, ends = slab[whole][::2], ends[whole].reshape(-1, 2, 2)  # left and right, below and above
    u = np.stack([levels[slab], levels[slab], levels[slab + 1], levels[slab + 1]], axis=1)
    v = np.stack([ends[:, 0, 0], ends[:, 1, 0], ends[:, 0, 1], ends[:, 1, 1]], axis=1)
    return CutSection(np.stack([u, v], axis=-1))


def _at(lines: Floats, levels: Floats, low: Indices, high: Indices, level: Indices) -> Floats:
    """Return the positions of lines (n, 2, 2), which run from level to level, at a level (n,)."""
    share = (levels[level] - levels[low]) / (levels[high] - levels[low])
    found: Floats = lines[:, 0, 1] * (1 - share) + lines[:, 1, 1] * share
    return found


def _levels(u: Floats) -> tuple[Floats, Indices]:
    """Return the levels, rising, and at which each end (m, 2) is."""
    values, places = np.unique(u.ravel(), return_inverse=True)
    if not len(values):
        return np.zeros(2), np.zeros(u.shape, np.intp)
    new = np.diff(values, prepend=-np.inf) > _SAME * max(float(np.ptp(values)), 1e-300)
    return values[new], (np.cumsum(new) - 1)[places].reshape(u.shape)


_IN_PLANE = 1e-10
"""Distance from a plane that counts as none, as a share of the extent of what is cut."""

_DIGITS = 9
"""Decimal digits of levels (mm) that are told apart where they are counted."""


class Cutaway(Enum):
    """Part of a body that is removed to show its inside."""

    QUARTER = "quarter"
    HALF = "half"


@dataclass(frozen=True, eq=False)
class CutPlanes:
    """Cut that removes everything beyond all planes through `point` (3,).

    One or two planes have unit normals (3,) towards what is taken off. Two planes are square to each other.
    """

    point: Floats
    normals: tuple[Floats, ...]

    def left(self, points: Floats) -> Bools:
        """Return which points (n, 3) remain after the cut."""
        beyond: Bools = np.all([(points - self.point) @ normal > 0 for normal in self.normals], axis=0)
        return ~beyond


class CutFace(NamedTuple):
    """A face where a part was cut: triangles (n, 3, 3) by their corners, its normal (3,), the lines around it (m, 2, 3)."""

    triangles: Floats
    normal: Floats
    outline: Floats


@dataclass(frozen=True, eq=False)
class CutFacets:
    """Facets that a cut leaves, open where the `faces` close them. Two planes leave two pieces, side by side."""

    facets: Facets
    faces: tuple[CutFace, ...]


def cut_away(facets: Facets, cut: CutPlanes) -> CutFacets:
    """Return the facets that a cut leaves, with the cut faces; facets stand in their place."""
    first = cut.normals[0]
    near, beyond, lines = _parted(facets, cut.point, first)
    if len(cut.normals) == 1:
        return CutFacets(near, (_cut_face(lines, cut.point, first, _fewest_levels(lines, first)),))
    second = cut.normals[1]
    beside, _, more = _parted(beyond, cut.point, second)
    left = Facets(
        np.concatenate([near.vertices, beside.vertices]), np.concatenate([near.faces, beside.faces + len(near.vertices)])
    )
    lines = _clipped(lines, (lines - cut.point) @ second)
    return CutFacets(left, (_cut_face(lines, cut.point, first, second), _cut_face(more, cut.point, second, first)))


def _parted(facets: Facets, point: Floats, normal: Floats) -> tuple[Facets, Facets, Floats]:
    """Facets on this side of a plane, those beyond, and the lines (m, 2, 3) in the plane between them."""
    height = (facets.vertices - point) @ normal
    height[np.abs(height) < _IN_PLANE * np.ptp(facets.vertices, axis=0).max(initial=0.0)] = 0.0
    above = height > 0  # a vertex in the plane is on this side, so every triangle across it is crossed at two edges
    count = above[facets.faces].sum(axis=1)
    cut = facets.faces[(count == 1) | (count == 2)]
    # Turned so that the vertex that is alone on its side comes first.
    alone = above[cut] == (above[cut].sum(axis=1) == 1)[:, None]
    a, b, c = np.take_along_axis(cut, (alone.argmax(axis=1)[:, None] + np.arange(3)) % 3, axis=1).T
    vertices, (ab, ac) = _crossings(facets.vertices, height, a, np.stack([b, c]))
    tips, stumps = np.stack([a, ab, ac], axis=1), np.concatenate([np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)])
    upper = above[a]
    twice = np.tile(upper, 2)
    here = np.concatenate([facets.faces[count == 0], _true(tips[~upper]), _true(stumps[twice])])
    beyond = np.concatenate([facets.faces[count == 3], _true(tips[upper]), _true(stumps[~twice])])
    return Facets(vertices.copy(), here), Facets(vertices.copy(), beyond), vertices[np.stack([ab, ac], axis=1)[ab != ac]]


def _true(faces: Wholes) -> Wholes:
    """Return the triangles (n, 3) that have three different corners."""
    found: Wholes = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    return found


def _crossings(vertices: Floats, height: Floats, one: Wholes, others: Wholes) -> tuple[Floats, Wholes]:
    """Return the vertices with those where edges (k, m) cross height 0 behind them, each once, and the numbers (k, m) of these.

    An edge that ends at height 0 crosses it at that vertex.
    """
    low, high = np.minimum(one, others), np.maximum(one, others)
    keys, places = np.unique((low * len(vertices) + high).ravel(), return_inverse=True)
    low, high = keys // max(len(vertices), 1), keys % max(len(vertices), 1)
    share = (height[low] / (height[low] - height[high]))[:, None]
    found = vertices[low] * (1 - share) + vertices[high] * share
    numbers = np.where(height[low] == 0, low, np.where(height[high] == 0, high, len(vertices) + np.arange(len(keys))))
    return np.concatenate([vertices, found]), numbers[places.reshape(others.shape)]


def _clipped(lines: Floats, height: Floats) -> Floats:
    """Return the parts of lines (m, 2, 3) above height 0, that of their ends being (m, 2)."""
    lines, height = lines[(height > 0).any(axis=1)], height[(height > 0).any(axis=1)]
    fall = np.where(height[:, 0] == height[:, 1], 1.0, height[:, 0] - height[:, 1])
    crossing = lines[:, 0] + (height[:, 0] / fall)[:, None] * (lines[:, 1] - lines[:, 0])
    return np.where((height > 0)[..., None], lines, crossing[:, None])


def _cut_face(lines: Floats, point: Floats, normal: Floats, level: Floats) -> CutFace:
    """Return the face that lines (m, 2, 3) in a plane enclose, as strips across a direction in it. At level 0 it ends where the
    lines do.
    """
    frame = np.stack([level, np.cross(normal, level)])
    section = section_of((lines - point) @ frame.T)
    strips, end = point + section.strips @ frame, point + section.lowest @ frame
    # Where the lowest side is a line itself, it is drawn twice, which nobody sees.
    return CutFace(np.concatenate([strips[:, [0, 3, 1]], strips[:, [0, 2, 3]]]), normal, np.concatenate([lines, end]))


def _fewest_levels(lines: Floats, normal: Floats) -> Floats:
    """Return the one of two directions in a plane along which fewer levels have ends of lines."""
    one = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    one /= np.linalg.norm(one)
    directions = one, np.cross(normal, one)
    counts = [len(np.unique(np.round((lines.reshape(-1, 3) @ each), _DIGITS))) for each in directions]
    return directions[int(np.argmin(counts))]


_MARGIN = 1.06
"""The picture's extent over that of what it shows."""


class SceneView(Enum):
    """Direction from which a scene is seen: above one corner, along the axes, from the right, from above (as a sheet's views
    are), and close by, along the axes, where teeth mesh.
    """

    CORNER = "corner"
    FRONT = "front"
    SIDE = "side"
    TOP = "top"
    MESH = "mesh"


class ViewDirection(NamedTuple):
    """Direction from the scene to the eye, and what is up in the picture."""

    eye: tuple[float, float, float]
    up: tuple[float, float, float]

    @property
    def axes(self) -> Floats:
        """Right, up and towards the eye, as unit vectors (3, 3)."""
        towards = np.array(self.eye) / np.linalg.norm(self.eye)
        right = np.cross(self.up, towards)
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(towards, right), towards])


@dataclass(frozen=True, eq=False)
class Camera:
    """An eye without perspective: `axes` (3, 3) right, up and towards the eye, the point (3,) in the middle of the picture,
    half of what it shows in height, and a `distance` from that point at which nothing is behind the eye (mm).
    """

    axes: Floats
    middle: Floats
    half_height: float
    distance: float


def framed(points: Floats, direction: ViewDirection, aspect: float) -> Camera:
    """Return the camera that has all points (n, 3) in a picture of width over height `aspect`, with a margin."""
    axes = direction.axes
    seen = points @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    width, height, depth = high - low
    return Camera(axes, (low + high) / 2 @ axes, _MARGIN * max(float(height), float(width) / aspect) / 2, float(depth))


def close_up(points: Floats, direction: ViewDirection, place: tuple[float, float], half_height: float) -> Camera:
    """Return the camera above all points (n, 3) that looks down on a place (x, y), and sees so much (mm) above and below it."""
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    return Camera(direction.axes, np.array([*place, high]), half_height, high - low)


def points_of(parts: Iterable[ScenePart]) -> Floats:
    """Return all points (n, 3) of parts in their places."""
    return np.concatenate([part.facets.vertices @ part.pose[:3, :3].T + part.pose[:3, 3] for part in parts])
