"""What a notebook shows of a gear or a pair: a small picture, drawn from the ToothProfile, and the figures looked up first."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from html import escape
from typing import NamedTuple

import numpy as np

from gearcad import symbols
from gearcad.arrays import Floats
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.helix import twist
from gearcad.geometry.pose import Pose
from gearcad.geometry.profile import ToothProfile
from gearcad.per_gear import PerGear, Role
from gearcad.schema import symbols_of

__all__ = ["gear_html", "pair_html"]


_PIXELS = 240
"""Of the longer side."""

_CHORD_ERROR = 0.2
"""Pixels that a polygon may be off the outline."""

_OF_GEAR = "teeth normal_module helix_angle profile_shift face_width reference_diameter tip_diameter root_diameter".split()

_FLAT = 'style="width:auto;border-collapse:collapse"'


def gear_html(gear: GearData, profile: ToothProfile) -> str:
    """A picture of the gear from +z, and a table."""
    written = symbols_of(GearData) | symbols.GEAR
    rows = ((written[name], [getattr(gear, name)]) for name in _OF_GEAR)
    return _html(gear.name, _svg([_Placed(gear, profile, Pose(0.0, 0.0, 0.0))]), [], rows)


def pair_html(
    name: str,
    gears: PerGear[GearData],
    profiles: PerGear[ToothProfile],
    wheel: Pose,
    figures: Iterable[tuple[symbols.Symbol, float]],
) -> str:
    """A picture of the pair in mesh from +z, the wheel at its pose, and a table with figures of the pair."""
    written = symbols_of(GearData) | symbols.GEAR
    rows = [(written[key], [getattr(gear, key) for gear in gears]) for key in _OF_GEAR]
    rows += [(symbol, [value]) for symbol, value in figures]
    poses = PerGear(Pose(0.0, 0.0, 0.0), wheel)
    picture = _svg([_Placed(*each) for each in zip(gears, profiles, poses, strict=True)])
    return _html(name, picture, [role.value for role in Role], rows)


class _Placed(NamedTuple):
    """A gear where a picture shows it."""

    gear: GearData
    profile: ToothProfile
    pose: Pose


def _html(name: str, picture: str, headings: list[str], rows: Iterable[tuple[symbols.Symbol, list[float]]]) -> str:
    columns = len(headings) or 1
    head = "".join(f"<th>{escape(heading)}</th>" for heading in headings)
    lines = [f"<tr><th>{escape(name)}</th><th></th>{head}</tr>"]
    for symbol, values in rows:
        span = f' colspan="{columns}"' if len(values) < columns else ""
        cells = "".join(f"<td{span}>{_shown(value, symbol.unit)}</td>" for value in values)
        lines.append(f"<tr><td>{escape(symbol.words)}</td><td>{escape(symbol.symbol)}</td>{cells}</tr>")
    table = f"<table cellpadding=3 {_FLAT}>{''.join(lines)}</table>"
    return f'<div style="display:flex;flex-wrap:wrap;gap:1em;align-items:center">{picture}{table}</div>'


def _shown(value: float, unit: str) -> str:
    # What is left of a difference is no figure; adding zero makes -0.0 a plain zero.
    return f"{round(value, 9) + 0.0:.6g}{' ' if unit else ''}{escape(unit)}"


def _svg(placed: list[_Placed]) -> str:
    """Sections of gears where they stand, the section of the first one at its z = 0, as seen from +z; in mm."""
    left = min(pose.x - gear.tip_diameter / 2 for gear, _, pose in placed)
    right = max(pose.x + gear.tip_diameter / 2 for gear, _, pose in placed)
    height = max(gear.tip_diameter for gear, _, _ in placed)
    scale = _PIXELS / max(right - left, height)
    shapes = "".join(shape for each in placed for shape in _shapes(each, 1 / scale))
    view = f"{left:.6g} {-height / 2:.6g} {right - left:.6g} {height:.6g}"
    size = f'width="{(right - left) * scale:.0f}" height="{height * scale:.0f}"'
    style = f'fill="currentColor" fill-opacity=".15" stroke="currentColor" stroke-width="{1 / scale:.3g}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="{view}" overflow="visible"><g {style}>{shapes}</g></svg>'


def _shapes(placed: _Placed, pixel: float) -> Iterator[str]:
    """The outline with its bore, and the reference circle; `pixel` is its size (mm)."""
    gear, profile, pose = placed
    # Seen at the pinion's z = 0, a helical wheel that begins at another height is turned by then.
    turn = math.radians(pose.rotation) - twist(gear, pose.z)
    cosine, sine = math.cos(turn), math.sin(turn)
    turned = profile.contour(_CHORD_ERROR * pixel) @ np.array([[cosine, sine], [-sine, cosine]])
    outline = _polygon(turned + np.array([pose.x, 0.0]), pixel)
    yield f'<path fill-rule="evenodd" d="{outline}{_circle(gear.body.bore / 2, pose.x)}"/>'
    yield (
        f'<circle cx="{pose.x:.6g}" cy="0" r="{gear.reference_diameter / 2:.6g}" fill="none" stroke-opacity=".5"'
        f' stroke-dasharray="{8 * pixel:.3g} {2 * pixel:.3g} {pixel:.3g} {2 * pixel:.3g}"/>'
    )


def _polygon(points: Floats, pixel: float) -> str:
    """A closed path, to a tenth of a pixel; y is down in an SVG."""
    digits = max(0, 1 - math.floor(math.log10(pixel)))
    return "M" + " ".join(f"{x:.{digits}f},{-y:.{digits}f}" for x, y in points.tolist()) + "Z"


def _circle(radius: float, x: float) -> str:
    """A path, empty for no radius."""
    arc = f"a{radius:.6g},{radius:.6g} 0 1 0"
    return f"M{x - radius:.6g},0{arc} {2 * radius:.6g},0{arc} {-2 * radius:.6g},0Z" if radius else ""
