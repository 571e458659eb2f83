"""Levels: the circles of a tooth, or lines of a rack's, that its detail shows and names. Lengths in mm of the part."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.drawing.shapes import Pen
from gearcad.geometry import Gear, Rack

__all__ = ["Level", "levels_of"]

_DEEPEST = 0.6
"""A base circle further below the root circle (tooth depths) is left out: nothing of the tooth is there."""

_FORM_DECIMALS = 2
"""Of where a rack's flank ends: no third one is true, as the root radii of ISO 53 have two."""


@dataclass(frozen=True)
class Level:
    """A radius, or a height over a rack's reference line, with its symbol, the value that is written beside it, and its pen.

    A `reference` value stands elsewhere on the sheet, so it is in brackets here.
    """

    symbol: str
    height: float
    value: float
    pen: Pen = Pen.THIN
    reference: bool = False
    decimals: int = 3


def levels_of(gear: Gear | Rack) -> tuple[Level, ...]:
    """From the lowest to the highest on paper: those that are on the tooth or near it."""
    found = _of_rack(gear) if isinstance(gear, Rack) else _of_gear(gear)
    return tuple(sorted(found, key=lambda level: level.height))


def _of_gear(gear: Gear) -> list[Level]:
    profile = gear.profile
    circles = [
        ("d_a", profile.tip_diameter, Pen.THIN, True),
        ("d_Fa", profile.tip_form_diameter, Pen.THIN, False),
        ("d", profile.reference_diameter, Pen.CENTRE, True),
        ("d_b", profile.base_diameter, Pen.THIN, True),
        ("d_Ff", profile.form_diameter, Pen.THIN, True),
        ("d_f", profile.root_diameter, Pen.THIN, True),
    ]
    tip, root = profile.tip_diameter, profile.root_diameter
    beyond = _DEEPEST * abs(tip - root)
    near = min(tip, root) - beyond, max(tip, root) + beyond
    if not profile.tip_chamfer:
        del circles[1]
    return [Level(symbol, size / 2, size, pen, known) for symbol, size, pen, known in circles if near[0] <= size <= near[1]]


def _of_rack(rack: Rack) -> list[Level]:
    lines = [
        Level("h_a", rack.tip_height, rack.tip_height, reference=True),
        Level("h_Fa", rack.tip_form_height, rack.tip_form_height),
        Level("h_Ff", -rack.form_depth, rack.form_depth, decimals=_FORM_DECIMALS),
        Level("h_f", -rack.root_depth, rack.root_depth, reference=True),
    ]
    if not rack.tip_chamfer:
        del lines[1]
    return [Level("H_0", 0.0, rack.height, Pen.CENTRE, True), *lines]
