"""Judge of drawings: DXF files read and audited by ezdxf, contours held against the exact section."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from gearcad.core.records import Floats
from gearcad.geometry import Gear, Rack
from gearcad.geometry.gear_data import section_turn
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel
from gearcad.verification.exact_parts import ExactPart

_ACCURACY = 0.0005
"""Distance (mm) that arcs of a contour may be off the exact section."""

_SLACK = 1e-6
"""Distance (mm) that is permitted beside it, for the digits of the file."""

_PROFILE, _BORE = "PROFILE", "BORE"
"""Layers of the toothed contour, and of that of a splined bore."""

_ON_ARC = (np.arange(6) + 0.5) / 6
"""Places on each arc that are looked at, as shares of it."""


def read_dxf(path: Path, judge: Judge) -> tuple[Any, list[Claim]]:
    """Return the drawing in a file, None if it cannot be read, and the claims that it is read without faults, in mm."""
    import ezdxf

    try:
        document = ezdxf.readfile(path)
        errors = document.audit().errors
    except Exception as error:  # a reader may raise anything for a broken file
        return None, [judge.holds("is read", False, place=f"{type(error).__name__}: {error}")]
    faults = "; ".join(each.message for each in errors[:3])
    audit = judge.equal("faults of the audit", 0, len(errors), place=faults)
    return document, [audit, judge.equal("unit ($INSUNITS, 4 is mm)", 4, int(document.header.get("$INSUNITS", 0)))]


def judge_section(path: Path, part: ExactPart) -> Iterator[Claim]:
    """Judge the section of a gear or a rack: readable, one closed contour, on the exact section, with all its teeth."""
    judge = Judge(ClaimSubject.DXF, VerificationLevel.FILES, path.name, "ezdxf")
    document, claims = read_dxf(path, judge)
    yield from claims
    if document is None:
        return
    contours = [each for each in document.modelspace().query("LWPOLYLINE") if each.dxf.layer == _PROFILE]
    yield judge.equal("toothed contours", 1, len(contours))
    for contour in contours[:1]:
        yield from _judge_contour(judge, contour, part)
    if part.bore is not None:
        bores = [each for each in document.modelspace().query("LWPOLYLINE") if each.dxf.layer == _BORE]
        of_bore = Judge(judge.subject, judge.level, f"{path.name}: {_BORE}", judge.name)
        yield of_bore.equal("toothed contours", 1, len(bores))
        for contour in bores[:1]:
            yield from _judge_contour(of_bore, contour, part.bore)


def judge_sections(path: Path, counts: Mapping[str, int]) -> Iterator[Claim]:
    """Judge the sections of parts in mesh: closed contours on each layer, as many as those of its name have."""
    judge = Judge(ClaimSubject.DXF, VerificationLevel.FILES, path.name, "ezdxf")
    document, claims = read_dxf(path, judge)
    yield from claims
    if document is None:
        return
    every = list(document.modelspace().query("LWPOLYLINE"))
    found = {layer: [each for each in every if each.dxf.layer == layer] for layer in counts}
    for layer, count in counts.items():
        of_layer = Judge(judge.subject, judge.level, f"{path.name}: {layer}", judge.name)
        yield of_layer.equal("contours", count, len(found[layer]))
        yield of_layer.holds("contours are closed", all(each.closed for each in found[layer]))


def _judge_contour(judge: Judge, contour: Any, part: ExactPart) -> Iterator[Claim]:
    """Judge one contour: closed, its points on the exact section, its teeth."""
    yield judge.holds("contour is closed", bool(contour.closed))
    points = _on_arcs(np.array(contour.get_points("xyb"), float))
    surface, in_space = part.surface, _in_space(part.part, points)
    apart = surface.distances(in_space)
    if part.gear is None:
        apart = apart[:-2]  # without the planes of its end faces
    off = apart.min(axis=0)
    x, y = points[int(off.argmax())]
    permitted, place = _ACCURACY + _SLACK, f"at x {x:.4g}, y {y:.4g} mm"
    yield judge.below("distance of the contour from the exact section", 1e3 * off.max(), 1e3 * permitted, "µm", place=place)
    on_flanks = apart[surface.flanks].min(axis=0) <= permitted
    teeth = set(surface.teeth(in_space[on_flanks]).tolist())
    yield judge.equal("number of teeth", part.teeth, len(teeth.intersection(range(part.teeth))))


def _in_space(part: Gear | Rack, points: Floats) -> Floats:
    """Return the points (n, 2) of a section as points (n, 3) of the part: at mid face width, or on the end face of a rack.

    In the file the section of a gear is not turned.
    """
    if isinstance(part, Rack):
        return np.column_stack([points, np.zeros(len(points))])
    z = part.half_width / 2
    turn = float(section_turn(part, np.array([z]))[0])
    cosine, sine = math.cos(turn), math.sin(turn)
    return np.column_stack([points @ np.array([[cosine, sine], [-sine, cosine]]), np.full(len(points), z)])


def _on_arcs(vertices: Floats) -> Floats:
    """Points (n, 2) on the arcs of a closed polyline, vertices (m, 3): x, y, and the bulge to the next."""
    start, end, bulge = vertices[:, :2], np.roll(vertices[:, :2], -1, axis=0), vertices[:, 2]
    chord = end - start
    # tan of a quarter of the angle; at the share t of the arc: x along the chord, y to its right for a positive bulge.
    quarter = np.arctan(bulge)[:, None]
    t = _ON_ARC[None, :]
    straight = np.abs(bulge) < 1e-12
    safe = np.where(straight[:, None], 1.0, quarter)
    along = np.where(straight[:, None], t, np.sin(4 * safe * t / 2) * np.cos(2 * safe * (1 - t)) / np.sin(2 * safe))
    across = np.where(straight[:, None], 0.0, np.sin(2 * safe * t) * np.sin(2 * safe * (1 - t)) / np.sin(2 * safe))
    right = np.stack([chord[:, 1], -chord[:, 0]], -1)
    points: Floats = start[:, None] + along[..., None] * chord[:, None] + across[..., None] * right[:, None]
    return np.concatenate([points.reshape(-1, 2), start])
