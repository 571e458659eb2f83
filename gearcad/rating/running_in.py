"""What running in takes off deviations: y_alpha and y_beta of ISO 6336-1:2006, clauses 8 and 7. Deviations in µm."""

from __future__ import annotations

import math
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.errors import require_number
from gearcad.material import MaterialGroup
from gearcad.per_gear import PerGear
from gearcad.rating.factors.elementwise import Values

__all__ = ["FlankWear", "RunningIn", "running_in_alpha", "running_in_beta", "running_in_relief"]


_SLOW, _FAST = 5.0, 10.0
"""Circumferential speeds (m/s) up to which nothing, and beyond which most, is held back by speed."""


class RunningIn(Enum):
    """How flanks wear to fit each other."""

    THROUGH_HARDENED = "through hardened"
    """Structural and through-hardened steel, cast steel, perlitic and bainitic nodular iron: St, V, GGG, GTS."""

    CAST_IRON = "cast iron"
    """Grey iron and ferritic nodular iron: GG, GGG (ferr.)."""

    SURFACE_HARDENED = "surface hardened"
    """Case-hardened, nitrided, flame- or induction-hardened steel: Eh, IF, NT, NV."""

    @classmethod
    def of(cls, group: MaterialGroup) -> RunningIn:
        """That of a group of materials."""
        if group in (MaterialGroup.GREY_IRON, MaterialGroup.FERRITIC_NODULAR_IRON):
            return cls.CAST_IRON
        return cls.SURFACE_HARDENED if group in _HARDENED else cls.THROUGH_HARDENED

    @property
    def needs_flank_limit(self) -> bool:
        """True if the allowance depends on sigma_H_lim."""
        return self is RunningIn.THROUGH_HARDENED


_HARDENED = (
    MaterialGroup.CASE_HARDENED,
    MaterialGroup.SURFACE_HARDENED,
    MaterialGroup.NITRIDING_STEEL,
    MaterialGroup.NITRIDED,
    MaterialGroup.NITROCARBURISED,
)


class _Rule(NamedTuple):
    """Part of a deviation that wears off, and its most (µm) at slow, medium and high speed.

    Through-hardened flanks have all of them times MPa, over sigma_H_lim.
    """

    part: float
    most: tuple[float, float, float]

    def allowance(self, deviation: float | Floats, speed: ArrayLike, softness: float | Floats) -> Floats:
        """What wears off deviations (µm) at circumferential speeds (m/s); all broadcast."""
        v = np.abs(np.asarray(speed, float))
        most = np.select([v <= _SLOW, v <= _FAST], self.most[:2], self.most[2])
        result: Floats = np.minimum(np.minimum(self.part * deviation, most) / softness, deviation)
        return result


_ALPHA = {
    RunningIn.THROUGH_HARDENED: _Rule(160, (math.inf, 12800, 6400)),
    RunningIn.CAST_IRON: _Rule(0.275, (math.inf, 22, 11)),
    RunningIn.SURFACE_HARDENED: _Rule(0.075, (3, 3, 3)),
}
_BETA = {
    RunningIn.THROUGH_HARDENED: _Rule(320, (math.inf, 25600, 12800)),
    RunningIn.CAST_IRON: _Rule(0.55, (math.inf, 45, 22)),
    RunningIn.SURFACE_HARDENED: _Rule(0.15, (6, 6, 6)),
}


def running_in_alpha(
    deviation: float | Floats, kind: RunningIn, speed: ArrayLike, flank_limit: float | Floats | None = None
) -> Floats:
    """y_alpha (8.3.5): what wears off deviations f_pb or f_falpha at circumferential speeds (m/s); all broadcast.

    For two materials it is the mean of theirs. Through-hardened gears need their `flank_limit` sigma_H_lim (MPa). Raises
    ParameterError.
    """
    return _ALPHA[kind].allowance(deviation, speed, _softness(kind, flank_limit))


def running_in_beta(
    misalignment: float | Floats, kind: RunningIn, speed: ArrayLike, flank_limit: float | Floats | None = None
) -> Floats:
    """y_beta (clause 7): what wears off an initial misalignment F_beta_x; F_beta_y = F_beta_x - y_beta. Else as y_alpha."""
    return _BETA[kind].allowance(misalignment, speed, _softness(kind, flank_limit))


def running_in_relief(flank_limit: Values) -> Values:
    """C_ay (6.5): the tip relief (µm) that running in makes, by sigma_H_lim (MPa); for two materials the mean of theirs."""
    return (flank_limit / 97 - 18.45) ** 2 / 18 + 1.5


class FlankWear(NamedTuple):
    """How the flanks of both gears run in, and their limits sigma_Hlim (MPa): of two materials the mean of both counts."""

    kinds: PerGear[RunningIn]
    flank_limits: PerGear[float | Floats | None]

    def alpha(self, deviation: float | Floats, speed: ArrayLike) -> Floats:
        """y_alpha (µm) of deviations f_pb or f_falpha at circumferential speeds (m/s)."""
        pinion, wheel = (running_in_alpha(deviation, kind, speed, limit) for kind, limit in zip(*self, strict=True))
        return (pinion + wheel) / 2

    def beta(self, misalignment: float | Floats, speed: ArrayLike) -> Floats:
        """y_beta (µm) of misalignments F_beta_x."""
        pinion, wheel = (running_in_beta(misalignment, kind, speed, limit) for kind, limit in zip(*self, strict=True))
        return (pinion + wheel) / 2


def _softness(kind: RunningIn, flank_limit: float | Floats | None) -> float | Floats:
    if not kind.needs_flank_limit:
        return 1.0
    require_number("flank_limit", flank_limit if flank_limit is None else float(np.min(flank_limit)), "MPa", above=0)
    assert flank_limit is not None  # a number: seen to just now
    return flank_limit
