"""GearData: what is given of a gear, the sizes that follow by formula (ISO 21771), and the tool that cuts its teeth.

A tooth that is thinned comes from a thicker tooth of the tool. Angles are radians in here.

Raises GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Annotated

import numpy as np

from gearcad.core.errors import GeometryError, at_least, at_most
from gearcad.core.quantities import NOT_GIVEN, Derived, Range, Whole, Words, is_given
from gearcad.core.records import Floats, Notice
from gearcad.geometry.fillets import FilletTool, ShaperTip, ToolTip
from gearcad.geometry.fits import ToothAllowance, tooth_thickness_allowance
from gearcad.geometry.gear_parts import ISO53_A, BasicRack, Body, DoubleHelix, NormalDiametralPitch, NormalModule, ShaperCutter
from gearcad.geometry.involute import inverse_involute, involute, root_between
from gearcad.geometry.modification import FlankModification
from gearcad.geometry.profile import ToothProfile
from gearcad.geometry.toothed import FaceWidth, GearSizes, HelixAngle, TipAlteration, ToothedPart, ToothThinning

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
    rack: BasicRack = field(default=ISO53_A)
    cutter: ShaperCutter = field(default=ShaperCutter())
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
    """Angle (rad) by which the section at a height z (mm) is turned: z tan(beta)/r, positive for a right-hand helix.

    That of 1 mm is the twist rate (rad/mm).
    """
    return height * math.tan(math.radians(gear.helix_angle)) / (abs(gear.reference_diameter) / 2)


def height_in_half(gear: GearData, heights: Floats) -> Floats:
    """Heights z (mm) above the outer end of the half that they are in: halves of double helical gears are mirror images."""
    if not gear.double_helix.present:
        return heights
    below: Floats = np.minimum(heights, gear.face_width - heights)
    return below


def section_turn(gear: GearData, heights: Floats) -> Floats:
    """Angles (rad) by which sections at heights z (mm) are turned, those of the upper half of a double helical gear too."""
    turned = twist(gear) * height_in_half(gear, heights)
    if not gear.double_helix.offset:
        return turned
    pitch = 2 * math.pi / gear.tooth_count
    on: Floats = turned + np.where(heights > gear.face_width / 2, pitch * gear.double_helix.offset, 0.0)
    return on


_ROUNDING = 1e-14
"""Share by which the full radius is taken less, for both corners to fit."""


def shaped(gear: GearData) -> bool:
    """Whether the fillets are those of a cutter's corner, not of a rack: on rings, and where a shaper cutter is named."""
    return gear.internal or gear.cutter.teeth is not None


def fillet_tool(gear: GearData) -> FilletTool:
    """The rounded tip of what cuts the fillets, once the tool is known to be feasible."""
    if shaped(gear):
        return shaper_tip(gear, corner_radius(gear))
    m, shift = gear.normal_module, gear.profile_shift * gear.normal_module
    return ToolTip.cutting(
        normal_module=m,
        pressure_angle=math.radians(gear.rack.pressure_angle),
        helix_angle=math.radians(gear.helix_angle),
        reference_radius=gear.reference_diameter / 2,
        depth=gear.dedendum * m - shift,
        shift=shift,
        radius=gear.root_radius * m,
        thinning=gear.tooth_thinning,
    )


def generating_involute(gear: GearData, teeth: int) -> float:
    """inv alpha_w0 = inv alpha_t + 2 tan alpha_n (x + x_0)/(z + z_0); not above 0 where a cutter of z_0 teeth cannot work."""
    shift = 2 * math.tan(math.radians(gear.rack.pressure_angle)) * (gear.profile_shift + gear.cutter.profile_shift)
    return involute(gear.transverse_pressure_angle) + shift / (gear.teeth + teeth)


def line_of_generation(gear: GearData, teeth: int) -> float:
    """a_0 sin alpha_w0 (mm): the line of action between the base circles of the gear and a cutter of z_0 teeth."""
    working = math.radians(inverse_involute(generating_involute(gear, teeth)))
    return abs(1 + teeth / gear.teeth) * abs(gear.base_diameter) / 2 * math.tan(working)


def shaper_tip(gear: GearData, radius: float) -> ShaperTip:
    """The cutter's corner of a radius in normal modules, as it is set to reach the root circle.

    Without a cutter that of the ring's own counterpart, which has |z| teeth, the profile shift -x and the ring's axis.
    """
    m, teeth, own = gear.normal_module, gear.cutter.teeth or gear.tooth_count, gear.cutter.teeth is None
    angle, root = math.radians(gear.transverse_pressure_angle), abs(gear.root_diameter) / 2
    apart = 0.0 if own else _centre_distance(gear, teeth)
    shift = -gear.profile_shift if own else gear.cutter.profile_shift
    thickness = m * (math.pi / 2 + 2 * shift * math.tan(math.radians(gear.rack.pressure_angle))) + gear.tooth_thinning
    return ShaperTip(
        radius=radius * m,
        base_radius=teeth * gear.transverse_module / 2 * math.cos(angle),
        base_half_angle=thickness / (m * teeth) + involute(gear.transverse_pressure_angle),
        helix_angle=math.radians(gear.helix_angle),
        centre_distance=apart,
        root_radius=root,
        teeth=gear.tooth_count,
        cutter_teeth=teeth,
        internal=gear.internal,
    )


def _centre_distance(gear: GearData, teeth: int) -> float:
    """a_0 = |z + z_0| m_t cos alpha_t/(2 cos alpha_w0), a magnitude (mm)."""
    working = math.radians(inverse_involute(generating_involute(gear, teeth)))
    angle = math.radians(gear.transverse_pressure_angle)
    return abs(gear.teeth + teeth) * gear.transverse_module / 2 * math.cos(angle) / math.cos(working)


@lru_cache(maxsize=4)
def full_corner_radius(gear: GearData) -> float:
    """Largest radius of the corner (in normal modules), where both corners of the cutter's tip meet: psi_M = 0.

    Negative where even a sharp cutter's flanks meet before its tip circle, or that lies inside its base circle.
    """
    sharp, m = shaper_tip(gear, 0.0), gear.normal_module
    most = (sharp.tip_radius - sharp.base_radius) / m * (1 - _ROUNDING)
    if most < 0 or sharp.middle_angle < 0:
        return -1.0

    def room(radius: float) -> float:
        return shaper_tip(gear, radius).middle_angle

    if room(most) >= 0:  # the corner then reaches down to the cutter's base circle
        return most

    return root_between(room, 0.0, most, xtol=1e-15, rtol=8.9e-16) * (1 - _ROUNDING)


def corner_radius(gear: GearData) -> float:
    """Radius of the corner in normal modules: the cutter's own, else the rack's or the full one, whichever is smaller."""
    if gear.cutter.tip_radius is not None:
        return gear.cutter.tip_radius
    full = full_corner_radius(gear)
    return full if gear.rack.root_radius == "full" else min(float(gear.rack.root_radius), full)


def corner_notices(gear: GearData) -> Iterator[Notice]:
    """Yield a notice if the radius of the cutter's corner was assumed: no cutter is given, or the full radius replaces the
    rack's.
    """
    if not shaped(gear):
        return
    radius, rack = corner_radius(gear), gear.rack.root_radius
    full = gear.cutter.tip_radius is None and rack != "full" and radius < float(rack)
    instead = f", the full radius: the rack's {rack:g} does not fit" if full else ""
    size = f"{radius:.4g} m_n ({radius * gear.normal_module:.4g} mm){instead}"
    if gear.cutter.teeth is None:
        yield Notice("form-root", f"form root: no cutter given; the radius of the fillet is {size}")
    elif full:
        yield Notice("full-radius", f"cutter: the radius of its tip corner is {size}")


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
    """Least rim diameter (mm) of a ring, with some wall outside its root circle."""
    return abs(gear.root_diameter) + 2 * LEAST_RIM * gear.normal_module


def _check_ring(gear: GearData) -> None:
    """Raise GeometryError if the body outside the teeth of a ring is not possible.

    Checks rim, bolt holes and end chamfers, and that no parts for external gears are given.
    """
    body = gear.body
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
    root = gear.root_diameter - 2 * wall
    rim = f"a rim of {LEAST_RIM} m_n inside the root circle {gear.root_diameter:.6g} mm"
    for name, opening in (
        ("bore", body.bore),
        ("keyway_depth", body.opening_diameter),
        ("hub_diameter", body.hub_diameter),
    ):
        if opening > root:
            spare = f"must be at most {at_most(max(root, 0))} mm ({rim})"
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
