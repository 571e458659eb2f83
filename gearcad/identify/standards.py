"""Standard sizes of gears, each with its weight, and the prior probability of the unknowns. The weights are our judgement.

A hypothesis is a size, a pressure angle, and spur or helical teeth; the size of helical ones may be that of the transverse
section, from which the helix angle makes a normal module of no series. Under each there are ways to have made the gear: with
one of the racks, with tips as the rack has them or others, without profile shift or with some, and likewise the mate. Numbers
here are judgement, not statistics of a population; they decide only where readings do not.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from functools import lru_cache
from itertools import product

import numpy as np

from gearcad.core.records import Floats
from gearcad.core.units import module_of_pitch
from gearcad.geometry.gear_parts import ISO_54_I, ISO_54_II


class Unknown(IntEnum):
    """Index of each unknown in the vector; lengths in mm, angles in degrees, coefficients in normal modules."""

    MODULE = 0
    PRESSURE_ANGLE = 1
    HELIX_ANGLE = 2
    SHIFT = 3
    ADDENDUM = 4
    """h_aP + k: what the tip circle stands over the shifted reference circle."""

    DEDENDUM = 5
    THINNING = 6
    """The natural logarithm of the tooth thinning, which is above 0."""

    MATE_SHIFT = 7


UNKNOWNS = len(Unknown)


@dataclass(frozen=True)
class StandardSize:
    """A normal module (mm), the diametral pitch (1/inch) that it stands for or None, its series, and its weight."""

    module: float
    pitch: float | None
    series: str
    weight: float


@dataclass(frozen=True)
class StandardRack:
    """A basic rack in normal modules, and its weight at pressure angles (degrees); None stands for all others.

    Its dedendum may have a constant part (mm), and may be known no better than to a `spread`.
    """

    name: str
    addendum: float
    dedendum: float
    root_radius: float
    weights: dict[float | None, float]
    constant: float = 0.0
    spread: float = 0.0
    largest_module: float = 1e9

    def dedendum_at(self, module: float) -> float:
        """Return the dedendum, in modules, for a normal module (mm)."""
        return self.dedendum + self.constant / module

    def weight(self, angle: float, module: float) -> float:
        """Return the weight of the rack at a pressure angle (degrees) and a normal module (mm)."""
        return 0.0 if module > self.largest_module else self.weights.get(angle, self.weights[None])


FREE = "free"
"""The series of a size that no series has."""

_FINE_I = (0.1, 0.12, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8)
_FINE_II = (0.35, 0.45, 0.55, 0.7, 0.75, 0.9)
_USUAL_PITCHES = (2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 18, 20, 24, 28, 32, 36, 40, 48, 64, 72, 80, 96, 120)
_COARSE_PITCHES = (1, 1.25, 1.5, 1.75, 2.25, 2.5, 2.75, 3.5, 4.5, 5.5, 7, 9, 11, 13, 15)
_FINE_PITCHES = (22, 25, 26, 30, 44, 50, 56, 60, 100, 128, 150, 200)

SIZES = tuple(
    sorted(
        (
            *(StandardSize(float(module), None, "ISO 54 I", 1.0) for module in ISO_54_I),
            *(StandardSize(float(module), None, "ISO 54 II", 0.4) for module in ISO_54_II),
            *(StandardSize(module, None, "DIN 780 I", 1.0) for module in _FINE_I),
            *(StandardSize(module, None, "DIN 780 II", 0.4) for module in _FINE_II),
            *(StandardSize(module_of_pitch(pitch), float(pitch), "DP", 0.5) for pitch in _USUAL_PITCHES),
            *(StandardSize(module_of_pitch(pitch), float(pitch), "DP", 0.15) for pitch in (*_COARSE_PITCHES, *_FINE_PITCHES)),
        ),
        key=lambda size: size.module,
    )
)
"""ISO 54:1996, modules below 1 mm as DIN 780-1 has them, and diametral pitches as catalogues have them."""

ANGLES = {20.0: 1.0, 14.5: 0.12, 25.0: 0.06, 22.5: 0.04, 15.0: 0.04, 17.5: 0.04, 30.0: 0.01}
"""Normal pressure angles (degrees), and how usual they are beside 20."""

FREE_ANGLE = 0.002
"""Share of gears with any other pressure angle, with a size of no series."""

RACKS = (
    StandardRack("ISO 53 A, B, C; JIS; AGMA", 1.0, 1.25, 0.38, {None: 0.6, 14.5: 0.12}),
    StandardRack("ISO 53 D", 1.0, 1.4, 0.39, {None: 0.1, 14.5: 0.02}),
    StandardRack("AGMA, full fillet", 1.0, 1.35, 0.3, {None: 0.05}),
    StandardRack("1.2 deep", 1.0, 1.2, 0.3, {None: 0.05}),
    StandardRack("AGMA fine pitch", 1.0, 1.2, 0.3, {None: 0.1}, constant=0.0508, largest_module=1.271),
    StandardRack("Brown & Sharpe", 1.0, 1.157, 0.209, {None: 0.04, 14.5: 0.6}),
    StandardRack("stub", 0.8, 1.0, 0.3, {None: 0.04, 14.5: 0.01}),
    StandardRack("another depth", 1.0, 1.27, 0.3, {None: 0.1, 14.5: 0.1}, spread=0.12),
    StandardRack("another stub", 0.8, 1.0, 0.3, {None: 0.02, 14.5: 0.01}, spread=0.08),
)
"""ISO 53:1998, AGMA 201.02 (full depth, fine pitch, full fillet), the Brown & Sharpe system of 14.5 degrees, and stub teeth."""


_HELICAL = 0.35
"""Share of gears with a helix."""

_TRANSVERSE, _USUAL = 0.05, 0.4
"""The share of helical gears of a standard transverse size, and the least weight of sizes that are tried so."""

_FREE = 0.05
"""The weight of a size of no series; a whole range of them shares it."""

_HELIX, _HELIX_SPREAD = 18.0, 9.0
_MODULE_SPREAD = 0.05
"""Spread of a size of no series about the module from which the search starts, relative to it."""

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
        """Logarithm of the weight of the hypothesis."""
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
    """Return all standard hypotheses, of spur gears, helical ones, or both."""
    kinds = [False, True] if spur is None else [not spur]
    return [Hypothesis(size, angle, helical) for helical, angle, size in product(kinds, ANGLES, SIZES)]


def transverse_hypotheses(helices: Iterable[float]) -> list[list[Hypothesis]]:
    """Return all hypotheses with usual sizes of the transverse section, each about these helix angles (degrees)."""
    usual = [size for size in SIZES if size.weight >= _USUAL]
    return [[Hypothesis(size, angle, True, transverse_at=helix) for helix in helices] for angle, size in product(ANGLES, usual)]


@lru_cache(maxsize=4096)
def ways(hypothesis: Hypothesis, mated: bool) -> Ways:
    """Return the ways under a hypothesis, of a gear with a mate or without."""
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
