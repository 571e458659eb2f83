"""Factors whose blocks on the diagonal are inverted, against SciPy's solutions with a triangle."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg

from gearcad.contact.solid.fronts import factorise, solve_above, solve_aside, solved_rows, subtract_product, subtract_square
from gearcad.core.records import Floats

ROUNDING = 1e-13
"""Of matrices with condition numbers of about 10."""

SIZES = (1, 128, 129, 300)
"""Within a block, just one, just more than one, and three."""


def definite(size: int) -> Floats:
    chance = np.random.default_rng(size)
    given = chance.normal(size=(size, size))
    return np.asfortranarray(given @ given.T / size + np.eye(size))


def numbers(*shape: int) -> Floats:
    return np.asfortranarray(np.random.default_rng(sum(shape)).normal(size=shape))


@pytest.mark.parametrize("size", SIZES)
def test_solutions_are_those_with_a_triangle(size: int) -> None:
    matrix, right = definite(size), numbers(size, 7)
    lower = np.linalg.cholesky(matrix)
    factor = matrix.copy(order="F")
    assert factorise(factor) == 0
    above = right.copy(order="F")
    solve_above(factor, above)
    assert above == pytest.approx(scipy.linalg.solve_triangular(lower, right, lower=True), abs=ROUNDING)
    for transposed in (False, True):
        aside = np.array(right.T, order="F")
        solve_aside(factor, aside, transposed=transposed)
        expected = scipy.linalg.solve_triangular(lower, right, lower=True, trans=0 if transposed else 1).T
        assert aside == pytest.approx(expected, abs=ROUNDING)
    assert solved_rows(factor, right) == pytest.approx(np.linalg.solve(matrix, right), abs=ROUNDING)


def test_the_minor_that_is_not_positive_is_told() -> None:
    matrix = definite(200)
    matrix[150, 150] = -1.0
    assert factorise(matrix) == 151


def test_products_are_taken_off_in_place() -> None:
    first, second, result = numbers(5, 4), numbers(4, 6), numbers(5, 6)
    left = result.copy(order="F")
    subtract_product(left, first, second, transposed=False)
    assert left == pytest.approx(result - first @ second, abs=ROUNDING)
    left = result.copy(order="F")
    subtract_product(left, first, np.array(second.T, order="F"), transposed=True)
    assert left == pytest.approx(result - first @ second, abs=ROUNDING)
    square = definite(6)
    given = square.copy(order="F")
    subtract_square(second, square)
    assert np.tril(square) == pytest.approx(np.tril(given - second.T @ second), abs=ROUNDING)
