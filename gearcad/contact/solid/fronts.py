"""Multifrontal Cholesky of a tooth sector, with dense factors by BLAS and LAPACK, and equal sectors in a row.

Matrices of doubles lie column by column, as a whole; of symmetric ones, and of factors, the lower triangle is there. A factor L
has the inverses of the blocks on its diagonal in their place: all that it solves is then products of matrices, which are up to
twice as fast as BLAS's own solutions with a triangle.

Fronts are dense, and BLAS works in place: matrices lie column by column, of symmetric ones the lower triangle, loads row by
row.

The turn about the middle of a row changes its ends (see `half_turn`), so the cut behind tells all: F u are the forces there
where the cut ahead moves by the same u, turned, or by its opposite. A row is doubled, or goes on both sides of another one: any
number of sectors is a few steps away, and a cut between two equal rows is solved in two halves, for its own even and odd parts.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from threading import Lock
from typing import Any, NamedTuple

import numpy as np

from gearcad.contact.solid.dissection import PARITIES, ElementBlock, SolidPart
from gearcad.core.errors import SolverError
from gearcad.core.records import Floats, Wholes
from gearcad.core.runtime import on_all_cores

_BLOCK = 128
"""Rows of a block on the diagonal of a factor."""

_BYTES = 8
"""Size (bytes) of a double."""


def factorise(matrix: Floats) -> int:
    """Make L with L L.T of a matrix (n, n); else which of its leading minors is not positive."""
    failed, whole = ctypes.c_int(0), _Part.of(matrix)
    _routine("lapack", "dpotrf", 5)(b"L", _size(whole.rows), whole.at, _size(whole.step), ctypes.byref(failed))
    if not failed.value:
        for first, last in _blocks(whole.rows):
            block = whole.some(first, last, first, last)
            arguments = (_size(block.rows), block.at, _size(block.step), ctypes.byref(failed))
            _routine("lapack", "dtrtri", 6)(b"L", b"N", *arguments)
    return failed.value


def solve_above(lower: Floats, right: Floats) -> None:
    """Make L^-1 R of R (n, m)."""
    given, result = _Part.of(lower), _Part.of(right)
    for first, last in _blocks(given.rows):
        rows = result.some(first, last, 0, result.columns)
        _subtract(rows, given.some(first, last, 0, first), result.some(0, first, 0, result.columns))
        _multiply(given.some(first, last, first, last), rows, side=b"L")


def solve_aside(lower: Floats, right: Floats, *, transposed: bool) -> None:
    """Make R L^-1, or R L^-T, of R (m, n)."""
    given, result = _Part.of(lower), _Part.of(right)
    blocks = _blocks(given.rows)
    for first, last in blocks if transposed else blocks[::-1]:
        columns, own = result.some(0, result.rows, first, last), given.some(first, last, first, last)
        if transposed:
            _subtract(columns, result.some(0, result.rows, 0, first), given.some(first, last, 0, first), turned=b"T")
            _multiply(own, columns, side=b"R", turned=b"T")
        else:
            known, across = result.some(0, result.rows, last, given.rows), given.some(last, given.rows, first, last)
            _subtract(columns, known, across)
            _multiply(own, columns, side=b"R")


def solved_rows(lower: Floats, right: Floats) -> Floats:
    """Return (L L.T)^-1 R of R (n, m), row by row."""
    result = np.array(right, order="C")
    solve_aside(lower, result.T, transposed=True)  # rows of C are columns of Fortran
    solve_aside(lower, result.T, transposed=False)
    return result


def subtract_product(result: Floats, first: Floats, second: Floats, *, transposed: bool) -> None:
    """Make C - A B, or C - A B.T, of C."""
    _subtract(_Part.of(result), _Part.of(first), _Part.of(second), turned=b"T" if transposed else b"N")


def subtract_square(across: Floats, rest: Floats) -> None:
    """Make C - A.T A of C (m, m) and A (n, m)."""
    given, result = _Part.of(across), _Part.of(rest)
    sizes = (_size(given.columns), _size(given.rows))
    arguments = (_number(-1.0), given.at, _size(given.step), _number(1.0), result.at, _size(result.step))
    _routine("blas", "dsyrk", 10)(b"L", b"T", *sizes, *arguments)


class _Part(NamedTuple):
    """A block of a matrix: index of its first number, its rows and columns, and the step from column to column."""

    at: int
    rows: int
    columns: int
    step: int

    @classmethod
    def of(cls, matrix: Floats) -> _Part:
        """Return all of a matrix as a part."""
        assert matrix.flags.f_contiguous and matrix.dtype == float
        rows, columns = matrix.shape
        return cls(matrix.ctypes.data, rows, columns, max(rows, 1))

    def some(self, first_row: int, last_row: int, first: int, last: int) -> _Part:
        """Rows and columns from the first one to before the last one."""
        at = self.at + _BYTES * (first_row + first * self.step)
        return _Part(at, last_row - first_row, last - first, self.step)


def _blocks(rows: int) -> list[tuple[int, int]]:
    """First row, and the one after the last, of each block on the diagonal."""
    return [(first, min(first + _BLOCK, rows)) for first in range(0, rows, _BLOCK)]


def _subtract(result: _Part, first: _Part, second: _Part, *, turned: bytes = b"N") -> None:
    """Make C - A B, or C - A B.T, of C."""
    if not result.rows or not result.columns or not first.columns:
        return
    sizes = (_size(result.rows), _size(result.columns), _size(first.columns))
    factors = (_number(-1.0), first.at, _size(first.step), second.at, _size(second.step), _number(1.0))
    _routine("blas", "dgemm", 13)(b"N", turned, *sizes, *factors, result.at, _size(result.step))


def _multiply(triangle: _Part, result: _Part, *, side: bytes, turned: bytes = b"N") -> None:
    """Make A B, or with `side` R B A or B A.T, of B, with a lower triangle A."""
    if not result.rows or not result.columns:
        return
    sizes = (_size(result.rows), _size(result.columns), _number(1.0))
    _routine("blas", "dtrmm", 11)(
        side, b"L", turned, b"N", *sizes, triangle.at, _size(triangle.step), result.at, _size(result.step)
    )


@cache
def _routine(library: str, name: str, arguments: int) -> Callable[..., None]:
    from numba.extending import get_cython_function_address

    address = get_cython_function_address(f"scipy.linalg.cython_{library}", name)
    routine: Callable[..., None] = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * arguments)(address)
    return routine


def _size(value: int) -> Any:
    return ctypes.byref(ctypes.c_int(value))


def _number(value: float) -> Any:
    return ctypes.byref(ctypes.c_double(value))


_APART = 0.5
"""Largest share of all operations in a part that is eliminated beside other parts."""


def node_dofs(nodes: Wholes) -> Wholes:
    """Dofs (..., 3 n) of nodes (..., n)."""
    return (3 * nodes[..., None] + np.arange(3)).reshape(*nodes.shape[:-1], -1)


@dataclass(frozen=True)
class EliminationStep:
    """One step: nodes that go, those that take over their load, L of the matrix of the first, L^-1 times that across.

    Loads and displacements are rows, three of each node, its own nodes first.
    """

    own: Wholes
    aside: Wholes
    lower: Floats
    across: Floats

    def forward(self, loads: Floats) -> None:
        """Make L^-1 times the loads of its own nodes, and what is left of them for the others, of loads (n, m)."""
        solved, left = np.split(loads.T, [3 * len(self.own)], axis=1)  # rows of C are columns of Fortran
        solve_aside(self.lower, solved, transposed=True)
        subtract_product(left, solved, self.across, transposed=False)

    def backward(self, moved: Floats) -> None:
        """Make displacements of its own nodes of what `forward` made there - 0 where there is no load - and of the others'."""
        solved, aside = np.split(moved.T, [3 * len(self.own)], axis=1)
        subtract_product(solved, aside, self.across, transposed=True)
        solve_aside(self.lower, solved, transposed=False)


class Blocks(NamedTuple):
    """A symmetric matrix on dofs that go and others: [[own, across], [across.T, rest]]."""

    own: Floats
    across: Floats
    rest: Floats

    def eliminated(self) -> Blocks:
        """L (see `dense`), L^-1 across, and the matrix on the others, all in place.

        Raises SolverError if it is not positive definite.
        """
        if not len(self.own):
            return self
        if failed := factorise(self.own):
            raise SolverError(f"the stiffness matrix of a gear body could not be factorised (its minor {failed})")
        if len(self.rest):
            solve_above(self.own, self.across)
            subtract_square(self.across, self.rest)
        return self


class Store:
    """Memory for matrices that are kept: one piece, which the system gets back as a whole."""

    def __init__(self, numbers: int) -> None:
        self._left, self._lock = np.zeros(numbers), Lock()

    def zeros(self, rows: int, columns: int) -> Floats:
        """Return a matrix (rows, columns) of zeros."""
        with self._lock:
            taken, self._left = np.split(self._left, [rows * columns])
        return taken.reshape(rows, columns, order="F")


class _Room:
    """Memory of matrices no longer needed, reused for new ones, because memory from the system is cleared page by page, which
    is slow.
    """

    def __init__(self) -> None:
        self._left: list[Floats] = []

    def zeros(self, size: int) -> Floats:
        """Return a matrix (size, size) of zeros."""
        fitting = [each for each in self._left if each.size >= size**2]
        if fitting:
            chosen = min(fitting, key=len)
            self._drop(chosen)
            chosen[: size**2] = 0.0
        else:
            if self._left:
                self._drop(max(self._left, key=len))
            chosen = np.zeros(size**2)
        return chosen[: size**2].reshape(size, size, order="F")

    def _drop(self, chosen: Floats) -> None:
        self._left = [each for each in self._left if each is not chosen]

    def take_back(self, matrix: Floats) -> None:
        """Take back a matrix that `zeros` gave and that is no longer needed."""
        base = matrix.base
        assert base is not None
        self._left.append(base)


@dataclass
class Elimination:
    """Of the parts of a mesh of so many `nodes`: `nodes_of` gives those (m, 20) of the hexahedra of a box, `matrices_of` their
    matrices (m, 60, 60). What stays is in `store`; `done` hears the operations of each part.
    """

    nodes: int
    nodes_of: Callable[[ElementBlock], Wholes]
    matrices_of: Callable[[ElementBlock], Floats]
    store: Store
    done: Callable[[float], None]
    fronts: list[EliminationStep] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._places = np.full(self.nodes, -1)  # but for the nodes of the part that is put together
        self._room = _Room()

    def on_all_cores(self, part: SolidPart) -> Floats:
        """`eliminated`, the greater parts of it side by side."""
        apart = _apart(part, _APART * part.all_flops)

        def work(each: SolidPart) -> tuple[list[EliminationStep], Floats]:
            helper = replace(self, fronts=[])
            return helper.fronts, helper.eliminated(each)

        known = {}
        for each, (fronts, matrix) in zip(apart, on_all_cores(work, apart), strict=True):
            self.fronts += fronts
            known[id(each)] = matrix
        matrix = self.eliminated(part, known)
        self._room = _Room()
        return matrix

    def eliminated(self, part: SolidPart, known: dict[int, Floats] | None = None) -> Floats:
        """The matrix, its lower triangle only, on the dofs of the nodes that a part leaves; `known` are those of some parts of
        it, by their identities, and go.
        """
        known = {} if known is None else known
        if id(part) in known:
            return known.pop(id(part))
        blocks = self._assembled(part, known).eliminated()
        if len(part.own):
            self.fronts.append(EliminationStep(part.own, part.aside, blocks.own, blocks.across))
        self.done(part.flops)
        return blocks.rest

    def _assembled(self, part: SolidPart, known: dict[int, Floats]) -> Blocks:
        from gearcad.contact.solid.kernels import add_block, add_hexahedra

        given = [(each, self.eliminated(each, known)) for each in part.parts]
        own, rest = 3 * len(part.own), 3 * len(part.aside)
        blocks = Blocks(self.store.zeros(own, own), self.store.zeros(own, rest), self._room.zeros(rest))
        every = np.r_[part.own, part.aside]
        self._places[every] = np.arange(len(every))
        while given:
            each, matrix = given.pop()
            add_block(matrix, self._places[each.aside], *blocks)
            self._room.take_back(matrix)
        if part.box is not None:
            add_hexahedra(self.matrices_of(part.box), self._places[self.nodes_of(part.box)], *blocks)
        self._places[every] = -1
        return blocks


def _apart(part: SolidPart, most: float) -> list[SolidPart]:
    """The parts of one, or of its parts, that are no more than so many operations."""
    if part.all_flops <= most or not part.parts:
        return [part]
    return [each for one in part.parts for each in _apart(one, most)]


@dataclass(frozen=True)
class Reversal:
    """Effect of the half turn on the dofs of a cut: dof n becomes dof `image` (n,) times `signs` (n,)."""

    image: Wholes
    signs: Floats

    def rows(self, values: Floats) -> Floats:
        """Values (n, ...) after the turn."""
        result: Floats = values[self.image] * self.signs.reshape(-1, *[1] * (values.ndim - 1))
        return result

    def both(self, matrix: Floats) -> Floats:
        """A matrix (n, n), its rows and columns after the turn."""
        return self.rows(self.rows(matrix).T).T

    @cached_property
    def _pairs(self) -> tuple[Wholes, Wholes]:
        """Dofs (m,) of two that change places, the first of each, and those that stay."""
        every = np.arange(len(self.image))
        return every[every < self.image], every[every == self.image]

    def part(self, values: Floats, parity: int) -> Floats:
        """Return the even or odd part of values (n, ...) in an orthonormal basis of such values."""
        first, alone = self._pairs
        alone = alone[self.signs[alone] == PARITIES[parity]]
        turned = PARITIES[parity] * self.signs[first].reshape(-1, *[1] * (values.ndim - 1)) * values[self.image[first]]
        return np.concatenate([(values[first] + turned) / np.sqrt(2), values[alone]])

    def whole(self, part: Floats, parity: int) -> Floats:
        """The values (n, m) of a part."""
        first, alone = self._pairs
        alone = alone[self.signs[alone] == PARITIES[parity]]
        values = np.zeros((len(self.image), part.shape[1]))
        values[first] = part[: len(first)] / np.sqrt(2)
        values[self.image[first]] = PARITIES[parity] * self.signs[first, None] * values[first]
        values[alone] = part[len(first) :]
        return values


@dataclass(frozen=True)
class ToothSpan:
    """A row of `teeth` sectors: symmetric matrices (n + hub, n + hub), even and odd, on the cut behind and the hub.

    The hub's dofs are seen from the middle of the row; those of the other parity are left out, with zeros in their place.
    `seen` turns them to what one sees who is so many teeth ahead.
    """

    matrices: tuple[Floats, Floats]
    teeth: int
    reversal: Reversal
    seen: Callable[[float], Floats]
    hub_parities: Floats

    @property
    def cut(self) -> int:
        """Dofs of one cut."""
        return len(self.reversal.image)

    @property
    def near(self) -> Floats:
        """Forces (n, n + hub) at the cut behind by displacements of it and the hub, the other one held."""
        n, (even, odd) = self.cut, self.matrices
        return np.hstack([(even[:n, :n] + odd[:n, :n]) / 2, even[:n, n:] + odd[:n, n:]])

    @property
    def far(self) -> Floats:
        """Forces (n, n + hub) at the cut ahead by the same, after the turn."""
        n, (even, odd) = self.cut, self.matrices
        return np.hstack([(even[:n, :n] - odd[:n, :n]) / 2, even[:n, n:] - odd[:n, n:]])

    @property
    def hub(self) -> Floats:
        """Matrix (hub, hub) of the hub, both cuts held."""
        n, (even, odd) = self.cut, self.matrices
        result: Floats = 2 * (even[n:, n:] + odd[n:, n:])
        return result

    def matrix(self) -> Floats:
        """Matrix on [cut behind, cut ahead, hub]."""
        n, near, ahead = self.cut, self.near, self.reversal.rows(self.far)
        return np.block(
            [
                [near[:, :n], ahead[:, :n].T, near[:, n:]],
                [ahead[:, :n], self.reversal.both(near[:, :n]), ahead[:, n:]],
                [near[:, n:].T, ahead[:, n:].T, self.hub],
            ]
        )

    def ends(self, aside: float) -> Floats:
        """Return the matrix on the cut behind and the hub of a row that begins with this one.

        The cut ahead is held. The row's middle is `aside` teeth away.
        """
        n, near, turn = self.cut, self.near, self.seen(-aside)
        across = near[:, n:] @ turn
        return np.block([[near[:, :n], across], [across.T, turn.T @ self.hub @ turn]])

    def inward(self, aside: float) -> Floats:
        """Forces (n, n + hub) at the cut ahead by the cut behind and the hub of such a row."""
        far = self.reversal.rows(self.far)
        far[:, self.cut :] = far[:, self.cut :] @ self.seen(-aside)
        return far

    def pushed(self, ends: Floats, aside: float) -> Floats:
        """Forces (n, m) at the cut ahead by displacements of the cut behind and the hub (n + hub, m): as by `inward`."""
        n, (even, odd) = self.cut, self.matrices
        given = np.concatenate([ends[:n] / 2, self.seen(-aside) @ ends[n:]])
        return self.reversal.rows(even[:n] @ given - odd[:n] @ given)

    def repeated(self, times: int) -> ToothSpan:
        """Return a row of `times` copies of this one."""
        if times == 1:
            return self
        half = self.repeated(times // 2)
        return joined(half, self if times % 2 else None)[0]


@dataclass(frozen=True)
class Inside:
    """Response of the first cut inside a row that begins with `side` to the row's ends; `aside` teeth is the row's middle.

    `lower` are L (see `dense`) with L L.T the matrices of that cut, even and odd, `hub` (n, hub) what else is between it and
    the hub; None where the row has only `side` twice, and `lower` are of the even and the odd part of the cut.
    """

    side: ToothSpan
    aside: float
    lower: tuple[Floats, Floats]
    hub: tuple[Floats, Floats] | None

    def moved(self, ends: Floats, parity: int) -> Floats:
        """Displacements (n, m) by those of the cut behind and the hub (n + hub, m)."""
        reversal, n = self.side.reversal, self.side.cut
        force = self.side.pushed(ends, self.aside)
        if self.hub is not None:
            force += self.hub[parity] @ ends[n:]
            return -solved_rows(self.lower[parity], force)
        part = reversal.part(force, parity)
        return -reversal.whole(solved_rows(self.lower[parity], part), parity)


def joined(side: ToothSpan, middle: ToothSpan | None) -> tuple[ToothSpan, Inside]:
    """A row on both sides of another one, or of none."""
    teeth = 2 * side.teeth + (0 if middle is None else middle.teeth)
    n, aside, reversal = side.cut, (teeth - side.teeth) / 2, side.reversal

    def of(parity: int) -> tuple[Floats, Floats]:
        ends, inward, near = side.ends(aside), side.inward(aside), side.near[:, :n]
        if middle is None:
            inner = reversal.part(reversal.part(near, parity).T, parity)
            lower, matrix = eliminated(inner, reversal.part(inward, parity), ends)
        else:
            given = middle.matrices[parity]
            inward[:, n:] += given[:n, n:]
            ends[n:, n:] += given[n:, n:]
            lower, matrix = eliminated(reversal.both(near) + given[:n, :n], inward, ends)
        others = n + np.flatnonzero(side.hub_parities != PARITIES[parity])
        matrix[others] = 0.0
        matrix[:, others] = 0.0
        return lower, matrix

    lowers, matrices = zip(*on_all_cores(of, (0, 1)), strict=True)
    whole = ToothSpan((matrices[0], matrices[1]), teeth, reversal, side.seen, side.hub_parities)
    hub = None if middle is None else (middle.matrices[0][:n, n:].copy(), middle.matrices[1][:n, n:].copy())
    return whole, Inside(side, aside, (lowers[0], lowers[1]), hub)


def eliminated(inner: Floats, across: Floats, ends: Floats) -> tuple[Floats, Floats]:
    """L (see `dense`) of a symmetric matrix (n, n), and the one (m, m) at the `ends` without its dofs.

    `across` (n, m) is between both.
    """
    from gearcad.contact.solid.kernels import fill_upper

    blocks = Blocks(*(np.asfortranarray(each) for each in (inner.T, across, ends.T))).eliminated()
    fill_upper(blocks.rest)
    return blocks.own, blocks.rest
