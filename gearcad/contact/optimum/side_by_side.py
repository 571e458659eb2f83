"""Contacts of many variants on the same bodies, their systems solved together.

The ellipse of a cell follows its load by the diagonal alone: other cells hardly see how wide it is.
"""

from __future__ import annotations

import math

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.contact.solid.line_contact import OWN_DISTANCE, Responses, half_widths

__all__ = ["press"]


_BED = 0.15
"""Stiffness of a bed of springs, per length, that deflects about as teeth do: a share of the reduced modulus."""

_LEAST = 1e-3
"""Share of the mean load per length for which the ellipse of a cell is wide enough, however little it carries."""

_OPEN = 1e-9
"""Overlap (mm) that is rounding."""

_ROUNDS = 25
_SETTLED = 1e-4
"""Most rounds of finding the cells that carry, and the relative change of the approach at which their widths have settled."""


def press(given: Responses, matrix: Floats, gap: Floats, radii: Floats, force: float) -> tuple[Floats, Floats]:
    """Forces (v, n) in N of all cells, and approaches (v,) in mm, infinite where no set of cells settles.

    `matrix` (n, n) in mm/N is the compliance but for what a cell's own ellipse adds to the diagonal; `gap` and `radii` (v, n)
    are in mm, `force` in N.
    """
    least = _LEAST * force * given.lengths / given.lengths.sum()
    forces, approach = _on_springs(gap, given.lengths, force, _BED * given.modulus)
    active = forces > 0
    found, approaches = np.zeros_like(gap), np.full(len(gap), np.inf)
    todo = np.arange(len(gap))
    for _ in range(_ROUNDS):
        own = _own(given, half_widths(given, radii[todo], np.maximum(forces, least)))
        forces, changed = _equations(matrix, own, gap[todo], force, active)
        opening = forces @ matrix.T + own * forces + gap[todo] - changed[:, None]
        wrong = np.where(active, forces <= 0, opening < -_OPEN)
        settled = ~wrong.any(axis=1) & (np.abs(changed - approach) < _SETTLED * np.abs(changed))
        found[todo[settled]], approaches[todo[settled]] = forces[settled], changed[settled]
        left = ~settled
        todo, forces, approach, active = todo[left], forces[left], changed[left], (active ^ wrong)[left]
        if not len(todo):
            break
        empty = ~active.any(axis=1)
        active[empty, gap[todo[empty]].argmin(axis=1)] = True
    return found, approaches


def _on_springs(gap: Floats, lengths: Floats, force: float, stiffness: float) -> tuple[Floats, Floats]:
    """Forces (v, n) and approach (v,) of cells that do not feel each other: a start, closed by sorting the gaps."""
    order = np.argsort(gap, axis=1)
    ordered, along = np.take_along_axis(gap, order, 1), lengths[order]
    levels = (force / stiffness + np.cumsum(along * ordered, axis=1)) / np.cumsum(along, axis=1)
    last = (ordered < levels).sum(axis=1) - 1
    approach = levels[np.arange(len(gap)), last]
    return stiffness * lengths * np.maximum(approach[:, None] - gap, 0.0), approach


def _own(given: Responses, widths: Floats) -> Floats:
    """What the ellipse of each cell adds to its own compliance (v, n) in mm/N: the diagonal of `Responses.half_space`."""
    result: Floats = 2 * np.arcsinh(given.lengths / 2 / (OWN_DISTANCE * widths)) / given.lengths / (math.pi * given.modulus)
    return result


def _equations(matrix: Floats, own: Floats, gap: Floats, force: float, active: Bools) -> tuple[Floats, Floats]:
    """Forces and approach where exactly the `active` cells touch: systems of equal size, filled up by rows of identity."""
    most = int(active.sum(axis=1).max())
    cells = np.argsort(~active, axis=1, kind="stable")[:, :most]
    real = np.take_along_axis(active, cells, 1)
    system = matrix[cells[:, :, None], cells[:, None, :]] * (real[:, :, None] & real[:, None, :])
    steps = np.arange(most)
    system[:, steps, steps] += np.where(real, np.take_along_axis(own, cells, 1), 1.0)
    right = np.stack([np.where(real, np.take_along_axis(gap, cells, 1), 0.0), real.astype(float)], -1)
    by_gap, by_approach = np.moveaxis(np.linalg.solve(system, right), -1, 0)
    approach = (force + by_gap.sum(axis=1)) / by_approach.sum(axis=1)
    forces = np.zeros_like(gap)
    np.put_along_axis(forces, cells, approach[:, None] * by_approach - by_gap, 1)
    return forces, approach
