"""Whether gears of stages stand in the way of the set: teeth at the same height, at the same distance from the axis."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.geometry import Gear
from gearcad.notice import Notice
from gearcad.planetary.clearances import Span, teeth_spans
from gearcad.planetary.poses import GearPlace, train_pose
from gearcad.planetary.train_data import TrainData

__all__ = ["stage_notices"]


def stage_notices(train: TrainData) -> Iterator[Notice]:
    """What of each stage is where planets or centrals pass; its tip circles are looked at, not its shafts and bodies."""
    heights, reaches = teeth_spans(train), _reaches(train)
    for stage, pose in zip(train.stages, train_pose(train).stages, strict=True):
        for role, place in pose.gears.items():
            gear = stage.pair.gears.pick(role)
            height, reach = Span(place.height, place.height + gear.face_width), _reach(gear, place)
            met = [name for name in heights if height.meets(heights[name]) and reach.meets(reaches[name])]
            if met:
                text = f"its {role.value} stands at the height of {', '.join(met)}: another axial_position is clear of them"
                yield Notice("stage-in-the-way", text, where=stage.name)


def _reaches(train: TrainData) -> dict[str, Span]:
    """From where to where, from the axis of the train, teeth of rims and centrals pass."""
    distance = float(train.centre_distance)
    found = {rim.name: Span(distance - rim.gear.tip_diameter / 2, distance + rim.gear.tip_diameter / 2) for rim in train.rims}
    return found | {central.name: _reach(central.gear, GearPlace(0.0, 0.0, 0.0, 0.0)) for central in train.centrals}


def _reach(gear: Gear, place: GearPlace) -> Span:
    """The same of a gear in its place: what is outside the tips of a ring, or inside those of another gear."""
    off, radius = math.hypot(place.x, place.y), abs(gear.tip_diameter) / 2
    return Span(max(radius - off, 0.0), math.inf) if gear.internal else Span(max(off - radius, 0.0), off + radius)
