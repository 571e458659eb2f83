"""Gear: one cylindrical gear, external or internal, with all that follows from its inputs (ISO 21771)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property
from html import escape
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike

from gearcad.core import symbols
from gearcad.core.errors import GeometryError, InputError, format_number
from gearcad.core.quantities import derive, symbols_of
from gearcad.core.records import Floats, JsonObject, Notice, PerGear, Role, concise
from gearcad.geometry.curves import Curve, CurveKind, Fillet, Involute, Land
from gearcad.geometry.feasibility import check_given, check_tool, trimming_notices
from gearcad.geometry.gear_data import (
    RING_RIM_LIMIT,
    GearData,
    check_body,
    corner_notices,
    fillet_tool,
    outer_diameter,
    shaper_tip,
    twist,
)
from gearcad.geometry.gear_parts import DoubleHelix
from gearcad.geometry.inspection import Inspection, ThicknessLimits, inspection_of
from gearcad.geometry.modification import FlankForm, check_flanks
from gearcad.geometry.profile import LEAST_LAND, InternalProfile, ToothProfile
from gearcad.geometry.toothed import tip_notices


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
    """A picture of the gear from +z, and a table."""
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
    """A picture of the pair in mesh from +z, the wheel at its pose, and a table with figures of the pair."""
    written = symbols_of(GearData) | symbols.GEAR
    rows = [(written[key], [getattr(gear, key) for gear in gears]) for key in _looked_up(*gears)]
    rows += [(symbol, [value]) for symbol, value in figures]
    poses = PerGear(Pose(0.0, 0.0, 0.0), wheel)
    picture = _svg([_Placed(*each) for each in zip(gears, profiles, poses, strict=True)])
    return sheet(name, picture, [role.value for role in Role], rows)


def _looked_up(*gears: GearData) -> list[str]:
    """The figures of gears; of a ring the profile shift in the other sign too, as many know it."""
    ring = any(gear.internal for gear in gears)
    return [key for name in _OF_GEAR for key in ((name, "profile_shift_khk") if ring and name == "profile_shift" else (name,))]


class _Placed(NamedTuple):
    """A gear where a picture shows it."""

    gear: GearData
    profile: ToothProfile
    pose: Pose


def sheet(name: str, picture: str, headings: list[str], rows: Iterable[tuple[symbols.Symbol, list[float | None]]]) -> str:
    """A picture beside a table of figures, a column for each heading."""
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
    """An SVG of what is in a view (left, top, width, height in mm, y down), whose shapes are drawn for the size of a pixel."""
    left, top, width, height = view
    scale = _PIXELS / max(width, height)
    box = f"{left:.6g} {top:.6g} {width:.6g} {height:.6g}"
    size = f'width="{width * scale:.0f}" height="{height * scale:.0f}"'
    style = f'fill="currentColor" fill-opacity=".15" stroke="currentColor" stroke-width="{1 / scale:.3g}"'
    drawn = shapes(1 / scale)
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="{box}" overflow="visible"><g {style}>{drawn}</g></svg>'


def _outside(gear: GearData) -> float:
    """Diameter (mm) of what surrounds a gear: its tip circle, or the rim of a ring, which is drawn somewhere if not given."""
    return outer_diameter(gear) if gear.internal else gear.tip_diameter


def gear_shapes(gear: GearData, profile: ToothProfile, pose: Pose, pixel: float) -> Iterator[str]:
    """The outline with its bore or rim, and the reference circle; `pixel` is its size (mm)."""
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
    """The bolt holes of a ring, the first in the middle of tooth 0, as paths; y is down."""
    body = gear.body
    angles = turn + 2 * math.pi / max(body.bolt_holes, 1) * np.arange(body.bolt_holes)
    centres = zip(np.cos(angles).tolist(), np.sin(angles).tolist(), strict=True)
    half = body.bolt_circle / 2
    return "".join(_circle(body.bolt_diameter / 2, x + half * cosine, -half * sine) for cosine, sine in centres)


def polygon(points: Floats, pixel: float) -> str:
    """A closed path, to a tenth of a pixel; y is down in an SVG."""
    digits = max(0, 1 - math.floor(math.log10(pixel)))
    return "M" + " ".join(f"{x:.{digits}f},{-y:.{digits}f}" for x, y in points.tolist()) + "Z"


def _circle(radius: float, x: float, y: float = 0.0) -> str:
    """A path, empty for no radius; y is down."""
    arc = f"a{radius:.6g},{radius:.6g} 0 1 0"
    return f"M{x - radius:.6g},{y:.6g}{arc} {2 * radius:.6g},0{arc} {-2 * radius:.6g},0Z" if radius else ""


_DERIVED = (
    "transverse_module transverse_pressure_angle base_helix_angle reference_diameter base_diameter tip_form_diameter "
    "form_diameter undercut normal_tooth_thickness transverse_tooth_thickness tip_thickness transverse_pitch "
    "transverse_base_pitch lead virtual_teeth cutter_tip_diameter"
).split()
_OF_EXTERNAL = "span_teeth span_measurement span_contact_diameter ball_diameter over_balls over_pins pin_axial_shift".split()
_OF_RINGS = (
    "profile_shift_khk span_spaces span_measurement span_contact_diameter ball_diameter between_balls between_pins".split()
)
"""Properties in a document beside the inputs: of all gears, of external ones and of rings."""


@dataclass(frozen=True, kw_only=True)
class Gear(GearData):
    """One spur or helical gear, external or internal (z < 0). Lengths in mm, angles in degrees.

    `normal_module`, or `normal_diametral_pitch` (1/inch), is given and the other derived (see `Derived`).
    `helix_angle` is signed: right hand positive. `profile_shift` x and `tip_alteration` k are coefficients of the
    normal module; `tooth_thinning` is the reduction of the normal tooth thickness (mm), or follows from `tooth_allowance`
    ("cd25" of DIN 3967) as its mean; beside a thinning a series alone ("25") gives the tolerance. `tip_diameter` and
    `root_diameter` may be given, else they are derived, and read as numbers either way (see `Derived`): a given tip
    circle wins over k, a given root circle prescribes the depth of the tool, which then follows from the gear.
    An internal gear has the signs of ISO 21771: teeth and all diameters are negative, and x > 0 makes its teeth thicker (KHK
    and others give x the opposite sign, `profile_shift_khk`); its `profile` and everything along a flank are magnitudes.
    `cutter` is the shaper cutter that makes the roots; without one those of a ring are form roots.
    `modification` of the flanks leaves all of that as it is: diameters and thicknesses are those of the exact involute.
    Raises ParameterError for one value out of range, GeometryError for a combination that makes no gear.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        check_given(self)
        derive(self, "tip_diameter", self.standard_tip_diameter)
        derive(self, "root_diameter", self.standard_root_diameter)
        check_tool(self)
        try:
            self.profile  # noqa: B018 - built now, so that a gear that exists has teeth
        except InputError as error:
            raise error.within("body") if error.parameter == "tip_chamfer" else error from None
        check_body(self)
        try:
            check_flanks(self.flank_form, self.profile)
        except InputError as error:
            raise error.within("modification") from None

    # ------------------------------------------------------------------ the tooth

    @cached_property
    def profile(self) -> ToothProfile:
        """The exact outline of one tooth."""
        kind = InternalProfile if self.internal else ToothProfile
        return kind(
            teeth=self.tooth_count,
            reference_diameter=abs(self.reference_diameter),
            base_diameter=abs(self.base_diameter),
            tip_diameter=abs(self.tip_diameter),
            root_diameter=abs(self.root_diameter),
            base_half_angle=self.base_half_angle * self._side,
            tool=fillet_tool(self),
            tip_chamfer=self.body.tip_chamfer,
        )

    @property
    def _side(self) -> int:
        """Sign of the gear's diameters: -1 for a ring, otherwise 1."""
        return -1 if self.internal else 1

    @property
    def tip_form_diameter(self) -> float:
        """Tip form diameter d_Fa: the tip circle less the tip chamfers."""
        return self._side * self.profile.tip_form_diameter

    @property
    def form_diameter(self) -> float:
        """Root form circle d_Ff, where the involute begins."""
        return self._side * self.profile.form_diameter

    @cached_property
    def flank_form(self) -> FlankForm:
        """The modified flanks: how far they are taken back from the exact involute, and where."""
        return FlankForm.of(self.modification, self.profile, self.half_width, self.helix_angle, self.normal_module)

    @property
    def undercut(self) -> bool:
        """True if the tool removes part of the involute."""
        return self.profile.undercut

    @property
    def cutter_tip_diameter(self) -> float | None:
        """Tip diameter d_a0 of the shaper cutter (mm), set to reach the root circle; None without one."""
        return None if self.cutter.teeth is None else 2 * shaper_tip(self, 0.0).tip_radius

    @property
    def tip_thickness(self) -> float:
        """Normal tooth thickness s_an on the tip circle, before a tip chamfer."""
        tip_helix = math.atan(math.tan(math.radians(self.helix_angle)) * self.tip_diameter / self.reference_diameter)
        return self.profile.tip_thickness * math.cos(tip_helix)

    # ------------------------------------------------------------------ inspection

    @cached_property
    def inspection(self) -> Inspection:
        """Measuring the teeth, with any gauge; the properties below are those of the gauges suggested."""
        middle = self.reference_diameter + 2 * self.profile_shift * self.normal_module
        return inspection_of(self, min(max(middle, self.form_diameter), self.tip_form_diameter))

    @property
    def span_teeth(self) -> int | None:
        """Number k of teeth to span so that the anvils touch nearest to the middle of the flanks; None for a ring."""
        return None if self.internal else self.inspection.spanned

    @property
    def span_spaces(self) -> int | None:
        """Number of spaces to span on a spur ring; None for a helical ring and an external gear."""
        return self.inspection.spanned if self.internal else None

    @property
    def span_measurement(self) -> float | None:
        """Base tangent length W_k over `span_teeth` teeth or `span_spaces` spaces; None for a helical ring."""
        count = self.inspection.spanned
        return None if count is None else self.inspection.span_measurement(count)

    @property
    def span_contact_diameter(self) -> float | None:
        """Diameter on which the anvils touch; None for a helical ring."""
        count = self.inspection.spanned
        return None if count is None else self.inspection.span_contact_diameter(count)

    @property
    def ball_diameter(self) -> float:
        """Ball or pin that touches near d + 2 x m_n, rounded to two digits."""
        return self.inspection.ball_diameter

    @cached_property
    def over_balls(self) -> float | None:
        """Dimension over two balls of `ball_diameter`; None for a ring."""
        return None if self.internal else self.inspection.over_balls(self.ball_diameter)

    @cached_property
    def over_pins(self) -> float | None:
        """Dimension over two pins of `ball_diameter`, free to shift along the axis; None for a ring."""
        return None if self.internal else self.inspection.over_pins(self.ball_diameter)

    @cached_property
    def between_balls(self) -> float | None:
        """Dimension between two balls of `ball_diameter` in a ring; None for an external gear."""
        return self.inspection.between_balls(self.ball_diameter) if self.internal else None

    @property
    def between_pins(self) -> float | None:
        """Dimension between two pins in a spur ring; None for a helical ring: a straight pin does not fit its hollow flanks."""
        return None if self.helix_angle else self.between_balls

    @property
    def pin_axial_shift(self) -> float:
        """Distance along the axis between the two pins of `over_pins`."""
        return self.inspection.pin_axial_shift

    @cached_property
    def thickness_limits(self) -> ThicknessLimits | None:
        """Limits (mm) of what gauges may find within the `tooth_allowance`; None without one."""
        allowance = self.thickness_allowance
        return None if allowance is None else ThicknessLimits.of(self.inspection, allowance)

    # ------------------------------------------------------------------ what to know of it, and how it shows itself

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """Notices about this gear that an engineer should read before making it."""
        of_inspection = self.inspection.notices(self.form_diameter, self.tip_form_diameter, self.half_width, self.root_diameter)
        return (*self._notices_of_teeth(), *of_inspection)

    def _notices_of_teeth(self) -> Iterator[Notice]:
        if self.undercut:
            yield Notice("undercut", f"undercut: the involute begins at diameter {self.form_diameter:.4f} mm")
        yield from tip_notices(self)
        yield from corner_notices(self)
        yield from trimming_notices(self, self.profile)
        if self.body.web_thickness:
            text = "web: it counts in the rating alone (C_R, Y_B); the solid and its elements are a full disc"
            yield Notice("web-not-modelled", text)

    def _repr_html_(self) -> str:
        return gear_html(self, self.profile)

    def to_dict(self) -> JsonObject:
        """Inputs and derived properties under their field names, for JSON: a lead that is infinite becomes None."""
        parts = {name: asdict(getattr(self, name)) for name in ("rack", "cutter", "double_helix", "body")}
        parts["body"]["hub_side"] = self.body.hub_side.value
        parts["modification"] = self.flank_form.to_dict()
        inputs = {each.name: getattr(self, each.name) for each in fields(self) if each.name not in parts}
        names = (*_DERIVED, *(_OF_RINGS if self.internal else _OF_EXTERNAL))
        derived = {name: getattr(self, name) for name in names}
        if math.isinf(self.lead):
            derived["lead"] = None
        if self.thickness_limits is not None:
            derived["thickness_limits"] = self.thickness_limits.to_dict()
        warnings = {"warnings": list(self.warnings), "notices": [notice.to_dict() for notice in self.notices]}
        return {**inputs, **parts, **derived, **warnings}


class Half(NamedTuple):
    """One half: a gear of its width and hand, that begins at height `z` (mm) and is turned by `rotation` (degrees)."""

    gear: Gear
    z: float
    rotation: float


def halves(gear: Gear) -> tuple[Half, Half]:
    """Lower and upper half of a double helical gear.

    The upper one is the mirror image of the lower one, turned by the offset. Modifications along the face are those of each
    half.
    """
    lower = replace(gear, face_width=gear.half_width, double_helix=DoubleHelix())
    mirrored = replace(gear.modification, twist=0.0 - gear.modification.twist)
    upper = replace(lower, helix_angle=-gear.helix_angle, modification=mirrored)
    turned = math.copysign(gear.twist, gear.helix_angle) + 360 / gear.tooth_count * gear.double_helix.offset
    return Half(lower, 0.0, 0.0), Half(upper, gear.face_width - gear.half_width, turned)


def refuse_halves(gear: Gear, what: str) -> None:
    """Raise GeometryError for a double helical gear where only one hand is treated, with the half that would do."""
    if gear.double_helix.present:
        half = format_number(round(gear.half_width, 6))
        permitted = f"must be left out for {what}: take one half, of face width {half} mm, and half the torque"
        raise GeometryError("double_helix.gap_width", gear.double_helix.gap_width, permitted, "mm")


_HEIGHTS = 65
"""Number of places over the face width at which the width of the root land is evaluated."""

_STEP = 1e-5
"""Step of a curve's parameter over which its speed is taken."""


_NOTHING = 1e-9
"""Length (mm) of a curve that is but a point."""


@dataclass(frozen=True)
class FlankCurve:
    """A smooth piece of half a tooth's side, root to tip. Its end s = 0 is turned as the flank at roll length `first` (mm),
    s = 1 as at `last`, in proportion between them.

    `fading`: of that turn there is nothing at s = 0, and all of it, with no corner, at s = 1.
    """

    curve: Curve
    first: float
    last: float
    fading: bool = False

    def lengths(self, s: Floats) -> Floats:
        """Roll lengths (mm) whose depth turns the points at s."""
        return self.first + s * (self.last - self.first)

    def turn(self, form: FlankForm, s: ArrayLike, z: ArrayLike, *, left: bool) -> Floats:
        """Angle (rad) by which the point at s is turned at height z (mm); s and z broadcast."""
        s = np.asarray(s, float)
        turn = form.turn(self.lengths(s), z, left=left)
        return turn * s**2 * (3 - 2 * s) if self.fading else turn


def flank_curves(gear: Gear) -> list[FlankCurve]:
    """Fillet, involute and tip chamfer; the involute of a modified gear in the pieces on which the depth is smooth.

    Fillet and chamfer turn with the end of the involute that they join; sharp corners of a form root have no fillet. Fillets
    that meet in the middle of the space, or would after turning, do not turn at the root circle.
    """
    form, found = gear.flank_form, list[FlankCurve]()
    for curve in gear.profile.curves:
        if isinstance(curve, Fillet):
            if _is_point(curve):
                continue
            found.append(FlankCurve(curve, form.first, form.first, gear.modification.present and not _root_land_stays(gear)))
        elif curve.kind is CurveKind.CHAMFER:
            found.append(FlankCurve(curve, form.last, form.last))
        elif isinstance(curve, Involute):
            breaks = form.roll_breaks if gear.modification.present else ()
            lengths = [form.first, *breaks, form.last]
            rolls = [curve.first, *(abs(length) / curve.base_radius for length in breaks), curve.last]
            pieces = [replace(curve, first=first, last=last) for first, last in pairwise(rolls)]
            found += [FlankCurve(piece, *ends) for piece, ends in zip(pieces, pairwise(lengths), strict=True)]
    return found


def _is_point(curve: Curve) -> bool:
    """Whether there is nothing of a curve, as of the fillet of a form root with sharp corners."""
    start, end = curve.points(np.array([0.0, 1.0]))
    return math.dist(start, end) < _NOTHING


def _root_land_stays(gear: Gear) -> bool:
    """True if there is some root land at every height when both fillets have turned."""
    land = gear.profile.curves[0]
    if land.kind is not CurveKind.ROOT:
        return False
    form = gear.flank_form
    z = np.union1d(np.linspace(0.0, gear.half_width, _HEIGHTS), form.height_breaks)
    right, left = (form.turn(form.first, z, left=side) for side in (False, True))
    width = 2 * (math.pi / gear.tooth_count - float(land.polar(1.0)[1])) + right - left
    return float(width.min()) * gear.profile.root_diameter / 2 >= LEAST_LAND


# ---------------------------------------------------------------------- the section at mid face width


def middle_section(gear: Gear) -> tuple[Curve, ...]:
    """Curves of half a tooth in the section at mid face width, not turned by the helix: `profile.curves`, as modified.

    There lead crowning, end relief, helix modification and twist are nothing, and so both flanks are alike.
    """
    if not gear.modification.on_profile:
        return gear.profile.curves
    flank = [TurnedCurve.of(gear, piece) for piece in flank_curves(gear)]
    lands = {curve.kind: curve for curve in gear.profile.curves if isinstance(curve, Land)}
    tip = replace(lands[CurveKind.TIP], first=float(flank[-1].polar(1.0)[1]))
    root = lands.get(CurveKind.ROOT)
    return (*([replace(root, last=float(flank[0].polar(0.0)[1]))] if root else []), *flank, tip)


@dataclass(frozen=True)
class TurnedCurve:
    """A curve whose points are turned: by (a + b s + c s^2) times s^2 (3 - 2 s) if it is fading; angles in radians."""

    curve: Curve
    turn: Polynomial

    @classmethod
    def of(cls, gear: Gear, piece: FlankCurve) -> TurnedCurve:
        """A piece of the left flank at mid face width. Over a piece the depth is a parabola, so three places give it."""
        s = np.array([0.0, 0.5, 1.0])
        at = gear.flank_form.turn(piece.lengths(s), gear.half_width / 2)
        slope = at[2] - at[0]
        bend = 2 * (at[0] - 2 * at[1] + at[2])
        turn = Polynomial([at[0], slope - bend, bend])
        return cls(piece.curve, turn * Polynomial([0, 0, 3, -2]) if piece.fading else turn)

    @property
    def kind(self) -> CurveKind:
        return self.curve.kind

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        radius, angle = self.curve.polar(s)
        return radius, angle + self.turn(np.asarray(s, float))

    def points(self, s: ArrayLike) -> Floats:
        radius, angle = self.polar(s)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)

    def direction(self, s: ArrayLike) -> Floats:
        """Return the direction of travel (rad) at parameters `s` of the turned curve. The sum of the curve's own direction, the
        turn, and the tilt by the sideways step as the turn grows.
        """
        s = np.asarray(s, float)
        heading, (radius, angle) = self.curve.direction(s), self.curve.polar(s)
        low, high = np.clip(s - _STEP, 0, 1), np.clip(s + _STEP, 0, 1)
        speed = np.hypot(*np.moveaxis(self.curve.points(high) - self.curve.points(low), -1, 0)) / (high - low)
        sideways = radius * self.turn.deriv()(s)
        across = angle + np.pi / 2 - heading  # from the heading to where a turn moves a point
        tilt: Floats = np.arctan2(sideways * np.sin(across), speed + sideways * np.cos(across))
        return heading + tilt + self.turn(s)
