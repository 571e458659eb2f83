"""DXF of the transverse profile as modified: one closed contour of true arcs for laser and wire cutting."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dxf import CUT, NOT_CUT, add_layers, drawing
from gearcad.geometry import Body, Gear
from gearcad.solids.files.contour import extent_of, gear_contour
from gearcad.solids.keyway import keyway_half_angle

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts import Modelspace

__all__ = ["draw_circles", "draw_section", "write_dxf"]

_LAYERS = {"PROFILE": CUT, "BORE": CUT}
_RING_LAYERS = {"PROFILE": CUT, "RIM": CUT, "BOLTS": CUT}
_CIRCLES = {"CIRCLES": NOT_CUT}


def write_dxf(gear: Gear, path: Path | str, *, accuracy: float = 0.0005, circles: bool = False) -> None:
    """Write the transverse section as DXF (R2010, mm): tooth 0 on +x.

    The flanks are as modified at mid face width, where modifications along the face are nothing (see `middle_section`).
    Layer PROFILE holds the contour, one closed polyline of arcs (see `gear_contour`); BORE the bore, a circle, or with a
    keyway a closed polyline; CIRCLES, with `circles`, the tip, reference, base and root circles, which are not to be cut.
    A ring's contour is that of its opening; it has no BORE but RIM, the circle outside if it has one, and BOLTS, its holes.
    The header states how far the drawing reaches. Equal input gives equal bytes.
    Raises ParameterError for an `accuracy` (mm) below 1e-7.
    """
    contour = gear_contour(gear, accuracy)
    with drawing(path, _RING_LAYERS if gear.internal else _LAYERS) as document:
        space = document.modelspace()
        draw_section(space, gear, contour)
        low, high = extent_of(contour)
        if circles:
            low, high = draw_circles(document, gear)
        if gear.body.rim_diameter is not None:
            high = np.full(2, gear.body.rim_diameter / 2)
            low = -high
        space.reset_extents((*low, 0.0), (*high, 0.0))


def draw_section(space: Modelspace, gear: Gear, contour: Floats) -> None:
    """The contour of the teeth, and what else of a gear is cut, about the origin."""
    space.add_lwpolyline(contour.tolist(), format="xyb", close=True, dxfattribs={"layer": "PROFILE"})
    (_draw_rim if gear.internal else _draw_bore)(space, gear.body)


def draw_circles(document: Drawing, gear: Gear) -> tuple[Floats, Floats]:
    """The circles of reference about the origin; how far they reach."""
    add_layers(document, _CIRCLES)
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
