"""Inputs of a rack, sizes that need no outline of a tooth, and whether the teeth are possible.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated

from gearcad.core.errors import GeometryError, ParameterError, at_least, at_most
from gearcad.core.quantities import NOT_GIVEN, Range, Whole, Words, is_given
from gearcad.geometry.gear_data import LEAST_RIM
from gearcad.geometry.gear_parts import ISO53_A, LEAST_FEATURE, BasicRack, NormalDiametralPitch, NormalModule
from gearcad.geometry.premachining import WHEEL_TIP, RackFinishing, RackPremachining
from gearcad.geometry.profile import LEAST_LAND
from gearcad.geometry.rack_root import RackRamp, RackRoot, RackTools, check_rack_ramp, check_rack_tools
from gearcad.geometry.toothed import (
    FaceWidth,
    HelixAngle,
    TipAlteration,
    ToothedPart,
    ToothThinning,
    check_root_radius,
    check_thickness,
    check_width,
    most_dedendum,
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
    premachining: RackPremachining = field(default=RackPremachining())
    finishing: RackFinishing = field(default=RackFinishing())

    @property
    def dedendum(self) -> float:
        """Dedendum in normal modules: that of the basic rack, or the addendum of the tool that cuts before finishing."""
        return self.premachining.addendum_of(self.normal_module) if self.premachining.present else self.rack.dedendum

    @property
    def root_radius(self) -> float:
        """Radius of the fillets in normal modules, with "full" resolved."""
        return super().root_radius if self.premachining.tool_tip_radius is None else self.premachining.tool_tip_radius

    @property
    def stock(self) -> float:
        """Stock q (mm, normal) on each flank of these teeth; 0 where nothing is finished."""
        return self.premachining.stock_of(self.normal_module) if self.premachining.present else 0.0

    @property
    def residual_undercut(self) -> float:
        """s_pr = p_r - q (mm): how far the tool's tip reaches into the finished flank; negative where stock is left, or 0."""
        return self.premachining.protuberance - self.stock

    @property
    def tools(self) -> RackTools:
        """The tool that cuts before finishing, in the normal section."""
        pre = self.premachining
        return RackTools(
            half_thickness=self.normal_tooth_thickness / 2,
            half_pitch=self.normal_pitch / 2,
            angle=math.radians(self.rack.pressure_angle),
            depth=self.root_depth,
            radius=self.root_radius * self.normal_module,
            stock=self.stock,
            protuberance=pre.protuberance,
            steep=None if pre.protuberance_angle is None else math.radians(pre.protuberance_angle),
            stretch=1 / self.helix_cosine,
        )

    @cached_property
    def root(self) -> RackRoot | None:
        """The root of teeth that are cut before they are finished; None where one tool makes all."""
        if not self.premachining.present:
            return None
        return self.tools.finished(self.finishing.end_depth, self.wheel_tip_radius)

    @property
    def ramp(self) -> RackRamp | None:
        """The ramp of a semi-topping tool at the tips."""
        ramp = self.premachining.semi_topping
        if ramp.angle is None or ramp.height is None:
            return None
        return self.tools.ramp(math.radians(ramp.angle), ramp.height)

    @property
    def wheel_tip_radius(self) -> float:
        """Radius (mm) of the tip of the finishing wheel: as given, or a fifth of the normal module."""
        given = self.finishing.wheel_tip_radius
        return WHEEL_TIP * self.normal_module if given is None else given

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
        """Addendum h_a = m_n (h_aP + k), above the reference line, or the depth of a topping tool."""
        if self.premachining.topping is not None:
            return self.premachining.topping
        return self.normal_module * (self.rack.addendum + self.tip_alteration)

    @property
    def tip_form_height(self) -> float:
        """Height (mm) above the reference line at which the straight flank ends: the tip less its chamfer."""
        return self.tip_height - self.tip_chamfer if (ramp := self.ramp) is None else ramp.start

    @property
    def root_depth(self) -> float:
        """Dedendum h_f = m_n h_fP, below the reference line."""
        return self.normal_module * self.dedendum

    @property
    def form_depth(self) -> float:
        """h_Ff = h_f - rho_f (1 - sin alpha_n): where the straight flank begins, below the reference line."""
        if self.root is not None:
            return self.root.form_depth
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
    if rack.premachining.present:
        _check_premachining(rack)
    elif (most := most_dedendum(rack)) is not None:
        permitted = f"must be at most {at_most(most)}, where the flanks of a space meet"
        raise GeometryError("rack.dedendum", rack.rack.dedendum, permitted)
    if not rack.premachining.present:
        check_root_radius(rack)
    _check_flank(rack)
    if rack.tip_chamfer:
        _check_chamfer(rack)
    least = rack.root_depth + LEAST_RIM * rack.normal_module
    if rack.height < least:
        permitted = f"must be at least {at_least(least)} mm ({LEAST_RIM} m_n below the roots, {rack.root_depth:.6g} mm deep)"
        raise GeometryError("height", rack.height, permitted, "mm")


def _check_premachining(rack: RackData) -> None:
    """Raise GeometryError unless the tool that cuts before finishing, and the wheel, leave a tooth."""
    pre = rack.premachining
    if pre.topping is not None and rack.tip_alteration:
        permitted = "must be left out: the tips follow from premachining.topping"
        raise GeometryError("tip_alteration", rack.tip_alteration, permitted)
    if pre.semi_topping.present and rack.tip_chamfer:
        permitted = "must be left out: the tips are chamfered by premachining.semi_topping"
        raise GeometryError("tip_chamfer", rack.tip_chamfer, permitted, "mm")
    check_rack_tools(rack.tools, rack.normal_module)
    end = rack.finishing.end_depth
    if end is not None and not -rack.tip_height < end < rack.root_depth:
        permitted = f"must be above {at_least(-rack.tip_height)} and below {at_most(rack.root_depth)} mm, between tip and root"
        raise GeometryError("finishing.end_depth", end, permitted, "mm")
    assert rack.root is not None
    if -rack.root.form_depth >= rack.tip_height:
        permitted = "must be less: it cuts the whole flank away"
        raise GeometryError("premachining.protuberance", pre.protuberance, permitted, "mm")
    if rack.ramp is not None:
        height, angle = pre.semi_topping.height or 0.0, math.radians(rack.rack.pressure_angle)
        check_rack_ramp(rack.ramp, angle, rack.root.form_depth, rack.tip_height, height)
        land = rack.tip_thickness - 2 * (rack.tip_height - rack.ramp.start) * (rack.ramp.slope - math.tan(angle))
        if land < LEAST_LAND:
            raise GeometryError("premachining.semi_topping.height", height, "must be more: the ramp leaves no tip land", "mm")


def _check_flank(rack: RackData) -> None:
    """Raise GeometryError unless the tip is above the form line and some land is on it."""
    if rack.premachining.topping is not None:
        _check_topped(rack, rack.premachining.topping)
        return
    m, tangent = rack.normal_module, math.tan(math.radians(rack.rack.pressure_angle))
    if rack.tip_height <= -rack.form_depth:
        least = at_least(-rack.form_depth / m - rack.rack.addendum)
        raise GeometryError("tip_alteration", rack.tip_alteration, f"must be above {least}: no flank is left above the fillet")
    if rack.tip_thickness < LEAST_LAND:
        highest = (rack.normal_tooth_thickness - LEAST_LAND) / 2 / tangent
        permitted = f"must be at most {at_most(highest / m - rack.rack.addendum)} (pointed tooth)"
        raise GeometryError("tip_alteration", rack.tip_alteration, permitted)


def _check_topped(rack: RackData, topping: float) -> None:
    """Raise GeometryError unless a topping tool leaves some flank and some land."""
    tangent = math.tan(math.radians(rack.rack.pressure_angle))
    highest = (rack.normal_tooth_thickness - LEAST_LAND) / 2 / tangent
    if not -rack.form_depth < topping <= highest:
        least = at_least(max(-rack.form_depth, 0.0))
        permitted = f"must be above {least} and at most {at_most(highest)} mm: flank and land are left"
        raise GeometryError("premachining.topping", topping, permitted, "mm")


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
