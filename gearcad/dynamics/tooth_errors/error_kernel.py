"""Kernel of error samples: many samples of a train at one speed, step by step and side by side, with different tooth errors.

Every mode z'' + d z' + s z = g is propagated in closed form over a step in which its force g is a straight line. The forces of
the meshes at the end of a step are those that the motion there requires. At one speed all samples meet the same places of their
teeth at once, and each tooth period is like the next. So springs and gaps are known before, and only a few operations are left
for each sample, which processors do four at a time.

Compiled by numba: import this module inside functions only. Loops are used instead of whole arrays, each of which takes numba
seconds to compile. Arrays have the samples last. SI units.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Floats, Wholes
from gearcad.core.runtime import compiled, inlined

_SWEEPS = 4
"""Rounds over meshes that share gears: what one does to another within a step is some hundredths of what it does to itself."""

_HALVINGS = 200


class Pattern(NamedTuple):
    """Springs and gaps that repeat every t steps: `stiffness`, `gap` and `place` (t, m, p) of pairs side by side.

    There is no pair where the stiffness is 0. `tooth` (t, m) is the number of the first pair; `teeth` (m,) is the number of
    teeth that pass before the pattern repeats. `error` (t, m) is the approach that all flanks must make first, at a `rate`
    (t, m) that the damper feels.
    """

    stiffness: Floats
    gap: Floats
    place: Floats
    tooth: Wholes
    teeth: Wholes
    error: Floats
    rate: Floats


class Steps(NamedTuple):
    """Steps of `time` (s) each: `modes` (n, 8) as `motion_kernel.propagators` returns them, `mesh` (n, m) and `load` (n,).

    `mesh` is taken in the direction in which the load presses the flanks. `damping` (m,); `backlash` (m,), nan where flanks
    never part.
    """

    time: float
    modes: Floats
    mesh: Floats
    load: Floats
    damping: Floats
    backlash: Floats


class Samples(NamedTuple):
    """Errors of pairs of teeth, `position` and `slope` (m, z, s), and the motion of s samples. Mesh j has `counts[j]` pairs.

    `z`, `v` and `push` (n, s) are coordinates, speeds and forces of the modes; `force` (m, s) are the forces of the meshes.
    `before` and `earlier` (m, s) are the forces of the springs one and two steps before. `shift` (m, x, s) is the additional
    approach that all flanks of a mesh must make, with `per_tooth` values for each of `counts[j]` teeth. x is 0 where there is
    none.
    """

    position: Floats
    slope: Floats
    counts: Wholes
    shift: Floats
    per_tooth: int
    z: Floats
    v: Floats
    push: Floats
    force: Floats
    before: Floats
    earlier: Floats


@compiled
def _bracketed(k: Floats, g: Floats, right: float, part: float, backlash: float, sample: int) -> float:
    """Return the approach x with x + part f(x) = right, back flanks included; f never falls, so there is just one."""
    low, high, x = -np.inf, np.inf, right
    for _ in range(_HALVINGS):
        force, slope = 0.0, 0.0
        for p in range(k.size):
            gap = g[p, sample]
            if x > gap:
                force += k[p] * (x - gap)
                slope += k[p]
            if x < -backlash - gap:
                force += k[p] * (x + backlash + gap)
                slope += k[p]
        value = x + part * force - right
        if value > 0.0:
            high = min(high, x)
        else:
            low = max(low, x)
        following = x - value / (1.0 + part * slope)
        if not low <= following <= high:
            following = 0.5 * (low + high)
        if abs(following - x) <= 1e-14 * (abs(x) + abs(right)):
            break
        x = following
    return x


@inlined
def _solve(
    k: Floats, g: Floats, right: Floats, part: float, backlash: float, x: Floats, active: Floats, closed: Floats
) -> None:
    """Fill `x` (s,) with approaches that satisfy x + part sum k max(x - g, 0) = right, by Newton's steps from above.

    Each step drops pairs that part. The sum is convex, so the number of steps is at most the number of pairs plus one.
    """
    bonded, pairs = math.isnan(backlash), 0
    for p in range(k.size):
        pairs += k[p] > 0.0
    for s in range(x.size):
        x[s] = right[s]
    for _ in range(1 if bonded else pairs + 1):
        for s in range(x.size):
            active[s], closed[s] = 1.0, right[s]
        for p in range(k.size):
            stiff = part * k[p]
            if stiff == 0.0:
                continue
            gaps = g[p]
            for s in range(x.size):
                own = stiff if bonded or x[s] > gaps[s] else 0.0
                active[s] += own
                closed[s] += own * gaps[s]
        for s in range(x.size):
            x[s] = closed[s] / active[s]
    meeting = not bonded and backlash < math.inf
    if meeting:
        # The least gap of a pair: where flanks at the back touch first.
        active[:] = np.inf
        for p in range(k.size):
            if k[p] > 0.0:
                for s in range(x.size):
                    active[s] = min(active[s], g[p, s])
    for s in range(x.size if meeting else 0):
        if x[s] + backlash + active[s] < 0.0:
            x[s] = _bracketed(k, g, right[s], part, backlash, s)


@compiled
def _shifted(samples: Samples, j: int, turns: float, shift: Floats) -> None:
    """Fill `shift` (s,) with the approach that all flanks of mesh j must make first, after `turns` of its tooth periods."""
    cells = samples.counts[j] * samples.per_tooth
    along = turns * samples.per_tooth
    cell = math.floor(along)
    part, here = along - cell, int(cell) % cells
    one, other = samples.shift[j, here], samples.shift[j, (here + 1) % cells]
    for s in range(shift.size):
        shift[s] = one[s] + part * (other[s] - one[s])


@inlined
def _coast(steps: Steps, i: int, z: Floats, v: Floats, push: Floats, y: Floats, w: Floats) -> None:
    """Advance mode i by one step without the mesh forces at its end; add its share to the approaches y and their rates w (m,
    s).
    """
    a, b, c, d, e, f, g, h = steps.modes[i]
    load = steps.load[i]
    for s in range(z.size):
        here, going, force = z[s], v[s], push[s]
        z[s] = a * here + b * going + e * force + f * load
        v[s] = c * here + d * going + g * force + h * load
    for j in range(y.shape[0]):
        share, yj, wj = steps.mesh[i, j], y[j], w[j]
        for s in range(z.size):
            yj[s] += share * z[s]
            wj[s] += share * v[s]


@inlined
def _gaps(position: Floats, slope: Floats, gap: float, place: float, gaps: Floats) -> None:
    """Fill `gaps` (s,) with the gaps of a pair of teeth."""
    for s in range(gaps.size):
        gaps[s] = gap + position[s] + slope[s] * place


@inlined
def _carried(
    right: Floats, x: Floats, speed: Floats, part: float, damping: float, over: float, spring: Floats, force: Floats
) -> None:
    """Fill `spring` (s,) with the forces of the springs at an approach, and `force` (s,) with those of springs and damper."""
    for s in range(x.size):
        spring[s] = (right[s] - x[s]) / part
        force[s] = (spring[s] + damping * speed[s]) * over


@inlined
def _raise_to(spring: Floats, before: Floats, earlier: Floats, most: Floats) -> None:
    """Raise `most` (s,) to the crest of the parabola through the last three steps, then store the step."""
    for s in range(spring.size):
        middle = before[s]
        bend, rise = 2.0 * middle - earlier[s] - spring[s], spring[s] - earlier[s]
        top = middle + rise * rise / (8.0 * max(bend, 1e-300)) if abs(rise) < bend else max(middle, spring[s])
        most[s] = max(most[s], top)
        earlier[s] = middle
        before[s] = spring[s]


@inlined
def _push(steps: Steps, i: int, force: Floats, z: Floats, v: Floats, push: Floats) -> None:
    """Apply the forces at the end of a step to mode i."""
    for s in range(z.size):
        push[s] = 0.0
    for j in range(force.shape[0]):
        share, fj = steps.mesh[i, j], force[j]
        for s in range(z.size):
            push[s] -= share * fj[s]
    end, fast, load = steps.modes[i, 5], steps.modes[i, 7], steps.load[i]
    for s in range(z.size):
        z[s] += end * push[s]
        v[s] += fast * push[s]
        push[s] += load


@compiled
def advance(steps: Steps, pattern: Pattern, samples: Samples, turns: Floats, begin: int, count: int, crests: Floats) -> None:
    """Advance all samples in place by the steps `begin` + 1 to `begin` + `count`.

    `turns` (m,) are the tooth periods of each mesh in a step. `crests` (m, s) are raised to the greatest force of the springs
    of each mesh.
    """
    n, m = steps.mesh.shape
    size, pairs, length = samples.z.shape[1], pattern.stiffness.shape[2], pattern.stiffness.shape[0]
    give, rate = np.zeros((m, m)), np.zeros((m, m))
    for i in range(n):
        for j in range(m):
            for k in range(m):
                give[j, k] += steps.modes[i, 5] * steps.mesh[i, j] * steps.mesh[i, k]
                rate[j, k] += steps.modes[i, 7] * steps.mesh[i, j] * steps.mesh[i, k]
    y, w, springs, gaps = np.zeros((m, size)), np.zeros((m, size)), np.zeros((m, size)), np.zeros((m, pairs, size))
    right, x, active, closed = np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size)
    speed, shift, before = np.zeros(size), np.zeros(size), np.zeros((m, size))
    shifted = samples.shift.shape[1] > 0
    for j in range(m if shifted else 0):
        _shifted(samples, j, begin * turns[j], before[j])
    for step in range(begin + 1, begin + count + 1):
        row, passed = step % length, step // length
        y[:], w[:] = 0.0, 0.0
        for i in range(n):
            _coast(steps, i, samples.z[i], samples.v[i], samples.push[i], y, w)
        for j in range(m):
            error, change = pattern.error[row, j], pattern.rate[row, j]
            for s in range(size):
                y[j, s] -= error
                w[j, s] -= change
            if shifted:
                _shifted(samples, j, step * turns[j], shift)
                for s in range(size):
                    y[j, s] -= shift[s]
                    w[j, s] -= (shift[s] - before[j, s]) / steps.time
                    before[j, s] = shift[s]
            first = pattern.tooth[row, j] + passed * pattern.teeth[j]
            for p in range(pairs):
                if pattern.stiffness[row, j, p] > 0.0:
                    which = (first + p) % samples.counts[j]
                    _gaps(samples.position[j, which], samples.slope[j, which], pattern.gap[row, j, p], pattern.place[row, j, p],
                          gaps[j, p])  # fmt: skip
        for _ in range(1 if m == 1 else _SWEEPS):
            for j in range(m):
                damping, over = steps.damping[j], 1.0 / (1.0 + steps.damping[j] * rate[j, j])
                part = give[j, j] * over
                for s in range(size):
                    right[s], speed[s] = y[j, s], w[j, s]
                for k in range(m):
                    if k != j:
                        less, slower, force = give[j, k], rate[j, k], samples.force[k]
                        for s in range(size):
                            right[s] -= less * force[s]
                            speed[s] -= slower * force[s]
                for s in range(size):
                    right[s] -= part * damping * speed[s]
                _solve(pattern.stiffness[row, j], gaps[j], right, part, steps.backlash[j], x, active, closed)
                _carried(right, x, speed, part, damping, over, springs[j], samples.force[j])
        for j in range(m):
            _raise_to(springs[j], samples.before[j], samples.earlier[j], crests[j])
        for i in range(n):
            _push(steps, i, samples.force, samples.z[i], samples.v[i], samples.push[i])
