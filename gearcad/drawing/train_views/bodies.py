"""What the section of a train cuts: suns, planets on the pins of a plain carrier, rings, gears of stages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from gearcad.drawing.assembled import Cut, Sectioned, cut_gear, pitch_lines
from gearcad.drawing.train_views.pitch import pitch_radii
from gearcad.drawing.train_views.plan import InPlane, TrainPlan
from gearcad.planetary import PlanetaryTrain
from gearcad.solids.carrier_plan import CarrierPlan

__all__ = ["bodies_of"]

_ONE_WAY, _OTHER_WAY = 45.0, 135.0
_CARRIER_SPACING = 4.0
"""Of the hatching: what lies side by side differs."""

_Interval = tuple[float, float]
_Rectangle = tuple[tuple[float, float], ...]


def bodies_of(plan: TrainPlan) -> list[tuple[str, Sectioned]]:
    """Each with the key of its item, in order from the teeth in front on: suns, planets, rings, stages, carrier."""
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


def _carrier(plan: TrainPlan) -> Iterator[Sectioned]:
    """Pins, which are not hatched, and plates."""
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
    """What the plane cuts of a plate, between its pins."""
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
