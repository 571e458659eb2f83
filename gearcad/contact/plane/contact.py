"""Frictionless contact of a gear pair at one position: pressures on all pairs of flanks that can touch, and the approach.

Everything is per mm of face width, in the transverse section.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise, product

import numpy as np

from gearcad.arrays import Bools, Floats, Indices
from gearcad.contact.plane.flank import PlaneCompliance
from gearcad.contact.shared.complementarity import complementary
from gearcad.contact.shared.engaged import TOOTH_ORDER
from gearcad.per_gear import PerGear, Role

__all__ = ["ContactCells", "ContactPair", "ContactSolution", "compliance_matrix", "solve_contact"]


@dataclass(frozen=True)
class ContactCells:
    """Cells of constant pressure on one pair of flanks, `place` (n,) in mm along the common tangent from the line of action.

    `lengths` are the roll lengths (n,) in mm that face each other there, `gap` (n,) their distance (mm) before loading.
    """

    place: Floats
    width: float
    lengths: PerGear[Floats]
    gap: Floats


@dataclass(frozen=True)
class ContactPair:
    """A pair of flanks: tooth `tooth` of the pinion (0 is the middle one), in contact at roll `lengths` (mm).

    `added_curvature` (1/mm) is what modified flanks have more than the two involutes, where they come nearest.
    """

    tooth: int
    lengths: PerGear[float]
    cells: ContactCells
    added_curvature: float = 0.0

    @property
    def plain_radius(self) -> float:
        """Reduced radius of curvature (mm) of the two involutes."""
        pinion, wheel = self.lengths
        return pinion * wheel / (pinion + wheel)

    @property
    def radius(self) -> float:
        """Reduced radius of curvature (mm); infinite where one flank is hollower than the other is round."""
        pinion, wheel = self.lengths
        curvature = (pinion + wheel) / (pinion * wheel) + self.added_curvature
        return 1 / curvature if curvature > 0 else math.inf


@dataclass(frozen=True)
class ContactSolution:
    """Pressures (MPa) by pair and cell, and the approach of the flanks along the line of action (mm).

    `parts` are the pinion's and the wheel's shares of the approach; what is left is gaps that were closed.
    """

    pairs: tuple[ContactPair, ...]
    pressures: tuple[Floats, ...]
    approach: float
    parts: PerGear[float]

    @property
    def forces(self) -> Floats:
        """Normal force on each pair (N per mm)."""
        return np.array([pressure.sum() * pair.cells.width for pair, pressure in zip(self.pairs, self.pressures, strict=True)])


def solve_contact(
    pairs: tuple[ContactPair, ...], bodies: PerGear[PlaneCompliance], force: float, like: ContactSolution | None = None
) -> ContactSolution:
    """Press the gears together with the normal force `force` (N per mm of width).

    What touches is sought from where it does in a solution `like` this one, if there is one.
    """
    sizes = [len(pair.cells.place) for pair in pairs]
    width = np.concatenate([np.full(size, pair.cells.width) for size, pair in zip(sizes, pairs, strict=True)])
    gap = np.concatenate([pair.cells.gap for pair in pairs])
    matrices = PerGear.each(lambda role: compliance_matrix(pairs, bodies.pick(role), role))
    touching = _middles(pairs) if like is None else _touching(pairs, like)
    pressure, approach = complementary(matrices.pinion + matrices.wheel, gap * width, width, force, touching)
    parts = matrices.map(lambda matrix: float(pressure @ matrix @ pressure) / force)
    return ContactSolution(pairs, tuple(np.split(pressure, np.cumsum(sizes)[:-1])), approach, parts)


def _middles(pairs: tuple[ContactPair, ...]) -> Bools:
    """Cells (n,) in the middle third of what is around the least gap of each pair: half widths of windows of three."""
    places = [pair.cells.place for pair in pairs]
    away = [np.abs(place - place[pair.cells.gap.argmin()]) for place, pair in zip(places, pairs, strict=True)]
    return np.concatenate([each <= each.max() / 3 for each in away])


def _touching(pairs: tuple[ContactPair, ...], like: ContactSolution) -> Bools:
    """Cells (n,) that lie where another solution presses."""
    pressed = {pair.tooth: (pair.cells.place, pressure) for pair, pressure in zip(like.pairs, like.pressures, strict=True)}
    nowhere = np.zeros(1), np.zeros(1)
    return np.concatenate([np.interp(pair.cells.place, *pressed.get(pair.tooth, nowhere)) > 0 for pair in pairs])


def compliance_matrix(pairs: tuple[ContactPair, ...], body: PlaneCompliance, role: Role) -> Floats:
    """Displacement of a gear's flank over cell i, times its width, by the pressure on cell j.

    (n, n) in mm²/MPa.
    """
    lengths = [pair.cells.lengths.pick(role) for pair in pairs]
    begin = np.cumsum([0, *map(len, lengths)])
    spans = [slice(first, last) for first, last in pairwise(begin.tolist())]
    moved, parts = body.by_unit_loads(np.concatenate(lengths)), body.parts_of_loads(np.concatenate(lengths))
    matrix = np.zeros((begin[-1], begin[-1]))
    for (one, other), (there, here) in zip(product(pairs, pairs), product(spans, spans), strict=True):
        apart = (one.tooth - other.tooth) * TOOTH_ORDER.pick(role)
        if abs(apart) <= body.neighbours:
            block = moved[there, apart + body.neighbours] @ parts[here].T
            matrix[there, here] = block * (one.cells.width * other.cells.width)
        if body.edge_taken_off and not apart:
            matrix[there, here] += _edge_block(one.cells, body)
    result: Floats = (matrix + matrix.T) / 2
    return result


def _edge_block(cells: ContactCells, body: PlaneCompliance) -> Floats:
    """The straight edge's part: k(d) integrated over both cells in closed form."""
    log = -2 / (np.pi * body.elasticity.modulus)
    constant = -(1 + body.elasticity.ratio) / (np.pi * body.elasticity.modulus)
    count, h = len(cells.place), cells.width
    by_step, steps = _even_cells(count)
    result: Floats = (h * h * (log * (by_step + math.log(h)) + constant))[steps]
    return result


@lru_cache(256)
def _even_cells(count: int) -> tuple[Floats, Indices]:
    """ln|d| integrated over two cells of width 1 by the steps (n,) between them, and the steps (n, n) between all."""
    steps = np.arange(count)
    second = _second(np.arange(-1.0, count + 1))
    return second[2:] - 2 * second[1:-1] + second[:-2], np.abs(steps[:, None] - steps)


def _second(x: Floats) -> Floats:
    """Twice integrated ln|x|: x^2/2 (ln|x| - 3/2)."""
    size = np.abs(x)
    result: Floats = np.where(size > 0, x * x / 2 * (np.log(np.where(size > 0, size, 1.0)) - 1.5), 0.0)
    return result
