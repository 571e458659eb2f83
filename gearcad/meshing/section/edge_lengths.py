"""Wanted edge lengths along half a tooth: short where the outline bends and where teeth touch, growing gently from there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, Involute
from gearcad.geometry.turned import flank_curves
from gearcad.meshing.section.outline import HalfLengths, MeshSizes, edge_lengths

__all__ = ["bent_lengths"]


_FINE = 1025
"""Places of a curve at which its bend is looked at."""

_FARTHEST = 30.0
"""Degrees that any edge may turn: one that turns twice as far can fold the triangle behind it."""

_TINY = 0.02
"""Share of an edge that is not worth to be one."""

_CUBIC = 72 * math.sqrt(3)
"""A parabola through both ends and the middle of an arc is off by k' L^3 over this, k' the slope of the curvature."""

_QUARTIC = 1536
"""Where the curvature k is constant, by k^3 L^4 over this."""

_LEAST = 1e-3
"""Normal modules: no bend asks for shorter edges. Sharp tools leave corners that fillets come out of with no radius."""

_OF_DEPTH = 0.2
"""Share of the permitted deviation that a depth of modification may add."""

_SHORTEST = 0.003
"""Normal modules: no modification asks for shorter edges."""


@dataclass(frozen=True)
class _Sampled:
    """Edge lengths (n,) at distances `run` (n,) from the root side of a curve, all in mm."""

    run: Floats
    length: Floats

    def __call__(self, run: Floats, _whole: float) -> Floats:
        return np.interp(run, self.run, self.length)


def bent_lengths(gear: Gear, sizes: MeshSizes, near: HalfLengths | None = None, *, whole: bool = False) -> HalfLengths:
    """The lengths that `sizes` ask for, shorter where `fillet_turn` and `deviation` want it, and where `near` does.

    Over the whole half of the tooth they grow no faster than `growth`. Edges end where reliefs begin, and none of the flank is
    longer than a relief. With `whole` none is longer than its curve, however short a land is: triangles need neighbours of
    about their size.
    """
    plain, module = edge_lengths(gear, sizes, loaded=True).curves, gear.normal_module
    runs, lengths, breaks = list[Floats](), list[Floats](), list[float]()
    for curve in gear.profile.curves:
        s = np.linspace(0.0, 1.0, _FINE)
        run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(curve.points(s), axis=0).T))]
        wanted = np.minimum(plain[curve.kind](run, float(run[-1])), _by_bend(curve, s, run, sizes, module))
        if near and curve.kind in near.curves:
            wanted = np.minimum(wanted, near.curves[curve.kind](run, float(run[-1])))
        if isinstance(curve, Involute) and gear.modification.present:
            if sizes.deviation is not None:
                wanted = np.minimum(wanted, _by_depth(gear, curve.roll(s) * curve.base_radius, sizes.deviation * module))
            breaks = _breaks(gear, s, run, wanted)
            ends = np.interp([0.0, *breaks, 1.0], s, run)
            wanted = np.minimum(wanted, np.diff(ends)[np.searchsorted(ends[1:-1], run)])
        if whole:
            wanted = np.minimum(wanted, run[-1])
        runs.append(run)
        lengths.append(wanted)
    starts = np.cumsum([0.0, *(run[-1] for run in runs)])
    along = np.concatenate([run + start for run, start in zip(runs, starts[:-1], strict=True)])
    gentle = np.split(_gentle(along, np.concatenate(lengths), sizes.growth), len(runs))
    sampled = {curve.kind: _Sampled(run, own) for curve, run, own in zip(gear.profile.curves, runs, gentle, strict=True)}
    return HalfLengths(sampled, tuple(breaks), halved=True)


def _breaks(gear: Gear, s: Floats, run: Floats, wanted: Floats) -> list[float]:
    """Parameters of the involute where reliefs begin, but for those so near to others or an end that an edge would be tiny."""
    form, kept, before = gear.flank_form, list[float](), 0.0
    for roll in form.roll_breaks:
        place = (roll - form.first) / (form.last - form.first)
        at, edge = (float(np.interp(place, s, values)) for values in (run, wanted))
        if min(at - before, run[-1] - at) > _TINY * edge:
            kept.append(place)
            before = at
    return kept


def _gentle(run: Floats, length: Floats, growth: float) -> Floats:
    """Lengths (n,) along a line that nowhere grow faster than by `growth` times the distance."""
    ahead = run * growth + np.minimum.accumulate(length - run * growth)
    back = (length + run * growth)[::-1]
    result: Floats = np.minimum(ahead, np.minimum.accumulate(back)[::-1] - run * growth)
    return result


def _by_bend(curve: Curve, s: Floats, run: Floats, sizes: MeshSizes, module: float) -> Floats:
    """Longest edges (n,) that turn no more than fillets should, and bulge as the curve does."""
    between = np.diff(np.unwrap(curve.direction(s))) / np.diff(run)
    middles = (run[1:] + run[:-1]) / 2
    bend = np.maximum(np.abs(np.interp(run, middles, between)), 1e-12 / run[-1])
    turn = min(sizes.fillet_turn or _FARTHEST, _FARTHEST) if curve.kind is CurveKind.FILLET else _FARTHEST
    longest: Floats = math.radians(turn) / bend
    if sizes.deviation is not None:
        slope = np.maximum(np.abs(np.gradient(bend, run)), 1e-12 / run[-1] ** 2)
        off = sizes.deviation * module
        longest = np.minimum(longest, np.minimum(np.cbrt(_CUBIC * off / slope), (_QUARTIC * off / bend**3) ** 0.25))
    found: Floats = np.maximum(longest, _LEAST * module)
    return found


def _by_depth(gear: Gear, lengths: Floats, deviation: float) -> Floats:
    """Longest edges (n,) on the flank at roll lengths (n,) over which the depth bulges as a parabola does, but for a share of
    `deviation`; all in mm.

    On each piece the depth is alpha xi^2 + beta xi + gamma. On the arc a = xi^2/(2 r_b), alpha xi^2 is straight; beta xi is a
    root, which falls behind near the base circle: beta xi e(h/a) from xi on, e as `_root_error` has it.
    """
    form, base = gear.flank_form, gear.flank_form.base_radius
    heights = np.array([0.0, 0.5, 1.0]) * gear.face_width
    longest = np.full(len(lengths), np.inf)
    xi = np.maximum(lengths, 1e-3 * form.last)
    share, error = _root_error()
    for piece in flank_curves(gear):
        if piece.curve.kind is CurveKind.INVOLUTE:
            middle, span = (piece.first + piece.last) / 2, piece.last - piece.first
            low, mean, high = form.depth(np.array([[piece.first], [middle], [piece.last]]), heights)
            linear = float(np.abs((high - low) / span - 4 * (low - 2 * mean + high) / span**2 * middle).max())
            permitted = np.log(_OF_DEPTH * deviation / np.maximum(linear * xi, 1e-12))
            edge = np.exp(np.interp(permitted, np.log(error), np.log(share))) * xi**2 / (2 * base)
            inside = (lengths >= piece.first) & (lengths <= piece.last)
            longest[inside] = np.minimum(longest, edge)[inside]
    found: Floats = np.maximum(longest, _SHORTEST * gear.normal_module)
    return found


@cache
def _root_error() -> tuple[Floats, Floats]:
    """How far a parabola through the ends and the middle of sqrt(1 + x), x from 0 to u, is from it: u (n,) and e (n,)."""
    share, t = np.geomspace(1e-2, 1e8, 201), np.linspace(-1, 1, 201)

    def root(place: Floats) -> Floats:
        result: Floats = np.sqrt(1 + share[:, None] * (1 + place) / 2)
        return result

    low, middle, high = root(np.array([-1.0])), root(np.array([0.0])), root(np.array([1.0]))
    parabola = middle + t * (high - low) / 2 + t**2 * (low - 2 * middle + high) / 2
    error: Floats = np.abs(root(t) - parabola).max(axis=1)
    return share, error
