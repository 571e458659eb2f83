"""What of a planetary train a section through its axis shows, and where: its bodies turned into one plane.

The plane goes from the axis up through the first planet, and down through the planet that is nearest opposite (ISO 128-3, an
aligned section); gears of stages are turned into it about the axis that they are next to. z and heights in mm of the part.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

from gearcad.drawing.ring_views.meridian import Meridian
from gearcad.errors import GeometryError
from gearcad.planetary import PairStage, PlanetaryTrain
from gearcad.solids.carrier_plan import CarrierPlan, carrier_plan
from gearcad.solids.train_layout import Standing, TrainLayout
from gearcad.solids.train_room import require_room

__all__ = ["InPlane", "TrainPlan"]

_OPPOSITE = 90.0
"""A planet so far (degrees) from opposite the first one is not turned into the plane below the axis."""

_STRAIGHT = 1.0
"""Degrees by which a planet may be off a plane that is not bent: nobody sees that."""

_TOUCHING = 1e-9


@dataclass(frozen=True)
class InPlane:
    """A body of the train with the height of its axis over that of the train."""

    standing: Standing
    height: float


@dataclass(frozen=True)
class TrainPlan:
    """The bodies of a train in mesh, its carrier at the angle 0."""

    train: PlanetaryTrain

    @cached_property
    def layout(self) -> TrainLayout:
        """Every body in its place."""
        return TrainLayout(self.train, self.train.pose())

    @property
    def distance(self) -> float:
        """Of the planets' axes from that of the train."""
        return float(self.train.centre_distance)

    @cached_property
    def turns(self) -> tuple[float, ...]:
        """Where each planet is on paper: degrees from the first one, which is up, counter-clockwise as seen from +z."""
        first, *_ = planets = self.layout.pose.planets
        return tuple((planet.angle - first.angle) % 360 for planet in planets)

    @cached_property
    def below(self) -> int | None:
        """The planet that is shown below the axis; None if none is near to opposite."""
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
        """The rims of the planets that are shown."""
        shown = [(0, self.distance)] + ([] if self.below is None else [(self.below, -self.distance)])
        return tuple(InPlane(rim, height) for number, height in shown for rim in self.layout.planets[number])

    @cached_property
    def carrier(self) -> CarrierPlan | None:
        """A plain carrier; None where planets have no bores, or stages leave no room for one."""
        try:
            return carrier_plan(self.layout)
        except GeometryError:
            return None

    @cached_property
    def room(self) -> str:
        """Why the bodies cannot stand beside each other; "" where they can, or a ring without a rim leaves it open."""
        if any(body.gear.internal and body.gear.body.rim_diameter is None for body in self.layout.bodies.values()):
            return ""
        try:
            require_room(self.layout)
        except GeometryError as error:
            return str(error)
        return ""

    @property
    def reach(self) -> float:
        """How far from the axis of the train its set reaches."""
        planets = (self.distance + rim.gear.tip_diameter / 2 for rim in self.train.rims)
        rings = (Meridian(central.gear, 1.0).rim for central in self.train.centrals if central.gear.internal)
        return max((*planets, *rings))

    @property
    def largest(self) -> float:
        """The largest size of it: across, or along its axis."""
        ends = [end for each in self.layout.standing for end in each.extent]
        return max(2 * self.reach, max(ends) - min(ends))

    # ------------------------------------------------------------------ stages

    @cached_property
    def stages(self) -> tuple[InPlane, ...]:
        """Gears of the stages that have room in the plane, above or below the axis that they are next to."""
        return tuple(chain.from_iterable(self._stages.values()))

    @property
    def left_out(self) -> tuple[str, ...]:
        """Stages that have none."""
        return tuple(stage.name for stage in self.train.stages if stage.name not in self._stages)

    def stage(self, name: str) -> tuple[InPlane, InPlane]:
        """Pinion and wheel of one that is shown."""
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
        """Pinion and wheel on the side where they are, on the other side if there is no room; None if there is none either."""
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
    """Whether two bodies that do not mesh would be drawn over each other."""
    (low, high), (bottom, top) = one.standing.extent, other.standing.extent
    if low >= top - _TOUCHING or bottom >= high - _TOUCHING:
        return False
    return any(
        start < end - _TOUCHING for a, b in _reach(one) for c, d in _reach(other) for start, end in [(max(a, c), min(b, d))]
    )


def _reach(body: InPlane) -> Iterator[tuple[float, float]]:
    """Heights over which a body is cut; of a ring those of its two sides."""
    gear = body.standing.body.gear
    if not gear.internal:
        yield body.height - gear.tip_diameter / 2, body.height + gear.tip_diameter / 2
        return
    inner, outer = abs(gear.tip_diameter) / 2, (gear.body.rim_diameter or abs(gear.root_diameter)) / 2
    yield body.height + inner, body.height + outer
    yield body.height - outer, body.height - inner
