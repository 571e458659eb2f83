"""The lines along which flanks can touch at a position of the mesh, cell by cell, and the gap there.

In the plane of action a line of contact is straight and lies at the base helix angle. Where it leaves the flanks, the tip
edge of one gear faces the other's flank instead.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.fea.mesh_positions import MeshLine
from gearcad.geometry import GearPair
from gearcad.ltca.flank import Places, SolidFlank
from gearcad.mounting import Mounting

__all__ = ["ContactLine", "Gaps", "contact_lines", "gaps"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_LEAST_LENGTH = 0.01
"""Least roll length (mm per mm of normal module) at which a flank still has a curvature to speak of."""

_BEND = 0.05
"""Distance (mm per mm of normal module) over which slope and curvature of a modification are taken."""

_LEAST_BEND = 0.05
"""Share of the exact flanks' curvature that a hollow modification leaves at the least."""


@dataclass(frozen=True)
class ContactLine:
    """One pair of flanks: tooth `tooth` of the pinion (0 is the middle one), cell by cell along the face width.

    `across` (n,) in mm from the middle of the common face width, `nominal` (n,) where the line of contact crosses the line
    of action (mm from T1), `pinion` and `wheel` places on both flanks, `lengths` (n,) of the cells in mm, `aside` (n,) in mm
    how far beside the line of action the flanks are nearest (0 on the line of contact, else an edge touches), `gap` (n,) the
    transverse gap of the exact involutes in mm, `points` (n, 3) on the pinion's flank.
    """

    tooth: int
    across: Floats
    nominal: Floats
    pinion: Places
    wheel: Places
    lengths: Floats
    aside: Floats
    gap: Floats
    points: Floats
    edge_distance: Floats

    @property
    def on_edge(self) -> Bools:
        """Whether the edge of a tip touches instead of the flank."""
        result: Bools = self.aside != 0
        return result

    @property
    def curvature(self) -> Floats:
        """Curvature (n,) of the gap between the exact flanks in the transverse section (1/mm)."""
        return 1 / self.pinion[0] + 1 / self.wheel[0]


def contact_lines(
    pair: GearPair, line: MeshLine, flank: SolidFlank, pinion_length: float, cells: int, farthest_gap: float
) -> tuple[ContactLine, ...]:
    """The lines when the middle pair of teeth touches at `pinion_length` (mm from T1) in the middle of the common face width.

    Cells count where the exact flanks are nearer than `farthest_gap` (mm).
    """
    common, width = pair.common_width, pair.common_width.width
    edges = np.linspace(-width / 2, width / 2, cells + 1)
    slope = math.tan(flank.helix)
    reach = math.ceil((line.pinion.last + line.wheel.last + width * abs(slope)) / line.pitch)
    pinion_start = pair.pinion.face_width / 2 + common.offset
    wheel_start = pair.wheel.face_width / 2 + common.offset - pair.axial_offset
    found = []
    for tooth in range(-reach, reach + 1):
        nominal = pinion_length + tooth * line.pitch + edges * slope
        usable, places = _facing(line, nominal)
        ends = flank.points((places[0], edges + pinion_start))
        middle = (edges[1:] + edges[:-1]) / 2
        nominal = pinion_length + tooth * line.pitch + middle * slope
        usable, (one, other, aside, gap, distance) = _facing(line, nominal)
        here = usable & (gap < farthest_gap)
        if not here.any():
            continue
        pinion, wheel = (one[here], middle[here] + pinion_start), (other[here], middle[here] + wheel_start)
        lengths = np.linalg.norm(np.diff(ends, axis=0), axis=1)[here]
        found.append(
            ContactLine(
                tooth,
                middle[here],
                nominal[here],
                pinion,
                wheel,
                lengths,
                aside[here],
                gap[here],
                flank.points(pinion),
                distance[here],
            )
        )
    return tuple(found)


def _facing(line: MeshLine, nominal: Floats) -> tuple[Bools, tuple[Floats, Floats, Floats, Floats, Floats]]:
    """Where flanks are usable, and their roll lengths where they are nearest, how far aside that is, and the gap (mm).

    Last, how far inside the ends of both flanks that is.
    """
    one, other = line.pinion, line.wheel
    least = _LEAST_LENGTH * line.module
    usable = (nominal > least) & (line.whole - nominal > least)
    first, second = np.clip(nominal, least, line.whole - least), np.clip(line.whole - nominal, least, line.whole - least)
    high = np.minimum(_along_tangent(one.base_radius, first, one.last), -_along_tangent(other.base_radius, second, other.first))
    low = np.maximum(_along_tangent(one.base_radius, first, one.first), -_along_tangent(other.base_radius, second, other.last))
    aside = np.clip(0.0, low, high)
    lengths, behind = _behind_tangent(one.base_radius, first, aside)
    wheel_lengths, wheel_behind = _behind_tangent(other.base_radius, second, -aside)
    return usable & (low < high), (lengths, wheel_lengths, aside, behind + wheel_behind, np.minimum(high, -low))


def _along_tangent(base: float, contact: Floats, length: float) -> Floats:
    """Where the flank's point at roll length `length` lies along the common tangent, if it touches at `contact` (mm)."""
    turn = (length - contact) / base
    return np.asarray(base * np.cos(turn) + length * np.sin(turn) - base)


def _behind_tangent(base: float, contact: Floats, place: Floats) -> tuple[Floats, Floats]:
    """Roll lengths at places along the tangent (towards the tip), and how far the flank lies behind the tangent (mm)."""
    turn = (np.sqrt(np.maximum(contact**2 + 2 * base * place, 1e-12)) - contact) / base
    for _ in range(6):
        length = contact + base * turn
        turn = turn - (base * np.cos(turn) + length * np.sin(turn) - base - place) / (length * np.cos(turn))
    length = contact + base * turn
    return length, contact - (length * np.cos(turn) - base * np.sin(turn))


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
    width = pair.common_width.width
    turn, across = mounting.misalignment / 1000 / width, mounting.misalignment_across / 1000 / width
    step = _BEND * pair.pinion.normal_module
    found, radii = [], []
    for line in lines:
        before, here, after = (_taken_back(line, pair, across * line.across, place) for place in (-step, 0.0, step))
        curvature = line.curvature + (after - 2 * here + before) / step**2
        curvature = np.maximum(curvature, _LEAST_BEND * line.curvature)
        # Where the depth slopes, the flanks are nearest a little aside: the gap is a parabola there.
        slope = np.where(line.on_edge, 0.0, (after - before) / (2 * step))
        transverse = line.gap + here - slope**2 / (2 * curvature)
        if line.tooth == 0:
            transverse = transverse - mounting.pitch_error / 1000
        turned = turn * (line.across * math.cos(helix) - line.wheel[0] * math.sin(helix))
        found.append(transverse * math.cos(helix) + turned)
        radii.append(1 / (curvature * math.cos(helix)))
    return Gaps(np.concatenate(found), np.concatenate(radii))


def _taken_back(line: ContactLine, pair: GearPair, slid: Floats, place: float) -> Floats:
    """How far (n,) both flanks of a line are taken back (mm) at `place` (mm) along the tangent, towards the pinion's tip.

    The wheel has `slid` (n,) in mm along the tangent, so that the pinion meets it nearer to its tip.
    """
    depth = np.zeros_like(slid)
    for gear, (lengths, heights), along in ((pair.pinion, line.pinion, place), (pair.wheel, line.wheel, slid - place)):
        form = gear.flank_form
        there = np.sqrt(np.maximum(lengths**2 + form.base_radius * 2 * along, 0.0))
        # The point that stands there now comes from further down the flank, by what it was taken back.
        depth = depth + form.depth(there - form.depth(there, heights), heights)
    return depth
