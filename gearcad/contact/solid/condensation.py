"""A sector condensed to its cuts (static condensation): its section is divided in two, and again, and nodes go with the part
that needs them last.

Fronts are dense (nested dissection, multifrontal Cholesky): above a node of the section stand all nodes of the sweep, so even
small parts make large blocks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import SolverError
from gearcad.progress import Share, unheard

__all__ = ["Condensed", "condense", "parts_of"]


_SMALLEST = 8
"""Quadrangles of a part that is not divided further."""

_DIRECTIONS, _SHARES = 16, (0.42, 0.46, 0.5, 0.54, 0.58)
"""Lines along which a division is tried: directions, and parts of the quadrangles on one side."""


@dataclass(frozen=True)
class SectionPart:
    """Some quadrangles of a section, divided or not, the nodes (n,) that nothing else needs, and how many others do."""

    quads: Wholes
    own: Wholes
    shared: int
    halves: tuple[SectionPart, ...]

    @property
    def work(self) -> float:
        """Of eliminating its own nodes, in no unit: multiplications over the cube of the nodes above one of the section."""
        own = len(self.own)
        return own**3 / 3 + own**2 * self.shared + own * self.shared**2


def parts_of(points: Floats, quads: Wholes, kept: Wholes) -> SectionPart:
    """Divide a section: nodes `points` (n, 2), quadrangles (m, 8), and nodes that are not to go."""
    uses = np.bincount(quads.ravel(), minlength=len(points))
    uses[kept] = len(quads) * 8 + 1  # more than there can be
    return _divided(points, quads, np.arange(len(quads)), uses)


def _divided(points: Floats, quads: Wholes, chosen: Wholes, uses: Wholes) -> SectionPart:
    nodes, times = np.unique(quads[chosen], return_counts=True)
    complete = nodes[times == uses[nodes]]
    if len(chosen) <= _SMALLEST:
        return SectionPart(chosen, complete, len(nodes) - len(complete), ())
    halves = tuple(_divided(points, quads, chosen[half], uses) for half in _halves(points, quads[chosen]))
    gone = np.concatenate([_all_own(half) for half in halves])
    return SectionPart(chosen, np.setdiff1d(complete, gone), len(nodes) - len(complete), halves)


def _halves(points: Floats, quads: Wholes) -> tuple[Wholes, Wholes]:
    """The quadrangles on both sides of a line with the fewest nodes on it, among lines that leave a fair part on each."""
    centres = points[quads[:, :4]].mean(axis=1)
    best: tuple[int, Wholes, Wholes] | None = None
    for angle in np.linspace(0, np.pi, _DIRECTIONS, endpoint=False):
        order = np.argsort(centres @ [np.cos(angle), np.sin(angle)], kind="stable")
        for share in _SHARES:
            count = round(share * len(order))
            first, second = order[:count], order[count:]
            shared = len(np.intersect1d(quads[first], quads[second]))
            if best is None or shared < best[0]:
                best = (shared, first, second)
    assert best is not None  # there are directions
    return best[1], best[2]


def _all_work(part: SectionPart) -> float:
    return part.work + sum(_all_work(half) for half in part.halves)


def _all_own(part: SectionPart) -> Wholes:
    return np.concatenate([part.own, *(_all_own(half) for half in part.halves)])


@dataclass(frozen=True)
class _Front:
    """One step: dofs that go, those that take over their load, L with L L.T the matrix of the first, L^-1 times that across."""

    own: Wholes
    aside: Wholes
    lower: Floats
    across: Floats


@dataclass(frozen=True)
class Condensed:
    """The elimination, front by front, and what it leaves: the symmetric `matrix` on the dofs `kept`."""

    fronts: tuple[_Front, ...]
    kept: Wholes
    matrix: Floats

    def forward(self, loads: Floats) -> tuple[list[Floats], Floats]:
        """What `backward` needs of loads (dofs, m), and the loads (kept, m) that arrive at the dofs that are kept."""
        import scipy.linalg

        left, found = loads.copy(), []
        for front in self.fronts:
            solved = scipy.linalg.solve_triangular(front.lower, left[front.own], lower=True, check_finite=False)
            left[front.aside] -= front.across.T @ solved
            found.append(solved)
        return found, left[self.kept]

    def backward(self, found: list[Floats] | None, moved: Floats) -> Floats:
        """Displacements (dofs, m); `moved` holds those of the kept dofs and is 0 elsewhere, `found` None stands for no load."""
        import scipy.linalg

        moved = moved.copy()
        for place in range(len(self.fronts) - 1, -1, -1):
            front = self.fronts[place]
            right = -front.across @ moved[front.aside]
            if found is not None:
                right += found[place]
            moved[front.own] = scipy.linalg.solve_triangular(front.lower, right, lower=True, trans=1, check_finite=False)
        return moved


def condense(
    part: SectionPart,
    dofs_of: Callable[[Wholes], Wholes],
    matrix_of: Callable[[Wholes], tuple[Wholes, Floats]],
    kept: Wholes,
    tell: Share = unheard,
) -> Condensed:
    """Eliminate all but the dofs `kept`.

    `dofs_of` gives the dofs above section nodes, `matrix_of` the dofs of some quadrangles and their dense matrix, held dofs
    left out. Raises SolverError for a matrix that is not positive definite.
    """
    fronts: list[_Front] = []
    whole, done = _all_work(part), 0.0

    def finished(front: _Front, part: SectionPart) -> None:
        nonlocal done
        fronts.append(front)
        done += part.work
        tell(done / whole)

    dofs, matrix = _eliminated(part, dofs_of, matrix_of, finished)
    place = np.searchsorted(dofs, kept)
    result = matrix[np.ix_(place, place)]
    return Condensed(tuple(fronts), kept, (result + result.T) / 2)


def _eliminated(
    part: SectionPart,
    dofs_of: Callable[[Wholes], Wholes],
    matrix_of: Callable[[Wholes], tuple[Wholes, Floats]],
    finished: Callable[[_Front, SectionPart], None],
) -> tuple[Wholes, Floats]:
    """The dofs (sorted) that a part leaves, and the matrix on them; `finished` gets its fronts."""
    import scipy.linalg

    given = [_eliminated(half, dofs_of, matrix_of, finished) for half in part.halves] or [matrix_of(part.quads)]
    every = np.unique(np.concatenate([dofs for dofs, _ in given]))
    goes = np.isin(every, dofs_of(part.own), assume_unique=True)
    own, aside = every[goes], every[~goes]
    # Those that go come first, so that the parts of the matrix are slices.
    place = np.empty(len(every), int)
    place[goes], place[~goes] = np.arange(len(own)), len(own) + np.arange(len(aside))
    matrix = np.zeros((len(every), len(every)))
    for dofs, block in given:
        here = place[np.searchsorted(every, dofs)]
        for row, values in zip(here, block, strict=True):  # an order of magnitude faster than all rows at once
            matrix[row, here] += values
    count = len(own)
    try:
        lower = scipy.linalg.cholesky(matrix[:count, :count], lower=True, check_finite=False)
    except np.linalg.LinAlgError as error:
        raise SolverError(f"the stiffness matrix of a gear body could not be factorised ({error})") from error
    across = scipy.linalg.solve_triangular(lower, matrix[:count, count:], lower=True, check_finite=False)
    finished(_Front(own, aside, lower, across), part)
    rest = matrix[count:, count:]
    rest -= across.T @ across
    return aside, rest
