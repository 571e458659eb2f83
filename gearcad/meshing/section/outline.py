"""The outline of one tooth sector as graded nodes that lie exactly on the tooth profile."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from enum import Enum
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import GeometryError, require_number
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind
from gearcad.meshing.section.grading import Grading, graded

__all__ = [
    "OTHER_SIDE",
    "EdgeLength",
    "HalfLengths",
    "MeshSizes",
    "SectorSides",
    "Side",
    "Stretch",
    "edge_lengths",
    "sector_outline",
]


EdgeLength = Callable[[Floats, float], Floats]
"""Wanted edge lengths (mm) at distances (mm) from the root side of a curve, of a given length in all."""

_LEAST_FILLET = 1e-6
"""Shortest fillet in normal modules."""

_SHORTEST_HALF = 0.05
"""Half of a ring's fillet, in normal modules, that is an edge of its own: one edge for all of it would fold its triangle."""

_FINE = 513
"""Places at which a part of a curve is sampled to be measured."""


@dataclass(frozen=True)
class HalfLengths:
    """Wanted edge lengths on the `curves` of half a tooth; at `breaks`, parameters of the involute, an edge ends.

    Nodes between ends stand half-way if edges are to be `halved`, and else where the grading has the ends of half as long ones.
    """

    curves: Mapping[CurveKind, EdgeLength]
    breaks: tuple[float, ...] = ()
    halved: bool = False

    def parts(self, curve: Curve) -> list[tuple[float, float]]:
        """Parameters of the ends of the parts of a curve that have edges of their own."""
        return list(pairwise((0.0, *(self.breaks if curve.kind is CurveKind.INVOLUTE else ()), 1.0)))

    def graded(self, curve: Curve, first: float = 0.0, last: float = 1.0) -> Grading:
        """A curve, or a part of it, with edges of these lengths."""
        length, before = self.curves[curve.kind], _measured(curve, first)
        return graded(curve.points, lambda run, whole: length(before + run, before + whole), first, last)


def _measured(curve: Curve, last: float) -> float:
    """Length (mm) of a curve up to a parameter."""
    if last == 0:
        return 0.0
    return float(np.hypot(*np.diff(curve.points(np.linspace(0.0, last, _FINE)), axis=0).T).sum())


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
    HELD = "held circle"
    BEHIND = "cut at minus half a pitch"


class SectorSides(ABC):
    """A sector's mesh: `points` (n, 2) in mm, vertices first, `sides` its nodes by the sides of its outline.

    These are in order along it - end, middle, end, middle ... end - and run counter-clockwise about the gear's axis over the
    tooth: so does the whole outline of an external tooth about its sector, while that of a ring's runs clockwise.
    """

    points: Floats
    sides: Mapping[Side, Wholes]

    @property
    @abstractmethod
    def cells(self) -> Wholes:
        """Nodes of every element: its vertices counter-clockwise, then those between them."""

    @property
    def ahead(self) -> Wholes:
        """Nodes of the cut at plus half a pitch, from the root to the held circle."""
        return self.sides[Side.AHEAD]

    @property
    def behind(self) -> Wholes:
        """Nodes of the cut at minus half a pitch, from the root to the held circle: the k-th meets the k-th of `ahead`."""
        return self.sides[Side.BEHIND][::-1]


@dataclass(frozen=True, kw_only=True)
class MeshSizes:
    """Edge lengths in normal modules: loaded flank, its tip corner, fillets, other outline; the cuts at the root, the rim.

    From each small size the edges grow by `growth` times the distance. `fillet_turn` is how far an edge of a fillet may turn
    (deg), `deviation` how far any edge's parabola may be from the curve (normal modules): for meshes of bodies, which have
    shorter edges where these are given. Raises ParameterError.
    """

    flank: float = 0.13
    corner: float = 0.007
    fillet: float = 0.05
    outline: float = 0.25
    cut: float = 0.1
    rim: float = 1.5
    growth: float = 0.3
    fillet_turn: float | None = None
    deviation: float | None = None

    def __post_init__(self) -> None:
        for name, value in self._given.items():
            require_number(name, value, above=0)

    @property
    def _given(self) -> dict[str, float]:
        return {each.name: getattr(self, each.name) for each in fields(self) if getattr(self, each.name) is not None}

    def coarse(self) -> MeshSizes:
        """Sizes for a sector that only carries on; its cuts are the same, so that it fits."""
        return replace(self, flank=0.4, corner=0.4, fillet=0.3, outline=0.5)

    def refined(self, factor: float) -> MeshSizes:
        """All sizes smaller by `factor`; away from them edges grow as fast as before."""
        return replace(self.scaled(factor), growth=self.growth)

    def scaled(self, factor: float) -> MeshSizes:
        """Every edge shorter by `factor`, wherever it is."""
        shorter = {name: value / factor for name, value in self._given.items()}
        if self.deviation is not None:
            shorter["deviation"] = self.deviation / factor**3  # as long edges are off by the cube of their length
        return MeshSizes(**shorter)


@dataclass(frozen=True)
class Stretch:
    """One stretch of the outline: `points` (2 n + 1, 2) in mm in order, exactly on it: ends and middles of its edges."""

    side: Side
    points: Floats

    @property
    def ends(self) -> Floats:
        """Ends of the edges (n + 1, 2)."""
        return self.points[::2]

    @property
    def mids(self) -> Floats:
        """Middles of the edges (n, 2)."""
        return self.points[1::2]

    def backwards(self, side: Side | None = None) -> Stretch:
        """The same stretch run through from its end."""
        return Stretch(side or self.side, self.points[::-1])

    def mirrored(self, side: Side) -> Stretch:
        """The mirror image about the x axis."""
        return Stretch(side, self.points * np.array([1.0, -1.0]))


def require_fillet(gear: Gear) -> None:
    """Raise GeometryError for a tooth without a fillet that has a middle to divide it at."""
    fillet = next(curve for curve in gear.profile.curves if curve.kind is CurveKind.FILLET)
    ends = fillet.points(np.array([0.0, 1.0]))
    if float(np.hypot(*(ends[1] - ends[0]))) < _LEAST_FILLET * gear.normal_module:
        permitted = "must be larger for finite elements: the sharp tool leaves a corner and no fillet"
        if gear.cutter.tip_radius is not None:
            raise GeometryError("cutter.tip_radius", gear.cutter.tip_radius, permitted, "m_n")
        raise GeometryError("rack.root_radius", gear.rack.root_radius, permitted, "m_n")


def sector_outline(
    gear: Gear, held_radius: float, sizes: MeshSizes, left: HalfLengths | None = None, right: HalfLengths | None = None
) -> list[Stretch]:
    """The closed outline of tooth 0 and its share of the body up to `held_radius` (mm), in the order of `SectorSides`.

    Halves without edge lengths of their own have those of `sizes`: the left one those of the loaded flank. Both cuts have the
    same nodes, whatever the lengths on the teeth, so that sectors fit together. Raises GeometryError for a tooth without a
    fillet.
    """
    require_fillet(gear)
    half_pitch = math.pi / gear.tooth_count
    first = _half_tooth(gear, right or edge_lengths(gear, sizes, loaded=False))
    second = _half_tooth(gear, left or edge_lengths(gear, sizes, loaded=True))
    cut = _cut(gear.profile.root_diameter / 2, held_radius, half_pitch, sizes, gear.normal_module)
    behind = cut.mirrored(Side.BEHIND).backwards()
    last = float(np.hypot(*(cut.ends[-1] - cut.ends[-2])))
    held = _arc(held_radius, half_pitch, last)
    return [
        *(stretch.mirrored(OTHER_SIDE[stretch.side]) for stretch in first),
        *(stretch.backwards() for stretch in reversed(second)),
        cut,
        held,
        behind,
    ]


OTHER_SIDE = {
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


def edge_lengths(gear: Gear, sizes: MeshSizes, *, loaded: bool) -> HalfLengths:
    """The wanted edge lengths on the curves of half a tooth."""
    module, grow = gear.normal_module, sizes.growth
    fillet, other = sizes.fillet * module, sizes.outline * module
    bent = min(fillet, max(_half_fillet(gear), _SHORTEST_HALF * module)) if gear.internal else fillet
    flank, corner = (sizes.flank * module, sizes.corner * module) if loaded else (other, other)

    def on_flank(run: Floats, whole: float) -> Floats:
        return np.minimum(flank, np.minimum(fillet + grow * run, corner + grow * (whole - run)))

    curves: dict[CurveKind, EdgeLength] = {
        CurveKind.ROOT: lambda run, whole: np.minimum(sizes.cut * module, fillet + grow * (whole - run)),
        CurveKind.FILLET: lambda run, _whole: np.full_like(run, bent),
        CurveKind.INVOLUTE: on_flank,
        CurveKind.CHAMFER: lambda run, _whole: np.minimum(other, corner + grow * run),
        CurveKind.TIP: lambda run, _whole: np.minimum(other, corner + grow * run),
    }
    return HalfLengths(curves)


def _half_fillet(gear: Gear) -> float:
    """Half the length (mm) of a fillet."""
    return _measured(next(curve for curve in gear.profile.curves if curve.kind is CurveKind.FILLET), 1.0) / 2


def _half_tooth(gear: Gear, lengths: HalfLengths) -> list[Stretch]:
    """Stretches of the left half, from the middle of the space to the middle of the tooth."""
    return [_stretch(curve, lengths, *part) for curve in gear.profile.curves for part in lengths.parts(curve)]


def _stretch(curve: Curve, lengths: HalfLengths, first: float, last: float) -> Stretch:
    """A part of a curve with edges of the wanted lengths."""
    grading = lengths.graded(curve, first, last)
    edges = max(1, math.ceil(grading.edges - 1e-9))
    s = grading.with_middles(edges) if lengths.halved else grading.ends(2 * edges)
    return Stretch(_SIDES[curve.kind], curve.points(s))


def _cut(root: float, held: float, angle: float, sizes: MeshSizes, module: float) -> Stretch:
    """The radial cut from the root circle to the held one, edges growing up to the rim's."""
    direction = np.array([math.cos(angle), math.sin(angle)])
    rim, cut = sizes.rim * module, sizes.cut * module

    def points(s: Floats) -> Floats:
        result: Floats = (root + s[:, None] * (held - root)) * direction
        return result

    grading = graded(points, lambda run, _whole: np.minimum(rim, cut + sizes.growth * run))
    return Stretch(Side.AHEAD, points(grading.with_middles(max(2, math.ceil(grading.edges)))))


def _arc(radius: float, half_angle: float, size: float) -> Stretch:
    """The held circle from plus to minus half a pitch."""
    edges = max(1, math.ceil(2 * half_angle * radius / size))
    angles = np.linspace(half_angle, -half_angle, 2 * edges + 1)
    return Stretch(Side.HELD, radius * np.stack([np.cos(angles), np.sin(angles)], -1))
