"""Checks that a gear can exist: its numbers, the tool that must cut it, and trimming by a shaper cutter.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from gearcad.core.errors import GeometryError, ParameterError, at_least, at_most
from gearcad.core.quantities import is_given
from gearcad.core.records import Floats, Notice
from gearcad.geometry.fillets import ShaperTip
from gearcad.geometry.fits import derive_thinning, require_allowance
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.gear_parts import LEAST_FEATURE, Body, DoubleHelix, ShaperCutter, derive_module
from gearcad.geometry.gear_tools import (
    corner_radius,
    full_corner_radius,
    generating_involute,
    line_of_generation,
    precut_tip,
    shaped,
    shaper_tip,
    tool_pressure_angle,
)
from gearcad.geometry.interference import InternalTips, ToothTips
from gearcad.geometry.involute import inverse_involute, involute, tangent_length
from gearcad.geometry.modification import FlankModification
from gearcad.geometry.toothed import check_fields, check_root_radius, check_thickness, check_width, most_dedendum

if TYPE_CHECKING:
    from gearcad.geometry.profile import ToothProfile

_MOST_CUTTER_TEETH = 2000
"""Largest number of teeth of the cutters that are tried, to suggest one that works."""


def check_shaper(gear: GearData) -> None:
    """Raise GeometryError unless the cutter can make these teeth.

    The cutter must fit inside its ring, roll on it, reach its root, and generate its flanks up to the tips.
    """
    teeth, cutter = gear.root_cutter.teeth, gear.root_cutter
    if gear.internal and teeth is not None and teeth >= gear.tooth_count:
        permitted = f"must be at most {gear.tooth_count - 1}: the cutter works inside a ring of {gear.tooth_count} teeth"
        raise GeometryError("cutter.teeth", teeth, permitted)
    if teeth is not None:
        _check_shift(gear, teeth)
    full, least = full_corner_radius(gear), _least_radius(gear)
    if full < least:
        raise _cannot_reach(gear)
    if cutter.tip_radius is not None and cutter.tip_radius > full:
        permitted = f"must be at most {at_most(full, 4)} (full radius) {_terms(gear)}"
        raise GeometryError("cutter.tip_radius", cutter.tip_radius, permitted)
    if 0 < (radius := corner_radius(gear)) < least:
        permitted = f"must be 0 or at least {at_least(least)} ({LEAST_FEATURE} mm): it is the fillet of a form root"
        raise GeometryError("cutter.tip_radius", radius, permitted)
    if teeth is not None:
        _check_generated(gear, teeth)


def cutter_fits(gear: GearData) -> bool:
    """Return whether the gear's cutter can make these teeth, or the gear has no cutter."""
    try:
        check_shaper(gear)
    except GeometryError:
        return False
    return True


def _least_radius(gear: GearData) -> float:
    """Return the least radius of the corner, in normal modules, that leaves a visible fillet at a form root."""
    return 0.0 if gear.root_cutter.teeth else LEAST_FEATURE / gear.normal_module


def _terms(gear: GearData) -> str:
    """Return, in words, the condition under which the cutter's corner has room."""
    teeth = gear.root_cutter.teeth
    return "for a space of that depth" if teeth is None else f"for a cutter of {teeth} teeth that reaches the root circle"


def _check_shift(gear: GearData, teeth: int) -> None:
    """Raise GeometryError unless the cutter has teeth on its reference circle and meshes at some centre distance."""
    tangent = math.tan(math.radians(gear.rack.pressure_angle))
    least = -(math.pi / 2 + gear.tooth_thinning / gear.normal_module) / (2 * tangent)
    limit = -gear.profile_shift - involute(gear.transverse_pressure_angle) * (gear.teeth + teeth) / (2 * tangent)
    if gear.root_cutter.profile_shift <= least:
        permitted = f"must be above {at_least(least)}: no tooth of the cutter on its reference circle"
    elif generating_involute(gear, teeth) <= 0:
        side = f"below {at_most(limit)}" if gear.internal else f"above {at_least(limit)}"
        permitted = f"must be {side}: the cutter meshes with these teeth at no centre distance"
    else:
        return
    raise GeometryError("cutter.profile_shift", gear.root_cutter.profile_shift, permitted)


def _cannot_reach(gear: GearData) -> GeometryError:
    """Return the error for a root circle at which the cutter has no tip.

    The root circle is inside the cutter's base circle, or beyond where its flanks meet.
    """
    tip = shaper_tip(gear, 0.0)
    owner = "the flanks of the space" if gear.root_cutter.teeth is None else "the cutter's flanks"
    if shallow := tip.tip_radius <= tip.base_radius:
        radius, why = tip.base_radius, f"where {owner} begin"
    else:
        angle = math.radians(inverse_involute(max(tip.base_half_angle, 0.0)))
        # The corner of least radius needs some flat between the flanks.
        flat = 1.1 * _least_radius(gear) * gear.normal_module * (1 - math.sin(angle)) / max(math.sin(angle), 1e-3)
        radius, why = tip.base_radius / math.cos(angle) - flat, f"where {owner} meet"
    limit = -2 * (tip.centre_distance + radius) if gear.internal else 2 * (tip.centre_distance - radius)
    if is_given(gear.root_diameter):
        side = f"below {at_most(limit)}" if shallow else f"at least {at_least(limit)}"
        return GeometryError("root_diameter", gear.root_diameter, f"must be {side} mm, {why}", "mm")
    dedendum = (gear.reference_diameter - limit) / (2 * gear.normal_module) + gear.profile_shift
    if dedendum <= 0:
        return GeometryError("profile_shift", gear.profile_shift, f"must be smaller: no dedendum of the rack is left, {why}")
    side = f"above {at_least(dedendum)}" if shallow else f"at most {at_most(dedendum)}"
    return GeometryError("rack.dedendum", gear.rack.dedendum, f"must be {side}, {why}")


# ---------------------------------------------------------------------- up to the tips


def tip_words(gear: GearData, limit: float, side: str) -> str:
    """Return, in words, the rack's addendum that puts its tip on a circle (mm, signed).

    The text is empty if the tip does not follow from the addendum.
    """
    addendum = (limit - gear.reference_diameter) / (2 * gear.normal_module) - gear.profile_shift - gear.tip_alteration
    return "" if is_given(gear.tip_diameter) or addendum <= 0 else f" (rack.addendum {side} {at_most(addendum)})"


def _check_generated(gear: GearData, teeth: int) -> None:
    """Raise GeometryError unless the cutter generates the flanks up to the tips.

    The cutter's involute begins on its base circle: it touches no flank beyond the end of the line of action there.
    """
    if _generates(gear, teeth):
        return
    side = -1 if gear.internal else 1
    limit = side * 2 * math.hypot(gear.base_diameter / 2, line_of_generation(gear, teeth)) + 2 * gear.body.tip_chamfer
    others = range(teeth + 1, gear.tooth_count if gear.internal else _MOST_CUTTER_TEETH + 1)
    more = next((other for other in others if _generates(gear, other) and cutter_fits(_cut_by(gear, other))), None)
    hint = "" if more is None else f"; or cutter.teeth at least {more}"
    words = f"must be at most {at_most(limit)} mm{tip_words(gear, limit, 'at most')}"
    why = "the cutter's involute begins on its base circle and generates no flank beyond that"
    raise GeometryError("tip_diameter", gear.tip_diameter, f"{words}: {why}{hint}", "mm")


def _cut_by(gear: GearData, teeth: int) -> GearData:
    """Return the gear, unchecked, with another number of teeth of its cutter."""
    given = {each.name: getattr(gear, each.name) for each in fields(GearData)}
    if gear.premachining.present:
        return GearData(**given | {"premachining": replace(gear.premachining, cutter_teeth=teeth)})
    return GearData(**given | {"cutter": replace(gear.cutter, teeth=teeth)})


def _generates(gear: GearData, teeth: int) -> bool:
    """Return whether a cutter of so many teeth generates the flanks up to the tip form circle."""
    if generating_involute(gear, teeth) <= 0:
        return False
    length = abs(tangent_length(gear.tip_diameter - 2 * gear.body.tip_chamfer, gear.base_diameter))
    line = line_of_generation(gear, teeth)
    return length >= line if gear.internal else length <= line


_CORNER_POINTS = 9
"""Points of the cutter's corner that are looked at."""

_ROUNDING = 1e-6
"""Trimming, in normal modules, that counts as none."""


@dataclass(frozen=True)
class _CutterTips(ToothTips):
    """The rounded tips of a cutter: points of the corner from the end of its involute on."""

    @classmethod
    def rounded(cls, tip: ShaperTip, teeth: int, outside: float) -> _CutterTips:
        """Return the rounded tips of a cutter with `teeth` teeth, from its corner `tip`.

        `outside` (rad): by how much the corner stands out of the flanks that touch those of the ring, on the base circle.
        """
        along, across = tip.outline(np.linspace(tip.corner_end, 0.0, _CORNER_POINTS if tip.radius else 1))
        edges = zip(np.hypot(along, across).tolist(), np.arctan2(across, along).tolist(), strict=True)
        return cls(teeth, tip.base_radius, tip.base_half_angle - outside, tuple(edges))

    @cached_property
    def corner(self) -> tuple[Floats, Floats]:
        """Radius (mm) and half tooth angle (rad) of its points."""
        radius, angle = np.array(self.edges).T
        return radius, angle


def trimming_notices(gear: GearData, profile: ToothProfile) -> Iterator[Notice]:
    """Yield a notice if the cutter of a ring trims the ring's tips, as it rolls or as it is fed in. Yield nothing without a
    cutter.
    """
    teeth = gear.root_cutter.teeth
    if not gear.internal or teeth is None:
        return
    tips, least = _tips(gear, profile, teeth), -_ROUNDING * gear.normal_module
    rolling, way_in = tips.trochoid_margin, tips.radial_margin
    if rolling < least:
        hint = _fewer(gear, profile, lambda each: each.trochoid_margin)
        yield Notice("cutter-trims-tips", f"cutter: as it rolls it trims the tips of the ring by {-rolling:.3g} mm{hint}")
    elif way_in < least:
        hint = _fewer(gear, profile, lambda each: each.radial_margin)
        text = f"cutter: fed in radially it trims the tips of the ring by {-way_in:.3g} mm{hint}"
        yield Notice("cutter-trims-on-infeed", text)


def _tips(gear: GearData, profile: ToothProfile, teeth: int) -> InternalTips:
    """Return the tips of the cutter inside its ring, with `teeth` teeth of the cutter."""
    tip = shaper_tip(gear, corner_radius(gear))
    residual = gear.premachining.protuberance - gear.stock
    outside = residual / (tip.base_radius * math.cos(math.radians(gear.base_helix_angle)))
    return InternalTips(_CutterTips.rounded(tip, teeth, outside), ToothTips.of(profile), tip.centre_distance)


def _fewer(gear: GearData, profile: ToothProfile, margin: Callable[[InternalTips], float]) -> str:
    """Return, in words, the largest number of teeth of a cutter that would not trim."""
    for teeth in range((gear.root_cutter.teeth or 0) - 1, 2, -1):
        other = _cut_by(gear, teeth)
        if not cutter_fits(other):
            return ""
        if margin(_tips(other, profile, teeth)) >= 0:
            return f"; one of {teeth} teeth does not"
    return ""


MOST_TWIST = 720.0
"""Largest twist of a tooth over the face width (degrees) that one screw surface spans to the accuracy promised."""


def check_given(gear: GearData) -> None:
    """Check a gear before its teeth exist: each field alone, then the other numbers. Derives module and thinning in between."""
    _check_fields(gear)
    derive_module(gear)
    derive_thinning(gear)
    _check_numbers(gear)


def _check_fields(gear: GearData) -> None:
    """Raise ParameterError for a field that is not permitted by itself."""
    check_fields(gear)
    if gear.tooth_allowance is not None:
        require_allowance(gear.tooth_allowance)
    parts: tuple[tuple[str, type], ...] = (
        ("cutter", ShaperCutter),
        ("double_helix", DoubleHelix),
        ("body", Body),
        ("modification", FlankModification),
    )
    for part, kind in parts:
        if not isinstance(getattr(gear, part), kind):
            raise ParameterError(part, getattr(gear, part), f"must be a {kind.__name__}")


def _check_numbers(gear: GearData) -> None:
    """Raise ParameterError or GeometryError for numbers that do not fit together.

    Given circles must have the sign of the teeth, and the width must fit module and lead.
    """
    for name in ("tip_diameter", "root_diameter"):
        if is_given(given := getattr(gear, name)) and given * gear.teeth <= 0:
            below = f"must be a number below 0 mm, as the teeth are (ISO 21771){f': write {-given:.10g}' if given else ''}"
            raise ParameterError(name, given, below if gear.internal else "must be a number above 0 mm", "mm")
    if gear.double_helix.present:
        _check_double_helix(gear)
    check_width(gear, gear.half_width)
    if gear.twist > MOST_TWIST:
        most = MOST_TWIST / 360 * gear.lead
        if gear.double_helix.present:
            most = 2 * most + (gear.double_helix.gap_width or 0.0)
        permitted = f"must be at most {at_most(most)} mm ({MOST_TWIST:g} deg of twist)"
        raise GeometryError("face_width", gear.face_width, permitted, "mm")


def _check_double_helix(gear: GearData) -> None:
    """Raise GeometryError unless a double helical gear has a helix, external teeth, and halves of some width beside the gap."""
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
    """Raise GeometryError unless the tool can exist: its tip radius fits between its flanks, and it leaves some tooth."""
    _check_thickness(gear)
    if gear.internal:
        _check_base_circle(gear)
    if gear.premachining.present:
        _check_premachining(gear)
    else:
        (check_shaper if shaped(gear) else _check_hob)(gear)


_OF_PREMACHINING = {
    "rack.dedendum": "premachining.tool_addendum",
    "rack.root_radius": "premachining.tool_tip_radius",
    "cutter.teeth": "premachining.cutter_teeth",
    "cutter.profile_shift": "premachining.cutter_profile_shift",
    "cutter.tip_radius": "premachining.tool_tip_radius",
}
"""Keys of the tool that cuts before finishing, by those of a tool that makes all."""


def _check_premachining(gear: GearData) -> None:
    """Raise GeometryError unless the tool that cuts before finishing can exist, and is the only one of the root."""
    if gear.cutter.present:
        raise GeometryError("cutter.teeth", gear.cutter.teeth, "must be left out: premachining has the tool of the root")
    if is_given(gear.root_diameter):
        permitted = "must be left out: it follows from premachining.tool_addendum"
        raise GeometryError("root_diameter", gear.root_diameter, permitted, "mm")
    if gear.premachining.topping is not None:
        for name, given, unit in (
            ("tip_diameter", is_given(gear.tip_diameter), "mm"),
            ("tip_alteration", gear.tip_alteration != 0, ""),
        ):
            if given:
                permitted = "must be left out: the tips follow from premachining.topping"
                raise GeometryError(name, getattr(gear, name), permitted, unit)
    if gear.premachining.semi_topping.present and gear.body.tip_chamfer:
        permitted = "must be left out: the tips are chamfered by premachining.semi_topping"
        raise GeometryError("body.tip_chamfer", gear.body.tip_chamfer, permitted, "mm")
    thin = gear.transverse_pitch * gear.helix_cosine - gear.normal_tooth_thickness
    most = thin * math.cos(math.radians(gear.rack.pressure_angle)) / 2
    if gear.stock >= most:
        permitted = f"must be below {at_most(most)} mm: no space is left between the teeth that are cut before"
        raise GeometryError("premachining.stock", gear.stock, permitted, "mm")
    if gear.premachining.protuberance_angle is not None:
        angle = tool_pressure_angle(gear)
        if gear.premachining.protuberance_angle >= angle:
            permitted = f"must be below {angle:.6g} deg, the pressure angle of the tool"
            raise GeometryError("premachining.protuberance_angle", gear.premachining.protuberance_angle, permitted, "deg")
    if shaped(gear):
        try:
            check_shaper(gear)
        except GeometryError as error:
            name = _OF_PREMACHINING.get(error.parameter, error.parameter)
            raise GeometryError(name, error.value, error.permitted, error.unit) from None
        return
    _check_precut_hob(gear)


def _check_precut_hob(gear: GearData) -> None:
    """Raise GeometryError unless both roundings fit the tip of the hob that cuts before finishing."""
    tip = precut_tip(gear)
    if tip.u >= 0:
        return
    m, angle = gear.normal_module, tip.pressure_angle
    most = gear.root_radius + tip.u * math.cos(angle) / (1 - math.sin(angle)) / m
    if most > 0:
        permitted = f"must be at most {at_most(most, 4)} (full radius) for this addendum, protuberance and stock"
        raise GeometryError("premachining.tool_tip_radius", gear.root_radius, permitted)
    less = gear.tool_addendum + (tip.u - tip.radius * (math.tan(angle) - 1 / math.cos(angle))) / math.tan(angle) / m
    permitted = f"must be at most {at_most(less, 4)}, where the flanks of the tool meet"
    raise GeometryError("premachining.tool_addendum", gear.tool_addendum, permitted)


def _check_base_circle(gear: GearData) -> None:
    """Raise GeometryError unless the base circle of a ring, where its involutes begin, is inside its tips."""
    if gear.tip_diameter >= gear.base_diameter:
        words = tip_words(gear, gear.base_diameter, "below")
        permitted = f"must be below {at_most(gear.base_diameter)} mm{words}, the base circle, where involutes begin"
        raise GeometryError("tip_diameter", gear.tip_diameter, permitted, "mm")


def _check_thickness(gear: GearData) -> None:
    """Raise GeometryError unless some tooth is left on the reference circle, and some tool depth below it."""
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
    check_thickness(gear)
    if gear.dedendum <= 0:
        limit = gear.reference_diameter + 2 * m * gear.profile_shift
        raise GeometryError(
            "root_diameter", gear.root_diameter, f"must be below {at_most(limit)} mm (no tool depth left)", "mm"
        )


def _check_hob(gear: GearData) -> None:
    """Raise GeometryError unless the tip of a hob or rack is wide enough for its radius."""
    if (most := most_dedendum(gear)) is not None:
        if not is_given(gear.root_diameter):
            permitted = f"must be at most {at_most(most)}, where the tool's flanks meet"
            raise GeometryError("rack.dedendum", gear.rack.dedendum, permitted)
        least = at_least(gear.reference_diameter - 2 * gear.normal_module * (most - gear.profile_shift))
        raise GeometryError(
            "root_diameter", gear.root_diameter, f"must be at least {least} mm, where the tool's flanks meet", "mm"
        )
    check_root_radius(gear)
