"""Kernel of motions in time: a System under any speed and torque, its modes exact, its tooth forces implicit.

Every mode z'' + d z' + s z = g is propagated in closed form over a step over which its force g runs in a straight line. Forces
of the meshes at the end of a step are those that the motion there asks for: equations that are linear between the kinks of the
springs, one for each mesh. So the motion is good to second order in the step. However quick or damped a mode is, it asks for no
shorter steps; but a vibration on the springs of the teeth must have two steps at least. Without damping it then neither grows
nor fades: one step is a matrix of determinant 1.

Stiffness where a pair of teeth comes or goes, torque and speed may jump. Each is taken as its mean from half a step before to
half a step behind, by tables of integrals: no impulse is lost or counted twice, wherever in the step the jump lies.

Compiled by numba: import this module inside functions only. All of it is in one file, because numba looks only at the file of a
function to see whether the code that it keeps on disk is still good, not at those of the functions it calls. Loops instead of
whole arrays: these take numba seconds each to compile. SI units; places of teeth in base pitches.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Floats, Wholes
from gearcad.core.runtime import compiled, inlined

_LEAST_WINDOW = 1e-6
"""Least number of base pitches over which a mean is taken, also at rest."""

_MOST_PASSED, _FARTHEST = 1.001, 2.0**50
"""Base pitches that pass in a step at most - there is room for the teeth of so many - and places that are told apart."""

_NEWTON, _SWEEPS, _HALVINGS = 20, 200, 201
"""Newton's steps for all meshes at once; where these fail, meshes in turn, each by steps inside a bracket."""

_ALIKE = 1e-12
"""Relative difference of forces that is rounding."""

_TERMS = 40
"""Number of terms of series whose arguments are at most 1: a double has room for half of them."""

_APART = 16
"""Steps after which the size of a disturbance is looked at."""


class MotionModel(NamedTuple):
    """A System of n modes and m meshes with the springs of its teeth; `rows` (n, r) are sums of coordinates to be known.

    Approaches, forces and errors count positive as the mean load presses the flanks. `driven` (n,) are what the modes feel of a
    speed of the common period that rises by 1/s in a second; `scale` (1/s) weighs coordinates and rates in a disturbance, and
    `free` (n, r) are unit vectors of what turns as a whole, which is none.

    Torques beside those at rest act along `ripples` (n, e); `waves` (e, k) are even samples of each over the part of the common
    period after which it comes again, `cycles` (e,) times in that period.

    `marks` (m, 13) of each mesh are what the constants below name. `tables` (m, cells, 8) are cells of even width from the
    first to the last place of a tooth, each with the integral of stiffness before it, its mean, slope, the same three of
    stiffness times gap, and the error at its beginning with its slope. `teeth` (2, z) are more gap, and how much more per base
    pitch, of the teeth of all meshes one after the other; `errors` (k,) what the flanks must approach first, likewise, in even
    samples.
    """

    squares: Floats
    damping: Floats
    mesh: Floats
    load: Floats
    driven: Floats
    marks: Floats
    tables: Floats
    teeth: Floats
    errors: Floats
    rows: Floats
    free: Floats
    ripples: Floats
    waves: Floats
    cycles: Floats
    scale: float


_DAMPING, _BACKLASH, _OPENING = 0, 1, 2
"""Columns of `marks`: damping of the damper (N·s/m); clearance (m, nan: bonded); and opening.

Opening is 1 where gaps are of flanks that stand apart on both sides, else 0.
"""

_ORDER, _LEAD, _FIRST, _LAST = 3, 4, 5, 6
"""Columns of `marks`: teeth in the common period, base pitches by which they are early, first and last place with springs."""

_MIDDLE, _TOOTH_START, _TOOTH_COUNT = 7, 8, 9
"""Columns of `marks`: the place at which the slope of a tooth adds nothing, where teeth of this mesh begin,
and their number.
"""

_ERROR_START, _ERROR_COUNT, _ERROR_TEETH = 10, 11, 12
"""Columns of `marks`: where samples of the error begin, how many there are, and over how many teeth."""


class CourseTables(NamedTuple):
    """Straight lines over time, rows of times, values and integrals up to them: turns of the common period per second (3, k),
    whose integrals are turns, and the torque factor (3, l)."""

    speed: Floats
    factor: Floats


class MotionState(NamedTuple):
    """State of a run, changed in place: coordinates z, v (n,), forces (m,) on the meshes; dz, dv, df of a disturbance.

    `growth` is the logarithm of its size, the least so far, and the most by which it grew between any two times.
    """

    z: Floats
    v: Floats
    force: Floats
    dz: Floats
    dv: Floats
    df: Floats
    growth: Floats


class Records(NamedTuple):
    """Records of a run: at every `stride`-th step, and of windows of steps that end before `ends` (w,).

    `approach`, `spring`, `total` (k, m) are y, the force of the springs and with it that of the damper; `sums`, `rates` (k, r)
    the rows of the model and their rates. Of each window: `crests` (w, m, 3) are the most and least of the spring's force and
    the most of both; `parted` (w, m) the steps in which no flank pressed; `reach` (w, r, 2) most and least of the rows.
    """

    stride: int
    approach: Floats
    spring: Floats
    total: Floats
    sums: Floats
    rates: Floats
    ends: Wholes
    crests: Floats
    parted: Floats
    reach: Floats


# ---------------------------------------------------------------------- modes


@compiled
def _mean_decay(rate: float) -> tuple[float, float]:
    """Return the integrals over x from 0 to 1 of exp(-rate x) and of (1 - x) exp(-rate x)."""
    if rate < 1.0:
        first, second, term = 0.0, 0.0, 1.0
        for k in range(1, _TERMS):
            first += term / k
            second += term / (k * (k + 1))
            term *= -rate / k
        return first, second
    first = -math.expm1(-rate) / rate
    return first, (1.0 - first) / rate


@compiled
def _series(square: float, damping: float, z: float, v: float, force: float, ramp: float) -> tuple[float, float]:
    """Return z and its rate at 1 of z'' + damping z' + square z = force + ramp x, by its power series."""
    before, here, total, rate = z, v, z + v, v
    for k in range(_TERMS):
        push = force if k == 0 else (ramp if k == 1 else 0.0)
        following = (push - damping * (k + 1) * here - square * before) / ((k + 1) * (k + 2))
        total += following
        rate += (k + 2) * following
        before, here = here, following
    return total, rate


@compiled
def _unit_step(square: float, damping: float) -> tuple[float, float, float, float, float, float]:
    """Return (zz, zv, vz, vv, S, R) over a time of 1.

    S and R are what a force of 1, and one that rises to 1, leave of z. Their rates there are zv and S: a response to the
    integral of a force is the integral of the response.
    """
    if square <= 1.0 and damping <= 1.0:
        zz, vz = _series(square, damping, 1.0, 0.0, 0.0, 0.0)
        zv, vv = _series(square, damping, 0.0, 1.0, 0.0, 0.0)
        return zz, zv, vz, vv, _series(square, damping, 0.0, 0.0, 1.0, 0.0)[0], _series(square, damping, 0.0, 0.0, 0.0, 1.0)[0]
    half = 0.5 * damping
    inside = half * half - square
    if inside > 0.0:
        root = math.sqrt(inside)
        fast = half + root
        slow = square / fast
        if 2.0 * root > 0.5 * fast:
            first, second = math.exp(-slow), math.exp(-fast)
            between = fast - slow
            (s1, r1), (s2, r2) = _mean_decay(slow), _mean_decay(fast)
            zz, zv = (fast * first - slow * second) / between, (first - second) / between
            vv = (fast * second - slow * first) / between
            return zz, zv, -square * zv, vv, (s1 - s2) / between, (r1 - r2) / between
        even, odd = 0.5 * (math.exp(-slow) + math.exp(-fast)), 0.5 * (math.exp(-slow) - math.exp(-fast)) / root
    elif inside < 0.0:
        turns, decay = math.sqrt(-inside), math.exp(-half)
        even, odd = decay * math.cos(turns), decay * math.sin(turns) / turns
    else:
        even = odd = math.exp(-half)
    zz = even + half * odd
    step = (1.0 - zz) / square
    return zz, odd, -square * odd, even - half * odd, step, (1.0 - odd - damping * step) / square


@compiled
def propagators(squares: Floats, damping: Floats, h: float) -> Floats:
    """Return the propagators (n, 8) over a step h: zz, zv, vz, vv, and the effect of the force.

    The effect is what the force at the beginning and at the end of the step leave of z, and then of v.
    """
    result = np.empty((squares.size, 8))
    for i in range(squares.size):
        zz, zv, vz, vv, s, r = _unit_step(squares[i] * h * h, damping[i] * h)
        result[i, 0], result[i, 1], result[i, 2], result[i, 3] = zz, h * zv, vz / h, vv
        result[i, 4], result[i, 5] = h * h * (s - r), h * h * r
        result[i, 6], result[i, 7] = h * (zv - s), h * s
    return result


# ---------------------------------------------------------------------- speed, torque, teeth


@inlined
def _along(line: Floats, cursor: int, t: float) -> tuple[float, float, int]:
    """Return value and integral at t of straight lines that go on level beyond their ends; the cursor never turns back."""
    while cursor + 1 < line.shape[1] and line[0, cursor + 1] <= t:
        cursor += 1
    after, slope = t - line[0, cursor], 0.0
    if after >= 0.0 and cursor + 1 < line.shape[1]:
        slope = (line[1, cursor + 1] - line[1, cursor]) / (line[0, cursor + 1] - line[0, cursor])
    return line[1, cursor] + slope * after, line[2, cursor] + after * (line[1, cursor] + 0.5 * slope * after), cursor


@inlined
def _integrals(tables: Floats, j: int, first: float, width: float, place: float) -> tuple[float, float, float]:
    """Return integrals of the stiffness and of stiffness times gap up to a place of the tooth, and the error there."""
    cell = min(max(int((place - first) / width), 0), tables.shape[1] - 1)
    x = place - first - cell * width
    rest = 0.5 * (x - width)
    stiffness = tables[j, cell, 0] + x * (tables[j, cell, 1] + tables[j, cell, 2] * rest)
    weighted = tables[j, cell, 3] + x * (tables[j, cell, 4] + tables[j, cell, 5] * rest)
    return stiffness, weighted, tables[j, cell, 6] + tables[j, cell, 7] * x


@inlined
def _long_error(marks: Floats, errors: Floats, j: int, place: float) -> float:
    """Return the error that comes again with the gears, at base pitches of mesh j (m)."""
    start, count, teeth = int(marks[j, _ERROR_START]), int(marks[j, _ERROR_COUNT]), marks[j, _ERROR_TEETH]
    along = (place - teeth * math.floor(place / teeth)) / teeth * count if count > 1 else 0.0
    k = min(int(along), count - 1)
    following = start + (k + 1) % count
    found: float = errors[start + k] + (along - k) * (errors[following] - errors[start + k])
    return found


@inlined
def _engage(
    marks: Floats, tables: Floats, teeth: Floats, errors: Floats, j: int, begin: float, end: float, springs: Floats
) -> tuple[int, float, float]:
    """Fill in stiffness and gap (rows of springs[j]) of the teeth met from `begin` to `end`, in base pitches of mesh j.

    Returns how many there are, the error, and its change in a base pitch.
    """
    low, high = min(begin, end), max(begin, end)
    short = max(0.5 * (_LEAST_WINDOW - (high - low)), 0.0)
    low, high = low - short, high + short
    first, last = marks[j, _FIRST], marks[j, _LAST]
    width = (last - first) / tables.shape[1]
    tooth, met, count, at_low, at_high = math.floor(high - first), 0, 0, 0.0, 0.0
    while low - tooth < last:
        a, b = max(low - tooth, first), min(high - tooth, last)
        if b > a:
            k0, w0, at_low = _integrals(tables, j, first, width, a)
            k1, w1, error = _integrals(tables, j, first, width, b)
            at_high = at_high if met else error
            met += 1
            if k1 > k0:
                which = int(marks[j, _TOOTH_START]) + tooth % int(marks[j, _TOOTH_COUNT])
                more = teeth[0, which] + teeth[1, which] * (0.5 * (a + b) - marks[j, _MIDDLE])
                springs[j, count, 0] = (k1 - k0) / (high - low)
                springs[j, count, 1] = (w1 - w0) / (k1 - k0) + more
                count += 1
        tooth -= 1
    from_error, to_error = _long_error(marks, errors, j, low), _long_error(marks, errors, j, high)
    return count, 0.5 * (from_error + to_error), (to_error - from_error + at_high - at_low) / (high - low)


@inlined
def _carried(marks: Floats, springs: Floats, j: int, count: int, y: float) -> tuple[float, float]:
    """Return the force (N) of the springs of mesh j at an approach y of its flanks beyond their error, and its tangent
    stiffness.
    """
    backlash, force, slope = marks[j, _BACKLASH], 0.0, 0.0
    for p in range(count):
        stiffness, gap = springs[j, p, 0], springs[j, p, 1]
        front = y - gap
        back = y + backlash + (gap if marks[j, _OPENING] else -gap)
        if front > 0.0 or math.isnan(backlash):
            force += stiffness * front
            slope += stiffness
        elif back < 0.0:
            force += stiffness * back
            slope += stiffness
    return force, slope


# ---------------------------------------------------------------------- forces at the end of a step


@compiled
def _eliminate(matrix: Floats, right: Floats) -> None:
    """Solve in place, with row pivots; matrices are of the size of the number of meshes."""
    n = right.size
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if best != k:
            for i in range(k, n):
                matrix[k, i], matrix[best, i] = matrix[best, i], matrix[k, i]
            right[k], right[best] = right[best], right[k]
        for i in range(k + 1, n):
            part = matrix[i, k] / matrix[k, k]
            for column in range(k + 1, n):
                matrix[i, column] -= part * matrix[k, column]
            right[i] -= part * right[k]
    for k in range(n - 1, -1, -1):
        for i in range(k + 1, n):
            right[k] -= matrix[k, i] * right[i]
        right[k] /= matrix[k, k]


@inlined
def _one_mesh(
    marks: Floats, springs: Floats, j: int, count: int, y: float, v: float, give: float, rate: float
) -> tuple[float, float, float]:
    """Return the force of mesh j alone, the part of it that the springs carry, and their stiffness.

    Its approach is y and the rate of that v, less `give` and `rate` for each newton. Newton's steps inside a bracket: the
    springs never give way, so there is just one such force.
    """
    damped = marks[j, _DAMPING] * v
    share = 1.0 / (1.0 + marks[j, _DAMPING] * rate)
    part = give * share
    low, high, x = -np.inf, np.inf, y
    spring, slope = 0.0, 0.0
    for _ in range(_HALVINGS):
        spring, slope = _carried(marks, springs, j, count, x)
        value = x - y + part * (spring + damped)
        if not abs(value) > _ALIKE * (abs(x) + abs(y)):  # nor where it is no number any more
            break
        if value > 0.0:
            high = min(high, x)
        else:
            low = max(low, x)
        x -= value / (1.0 + part * slope)
        if not low <= x <= high:
            x = 0.5 * (low + high)
    return share * (spring + damped), spring, slope


@inlined
def _together(
    marks: Floats, springs: Floats, counts: Wholes, y: Floats, v: Floats, give: Floats, rate: Floats, found: Floats,
    work: Floats
) -> bool:  # fmt: skip
    """Find the forces (m,) of all meshes, the parts that springs carry, and their stiffness: the rows of `found`.

    With them y and v less `give` and `rate` times the forces are the approaches and their rates. Begins with the forces that
    are there. Returns False where Newton's steps do not come to rest.
    """
    m = y.size
    for _ in range(_NEWTON):
        done = True
        for j in range(m):
            here, speed = y[j], v[j]
            for k in range(m):
                here -= give[j, k] * found[0, k]
                speed -= rate[j, k] * found[0, k]
            found[1, j], found[2, j] = _carried(marks, springs, j, counts[j], here)
            off = found[1, j] + marks[j, _DAMPING] * speed - found[0, j]
            done &= not abs(off) > _ALIKE * (abs(found[1, j]) + abs(found[0, j]) + found[2, j] * abs(y[j]))
            work[j, m] = off
            for k in range(m):
                work[j, k] = found[2, j] * give[j, k] + marks[j, _DAMPING] * rate[j, k]
            work[j, j] += 1.0
        if done:
            return True
        _eliminate(work[:, :m], work[:, m])
        for j in range(m):
            found[0, j] += work[j, m]
    return False


@compiled
def _in_turn(
    marks: Floats, springs: Floats, counts: Wholes, y: Floats, v: Floats, give: Floats, rate: Floats, found: Floats
) -> bool:
    """Find the same forces mesh after mesh until none changes any more; return whether that succeeds."""
    m = y.size
    for _ in range(_SWEEPS):
        most, scale = 0.0, 0.0
        for j in range(m):
            here, speed, before = y[j], v[j], found[0, j]
            for k in range(m):
                if k != j:
                    here -= give[j, k] * found[0, k]
                    speed -= rate[j, k] * found[0, k]
            found[0, j], found[1, j], found[2, j] = _one_mesh(marks, springs, j, counts[j], here, speed, give[j, j], rate[j, j])
            most, scale = max(most, abs(found[0, j] - before)), max(scale, abs(found[0, j]) + found[2, j] * abs(y[j]))
        if most <= _ALIKE * scale:
            return True
    return False


# ---------------------------------------------------------------------- a disturbance


@inlined
def _disturb(
    mesh: Floats, marks: Floats, steps: Floats, dz: Floats, dv: Floats, df: Floats, give: Floats, rate: Floats, slopes: Floats,
    work: Floats
) -> None:  # fmt: skip
    """Take the disturbance over one step, along the tangent of the motion."""
    n, m = mesh.shape
    for j in range(m):
        work[j, m] = 0.0
    for i in range(n):
        push = 0.0
        for j in range(m):
            push -= mesh[i, j] * df[j]
        z, v = dz[i], dv[i]
        dz[i] = steps[i, 0] * z + steps[i, 1] * v + steps[i, 4] * push
        dv[i] = steps[i, 2] * z + steps[i, 3] * v + steps[i, 6] * push
        for j in range(m):
            work[j, m] += mesh[i, j] * (slopes[j] * dz[i] + marks[j, _DAMPING] * dv[i])
    for j in range(m):
        for k in range(m):
            work[j, k] = slopes[j] * give[j, k] + marks[j, _DAMPING] * rate[j, k]
        work[j, j] += 1.0
    _eliminate(work[:, :m], work[:, m])
    for j in range(m):
        df[j] = work[j, m]
        for i in range(n):
            dz[i] -= steps[i, 5] * mesh[i, j] * df[j]
            dv[i] -= steps[i, 7] * mesh[i, j] * df[j]


@compiled
def _sum(rows: Floats, r: int, values: Floats) -> float:
    """Return one of the sums of coordinates."""
    total = 0.0
    for i in range(values.size):
        total += rows[i, r] * values[i]
    return total


@compiled
def _measure(scale: float, free: Floats, dz: Floats, dv: Floats, df: Floats, growth: Floats) -> None:
    """Add the growth of the disturbance to its account, and make it small again.

    What turns as a whole is taken out: nothing damps it, so that after a while only rounding in it would be left.
    """
    for r in range(free.shape[1]):
        turned, turning = _sum(free, r, dz), _sum(free, r, dv)
        for i in range(dz.size):
            dz[i] -= turned * free[i, r]
            dv[i] -= turning * free[i, r]
    size = 0.0
    for i in range(dz.size):
        size += (scale * dz[i]) ** 2 + dv[i] ** 2
    size = math.sqrt(size)
    if not 0.0 < size < math.inf:
        return
    for i in range(dz.size):
        dz[i] /= size
        dv[i] /= size
    for j in range(df.size):
        df[j] /= size
    growth[0] += math.log(size)
    growth[1] = min(growth[1], growth[0])
    growth[2] = max(growth[2], growth[0] - growth[1])


# ---------------------------------------------------------------------- steps


@compiled
def _yielding(mesh: Floats, left: Floats) -> Floats:
    """Return (m, m) by how much approaches, or their rates, are less for each newton at the end of a step.

    `left` (n,) is what each mode gets of that newton.
    """
    n, m = mesh.shape
    result = np.zeros((m, m))
    for i in range(n):
        for j in range(m):
            for k in range(m):
                result[j, k] += left[i] * mesh[i, j] * mesh[i, k]
    return result


@inlined
def _moved(
    mesh: Floats, steps: Floats, z: Floats, v: Floats, push: Floats, load: Floats, driven: Floats, factor: float, faster: float,
    still: bool, y: Floats, rates: Floats
) -> None:  # fmt: skip
    """Set the coordinates at the end of a step without the forces of the meshes there, and the approaches and their rates.

    If the step is `still`, the coordinates remain as they are.
    """
    n, m = mesh.shape
    for j in range(m):
        y[j] = rates[j] = 0.0
    for i in range(n):
        pushed = factor * load[i] + faster * driven[i]
        if not still:
            before, speed = z[i], v[i]
            z[i] = steps[i, 0] * before + steps[i, 1] * speed + steps[i, 4] * push[i] + steps[i, 5] * pushed
            v[i] = steps[i, 2] * before + steps[i, 3] * speed + steps[i, 6] * push[i] + steps[i, 7] * pushed
        push[i] = pushed
        for j in range(m):
            y[j] += mesh[i, j] * z[i]
            rates[j] += mesh[i, j] * v[i]


@inlined
def _pressed(mesh: Floats, steps: Floats, z: Floats, v: Floats, push: Floats, forces: Floats, still: bool) -> None:
    """Apply the forces of the meshes to the coordinates, and to what pushes them into the next step."""
    n, m = mesh.shape
    for i in range(n):
        total = 0.0
        for j in range(m):
            total += mesh[i, j] * forces[j]
        if not still:
            z[i] -= steps[i, 5] * total
            v[i] -= steps[i, 7] * total
        push[i] -= total


@inlined
def _counted(crests: Floats, parted: Floats, reach: Floats, rows: Floats, window: int, found: Floats, z: Floats) -> None:
    """Count one step in its window."""
    for j in range(found.shape[1]):
        force, spring = found[0, j], found[1, j]
        crests[window, j, 0] = max(crests[window, j, 0], spring)
        crests[window, j, 1] = min(crests[window, j, 1], spring)
        crests[window, j, 2] = max(crests[window, j, 2], force)
        parted[window, j] += spring == 0.0
    for r in range(reach.shape[1]):
        total = _sum(rows, r, z)
        reach[window, r, 0], reach[window, r, 1] = max(reach[window, r, 0], total), min(reach[window, r, 1], total)


@compiled
def _written(records: Records, number: int, rows: Floats, found: Floats, y: Floats, z: Floats, v: Floats) -> None:
    """Write the sample of that number to the records."""
    for j in range(y.size):
        records.approach[number, j] = y[j]
        records.total[number, j], records.spring[number, j] = found[0, j], found[1, j]
    for r in range(rows.shape[1]):
        records.sums[number, r], records.rates[number, r] = _sum(rows, r, z), _sum(rows, r, v)


@compiled
def run(
    model: MotionModel, course: CourseTables, h: float, begin: int, count: int, state: MotionState, records: Records
) -> int:
    """Run steps `begin` + 1 to `begin` + `count` of h seconds, and return how many were made.

    These are `count` unless the forces of a step could not be found, or more than a base pitch passed in one. The first step
    also writes down what is before it if that is step 0.
    """
    # Arrays by themselves: to take one out of a tuple costs as much as to use it. And what else could be functions of their own
    # stands here: with two more of them a step takes twice as long.
    mesh, marks, tables, teeth, errors = model.mesh, model.marks, model.tables, model.teeth, model.errors
    load, driven, rows = model.load, model.driven, model.rows
    ripples, waves, cycles = model.ripples, model.waves, model.cycles
    z, v, dz, dv, df = state.z, state.v, state.dz, state.dv, state.df
    ends, crests, parted, reach, samples = records.ends, records.crests, records.parted, records.reach, len(records.approach)
    speeds, factors = course.speed, course.factor
    n, m = mesh.shape
    steps = propagators(model.squares, model.damping, h)
    give, rate = _yielding(mesh, steps[:, 5]), _yielding(mesh, steps[:, 7])
    longest = 0.0
    for j in range(m):
        longest = max(longest, marks[j, _LAST] - marks[j, _FIRST])
    most = math.ceil(longest + _MOST_PASSED) + 1
    springs, counts, work = np.zeros((m, most, 2)), np.zeros(m, np.int64), np.zeros((m, m + 1))
    y, rates, shift, push, found = np.zeros(m), np.zeros(m), np.zeros(m), np.zeros(n), np.zeros((3, m))
    for j in range(m):
        found[0, j] = state.force[j]
    loaded = np.zeros(n)
    speed, turns, passed, at_speed, at_factor, window = 0.0, 0.0, 0.0, 0, 0, 0
    taken = begin // records.stride + 1 if begin > 0 else 0
    for step in range(begin - 1, begin + count + 1):
        still = step == begin
        speed_before, turns_before, passed_before = speed, turns, passed
        speed, turns, at_speed = _along(speeds, at_speed, (step + 0.5) * h)
        _, passed, at_factor = _along(factors, at_factor, (step + 0.5) * h)
        if step < begin:
            continue
        factor, faster = (passed - passed_before) / h, (speed - speed_before) / h
        if cycles.size:
            # All torques of the step are put into one load: it acts with a factor of 1.
            for i in range(n):
                loaded[i] = factor * load[i]
            for e in range(cycles.size):
                along = 0.5 * (turns_before + turns) * cycles[e]
                along = (along - math.floor(along)) * waves.shape[1]
                k = min(int(along), waves.shape[1] - 1)
                torque = waves[e, k] + (along - k) * (waves[e, (k + 1) % waves.shape[1]] - waves[e, k])
                for i in range(n):
                    loaded[i] += factor * torque * ripples[i, e]
            _moved(mesh, steps, z, v, push, loaded, driven, 1.0, faster, still, y, rates)
        else:
            _moved(mesh, steps, z, v, push, load, driven, factor, faster, still, y, rates)
        for j in range(m):
            from_place = marks[j, _ORDER] * turns_before + marks[j, _LEAD]
            to_place = marks[j, _ORDER] * turns + marks[j, _LEAD]
            if not (abs(to_place - from_place) <= _MOST_PASSED and abs(to_place) < _FARTHEST):
                return step - begin - 1
            counts[j], shift[j], change = _engage(marks, tables, teeth, errors, j, from_place, to_place, springs)
            y[j] -= shift[j]
            rates[j] -= change * (to_place - from_place) / h
        if still:
            for j in range(m):
                found[1, j], found[2, j] = _carried(marks, springs, j, counts[j], y[j])
                found[0, j] = found[1, j] + marks[j, _DAMPING] * rates[j]
        elif m == 1:
            found[0, 0], found[1, 0], found[2, 0] = _one_mesh(
                marks, springs, 0, counts[0], y[0], rates[0], give[0, 0], rate[0, 0]
            )
        elif not _together(marks, springs, counts, y, rates, give, rate, found, work):
            if not _in_turn(marks, springs, counts, y, rates, give, rate, found):
                return step - begin - 1
        _pressed(mesh, steps, z, v, push, found[0], still)
        if dz.size and not still:
            _disturb(mesh, marks, steps, dz, dv, df, give, rate, found[2], work)
            if step % _APART == 0:
                _measure(model.scale, model.free, dz, dv, df, state.growth)
        if still and begin > 0:
            continue
        sample = step // records.stride - taken
        if step % records.stride == 0 and sample < samples:
            for j in range(m):
                y[j] = _sum(mesh, j, z)
            _written(records, sample, rows, found, y, z, v)
        while window < ends.size and step >= ends[window]:
            window += 1
        if window < ends.size:
            _counted(crests, parted, reach, rows, window, found, z)
    for j in range(m):
        state.force[j] = found[0, j]
    return count
