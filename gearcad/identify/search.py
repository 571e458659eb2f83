"""All hypotheses gone through: those that readings rule out at a glance, and the fits of all others."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np

from gearcad.arrays import Floats
from gearcad.identify.fit import Fit, fitted
from gearcad.identify.gauges import read_off
from gearcad.identify.measured import Gauge, Measured, Reading
from gearcad.identify.prior import Hypothesis, hypotheses, transverse_hypotheses, ways
from gearcad.identify.standards import FREE
from gearcad.identify.unknowns import Unknown

__all__ = ["fits"]

_REACH = {
    Gauge.TIP_DIAMETER: 3.5,
    Gauge.ROOT_DIAMETER: 3.5,
    Gauge.MATE_TIP_DIAMETER: 3.5,
    Gauge.CENTRE_DISTANCE: 3.0,
    Gauge.SPAN: 1.8,
    Gauge.CHORDAL_THICKNESS: 1.8,
    Gauge.OVER_PINS: 6.0,
    Gauge.OVER_BALLS: 6.0,
    Gauge.BETWEEN_PINS: 6.0,
    Gauge.BETWEEN_BALLS: 6.0,
}
"""How far, in normal modules, shift and height of the teeth and their thinning may bring a reading from the usual."""

_SIGMAS = 6.0
_SOUGHT = 1
"""How often a size of no series is sought again about where it was found."""

_ANGLES = ((Gauge.HELIX_ANGLE, 1.0), (Gauge.TIP_HELIX_ANGLE, 0.95))
"""What tells a helix angle, and what part of the reading that is about."""

_HELICES = (8.0, 18.0, 30.0, 42.0)
"""Helix angles (degrees) about which sizes of the transverse section are sought where none was measured."""

_TURNED, _SETTLED_HELIX = 6, 0.2
"""How often a size of the transverse section is sought about the helix angle that was found, and how near (degrees) it ends."""

_FIRST_HELIX, _LEAST, _MOST = 15.0, 5.0, 42.0
_LEAST_HELIX, _MOST_HELIX = 1.0, 55.0
_MOST_SHIFT = 1.0
_CIRCLES = (Gauge.TIP_DIAMETER, Gauge.ROOT_DIAMETER)
_DIAMETERS = (
    Gauge.TIP_DIAMETER,
    Gauge.ROOT_DIAMETER,
    Gauge.OVER_PINS,
    Gauge.OVER_BALLS,
    Gauge.BETWEEN_PINS,
    Gauge.BETWEEN_BALLS,
)


def fits(measured: Measured) -> list[Fit]:
    """All hypotheses that readings leave worth a fit, the most probable first."""
    found: list[Fit] = []
    nearest: dict[tuple[float, bool], tuple[float, Hypothesis]] = {}
    for hypothesis in hypotheses(measured.spur):
        start = _start(measured, hypothesis)
        miss = _miss(measured, start)
        family = hypothesis.pressure_angle, hypothesis.helical
        if miss < nearest.get(family, (math.inf, hypothesis))[0]:
            nearest[family] = miss, hypothesis
        if miss <= 1 and (fit := fitted(measured, hypothesis, start)) is not None:
            found.append(fit)
    if measured.spur is not True:
        found += _transverse(measured)
    found += _free(measured, (hypothesis for _, hypothesis in nearest.values()))
    return sorted(found, key=lambda fit: -fit.log_evidence)


def _free(measured: Measured, near: Iterable[Hypothesis]) -> Iterator[Fit]:
    """Sizes of no series near the standard one that comes nearest, at each pressure angle and at any other."""
    for hypothesis in near:
        for any_angle in (False, True) if hypothesis.pressure_angle == 20.0 else (False,):
            free = replace(hypothesis, size=replace(hypothesis.size, pitch=None, series=FREE), free_angle=any_angle)
            fit = fitted(measured, free, _start(measured, free))
            for _ in range(_SOUGHT):
                if fit is None or not (module := float(fit.unknowns[Unknown.MODULE])) > 0:
                    break
                free = replace(free, size=replace(free.size, module=module))
                fit = fitted(measured, free, _start(measured, free))
            if fit is not None:
                yield fit


def _transverse(measured: Measured) -> Iterator[Fit]:
    """Standard sizes of the transverse section, each about the helix angle that it was found to have."""
    said = [part * abs(each.value) for gauge, part in _ANGLES if (each := measured.find(gauge)) is not None]
    for family in transverse_hypotheses(said[:1] or _HELICES):
        miss, number = min((_miss(measured, _start(measured, each)), number) for number, each in enumerate(family))
        if miss > 1:
            continue
        about = family[number]
        for _ in range(_TURNED):
            if (fit := fitted(measured, about, _start(measured, about))) is None:
                break
            helix = float(fit.unknowns[Unknown.HELIX_ANGLE])
            if abs(helix - (about.transverse_at or 0.0)) <= _SETTLED_HELIX:
                yield fit
                break
            about = replace(about, transverse_at=min(max(helix, _LEAST_HELIX), _MOST_HELIX))


def _start(measured: Measured, hypothesis: Hypothesis) -> Floats:
    """First values of the unknowns: the means of the most usual way, and a helix angle that fits a diameter."""
    made = ways(hypothesis, measured.mate_teeth is not None)
    start: Floats = made.means[int(np.argmax(made.log_weights))].copy()
    if hypothesis.transverse_at is not None:
        start[Unknown.HELIX_ANGLE] = hypothesis.transverse_at
        start[Unknown.MODULE] = hypothesis.size.module * math.cos(math.radians(hypothesis.transverse_at))
    elif hypothesis.helical:
        start[Unknown.HELIX_ANGLE] = _first_helix(measured, start)
    start[Unknown.SHIFT] = _first_shift(measured, start)
    return start


def _first_shift(measured: Measured, start: Floats) -> float:
    """The shift that brings a tip or root circle to its place: none of the gauges is far from its reading then."""
    known = next((each for each in measured.readings if each.gauge in _CIRCLES), None)
    if known is None:
        return 0.0
    beyond = known.value - float(read_off(measured, [known], start)[0])
    shift = beyond / (2 * float(start[Unknown.MODULE])) * (-1 if measured.ring else 1) + float(start[Unknown.SHIFT])
    return min(max(shift, -_MOST_SHIFT), _MOST_SHIFT)


def _first_helix(measured: Measured, start: Floats) -> float:
    for gauge, part in _ANGLES:
        if (said := measured.find(gauge)) is not None:
            return part * abs(said.value)
    known = next((each for each in measured.readings if each.gauge in _DIAMETERS), None)
    if known is None:
        return _FIRST_HELIX
    straight = start.copy()
    straight[Unknown.HELIX_ANGLE] = 0.0
    reference = abs(measured.teeth) * float(start[Unknown.MODULE])
    wider = known.value - float(read_off(measured, [known], straight)[0]) + reference
    cosine = reference / wider if wider > reference else 1.0
    return min(max(math.degrees(math.acos(min(cosine, 1.0))), _LEAST), _MOST)


def _miss(measured: Measured, start: Floats) -> float:
    """How far readings are from the usual, as a part of what may be; above 1 for what they rule out."""
    lengths = [each for each in measured.readings if each.gauge in _REACH]
    circles, flanks = ([each for each in lengths if bool(each.size) is sized] for sized in (False, True))
    _, miss = _off(circles, measured, start)
    if miss > 1 or not flanks:  # flanks take longer
        return miss
    off, beside = _off(flanks, measured, start)
    spans = [number for number, each in enumerate(flanks) if each.gauge is Gauge.SPAN]
    return max(miss, beside, *(_pitch_miss(flanks, off, *pair) for pair in combinations(spans, 2)))


def _off(places: list[Reading], measured: Measured, start: Floats) -> tuple[Floats, float]:
    """How far readings are from the usual (mm), and the greatest as a part of what may be."""
    off: Floats = np.array([each.value for each in places]) - read_off(measured, places, start)
    module = float(start[Unknown.MODULE])
    may = np.array([_REACH[each.gauge] * module + _SIGMAS * each.uncertainty for each in places])
    return off, float(np.max(np.abs(off) / may, initial=0.0, where=np.isfinite(off)))


def _pitch_miss(flanks: list[Reading], off: Floats, one: int, other: int) -> float:
    """Two spans differ by base pitches, whatever shift and thinning are."""
    return abs(float(off[one] - off[other])) / (_SIGMAS * math.hypot(flanks[one].uncertainty, flanks[other].uncertainty))
