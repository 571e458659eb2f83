"""Lines of contact across the start of a linear relief: cells there are pressed by their exact gap, not as two cylinders.

Away from these starts a cell has Hertz's ellipse. Beside them its gap is that of the exact flanks with their depths, and what
it gives way is that of the half-plane under it: the line then moves as much at the cell's own distance (see `line_contact`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gearcad.contact.shared.line_of_action import LineOfAction, TransverseFlank
from gearcad.contact.shared.loaded import INTERIOR
from gearcad.contact.shared.local_contact import GapCurve, Pressed, onsets, press
from gearcad.contact.solid.line_contact import (
    BEND,
    OWN_DISTANCE,
    Gaps,
    LineSolution,
    StartCells,
    evened_loads,
    overlap_of,
    solve_lines,
    start_distances,
    turned_back,
)
from gearcad.core.records import Bools, Floats, PerGear, Wholes
from gearcad.geometry import FlankForm, GearPair
from gearcad.mounting import Mounting
from gearcad.rating.contact_stress import half_width

__all__ = ["press_starts"]


_REACH = 1.1
"""Distance within which cells are pressed by their exact gap, over that within which no pressure is Hertz's."""

_SHARPEST = 0.01
"""Transition (normal modules of roll) with which a kink, that has none, is pressed: its load hardly depends on it."""

_ROUNDS, _SETTLED = 8, 1e-4
"""Rounds of fitting cells to their loads, and the change of a load, over the greatest, at which they have settled."""

_STEP = 1e-4
"""Distance (mm of roll) over which slope and curvature of a depth are taken: a parabola's are exact between its ends."""

_BESIDE = np.array([-_STEP, 0.0, _STEP])[:, None, None]
"""Distances (3, 1, 1) in mm of roll before, at and behind places (k, m)."""


def press_starts(pair: GearPair, action: LineOfAction, mounting: Mounting, helix: float, found: LineSolution) -> LineSolution:
    """Return a contact with the cells beside the starts of linear reliefs pressed by their exact gaps. Raises SolverError."""
    given, shortest = found.given, _shortest(action)
    if shortest == math.inf or not len(cells := _cells_at_start(found, action, mounting, pair, helix)):
        return found
    curve, solved = _Curve.of(found, cells, pair, action, mounting, helix), found
    force, normal, radii = float((found.forces * given.arms).sum()), found.gaps.normal.copy(), found.gaps.radii.copy()
    middle, half = np.zeros(len(cells)), solved.half_widths[cells]
    for _ in range(_ROUNDS):
        loads = evened_loads(given, solved.gaps, solved.forces)[cells]
        plain = half_width(loads, found.gaps.radii[cells], given.modulus)
        pressed = press(curve.at, loads, given.modulus, (middle, np.maximum(half, plain / 8)), shortest)
        known = pressed.settled
        middle, half = np.where(known, pressed.middle, 0.0), np.where(known, pressed.half_widths, plain)
        # The radius with which Hertz's own distance is the one that was found.
        wide = pressed.own[known] / OWN_DISTANCE
        normal[cells[known]], radii[cells[known]] = (
            pressed.least[known],
            wide**2 * math.pi * given.modulus / (4 * loads[known]),
        )
        before = solved.forces
        solved = solve_lines(given, Gaps(normal.copy(), radii.copy()), force, before)
        if np.abs(solved.forces - before).max() < _SETTLED * solved.forces.max():
            break
    return replace(solved, starts=StartCells(cells[known], half[known], pressed.peaks[known], curve.sound(pressed)[known]))


def _shortest(action: LineOfAction) -> float:
    """Return the length (mm) along the flank of the shortest transition, a kink's as it is pressed; infinite without one."""
    return min((onset.length for flank in action.flanks for onset in onsets(_rounded(flank))), default=math.inf)


def _rounded(flank: TransverseFlank) -> TransverseFlank:
    """Return the flank with short transitions in the place of kinks."""
    form = flank.form
    sharp: dict[str, Any] = {
        f"{name}_transition": _SHARPEST * form.module for name, of in form.transitions.items() if not of.length
    }
    return replace(flank, form=replace(form, modification=replace(form.modification, **sharp))) if sharp else flank


def _cells_at_start(found: LineSolution, action: LineOfAction, mounting: Mounting, pair: GearPair, helix: float) -> Wholes:
    """Return the cells (k,) that touch flanks beside the start of a linear relief."""
    even = found.forces.sum() * found.given.lengths / found.given.lengths.sum()
    loads = np.maximum(found.forces, even) / found.given.lengths
    near = []
    for line, load in zip(found.given.lines, found.given.split(loads), strict=True):
        wide = INTERIOR * half_width(load, 1 / (line.curvature * math.cos(helix)), found.given.modulus)
        slid = np.abs(line.across) * abs(mounting.misalignment_across) / 1000 / pair.common_width.width
        reach = np.maximum(_REACH * wide, 2 * BEND * action.module) + slid
        distance = np.minimum(*start_distances(line, action))
        near.append((distance < reach) & ~line.on_edge)
    return np.flatnonzero(np.concatenate(near))


@dataclass(frozen=True)
class _Side:
    """The flanks of one gear on cells (k, 1): roll lengths that touch, heights, and how far they slid (mm)."""

    flank: TransverseFlank
    touching: Floats
    heights: Floats
    slid: Floats

    def at(self, place: Floats) -> GapCurve:
        """Return how far (k, m) the flank lies behind the tangent at places along it towards the tip, with its depth (mm)."""
        base = self.flank.base_radius
        length, behind = self.flank.facing(self.touching, place)
        turn = (length - self.touching) / base
        cosine, tangent = np.cos(turn), np.tan(turn)
        shifted = self.flank.facing(self.touching, place + self.slid)[0] if self.slid.any() else length
        depth, slope, bend = self._depth(shifted)
        # Along the tangent roll grows by r_b/(rho cos t), t the turn, and the flank falls behind by tan t.
        grown = base / (length * cosine)
        bent = -(grown**2) * (1 / length - tangent / base)
        return GapCurve(
            behind + depth,
            tangent + slope * grown,
            1 / (length * cosine**3) + bend * grown**2 + slope * bent,
        )

    def _depth(self, lengths: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the depth (k, m) in mm, its slope and its bend over roll; beyond the ends of the flank it goes on straight."""
        form = self.flank.form
        inside = np.clip(lengths, form.first + 2 * _STEP, form.last - 2 * _STEP)
        before, here, after = self._taken_back(form, inside + _BESIDE)
        slope = (after - before) / (2 * _STEP)
        bend = np.where(inside == lengths, (after - 2 * here + before) / _STEP**2, 0.0)
        return here + slope * (lengths - inside), slope, bend

    def _taken_back(self, form: FlankForm, lengths: Floats) -> Floats:
        # What is there now comes from further down the flank, by what it was taken back.
        return form.depth(lengths - form.depth(lengths, self.heights), self.heights)


@dataclass(frozen=True)
class _Curve:
    """The gaps of cells (k,) along the normal, over places along the tangent from the line of contact to the pinion's tip.

    `constant` (k, 1) in mm is what does not depend on the place; places are on both flanks between `low` and `high` (k,).
    """

    sides: PerGear[_Side]
    helix: float
    constant: Floats
    low: Floats
    high: Floats

    @classmethod
    def of(
        cls,
        found: LineSolution,
        cells: Wholes,
        pair: GearPair,
        action: LineOfAction,
        mounting: Mounting,
        helix: float,
    ) -> _Curve:
        """Return the gaps of cells (k,) of a contact."""
        lines = found.given.lines

        def each(values: Sequence[Floats]) -> Floats:
            return np.concatenate(values)[cells]

        overlaps = [overlap_of(action, line.nominal) for line in lines]
        touching = PerGear(*(each([getattr(of.touching, role) for of in overlaps]) for role in ("pinion", "wheel")))
        heights = PerGear(*(each([getattr(line.places, role)[1] for line in lines]) for role in ("pinion", "wheel")))
        slid = each([line.across for line in lines]) * mounting.misalignment_across / 1000 / pair.common_width.width
        proud = each([np.full(len(line.across), mounting.pitch_error / 1000 if line.tooth == 0 else 0.0) for line in lines])
        turned = each([turned_back(line, pair, mounting, helix) for line in lines])
        flanks = action.flanks.map(_rounded)
        sides = PerGear(
            _Side(flanks.pinion, touching.pinion[:, None], heights.pinion[:, None], np.zeros((len(cells), 1))),
            _Side(flanks.wheel, touching.wheel[:, None], heights.wheel[:, None], slid[:, None]),
        )
        constant = (turned - proud * math.cos(helix))[:, None]
        low, high = (each([getattr(of, end) for of in overlaps]) for end in ("low", "high"))
        return cls(sides, helix, constant, low, high)

    def sound(self, pressed: Pressed) -> Bools:
        """Return whether contacts (k,) are resolved, and no end of a flank lies in them."""
        first, last = pressed.middle - pressed.half_widths, pressed.middle + pressed.half_widths
        result: Bools = pressed.resolved & (self.low < first) & (last < self.high)
        return result

    def at(self, place: Floats) -> GapCurve:
        """Return the gaps (k, m) at places."""
        pinion, wheel = self.sides.pinion.at(place), self.sides.wheel.at(-place)
        flat = math.cos(self.helix)
        return GapCurve(
            (pinion.gap + wheel.gap) * flat + self.constant,
            (pinion.slope - wheel.slope) * flat,
            (pinion.curvature + wheel.curvature) * flat,
        )
