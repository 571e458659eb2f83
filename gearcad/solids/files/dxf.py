"""DXF of the transverse profile as modified: one closed contour of true arcs for laser and wire cutting."""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Mapping
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import Body, Gear
from gearcad.solids.files.contour import extent_of, gear_contour
from gearcad.solids.keyway import keyway_half_angle

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts import Modelspace

__all__ = ["write_dxf"]

_CUT = (7, "CONTINUOUS")
_LAYERS = {"PROFILE": _CUT, "BORE": _CUT}
_RING_LAYERS = {"PROFILE": _CUT, "RIM": _CUT, "BOLTS": _CUT}
_CIRCLES = {"CIRCLES": (8, "CENTER")}
"""Colour (AutoCAD index) and line type of layers; circles are grey and dash-dotted, as they are not to be cut."""

_fixed_meta_data = Lock()
"""Held while the global option of ezdxf is changed, so that threads do not restore each other's value."""

_MILLIMETRES, _METRIC = 4, 1


def write_dxf(gear: Gear, path: Path | str, *, accuracy: float = 0.0005, circles: bool = False) -> None:
    """Write the transverse section as DXF (R2010, mm): tooth 0 on +x.

    The flanks are as modified at mid face width, where modifications along the face are nothing (see `middle_section`).
    Layer PROFILE holds the contour, one closed polyline of arcs (see `gear_contour`); BORE the bore, a circle, or with a
    keyway a closed polyline; CIRCLES, with `circles`, the tip, reference, base and root circles, which are not to be cut.
    A ring's contour is that of its opening; it has no BORE but RIM, the circle outside if it has one, and BOLTS, its holes.
    The header states how far the drawing reaches. Equal input gives equal bytes.
    Raises ParameterError for an `accuracy` (mm) below 1e-7.
    """
    import ezdxf

    contour = gear_contour(gear, accuracy)
    with _fixed_meta_data:
        # The only way to keep ezdxf from writing the time and new identifiers into the file is this global option.
        before = ezdxf.options.write_fixed_meta_data_for_testing
        ezdxf.options.write_fixed_meta_data_for_testing = True
        try:
            document = _document(_RING_LAYERS if gear.internal else _LAYERS)
            space = document.modelspace()
            space.add_lwpolyline(contour.tolist(), format="xyb", close=True, dxfattribs={"layer": "PROFILE"})
            (_draw_rim if gear.internal else _draw_bore)(space, gear.body)
            low, high = extent_of(contour)
            if circles:
                low, high = _draw_circles(document, gear)
            if gear.body.rim_diameter is not None:
                high = np.full(2, gear.body.rim_diameter / 2)
                low = -high
            space.reset_extents((*low, 0.0), (*high, 0.0))
            with Path(path).open("w", encoding=document.output_encoding, errors="dxfreplace", newline="\n") as stream:
                document.write(stream)
        finally:
            ezdxf.options.write_fixed_meta_data_for_testing = before


def _document(layers: Mapping[str, tuple[int, str]]) -> Drawing:
    import ezdxf

    document = ezdxf.new("R2010", setup=["linetypes"])
    # ezdxf adds these from a set when it writes, in an order that changes from process to process.
    document.classes.add_required_classes(document.dxfversion)
    document.classes.classes = OrderedDict(sorted(document.classes.classes.items()))
    document.header["$INSUNITS"], document.header["$MEASUREMENT"] = _MILLIMETRES, _METRIC
    _add_layers(document, layers)
    return document


def _add_layers(document: Drawing, layers: Mapping[str, tuple[int, str]]) -> None:
    for name, (colour, linetype) in layers.items():
        document.layers.add(name, color=colour, linetype=linetype)


def _draw_circles(document: Drawing, gear: Gear) -> tuple[Floats, Floats]:
    """The circles of reference; how far they reach."""
    _add_layers(document, _CIRCLES)
    profile = gear.profile
    for diameter in (profile.tip_diameter, profile.reference_diameter, profile.base_diameter, profile.root_diameter):
        document.modelspace().add_circle((0, 0), diameter / 2, dxfattribs={"layer": "CIRCLES"})
    reach = np.full(2, max(profile.tip_diameter, profile.root_diameter) / 2)
    return -reach, reach


def _draw_rim(space: Modelspace, body: Body) -> None:
    if body.rim_diameter is not None:
        space.add_circle((0, 0), body.rim_diameter / 2, dxfattribs={"layer": "RIM"})
    for k in range(body.bolt_holes):
        angle = 2 * math.pi * k / body.bolt_holes
        middle = (body.bolt_circle / 2 * math.cos(angle), body.bolt_circle / 2 * math.sin(angle))
        space.add_circle(middle, body.bolt_diameter / 2, dxfattribs={"layer": "BOLTS"})


def _draw_bore(space: Modelspace, body: Body) -> None:
    radius, half_width = body.bore / 2, body.keyway_width / 2
    if not radius:
        return
    if not half_width:
        space.add_circle((0, 0), radius, dxfattribs={"layer": "BORE"})
        return
    end = keyway_half_angle(body)
    corner, floor = radius * math.cos(end), radius + body.keyway_depth
    # The arc goes the long way round, from the keyway's upper to its lower wall.
    points = [
        (corner, half_width, math.tan((math.pi - end) / 2)),
        (corner, -half_width, 0.0),
        (floor, -half_width, 0.0),
        (floor, half_width, 0.0),
    ]
    space.add_lwpolyline(points, format="xyb", close=True, dxfattribs={"layer": "BORE"})
