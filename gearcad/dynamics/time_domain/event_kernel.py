"""Kernel of the contact model: a pair whose teeth come, go and part, integrated from event to event in closed form.

The approach y of the flanks obeys m y'' + b y' + f = F, f = k N y where the front flanks press (y > 0), f = k N (y + j) where
the back flanks do (y < -j). The pinion's travel along the line of action is u = V t + share y: a uniform rotation and y's
share. A pair of teeth enters or leaves the zone of contact where u, or u - y, passes a fixed place, and again each base pitch.

Compiled by numba: import this module inside functions only. All of it is in one file, because numba looks only at the file of a
function to see whether the code that it keeps on disk is still good, not at those of the functions it calls. SI units.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Floats
from gearcad.core.runtime import compiled

_ANCHORED = 64
"""Samples taken by one step matrix in a row before the closed form is evaluated again, so that rounding does not add up."""

_RESOLVED = 1e-10
"""Excursion, in base pitches, below which a pair of teeth that keeps entering and leaving stands on the end of the zone."""

_LASTING = 500.0
"""Time without events, in times of decay, that is looked at in one go: longer, and a disturbance would vanish altogether."""

_ITERATIONS = 200
"""Newton's steps, or halvings: a double has room for far fewer."""


class Oscillator(NamedTuple):
    """y'' + 2 half y' + square (y - rest) = push: 1/s², 1/s, m/s², m. Where square is 0, rest is 0; elsewhere push is."""

    square: float
    half: float
    push: float
    rest: float


class Zone(NamedTuple):
    """Places of tooth 0 (m) at the two ends of the zone of contact, and the share of y in its travel to each."""

    first: float
    last: float
    first_share: float
    last_share: float


class PairMotion(NamedTuple):
    """One pair: k/m and b/(2 m) and F/m of its reduced mass m, base pitch, share of y in u, backlash (may be infinite)."""

    pair_square: float
    half: float
    push: float
    pitch: float
    backlash: float
    front: Zone
    back: Zone


class MotionOutcome(NamedTuple):
    """Results of one run besides its samples."""

    free: float
    """Time without contact in the counted part (s)."""
    growth: float
    """Mean logarithmic growth of a small disturbance in the counted part, the Lyapunov exponent (1/s)."""
    gain: float
    """Logarithm of the most that a disturbance grows between any two times of the whole run."""
    events: int
    held: float
    """Time for which a pair stood on an end of the zone (s)."""


@compiled
def _transition(spring: Oscillator, tau: float) -> tuple[float, float, float, float, float, float]:
    """Return (xx, xv, vx, vv, fx, fv) of a time tau for x = y - rest.

    Over that time x becomes xx x + xv v + fx, and v becomes vx x + vv v + fv.
    """
    square, half = spring.square, spring.half
    if square == 0.0:
        a = 2.0 * half * tau
        if a < 0.1:
            second = 0.0  # (a - 1 + exp(-a))/a² by its series: the difference would cancel
            for order in range(11, 1, -1):
                second = (1.0 - a * second) / order
            first = 1.0 - a * second
        else:
            first = -math.expm1(-a) / a
            second = (1.0 - first) / a
        return 1.0, tau * first, 0.0, 1.0 - a * first, tau * tau * second * spring.push, tau * first * spring.push
    if square > half * half:
        turns = math.sqrt(square - half * half)
        decay = math.exp(-half * tau)
        even, odd = decay * math.cos(turns * tau), decay * math.sin(turns * tau) / turns
    elif square < half * half:
        rate = math.sqrt(half * half - square)
        slow, fast = math.exp(-square / (half + rate) * tau), math.exp(-(half + rate) * tau)
        even, odd = 0.5 * (slow + fast), 0.5 * (slow - fast) / rate
    else:
        decay = math.exp(-half * tau)
        even, odd = decay, decay * tau
    return even + half * odd, odd, -square * odd, even - half * odd, 0.0, 0.0


@compiled
def advanced(spring: Oscillator, y: float, v: float, tau: float) -> tuple[float, float]:
    """Return y and v after a time tau."""
    xx, xv, vx, vv, fx, fv = _transition(spring, tau)
    x = y - spring.rest
    return spring.rest + (xx * x + xv * v + fx), vx * x + vv * v + fv


@compiled
def accelerated(spring: Oscillator, y: float, v: float) -> float:
    """Return the acceleration y'' where y is the approach and v its rate."""
    return spring.push - spring.square * (y - spring.rest) - 2.0 * spring.half * v


@compiled
def next_turn(spring: Oscillator, y: float, v: float) -> tuple[float, float]:
    """Return the time of the first zero of the acceleration, and from each to the next; infinite where there is none."""
    a = accelerated(spring, y, v)
    slope = -spring.square * v - spring.half * a  # of exp(half t) a(t)
    if spring.square > spring.half * spring.half:
        turns = math.sqrt(spring.square - spring.half * spring.half)
        angle = math.atan2(slope / turns, a) + 0.5 * math.pi
        if angle > math.pi:
            angle -= math.pi
        elif angle <= 0.0:
            angle += math.pi
        return angle / turns, math.pi / turns
    if spring.square == 0.0 or a * slope >= 0.0:
        return math.inf, math.inf
    rate = math.sqrt(spring.half * spring.half - spring.square)
    if rate == 0.0:
        return -a / slope, math.inf
    part = -a * rate / slope
    return (math.atanh(part) / rate, math.inf) if part < 1.0 else (math.inf, math.inf)


@compiled
def _zero(
    spring: Oscillator, y: float, v: float, drift: float, share: float, level: float, a: float, b: float, order: int
) -> float:
    """Return the time in [a, b] at which q(t) = drift t + share (y(t) - y) reaches `level` (order 0), or turns (order 1).

    The time is good to rounding. One such time is in [a, b]: Newton's steps, and halvings where these leave the bracket or gain
    too little.
    """
    end_y, end_v = advanced(spring, y, v, b)
    end = drift * b + share * (end_y - y) - level if order == 0 else drift + share * end_v
    x, before = 0.5 * (a + b), math.inf
    for _ in range(_ITERATIONS):
        at_y, at_v = advanced(spring, y, v, x)
        value, slope = drift * x + share * (at_y - y) - level, drift + share * at_v
        if order == 1:
            value, slope = slope, share * accelerated(spring, at_y, at_v)
        if value == 0.0:
            return x
        if (value > 0.0) == (end > 0.0):
            b = x
        else:
            a = x
        following = x - value / slope if slope != 0.0 else a
        if not a < following < b or abs(value) > 0.5 * before:
            following = 0.5 * (a + b)
        if abs(following - x) <= 2.3e-16 * b or not a < following < b:
            return following
        before, x = abs(value), following
    return x


@compiled
def _spring(motion: PairMotion, side: int, pairs: int) -> Oscillator:
    """Return the spring that acts on y while so many pairs touch on this side: 1 front, -1 back, 0 neither."""
    if side == 0 or pairs <= 0:
        return Oscillator(0.0, motion.half, motion.push, 0.0)
    square = pairs * motion.pair_square
    rest = motion.push / square - (motion.backlash if side < 0 else 0.0)
    return Oscillator(square, motion.half, 0.0, rest)


@compiled
def _passed(motion: PairMotion, zone: Zone, travel: float, y: float) -> tuple[int, int]:
    """Return the whole pitches by which tooth 0 is past each end of the zone; their difference is the number of pairs in it."""
    first = math.floor((travel + zone.first_share * y - zone.first) / motion.pitch)
    last = math.floor((travel + zone.last_share * y - zone.last) / motion.pitch)
    return int(first), int(last)


@compiled
def _watch(table: Floats, motion: PairMotion, side: int, first: int, last: int, drift: float, travel: float, y: float) -> None:
    """Fill in the rows of the table: drift and share of each watched quantity, and its next level above and below.

    Row 0 is y itself, which parts or closes the flanks; 1 and 2 are the ends of the zone, at which the number of pairs changes.
    """
    table[0, 0], table[0, 1], table[0, 2], table[0, 3] = 0.0, 1.0, np.inf, -np.inf
    table[1:, 0], table[1:, 1], table[1:, 2], table[1:, 3] = drift, 0.0, np.inf, -np.inf
    if side == 1:
        table[0, 3] = -y
    elif side == -1:
        table[0, 2] = -motion.backlash - y
    else:
        table[0, 2], table[0, 3] = -y, -motion.backlash - y
        return
    zone = motion.front if side == 1 else motion.back
    at = travel + zone.first_share * y
    table[1, 1] = zone.first_share
    table[1, 2] = zone.first + (first + 1) * motion.pitch - at
    table[1, 3] = zone.first + first * motion.pitch - at
    at = travel + zone.last_share * y
    table[2, 1] = zone.last_share
    table[2, 2] = zone.last + (last + 1) * motion.pitch - at
    table[2, 3] = zone.last + last * motion.pitch - at


@compiled
def _crossing(
    row: Floats, spring: Oscillator, y: float, v: float, piece: tuple[float, float, float, float, float, float]
) -> tuple[float, bool]:
    """Return the first time in a piece at which one row of the table passes a level, and whether it rises there.

    The time is infinite if the row passes none. A piece (a, y, v there, b, y, v there) lies between zeros of the acceleration:
    what is watched turns once in it, or never. So it is cut in at most two monotone parts, of which each can pass only the
    level it moves to.
    """
    a, _, va, b, yb, vb = piece
    drift, share, above, below = row[0], row[1], row[2], row[3]
    start, end = drift + share * va, drift + share * vb
    rising = start + end > 0.0
    if start * end < 0.0:
        rising = end > 0.0
        middle = _zero(spring, y, v, drift, share, 0.0, a, b, 1)
        ym, _ = advanced(spring, y, v, middle)
        reached = drift * middle + share * (ym - y)
        if (not rising and reached > above) or (rising and reached < below):
            return _zero(spring, y, v, drift, share, below if rising else above, a, middle, 0), not rising
        a = middle
    reached = drift * b + share * (yb - y)
    if (rising and reached > above) or (not rising and reached < below):
        return _zero(spring, y, v, drift, share, above if rising else below, a, b, 0), rising
    return np.inf, rising


@compiled
def _next_event(table: Floats, spring: Oscillator, y: float, v: float, horizon: float) -> tuple[float, int, bool]:
    """Return the time to the first event, its row in the table, and whether that rises; the horizon and -1 if there is none."""
    turn, step = next_turn(spring, y, v)
    a, ya, va = 0.0, y, v
    while True:
        b = min(turn, horizon)
        yb, vb = advanced(spring, y, v, b)
        found, row, upwards = np.inf, -1, False
        for each in range(3):
            time, rising = _crossing(table[each], spring, y, v, (a, ya, va, b, yb, vb))
            if time < found:
                found, row, upwards = time, each, rising
        if row >= 0:
            return found, row, upwards
        if b >= horizon:
            return horizon, -1, False
        a, ya, va, turn = b, yb, vb, turn + step


@compiled
def _sample(
    approach: Floats, rate: Floats, number: int, step: float, spring: Oscillator, y: float, v: float, t: float, end: float
) -> int:
    """Fill in the samples before `end` of a motion that is y, v at t, from `number` on; return the first that is left."""
    xx, xv, vx, vv, fx, fv = _transition(spring, step)
    taken = 0
    at_y, at_v = y, v
    while number < approach.size and number * step < end:
        if taken % _ANCHORED == 0:
            at_y, at_v = advanced(spring, y, v, number * step - t)
        else:
            x = at_y - spring.rest
            at_y, at_v = spring.rest + (xx * x + xv * at_v + fx), vx * x + vv * at_v + fv
        approach[number], rate[number] = at_y, at_v
        taken += 1
        number += 1
    return number


@compiled
def _changed(
    motion: PairMotion, side: int, first: int, last: int, row: int, rising: bool, travel: float
) -> tuple[int, int, int]:
    """Return the side and the passed pitches behind an event of that row."""
    if row == 1:
        return side, first + (1 if rising else -1), last
    if row == 2:
        return side, first, last + (1 if rising else -1)
    if side != 0:
        return 0, first, last
    y = 0.0 if rising else -motion.backlash
    first, last = _passed(motion, motion.front if rising else motion.back, travel, y)
    return (1 if rising else -1), first, last


@compiled
def _stands(row: Floats, before: Oscillator, after: Oscillator, y: float, v: float, pitch: float) -> bool:
    """Return whether both accelerations press what is watched against its level, so nearly at rest that it cannot leave it."""
    speed = row[0] + row[1] * v
    back = row[1] * accelerated(after, y, v)
    towards = row[1] * accelerated(before, y, v)
    return bool(back * towards < 0.0 and back * speed <= 0.0 and speed * speed < 2.0 * _RESOLVED * pitch * abs(back))


@compiled
def _disturbed(before: Oscillator, after: Oscillator, row: Floats, y: float, v: float, dy: float, dv: float) -> float:
    """Return dv behind an event: a disturbed motion passes it earlier or later, and is so long under the other acceleration."""
    speed: float = row[0] + row[1] * v
    share: float = row[1]
    if speed == 0.0:
        return dv
    return dv - (accelerated(before, y, v) - accelerated(after, y, v)) * share * dy / speed


@compiled
def run(
    motion: PairMotion,
    drift: float,
    start: tuple[float, float, float],
    step: float,
    counted: float,
    approach: Floats,
    rate: Floats,
) -> MotionOutcome:
    """Fill in samples of y (m) and y' (m/s) every `step` seconds, and return the outcome of the run.

    The run begins at the start (u - share y, y, y'), with V = `drift` in m/s. Time without contact and the growth of a
    disturbance (dy, dv) are counted from `counted` seconds to the end.
    """
    travel, y, v = start
    t, end, number, events = 0.0, step * approach.size, 0, 0
    side = 1 if y > 0.0 or (y == 0.0 and v >= 0.0) else (-1 if y < -motion.backlash else 0)
    first, last = _passed(motion, motion.back if side < 0 else motion.front, travel, y)
    table, scale = np.empty((3, 4)), math.sqrt(motion.pair_square)
    dy, dv, free, held = 1.0 / scale, 0.0, 0.0, 0.0
    total, least, gain, counted_from = 0.0, 0.0, 0.0, 0.0
    while t < end:
        spring, began = _spring(motion, side, first - last), t
        _watch(table, motion, side, first, last, drift, travel + drift * t, y)
        horizon = min((counted if t < counted else end) - t, _LASTING / motion.half)
        tau, row, rising = _next_event(table, spring, y, v, horizon)
        number = _sample(approach, rate, number, step, spring, y, v, t, t + tau)
        xx, xv, vx, vv, _, _ = _transition(spring, tau)
        dy, dv = xx * dy + xv * dv, vx * dy + vv * dv
        y, v = advanced(spring, y, v, tau)
        t += tau
        free += tau if side == 0 and began >= counted else 0.0
        if row >= 0:
            events += 1
            side, first, last = _changed(motion, side, first, last, row, rising, travel + drift * t)
            after = _spring(motion, side, first - last)
            if not (row > 0 and _stands(table[row], spring, after, y, v, motion.pitch)):
                dv = _disturbed(spring, after, table[row], y, v, dy, dv)
            else:
                # It leaves when the force between its two values no longer suffices: looked at again after one sample.
                # Whatever was disturbed ends in the same place: a disturbance begins anew.
                v, pause = -drift / table[row, 1], min(step, end - t)
                number = _sample(approach, rate, number, step, Oscillator(0.0, 0.0, 0.0, 0.0), y, v, t, t + pause)
                y, t, held = y + v * pause, t + pause, held + pause
                least = math.inf
        size = math.hypot(scale * dy, dv)
        total, dy, dv = total + math.log(size), dy / size, dv / size
        least, gain = min(least, total), max(gain, total - least)
        counted_from = total if began < counted else counted_from
    return MotionOutcome(free, (total - counted_from) / (end - counted), gain, events, held)
