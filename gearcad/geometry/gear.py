"""Gear: the inputs of one external cylindrical gear, and everything that follows from them (ISO 21771)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any

from gearcad.errors import InputError, plain_numbers, require_number
from gearcad.geometry import feasibility, inspection
from gearcad.geometry.body import Body
from gearcad.geometry.derived import Derived
from gearcad.geometry.modification import FlankForm, FlankModification, check_flanks
from gearcad.geometry.picture import gear_html
from gearcad.geometry.profile import ToothProfile, base_half_angle
from gearcad.geometry.rack import ISO53_A, BasicRack
from gearcad.geometry.trochoid import ToolTip
from gearcad.notice import Notice, texts
from gearcad.reprs import concise

__all__ = ["Gear"]

THIN_TIP = 0.2
"""Normal tip thickness below which the data sheet warns, in normal modules (0.4 for case-hardened teeth)."""

_DERIVED = (
    "transverse_module transverse_pressure_angle base_helix_angle reference_diameter base_diameter tip_form_diameter "
    "form_diameter undercut normal_tooth_thickness transverse_tooth_thickness tip_thickness transverse_pitch "
    "transverse_base_pitch lead virtual_teeth span_teeth span_measurement span_contact_diameter ball_diameter over_balls "
    "over_pins pin_axial_shift"
).split()


@dataclass(frozen=True, kw_only=True)
class Gear:
    """One external spur or helical gear. Lengths in mm, angles in degrees.

    `helix_angle` is signed: right hand positive. `profile_shift` x and `tip_alteration` k are coefficients of the
    normal module; `tooth_thinning` is the reduction of the normal tooth thickness (mm). `tip_diameter` and
    `root_diameter` may be given, else they are derived, and read as numbers either way (see `Derived`): a given tip
    circle wins over k, a given root circle prescribes the depth of the tool, which then follows from the gear.
    `modification` of the flanks leaves all of that as it is: diameters and thicknesses are those of the exact involute.
    Raises ParameterError for one value out of range, GeometryError for a combination that makes no gear.
    """

    name: str = "gear"
    teeth: int
    normal_module: float
    face_width: float
    helix_angle: float = 0.0
    profile_shift: float = 0.0
    tip_alteration: float = 0.0
    tooth_thinning: float = 0.0
    rack: BasicRack = field(default=ISO53_A)
    body: Body = field(default=Body())
    modification: FlankModification = field(default=FlankModification())
    tip_diameter: float = Derived("nan")
    root_diameter: float = Derived("nan")

    __repr__ = concise
    _repr_html_ = gear_html

    def __post_init__(self) -> None:
        plain_numbers(self)
        feasibility.check_numbers(self)
        for name in ("tip_diameter", "root_diameter"):
            value = getattr(self, name)
            if value is None or isinstance(value, Derived):
                object.__setattr__(self, name, Derived(getattr(self, "_standard_" + name)))
            else:
                require_number(name, value, "mm", above=0, at_most=feasibility.LARGEST_DIAMETER)
        feasibility.check_tool(self)
        try:
            self.profile  # noqa: B018 - built now, so that a gear that exists has teeth
        except InputError as error:
            raise error.within("body") if error.parameter == "tip_chamfer" else error from None
        feasibility.check_body(self)
        try:
            check_flanks(self)
        except InputError as error:
            raise error.within("modification") from None

    # ------------------------------------------------------------------ what the standard derives

    @property
    def _standard_tip_diameter(self) -> float:
        """d_a = d + 2 m_n (h_aP + x + k)."""
        rise = self.rack.addendum + self.profile_shift + self.tip_alteration
        return self.reference_diameter + 2 * self.normal_module * rise

    @property
    def _standard_root_diameter(self) -> float:
        """d_f = d - 2 m_n (h_fP - x)."""
        return self.reference_diameter - 2 * self.normal_module * (self.rack.dedendum - self.profile_shift)

    @property
    def dedendum(self) -> float:
        """Dedendum h_fP of the tool in normal modules: the rack's, or (d - d_f)/(2 m_n) + x for a given root circle."""
        if isinstance(self.root_diameter, Derived):
            return self.rack.dedendum
        return (self.reference_diameter - self.root_diameter) / (2 * self.normal_module) + self.profile_shift

    @property
    def root_radius(self) -> float:
        """Tip radius of the tool in normal modules, with "full" resolved for this gear."""
        if self.rack.root_radius == "full":
            return self.rack.full_root_radius(self.dedendum, self.tooth_thinning / self.normal_module)
        return float(self.rack.root_radius)

    @cached_property
    def transverse_module(self) -> float:
        """m_t = m_n / cos beta."""
        return self.normal_module / math.cos(math.radians(self.helix_angle))

    @cached_property
    def transverse_pressure_angle(self) -> float:
        """tan alpha_t = tan alpha_n / cos beta."""
        tangent = math.tan(math.radians(self.rack.pressure_angle))
        return math.degrees(math.atan(tangent / math.cos(math.radians(self.helix_angle))))

    @cached_property
    def base_helix_angle(self) -> float:
        """sin beta_b = sin beta cos alpha_n; signed like the helix angle."""
        sine = math.sin(math.radians(self.helix_angle)) * math.cos(math.radians(self.rack.pressure_angle))
        return math.degrees(math.asin(sine))

    @cached_property
    def reference_diameter(self) -> float:
        """d = z m_t."""
        return self.teeth * self.transverse_module

    @cached_property
    def base_diameter(self) -> float:
        """d_b = d cos alpha_t."""
        return self.reference_diameter * math.cos(math.radians(self.transverse_pressure_angle))

    @property
    def tip_form_diameter(self) -> float:
        """d_Fa: the tip circle less the tip chamfers."""
        return self.profile.tip_form_diameter

    @property
    def form_diameter(self) -> float:
        """Root form circle d_Ff, where the involute begins."""
        return self.profile.form_diameter

    @cached_property
    def flank_form(self) -> FlankForm:
        """The modified flanks: how far they are taken back from the exact involute, and where."""
        return FlankForm.of(self)

    @property
    def undercut(self) -> bool:
        """True if the tool removes part of the involute."""
        return self.profile.undercut

    @property
    def normal_tooth_thickness(self) -> float:
        """s_n = m_n (pi/2 + 2 x tan alpha_n) - thinning, on the reference circle."""
        tangent = math.tan(math.radians(self.rack.pressure_angle))
        return self.normal_module * (math.pi / 2 + 2 * self.profile_shift * tangent) - self.tooth_thinning

    @property
    def transverse_tooth_thickness(self) -> float:
        """s_t = s_n / cos beta, on the reference circle."""
        return self.normal_tooth_thickness / math.cos(math.radians(self.helix_angle))

    @property
    def tip_thickness(self) -> float:
        """Normal tooth thickness s_an on the tip circle, before a tip chamfer."""
        tip_helix = math.atan(math.tan(math.radians(self.helix_angle)) * self.tip_diameter / self.reference_diameter)
        return self.profile.tip_thickness * math.cos(tip_helix)

    @property
    def transverse_pitch(self) -> float:
        """p_t = pi m_t."""
        return math.pi * self.transverse_module

    @property
    def transverse_base_pitch(self) -> float:
        """p_bt = pi m_t cos alpha_t."""
        return math.pi * self.base_diameter / self.teeth

    @property
    def lead(self) -> float:
        """Lead p_z = pi d / tan |beta|; infinite for a spur gear."""
        if self.helix_angle == 0:
            return math.inf
        return math.pi * self.reference_diameter / math.tan(math.radians(abs(self.helix_angle)))

    @property
    def twist(self) -> float:
        """Rotation of the section over the face width in degrees (magnitude): 360 b / p_z."""
        return 0.0 if self.helix_angle == 0 else 360 * self.face_width / self.lead

    @property
    def virtual_teeth(self) -> float:
        """z_n = z / (cos^2 beta_b cos beta)."""
        base, helix = math.radians(self.base_helix_angle), math.radians(self.helix_angle)
        return self.teeth / (math.cos(base) ** 2 * math.cos(helix))

    # ------------------------------------------------------------------ inspection

    @cached_property
    def span_teeth(self) -> int:
        """Number k of teeth to span so that the anvils touch nearest to the middle of the flanks."""
        return inspection.span_teeth(self)

    @property
    def span_measurement(self) -> float:
        """Base tangent length W_k over `span_teeth` teeth."""
        return inspection.span_measurement(self, self.span_teeth)

    @property
    def span_contact_diameter(self) -> float:
        """Diameter on which the anvils touch over `span_teeth` teeth."""
        return inspection.span_contact_diameter(self, self.span_teeth)

    @cached_property
    def ball_diameter(self) -> float:
        """Ball or pin that touches near d + 2 x m_n, rounded to two digits."""
        return inspection.suggested_ball_diameter(self)

    @cached_property
    def over_balls(self) -> float:
        """Dimension over two balls of `ball_diameter`."""
        return inspection.over_balls(self, self.ball_diameter)

    @cached_property
    def over_pins(self) -> float:
        """Dimension over two pins of `ball_diameter`, free to shift along the axis."""
        return inspection.over_pins(self, self.ball_diameter)

    @property
    def pin_axial_shift(self) -> float:
        """Distance along the axis between the two pins of `over_pins`."""
        return inspection.pin_axial_shift(self)

    # ------------------------------------------------------------------ the tooth

    @cached_property
    def profile(self) -> ToothProfile:
        """The exact outline of one tooth."""
        m, helix = self.normal_module, math.radians(self.helix_angle)
        shift = self.profile_shift * m
        tool = ToolTip.cutting(
            normal_module=m,
            pressure_angle=math.radians(self.rack.pressure_angle),
            helix_angle=helix,
            reference_radius=self.reference_diameter / 2,
            depth=self.dedendum * m - shift,
            shift=shift,
            radius=self.root_radius * m,
            thinning=self.tooth_thinning,
        )
        return ToothProfile(
            teeth=self.teeth,
            reference_diameter=self.reference_diameter,
            base_diameter=self.base_diameter,
            tip_diameter=self.tip_diameter,
            root_diameter=self.root_diameter,
            base_half_angle=base_half_angle(self.teeth, self.normal_tooth_thickness, m, self.transverse_pressure_angle),
            tool=tool,
            tip_chamfer=self.body.tip_chamfer,
        )

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """What an engineer should know about this gear before making it."""
        return (*self._notices_of_teeth(), *self._notices_of_inspection())

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def _notices_of_teeth(self) -> Iterator[Notice]:
        if self.undercut:
            yield Notice("undercut", f"undercut: the involute begins at diameter {self.form_diameter:.4f} mm")
        if self.tip_thickness < THIN_TIP * self.normal_module:
            thickness = f"normal thickness {self.tip_thickness:.4f} mm is below {THIN_TIP} m_n"
            yield Notice("thin-tip", f"thin tip: {thickness} (0.4 m_n if case-hardened)")
        if self.body.web_thickness:
            text = "web: it counts in the rating alone (C_R, Y_B); the solid and its elements are a full disc"
            yield Notice("web-not-modelled", text)

    def _notices_of_inspection(self) -> Iterator[Notice]:
        lowest, highest = self.form_diameter, self.tip_form_diameter
        if not lowest <= (touching := self.span_contact_diameter) <= highest:
            yield Notice("span-off-involute", f"span: the anvils would touch at diameter {touching:.4f} mm, off the involute")
        ball = self.ball_diameter
        if not lowest <= (touching := inspection.ball_contact_diameter(self, ball)) <= highest:
            text = f"balls: a ball of {ball:g} mm would touch at diameter {touching:.4f} mm, off the involute"
            yield Notice("balls-off-involute", text)
        if self.face_width < (width := self.pin_axial_shift):
            text = f"pins: the dimension over two pins needs a face width of {width:.4f} mm; use balls, or one pin"
            yield Notice("narrow-for-pins", text)
        if self.face_width < (width := self.span_measurement * math.sin(math.radians(abs(self.base_helix_angle)))):
            text = f"span: measuring over {self.span_teeth} teeth needs a face width of {width:.4f} mm"
            yield Notice("narrow-for-span", text)

    def to_dict(self) -> dict[str, Any]:
        """Inputs and derived properties under their field names, for JSON: a lead that is infinite becomes None."""
        inputs = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in ("rack", "body", "modification")}
        rack = {f.name: getattr(self.rack, f.name) for f in fields(self.rack)}
        body = {f.name: getattr(self.body, f.name) for f in fields(self.body)} | {"hub_side": self.body.hub_side.value}
        modification = self.modification.to_dict()
        derived = {name: getattr(self, name) for name in _DERIVED}
        if math.isinf(self.lead):
            derived["lead"] = None
        warnings = {"warnings": list(self.warnings), "notices": [notice.to_dict() for notice in self.notices]}
        return {**inputs, "rack": rack, "body": body, "modification": modification, **derived, **warnings}
