"""A block of quadrangles between four sides: transfinite interpolation."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats

__all__ = ["transfinite"]


def transfinite(lower: Floats, upper: Floats, left: Floats, right: Floats) -> Floats:
    """Vertices (rows, columns, 2) between the sides.

    `lower` and `upper` (columns, 2) run from left to right, `left` and `right` (rows, 2) upwards; they share their corners. A
    vertex stands where the lines cross that join its ends, by length, on opposite sides, so the spacing of each side fades
    into that of the other (W. J. Gordon and C. A. Hall, 1973; weights of L.-E. Eriksson, 1982).
    """
    below, above = (_shares(side)[None, :, None] for side in (lower, upper))
    behind, ahead = (_shares(side)[:, None, None] for side in (left, right))
    wide, high = above - below, ahead - behind
    u = (below + behind * wide) / (1 - wide * high)
    v = behind + u * high
    corners = (1 - v) * ((1 - u) * lower[0] + u * lower[-1]) + v * ((1 - u) * upper[0] + u * upper[-1])
    result: Floats = (1 - v) * lower + v * upper + (1 - u) * left[:, None] + u * right[:, None] - corners
    return result


def _shares(line: Floats) -> Floats:
    """Length of a polyline (n, 2) up to each point, over the whole."""
    run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T))]
    result: Floats = run / run[-1]
    return result
