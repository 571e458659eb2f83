"""Room for the planets: tips of neighbours, and teeth at the same height that do not mesh."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from gearcad.errors import GeometryError, ParameterError
from gearcad.geometry.limits import at_least, at_most
from gearcad.planetary.members import Central, Rim
from gearcad.planetary.train_data import EQUAL, TrainData

__all__ = [
    "Span",
    "check_heights",
    "check_neighbours",
    "free_distance",
    "least_gap",
    "most_planets",
    "teeth_spans",
    "with_room",
]

_APART = 1e-9
"""Overlap of face widths (mm) that is rounding."""


# ---------------------------------------------------------------------- neighbours


class Gap(NamedTuple):
    """The least angle (degrees) between neighbouring planets, and which these are, from 0."""

    angle: float
    planets: tuple[int, int]


def least_gap(train: TrainData) -> Gap:
    """Of two planets or more."""
    order = sorted(range(train.planets), key=lambda number: train.angles[number] % 360)
    around = [(*order, order[0])[i : i + 2] for i in range(len(order))]
    return min(Gap((train.angles[b] - train.angles[a]) % 360, (a, b)) for a, b in around)


def most_planets(train: TrainData) -> int:
    """How many planets at equal angles have room for every rim, whether their teeth fit or not."""
    share = max(_wanted(train, rim) for rim in train.rims) / (2 * float(train.centre_distance))
    return 1 if share >= 1 else max(math.ceil(math.pi / math.asin(share)) - 1, 1)


def with_room(train: TrainData) -> list[int]:
    """The numbers of planets, from 1 on, whose teeth fit at equal angles and that have room."""
    return [number for number in range(1, most_planets(train) + 1) if train.adjusted or train.positions % number == 0]


def free_distance(train: TrainData) -> float | None:
    """Between the tips of neighbouring planets (mm), the least; None of a planet alone."""
    if train.planets == 1:
        return None
    return _apart(train, least_gap(train)) - max(rim.gear.tip_diameter for rim in train.rims)


def check_neighbours(train: TrainData) -> None:
    """2 a sin(gap/2) is above tip diameter and tip distance of each rim. Raises GeometryError."""
    if train.planets == 1:
        return
    gap = least_gap(train)
    apart = _apart(train, gap)
    rim = max(train.rims, key=lambda each: _wanted(train, each))
    if apart > _wanted(train, rim):
        return
    first, second = (number + 1 for number in gap.planets)
    free = f" and {train.tip_distance:g} mm shall be free" if train.tip_distance else ""
    tips = f"tips of {rim.name} reach {rim.gear.tip_diameter:.6g} mm"
    why = f"the axes of planets {first} and {second} are {apart:.6g} mm apart, {tips}"
    most, fitting = most_planets(train), with_room(train)[-1]
    teeth = "" if fitting == most else f" ({fitting}, for teeth to fit too)"
    if train.planet_angles == EQUAL:
        raise GeometryError("planets", train.planets, f"must be at most {most}{teeth}: {why}{free}")
    permitted = f"must be farther apart: {why}{free}; at equal angles {most} have room{teeth}"
    raise GeometryError("planet_angles", train.planet_angles, permitted)


def _apart(train: TrainData, gap: Gap) -> float:
    """Distance (mm) of the axes of neighbours."""
    return 2 * float(train.centre_distance) * math.sin(math.radians(gap.angle) / 2)


def _wanted(train: TrainData, rim: Rim) -> float:
    """Distance (mm) of axes that a rim needs, at least."""
    return rim.gear.tip_diameter + train.tip_distance


# ---------------------------------------------------------------------- heights


class Span(NamedTuple):
    """From `low` to `high` (mm)."""

    low: float
    high: float

    def meets(self, other: Span) -> bool:
        """Whether more than rounding is in both."""
        return min(self.high, other.high) - max(self.low, other.low) > _APART


def check_heights(train: TrainData) -> None:
    """Teeth at the same height that do not mesh are clear of each other. Raises ParameterError, GeometryError."""
    first = train.rims[0]
    for name, value, unit in (("axial_position", first.axial_position, "mm"), ("clocking", first.clocking, "deg")):
        if value:
            raise ParameterError(f"{first.name}.{name}", value, f"must be 0 {unit}: it is counted from this rim", unit)
    fouled = next(_fouled(train), None)
    if fouled is None:
        return
    if not train.stepped:
        raise GeometryError("rims", 1, f"must be two, one above the other: {fouled}")
    low, high = _clear_positions(train)
    permitted = f"must be at least {at_least(high)} or at most {at_most(low)} mm: {fouled}"
    raise GeometryError(f"{train.rims[1].name}.axial_position", train.rims[1].axial_position, permitted, "mm")


def teeth_spans(train: TrainData) -> dict[str, Span]:
    """Heights over which the teeth of rims and centrals stand, by names."""
    spans = {rim.name: Span(rim.axial_position, rim.axial_position + rim.gear.face_width) for rim in train.rims}
    for mesh in train.meshes:
        low = mesh.rim.axial_position + (mesh.rim.gear.face_width - mesh.central.gear.face_width) / 2
        spans[mesh.central.name] = Span(low, low + mesh.central.gear.face_width)
    return spans


def _fouled(train: TrainData) -> Iterator[str]:
    """What stands in the way of what, in words."""
    spans = teeth_spans(train)
    for one, other in pairwise(train.rims):
        if spans[one.name].meets(spans[other.name]):
            yield f"the rims of a planet, {one.name} and {other.name}, stand at the same height"
    a, b = train.centrals
    if spans[a.name].meets(spans[b.name]) and _centrals_overlap(a, b):
        yield f"{a.name} and {b.name} stand at the same height"
    for central in train.centrals:
        for rim in train.rims:
            if rim.name != central.meshes and spans[rim.name].meets(spans[central.name]):
                if (depth := _reach(train, central, rim)) >= 0:
                    yield f"{rim.name} stands at the height of {central.name} and reaches {at_most(depth)} mm into it"


def _centrals_overlap(a: Central, b: Central) -> bool:
    """Whether centrals at the same height are in each other's way: two suns, two rings, or a sun as large as the ring."""
    if a.gear.internal is b.gear.internal:
        return True
    return a.gear.tip_diameter + b.gear.tip_diameter >= 0


def _reach(train: TrainData, central: Central, rim: Rim) -> float:
    """How far (mm) the tips of a rim reach beyond those of a central that it does not mesh with; negative if clear."""
    distance = -float(train.centre_distance) if central.gear.internal else float(train.centre_distance)
    return (rim.gear.tip_diameter + central.gear.tip_diameter) / 2 - distance


def _clear_positions(train: TrainData) -> tuple[float, float]:
    """Below and above which positions of the second rim nothing of both meshes stands at the same height."""
    first, second = train.meshes if train.meshes[0].rim is train.rims[0] else train.meshes[::-1]
    widths = [max(mesh.rim.gear.face_width, mesh.central.gear.face_width) for mesh in (first, second)]
    level = (first.rim.gear.face_width - second.rim.gear.face_width) / 2
    return level - sum(widths) / 2, level + sum(widths) / 2
