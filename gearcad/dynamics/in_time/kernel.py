"""A System under any speed and torque, stepped through time: its modes exactly, what the teeth carry implicitly.

Every mode z'' + d z' + s z = g is propagated in closed form over a step over which its force g runs in a straight line. Forces
of the meshes at the end of a step are those that the motion there asks for: equations that are linear between the kinks of the
springs, one for each mesh. So the motion is good to second order in the step. However quick or damped a mode is, it asks for no
shorter steps; but a vibration on the springs of the teeth must have two steps at least. Without damping it then neither grows
nor fades: one step is a matrix of determinant 1.

What jumps - stiffness where a pair of teeth comes or goes, torque, speed - is taken as its mean from half a step before to half
a step behind, by tables of integrals: no impulse is lost or found twice, wherever in the step the jump lies.

Compiled by numba: import this room inside functions only. All of it is in one file, because numba looks only at the file of a
function to see whether the code that it keeps on disk is still good, not at those of the functions it calls. SI units; places
of teeth in base pitches.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.dynamics.compiled import compiled, inlined

__all__ = ["CourseTables", "Model", "Records", "State", "propagators", "run"]

_LEAST_WINDOW = 1e-6
"""Base pitches over which a mean is taken at least: at rest as well."""

_MOST_PASSED, _FARTHEST = 1.001, 2.0**50
"""Base pitches that pass in a step at most - there is room for the teeth of so many - and places that are told apart."""

_NEWTON, _SWEEPS, _HALVINGS = 20, 200, 200
"""Newton's steps for all meshes at once; where these fail, meshes in turn, each by steps inside a bracket."""

_ALIKE = 1e-12
"""Relative difference of forces that is rounding."""

_TERMS = 40
"""Of series whose arguments are at most 1: a double has room for half of them."""

_APART = 16
"""Steps after which the size of a disturbance is looked at."""


class Model(NamedTuple):
    """A System of n modes and m meshes with the springs of its teeth; `rows` (n, r) are sums of coordinates to be known.

    Approaches, forces and errors count positive as the mean load presses the flanks. `driven` (n,) are what the modes feel of a
    speed of the common period that rises by 1/s in a second; `scale` (1/s) weighs coordinates and rates in a disturbance.

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
    scale: float


_DAMPING, _BACKLASH, _OPENING = 0, 1, 2
"""Of the damper (N·s/m); clearance (m, nan: bonded); 1 where gaps are of flanks that stand apart on both sides, else 0."""

_ORDER, _LEAD, _FIRST, _LAST = 3, 4, 5, 6
"""Teeth in the common period, base pitches by which they are early, and between which places they have springs."""

_MIDDLE, _TOOTH_START, _TOOTH_COUNT = 7, 8, 9
"""The place at which the slope of a tooth adds nothing; where the teeth of this mesh begin, and how many there are."""

_ERROR_START, _ERROR_COUNT, _ERROR_TEETH = 10, 11, 12
"""Where samples of the error begin, how many there are, and over how many teeth."""


class CourseTables(NamedTuple):
    """Straight lines over time: turns of the common period per second with the turns before, the torque factor likewise."""

    speed_time: Floats
    speed: Floats
    turns: Floats
    factor_time: Floats
    factor: Floats
    factor_sum: Floats


class State(NamedTuple):
    """Where a run stands, changed in place: coordinates z, v (n,), forces (m,) on the meshes; dz, dv, df of a disturbance.

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
    """What a run writes down: at every `stride`-th step, and of windows of steps that end before `ends` (w,).

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
    """Integrals over x from 0 to 1 of exp(-rate x) and of (1 - x) exp(-rate x)."""
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
    """z and its rate at 1 of z'' + damping z' + square z = force + ramp x, by its power series."""
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
    """(zz, zv, vz, vv, S, R): over a time of 1, and what a force of 1, and one that rises to 1, leave of z.

    Their rates there are zv and S: a response to the integral of a force is the integral of the response.
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
    """(n, 8): zz, zv, vz, vv over a step h, then what the force at its beginning and at its end leave of z, and of v."""
    result = np.empty((squares.size, 8))
    for i in range(squares.size):
        zz, zv, vz, vv, s, r = _unit_step(squares[i] * h * h, damping[i] * h)
        result[i, 0], result[i, 1], result[i, 2], result[i, 3] = zz, h * zv, vz / h, vv
        result[i, 4], result[i, 5] = h * h * (s - r), h * h * r
        result[i, 6], result[i, 7] = h * (zv - s), h * s
    return result


# ---------------------------------------------------------------------- speed, torque, teeth


@inlined
def _along(times: Floats, values: Floats, sums: Floats, cursor: int, t: float) -> tuple[float, float, int]:
    """Value and integral at t of straight lines that go on level beyond their ends; the cursor never turns back."""
    while cursor + 1 < times.size and times[cursor + 1] <= t:
        cursor += 1
    after = t - times[cursor]
    if after < 0.0 or cursor + 1 == times.size:
        return values[cursor], sums[cursor] + values[cursor] * after, cursor
    slope = (values[cursor + 1] - values[cursor]) / (times[cursor + 1] - times[cursor])
    return values[cursor] + slope * after, sums[cursor] + after * (values[cursor] + 0.5 * slope * after), cursor


@inlined
def _integrals(tables: Floats, j: int, first: float, width: float, place: float) -> tuple[float, float, float]:
    """At a place of the tooth: integrals of the stiffness and of stiffness times gap up to it, and the error."""
    cell = min(max(int((place - first) / width), 0), tables.shape[1] - 1)
    x = place - first - cell * width
    rest = 0.5 * (x - width)
    stiffness = tables[j, cell, 0] + x * (tables[j, cell, 1] + tables[j, cell, 2] * rest)
    weighted = tables[j, cell, 3] + x * (tables[j, cell, 4] + tables[j, cell, 5] * rest)
    return stiffness, weighted, tables[j, cell, 6] + tables[j, cell, 7] * x


@inlined
def _long_error(marks: Floats, errors: Floats, j: int, place: float) -> float:
    """The error that comes again with the gears, at base pitches of mesh j (m)."""
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

    Gives how many there are, the error, and its change in a base pitch.
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
    """What the springs of mesh j carry where its flanks approach by y besides their error, and their tangent stiffness."""
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
def _one_mesh(marks: Floats, springs: Floats, j: int, count: int, y: float, v: float, give: float, rate: float) -> float:
    """Force of mesh j alone: its approach is y and the rate of it v, less `give` and `rate` for each newton.

    Newton's steps inside a bracket: the springs never give way, so there is just one such force.
    """
    damping = marks[j, _DAMPING]
    part = give / (1.0 + damping * rate)
    low, high, x = -np.inf, np.inf, y
    for _ in range(_HALVINGS):
        force, slope = _carried(marks, springs, j, count, x)
        value = x - y + part * (force + damping * v)
        if value > 0.0:
            high = min(high, x)
        else:
            low = max(low, x)
        following = x - value / (1.0 + part * slope)
        if not low <= following <= high:
            following = 0.5 * (low + high)
        if abs(following - x) <= _ALIKE * (abs(x) + abs(y)):
            break
        x = following
    force, _ = _carried(marks, springs, j, count, x)
    found: float = (force + damping * v) / (1.0 + damping * rate)
    return found


@inlined
def _forces(
    marks: Floats, springs: Floats, counts: Wholes, y: Floats, v: Floats, give: Floats, rate: Floats, force: Floats,
    slopes: Floats, work: Floats
) -> bool:  # fmt: skip
    """Forces (m,) of all meshes, where y and v less `give` and `rate` times these are their approaches.

    Begins with the forces that are there. False where neither Newton's steps nor meshes in turn come to rest.
    """
    m = y.size
    if m == 1:
        force[0] = _one_mesh(marks, springs, 0, counts[0], y[0], v[0], give[0, 0], rate[0, 0])
        slopes[0] = _carried(marks, springs, 0, counts[0], y[0] - give[0, 0] * force[0])[1]
        return True
    for _ in range(_NEWTON):
        done = True
        for j in range(m):
            here, speed = y[j], v[j]
            for k in range(m):
                here -= give[j, k] * force[k]
                speed -= rate[j, k] * force[k]
            spring, slopes[j] = _carried(marks, springs, j, counts[j], here)
            off = spring + marks[j, _DAMPING] * speed - force[j]
            done &= abs(off) <= _ALIKE * (abs(spring) + abs(force[j]) + slopes[j] * abs(y[j]))
            work[j, m] = off
            for k in range(m):
                work[j, k] = slopes[j] * give[j, k] + marks[j, _DAMPING] * rate[j, k]
            work[j, j] += 1.0
        if done:
            return True
        _eliminate(work[:, :m], work[:, m])
        for j in range(m):
            force[j] += work[j, m]
    return _in_turn(marks, springs, counts, y, v, give, rate, force, slopes)


@compiled
def _in_turn(
    marks: Floats, springs: Floats, counts: Wholes, y: Floats, v: Floats, give: Floats, rate: Floats, force: Floats,
    slopes: Floats
) -> bool:  # fmt: skip
    """The same, mesh after mesh until none changes any more."""
    m = y.size
    for _ in range(_SWEEPS):
        most, scale = 0.0, 0.0
        for j in range(m):
            here, speed = y[j], v[j]
            for k in range(m):
                if k != j:
                    here -= give[j, k] * force[k]
                    speed -= rate[j, k] * force[k]
            found = _one_mesh(marks, springs, j, counts[j], here, speed, give[j, j], rate[j, j])
            slopes[j] = _carried(marks, springs, j, counts[j], here - give[j, j] * found)[1]
            most, scale = max(most, abs(found - force[j])), max(scale, abs(found) + slopes[j] * abs(y[j]))
            force[j] = found
        if most <= _ALIKE * scale:
            return True
    return False


# ---------------------------------------------------------------------- steps


@inlined
def _disturb(
    mesh: Floats, marks: Floats, steps: Floats, dz: Floats, dv: Floats, df: Floats, give: Floats, rate: Floats, slopes: Floats,
    work: Floats
) -> None:  # fmt: skip
    """Take the disturbance over one step, along the tangent of the motion."""
    n, m = mesh.shape
    work[:, m] = 0.0
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
def _measure(scale: float, dz: Floats, dv: Floats, df: Floats, growth: Floats) -> None:
    """Add the growth of the disturbance to its account, and make it small again."""
    size = 0.0
    for i in range(dz.size):
        size += (scale * dz[i]) ** 2 + dv[i] ** 2
    size = math.sqrt(size)
    if not 0.0 < size < math.inf:
        return
    dz /= size
    dv /= size
    df /= size
    growth[0] += math.log(size)
    growth[1] = min(growth[1], growth[0])
    growth[2] = max(growth[2], growth[0] - growth[1])


@compiled
def _sum(rows: Floats, r: int, values: Floats) -> float:
    """One of the sums of coordinates."""
    total = 0.0
    for i in range(values.size):
        total += rows[i, r] * values[i]
    return total


@compiled
def run(model: Model, course: CourseTables, h: float, begin: int, count: int, state: State, records: Records) -> int:
    """Steps `begin` + 1 to `begin` + `count` of h seconds; the first also writes down what is before it if that is step 0.

    Gives how many steps were made before the forces of one could not be found, or more than a base pitch passed in one: `count`
    if all could.
    """
    mesh, marks, tables, teeth, errors_of, load, driven = (
        model.mesh, model.marks, model.tables, model.teeth, model.errors, model.load, model.driven
    )  # fmt: skip
    state_z, state_v, force, dz, dv, df = state.z, state.v, state.force, state.dz, state.dv, state.df
    rows, ends, crests, parted, reach = model.rows, records.ends, records.crests, records.parted, records.reach
    approach, spring_at, total_at, sums, rates = records.approach, records.spring, records.total, records.sums, records.rates
    n, m = mesh.shape
    steps = propagators(model.squares, model.damping, h)
    give, rate = np.zeros((m, m)), np.zeros((m, m))
    for i in range(n):
        for j in range(m):
            for k in range(m):
                give[j, k] += steps[i, 5] * mesh[i, j] * mesh[i, k]
                rate[j, k] += steps[i, 7] * mesh[i, j] * mesh[i, k]
    most = 2
    for j in range(m):
        most = max(most, math.ceil(marks[j, _LAST] - marks[j, _FIRST] + _MOST_PASSED) + 1)
    springs, counts, work = np.zeros((m, most, 2)), np.zeros(m, np.int64), np.zeros((m, m + 1))
    y, v, spring, slopes = np.zeros(m), np.zeros(m), np.zeros(m), np.zeros(m)
    errors, push = np.zeros(m), np.zeros(n)
    speed_time, speed_at, turns_at = course.speed_time, course.speed, course.turns
    factor_time, factor_at, factor_sum = course.factor_time, course.factor, course.factor_sum
    t = (begin - 0.5) * h
    speed, turns, at_speed = _along(speed_time, speed_at, turns_at, 0, t)
    _, passed, at_factor = _along(factor_time, factor_at, factor_sum, 0, t)
    window, sampled = 0, 0
    for step in range(begin, begin + count + 1):
        t = (step + 0.5) * h
        speed_before, turns_before, passed_before = speed, turns, passed
        speed, turns, at_speed = _along(speed_time, speed_at, turns_at, at_speed, t)
        _, passed, at_factor = _along(factor_time, factor_at, factor_sum, at_factor, t)
        factor, faster = (passed - passed_before) / h, (speed - speed_before) / h
        first = step == begin
        for j in range(m):
            y[j] = v[j] = 0.0
        for i in range(n):
            pushed = factor * load[i] + faster * driven[i]
            if not first:
                z, vz = state_z[i], state_v[i]
                state_z[i] = steps[i, 0] * z + steps[i, 1] * vz + steps[i, 4] * push[i] + steps[i, 5] * pushed
                state_v[i] = steps[i, 2] * z + steps[i, 3] * vz + steps[i, 6] * push[i] + steps[i, 7] * pushed
            push[i] = pushed
            for j in range(m):
                y[j] += mesh[i, j] * state_z[i]
                v[j] += mesh[i, j] * state_v[i]
        for j in range(m):
            from_place = marks[j, _ORDER] * turns_before + marks[j, _LEAD]
            to_place = marks[j, _ORDER] * turns + marks[j, _LEAD]
            if not (abs(to_place - from_place) <= _MOST_PASSED and abs(to_place) < _FARTHEST):
                return step - begin - 1
            counts[j], errors[j], change = _engage(marks, tables, teeth, errors_of, j, from_place, to_place, springs)
            y[j] -= errors[j]
            v[j] -= change * (to_place - from_place) / h
        if first:
            for j in range(m):
                spring[j], slopes[j] = _carried(marks, springs, j, counts[j], y[j])
                force[j] = spring[j] + marks[j, _DAMPING] * v[j]
        else:
            if not _forces(marks, springs, counts, y, v, give, rate, force, slopes, work):
                return step - begin - 1
            for i in range(n):
                for j in range(m):
                    state_z[i] -= steps[i, 5] * mesh[i, j] * force[j]
                    state_v[i] -= steps[i, 7] * mesh[i, j] * force[j]
            for j in range(m):
                for k in range(m):
                    y[j] -= give[j, k] * force[k]
                spring[j], _ = _carried(marks, springs, j, counts[j], y[j])
            if dz.size:
                _disturb(mesh, marks, steps, dz, dv, df, give, rate, slopes, work)
                if step % _APART == 0:
                    _measure(model.scale, dz, dv, df, state.growth)
        for i in range(n):
            for j in range(m):
                push[i] -= mesh[i, j] * force[j]
        if first and begin > 0:
            continue
        if step % records.stride == 0 and sampled < approach.shape[0]:
            for j in range(m):
                approach[sampled, j], spring_at[sampled, j], total_at[sampled, j] = y[j] + errors[j], spring[j], force[j]
            for r in range(sums.shape[1]):
                sums[sampled, r], rates[sampled, r] = _sum(rows, r, state_z), _sum(rows, r, state_v)
            sampled += 1
        while window < ends.size and step >= ends[window]:
            window += 1
        if window < ends.size:
            for j in range(m):
                crests[window, j, 0] = max(crests[window, j, 0], spring[j])
                crests[window, j, 1] = min(crests[window, j, 1], spring[j])
                crests[window, j, 2] = max(crests[window, j, 2], force[j])
                parted[window, j] += spring[j] == 0.0
            for r in range(reach.shape[1]):
                total = _sum(rows, r, state_z)
                reach[window, r, 0], reach[window, r, 1] = max(reach[window, r, 0], total), min(reach[window, r, 1], total)
    return count
