"""Rack: a spur or helical toothed bar with its exact outline, and all that follows from its inputs (ISO 21771).

The tooth is centred on x = 0 with its tip up, y counts from the reference line, z towards the viewer: its left half has x < 0.
Square to the teeth flanks are straight and fillets arcs of circles; along the rack all is stretched by 1/cos beta.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from enum import Enum
from functools import cached_property
from typing import Annotated, Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core import symbols
from gearcad.core.errors import GeometryError, ParameterError, at_least, at_most
from gearcad.core.quantities import NOT_GIVEN, Range, Whole, Words, derive, derive_count, is_given, symbols_of
from gearcad.core.records import Floats, JsonObject, Notice, concise
from gearcad.geometry.curves import PlaneCurve, parameters_within
from gearcad.geometry.gear import Gear
from gearcad.geometry.gear_data import LEAST_RIM
from gearcad.geometry.gear_parts import ISO53_A, LEAST_FEATURE, BasicRack, NormalDiametralPitch, NormalModule, derive_module
from gearcad.geometry.gear_pictures import CHORD_ERROR, Pose, RackPose, drawing, gear_shapes, polygon, sheet
from gearcad.geometry.inspection import RackInspection
from gearcad.geometry.profile import LEAST_LAND, RADIUS_SLACK
from gearcad.geometry.toothed import (
    FaceWidth,
    HelixAngle,
    TipAlteration,
    ToothedPart,
    ToothThinning,
    check_fields,
    check_root_radius,
    check_thickness,
    check_width,
    most_dedendum,
    tip_notices,
)

_LENGTH = Range("mm", 0, None, ends="(]")
_FEATURE = Range("mm", 0, None)

WHOLE_PITCH = 1e-9
"""Share of a pitch by which a given length may miss a whole number of them, as printed lengths do."""


@dataclass(frozen=True, kw_only=True)
class RackData(ToothedPart):
    """The fields of a `Rack`, unchecked, and sizes that need no outline of a tooth. Lengths in mm, angles in degrees."""

    name: Annotated[str, Words("name")] = "rack"
    teeth: Annotated[int | None, Whole(1, 2000), Words("number of teeth (whole pitches)", "z")] = None
    length: Annotated[float, _LENGTH, Words("length", "L")] = NOT_GIVEN
    normal_module: NormalModule = NOT_GIVEN
    normal_diametral_pitch: NormalDiametralPitch = NOT_GIVEN
    helix_angle: HelixAngle = 0.0
    face_width: FaceWidth
    height: Annotated[float, Range("mm", 0, 10000, ends="(]"), Words("height, back to reference line", "H_0")]
    tip_alteration: TipAlteration = 0.0
    tooth_thinning: ToothThinning = 0.0
    tip_chamfer: Annotated[float, _FEATURE, Words("tip chamfer, height", "h_K", "6.1")] = 0.0
    rack: BasicRack = field(default=ISO53_A)

    @property
    def normal_pitch(self) -> float:
        """Normal pitch p_n = pi m_n, perpendicular to the teeth."""
        return math.pi * self.normal_module

    @property
    def transverse_base_pitch(self) -> float:
        """Transverse base pitch p_bt = p_t cos alpha_t."""
        return self.transverse_pitch * math.cos(math.radians(self.transverse_pressure_angle))

    @property
    def normal_tooth_thickness(self) -> float:
        """Normal tooth thickness s_n = pi m_n/2 - thinning, on the reference line."""
        return self.normal_module * math.pi / 2 - self.tooth_thinning

    @property
    def tip_height(self) -> float:
        """Addendum h_a = m_n (h_aP + k), above the reference line."""
        return self.normal_module * (self.rack.addendum + self.tip_alteration)

    @property
    def tip_form_height(self) -> float:
        """Height (mm) above the reference line at which the straight flank ends: the tip less its chamfer."""
        return self.tip_height - self.tip_chamfer

    @property
    def root_depth(self) -> float:
        """Dedendum h_f = m_n h_fP, below the reference line."""
        return self.normal_module * self.rack.dedendum

    @property
    def form_depth(self) -> float:
        """h_Ff = h_f - rho_f (1 - sin alpha_n): where the straight flank begins, below the reference line."""
        radius = self.root_radius * self.normal_module
        return self.root_depth - radius * (1 - math.sin(math.radians(self.rack.pressure_angle)))

    @property
    def tip_thickness(self) -> float:
        """s_an = s_n - 2 h_a tan alpha_n: normal tooth thickness at the tip, before a tip chamfer."""
        return self.normal_tooth_thickness - 2 * self.tip_height * math.tan(math.radians(self.rack.pressure_angle))

    @property
    def total_height(self) -> float:
        """Height (mm) from the back to the tips."""
        return self.height + self.tip_height

    @property
    def whole_pitches(self) -> int:
        """Number of whole pitches in the length."""
        return math.floor(self.length / self.transverse_pitch + WHOLE_PITCH)

    @property
    def drift(self) -> float:
        """Distance (mm) that a tooth moves along +x per mm of height z: -tan beta, as a right-hand tooth on +y does."""
        return 0.0 - math.tan(math.radians(self.helix_angle))


class RackCurveKind(Enum):
    """Kind of a piece of the outline; the value is its name in files."""

    ROOT = "root land"
    FILLET = "fillet"
    FLANK = "flank"
    CHAMFER = "tip chamfer"
    TIP = "tip land"


class RackCurve(PlaneCurve, Protocol):
    """A piece of the outline of the left half of a tooth, root side first."""

    @property
    def kind(self) -> RackCurveKind: ...


@dataclass(frozen=True)
class Straight:
    """A land, a flank or a chamfer, between two points (mm)."""

    kind: RackCurveKind
    start: tuple[float, float]
    end: tuple[float, float]

    def points(self, s: ArrayLike) -> Floats:
        s = np.asarray(s, float)[..., None]
        points: Floats = (1 - s) * np.array(self.start) + s * np.array(self.end)
        return points

    def direction(self, s: ArrayLike) -> Floats:
        (x, y), (to_x, to_y) = self.start, self.end
        return np.full(np.shape(s), math.atan2(to_y - y, to_x - x))


@dataclass(frozen=True)
class FilletArc:
    """The fillet: a circle about (`x`, `y`) in the normal section (mm), from its lowest point over the angle `last` (rad).

    `stretch` is 1/cos beta, by which the transverse section is wider.
    """

    x: float
    y: float
    radius: float
    last: float
    stretch: float
    kind: RackCurveKind = RackCurveKind.FILLET

    def points(self, s: ArrayLike) -> Floats:
        theta = np.asarray(s, float) * self.last
        return np.stack([(self.x + self.radius * np.sin(theta)) * self.stretch, self.y - self.radius * np.cos(theta)], -1)

    def direction(self, s: ArrayLike) -> Floats:
        theta = np.asarray(s, float) * self.last
        return np.arctan2(np.sin(theta), np.cos(theta) * self.stretch)


@dataclass(frozen=True, kw_only=True)
class RackProfile:
    """Exact transverse outline of one tooth of a rack: root land, fillet, flank, tip chamfer, tip land.

    Normal pitch and thickness on the reference line, heights, radius of the fillets and height of the tip chamfer (45 degrees
    in the transverse section) in mm; angles in degrees. Normally obtained as `rack.profile`.
    """

    normal_pitch: float
    normal_thickness: float
    pressure_angle: float
    helix_angle: float
    tip_height: float
    root_depth: float
    root_radius: float
    tip_chamfer: float = 0.0

    @property
    def stretch(self) -> float:
        """Factor 1/cos beta of lengths in the transverse section."""
        return 1 / math.cos(math.radians(self.helix_angle))

    @property
    def pitch(self) -> float:
        """Transverse pitch (mm)."""
        return self.normal_pitch * self.stretch

    @property
    def slope(self) -> float:
        """Slope tan alpha_t of a flank against the height."""
        return math.tan(math.radians(self.pressure_angle)) * self.stretch

    @property
    def form_depth(self) -> float:
        """Depth (mm) below the reference line at which the straight flank begins."""
        return self.root_depth - self.root_radius * (1 - math.sin(math.radians(self.pressure_angle)))

    @cached_property
    def _fillet(self) -> FilletArc:
        """u = s_n/2 + (h_f - rho) tan a_n + rho/cos a_n from the middle of the tooth, v = -(h_f - rho)."""
        angle, depth = math.radians(self.pressure_angle), self.root_depth - self.root_radius
        u = self.normal_thickness / 2 + depth * math.tan(angle) + self.root_radius / math.cos(angle)
        return FilletArc(-u, -depth, self.root_radius, math.pi / 2 - angle, self.stretch)

    @property
    def root_land(self) -> float:
        """Width of the root land along the rack (mm); 0 where fillets meet."""
        width = self.pitch + 2 * self._fillet.x * self.stretch
        return width if width >= LEAST_LAND else 0.0

    @cached_property
    def curves(self) -> tuple[RackCurve, ...]:
        """Curves of the left half of a tooth from the middle of the space to the middle of the tooth.

        The root land is absent where the fillets meet, the fillet where there is no radius, the chamfer where there is none.
        """
        fillet, tip = self._fillet, self.tip_height
        middle = (-self.pitch / 2, -self.root_depth)
        foot = (fillet.x * self.stretch, -self.root_depth)
        form = (-self.half_thickness_on_flank(-self.form_depth), -self.form_depth)
        if not (self.root_land or self.root_radius):  # flanks meet, rounding or not
            form = middle
        end = (-self.half_thickness_on_flank(tip - self.tip_chamfer), tip - self.tip_chamfer)
        top = (end[0] + self.tip_chamfer, tip)
        curves: list[RackCurve] = [Straight(RackCurveKind.FLANK, form, end)]
        if self.root_radius:
            curves.insert(0, fillet)
        if self.root_land:
            curves.insert(0, Straight(RackCurveKind.ROOT, middle, foot))
        if self.tip_chamfer:
            curves.append(Straight(RackCurveKind.CHAMFER, end, top))
        return (*curves, Straight(RackCurveKind.TIP, top, (0.0, tip)))

    def half_thickness_on_flank(self, height: float) -> float:
        """Return half the transverse tooth thickness (mm) at a height (mm) if the flank went on to there."""
        return float(self._on_flank(height))

    def _on_flank(self, height: ArrayLike) -> Floats:
        return self.normal_thickness / 2 * self.stretch - np.asarray(height, float) * self.slope

    def half_thickness(self, height: ArrayLike) -> Any:
        """Return half the transverse tooth thickness (mm) at a height over the reference line (mm, root to tip), scalar or
        array.

        Raises ParameterError for heights outside root ... tip.
        """
        given = np.asarray(height, float)
        slack = RADIUS_SLACK * self.normal_pitch
        outside = ~((given >= -self.root_depth - slack) & (given <= self.tip_height + slack))
        if np.any(outside):
            permitted = f"must be from {-self.root_depth:.10g} to {self.tip_height:.10g} mm (root to tip)"
            raise ParameterError("height", float(given[outside].flat[0]), permitted, "mm")
        half = self._on_flank(given)
        fillet, end = self._fillet, self.tip_height - self.tip_chamfer
        below = np.clip(fillet.y - given, -fillet.radius, fillet.radius)
        along = np.sqrt((fillet.radius - below) * (fillet.radius + below))
        half = np.where(given < -self.form_depth, -(fillet.x + along) * self.stretch, half)
        half = np.where(given > end, self._on_flank(end) - (given - end), half)
        return float(half) if half.ndim == 0 else half


MOST_PITCHES = 2000
"""Largest number of teeth of a rack."""


def check_rack_numbers(rack: RackData) -> None:
    """Raise ParameterError or GeometryError for numbers that do not fit the module, and unless teeth or a length are given."""
    if 0 < rack.tip_chamfer < LEAST_FEATURE:
        raise ParameterError("tip_chamfer", rack.tip_chamfer, f"must be 0 or at least {LEAST_FEATURE} mm", "mm")
    if not is_given(rack.teeth) and not is_given(rack.length):
        raise ParameterError("teeth", None, "must be a whole number from 1 to 2000, or give the length in mm")
    if is_given(rack.teeth) and is_given(rack.length):
        long = f"{rack.teeth} teeth are {(rack.teeth or 0) * rack.transverse_pitch:.6f} mm long"
        raise GeometryError("length", rack.length, f"must be left out where teeth are given: {long}", "mm")
    check_width(rack, rack.face_width)


def check_rack_length(rack: RackData) -> None:
    """Raise GeometryError unless a given length holds a pitch, and not too many."""
    pitch = rack.transverse_pitch
    if not 1 <= rack.whole_pitches <= MOST_PITCHES:
        permitted = f"must be from {at_least(pitch)} to {at_most(MOST_PITCHES * pitch)} mm (1 to {MOST_PITCHES} pitches)"
        raise GeometryError("length", rack.length, permitted, "mm")


def check_rack_teeth(rack: RackData) -> None:
    """Raise GeometryError unless the teeth are possible.

    There must be some tooth on the reference line, a fillet that fits the space, some flank, some tip land, and a back below
    the roots.
    """
    check_thickness(rack)
    if (most := most_dedendum(rack)) is not None:
        permitted = f"must be at most {at_most(most)}, where the flanks of a space meet"
        raise GeometryError("rack.dedendum", rack.rack.dedendum, permitted)
    check_root_radius(rack)
    _check_flank(rack)
    if rack.tip_chamfer:
        _check_chamfer(rack)
    least = rack.root_depth + LEAST_RIM * rack.normal_module
    if rack.height < least:
        permitted = f"must be at least {at_least(least)} mm ({LEAST_RIM} m_n below the roots, {rack.root_depth:.6g} mm deep)"
        raise GeometryError("height", rack.height, permitted, "mm")


def _check_flank(rack: RackData) -> None:
    """Raise GeometryError unless the tip is above the form line and some land is on it."""
    m, tangent = rack.normal_module, math.tan(math.radians(rack.rack.pressure_angle))
    if rack.tip_height <= -rack.form_depth:
        least = at_least(-rack.form_depth / m - rack.rack.addendum)
        raise GeometryError("tip_alteration", rack.tip_alteration, f"must be above {least}: no flank is left above the fillet")
    if rack.tip_thickness < LEAST_LAND:
        highest = (rack.normal_tooth_thickness - LEAST_LAND) / 2 / tangent
        permitted = f"must be at most {at_most(highest / m - rack.rack.addendum)} (pointed tooth)"
        raise GeometryError("tip_alteration", rack.tip_alteration, permitted)


def _check_chamfer(rack: RackData) -> None:
    """Raise GeometryError unless the tip chamfer takes material off and leaves some flank and some land."""
    slope = math.tan(math.radians(rack.transverse_pressure_angle))
    if slope >= 1:
        permitted = "must be 0 mm: the flank leans in by more than the chamfer's 45 deg"
        raise GeometryError("tip_chamfer", rack.tip_chamfer, permitted, "mm")
    land = rack.tip_thickness / math.cos(math.radians(rack.helix_angle))
    most = min((land - LEAST_LAND) / 2 / (1 - slope), rack.tip_height + rack.form_depth)
    if rack.tip_chamfer >= most:
        permitted = f"must be below {at_most(most)} mm: some flank and some tip land are left"
        raise GeometryError("tip_chamfer", rack.tip_chamfer, permitted, "mm")


_OF_RACK = "teeth length normal_module helix_angle face_width height tip_height root_depth".split()

_MOST_SHOWN = 12
"""Teeth on each side of the pinion that a picture shows."""


def rack_html(rack: RackData, profile: RackProfile) -> str:
    """Return a picture of the rack, and a table."""
    view = (0.0, -rack.tip_height, rack.length, rack.total_height)
    picture = drawing(view, lambda pixel: _outline(rack, profile, (0.0, rack.length), None, pixel))
    return sheet(rack.name, picture, [], _rows(rack))


def rack_pair_html(
    name: str,
    pinion: Gear,
    rack: RackData,
    profile: RackProfile,
    pose: RackPose,
    figures: Iterable[tuple[symbols.Symbol, float]],
) -> str:
    """Return a picture of both in mesh, the rack at its pose as far as it is near, and a table of the rack and the pair."""
    reach = _MOST_SHOWN * profile.pitch
    near = max(0.0, -pose.y - reach), min(rack.length, -pose.y + reach)
    tip = pinion.tip_diameter / 2
    low, high = min(near[0] + pose.y, -tip), max(near[1] + pose.y, tip)
    view = (-tip, -high, tip + pose.x + rack.height, high - low)

    def shapes(pixel: float) -> str:
        gear = "".join(gear_shapes(pinion, pinion.profile, Pose(0.0, 0.0, 0.0), pixel))
        return gear + _outline(rack, profile, near, pose, pixel)

    rows = _rows(rack)
    rows += [(symbol, [value]) for symbol, value in figures]
    return sheet(name, drawing(view, shapes), [], rows)


def _rows(rack: RackData) -> list[tuple[symbols.Symbol, list[float | None]]]:
    written = symbols_of(RackData) | symbols.RACK
    return [(written[name], [getattr(rack, name)]) for name in _OF_RACK]


def _outline(rack: RackData, profile: RackProfile, near: tuple[float, float], pose: RackPose | None, pixel: float) -> str:
    """Return the section at z = 0 of the pinion, or of a rack by itself, between two places along it (mm)."""
    first, last = (int(place // profile.pitch) for place in near)
    middles = (np.arange(first - 1, last + 2) + 0.5) * profile.pitch
    tooth = _tooth(profile, CHORD_ERROR * pixel)
    shift = 0.0 if pose is None else -rack.drift * pose.z
    x = (middles[:, None] + tooth[:, 0]).ravel() + shift
    y = np.tile(tooth[:, 1], len(middles))
    inside = (x > near[0]) & (x < near[1])
    ends = np.interp(near, x, y)
    top = np.column_stack([np.r_[near[0], x[inside], near[1]], np.r_[ends[0], y[inside], ends[1]]])
    points = np.concatenate([[[near[0], -rack.height], [near[1], -rack.height]], top[::-1]])
    if pose is not None:
        points = np.column_stack([pose.x - points[:, 1], pose.y + points[:, 0]])
    return f'<path d="{polygon(points, pixel)}"/>'


def _tooth(profile: RackProfile, chord_error: float) -> Floats:
    """Return the points (n, 2) of a tooth from space to space, without the last one."""
    half = np.concatenate([curve.points(parameters_within(curve, chord_error))[:-1] for curve in profile.curves])
    return np.concatenate([half, [[0.0, profile.tip_height]], half[:0:-1] * [-1, 1]])


_DERIVED = (
    "transverse_module transverse_pressure_angle base_helix_angle normal_pitch transverse_pitch transverse_base_pitch "
    "tip_height tip_form_height form_depth root_depth total_height normal_tooth_thickness transverse_tooth_thickness "
    "tip_thickness pin_diameter over_pin"
).split()
"""Properties in a document beside the inputs."""


@dataclass(frozen=True, kw_only=True)
class Rack(RackData):
    """One spur or helical rack. Lengths in mm, angles in degrees.

    It lies along x from x = 0 to the `length`, teeth up (+y) and z = 0 ... face width; y = 0 is the reference line, `height`
    above the back. At z = 0 the middle of a space is at x = 0, so tooth 0 is centred half a pitch on. The end faces are square
    to the length: they cut helical teeth obliquely, and whatever a length that is no whole number of pitches ends in. Of
    `teeth` and `length` one is given: so many pitches are the length, and the teeth then are the whole pitches in it.
    `helix_angle` is signed as a gear's: right hand positive; a right-hand rack meshes with a left-hand pinion.
    `tip_alteration` k is in normal modules, `tooth_thinning` the reduction of the normal tooth thickness (mm), `tip_chamfer`
    the height of the 45-degree chamfer along both tip edges (transverse section). A rack has no profile shift: what that does
    on a gear, the mounting distance of its pair does.
    Raises ParameterError for one value out of range, GeometryError for a combination that makes no rack.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        check_fields(self)
        derive_module(self)
        check_rack_numbers(self)
        derive(self, "length", (self.teeth or 0) * self.transverse_pitch)
        check_rack_length(self)
        derive_count(self, "teeth", self.whole_pitches)
        check_rack_teeth(self)

    @cached_property
    def profile(self) -> RackProfile:
        """The exact outline of one tooth."""
        radius = self.root_radius * self.normal_module
        return RackProfile(
            normal_pitch=self.normal_pitch,
            normal_thickness=self.normal_tooth_thickness,
            pressure_angle=self.rack.pressure_angle,
            helix_angle=self.helix_angle,
            tip_height=self.tip_height,
            root_depth=self.root_depth,
            root_radius=radius if radius >= LEAST_LAND else 0.0,
            tip_chamfer=self.tip_chamfer,
        )

    # ------------------------------------------------------------------ inspection

    @cached_property
    def inspection(self) -> RackInspection:
        """Inspection of the rack with any pin; the properties below are those of the suggested pin."""
        return RackInspection(
            normal_pitch=self.normal_pitch,
            normal_tooth_thickness=self.normal_tooth_thickness,
            pressure_angle=self.rack.pressure_angle,
            height=self.height,
            tip_height=self.tip_height,
            tip_form_height=self.tip_form_height,
            form_depth=self.form_depth,
            root_depth=self.root_depth,
        )

    @property
    def pin_diameter(self) -> float:
        """Pin or ball that touches near the reference line, rounded up to two digits."""
        return self.inspection.pin_diameter

    @property
    def over_pin(self) -> float | None:
        """Height over a pin of `pin_diameter` in a space, from the back; None where it touches no flank."""
        try:
            return self.inspection.over_pin(self.pin_diameter)
        except GeometryError:
            return None

    # ------------------------------------------------------------------ what to know of it, and how it shows itself

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """Notices about this rack that an engineer should read before making it."""
        return (*tip_notices(self), *self.inspection.notices())

    def _repr_html_(self) -> str:
        return rack_html(self, self.profile)

    def to_dict(self) -> JsonObject:
        """Return the inputs and derived properties under their field names, for JSON."""
        inputs = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "rack"}
        rack = {f.name: getattr(self.rack, f.name) for f in fields(self.rack)}
        warnings = {"warnings": list(self.warnings), "notices": [notice.to_dict() for notice in self.notices]}
        return {**inputs, "rack": rack, **{name: getattr(self, name) for name in _DERIVED}, **warnings}
