"""What a gear meshes with, and how far from it it stands."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from gearcad.drawing.gear_data.row import Row, RowWriter
from gearcad.drawing.subject import DrawnGear, Mate
from gearcad.drawing.titles import kind_of, titled
from gearcad.geometry import RackPair

__all__ = ["mate_rows"]


def mate_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[Row]:
    """The distance from each mate, and its teeth and number, or title; of several mates the keys begin with their names.

    A distance that is that of another mate too stands once.
    """
    seen: set[str] = set()
    for mate in drawn.mates:
        lead = f"{mate.name}." if len(drawn.mates) > 1 else ""
        distance = _distance(mate, write)
        if distance.text not in seen:
            yield _led(distance, lead)
        seen.add(distance.text)
        yield _led(_teeth(mate, write), lead)


def _led(row: Row, lead: str) -> Row:
    """With this before its keys."""
    return replace(row, key=f"{lead}{row.key}", numbers={f"{lead}{key}": value for key, value in row.numbers.items()})


def _teeth(mate: Mate, write: RowWriter) -> Row:
    teeth = mate.gear.teeth
    assert teeth is not None  # a rack has counted its own
    name = mate.number or titled(write.words, kind_of(mate.name, mate.gear), mate.gear.name, mate.name)
    return write.text("mate", f"{write.words.number(teeth, 0)} / {name}", "z", {"mate.teeth": teeth})


def _distance(mate: Mate, write: RowWriter) -> Row:
    pair = mate.pair
    if isinstance(pair, RackPair):
        return write.length("mounting_distance", pair.mounting_distance, "H", "pair.mounting_distance")
    row = write.length("centre_distance", pair.centre_distance, "a", "pair.centre_distance")
    if pair.centre_distance_tolerance is None:
        return row
    allowance = pair.centre_distance_allowance
    text = f"{row.text} ±{write.words.shortest(allowance / 1000, 4)}"
    numbers = {**row.numbers, "pair.backlash_limits.centre_distance_allowance": allowance}
    return write.text("centre_distance", text, "a", numbers)
