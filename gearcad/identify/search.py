"""Search of all hypotheses, and the further measurements that would tell candidates apart."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations, pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats
from gearcad.geometry.tool_shelf import Shelf
from gearcad.identify.candidates import Candidate, Deciding, Identification, on_involute, variance
from gearcad.identify.fit import FittedHypothesis, fitted, read_off, sensitivity
from gearcad.identify.measurements import Gauge, Measured, Reading
from gearcad.identify.standards import FREE, Hypothesis, Unknown, hypotheses, transverse_hypotheses, ways

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
"""Largest difference, in normal modules, between a reading and that of usual teeth, due to shift, height of the teeth and
thinning.
"""

_SIGMAS = 6.0
_SOUGHT = 1
"""Number of times that a size of no series is searched again about the size that was found."""

_ANGLES = ((Gauge.HELIX_ANGLE, 1.0), (Gauge.TIP_HELIX_ANGLE, 0.95))
"""Gauges that tell a helix angle, and what part of the reading that is about."""

_HELICES = (8.0, 18.0, 30.0, 42.0)
"""Helix angles (degrees) about which sizes of the transverse section are sought where none was measured."""

_TURNED, _SETTLED_HELIX = 6, 0.2
"""Number of times that a size of the transverse section is searched about the helix angle that was found, and the change
(degrees) that ends the search.
"""

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


def fits(measured: Measured) -> list[FittedHypothesis]:
    """Return the fits of all hypotheses that the readings do not rule out, the most probable first."""
    found: list[FittedHypothesis] = []
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


def _free(measured: Measured, near: Iterable[Hypothesis]) -> Iterator[FittedHypothesis]:
    """Yield fits of sizes of no series near the nearest standard one, at each pressure angle and at any other."""
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


def _transverse(measured: Measured) -> Iterator[FittedHypothesis]:
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
    """Return the shift that brings a tip or root circle to its place: none of the gauges is far from its reading then."""
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
    """Return the greatest difference of readings from usual ones, over the permitted difference.

    Above 1 the readings rule out the unknowns.
    """
    lengths = [each for each in measured.readings if each.gauge in _REACH]
    circles, flanks = ([each for each in lengths if bool(each.size) is sized] for sized in (False, True))
    _, miss = _off(circles, measured, start)
    if miss > 1 or not flanks:  # flanks take longer
        return miss
    off, beside = _off(flanks, measured, start)
    spans = [number for number, each in enumerate(flanks) if each.gauge is Gauge.SPAN]
    return max(miss, beside, *(_pitch_miss(flanks, off, *pair) for pair in combinations(spans, 2)))


def _off(places: list[Reading], measured: Measured, start: Floats) -> tuple[Floats, float]:
    """Return the differences (mm) of readings from usual ones, and the greatest of them over the permitted one."""
    off: Floats = np.array([each.value for each in places]) - read_off(measured, places, start)
    module = float(start[Unknown.MODULE])
    may = np.array([_REACH[each.gauge] * module + _SIGMAS * each.uncertainty for each in places])
    return off, float(np.max(np.abs(off) / may, initial=0.0, where=np.isfinite(off)))


def _pitch_miss(flanks: list[Reading], off: Floats, one: int, other: int) -> float:
    """Two spans differ by base pitches, whatever shift and thinning are."""
    return abs(float(off[one] - off[other])) / (_SIGMAS * math.hypot(flanks[one].uncertainty, flanks[other].uncertainty))


_FURTHER_MOST = 3
_RIVALS = 4
"""Number of candidates that are told apart."""

_FURTHER_REACH = 6
"""Number of teeth more or fewer than the suggested span that are tried."""

_PINS = (1.4, 1.5, 1.68, 1.8, 2.0, 2.2)
"""Diameters of pins or balls in modules."""

_TELLING = 0.3
"""Share of the power of the most telling gauge that another one needs to be named."""

_FAR = 4.0
"""Number of uncertainties from which two readings are told apart."""

_OFF_FLANKS = (Gauge.TIP_DIAMETER, Gauge.ROOT_DIAMETER)
_ANGLE = 0.5
"""Uncertainty of a helix angle that is measured with care (degrees)."""


class Further(NamedTuple):
    """Gauges that would decide, most telling first; and those of the others whose flanks are those of the first within
    uncertainty.
    """

    deciding: tuple[Deciding, ...]
    alike: tuple[Candidate, ...]


def further(measured: Measured, rivals: Sequence[Candidate], uncertainty: float) -> Further:
    """Return the measurements that tell the first of these apart from all the others best."""
    rivals = rivals[:_RIVALS]
    known = {each.place for each in measured.readings}
    places = {place.place: place for place in _places(measured, rivals, uncertainty) if place.place not in known}
    found = [each for place in places.values() if (each := _deciding_reading(measured, rivals, place, None)) is not None]
    alike = tuple(rival for number, rival in enumerate(rivals) if number and _alike(found, number))
    spans = sorted((each.place for each in found if each.place.gauge is Gauge.SPAN), key=lambda place: place.size)
    pairs = [(more, less) for less, more in combinations(spans, 2)]
    found += [each for more, less in pairs if (each := _deciding_reading(measured, rivals, more, less)) is not None]
    found.sort(key=lambda each: -_separation(each, rivals))
    chosen: dict[tuple[Gauge, bool], Deciding] = {}
    for each in found:
        if _separation(each, rivals) >= _TELLING * _separation(found[0], rivals):
            chosen.setdefault((each.place.gauge, each.less is None), each)
    return Further(tuple(chosen.values())[:_FURTHER_MOST], alike)


def _separation(each: Deciding, rivals: Sequence[Candidate]) -> float:
    """Return how well a measurement separates all candidates; more probable ones count more."""
    return sum(rival.probability * min(apart, _FAR) for rival, apart in zip(rivals[1:], each.apart, strict=True))


def _alike(found: Sequence[Deciding], number: int) -> bool:
    """Return whether a candidate differs from the first by less than an uncertainty wherever a gauge touches flanks of both."""
    flanks = [each for each in found if each.place.gauge not in _OFF_FLANKS]
    return len(flanks) > 1 and all(abs(each.predicted[number] - each.predicted[0]) < each.place.uncertainty for each in flanks)


def _places(measured: Measured, rivals: Sequence[Candidate], uncertainty: float) -> Iterator[Reading]:
    def place(gauge: Gauge, size: float = 0.0) -> Reading:
        return Reading(gauge=gauge, value=1.0, uncertainty=uncertainty, size=size)

    yield place(Gauge.TIP_DIAMETER)
    yield place(Gauge.ROOT_DIAMETER)
    angles = sorted(abs(each.gear.helix_angle) for each in rivals)
    if measured.spur is not True and any(more - less > _ANGLE for less, more in pairwise(angles)):
        yield Reading(gauge=Gauge.TIP_HELIX_ANGLE, value=1.0, uncertainty=_ANGLE)
    for each in rivals:
        if not (measured.ring and each.gear.helix_angle):
            middle = each.gear.inspection.spanned or 1
            for count in range(max(1, middle - _FURTHER_REACH), min(abs(measured.teeth), middle + _FURTHER_REACH) + 1):
                yield place(Gauge.SPAN, count)
        for part in _PINS:
            yield place(
                Gauge.BETWEEN_BALLS if measured.ring else Gauge.OVER_BALLS, float(f"{part * each.gear.normal_module:.2g}")
            )


def _deciding_reading(measured: Measured, rivals: Sequence[Candidate], place: Reading, less: Reading | None) -> Deciding | None:
    """Return what each candidate would read at `place`, and how far apart.

    The result is None where the gauge does not touch all their flanks.
    """
    places = [place] if less is None else [place, less]
    values, variances = [], []
    for each in rivals:
        if not on_involute(each.gear, place):
            return None
        here, slopes = sensitivity(measured, places, each.fit.unknowns, each.fit.ways.varied)
        if not (np.all(np.isfinite(here)) and np.all(np.isfinite(slopes))):
            return None
        signs = np.array([1.0, -1.0][: len(places)])
        values.append(float(signs @ here))
        variances.append(variance(signs @ slopes, each.fit))
    apart = tuple(
        abs(value - values[0]) / math.sqrt(len(places) * place.uncertainty**2 + variances[0] + other)
        for value, other in zip(values[1:], variances[1:], strict=True)
    )
    return Deciding(place=place, less=less, predicted=tuple(values), apart=apart)


_OFF_INVOLUTE = 6.0
"""Logarithm of how improbable a gauge beside the involute makes a candidate: one measures where there is a flank."""

_JUDGED = 40
_RUN_LEAST = 1e-4
"""Least probability of candidates that are listed beside the best."""

_USUAL_UNCERTAINTY = 0.02


def identify_gear(measured: Measured, count: int = 10, folder: Path | None = None) -> Identification:
    """Return the gears that readings may be of, at most `count`, the most probable first.

    Each names the tools of the shelf that would leave its root; `folder` is that of a table of tools, None the current one.
    Raises GeometryError where no gear of any size comes near them.
    """
    made = [
        (each, each.fit.log_evidence - _OFF_INVOLUTE * len(each.off_involute))
        for fit in fits(measured)[:_JUDGED]
        if (each := Candidate.of(measured, fit, 0.0)) is not None
    ]
    if not made:
        permitted = "must be counted again, or the readings taken again: no gear of any size comes near them"
        raise GeometryError("teeth", measured.teeth, permitted)
    whole = float(np.logaddexp.reduce([weight for _, weight in made]))
    made.sort(key=lambda each: -each[1])
    likely = [(each, math.exp(weight - whole)) for each, weight in made[:count]]
    shelf = list(Shelf(folder or Path()).rows())
    found = tuple(
        replace(each, probability=share, tools=each.tools_of(measured, shelf))
        for each, share in likely
        if share >= _RUN_LEAST or share == likely[0][1]
    )
    result = Identification(
        measured=measured, candidates=found, deciding=(), alike=(), chance=_chance(measured, found[0].chi_square)
    )
    rivals = result.rivals
    if not rivals:
        return result
    lengths = [each.uncertainty for each in measured.readings if each.gauge not in (Gauge.HELIX_ANGLE, Gauge.TIP_HELIX_ANGLE)]
    told = further(measured, (found[0], *rivals), min([*lengths, _USUAL_UNCERTAINTY]))
    return replace(result, deciding=told.deciding, alike=told.alike)


def _chance(measured: Measured, chi_square: float) -> float:
    """Return the chance of a sum of squares at least as great, by the chi-square distribution of the number of readings.

    For whole numbers of degrees of freedom it is a finite sum (Abramowitz and Stegun, 26.4.4 and 26.4.5).
    """
    half, freedom = chi_square / 2, len(measured.readings)
    first = math.erfc(math.sqrt(half)) if freedom % 2 else math.exp(-half)
    powers = (math.exp(-half + k * math.log(half) - math.lgamma(k + 1)) if half else float(k == 0) for k in _steps(freedom))
    return first + sum(powers)


def _steps(freedom: int) -> list[float]:
    """Return the exponents of the terms beside the first: 1/2, 3/2 ... or 1, 2 ... below half the degrees of freedom."""
    begin = 0.5 if freedom % 2 else 1.0
    return [begin + step for step in range(int(freedom / 2 - begin + 0.5))]
