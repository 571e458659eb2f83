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
from gearcad.geometry import Gear, GearPair, Rack, RackPair, SplineJoint
from gearcad.geometry.curves import Involute
from gearcad.geometry.gear_data import section_turn
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel

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
    """Two parts in mesh, or a shaft and the hub on it, by their names as products."""

    pair: GearPair | RackPair | SplineJoint
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
        told = _play(mesh.pair)
        every = np.array([_gaps(mesh.pair, one, two, sections) for one, two in found])
        overlap = -float(every[..., 0, :].min())
        permitted = _OVERLAP + rounding + max(-told / 2, 0.0)
        yield of_mesh.holds("teeth do not overlap", overlap <= permitted, place=f"by {overlap * 1e3:.4g} µm")
        backlash = every[..., 1, :].sum(axis=-1).ravel()
        worst = float(max(backlash, key=lambda value: abs(value - told)))
        yield of_mesh.near("circumferential backlash", told, worst, _BACKLASH + 2 * rounding, "mm")


def _in_mesh(pair: GearPair | SplineJoint, one: PlacedPart, two: PlacedPart) -> bool:
    """Return whether the axes of two gears are as far apart as those of the pair, and their teeth at the same height."""
    apart = math.dist(one.offset[:2], two.offset[:2])
    first, mate = _parts(pair)
    low = max(float(one.offset[2]), float(two.offset[2]))
    high = min(float(one.offset[2]) + first.face_width, float(two.offset[2]) + mate.face_width)
    axes = 0.0 if isinstance(pair, SplineJoint) else abs(pair.centre_distance)
    return abs(apart - axes) < _APART and low < high


def _parts(pair: GearPair | RackPair | SplineJoint) -> tuple[Gear, Gear | Rack]:
    """Return pinion and mate, or shaft and hub."""
    if isinstance(pair, SplineJoint):
        return pair.parts["shaft"].gear, pair.parts["hub"].gear
    return pair.pinion, pair.wheel if isinstance(pair, GearPair) else pair.rack


def _play(pair: GearPair | RackPair | SplineJoint) -> float:
    """Return the circumferential backlash, or the play of the solids of a spline (mm)."""
    return pair.built_play or 0.0 if isinstance(pair, SplineJoint) else pair.circumferential_backlash


def _circle(pair: GearPair | SplineJoint) -> float:
    """Return the diameter (mm) of the mate's working circle, of a hub that of the reference circle."""
    return pair.reference_diameter if isinstance(pair, SplineJoint) else abs(pair.working_pitch_diameters.wheel)


def _gaps(pair: GearPair | RackPair | SplineJoint, one: PlacedPart, two: PlacedPart, sections: int) -> Floats:
    """Gaps (sections, 2, 2) in mm at the working circle, at heights of the common width, on both sides of the mate's teeth.

    First those of the whole outlines, then those of the flanks alone. The circle of a spline is its reference circle.
    """
    first, mate = _parts(pair)
    low = max(float(one.offset[2]), float(two.offset[2]))
    high = min(float(one.offset[2]) + first.face_width, float(two.offset[2]) + mate.face_width)
    heights = low + (high - low) * (np.arange(sections) + 0.5) / sections
    outline, flank = _outline(first)
    gaps = []
    for z in heights:
        points = _section(first, outline, one, float(z))
        if isinstance(pair, RackPair):
            gaps.append(_rack_gaps(pair, points, flank, two, float(z)))
        elif isinstance(mate, Gear):
            circle = _circle(pair)
            gaps.append(_gear_gaps(mate, points, flank, two, float(z)) * circle / 2)
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


def _gear_gaps(wheel: Gear, points: Floats, flank: Bools, mate: PlacedPart, z: float) -> Floats:
    """Gaps (2, 2) as angles (rad) on both sides of the teeth of a placed wheel or hub, negative where teeth overlap."""
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
    return _least(clear, angle > 0, flank)


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


_PLAYS = {
    "effective play, least": ("effective_play_min", "effective_limit"),
    "effective play, greatest": ("effective_play_max", "effective_other"),
    "actual play, least": ("actual_play_min", "actual_limit"),
    "actual play, greatest": ("actual_play_max", "actual_other"),
}
"""Plays of a spline by their keys, and the limit of shaft and hub between which each of them is."""


_ANGLE = 1e-5
"""Difference of the backlash angle (degrees) that is permitted."""


def judge_joint(joint: SplineJoint, where: str) -> Iterator[Claim]:
    """Judge the plays of a spline: the outlines of shaft and hub at their limits are turned until they touch."""
    judge = Judge(ClaimSubject.GEOMETRY, VerificationLevel.FILES, where, OUTLINES)
    shaft, hub = joint.parts["shaft"], joint.parts["hub"]
    turned = PlacedPart("hub", _turned_place(math.radians(joint.hub_rotation)))
    for words, (key, limit) in _PLAYS.items():
        told, thickness, space = getattr(joint, key), getattr(shaft, limit), getattr(hub, limit)
        if told is None:
            yield judge.not_judged(words, "the tolerances are not known")
            continue
        outline, flank = _outline(shaft.gear_of(thickness))
        gaps = _gear_gaps(hub.gear_of(space), outline, flank, turned, 0.0) * joint.reference_diameter / 2
        yield judge.near(words, told, float(gaps[1].sum()), _BACKLASH, "mm")
    outline, flank = _outline(shaft.gear)
    angle = math.degrees(float(_gear_gaps(hub.gear, outline, flank, turned, 0.0)[1].sum()))
    yield judge.near("backlash angle", joint.backlash_angle or 0.0, angle, _ANGLE, "deg")
    yield judge.not_judged("contact ratio, centre distance", "the parts of a spline do not roll on each other")


def _turned_place(angle: float) -> Floats:
    """Return the place (3, 4) of a part that is turned about z by an angle (rad)."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, -sine, 0.0, 0.0], [sine, cosine, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
