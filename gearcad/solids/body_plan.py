"""Plans of bodies: colours, axles, chamfer cones, keyways, rims, and the strips of racks.

What all surfaces of the toothed side have in common is that nothing changes along the teeth. So c = x - drift z tells all:
the height there, the piece of the outline, and which strip between two lines of constant c a place belongs to. Going from the
corner of least c to that of greatest, both ways along the rim of the rectangle c never falls, so a line crosses each once.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, at_least
from gearcad.core.records import Floats, Wholes
from gearcad.geometry import Body, Gear
from gearcad.geometry.gear_data import least_rim_diameter
from gearcad.geometry.rack import Rack
from gearcad.geometry.rack_root import FilletArc, RackCurveKind

Colour = tuple[float, float, float]

STEEL: Colour = (0.62, 0.66, 0.72)
"""Colour of a single part."""

BRIGHT_STEEL: Colour = (0.809468152636, 0.832283570587, 0.865042042985)
"""Colour of a part by itself in STEP: the shares of STEEL as shares of light."""

PART_COLOURS: dict[str, Colour] = {
    "pinion": (0.80, 0.55, 0.20),
    "wheel": (0.45, 0.58, 0.72),
    "rack": (0.45, 0.58, 0.72),
    "shaft": (0.80, 0.55, 0.20),
    "hub": (0.45, 0.58, 0.72),
    "bracket": (0.55, 0.55, 0.55),
}
"""Colours of the parts of an assembly."""

SHAFT_COLOURS: tuple[Colour, Colour] = ((0.74, 0.76, 0.78), (0.66, 0.68, 0.70))
"""Colours of the shafts of pinion and wheel."""

BEARING_COLOUR: Colour = (0.38, 0.42, 0.47)
"""Colour of bearings."""

TRAIN_COLOURS: dict[str, tuple[Colour, Colour]] = {
    "suns": ((0.80, 0.55, 0.20), (0.72, 0.38, 0.22)),
    "rings": ((0.45, 0.58, 0.72), (0.27, 0.42, 0.60)),
    "rims": ((0.45, 0.66, 0.42), (0.70, 0.74, 0.36)),
    "carrier": ((0.55, 0.55, 0.55), (0.55, 0.55, 0.55)),
}
"""Colours of the parts of a planetary train, the first and the second of their kind: no two parts that differ share one."""

STAGE_COLOURS: tuple[Colour, Colour] = ((0.66, 0.44, 0.58), (0.52, 0.47, 0.68))
"""Colours of pinion and wheel of a stage; those of each further stage are darker."""


@dataclass(frozen=True)
class Axle:
    """An upright axis through (x, y) (mm) and the name of what turns about it; `on` is the axle that carries it about."""

    name: str
    x: float = 0.0
    y: float = 0.0
    on: Axle | None = None


@dataclass(frozen=True)
class EndCone:
    """`face_radius` (mm) is where the cone meets the end plane, infinite without a chamfer; `slope` the tangent of its angle to
    the axis. `side` is 1 where the tips lie outside that circle, -1 on a ring, whose tips lie inside it.
    """

    face_radius: float
    slope: float
    side: int

    @classmethod
    def of(cls, gear: Gear) -> EndCone:
        slope = math.tan(math.radians(gear.body.end_chamfer_angle))
        side = -1 if gear.internal else 1
        if not gear.body.end_chamfer:
            return cls(side * math.inf, slope, side)
        return cls(gear.profile.tip_diameter / 2 - side * gear.body.end_chamfer * slope, slope, side)

    def snapped(self, radii: Iterable[float], near: float) -> EndCone:
        """Return the cone with its face radius moved onto the first of some radii that is nearer than `near` (mm)."""
        return next((replace(self, face_radius=radius) for radius in radii if abs(radius - self.face_radius) < near), self)

    @property
    def present(self) -> bool:
        return math.isfinite(self.face_radius)

    @property
    def sine(self) -> float:
        """Sine of its angle to the axis."""
        return self.slope / math.hypot(1.0, self.slope)

    def beyond(self, radius: ArrayLike) -> Floats:
        """Return the distance (mm) of a radius (mm) beyond the face radius towards the tips.

        The cone is where this is above 0.
        """
        result: Floats = self.side * (np.asarray(radius, float) - self.face_radius)
        return result

    def setback(self, radius: ArrayLike) -> Floats:
        """Axial distance (mm) of the surface from the end plane at `radius` (mm)."""
        result: Floats = np.maximum(self.beyond(radius) / self.slope, 0.0)
        return result

    def radius(self, setback: float) -> float:
        """Return the radius (mm) at an axial distance (mm) from the end plane."""
        return self.face_radius + self.side * setback * self.slope


def keyway_half_angle(body: Body) -> float:
    """Return half of the angle (rad) over which the keyway opens the bore."""
    return math.asin(body.keyway_width / body.bore)


def require_rim(gear: Gear) -> float:
    """Return the rim diameter (mm) of a ring. Raises GeometryError where none was given: the teeth alone are no body."""
    rim = gear.body.rim_diameter
    if rim is None:
        permitted = f"must be given, at least {at_least(least_rim_diameter(gear))} mm: a solid of a ring ends there"
        raise GeometryError("body.rim_diameter", rim, permitted)
    return rim


_SNAP = 1e-5
"""A chamfer that begins this close (mm) to where two pieces of the outline meet begins there: no slivers."""


@dataclass(frozen=True)
class End:
    """One end face at the height `z` (mm). `inward` is +1 at the lower end (z = 0), -1 at the upper."""

    z: float
    inward: int
    cone: EndCone

    @property
    def widens(self) -> int:
        """+1 where the cone widens upwards, -1 where it does downwards."""
        return self.inward * self.cone.side

    def height(self, radius: ArrayLike) -> Floats:
        """z (mm) of the end's surface at a radius (mm), array."""
        return np.asarray(self.z + self.inward * self.cone.setback(radius))


def gear_ends(gear: Gear, junctions: Iterable[float]) -> tuple[End, End]:
    """Return the lower and upper end of a gear; a chamfer's face radius snaps to the radii (mm) where pieces of the outline
    meet.
    """
    cone = EndCone.of(gear).snapped(junctions, _SNAP)
    return End(0.0, 1, cone), End(gear.face_width, -1, cone)


SNAP = 1e-6
"""A line this close to a corner (mm) goes through it: no slivers, and less than any tolerance of a solid."""


_Place = tuple[float, float]
_Corners = tuple[_Place, _Place, _Place]


class RackSide(Enum):
    """A side of the rectangle: the end faces at z = 0 and z = face width, and those at x = 0 and x = length."""

    BOTTOM = "z = 0"
    TOP = "z = face width"
    START = "x = 0"
    END = "x = length"


@dataclass(frozen=True)
class OutlinePiece:
    """A piece of the outline at z = 0 between two points (c, y), c rising; `fillet` where it is an arc, of a tooth at `middle`.

    The arc of a right half of a tooth is `mirrored`.
    """

    start: tuple[float, float]
    end: tuple[float, float]
    fillet: FilletArc | None = None
    middle: float = 0.0
    mirrored: bool = False

    @property
    def centre(self) -> float:
        """Parameter c of the middle of the fillet's arc."""
        assert self.fillet is not None
        offset = self.fillet.x * self.fillet.stretch
        return self.middle - offset if self.mirrored else self.middle + offset

    def height(self, c: float) -> float:
        """Return the height over the reference line (mm)."""
        (first, low), (last, high) = self.start, self.end
        if self.fillet is None:
            return low + (high - low) * (c - first) / (last - first)
        across = min(abs(c - self.centre) / self.fillet.stretch, self.fillet.radius)
        return self.fillet.y - math.sqrt((self.fillet.radius - across) * (self.fillet.radius + across))


def outline_pieces(rack: Rack) -> list[OutlinePiece]:
    """Return the outline over all c that the rectangle has, from left to right, each land in one piece."""
    shift = rack.drift * rack.face_width
    low, high = min(0.0, -shift), max(rack.length, rack.length - shift)
    first, last = (math.floor(c / rack.transverse_pitch) for c in (low, high))
    pieces: list[OutlinePiece] = []
    for j in range(first - 1, last + 2):
        tooth = _tooth(rack, (j + 0.5) * rack.transverse_pitch)
        if pieces and rack.profile.root_land:
            pieces.append(OutlinePiece(pieces[-1].end, tooth[0].start))
        pieces += tooth
    return pieces


def _tooth(rack: Rack, middle: float) -> list[OutlinePiece]:
    """Return one tooth without root lands."""
    left, right = list[OutlinePiece](), list[OutlinePiece]()
    for curve in rack.profile.curves:
        (x, y), (to_x, to_y) = curve.points(np.array([0.0, 1.0])).tolist()
        fillet = curve if isinstance(curve, FilletArc) else None
        if curve.kind is RackCurveKind.TIP:
            left.append(OutlinePiece((middle + x, y), (middle - x, y)))
        elif curve.kind is not RackCurveKind.ROOT:
            left.append(OutlinePiece((middle + x, y), (middle + to_x, to_y), fillet, middle))
            right.insert(0, OutlinePiece((middle - to_x, to_y), (middle - x, y), fillet, middle, mirrored=True))
    return left + right


@dataclass(frozen=True)
class Edge:
    """A stretch of the rim within one strip, between two vertices of the plan in the order of c."""

    start: int
    end: int
    side: RackSide


@dataclass(frozen=True)
class Strip:
    """Edges of the part of a strip between two neighbouring lines that is inside the rectangle, on both ways along the rim.

    `piece` counts the stretches between lines; the first and the last strip begin or end in a corner.
    """

    piece: int
    ways: tuple[tuple[Edge, ...], tuple[Edge, ...]]

    @property
    def starts(self) -> tuple[int, int]:
        """Vertices where the line of least c begins and ends; one twice in the first strip."""
        return self.ways[0][0].start, self.ways[1][0].start

    @property
    def ends(self) -> tuple[int, int]:
        """Vertices where the line of greatest c begins and ends; one twice in the last strip."""
        return self.ways[0][-1].end, self.ways[1][-1].end


class RackPlan:
    """The rectangle cut along the lines of constant c (mm, rising) in `lines`.

    `places` (n, 2) are x and z (mm) of the vertices, all on the rim, `along` (n,) their c, `line` (n,) which line goes through
    each (-1: a corner without one), `strips` what is between the lines.
    """

    def __init__(self, lines: Floats, drift: float, length: float, width: float) -> None:
        bottom, top, start, end = RackSide.BOTTOM, RackSide.TOP, RackSide.START, RackSide.END
        # Two ways from the corner of least c to that of greatest: two sides and the corner between them, each.
        if drift >= 0:
            first, last = (0.0, width), (length, 0.0)
            ways = (((length, width), top, end), ((0.0, 0.0), start, bottom))
        else:
            first, last = (0.0, 0.0), (length, width)
            ways = (((0.0, width), start, top), ((length, 0.0), bottom, end))
        self._drift = drift
        low, high = self._c(first), self._c(last)
        inner = np.flatnonzero((lines > low + SNAP) & (lines < high - SNAP))
        self._places: list[_Place] = [first, last]
        self._line = [-1, -1]
        rims = [self._way(lines, inner, (first, corner, last), sides) for corner, *sides in ways]
        self.places: Floats = np.array(self._places)
        self.along: Floats = self.places[:, 0] - drift * self.places[:, 1]
        self.line = np.array(self._line)
        base = int(inner[0]) - 1 if len(inner) else int(np.searchsorted(lines, (low + high) / 2)) - 1
        self.strips = tuple(Strip(base + i, (one, other)) for i, (one, other) in enumerate(zip(*rims, strict=True)))
        self.corners = self._corners(length, width)

    def _c(self, place: _Place) -> float:
        return place[0] - self._drift * place[1]

    def _way(self, lines: Floats, inner: Wholes, corners: _Corners, sides: Sequence[RackSide]) -> list[tuple[Edge, ...]]:
        """Return the edges of each strip along one way round the rim; adds their vertices."""
        at, side, edges, found = 0, sides[0], list[Edge](), list[tuple[Edge, ...]]()
        for place, line in self._stops(lines, inner, corners):
            self._places.append(place)
            self._line.append(line)
            at, before = len(self._places) - 1, at
            edges.append(Edge(before, at, side))
            if place == corners[1]:
                side = sides[1]
            if line >= 0:
                found.append(tuple(edges))
                edges = []
        return [*found, (*edges, Edge(at, 1, side))]

    def _stops(self, lines: Floats, inner: Wholes, corners: _Corners) -> list[tuple[_Place, int]]:
        """Return the places where lines meet one way round the rim, and its middle corner, in the order of c.

        Each place comes with the number of its line (-1: none).
        """
        first, middle, last = corners
        turn, found = self._c(middle), list[tuple[_Place, int]]()
        for line in inner.tolist():
            c = float(lines[line])
            before, after = (first, middle) if c <= turn else (middle, last)
            start, end = self._c(before), self._c(after)
            share = (c - start) / (end - start)
            place = before[0] + share * (after[0] - before[0]), before[1] + share * (after[1] - before[1])
            found.append((middle if math.dist(place, middle) < SNAP else place, line))
        if all(place != middle for place, _ in found):
            found.insert(int(np.count_nonzero(lines[inner] <= turn)), (middle, -1))
        return found

    def _corners(self, length: float, width: float) -> dict[tuple[RackSide, RackSide], int]:
        """Return the vertex in each corner of the rectangle, by the sides that meet there: start or end, bottom or top."""
        found = {}
        for one, x in ((RackSide.START, 0.0), (RackSide.END, length)):
            for other, z in ((RackSide.BOTTOM, 0.0), (RackSide.TOP, width)):
                found[one, other] = int(np.flatnonzero((self.places == (x, z)).all(axis=1))[0])
        return found

    def rim(self, side: RackSide) -> list[Edge]:
        """Return the edges on one side, one behind the other: along +x, or along +z, each run as it is here."""
        edges = [edge for strip in self.strips for way in strip.ways for edge in way if edge.side is side]
        axis = 0 if side in (RackSide.BOTTOM, RackSide.TOP) else 1
        rising = [
            edge if self.places[edge.start, axis] < self.places[edge.end, axis] else Edge(edge.end, edge.start, side)
            for edge in edges
        ]
        return sorted(rising, key=lambda edge: self.places[edge.start, axis])

    def chain(self, side: RackSide) -> list[int]:
        """Return the vertices on one side, along +x or +z."""
        edges = self.rim(side)
        assert all(one.end == other.start for one, other in pairwise(edges))
        return [edges[0].start, *(edge.end for edge in edges)]
