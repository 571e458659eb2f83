"""The skeleton of a train, as data: its half section in the symbols of engineers, in inches of paper."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from gearcad.planetary import Central, PairStage, PlanetaryTrain, Rim
from gearcad.planetary.power import PowerFlow
from gearcad.plots.planetary.parts import placed_stages, power_ways, role_of
from gearcad.plots.planetary.places import CLEAR, Places

__all__ = ["Arrow", "Callout", "Ground", "Plan", "Point", "Stroke", "Weight", "plan_of"]

Point = tuple[float, float]

_LEVEL = 0.15
"""Between shafts that turn in each other."""

_GAP = 0.03
"""Between teeth and the pitch circle that they roll on, so that both gears are seen."""

_PLATE, _SHAFT, _STAGE, _STUB, _ARROW = 0.2, 0.3, 0.42, 0.35, 0.3
"""Along the axis: between plates, of shafts beyond them, before a stage, of its shaft, of arrows."""


class Weight(Enum):
    """How broad a stroke is."""

    TEETH = 2.6
    BODY = 1.4
    AXIS = 0.6


class Stroke(NamedTuple):
    """A line of a part; that of the axis belongs to none."""

    part: str
    points: tuple[Point, ...]
    weight: Weight


class Ground(NamedTuple):
    """What does not turn: a hatched line at a point, hatched on the side `away` ((0, 1): above)."""

    at: Point
    away: tuple[int, int]


class Arrow(NamedTuple):
    """Where power goes in or out."""

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
    """All that is drawn; `ways` of members and shafts are "in" and "out", as power goes there."""

    strokes: tuple[Stroke, ...]
    grounds: tuple[Ground, ...]
    arrows: tuple[Arrow, ...]
    callouts: tuple[Callout, ...]
    ways: Mapping[str, str]

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Least x and y, greatest x and y."""
        points = np.array([point for stroke in self.strokes for point in stroke.points])
        (left, low), (right, high) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
        return left, low, right, high


def plan_of(train: PlanetaryTrain, flow: PowerFlow | None = None) -> Plan:
    """The skeleton of a train, with arrows where power goes in and out: as it flows, or at its input and output."""
    return _Draft(train, power_ways(train, flow)).drawn()


class _Draft:
    """A plan while it is drawn."""

    def __init__(self, train: PlanetaryTrain, ways: Mapping[str, str]) -> None:
        self.train, self.places, self.ways = train, Places(train), ways
        self.strokes: list[Stroke] = []
        self.grounds: list[Ground] = []
        self.arrows: list[Arrow] = []
        self.callouts: list[Callout] = []
        self._rim_of = {each.name: each.meshes for each in train.centrals}
        self.axes: dict[str, tuple[float, float]] = {}
        """Of shafts: where they end so far, and how high they are."""

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
        self.strokes.append(Stroke(part, points, weight))

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
        """The shaft of a member with its stages; how far out it comes."""
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
        """A stage: the gear on the shaft towards the set, its mate, and the shaft of that; how far out it comes."""
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
        """The end of a shaft: an arrow in or out, or ground; how far out it comes."""
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
