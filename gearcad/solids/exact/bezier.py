"""Bezier pieces by interpolation at Chebyshev-Lobatto nodes: the lowest degree that meets a tolerance.

One polynomial span per smooth piece keeps the shared edges of neighbouring faces identical, pole for pole.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import comb

import numpy as np

from gearcad.arrays import Floats

__all__ = ["MOST_DEGREE", "bernstein", "fit", "interpolate", "interpolate_surface"]


MOST_DEGREE = 25
"""Highest degree of a B-spline that the OpenCASCADE kernel accepts."""


def bernstein(degree: int, t: Floats) -> Floats:
    """Bernstein polynomials of one degree at t (n,): (n, degree + 1)."""
    power = np.arange(degree + 1)
    weight = np.array([comb(degree, int(i)) for i in power], float)
    return np.asarray(weight * t[:, None] ** power * (1 - t[:, None]) ** (degree - power), float)


@cache
def _nodes(degree: int) -> tuple[Floats, Floats]:
    """Chebyshev-Lobatto nodes on [0, 1] and the matrix that turns values there into poles."""
    nodes: Floats = np.asarray(0.5 - 0.5 * np.cos(np.pi * np.arange(degree + 1) / degree), float)
    nodes[0], nodes[-1] = 0.0, 1.0
    to_poles = np.asarray(np.linalg.inv(bernstein(degree, nodes)), float)
    return nodes, to_poles


@cache
def _check(degree: int) -> tuple[Floats, Floats]:
    """Points between the nodes (the extremes of the interpolation error lie close to them), and their Bernstein values."""
    nodes, _ = _nodes(degree)
    t = np.sort(np.concatenate([nodes[:-1] + f * np.diff(nodes) for f in (0.25, 0.5, 0.75)])).astype(float)
    return t, bernstein(degree, t)


def interpolate(function: Callable[[Floats], Floats], degree: int) -> Floats:
    """Poles (degree + 1, k) of the Bezier that interpolates `function` ((n,) in [0, 1] -> (n, k)), ends exact."""
    return _through(function(_nodes(degree)[0]))


def interpolate_surface(function: Callable[[Floats, Floats], Floats], degrees: tuple[int, int]) -> Floats:
    """Poles (n + 1, m + 1, k) of the Bezier surface of degrees n and m that interpolates `function` ((n,), (m,) -> (n, m, k)).

    An edge depends on the values there alone, so neighbours have its poles in common.
    """
    values = function(*(_nodes(degree)[0] for degree in degrees))
    return np.swapaxes(_through(np.swapaxes(_through(values), 0, 1)), 0, 1)


def _through(values: Floats) -> Floats:
    """Poles (n + 1, ...) of the Bezier through the values at the nodes of degree n, ends exact."""
    to_poles = _nodes(len(values) - 1)[1]
    poles: Floats = (to_poles @ values.reshape(len(values), -1)).reshape(values.shape)
    poles[0], poles[-1] = values[0], values[-1]
    return poles


def fit(
    function: Callable[[Floats], Floats],
    error: Callable[[Floats, Floats], Floats],
    tolerance: float,
    *,
    least: int = 2,
    most: int = MOST_DEGREE,
) -> Floats | None:
    """Poles of the lowest-degree interpolant with `error(values, t) <= tolerance` between the nodes; None if there is none."""
    for degree in range(least, most + 1):
        poles = interpolate(function, degree)
        t, basis = _check(degree)
        if np.max(error(basis @ poles, t)) <= tolerance:
            return poles
    return None
