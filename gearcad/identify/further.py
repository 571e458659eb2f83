"""What else to measure: the gauges that would tell candidates apart, with what each of them would have there."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np

from gearcad.identify.candidate import Candidate, on_involute, variance
from gearcad.identify.gauges import sensitivity
from gearcad.identify.identification import Deciding
from gearcad.identify.measured import Gauge, Measured, Reading

__all__ = ["Further", "further"]

_MOST = 3
_RIVALS = 4
"""How many candidates are told apart."""

_REACH = 6
"""How many teeth more or fewer than the suggested span."""

_PINS = (1.4, 1.5, 1.68, 1.8, 2.0, 2.2)
"""Diameters of pins or balls in modules."""

_TELLING = 0.3
"""How much less than the most telling one another may tell and be named."""

_FAR = 4.0
"""What is that many uncertainties apart is told apart."""

_OFF_FLANKS = (Gauge.TIP_DIAMETER, Gauge.ROOT_DIAMETER)
_ANGLE = 0.5
"""Uncertainty of a helix angle that is measured with care (degrees)."""


class Further(NamedTuple):
    """What would decide, most telling first; and those of the others whose flanks are those of the first within uncertainty."""

    deciding: tuple[Deciding, ...]
    alike: tuple[Candidate, ...]


def further(measured: Measured, rivals: Sequence[Candidate], uncertainty: float) -> Further:
    """The measurements that tell the first of these apart from all the others best."""
    rivals = rivals[:_RIVALS]
    known = {each.place for each in measured.readings}
    places = {place.place: place for place in _places(measured, rivals, uncertainty) if place.place not in known}
    found = [each for place in places.values() if (each := _told(measured, rivals, place, None)) is not None]
    alike = tuple(rival for number, rival in enumerate(rivals) if number and _alike(found, number))
    spans = sorted((each.place for each in found if each.place.gauge is Gauge.SPAN), key=lambda place: place.size)
    pairs = [(more, less) for less, more in combinations(spans, 2)]
    found += [each for more, less in pairs if (each := _told(measured, rivals, more, less)) is not None]
    found.sort(key=lambda each: -_told_by(each, rivals))
    chosen: dict[tuple[Gauge, bool], Deciding] = {}
    for each in found:
        if _told_by(each, rivals) >= _TELLING * _told_by(found[0], rivals):
            chosen.setdefault((each.place.gauge, each.less is None), each)
    return Further(tuple(chosen.values())[:_MOST], alike)


def _told_by(each: Deciding, rivals: Sequence[Candidate]) -> float:
    """How much a measurement tells of all, the more probable counting more."""
    return sum(rival.probability * min(apart, _FAR) for rival, apart in zip(rivals[1:], each.apart, strict=True))


def _alike(found: Sequence[Deciding], number: int) -> bool:
    """Whether a candidate differs from the first by less than an uncertainty wherever a gauge touches flanks of both."""
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
            for count in range(max(1, middle - _REACH), min(abs(measured.teeth), middle + _REACH) + 1):
                yield place(Gauge.SPAN, count)
        for part in _PINS:
            yield place(
                Gauge.BETWEEN_BALLS if measured.ring else Gauge.OVER_BALLS, float(f"{part * each.gear.normal_module:.2g}")
            )


def _told(measured: Measured, rivals: Sequence[Candidate], place: Reading, less: Reading | None) -> Deciding | None:
    """How far apart candidates are there; None where the gauge does not touch all their flanks."""
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
