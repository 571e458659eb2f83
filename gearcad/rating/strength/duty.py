"""Duty of a pair: the loads over its life, the stresses under each, and how safely a flank or root bears them (ISO 6336-6).

A curve has the corners (load cycles, permissible stress in MPa) of straight lines in log-log, cycles rising: a life factor's
points times what a flank or root bears. Bins are arrays (n,): load cycles in all, and the stress of each with its own load
factors, K_A = 1. Stress goes with the square root of torque on flanks, and with torque at roots: `power` is 2 or 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property, partial
from typing import Any, Generic

import numpy as np

from gearcad.core.errors import require_number
from gearcad.core.records import Floats, PerGear, Role, Verdict
from gearcad.core.values import Values, interpolated_in_logs, number_or_array
from gearcad.geometry.involute import root_between
from gearcad.load import Load
from gearcad.rating.editions import both
from gearcad.rating.factors import Points, endurance_cycles, transition
from gearcad.rating.load_factors import LoadFactors
from gearcad.rating.nominal_rating import Rating
from gearcad.rating.options import LoadBin, RatingOptions


@dataclass(frozen=True, kw_only=True)
class Resistance(Generic[Values]):
    """`reference` (MPa) times factors under their symbols: of static strength, and of endurance; the life factor's `points`.

    The reference is sigma_Hlim, or sigma_Flim Y_ST. The factors go over from one to the other as `transition` has it.
    """

    reference: float
    life_symbol: str
    points: Points
    static: Mapping[str, Values]
    endurance: Mapping[str, Values]

    def factors(self, cycles: Values | None) -> dict[str, Values]:
        """Return all factors after a number of load cycles; None means the endurance limit, where the life factor is 1."""
        count: Values = endurance_cycles(self.points) if cycles is None else cycles
        others = {
            symbol: transition(count, self.static[symbol], value, self.points) for symbol, value in self.endurance.items()
        }
        return {self.life_symbol: interpolated_in_logs(count, self.points), **others}

    def stress(self, cycles: Values | None) -> Values:
        """Return the strength sigma_HG or sigma_FG (MPa) after so many load cycles."""
        return self.reference * math.prod(self.factors(cycles).values())

    @cached_property
    def curve(self: Resistance[float]) -> Points:
        """Corners of the S-N line, straight in log-log: load cycles, rising, and stress (MPa)."""
        return tuple((cycles, self.stress(cycles)) for cycles, _ in self.points)


INFINITE = "infinite"
"""Word in documents for an unlimited life."""


class RatedPart(Enum):
    """The part of a gear that is rated: flank or root."""

    FLANK = "flank"
    ROOT = "root"

    @property
    def index(self) -> str:
        """Index of the part in symbols: H as in sigma_H, F as in S_F."""
        return "H" if self is RatedPart.FLANK else "F"


@dataclass(frozen=True, kw_only=True)
class PartStrength:
    """Strength of one gear: stresses in MPa, torque in N·m on the pinion, life in hours; None for what is not known.

    `stress` is sigma_H or sigma_F under all load factors, `strength` sigma_HG or sigma_FG after the load `cycles` (None: the
    endurance limit), whose `factors` stand under their symbols. `damage` and `life` are those at the `required` safety; a life
    can be infinite. `beyond_knee` is the share of the damage of a spectrum, at the safety, that its loads below the last corner
    of the S-N line do. Without a `safety` it was not judged, for the `reason`. `find_torque` finds the permissible torque.
    """

    part: RatedPart
    required: float
    stress: float | None = None
    resistance: Resistance[float] | None = None
    cycles: float | None = None
    safety: float | None = None
    damage: float | None = None
    life: float | None = None
    beyond_knee: float = 0.0
    reason: str = ""
    find_torque: Callable[[], float | None] | None = field(default=None, repr=False, compare=False)

    @cached_property
    def factors(self) -> Mapping[str, float]:
        """Factors of the permissible stress under their symbols; empty if they are not known."""
        return {} if self.resistance is None else self.resistance.factors(self.cycles)

    @cached_property
    def permissible_torque(self) -> float | None:
        """Permissible torque (N·m) on the pinion at the required safety, with its own load factors; None if not known.

        The search runs at the first access.
        """
        return None if self.find_torque is None else self.find_torque()

    @property
    def strength(self) -> float | None:
        """Strength sigma_HG or sigma_FG (MPa)."""
        return None if self.resistance is None else self.resistance.reference * math.prod(self.factors.values())

    @property
    def permissible_stress(self) -> float | None:
        """Permissible stress sigma_HP or sigma_FP (MPa): the strength over the required safety."""
        return None if self.strength is None else self.strength / self.required

    @property
    def verdict(self) -> Verdict:
        """Whether the safety is as large as is required."""
        if self.safety is None:
            return Verdict.NOT_JUDGED
        return Verdict.PASSED if self.safety >= self.required else Verdict.FAILED

    def stresses(self) -> dict[str, float | None]:
        """Return the stresses (MPa) under their symbols."""
        of = self.part.index
        return {f"sigma_{of}": self.stress, f"sigma_{of}G": self.strength, f"sigma_{of}P": self.permissible_stress}


def told(value: float | None) -> Any:
    """Return a value as JSON can hold it: the value itself, or the word for infinity."""
    return INFINITE if value is not None and math.isinf(value) else value


_MINUTES = 60


@dataclass(frozen=True, kw_only=True)
class LoadCase:
    """A load, the part of all load cycles that it has, and its load factors and stresses (MPa)."""

    load: Load
    life_share: float
    cycle_share: float
    factors: LoadFactors
    stresses: dict[RatedPart, PerGear[float]]


@dataclass(frozen=True, kw_only=True)
class Duty:
    """The `load` over the life as `bins` of shares have it; `factors` finds the load factors of a load.

    `nominal` is the rating of the load's torque without load factors; `whole_torque` (N·m) is that of the pair, of which a
    double helical pair's half has half.
    """

    nominal: Rating
    load: Load
    options: RatingOptions
    gear_ratio: float
    whole_torque: float
    factors: Callable[[Load], LoadFactors]

    @property
    def bins(self) -> tuple[LoadBin, ...]:
        """The load spectrum; without one, a single load."""
        return self.options.bins or (LoadBin(1.0, 1.0),)

    @property
    def steady(self) -> bool:
        """Whether there is one load level: the parts of the life that carry have one torque at one speed."""
        return len({(each.torque, each.speed) for each in self.bins if each.torque}) == 1

    @cached_property
    def governing(self) -> LoadCase:
        """The load with the greatest torque, the first of equals: stresses and load factors that are told are of it."""
        return max(self.cases(), key=lambda case: abs(case.load.torque))

    @cached_property
    def loaded_cycles(self) -> PerGear[float] | PerGear[None]:
        """Load cycles of both gears that carry torque, out of `cycles`; None if cycles are not known."""
        return self.cycles.map(lambda cycles: None if cycles is None else cycles * self._loaded)

    @cached_property
    def _loaded(self) -> float:
        """Share of the turns under torque."""
        return math.fsum(each.life * each.speed for each in self.bins if each.torque) / self._turns

    @cached_property
    def _turns(self) -> float:
        """Mean share of the speed over the life."""
        return math.fsum(each.life * each.speed for each in self.bins)

    @cached_property
    def cycles_per_hour(self) -> PerGear[float]:
        """Load cycles of a tooth of each gear in an hour of operation, on the mean; 0 at rest and of a rack."""
        turns = _MINUTES * abs(self.load.speed) * self._turns
        contacts = both(self.options.contacts_per_turn)
        return PerGear(turns * contacts.pinion, turns / abs(self.gear_ratio) * contacts.wheel)

    @cached_property
    def cycles(self) -> PerGear[float] | PerGear[None]:
        """Load cycles of a tooth of each gear over the life; None where neither life nor cycles are given."""
        if self.options.load_cycles is not None:
            return both(self.options.load_cycles)
        if self.options.life is None or not self.load.speed:
            return PerGear(None, None)
        hours = self.options.life
        return self.cycles_per_hour.map(lambda rate: rate * hours)

    def cases(self, scale: float = 1.0) -> tuple[LoadCase, ...]:
        """Return the loads with all torques times `scale`; bins without torque are left out."""
        found = self._found.get(scale)
        if found is None:
            found = self._found[scale] = tuple(self._case(each, scale) for each in self.bins if each.torque)
        return found

    @cached_property
    def _found(self) -> dict[float, tuple[LoadCase, ...]]:
        return {}

    def _case(self, of: LoadBin, scale: float) -> LoadCase:
        load = replace(self.load, torque=self.load.torque * of.torque * scale, speed=self.load.speed * of.speed)
        factors = self.factors(load)
        return LoadCase(
            load=load,
            life_share=of.life,
            cycle_share=of.life * of.speed / self._turns,
            factors=factors,
            stresses=stresses_of(self.nominal, factors, of.torque * scale),
        )

    def stresses(self, part: RatedPart, role: Role, scale: float = 1.0) -> tuple[Floats, Floats]:
        """Return the shares of the load cycles (n,), and the stress of each (n,) in MPa, of one part."""
        cases = self.cases(scale)
        return np.array([case.cycle_share for case in cases]), np.array([case.stresses[part].pick(role) for case in cases])


def stresses_of(nominal: Rating, factors: LoadFactors, share: float = 1.0) -> dict[RatedPart, PerGear[float]]:
    """sigma_H and sigma_F (MPa) of both gears with all load factors, at a share of the torque of the nominal rating."""
    common = factors.application * factors.mesh_load * factors.dynamic * share
    flank = math.sqrt(common * factors.face_flank * factors.transverse_flank) * nominal.flank.nominal_stress
    root = common * factors.face_root * factors.transverse_root
    return {
        RatedPart.FLANK: nominal.flank.contact_factors.map(lambda factor: factor * flank),
        RatedPart.ROOT: nominal.roots.map(lambda each: each.nominal_stress * root),
    }


FLANK_POWER = 2.0
ROOT_POWER = 1.0
"""Exponents of the flank and the root stress to which the torque is proportional."""

_ROUNDING = 1e-12
"""Relative excess over the static strength that still counts as rounding."""

_MOST_LOGARITHM = 700.0
"""Largest logarithm of a number of load cycles: that of 10^304, which a float can still hold."""

_HALVINGS = 60
"""Steps of a search in logarithms: from a factor of 2 to less than rounding."""

_DOUBLINGS = 40
"""Number of times that the range in which a torque is searched may double: up to a factor of 10^12."""


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
    """Return the life at which the damage is 1, by the damage of a life, in its unit (h or cycles); infinite without damage."""
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
    """Return the torque at which a safety is the required one, where load factors do not depend on it: T (S/S_min)^power."""
    return torque * math.pow(safety / required, power)


def torque_at_safety(safety_of: Callable[[float], float], required: float, torque: float) -> float:
    """Return the greatest torque whose safety is at least the required one, where load factors depend on it.

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
    """Return the torque of `torque_at_safety` by a search between `low`, which holds, and `high`, which does not."""

    def excess(logarithm: float) -> float:
        ratio = safety_of(math.exp(logarithm)) / required
        return math.log(min(max(ratio, 1e-30), 1e30))

    if excess(math.log(low)) == 0:
        return low
    return math.exp(root_between(excess, math.log(low), math.log(high), xtol=1e-13, rtol=1e-13))


def _falling(curve: Points) -> list[tuple[float, float]]:
    """Return the corners of the life curve so that none is above an earlier one: a stress that breaks a part in one load cycle
    also does in more.
    """
    least = math.inf
    corners = []
    for cycles, stress in curve:
        least = min(least, stress)
        corners.append((cycles, least))
    return corners


def judged(part: RatedPart, role: Role, duty: Duty, resistance: Resistance[float], required: float) -> PartStrength:
    """Return the strength of a part under its duty.

    The safety under a spectrum is the factor on the stresses at which the damage is 1 (ISO 6336-6).
    """
    cycles, rate = duty.cycles.pick(role), duty.cycles_per_hour.pick(role)
    shares, stresses = duty.stresses(part, role)
    # A single load is held against the life factor, which stays after the last corner; Miner's line goes on.
    per_cycle = damage_sum(shares, stresses, resistance.curve, safety=required, endurance=duty.steady)
    safety = _safety(part, role, duty, resistance, 1.0)
    return PartStrength(
        part=part,
        required=required,
        stress=duty.governing.stresses[part].pick(role),
        resistance=resistance,
        cycles=duty.loaded_cycles.pick(role),
        safety=safety,
        beyond_knee=0.0 if duty.steady or cycles is None else _beyond_knee(cycles * shares, safety * stresses, resistance),
        damage=None if cycles is None else cycles * per_cycle,
        life=life_at_failure(1.0, rate * per_cycle) if rate else None,
        find_torque=partial(_permissible_torque, part, role, duty, resistance, required),
    )


def _safety(part: RatedPart, role: Role, duty: Duty, resistance: Resistance[float], scale: float) -> float:
    """Return the safety of a part with all torques times `scale`."""
    cycles = duty.cycles.pick(role)
    shares, stresses = duty.stresses(part, role, scale)
    if duty.steady or cycles is None:
        return resistance.stress(duty.loaded_cycles.pick(role)) / float(stresses.max())
    return safety_at_failure(cycles * shares, stresses, resistance.curve)


def _beyond_knee(cycles: Floats, stresses: Floats, resistance: Resistance[float]) -> float:
    """Return the share of the damage that is due to stresses (MPa) below the last corner of the life curve."""
    whole, above = (damage_sum(cycles, stresses, resistance.curve, endurance=end) for end in (False, True))
    return 1 - above / whole if 0 < whole < math.inf else 0.0


def _permissible_torque(
    part: RatedPart, role: Role, duty: Duty, resistance: Resistance[float], required: float
) -> float | None:
    """Return the permissible torque (N·m), or None if it is beyond the range of the search."""
    scale = torque_at_safety(partial(_safety, part, role, duty, resistance), required, 1.0)
    return scale * abs(duty.whole_torque) if math.isfinite(scale) else None
