"""What a gear meshes with, and how far from it it stands."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.drawing.gear_data.row import Row, RowWriter
from gearcad.drawing.subject import DrawnGear, Mate
from gearcad.geometry import RackPair

__all__ = ["mate_rows"]


def mate_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[Row]:
    """The distance from each mate, and its teeth and number."""
    for mate in drawn.mates:
        teeth = mate.gear.teeth
        assert teeth is not None  # a rack has counted its own
        text = f"{write.words.number(teeth, 0)} / {mate.number or mate.name}"
        yield _distance(mate, write)
        yield write.text("mate", text, "z", {"mate.teeth": teeth})


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
