"""How a tooth sector is laid out in blocks of quadrangles, and how many edges each of their sides gets.

tip circle         +---------+             (of a ring: seen with the tip up)
                   |  tooth  |            across: edges from flank to flank
end of fillet     /           \\           up: edges from the split of the fillet to the tip
split of fillet  +-------------+
root circle  +--+ |           | +--+      outer: edges of root land and lower fillet
             |  | |   core    | |  |      deep: edges from the fillet to the held circle
held circle  +--+-+-----------+-+--+
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, Land
from gearcad.meshing.section.grading import Grading, graded
from gearcad.meshing.section.outline import HalfLengths, MeshSizes, Side, edge_lengths, require_fillet

__all__ = ["Counts", "LogPlane", "Piece", "SectorLayout", "choose_counts", "quadrangles", "shares"]


_WEIGHT_OF_ALL = 30.0
"""How much more the number of all quadrangles matters than that on one side, squares of logarithms compared."""

_LEAST_BEND = 0.15
"""Slope with which the line below the split leans, at the least, towards where it ends on the held circle."""

_DEEPEST_DIP = 0.25
"""Share of the body's depth by which the line across the tooth may dip."""

_LEVELLED = 3.0
"""In how many times the depth of the root circle below the split the rows of the cut become level with those of the core."""


class Counts(NamedTuple):
    """Edges on the sides of the blocks."""

    across: int
    up: int
    outer: int
    deep: int


def quadrangles(across: float, up: float, outer: float, deep: float) -> float:
    """Quadrangles of all blocks."""
    return across * up + (across + 2 * outer) * deep


def choose_counts(wanted: tuple[float, ...], least: Counts) -> Counts:
    """Whole numbers near the real ones that are wanted, so that roundings make up for one another in the number of all."""
    real = [max(want, few) for want, few in zip(wanted, least, strict=True)]
    aim = quadrangles(*real)
    near = [range(max(few, math.floor(want) - 1), math.floor(want) + 3) for want, few in zip(real, least, strict=True)]

    def off(counts: tuple[int, ...]) -> float:
        apart = sum(math.log(count / want) ** 2 for count, want in zip(counts, real, strict=True))
        return apart + _WEIGHT_OF_ALL * math.log(quadrangles(*counts) / aim) ** 2

    return Counts(*min(itertools.product(*near), key=off))


@dataclass(frozen=True)
class LogPlane:
    """The plane of angle (rad) and logarithm of the radius (mm), in which circles and radii are straight and angles stay.

    Tips are up in it: of a ring it has the logarithm `inward`, of 1 over the radius, and so is a mirror image.
    """

    inward: bool

    def height(self, radius: float) -> float:
        """Logarithm of a radius (mm)."""
        log = math.log(radius)
        return -log if self.inward else log

    def places(self, points: Floats) -> Floats:
        """Places (..., 2) of points (..., 2) in mm."""
        log = np.log(np.hypot(points[..., 0], points[..., 1]))
        return np.stack([np.arctan2(points[..., 1], points[..., 0]), -log if self.inward else log], -1)

    def points(self, places: Floats) -> Floats:
        """Points (..., 2) in mm of places (..., 2)."""
        log = -places[..., 1:] if self.inward else places[..., 1:]
        result: Floats = np.exp(log) * np.stack([np.cos(places[..., 0]), np.sin(places[..., 0])], -1)
        return result


@dataclass(frozen=True)
class Piece:
    """A part of one of the outline's curves, graded; the side of the outline to which it belongs, on the left.

    It has at least so many edges.
    """

    side: Side
    curve: Curve
    grading: Grading
    least: int = 1

    def points(self, count: int) -> Floats:
        """Ends and middles (2 count + 1, 2) of so many edges, in order (mm)."""
        return self.curve.points(self.grading.with_middles(count))


def edges_of(pieces: tuple[Piece, ...]) -> float:
    """Edges that the sizes ask for on some pieces."""
    return sum(piece.grading.edges for piece in pieces)


def least_of(pieces: tuple[Piece, ...]) -> int:
    """Edges that some pieces have at least."""
    return sum(piece.least for piece in pieces)


def shares(pieces: tuple[Piece, ...], count: int) -> list[tuple[Piece, int]]:
    """Each piece with its edges, of `count` in all, in proportion to what is wanted (Webster's divisors)."""
    given = [piece.least for piece in pieces]
    for _ in range(count - sum(given)):
        most = max(range(len(pieces)), key=lambda k: pieces[k].grading.edges / (given[k] + 0.5))
        given[most] += 1
    return list(zip(pieces, given, strict=True))


@dataclass(frozen=True)
class SectorLayout:
    """The lines between the blocks of the left half of tooth 0's sector, and the edges that the sizes ask for on them.

    Inside the outline they are drawn in its `plane`, where gears of few teeth look like those of many. `lengths` are the edge
    lengths along the outline, where they are not those of `sizes`, and are then nowhere exceeded; `rows` those from the split
    to the tip land, which decide on no other line. With `even` the held circle gets an even number of edges. Raises
    GeometryError for a tooth without a fillet.
    """

    gear: Gear
    held_radius: float
    sizes: MeshSizes
    lengths: HalfLengths | None = None
    rows: HalfLengths | None = None
    even: bool = False

    def __post_init__(self) -> None:
        require_fillet(self.gear)

    @cached_property
    def plane(self) -> LogPlane:
        """Angle and logarithm of the radius, the tip up."""
        return LogPlane(inward=self.gear.internal)

    # ------------------------------------------------------------------ the outline

    @cached_property
    def _curves(self) -> dict[CurveKind, Curve]:
        return {curve.kind: curve for curve in self.gear.profile.curves}

    @cached_property
    def root(self) -> tuple[Piece, ...]:
        """From the cut along root land, if there is one, and lower fillet to the split."""
        lengths = self._lengths
        land = self._piece(lengths, Side.LEFT_ROOT, CurveKind.ROOT) if CurveKind.ROOT in self._curves else ()
        return (*land, *self._piece(lengths, Side.LEFT_FILLET, CurveKind.FILLET, 0.0, self.split))

    @cached_property
    def flank(self) -> tuple[Piece, ...]:
        """From the split along upper fillet, flank and tip chamfer, if there is one, to the tip land.

        A chamfer turns more from the land than from the flank, so the block has its corner there.
        """
        return self._flank(self.rows or self._lengths)

    def _flank(self, lengths: HalfLengths) -> tuple[Piece, ...]:
        fillet = self._piece(lengths, Side.LEFT_FILLET, CurveKind.FILLET, self.split, 1.0)
        chamfer = self._piece(lengths, Side.TIP, CurveKind.CHAMFER) if CurveKind.CHAMFER in self._curves else ()
        involute = lengths.parts(self._curves[CurveKind.INVOLUTE])
        flank = [self._piece(lengths, Side.LEFT_FLANK, CurveKind.INVOLUTE, *part)[0] for part in involute]
        return (*fillet, *flank, *chamfer)

    @cached_property
    def tip(self) -> tuple[Piece, ...]:
        """The tip land from its left end to its right one, graded alike from both."""
        half, size = self._curves[CurveKind.TIP], self._lengths.curves[CurveKind.TIP]
        (radius,), (angle,) = half.polar(np.zeros(1))
        land = Land(CurveKind.TIP, float(radius), float(angle), -float(angle))
        return (Piece(Side.TIP, land, graded(land.points, lambda run, whole: size(np.minimum(run, whole - run), whole))),)

    @cached_property
    def _lengths(self) -> HalfLengths:
        return self.lengths or edge_lengths(self.gear, self.sizes, loaded=True)

    def _piece(self, lengths: HalfLengths, side: Side, kind: CurveKind, first: float = 0.0, last: float = 1.0) -> tuple[Piece]:
        curve = self._curves[kind]
        grading = lengths.graded(curve, first, last)
        least = 1 if self.lengths is None else max(1, math.ceil(grading.edges - 1e-9))
        return (Piece(side, curve, grading, least),)

    @cached_property
    def split(self) -> float:
        """Parameter of the fillet where the blocks of tooth, core and root meet: half-way in direction along it."""
        s = np.linspace(0.0, 1.0, 257)
        lean = self._lean(s)
        middle = (math.pi / 2 + max(float(lean[-1]), 0.0)) / 2
        at = int(np.argmax(lean < middle))
        return float(np.interp(-middle, -lean[at - 1 : at + 1], s[at - 1 : at + 1]))

    def _lean(self, s: Floats) -> Floats:
        """Angle (rad) of the fillet to the radius at parameters (n,): a right one at the root circle, less further up."""
        fillet = self._curves[CurveKind.FILLET]
        result: Floats = fillet.polar(s)[1] - fillet.direction(s)
        return math.pi - result if self.plane.inward else result

    # ------------------------------------------------------------------ lines through the inside

    @cached_property
    def corner(self) -> Floats:
        """Angle and logarithm of the radius (2,) of the split."""
        result: Floats = self.plane.places(self._curves[CurveKind.FILLET].points(np.array([self.split])))[0]
        return result

    @cached_property
    def _corner_lean(self) -> float:
        return float(self._lean(np.array([self.split]))[0])

    @cached_property
    def depth(self) -> float:
        """From the split to the held circle, in logarithms of radii."""
        return float(self.corner[1]) - self.plane.height(self.held_radius)

    def across_line(self, s: Floats) -> Floats:
        """Angles and logarithms (n, 2) along the line across the tooth, s from 0 at the left split to 1 at the right one.

        Three quadrangles meet at the split, so each is given a third of the straight angle; hence the dip.
        """
        half = self.corner[0]
        slope = math.tan(max(self._corner_lean - math.pi / 6, 0.0))
        dip = min(half * slope / 2, _DEEPEST_DIP * self.depth)
        place = 1 - 2 * s
        return np.stack([half * place, self.corner[1] - dip * (1 - place**2)], -1)

    def down_line(self, s: Floats) -> Floats:
        """Angles and logarithms (n, 2) along the line from the held circle (s = 0) up to the left split (s = 1)."""
        slope = max(math.tan(math.pi / 3 - self._corner_lean), _LEAST_BEND)
        way = math.pi / self.gear.tooth_count * self._core_share - self.corner[0]
        down = self.depth * (1 - s)
        moved = way * -np.expm1(-slope * down / max(abs(way), 1e-12))
        return np.stack([self.corner[0] + moved, self.corner[1] - down], -1)

    def cut_line(self, down: Floats) -> Floats:
        """Angles and logarithms (n, 2) on the cut ahead, level with those of the line below the split but for its upper end.

        The root circle is deeper than the split; what that takes off is made up for within a few times as much.
        """
        root = self.plane.height(self.gear.profile.root_diameter / 2)
        drop = max(float(self.corner[1]) - root, 1e-9 * self.depth)
        below, fades = self.corner[1] - down[:, 1], _LEVELLED * drop
        left = 1 - np.expm1(-below / fades) / math.expm1(-self.depth / fades)
        return np.stack([np.full(len(down), math.pi / self.gear.tooth_count), down[:, 1] - drop * left], -1)

    # ------------------------------------------------------------------ edges on them

    @cached_property
    def across(self) -> Grading:
        """The line across the tooth, edges growing from both fillets."""
        module, fillet = self.gear.normal_module, self.sizes.fillet * self.gear.normal_module

        def size(run: Floats, whole: float) -> Floats:
            grown = fillet + self.sizes.growth * np.minimum(run, whole - run)
            return np.minimum(self.sizes.outline * module, grown)

        return graded(lambda s: self.plane.points(self.across_line(s)), size)

    @cached_property
    def down(self) -> Grading:
        """The line below the split, edges growing down to the rim's."""
        sizes, module = self.sizes, self.gear.normal_module

        def size(run: Floats, whole: float) -> Floats:
            return np.minimum(sizes.rim * module, sizes.fillet * module + sizes.growth * (whole - run))

        return graded(lambda s: self.plane.points(self.down_line(s)), size)

    @cached_property
    def wanted(self) -> tuple[float, float, float, float]:
        """Edges across, up, outer and deep that the sizes ask for, `rows` aside."""
        return self._across, edges_of(self._flank(self._lengths)), edges_of(self.root), self.down.edges

    @property
    def _across(self) -> float:
        return max(self.across.edges, edges_of(self.tip))

    @cached_property
    def _core_share(self) -> float:
        """Share of the held circle that belongs to the core, for edges of one length there."""
        return self._across / (self._across + 2 * edges_of(self.root))

    @cached_property
    def counts(self) -> Counts:
        """Edges on the sides of the blocks; each piece of a side needs one at least, the tooth two across."""
        plain = self._flank(self._lengths)
        counts = choose_counts(self.wanted, Counts(2, least_of(plain), least_of(self.root), 1))
        if self.even:
            counts = counts._replace(across=counts.across + counts.across % 2)
        if self.rows is None:
            return counts
        return counts._replace(up=max(least_of(self.flank), round(counts.up * edges_of(self.flank) / edges_of(plain))))
