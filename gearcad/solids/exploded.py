"""A planetary train moved apart along its axis, so that every part shows."""

from __future__ import annotations

from dataclasses import replace

from gearcad.solids.carrier_plan import CarrierPlan
from gearcad.solids.train_layout import TrainLayout

__all__ = ["exploded"]

_GAP = 0.3
"""Between what was moved apart, as a share of the widest part: an oblique view then looks between them."""


def exploded(layout: TrainLayout, carrier: CarrierPlan | None = None) -> TrainLayout:
    """The layout with members above each other, in the order in which they stand; planets stay beside each
    other, and so do the gears of a stage.

    A carrier, under the name it has in the train, stands above all.
    """
    planet = layout.planets[0]
    extents = {each.body.key: each.extent for each in (*layout.centrals, *planet, *layout.stages)}
    members = ((layout.centrals[0],), planet, (layout.centrals[1],), *zip(*2 * [iter(layout.stages)], strict=True))
    groups = [tuple(each.body.key for each in member) for member in members]
    spans = {keys: (min(extents[key][0] for key in keys), max(extents[key][1] for key in keys)) for keys in groups}
    ordered = sorted(groups, key=lambda keys: round(sum(spans[keys]), 9))  # those at one height stay in the order of the train
    if carrier is not None:
        name = (layout.carrier.name,)
        spans[name] = carrier.reach
        ordered.append(name)
    gap = _GAP * max(abs(body.gear.tip_diameter) for body in layout.bodies.values())
    lifts: dict[str, float] = {}
    floor = spans[ordered[0]][0]
    for keys in ordered:
        low, high = spans[keys]
        lifts |= dict.fromkeys(keys, floor - low)
        floor += high - low + gap
    return replace(layout, lifts=lifts)
