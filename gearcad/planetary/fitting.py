"""Where the teeth of a set let planets stand, on plain numbers: signed teeth, angles in radians in one transverse plane.

A set meshes central a with rim 2 and central b with rim 2' of the same planet; rings have negative teeth.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

__all__ = ["Fit", "SetTeeth", "fit_planets", "meshing_angle", "permitted_steps"]

TURN = 2 * math.pi


class SetTeeth(NamedTuple):
    """z_a, z_2, z_2', z_b: those of central a, of its rim, of the rim of central b and of that; z_2 twice without a step."""

    a: int
    rim_a: int
    rim_b: int
    b: int

    @property
    def common(self) -> int:
        """g, the greatest common divisor of z_2 and z_2'."""
        return math.gcd(self.rim_a, self.rim_b)

    @property
    def positions(self) -> int:
        """q = |z_a z_2' - z_2 z_b|/g: planets fit at multiples of a full turn by q, and nowhere else; 0 if i_0 = 1."""
        return abs(self.a * self.rim_b - self.rim_a * self.b) // self.common


class Fit(NamedTuple):
    """How planets stand: rotations (rad) of central a and of both rims of each planet; how many pitches mesh a is off there."""

    central_a: float
    rims_a: tuple[float, ...]
    rims_b: tuple[float, ...]
    misfits: tuple[float, ...]

    def adjusted(self, teeth: SetTeeth) -> Fit:
        """The same with rim 2 of each planet turned against its rim 2' until it fits."""
        turned = (rim + misfit * TURN / teeth.rim_a for rim, misfit in zip(self.rims_a, self.misfits, strict=True))
        return self._replace(rims_a=tuple(turned), misfits=(0.0,) * len(self.misfits))


def meshing_angle(teeth: int, towards: float, mate_teeth: int, mate_rotation: float, mate_towards: float) -> float:
    """Rotation (rad) at which a gear has a tooth where its mate has a space, backlash split.

    `towards` and `mate_towards` are the directions from each gear's axis to where they mesh: opposite ones of external
    gears, equal ones of a ring and its pinion.
    """
    return towards + (mate_teeth * (mate_towards - mate_rotation) - math.pi) / teeth


def fit_planets(teeth: SetTeeth, angles: Sequence[float], *, central_b: float = 0.0, clocking: float = 0.0) -> Fit:
    """Planets, all alike, put in at `angles` about the axis (rad), with central b and rim 2' against rim 2 turned as given.

    z_b (psi - phi_b) + z_2' (psi + pi e_b - theta - kappa) = pi and z_a (psi - phi_a) + z_2 (psi + pi e_a - theta) = pi, both
    modulo 2 pi, e = 1 at external centrals: the first equation holds for every planet, and the second for planet 0. A stepped
    planet is turned on by the pitches of rim 2' that bring its rim 2 nearest to fitting; what is left is its misfit.
    """
    inside_a, inside_b = (math.pi * (central > 0) for central in (teeth.a, teeth.b))
    rims_b = [meshing_angle(teeth.rim_b, psi + inside_b, teeth.b, central_b, psi) for psi in angles]
    central_a = meshing_angle(teeth.a, angles[0], teeth.rim_a, rims_b[0] - clocking, angles[0] + inside_a)
    own, pitches = teeth.rim_a // teeth.common, teeth.rim_b // teeth.common
    turned, misfits = [], []
    for psi, rim in zip(angles, rims_b, strict=True):
        off = (teeth.a * (psi - central_a) + teeth.rim_a * (psi + inside_a - rim + clocking) - math.pi) / TURN
        steps = round(off * pitches)  # a pitch of rim 2' moves rim 2 by own/pitches of its pitches
        turned.append(rim + steps * pow(own, -1, pitches) % pitches * TURN / teeth.rim_b)
        misfits.append(off - steps / pitches)
    return Fit(central_a, tuple(rim - clocking for rim in turned), tuple(turned), tuple(misfits))


def permitted_steps(positions: int, planets: int) -> tuple[int, ...]:
    """Return which of the positions, numbers below `positions`, are nearest to equal angles, one for each planet.

    Where two positions are equally near, the planets balance each other as well as they can: the choice has the least
    |sum exp(i psi)|, and of equal ones the greater numbers.
    """
    nearest = []
    for number in range(planets):
        whole, rest = divmod(2 * positions * number, 2 * planets)
        nearest.append((whole + 1, whole) if rest == planets else (whole + (rest > planets),))

    def unbalance(steps: tuple[int, ...]) -> float:
        return round(abs(sum(cmath.exp(1j * TURN * step / positions) for step in steps)), 9)

    return min(product(*nearest), key=unbalance)
