"""Speeds between those asked for, until curves over them show every maximum."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Bools, Floats

__all__ = ["speeds_between"]


_ABOVE = 0.002
"""Of a maximum: how far a parabola through three points may rise above them."""

_FALL = 0.03
"""Of a maximum: what its neighbours may lie below it, so that a parabola says something."""

_BEND = 0.02
"""Of a value: how far it may lie off the straight line between its neighbours."""

NARROWEST = 1e-4
"""Relative: intervals below that are not divided. Resonances with a damping ratio of 0.0005 are ten such intervals wide."""


def speeds_between(speeds: Floats, curves: Floats, narrowest: float = NARROWEST) -> Floats:
    """Where curves (s, c), all positive, over rising speeds (s,) may hide more than a hundredth of a maximum: (x,), or none.

    Over less than `narrowest` of a speed curves may jump: what is beyond tells nothing there.
    """
    if len(speeds) < 3 or not curves.shape[1]:
        return np.zeros(0)
    steps = np.diff(speeds)
    wide = steps > narrowest * speeds[1:]
    tops, bends = _tops(steps, curves, wide), _bends(steps, curves) & wide[:-1] & wide[1:]
    fine, coarse = (np.concatenate([each, [False]]) | np.concatenate([[False], each]) for each in (tops, bends))
    parts = [(fine, (0.25, 0.5, 0.75)), (coarse & ~fine, (0.5,))]
    found = [speeds[:-1][which & wide] + part * steps[which & wide] for which, shares in parts for part in shares]
    return np.unique(np.concatenate(found))


def _tops(steps: Floats, curves: Floats, wide: Bools) -> Bools:
    """(s - 2,): inner speeds at which a maximum may be more than the value there."""
    here, sides = curves[1:-1], (wide[:-1, None], wide[1:, None])
    rise, fall = (np.where(side, here - beside, 0.0) for side, beside in zip(sides, (curves[:-2], curves[2:]), strict=True))
    before, after = steps[:-1, None], steps[1:, None]
    # A parabola through three points, from the one in the middle: slope and bend.
    bend = (rise / before + fall / after) / (before + after)
    slope = rise / before - bend * before
    above = np.divide(slope**2, 4 * bend, out=np.zeros_like(bend), where=(bend > 0) & sides[0] & sides[1])
    rough = (above > _ABOVE * here) | (np.maximum(rise, fall) > _FALL * here)
    return np.asarray(((rise >= 0) & (fall >= 0) & rough).any(axis=1), bool)


def _bends(steps: Floats, curves: Floats) -> Bools:
    """(s - 2,): inner speeds whose values are far from the straight lines between their neighbours."""
    share = (steps[:-1] / (steps[:-1] + steps[1:]))[:, None]
    straight = (1 - share) * curves[:-2] + share * curves[2:]
    return np.asarray((np.abs(curves[1:-1] - straight) > _BEND * curves[1:-1]).any(axis=1), bool)
