"""CSV of the computed points: the outline of a tooth, the tool that cuts it, and the way of the tool's tip."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import require_number
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, Fillet, Involute, parameters_within
from gearcad.geometry.turned import TurnedCurve, middle_section
from gearcad.solids.files.tool_points import tool_points

__all__ = ["PointBlock", "gear_points", "write_points"]


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
    A ring with a form root has none.

    The parameter is the roll angle on the involute, the angle theta on the tool's tip on the trochoid and on the tool's
    outline, the roll angle of the gear along the tool's path, else the half angle.
    """
    require_number("chord_error", chord_error, "mm", above=0)
    return [*_tooth(gear, chord_error), *(PointBlock(*block) for block in tool_points(gear, chord_error))]


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
