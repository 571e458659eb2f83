"""Whose teeth meet in a mesh, how exact they are, and what is drawn of their errors."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcad.dynamics.excitation.deviations import (
    ErrorDistribution,
    ToothDeviations,
    TransmissionError,
    random_deviations,
    tooth_errors,
)
from gearcad.dynamics.tooth_errors.springs import PairErrors, ToothSpring
from gearcad.per_gear import PerGear, Role
from gearcad.rating.tolerances.iso1328 import FlankTolerances

__all__ = ["Draw", "MeshTeeth"]

_MICRO = 1e-6

_HARMONICS = 12
"""Of the tooth frequency, of errors that are smooth: as those of a chart have."""


class Draw(NamedTuple):
    """What is drawn: gear k of a distribution, by a seed. Gear 0 is the one of a single chart."""

    distribution: ErrorDistribution
    seed: int
    sample: int


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshTeeth:
    """The teeth of mesh `number` of a train: of pinion and wheel (a ring's above 0 as well), and the tolerances (µm) of both.

    Without tolerances teeth have no errors, but for those `given` of the pinion's. `spring` is a pair of them, where
    pairs are known one by one. Errors of the
    wheel are drawn if it is `wheel_drawn`: they come again only when the same teeth meet. `source` names what told the
    stiffness of the pair, if anything did.
    """

    name: str
    number: int
    teeth: PerGear[int]
    contact_ratio: float
    spring: ToothSpring | None = None
    tolerances: PerGear[FlankTolerances] | None = None
    given: ToothDeviations | None = None
    source: str = ""
    helical: bool = False
    wheel_drawn: bool = True

    @property
    def exact(self) -> bool:
        """Whether no tooth has an error."""
        return self.tolerances is None and self.given is None

    @property
    def period(self) -> int:
        """Teeth after which the errors come again."""
        if self.tolerances is not None and self.wheel_drawn:
            return math.lcm(*self.teeth)
        return 1 if self.exact else self.teeth.pinion

    def _drawn(self, draw: Draw, role: Role) -> ToothDeviations | None:
        """Deviations of a gear, None where it has none."""
        if role is Role.PINION and self.given is not None:
            return self.given
        if self.tolerances is None or (role is Role.WHEEL and not self.wheel_drawn) or self.teeth.pick(role) < 2:
            return None
        # The pinion of sample 0 is that of a chart by itself.
        gear = () if draw.sample == 0 and role is Role.PINION else (draw.sample, 0 if role is Role.PINION else 1)
        tolerances = self.tolerances.pick(role)
        seed = draw.seed + self.number
        return random_deviations(self.teeth.pick(role), tolerances, seed, distribution=draw.distribution, gear=gear)

    def pair_errors(self, draw: Draw) -> PairErrors:
        """Of every pair of teeth until the errors come again."""
        position, slope = np.zeros(self.period), np.zeros(self.period)
        for role in Role:
            if (found := self._drawn(draw, role)) is not None:
                which = np.arange(self.period) % self.teeth.pick(role)
                position += found.position[which]
                slope += found.slope[which]
        return PairErrors(_MICRO * position, _MICRO / self.contact_ratio * slope)

    def smooth_errors(self, draw: Draw) -> TransmissionError:
        """What they make of the transmission error where pairs take over gradually."""
        pinion, wheel = (self._drawn(draw, role) for role in Role)
        if pinion is None:
            return TransmissionError()
        return tooth_errors(pinion, wheel, contact_ratio=self.contact_ratio, harmonics=_HARMONICS)
