"""The parts of an assembly by their item numbers: how many there are, what they are called, what they are made of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from gearcad.drawing.frame import PartLine
from gearcad.drawing.options import DrawingOptions, PartDrawing
from gearcad.drawing.subject import DrawnGear, DrawnPair, DrawnTrain
from gearcad.drawing.titles import titled
from gearcad.drawing.train_views import TrainPlan
from gearcad.drawing.treatment import material_text
from gearcad.drawing.words import Words
from gearcad.geometry import Gear, Rack
from gearcad.planetary import PlanetaryTrain

__all__ = ["Item", "member_title", "pair_items", "train_items"]


@dataclass(frozen=True, kw_only=True)
class Item(PartLine):
    """A line of the parts list; `key` is the role of the part."""

    key: str


def pair_items(drawn: DrawnPair, options: DrawingOptions, parts: Mapping[str, PartDrawing], words: Words) -> tuple[Item, ...]:
    """Pinion and mate."""
    return tuple(
        _item(number, 1, part.role, part, "pinion" if number == 1 else _kind(part.gear), options, parts, words)
        for number, part in enumerate(drawn.parts, 1)
    )


def train_items(
    drawn: DrawnTrain, plan: TrainPlan, options: DrawingOptions, parts: Mapping[str, PartDrawing], words: Words
) -> tuple[Item, ...]:
    """The gears in the order of the train, those of the planets as many as there are, and the carrier if it is drawn."""
    known = {part.role: part for part in drawn.parts}
    found = []
    for number, (key, kind) in enumerate(_kinds(plan), 1):
        quantity = plan.train.planets if kind == "planet" else 1
        part = known.get(key) or DrawnGear(role=key, gear=plan.layout.bodies[key].gear)
        found.append(_item(number, quantity, key, part, kind, options, parts, words))
    if plan.carrier is not None:
        name = plan.train.carrier.name
        title = titled(words, "carrier", name)
        found.append(Item(key=name, item=len(found) + 1, quantity=1, title=title))
    return tuple(found)


def member_title(train: PlanetaryTrain, name: str, words: Words) -> str:
    """What a member, a central gear or the carrier, is called."""
    internal = {central.name: central.gear.internal for central in train.centrals}
    kind = "carrier" if name not in internal else "ring" if internal[name] else "sun"
    return titled(words, kind, name)


def _kinds(plan: TrainPlan) -> Iterator[tuple[str, str]]:
    """Keys of the gears, each with the word for what it is."""
    train = plan.train
    for central in train.centrals:
        yield central.name, "ring" if central.gear.internal else "sun"
    yield from ((rim.name, "planet") for rim in train.rims)
    for number, gear in enumerate(plan.layout.stages):
        yield gear.body.key, _kind(gear.body.gear) if number % 2 else "pinion"


def _kind(gear: Gear | Rack) -> str:
    if isinstance(gear, Rack):
        return "rack"
    return "ring" if gear.internal else "wheel"


def _item(
    number: int,
    quantity: int,
    key: str,
    part: DrawnGear,
    kind: str,
    options: DrawingOptions,
    parts: Mapping[str, PartDrawing],
    words: Words,
) -> Item:
    own = options.of_part(parts.get(key), alone=False)
    return Item(
        key=key,
        item=number,
        quantity=quantity,
        number=own.number,
        title=own.title or titled(words, kind, part.gear.name, key),
        material=material_text(part, own, words),
    )
