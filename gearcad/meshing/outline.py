"""Outline of a tooth sector as graded nodes that lie exactly on the tooth profile."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from enum import Enum
from functools import cache
from itertools import pairwise

import numpy as np

from gearcad.core.errors import GeometryError, require_number
from gearcad.core.records import Floats, Notice, Wholes
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, FilletChain, Involute
from gearcad.geometry.gear import flank_curves
from gearcad.geometry.gear_data import outer_diameter

_GRADING_FINE = 513
"""Points at which a line is sampled to measure and to grade it."""


@dataclass(frozen=True)
class Grading:
    """A line sampled at parameters `s` (n,): length run through (mm) and edges passed, up to each of them."""

    s: Floats
    run: Floats
    passed: Floats

    @property
    def edges(self) -> float:
        """Edges of the wanted lengths that the line takes, as a real number."""
        return float(self.passed[-1])

    def ends(self, count: int) -> Floats:
        """Return the parameters (count + 1,) of the ends of so many edges, all longer or shorter than wanted by the same
        factor.
        """
        return np.interp(np.linspace(0.0, self.edges, count + 1), self.passed, self.s)

    def with_middles(self, count: int) -> Floats:
        """Return the parameters (2 count + 1,) of the ends and middles of `count` edges."""
        ends = self.ends(count)
        length = np.interp(ends, self.s, self.run)
        middles = np.interp((length[1:] + length[:-1]) / 2, self.run, self.s)
        return np.insert(ends, range(1, len(ends)), middles)


def graded(
    points: Callable[[Floats], Floats], size: Callable[[Floats, float], Floats], first: float = 0.0, last: float = 1.0
) -> Grading:
    """Grade a line between two parameters.

    `points` gives places (n, 2) in mm at parameters (n,); `size` the wanted edge lengths (n,) in mm at distances (n,) from the
    line's start, of its whole length.
    """
    s = np.linspace(first, last, _GRADING_FINE)
    run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(points(s), axis=0).T))]
    effort = 1 / size(run, float(run[-1]))
    return Grading(s, run, np.r_[0.0, np.cumsum((effort[1:] + effort[:-1]) / 2 * np.diff(run))])


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
        """Return the parameters of the ends of the parts of a curve that have edges of their own."""
        if isinstance(curve, FilletChain):
            return list(pairwise((0.0, *curve.breaks, 1.0)))
        return list(pairwise((0.0, *(self.breaks if curve.kind is CurveKind.INVOLUTE else ()), 1.0)))

    def graded(self, curve: Curve, first: float = 0.0, last: float = 1.0) -> Grading:
        """Return a curve, or a part of it, with edges of these lengths."""
        length, before = self.curves[curve.kind], _measured(curve, first)
        return graded(curve.points, lambda run, whole: length(before + run, before + whole), first, last)


def _measured(curve: Curve, last: float) -> float:
    """Return the length (mm) of a curve up to a parameter."""
    if last == 0:
        return 0.0
    return float(np.hypot(*np.diff(curve.points(np.linspace(0.0, last, _FINE)), axis=0).T).sum())


class OutlineSide(Enum):
    """Kind of a stretch of the outline. The left flank, y > 0 for tooth 0 on +x, is the loaded one."""

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
    sides: Mapping[OutlineSide, Wholes]

    @property
    @abstractmethod
    def cells(self) -> Wholes:
        """Nodes of every element: its vertices counter-clockwise, then those between them."""

    @property
    def ahead(self) -> Wholes:
        """Nodes of the cut at plus half a pitch, from the root to the held circle."""
        return self.sides[OutlineSide.AHEAD]

    @property
    def behind(self) -> Wholes:
        """Nodes of the cut at minus half a pitch, from the root to the held circle: the k-th meets the k-th of `ahead`."""
        return self.sides[OutlineSide.BEHIND][::-1]


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
        """Return all sizes smaller by `factor`; away from them edges grow as fast as before."""
        return replace(self.scaled(factor), growth=self.growth)

    def scaled(self, factor: float) -> MeshSizes:
        """Return the grading with every edge shorter by `factor`."""
        shorter = {name: value / factor for name, value in self._given.items()}
        if self.deviation is not None:
            shorter["deviation"] = self.deviation / factor**3  # as long edges are off by the cube of their length
        return MeshSizes(**shorter)


@dataclass(frozen=True)
class Stretch:
    """One stretch of the outline: `points` (2 n + 1, 2) in mm in order, exactly on it: ends and middles of its edges."""

    side: OutlineSide
    points: Floats

    @property
    def ends(self) -> Floats:
        """Ends of the edges (n + 1, 2)."""
        return self.points[::2]

    @property
    def mids(self) -> Floats:
        """Middles of the edges (n, 2)."""
        return self.points[1::2]

    def backwards(self, side: OutlineSide | None = None) -> Stretch:
        """Return the same stretch run through from its end."""
        return Stretch(side or self.side, self.points[::-1])

    def mirrored(self, side: OutlineSide) -> Stretch:
        """Return the mirror image about the x axis."""
        return Stretch(side, self.points * np.array([1.0, -1.0]))


def require_fillet(gear: Gear) -> None:
    """Raise GeometryError for a tooth without a fillet that has a middle to divide it at."""
    fillet = gear.profile.fillet
    ends = fillet.points(np.array([0.0, 1.0]))
    if float(np.hypot(*(ends[1] - ends[0]))) < _LEAST_FILLET * gear.normal_module:
        permitted = "must be larger for finite elements: the sharp tool leaves a corner and no fillet"
        if gear.premachining.present:
            raise GeometryError("premachining.tool_tip_radius", gear.root_radius, permitted, "m_n")
        if gear.cutter.tip_radius is not None:
            raise GeometryError("cutter.tip_radius", gear.cutter.tip_radius, permitted, "m_n")
        raise GeometryError("rack.root_radius", gear.rack.root_radius, permitted, "m_n")


def sector_outline(
    gear: Gear, held_radius: float, sizes: MeshSizes, left: HalfLengths | None = None, right: HalfLengths | None = None
) -> list[Stretch]:
    """Return the closed outline of tooth 0 and its share of the body up to `held_radius` (mm), in the order of `SectorSides`.

    Halves without edge lengths of their own have those of `sizes`: the left one those of the loaded flank. Both cuts have the
    same nodes, whatever the lengths on the teeth, so that sectors fit together. Raises GeometryError for a tooth without a
    fillet.
    """
    require_fillet(gear)
    half_pitch = math.pi / gear.tooth_count
    first = _half_tooth(gear, right or edge_lengths(gear, sizes, loaded=False))
    second = _half_tooth(gear, left or edge_lengths(gear, sizes, loaded=True))
    cut = _cut(gear.profile.root_diameter / 2, held_radius, half_pitch, sizes, gear.normal_module)
    behind = cut.mirrored(OutlineSide.BEHIND).backwards()
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
    OutlineSide.LEFT_ROOT: OutlineSide.RIGHT_ROOT,
    OutlineSide.LEFT_FILLET: OutlineSide.RIGHT_FILLET,
    OutlineSide.LEFT_FLANK: OutlineSide.RIGHT_FLANK,
    OutlineSide.TIP: OutlineSide.TIP,
}

_SIDES = {
    CurveKind.ROOT: OutlineSide.LEFT_ROOT,
    CurveKind.FILLET: OutlineSide.LEFT_FILLET,
    CurveKind.INVOLUTE: OutlineSide.LEFT_FLANK,
    CurveKind.CHAMFER: OutlineSide.TIP,
    CurveKind.TIP: OutlineSide.TIP,
}


@dataclass(frozen=True)
class NotchPlace:
    """Where the finishing wheel leaves a notch: from `start` to `end` (mm along the fillet), and its least radius (mm)."""

    start: float
    end: float
    radius: float

    @classmethod
    def of(cls, gear: Gear) -> NotchPlace | None:
        """Return the place of the notch of a gear; None without one."""
        outline = gear.profile.root
        if outline is None or not outline.wheel:
            return None
        *below, notch = outline.pieces
        start = sum(_measured(piece, 1.0) for piece in below)
        s = np.linspace(0.0, 1.0, _FINE)
        step = np.hypot(*np.diff(notch.points(s), axis=0).T)
        turned = np.abs(np.diff(np.unwrap(notch.direction(s))))
        return cls(start, start + float(step.sum()), float((step / np.maximum(turned, 1e-12)).min()))

    def sharp(self, module: float) -> bool:
        """Return whether edges of other fillets do not resolve it."""
        return self.radius < _NOTCH_RADIUS * module

    def shorter(self, size: float, module: float) -> float:
        """Return the edge length (mm) in the notch beside that of other fillets: a twelfth of its radius at the usual size."""
        return size * min(self.radius / (_NOTCH_RADIUS * module), 1.0)


_NOTCH_RADIUS = 0.6
"""Radius of a notch in normal modules from which on edges of other fillets resolve it."""


def edge_lengths(gear: Gear, sizes: MeshSizes, *, loaded: bool, notched: bool = True) -> HalfLengths:
    """Return the wanted edge lengths on the curves of half a tooth; shorter in a grinding notch where it is `notched`."""
    module, grow = gear.normal_module, sizes.growth
    fillet = sizes.fillet * module
    bent = min(fillet, max(_half_fillet(gear), _SHORTEST_HALF * module)) if gear.internal else fillet
    notch = NotchPlace.of(gear) if notched else None
    first = fillet if notch is None else notch.shorter(fillet, module)

    def on_fillet(run: Floats, _whole: float) -> Floats:
        if notch is None:
            return np.full_like(run, bent)
        outside = np.maximum(np.maximum(notch.start - run, run - notch.end), 0.0)
        return np.minimum(bent, notch.shorter(bent, module) + grow * outside)

    return HalfLengths(plain_lengths(module, sizes, loaded=loaded, flank_start=first) | {CurveKind.FILLET: on_fillet})


def plain_lengths(
    module: float, sizes: MeshSizes, *, loaded: bool, flank_start: float | None = None
) -> dict[CurveKind, EdgeLength]:
    """Return the wanted edge lengths on the curves of half a tooth of a normal module (mm) that has no grinding notch.

    Those of the flank begin with `flank_start` (mm) beside the fillet, if it is not that of the fillet.
    """
    grow, fillet, other = sizes.growth, sizes.fillet * module, sizes.outline * module
    flank, corner = (sizes.flank * module, sizes.corner * module) if loaded else (other, other)
    first = fillet if flank_start is None else flank_start

    def on_flank(run: Floats, whole: float) -> Floats:
        return np.minimum(flank, np.minimum(first + grow * run, corner + grow * (whole - run)))

    return {
        CurveKind.ROOT: lambda run, whole: np.minimum(sizes.cut * module, fillet + grow * (whole - run)),
        CurveKind.FILLET: lambda run, _whole: np.full_like(run, fillet),
        CurveKind.INVOLUTE: on_flank,
        CurveKind.CHAMFER: lambda run, _whole: np.minimum(other, corner + grow * run),
        CurveKind.TIP: lambda run, _whole: np.minimum(other, corner + grow * run),
    }


def _half_fillet(gear: Gear) -> float:
    """Return half the length (mm) of a fillet."""
    return _measured(gear.profile.fillet, 1.0) / 2


def _half_tooth(gear: Gear, lengths: HalfLengths) -> list[Stretch]:
    """Return the stretches of the left half, from the middle of the space to the middle of the tooth."""
    return [_stretch(curve, lengths, *part) for curve in gear.profile.joined_curves for part in lengths.parts(curve)]


def _stretch(curve: Curve, lengths: HalfLengths, first: float, last: float) -> Stretch:
    """Return a part of a curve with edges of the wanted lengths."""
    grading = lengths.graded(curve, first, last)
    edges = max(1, math.ceil(grading.edges - 1e-9))
    s = grading.with_middles(edges) if lengths.halved else grading.ends(2 * edges)
    return Stretch(_SIDES[curve.kind], curve.points(s))


def _cut(root: float, held: float, angle: float, sizes: MeshSizes, module: float) -> Stretch:
    """Return the radial cut from the root circle to the held one, edges growing up to the rim's."""
    direction = np.array([math.cos(angle), math.sin(angle)])

    def points(s: Floats) -> Floats:
        result: Floats = (root + s[:, None] * (held - root)) * direction
        return result

    return graded_cut(points, sizes, module)


def graded_cut(points: Callable[[Floats], Floats], sizes: MeshSizes, module: float) -> Stretch:
    """Return the cut ahead along a line of `points` from the root down, edges growing up to the rim's."""
    rim, cut = sizes.rim * module, sizes.cut * module
    grading = graded(points, lambda run, _whole: np.minimum(rim, cut + sizes.growth * run))
    return Stretch(OutlineSide.AHEAD, points(grading.with_middles(max(2, math.ceil(grading.edges)))))


def _arc(radius: float, half_angle: float, size: float) -> Stretch:
    """Return the held circle from plus to minus half a pitch."""
    edges = max(1, math.ceil(2 * half_angle * radius / size))
    angles = np.linspace(half_angle, -half_angle, 2 * edges + 1)
    return Stretch(OutlineSide.HELD, radius * np.stack([np.cos(angles), np.sin(angles)], -1))


_EDGE_LENGTHS_FINE = 1025
"""Places of a curve at which its bend is looked at."""

_FARTHEST = 30.0
"""Degrees that any edge may turn: one that turns twice as far can fold the triangle behind it."""

_TINY = 0.02
"""Share of an edge that is not worth to be one."""

_CUBIC = 72 * math.sqrt(3)
"""A parabola through both ends and the middle of an arc is off by k' L^3 over this, k' the slope of the curvature."""

_QUARTIC = 1536
"""Denominator of the deviation k^3 L^4/1536 where the curvature k is constant."""

_LEAST = 1e-3
"""Normal modules: no bend asks for shorter edges. Sharp tools leave corners that fillets come out of with no radius."""

_OF_DEPTH = 0.2
"""Share of the permitted deviation that a depth of modification may add."""

_SHORTEST = 0.003
"""Normal modules: no modification asks for shorter edges."""


@dataclass(frozen=True)
class _Sampled:
    """Edge lengths (n,) at distances `run` (n,) from the root side of a curve, all in mm."""

    run: Floats
    length: Floats

    def __call__(self, run: Floats, _whole: float) -> Floats:
        return np.interp(run, self.run, self.length)


def bent_lengths(gear: Gear, sizes: MeshSizes, near: HalfLengths | None = None, *, whole: bool = False) -> HalfLengths:
    """Return the wanted edge lengths on half a tooth: those of `sizes`, made shorter by `fillet_turn`, `deviation` and `near`.

    Over the whole half of the tooth they grow no faster than `growth`. Edges end where reliefs begin, and none of the flank is
    longer than a relief. With `whole` none is longer than its curve, however short a land is: triangles need neighbours of
    about their size.
    """
    plain, module = edge_lengths(gear, sizes, loaded=True).curves, gear.normal_module
    runs, lengths, breaks = list[Floats](), list[Floats](), list[float]()
    for curve in gear.profile.joined_curves:
        s = np.linspace(0.0, 1.0, _EDGE_LENGTHS_FINE)
        run, wanted = _bent(curve, s, sizes, module)
        wanted = np.minimum(plain[curve.kind](run, float(run[-1])), wanted)
        if near and curve.kind in near.curves:
            wanted = np.minimum(wanted, near.curves[curve.kind](run, float(run[-1])))
        if isinstance(curve, Involute) and gear.modification.present:
            if sizes.deviation is not None:
                wanted = np.minimum(wanted, _by_depth(gear, curve.roll(s) * curve.base_radius, sizes.deviation * module))
            breaks = _breaks(gear, s, run, wanted)
            ends = np.interp([0.0, *breaks, 1.0], s, run)
            wanted = np.minimum(wanted, np.diff(ends)[np.searchsorted(ends[1:-1], run)])
        if whole:
            wanted = np.minimum(wanted, run[-1])
        runs.append(run)
        lengths.append(wanted)
    starts = np.cumsum([0.0, *(run[-1] for run in runs)])
    along = np.concatenate([run + start for run, start in zip(runs, starts[:-1], strict=True)])
    gentle = np.split(_gentle(along, np.concatenate(lengths), sizes.growth), np.cumsum([len(run) for run in runs[:-1]]))
    sampled = {curve.kind: _Sampled(run, own) for curve, run, own in zip(gear.profile.joined_curves, runs, gentle, strict=True)}
    return HalfLengths(sampled, tuple(breaks), halved=True)


def _bent(curve: Curve, s: Floats, sizes: MeshSizes, module: float) -> tuple[Floats, Floats]:
    """Return lengths run through (n,) on a curve, and the longest edges there (mm); of a chain for each of its pieces at s."""
    runs, lengths, before = list[Floats](), list[Floats](), 0.0
    for piece in curve.pieces if isinstance(curve, FilletChain) else (curve,):
        run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(piece.points(s), axis=0).T))]
        runs.append(before + run)
        lengths.append(_by_bend(piece, s, run, sizes, module))
        before += float(run[-1])
    return np.concatenate(runs), np.concatenate(lengths)


def _breaks(gear: Gear, s: Floats, run: Floats, wanted: Floats) -> list[float]:
    """Return the parameters of the involute where reliefs begin, but for those so near to others or an end that an edge would
    be tiny.
    """
    form, kept, before = gear.flank_form, list[float](), 0.0
    for roll in form.roll_breaks:
        place = (roll - form.first) / (form.last - form.first)
        at, edge = (float(np.interp(place, s, values)) for values in (run, wanted))
        if min(at - before, run[-1] - at) > _TINY * edge:
            kept.append(place)
            before = at
    return kept


def _gentle(run: Floats, length: Floats, growth: float) -> Floats:
    """Return the lengths (n,) along a line that nowhere grow faster than by `growth` times the distance."""
    ahead = run * growth + np.minimum.accumulate(length - run * growth)
    back = (length + run * growth)[::-1]
    result: Floats = np.minimum(ahead, np.minimum.accumulate(back)[::-1] - run * growth)
    return result


def _by_bend(curve: Curve, s: Floats, run: Floats, sizes: MeshSizes, module: float) -> Floats:
    """Return the longest edges (n,) that turn by no more than edges of fillets should, and follow the curve's bulge."""
    between = np.diff(np.unwrap(curve.direction(s))) / np.diff(run)
    middles = (run[1:] + run[:-1]) / 2
    bend = np.maximum(np.abs(np.interp(run, middles, between)), 1e-12 / run[-1])
    turn = min(sizes.fillet_turn or _FARTHEST, _FARTHEST) if curve.kind is CurveKind.FILLET else _FARTHEST
    longest: Floats = math.radians(turn) / bend
    if sizes.deviation is not None:
        slope = np.maximum(np.abs(np.gradient(bend, run)), 1e-12 / run[-1] ** 2)
        off = sizes.deviation * module
        longest = np.minimum(longest, np.minimum(np.cbrt(_CUBIC * off / slope), (_QUARTIC * off / bend**3) ** 0.25))
    found: Floats = np.maximum(longest, _LEAST * module)
    return found


def _by_depth(gear: Gear, lengths: Floats, deviation: float) -> Floats:
    """Longest edges (n,) on the flank at roll lengths (n,) over which the depth bulges as a parabola does, but for a share of
    `deviation`; all in mm.

    On each piece the depth is alpha xi^2 + beta xi + gamma. On the arc a = xi^2/(2 r_b), alpha xi^2 is straight; beta xi is a
    root, which falls behind near the base circle: beta xi e(h/a) from xi on, e as `_root_error` has it.
    """
    form, base = gear.flank_form, gear.flank_form.base_radius
    heights = np.array([0.0, 0.5, 1.0]) * gear.face_width
    longest = np.full(len(lengths), np.inf)
    xi = np.maximum(lengths, 1e-3 * form.last)
    share, error = _root_error()
    for piece in flank_curves(gear):
        if piece.curve.kind is CurveKind.INVOLUTE:
            middle, span = (piece.first + piece.last) / 2, piece.last - piece.first
            low, mean, high = form.depth(np.array([[piece.first], [middle], [piece.last]]), heights)
            linear = float(np.abs((high - low) / span - 4 * (low - 2 * mean + high) / span**2 * middle).max())
            permitted = np.log(_OF_DEPTH * deviation / np.maximum(linear * xi, 1e-12))
            edge = np.exp(np.interp(permitted, np.log(error), np.log(share))) * xi**2 / (2 * base)
            inside = (lengths >= piece.first) & (lengths <= piece.last)
            longest[inside] = np.minimum(longest, edge)[inside]
    found: Floats = np.maximum(longest, _SHORTEST * gear.normal_module)
    return found


@cache
def _root_error() -> tuple[Floats, Floats]:
    """Return u (n,) and the greatest error e (n,) of a parabola that replaces sqrt(1 + x) over x from 0 to u.

    The parabola runs through the ends and the middle of the curve.
    """
    share, t = np.geomspace(1e-2, 1e8, 201), np.linspace(-1, 1, 201)

    def root(place: Floats) -> Floats:
        result: Floats = np.sqrt(1 + share[:, None] * (1 + place) / 2)
        return result

    low, middle, high = root(np.array([-1.0])), root(np.array([0.0])), root(np.array([1.0]))
    parabola = middle + t * (high - low) / 2 + t**2 * (low - 2 * middle + high) / 2
    error: Floats = np.abs(root(t) - parabola).max(axis=1)
    return share, error


_RIM = 4.0
"""Depth of the body below the root circle, in normal modules, where no bore is given."""

_HELD_LEAST = 0.3
"""Least radius of the held circle as a share of that of the root circle."""


def held_radius(gear: Gear) -> float:
    """Return the radius (mm) of the bore or, without one, 4 m_n below the root circle: what lies deeper hardly bends.

    Of a ring that of the rim or, without one, 3.5 m_n outside the root circle, where it is as good as a solid body.
    """
    if gear.internal:
        return outer_diameter(gear) / 2
    return gear.body.bore / 2 if gear.body.bore else rim_radius(gear)


def round_bore_notice(gear: Gear) -> Notice:
    """Return the notice of a splined bore: elements have a round one in its place, where they are held."""
    text = f"the elements have a round bore of {gear.body.bore:.6g} mm, the root circle of {gear.body.bore_spline}"
    return Notice("round-bore", text)


def rim_radius(gear: Gear) -> float:
    """Return the radius (mm) 4 m_n below the root circle of an external gear."""
    root = gear.root_diameter / 2
    return max(root - _RIM * gear.normal_module, _HELD_LEAST * root)
