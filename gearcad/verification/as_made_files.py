"""Judges of files of gears as they are made: solids of moulds and prints by volume, paths of wire and laser by their area.

The exact figures are integrals over the made outline, which know nothing of solids or arcs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from gearcad.core.dxf import ezdxf
from gearcad.core.records import Floats
from gearcad.geometry import Body, Gear
from gearcad.geometry.gear import AsMadeGear
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel

_VOLUME = 1e-7
"""Largest relative difference of a volume: spans of the solid are within 1 nm."""

_ENDS, _TANGENTS = 1e-9, 1e-6
"""Largest gap (mm) between arcs of a path, and largest angle (degrees) between them where the path is smooth."""

_PLACES = 2049


def judge_made(path: Path, gear: Gear) -> Iterator[Claim]:
    """Judge the file of a gear as it is made: a solid as STEP, or the path of a wire or beam as DXF."""
    made = gear.as_made
    assert isinstance(made, AsMadeGear)
    yield from _judge_path(path, gear, made) if gear.making.cuts else _judge_solid(path, made)


def _judge_solid(path: Path, made: AsMadeGear) -> Iterator[Claim]:
    from cadquery import importers
    from OCP.BRepCheck import BRepCheck_Analyzer

    judge = Judge(ClaimSubject.STEP, VerificationLevel.FILES, path.name, "Open CASCADE")
    solids = importers.importStep(str(path)).solids().vals()
    yield judge.equal("solids", 1, len(solids))
    for solid in solids[:1]:
        yield judge.holds("is valid (BRepCheck)", bool(BRepCheck_Analyzer(solid.wrapped).IsValid()))
        if (volume := made_volume(made)) is None:
            yield judge.not_judged("volume", "an end chamfer: the integral over the outline is of plane ends")
        else:
            yield judge.near("volume", volume, solid.Volume(), _VOLUME, relative=True)


def made_volume(made: AsMadeGear) -> float | None:
    """Return the volume (mm³) of a gear as it is made, by its sections; None with end chamfers or halves."""
    body, height = made.body, made.first_layer
    if body.end_chamfer or made.double_helix.present or (made.internal and body.rim_diameter is None):
        return None
    foot = _section(made.foot) * height if height else 0.0
    hubs = sum(body.hub_ends) * (math.pi * body.hub_diameter**2 / 4 - _hole(body)) if body.hub_diameter else 0.0
    return foot + _section(made) * (made.face_width - height) + hubs


def _section(made: AsMadeGear) -> float:
    """Return the area (mm²) of the section of the teeth and the body."""
    teeth, body = _enclosed(made), made.body
    if not made.internal:
        return teeth - _hole(body)
    bolts = body.bolt_holes * body.bolt_diameter**2
    return math.pi / 4 * (float(body.rim_diameter or 0.0) ** 2 - bolts) - teeth


def _enclosed(made: AsMadeGear) -> float:
    """Return the area (mm²) inside the outline of all teeth: of polygons, extrapolated to the curves."""

    def area(step: int) -> float:
        half = 0.0
        for curve in made.profile.curves:
            x, y = curve.points(np.linspace(0.0, 1.0, _PLACES)[::step]).T
            half += abs(float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))) / 2
        return 2 * made.tooth_count * half

    return (4 * area(1) - area(2)) / 3


def _hole(body: Body) -> float:
    """Return the area (mm²) of bore and keyway."""
    radius, half = body.bore / 2, body.keyway_width / 2
    if not half:
        return math.pi * radius**2
    beside = radius**2 * math.asin(half / radius) + half * math.sqrt(radius**2 - half**2)
    return math.pi * radius**2 + 2 * half * (radius + body.keyway_depth) - beside


def _judge_path(path: Path, gear: Gear, made: AsMadeGear) -> Iterator[Claim]:
    judge = Judge(ClaimSubject.DXF, VerificationLevel.FILES, path.name, "ezdxf")
    space = ezdxf().readfile(path).modelspace()
    found = list(space.query('LWPOLYLINE[layer=="PROFILE"]'))
    yield judge.equal("closed contours", 1, len(found))
    for polyline in found[:1]:
        contour = np.array(polyline.get_points("xyb"))
        after = np.roll(contour, -1, axis=0)
        chord = after[:, :2] - contour[:, :2]
        lengths, halves = np.hypot(*chord.T), 2 * np.arctan(contour[:, 2])
        yield judge.holds("is closed", bool(polyline.closed))
        yield judge.below("gap between arcs", _largest_gap(polyline), _ENDS, "mm")
        headings = np.arctan2(chord[:, 1], chord[:, 0])
        turns = np.angle(np.exp(1j * (np.roll(headings - halves, -1) - (headings + halves))))
        yield judge.below("angle between arcs", math.degrees(np.abs(turns).max()), _TANGENTS, "deg")
        area = _area(contour, lengths)
        perimeter = float(np.sum(lengths * np.where(halves == 0, 1.0, halves / np.sin(np.where(halves == 0, 1.0, halves)))))
        yield judge.near("area inside", _enclosed(made), area, gear.making.arc_tolerance * perimeter, "mm²")


def _area(contour: Floats, lengths: Floats) -> float:
    """Return the area (mm²) inside a closed contour of arcs: of its polygon, and of the segments beside that."""
    x, y, bulge = contour.T
    polygon = float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2
    angle = 4 * np.arctan(bulge)
    arcs = np.abs(bulge) > 1e-9
    radius = np.zeros_like(bulge)
    radius[arcs] = lengths[arcs] / (2 * np.sin(np.abs(angle[arcs]) / 2))
    return polygon + float(np.sum(radius**2 / 2 * (angle - np.sin(angle))))


def _largest_gap(polyline: Any) -> float:
    """Return the largest distance (mm) between an end of a line or arc of a path and what follows it."""
    ends = []
    for each in polyline.virtual_entities():
        pair = (each.start_point, each.end_point) if each.dxftype() == "ARC" else (each.dxf.start, each.dxf.end)
        ends.append(np.array([tuple(point)[:2] for point in pair]))
    neighbours = zip(ends, [*ends[1:], ends[0]], strict=True)
    return max(min(float(np.hypot(*(p - q))) for p in one for q in other) for one, other in neighbours)
