"""Duty: the loads of a pair over its life, and the stresses under each of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats
from gearcad.load import Load
from gearcad.per_gear import PerGear, Role
from gearcad.rating.both import both
from gearcad.rating.duty_options import LoadBin
from gearcad.rating.load_factors import LoadFactors
from gearcad.rating.options import RatingOptions
from gearcad.rating.rate import Rating
from gearcad.rating.strength.part import Part

__all__ = ["Duty", "LoadCase", "stresses_of"]

_MINUTES = 60


@dataclass(frozen=True, kw_only=True)
class LoadCase:
    """A load, the part of all load cycles that it has, and its load factors and stresses (MPa)."""

    load: Load
    life_share: float
    cycle_share: float
    factors: LoadFactors
    stresses: dict[Part, PerGear[float]]


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
        """Those of `cycles` that carry."""
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
        """The loads with all torques times `scale`; bins without torque are left out."""
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

    def stresses(self, part: Part, role: Role, scale: float = 1.0) -> tuple[Floats, Floats]:
        """Shares of the load cycles (n,), and the stress of each (n,) in MPa, of one part."""
        cases = self.cases(scale)
        return np.array([case.cycle_share for case in cases]), np.array([case.stresses[part].pick(role) for case in cases])


def stresses_of(nominal: Rating, factors: LoadFactors, share: float = 1.0) -> dict[Part, PerGear[float]]:
    """sigma_H and sigma_F (MPa) of both gears with all load factors, at a share of the torque of the nominal rating."""
    common = factors.application * factors.mesh_load * factors.dynamic * share
    flank = math.sqrt(common * factors.face_flank * factors.transverse_flank) * nominal.flank.nominal_stress
    root = common * factors.face_root * factors.transverse_root
    return {
        Part.FLANK: nominal.flank.contact_factors.map(lambda factor: factor * flank),
        Part.ROOT: nominal.roots.map(lambda each: each.nominal_stress * root),
    }
