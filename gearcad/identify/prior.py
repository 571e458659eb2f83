"""What is known of gears before one is measured: under each hypothesis a mixture of normal distributions of the unknowns.

A hypothesis is a size, a pressure angle, and spur or helical teeth; the size of helical ones may be that of the transverse
section, from which the helix angle makes a normal module of no series. Under each there are ways to have made the gear: with
one of the racks, with tips as the rack has them or others, without profile shift or with some, and likewise the mate. Numbers
here are judgement, not statistics of a population; they decide only where readings do not.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np

from gearcad.arrays import Floats
from gearcad.identify.standards import ANGLES, FREE, FREE_ANGLE, RACKS, SIZES, StandardRack, StandardSize
from gearcad.identify.unknowns import UNKNOWNS, Unknown

__all__ = ["Hypothesis", "Ways", "hypotheses", "transverse_hypotheses", "ways"]

_HELICAL = 0.35
"""The share of gears with a helix."""

_TRANSVERSE, _USUAL = 0.05, 0.4
"""The share of helical gears of a standard transverse size, and the least weight of sizes that are tried so."""

_FREE = 0.05
"""The weight of a size of no series; a whole range of them shares it."""

_HELIX, _HELIX_SPREAD = 18.0, 9.0
_MODULE_SPREAD = 0.05
"""Of a size of no series, beside the module from which it is sought, relative to it."""

_ANGLE_SPREAD = 4.0
_SHIFTED, _SHIFT, _SHIFT_SPREAD = 0.6, 0.05, 0.4
_ALTERED, _ALTERATION, _ALTERATION_SPREAD = 0.25, -0.05, 0.12
_THINNING, _THINNING_OF_MODULE, _THINNING_SPREAD = 0.03, 0.012, 0.9
"""The median thinning (mm) and its part of the module; the spread is of its logarithm."""

_SHIFTS_OF_PAIRS = ((1 - _SHIFTED, 0.0, 0.0), (0.2, 1.0, -1.0), (0.4, 1.0, 0.0))
"""Weights, and what part of a spread of shifts pinion and mate have in common: none, opposite shifts, or each its own."""


@dataclass(frozen=True)
class Hypothesis:
    """A standard size, or one of no series near its module; a pressure angle (degrees), or one near it; spur or helical.

    A `transverse_at` makes the size that of the transverse section; the normal module changes with the helix angle as it does
    about that one (degrees).
    """

    size: StandardSize
    pressure_angle: float
    helical: bool
    free_angle: bool = False
    transverse_at: float | None = None

    @property
    def free(self) -> bool:
        return self.size.series == FREE

    @property
    def transverse(self) -> bool:
        return self.transverse_at is not None

    @property
    def log_weight(self) -> float:
        """How usual it is."""
        angle = FREE_ANGLE if self.free_angle else self._angle_weight
        size = _FREE if self.free else self.size.weight
        if self.transverse:
            size *= _TRANSVERSE
        return float(np.log(size * angle * (_HELICAL if self.helical else 1 - _HELICAL)))

    @property
    def _angle_weight(self) -> float:
        """14.5 degrees is an angle of diametral pitches."""
        weight = ANGLES[self.pressure_angle]
        if self.pressure_angle == 14.5:
            return weight * (2.0 if self.size.pitch is not None else 0.3)
        return weight


@dataclass(frozen=True)
class Ways:
    """The ways to have made a gear (w): their racks, log weights, means (w, unknowns), and roots of covariances
    (w, unknowns, unknowns), of which one times its transpose is a covariance.
    """

    racks: tuple[StandardRack, ...]
    log_weights: Floats
    means: Floats
    roots: Floats

    @property
    def varied(self) -> list[int]:
        """The unknowns that vary in any of the ways."""
        return [int(each) for each in np.flatnonzero(np.any(self.roots != 0, axis=(0, 2)))]


def hypotheses(spur: bool | None) -> list[Hypothesis]:
    """All standard ones, of spur gears, helical ones, or both."""
    kinds = [False, True] if spur is None else [not spur]
    return [Hypothesis(size, angle, helical) for helical, angle, size in product(kinds, ANGLES, SIZES)]


def transverse_hypotheses(helices: Iterable[float]) -> list[list[Hypothesis]]:
    """All of usual sizes of the transverse section, each about these helix angles (degrees)."""
    usual = [size for size in SIZES if size.weight >= _USUAL]
    return [[Hypothesis(size, angle, True, transverse_at=helix) for helix in helices] for angle, size in product(ANGLES, usual)]


@lru_cache(maxsize=4096)
def ways(hypothesis: Hypothesis, mated: bool) -> Ways:
    """The ways under a hypothesis, of a gear with a mate or without."""
    module, angle = hypothesis.size.module, hypothesis.pressure_angle
    tips = ((1 - _ALTERED, 0.0, 0.0), (_ALTERED, _ALTERATION, _ALTERATION_SPREAD))
    shifts = _SHIFTS_OF_PAIRS if mated else ((1 - _SHIFTED, 0.0, 0.0), (_SHIFTED, 1.0, 0.0))
    racks = [(rack, rack.weight(angle, module)) for rack in RACKS]
    total = sum(weight for _, weight in racks)
    cases = [case for case in product(racks, tips, shifts) if case[0][1] > 0]
    means, roots, weights = np.zeros((len(cases), UNKNOWNS)), np.zeros((len(cases), UNKNOWNS, UNKNOWNS)), np.zeros(len(cases))
    means[:, Unknown.MODULE], means[:, Unknown.PRESSURE_ANGLE] = module, angle
    means[:, Unknown.THINNING] = np.log(_THINNING + _THINNING_OF_MODULE * module)
    _spread(roots, Unknown.THINNING, _THINNING_SPREAD)
    if hypothesis.helical:
        means[:, Unknown.HELIX_ANGLE] = _HELIX
        _spread(roots, Unknown.HELIX_ANGLE, _HELIX_SPREAD)
        if hypothesis.transverse_at is not None:
            about = math.radians(hypothesis.transverse_at)
            slope = -math.radians(module * math.sin(about))
            means[:, Unknown.MODULE] = module * math.cos(about) + slope * (_HELIX - hypothesis.transverse_at)
            roots[:, Unknown.MODULE, Unknown.HELIX_ANGLE] = slope * _HELIX_SPREAD
    if hypothesis.free:
        _spread(roots, Unknown.MODULE, _MODULE_SPREAD * module)
    if hypothesis.free_angle:
        _spread(roots, Unknown.PRESSURE_ANGLE, _ANGLE_SPREAD)
    for way, ((rack, usual), (tip_weight, tip, tip_spread), (shift_weight, own, opposite)) in enumerate(cases):
        weights[way] = usual / total * tip_weight * shift_weight
        means[way, Unknown.ADDENDUM] = rack.addendum + tip
        means[way, Unknown.DEDENDUM] = rack.dedendum_at(module)
        means[way, Unknown.SHIFT] = _SHIFT * own * (1 + opposite)
        root = roots[way]
        root[Unknown.ADDENDUM, Unknown.ADDENDUM] = tip_spread
        root[Unknown.DEDENDUM, Unknown.DEDENDUM] = rack.spread
        root[Unknown.SHIFT, Unknown.SHIFT] = _SHIFT_SPREAD * own
        root[Unknown.MATE_SHIFT, Unknown.SHIFT] = _SHIFT_SPREAD * opposite
        if mated and own and not opposite:
            root[Unknown.MATE_SHIFT, Unknown.MATE_SHIFT] = _SHIFT_SPREAD
    return Ways(tuple(case[0][0] for case in cases), np.log(weights), means, roots)


def _spread(roots: Floats, unknown: Unknown, spread: float) -> None:
    roots[:, unknown, unknown] = spread
