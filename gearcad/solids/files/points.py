"""CSV of the computed points: the outline of a tooth, the tool that cuts it, and the way of the tool's tip."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.errors import require_number
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, Fillet, Involute, parameters_within
from gearcad.geometry.trochoid import ToolTip
from gearcad.geometry.turned import TurnedCurve, middle_section

__all__ = ["PointBlock", "gear_points", "write_points"]


_NO_FLAT = 1e-9
"""Half width (mm) below which the tip of a tool with a full radius has no flat but rounding."""

_HEADER = ("curve", "index", "parameter_deg", "radius_mm", "half_angle_deg", "x_mm", "y_mm")


class PointBlock(NamedTuple):
    """Points (n, 2) of one curve in mm, in the gear's transverse section, tooth 0 on +x, and a parameter in degrees (n,)."""

    curve: str
    parameter: Floats
    points: Floats


def write_points(gear: Gear, path: Path | str, *, chord_error: float = 0.0005) -> None:
    """Write the points of `gear_points` as CSV: curve, index, parameter (degrees), radius, half angle, x, y.

    The half angle (degrees) is counted from the middle of tooth 0, on +x. Raises ParameterError for a chord error (mm)
    that is not positive.
    """
    with Path(path).open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(_HEADER)
        for block in gear_points(gear, chord_error):
            x, y = block.points.T
            columns = (block.parameter, np.hypot(x, y), np.degrees(np.arctan2(y, x)), x, y)
            for index, row in enumerate(zip(*(column.tolist() for column in columns), strict=True)):
                writer.writerow([block.curve, index, *(f"{value:.12g}" for value in row)])


def gear_points(gear: Gear, chord_error: float = 0.0005) -> list[PointBlock]:
    """The left flank of tooth 0 from root to tip, then the tool; dense enough that chords stay within `chord_error` (mm).

    The flank is as modified at mid face width, where modifications along the face are nothing; the tool is the unmodified one.

    The parameter is the roll angle on the involute, the angle theta on the tool's tip on the trochoid and on the tool's
    outline, the roll angle of the gear along the tool's path, else the half angle.
    """
    require_number("chord_error", chord_error, "mm", above=0)
    tool = gear.profile.tool
    return [*_tooth(gear, chord_error), *(_tool(gear, tool, chord_error) if isinstance(tool, ToolTip) else ())]


def _tooth(gear: Gear, chord_error: float) -> Iterator[PointBlock]:
    for curve in middle_section(gear):
        s = parameters_within(curve, chord_error)
        yield PointBlock(_NAMES.get(curve.kind, curve.kind.value), np.degrees(_parameter(curve, s)), curve.points(s))


_NAMES = {CurveKind.ROOT: "root land", CurveKind.TIP: "tip land"}


def _parameter(curve: Curve, s: Floats) -> Floats:
    if isinstance(curve, TurnedCurve):
        curve = curve.curve
    if isinstance(curve, Involute):
        return curve.roll(s)
    if isinstance(curve, Fillet):
        return curve.theta(s)
    return curve.polar(s)[1]


# ---------------------------------------------------------------------- the tool


def _tool_in_gear(tool: ToolTip, teeth: int, xi: ArrayLike, eta: ArrayLike, roll: ArrayLike = 0.0) -> Floats:
    """Points (..., 2) in mm of the tool, seen from the gear turned by `roll` (rad) from where the tool is centred.

    The tool's tooth stands in the space between teeth 0 and 1. `xi` (mm) runs along the rolling line from the middle of
    the tool's tooth towards tooth 0, `eta` from that line outwards. The tool rolls along it without slip.
    """
    roll = np.asarray(roll, float)
    across, along = np.asarray(xi) + tool.reference_radius * roll, tool.reference_radius + np.asarray(eta)
    angle = math.pi / teeth + roll - np.arctan2(across, along)
    radius = np.hypot(across, along)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)


def _tool_outline(gear: Gear, tool: ToolTip, chord_error: float) -> tuple[Floats, Floats, Floats]:
    """Half of the tool's tooth in the transverse section, towards tooth 0: theta (rad), xi and eta (mm), each (n,).

    From the middle of its tip over the tip arc (an ellipse there) and along the straight flank to the tip circle's line.
    """
    theta = np.zeros(1)
    if tool.radius:
        # An ellipse is a stretched circle, and so is the chord's distance from it.
        share = chord_error * math.cos(tool.helix_angle) / tool.radius
        steps = math.ceil(tool.last_angle / (2 * math.acos(max(1 - share, 0.5))))
        theta = np.linspace(0.0, tool.last_angle, steps + 1)
    xi, eta = tool.outline(theta)
    top = (gear.tip_diameter - gear.reference_diameter) / 2
    slope = math.tan(math.radians(gear.transverse_pressure_angle))
    theta, xi, eta = np.r_[theta, theta[-1]], np.r_[xi, xi[-1] + (top - eta[-1]) * slope], np.r_[eta, top]
    if xi[0] < _NO_FLAT:
        return theta, np.r_[0.0, xi[1:]], eta
    return np.r_[0.0, theta], np.r_[0.0, xi], np.r_[eta[0], eta]


def _tool(gear: Gear, tool: ToolTip, chord_error: float) -> Iterator[PointBlock]:
    fillet = next(curve for curve in gear.profile.curves if isinstance(curve, Fillet))
    theta, xi, eta = _tool_outline(gear, tool, chord_error)
    whole = np.r_[-xi[:0:-1], xi], np.r_[eta[:0:-1], eta]
    yield PointBlock(
        "tool outline", np.degrees(np.r_[-theta[:0:-1], theta]), _tool_in_gear(tool, gear.teeth, whole[0], whole[1])
    )
    first, last = (float(tool.roll(angle)) for angle in (0.0, fillet.last))
    centre = tool.u / math.cos(tool.helix_angle), tool.v
    for name, (along, across) in (("tool path", centre), ("tool corner path", tool.outline(0.0))):

        def path(roll: Floats, along: float = along, across: float = across) -> Floats:
            return _tool_in_gear(tool, gear.teeth, along, across, roll)

        roll = _evenly_within(path, first, last, chord_error)
        yield PointBlock(name, np.degrees(roll), path(roll))


def _evenly_within(curve: Callable[[Floats], Floats], first: float, last: float, chord_error: float) -> Floats:
    """Evenly spaced parameters from `first` to `last` at which a polyline stays within `chord_error` (mm) of the curve."""
    fine = np.linspace(first, last, 257)
    bend = np.hypot(*np.diff(curve(fine), n=2, axis=0).T).max() * 256**2
    return np.linspace(first, last, max(1, math.ceil(math.sqrt(bend / (8 * chord_error)))) + 1)
