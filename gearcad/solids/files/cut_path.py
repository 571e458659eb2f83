"""Paths of a wire or a laser beam as DXF: closed contours of arcs that go round the material at half the width of the cut.

Every contour is one closed polyline: teeth, bore, rim and bolt holes apart. Arcs meet in one vertex each and with one tangent,
but for corners that no wire can follow: those in the floor of a keyway, and where the outline of an undercut tooth is left.
A straight lead on a layer of its own ends in the first vertex of each contour, in the middle of an arc.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gearcad.core.dxf import CUT, NOT_CUT, drawing
from gearcad.core.records import Floats
from gearcad.geometry import Body, Gear
from gearcad.solids.body_plan import keyway_half_angle
from gearcad.solids.files.dxf import contour_of, extent_of

LEAD = "LEAD"

_LAYERS = {"PROFILE": CUT, "BORE": CUT}
_RING_LAYERS = {"PROFILE": CUT, "RIM": CUT, "BOLTS": CUT}


@dataclass(frozen=True, eq=False)
class CutPath:
    """A closed path on a `layer`: `contour` (n, 3) as in `gear_contour`, and `lead` (2, 2), the way in; mm."""

    layer: str
    contour: Floats
    lead: Floats


def cut_paths(gear: Gear) -> list[CutPath]:
    """Return the paths that cut a gear whose process is "wire" or "laser": its teeth first, then its holes and its rim.

    They are within its `path_tolerance` of the exact parallels.
    """
    made, making = gear.as_made, gear.making
    length = making.lead_length(gear.normal_module)
    teeth = contour_of(made.profile.curves, made.tooth_count, made.profile.root_diameter, making.arc_tolerance)
    outward = -1.0 if gear.internal else 1.0
    found = [CutPath("PROFILE", contour := _from_tip(teeth), _lead(contour, length, outward))]
    return [*found, *(_ring_paths if gear.internal else _bore_paths)(gear, made.body, length)]


def _from_tip(contour: Floats) -> Floats:
    """Return the contour from the middle of the first tip land, on +x, on."""
    x, y, bulge = contour.T
    after = np.roll(contour, -1, axis=0)
    land = int(np.argmin(np.abs(y + after[:, 1]) + np.abs(x - after[:, 0]) + np.where(x > 0, 0.0, np.inf)))
    half = math.tan(math.atan(bulge[land]) / 2)
    begun = np.array([[math.hypot(x[land], y[land]), 0.0, half]])
    before = contour[land].copy()
    before[2] = half
    return np.concatenate([begun, contour[land + 1 :], contour[:land], before[None]])


def _lead(contour: Floats, length: float, outward: float) -> Floats:
    """Return the ends of a lead along the radius to the first vertex of a contour; from within no farther than the axis."""
    place = contour[0, :2]
    radius = math.hypot(*place)
    reach = max(radius + outward * length, 0.0)
    return np.stack([place * (reach / radius), place])


def _circle(x: float, y: float, radius: float, start: float) -> Floats:
    """Return a circle as two arcs, from the angle `start` (rad) on."""
    dx, dy = radius * math.cos(start), radius * math.sin(start)
    return np.array([[x + dx, y + dy, 1.0], [x - dx, y - dy, 1.0]])


def _bore_paths(gear: Gear, made: Body, length: float) -> Iterator[CutPath]:
    if made.bore:
        contour = _keyed(gear, made) if made.keyway_width else _circle(0.0, 0.0, made.bore / 2, math.pi)
        yield CutPath("BORE", contour, _lead(contour, length, -1.0))


def _keyed(gear: Gear, made: Body) -> Floats:
    """Return the path of a bore with keyway: round the edges of the bore, and sharp in the corners of the floor."""
    step = (gear.body.bore - made.bore) / 2
    radius, half, end = made.bore / 2, gear.body.keyway_width / 2, keyway_half_angle(gear.body)
    edge = gear.body.bore / 2 * math.cos(end)
    floor = gear.body.bore / 2 + gear.body.keyway_depth - step
    arc, round_edge = math.tan((math.pi - end) / 4), -math.tan((math.pi / 2 - end) / 4)
    x, y = radius * math.cos(end), radius * math.sin(end)
    return np.array(
        [
            (-radius, 0.0, arc),
            (x, -y, round_edge),
            (edge, -half + step, 0.0),
            (floor, -half + step, 0.0),
            (floor, half - step, 0.0),
            (edge, half - step, round_edge),
            (x, y, arc),
        ]
    )


def _ring_paths(gear: Gear, made: Body, length: float) -> Iterator[CutPath]:
    if made.rim_diameter is not None:
        contour = _circle(0.0, 0.0, made.rim_diameter / 2, 0.0)
        yield CutPath("RIM", contour, _lead(contour, length, 1.0))
    for k in range(made.bolt_holes):
        angle = 2 * math.pi * k / made.bolt_holes
        x, y = made.bolt_circle / 2 * math.cos(angle), made.bolt_circle / 2 * math.sin(angle)
        radius = made.bolt_diameter / 2
        contour = _circle(x, y, radius, angle)
        reach = max(radius - length, 0.0)
        start = (x + reach * math.cos(angle), y + reach * math.sin(angle))
        yield CutPath("BOLTS", contour, np.array([start, contour[0, :2]]))


def write_path_dxf(gear: Gear, path: Path | str) -> None:
    """Write the paths of a wire or beam as DXF (R2010, mm): see `cut_paths`.

    Each is a closed polyline of arcs, leads are lines.

    The leads are on the layer LEAD. The header states how far the drawing reaches. Equal input gives equal bytes.
    """
    paths = cut_paths(gear)
    with drawing(path, {**(_RING_LAYERS if gear.internal else _LAYERS), LEAD: NOT_CUT}) as document:
        space = document.modelspace()
        for each in paths:
            space.add_lwpolyline(each.contour.tolist(), format="xyb", close=True, dxfattribs={"layer": each.layer})
            space.add_line(*each.lead.tolist(), dxfattribs={"layer": LEAD})
        extents = [extent_of(each.contour) for each in paths]
        ends = np.concatenate([np.stack(each) for each in extents] + [each.lead for each in paths])
        space.reset_extents((*ends.min(axis=0), 0.0), (*ends.max(axis=0), 0.0))
