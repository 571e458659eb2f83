"""Frictionless contact along lines: the load of every cell, and the approach of the gears.

Across the line the pressure is Hertz's, an ellipse as wide as the load of its place makes it; along the line loads act on each
other as on a half-space. c = 0.3033 a is the distance at which a point load moves the middle of the ellipse as the ellipse does
(the mean of ln|x| over a semi-ellipse is ln(a/2) - 1/2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.contact.shared.complementarity import complementary
from gearcad.contact.shared.engaged import TOOTH_ORDER
from gearcad.contact.solid.contact_lines import ContactLine, Gaps
from gearcad.contact.solid.flank import SolidCompliance
from gearcad.errors import SolverError
from gearcad.per_gear import PerGear, Role
from gearcad.rating.hertz import half_width, peak_pressure

__all__ = [
    "LineSolution",
    "Responses",
    "StartCells",
    "evened_loads",
    "half_widths",
    "plain_widths",
    "responses",
    "solve_lines",
]


OWN_DISTANCE = math.exp(-0.5) / 2
"""c/a: 0.30327."""

_LEAST = 1e-3
"""Share of the mean load per length for which the ellipse of a cell is wide enough, however little it carries."""

_ROUNDS = 60
_SETTLED = 1e-9
"""Rounds of fitting the ellipses to the loads, and the relative error of half widths at which they have settled."""

_EVENED = (1, 2, 4, 8)
"""Half widths of an even load over which loads are evened out, in turn until the contact settles: where a few cells carry all,
their own half widths are as many times greater.
"""

_SHARES, _DECREASE = (1.0, 0.5, 0.25), 0.1
"""Shares of Newton's step that are tried, and the share of the decrease it promises that one must reach: with shorter ones it
creeps along a kink."""

_PARTS = (0.5, 0.3, 0.8)
"""Shares of the fixed point's step, in turn, that are taken where Newton's does not help: one alone could repeat a cycle."""

_LONGEST = 1.5
"""Greatest change of a half width's logarithm in one step."""


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

    def half_space_slopes(self, half_widths: Floats) -> Floats:
        """Return the derivatives (n, n) in mm/N of `half_space` by the logarithm of the half width of the loaded cell."""
        result = np.zeros_like(self.apart)
        for here in self._own_cells:
            apart, own, half = self.apart[here, here], OWN_DISTANCE * half_widths[here], self.lengths[here] / 2
            far, near = apart + half, apart - half
            kernel = (near / np.hypot(near, own) - far / np.hypot(far, own)) / self.lengths[here]
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

    `rigid` (mm) is what of the approach needs no load, `starts` are the cells beside the start of a linear relief.
    """

    given: Responses
    gaps: Gaps
    forces: Floats
    approach: float
    rigid: float
    parts: PerGear[float]
    starts: StartCells | None = None

    @property
    def half_widths(self) -> Floats:
        """Half width (n,) in mm of each cell, Hertz's but for those beside the start of a linear relief."""
        result = half_widths(self.given, self.gaps.radii, self.forces)
        if self.starts is not None:
            result[self.starts.cells] = self.starts.half_widths
        return result

    @property
    def pressures(self) -> Floats:
        """Greatest pressure (n,) in MPa across each cell, Hertz's but for those beside the start of a linear relief."""
        result = peak_pressure(self.forces / self.given.lengths, self.gaps.radii, self.given.modulus)
        if self.starts is not None:
            result[self.starts.cells] = np.where(self.forces[self.starts.cells] > 0, self.starts.peaks, 0.0)
        return result


@dataclass(frozen=True)
class StartCells:
    """Cells (k,) beside the start of a linear relief: half widths in mm, greatest pressures in MPa.

    `sound` is False where these are not to be told: the transition is too short for the places of a contact, or the end of a
    flank lies in it.
    """

    cells: Wholes
    half_widths: Floats
    peaks: Floats
    sound: Bools


def half_widths(given: Responses, radii: Floats, forces: Floats) -> Floats:
    """Hertz half widths (n,) in mm of cells that carry `forces` (n,) in N."""
    return half_width(forces / given.lengths, radii, given.modulus)


def plain_widths(given: Responses, curvature: Floats, helix: float, forces: Floats) -> Floats:
    """Return Hertz's half widths in mm of cells on exact flanks, whose `curvature` (1/mm) is that in the transverse section.

    `helix` (rad) is on the base cylinder, `forces` in N.
    """
    return half_widths(given, 1 / (curvature * math.cos(helix)), forces)


def evened_loads(given: Responses, gap: Gaps, forces: Floats) -> Floats:
    """Return the loads per length (n,) in N/mm that decide how wide cells are: forces (n,) in N, evened out along the lines."""
    even = forces.sum() * given.lengths / given.lengths.sum()
    spread = _spread(given, half_widths(given, gap.radii, even))
    result: Floats = spread @ np.maximum(forces, _LEAST * even) / given.lengths
    return result


def solve_lines(given: Responses, gap: Gaps, force: float, like: Floats | None = None) -> LineSolution:
    """Press the gears together with the normal force `force` (N), from forces (n,) `like` those sought. Raises SolverError.

    Newton's rule on the logarithms of the half widths: each cell's width must be that of Hertz for the load that it then
    carries. Steps are shortened until the residual falls; the cells that carry change with the widths.
    """
    for times in _EVENED:
        problem = _Widths(given, gap, force, given.both, force * given.lengths / given.lengths.sum(), times)
        state = problem.settled(problem.even if like is None else like)
        if state.error < _SETTLED:
            break
    else:
        raise SolverError(
            f"the widths of the contact did not settle (half width {state.widths.max():.3g} mm, "
            f"off by {100 * state.error:.2g} %): reduce load.torque or mounting.misalignment, or raise check.refinement"
        )
    forces = state.forces
    contact = float(forces @ state.kernel @ forces)
    parts = given.smooth.map(lambda matrix: float(forces @ matrix @ forces + contact / 2) / force)
    return LineSolution(given, gap, forces, state.approach, float(gap.normal.min()), parts)


@dataclass(frozen=True)
class _State:
    """Contact with ellipses of half `widths` (n,) in mm: `forces` (n,) in N, and the half widths `wanted` (n,) by these."""

    widths: Floats
    kernel: Floats
    forces: Floats
    approach: float
    wanted: Floats

    @property
    def residual(self) -> Floats:
        """Logarithm (n,) of the wanted half widths over those that were taken."""
        result: Floats = np.log(self.wanted / self.widths)
        return result

    @property
    def error(self) -> float:
        """Greatest size of the residual."""
        return float(np.abs(self.residual).max())


@dataclass(frozen=True)
class _Widths:
    """The equation for the half widths of all cells; `smooth` (n, n) in mm/N, `even` (n,) the even load in N, loads evened out
    over so many `times` its half widths.
    """

    given: Responses
    gap: Gaps
    force: float
    smooth: Floats
    even: Floats
    times: int = 1

    @cached_property
    def spread(self) -> Floats:
        """Weights (n, n) that even out forces along the lines."""
        return _spread(self.given, self.times * half_widths(self.given, self.gap.radii, self.even))

    def settled(self, like: Floats) -> _State:
        """Return the state after the last round, from the widths of forces (n,) in N on."""
        evened = self.spread @ np.maximum(like, _LEAST * self.even)
        state = self.at(half_widths(self.given, self.gap.radii, evened), like > 0)
        for count in range(_ROUNDS):
            if state.error < _SETTLED:
                break
            state = self.better(state, _PARTS[count % len(_PARTS)])
        return state

    def at(self, widths: Floats, start: Bools) -> _State:
        """Solve the contact for given half widths (n,) in mm, from the cells that carry at the `start` (n,)."""
        kernel = self.given.half_space(widths)
        forces, approach = complementary(self.smooth + kernel, self.gap.normal, np.ones(len(widths)), self.force, start)
        evened = self.spread @ np.maximum(forces, _LEAST * self.even)
        return _State(widths, kernel, forces, approach, half_widths(self.given, self.gap.radii, evened))

    def better(self, state: _State, part: float) -> _State:
        """Return a state of less residual by Newton's step or, where a kink stops it, after a `part` of the fixed point's."""
        carries = state.forces > 0
        step = self._newton_step(state)
        longest = min(1.0, _LONGEST / max(float(np.abs(step).max()), _SETTLED))
        for share in (longest * each for each in _SHARES):
            tried = self.at(state.widths * np.exp(share * step), carries)
            if np.linalg.norm(tried.residual) < (1 - _DECREASE * share) * np.linalg.norm(state.residual):
                return tried
        # The fixed point's own step may raise the residual: it leaves the kink at which Newton's ends.
        return self.at(state.widths * np.exp(part * state.residual), carries)

    def _newton_step(self, state: _State) -> Floats:
        """Return the change (n,) of the logarithms of the half widths by the exact derivative, while the same cells carry."""
        carry = np.flatnonzero(state.forces > 0)
        count, cells = len(carry), len(state.widths)
        system = np.zeros((count + 1, count + 1))
        system[:count, :count] = (self.smooth + state.kernel)[carry[:, None], carry]
        system[:count, count] = system[count, :count] = -1.0
        moved = np.zeros((count + 1, cells))
        moved[:count] = -(self.given.half_space_slopes(state.widths) * state.forces)[carry]
        changed = np.zeros((cells, cells))
        evened = self.spread @ np.maximum(state.forces, _LEAST * self.even)
        try:
            changed[carry] = np.linalg.solve(system, moved)[:count]
            changed[state.forces <= _LEAST * self.even] = 0.0
            slopes = (self.spread @ changed) / (2 * evened[:, None])
            return np.asarray(np.linalg.solve(np.eye(cells) - slopes, state.residual), float)
        except np.linalg.LinAlgError:
            return state.residual


def _spread(given: Responses, widths: Floats) -> Floats:
    """Weights (n, n) that even out forces over about a half width along the line.

    An ellipse cannot change its width faster than that; cells that are shorter would each go their own way.
    """
    near = np.exp(-((given.apart / widths[:, None]) ** 2)) * given.lengths
    result: Floats = near / near.sum(axis=1, keepdims=True) * (given.lengths[:, None] / given.lengths)
    return result
