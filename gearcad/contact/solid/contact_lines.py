"""The lines along which flanks can touch at a position of the mesh, cell by cell, and the gap there.

In the plane of action a line of contact is straight and lies at the base helix angle. Where it leaves the flanks, the tip
edge of one gear faces the other's flank instead.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.contact.shared.line_of_action import LEAST_LENGTH, LineOfAction
from gearcad.contact.shared.loaded_left import gears_loaded_left
from gearcad.contact.shared.relief_start import onsets, start_distance
from gearcad.contact.solid.places import Places, SolidFlank
from gearcad.geometry import Gear, GearPair
from gearcad.mounting import Mounting
from gearcad.per_gear import PerGear

__all__ = [
    "ContactLine",
    "Gaps",
    "contact_lines",
    "gaps",
    "line_gap",
    "near_path",
    "overlap_of",
    "places_beside",
    "start_distances",
    "turned_back",
]


BEND = 0.05
"""Distance (mm per mm of normal module) over which slope and curvature of a modification are taken."""

_PLACES = 2001
"""On the line of action, at which flanks are looked at."""

_LEAST_BEND = 0.05
"""Share of the exact flanks' curvature that a hollow modification leaves at the least."""


@dataclass(frozen=True)
class ContactLine:
    """One pair of flanks: tooth `tooth` of the pinion (0 is the middle one), cell by cell along the face width.

    `across` (n,) in mm from the middle of the common face width, `nominal` (n,) where the line of contact crosses the line
    of action (mm from T1), `places` on both flanks, `lengths` (n,) of the cells in mm, `aside` (n,) in mm how far beside the
    line of action the flanks are nearest (0 on the line of contact, else an edge touches), `gap` (n,) the transverse gap of the
    exact involutes in mm, `points` (n, 3) on the pinion's flank, `slope` (mm per mm) that of `nominal` over `across`.
    """

    tooth: int
    across: Floats
    nominal: Floats
    places: PerGear[Places]
    lengths: Floats
    aside: Floats
    gap: Floats
    points: Floats
    edge_distance: Floats
    slope: float

    @property
    def middle(self) -> float:
        """Where the line crosses the middle of the common face width (mm from T1)."""
        return float(self.nominal[0] - self.across[0] * self.slope)

    @property
    def on_edge(self) -> Bools:
        """Whether the edge of a tip touches instead of the flank."""
        result: Bools = self.aside != 0
        return result

    @property
    def curvature(self) -> Floats:
        """Curvature (n,) of the gap between the exact flanks in the transverse section (1/mm)."""
        (pinion, _), (wheel, _) = self.places
        return 1 / pinion + 1 / wheel


def contact_lines(
    pair: GearPair, line: LineOfAction, flank: SolidFlank, pinion_length: float, cells: int, farthest_gap: float
) -> tuple[ContactLine, ...]:
    """The lines when the middle pair of teeth touches at `pinion_length` (mm from T1) in the middle of the common face width.

    Cells count where the exact flanks are nearer than `farthest_gap` (mm).
    """
    common, width = pair.common_width, pair.common_width.width
    edges = np.linspace(-width / 2, width / 2, cells + 1)
    slope = math.tan(flank.helix)
    reach = math.ceil((sum(abs(each.last) for each in line.flanks) + width * abs(slope)) / line.pitch)
    pinion_start = pair.pinion.face_width / 2 + common.offset
    wheel_start = pair.wheel.face_width / 2 + common.offset - pair.axial_offset
    middle = (edges[1:] + edges[:-1]) / 2
    found = []
    for tooth in range(-reach, reach + 1):
        start = pinion_length + tooth * line.pitch
        nominal = start + middle * slope
        if not overlap_of(line, nominal).usable.any():
            continue
        usable, (one, other, aside, gap, distance) = _facing(line, nominal)
        here = usable & (gap < farthest_gap)
        if not here.any():
            continue
        _, (at_ends, *_) = _facing(line, start + edges * slope)
        ends = flank.points((at_ends, edges + pinion_start))
        places = PerGear((one[here], middle[here] + pinion_start), (other[here], middle[here] + wheel_start))
        lengths = np.linalg.norm(np.diff(ends, axis=0), axis=1)[here]
        found.append(
            ContactLine(
                tooth,
                middle[here],
                nominal[here],
                places,
                lengths,
                aside[here],
                gap[here],
                flank.points(places.pinion),
                distance[here],
                slope,
            )
        )
    return tuple(found)


class _Overlap(NamedTuple):
    """Roll lengths (n,) of both flanks that touch, between which places (n,) along the tangent they face each other (mm), and
    whether they do.
    """

    touching: PerGear[Floats]
    low: Floats
    high: Floats
    usable: Bools


def overlap_of(line: LineOfAction, nominal: Floats) -> _Overlap:
    """That of flanks that touch at places (n,) of the line of action (mm from T1)."""
    one, other = line.flanks
    bent, touching = _bent(line), PerGear(nominal, line.whole - nominal)
    usable = (nominal > bent.pinion[0]) & (touching.wheel > bent.wheel[0])
    first, second = (np.clip(lengths, *within) for lengths, within in zip(touching, bent, strict=True))
    high = np.minimum(one.along_tangent(first, one.last), -other.along_tangent(second, other.first))
    low = np.maximum(one.along_tangent(first, one.first), -other.along_tangent(second, other.last))
    return _Overlap(PerGear(first, second), low, high, usable & (low < high))


def _facing(line: LineOfAction, nominal: Floats) -> tuple[Bools, tuple[Floats, Floats, Floats, Floats, Floats]]:
    """Where flanks are usable, and their roll lengths where they are nearest, how far aside that is, and the gap (mm).

    Last, how far inside the ends of both flanks that is.
    """
    one, other = line.flanks
    (first, second), low, high, usable = overlap_of(line, nominal)
    aside = np.clip(0.0, low, high)
    lengths, behind = one.facing(first, aside)
    wheel_lengths, wheel_behind = other.facing(second, -aside)
    return usable, (lengths, wheel_lengths, aside, behind + wheel_behind, np.minimum(high, -low))


def _bent(line: LineOfAction) -> PerGear[tuple[float, float]]:
    """Between which roll lengths (mm) flanks that touch have curvatures to speak of.

    Between T1 and T2 where these lie apart; beyond T1 where that of a ring lies behind it.
    """
    least = LEAST_LENGTH * line.module
    if line.whole > 0:
        return PerGear((least, line.whole - least), (least, line.whole - least))
    return PerGear((least, math.inf), (-math.inf, line.whole - least))


def near_path(line: LineOfAction, farthest_gap: float) -> float:
    """Length (mm) of the line of action over which exact flanks, or edges of their tips, come nearer than a gap (mm)."""
    nominal = np.linspace(0.0, sum(max(abs(each.first), abs(each.last)) for each in line.flanks), _PLACES)
    usable, (*_, gap, _) = _facing(line, nominal)
    return float(np.ptp(nominal[usable & (gap < farthest_gap)]))


def start_distances(line: ContactLine, action: LineOfAction) -> PerGear[Floats]:
    """Return distances (n,) in mm along the tangent from the cells to the transitions of each flank, as `start_distance`.

    Infinite without a linear relief.
    """
    found = []
    for flank, (lengths, _) in zip(action.flanks, line.places, strict=True):
        nearest = np.full(line.across.shape, math.inf)
        for onset in onsets(flank):
            nearest = np.minimum(nearest, start_distance(flank.base_radius, onset, lengths, 1 / line.curvature))
        found.append(nearest)
    return PerGear(*found)


class Gaps(NamedTuple):
    """Of all cells: the gap (n,) along the normal in mm, and the reduced radius (n,) in the normal section in mm."""

    normal: Floats
    radii: Floats


def gaps(lines: tuple[ContactLine, ...], pair: GearPair, mounting: Mounting, helix: float) -> Gaps:
    """Gaps and curvatures of all cells: of the exact flanks, their modifications, and the mounting.

    A misaligned axis of the wheel is turned, as a rigid body, about its middle in the common face width. Turned in the plane
    of action it recedes along the line of action and moves along the axis; turned across it, flanks face each other nearer to
    tip or root, which only modified flanks feel. A pitch error belongs to the tooth in the middle.
    """
    found = [
        line_gap(line, pair, mounting, helix, [_taken_back(pair, places) for places in places_beside(line, pair, mounting)])
        for line in lines
    ]
    return Gaps(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def line_gap(
    line: ContactLine, pair: GearPair, mounting: Mounting, helix: float, depths: Sequence[Floats] | Floats
) -> tuple[Floats, Floats]:
    """Gaps along the normal and reduced radii (..., n) in mm of a line, flanks taken back by `depths` (..., n) in mm
    at the `places_beside` it.
    """
    here, before, middle, after = depths
    step = BEND * pair.pinion.normal_module
    bend = (after - 2 * middle + before) / step**2
    curvature = np.maximum(line.curvature + bend, _LEAST_BEND * line.curvature)
    # Where the depth slopes, the flanks are nearest a little aside: the gap is a parabola there.
    slope = np.where(line.on_edge, 0.0, (after - before) / (2 * step) - bend * _aside(line, pair, mounting))
    transverse = line.gap + here - slope**2 / (2 * curvature)
    if line.tooth == 0:
        transverse = transverse - mounting.pitch_error / 1000
    return transverse * math.cos(helix) + turned_back(line, pair, mounting, helix), 1 / (curvature * math.cos(helix))


def turned_back(line: ContactLine, pair: GearPair, mounting: Mounting, helix: float) -> Floats:
    """Return what a misalignment in the plane of action adds to the gap (n,) of the cells along the normal, in mm."""
    turn = mounting.misalignment / 1000 / pair.common_width.width
    result: Floats = turn * (line.across * math.cos(helix) - line.places.wheel[0] * math.sin(helix))
    return result


def places_beside(line: ContactLine, pair: GearPair, mounting: Mounting) -> list[PerGear[Places]]:
    """Places on the pinion's and the wheel's flank on the line, and three along the tangent, towards the pinion's tip, which
    are what it takes to tell slope and curvature: a little before the line, on it and after it, or at the ends of the flanks
    as near to it as they all lie on them.

    The wheel has slid along the tangent where its axis is turned across, so that the pinion meets it nearer to its tip.
    """
    step, aside = BEND * pair.pinion.normal_module, _aside(line, pair, mounting)
    found = []
    for place in (np.zeros_like(aside), aside - step, aside, aside + step):
        pinion, wheel = (
            (_along_tangent(gear, lengths, sense * place + moved), heights)
            for gear, (lengths, heights), sense, moved in _sides(line, pair, mounting)
        )
        found.append(PerGear(pinion, wheel))
    return found


def _along_tangent(gear: Gear, lengths: Floats, towards_tip: Floats) -> Floats:
    """Roll lengths (n,) at distances (n,) along the tangent from others (mm)."""
    square = np.maximum(lengths**2 + gear.base_diameter * towards_tip, 0.0)
    return np.copysign(np.sqrt(square), gear.base_diameter)


def _sides(line: ContactLine, pair: GearPair, mounting: Mounting) -> PerGear[tuple[Gear, Places, int, Floats]]:
    """Both gears with their places, the sense of the tangent towards their tips, and how far (n,) in mm they slid along it."""
    slid = mounting.misalignment_across / 1000 / pair.common_width.width * line.across
    pinion, wheel = line.places
    return PerGear((pair.pinion, pinion, 1, np.zeros_like(slid)), (pair.wheel, wheel, -1, slid))


def _aside(line: ContactLine, pair: GearPair, mounting: Mounting) -> Floats:
    """How far (n,) in mm along the tangent slope and curvature are taken from the line, so that no end of a flank is passed:
    beyond it a modification goes on no more.
    """
    step, low, high = (
        BEND * pair.pinion.normal_module,
        np.full_like(line.across, -math.inf),
        np.full_like(line.across, math.inf),
    )
    for gear, (lengths, _), sense, moved in _sides(line, pair, mounting):
        form = gear.flank_form
        first, last = ((end**2 - lengths**2) / gear.base_diameter - moved for end in (form.first, form.last))
        low, high = (
            (np.maximum(low, first), np.minimum(high, last))
            if sense > 0
            else (
                np.maximum(low, -last),
                np.minimum(high, -first),
            )
        )
    result: Floats = np.clip(0.0, low + step, high - step)
    return result


def _taken_back(pair: GearPair, places: PerGear[Places]) -> Floats:
    """How far (n,) both flanks are taken back (mm) at places on them."""
    depths = []
    for gear, (lengths, heights) in zip(gears_loaded_left(pair), places, strict=True):
        form = gear.flank_form
        if not form.modification.present:
            depths.append(np.zeros_like(lengths))
            continue
        # The point that stands there now comes from further down the flank, by what it was taken back.
        depths.append(form.depth(lengths - form.depth(lengths, heights), heights))
    result: Floats = depths[0] + depths[1]
    return result
