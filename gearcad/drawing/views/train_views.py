"""Views of a planetary train: the section through its axis, and its gear set along the axis (ISO 2203). Lengths in mm.

The section runs from the axis up through the first planet, and down through the planet that is nearest opposite (ISO 128-3,
aligned section). Gears of stages are turned into it about the axis beside them. Heights decide which of two circles on one
axis is hidden; gears in mesh do not hide each other (ISO 2203). z and heights are in mm of the part.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import chain

from gearcad.core.errors import GeometryError
from gearcad.core.records import Role
from gearcad.drawing.dimensions import Side, arrow, linear_dimension
from gearcad.drawing.drawing_symbols import centre_circle, centre_line, centre_star, view_label
from gearcad.drawing.layout import Candidates, View
from gearcad.drawing.shapes import Anchor, Box, Figure, Line, Pen, Point, Shape, Text
from gearcad.drawing.views.assembly_figures import (
    BEYOND_AXIS,
    Across,
    Cut,
    FrontView,
    Sectioned,
    balloons,
    cut_gear,
    distance_size,
    dots,
    overall_height,
    overall_width,
    pitch_lines,
    section_figure,
)
from gearcad.drawing.views.ring_views import Meridian
from gearcad.drawing.words import Draughting, Size
from gearcad.geometry import GearPair
from gearcad.planetary import PairStage, PlanetaryTrain
from gearcad.solids.train_plan import CarrierPlan, Standing, TrainLayout, carrier_plan, require_room, stage_keys

_OPPOSITE = 90.0
"""Angle (degrees) from opposite the first planet at which another one is no longer turned into the plane below the axis."""

_STRAIGHT = 1.0
"""Angle (degrees) up to which a planet counts as in the plane, because the difference is not visible."""

_TOUCHING = 1e-9


@dataclass(frozen=True)
class InPlane:
    """A body of the train with the height of its axis over that of the train (mm)."""

    standing: Standing
    height: float


@dataclass(frozen=True)
class PosedTrain:
    """The bodies of a train in mesh, its carrier at the angle 0."""

    train: PlanetaryTrain

    @cached_property
    def layout(self) -> TrainLayout:
        """Layout of the train, with every body in its place."""
        return TrainLayout(self.train, self.train.pose())

    @property
    def distance(self) -> float:
        """Distance of the planets' axes from that of the train (mm)."""
        return float(self.train.centre_distance)

    @cached_property
    def turns(self) -> tuple[float, ...]:
        """Angles of the planets on paper (degrees) from the first one, which is up, counter-clockwise as seen from +z."""
        first, *_ = planets = self.layout.pose.planets
        return tuple((planet.angle - first.angle) % 360 for planet in planets)

    @cached_property
    def below(self) -> int | None:
        """Number of the planet that is shown below the axis; None if none is near to opposite."""
        off = [abs(turn - 180) for turn in self.turns]
        nearest = min(range(len(off)), key=off.__getitem__)
        return nearest if nearest and off[nearest] < _OPPOSITE else None

    @property
    def bent(self) -> bool:
        """Whether the plane of the section changes its direction at the axis."""
        return self.below is not None and abs(self.turns[self.below] - 180) > _STRAIGHT

    @cached_property
    def centrals(self) -> tuple[InPlane, ...]:
        return tuple(InPlane(each, 0.0) for each in self.layout.centrals)

    @cached_property
    def planets(self) -> tuple[InPlane, ...]:
        """Rims of the planets that are shown."""
        shown = [(0, self.distance)] + ([] if self.below is None else [(self.below, -self.distance)])
        return tuple(InPlane(rim, height) for number, height in shown for rim in self.layout.planets[number])

    @cached_property
    def carrier(self) -> CarrierPlan | None:
        """Plan of a plain carrier; None where planets have no bores, or stages leave no room for one."""
        try:
            return carrier_plan(self.layout)
        except GeometryError:
            return None

    @cached_property
    def room(self) -> str:
        """Reason why the bodies cannot stand beside each other; "" if they can, or if a ring without a rim diameter leaves it
        open.
        """
        if any(body.gear.internal and body.gear.body.rim_diameter is None for body in self.layout.bodies.values()):
            return ""
        try:
            require_room(self.layout)
        except GeometryError as error:
            return str(error)
        return ""

    @property
    def reach(self) -> float:
        """Outer radius of the gear set about the axis of the train (mm)."""
        planets = (self.distance + rim.gear.tip_diameter / 2 for rim in self.train.rims)
        rings = (Meridian(central.gear, 1.0).rim for central in self.train.centrals if central.gear.internal)
        return max((*planets, *rings))

    @property
    def largest(self) -> float:
        """Largest size of the train (mm): across, or along its axis."""
        ends = [end for each in self.layout.standing for end in each.extent]
        return max(2 * self.reach, max(ends) - min(ends))

    # ------------------------------------------------------------------ stages

    @cached_property
    def stages(self) -> tuple[InPlane, ...]:
        """Gears of the stages that have room in the plane, above or below the axis beside them."""
        return tuple(chain.from_iterable(self._stages.values()))

    @property
    def left_out(self) -> tuple[str, ...]:
        """Names of the stages that have no room in the plane."""
        return tuple(stage.name for stage in self.train.stages if stage.name not in self._stages)

    def stage(self, name: str) -> tuple[InPlane, InPlane]:
        """Return pinion and wheel of a stage that is shown."""
        return self._stages[name]

    @cached_property
    def _stages(self) -> dict[str, tuple[InPlane, InPlane]]:
        heights = dict.fromkeys(self.train.members, 0.0)
        gears = list(zip(*2 * [iter(self.layout.stages)], strict=True))
        waiting = dict(zip(self.train.stages, gears, strict=True))
        found: dict[str, tuple[InPlane, InPlane]] = {}
        while ready := [stage for stage in waiting if {stage.pinion, stage.wheel} & heights.keys()]:
            for stage in ready:
                pair = self._placed(stage, waiting.pop(stage), heights, tuple(chain.from_iterable(found.values())))
                if pair is not None:
                    found[stage.name] = pair
                    heights |= {stage.pinion: pair[0].height, stage.wheel: pair[1].height}
        return found

    def _placed(
        self, stage: PairStage, gears: tuple[Standing, Standing], heights: dict[str, float], others: tuple[InPlane, ...]
    ) -> tuple[InPlane, InPlane] | None:
        """Return pinion and wheel on their own side, else on the other side; None if neither has room."""
        side = 1.0 if math.cos(math.radians(stage.angle - self.layout.pose.planets[0].angle)) >= 0 else -1.0
        distance = abs(stage.pair.centre_distance)
        for way in (side, -side):
            if stage.pinion in heights:
                at = heights[stage.pinion], heights[stage.pinion] + way * distance
            else:
                at = heights[stage.wheel] + way * distance, heights[stage.wheel]
            pair = InPlane(gears[0], at[0]), InPlane(gears[1], at[1])
            stand = (*self.centrals, *self.planets, *others)
            if not any(_collide(one, other) for one in pair for other in stand):
                return pair
        return None


def _collide(one: InPlane, other: InPlane) -> bool:
    """Return whether two bodies that do not mesh would be drawn over each other."""
    (low, high), (bottom, top) = one.standing.extent, other.standing.extent
    if low >= top - _TOUCHING or bottom >= high - _TOUCHING:
        return False
    return any(
        start < end - _TOUCHING for a, b in _reach(one) for c, d in _reach(other) for start, end in [(max(a, c), min(b, d))]
    )


def _reach(body: InPlane) -> Iterator[tuple[float, float]]:
    """Yield the ranges of height over which a body is cut (mm); a ring has two, one for each side."""
    gear = body.standing.body.gear
    if not gear.internal:
        yield body.height - gear.tip_diameter / 2, body.height + gear.tip_diameter / 2
        return
    inner, outer = abs(gear.tip_diameter) / 2, (gear.body.rim_diameter or abs(gear.root_diameter)) / 2
    yield body.height + inner, body.height + outer
    yield body.height - outer, body.height - inner


_DIGITS = 9


def pitch_radii(train: PlanetaryTrain, key: str) -> tuple[float, ...]:
    """Return the radii (mm) of a gear's working pitch circles. A planet has one with each of its mates; equal ones stand
    once.
    """
    radii = [abs(pair.working_pitch_diameters.pick(role)) / 2 for pair, role in meshes_of(train, key)]
    return tuple(dict.fromkeys(round(radius, _DIGITS) for radius in radii))


def meshes_of(train: PlanetaryTrain, key: str) -> Iterator[tuple[GearPair, Role]]:
    """Yield the pairs that a gear is part of, each with its role in the pair."""
    for mesh in train.meshes:
        if key == mesh.central.name:
            yield mesh.pair, mesh.central_role
        elif key == mesh.rim.name:
            yield mesh.pair, mesh.rim_role
    for stage, keys in zip(train.stages, stage_keys(train), strict=True):
        yield from ((stage.pair, role) for role, name in keys.items() if name == key)


_ONE_WAY, _OTHER_WAY = 45.0, 135.0
_CARRIER_SPACING = 4.0
"""Hatching: angles (degrees) and spacing differ between neighbours."""

_Interval = tuple[float, float]
_Rectangle = tuple[tuple[float, float], ...]


def bodies_of(plan: PosedTrain) -> list[tuple[str, Sectioned]]:
    """Return the bodies, each with the key of its item, from the front teeth on: suns, planets, rings, stages, carrier."""
    suns = [each for each in plan.centrals if not each.standing.body.gear.internal]
    rings = [each for each in plan.centrals if each.standing.body.gear.internal]
    rows: tuple[tuple[Sequence[InPlane], float], ...] = (
        (suns, _ONE_WAY),
        (plan.planets, _OTHER_WAY),
        (rings, _ONE_WAY),
        (plan.stages[::2], _ONE_WAY),
        (plan.stages[1::2], _OTHER_WAY),
    )
    found = [(each.standing.body.key, _gear(plan.train, each, angle)) for row, angle in rows for each in row]
    return found + [(plan.train.carrier.name, each) for each in _carrier(plan)]


def _gear(train: PlanetaryTrain, body: InPlane, angle: float) -> Sectioned:
    gear, z = body.standing.body.gear, body.standing.z
    radii = pitch_radii(train, body.standing.body.key)
    pitch = (line for radius in radii for line in pitch_lines(z, z + gear.face_width, body.height, radius))
    return Sectioned(cut_gear(gear, z, body.height), angle, tuple(pitch))


def _carrier(plan: PosedTrain) -> Iterator[Sectioned]:
    """Yield the pins of the carrier, which are not hatched, and its plates."""
    carrier = plan.carrier
    if carrier is None:
        return
    heights = sorted({planet.height for planet in plan.planets}, reverse=True)
    pins = [_about(height, carrier.diameter / 2) for height in heights]
    yield Sectioned(Cut(tuple(_rectangle(carrier.reach, pin) for pin in pins)), None)
    areas = [area for plate in carrier.plates for area in _plate(carrier, plate, pins)]
    edges = [((z, -carrier.inner), (z, carrier.inner)) for plate in carrier.plates for z in plate if carrier.inner]
    yield Sectioned(Cut(tuple(areas), edges=tuple(edges)), _ONE_WAY, spacing=_CARRIER_SPACING)


def _plate(carrier: CarrierPlan, plate: _Interval, pins: Sequence[_Interval]) -> Iterator[_Rectangle]:
    """Return the cut areas of a plate between its pins."""
    inner, outer = carrier.inner, carrier.outer
    solid = [(inner, outer), (-outer, -inner)] if inner else [(-outer, outer)]
    for low, high in pins:
        parts = [part for start, end in solid for part in ((start, min(end, low)), (max(start, high), end))]
        solid = [(start, end) for start, end in parts if start < end]
    return (_rectangle(plate, part) for part in solid)


def _about(middle: float, half: float) -> _Interval:
    return middle - half, middle + half


def _rectangle(across: _Interval, up: _Interval) -> _Rectangle:
    (left, right), (low, high) = across, up
    return (left, low), (right, low), (right, high), (left, high)


LETTER = "A"

_STROKE, _CORNER, _STEM = 8.0, 4.0, 9.0


def cutting_line(turn: float, distance: float, reach: float, looking: int) -> Figure:
    """Return the cutting line: thick ends at `reach` (mm of paper) from the axis, and a thick corner at the axis.

    One end is above the axis, the other in the direction `turn` (radians). The axis of a planet is at a `distance` in that
    direction; the line is its centre line too. `looking` is the viewing direction on the upper half, -1 to the left, 1 to the
    right; the other half is turned into its plane.
    """
    shapes: list[Shape] = []
    for angle, side in ((math.pi / 2, 1.0), (turn, -1.0)):
        way = math.cos(angle), math.sin(angle)
        across = looking * side * way[1], -looking * side * way[0]
        shapes += _end(way, across, reach)
        shapes.append(Line((0.0, 0.0), _along(way, _CORNER), Pen.OUTLINE))
        if side < 0:
            shapes += centre_line(_along(way, _CORNER), _along(way, distance), _along(way, reach)).shapes
    return Figure(tuple(shapes))


def _end(way: Point, across: Point, reach: float) -> list[Shape]:
    """Return a thick end, the arrow at it, and the letter beside the arrow."""
    tip = _along(way, reach + _STROKE / 2)
    foot = tip[0] - _STEM * across[0], tip[1] - _STEM * across[1]
    place = foot[0] + 5.0 * way[0], foot[1] + 5.0 * way[1]
    return [
        Line(_along(way, reach), _along(way, reach + _STROKE), Pen.OUTLINE),
        Line(foot, tip, Pen.SYMBOL),
        arrow(tip, across, Pen.SYMBOL),
        Text(LETTER, place, 5.0, Anchor.MIDDLE, pen=Pen.TEXT),
    ]


def _along(way: Point, by: float) -> Point:
    return by * way[0], by * way[1]


_ABOVE, _BESIDE = (8.0, 14.0, 22.0, 30.0, 40.0), (0.0, 12.0, -12.0)
"""Positions of the name of the section, above the outlines and aside (mm of paper)."""


def train_section(plan: PosedTrain, items: Mapping[str, int], draughting: Draughting, direction: int = 1) -> View:
    """Return the section, with the axis of the train at height 0. z is to the right, or to the left if `direction` is -1;
    `items` are item numbers by keys.
    """
    bodies = bodies_of(plan)
    extent = Box.around(point for _, body in bodies for polygon in body.cut.covers for point in polygon)
    across = Across(draughting.scale, (extent.left + extent.right) / 2, direction)
    figure = section_figure([body for _, body in bodies], across) + Figure(tuple(_axes(plan, across)))
    box = Box.around(across.points((extent[:2], extent[2:])))
    spots: dict[int, tuple[Point, ...]] = {}
    for key, body in bodies:
        spots[items[key]] = spots.get(items[key], ()) + dots(body.cut.areas, across)
    marks: list[Candidates] = [*_stage_distances(plan, box, across, draughting)]
    marks += [partial(overall_width, box, extent.width, draughting), partial(balloons, spots, box)]
    if plan.bent:
        marks.append(partial(_name, box))
    return View("section", figure, tuple(marks))


def _axes(plan: PosedTrain, across: Across) -> Iterator[Line]:
    """Yield the axes of the train, its planets and its stages."""
    bodies = (*plan.centrals, *plan.planets, *plan.stages)
    for height in dict.fromkeys(body.height for body in bodies):
        ends = [end for body in bodies if body.height == height for end in body.standing.extent]
        if plan.carrier is not None and any(body.height == height for body in plan.planets):
            ends += plan.carrier.reach
        (left, y), (right, _) = sorted(across.points(((min(ends), height), (max(ends), height))))
        yield Line((left - BEYOND_AXIS, y), (right + BEYOND_AXIS, y), Pen.CENTRE)


def _stage_distances(plan: PosedTrain, box: Box, across: Across, draughting: Draughting) -> Iterator[Candidates]:
    """Yield the centre distance of each stage that is shown."""
    for stage in plan.train.stages:
        if stage.name in plan.left_out:
            continue
        pinion, wheel = plan.stage(stage.name)
        yield partial(_stage_distance, (pinion, wheel), stage.pair, box, across, draughting)


def _stage_distance(
    gears: Sequence[InPlane], pair: GearPair, box: Box, across: Across, draughting: Draughting
) -> Iterator[Figure]:
    """Yield dimensions of a stage's centre distance, outside the outlines, at the right, then at the left."""
    size = distance_size(pair)
    ends = [sorted(across.points((z, each.height) for z in each.standing.extent)) for each in gears]
    for side, edge, end, way in ((Side.RIGHT, box.right, 1, 1.0), (Side.LEFT, box.left, 0, -1.0)):
        first, second = ((each[end][0] + way * BEYOND_AXIS, each[end][1]) for each in ends)
        yield from linear_dimension(first, second, side, size, draughting, clear=edge)


def _name(box: Box) -> Iterator[Figure]:
    """Yield the name of a section that is not in one plane, above it."""
    for up in _ABOVE:
        for across in _BESIDE:
            yield view_label(f"{LETTER}–{LETTER}", (box.middle[0] + across, box.top + up))


_ON_AXIS = 1e-6
"""Distance (mm) up to which a point is on an axis of the train."""


def train_face(plan: PosedTrain, draughting: Draughting, looking: int = -1) -> View:
    """Return the view from +z: the axis of the train at the origin, the first planet above it, with centre distance and
    overall sizes.

    `looking` is the viewing direction of a bent section: -1 to the left, 1 to the right.
    """
    fronts, scale = list(_fronts(plan)), draughting.scale
    whole = Box.of_all(Box(*front.centre, *front.centre).grown(front.reach) for front in fronts)
    box = Box(*(scale * side for side in whole))
    figure = Figure.of(*(front.figure(scale) for front in fronts)) + _centre_lines(plan, fronts, box, scale)
    if plan.below is not None and plan.bent:
        reach = scale * max(math.hypot(*front.centre) + front.reach for front in fronts) + BEYOND_AXIS
        figure += cutting_line(math.radians(90 + plan.turns[plan.below]), scale * plan.distance, reach, looking)
    round_about = any(front.gear.internal and 2 * front.reach >= whole.height for front in fronts)
    marks: list[Candidates] = [
        partial(_distance, plan, box, draughting),
        partial(overall_height, box, whole.height, draughting, "⌀" if round_about else ""),
    ]
    if not round_about:
        marks.append(partial(overall_width, box, whole.width, draughting))
    return View("face", figure, tuple(marks))


def _distance(plan: PosedTrain, box: Box, draughting: Draughting) -> Iterator[Figure]:
    """Yield dimensions from the axis of the train to that of the first planet."""
    scale, size = draughting.scale, Size(value=plan.distance)
    half = scale * max(rim.body.gear.tip_diameter for rim in plan.layout.planets[0]) / 2
    for side, edge in ((Side.RIGHT, box.right), (Side.LEFT, box.left)):
        first = side.outwards * half, scale * plan.distance
        yield from linear_dimension(first, (edge + side.outwards * BEYOND_AXIS, 0.0), side, size, draughting, clear=edge)


def planet_centres(plan: PosedTrain) -> list[Point]:
    """Return the axes of the planets (mm of the part), the axis of the train at the origin."""
    turns = [math.radians(90 + turn) for turn in plan.turns]
    return [(plan.distance * math.cos(turn), plan.distance * math.sin(turn)) for turn in turns]


def _fronts(plan: PosedTrain) -> Iterator[FrontView]:
    train = plan.train
    centrals, rims = plan.layout.centrals, plan.layout.planets[0]
    for central in centrals:
        yield FrontView(central.body.gear, (0.0, 0.0), pitch_radii(train, central.body.key), _tip(central, centrals))
    for centre in planet_centres(plan):
        for rim in rims:
            yield FrontView(rim.body.gear, centre, pitch_radii(train, rim.body.key), _tip(rim, rims))
    first = math.radians(90 - plan.layout.pose.planets[0].angle)
    for gear in plan.layout.stages:
        x, y = gear.axle.x, gear.axle.y
        at = x * math.cos(first) - y * math.sin(first), x * math.sin(first) + y * math.cos(first)
        yield FrontView(gear.body.gear, at, pitch_radii(train, gear.body.key), Pen.THIN, bare=True)


def _tip(one: Standing, others: Sequence[Standing]) -> Pen:
    """Return the pen of a tip circle: dashed behind a nearer and larger body on the same axis; for rings, one that is smaller
    inside.
    """
    own = one.body.gear
    for other in others:
        gear = other.body.gear
        if other is not one and other.z > one.z and gear.internal is own.internal and gear.tip_diameter > own.tip_diameter:
            return Pen.HIDDEN
    return Pen.OUTLINE


def _centre_lines(plan: PosedTrain, fronts: Sequence[FrontView], box: Box, scale: float) -> Figure:
    """Return the centre lines of all axes, except that of the planet through which a bent section goes. The circle of the
    planets' axes is included.
    """
    centres = [(scale * x, scale * y) for x, y in planet_centres(plan)]
    half = scale * max(rim.body.gear.tip_diameter for rim in plan.layout.planets[0]) / 2
    (x, y), *others = centres
    crossed = [each for number, each in enumerate(centres) if not plan.bent or number != plan.below]
    stages = [front for front in fronts if front.bare and math.hypot(*front.centre) > _ON_AXIS]
    crossed += [_paper(front, scale) for front in stages if min(map(abs, front.centre)) <= _ON_AXIS]
    figure = centre_star(box.grown(BEYOND_AXIS), crossed, half) + centre_line((x - half, y), (x, y), (x + half, y))
    if others:
        figure += centre_circle(scale * plan.distance, centres)
    for front in stages:
        figure += _stage_lines(_paper(front, scale), scale * front.reach + BEYOND_AXIS)
    return figure


def _paper(front: FrontView, scale: float) -> Point:
    """Return the centre of a gear on paper."""
    return scale * front.centre[0], scale * front.centre[1]


def _stage_lines(centre: Point, reach: float) -> Figure:
    """Return a centre cross, without lines that would lie on a centre line of the train."""
    (x, y), figure = centre, Figure()
    if abs(y) > _ON_AXIS:
        figure += centre_line((x - reach, y), centre, (x + reach, y))
    if abs(x) > _ON_AXIS:
        figure += centre_line((x, y - reach), centre, (x, y + reach))
    return figure
