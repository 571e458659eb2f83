"""What the general arrangement of a planetary train says of it: ratio, members, each mesh. Lengths in mm."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from gearcad.drawing.gear_data import Row
from gearcad.drawing.sheets.items import member_title
from gearcad.drawing.sheets.pair_rows import backlash_row, distance_row
from gearcad.drawing.train_views import TrainPlan
from gearcad.drawing.words import Words
from gearcad.geometry import Gear, GearPair
from gearcad.planetary import PlanetaryTrain
from gearcad.solids.train_layout import stage_keys

__all__ = ["train_rows"]


def train_rows(plan: TrainPlan, items: Mapping[str, int], words: Words) -> tuple[Row, ...]:
    """In order: the train as a whole, its meshes, its stages; `items` are item numbers by keys of gears."""
    return tuple(_rows(plan.train, items, words))


def _rows(train: PlanetaryTrain, items: Mapping[str, int], words: Words) -> Iterator[Row]:
    titles = {name: member_title(train, name, words) for name in (train.input, train.output)}
    if train.ratio is not None:
        numbers = {"planetary.ratio": train.ratio}
        input_end, output_end = map(words.within_text, titles.values())
        yield _row("ratio", words, "i", words.number(train.ratio, 4), numbers, input=input_end, output=output_end)
    else:
        yield _row("input_output", words, "", " / ".join(titles.values()), {})
    fixed = words["assembly.no_fixed"] if train.fixed is None else member_title(train, train.fixed, words)
    yield _row("fixed", words, "", fixed, {})
    yield _row("planets", words, "N", str(train.planets), {"planetary.planets": float(train.planets)})
    distance = float(train.centre_distance)
    yield _row("centre_distance", words, "a", words.number(distance, 3), {"planetary.centre_distance": distance})
    for mesh in train.meshes:
        gears = {mesh.central.name: mesh.central.gear, mesh.rim.name: mesh.rim.gear}
        yield from _mesh(gears, mesh.pair, f"planetary.meshes.{mesh.name}", items, words)
    for stage, keys in zip(train.stages, stage_keys(train), strict=True):
        gears, of_stage = dict(zip(keys, stage.pair.gears, strict=True)), f"planetary.stages.{stage.name}"
        row = distance_row(stage.pair, words)
        label = words["assembly.stage_distance"].format(**_pair_of(gears, items))
        numbers = {name.replace("pair", of_stage, 1): value for name, value in row.numbers.items()}
        yield Row(key="stage_distance", words=label, symbol=row.symbol, text=row.text, numbers=numbers)
        yield from _mesh(gears, stage.pair, of_stage, items, words)


def _mesh(gears: Mapping[str, Gear], pair: GearPair, where: str, items: Mapping[str, int], words: Words) -> Iterator[Row]:
    """Module, teeth and backlash of two gears; `where` documents have the pair."""
    first, _ = gears
    numbers = {f"{first}.normal_module": pair.pinion.normal_module}
    numbers |= {f"{name}.teeth": float(gear.teeth) for name, gear in gears.items()}
    teeth = " / ".join(words.number(gear.teeth, 0) for gear in gears.values())
    module = words.shortest(pair.pinion.normal_module, 6)
    yield _row("mesh", words, "m_n; z", f"{module}; {teeth}", numbers, **_pair_of(gears, items))
    row = backlash_row("normal_backlash", "j_bn", pair, words)
    found = {name.replace("pair", where, 1): value for name, value in row.numbers.items()}
    label = words["assembly.mesh_backlash"].format(**_pair_of(gears, items))
    yield Row(key="mesh_backlash", words=label, symbol="j_bn", text=row.text, limits=row.limits, numbers=found)


def _pair_of(gears: Mapping[str, Gear], items: Mapping[str, int]) -> dict[str, str]:
    """The item numbers of two gears, as words name them."""
    first, second = (str(items[key]) for key in gears)
    return {"first": first, "second": second}


def _row(key: str, words: Words, symbol: str, text: str, numbers: Mapping[str, float], **named: str) -> Row:
    return Row(key=key, words=words[f"assembly.{key}"].format(**named), symbol=symbol, text=text, numbers=numbers)
