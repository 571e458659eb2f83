"""The damped oscillator under a constant force, in closed form: what the motion of a pair is between two events.

Compiled by numba: import this room inside functions only. SI units.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numba

__all__ = ["Spring", "accelerated", "advanced", "compiled", "next_turn", "transition", "zero"]

Function = TypeVar("Function", bound=Callable[..., Any])

_ITERATIONS = 200
"""Newton's steps, or halvings: a double has room for far fewer."""


def compiled(function: Function) -> Function:
    """Machine code, kept on disk; it lets other threads run, and rounds as written."""
    made: Function = numba.njit(nogil=True, cache=True, error_model="numpy")(function)
    return made


class Spring(NamedTuple):
    """y'' + 2 half y' + square (y - rest) = push: 1/s², 1/s, m/s², m. Where square is 0, rest is 0; elsewhere push is."""

    square: float
    half: float
    push: float
    rest: float


@compiled
def transition(spring: Spring, tau: float) -> tuple[float, float, float, float, float, float]:
    """(xx, xv, vx, vv, fx, fv): over a time tau, x = y - rest becomes xx x + xv v + fx, and v becomes vx x + vv v + fv."""
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
def advanced(spring: Spring, y: float, v: float, tau: float) -> tuple[float, float]:
    """y and v after a time tau."""
    xx, xv, vx, vv, fx, fv = transition(spring, tau)
    x = y - spring.rest
    return spring.rest + (xx * x + xv * v + fx), vx * x + vv * v + fv


@compiled
def accelerated(spring: Spring, y: float, v: float) -> float:
    """y''."""
    return spring.push - spring.square * (y - spring.rest) - 2.0 * spring.half * v


@compiled
def next_turn(spring: Spring, y: float, v: float) -> tuple[float, float]:
    """Time of the first zero of the acceleration, and from each to the next; infinite where there is none."""
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
def zero(spring: Spring, y: float, v: float, drift: float, share: float, level: float, a: float, b: float, order: int) -> float:
    """Where q(t) = drift t + share (y(t) - y) reaches `level` (order 0), or turns (order 1), in [a, b], to rounding.

    One such time is in there: Newton's steps, and halvings where these leave the bracket or gain too little.
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
