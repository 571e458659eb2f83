"""The enlarged detail of a tooth: its exact outline, its circles, the tooth thickness, the tip chamfer (ISO 128-3, 4.6)."""

from __future__ import annotations

import math

from gearcad.drawing.marks import freehand, plain, view_label
from gearcad.drawing.options import SCALES
from gearcad.drawing.shapes import Anchor, Box, Figure, Line, Pen
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.tooth_views.levels import levels_of
from gearcad.drawing.tooth_views.named import named_levels
from gearcad.drawing.tooth_views.placing import Placing, placing
from gearcad.drawing.tooth_views.thickness import thickness_dimension
from gearcad.drawing.words import Draughting
from gearcad.geometry import Gear, Rack

__all__ = ["detail_scale", "tooth_figure"]

_ROOM = (64.0, 54.0)
"""Greatest width and height of the tooth with half a space on both sides."""

_TITLE_GAP, _TEXT = 4.0, 2.5
_AIR = 1.2


def detail_scale(drawn: DrawnGear) -> float:
    """The largest scale of ISO 5455 at which a tooth has room."""
    place = placing(drawn.gear, 1.0)
    box = _shown(place)
    most = min(_ROOM[0] / box.width, _ROOM[1] / box.height)
    return next((scale for scale in SCALES.values() if scale <= most), min(SCALES.values()))


def tooth_figure(drawn: DrawnGear, draughting: Draughting, letter: str = "Z") -> Figure:
    """The detail at the scale of `draughting`, its reference circle at the origin, named by a letter and its scale."""
    place = placing(drawn.gear, draughting.scale)
    tooth = Figure.of(
        place.outline(),
        freehand(place.limit),
        named_levels(levels_of(drawn.gear), place, draughting),
        thickness_dimension(drawn.gear, place, draughting),
        _chamfer(drawn.gear, place, draughting),
    )
    return tooth + _title(letter, draughting.scale, tooth.box)


def _shown(place: Placing) -> Box:
    return Box.around((*place.outline().points, *place.limit))


def _chamfer(gear: Gear | Rack, place: Placing, draughting: Draughting) -> Figure:
    """A leader to the chamfer on the left, with its height in brackets: the gear data has it; nothing where there is none."""
    size = gear.tip_chamfer if isinstance(gear, Rack) else gear.body.tip_chamfer
    if not size:
        return Figure()
    up = not (isinstance(gear, Gear) and gear.internal)
    tip = gear.tip_height if isinstance(gear, Rack) else gear.profile.tip_diameter / 2
    at = tip - size / 2 if up else tip + size / 2
    x, y = place.point(at, -(place.flank(at) or 0.0))
    rise = 6.0 if up else -6.0
    knee = (x - 6.0, y + rise)
    text = plain(f"({draughting.words.shortest(size, 3)}×45°)", _TEXT)
    end = knee[0] - text.width - _AIR
    return Figure.of(
        Line((x, y), knee, Pen.DIMENSION),
        Line(knee, (end, knee[1]), Pen.DIMENSION),
        text.at((end, knee[1] + _AIR), Anchor.LEFT),
    )


def _title(letter: str, scale: float, box: Box) -> Figure:
    """Letter and scale in brackets above what they name."""
    ratio = next((name for name, value in SCALES.items() if math.isclose(value, scale)), f"{scale:g}:1")
    return view_label(f"{letter} ({ratio})", (box.middle[0], box.top + _TITLE_GAP))
