"""Judge of assemblies: gears where a file has placed them must not overlap, and have the backlash that is told.

The outline of one gear, as points, is brought to the frame of its mate and held against the exact thickness of its teeth: how
far can the mate turn until the flanks touch? No boolean operation is needed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from gearcad.core.records import Bools, Floats
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.curves import Involute
from gearcad.geometry.gear_data import section_turn
from gearcad.verification.claims import Claim, Judge

OUTLINES = "exact outlines"
"""Name of the judge."""

_POINTS = 1000
"""Points on each curve of the outline that is brought to the mate."""

_OVERLAP = 1e-6
"""Overlap (mm at the working circle) that is permitted beside the rounding of a file."""

_BACKLASH = 1e-5
"""Difference of the backlash (mm) that is permitted beside the rounding of a file."""

_APART = 1e-4
"""Difference (mm) of the distance of axes at which two gears are those of a mesh."""


@dataclass(frozen=True)
class PlacedPart:
    """A part where a file has it: its name as a product, and its place (3, 4) in mm."""

    product: str
    place: Floats

    @property
    def rotation(self) -> float:
        """Angle (rad) by which it is turned about z."""
        return math.atan2(float(self.place[1, 0]), float(self.place[0, 0]))

    @property
    def offset(self) -> Floats:
        """Position (3,) in mm of its own origin."""
        return self.place[:, 3]


@dataclass(frozen=True)
class PlacedMesh:
    """Two parts in mesh, by their names as products."""

    pair: GearPair | RackPair
    pinion: str
    mate: str


def judge_places(
    judge: Judge, meshes: Sequence[PlacedMesh], placed: Sequence[PlacedPart], sections: int = 3, rounding: float = 1e-9
) -> Iterator[Claim]:
    """Judge the places of gears in mesh at several sections; `rounding` (mm) is that of the coordinates in the file."""
    for mesh in meshes:
        pinions = [part for part in placed if part.product == mesh.pinion]
        mates = [part for part in placed if part.product == mesh.mate]
        found = [
            (one, two) for one in pinions for two in mates if isinstance(mesh.pair, RackPair) or _in_mesh(mesh.pair, one, two)
        ]
        of_mesh = Judge(judge.subject, judge.level, f"{judge.where}: {mesh.pinion} and {mesh.mate}", judge.name)
        yield of_mesh.equal("gears in mesh", max(len(pinions), len(mates)), len(found))
        if not found:
            continue
        told = mesh.pair.circumferential_backlash
        every = np.array([_gaps(mesh.pair, one, two, sections) for one, two in found])
        overlap = -float(every[..., 0, :].min())
        permitted = _OVERLAP + rounding + max(-told / 2, 0.0)
        yield of_mesh.holds("teeth do not overlap", overlap <= permitted, place=f"by {overlap * 1e3:.4g} µm")
        backlash = every[..., 1, :].sum(axis=-1).ravel()
        worst = float(max(backlash, key=lambda value: abs(value - told)))
        yield of_mesh.near("circumferential backlash", told, worst, _BACKLASH + 2 * rounding, "mm")


def _in_mesh(pair: GearPair, one: PlacedPart, two: PlacedPart) -> bool:
    """Return whether the axes of two gears are as far apart as those of the pair, and their teeth at the same height."""
    apart = math.dist(one.offset[:2], two.offset[:2])
    low = max(float(one.offset[2]), float(two.offset[2]))
    high = min(float(one.offset[2]) + pair.pinion.face_width, float(two.offset[2]) + pair.wheel.face_width)
    return abs(apart - abs(pair.centre_distance)) < _APART and low < high


def _gaps(pair: GearPair | RackPair, one: PlacedPart, two: PlacedPart, sections: int) -> Floats:
    """Gaps (sections, 2, 2) in mm at the working circle, at heights of the common width, on both sides of the mate's teeth.

    First those of the whole outlines, then those of the flanks alone.
    """
    mate = pair.wheel if isinstance(pair, GearPair) else pair.rack
    low = max(float(one.offset[2]), float(two.offset[2]))
    high = min(float(one.offset[2]) + pair.pinion.face_width, float(two.offset[2]) + mate.face_width)
    heights = low + (high - low) * (np.arange(sections) + 0.5) / sections
    outline, flank = _outline(pair.pinion)
    gaps = []
    for z in heights:
        points = _section(pair.pinion, outline, one, float(z))
        if isinstance(pair, GearPair):
            gaps.append(_gear_gaps(pair, points, flank, two, float(z)))
        else:
            gaps.append(_rack_gaps(pair, points, flank, two, float(z)))
    return np.array(gaps)


def _outline(gear: Gear) -> tuple[Floats, Bools]:
    """Outline (n, 2) of all teeth in mm, unturned, and which of its points (n,) are on flanks."""
    s = np.linspace(0.0, 1.0, _POINTS)
    half = np.concatenate([curve.points(s) for curve in gear.profile.curves])
    flank = np.concatenate([np.full(_POINTS, isinstance(curve, Involute)) for curve in gear.profile.curves])
    x, y = np.concatenate([half, half * [1.0, -1.0]]).T
    turns = 2 * math.pi * np.arange(gear.tooth_count) / gear.tooth_count
    cosine, sine = np.cos(turns)[:, None], np.sin(turns)[:, None]
    points = np.stack([x * cosine - y * sine, x * sine + y * cosine], -1).reshape(-1, 2)
    return points, np.tile(flank, 2 * gear.tooth_count)


def _turned(points: Floats, angle: float) -> Floats:
    cosine, sine = math.cos(angle), math.sin(angle)
    turned: Floats = points @ np.array([[cosine, sine], [-sine, cosine]])
    return turned


def _helix(gear: Gear, z: float) -> float:
    """Angle (rad) by which the section of a gear at its own height z (mm) is turned."""
    return float(section_turn(gear, np.array([z]))[0])


def _section(gear: Gear, outline: Floats, part: PlacedPart, z: float) -> Floats:
    """Outline of a placed gear (n, 2) at a height z (mm) of the file."""
    turn = part.rotation + _helix(gear, z - float(part.offset[2]))
    return _turned(outline, turn) + part.offset[:2]


def _gear_gaps(pair: GearPair, points: Floats, flank: Bools, mate: PlacedPart, z: float) -> Floats:
    """Gaps (2, 2) in mm at the working circle on both sides of the mate's teeth, negative where teeth overlap."""
    wheel = pair.wheel
    turn = mate.rotation + _helix(wheel, z - float(mate.offset[2]))
    own = _turned(points - mate.offset[:2], -turn)
    radius, angle = np.hypot(*own.T), np.arctan2(own[:, 1], own[:, 0])
    profile, form = wheel.profile, abs(wheel.form_diameter) / 2
    low, high = sorted((profile.root_diameter / 2, profile.tip_diameter / 2))
    inside = (radius > low) & (radius < high)
    radius, angle, flank = radius[inside], angle[inside], flank[inside]
    flank &= (radius < form) if wheel.internal else (radius > form)
    pitch = 2 * math.pi / wheel.tooth_count
    angle = angle - pitch * np.rint(angle / pitch)
    clear = np.abs(angle) - np.radians(wheel.profile.half_angle(radius))
    return _least(clear, angle > 0, flank) * abs(pair.working_pitch_diameters.wheel) / 2


def _rack_gaps(pair: RackPair, points: Floats, flank: Bools, mate: PlacedPart, z: float) -> Floats:
    """Gaps (2, 2) in mm along the rack on both sides of its teeth, negative where teeth overlap."""
    rack = pair.rack
    own = _turned(points - mate.offset[:2], -mate.rotation)
    height = own[:, 1]
    along = own[:, 0] - rack.transverse_pitch / 2 + (z - float(mate.offset[2])) * math.tan(math.radians(rack.helix_angle))
    inside = (height > -rack.root_depth) & (height < rack.tip_height)
    height, along = height[inside], along[inside]
    along = along - rack.transverse_pitch * np.rint(along / rack.transverse_pitch)
    clear = np.abs(along) - rack.profile.half_thickness(height)
    return _least(clear, along > 0, flank[inside] & (height > -rack.profile.form_depth))


def _least(clear: Floats, left: Bools, flank: Bools) -> Floats:
    """Least clearances (2, 2): of all points and of those on flanks, on the left and on the right side of teeth."""
    every = np.ones_like(flank)
    return np.array([[clear[of & side].min(initial=np.inf) for side in (left, ~left)] for of in (every, flank)])
