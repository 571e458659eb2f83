"""One shaft in torsion: as a spring, as a hierarchical element, and as the wave equation has it. In SI units."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.arrays import Floats

__all__ = [
    "clamped_modes_below",
    "dynamic_inertia",
    "dynamic_stiffness",
    "element_matrices",
    "twist_between",
    "twist_shapes",
]

Each = float | Floats
"""Of one shaft at one frequency, or arrays of them."""


# ---------------------------------------------------------------------- elements


def twist_shapes(order: int, places: ArrayLike) -> Floats:
    """Shape functions (order + 1, n) at places 0 ... 1 along a shaft: two linear ones, then integrated Legendre polynomials.

    Those vanish at both ends: N_j = (P_j - P_{j-2}) / sqrt(4 j - 2) (Szabo and Babuska, Finite Element Analysis, 3.1.1).
    """
    x = 2 * np.asarray(places, dtype=float) - 1
    p = [np.ones_like(x), x]
    for j in range(2, order + 1):  # Bonnet's recursion
        p.append(((2 * j - 1) * x * p[-1] - (j - 1) * p[-2]) / j)
    bubbles = [(p[j] - p[j - 2]) / math.sqrt(4 * j - 2) for j in range(2, order + 1)]
    return np.array([(1 - x) / 2, (1 + x) / 2, *bubbles])


def element_matrices(stiffness: float, inertia: float, order: int) -> tuple[Floats, Floats]:
    """Stiffness and inertia matrix (order + 1, order + 1) of a shaft by the shape functions of `twist_shapes`.

    The derivatives of all but the linear ones are orthonormal on [-1, 1], so the stiffness matrix is known; that of inertia has
    integrands of degree 2 order, for which Gauss's rule with order + 1 points is exact.
    """
    k = np.diag(np.full(order + 1, 2.0))
    k[:2, :2] = [[1, -1], [-1, 1]]
    points, weights = np.polynomial.legendre.leggauss(order + 1)
    shapes = twist_shapes(order, (points + 1) / 2)
    return stiffness * k, inertia / 2 * (shapes * weights) @ shapes.T


# ---------------------------------------------------------------------- the wave equation

_SMALL = 1e-2
"""Wave number below which series are more accurate than differences of large terms: the first one left out is its 6th power."""


def _wave_number(stiffness: Each, inertia: Each, omega: Each) -> Floats:
    """beta = omega L / c = omega sqrt(J / k)."""
    result: Floats = np.asarray(omega) * np.sqrt(np.asarray(inertia) / np.asarray(stiffness))
    return result


def _two_by_two(diagonal: Floats, off: Floats) -> Floats:
    return np.moveaxis(np.array([[diagonal, off], [off, diagonal]]), (0, 1), (-2, -1))


def dynamic_stiffness(stiffness: Each, inertia: Each, omega: Each) -> Floats:
    """(..., 2, 2): torques on the ends of a shaft that turn harmonically, k beta [[cot beta, -1/sin beta], [..., cot beta]]."""
    beta = _wave_number(stiffness, inertia, omega)
    per_sine = np.asarray(stiffness) / np.sinc(beta / np.pi)
    return _two_by_two(np.cos(beta) * per_sine, -per_sine)


def dynamic_inertia(stiffness: Each, inertia: Each, omega: Each) -> Floats:
    """(..., 2, 2): minus the derivative of `dynamic_stiffness` by omega squared; its quadratic form is twice the kinetic energy
    over omega squared, of the whole shaft."""
    beta = _wave_number(stiffness, inertia, omega)
    b2 = beta**2
    diagonal, off = 2 / 3 + b2 * (4 / 45 + b2 * 4 / 315), 1 / 3 + b2 * (7 / 90 + b2 * 31 / 2520)
    large = beta >= _SMALL
    b = np.where(large, beta, 1.0)
    sine, cosine = np.sin(b), np.cos(b)
    diagonal = np.where(large, 1 / sine**2 - cosine / (sine * b), diagonal)
    off = np.where(large, 1 / (sine * b) - cosine / sine**2, off)
    half = np.asarray(inertia) / 2
    return _two_by_two(half * diagonal, half * off)


def clamped_modes_below(stiffness: Each, inertia: Each, omega: Each) -> NDArray[np.int64]:
    """J_0 of Wittrick and Williams: how many natural frequencies of the shaft, both ends clamped, are below omega."""
    beta = _wave_number(stiffness, inertia, omega)
    count: NDArray[np.int64] = np.maximum(np.ceil(beta / np.pi) - 1, 0).astype(np.int64)
    return count


def twist_between(stiffness: float, inertia: float, omega: float, places: ArrayLike) -> Floats:
    """(2, n): turn at places 0 ... 1 of a shaft one of whose ends turns by 1, the other by 0, harmonically."""
    beta = float(_wave_number(stiffness, inertia, omega))
    x = np.asarray(places, dtype=float)
    whole = np.sinc(beta / np.pi)
    return np.array([(1 - x) * np.sinc((1 - x) * beta / np.pi), x * np.sinc(x * beta / np.pi)]) / whole
