"""Places of gears beside each other, and pictures (SVG) and tables of gears and pairs for notebooks."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from html import escape
from typing import NamedTuple

import numpy as np

from gearcad.core import symbols
from gearcad.core.quantities import symbols_of
from gearcad.core.records import Floats, PerGear, Role
from gearcad.geometry.gear_data import RING_RIM_LIMIT, GearData, outer_diameter, twist
from gearcad.geometry.profile import ToothProfile


class Pose(NamedTuple):
    """Place of the wheel beside a pinion that stands unturned at the origin, teeth from z = 0 to its face width.

    `rotation` of the wheel about its own axis (degrees, counter-clockwise seen from +z), then its shift along x (the
    centre distance) and along z (mm).
    """

    rotation: float
    x: float
    z: float


def wheel_pose(*, teeth: PerGear[int], centre_distance: float, z: float, turn: float) -> Pose:
    """Pose of a wheel that begins at height `z` (mm), where the pinion's section is turned by `turn` (degrees).

    A ring stands at minus x: like the pinion's, the teeth of it that mesh are on its side of +x.
    """
    facing = 0.0 if teeth.wheel > 0 and teeth.wheel % 2 else 180 / abs(teeth.wheel)
    return Pose(facing - turn / (teeth.wheel / teeth.pinion), centre_distance, z)


class RackPose(NamedTuple):
    """Place of a rack beside a pinion that stands at the origin, teeth from z = 0 to its face width.

    `rotation` of the rack about z (degrees: its tips then face the pinion), then its shift (mm) along x (the mounting
    distance), y (its travel, from where its own x = 0 is) and z.
    """

    rotation: float
    x: float
    y: float
    z: float


_PIXELS = 240
"""Length (pixels) of the longer side of a picture."""

CHORD_ERROR = 0.2
"""Pixels that a polygon may be off the outline."""

_OF_GEAR = "teeth normal_module helix_angle profile_shift face_width reference_diameter tip_diameter root_diameter".split()

_NO_RIM = f"no body.rim_diameter is given: drawn with {RING_RIM_LIMIT:g} m_n outside the root circle"

_FLAT = 'style="width:auto;border-collapse:collapse"'


def gear_html(gear: GearData, profile: ToothProfile) -> str:
    """Return a picture of the gear from +z, and a table."""
    written = symbols_of(GearData) | symbols.GEAR
    rows = ((written[name], [getattr(gear, name)]) for name in _looked_up(gear))
    return sheet(gear.name, _svg([_Placed(gear, profile, Pose(0.0, 0.0, 0.0))]), [], rows)


def pair_html(
    name: str,
    gears: PerGear[GearData],
    profiles: PerGear[ToothProfile],
    wheel: Pose,
    figures: Iterable[tuple[symbols.Symbol, float]],
) -> str:
    """Return a picture of the pair in mesh from +z, the wheel at its pose, and a table with figures of the pair."""
    written = symbols_of(GearData) | symbols.GEAR
    rows = [(written[key], [getattr(gear, key) for gear in gears]) for key in _looked_up(*gears)]
    rows += [(symbol, [value]) for symbol, value in figures]
    poses = PerGear(Pose(0.0, 0.0, 0.0), wheel)
    picture = _svg([_Placed(*each) for each in zip(gears, profiles, poses, strict=True)])
    return sheet(name, picture, [role.value for role in Role], rows)


def _looked_up(*gears: GearData) -> list[str]:
    """Return the figures of gears; of a ring the profile shift in the other sign too, as many know it."""
    ring = any(gear.internal for gear in gears)
    return [key for name in _OF_GEAR for key in ((name, "profile_shift_khk") if ring and name == "profile_shift" else (name,))]


class _Placed(NamedTuple):
    """A gear where a picture shows it."""

    gear: GearData
    profile: ToothProfile
    pose: Pose


def sheet(name: str, picture: str, headings: list[str], rows: Iterable[tuple[symbols.Symbol, list[float | None]]]) -> str:
    """Return a picture beside a table of figures, a column for each heading."""
    columns = len(headings) or 1
    head = "".join(f"<th>{escape(heading)}</th>" for heading in headings)
    lines = [f"<tr><th>{escape(name)}</th><th></th>{head}</tr>"]
    for symbol, values in rows:
        span = f' colspan="{columns}"' if len(values) < columns else ""
        cells = "".join(f"<td{span}>{_value_text(value, symbol.unit)}</td>" for value in values)
        lines.append(f"<tr><td>{escape(symbol.words)}</td><td>{escape(symbol.symbol)}</td>{cells}</tr>")
    table = f"<table cellpadding=3 {_FLAT}>{''.join(lines)}</table>"
    return f'<div style="display:flex;flex-wrap:wrap;gap:1em;align-items:center">{picture}{table}</div>'


def _value_text(value: float | None, unit: str) -> str:
    if value is None:
        return "-"
    # What is left of a difference is no figure; adding zero makes -0.0 a plain zero.
    return f"{round(value, 9) + 0.0:.6g}{' ' if unit else ''}{escape(unit)}"


def _svg(placed: list[_Placed]) -> str:
    """Sections of gears where they stand, the section of the first one at its z = 0, as seen from +z; in mm."""
    left = min(pose.x - _outside(gear) / 2 for gear, _, pose in placed)
    right = max(pose.x + _outside(gear) / 2 for gear, _, pose in placed)
    height = max(_outside(gear) for gear, _, _ in placed)

    def shapes(pixel: float) -> str:
        return "".join(shape for each in placed for shape in gear_shapes(*each, pixel))

    return drawing((left, -height / 2, right - left, height), shapes)


def drawing(view: tuple[float, float, float, float], shapes: Callable[[float], str]) -> str:
    """Return an SVG of what is in a view (left, top, width, height in mm, y down), whose shapes are drawn for the size of a
    pixel.
    """
    left, top, width, height = view
    scale = _PIXELS / max(width, height)
    box = f"{left:.6g} {top:.6g} {width:.6g} {height:.6g}"
    size = f'width="{width * scale:.0f}" height="{height * scale:.0f}"'
    style = f'fill="currentColor" fill-opacity=".15" stroke="currentColor" stroke-width="{1 / scale:.3g}"'
    drawn = shapes(1 / scale)
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="{box}" overflow="visible"><g {style}>{drawn}</g></svg>'


def _outside(gear: GearData) -> float:
    """Return the diameter (mm) of what surrounds a gear: its tip circle, or the rim of a ring, which is drawn somewhere if not
    given.
    """
    return outer_diameter(gear) if gear.internal else gear.tip_diameter


def gear_shapes(gear: GearData, profile: ToothProfile, pose: Pose, pixel: float) -> Iterator[str]:
    """Yield the outline with its bore or rim, and the reference circle; `pixel` is its size (mm)."""
    # Seen at the pinion's z = 0, a helical wheel that begins at another height is turned by then.
    turn = math.radians(pose.rotation) - twist(gear, pose.z)
    cosine, sine = math.cos(turn), math.sin(turn)
    turned = profile.contour(CHORD_ERROR * pixel) @ np.array([[cosine, sine], [-sine, cosine]])
    outline = polygon(turned + np.array([pose.x, 0.0]), pixel)
    rim = _circle(_outside(gear) / 2, pose.x)
    if not gear.internal:
        yield f'<path fill-rule="evenodd" d="{outline}{_circle(gear.body.bore / 2, pose.x)}"/>'
    elif gear.body.rim_diameter is not None:
        yield f'<path fill-rule="evenodd" d="{outline}{rim}{_bolt_holes(gear, pose.x, turn)}"/>'
    else:
        yield f'<path fill-rule="evenodd" stroke="none" d="{outline}{rim}"/><path fill="none" d="{outline}"/>'
        yield f'<path fill="none" stroke-dasharray="{2 * pixel:.3g}" d="{rim}"><title>{_NO_RIM}</title></path>'
    yield (
        f'<circle cx="{pose.x:.6g}" cy="0" r="{abs(gear.reference_diameter) / 2:.6g}" fill="none" stroke-opacity=".5"'
        f' stroke-dasharray="{8 * pixel:.3g} {2 * pixel:.3g} {pixel:.3g} {2 * pixel:.3g}"/>'
    )


def _bolt_holes(gear: GearData, x: float, turn: float) -> str:
    """Return the bolt holes of a ring, the first in the middle of tooth 0, as paths; y is down."""
    body = gear.body
    angles = turn + 2 * math.pi / max(body.bolt_holes, 1) * np.arange(body.bolt_holes)
    centres = zip(np.cos(angles).tolist(), np.sin(angles).tolist(), strict=True)
    half = body.bolt_circle / 2
    return "".join(_circle(body.bolt_diameter / 2, x + half * cosine, -half * sine) for cosine, sine in centres)


def polygon(points: Floats, pixel: float) -> str:
    """Return a closed path, to a tenth of a pixel; y is down in an SVG."""
    digits = max(0, 1 - math.floor(math.log10(pixel)))
    return "M" + " ".join(f"{x:.{digits}f},{-y:.{digits}f}" for x, y in points.tolist()) + "Z"


def _circle(radius: float, x: float, y: float = 0.0) -> str:
    """Return a path, empty for no radius; y is down."""
    arc = f"a{radius:.6g},{radius:.6g} 0 1 0"
    return f"M{x - radius:.6g},{y:.6g}{arc} {2 * radius:.6g},0{arc} {-2 * radius:.6g},0Z" if radius else ""
