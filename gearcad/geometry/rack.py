"""Rack: a spur or helical toothed bar with its exact outline, and all that follows from its inputs (ISO 21771).

The tooth is centred on x = 0 with its tip up, y counts from the reference line, z towards the viewer: its left half has x < 0.
Square to the teeth flanks are straight and fillets arcs of circles; along the rack all is stretched by 1/cos beta.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core import symbols
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.quantities import derive, derive_count, symbols_of
from gearcad.core.records import Floats, JsonObject, Notice, concise
from gearcad.geometry.curves import parameters_within
from gearcad.geometry.gear import Gear
from gearcad.geometry.gear_parts import derive_module
from gearcad.geometry.gear_pictures import CHORD_ERROR, Pose, RackPose, drawing, gear_shapes, polygon, sheet
from gearcad.geometry.inspection import RackInspection
from gearcad.geometry.premachining import RackFinishing
from gearcad.geometry.profile import LEAST_LAND, RADIUS_SLACK
from gearcad.geometry.rack_data import RackData, check_rack_length, check_rack_numbers, check_rack_teeth
from gearcad.geometry.rack_root import FilletArc, RackCurve, RackCurveKind, RackRamp, RackRoot, Straight
from gearcad.geometry.toothed import check_fields, tip_notices


@dataclass(frozen=True, kw_only=True)
class RackProfile:
    """Exact transverse outline of one tooth of a rack: root land, fillet, flank, tip chamfer, tip land.

    Normal pitch and thickness on the reference line, heights, radius of the fillets and height of the tip chamfer (45 degrees
    in the transverse section) in mm; angles in degrees. `root` and `ramp` are of teeth that are cut before they are finished.
    Normally obtained as `rack.profile`.
    """

    normal_pitch: float
    normal_thickness: float
    pressure_angle: float
    helix_angle: float
    tip_height: float
    root_depth: float
    root_radius: float
    tip_chamfer: float = 0.0
    root: RackRoot | None = None
    ramp: RackRamp | None = None

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
        if self.root is not None:
            return self.root.form_depth
        return self.root_depth - self.root_radius * (1 - math.sin(math.radians(self.pressure_angle)))

    @cached_property
    def _fillet(self) -> FilletArc:
        """u = s_n/2 + (h_f - rho) tan a_n + rho/cos a_n from the middle of the tooth, v = -(h_f - rho)."""
        angle, depth = math.radians(self.pressure_angle), self.root_depth - self.root_radius
        u = self.normal_thickness / 2 + depth * math.tan(angle) + self.root_radius / math.cos(angle)
        return FilletArc(-u, -depth, self.root_radius, math.pi / 2 - angle, self.stretch)

    @property
    def tip_form_height(self) -> float:
        """Height (mm) above the reference line at which the straight flank ends."""
        return self.tip_height - self.tip_chamfer if self.ramp is None else self.ramp.start

    @property
    def chamfered(self) -> bool:
        """Whether something is between the flank and the tip land."""
        return bool(self.tip_chamfer) or self.ramp is not None

    @property
    def _chamfer_slope(self) -> float:
        """Slope of the tip chamfer against the height (transverse section): 1, or that of the ramp."""
        return 1.0 if self.ramp is None else self.ramp.slope * self.stretch

    @cached_property
    def _root_pieces(self) -> tuple[FilletArc | Straight, ...]:
        if self.root is not None:
            return self.root.pieces
        return (self._fillet,) if self.root_radius else ()

    @property
    def _foot(self) -> float:
        """Place (mm along the rack) where the root land ends, left of the middle of the tooth."""
        pieces = self._root_pieces
        return float(pieces[0].points(0.0)[0]) if pieces else self._fillet.x * self.stretch

    @property
    def root_land(self) -> float:
        """Width of the root land along the rack (mm); 0 where fillets meet."""
        width = self.pitch + 2 * self._foot
        return width if width >= LEAST_LAND else 0.0

    @cached_property
    def curves(self) -> tuple[RackCurve, ...]:
        """Curves of the left half of a tooth from the middle of the space to the middle of the tooth.

        The root land is absent where the fillets meet, the fillet where there is no radius, the chamfer where there is none.
        """
        pieces, tip = self._root_pieces, self.tip_height
        middle = (-self.pitch / 2, -self.root_depth)
        foot = (self._foot, -self.root_depth)
        form = (-self.half_thickness_on_flank(-self.form_depth), -self.form_depth)
        if not (self.root_land or pieces):  # flanks meet, rounding or not
            form = middle
        end = (-self.half_thickness_on_flank(self.tip_form_height), self.tip_form_height)
        run = self.tip_chamfer if self.ramp is None else (tip - end[1]) * self._chamfer_slope
        top = (end[0] + run, tip)
        curves: list[RackCurve] = [*pieces, Straight(RackCurveKind.FLANK, form, end)]
        if self.root_land:
            curves.insert(0, Straight(RackCurveKind.ROOT, middle, foot))
        if self.chamfered:
            curves.append(Straight(RackCurveKind.CHAMFER, end, top))
        return (*curves, Straight(RackCurveKind.TIP, top, (0.0, tip)))

    def contour(self, chord_error: float) -> Floats:
        """Return the points (n, 2) of a tooth from the middle of a space to the next, without the last one."""
        half = np.concatenate([curve.points(parameters_within(curve, chord_error))[:-1] for curve in self.curves])
        return np.concatenate([half, [[0.0, self.tip_height]], half[:0:-1] * [-1, 1]])

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
        end, below = self.tip_form_height, given < -self.form_depth
        if self.root is None or self.root.pieces:
            half = np.where(below, (self.root or self._fillet).half_thickness(given), half)
        half = np.where(given > end, self._on_flank(end) - (given - end) * self._chamfer_slope, half)
        return float(half) if half.ndim == 0 else half


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
    tooth = profile.contour(CHORD_ERROR * pixel)
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
            root=self.root,
            ramp=self.ramp,
        )

    # ------------------------------------------------------------------ before the flanks are finished

    @cached_property
    def precut(self) -> Rack:
        """The rack before its flanks are finished; itself where they are cut in one step."""
        if not self.premachining.present:
            return self
        given = {each.name: getattr(self, each.name) for each in fields(self)}
        return PrecutRack(**given | {"finishing": RackFinishing()})

    @property
    def undercut(self) -> bool:
        """True if the flank begins at a corner, above a root that the tool has cut deeper."""
        return self.root is not None and self.root.corner

    @property
    def greatest_undercut(self) -> float:
        """Greatest distance (mm, along the rack) of the fillet inside the finished flank going on: s_pr/cos alpha."""
        beyond = max(self.residual_undercut, 0.0) if self.undercut else 0.0
        return beyond / math.cos(math.radians(self.rack.pressure_angle)) / self.helix_cosine

    def with_stock(self, stock: float) -> Rack:
        """Return the rack cut with another stock (mm) on its flanks. Its wheel runs free of the root where nothing stops it."""
        pre = replace(self.premachining, tool_addendum=self.dedendum, stock=stock, stock_tolerance=0.0)
        free = stock <= self.premachining.protuberance
        return replace(self, premachining=pre, finishing=RackFinishing() if free else self.finishing)

    def _premachining_document(self) -> JsonObject:
        """Return the inputs of the pre-cutting tool and what it leaves (mm)."""
        pre, before = self.premachining, self.precut
        document = asdict(pre) | {
            "tool_addendum": self.dedendum,
            "stock": self.stock,
            "residual_undercut": self.residual_undercut,
            "greatest_undercut": self.greatest_undercut,
            "root_depth": self.root_depth,
            "root_form_depth": None if self.residual_undercut < 0 else self.with_stock(self.stock).form_depth,
            "precut": {
                "normal_tooth_thickness": before.normal_tooth_thickness,
                "pin_diameter": before.pin_diameter,
                "over_pin": before.over_pin,
                "tip_thickness": before.tip_thickness,
                "tip_height": before.tip_height,
                "form_depth": before.form_depth,
            },
        }
        for name, sign in (("least_stock", -1), ("most_stock", 1)):
            if pre.stock_tolerance:
                stock = self.stock + sign * pre.stock_tolerance
                left = pre.protuberance - stock
                form = None if left < 0 else self.with_stock(stock).form_depth
                document[name] = {"stock": stock, "residual_undercut": left, "root_form_depth": form}
        return document

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
        return (*tip_notices(self), *self._notices_of_premachining(), *self.inspection.notices())

    def _notices_of_premachining(self) -> Iterator[Notice]:
        begins = f"the finished flank begins {self.form_depth:.4f} mm below the reference line"
        if self.undercut:
            reach = f"{self.greatest_undercut:.4f} mm deep (protuberance less stock {self.residual_undercut:.4f} mm)"
            yield Notice("residual-undercut", f"residual undercut: {begins}, above an undercut {reach}")
        elif self.residual_undercut < 0:
            left = -self.residual_undercut
            yield Notice("grinding-notch", f"grinding notch: {begins}, where the wheel leaves a step of {left:.4f} mm")
        yield from self.premachining.notices(self.normal_module, ends=self.finishing.end_depth is not None)

    def _repr_html_(self) -> str:
        return rack_html(self, self.profile)

    def to_dict(self) -> JsonObject:
        """Return the inputs and derived properties under their field names, for JSON."""
        parts = {"rack", "premachining", "finishing"}
        inputs = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in parts}
        rack: JsonObject = {"rack": {f.name: getattr(self.rack, f.name) for f in fields(self.rack)}}
        if self.premachining.present:
            rack |= {"premachining": self._premachining_document(), "finishing": asdict(self.finishing)}
        warnings = {"warnings": list(self.warnings), "notices": [notice.to_dict() for notice in self.notices]}
        return {**inputs, **rack, **{name: getattr(self, name) for name in _DERIVED}, **warnings}


class PrecutRack(Rack):
    """A rack as its pre-cutting tool leaves it: thicker by the stock on each flank.

    Obtained as `rack.precut`.
    """

    @property
    def stock(self) -> float:
        """0 mm: nothing of these teeth is finished yet."""
        return 0.0

    @property
    def normal_tooth_thickness(self) -> float:
        """Normal tooth thickness s_n (mm) on the reference line, with the stock."""
        stock = self.premachining.stock_of(self.normal_module)
        return super().normal_tooth_thickness + 2 * stock / math.cos(math.radians(self.rack.pressure_angle))
