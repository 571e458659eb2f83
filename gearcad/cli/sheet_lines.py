"""The lines of a data sheet: their columns and blocks, and those of pairs, which sheets of trains have too."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from gearcad import symbols
from gearcad.geometry import GearPair, RackPair
from gearcad.schema import symbols_of

__all__ = ["ABSENT", "NOTHING", "OF_PAIR", "WIDTH", "Line", "block", "columns", "flattened", "pair_lines", "value_text"]

OF_PAIR = symbols_of(GearPair) | symbols_of(RackPair) | symbols.PAIR | symbols.RACK_PAIR | symbols.DRIVE
OF_PAIR["tip_clearances.pinion"] = symbols.PAIR["tip_clearances"]._replace(words="tip clearance of the pinion")


_PAIR_BLOCKS = {
    "Mesh": "gear_ratio centre_distance reference_centre_distance axial_offset mounting_distance back_distance"
    " shifted_distance zero_backlash_distance pitch_line_height working_transverse_pressure_angle"
    " profile_shift_sum zero_backlash_shift_sum tip_alteration circumferential_backlash normal_backlash axial_force_ratio"
    " tip_clearances.pinion tip_clearances.rack",
    "Backlash within tolerances": "centre_distance_tolerance "
    + " ".join(k for k in OF_PAIR if k.startswith("backlash_limits.")),
    "Motion": "travel_per_revolution travel_per_degree rack_force rack_speed",
    "Contact": "transverse_contact_ratio usable_contact_ratio overlap_ratio total_contact_ratio common_width.width"
    " common_width.offset contact_line_lengths.minimum contact_line_lengths.mean contact_line_lengths.maximum"
    " active_root_diameter active_root_depth",
    "Line of action, from T1": "path_of_contact.A path_of_contact.B path_of_contact.C path_of_contact.D path_of_contact.E",
    "Free of interference by (negative: it is there)": "interference_margins.involute interference_margins.pinion_fillet"
    " interference_margins.wheel_fillet interference_margins.trochoid interference_margins.radial",
}

ABSENT = "-"

NOTHING = symbols.Symbol("", "", "", "")

WIDTH = 12
"""Of a column of values."""


class Line(NamedTuple):
    """One line of the sheet and its style on a terminal."""

    text: str
    style: str = ""


def pair_lines(pairs: Mapping[str, dict[str, Any]], with_source: bool, width: int = WIDTH) -> Iterator[Line]:
    """The blocks of pairs, a column each."""
    for title, keys in _PAIR_BLOCKS.items() if pairs else ():
        known = [key for key in keys.split() if any(key in pair for pair in pairs.values())]
        rows = [(OF_PAIR[key], [value_text(pair.get(key)) for pair in pairs.values()]) for key in known]
        yield from block(title, rows, with_source, width)


def block(title: str, rows: list[tuple[symbols.Symbol, list[str]]], with_source: bool, width: int = WIDTH) -> Iterator[Line]:
    """A title and its rows, if there are any."""
    if rows:
        yield Line(title, "bold cyan")
        for symbol, values in rows:
            yield Line(columns(symbol, values, with_source=with_source, width=width))
        yield Line("")


def columns(symbol: symbols.Symbol, values: Iterable[str], *, with_source: bool, width: int = WIDTH) -> str:
    """One line of 76 characters, or some more with the source behind."""
    numbers = "".join(f"{value:>{width}}" for value in values)
    line = f"  {symbol.words:<37}{symbol.symbol:<6} {symbol.unit:<6}{numbers}"
    return f"{line:<80}{symbol.source}".rstrip() if with_source else line.rstrip()


def flattened(document: Mapping[str, Any]) -> dict[str, Any]:
    """Nested keys joined by a dot."""
    flat: dict[str, Any] = {}
    for key, value in document.items():
        if isinstance(value, Mapping):
            flat |= {f"{key}.{inner}": item for inner, item in value.items()}
        else:
            flat[key] = value
    return flat


def value_text(value: Any) -> str:
    """Four digits after the point: 0.1 µm, and enough of a ratio or an angle."""
    if value is None:
        return ABSENT
    if isinstance(value, bool):
        return "yes" if value else "no"
    # Adding zero turns a rounded -0.0 into a plain one.
    return f"{round(value, 4) + 0.0:.4f}" if isinstance(value, float) else str(value)
