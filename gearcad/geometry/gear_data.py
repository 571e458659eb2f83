"""GearData: what is given of a gear, the sizes that follow by formula (ISO 21771), and checks of its body.

Raises GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Annotated

import numpy as np

from gearcad.core.errors import GeometryError, at_least, at_most
from gearcad.core.quantities import NOT_GIVEN, Derived, Range, Whole, Words, is_given
from gearcad.core.records import Floats
from gearcad.geometry.fits import ToothAllowance, tooth_thickness_allowance
from gearcad.geometry.gear_parts import ISO53_A, BasicRack, Body, DoubleHelix, NormalDiametralPitch, NormalModule, ShaperCutter
from gearcad.geometry.making import Making
from gearcad.geometry.modification import FlankModification
from gearcad.geometry.premachining import Finishing, Premachining
from gearcad.geometry.toothed import FaceWidth, GearSizes, HelixAngle, TipAlteration, ToothedPart, ToothThinning

if TYPE_CHECKING:
    from gearcad.geometry.profile import ToothProfile

_TEETH = Whole(3, 2000, negative=(-10, "internal gear"))

_DIAMETER = Range("mm", -2e6, 2e6)
"""Range of given diameters, negative on a ring: no permitted teeth and module make a larger gear."""


_ROUGHNESS = Range("µm", 0.01, 1000)

_NO_THINNING = Derived(0.0)

_GAP_DEPTH = 0.5
"""Difference of the root circle's diameter and that between the halves of a double helical gear, in normal modules."""


@dataclass(frozen=True, kw_only=True)
class GearData(GearSizes[float], ToothedPart):
    """The fields of a `Gear`, unchecked, and sizes that need no outline of a tooth. Lengths in mm, angles in degrees.

    Those of an internal gear have the signs of ISO 21771: teeth and diameters are negative.
    """

    name: Annotated[str, Words("name")] = "gear"
    teeth: Annotated[int, _TEETH, Words("number of teeth", "z", "4.1")]
    normal_module: NormalModule = NOT_GIVEN
    normal_diametral_pitch: NormalDiametralPitch = NOT_GIVEN
    face_width: FaceWidth
    helix_angle: HelixAngle = 0.0
    profile_shift: Annotated[float, Range("", -5, 5), Words("profile shift coefficient", "x", "4.2")] = 0.0
    tip_alteration: TipAlteration = 0.0
    tooth_thinning: ToothThinning = _NO_THINNING
    tooth_allowance: Annotated[str | None, Words("tooth thickness allowance", "", "DIN 3967")] = None
    accuracy_grade: Annotated[int | None, Whole(0, 12), Words("accuracy grade", "", "ISO 1328-1")] = None
    flank_roughness: Annotated[float | None, _ROUGHNESS, Words("roughness of the flanks", "Rz")] = None
    root_roughness: Annotated[float | None, _ROUGHNESS, Words("roughness of the roots", "Rz")] = None
    tool: Annotated[str | None, Words("tool of the shelf")] = None
    rack: BasicRack = field(default=ISO53_A)
    cutter: ShaperCutter = field(default=ShaperCutter())
    premachining: Premachining = field(default=Premachining())
    finishing: Finishing = field(default=Finishing())
    making: Making = field(default=Making())
    double_helix: DoubleHelix = field(default=DoubleHelix())
    body: Body = field(default=Body())
    modification: FlankModification = field(default=FlankModification())
    tip_diameter: Annotated[float, _DIAMETER, Words("tip diameter", "d_a", "4.5")] = NOT_GIVEN
    root_diameter: Annotated[float, _DIAMETER, Words("root diameter", "d_f", "4.5")] = NOT_GIVEN

    @property
    def internal(self) -> bool:
        """Whether the gear is internal (a ring): z < 0."""
        return self.teeth < 0

    @property
    def tooth_count(self) -> int:
        """Number of teeth |z|."""
        return abs(self.teeth)

    @property
    def profile_shift_khk(self) -> float | None:
        """The profile shift of a ring as KHK and many programs read it, with the opposite sign; None for an external gear."""
        return 0.0 - self.profile_shift if self.internal else None

    @property
    def given_root_diameter(self) -> float | None:
        """Root diameter d_f that is prescribed; None where it follows from the rack."""
        return self.root_diameter if is_given(self.root_diameter) else None

    @property
    def tool_addendum(self) -> float:
        """Addendum of the tool that cuts the roots, in normal modules."""
        return self.premachining.addendum_of(self.normal_module) if self.premachining.present else self.rack.dedendum

    @property
    def standard_tip_diameter(self) -> float:
        """d_a = d + 2 m_n (h_aP + x + k), or d + 2 (x m_n + h_fP0) where the root of the tool cuts the tips."""
        topping = self.premachining.topping
        if topping is None:
            return super().standard_tip_diameter
        return self.reference_diameter + 2 * (self.profile_shift * self.normal_module + topping)

    @property
    def root_radius(self) -> float:
        """Radius of the tip of the tool that cuts the roots, in normal modules, with "full" resolved."""
        return super().root_radius if self.premachining.tool_tip_radius is None else self.premachining.tool_tip_radius

    @property
    def root_cutter(self) -> ShaperCutter:
        """Shaper cutter that makes the roots, be it before the flanks are finished; without teeth there is none."""
        pre = self.premachining
        if not pre.present:
            return self.cutter
        return ShaperCutter(teeth=pre.cutter_teeth, profile_shift=pre.cutter_profile_shift, tip_radius=pre.tool_tip_radius)

    @property
    def root_thinning(self) -> float:
        """Reduction of the normal tooth thickness (mm) of the teeth as they are described here."""
        return self.tooth_thinning

    @property
    def stock(self) -> float:
        """Stock q (mm, normal) on each flank of these teeth; 0 where nothing is finished."""
        return self.premachining.stock_of(self.normal_module) if self.premachining.present else 0.0

    @property
    def stock_angle(self) -> float:
        """Half tooth angle (rad) of the stock on one flank: q/(r_b cos beta_b)."""
        return self.stock / (abs(self.base_diameter) / 2 * math.cos(math.radians(self.base_helix_angle)))

    @cached_property
    def thickness_allowance(self) -> ToothAllowance | None:
        """A_sne and A_sni of `tooth_allowance`; None without one, whose thinning is exact."""
        if self.tooth_allowance is None:
            return None
        return tooth_thickness_allowance(self.tooth_allowance, self.reference_diameter, self.tooth_thinning)

    @property
    def lead(self) -> float:
        """Lead p_z = pi d / tan |beta|; infinite for a spur gear."""
        if self.helix_angle == 0:
            return math.inf
        return math.pi * abs(self.reference_diameter) / math.tan(math.radians(abs(self.helix_angle)))

    @property
    def gap_diameter(self) -> float:
        """Diameter between the halves of a double helical gear (mm)."""
        if self.double_helix.gap_diameter is not None:
            return self.double_helix.gap_diameter
        return self.root_diameter - _GAP_DEPTH * self.normal_module

    @property
    def half_width(self) -> float:
        """Width of teeth of one hand (mm): of one half of a double helical gear, b_B = (b - b_g)/2, else b."""
        gap = self.double_helix.gap_width
        return self.face_width if gap is None else (self.face_width - gap) / 2

    @property
    def twist(self) -> float:
        """Rotation of the section over the width of one hand in degrees (magnitude): 360 b / p_z."""
        return 0.0 if self.helix_angle == 0 else 360 * self.half_width / self.lead


def twist(gear: GearData, height: float = 1.0) -> float:
    """Return the angle (rad) by which the section at a height z (mm) is turned: z tan(beta)/r, positive for a right-hand helix.

    That of 1 mm is the twist rate (rad/mm).
    """
    return height * math.tan(math.radians(gear.helix_angle)) / (abs(gear.reference_diameter) / 2)


def height_in_half(gear: GearData, heights: Floats) -> Floats:
    """Return the heights z (mm) above the outer end of the half that they are in: halves of double helical gears are mirror
    images.
    """
    if not gear.double_helix.present:
        return heights
    below: Floats = np.minimum(heights, gear.face_width - heights)
    return below


def section_turn(gear: GearData, heights: Floats) -> Floats:
    """Return the angles (rad) by which sections at heights z (mm) are turned, those of the upper half of a double helical gear
    too.
    """
    turned = twist(gear) * height_in_half(gear, heights)
    if not gear.double_helix.offset:
        return turned
    pitch = 2 * math.pi / gear.tooth_count
    on: Floats = turned + np.where(heights > gear.face_width / 2, pitch * gear.double_helix.offset, 0.0)
    return on


def first_touch(gear: GearData, profile: ToothProfile, pressure_angle: float) -> float:
    """Return the place (mm from T1, along the line of action) of the left flank of tooth 0 while that tooth points at the mate.

    r_b (psi_b + alpha_wt), psi_b the half tooth angle on the base circle; `pressure_angle` is the working transverse one
    (degrees). Turned by phi (rad, counter-clockwise) the flank is r_b phi further on, the other left flanks whole base pitches
    away. Right flanks are as far along the mirrored line, and r_b phi back.
    """
    return gear.base_diameter / 2 * math.radians(profile.base_half_angle + pressure_angle)


LEAST_RIM = 0.1
"""Least wall between what is on a body - bore, keyway, hub, bolt holes, rim - and the root circle, in normal modules."""


def check_body(gear: GearData) -> None:
    """Raise GeometryError unless the body is possible.

    Bore, keyway and hub must leave a rim, the end chamfers some end face; a ring must fit in its rim.
    """
    (_check_ring if gear.internal else _check_disc)(gear)
    if gear.double_helix.gap_width:
        _check_gap(gear)


def _check_gap(gear: GearData) -> None:
    """Raise GeometryError unless the gap of a double helical gear lies below its teeth and leaves a wall round the bore.

    The wall is also round the keyway.
    """
    wall = 2 * LEAST_RIM * gear.normal_module
    least, most = gear.body.opening_diameter + wall, gear.root_diameter - wall
    if not least <= gear.gap_diameter <= most:
        permitted = f"must be from {at_least(least)} to {at_most(most)} mm, between bore and root circle"
        raise GeometryError("double_helix.gap_diameter", gear.gap_diameter, permitted, "mm")


RING_RIM_LIMIT = 3.5
"""Thickness of a ring's rim, in normal modules, from which it is as stiff as a solid body (ISO 6336-1, clause 9)."""


def outer_diameter(ring: GearData) -> float:
    """Return the diameter (mm) of a ring's rim or, where none is given, of a rim that is as stiff as a solid body."""
    rim = ring.body.rim_diameter
    return abs(ring.root_diameter) + 2 * RING_RIM_LIMIT * ring.normal_module if rim is None else rim


def least_rim_diameter(gear: GearData) -> float:
    """Return the least rim diameter (mm) of a ring, with some wall outside its root circle."""
    return abs(gear.root_diameter) + 2 * LEAST_RIM * gear.normal_module


def _check_ring(gear: GearData) -> None:
    """Raise GeometryError if the body outside the teeth of a ring is not possible.

    Checks rim, bolt holes and end chamfers, and that no parts for external gears are given.
    """
    body = gear.body
    if body.step is not None:
        raise GeometryError("body.step", body.step, "must be left out: it is for external gears")
    for name in ("bore", "keyway_width", "hub_diameter"):
        if getattr(body, name):
            raise GeometryError(f"body.{name}", getattr(body, name), "must be left out: it is for external gears", "mm")
    root, least = abs(gear.root_diameter), least_rim_diameter(gear)
    if body.rim_diameter is not None and body.rim_diameter < least:
        permitted = f"must be at least {at_least(least)} mm (a rim of {LEAST_RIM} m_n outside the root circle {root:.6g} mm)"
        raise GeometryError("body.rim_diameter", body.rim_diameter, permitted, "mm")
    if body.bolt_holes:
        _check_bolt_circle(gear)
        _check_bolt_holes(gear)
    if body.end_chamfer:
        outside = math.inf if body.rim_diameter is None else body.rim_diameter
        free = body.bolt_circle - body.bolt_diameter if body.bolt_holes else outside
        _check_end_chamfer(gear, (free - 2 * LEAST_RIM * gear.normal_module - abs(gear.tip_diameter)) / 2)


def _check_bolt_circle(gear: GearData) -> None:
    """Raise GeometryError unless bolt holes leave a wall outside the root circle and inside the rim."""
    body, wall = gear.body, 2 * LEAST_RIM * gear.normal_module
    inner = abs(gear.root_diameter) + wall + body.bolt_diameter
    outer = math.inf if body.rim_diameter is None else body.rim_diameter - wall - body.bolt_diameter
    walls = f"walls of {LEAST_RIM} m_n to the root circle {abs(gear.root_diameter):.6g} mm and to the rim"
    most = math.inf if body.rim_diameter is None else (body.rim_diameter - abs(gear.root_diameter)) / 2 - wall
    if body.bolt_diameter > most:
        room = "must be left out" if most <= 0 else f"must be at most {at_most(most)} mm"
        raise GeometryError("body.bolt_diameter", body.bolt_diameter, f"{room} ({walls})", "mm")
    if not inner <= body.bolt_circle <= outer:
        most_of_all = "" if math.isinf(outer) else f" and at most {at_most(outer)} mm"
        permitted = f"must be at least {at_least(inner)} mm{most_of_all} ({walls})"
        raise GeometryError("body.bolt_circle", body.bolt_circle, permitted, "mm")


def _check_bolt_holes(gear: GearData) -> None:
    """Raise GeometryError unless bolt holes leave a wall between each other."""
    body = gear.body
    most = math.floor(math.pi / math.asin((body.bolt_diameter + LEAST_RIM * gear.normal_module) / body.bolt_circle))
    if body.bolt_holes > max(most, 1):
        permitted = f"must be at most {most}, to leave walls of {LEAST_RIM} m_n between holes of {body.bolt_diameter:.6g} mm"
        raise GeometryError("body.bolt_holes", body.bolt_holes, permitted)


def _check_disc(gear: GearData) -> None:
    """Raise GeometryError if the body inside the teeth of an external gear is not possible.

    Checks bore, keyway, hub, rim thickness and end chamfers, and that no parts for internal gears are given.
    """
    for name in ("rim_diameter", "bolt_circle"):
        if getattr(gear.body, name):
            raise GeometryError(f"body.{name}", getattr(gear.body, name), "must be left out: it is for internal gears", "mm")
    body, wall = gear.body, LEAST_RIM * gear.normal_module
    if body.step is not None and gear.double_helix.present:
        raise GeometryError("body.step", body.step, "must be left out for double helical teeth")
    root = gear.root_diameter - 2 * wall
    rim = f"a rim of {LEAST_RIM} m_n inside the root circle {gear.root_diameter:.6g} mm"
    for name, opening in (
        ("bore", body.bore),
        ("keyway_depth", body.opening_diameter),
        ("hub_diameter", body.hub_diameter),
    ):
        if opening > root:
            spare = f"must be at most {at_most(max(root, 0))} mm ({rim})"
            if name == "bore" and body.bore_spline:
                spare += f"; it is the root circle of {body.bore_spline}"
            if name == "keyway_depth":
                spare = f"must leave {rim}: bore and keyway reach out to diameter {opening:.6g} mm"
            raise GeometryError(f"body.{name}", getattr(body, name), spare, "mm")
    if body.hub_diameter and body.opening_diameter > body.hub_diameter - 2 * wall:
        least = body.opening_diameter + 2 * wall
        raise GeometryError(
            "body.hub_diameter", body.hub_diameter, f"must be at least {at_least(least)} mm, to hold bore and keyway", "mm"
        )
    if body.rim_thickness > (deep := (gear.root_diameter - body.opening_diameter) / 2):
        permitted = f"must be at most {at_most(deep)} mm, what bore and keyway leave below the root circle"
        raise GeometryError("body.rim_thickness", body.rim_thickness, permitted, "mm")
    if body.end_chamfer:
        between = gear.gap_diameter if gear.double_helix.gap_width else 0.0
        least_face = max(body.opening_diameter, body.hub_diameter, between) + 2 * wall
        _check_end_chamfer(gear, (gear.tip_diameter - least_face) / 2)


def _check_end_chamfer(gear: GearData, deepest: float) -> None:
    """Raise GeometryError if end chamfers reach deeper than `deepest` (mm, along the radius from the tip circle)."""
    length = gear.body.end_chamfer
    slope = math.tan(math.radians(gear.body.end_chamfer_angle))
    most = min(0.49 * gear.half_width, deepest / slope)
    if length > most:
        raise GeometryError(
            "body.end_chamfer",
            length,
            f"must be at most {at_most(max(most, 0))} mm at {gear.body.end_chamfer_angle:g} deg"
            " (0.49 of the face width, and some end face left)",
            "mm",
        )
