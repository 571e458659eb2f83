"""Identify: the gears that readings may be of, and the spec of one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from gearcad.errors import ParameterError, is_finite_number, require_whole
from gearcad.identify.identification import Identification
from gearcad.identify.measured import ANGLES, Gauge, Measured, Reading
from gearcad.identify.run import identify_gear

__all__ = ["identify"]

Value = float | tuple[float, float]
"""A reading, or a reading and its standard uncertainty."""

_OF_LEAD = 0.01
"""Uncertainty of a lead that is given without one, relative to it."""

_MOST = 100


def identify(
    teeth: int,
    *,
    tip_diameter: Value | None = None,
    root_diameter: Value | None = None,
    span: Mapping[int, Value] | None = None,
    over_pins: Mapping[float, Value] | None = None,
    over_balls: Mapping[float, Value] | None = None,
    between_pins: Mapping[float, Value] | None = None,
    between_balls: Mapping[float, Value] | None = None,
    helix_angle: Value | None = None,
    tip_helix_angle: Value | None = None,
    lead: Value | None = None,
    centre_distance: Value | None = None,
    mate_teeth: int | None = None,
    mate_tip_diameter: Value | None = None,
    uncertainty: float = 0.02,
    angle_uncertainty: float = 1.0,
    count: int = 10,
) -> Identification:
    """The standard gears that readings may be of, at most `count`, the most probable first. Lengths in mm, angles in degrees.

    `teeth` are negative for a ring, whose diameters are positive as they are read. `span` is {teeth or spaces spanned: mm}, the
    others {diameter of the pins or balls: mm}. A reading is a number, or a number and its own standard uncertainty; the others
    have `uncertainty` (mm), `angle_uncertainty` (degrees), and a lead 1 %. `helix_angle` is that on the reference circle, 0 for
    a gear seen to be a spur gear; `tip_helix_angle` is that on the tip circle, as a gear rolled over paper prints it; below 0
    for a left hand. Without any of them spur and helical gears are tried. The centre distance, and the mate's tips, are of the
    pair in which it runs.

    >>> found = identify(24, tip_diameter=52.02, root_diameter=43.01, span={3: 15.40, 4: 21.30}, helix_angle=0)
    >>> found.certain, found.best.gear.normal_module, found.best.gear.rack.pressure_angle
    (True, 2.0, 20.0)

    Raises ParameterError for readings that no gear can have, GeometryError where no gear comes near them.
    """
    require_whole("count", count, at_least=1, at_most=_MOST)
    single = {
        Gauge.TIP_DIAMETER: tip_diameter,
        Gauge.ROOT_DIAMETER: root_diameter,
        Gauge.HELIX_ANGLE: helix_angle,
        Gauge.TIP_HELIX_ANGLE: tip_helix_angle,
        Gauge.LEAD: lead,
        Gauge.CENTRE_DISTANCE: centre_distance,
        Gauge.MATE_TIP_DIAMETER: mate_tip_diameter,
    }
    sized: dict[Gauge, Mapping[int, Value] | Mapping[float, Value] | None] = {
        Gauge.SPAN: span,
        Gauge.OVER_PINS: over_pins,
        Gauge.OVER_BALLS: over_balls,
        Gauge.BETWEEN_PINS: between_pins,
        Gauge.BETWEEN_BALLS: between_balls,
    }

    def readings() -> Iterator[Reading]:
        for gauge, value in single.items():
            if value is not None:
                yield _reading(gauge, 0.0, value, uncertainty, angle_uncertainty)
        for gauge, values in sized.items():
            if values is not None and not isinstance(values, Mapping):
                raise ParameterError(gauge.value, values, "must be {teeth spanned, or diameter of pins or balls: reading}")
            for size, value in (values or {}).items():
                yield _reading(gauge, size, value, uncertainty, angle_uncertainty)

    return identify_gear(Measured(teeth=teeth, readings=tuple(readings()), mate_teeth=mate_teeth), count)


def _reading(gauge: Gauge, size: float, value: Value, length: float, angle: float) -> Reading:
    if isinstance(value, tuple):
        if len(value) != 2:
            raise ParameterError(gauge.value, value, "must be a number, or a number and its uncertainty")
        return Reading(gauge=gauge, value=value[0], uncertainty=value[1], size=size)
    usual = angle if gauge in ANGLES else _OF_LEAD * value if gauge is Gauge.LEAD and is_finite_number(value) else length
    return Reading(gauge=gauge, value=value, uncertainty=usual, size=size)
