"""Friction along the lines of contact of solid gears: what it moves and turns, and the contact that carries a torque with it.

Sliding and friction lie in the transverse section, along the common tangent. The friction of a cell is its normal force times
the coefficient there; it moves other cells along their normals, and has its part in the torque. Both follow from the forces,
which are found round by round.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from gearcad.contact.shared.line_of_action import LineOfAction
from gearcad.contact.shared.loaded import TOOTH_ORDER
from gearcad.contact.solid.flank import SolidCompliance
from gearcad.contact.solid.line_contact import ContactLine, LineSolution, Responses
from gearcad.core.errors import SolverError
from gearcad.core.records import Floats, PerGear, Role
from gearcad.geometry import GearPair
from gearcad.geometry.tooth_friction import MeshFriction

_ROUNDS, _SETTLED = 40, 1e-8
"""Rounds of finding friction from forces, and the change of a force, over the greatest, at which they have settled."""


class KnownSlips(dict[tuple[float, float, bool], PerGear[Floats]]):
    """`slips` by roll angle (deg), farthest gap (mm) and whether the middle pair is alone; grows as positions are solved.

    Pairs of the same bodies at the same centre distance share it.
    """


def with_friction(
    lines: tuple[ContactLine, ...], pair: GearPair, action: LineOfAction, friction: MeshFriction, force: float, helix: float
) -> tuple[ContactLine, ...]:
    """Return the lines with the friction of their cells under the transverse force (N per mm) of all pairs of teeth."""
    found = []
    for line in lines:
        bases = (flank.base_radius * math.cos(helix) for flank in action.flanks)
        lengths = (line.nominal, action.whole - line.nominal)
        levers = PerGear(*(length / base for length, base in zip(lengths, bases, strict=True)))
        found.append(replace(line, friction=friction.signed(pair, line.nominal, force), friction_levers=levers))
    return tuple(found)


def slips(lines: tuple[ContactLine, ...], bodies: PerGear[SolidCompliance]) -> PerGear[Floats]:
    """Return the displacements (n, n) in mm/N of the cells i along their normals by forces on cells j along the flanks,
    towards the tips.

    By reciprocity they are those of cell j towards the tip by normal forces on cell i.
    """
    return PerGear.each(lambda role: _slips(lines, bodies.pick(role), role))


def _slips(lines: tuple[ContactLine, ...], body: SolidCompliance, role: Role) -> Floats:
    places = [line.places.pick(role) for line in lines]
    rows, columns = [body.moved_weights(each) for each in places], [body.load_weights(each) for each in places]
    ends = np.cumsum([0, *map(len, rows)])
    spans = [slice(first, last) for first, last in pairwise(ends.tolist())]
    matrix = np.zeros((ends[-1], ends[-1]))
    for rubbed, row, place, there in zip(lines, rows, places, spans, strict=True):
        for pressed, column, here in zip(lines, columns, spans, strict=True):
            response = body.along.get((rubbed.tooth - pressed.tooth) * TOOTH_ORDER.pick(role))
            if response is not None:
                matrix[here, there] = (row @ response @ column.T).T
            if pressed is rubbed:
                matrix[here, there] += body.taken_off_along(place).T
    return matrix


def pressed_with_friction(
    given: Responses, slid: PerGear[Floats], press: Callable[[Responses, float], LineSolution], force: float
) -> LineSolution:
    """Return the contact whose normal forces and friction have the torque of `force` (N) at the base radius of the pinion.

    `press` solves for responses, with the gap that friction leaves, and a normal force without friction. Raises SolverError.
    """
    friction = np.concatenate([np.broadcast_to(line.friction, line.across.shape) for line in given.lines])
    levers = given.arms + np.concatenate([line.friction * line.friction_levers.pinion for line in given.lines])
    by_friction = slid.map(lambda matrix: matrix * friction)
    both, normal, before = by_friction.pinion + by_friction.wheel, force, np.zeros(given.cells)
    rigid = math.nan
    for count in range(_ROUNDS):
        found = press(_shifted(given, both @ before), normal)
        rigid = found.rigid if count == 0 else rigid
        change = float(np.abs(found.forces - before).max())
        before = found.forces
        normal = force * float(given.arms @ before) / float(levers @ before)
        if change < _SETTLED * float(before.max()):
            break
    else:
        raise SolverError("the contact with friction did not settle: reduce check.friction")
    forces = before
    moved = (float(forces @ matrix @ forces) / normal for matrix in by_friction)
    parts = PerGear(*(part + slid for part, slid in zip(found.parts, moved, strict=True)))
    own = replace(found.given, lines=given.lines)
    return replace(found, given=own, forces=forces * (force / float(levers @ forces)), rigid=rigid, parts=parts)


def _shifted(given: Responses, gap: Floats) -> Responses:
    """Return the responses of lines with a further gap (n,) along the normal, in mm."""
    lines = zip(given.lines, given.split(gap), strict=True)
    return replace(given, lines=tuple(replace(line, supported=line.supported + more) for line, more in lines))
