"""Exact figures of a gear or a rack: surface, volume, inertia, and area by quadrature over its profile."""

from __future__ import annotations

import hashlib
import math
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import leggauss

from gearcad.core.records import Floats
from gearcad.geometry import Gear, Rack
from gearcad.geometry.bore_teeth import bore_teeth
from gearcad.geometry.gear import FlankCurve, flank_curves
from gearcad.geometry.gear_data import twist
from gearcad.solids.body_plan import keyway_half_angle
from gearcad.solids.exact.inertia import Moments, moments
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.exact.solid import gear_boundary
from gearcad.verification.surfaces import ExactSurface, surface_of

_PLACES, _WEIGHTS = leggauss(24)

_STEP = 1e-5
"""Step of a curve's parameter over which derivatives are taken."""


class ExactPart:
    """A gear or a rack, and what files of it are held against; each is found once, at its first use."""

    def __init__(self, part: Gear | Rack) -> None:
        self.part = part
        self._distances: dict[bytes, Floats] = {}

    @property
    def gear(self) -> Gear | None:
        """The part if it is a gear."""
        return None if isinstance(self.part, Rack) else self.part

    @property
    def teeth(self) -> int:
        """Number of whole teeth."""
        return int(self.part.teeth or 0) if isinstance(self.part, Rack) else self.part.tooth_count

    @cached_property
    def surface(self) -> ExactSurface:
        """The exact surface."""
        return surface_of(self.part)

    @cached_property
    def bore(self) -> ExactPart | None:
        """The teeth of a splined bore, which begin at z = 0 of their own; None of another part."""
        teeth = None if self.gear is None else bore_teeth(self.gear)
        return None if teeth is None else ExactPart(teeth)

    @cached_property
    def moments(self) -> Moments:
        """Volume (mm³) and polar moment (mm⁵) of the exact solid."""
        return moments(rack_boundary(self.part) if isinstance(self.part, Rack) else gear_boundary(self.part))

    @cached_property
    def area(self) -> float | None:
        """Exact area (mm²) of the whole surface, None for a gear with end chamfers."""
        return surface_area(self.part)

    @property
    def euler_number(self) -> int:
        """Euler number of the surface: 2, less 2 for each hole through the part."""
        if isinstance(self.part, Rack):
            return 2
        body = self.part.body
        return 2 - 2 * (1 + body.bolt_holes if self.part.internal else int(body.bore > 0))

    def distances(self, points: Floats) -> Floats:
        """Return the distances (k, n) in mm of points (n, 3) from each of the k surfaces; equal points are looked at once."""
        key = hashlib.sha256(np.ascontiguousarray(points).tobytes()).digest()
        if key not in self._distances:
            self._distances = {key: self.surface.distances(points)}
        return self._distances[key]


def surface_area(part: Gear | Rack) -> float | None:
    """Return the exact area (mm²) of a part's whole surface, None for a gear with end chamfers."""
    if isinstance(part, Rack):
        return _rack_area(part)
    return None if part.body.end_chamfer else _gear_area(part)


def _rack_area(rack: Rack) -> float:
    """Area (mm²) of a rack: teeth along their slanted length, both sides, both ends, and the back."""
    cosine = math.cos(math.radians(rack.helix_angle))
    length = rack.length
    outline = 0.0
    for curve in rack.profile.curves:  # of half a tooth, in the normal section
        s = (1 + _PLACES) / 2
        low, high = np.maximum(s - _STEP, 0), np.minimum(s + _STEP, 1)
        step = (curve.points(high) - curve.points(low)) * [cosine, 1.0]
        outline += float(np.hypot(*step.T) / (high - low) @ _WEIGHTS) / 2
    teeth = 2 * outline * int(rack.teeth or 0) * rack.face_width / cosine
    ends = 2 * _rack_section(rack)
    return teeth + ends + length * rack.face_width + _rack_sides(rack)


def _rack_section(rack: Rack) -> float:
    """Area (mm²) of an end face of a rack, which has whole teeth."""
    area = 0.0
    for curve in rack.profile.curves:
        s = (1 + _PLACES) / 2
        low, high = np.maximum(s - _STEP, 0), np.minimum(s + _STEP, 1)
        speed = (curve.points(high) - curve.points(low))[:, 0] / (high - low)
        area += float((curve.points(s)[:, 1] + rack.height) * speed @ _WEIGHTS) / 2
    return 2 * area * int(rack.teeth or 0)


def _rack_sides(rack: Rack) -> float:
    """Area (mm²) of both sides across the length: the height of the outline over the face width, from z = 0 to it."""
    slope, pitch = math.tan(math.radians(rack.helix_angle)), rack.transverse_pitch
    if abs(slope) < 1e-12:
        return 2 * rack.face_width * (float(rack.profile.curves[0].points(0.0)[1]) + rack.height)
    # Along the side the outline passes as it does along the rack, compressed by the slope.
    run = rack.face_width * abs(slope)
    return 2 * (_under_outline(rack, run) / abs(slope) if run % pitch or run else 0.0)


def _under_outline(rack: Rack, run: float) -> float:
    """Area (mm²) over the back between the middle of a space and `run` (mm) further along the rack."""
    pitch = rack.transverse_pitch
    whole, rest = divmod(run, pitch)
    full = _rack_section(rack) / int(rack.teeth or 1)
    part = min(rest, pitch - rest)
    below = _half_under(rack, part)
    return whole * full + (below if rest <= pitch / 2 else full - below)


def _half_under(rack: Rack, run: float) -> float:
    """Area (mm²) over the back between the middle of a space and `run` (mm, at most half a pitch) further."""
    area, start = 0.0, -rack.transverse_pitch / 2
    for curve in rack.profile.curves:
        first, last = (float(curve.points(end)[0]) - start for end in (0.0, 1.0))
        if first >= run:
            break
        end = 1.0 if last <= run else _crossing(lambda s, curve=curve: float(curve.points(s)[0]) - start - run)
        s = end * (1 + _PLACES) / 2
        low, high = np.maximum(s - _STEP, 0), np.minimum(s + _STEP, 1)
        speed = (curve.points(high) - curve.points(low))[:, 0] / (high - low)
        area += end * float((curve.points(s)[:, 1] + rack.height) * speed @ _WEIGHTS) / 2
    return area


def _crossing(function: object) -> float:
    """Return the parameter in [0, 1] at which a rising function is 0."""
    from scipy.optimize import brentq

    return float(brentq(function, 0.0, 1.0, xtol=1e-14))


def _gear_area(gear: Gear) -> float:
    """Area (mm²) of a gear without end chamfers: flanks, lands, ends, and the body."""
    halves = 2 if gear.double_helix.present else 1
    sides = sum(_tooth_area(gear, *heights) for heights in _stretches(gear))
    body, width = gear.body, gear.face_width
    ends = [_section(gear, z) for z in (0.0, gear.half_width)]
    area = gear.tooth_count * halves * sides
    if gear.double_helix.gap_width:
        gap = gear.gap_diameter / 2
        area += 2 * (ends[1] - math.pi * gap**2) + 2 * math.pi * gap * gear.double_helix.gap_width
    faces = 2 * (ends[0] if gear.double_helix.present else (ends[0] + ends[1]) / 2)
    if gear.internal:
        rim = (body.rim_diameter or 0.0) / 2
        holes = body.bolt_holes * math.pi * body.bolt_diameter
        area += 2 * math.pi * rim**2 - faces + 2 * math.pi * rim * width
        return area + holes * width - 2 * holes * body.bolt_diameter / 4
    back, front = body.hub_ends
    area += faces + math.pi * body.hub_diameter * (back + front)
    if body.bore:
        around, opening = _opening(gear)
        area += around * (width + back + front) - 2 * opening
    return area


def _opening(gear: Gear) -> tuple[float, float]:
    """Length (mm) around the bore with its keyway or its teeth, and its area (mm²)."""
    body, radius = gear.body, gear.body.bore / 2
    if (teeth := bore_teeth(gear)) is not None:
        return teeth.tooth_count * _tooth_area(teeth, 0.0, teeth.face_width) / teeth.face_width, _section(teeth, 0.0)
    if not body.keyway_width:
        return 2 * math.pi * radius, math.pi * radius**2
    half, angle = body.keyway_width / 2, keyway_half_angle(body)
    mouth, floor = math.sqrt(radius**2 - half**2), radius + body.keyway_depth
    segment = radius**2 * angle - half * mouth
    around = 2 * radius * (math.pi - angle) + 2 * (floor - mouth) + body.keyway_width
    return around, math.pi * radius**2 + body.keyway_width * (floor - mouth) - segment


def _stretches(gear: Gear) -> list[tuple[float, float]]:
    """Stretches of the width of one hand over which the flanks are smooth (mm)."""
    breaks = gear.flank_form.height_breaks if gear.modification.present else ()
    return list(pairwise(sorted({0.0, *breaks, gear.half_width / 2, gear.half_width})))


def _angles(gear: Gear, piece: FlankCurve, s: Floats, z: Floats, *, left: bool) -> tuple[Floats, Floats]:
    """Radii (mm) and angles (rad) of a piece of the left or right flank, at s and heights z, which broadcast."""
    radius, angle = piece.curve.polar(s)
    sense = 1 if left else -1
    turned = sense * angle + piece.turn(gear.flank_form, s, z, left=left)
    return np.broadcast_arrays(radius, turned + twist(gear) * z)[0], turned + twist(gear) * z


def _tooth_area(gear: Gear, low: float, high: float) -> float:
    """Area (mm²) of flanks, fillets, chamfers and lands of one tooth and space between two heights (mm)."""
    pieces = flank_curves(gear)
    z = (low + high) / 2 + (high - low) / 2 * _PLACES
    area = 0.0
    for left in (True, False):
        for piece in pieces:
            area += _piece_area(gear, piece, z, (high - low) / 2 * _WEIGHTS, left=left)
    for piece, s, tip in ((pieces[-1], 1.0, True), (pieces[0], 0.0, False)):
        radius, first = _angles(gear, piece, np.array(s), z, left=True)
        _, last = _angles(gear, piece, np.array(s), z, left=False)
        width = first - last if tip else 2 * math.pi / gear.tooth_count - (first - last)
        area += float((radius * width) @ ((high - low) / 2 * _WEIGHTS))
    return area


def _piece_area(gear: Gear, piece: FlankCurve, z: Floats, weights: Floats, *, left: bool) -> float:
    """Area (mm²) of a piece of a flank at heights z (n,), whose weights (n,) are in mm."""
    # A fillet of a rack begins with the square of its parameter: more places near both ends do no harm elsewhere.
    s = np.sin(np.pi / 4 * (1 + _PLACES)) ** 2
    share = _WEIGHTS * np.pi / 4 * np.sin(np.pi / 2 * (1 + _PLACES))
    low, high = np.maximum(s - _STEP, 0.0), np.minimum(s + _STEP, 1.0)
    heights = z[None, :]

    def at(s: Floats, heights: Floats) -> Floats:
        radius, angle = _angles(gear, piece, s[:, None], heights, left=left)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.broadcast_to(heights, angle.shape)], -1)

    along = (at(high, heights) - at(low, heights)) / (high - low)[:, None, None]
    up = (at(s, heights + _STEP) - at(s, heights - _STEP)) / (2 * _STEP)
    return float(share @ np.linalg.norm(np.cross(along, up), axis=-1) @ weights)


def toothed_size(gear: Gear, teeth: int, end_radius: float, *, solid: bool) -> float:
    """Return the volume (mm³) of so many teeth with their share of the body, up to `end_radius` (mm), which has no ends.

    If not `solid`, it is the area (mm²) of the section in the middle of a half's face width.
    """

    def share(z: float) -> float:
        area = _section(gear, z) - math.pi * end_radius**2
        return (-area if gear.internal else area) * teeth / gear.tooth_count

    if not solid:
        return share(gear.half_width / 2)
    volume = 0.0
    for low, high in _stretches(gear):
        places, weights = (low + high) / 2 + (high - low) / 2 * _PLACES, (high - low) / 2 * _WEIGHTS
        volume += sum(weight * share(z) for z, weight in zip(places.tolist(), weights.tolist(), strict=True))
    return volume * (2 if gear.double_helix.present else 1)


def _section(gear: Gear, z: float) -> float:
    """Area (mm²) of the section at a height (mm), down to the axis, by the integral of r² dphi/2 around it."""
    area, pieces = 0.0, flank_curves(gear)
    s = np.sin(np.pi / 4 * (1 + _PLACES)) ** 2
    share = _WEIGHTS * np.pi / 4 * np.sin(np.pi / 2 * (1 + _PLACES))
    low, high = np.maximum(s - _STEP, 0.0), np.minimum(s + _STEP, 1.0)
    height = np.array(z)
    for left in (True, False):
        for piece in pieces:
            radius, _ = _angles(gear, piece, s, height, left=left)
            turned = [_angles(gear, piece, ends, height, left=left)[1] for ends in (low, high)]
            area += (-1 if left else 1) * float(radius**2 / 2 * (turned[1] - turned[0]) / (high - low) @ share)
    for piece, end, tip in ((pieces[-1], 1.0, True), (pieces[0], 0.0, False)):
        radius, first = _angles(gear, piece, np.array(end), height, left=True)
        _, last = _angles(gear, piece, np.array(end), height, left=False)
        width = first - last if tip else 2 * math.pi / gear.tooth_count - (first - last)
        area += float(radius**2 / 2 * width)
    return gear.tooth_count * area
