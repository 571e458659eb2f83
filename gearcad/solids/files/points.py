"""CSV of computed points: the outline of a tooth, the tool that cuts it, and the path of the tool's tip.

The tool's tooth stands in the space between teeth 0 and 1, towards which `along` runs; `across` runs from the middle of the
tool's tooth towards tooth 0. Angles are radians in here.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import require_number
from gearcad.core.records import Floats
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, Fillet, Involute, Land, parameters_within
from gearcad.geometry.fillets import ShaperTip, ToolTip
from gearcad.geometry.gear import TurnedCurve, middle_section
from gearcad.geometry.rack import Rack

_NO_FLAT = 1e-9
"""Half width (mm) below which the tip of a tool with a full radius has no flat but rounding."""


def tool_points(gear: Gear, chord_error: float) -> Iterator[tuple[str, Floats, Floats]]:
    """Yield the outline of the tool's tooth, and the paths of the middle of its tip's rounding and of where that begins.

    Name, parameter in degrees (n,) and points (n, 2) in mm of each; nothing where no tool rolls. The parameter is theta on
    the outline, the roll angle of the gear on the paths.
    """
    tool = _rolling(gear)
    if tool is None:
        return
    fillet = next(curve for curve in gear.profile.curves if isinstance(curve, Fillet))
    theta, across, along = tool.outline(gear, chord_error)
    whole = np.r_[-across[:0:-1], across], np.r_[along[:0:-1], along]
    yield "tool outline", np.degrees(np.r_[-theta[:0:-1], theta]), tool.seen(*whole, 0.0)
    first, last = (tool.roll(angle) for angle in (0.0, fillet.last))
    for name, point in (("tool path", tool.centre), ("tool corner path", tool.corner)):

        def path(roll: Floats, point: tuple[float, float] = point) -> Floats:
            return tool.seen(*point, roll)

        roll = _evenly_within(path, first, last, chord_error)
        yield name, np.degrees(roll), path(roll)


class _Rolling(Protocol):
    """A tool that rolls with the gear."""

    @property
    def centre(self) -> tuple[float, float]:
        """Middle of the tip's rounding: across and along (mm)."""

    @property
    def corner(self) -> tuple[float, float]:
        """Point where the tip's rounding begins: across and along (mm)."""

    def outline(self, gear: Gear, chord_error: float) -> tuple[Floats, Floats, Floats]:
        """Return half of the tool's tooth in the transverse section, towards tooth 0: theta, across and along (mm), each (n,).

        From the middle of its tip over the rounding (an ellipse there) and along the flank to the gear's tip circle.
        """

    def roll(self, theta: float) -> float:
        """Return the roll angle of the gear where theta cuts."""

    def seen(self, across: ArrayLike, along: ArrayLike, roll: ArrayLike) -> Floats:
        """Return the points (..., 2) in mm of the tool, seen from the gear turned by `roll` from where the tool is centred."""


def _rolling(gear: Gear) -> _Rolling | None:
    tool = gear.profile.tool
    if isinstance(tool, ToolTip):
        return _Hob(tool, gear.teeth)
    return _Shaper(tool, gear.tooth_count) if isinstance(tool, ShaperTip) and tool.rolls else None


def _rounding(radius: float, helix_angle: float, last: float, chord_error: float) -> Floats:
    """theta of the points on the rounding of a tip."""
    if not radius:
        return np.zeros(1)
    # An ellipse is a stretched circle, and so is the chord's distance from it.
    share = chord_error * math.cos(helix_angle) / radius
    steps = math.ceil(last / (2 * math.acos(max(1 - share, 0.5))))
    return np.linspace(0.0, last, steps + 1)


@dataclass(frozen=True)
class _Hob:
    """A hob or rack: `along` is from the rolling line outwards."""

    tool: ToolTip
    teeth: int

    @property
    def centre(self) -> tuple[float, float]:
        return self.tool.u / math.cos(self.tool.helix_angle), self.tool.v

    @property
    def corner(self) -> tuple[float, float]:
        return self.tool.outline(0.0)

    def roll(self, theta: float) -> float:
        return float(self.tool.roll(theta))

    def seen(self, across: ArrayLike, along: ArrayLike, roll: ArrayLike) -> Floats:
        """Return points (n, 2) of the tool in the frame of the gear; the tool rolls on its line without slip."""
        roll, reference = np.asarray(roll, float), self.tool.reference_radius
        xi, radial = np.asarray(across) + reference * roll, reference + np.asarray(along)
        return _cartesian(np.hypot(xi, radial), math.pi / self.teeth + roll - np.arctan2(xi, radial))

    def outline(self, gear: Gear, chord_error: float) -> tuple[Floats, Floats, Floats]:
        tool = self.tool
        theta = _rounding(tool.radius, tool.helix_angle, tool.last_angle, chord_error)
        xi, eta = tool.outline(theta)
        top = (gear.tip_diameter - gear.reference_diameter) / 2
        slope = math.tan(math.radians(gear.transverse_pressure_angle))
        theta, xi, eta = np.r_[theta, theta[-1]], np.r_[xi, xi[-1] + (top - eta[-1]) * slope], np.r_[eta, top]
        if xi[0] < _NO_FLAT:
            return theta, np.r_[0.0, xi[1:]], eta
        return np.r_[0.0, theta], np.r_[0.0, xi], np.r_[eta[0], eta]


@dataclass(frozen=True)
class _Shaper:
    """A shaper cutter: `along` is from its axis."""

    tool: ShaperTip
    teeth: int

    @property
    def centre(self) -> tuple[float, float]:
        radius, angle = self.tool.tip_radius - self.tool.radius, self.tool.middle_angle
        return radius * math.sin(angle), radius * math.cos(angle)

    @property
    def corner(self) -> tuple[float, float]:
        along, across = self.tool.outline(0.0)
        return float(across), float(along)

    def roll(self, theta: float) -> float:
        return float(self.tool.turn(theta)) * self.tool.share

    def seen(self, across: ArrayLike, along: ArrayLike, roll: ArrayLike) -> Floats:
        radius, angle = self.tool.seen(along, across, np.asarray(roll, float) / self.tool.share)
        return _cartesian(radius, math.pi / self.teeth - angle)

    def outline(self, gear: Gear, chord_error: float) -> tuple[Floats, Floats, Floats]:
        """The flank ends on the cutter's base circle where that comes before the gear's tip circle."""
        tool = self.tool
        tip = Land(CurveKind.TIP, tool.tip_radius, 0.0, tool.middle_angle)
        theta = _rounding(tool.radius, tool.helix_angle, tool.last_angle, chord_error)
        end = abs(gear.profile.tip_diameter / 2 - tool.centre_distance)
        rolls = tool.join_length / tool.base_radius, math.sqrt(max((end / tool.base_radius) ** 2 - 1, 0.0))
        flank = Involute(tool.base_radius, tool.base_half_angle, *rolls)
        flat = tip.points(parameters_within(tip, chord_error))[:-1]
        side = flank.points(parameters_within(flank, chord_error))[1:]
        if self.corner[0] < _NO_FLAT:
            flat = flat[:0]
        along, across = np.concatenate([flat, np.stack(tool.outline(theta), -1), side]).T
        across[0] = 0.0
        return np.r_[np.zeros(len(flat)), theta, np.full(len(side), theta[-1])], across, along


def _cartesian(radius: Floats, angle: Floats) -> Floats:
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)


def _evenly_within(curve: Callable[[Floats], Floats], first: float, last: float, chord_error: float) -> Floats:
    """Evenly spaced parameters from `first` to `last` at which a polyline stays within `chord_error` (mm) of the curve."""
    fine = np.linspace(first, last, 257)
    bend = np.hypot(*np.diff(curve(fine), n=2, axis=0).T).max() * 256**2
    return np.linspace(first, last, max(1, math.ceil(math.sqrt(bend / (8 * chord_error)))) + 1)


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
    """Return the left flank of tooth 0 from root to tip, then the tool; dense enough that chords stay within `chord_error`
    (mm).

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


_RACK_POINTS_HEADER = ("curve", "index", "direction_deg", "x_mm", "y_mm")


def write_rack_points(rack: Rack, path: Path | str, *, chord_error: float = 0.0005) -> None:
    """Write the left half of a tooth from the middle of the space to that of the tooth, in the transverse section, as CSV.

    Curve, index, direction of travel (degrees from +x), x and y; the tooth is centred on x = 0, y counts from the reference
    line. Chords stay within `chord_error` (mm). Raises ParameterError for one that is not positive.
    """
    require_number("chord_error", chord_error, "mm", above=0)
    with Path(path).open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(_RACK_POINTS_HEADER)
        for curve in rack.profile.curves:
            s = parameters_within(curve, chord_error)
            rows = np.column_stack([np.degrees(curve.direction(s)), curve.points(s)])
            for index, row in enumerate(rows.tolist()):
                writer.writerow([curve.kind.value, index, *(f"{value:.12g}" for value in row)])
