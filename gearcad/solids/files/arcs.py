"""Curves as chains of true arcs, as DXF draws them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import SolverError
from gearcad.geometry.curves import CurveKind, PlaneCurve

__all__ = ["Arcs", "arcs_of", "joined"]

_CHECKED = np.linspace(0.0, 1.0, 33)
"""Where a pair of arcs is compared with the curve."""

_UNSEEN = 1e-3
"""Share of a deviation by which its peak may be higher than it looks from there."""

_MOST_PAIRS = 1000


@dataclass(frozen=True)
class Arcs:
    """A chain of arcs: `vertices` (n + 1, 2) in mm, `bulges` (n,), tan of a quarter of the arc's angle (0: straight)."""

    vertices: Floats
    bulges: Floats


def arcs_of(curve: PlaneCurve, accuracy: float) -> Arcs:
    """A curve as pairs of arcs, as few as stay within `accuracy`; the pairs are shorter where its curvature changes fast."""
    if curve.kind is CurveKind.CHAMFER:
        return Arcs(curve.points(np.array([0.0, 1.0])), np.zeros(1))
    fine = np.linspace(0.0, 1.0, 257)
    length = np.hypot(*np.diff(curve.points(fine), axis=0).T)
    curvature = np.diff(curve.direction(fine)) / length
    # A pair of arcs over the length h is off by some |curvature'| h^3, so each takes an equal share of this effort.
    effort = np.cbrt(np.abs(np.gradient(curvature)) * length**2)
    effort = np.r_[0.0, np.cumsum(effort + 1e-3 * effort.max() + 1e-12)]
    pairs = 1
    while pairs <= _MOST_PAIRS:
        s = np.interp(np.linspace(0.0, effort[-1], pairs + 1), effort, fine)
        arcs = _pairs_of_arcs(curve, s)
        error = (1 + _UNSEEN) * _deviation(curve, s, arcs)
        if error <= accuracy:
            return arcs
        pairs = max(pairs + 1, math.floor(pairs * (error / accuracy) ** (1 / 3)))
    raise SolverError(f"the {curve.kind.value} cannot be drawn within {accuracy:g} mm by {_MOST_PAIRS} pairs of arcs")


def _pairs_of_arcs(curve: PlaneCurve, s: Floats) -> Arcs:
    """Biarcs through the points at s (n + 1,) with the exact tangents there: 2 n arcs.

    The tangents at both ends of a pair have equal lengths d up to where they meet the common tangent of its two arcs.
    """
    points, heading = curve.points(s), curve.direction(s)
    tangent = np.stack([np.cos(heading), np.sin(heading)], -1)
    start, end, first, last = points[:-1], points[1:], tangent[:-1], tangent[1:]
    chord = end - start
    along = np.sum(chord * (first + last), -1)
    square = np.sum(chord * chord, -1)
    opening = 4 * np.sin(np.diff(heading) / 2) ** 2
    d = square / (along + np.sqrt(along**2 + opening * square))
    joint = 0.5 * (start + end + d[:, None] * (first - last))
    bulges = np.stack([_half_tangent(first, joint - start), _half_tangent(end - joint, last)], -1).ravel()
    vertices = np.concatenate([np.stack([start, joint], 1).reshape(-1, 2), end[-1:]])
    return Arcs(vertices, bulges)


def _half_tangent(one: Floats, other: Floats) -> Floats:
    """Tangent of half the angle from one vector to another, (n, 2) each."""
    cross = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    result: Floats = np.tan(0.5 * np.arctan2(cross, np.sum(one * other, -1)))
    return result


def _deviation(curve: PlaneCurve, s: Floats, arcs: Arcs) -> float:
    """Largest distance (mm) of points of the curve from the pair of arcs between s[i] and s[i + 1]."""
    points = curve.points(s[:-1, None] + np.diff(s)[:, None] * _CHECKED)
    starts, ends = arcs.vertices[:-1].reshape(-1, 2, 1, 2), arcs.vertices[1:].reshape(-1, 2, 1, 2)
    bulge = arcs.bulges.reshape(-1, 2, 1)
    half = 0.5 * (ends - starts)
    size = np.hypot(half[..., 0], half[..., 1])
    offset = points[:, None] - 0.5 * (starts + ends)
    across = (half[..., 0] * offset[..., 1] - half[..., 1] * offset[..., 0]) / size
    # The circle in the frame of its chord: b (x^2 + y^2 - c^2) = y c (1 - b^2), gradient c (1 + b^2) on the circle.
    square = np.sum(offset**2, -1) - size**2
    distance = np.abs(bulge * square - across * size * (1 - bulge**2)) / (size * (1 + bulge**2))
    forward = np.sum((points[:, None] - ends[:, :1]) * half[:, :1], -1)[:, 0] > 0  # beyond the joint of the pair
    return _highest(np.where(forward, distance[:, 1], distance[:, 0]))


def _highest(values: Floats) -> float:
    """Highest of curves that are zero at both ends, of values (n, k) in equal steps: of the parabolas through its peaks."""
    before, here, after = values[:, :-2], values[:, 1:-1], values[:, 2:]
    peak = (here > before) & (here >= after)
    before, here, after = before[peak], here[peak], after[peak]
    return float((here + (after - before) ** 2 / (8 * (2 * here - before - after))).max(initial=0.0))


def joined(chains: list[Arcs]) -> Arcs:
    vertices = [chains[0].vertices[:1], *(chain.vertices[1:] for chain in chains)]
    return Arcs(np.concatenate(vertices), np.concatenate([chain.bulges for chain in chains]))
