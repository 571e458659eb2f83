"""Friction of flanks that slide on each other: its sense, levers of sliding, and Ohlendorf's loss factor.

A pair of flanks slides with v_g = omega_1 (1 + 1/u) |g|, g the distance from the pitch point along the line of action. The
friction on both gears points to their tips while contact is on the addendum of the gear that drives, and to their roots
before the pitch point. A normal force N on a flank with the roll length rho so has the moment N (r_b + f rho), f the
coefficient of friction with that sign.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from gearcad.core.records import Floats, Role
from gearcad.core.values import Numbers, chosen, cos, radians, smaller
from gearcad.geometry.pair import GearPair
from gearcad.geometry.pair_data import PairSizes


@dataclass(frozen=True, kw_only=True)
class MeshFriction:
    """Friction of a mesh: a coefficient `reference` under the transverse force `reference_force` (N per mm of width).

    It goes with the `exponent` of the force, which counts from `least_force` on; 0 is a constant coefficient. `driver` is the
    gear that drives, `law` the name of a law.
    """

    reference: float
    driver: Role = Role.PINION
    law: str = "constant"
    exponent: float = 0.0
    reference_force: float = 1.0
    least_force: float = 0.0

    def coefficient(self, force: float) -> float:
        """Return the mean coefficient of friction under a transverse force (N per mm of width)."""
        if not self.exponent:
            return self.reference
        counted, known = (max(each, self.least_force) for each in (force, self.reference_force))
        return float(self.reference * (counted / known) ** self.exponent)

    def signed(self, pair: GearPair, places: Floats | float, force: float) -> Floats:
        """Return the coefficients (n,) at places (mm from T1): positive where friction points to the tips of both gears."""
        way = 1.0 if self.driver is Role.PINION else -1.0
        result: Floats = way * self.coefficient(force) * np.sign(np.asarray(places) - pair.path_of_contact.C)
        return result


def sliding_levers(pair: GearPair, places: Floats | float) -> Floats:
    """Return the sliding velocity over the angular speed of the pinion (mm) at places (n,) in mm from T1."""
    result: Floats = np.abs((1 + 1 / pair.gear_ratio) * (np.asarray(places) - pair.path_of_contact.C))
    return result


def ohlendorf_loss_factor(pair: GearPair) -> float | None:
    """Return Ohlendorf's loss factor H_V of a pair; None where it does not hold."""
    factor = float(loss_factors(pair))
    return None if math.isnan(factor) else factor


def loss_factors(pair: PairSizes[Any]) -> Numbers:
    """Return H_V = pi (u + 1)/(z_1 u cos beta_b) (1 - eps_alpha + eps_1^2 + eps_2^2) of a pair or of many; nan where it does
    not hold.

    H. Ohlendorf, Munich 1958: one pair of teeth carries all of the load, two carry half each. The pitch point must lie in
    the path of contact, and the contact ratio between 1 and 2.
    """
    path, pinion, ratio = pair.path_of_contact, pair.gears.pinion, pair.gear_ratio
    first, second = ((end / pinion.transverse_base_pitch) for end in (path.E - path.C, path.C - path.A))
    known = (first + second >= 1) & (first + second <= 2) & (smaller(first, second) >= 0)
    sliding = math.pi * (ratio + 1) / (pinion.teeth * ratio * cos(radians(pinion.base_helix_angle)))
    factors: Numbers = chosen(known, sliding * (1 - (first + second) + first**2 + second**2), math.nan)
    return factors
