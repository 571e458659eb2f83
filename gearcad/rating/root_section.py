"""Root section of a tooth by ISO 6336-3:2006, or of the fillet that the tool really generates; virtual gears; rings; racks.

Lengths in mm, angles in degrees; equations are those of ISO 6336-3:2006. A spur gear is its own virtual gear; the equations
hold for rings with the signs of ISO 21771.

An external tooth is cut where tangents at 30 degrees to its middle touch the fillet, that of a ring at 60 degrees. The
standard's E, G, H and theta describe the very trochoid of a hob that gear.profile is made of, so both ways give the same
section there. For the roots of rings and shaped gears the standard has a substitute rack, which is far from a shaper cutter
(see `ring_formula`); their section is taken from the generated fillet. That is ours: no clause of the standard says so.

They are shown beside the section of the generated fillet, which rates the ring: the substitute rack is far from the cutter
where the profile shift is large. To be verified: the formulas are as remembered, and as they agree with values computed
elsewhere; z_n is signed throughout, rho_F included, as the generated fillet wants it.

Lengths in mm, angles in degrees, but in units of the normal module and radians inside the formulas.

The standard has no clause on racks. Its equations of external gears have this limit: tangents at 30 degrees to the middle of
the tooth, in the normal section, and a load that leans by the pressure angle. Lengths in mm, angles in degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Generic, cast

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError
from gearcad.core.records import Bools, Floats
from gearcad.core.values import (
    Numbers,
    Values,
    arccos,
    arctan2,
    cos,
    degrees,
    hypot,
    radians,
    root,
    sin,
    smaller,
    tan,
    with_sign,
)
from gearcad.geometry import Gear, Rack, involute
from gearcad.geometry.fillets import FilletTool, ShaperTip, ToolTip
from gearcad.geometry.gear_tools import corner_radius, shaped
from gearcad.geometry.involute import inverse_involute, root_between
from gearcad.geometry.toothed import GearSizes


@dataclass(frozen=True, kw_only=True)
class VirtualGear(Generic[Values]):
    """Spur gear with the teeth of a helical gear's normal section. Lengths in mm, the pressure angle in degrees.

    `teeth` z_n is any number. `tooth_angle` s_n/(m_n z_n) is the half tooth angle on the reference circle, in degrees.
    Of a ring number of teeth, diameters and half tooth angles are negative.
    """

    normal_module: Values
    pressure_angle: float
    teeth: Values
    reference_diameter: Values
    base_diameter: Values
    tip_diameter: Values
    tooth_angle: Values

    @classmethod
    def of(cls, gear: GearSizes[Values]) -> VirtualGear[Values]:
        """Return the virtual spur gear: z_n (21), d_n (24), d_bn (26), d_an = d_n + d_a - d (27), with the tip form circle for
        d_a.
        """
        m_n, z_n, alpha_n = gear.normal_module, gear.virtual_teeth, gear.rack.pressure_angle
        d_n = m_n * z_n
        return VirtualGear(
            normal_module=m_n,
            pressure_angle=alpha_n,
            teeth=z_n,
            reference_diameter=d_n,
            base_diameter=d_n * math.cos(math.radians(alpha_n)),
            tip_diameter=d_n + gear.tip_form_diameter - gear.reference_diameter,
            tooth_angle=degrees(gear.normal_tooth_thickness / d_n),
        )

    @property
    def side(self) -> Values:
        """The sign of its diameters."""
        return with_sign(1.0, self.teeth)

    def half_angle(self, diameter: Values) -> Values:
        """Return half tooth angle (degrees) of the involute at a diameter (mm) that is not inside the base circle."""
        at = degrees(arccos(smaller(self.base_diameter / diameter, 1.0)))
        return self.tooth_angle + degrees(involute(self.pressure_angle) - involute(at))


@dataclass(frozen=True, kw_only=True)
class LoadPoint(Generic[Values]):
    """Outer point of single pair contact on the virtual gear: diameter d_en (mm), angles alpha_en, gamma_e, alpha_Fen (deg).

    Diameter and half angle are negative on a ring.
    """

    diameter: Values
    pressure_angle: Values
    half_angle: Values
    load_angle: Values

    def to_dict(self) -> dict[str, Values]:
        """Return the values under their symbols."""
        return {"d_en": self.diameter, "alpha_Fen": self.load_angle}


def load_point(virtual: VirtualGear[Values], virtual_contact_ratio: Values) -> LoadPoint[Values]:
    """Return the outer point of single pair contact, from the virtual contact ratio eps_alphan = eps_alpha/cos^2 beta_b.

    d_en = 2 sqrt((sqrt(d_an^2/4 - d_bn^2/4) - p_bn (eps_alphan - 1))^2 + d_bn^2/4) (28), p_bn = pi m_n cos alpha_n;
    alpha_en = arccos(d_bn/d_en) (29), gamma_e = s_n/(m_n z_n) + inv alpha_n - inv alpha_en (30),
    alpha_Fen = alpha_en - gamma_e (31). On a ring the root of (28) is negative, as all lengths from its base circle are.
    """
    r_an, r_bn = virtual.tip_diameter / 2, virtual.base_diameter / 2
    p_bn = math.pi * virtual.normal_module * math.cos(math.radians(virtual.pressure_angle))
    side = virtual.side
    along = side * root((r_an - r_bn) * (r_an + r_bn)) - p_bn * (virtual_contact_ratio - 1)
    d_en = side * 2 * hypot(along, r_bn)
    alpha_en = degrees(arctan2(side * along, side * r_bn))
    gamma_e = virtual.half_angle(d_en)
    return LoadPoint(diameter=d_en, pressure_angle=alpha_en, half_angle=gamma_e, load_angle=alpha_en - gamma_e)


def lever_of(load: LoadPoint[Values]) -> Values:
    """Return twice the height at which the load meets the centre line: (cos gamma_e - sin gamma_e tan alpha_Fen) d_en (mm), of
    (18).
    """
    gamma_e, alpha_fen = radians(load.half_angle), radians(load.load_angle)
    return (cos(gamma_e) - sin(gamma_e) * tan(alpha_fen)) * load.diameter


def virtual_tool(gear: Gear, virtual: VirtualGear[float]) -> FilletTool:
    """Return the tip of the tool, set to cut the virtual gear; for a spur gear this is its own tool.

    A hob stays what it is; a shaper cutter becomes its own virtual spur gear, with z_0 z_n/z teeth, the same shift and corner.
    Raises GeometryError where that cannot reach the virtual gear's root.
    """
    tool = gear.profile.tool
    if not gear.helix_angle:
        return tool
    if isinstance(tool, ToolTip):
        return _virtual_hob(gear, virtual, tool)
    return _virtual_shaper(gear, virtual, tool.radius) if isinstance(tool, ShaperTip) else tool


def _virtual_hob(gear: Gear, virtual: VirtualGear[float], tool: ToolTip) -> ToolTip:
    """Return the tip of a hob set to cut the virtual gear, rolling on r_bn/cos alpha_n0: r_n unless its lead is short."""
    rolling = virtual.reference_diameter / 2
    if math.isclose(tool.pressure_angle, math.radians(gear.rack.pressure_angle), rel_tol=1e-12):
        return replace(tool, helix_angle=0.0, reference_radius=rolling)
    at = virtual.base_diameter / 2 / math.cos(tool.pressure_angle)
    half = math.radians(virtual.half_angle(2 * at))
    v = tool.radius - (at - rolling + (gear.reference_diameter - gear.root_diameter) / 2)
    space = at * (math.pi / virtual.teeth - half)
    residual = gear.residual_undercut
    u = space + v * math.tan(tool.pressure_angle) - (tool.radius - residual) / math.cos(tool.pressure_angle)
    return replace(tool, helix_angle=0.0, reference_radius=at, u=u, v=v)


def _virtual_shaper(gear: Gear, virtual: VirtualGear[float], radius: float) -> ShaperTip:
    """Return the tip of the shaper cutter for the virtual gear, with a corner of `radius` (mm).

    Without a cutter it is the gear's own counterpart, on the gear's axis. Raises GeometryError if such a tip is not feasible.
    """
    cutter, angle = gear.root_cutter, math.radians(virtual.pressure_angle)
    m, own, z_n = gear.normal_module, cutter.teeth is None, virtual.teeth
    z_0 = abs(z_n) if cutter.teeth is None else cutter.teeth * z_n / gear.teeth
    shift = -gear.profile_shift if own else cutter.profile_shift
    apart = 0.0 if own else _centre_distance(gear, virtual, z_0)
    root = abs(virtual.reference_diameter + gear.root_diameter - gear.reference_diameter) / 2
    thickness = m * (math.pi / 2 + 2 * shift * math.tan(angle)) + gear.tooth_thinning
    tip = ShaperTip(
        radius=radius,
        base_radius=z_0 * m / 2 * math.cos(angle),
        base_half_angle=(thickness + 2 * gear.residual_undercut / math.cos(angle)) / (m * z_0)
        + involute(virtual.pressure_angle),
        helix_angle=0.0,
        centre_distance=apart,
        root_radius=root,
        teeth=abs(z_n),
        cutter_teeth=z_0,
        internal=gear.internal,
    )
    if not tip.feasible:
        raise _unreachable(gear)
    return tip


def _centre_distance(gear: Gear, virtual: VirtualGear[float], cutter_teeth: float) -> float:
    """a_0 (mm), by inv alpha_w0 = inv alpha_n + 2 tan alpha_n (x + x_0)/(z_n + z_n0)."""
    teeth, angle = virtual.teeth + cutter_teeth, math.radians(virtual.pressure_angle)
    shift = gear.profile_shift + gear.root_cutter.profile_shift
    working = involute(virtual.pressure_angle) + 2 * math.tan(angle) * shift / teeth
    if working <= 0:
        raise _unreachable(gear)
    apart = abs(teeth) * gear.normal_module / 2
    return apart * math.cos(angle) / math.cos(math.radians(inverse_involute(working)))


def _unreachable(gear: Gear) -> GeometryError:
    permitted = "must be others for a rating: in the normal section the cutter does not reach the root of the virtual gear"
    return GeometryError("cutter.teeth", gear.root_cutter.teeth, permitted)


_LEAN, _RING_LEAN = 30.0, 60.0
"""Angle (deg) between the middle of the tooth and the tangents at the section, of external teeth and of rings."""

_STEP, _OFFSETS, _SLOPE = 1e-3, np.array([-2.0, -1.0, 1.0, 2.0]), np.array([1.0, -8.0, 8.0, -1.0])
"""Step of theta (rad) for slopes along the fillet; places in steps, and their weights."""

_SHARP = 1e-4
"""Radius of the fillet, in normal modules, below which its section is a sharp corner."""


@dataclass(frozen=True, kw_only=True)
class RootSection(Generic[Values]):
    """Section at the 30-degree tangents: `tangent_angle` theta (deg), chord s_Fn, fillet radius rho_F, and the arm h_Fe (mm).

    `lean` (deg) is the angle of the tangents to the middle of the tooth, 60 on a ring. `on_fillet` is False where the tangent
    would touch beyond the fillet, on the flank: then the formulas do not hold.
    """

    tangent_angle: Values
    chord: Values
    fillet_radius: Values
    moment_arm: Values
    on_fillet: bool | Bools
    lean: float = _LEAN

    @property
    def notch_parameter(self) -> Values:
        """Notch parameter q_s = s_Fn/(2 rho_F) (38)."""
        return self.chord / (2 * self.fillet_radius)


def lean_of(gear: Gear) -> float:
    """Return the angle (deg) of the tangents at its root section to the middle of the tooth."""
    return _RING_LEAN if gear.internal else _LEAN


def root_section(gear: Gear, virtual: VirtualGear[float], load: LoadPoint[float]) -> RootSection[float]:
    """Return the section at the tangents to the fillet, and the arm at which the load bends it.

    Raises GeometryError for teeth without such a section, as of a gear with three.
    """
    if shaped(gear) or gear.premachining.tool_pressure_angle is not None or gear.premachining.tool_module is not None:
        return generated_section(gear, virtual, load)
    section = hob_section(gear, virtual, load)
    if math.isnan(section.tangent_angle):
        raise _no_tangent(gear)
    return section


# ---------------------------------------------------------------------- cut by a hob


def tool_half_width(gear: GearSizes[Values]) -> Values:
    """E (10) (mm): from the middle of the tool's tooth to the centre of its tip arc.

    pi m_n/4 - h_fP tan alpha_n + s_pr/cos alpha_n - (1 - sin alpha_n) rho_fP/cos alpha_n, plus half the tooth thinning.
    """
    m_n, alpha_n = gear.normal_module, math.radians(gear.rack.pressure_angle)
    corner = (1 - math.sin(alpha_n)) * gear.root_radius / math.cos(alpha_n)
    return (
        m_n * (math.pi / 4 - gear.dedendum * math.tan(alpha_n) - corner)
        + gear.tooth_thinning / 2
        + gear.residual_undercut / math.cos(alpha_n)
    )


_ARRAY_STEPS, _SETTLED = 6, 1e-12
"""Newton's steps for arrays; the change of theta (rad) in the last step beyond which there is no tangent."""


def tangent_angle(g: Values, h: Values, virtual_teeth: Values) -> Values:
    """theta (rad) of theta = (2 G/z_n) tan theta - H (14), by Newton from the standard's pi/6; nan where there is none."""
    slope = 2 * g / virtual_teeth
    if isinstance(slope, np.ndarray) or isinstance(h, np.ndarray):
        return cast(Values, _tangent_angles(slope, h))
    return _tangent_angle_of_one(slope, h)


def _tangent_angle_of_one(slope: float, h: float) -> float:
    theta, step = math.pi / 6, math.inf
    for _ in range(50):
        step = (theta - slope * math.tan(theta) + h) / (1 - slope / math.cos(theta) ** 2)
        theta -= step
        if abs(step) < 1e-15:
            break
    return theta if abs(step) < _SETTLED and 1e-9 < theta < math.pi / 2 else math.nan


def _tangent_angles(slope: Numbers, h: Numbers) -> Floats:
    """Return the angles by six steps each: steps for the few that never settle would cost all."""
    theta = step = np.full(np.broadcast_shapes(np.shape(slope), np.shape(h)), math.pi / 6)
    for _ in range(_ARRAY_STEPS):
        tangent = np.tan(theta)
        step = (theta - slope * tangent + h) / (1 - slope * (1 + tangent**2))
        theta = theta - step
    return np.where((np.abs(step) < _SETTLED) & (theta > 1e-9) & (theta < math.pi / 2), theta, np.nan)


def hob_section(gear: GearSizes[Values], virtual: VirtualGear[Values], load: LoadPoint[Values]) -> RootSection[Values]:
    """Return the root section by the equations for a hob, with the gear's own rack; nan for teeth without such a section.

    G = rho_fP/m_n - h_fP/m_n + x (12), H = (2/z_n) (pi/2 - E/m_n) - pi/3 (13), then s_Fn (15), rho_F (17) and h_Fe (18).
    """
    m_n, z_n, rho = gear.normal_module, virtual.teeth, gear.root_radius
    g = rho - gear.dedendum + gear.profile_shift
    theta = tangent_angle(g, 2 / z_n * (math.pi / 2 - tool_half_width(gear) / m_n) - math.pi / 3, z_n)
    cosine = cos(theta)
    centre = g / cosine - rho
    s_fn = z_n * sin(math.pi / 3 - theta) + math.sqrt(3) * centre
    rho_f = rho + 2 * g**2 / (cosine * (z_n * cosine**2 - 2 * g))
    height = z_n * cos(math.pi / 3 - theta) + centre
    return RootSection(
        tangent_angle=degrees(theta),
        chord=m_n * s_fn,
        fillet_radius=m_n * rho_f,
        moment_arm=m_n * (lever_of(load) / m_n - height) / 2,
        # Undercut takes away only the top of the fillet, where it leans by less than the involute there.
        on_fillet=theta <= math.pi / 2 - math.radians(virtual.pressure_angle),
    )


def _no_tangent(gear: Gear) -> GeometryError:
    return GeometryError("teeth", gear.teeth, "must be more for a rating: no tangent at 30 deg touches the fillet")


# ---------------------------------------------------------------------- on the generated fillet


def generated_section(gear: Gear, virtual: VirtualGear[float], load: LoadPoint[float]) -> RootSection[float]:
    """Return the root section on the fillet that the tool generates on the virtual gear.

    Chord, radius of curvature and place are those of the curve.

    The force is tangential to the base circle, so it meets the middle of the tooth at r_bn/cos alpha_Fen. Raises GeometryError
    for teeth without such a section, with a sharp corner there, or whose load passes beyond it.
    """
    fillet = _GeneratedFillet(virtual_tool(gear, virtual), math.pi / abs(virtual.teeth), gear.internal)
    theta = fillet.theta_at(math.radians(lean_of(gear)))
    if theta is None:
        permitted = f"must be others for a rating: no tangent at {lean_of(gear):g} deg touches the fillet"
        raise GeometryError("teeth", gear.teeth, permitted)
    (x,), (y,) = fillet.points(np.array([theta]))
    radius, meets = fillet.curvature_radius(theta), virtual.base_diameter / 2 / math.cos(math.radians(load.load_angle))
    arm = float(meets - virtual.side * x)
    if radius < _SHARP * gear.normal_module:
        permitted = f"must be above {_SHARP:g} for a rating: stress has no limit in a sharp corner"
        raise GeometryError("cutter.tip_radius", corner_radius(gear), permitted)
    if arm <= 0:
        permitted = "must be others for a rating: the load passes beyond the root section, and does not bend the tooth"
        raise GeometryError("profile_shift", gear.profile_shift, permitted)
    return RootSection(
        tangent_angle=math.degrees(theta),
        chord=float(2 * y),
        fillet_radius=radius,
        moment_arm=arm,
        on_fillet=True,
        lean=lean_of(gear),
    )


@dataclass(frozen=True)
class _GeneratedFillet:
    """What a tool's tip cuts from a tooth on +x (y > 0), by its angle theta (rad); `internal` with the tip inside the root."""

    tool: FilletTool
    half_pitch: float
    internal: bool

    def points(self, theta: Floats) -> tuple[Floats, Floats]:
        """Return x and y (mm) of the points."""
        radius, angle = self.tool.cut(theta)
        return radius * np.cos(self.half_pitch - angle), radius * np.sin(self.half_pitch - angle)

    def lean(self, theta: ArrayLike) -> Floats:
        """Return the angle (rad) between the tangent and the middle of the tooth: a right angle on the root circle, falling
        from there.
        """
        direction = self.tool.direction(theta, self.half_pitch)
        return math.pi + direction if self.internal else -direction

    def theta_at(self, lean: float) -> float | None:
        """Return the angle theta (rad) at which the fillet leans by `lean` (rad), or None if it has no such point."""
        if not self.lean(0.0) > lean > self.lean(self.tool.last_angle):
            return None
        return root_between(lambda theta: float(self.lean(theta)) - lean, 0.0, self.tool.last_angle, xtol=1e-15, rtol=8.9e-16)

    def curvature_radius(self, theta: float) -> float:
        """Return the radius of curvature (mm), from differences of fourth order along the curve."""
        near = theta + _STEP * _OFFSETS
        (x, y), lean = self.points(near), self.lean(near)
        return float(math.hypot(_SLOPE @ x, _SLOPE @ y) / abs(_SLOPE @ lean))


def substitute_radius(gear: Gear, cutter_teeth: int) -> float:
    """rho_fPv (mm) of the rack that stands for the cutter: rho_fP + (x_0 + h_fP - rho_fP)^1.95/(3.156 1.036^z_0) in m_n."""
    rho, reach = corner_radius(gear), gear.root_cutter.profile_shift + gear.dedendum
    return gear.normal_module * (rho + math.pow(max(reach - rho, 0.0), 1.95) / (3.156 * math.pow(1.036, cutter_teeth)))


def ring_section(gear: Gear, virtual: VirtualGear[float], load: LoadPoint[float], radius: float) -> RootSection[float] | None:
    """Return the section at the 60-degree tangents of a ring whose substitute rack has a tip of `radius` rho_fPv (mm).

    G = rho_fPv - h_fP + x, H = (2/z_n) (pi/2 - E) - pi/6, theta as of external gears; then
    s_Fn = z_n sin(pi/6 - theta) + G/cos theta - rho_fPv, rho_F = rho_fPv + 2 G^2/(cos theta (z_n cos^2 theta - 2 G)),
    h_Fe = ((cos gamma_e - sin gamma_e tan alpha_Fen) d_en - z_n cos(pi/6 - theta) - sqrt(3) (G/cos theta - rho_fPv))/2.
    None where they give no section.
    """
    m_n, z_n, rho = gear.normal_module, virtual.teeth, radius / gear.normal_module
    g = rho - gear.dedendum + gear.profile_shift
    h = 2 / z_n * (math.pi / 2 - _half_width(gear, rho)) - math.pi / 6
    theta = tangent_angle(g, h, z_n)
    if math.isnan(theta):
        return None
    centre = g / math.cos(theta) - rho
    s_fn = z_n * math.sin(math.pi / 6 - theta) + centre
    rho_f = rho + 2 * g**2 / (math.cos(theta) * (z_n * math.cos(theta) ** 2 - 2 * g))
    h_fe = (lever_of(load) / m_n - z_n * math.cos(math.pi / 6 - theta) - math.sqrt(3) * centre) / 2
    if min(s_fn, rho_f, h_fe) <= 0:
        return None
    return RootSection(
        tangent_angle=math.degrees(theta),
        chord=m_n * s_fn,
        fillet_radius=m_n * rho_f,
        moment_arm=m_n * h_fe,
        on_fillet=True,
        lean=lean_of(gear),
    )


def _half_width(gear: Gear, rho: float) -> float:
    """E/m_n = pi/4 - h_fP tan alpha_n - (1 - sin alpha_n) rho/cos alpha_n, and half the thinning; `rho` in normal modules."""
    alpha_n = math.radians(gear.rack.pressure_angle)
    corner = (1 - math.sin(alpha_n)) * rho / math.cos(alpha_n)
    return math.pi / 4 - gear.dedendum * math.tan(alpha_n) - corner + gear.tooth_thinning / gear.normal_module / 2


_RACK_ROOT_LEAN = math.radians(30)


@dataclass(frozen=True, kw_only=True)
class RackLoadPoint(LoadPoint[float]):
    """Outer point of single pair contact on a rack, `height` (mm) above its reference line."""

    height: float

    def to_dict(self) -> dict[str, float]:
        """Return the values under their symbols: there is no diameter."""
        return {"h_en": self.height, "alpha_Fen": self.load_angle}


def virtual_rack(rack: Rack) -> VirtualGear[float]:
    """Return the normal section of a rack: a gear of infinite size."""
    return VirtualGear(
        normal_module=rack.normal_module,
        pressure_angle=rack.rack.pressure_angle,
        teeth=math.inf,
        reference_diameter=math.inf,
        base_diameter=math.inf,
        tip_diameter=math.inf,
        tooth_angle=0.0,
    )


def rack_load_point(rack: Rack, virtual_contact_ratio: float) -> RackLoadPoint:
    """Return the outer point of single pair contact on a rack.

    It is eps_alphan - 1 base pitches down the line of action from the tip.
    """
    angle = math.radians(rack.rack.pressure_angle)
    down = (virtual_contact_ratio - 1) * rack.normal_pitch * math.cos(angle) * math.sin(angle)
    return RackLoadPoint(
        diameter=math.inf,
        pressure_angle=rack.rack.pressure_angle,
        half_angle=0.0,
        load_angle=rack.rack.pressure_angle,
        height=rack.tip_form_height - down,
    )


def rack_section(rack: Rack, load: RackLoadPoint) -> RootSection[float]:
    """Return the section at the 30-degree tangents, and the arm at which the load bends it.

    The middle of the arc is u = s_n/2 + (h_f - rho) tan alpha_n + (rho - s_pr)/cos alpha_n from that of the tooth, with the
    residual undercut s_pr. Raises GeometryError for a rack without fillets, or whose load passes below the section.
    """
    angle, rho = math.radians(rack.rack.pressure_angle), rack.root_radius * rack.normal_module
    if rho <= 0:
        raise GeometryError("rack.rack.root_radius", 0.0, "must be above 0 for a rating: stress has no limit in a sharp corner")
    depth = rack.root_depth - rho
    u = rack.normal_tooth_thickness / 2 + depth * math.tan(angle) + (rho - rack.residual_undercut) / math.cos(angle)
    half_chord, foot = u - rho * math.cos(_RACK_ROOT_LEAN), -depth - rho * math.sin(_RACK_ROOT_LEAN)
    half_thickness = rack.normal_tooth_thickness / 2 - load.height * math.tan(angle)
    arm = load.height - half_thickness * math.tan(angle) - foot
    if arm <= 0:
        permitted = "must be less for a rating: the load passes below the root section, and does not bend the tooth"
        raise GeometryError("rack.rack.pressure_angle", rack.rack.pressure_angle, permitted, "deg")
    return RootSection(
        tangent_angle=90 - math.degrees(_RACK_ROOT_LEAN),
        chord=2 * half_chord,
        fillet_radius=rho,
        moment_arm=arm,
        on_fillet=angle <= _RACK_ROOT_LEAN,
    )
