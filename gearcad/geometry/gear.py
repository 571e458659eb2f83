"""Gear: one cylindrical gear, external or internal, and everything that follows from what was given (ISO 21771)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from functools import cached_property
from typing import Any

from gearcad.errors import InputError
from gearcad.geometry.derived import derive
from gearcad.geometry.feasibility import check_given, check_tool
from gearcad.geometry.gauged import inspection_of
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.inspection import Inspection
from gearcad.geometry.internal_profile import InternalProfile
from gearcad.geometry.modification import FlankForm, check_flanks
from gearcad.geometry.picture import gear_html
from gearcad.geometry.profile import ToothProfile, base_half_angle
from gearcad.geometry.thickness_limits import ThicknessLimits
from gearcad.geometry.tooling import corner_notices, fillet_tool, shaper_tip
from gearcad.geometry.trimming import trimming_notices
from gearcad.geometry.walls import check_body
from gearcad.notice import Notice, texts
from gearcad.reprs import concise

__all__ = ["Gear"]

THIN_TIP = 0.2
"""Normal tip thickness below which the data sheet warns, in normal modules (0.4 for case-hardened teeth)."""

_DERIVED = (
    "transverse_module transverse_pressure_angle base_helix_angle reference_diameter base_diameter tip_form_diameter "
    "form_diameter undercut normal_tooth_thickness transverse_tooth_thickness tip_thickness transverse_pitch "
    "transverse_base_pitch lead virtual_teeth cutter_tip_diameter"
).split()
_OF_EXTERNAL = "span_teeth span_measurement span_contact_diameter ball_diameter over_balls over_pins pin_axial_shift".split()
_OF_RINGS = (
    "profile_shift_khk span_spaces span_measurement span_contact_diameter ball_diameter between_balls between_pins".split()
)
"""What a document has beside the inputs: of all gears, of external ones and of rings."""


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
        """The sign of its diameters."""
        return -1 if self.internal else 1

    @property
    def base_half_angle(self) -> float:
        """Half tooth angle on the base circle in degrees, signed like the diameters: s_n/(m_n z) + inv alpha_t (ISO 21771)."""
        return base_half_angle(self.teeth, self.normal_tooth_thickness, self.normal_module, self.transverse_pressure_angle)

    @property
    def tip_form_diameter(self) -> float:
        """d_Fa: the tip circle less the tip chamfers."""
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
        """d_a0 of the shaper cutter (mm), set to reach the root circle; None without one."""
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
        """The same of a spur ring, whose anvils span spaces; None for a helical ring and an external gear."""
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
        """The same with pins in a spur ring; None for a helical ring, whose hollow flanks a straight pin does not fit."""
        return None if self.helix_angle else self.between_balls

    @property
    def pin_axial_shift(self) -> float:
        """Distance along the axis between the two pins of `over_pins`."""
        return self.inspection.pin_axial_shift

    @cached_property
    def thickness_limits(self) -> ThicknessLimits | None:
        """What gauges may find within the `tooth_allowance`; None without one."""
        allowance = self.thickness_allowance
        return None if allowance is None else ThicknessLimits.of(self.inspection, allowance)

    # ------------------------------------------------------------------ what to know of it, and how it shows itself

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """What an engineer should know about this gear before making it."""
        of_inspection = self.inspection.notices(self.form_diameter, self.tip_form_diameter, self.half_width)
        return (*self._notices_of_teeth(), *of_inspection)

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
        yield from corner_notices(self)
        yield from trimming_notices(self, self.profile)
        if self.body.web_thickness:
            text = "web: it counts in the rating alone (C_R, Y_B); the solid and its elements are a full disc"
            yield Notice("web-not-modelled", text)

    def _repr_html_(self) -> str:
        return gear_html(self, self.profile)

    def to_dict(self) -> dict[str, Any]:
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
