"""What the sheet of a pair says of its mesh: distance, teeth, backlash with its limits, accuracy. Lengths in mm."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from gearcad.drawing.gear_data import Row
from gearcad.drawing.quality import grade_of
from gearcad.drawing.subject import DrawnPair
from gearcad.drawing.words import Words
from gearcad.geometry import Gear, GearPair, Rack, RackPair

__all__ = ["backlash_row", "distance_row", "pair_rows"]


def pair_rows(drawn: DrawnPair, words: Words) -> tuple[Row, ...]:
    """In order: where the axes are, what meshes, with how much backlash, how accurate."""
    return tuple(_rows(drawn, words))


def _rows(drawn: DrawnPair, words: Words) -> Iterator[Row]:
    pair = drawn.pair
    first = drawn.parts[0].gear
    yield distance_row(pair, words)
    if isinstance(pair, GearPair) and pair.axial_offset:
        yield _row(
            "axial_offset", words, "", words.shortest(pair.axial_offset, 3), {"pair.axial_offset": pair.axial_offset}, item="2"
        )
    numbers = {"pinion.normal_module": first.normal_module}
    yield _row("normal_module", words, "m_n", words.shortest(first.normal_module, 6), numbers)
    yield _teeth(drawn, words)
    if isinstance(pair, GearPair):
        ratio = pair.gear_ratio
        yield _row("gear_ratio", words, "u", words.number(ratio, 4), {"pair.gear_ratio": ratio})
    else:
        travel = pair.travel_per_revolution
        length = pair.rack.length
        yield _row("rack_length", words, "L", words.shortest(length, 3), {f"{drawn.parts[1].role}.length": length})
        yield _row("travel", words, "", words.number(travel, 3), {"pair.travel_per_revolution": travel})
    if first.helix_angle:
        yield _helix(first, pair, words)
    for name, symbol in (("circumferential_backlash", "j_wt"), ("normal_backlash", "j_bn")):
        yield backlash_row(name, symbol, pair, words)
    for number, part in enumerate(drawn.parts, 1):
        if isinstance(part.gear, Rack):
            yield _row("accuracy", words, "", f"— ({words['data.not_of_racks']})", {}, item=str(number))
            continue
        grade = grade_of(part)
        assumed = f" ({words['assembly.assumed']})" if part.grade is None else ""
        text = f"{grade}  {part.accuracy.value}{assumed}"
        yield _row("accuracy", words, "", text, {f"{part.role}.tolerances.grade": grade}, item=str(number))


def distance_row(pair: GearPair | RackPair, words: Words) -> Row:
    """The centre distance and its allowance, or how far a pinion's axis is from a rack's reference line."""
    if isinstance(pair, RackPair):
        value = pair.mounting_distance
        return _row("mounting_distance", words, "H", words.number(value, 3), {"pair.mounting_distance": value})
    text, numbers = words.number(abs(pair.centre_distance), 3), {"pair.centre_distance": pair.centre_distance}
    if pair.centre_distance_tolerance is not None:
        text += f" ±{words.shortest(pair.centre_distance_allowance / 1000, 4)}"
        numbers["pair.backlash_limits.centre_distance_allowance"] = pair.centre_distance_allowance
    return _row("centre_distance", words, "a", text, numbers)


def backlash_row(name: str, symbol: str, pair: GearPair | RackPair, words: Words) -> Row:
    """Of one name ("normal_backlash"): between limits where tolerances are known, else its nominal value."""
    limits = pair.backlash_limits if isinstance(pair, GearPair) else None
    if limits is None:
        value = getattr(pair, name)
        return _row(name, words, symbol, words.number(value, 3), {f"pair.{name}": value})
    kind = name.removesuffix("_backlash")
    found = {f"pair.backlash_limits.{kind}_{end}": getattr(limits, f"{kind}_{end}") for end in ("greatest", "least")}
    greatest, least = (words.number(value, 3) for value in found.values())
    return Row(key=name, words=words[f"assembly.{name}"], symbol=symbol, limits=(greatest, least), numbers=found)


def _teeth(drawn: DrawnPair, words: Words) -> Row:
    """Those of both; of a ring negative, as in its own table."""
    counts = {f"{part.role}.teeth": float(part.gear.teeth or 0) for part in drawn.parts}
    text = " / ".join(words.number(count, 0) for count in counts.values())
    return _row("teeth", words, "z_1 / z_2", text, counts, first="1", second="2")


def _helix(gear: Gear | Rack, pair: GearPair | RackPair, words: Words) -> Row:
    """Angle and hand of the pinion; a double helical one has both."""
    angle = gear.helix_angle
    hand = "right" if angle > 0 else "left"
    if isinstance(pair, GearPair) and pair.double_helical:
        hand = "double_helical"
    text = f"{words.number(abs(angle), 4)}° {words[f'assembly.{hand}']}"
    return _row("helix_angle", words, "β", text, {"pinion.helix_angle": angle}, item="1")


def _row(key: str, words: Words, symbol: str, text: str, numbers: Mapping[str, float], **named: str) -> Row:
    label = words[f"assembly.{key}"].format(**named)
    return Row(key=key, words=label, symbol=symbol, text=text, numbers=numbers)
