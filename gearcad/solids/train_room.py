"""Is there room for the bodies of a planetary train beside each other, along its axis? What they sweep as they turn, compared.

Gears that mesh are judged where teeth are; here are those that only stand side by side: a rim and the central of the other
rim, the two rims of a planet, rings, and the gears of stages.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from gearcad.errors import GeometryError
from gearcad.geometry.limits import at_least, at_most
from gearcad.solids.rim import require_rim
from gearcad.solids.train_layout import Standing, TrainLayout

__all__ = ["Sweep", "overlap", "require_bodies", "require_room", "sweeps"]

_TOUCHING = 1e-9
"""Lengths (mm) that are rounding: bodies may stand face to face."""

_Extent = tuple[float, float]


@dataclass(frozen=True)
class Sweep:
    """What a part of a body sweeps: between two radii about its own axis, between two heights (mm)."""

    standing: Standing
    radii: _Extent
    heights: _Extent

    @property
    def distance(self) -> float:
        """Of its axis from the train's (mm)."""
        return math.hypot(self.standing.axle.x, self.standing.axle.y)

    def about_the_train(self) -> _Extent:
        """The radii between which it is, seen from the axis of the train (mm)."""
        inner, outer = self.radii
        return max(self.distance - outer, inner - self.distance, 0.0), self.distance + outer


def require_bodies(layout: TrainLayout) -> None:
    """Raise GeometryError, led by its name, for a ring without a rim: its teeth alone are no body."""
    for body in layout.bodies.values():
        if body.gear.internal:
            try:
                require_rim(body.gear)
            except GeometryError as error:
                raise error.within(body.key) from error


def require_room(layout: TrainLayout) -> None:
    """Raise GeometryError, with the axial positions that would do, where bodies stand in each other."""
    train, planet = layout.train, layout.planets[0]
    if train.stepped:
        rims = {central.name: central.meshes for central in train.centrals}
        second = train.rims[1]
        upper = [each for each in (*layout.centrals, *planet) if rims.get(each.body.key, each.body.key) == second.name]
        lower = [each for each in (*layout.centrals, *planet) if each not in upper]
        _require_apart(f"{second.name}.axial_position", second.axial_position, upper, lower)
    stages = layout.stages
    for number, stage in enumerate(train.stages):
        own, before = stages[2 * number : 2 * number + 2], stages[: 2 * number]
        _require_apart(f"{stage.name}.axial_position", stage.axial_position, own, [*layout.centrals, *planet, *before])


def _require_apart(parameter: str, value: float, moved: Sequence[Standing], others: Sequence[Standing]) -> None:
    """Bodies that an axial position moves must not stand in any of the others."""
    pairs = [
        (one, other)
        for mine in moved
        for theirs in others
        for one in sweeps(mine)
        for other in sweeps(theirs)
        if _side_by_side(one, other)
    ]
    within = [(one, other) for one, other in pairs if overlap(one.heights, other.heights)]
    if not within:
        return
    one, other = within[0]
    above = value + max(other.heights[1] - one.heights[0] for one, other in pairs)
    below = value - max(one.heights[1] - other.heights[0] for one, other in pairs)
    names = f"{one.standing.body.key} and {other.standing.body.key} stand in each other"
    raise GeometryError(parameter, value, f"must be at least {at_least(above)} or at most {at_most(below)} mm: {names}", "mm")


def sweeps(standing: Standing) -> Iterator[Sweep]:
    """The teeth of a gear down to its bore, or out to its rim, and its hubs."""
    gear, body = standing.body.gear, standing.body.gear.body
    bottom, top = standing.z, standing.z + gear.face_width
    tip, bore = abs(gear.tip_diameter) / 2, body.bore / 2
    yield Sweep(standing, (tip, require_rim(gear) / 2) if gear.internal else (bore, tip), (bottom, top))
    back, front = body.hub_ends
    for low, high in ((bottom - back, bottom), (top, top + front)):
        if high > low:
            yield Sweep(standing, (bore, body.hub_diameter / 2), (low, high))


def _side_by_side(one: Sweep, other: Sweep) -> bool:
    """Whether two would be in each other at one height."""
    if _off_axis(one) and _off_axis(other):
        axles = one.standing.axle, other.standing.axle
        apart = math.hypot(axles[0].x - axles[1].x, axles[0].y - axles[1].y)
        same = apart < _TOUCHING
        return overlap(one.radii, other.radii) if same else apart < one.radii[1] + other.radii[1] - _TOUCHING
    return overlap(one.about_the_train(), other.about_the_train())


def _off_axis(sweep: Sweep) -> bool:
    """Whether it turns about an axis of its own that stands still."""
    return sweep.distance > _TOUCHING and sweep.standing.axle.on is None


def overlap(one: _Extent, other: _Extent) -> bool:
    """Whether two ranges (mm) have more than an end in common."""
    return one[0] < other[1] - _TOUCHING and other[0] < one[1] - _TOUCHING
