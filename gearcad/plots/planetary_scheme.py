"""Scheme of a planetary train: its half section in the symbols of engineers, every part named beside it.

In inches of paper; x runs along the axis, y away from it. Radii are to scale where that leaves room to see every part;
widths are not.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.core.records import Role
from gearcad.geometry import GearPair
from gearcad.planetary import Central, PairStage, PlanetaryTrain, Rim
from gearcad.planetary.power import PowerFlow
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, new_figure, plain
from gearcad.plots.planetary import (
    LINE,
    colour_of,
    lines_of,
    placed_stages,
    power_ways,
    rim_words,
    role_of,
    role_words,
    signed,
    spread,
    stage_gear,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_SET_HEIGHT, _HEIGHT = 2.4, 3.4
"""Heights of the set, and of the set with the stages, where radii are to scale."""

CLEAR = 0.3
"""Least distance of a pitch point from the axis and from a pin."""

_APART = 0.1
"""Least distance between radii that differ."""

_WIDEST, _NARROWEST = 0.6, 0.24
"""Largest and least drawn width of teeth."""

_BETWEEN = (0.3, 0.6)
"""Least and greatest distance of the rims of a stepped planet."""


class Places:
    """Places of the parts of a train in the drawing."""

    def __init__(self, train: PlanetaryTrain) -> None:
        self.train = train
        self.radii = {(rim.name, sign): self._radius(rim, sign) for rim in train.rims for sign in (1, -1)}
        """Radii of the working circles of rims (mm), on the outer side of the train (1) and on the inner one (-1)."""

    def _radius(self, rim: Rim, sign: int) -> float:
        """Return the working radius (mm) of a rim in the mesh on that side, or in its only mesh; two meshes may differ."""
        meshes = [mesh for mesh in self.train.meshes if mesh.rim is rim]
        mesh = next((mesh for mesh in meshes if mesh.central.gear.internal == (sign > 0)), meshes[0])
        return abs(mesh.pair.working_pitch_diameters.pick(mesh.rim_role)) / 2

    @cached_property
    def scale(self) -> float:
        """Inches per mm of radius."""
        reach = self._distance + max(self.radii.values())
        stages = [abs(stage.pair.centre_distance) + _smaller_radius(stage.pair) for stage in self.train.stages]
        return min(_SET_HEIGHT / reach, _HEIGHT / max([reach, *stages]))

    @cached_property
    def _heights(self) -> dict[float, float]:
        """Drawn heights of axis, pin and pitch points by their distance from the axis (mm)."""
        knots = sorted({0.0, self._distance, *(self._distance_of(*each) for each in self.radii)})
        heights = [0.0]
        for low, high in pairwise(knots):
            least = CLEAR if {low, high} & {0.0, self._distance} else _APART
            heights.append(heights[-1] + max(self.scale * (high - low), least))
        axis = heights[knots.index(0.0)]
        return {knot: height - axis for knot, height in zip(knots, heights, strict=True)}

    @property
    def pin(self) -> float:
        """Height of the pin."""
        return self._heights[self._distance]

    def pitch(self, rim: str, sign: int) -> float:
        """Return the height of the working circle of a rim on its outer (1) or inner side."""
        return self._heights[self._distance_of(rim, sign)]

    def _distance_of(self, rim: str, sign: int) -> float:
        return round(self._distance + sign * self.radii[rim, sign], 9)

    @property
    def _distance(self) -> float:
        return float(self.train.centre_distance)

    # ------------------------------------------------------------------ along the axis

    @cached_property
    def rims(self) -> dict[str, tuple[float, float]]:
        """Start and end of each rim along the axis, by name, from left to right."""
        rims = sorted(self.train.rims, key=lambda rim: rim.axial_position + rim.gear.face_width / 2)
        first, start, found = rims[0], 0.0, {}
        for rim in rims:
            if rim is not first:
                gap = rim.axial_position - first.axial_position - first.gear.face_width
                start += min(max(_WIDEST * gap / self._widest, _BETWEEN[0]), _BETWEEN[1])
            found[rim.name] = (start, start := start + self._width(rim.gear.face_width))
        return found

    @cached_property
    def centrals(self) -> dict[str, tuple[float, float]]:
        """Start and end of each central along the axis, by name.

        A central is middle by middle with its rim, or takes half of it where both would be in one place.
        """
        bars = {}
        for central, half in zip(self.train.centrals, (0.25, 0.75), strict=True):
            left, right = self.rims[central.meshes]
            middle = left + (half if self._halved else 0.5) * (right - left)
            width = 0.4 * (right - left) if self._halved else self._width(central.gear.face_width)
            bars[central.name] = (middle - width / 2, middle + width / 2)
        return bars

    @property
    def _halved(self) -> bool:
        first, second = self.train.centrals
        return not self.train.stepped and first.gear.internal == second.gear.internal

    @cached_property
    def _widest(self) -> float:
        return max(gear.face_width for part in (self.train.centrals, self.train.rims) for gear in (each.gear for each in part))

    def _width(self, width: float) -> float:
        return min(max(_WIDEST * width / self._widest, _NARROWEST), _WIDEST)

    # ------------------------------------------------------------------ who comes out where

    def held_ring(self, name: str) -> bool:
        """Return whether a member is a ring that does not turn: it stands on the ground and needs no shaft."""
        return name == self.train.fixed and any(each.name == name and each.gear.internal for each in self.train.centrals)

    @cached_property
    def sides(self) -> dict[str, int]:
        """Side on which each member comes out (-1: left, 1: right).

        Inputs are on the left if possible; centrals in two planes are each on their own side.
        """
        roles, wanted, found = self._roles(), {"input": -1, "output": 1}, {}
        first, second = (sum(bar) for bar in self.centrals.values())
        for central, own in zip(self.train.centrals, (first - second, second - first), strict=True):
            free = wanted.get(roles[central.name], 1 if central.gear.internal else -1)
            found[central.name] = free if abs(own) < 1e-9 else -1 if own < 0 else 1
        taken = {side for name, side in found.items() if not self.held_ring(name)}
        side = wanted.get(roles[self.train.carrier.name], -1)
        return found | {self.train.carrier.name: -side if side in taken and -side not in taken else side}

    def _roles(self) -> dict[str, str]:
        """Return the role of each member in the train, its own or that of the stages on it."""
        roles = {name: role_of(self.train, name) for name in self.train.members}
        for _, inner, outer in reversed(placed_stages(self.train)):
            roles[inner] = roles.get(inner) or role_of(self.train, inner) or roles.get(outer) or role_of(self.train, outer)
        return roles


def _smaller_radius(pair: GearPair) -> float:
    return min(abs(gear.reference_diameter) for gear in pair.gears) / 2


Point = tuple[float, float]

_LEVEL = 0.15
"""Radial distance between shafts that turn in each other."""

_GAP = 0.03
"""Distance between teeth and the pitch circle that they roll on, so that both gears are seen."""

_PLATE, _SHAFT, _STAGE, _STUB, _ARROW = 0.2, 0.3, 0.42, 0.35, 0.3
"""Along the axis: between plates, of shafts beyond them, before a stage, of its shaft, of arrows."""


class Weight(Enum):
    """Width of a stroke."""

    TEETH = 2.6
    BODY = 1.4
    AXIS = 0.6


class SchemeLine(NamedTuple):
    """A line of a part; that of the axis belongs to none."""

    part: str
    points: tuple[Point, ...]
    weight: Weight


class Ground(NamedTuple):
    """A part that does not turn: a hatched line at a point, hatched on the side `away` ((0, 1): above)."""

    at: Point
    away: tuple[int, int]


class Arrow(NamedTuple):
    """An arrow where power enters or leaves."""

    part: str
    start: Point
    end: Point


class Callout(NamedTuple):
    """A part that is named beside the drawing, on its `side` (-1: left), with a line from `anchor`, dotted unless at an end."""

    part: str
    anchor: Point
    side: int
    dotted: bool = True


@dataclass(frozen=True)
class Plan:
    """The complete content of the drawing; `ways` gives "in" or "out" for members and shafts, the direction of power there."""

    strokes: tuple[SchemeLine, ...]
    grounds: tuple[Ground, ...]
    arrows: tuple[Arrow, ...]
    callouts: tuple[Callout, ...]
    ways: Mapping[str, str]

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Least x and y and the greatest x and y."""
        points = np.array([point for stroke in self.strokes for point in stroke.points])
        (left, low), (right, high) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
        return left, low, right, high


def plan_of(train: PlanetaryTrain, flow: PowerFlow | None = None) -> Plan:
    """Return the skeleton of a train, with arrows where power goes in and out: as it flows, or at its input and output."""
    return _Draft(train, power_ways(train, flow)).drawn()


class _Draft:
    """A plan while it is drawn."""

    def __init__(self, train: PlanetaryTrain, ways: Mapping[str, str]) -> None:
        self.train, self.places, self.ways = train, Places(train), ways
        self.strokes: list[SchemeLine] = []
        self.grounds: list[Ground] = []
        self.arrows: list[Arrow] = []
        self.callouts: list[Callout] = []
        self._rim_of = {each.name: each.meshes for each in train.centrals}
        self.axes: dict[str, tuple[float, float]] = {}
        """Ends of the shafts drawn so far, and their heights."""

    def drawn(self) -> Plan:
        for side in (-1, 1):
            self._draw_side(side)
        self._draw_planets()
        for central in self.train.centrals:
            self._draw_teeth(central)
        for rim in self.train.rims:
            self._name_rim(rim)
        ends = [point[0] for stroke in self.strokes for point in stroke.points]
        self._line("", Weight.AXIS, (min(ends) - 0.1, 0.0), (max(ends) + 0.1, 0.0))
        return Plan(tuple(self.strokes), tuple(self.grounds), tuple(self.arrows), tuple(self.callouts), self.ways)

    def _line(self, part: str, weight: Weight, *points: Point) -> None:
        self.strokes.append(SchemeLine(part, points, weight))

    def _teeth(self, part: str, left: float, right: float, height: float) -> None:
        self._line(part, Weight.TEETH, (left, height), (right, height))

    # ------------------------------------------------------------------ members on the axis

    def _draw_side(self, side: int) -> None:
        """Members that come out on a side: the outermost of their shafts ends first."""
        carrier = self.train.carrier.name
        here = [name for name, each in self.places.sides.items() if each == side and not self.places.held_ring(name)]
        rings = [each.name for each in self.train.centrals if each.gear.internal and each.name in here]
        inside_out = sorted(here, key=lambda name: (name in rings, name == carrier))
        place = side * max(side * x for bar in self.places.rims.values() for x in bar) + side * 0.12
        for level, name in enumerate(inside_out):
            height = level * _LEVEL
            if name == carrier or name in rings:
                place += side * _PLATE
                self._draw_plate(name, side, place, height)
            else:
                x = sum(self.places.centrals[name]) / 2
                self._line(name, Weight.BODY, (x, self.places.pitch(self._rim_of[name], -1) - _GAP), (x, height))
                self.axes[name] = (x, height)
        for name in reversed(inside_out):
            place = self._draw_out(name, side, place)

    def _draw_plate(self, name: str, side: int, x: float, height: float) -> None:
        """The plate of a carrier from its pins, or of a ring from its teeth, down to its shaft."""
        if name == self.train.carrier.name:
            self._line(name, Weight.BODY, (x, self.places.pin), (x, height))
        else:
            end, rim = self.places.centrals[name][(side + 1) // 2], self.places.pitch(self._rim_of[name], 1) + _GAP
            self._line(name, Weight.BODY, (end, rim), (x, rim), (x, height))
        self.axes[name] = (x, height)

    def _draw_out(self, name: str, side: int, place: float) -> float:
        """Return the shaft of a member with its stages; how far out it comes."""
        reached = {name}
        for stage, inner, outer in placed_stages(self.train):
            if inner in reached:
                reached.add(outer)
                place = self._draw_stage(stage, (inner, outer), side, place + side * _STAGE)
        if len(reached) > 1 and not role_of(self.train, name) and name not in self.ways:
            self.callouts.append(Callout(name, self.axes[name], side))
            return place
        start, height = self.axes[name]
        place += side * _SHAFT
        self._line(name, Weight.BODY, (start, height), (place, height))
        return self._end(name, side, (place, height))

    def _draw_stage(self, stage: PairStage, shafts: tuple[str, str], side: int, x: float) -> float:
        """Return a stage: the gear on the shaft towards the set, its mate, and the shaft of that; how far out it comes."""
        inner, outer = shafts
        start, axis = self.axes[inner]
        diameters = stage.pair.working_pitch_diameters
        on, mate = (diameters.pinion, diameters.wheel) if stage.pinion == inner else (diameters.wheel, diameters.pinion)
        mesh = axis + max(self.places.scale * abs(on) / 2, CLEAR if on > 0 else 0.8)
        away = max(self.places.scale * abs(mate) / 2, CLEAR - 0.05)
        centre = mesh + away if on > 0 and mate > 0 else mesh - away
        half, gap = 0.15, math.copysign(_GAP, on)
        self._line(inner, Weight.BODY, (start, axis), (x, axis))
        self._teeth(inner, x - half, x + half, mesh - gap)
        web = x if on > 0 else x - side * half  # of a ring, behind its teeth
        self._line(inner, Weight.BODY, (web, axis), (web, mesh - gap))
        self._teeth(outer, x - half, x + half, mesh + gap)
        web, end = (x if mate > 0 else x + side * half), x + side * _STUB
        self._line(outer, Weight.BODY, (web, mesh + gap), (web, centre), (end, centre))
        if mate > 0:
            far = 2 * centre - mesh - gap
            self._teeth(outer, x - half, x + half, far)
            self._line(outer, Weight.BODY, (x, centre), (x, far))
        self.axes |= {inner: (x, axis), outer: (end, centre)}
        return self._end(outer, side, (end, centre))

    def _end(self, name: str, side: int, at: Point) -> float:
        """Return the end of a shaft: an arrow in or out, or ground; how far out it comes."""
        x, y = at
        if role_of(self.train, name) == "fixed":
            self.grounds.append(Ground(at, (side, 0)))
        elif name in self.ways:
            near, far = (x + side * 0.06, y), (x + side * (0.06 + _ARROW), y)
            self.arrows.append(Arrow(name, *((far, near) if self.ways[name] == "in" else (near, far))))
            x = far[0]
        self.callouts.append(Callout(name, (x, y), side, dotted=False))
        return x

    # ------------------------------------------------------------------ teeth

    def _draw_planets(self) -> None:
        """Rims on their hub, and the pin in it, which the carrier holds."""
        train, places = self.train, self.places
        for rim, (left, right) in places.rims.items():
            for sign in (1, -1):
                height, middle = places.pitch(rim, sign) - sign * _GAP, (left + right) / 2
                self._teeth(rim, left, right, height)
                self._line(rim, Weight.BODY, (middle, height), (middle, places.pin + sign * 2 * _GAP))
        bars = list(places.rims.values())
        start, end = sum(bars[0]) / 2 - 0.1, sum(bars[-1]) / 2 + 0.1
        for sign in (1, -1):
            height = places.pin + sign * 2 * _GAP
            self._line(train.rims[0].name, Weight.BODY, (start, height), (end, height))
        plate = next(stroke.points[0][0] for stroke in self.strokes if stroke.part == train.carrier.name)
        far = bars[0][0] - 0.1 if places.sides[train.carrier.name] > 0 else bars[-1][1] + 0.1
        self._line(train.carrier.name, Weight.BODY, (plate, places.pin), (far, places.pin))

    def _draw_teeth(self, central: Central) -> None:
        """The teeth of a central; those of a ring that is held, with the ground they stand on."""
        sign, (left, right) = 1 if central.gear.internal else -1, self.places.centrals[central.name]
        height = self.places.pitch(central.meshes, sign) + sign * _GAP
        self._teeth(central.name, left, right, height)
        if self.places.held_ring(central.name):
            middle, top, side = (left + right) / 2, height + 0.2, self.places.sides[central.name]
            self._line(central.name, Weight.BODY, (middle, height), (middle, top))
            self.grounds.append(Ground((middle, top), (0, 1)))
            self.callouts.append(Callout(central.name, ((left, right)[(side + 1) // 2], height), side))

    def _name_rim(self, rim: Rim) -> None:
        """Rims of stepped planets on their own sides, others where there is less to name; by teeth that mesh with nothing."""
        left, right = self.places.rims[rim.name]
        if self.train.stepped:
            side = -1 if left == 0 else 1
        else:
            side = -1 if sum(each.side for each in self.callouts) > 0 else 1
        centrals = [mesh.central for mesh in self.train.meshes if mesh.rim is rim]
        free = -1 if all(central.gear.internal for central in centrals) else 1
        height = self.places.pitch(rim.name, free) - free * _GAP
        self.callouts.append(Callout(rim.name, ((left, right)[(side + 1) // 2], height), side))


_COLUMN, _LEADER = 1.5, 0.25
"""Widths (inches): of a column of names, and of the lines towards it."""

_MARGIN = 0.12

_SCHEME_ARROW = {"arrowstyle": "-|>", "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0}


def scheme_inches(train: PlanetaryTrain, flow: PowerFlow | None = None) -> tuple[float, float]:
    """Return the size of the scheme of a train."""
    (left, low, right, high), _ = _laid_out(plan_of(train, flow), train)
    return max(FIGURE_INCHES[0], right - left), high - low


def plot_scheme(train: PlanetaryTrain, ax: Axes | None = None, flow: PowerFlow | None = None) -> Axes:
    """Draw half section of the train in symbols: bars are teeth, hatched lines do not turn, power goes in and out along arrows.

    Without its `flow` these are at input and output.
    """
    plan = plan_of(train, flow)
    (left, low, right, high), names = _laid_out(plan, train)
    axes = new_figure(scheme_inches(train, flow)).subplots() if ax is None else ax
    for stroke in plan.strokes:
        style = (0, (12, 3, 2, 3)) if stroke.weight is Weight.AXIS else "-"
        axes.plot(
            *zip(*stroke.points, strict=True),
            color=colour_of(train, stroke.part) if stroke.part else MARKED,
            linewidth=stroke.weight.value,
            linestyle=style,
            solid_capstyle="butt",
            solid_joinstyle="miter",
            zorder=1 if stroke.weight is Weight.AXIS else 3,
        )
    for ground in plan.grounds:
        _hatch(axes, ground)
    for arrow in plan.arrows:
        colour = colour_of(train, arrow.part)
        axes.annotate(
            "",
            arrow.end,
            arrow.start,
            arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0},
        )
    for callout, lines, height, x in names:
        _name(axes, train, callout, lines, (x, height))
    axes.set_axis_off()
    axes.set_aspect("equal")
    spare = max(FIGURE_INCHES[0] - (right - left), 0.0) / 2
    axes.set_xlim(left - spare, right + spare)
    axes.set_ylim(low, high)
    return axes


_Name = tuple[Callout, list[str], float, float]
"""A name in the picture: its callout, its lines, its height (y), and the x of its column."""


def _laid_out(plan: Plan, train: PlanetaryTrain) -> tuple[tuple[float, float, float, float], list[_Name]]:
    """Return the box of the picture, and all names in it."""
    left, low, right, high = plan.box
    xs = [point[0] for arrow in plan.arrows for point in (arrow.start, arrow.end)]
    left, right = min([left, *xs]) - _LEADER, max([right, *xs]) + _LEADER
    names: list[_Name] = []
    for side, x in ((-1, left), (1, right)):
        here = [each for each in plan.callouts if each.side == side]
        texts = [_words(train, each.part, plan.ways) for each in here]
        heights = spread([each.anchor[1] for each in here], [LINE * len(lines) for lines in texts])
        names += [(each, lines, height, x) for each, lines, height in zip(here, texts, heights, strict=True)]
    low = min([low, *(height - LINE * len(lines) / 2 for _, lines, height, _ in names)])
    high = max([high + 0.1 * bool(plan.grounds), *(height + LINE * len(lines) / 2 for _, lines, height, _ in names)])
    return (left - _COLUMN, low - _MARGIN, right + _COLUMN, high + _MARGIN), names


def _words(train: PlanetaryTrain, part: str, ways: Mapping[str, str]) -> list[str]:
    """Return a part's name, its teeth, what it is to the train, and which way power goes there."""
    role = role_words(train, part, ways)
    for rim in train.rims:
        if rim.name == part:
            return lines_of(rim_words(train, rim), signed(rim.gear))
    texts = [part]
    texts += [signed(central.gear) for central in train.centrals if central.name == part]
    floating = [each.name for each in train.centrals if each.support_stiffness == 0]
    floating += [train.carrier.name] * (train.carrier.support_stiffness == 0)
    role = ", ".join(each for each in (role, "floating" if part in floating else "") if each)
    for stage in train.stages:
        for gear_role, shaft in ((Role.PINION, stage.pinion), (Role.WHEEL, stage.wheel)):
            if shaft == part:
                name, teeth = stage_gear(stage, gear_role), signed(stage.pair.gears.pick(gear_role))
                texts.append(teeth if name == part else f"{name}: {teeth}")
    return lines_of(*texts, *([role] if role else []))


def _name(axes: Axes, train: PlanetaryTrain, callout: Callout, lines: list[str], at: tuple[float, float]) -> None:
    """A name in its column, and a thin line to its part."""
    (x, y), side = at, callout.side
    axes.plot([callout.anchor[0], x], [callout.anchor[1], y], color=MARKED, linewidth=0.6, zorder=2)
    if callout.dotted:
        axes.plot(*callout.anchor, "o", color=colour_of(train, callout.part), markersize=3, zorder=4)
    align = "right" if side < 0 else "left"
    axes.text(
        x + side * 0.05, y, plain("\n".join(lines)), ha=align, va="center", fontsize=8, color=DARK, linespacing=1.25
    )  # fmt: skip


def _hatch(axes: Axes, ground: Ground) -> None:
    """A line across, and short slanted ones behind it."""
    (x, y), (right, up) = ground.at, ground.away
    half, depth, count = 0.16, 0.08, 5
    across = (abs(up), abs(right))
    if right and y > 0:
        y += half - 0.02  # above a hollow shaft: the one in it does turn
    ends = [(x - sign * half * across[0], y - sign * half * across[1]) for sign in (1, -1)]
    axes.plot(*zip(*ends, strict=True), color=DARK, linewidth=1.4, zorder=4)
    for number in range(count):
        along = -half + (number + 0.3) * 2 * half / count
        start = (x + along * across[0], y + along * across[1])
        end = (start[0] + depth * (right or 1), start[1] + depth * (up or 1))
        axes.plot(*zip(start, end, strict=True), color=DARK, linewidth=0.8, zorder=4)
