"""What gauges read on a gear whose unknowns are known, by the formulas of `geometry`, and how readings change with them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import InputError, SolverError
from gearcad.geometry import BasicRack
from gearcad.geometry.gauged import inspection_of
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.inspection import Inspection
from gearcad.geometry.shift import zero_backlash_centre_distance
from gearcad.geometry.tooth_caliper import chord_below_tip
from gearcad.identify.measured import Gauge, Measured, Reading
from gearcad.identify.unknowns import UNKNOWNS, Unknown
from gearcad.per_gear import PerGear

__all__ = ["gear_data", "read_off", "sensitivity", "touches"]

_STEPS = np.array([1e-5, 1e-4, 1e-3, 1e-4, 1e-4, 1e-4, 1e-3, 1e-4])
"""Of differences, small beside how far each unknown bends a reading, large beside rounding."""


_FELT_BY: dict[int, tuple[Gauge, ...]] = {
    Unknown.ADDENDUM: (Gauge.TIP_DIAMETER, Gauge.TIP_HELIX_ANGLE, Gauge.MATE_TIP_DIAMETER, Gauge.CHORDAL_THICKNESS),
    Unknown.DEDENDUM: (Gauge.ROOT_DIAMETER,),
    Unknown.MATE_SHIFT: (Gauge.CENTRE_DISTANCE, Gauge.MATE_TIP_DIAMETER),
}
"""Which gauges feel an unknown, of those that not all do."""


@lru_cache(maxsize=256)
def _rack(pressure_angle: float) -> BasicRack:
    return BasicRack(pressure_angle=pressure_angle)


def gear_data(teeth: int, unknowns: Floats) -> GearData:
    """The gear: its tip circle by its alteration, its root circle by the rack."""
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
    """What the gauges at `places` would read, nan where one does not fit between the teeth or the pair does not mesh."""
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
    """What gauges of flanks ask; None where there are none."""
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
    """The centre distance without backlash, thinning apart; the tip circle of a mate whose tips stand as high."""
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
    """Readings (n,) and their derivatives (n, unknowns), 0 by those that are not `varied`."""
    here = read_off(measured, places, unknowns)
    slopes = np.zeros((len(places), UNKNOWNS))
    for each in varied:
        felt = [row for row, place in enumerate(places) if each not in _FELT_BY or place.gauge in _FELT_BY[each]]
        beside = unknowns.copy()
        beside[each] += _STEPS[each]
        slopes[felt, each] = (read_off(measured, [places[row] for row in felt], beside) - here[felt]) / _STEPS[each]
    return here, slopes


def touches(inspection: Inspection, place: Reading) -> float | None:
    """The diameter (mm, positive) on which a gauge touches the flanks; None for one that does not."""
    if place.gauge is Gauge.SPAN:
        return abs(inspection.span_contact_diameter(int(place.size)))
    if place.gauge is Gauge.CHORDAL_THICKNESS:
        return chord_below_tip(inspection, inspection.addendum, place.size).diameter
    if place.gauge in (Gauge.OVER_PINS, Gauge.OVER_BALLS, Gauge.BETWEEN_PINS, Gauge.BETWEEN_BALLS):
        return abs(inspection.ball_contact_diameter(place.size))
    return None
