"""Gear: one cylindrical gear, external or internal, with all that follows from its inputs (ISO 21771)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, InputError, at_most, format_number
from gearcad.core.quantities import Derived, derive
from gearcad.core.records import Floats, JsonObject, Notice, concise
from gearcad.geometry.as_made import MadeTeeth
from gearcad.geometry.curves import Curve, CurveKind, Involute, Land
from gearcad.geometry.feasibility import check_given, check_tool, trimming_notices
from gearcad.geometry.gear_data import GearData, check_body
from gearcad.geometry.gear_parts import DoubleHelix
from gearcad.geometry.gear_pictures import gear_html
from gearcad.geometry.gear_tools import chamfering_ramp, corner_notices, fillet_tool, root_outline, shaper_tip
from gearcad.geometry.inspection import Inspection, ThicknessLimits, inspection_of
from gearcad.geometry.making import Making
from gearcad.geometry.modification import FlankForm, FlankModification, check_flanks
from gearcad.geometry.premachining import Finishing
from gearcad.geometry.profile import LEAST_LAND, InternalProfile, ToothProfile
from gearcad.geometry.tool_shelf import ToolName, equip
from gearcad.geometry.toothed import tip_notices

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


_UNDERCUT_PLACES = 2049
"""Places along a fillet at which the residual undercut is looked at."""


def _peak(values: Floats) -> float:
    """Return the greatest of values in equal steps, by the parabola through it and its neighbours."""
    at = int(np.argmax(values))
    if not 0 < at < len(values) - 1:
        return float(values[at])
    before, here, after = values[at - 1 : at + 2]
    bend = before - 2 * here + after
    return float(here - (after - before) ** 2 / (8 * bend)) if bend else float(here)


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
    `cutter` is the shaper cutter that makes the roots; without one those of a ring are form roots. `tool` names a tool of the
    shelf (`gearcad tools`), which fills `rack`, `cutter` or `premachining`.
    `modification` of the flanks leaves all of that as it is: diameters and thicknesses are those of the exact involute.
    Raises ParameterError for one value out of range, GeometryError for a combination that makes no gear.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        equip(self)
        check_given(self)
        derive(self, "tip_diameter", self.standard_tip_diameter)
        derive(self, "root_diameter", self.standard_root_diameter)
        check_tool(self)
        try:
            self.profile  # noqa: B018 - built now, so that a gear that exists has teeth
        except InputError as error:
            if error.parameter == "ramp":
                height = self.premachining.semi_topping.height
                raise GeometryError("premachining.semi_topping.height", height, error.permitted, "mm") from None
            raise error.within("body") if error.parameter == "tip_chamfer" else error from None
        check_body(self)
        try:
            check_flanks(self.flank_form, self.profile)
        except InputError as error:
            raise error.within("modification") from None
        if self.making.present:
            self.as_made  # noqa: B018 - refuses what cannot be made

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
            root=root_outline(self),
            ramp=chamfering_ramp(self),
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
        return None if self.root_cutter.teeth is None else 2 * shaper_tip(self, 0.0).tip_radius

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
        if self.premachining.present:
            yield from self._notices_of_premachining()
        elif self.undercut:
            yield Notice("undercut", f"undercut: the involute begins at diameter {self.form_diameter:.4f} mm")
        yield from tip_notices(self)
        yield from corner_notices(self)
        yield from trimming_notices(self, self.profile)
        if self.body.step is not None:
            text = f"blank {Path(self.body.step).name}: its body is in files of solids and facets alone"
            yield Notice("own-blank", f"{text}; finite elements, masses and drawings have a plain disc")
        if self.body.bore_spline:
            text = f"the bore is a spline ({self.body.bore_spline}): the strength of this seat is not judged"
            yield Notice("spline-not-judged", text)
        if self.body.web_thickness:
            text = "web: it counts in the rating alone (C_R, Y_B); the solid and its elements are a full disc"
            yield Notice("web-not-modelled", text)

    def _notices_of_premachining(self) -> Iterator[Notice]:
        begins = f"the finished flank begins at diameter {self.form_diameter:.4f} mm"
        if self.residual_undercut > 0 and self.undercut:
            reach = f"{self.greatest_undercut:.4f} mm deep (protuberance less stock {self.residual_undercut:.4f} mm)"
            yield Notice("residual-undercut", f"residual undercut: {begins}, above an undercut {reach}")
        elif self.residual_undercut < 0:
            left = -self.residual_undercut
            yield Notice("grinding-notch", f"grinding notch: {begins}, where the wheel leaves a step of {left:.4f} mm")
        elif self.undercut:
            yield Notice("undercut", f"undercut: the involute begins at diameter {self.form_diameter:.4f} mm")
        yield from self.premachining.notices(self.normal_module, ends=self.finishing.end_diameter is not None)

    def _repr_html_(self) -> str:
        return gear_html(self, self.profile)

    @property
    def first_layer(self) -> float:
        """Height (mm) of the step at the lower end, and its depth; 0 but for a print as it is made."""
        return 0.0

    @cached_property
    def as_made(self) -> Gear:
        """The gear as its mould, print or path is made; itself where no process is named."""
        return AsMadeGear.of(self) if self.making.present else self

    def _making_document(self) -> JsonObject:
        """Return the sizes (mm) of the gear, and of what is made for it."""
        made, size = self.as_made, "between_balls" if self.internal else "over_balls"
        assert isinstance(made, AsMadeGear)
        teeth, ball, scale = self.span_teeth, self.ball_diameter, self.making.radial_scale
        names = ("tip_diameter", "root_diameter", "form_diameter")

        def sizes(gear: Gear, thickness: float, span: float | None, over: float | None) -> JsonObject:
            found = {name: getattr(gear, name) for name in names}
            found |= {"normal_tooth_thickness": thickness, "span_teeth": teeth, "span_measurement": span}
            return found | {"ball_diameter": ball, size: over, "face_width": gear.face_width, "bore": gear.body.bore}

        measured = self.between_balls if self.internal else self.over_balls
        thickness = made.made.thickness_at(scale * abs(self.reference_diameter) / 2)
        span = None if teeth is None else made.made.span_over(teeth)
        document: JsonObject = {
            "nominal": sizes(self, self.normal_tooth_thickness, None if teeth is None else self.span_measurement, measured),
            "as_made": sizes(made, thickness, span, made.made.over_balls(ball)),
        }
        if self.making.process == "mould":
            document["cavity"] = made.made.cavity_document()
        if self.making.cuts:
            document["path_offset"] = made.made.offset
            document["path_tolerance"] = self.making.arc_tolerance
            document["lead_in"] = self.making.lead_length(self.normal_module)
        return document

    # ------------------------------------------------------------------ before the flanks are finished

    @cached_property
    def precut(self) -> Gear:
        """The gear before its flanks are finished; itself where they are cut in one step."""
        if not self.premachining.present:
            return self
        given = {each.name: getattr(self, each.name) for each in fields(self)}
        before = {"tooth_allowance": None, "modification": FlankModification(), "finishing": Finishing(), "making": Making()}
        return PrecutGear(**given | before | {"tooth_thinning": float(self.tooth_thinning)})

    @property
    def residual_undercut(self) -> float:
        """s_pr = p_r - q (mm): how far the tool's tip reaches into the finished flank; negative where stock is left, or 0."""
        return self.premachining.protuberance - self.stock

    @cached_property
    def greatest_undercut(self) -> float:
        """Greatest distance (mm, along the circle) of the fillet inside the finished flank, were that to go on to the root."""
        flank = self.profile.involute
        radius, half = self.profile.fillet.polar(np.linspace(0.0, 1.0, _UNDERCUT_PLACES))
        outside = radius >= flank.base_radius
        on_flank = flank.half_angle(np.maximum(radius, flank.base_radius))
        depth = np.where(outside, radius * (on_flank - half), 0.0)
        return max(float(_peak(depth)), 0.0)

    def _premachining_document(self) -> JsonObject:
        """Return the inputs of the pre-cutting tool and what it leaves (mm)."""
        pre, before = self.premachining, self.precut
        size = "between_balls" if self.internal else "over_balls"
        document = asdict(pre) | {
            "tool_addendum": self.tool_addendum,
            "stock": self.stock,
            "residual_undercut": self.residual_undercut,
            "greatest_undercut": self.greatest_undercut,
            "root_diameter": self.root_diameter,
            "root_form_diameter": None if self.residual_undercut < 0 else self._free_form_diameter(self.stock),
            "precut": {
                "normal_tooth_thickness": before.normal_tooth_thickness,
                "span_teeth": before.span_teeth,
                "span_measurement": before.span_measurement,
                "ball_diameter": before.ball_diameter,
                size: before.between_balls if self.internal else before.over_balls,
                "tip_thickness": before.tip_thickness,
                "tip_diameter": before.tip_diameter,
                "form_diameter": before.form_diameter,
            },
        }
        for name, sign in (("least_stock", -1), ("most_stock", 1)):
            if pre.stock_tolerance:
                stock = self.stock + sign * pre.stock_tolerance
                left = pre.protuberance - stock
                form = None if left < 0 else self._free_form_diameter(stock)
                document[name] = {"stock": stock, "residual_undercut": left, "root_form_diameter": form}
        return document

    def _free_form_diameter(self, stock: float) -> float:
        """Root form diameter (mm) where the wheel runs free of a root that was cut with a stock (mm)."""
        return self.with_stock(stock).form_diameter

    def with_stock(self, stock: float) -> Gear:
        """Return the gear cut with another stock (mm) on its flanks. Its wheel runs free of the root where nothing stops it."""
        pre = replace(self.premachining, tool_addendum=self.tool_addendum, stock=stock, stock_tolerance=0.0)
        free = stock <= self.premachining.protuberance
        return replace(self, premachining=pre, finishing=Finishing() if free else self.finishing)

    def to_dict(self) -> JsonObject:
        """Return the inputs and derived properties under their field names, for JSON: a lead that is infinite becomes None."""
        parts = {name: asdict(getattr(self, name)) for name in ("rack", "cutter", "double_helix")}
        parts["body"] = self.body.to_dict()
        parts["modification"] = self.flank_form.to_dict()
        two_steps = {"premachining", "finishing", "making", "tool"}
        inputs = {each.name: getattr(self, each.name) for each in fields(self) if each.name not in parts.keys() | two_steps}
        if isinstance(self.tool, ToolName) and self.tool.tool is not None:
            inputs |= {"tool": str(self.tool), "tool_file": self.tool.tool.file}
        if self.premachining.present:
            parts |= {"premachining": self._premachining_document(), "finishing": asdict(self.finishing)}
        if self.making.present:
            parts["making"] = self.making.inputs | self._making_document()
        names = (*_DERIVED, *(_OF_RINGS if self.internal else _OF_EXTERNAL))
        derived = {name: getattr(self, name) for name in names}
        if math.isinf(self.lead):
            derived["lead"] = None
        if self.thickness_limits is not None:
            derived["thickness_limits"] = self.thickness_limits.to_dict()
        warnings = {"warnings": list(self.warnings), "notices": [notice.to_dict() for notice in self.notices]}
        return {**inputs, **parts, **derived, **warnings}


@dataclass(frozen=True, kw_only=True)
class AsMadeGear(Gear):
    """A gear as its mould, print or path is made: `made` is its outline, and its sizes are those as made.

    Obtained as `gear.as_made`. Without modification of the flanks. Raises GeometryError for a body that is not possible.
    """

    made: MadeTeeth

    __repr__ = concise

    @classmethod
    def of(cls, gear: Gear, set_back: float = 0.0) -> AsMadeGear:
        """Return a gear as it is made, or as the path that cuts it; its outline set back by so much (mm) more."""
        making, side = gear.making, gear._side
        made = MadeTeeth(gear, gear.profile, rounded=making.cuts, set_back=set_back)
        radial, axial, helix = making.radial_scale, making.axial_scale, gear.double_helix
        slope = math.tan(math.radians(gear.helix_angle)) * radial / axial
        gap = helix.gap_diameter
        changed = {
            "made": made,
            "normal_module": gear.normal_module * radial,
            "normal_diametral_pitch": Derived(gear.normal_diametral_pitch / radial),
            "helix_angle": math.degrees(math.atan(slope)),
            "face_width": made.face_width,
            "tip_diameter": 2 * side * made.tip_radius,
            "root_diameter": 2 * side * made.root_radius,
            "body": made.body,
            "double_helix": replace(
                helix,
                gap_width=None if helix.gap_width is None else helix.gap_width * axial,
                gap_diameter=None if gap is None else gap * radial + 2 * made.offset,
            ),
            "modification": FlankModification(),
        }
        return cls(**{each.name: getattr(gear, each.name) for each in fields(gear)} | changed)

    def __post_init__(self) -> None:
        try:
            check_body(self)
        except GeometryError as error:
            key = "first_layer" if self.made.set_back else "offset"
            permitted = f"must leave a body: as made its {error.parameter} {error.permitted}"
            raise GeometryError(f"making.{key}", getattr(self.making, key), permitted, "mm") from None
        if self.first_layer:
            self._check_foot()

    def _check_foot(self) -> None:
        """Raise GeometryError unless the teeth stand on the first layer, and something is left of it."""
        height, nominal = self.first_layer, self.nominal
        for name, there in (
            ("body.end_chamfer", nominal.body.end_chamfer),
            ("body.hub_side", nominal.body.hub_ends[0]),
            ("double_helix.gap_width", nominal.double_helix.present),
        ):
            if there:
                permitted = f"must be left out beside {name}: it is for teeth that stand on the first layer with a plane end"
                raise GeometryError("making.first_layer", height, permitted, "mm")
        if height >= self.face_width:
            raise GeometryError(
                "making.first_layer", height, f"must be below {at_most(self.face_width)} mm, the face width", "mm"
            )
        self.foot  # noqa: B018 - checks its outline

    @property
    def nominal(self) -> Gear:
        """The gear that is made."""
        assert isinstance(self.made.gear, Gear)
        return self.made.gear

    @property
    def first_layer(self) -> float:
        """Height (mm) of the first layer, over which the outline is set back by as much."""
        return 0.0 if self.made.set_back else self.making.first_layer

    @cached_property
    def foot(self) -> AsMadeGear:
        """The gear set back by the spread of the first layer."""
        return AsMadeGear.of(self.nominal, self.first_layer)

    @property
    def profile(self) -> ToothProfile:
        """The outline of a tooth as it is made."""
        return self.made.profile

    @property
    def normal_tooth_thickness(self) -> float:
        """Normal tooth thickness s_n (mm) on the scaled reference circle."""
        return self.made.thickness_at(abs(self.reference_diameter) / 2)

    @property
    def base_half_angle(self) -> float:
        """Half tooth angle on the base circle (degrees), of a flank that is an involute."""
        return self._side * self.profile.base_half_angle

    @cached_property
    def transverse_module(self) -> float:
        """m_t, scaled."""
        return self.made.gear.transverse_module * self.making.radial_scale

    @cached_property
    def transverse_pressure_angle(self) -> float:
        """alpha_t of the nominal gear: scaling does not change it."""
        return self.made.gear.transverse_pressure_angle

    @cached_property
    def base_helix_angle(self) -> float:
        """beta_b of the scaled flank."""
        return math.degrees(math.atan(self.made.twist * self.made.base_radius))


class PrecutGear(Gear):
    """A gear as its pre-cutting tool leaves it: thicker by the stock on each flank, without what finishing modifies.

    Obtained as `gear.precut`.
    """

    @property
    def stock(self) -> float:
        """0 mm: nothing of these teeth is finished yet."""
        return 0.0

    @property
    def _left(self) -> float:
        """Normal tooth thickness (mm) of the stock on both flanks."""
        stock = self.premachining.stock_of(self.normal_module)
        return 2 * stock / math.cos(math.radians(self.rack.pressure_angle))

    @property
    def normal_tooth_thickness(self) -> float:
        """Normal tooth thickness s_n (mm) on the reference circle, with the stock."""
        return super().normal_tooth_thickness + self._left

    @property
    def root_thinning(self) -> float:
        """Reduction of the normal tooth thickness (mm); negative where the stock is more than it."""
        return self.tooth_thinning - self._left


class Half(NamedTuple):
    """One half: a gear of its width and hand, that begins at height `z` (mm) and is turned by `rotation` (degrees)."""

    gear: Gear
    z: float
    rotation: float


def halves(gear: Gear) -> tuple[Half, Half]:
    """Return the lower and upper half of a double helical gear.

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
        """Return the roll lengths (mm) whose depth turns the points at s."""
        return self.first + s * (self.last - self.first)

    def turn(self, form: FlankForm, s: ArrayLike, z: ArrayLike, *, left: bool) -> Floats:
        """Return the angle (rad) by which the point at s is turned at height z (mm); s and z broadcast."""
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
        if curve.kind is CurveKind.FILLET:
            if _is_point(curve):
                continue
            fading = not found and gear.modification.present and not _root_land_stays(gear)
            found.append(FlankCurve(curve, form.first, form.first, fading))
        elif curve.kind is CurveKind.CHAMFER:
            found.append(FlankCurve(curve, form.last, form.last))
        elif not isinstance(curve, Involute) and curve.kind is CurveKind.INVOLUTE:  # of teeth as they are made
            found.append(FlankCurve(curve, 0.0, 0.0))
        elif isinstance(curve, Involute):
            breaks = form.roll_breaks if gear.modification.present else ()
            lengths = [form.first, *breaks, form.last]
            rolls = [curve.first, *(abs(length) / curve.base_radius for length in breaks), curve.last]
            pieces = [replace(curve, first=first, last=last) for first, last in pairwise(rolls)]
            found += [FlankCurve(piece, *ends) for piece, ends in zip(pieces, pairwise(lengths), strict=True)]
    return found


def _is_point(curve: Curve) -> bool:
    """Return whether there is nothing of a curve, as of the fillet of a form root with sharp corners."""
    start, end = curve.points(np.array([0.0, 1.0]))
    return math.dist(start, end) < _NOTHING


def _root_land_stays(gear: Gear) -> bool:
    """Return whether there is some root land at every height when both fillets have turned."""
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
    """Return the curves of half a tooth in the section at mid face width, not turned by the helix: `profile.curves`, as
    modified.

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
        """Return a piece of the left flank at mid face width. Over a piece the depth is a parabola, so three places give it."""
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
