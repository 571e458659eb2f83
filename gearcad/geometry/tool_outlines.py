"""Gears as another tool would cut them, and how far such a root is from another. Lengths in mm, angles in radians."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from gearcad.core.errors import GeometryError
from gearcad.core.quantities import NOT_GIVEN
from gearcad.core.records import Floats
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.gear import Gear
from gearcad.geometry.gear_parts import ISO_54_I, ISO_54_II, ShaperCutter
from gearcad.geometry.premachining import Finishing, Premachining
from gearcad.geometry.profile import ToothProfile
from gearcad.geometry.tool_tables import ShelfTool

BASE_PITCH_SLACK = 1e-4
"""Share by which the base pitches of a hob with a short lead and of a gear may differ."""

_SAME_ANGLE = 1e-9
_PLACES = 241
"""Points of a curve, whose chords are within 1e-5 of the module of it."""

_NEAR = 3
"""Nearest points of a line whose chords are looked at."""

_NOTHING = 1e-300

_ROUNDER = 1.02
"""Factor of the least radius of a wheel's tip that reaches through the stock."""


def short_lead_module(tool: ShelfTool, gear: Gear) -> float | None:
    """Return the module m_0 (mm) of a hob that cuts a gear with more pressure angle: m_0 cos alpha_n0 = m_n cos alpha_n.

    None where its base pitch is another. A hob without a module of its own is there for the modules of ISO 54.
    """
    own, other = math.radians(tool.rack.pressure_angle), math.radians(gear.rack.pressure_angle)
    if gear.internal or tool.kind.startswith("cutter") or own >= other - _SAME_ANGLE or tool.premachining.tool_pressure_angle:
        return None
    module = gear.normal_module * math.cos(other) / math.cos(own)
    modules = (*ISO_54_I, *ISO_54_II) if tool.normal_module is None else (tool.normal_module,)
    near = min(modules, key=lambda each: abs(each - module))
    return float(near) if abs(near - module) <= BASE_PITCH_SLACK * module else None


def cuts(tool: ShelfTool, gear: Gear) -> bool:
    """Return whether a tool is of the module and the pressure angle of a gear, or cuts it with a short lead."""
    if gear.internal and not tool.kind.startswith("cutter"):
        return False
    if short_lead_module(tool, gear) is not None:
        return True
    return tool.fits(gear.normal_module) and abs(tool.rack.pressure_angle - gear.rack.pressure_angle) < _SAME_ANGLE


def with_tool(gear: Gear, tool: ShelfTool, end: float | None = None) -> Gear:
    """Return a gear as a tool of the shelf would cut it, with the tips that it has unless the tool cuts them.

    Where the tool leaves stock at the root and the gear names no end of its finished flank, the wheel ends at the diameter
    `end` (mm), or without one at the root form circle that the gear has. Raises GeometryError where the tool leaves none.
    """
    rack, pre = gear.rack, tool.premachining
    if not pre.present:
        rack = replace(rack, dedendum=tool.rack.dedendum, root_radius=tool.rack.root_radius)
    if (module := short_lead_module(tool, gear)) is not None:
        pre, rack = _short_lead(gear, tool, module), gear.rack
    plain = replace(
        gear,
        tool=None,
        rack=rack,
        cutter=tool.cutter if not pre.present else ShaperCutter(),
        premachining=Premachining(),
        finishing=Finishing(),
        root_diameter=NOT_GIVEN,
        tip_alteration=0.0,
        tip_diameter=float(gear.tip_diameter),
    )
    if not pre.present:
        return plain
    tip = NOT_GIVEN if pre.topping is not None else plain.tip_diameter
    return replace(plain, premachining=pre, finishing=_finishing(gear, pre, end), tip_diameter=tip)


def _finishing(gear: Gear, pre: Premachining, end: float | None) -> Finishing:
    """Return the finishing of a gear; where a tool leaves stock and the gear names no end, that given, or its form circle."""
    left = pre.stock_of(gear.normal_module) - pre.protuberance
    if left <= 0 and gear.premachining.present:
        return gear.finishing
    if left <= 0:
        return Finishing()
    wheel = gear.finishing
    least = _ROUNDER * left / (1 - math.sin(math.radians(gear.rack.pressure_angle)))
    radius = wheel.wheel_tip_radius
    if radius is None and least > 0.2 * gear.normal_module:
        radius = least
    given = wheel.end_diameter
    if given is None:
        given = float(gear.form_diameter) if end is None else end
    return replace(wheel, end_diameter=given, wheel_tip_radius=radius)


def _short_lead(gear: Gear, tool: ShelfTool, module: float) -> Premachining:
    """Return the keys of a hob with a short lead, set so deep that it leaves the thickness of the teeth.

    On the circle r_0 = r_b/cos alpha_t0 on which it rolls, its reference line is (s_n0 - pi m_0/2)/(2 tan alpha_n0) outside.
    The teeth are those without thinning, as for any tool.
    """
    angle = math.radians(tool.rack.pressure_angle)
    helix = math.asin(math.sin(math.radians(gear.base_helix_angle)) / math.cos(angle))
    transverse = math.atan(math.tan(angle) / math.cos(helix))
    rolling = gear.base_diameter / 2 / math.cos(transverse)
    own = math.radians(gear.transverse_pressure_angle)
    half = (math.pi / 2 + 2 * gear.profile_shift * math.tan(math.radians(gear.rack.pressure_angle))) / gear.teeth
    half += math.tan(own) - own - (math.tan(transverse) - transverse)
    outside = (2 * rolling * math.cos(helix) * half - math.pi * module / 2) / (2 * math.tan(angle))
    given, m = tool.premachining, gear.normal_module
    if not given.present and tool.rack.root_radius == "full":
        raise GeometryError("rack.root_radius", "full", "must be a number for a hob with a short lead")
    reach = (given.addendum_of(module) if given.present else tool.rack.dedendum) * module
    radius = given.tool_tip_radius if given.present else float(tool.rack.root_radius)
    assert radius is not None
    return replace(
        given,
        tool_addendum=(gear.reference_diameter / 2 + gear.profile_shift * m - (rolling + outside - reach)) / m,
        tool_tip_radius=radius * module / m,
        tool_pressure_angle=tool.rack.pressure_angle,
        stock=given.stock_of(module) if given.present else 0.0,
    )


def fillet_distance(one: ToothProfile, other: ToothProfile) -> float:
    """Return the greatest distance (mm, normal to the outlines) of the roots of two outlines of the same teeth.

    A root is all below the involute: root land and fillet of each, measured to the whole other outline.
    """
    first, second = _outline(one), _outline(other)
    return max(_farthest(_root(one), second), _farthest(_root(other), first))


def _outline(profile: ToothProfile) -> Floats:
    s = np.linspace(0.0, 1.0, _PLACES)
    return np.concatenate([curve.points(s) for curve in profile.curves])


def _root(profile: ToothProfile) -> Floats:
    s = np.linspace(0.0, 1.0, _PLACES)
    below = [curve.points(s) for curve in profile.curves if curve.kind in (CurveKind.ROOT, CurveKind.FILLET)]
    return np.concatenate(below) if below else np.array([profile.curves[0].points(0.0)])


def _farthest(points: Floats, line: Floats) -> float:
    """Return the greatest distance of points (n, 2) from a line of points (m, 2), whose chords are short."""
    from scipy.spatial import cKDTree

    _, near = cKDTree(line).query(points, k=_NEAR)
    starts = np.clip(np.concatenate([near - 1, near], axis=1), 0, len(line) - 2)
    first, step = line[starts], line[starts + 1] - line[starts]
    off = points[:, None, :] - first
    length = np.maximum(np.einsum("nij,nij->ni", step, step), _NOTHING)
    along = np.clip(np.einsum("nij,nij->ni", off, step) / length, 0.0, 1.0)
    off = off - along[:, :, None] * step
    return float(np.sqrt(np.einsum("nij,nij->ni", off, off).min(axis=1)).max())
