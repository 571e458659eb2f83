"""The outline of one tooth sector as graded nodes that lie exactly on the tooth profile."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from gearcad.errors import require_number
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind

__all__ = ["MeshSizes", "Side", "Stretch", "sector_outline"]

Floats = NDArray[np.float64]

_FINE = 513
"""Points at which a curve is sampled to measure and to grade it."""


class Side(Enum):
    """What a stretch of the outline is. The left flank, y > 0 for tooth 0 on +x, is the loaded one."""

    RIGHT_ROOT = "right root land"
    RIGHT_FILLET = "right fillet"
    RIGHT_FLANK = "right flank"
    TIP = "tip"
    LEFT_FLANK = "left flank"
    LEFT_FILLET = "left fillet"
    LEFT_ROOT = "left root land"
    AHEAD = "cut at plus half a pitch"
    INNER = "inner circle"
    BEHIND = "cut at minus half a pitch"


@dataclass(frozen=True, kw_only=True)
class MeshSizes:
    """Edge lengths in normal modules: loaded flank, its tip corner, fillets, other outline; the cuts at the root, the rim.

    From each small size the edges grow by `growth` times the distance. Raises ParameterError.
    """

    flank: float = 0.13
    corner: float = 0.007
    fillet: float = 0.05
    outline: float = 0.25
    cut: float = 0.1
    rim: float = 1.5
    growth: float = 0.3

    def __post_init__(self) -> None:
        for each in fields(self):
            require_number(each.name, getattr(self, each.name), above=0)

    def coarse(self) -> MeshSizes:
        """Sizes for a sector that only carries on; its cuts are the same, so that it fits."""
        return replace(self, flank=0.4, corner=0.4, fillet=0.3, outline=0.5)

    def refined(self, factor: float) -> MeshSizes:
        """All edges shorter by `factor`."""
        sizes = {each.name: getattr(self, each.name) / factor for each in fields(self) if each.name != "growth"}
        return replace(self, **sizes)


@dataclass(frozen=True)
class Stretch:
    """One stretch of the outline: `points` (4 n + 1, 2) in mm in order, exactly on it; an edge takes four steps."""

    side: Side
    points: Floats

    @property
    def ends(self) -> Floats:
        """Ends of the edges (n + 1, 2)."""
        return self.points[::4]

    @property
    def mids(self) -> Floats:
        """Middles of the edges (n, 2)."""
        return self.points[2::4]

    def backwards(self, side: Side | None = None) -> Stretch:
        """The same stretch run through from its end."""
        return Stretch(side or self.side, self.points[::-1])

    def mirrored(self, side: Side) -> Stretch:
        """The mirror image about the x axis."""
        return Stretch(side, self.points * np.array([1.0, -1.0]))


def sector_outline(gear: Gear, inner_radius: float, sizes: MeshSizes) -> list[Stretch]:
    """The closed outline of tooth 0 and its share of the body down to `inner_radius` (mm), counter-clockwise.

    Both cuts have the same nodes, so that sectors fit together.
    """
    half_pitch = math.pi / gear.teeth
    loaded = _half_tooth(gear, sizes, loaded=True)
    idle = _half_tooth(gear, sizes, loaded=False)
    right = [stretch.mirrored(_OTHER_SIDE[stretch.side]) for stretch in idle]
    left = [stretch.backwards() for stretch in reversed(loaded)]
    cut = _cut(gear.root_diameter / 2, inner_radius, half_pitch, sizes, gear.normal_module)
    behind = cut.mirrored(Side.BEHIND).backwards()
    last = float(np.hypot(*(cut.ends[-1] - cut.ends[-2])))
    inner = _arc(inner_radius, half_pitch, last)
    return [*right, *left, cut, inner, behind]


_OTHER_SIDE = {
    Side.LEFT_ROOT: Side.RIGHT_ROOT,
    Side.LEFT_FILLET: Side.RIGHT_FILLET,
    Side.LEFT_FLANK: Side.RIGHT_FLANK,
    Side.TIP: Side.TIP,
}

_SIDES = {
    CurveKind.ROOT: Side.LEFT_ROOT,
    CurveKind.FILLET: Side.LEFT_FILLET,
    CurveKind.INVOLUTE: Side.LEFT_FLANK,
    CurveKind.CHAMFER: Side.TIP,
    CurveKind.TIP: Side.TIP,
}


def _half_tooth(gear: Gear, sizes: MeshSizes, *, loaded: bool) -> list[Stretch]:
    """Stretches of the left half, from the middle of the space to the middle of the tooth."""
    module = gear.normal_module
    corner = (sizes.corner if loaded else sizes.outline) * module
    flank, fillet, other = (
        sizes.flank * module if loaded else sizes.outline * module,
        sizes.fillet * module,
        sizes.outline * module,
    )
    grow = sizes.growth

    def size(kind: CurveKind, run: Floats, whole: float) -> Floats:
        """Wanted edge length at the distance `run` from the root side of a curve of the length `whole`."""
        if kind is CurveKind.ROOT:
            return np.minimum(sizes.cut * module, fillet + grow * (whole - run))
        if kind is CurveKind.FILLET:
            return np.full_like(run, fillet)
        if kind is CurveKind.INVOLUTE:
            return np.minimum(flank, np.minimum(fillet + grow * run, corner + grow * (whole - run)))
        return np.minimum(other, corner + grow * run)

    return [_graded(curve, size) for curve in gear.profile.curves]


def _graded(curve: Curve, size: Callable[[CurveKind, Floats, float], Floats]) -> Stretch:
    """The curve with edges of the wanted lengths."""
    s = np.linspace(0.0, 1.0, _FINE)
    run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(curve.points(s), axis=0).T))]
    effort = 1 / size(curve.kind, run, float(run[-1]))
    count = np.r_[0.0, np.cumsum((effort[1:] + effort[:-1]) / 2 * np.diff(run))]
    edges = max(1, math.ceil(count[-1] - 1e-9))
    nodes = np.interp(np.linspace(0.0, count[-1], 4 * edges + 1), count, s)
    return Stretch(_SIDES[curve.kind], curve.points(nodes))


def _cut(outer: float, inner: float, angle: float, sizes: MeshSizes, module: float) -> Stretch:
    """The radial cut from the root circle inwards, edges growing up to the rim's."""
    depth = outer - inner
    run = np.linspace(0.0, depth, _FINE)
    effort = 1 / np.minimum(sizes.rim * module, sizes.cut * module + sizes.growth * run)
    count = np.r_[0.0, np.cumsum((effort[1:] + effort[:-1]) / 2 * np.diff(run))]
    edges = max(2, math.ceil(count[-1]))
    ends = outer - np.interp(np.linspace(0.0, count[-1], edges + 1), count, run)
    steps = np.interp(np.arange(4 * edges + 1) / 4, np.arange(edges + 1), ends)
    return Stretch(Side.AHEAD, steps[:, None] * np.array([math.cos(angle), math.sin(angle)]))


def _arc(radius: float, half_angle: float, size: float) -> Stretch:
    """The inner circle from plus to minus half a pitch."""
    edges = max(1, math.ceil(2 * half_angle * radius / size))
    angles = np.linspace(half_angle, -half_angle, 4 * edges + 1)
    return Stretch(Side.INNER, radius * np.stack([np.cos(angles), np.sin(angles)], -1))
