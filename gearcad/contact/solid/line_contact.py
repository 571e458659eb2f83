"""Frictionless contact along lines: the load of every cell, and the approach of the gears.

Across the line the pressure is Hertz's, an ellipse as wide as the load of its place makes it; along the line loads act on each
other as on a half-space. c = 0.3033 a is the distance at which a point load moves the middle of the ellipse as the ellipse does
(the mean of ln|x| over a semi-ellipse is ln(a/2) - 1/2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.shared.complementarity import complementary
from gearcad.contact.shared.engaged import TOOTH_ORDER
from gearcad.contact.solid.contact_lines import ContactLine, Gaps
from gearcad.contact.solid.flank import SolidCompliance
from gearcad.errors import SolverError
from gearcad.per_gear import PerGear, Role
from gearcad.rating.hertz import half_width, peak_pressure

__all__ = ["LineSolution", "Responses", "half_widths", "responses", "solve_lines"]


OWN_DISTANCE = math.exp(-0.5) / 2
"""c/a: 0.30327."""

_LEAST = 1e-3
"""Share of the mean load per length for which the ellipse of a cell is wide enough, however little it carries."""

_ROUNDS, _FREE_ROUNDS = 40, 8
_SETTLED = 1e-5
"""Rounds of fitting the ellipses to the loads, and the relative change at which they have settled."""


@dataclass(frozen=True)
class Responses:
    """What one position needs of both bodies: `smooth` (n, n) normal displacements (mm/N) without the half-space's part.

    `apart` (n, n) are the distances (mm) of cells on the same flank, infinite on different ones; `lengths` (n,) of the cells
    (mm); `modulus` E_r (MPa), 1/E_r = sum (1 - nu^2)/E.
    """

    lines: tuple[ContactLine, ...]
    smooth: PerGear[Floats]
    apart: Floats
    lengths: Floats
    modulus: float

    @property
    def both(self) -> Floats:
        """`smooth` of both bodies together (n, n)."""
        return self.smooth.pinion + self.smooth.wheel

    @property
    def cells(self) -> int:
        """Cells of all lines."""
        return len(self.lengths)

    def split(self, values: Floats) -> list[Floats]:
        """Values of all cells (..., n) by line."""
        return np.split(values, np.cumsum([len(line.across) for line in self.lines])[:-1], axis=-1)

    def half_space(self, half_widths: Floats) -> Floats:
        """Displacements (n, n) in mm/N of both half-spaces, for ellipses as wide as that (mm) on each side."""
        result = np.zeros_like(self.apart)
        for here in self._own_cells:
            apart, own, half = self.apart[here, here], OWN_DISTANCE * half_widths[here], self.lengths[here] / 2
            kernel = (np.arcsinh((apart + half) / own) - np.arcsinh((apart - half) / own)) / self.lengths[here]
            result[here, here] = kernel / (math.pi * self.modulus)
        return result

    @property
    def _own_cells(self) -> list[slice]:
        """The cells of each line."""
        ends = np.cumsum([0, *(len(line.across) for line in self.lines)]).tolist()
        return [slice(first, last) for first, last in pairwise(ends)]


def responses(lines: tuple[ContactLine, ...], bodies: PerGear[SolidCompliance], modulus: float) -> Responses:
    """The responses of both bodies to loads on all cells of a position."""
    smooth = PerGear.each(lambda role: _smooth(lines, bodies.pick(role), role))
    sizes = [len(line.across) for line in lines]
    apart = np.full((sum(sizes), sum(sizes)), np.inf)
    start = 0
    for line, size in zip(lines, sizes, strict=True):
        here = slice(start, start + size)
        apart[here, here] = np.linalg.norm(line.points[:, None] - line.points, axis=-1)
        start += size
    return Responses(lines, smooth, apart, np.concatenate([line.lengths for line in lines]), modulus)


def _smooth(lines: tuple[ContactLine, ...], body: SolidCompliance, role: Role) -> Floats:
    places = [line.places.pick(role) for line in lines]
    rows, columns = [body.moved_weights(each) for each in places], [body.load_weights(each) for each in places]
    blocks: list[list[Floats]] = []
    for moved, place, row in zip(lines, places, rows, strict=True):
        blocks.append([])
        for loaded, column in zip(lines, columns, strict=True):
            response = body.moved.get((moved.tooth - loaded.tooth) * TOOTH_ORDER.pick(role))
            block = np.zeros((len(row), len(column))) if response is None else row @ response @ column.T
            if moved is loaded:
                block += body.images.normal(place, place)
            blocks[-1].append(block)
    matrix = np.block(blocks)
    result: Floats = (matrix + matrix.T) / 2
    return result


@dataclass(frozen=True)
class LineSolution:
    """Forces (n,) in N of the cells, the approach along the normal (mm), and the pinion's and the wheel's parts of it.

    `rigid` (mm) is what of the approach needs no load.
    """

    given: Responses
    gaps: Gaps
    forces: Floats
    approach: float
    rigid: float
    parts: PerGear[float]

    @property
    def half_widths(self) -> Floats:
        """Hertz half width (n,) in mm of each cell."""
        return half_widths(self.given, self.gaps.radii, self.forces)

    @property
    def pressures(self) -> Floats:
        """Greatest pressure (n,) in MPa across each cell, Hertz's."""
        return peak_pressure(self.forces / self.given.lengths, self.gaps.radii, self.given.modulus)


def half_widths(given: Responses, radii: Floats, forces: Floats) -> Floats:
    """Hertz half widths (n,) in mm of cells that carry `forces` (n,) in N."""
    return half_width(forces / given.lengths, radii, given.modulus)


def solve_lines(given: Responses, gap: Gaps, force: float) -> LineSolution:
    """Press the gears together with the normal force `force` (N). Raises SolverError."""
    even = force * given.lengths / given.lengths.sum()
    smooth, forces, ones = given.both, even, np.ones(given.cells)
    widths, pressed = half_widths(given, gap.radii, even), np.ones(given.cells, bool)
    spread = _spread(given, widths)
    for count in range(_ROUNDS):
        kernel = given.half_space(widths)
        found, approach = complementary(smooth + kernel, gap.normal, ones, force, pressed)
        change = np.abs(found - forces).max() / found.max()
        forces, pressed = found, found > 0
        if change < _SETTLED:
            break
        # Later half the step: a cell at the end of a contact could come and go for ever.
        step = 1.0 if count < _FREE_ROUNDS else 0.5
        widths = widths + step * (half_widths(given, gap.radii, spread @ np.maximum(forces, _LEAST * even)) - widths)
    else:
        raise SolverError(f"the widths of the contact did not settle within {_ROUNDS} rounds")
    contact = float(forces @ kernel @ forces)
    parts = given.smooth.map(lambda matrix: float(forces @ matrix @ forces + contact / 2) / force)
    return LineSolution(given, gap, forces, approach, float(gap.normal.min()), parts)


def _spread(given: Responses, widths: Floats) -> Floats:
    """Weights (n, n) that even out forces over about a half width along the line.

    An ellipse cannot change its width faster than that; cells that are shorter would each go their own way.
    """
    near = np.exp(-((given.apart / widths[:, None]) ** 2)) * given.lengths
    result: Floats = near / near.sum(axis=1, keepdims=True) * (given.lengths[:, None] / given.lengths)
    return result
