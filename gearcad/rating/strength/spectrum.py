"""Load spectra by ISO 6336-6:2006: damage by Miner's rule, the safety and the life at which it is 1, equivalent torque.

A curve has the corners (load cycles, permissible stress in MPa) of straight lines in log-log, cycles rising: a life factor's
points times what a flank or root bears. Bins are arrays (n,): load cycles in all, and the stress of each with its own load
factors, K_A = 1. Stress goes with the square root of torque on flanks, and with torque at roots: `power` is 2 or 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import require_number
from gearcad.geometry.bracketed import root_between
from gearcad.rating.factors import Points
from gearcad.rating.factors.elementwise import Values, number_or_array

__all__ = [
    "FLANK_POWER",
    "ROOT_POWER",
    "damage_sum",
    "equivalent_torque",
    "life_at_failure",
    "permissible_cycles",
    "permissible_torque",
    "safety_at_failure",
    "torque_at_safety",
    "torque_exponent",
]

FLANK_POWER = 2.0
ROOT_POWER = 1.0
"""Torque goes with this power of the stress."""

_ROUNDING = 1e-12
"""Over the static strength by no more than that, relative, is not over it."""

_MOST_LOGARITHM = 700.0
"""Of load cycles: that of 10^304, in place of numbers beyond any float."""

_HALVINGS = 60
"""Steps of a search in logarithms: from a factor of 2 to less than rounding."""

_DOUBLINGS = 40
"""How far from where it begins a torque is looked for: by a factor of 10^12."""


def permissible_cycles(stress: Values, curve: Points, *, endurance: bool = False) -> Values:
    """N_i: the load cycles for which a stress (MPa) can be borne.

    Above the static strength the line of limited life goes on (ISO 6336-6, annex C), so there is no jump: the first line that
    falls. Below the last corner the last line goes on or, with `endurance`, no number of cycles does damage; nor does it below
    a last line that is level. A corner that stands above an earlier one counts as low as that.
    """
    x, y = np.log(_falling(curve)).T
    place = np.log(np.maximum(stress, np.exp(y[-1]) * 1e-9))
    found = np.interp(place, y[::-1], x[::-1])
    if y[-1] == y[-2]:
        found = np.where(place <= y[-1], math.inf, found)
    elif endurance:
        found = np.where(place < y[-1], math.inf, found)
    else:
        beyond = x[-1] + (x[-1] - x[-2]) / (y[-1] - y[-2]) * (place - y[-1])
        found = np.where(place < y[-1], np.minimum(beyond, _MOST_LOGARITHM), found)
    falls = np.flatnonzero(np.diff(y) < 0)
    slope = (x[falls[0] + 1] - x[falls[0]]) / (y[falls[0] + 1] - y[falls[0]]) if len(falls) else -math.inf
    above = place > y[0] + _ROUNDING
    over = x[falls[0] if len(falls) else 0] + slope * np.where(above, place - y[0], 1.0)
    return number_or_array(stress, np.exp(np.where(above, over, found)))


def damage_sum(cycles: Floats, stresses: Floats, curve: Points, *, safety: float = 1.0, endurance: bool = False) -> float:
    """D = sum n_i/N_i, with stresses (MPa) times a safety."""
    runs = cycles > 0
    permitted = permissible_cycles(safety * stresses[runs], curve, endurance=endurance)
    with np.errstate(divide="ignore"):  # a level curve bears no cycle above it
        return float(np.sum(cycles[runs] / permitted))


def safety_at_failure(cycles: Floats, stresses: Floats, curve: Points, *, endurance: bool = False) -> float:
    """S: the greatest number by which all stresses (MPa) could be multiplied with a damage of no more than 1, and with none of
    them above the static strength.

    Infinite for no load. Raises ParameterError for a stress that is no finite number.
    """
    greatest = float(np.max(stresses, initial=0.0, where=cycles > 0))
    require_number("stress", greatest, "MPa", at_least=0)
    if greatest == 0:
        return math.inf

    def holds(safety: float) -> bool:
        return damage_sum(cycles, stresses, curve, safety=safety, endurance=endurance) <= 1

    safe = curve[0][1] / greatest
    if holds(safe):
        return safe
    broken = safe
    while not holds(safe):
        broken, safe = safe, safe / 2
    for _ in range(_HALVINGS):
        middle = math.sqrt(safe * broken)
        safe, broken = (middle, broken) if holds(middle) else (safe, middle)
    return safe


def life_at_failure(life: float, damage: float) -> float:
    """The life at which the damage is 1, by the damage of a life, in its unit (h or cycles); infinite without damage."""
    return math.inf if damage == 0 else life / damage


def torque_exponent(points: Points, power: float) -> float:
    """p = ln(N_2/N_1)/ln(sigma_1/sigma_2)/power of the first line, that of limited life (ISO 6336-6, annex A)."""
    (first, static), (last, low), *_ = points
    return math.log(last / first) / math.log(static / low) / power


def equivalent_torque(cycles: Floats, torques: Floats, exponent: float) -> float:
    """T_eq = (sum n_i T_i^p/sum n_i)^(1/p): the steady torque that does the same damage in limited life (6336-6, annex A)."""
    greatest = float(np.max(torques, initial=0.0, where=cycles > 0))
    if greatest == 0:
        return 0.0
    # Relative to the greatest: high exponents of large torques would leave the range of floats.
    mean = float(np.sum(cycles * (torques / greatest) ** exponent) / np.sum(cycles))
    return greatest * math.pow(mean, 1 / exponent)


def permissible_torque(torque: float, safety: float, required: float, power: float) -> float:
    """The torque at which a safety is the required one, where load factors do not depend on it: T (S/S_min)^power."""
    return torque * math.pow(safety / required, power)


def torque_at_safety(safety_of: Callable[[float], float], required: float, torque: float) -> float:
    """The greatest torque whose safety is at least the required one, where load factors depend on it.

    `safety_of` a torque falls with it; the search begins at `torque`. Infinite if 10^12 times that is not enough, 0 where the
    safety is too low at 10^-12 of it: then vibration and deviations alone are too much.
    """
    factor = 2.0 if safety_of(torque) >= required else 0.5
    for _ in range(_DOUBLINGS):
        following = torque * factor
        if (safety_of(following) >= required) == (factor < 1):
            break
        torque = following
    else:
        return math.inf if factor > 1 else 0.0
    low, high = sorted((torque, following))
    return _between(safety_of, required, low, high)


def _between(safety_of: Callable[[float], float], required: float, low: float, high: float) -> float:
    """As `torque_at_safety`, of a torque `low` that holds and `high` that does not."""

    def excess(logarithm: float) -> float:
        ratio = safety_of(math.exp(logarithm)) / required
        return math.log(min(max(ratio, 1e-30), 1e30))

    if excess(math.log(low)) == 0:
        return low
    return math.exp(root_between(excess, math.log(low), math.log(high), xtol=1e-13, rtol=1e-13))


def _falling(curve: Points) -> list[tuple[float, float]]:
    """No corner above an earlier one: what breaks in one load cycle breaks in more."""
    least = math.inf
    corners = []
    for cycles, stress in curve:
        least = min(least, stress)
        corners.append((cycles, least))
    return corners
