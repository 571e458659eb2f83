"""The pairs of flanks that can touch at a position of the mesh, each divided into cells."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from gearcad.contact.plane.contact import ContactCells, ContactPair
from gearcad.contact.shared.line_of_action import LineOfAction, facing_gap, facing_pairs, overlap
from gearcad.contact.shared.relief_start import onsets, start_distance
from gearcad.per_gear import PerGear

__all__ = ["contact_pairs", "touching_teeth"]


_FEWEST = 6
"""Cells of a pair of flanks, however narrow its window."""

_OF_TRANSITION, _MOST = 8, 800
"""Cells over the transition of a linear relief that lies in the window, and the most cells of a pair of flanks."""

_BEND = 0.01
"""Distance (mm per mm of normal module) over which the curvature of a gap is taken."""


def contact_pairs(
    line: LineOfAction,
    pinion_length: float,
    span: Callable[[int, float], float],
    cells: int,
    farthest_gap: float,
    least_width: float = 0.0,
    *,
    single: bool = False,
) -> tuple[ContactPair, ...]:
    """Pairs of flanks when the middle pair touches at `pinion_length` (mm from T1).

    Each has `cells` within `span(tooth, reduced radius)` (mm) on both sides of its contact, or fewer that are not narrower
    than `least_width` (mm). Beyond the path of contact the corner of a tip can touch while teeth bend: such pairs count up
    to `farthest_gap` (mm) from where exact involutes would touch. `single` leaves all but the middle pair out.
    """
    return tuple(
        _contact_pair(line, tooth, pinion_length + tooth * line.pitch, place, span, cells, least_width)
        for tooth, place in touching_teeth(line, pinion_length, farthest_gap, single=single).items()
    )


def touching_teeth(line: LineOfAction, pinion_length: float, farthest_gap: float, *, single: bool = False) -> dict[int, float]:
    """Teeth whose flanks come as near as `farthest_gap` (mm), and where along the tangent (mm) they are nearest."""
    near = facing_pairs(line, pinion_length).items()
    return {tooth: place for tooth, (gap, place) in near if gap <= farthest_gap and not (single and tooth)}


def _contact_pair(
    line: LineOfAction,
    tooth: int,
    pinion_length: float,
    middle: float,
    span: Callable[[int, float], float],
    cells: int,
    least_width: float,
) -> ContactPair:
    low, high = overlap(line, pinion_length)
    touching = line.lengths(pinion_length)
    radius = touching.pinion * touching.wheel / line.whole
    reach = span(tooth, radius)
    first, last = max(low, middle - reach), min(high, middle + reach)
    finest = max(min(2 * reach / cells, _of_transition(line, touching, radius, reach)), 2 * reach / _MOST, least_width)
    count = max(round((last - first) / finest), _FEWEST)
    width = (last - first) / count
    place = np.linspace(first + width / 2, last - width / 2, count)
    facing, gap = facing_gap(line, tooth, pinion_length, place)
    # The mean gap over a cell is that of its middle and what the curvature adds.
    gap = gap + width**2 / 24 / radius
    added = 0.0 if line.exact else _curvature(line, tooth, pinion_length, middle) - 1 / radius
    return ContactPair(tooth, touching, ContactCells(place, width, facing, gap), added)


def _of_transition(line: LineOfAction, touching: PerGear[float], radius: float, reach: float) -> float:
    """Return the width (mm) of cells that the transitions within `reach` of a contact ask for; infinite without one."""
    finest = math.inf
    for flank, length in zip(line.flanks, touching, strict=True):
        for onset in onsets(flank):
            if onset.length and start_distance(flank.base_radius, onset, np.array(length), radius) < reach:
                finest = min(finest, onset.length / _OF_TRANSITION)
    return finest


def _curvature(line: LineOfAction, tooth: int, pinion_length: float, place: float) -> float:
    """Relative curvature (1/mm) of two flanks at a place along the tangent: second difference of their gap."""
    step = _BEND * line.module
    _, (before, here, after) = facing_gap(line, tooth, pinion_length, place + step * np.array([-1.0, 0.0, 1.0]))
    return float(before - 2 * here + after) / step**2
