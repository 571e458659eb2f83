"""Tip edges beyond the ends of the path of contact: the direction in which they press, and the lever arm of their force.

Beyond the path of contact the edge of a tip touches its mate's flank: the wheel's before the path begins, the pinion's after
its end. The force has the direction of the mate's normal there. So its lever arm on the mate is the base radius, as
everywhere; on the gear whose tip it is the arm is another, and the force is not normal to that gear's own flank.

With u = (along the tangent towards the own tip, along the line of action) a point of the flank is (r_b + x, rho - h), the tip's
place is x < 0, h how far the flank lies behind the tangent there, and t the slope of the mate's flank, both as angles. The arm
is (r_b + x) cos t - (rho - h) sin t, and to first order r_b + x (1 + rho/rho_mate).

Under load the tip stands elsewhere: turn and deflection slide it along the tangent. So levers and gaps are those of the
turned flanks; the difference is of second order, as the slides are some hundredths of a mm.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gearcad.contact.shared.line_of_action import AS_PLACED, LineOfAction, TransverseFlank
from gearcad.core.records import Bools, Floats, PerGear, Role

_STEP = 1e-4
"""Distance (mm of roll) over which the slope of a modification is taken."""


class TipEdges(NamedTuple):
    """Forces of contacts (n,) whose tip edges touch: lever `arms` over the base radii, and `tilts` (rad).

    A tilt is the angle from the normal of a gear's own involute at the edge of its tip to the force on it, towards the root.
    It is 0, and the arm 1, of a gear on whose flank the force is normal.
    """

    arms: PerGear[Floats]
    tilts: PerGear[Floats]

    @classmethod
    def none(cls, count: int) -> TipEdges:
        """Return the arms and tilts of so many contacts that no edge of a tip touches."""
        return cls(*(PerGear(np.full(count, value), np.full(count, value)) for value in (1.0, 0.0)))


def tip_edges(line: LineOfAction, touching: PerGear[Floats]) -> TipEdges:
    """Return the tip edges of flanks that touch at roll lengths (n,) of the line of action (mm)."""
    found = TipEdges.none(len(touching.pinion))
    for role in Role:
        own, mate = line.flanks.pick(role), line.flanks.pick(_mate(role))
        contact, opposite = touching.pick(role), touching.pick(_mate(role))
        place = own.along_tangent(contact, own.last)
        beyond = _beyond(own, place, -mate.along_tangent(opposite, mate.first), contact)
        if beyond.any():
            arms, tilts = _tilted(own, mate, contact[beyond], opposite[beyond], place[beyond])
            found.arms.pick(role)[beyond], found.tilts.pick(role)[beyond] = arms, tilts
    return found


class LoadedTip(NamedTuple):
    """The edge of a gear's tip that presses on its mate, and how far the load has moved both flanks.

    Each gear of `turns` (mm along the line of action) would slide its flank as far along the tangent as its turn and its
    deflection do together. By `ahead` (rad) the gear of the tip has turned on from there.
    """

    role: Role
    turns: PerGear[float] = AS_PLACED
    ahead: float = 0.0

    def forces(self, line: LineOfAction, pinion_length: float, places: Floats) -> TipEdges:
        """Return the forces of cells at places (n,) along the tangent (mm, towards the pinion's tip), each with its own lever.

        The unloaded flanks touch at `pinion_length` (mm from T1).
        """
        found, touching = TipEdges.none(len(places)), line.lengths(pinion_length, self.turns)
        own, mate = line.flanks.pick(self.role), line.flanks.pick(_mate(self.role))
        contact, opposite = (np.full(len(places), touching.pick(role)) for role in (self.role, _mate(self.role)))
        arms, tilts = _tilted(own, mate, contact, opposite, places if self.role is Role.PINION else -places)
        found.arms.pick(self.role)[:], found.tilts.pick(self.role)[:] = arms, tilts + self.ahead
        return found

    def gap(self, edges: TipEdges) -> Floats:
        """Return what the gaps (n,) in mm of the turned flanks gain: so they close by the turns, at the levers of these."""
        arms = edges.arms
        return (arms.pinion - 1) * self.turns.pinion - (arms.wheel - 1) * self.turns.wheel


def _mate(role: Role) -> Role:
    return Role.WHEEL if role is Role.PINION else Role.PINION


def _beyond(own: TransverseFlank, place: Floats, start: Floats, contact: Floats) -> Bools:
    """Return where the tip of a flank lies at a place below 0, and before the `start` of its mate's involute."""
    result: Bools = (contact > own.last) & (place < 0) & (place <= start)
    return result


def _tilted(
    own: TransverseFlank, mate: TransverseFlank, contact: Floats, opposite: Floats, place: Floats
) -> tuple[Floats, Floats]:
    """Return arms over the base radius, and tilts (rad), at places (n,) along the tangent (mm), towards the own tip."""
    own_lengths, behind = own.facing(contact, place)
    lengths, _ = mate.facing(opposite, -place)
    turn = mate.turned(lengths - opposite)
    slope = turn
    if mate.form.modification.present:
        slope = turn + _relieved(mate, lengths) * mate.base_radius / (lengths * np.cos(turn))
    return own.arms(place, contact - behind, slope), slope - own.turned(own_lengths - contact)


def _relieved(flank: TransverseFlank, lengths: Floats) -> Floats:
    """Return the slope (mm per mm of roll) of a flank's modification at roll lengths (n,), but for its ends."""
    inside = np.clip(lengths, flank.first + _STEP, flank.last - _STEP)
    result: Floats = (flank.depth(inside + _STEP) - flank.depth(inside - _STEP)) / (2 * _STEP)
    return result
