"""Random gears on a bench: made to standards, measured with noise, and whether an identification names them."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from gearcad import BasicRack, Gear
from gearcad.core.errors import InputError
from gearcad.core.quantities import NOT_GIVEN
from gearcad.core.records import PerGear
from gearcad.geometry.gear_parts import ISO_54_I, ISO_54_II
from gearcad.geometry.pair_data import zero_backlash_centre_distance
from gearcad.identify import Candidate, Gauge, Measured, Reading
from gearcad.identify.candidates import on_involute
from gearcad.identify.standards import Unknown

NOISE, ANGLE_NOISE = 0.02, 1.0
"""Standard deviations: of lengths (mm), as calipers have it, and of the helix angle that paper shows (degrees)."""

PITCHES = (2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 18, 20, 24)
FINE = (0.3, 0.35, 0.4, 0.5, 25.4 / 64, 25.4 / 48)

WAYS = ("two spans", "three spans", "two balls", "two spans, mate")
"""What is measured beside number of teeth, tip and root diameter and the helix angle, which of a spur gear is seen to be 0."""

NO_FLANK = "diameters, mate"
"""Without anything of the flanks: the pressure angle is hardly measured."""

_MANY = 3.0
"""How many of its uncertainties a fitted value may be off."""


class Bench(NamedTuple):
    gear: Gear
    measured: Measured


def random_gear(rng: np.random.Generator, modules: Sequence[float] = ()) -> Gear:
    """External and internal, spur and helical, of ISO 54 and DP, or of one of the `modules` (mm)."""
    while True:
        draw, pitch = rng.random(), None
        if modules:
            module = float(rng.choice(modules))
        elif draw < 0.65:
            series = [each for each in (ISO_54_I if draw < 0.45 else ISO_54_II) if each <= 12]
            module = float(rng.choice(series))
        else:
            pitch = float(rng.choice(PITCHES))
            module = 25.4 / pitch
        angle = 14.5 if pitch is not None and rng.random() < 0.3 else 20.0
        if angle == 20.0 and rng.random() < 0.15:
            angle = float(rng.choice([25.0, 22.5, 15.0, 17.5]))
        teeth = round(math.exp(rng.uniform(math.log(8), math.log(150))))
        if rng.random() < 0.2:
            teeth = -max(teeth, 30)
        depth = (
            1.157
            if angle == 14.5 and rng.random() < 0.7
            else float(rng.choice([1.25, 1.4, 1.35, 1.2, 1.0], p=[0.65, 0.15, 0.08, 0.07, 0.05]))
        )
        try:
            gear = Gear(
                teeth=teeth,
                **({"normal_diametral_pitch": pitch} if pitch is not None else {"normal_module": module}),
                face_width=10 * module,
                helix_angle=0.0 if rng.random() < 0.55 else round(rng.uniform(5, 35), 1),
                profile_shift=0.0 if rng.random() < 0.35 else round(rng.uniform(-0.5, 0.8), 3),
                tip_alteration=0.0 if rng.random() < 0.75 else round(-rng.uniform(0, 0.2), 3),
                tooth_thinning=round(rng.uniform(0, 0.04) + module * rng.uniform(0, 0.03), 4),
                rack=BasicRack(pressure_angle=angle, addendum=0.8 if depth == 1.0 else 1.0, dedendum=depth, root_radius=0.15),
            )
        except InputError:
            continue
        if gear.tip_thickness >= 0.15 * module:
            return gear


def of_transverse_size(gear: Gear) -> Gear:
    """A helical gear whose transverse module is the normal one of another."""
    module = gear.normal_module * math.cos(math.radians(gear.helix_angle))
    return replace(gear, normal_module=module, normal_diametral_pitch=NOT_GIVEN)


def bench(
    rng: np.random.Generator, way: str, *, helix_known: bool = True, modules: Sequence[float] = (), transverse: bool = False
) -> Bench:
    """A random gear and its readings; of gears whose flanks no gauge of this way touches another is drawn.

    `transverse` ones are helical, and of a standard size of the transverse section.
    """
    while True:
        gear = random_gear(rng, modules)
        if transverse:
            if not gear.helix_angle:
                continue
            gear = of_transverse_size(gear)
        if (measured := _measured(rng, gear, way, helix_known)) is not None:
            return Bench(gear, measured)


def _measured(rng: np.random.Generator, gear: Gear, way: str, helix_known: bool) -> Measured | None:
    def read(gauge: Gauge, value: float, size: float = 0.0, noise: float = NOISE) -> Reading:
        return Reading(gauge=gauge, value=float(rng.normal(value, noise)), uncertainty=noise, size=size)

    readings = [read(Gauge.TIP_DIAMETER, abs(gear.tip_diameter)), read(Gauge.ROOT_DIAMETER, abs(gear.root_diameter))]
    if helix_known and gear.helix_angle:
        angle = math.degrees(math.atan(math.pi * abs(gear.tip_diameter) / gear.lead))
        readings.append(read(Gauge.TIP_HELIX_ANGLE, angle, noise=ANGLE_NOISE))
    elif helix_known:
        readings.append(Reading(gauge=Gauge.HELIX_ANGLE, value=0.0, uncertainty=ANGLE_NOISE))
    inspection, mate = gear.inspection, None
    if "spans" in way:
        wanted = 3 if "three" in way else 2
        if inspection.spanned is None:
            return None
        counts = sorted(range(1, abs(gear.teeth) // 2 + 2), key=lambda count: abs(count - (inspection.spanned or 1)))[:9]
        counts = [count for count in counts if _touched(gear, Gauge.SPAN, count)][:wanted]
        if len(counts) < wanted:
            return None
        readings += [read(Gauge.SPAN, inspection.span_measurement(count), count) for count in counts]
    if "balls" in way:
        gauge = Gauge.BETWEEN_BALLS if gear.internal else Gauge.OVER_BALLS
        over = inspection.between_balls if gear.internal else inspection.over_balls
        sizes = [
            size for part in np.arange(1.3, 2.6, 0.05) if _touched(gear, gauge, size := round(part * gear.normal_module, 1))
        ]
        if len(set(sizes)) < 2:
            return None
        readings += [read(gauge, over(size), size) for size in (min(sizes), max(sizes))]
    if "mate" in way:
        mate = int(rng.integers(17, 25)) if gear.internal else int(rng.integers(20, 90))
        shift = 0.0 if rng.random() < 0.3 else -gear.profile_shift if rng.random() < 0.3 else round(rng.uniform(-0.4, 0.6), 3)
        try:
            distance = zero_backlash_centre_distance(
                normal_module=gear.normal_module,
                teeth=PerGear(gear.teeth, mate),
                helix_angle=gear.helix_angle,
                pressure_angle=gear.rack.pressure_angle,
                shift_sum=gear.profile_shift + shift,
            )
        except InputError:
            return None
        readings.append(read(Gauge.CENTRE_DISTANCE, abs(distance)))
        rise = 1 if gear.rack.addendum == 1.0 else 0.8
        tip = mate * gear.transverse_module + 2 * gear.normal_module * (rise + shift + gear.tip_alteration)
        readings.append(read(Gauge.MATE_TIP_DIAMETER, tip))
    return Measured(teeth=gear.teeth, readings=tuple(readings), mate_teeth=mate)


def _touched(gear: Gear, gauge: Gauge, size: float) -> bool:
    return on_involute(gear, Reading(gauge=gauge, value=1.0, uncertainty=1.0, size=size))


def names(candidate: Candidate, gear: Gear) -> bool:
    """Whether a candidate is the gear: module or pitch, pressure angle, spur or helical, and helix angle and shift within
    three of the uncertainties that the candidate states."""
    found = candidate.gear
    same = math.isclose(found.normal_module, gear.normal_module, rel_tol=1e-9) and candidate.series != "free"
    same = same and found.rack.pressure_angle == gear.rack.pressure_angle and bool(found.helix_angle) == bool(gear.helix_angle)
    turned = abs(abs(found.helix_angle) - gear.helix_angle) <= _MANY * candidate.fit.uncertainty(Unknown.HELIX_ANGLE) + 1e-4
    shifted = abs(found.profile_shift - gear.profile_shift) <= _MANY * candidate.shift_uncertainty + 1e-4
    return same and turned and shifted
