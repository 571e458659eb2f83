"""Where along the axis rims and stages stand, if that is not given: the bodies of each clear of those beside it."""

from __future__ import annotations

from dataclasses import replace

from gearcad.geometry import Gear
from gearcad.geometry.derived import Derived, is_given
from gearcad.planetary.members import PairStage
from gearcad.planetary.train_data import TrainData

__all__ = ["settle_heights"]

_Extent = tuple[float, float]


def settle_heights(train: TrainData) -> None:
    """Let every `axial_position` that is not given be one: second rims above the first, with a module of room.

    Stages on the way to the output stand above the set, all others below, those next to the set first.
    """
    room = max(rim.gear.normal_module for rim in train.rims)
    first, *others = (_rim_extent(train, rim.name, rim.gear) for rim in train.rims)
    heights = [0.0, *(first[1] + room - other[0] for other in others)]
    rims = [
        rim if is_given(rim.axial_position) else replace(rim, axial_position=Derived(height))
        for rim, height in zip(train.rims, heights, strict=True)
    ]
    object.__setattr__(train, "rims", tuple(rims))
    levels = [rim.axial_position for rim in rims]
    ends = [(low + level, high + level) for (low, high), level in zip((first, *others), levels, strict=True)]
    _settle_stages(train, min(low for low, _ in ends), max(high for _, high in ends), room)


def _settle_stages(train: TrainData, low: float, high: float, room: float) -> None:
    """The same of the stages beside a set between two heights (mm)."""
    above = _way(train, train.output) or ()
    found: dict[str, PairStage] = {}
    nearest_first = sorted(train.stages, key=lambda stage: len(_way(train, stage.pinion) or ()))
    for stage in nearest_first:
        if not is_given(stage.axial_position):
            bottom, top = _stage_extent(stage)
            if stage in above:
                height = high + room - bottom
                high = height + top
            else:
                height = low - room - top
                low = height + bottom
            found[stage.name] = replace(stage, axial_position=Derived(height))
    object.__setattr__(train, "stages", tuple(found.get(stage.name, stage) for stage in train.stages))


def _way(train: TrainData, shaft: str, gone: tuple[PairStage, ...] = ()) -> tuple[PairStage, ...] | None:
    """The stages between a shaft and the set; None where they do not lead to it."""
    if shaft in train.members:
        return gone
    for stage in train.stages:
        if stage not in gone and shaft in (stage.pinion, stage.wheel):
            other = stage.wheel if shaft == stage.pinion else stage.pinion
            if (found := _way(train, other, (*gone, stage))) is not None:
                return found
    return None


def _rim_extent(train: TrainData, name: str, rim: Gear) -> _Extent:
    """Lower and upper end (mm) of a rim and of what meshes with it, above the bottom of the rim's teeth."""
    centrals = [central.gear for central in train.centrals if central.meshes == name]
    ends = [_gear_extent(gear, (rim.face_width - gear.face_width) / 2) for gear in (rim, *centrals)]
    return min(low for low, _ in ends), max(high for _, high in ends)


def _stage_extent(stage: PairStage) -> _Extent:
    """The same of a stage, above the bottom of the pinion's teeth."""
    ends = [_gear_extent(stage.pair.pinion, 0.0), _gear_extent(stage.pair.wheel, stage.pair.wheel_pose().z)]
    return min(low for low, _ in ends), max(high for _, high in ends)


def _gear_extent(gear: Gear, bottom: float) -> _Extent:
    """The same of a gear with its hubs, whose teeth begin at `bottom`."""
    back, front = gear.body.hub_ends
    return bottom - back, bottom + gear.face_width + front
