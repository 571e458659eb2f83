"""Identify: the gears that readings may be of, and the spec of one."""

from __future__ import annotations

from collections.abc import Mapping

from gearcad.errors import require_whole
from gearcad.identify.identification import Identification
from gearcad.identify.measurements import Measurements, Value
from gearcad.identify.run import identify_gear

__all__ = ["identify", "identify_measured"]

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
    chordal_thickness: Mapping[float, Value] | None = None,
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

    `teeth` are negative for a ring, whose diameters are positive as they are read. `span` is {teeth or spaces spanned: mm},
    `chordal_thickness` {height below the tip: mm}, the others {diameter of the pins or balls: mm}. A reading is a number, or a
    number and its own standard uncertainty; the others have `uncertainty` (mm), `angle_uncertainty` (degrees), and a lead 1 %.
    `helix_angle` is that on the reference circle, 0 for a gear seen to be a spur gear; `tip_helix_angle` is that on the tip
    circle, as a gear rolled over paper prints it; below 0 for a left hand. Without any of them both are tried. The
    centre distance, and the mate's tips, are of the pair in which it runs.

    >>> found = identify(24, tip_diameter=52.02, root_diameter=43.01, span={3: 15.40, 4: 21.30}, helix_angle=0)
    >>> found.certain, found.best.gear.normal_module, found.best.gear.rack.pressure_angle
    (True, 2.0, 20.0)

    Raises ParameterError for readings that no gear can have, GeometryError where no gear comes near them.
    """
    measurements = Measurements(
        teeth=teeth,
        tip_diameter=tip_diameter,
        root_diameter=root_diameter,
        span=span,
        over_pins=over_pins,
        over_balls=over_balls,
        between_pins=between_pins,
        between_balls=between_balls,
        chordal_thickness=chordal_thickness,
        helix_angle=helix_angle,
        tip_helix_angle=tip_helix_angle,
        lead=lead,
        centre_distance=centre_distance,
        mate_teeth=mate_teeth,
        mate_tip_diameter=mate_tip_diameter,
        uncertainty=uncertainty,
        angle_uncertainty=angle_uncertainty,
    )
    return identify_measured(measurements, count)


def identify_measured(measurements: Measurements, count: int = 10) -> Identification:
    """The same of what a file says, as `read_measurements` has it."""
    require_whole("count", count, at_least=1, at_most=_MOST)
    return identify_gear(measurements.measured, count)
