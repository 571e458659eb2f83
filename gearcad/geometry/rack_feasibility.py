"""Can this rack exist? Each number by itself, its length, and teeth between back and tips.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math

from gearcad.errors import GeometryError, ParameterError, require_name
from gearcad.geometry.basic_rack import BasicRack
from gearcad.geometry.body import LEAST_FEATURE
from gearcad.geometry.derived import is_given
from gearcad.geometry.feasibility import LEAST_HELIX
from gearcad.geometry.limits import at_least, at_most
from gearcad.geometry.profile import LEAST_LAND
from gearcad.geometry.rack_data import RackData
from gearcad.geometry.walls import LEAST_RIM
from gearcad.schema import require_fields

__all__ = ["check_rack_fields", "check_rack_length", "check_rack_numbers", "check_rack_teeth"]

MOST_PITCHES = 2000
"""As many as a rack may have teeth."""


def check_rack_fields(rack: RackData) -> None:
    """Each field by itself."""
    require_name("name", rack.name)
    require_fields(rack)


def check_rack_numbers(rack: RackData) -> None:
    """Numbers as the module is known, and either teeth or a length."""
    if 0 < abs(rack.helix_angle) < LEAST_HELIX:
        raise ParameterError("helix_angle", rack.helix_angle, f"must be 0 or at least {LEAST_HELIX:g} deg", "deg")
    if not isinstance(rack.rack, BasicRack):
        raise ParameterError("rack", rack.rack, "must be a BasicRack")
    if 0 < rack.tip_chamfer < LEAST_FEATURE:
        raise ParameterError("tip_chamfer", rack.tip_chamfer, f"must be 0 or at least {LEAST_FEATURE} mm", "mm")
    if not is_given(rack.teeth) and not is_given(rack.length):
        raise ParameterError("teeth", None, "must be a whole number from 1 to 2000, or give the length in mm")
    if is_given(rack.teeth) and is_given(rack.length):
        long = f"{rack.teeth} teeth are {(rack.teeth or 0) * rack.transverse_pitch:.6f} mm long"
        raise GeometryError("length", rack.length, f"must be left out where teeth are given: {long}", "mm")
    if rack.face_width < 0.01 * rack.normal_module:
        least = at_least(0.01 * rack.normal_module)
        raise GeometryError("face_width", rack.face_width, f"must be at least {least} mm (0.01 m_n)", "mm")


def check_rack_length(rack: RackData) -> None:
    """A given length holds a pitch, and not too many."""
    pitch = rack.transverse_pitch
    if not 1 <= rack.whole_pitches <= MOST_PITCHES:
        permitted = f"must be from {at_least(pitch)} to {at_most(MOST_PITCHES * pitch)} mm (1 to {MOST_PITCHES} pitches)"
        raise GeometryError("length", rack.length, permitted, "mm")


def check_rack_teeth(rack: RackData) -> None:
    """Some tooth on the reference line, a fillet that fits the space, some flank, some tip land, and a back below the roots."""
    if rack.normal_tooth_thickness <= 0:
        most = at_most(rack.normal_tooth_thickness + rack.tooth_thinning)
        raise GeometryError("tooth_thinning", rack.tooth_thinning, f"must be below {most} mm, the normal tooth thickness", "mm")
    _check_space(rack)
    _check_flank(rack)
    if rack.tip_chamfer:
        _check_chamfer(rack)
    least = rack.root_depth + LEAST_RIM * rack.normal_module
    if rack.height < least:
        permitted = f"must be at least {at_least(least)} mm ({LEAST_RIM} m_n below the roots, {rack.root_depth:.6g} mm deep)"
        raise GeometryError("height", rack.height, permitted, "mm")


def _check_space(rack: RackData) -> None:
    m, angle = rack.normal_module, rack.rack.pressure_angle
    full = rack.rack.full_root_radius(thinning=rack.tooth_thinning / m)
    if full < 0:
        most = (math.pi / 4 + rack.tooth_thinning / m / 2) / math.tan(math.radians(angle))
        permitted = f"must be at most {at_most(most)}, where the flanks of a space meet"
        raise GeometryError("rack.dedendum", rack.rack.dedendum, permitted)
    if rack.rack.root_radius != "full" and float(rack.rack.root_radius) > full:
        thinning = f"thinning {rack.tooth_thinning:g} mm" if rack.tooth_thinning else "no thinning"
        terms = f"for dedendum {rack.rack.dedendum:.6g}, pressure angle {angle:g} deg, {thinning}"
        permitted = f"must be at most {at_most(full, 4)} (full radius) {terms}"
        raise GeometryError("rack.root_radius", rack.rack.root_radius, permitted)


def _check_flank(rack: RackData) -> None:
    """The tip above the form line, and some land on it."""
    m, tangent = rack.normal_module, math.tan(math.radians(rack.rack.pressure_angle))
    if rack.tip_height <= -rack.form_depth:
        least = at_least(-rack.form_depth / m - rack.rack.addendum)
        raise GeometryError("tip_alteration", rack.tip_alteration, f"must be above {least}: no flank is left above the fillet")
    if rack.tip_thickness < LEAST_LAND:
        highest = (rack.normal_tooth_thickness - LEAST_LAND) / 2 / tangent
        permitted = f"must be at most {at_most(highest / m - rack.rack.addendum)} (pointed tooth)"
        raise GeometryError("tip_alteration", rack.tip_alteration, permitted)


def _check_chamfer(rack: RackData) -> None:
    """It takes material off, and leaves some flank and some land."""
    slope = math.tan(math.radians(rack.transverse_pressure_angle))
    if slope >= 1:
        permitted = "must be 0 mm: the flank leans in by more than the chamfer's 45 deg"
        raise GeometryError("tip_chamfer", rack.tip_chamfer, permitted, "mm")
    land = rack.tip_thickness / math.cos(math.radians(rack.helix_angle))
    most = min((land - LEAST_LAND) / 2 / (1 - slope), rack.tip_height + rack.form_depth)
    if rack.tip_chamfer >= most:
        permitted = f"must be below {at_most(most)} mm: some flank and some tip land are left"
        raise GeometryError("tip_chamfer", rack.tip_chamfer, permitted, "mm")
