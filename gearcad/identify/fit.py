"""Fit of the unknowns of a gear to its readings, and the probability of a hypothesis.

With normal distributions that is least squares: the readings in units of their uncertainties, and the unknowns in units of the
spreads of a way to make the gear. Gauss-Newton's steps are taken in the space of the readings, for all ways at once, so that an
unknown may have no spread at all. The sum of squares at the least is a chi-square with as many degrees of freedom as readings.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from gearcad.core.errors import InputError, SolverError
from gearcad.core.records import Floats, PerGear
from gearcad.geometry import BasicRack
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.inspection import Inspection, chord_below_tip, inspection_of
from gearcad.geometry.pair_data import zero_backlash_centre_distance
from gearcad.identify.measurements import Gauge, Measured, Reading
from gearcad.identify.standards import UNKNOWNS, Hypothesis, Unknown, Ways, ways

_STEPS = np.array([1e-5, 1e-4, 1e-3, 1e-4, 1e-4, 1e-4, 1e-3, 1e-4])
"""Steps of finite differences for each unknown: small beside its influence on a reading, large beside rounding."""


_DEPENDENT_GAUGES: dict[int, tuple[Gauge, ...]] = {
    Unknown.ADDENDUM: (Gauge.TIP_DIAMETER, Gauge.TIP_HELIX_ANGLE, Gauge.MATE_TIP_DIAMETER, Gauge.CHORDAL_THICKNESS),
    Unknown.DEDENDUM: (Gauge.ROOT_DIAMETER,),
    Unknown.MATE_SHIFT: (Gauge.CENTRE_DISTANCE, Gauge.MATE_TIP_DIAMETER),
}
"""Gauges that depend on an unknown, for those unknowns on which not all gauges depend."""


@lru_cache(maxsize=256)
def _rack(pressure_angle: float) -> BasicRack:
    return BasicRack(pressure_angle=pressure_angle)


def gear_data(teeth: int, unknowns: Floats) -> GearData:
    """Return the gear: its tip circle by its alteration, its root circle by the rack."""
    values = unknowns.tolist()
    return GearData(
        teeth=teeth,
        normal_module=values[Unknown.MODULE],
        face_width=1.0,
        helix_angle=values[Unknown.HELIX_ANGLE],
        profile_shift=values[Unknown.SHIFT],
        tip_alteration=values[Unknown.ADDENDUM] - 1.0,
        tooth_thinning=math.exp(values[Unknown.THINNING]),
        rack=_rack(values[Unknown.PRESSURE_ANGLE]),
    )


def read_off(measured: Measured, places: Sequence[Reading], unknowns: Floats) -> Floats:
    """Return the readings (n,) of the gauges at `places`.

    A reading is nan where the gauge does not fit between the teeth or the pair does not mesh.
    """
    try:
        gear = gear_data(measured.teeth, unknowns)
    except InputError:
        return np.full(len(places), np.nan)
    inspection = _inspection(gear, places)
    found = np.empty(len(places))
    for number, place in enumerate(places):
        try:
            found[number] = _read(measured, place, unknowns, gear, inspection)
        except (InputError, SolverError):  # a pin so large that no pressure angle is found at its centre
            found[number] = np.nan
    return found


def _inspection(gear: GearData, places: Sequence[Reading]) -> Inspection | None:
    """Return the inspection that gauges of flanks need; None without such gauges."""
    return inspection_of(gear, gear.reference_diameter) if any(place.size for place in places) else None


def _read(measured: Measured, place: Reading, unknowns: Floats, gear: GearData, inspection: Inspection | None) -> float:
    if inspection is not None and place.size:
        return _over_flanks(inspection, (gear.standard_tip_diameter - gear.reference_diameter) / 2, place)
    match place.gauge:
        case Gauge.TIP_DIAMETER:
            return abs(gear.standard_tip_diameter)
        case Gauge.ROOT_DIAMETER:
            deeper = float(unknowns[Unknown.DEDENDUM]) - gear.rack.dedendum
            return abs(gear.standard_root_diameter - 2 * gear.normal_module * deeper)
        case Gauge.HELIX_ANGLE:
            return gear.helix_angle
        case Gauge.TIP_HELIX_ANGLE:
            return math.degrees(math.atan(math.pi * abs(gear.standard_tip_diameter) / gear.lead))
        case Gauge.LEAD:
            return gear.lead
        case _:
            return _of_mate(measured, place.gauge, unknowns)


def _over_flanks(inspection: Inspection, addendum: float, place: Reading) -> float:
    match place.gauge:
        case Gauge.SPAN:
            return inspection.span_measurement(int(place.size))
        case Gauge.OVER_PINS:
            return inspection.over_pins(place.size)
        case Gauge.OVER_BALLS:
            return inspection.over_balls(place.size)
        case Gauge.CHORDAL_THICKNESS:
            return chord_below_tip(inspection, addendum, place.size).thickness
        case _:
            return inspection.between_balls(place.size)


def _of_mate(measured: Measured, gauge: Gauge, unknowns: Floats) -> float:
    """Return the centre distance without backlash, thinning apart; the tip circle of a mate whose tips stand as high."""
    assert measured.mate_teeth is not None
    if gauge is Gauge.MATE_TIP_DIAMETER:
        of_mate = unknowns.copy()
        of_mate[Unknown.SHIFT] = unknowns[Unknown.MATE_SHIFT]
        return abs(gear_data(measured.mate_teeth, of_mate).standard_tip_diameter)
    distance = zero_backlash_centre_distance(
        normal_module=float(unknowns[Unknown.MODULE]),
        teeth=PerGear(measured.teeth, measured.mate_teeth),
        helix_angle=float(unknowns[Unknown.HELIX_ANGLE]),
        pressure_angle=float(unknowns[Unknown.PRESSURE_ANGLE]),
        shift_sum=float(unknowns[Unknown.SHIFT] + unknowns[Unknown.MATE_SHIFT]),
    )
    return abs(distance)


def sensitivity(
    measured: Measured, places: Sequence[Reading], unknowns: Floats, varied: Sequence[int]
) -> tuple[Floats, Floats]:
    """Return the readings (n,) and their derivatives (n, unknowns), 0 by those that are not `varied`."""
    here = read_off(measured, places, unknowns)
    slopes = np.zeros((len(places), UNKNOWNS))
    for each in varied:
        felt = [
            row for row, place in enumerate(places) if each not in _DEPENDENT_GAUGES or place.gauge in _DEPENDENT_GAUGES[each]
        ]
        beside = unknowns.copy()
        beside[each] += _STEPS[each]
        slopes[felt, each] = (read_off(measured, [places[row] for row in felt], beside) - here[felt]) / _STEPS[each]
    return here, slopes


def touches(inspection: Inspection, place: Reading) -> float | None:
    """Return the diameter (mm, positive) on which a gauge touches the flanks; None for a gauge that does not."""
    if place.gauge is Gauge.SPAN:
        return abs(inspection.span_contact_diameter(int(place.size)))
    if place.gauge is Gauge.CHORDAL_THICKNESS:
        return chord_below_tip(inspection, inspection.addendum, place.size).diameter
    if place.gauge in (Gauge.OVER_PINS, Gauge.OVER_BALLS, Gauge.BETWEEN_PINS, Gauge.BETWEEN_BALLS):
        return abs(inspection.ball_contact_diameter(place.size))
    return None


_MOST_STEPS = 12
_SETTLED = 4
"""Steps after which the way to have made the gear stays: two that are as probable would take turns for ever."""

_UNUSUAL = 2.0
"""Number of spreads from the usual value beyond which a value is called unusual."""

_CLOSE = 1e-3
"""Step that ends the search, as a share of a spread."""

_LEAST_HELIX, _MOST_HELIX = 1.0, 55.0
_MOST_RETREATS, _THICKER = 5, 0.25
_LONGEST = np.array([np.inf, 5.0, 8.0, 1.0, 1.0, 1.0, 2.0, 1.0])
"""Step that is taken of each unknown."""


@dataclass(frozen=True)
class FittedHypothesis:
    """A hypothesis fitted: its `best` way and the `unknowns` by that, the logarithm of the probability of readings and
    hypothesis by each way (w,), the sum of squares, and means (w, u) and covariances (w, u, u) of the unknowns by each way.
    """

    hypothesis: Hypothesis
    ways: Ways
    best: int
    unknowns: Floats
    log_evidences: Floats
    chi_square: float
    means: Floats
    covariances: Floats

    @property
    def log_evidence(self) -> float:
        """Logarithm of the probability over all ways."""
        return float(np.logaddexp.reduce(self.log_evidences)) + self.hypothesis.log_weight

    @property
    def shares(self) -> Floats:
        """Weight of each way in uncertainties (w,), by the square root of its probability, as the weights are judgement."""
        doubted = self.log_evidences / 2
        found: Floats = np.exp(doubted - np.logaddexp.reduce(doubted))
        return found

    @property
    def unusual(self) -> tuple[Unknown, ...]:
        """Unknowns that differ from the usual value by two spreads or more, or the one that differs most."""
        spreads = np.sqrt(np.einsum("ij,ij->i", self.ways.roots[self.best], self.ways.roots[self.best]))
        off = np.abs(self.unknowns - self.ways.means[self.best])
        far = np.divide(off, spreads, out=np.zeros_like(off), where=spreads > 0)
        return tuple(each for each in Unknown if far[each] >= min(_UNUSUAL, far.max()))

    def uncertainty(self, unknown: Unknown) -> float:
        """Standard uncertainty of an unknown about its value here, other ways considered."""
        off = self.means[:, unknown] - self.unknowns[unknown]
        return float(np.sqrt(self.shares @ (self.covariances[:, unknown, unknown] + off**2)))

    @property
    def covariance(self) -> Floats:
        """Covariance (u, u) of the unknowns about their values here, other ways considered."""
        off = self.means - self.unknowns
        spread: Floats = np.einsum("w,wij->ij", self.shares, self.covariances + off[:, :, None] * off[:, None, :])
        return spread


def fitted(measured: Measured, hypothesis: Hypothesis, start: Floats, steps: int = _MOST_STEPS) -> FittedHypothesis | None:
    """Return the fit of a hypothesis from first values of the unknowns (u,); None where no such gear has these readings."""
    made = ways(hypothesis, measured.mate_teeth is not None)
    read = np.array([abs(each.value) for each in measured.readings])
    noise = np.diag([each.uncertainty**2 for each in measured.readings])
    spreads = np.sqrt(np.einsum("wij,wij->wi", made.roots, made.roots).max(axis=0))
    unknowns, before, taken = start, None, 0
    found: FittedHypothesis | None = None
    for _ in range(steps + _MOST_RETREATS):
        here, slopes = sensitivity(measured, measured.readings, unknowns, made.varied)
        if not (np.all(np.isfinite(here)) and np.all(np.isfinite(slopes))):
            unknowns = _retreat(measured, unknowns, before)
            continue
        try:
            way = found.best if found is not None and taken >= _SETTLED else None
            found = _step(hypothesis, made, unknowns, read - here, slopes, noise, way)
        except np.linalg.LinAlgError:  # readings that differ by nothing but rounding
            return None
        step = np.clip(found.unknowns - unknowns, -_LONGEST, _LONGEST)
        before, unknowns = unknowns, unknowns + step
        if hypothesis.helical:
            unknowns[Unknown.HELIX_ANGLE] = np.clip(unknowns[Unknown.HELIX_ANGLE], _LEAST_HELIX, _MOST_HELIX)
        taken += 1
        if taken == steps or np.all(np.abs(step) <= _CLOSE * spreads):
            return found
    return None


def _retreat(measured: Measured, unknowns: Floats, before: Floats | None) -> Floats:
    """Return unknowns (u,) away from those at which a ball falls to the base circle.

    They are half way back to those `before`, or at first at thicker teeth, of a ring thinner ones.
    """
    if before is not None:
        return (unknowns + before) / 2
    thicker = unknowns.copy()
    thicker[Unknown.SHIFT] += -_THICKER if measured.ring else _THICKER
    return thicker


def _step(
    hypothesis: Hypothesis, made: Ways, unknowns: Floats, off: Floats, slopes: Floats, noise: Floats, way: int | None
) -> FittedHypothesis:
    """Return the least of the sum of squares for readings that are linear in the unknowns, by every way; the best if none is
    set.
    """
    bent = slopes @ made.roots
    variance = noise + bent @ bent.transpose(0, 2, 1)
    miss = off - (made.means - unknowns) @ slopes.T
    weighed = np.linalg.solve(variance, miss[:, :, None])[:, :, 0]
    squares = np.einsum("wn,wn->w", miss, weighed)
    log_evidences = made.log_weights - (squares + np.linalg.slogdet(variance)[1]) / 2
    gain = made.roots @ bent.transpose(0, 2, 1)
    means = made.means + np.einsum("wun,wn->wu", gain, weighed)
    covariances = made.roots @ made.roots.transpose(0, 2, 1) - gain @ np.linalg.solve(variance, gain.transpose(0, 2, 1))
    best = int(np.argmax(log_evidences)) if way is None else way
    return FittedHypothesis(hypothesis, made, best, means[best], log_evidences, float(squares[best]), means, covariances)
