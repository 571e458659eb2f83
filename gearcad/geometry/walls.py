"""Does the body of a gear leave walls around its teeth, and between its holes?

Raises GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math

from gearcad.errors import GeometryError
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.limits import at_least, at_most

__all__ = ["check_body", "least_rim_diameter"]

LEAST_RIM = 0.1
"""Least wall between what is on a body - bore, keyway, hub, bolt holes, rim - and the root circle, in normal modules."""


def check_body(gear: GearData) -> None:
    """Bore, keyway and hub must leave a rim, the end chamfers some end face; a ring must fit in its rim."""
    (_check_ring if gear.internal else _check_disc)(gear)
    if gear.double_helix.gap_width:
        _check_gap(gear)


def _check_gap(gear: GearData) -> None:
    """What is between the halves of a double helical gear lies below the teeth and leaves a wall round bore and keyway."""
    wall = 2 * LEAST_RIM * gear.normal_module
    least, most = gear.body.opening_diameter + wall, gear.root_diameter - wall
    if not least <= gear.gap_diameter <= most:
        permitted = f"must be from {at_least(least)} to {at_most(most)} mm, between bore and root circle"
        raise GeometryError("double_helix.gap_diameter", gear.gap_diameter, permitted, "mm")


def least_rim_diameter(gear: GearData) -> float:
    """Least rim diameter (mm) of a ring: some wall outside its root circle."""
    return abs(gear.root_diameter) + 2 * LEAST_RIM * gear.normal_module


def _check_ring(gear: GearData) -> None:
    """What is outside the teeth of a ring."""
    body = gear.body
    for name in ("bore", "keyway_width", "hub_diameter"):
        if getattr(body, name):
            raise GeometryError(f"body.{name}", getattr(body, name), "must be left out: it is for external gears", "mm")
    root, least = abs(gear.root_diameter), least_rim_diameter(gear)
    if body.rim_diameter is not None and body.rim_diameter < least:
        permitted = f"must be at least {at_least(least)} mm (a rim of {LEAST_RIM} m_n outside the root circle {root:.6g} mm)"
        raise GeometryError("body.rim_diameter", body.rim_diameter, permitted, "mm")
    if body.bolt_holes:
        _check_bolt_circle(gear)
        _check_bolt_holes(gear)
    if body.end_chamfer:
        outside = math.inf if body.rim_diameter is None else body.rim_diameter
        free = body.bolt_circle - body.bolt_diameter if body.bolt_holes else outside
        _check_end_chamfer(gear, (free - 2 * LEAST_RIM * gear.normal_module - abs(gear.tip_diameter)) / 2)


def _check_bolt_circle(gear: GearData) -> None:
    """Bolt holes leave a wall outside the root circle and inside the rim."""
    body, wall = gear.body, 2 * LEAST_RIM * gear.normal_module
    inner = abs(gear.root_diameter) + wall + body.bolt_diameter
    outer = math.inf if body.rim_diameter is None else body.rim_diameter - wall - body.bolt_diameter
    walls = f"walls of {LEAST_RIM} m_n to the root circle {abs(gear.root_diameter):.6g} mm and to the rim"
    most = math.inf if body.rim_diameter is None else (body.rim_diameter - abs(gear.root_diameter)) / 2 - wall
    if body.bolt_diameter > most:
        room = "must be left out" if most <= 0 else f"must be at most {at_most(most)} mm"
        raise GeometryError("body.bolt_diameter", body.bolt_diameter, f"{room} ({walls})", "mm")
    if not inner <= body.bolt_circle <= outer:
        most_of_all = "" if math.isinf(outer) else f" and at most {at_most(outer)} mm"
        permitted = f"must be at least {at_least(inner)} mm{most_of_all} ({walls})"
        raise GeometryError("body.bolt_circle", body.bolt_circle, permitted, "mm")


def _check_bolt_holes(gear: GearData) -> None:
    """Bolt holes leave a wall between each other."""
    body = gear.body
    most = math.floor(math.pi / math.asin((body.bolt_diameter + LEAST_RIM * gear.normal_module) / body.bolt_circle))
    if body.bolt_holes > max(most, 1):
        permitted = f"must be at most {most}, to leave walls of {LEAST_RIM} m_n between holes of {body.bolt_diameter:.6g} mm"
        raise GeometryError("body.bolt_holes", body.bolt_holes, permitted)


def _check_disc(gear: GearData) -> None:
    """What is inside the teeth of an external gear."""
    for name in ("rim_diameter", "bolt_circle"):
        if getattr(gear.body, name):
            raise GeometryError(f"body.{name}", getattr(gear.body, name), "must be left out: it is for internal gears", "mm")
    body, wall = gear.body, LEAST_RIM * gear.normal_module
    root = gear.root_diameter - 2 * wall
    rim = f"a rim of {LEAST_RIM} m_n inside the root circle {gear.root_diameter:.6g} mm"
    for name, opening in (
        ("bore", body.bore),
        ("keyway_depth", body.opening_diameter),
        ("hub_diameter", body.hub_diameter),
    ):
        if opening > root:
            spare = f"must be at most {at_most(max(root, 0))} mm ({rim})"
            if name == "keyway_depth":
                spare = f"must leave {rim}: bore and keyway reach out to diameter {opening:.6g} mm"
            raise GeometryError(f"body.{name}", getattr(body, name), spare, "mm")
    if body.hub_diameter and body.opening_diameter > body.hub_diameter - 2 * wall:
        least = body.opening_diameter + 2 * wall
        raise GeometryError(
            "body.hub_diameter", body.hub_diameter, f"must be at least {at_least(least)} mm, to hold bore and keyway", "mm"
        )
    if body.rim_thickness > (deep := (gear.root_diameter - body.opening_diameter) / 2):
        permitted = f"must be at most {at_most(deep)} mm, what bore and keyway leave below the root circle"
        raise GeometryError("body.rim_thickness", body.rim_thickness, permitted, "mm")
    if body.end_chamfer:
        between = gear.gap_diameter if gear.double_helix.gap_width else 0.0
        least_face = max(body.opening_diameter, body.hub_diameter, between) + 2 * wall
        _check_end_chamfer(gear, (gear.tip_diameter - least_face) / 2)


def _check_end_chamfer(gear: GearData, deepest: float) -> None:
    """End chamfers reach no deeper than `deepest` (mm, along the radius from the tip circle)."""
    length = gear.body.end_chamfer
    slope = math.tan(math.radians(gear.body.end_chamfer_angle))
    most = min(0.49 * gear.half_width, deepest / slope)
    if length > most:
        raise GeometryError(
            "body.end_chamfer",
            length,
            f"must be at most {at_most(max(most, 0))} mm at {gear.body.end_chamfer_angle:g} deg"
            " (0.49 of the face width, and some end face left)",
            "mm",
        )
