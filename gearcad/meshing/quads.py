r"""Quadratic quadrangles of a tooth sector, mapped block by block, and the quality of plane elements.

tip circle         +---------+             (of a ring: seen with the tip up)
                   |  tooth  |            across: edges from flank to flank
end of fillet     /           \           up: edges from the split of the fillet to the tip
split of fillet  +-------------+
root circle  +--+ |           | +--+      outer: edges of root land and lower fillet
             |  | |   core    | |  |      deep: edges from the fillet to the held circle
held circle  +--+-+-----------+-+--+
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.core.errors import SolverError
from gearcad.core.records import Floats, Wholes
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, FilletChain, Land
from gearcad.meshing.fem import Element, node_places, scaled_jacobians, shape_slopes
from gearcad.meshing.outline import (
    OTHER_SIDE,
    Grading,
    HalfLengths,
    MeshSizes,
    OutlineSide,
    SectorSides,
    edge_lengths,
    graded,
    require_fillet,
)


def edges_of_chain(chain: Wholes) -> Wholes:
    """Return the nodes (n, 3) - end, end, middle - of each edge of a chain of nodes end, middle, end, middle ... end."""
    return np.stack([chain[:-1:2], chain[2::2], chain[1::2]], -1)


LEAST_SCALED_JACOBIAN = 0.1
"""Least scaled Jacobian of usable quadrangles; below, the sharpest corner has less than 6 degrees."""


@dataclass(frozen=True)
class MeshQuality:
    """`least_angle` (deg); gamma, twice the radius of the inner circle over the outer's, 1 for an equilateral triangle.

    `least_jacobian` is the smallest ratio of an element's Jacobian at a vertex to that of the straight triangle: 1 for
    straight edges, 0 or less where a curved edge folds the element.
    """

    triangles: int
    least_angle: float
    least_gamma: float
    mean_gamma: float
    least_jacobian: float


def mesh_quality(points: Floats, triangles: NDArray[np.int64]) -> MeshQuality:
    """Return the quality of quadratic triangles (m, 6) with nodes at `points` (n, 2)."""
    corners = points[triangles[:, :3]]
    sides = np.linalg.norm(corners[:, [1, 2, 0]] - corners[:, [2, 0, 1]], axis=-1)  # side k faces corner k
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    twice_area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    a, b, c = sides.T
    gamma = 4 * twice_area**2 / ((a + b + c) * a * b * c)  # 2 r/R with r = A/s and R = a b c/(4 A)
    squares = sides**2
    cosines = (squares.sum(axis=1)[:, None] - 2 * squares) / (2 * a * b * c)[:, None] * sides
    jacobian = _jacobians(points[triangles]) / twice_area[:, None]
    return MeshQuality(
        triangles=len(triangles),
        least_angle=float(np.degrees(np.arccos(np.clip(cosines, -1, 1))).min()),
        least_gamma=float(gamma.min()),
        mean_gamma=float(gamma.mean()),
        least_jacobian=float(jacobian.min()),
    )


def _jacobians(nodes: Floats) -> Floats:
    """Determinant of the quadratic map at the three corners of each element (m, 6, 2)."""
    found = []
    for along_s, along_t in shape_slopes("tri6", node_places("tri6")[:3]):
        x, y = np.einsum("a,mac->cm", along_s, nodes), np.einsum("a,mac->cm", along_t, nodes)
        found.append(x[0] * y[1] - x[1] * y[0])
    return np.stack(found, -1)


def transfinite(lower: Floats, upper: Floats, left: Floats, right: Floats) -> Floats:
    """Return the vertices (rows, columns, 2) between the sides.

    `lower` and `upper` (columns, 2) run from left to right, `left` and `right` (rows, 2) upwards; they share their corners. A
    vertex stands where the lines cross that join its ends, by length, on opposite sides, so the spacing of each side fades
    into that of the other (W. J. Gordon and C. A. Hall, 1973; weights of L.-E. Eriksson, 1982).
    """
    below, above = (_shares(side)[None, :, None] for side in (lower, upper))
    behind, ahead = (_shares(side)[:, None, None] for side in (left, right))
    wide, high = above - below, ahead - behind
    u = (below + behind * wide) / (1 - wide * high)
    v = behind + u * high
    corners = (1 - v) * ((1 - u) * lower[0] + u * lower[-1]) + v * ((1 - u) * upper[0] + u * upper[-1])
    result: Floats = (1 - v) * lower + v * upper + (1 - u) * left[:, None] + u * right[:, None] - corners
    return result


def _shares(line: Floats) -> Floats:
    """Return the length of a polyline (n, 2) up to each point, over the whole."""
    run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T))]
    result: Floats = run / run[-1]
    return result


_WEIGHT_OF_ALL = 30.0
"""Weight of the number of all quadrangles against that on one side, squares of logarithms compared."""

_LEAST_BEND = 0.15
"""Slope with which the line below the split leans, at the least, towards where it ends on the held circle."""

_DEEPEST_DIP = 0.25
"""Share of the body's depth by which the line across the tooth may dip."""

_LEVELLED = 3.0
"""Height over which the rows of the cut become level with those of the core, over the depth of the root circle below the split.
"""


class Counts(NamedTuple):
    """Numbers of edges on the sides of the blocks."""

    across: int
    up: int
    outer: int
    deep: int


def quadrangles(across: float, up: float, outer: float, deep: float) -> float:
    """Return the quadrangles of all blocks."""
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
        """Return the places (..., 2) of points (..., 2) in mm."""
        log = np.log(np.hypot(points[..., 0], points[..., 1]))
        return np.stack([np.arctan2(points[..., 1], points[..., 0]), -log if self.inward else log], -1)

    def points(self, places: Floats) -> Floats:
        """Return the points (..., 2) in mm of places (..., 2)."""
        log = -places[..., 1:] if self.inward else places[..., 1:]
        result: Floats = np.exp(log) * np.stack([np.cos(places[..., 0]), np.sin(places[..., 0])], -1)
        return result


@dataclass(frozen=True)
class CurvePiece:
    """Part of a curve of the outline with its graded edges, and the side of the outline on its left.

    It has at least so many edges.
    """

    side: OutlineSide
    curve: Curve
    grading: Grading
    least: int = 1

    def points(self, count: int) -> Floats:
        """Ends and middles (2 count + 1, 2) of so many edges, in order (mm)."""
        return self.curve.points(self.grading.with_middles(count))


def edges_of(pieces: tuple[CurvePiece, ...]) -> float:
    """Return the edges that the sizes ask for on some pieces."""
    return sum(piece.grading.edges for piece in pieces)


def least_of(pieces: tuple[CurvePiece, ...]) -> int:
    """Return the edges that some pieces have at least."""
    return sum(piece.least for piece in pieces)


def shares(pieces: tuple[CurvePiece, ...], count: int) -> list[tuple[CurvePiece, int]]:
    """Return each piece with its edges, of `count` in all, in proportion to what is wanted (Webster's divisors)."""
    given = [piece.least for piece in pieces]
    for _ in range(count - sum(given)):
        most = max(range(len(pieces)), key=lambda k: pieces[k].grading.edges / (given[k] + 0.5))
        given[most] += 1
    return list(zip(pieces, given, strict=True))


_NEXT_TO_END = 0.01
"""Share of a fillet within which a corner counts as its end, or as the place where blocks meet."""


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
        return {curve.kind: curve for curve in self.gear.profile.joined_curves}

    @cached_property
    def root(self) -> tuple[CurvePiece, ...]:
        """Pieces of the outline from the cut along root land, if there is one, and lower fillet to the split."""
        lengths = self._lengths
        land = self._piece(lengths, OutlineSide.LEFT_ROOT, CurveKind.ROOT) if CurveKind.ROOT in self._curves else ()
        return (*land, *self._fillet(lengths, 0.0, self.split))

    @cached_property
    def flank(self) -> tuple[CurvePiece, ...]:
        """Pieces of the outline from the split along upper fillet, flank and tip chamfer, if there is one, to the tip land.

        A chamfer turns more from the land than from the flank, so the block has its corner there.
        """
        return self._flank(self.rows or self._lengths)

    def _flank(self, lengths: HalfLengths) -> tuple[CurvePiece, ...]:
        fillet = self._fillet(lengths, self.split, 1.0)
        chamfer = self._piece(lengths, OutlineSide.TIP, CurveKind.CHAMFER) if CurveKind.CHAMFER in self._curves else ()
        involute = lengths.parts(self._curves[CurveKind.INVOLUTE])
        flank = [self._piece(lengths, OutlineSide.LEFT_FLANK, CurveKind.INVOLUTE, *part)[0] for part in involute]
        return (*fillet, *flank, *chamfer)

    def _fillet(self, lengths: HalfLengths, first: float, last: float) -> tuple[CurvePiece, ...]:
        """Pieces of the fillet between two parameters; edges end at its corners, but for one that is next to an end."""
        fillet = self._curves[CurveKind.FILLET]
        breaks = fillet.breaks if isinstance(fillet, FilletChain) else ()
        inside = [at for at in breaks if first + _NEXT_TO_END < at < last - _NEXT_TO_END]
        ends = pairwise((first, *inside, last))
        return tuple(self._piece(lengths, OutlineSide.LEFT_FILLET, CurveKind.FILLET, *part)[0] for part in ends)

    @cached_property
    def tip(self) -> tuple[CurvePiece, ...]:
        """The tip land from its left end to its right one, graded alike from both."""
        half, size = self._curves[CurveKind.TIP], self._lengths.curves[CurveKind.TIP]
        (radius,), (angle,) = half.polar(np.zeros(1))
        land = Land(CurveKind.TIP, float(radius), float(angle), -float(angle))
        return (
            CurvePiece(
                OutlineSide.TIP, land, graded(land.points, lambda run, whole: size(np.minimum(run, whole - run), whole))
            ),
        )

    @cached_property
    def _lengths(self) -> HalfLengths:
        return self.lengths or edge_lengths(self.gear, self.sizes, loaded=True, notched=False)

    def _piece(
        self, lengths: HalfLengths, side: OutlineSide, kind: CurveKind, first: float = 0.0, last: float = 1.0
    ) -> tuple[CurvePiece]:
        curve = self._curves[kind]
        grading = lengths.graded(curve, first, last)
        least = 1 if self.lengths is None else max(1, math.ceil(grading.edges - 1e-9))
        return (CurvePiece(side, curve, grading, least),)

    @cached_property
    def split(self) -> float:
        """Parameter of the fillet where the blocks of tooth, core and root meet: half-way in direction along it."""
        s = np.linspace(0.0, 1.0, 257)
        lean = self._lean(s)
        middle = (math.pi / 2 + max(float(lean[-1]), 0.0)) / 2
        at = int(np.argmax(lean < middle))
        return float(np.interp(-middle, -lean[at - 1 : at + 1], s[at - 1 : at + 1]))

    def _lean(self, s: Floats) -> Floats:
        """Return the angle (rad) of the fillet to the radius at parameters (n,): a right one at the root circle, less further
        up.
        """
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
        """Distance from the split to the held circle, in logarithms of radii."""
        return float(self.corner[1]) - self.plane.height(self.held_radius)

    def across_line(self, s: Floats) -> Floats:
        """Return the angles and logarithms (n, 2) along the line across the tooth, s from 0 at the left split to 1 at the right
        one.

        Three quadrangles meet at the split, so each is given a third of the straight angle; hence the dip.
        """
        half = self.corner[0]
        slope = math.tan(max(self._corner_lean - math.pi / 6, 0.0))
        dip = min(half * slope / 2, _DEEPEST_DIP * self.depth)
        place = 1 - 2 * s
        return np.stack([half * place, self.corner[1] - dip * (1 - place**2)], -1)

    def down_line(self, s: Floats) -> Floats:
        """Return the angles and logarithms (n, 2) along the line from the held circle (s = 0) up to the left split (s = 1)."""
        slope = max(math.tan(math.pi / 3 - self._corner_lean), _LEAST_BEND)
        way = math.pi / self.gear.tooth_count * self._core_share - self.corner[0]
        down = self.depth * (1 - s)
        moved = way * -np.expm1(-slope * down / max(abs(way), 1e-12))
        return np.stack([self.corner[0] + moved, self.corner[1] - down], -1)

    def cut_line(self, down: Floats) -> Floats:
        """Return the angles and logarithms (n, 2) on the cut ahead, level with those of the line below the split but for its
        upper end.

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


_FLIPPED = np.array([-1.0, 1.0])
"""Turns angles over and leaves radii as they are."""


@dataclass(frozen=True)
class QuadMesh(SectorSides):
    """Quadrangles of tooth 0, centred on +x, and its share of the body.

    `points` (n, 2) in mm, the `vertices` first; `quads` (m, 8), four vertices counter-clockwise and the nodes between 0-1,
    1-2, 2-3, 3-0.
    """

    points: Floats
    vertices: int
    quads: Wholes
    sides: Mapping[OutlineSide, Wholes]

    @property
    def cells(self) -> Wholes:
        return self.quads


def mesh_quads(gear: Gear, held_radius: float, sizes: MeshSizes) -> QuadMesh:
    """Mesh tooth 0 of the transverse section up to `held_radius` (mm), symmetric about the middle of the tooth.

    The number of quadrangles follows the square of the sizes. Raises GeometryError for a tooth without a fillet, SolverError
    where quadrangles would be too distorted.
    """
    return fill_layout(SectorLayout(gear, held_radius, sizes))


def fill_layout(layout: SectorLayout) -> QuadMesh:
    """Return the quadrangles of a layout. Raises SolverError where they would be too distorted."""
    mesh = _quadratic(_Blocks(layout))
    worst = float(scaled_jacobians(Element.QUAD8, mesh.points[mesh.quads]).min())
    if worst < LEAST_SCALED_JACOBIAN:
        raise SolverError(
            f"the section of the gear with {layout.gear.teeth} teeth gives a distorted mesh: least scaled Jacobian "
            f"{worst:.3f}, must be at least {LEAST_SCALED_JACOBIAN}"
        )
    return mesh


@dataclass(frozen=True)
class _Blocks:
    """The sector as two grids of vertices, columns from the left (y > 0) to the right, rows towards the tip: body and tooth.

    The tooth stands on the middle of the body's last row.
    """

    layout: SectorLayout

    @property
    def _plane(self) -> LogPlane:
        return self.layout.plane

    @cached_property
    def root(self) -> Floats:
        """Ends and middles (2 outer + 1, 2) from the cut to the split of the fillet (mm)."""
        return _along(self.layout.root, self.layout.counts.outer)

    @cached_property
    def flank(self) -> Floats:
        """Ends and middles (2 up + 1, 2) from the split of the fillet to the tip land (mm)."""
        return _along(self.layout.flank, self.layout.counts.up)

    @cached_property
    def tip(self) -> Floats:
        """Ends and middles (2 across + 1, 2) of the tip land from left to right (mm)."""
        return _along(self.layout.tip, self.layout.counts.across)

    @cached_property
    def tooth(self) -> Floats:
        """Vertices (up + 1, across + 1, 2) as angles and logarithms of radii."""
        left = self._plane.places(self.flank[::2])
        return transfinite(self._across, self._plane.places(self.tip[::2]), left, left * _FLIPPED)

    @cached_property
    def body(self) -> Floats:
        """Vertices (deep + 1, outer + across + outer + 1, 2) as angles and logarithms of radii."""
        layout, counts = self.layout, self.layout.counts
        down = layout.down_line(layout.down.ends(counts.deep))
        cut = layout.cut_line(down)
        left = transfinite(np.linspace(cut[0], down[0], counts.outer + 1), self._plane.places(self.root[::2]), cut, down)
        core = transfinite(np.linspace(down[0], down[0] * _FLIPPED, counts.across + 1), self._across, down, down * _FLIPPED)
        return np.concatenate([left[:, :-1], core, left[:, -2::-1] * _FLIPPED], axis=1)

    @cached_property
    def _across(self) -> Floats:
        return self.layout.across_line(self.layout.across.ends(self.layout.counts.across))

    @cached_property
    def numbers(self) -> tuple[Wholes, Wholes]:
        """Numbers of the vertices of body and tooth, each vertex once."""
        counts = self.layout.counts
        rows, columns, _ = self.body.shape
        body = np.arange(rows * columns).reshape(rows, columns)
        above = body.size + np.arange(counts.up * (counts.across + 1)).reshape(counts.up, -1)
        return body, np.r_[body[-1:, counts.outer : counts.outer + counts.across + 1], above]

    @property
    def points(self) -> Floats:
        """All vertices (n, 2) in mm, as they are numbered."""
        places = np.concatenate([self.body.reshape(-1, 2), self.tooth[1:].reshape(-1, 2)])
        return self._plane.points(places)

    @property
    def quads(self) -> Wholes:
        """Vertices (m, 4) of all quadrangles, counter-clockwise."""
        grids = ([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]] for grid in self.numbers)
        quads = np.concatenate([np.stack([part.ravel() for part in grid], -1) for grid in grids])
        return quads[:, ::-1] if self._plane.inward else quads

    @cached_property
    def sides(self) -> list[tuple[OutlineSide, Wholes, Floats]]:
        """The outline in order: vertices (n + 1,), and the ends and middles (2 n + 1, 2) of their edges (mm)."""
        body, tooth = self.numbers
        outer = self.layout.counts.outer
        # From the cut over the root and up to the tip: numbers on both sides, points on the left.
        left, right = np.r_[body[-1, :outer], tooth[:, 0]], np.r_[body[-1, : -outer - 1 : -1], tooth[:, -1]]
        points = np.concatenate([self.root[:-1], self.flank])
        pieces = [*shares(self.layout.root, outer), *shares(self.layout.flank, self.layout.counts.up)]
        stops = np.cumsum([0, *(count for _, count in pieces)])
        up = [
            (piece.side, slice(a, b + 1), slice(2 * a, 2 * b + 1))
            for (piece, _), (a, b) in zip(pieces, pairwise(stops), strict=True)
        ]
        angles = self.body[0, :, 0]
        arc = np.stack([_with_middles(angles), np.full(2 * len(angles) - 1, self.body[0, 0, 1])], -1)
        return [
            *((OTHER_SIDE[side], right[ends], mirrored(points[both])) for side, ends, both in up),
            (OutlineSide.TIP, tooth[-1, ::-1], self.tip[::-1]),
            *((side, left[ends][::-1], points[both][::-1]) for side, ends, both in reversed(up)),
            (OutlineSide.AHEAD, body[::-1, 0], self._straight(self.body[::-1, 0])),
            (OutlineSide.HELD, body[0], self._plane.points(arc)),
            (OutlineSide.BEHIND, body[:, -1], self._straight(self.body[:, -1])),
        ]

    def _straight(self, places: Floats) -> Floats:
        return _with_middles(self._plane.points(places))


def _along(pieces: tuple[CurvePiece, ...], count: int) -> Floats:
    """Ends and middles (2 count + 1, 2) of the edges of pieces that follow each other (mm)."""
    every = [piece.points(own) for piece, own in shares(pieces, count)]
    return np.concatenate([*(points[:-1] for points in every[:-1]), every[-1]])


def _with_middles(ends: Floats) -> Floats:
    """Return the values (n + 1, ...) with the means of neighbours between them."""
    result = np.empty((2 * len(ends) - 1, *ends.shape[1:]))
    result[::2], result[1::2] = ends, (ends[1:] + ends[:-1]) / 2
    return result


def mirrored(points: Floats) -> Floats:
    """Return the points (n, 2) on the other side of the tooth."""
    result: Floats = points * np.array([1.0, -1.0])
    return result


def _quadratic(blocks: _Blocks) -> QuadMesh:
    """Return the vertices and the nodes between them: on the exact curves along the outline, half-way elsewhere."""
    points, quads = blocks.points, blocks.quads
    pairs = np.stack([quads, np.roll(quads, -1, axis=1)], -1).reshape(-1, 2)
    edges, which = np.unique(np.sort(pairs, axis=1), axis=0, return_inverse=True)
    middles = points[edges].mean(axis=1)
    keys = edges[:, 0] * len(points) + edges[:, 1]
    sides: dict[OutlineSide, Wholes] = {}
    for side, chain, exact in blocks.sides:
        low, high = np.minimum(chain[1:], chain[:-1]), np.maximum(chain[1:], chain[:-1])
        between = np.searchsorted(keys, low * len(points) + high)
        points[chain], middles[between] = exact[::2], exact[1::2]
        nodes = np.empty(len(exact), int)
        nodes[::2], nodes[1::2] = chain, len(points) + between
        # Tip and fillets come in pieces, one after the other.
        sides[side] = np.r_[sides[side], nodes[1:]] if side in sides else nodes
    return QuadMesh(np.r_[points, middles], len(points), np.c_[quads, len(points) + which.reshape(-1, 4)], sides)
