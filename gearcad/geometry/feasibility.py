"""Can this gear exist? Each number by itself, and the tool that must cut it.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math

from gearcad.errors import GeometryError, ParameterError, require_name
from gearcad.geometry.basic_rack import BasicRack
from gearcad.geometry.body import Body
from gearcad.geometry.cutter import ShaperCutter
from gearcad.geometry.derived import is_given
from gearcad.geometry.diametral import derive_module
from gearcad.geometry.double_helix import DoubleHelix
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.limits import at_least, at_most
from gearcad.geometry.modification import FlankModification
from gearcad.geometry.shaping import check_shaper, tip_words
from gearcad.geometry.tooling import shaped
from gearcad.geometry.tooth_allowance import derive_thinning, require_allowance
from gearcad.schema import require_fields

__all__ = ["check_given", "check_tool"]

LEAST_HELIX = 1e-6
"""Smallest helix angle (degrees) of a helical gear; less moves a tooth by less than 2e-8 of the face width."""

MOST_TWIST = 720.0
"""Largest twist of a tooth over the face width (degrees) that one screw surface spans to the accuracy promised."""


def check_given(gear: GearData) -> None:
    """What can be said of it before its teeth: each field, the module and the thinning that follow, and the other numbers."""
    _check_fields(gear)
    derive_module(gear)
    derive_thinning(gear)
    _check_numbers(gear)


def _check_fields(gear: GearData) -> None:
    """Each field by itself."""
    require_name("name", gear.name)
    require_fields(gear)
    if 0 < abs(gear.helix_angle) < LEAST_HELIX:
        raise ParameterError("helix_angle", gear.helix_angle, f"must be 0 or at least {LEAST_HELIX:g} deg", "deg")
    if gear.tooth_allowance is not None:
        require_allowance(gear.tooth_allowance)
    parts: tuple[tuple[str, type], ...] = (
        ("rack", BasicRack),
        ("cutter", ShaperCutter),
        ("double_helix", DoubleHelix),
        ("body", Body),
        ("modification", FlankModification),
    )
    for part, kind in parts:
        if not isinstance(getattr(gear, part), kind):
            raise ParameterError(part, getattr(gear, part), f"must be a {kind.__name__}")


def _check_numbers(gear: GearData) -> None:
    """Circles that are given have the sign of the teeth; the width against module and lead."""
    for name in ("tip_diameter", "root_diameter"):
        if is_given(given := getattr(gear, name)) and given * gear.teeth <= 0:
            below = f"must be a number below 0 mm, as the teeth are (ISO 21771){f': write {-given:.10g}' if given else ''}"
            raise ParameterError(name, given, below if gear.internal else "must be a number above 0 mm", "mm")
    if gear.double_helix.present:
        _check_double_helix(gear)
    if gear.half_width < 0.01 * gear.normal_module:
        least = at_least(0.01 * gear.normal_module)
        raise GeometryError("face_width", gear.face_width, f"must be at least {least} mm (0.01 m_n)", "mm")
    if gear.twist > MOST_TWIST:
        most = MOST_TWIST / 360 * gear.lead
        if gear.double_helix.present:
            most = 2 * most + (gear.double_helix.gap_width or 0.0)
        permitted = f"must be at most {at_most(most)} mm ({MOST_TWIST:g} deg of twist)"
        raise GeometryError("face_width", gear.face_width, permitted, "mm")


def _check_double_helix(gear: GearData) -> None:
    """Two hands need a helix, and halves of some width beside the gap."""
    double = gear.double_helix
    if gear.internal:
        permitted = "must be left out on a ring: its halves are two rings, each with its own hand"
        raise GeometryError("double_helix.gap_width", double.gap_width, permitted, "mm")
    if gear.helix_angle == 0:
        raise GeometryError("helix_angle", 0.0, "must not be 0 deg on a double helical gear", "deg")
    least = 0.02 * gear.normal_module
    if gear.face_width - (double.gap_width or 0.0) < least:
        permitted = f"must be at most {at_most(max(gear.face_width - least, 0.0))} mm, to leave two halves of the face width"
        raise GeometryError("double_helix.gap_width", double.gap_width, permitted, "mm")


def check_tool(gear: GearData) -> None:
    """The tool must be able to exist: its tip radius fits between its flanks, and it leaves some tooth."""
    _check_thickness(gear)
    if gear.internal:
        _check_base_circle(gear)
    (check_shaper if shaped(gear) else _check_hob)(gear)


def _check_base_circle(gear: GearData) -> None:
    """The involutes of a ring begin on its base circle, which must be inside its tips."""
    if gear.tip_diameter >= gear.base_diameter:
        words = tip_words(gear, gear.base_diameter, "below")
        permitted = f"must be below {at_most(gear.base_diameter)} mm{words}, the base circle, where involutes begin"
        raise GeometryError("tip_diameter", gear.tip_diameter, permitted, "mm")


def _check_thickness(gear: GearData) -> None:
    """Some tooth on the reference circle, and some depth below it."""
    m, angle = gear.normal_module, gear.rack.pressure_angle
    least_shift = -math.pi / 4 / math.tan(math.radians(angle))
    if gear.profile_shift <= least_shift:
        khk = f" (KHK's sign: below {at_most(-least_shift)})" if gear.internal else ""
        permitted = f"must be above {at_least(least_shift)}{khk}: no tooth on the reference circle"
        raise GeometryError("profile_shift", gear.profile_shift, permitted)
    if (allowance := gear.thickness_allowance) and gear.normal_tooth_thickness <= allowance.tolerance / 2000:
        most = at_most(gear.normal_tooth_thickness + gear.tooth_thinning)
        permitted = f"must be less: it takes up to {-allowance.lower / 1000:g} mm off teeth that are {most} mm thick without it"
        raise GeometryError("tooth_allowance", gear.tooth_allowance, permitted)
    if gear.normal_tooth_thickness <= 0:
        raise GeometryError(
            "tooth_thinning",
            gear.tooth_thinning,
            f"must be below {at_most(gear.normal_tooth_thickness + gear.tooth_thinning)} mm, the normal tooth thickness",
            "mm",
        )
    if gear.dedendum <= 0:
        limit = gear.reference_diameter + 2 * m * gear.profile_shift
        raise GeometryError(
            "root_diameter", gear.root_diameter, f"must be below {at_most(limit)} mm (no tool depth left)", "mm"
        )


def _check_hob(gear: GearData) -> None:
    """The tip of a hob or rack: wide enough for its radius."""
    m, angle = gear.normal_module, gear.rack.pressure_angle
    thinning = f"thinning {gear.tooth_thinning:g} mm" if gear.tooth_thinning else "no thinning"
    terms = f"for dedendum {gear.dedendum:.6g}, pressure angle {angle:g} deg, {thinning}"
    full = gear.rack.full_root_radius(gear.dedendum, gear.tooth_thinning / m)
    if full < 0:
        most = (math.pi / 4 + gear.tooth_thinning / m / 2) / math.tan(math.radians(angle))
        if not is_given(gear.root_diameter):
            permitted = f"must be at most {at_most(most)}, where the tool's flanks meet"
            raise GeometryError("rack.dedendum", gear.rack.dedendum, permitted)
        least = at_least(gear.reference_diameter - 2 * m * (most - gear.profile_shift))
        raise GeometryError(
            "root_diameter", gear.root_diameter, f"must be at least {least} mm, where the tool's flanks meet", "mm"
        )
    if gear.rack.root_radius != "full" and float(gear.rack.root_radius) > full:
        raise GeometryError(
            "rack.root_radius", gear.rack.root_radius, f"must be at most {at_most(full, 4)} (full radius) {terms}"
        )
