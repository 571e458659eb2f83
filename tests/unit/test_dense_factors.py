"""Factors whose blocks on the diagonal are inverted, against SciPy's solutions with a triangle."""

import numpy as np
import pytest
import scipy.linalg

from gearcad.contact.solid.fronts import factorise, solve_lower, solve_upper, solved_rows, subtract_square
from gearcad.core.records import Floats

ROUNDING = 1e-13
"""Of matrices with condition numbers of about 10."""

SIZES = (1, 192, 193, 450)
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
    for solve, transposed in ((solve_lower, 0), (solve_upper, 1)):
        result = right.copy()
        solve(factor, result)
        expected = scipy.linalg.solve_triangular(lower, right, lower=True, trans=transposed)
        assert result == pytest.approx(expected, abs=ROUNDING)
    assert solved_rows(factor, right) == pytest.approx(np.linalg.solve(matrix, right), abs=ROUNDING)


def test_the_minor_that_is_not_positive_is_told() -> None:
    matrix = definite(300)
    matrix[250, 250] = -1.0
    assert factorise(matrix) == 251


@pytest.mark.parametrize("size", SIZES)
def test_a_square_is_taken_off_in_place(size: int) -> None:
    across, square = numbers(5, size), definite(size)
    given = square.copy()
    subtract_square(across, square)
    assert np.tril(square) == pytest.approx(np.tril(given - across.T @ across), abs=ROUNDING)
