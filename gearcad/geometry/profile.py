"""ToothProfile: the exact outline of a tooth, external or internal, from which solids, drawings and meshes all start."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, ParameterError, at_least, at_most, require_number
from gearcad.core.records import Floats
from gearcad.geometry.curves import Chamfer, Curve, CurveKind, Fillet, FilletChain, Involute, Land, RootCurve, parameters_within
from gearcad.geometry.involute import inverse_involute, involute_at_roll, root_between
from gearcad.geometry.root_outline import FlankInvolute, RootOutline

if TYPE_CHECKING:
    from gearcad.geometry.fillets import FilletTool

LEAST_LAND = 4e-6
"""Arcs shorter than this (mm) are left out: they are below the tolerance of a solid (and of any machine)."""

RADIUS_SLACK = 1e-9
"""Relative excess of a radius over the tip or under the root that counts as rounding."""


@dataclass(frozen=True, kw_only=True)
class ToothProfile:
    """Exact transverse outline of one external tooth: root land, fillet, involute, tip chamfer, tip land.

    Tooth 0 is centred on +x. `teeth` is any number for the virtual gear of a helical one. Diameters in mm, `base_half_angle`
    (half tooth angle on the base circle) in degrees, `tool` the tip of hob or shaper, `tip_chamfer` its radial height in mm,
    `root` the root that a tool cut before the flanks were finished, in place of what `tool` alone would leave; `ramp` the
    involute that a semi-topping tool cuts in place of a tip chamfer.
    That of a ring is an `InternalProfile`, whose numbers are magnitudes too. Normally obtained as `gear.profile`.
    Raises GeometryError where these make no tooth: pointed, cut off by undercut, or with no involute left.
    """

    teeth: float
    reference_diameter: float
    base_diameter: float
    tip_diameter: float
    root_diameter: float
    base_half_angle: float
    tool: FilletTool
    tip_chamfer: float = 0.0
    root: RootOutline | None = None
    ramp: FlankInvolute | None = None

    internal: ClassVar[bool] = False
    """Whether the tip is inside the root, as on a ring."""

    @property
    def _side(self) -> int:
        """Sign of a step from root to tip along a radius: -1 for a ring, whose tip is inside, otherwise 1."""
        return -1 if self.internal else 1

    def __repr__(self) -> str:
        diameters = f"{self.root_diameter:.6g} to {self.tip_diameter:.6g} mm"
        return f"<{type(self).__name__}: {self.teeth:.6g} teeth, diameters {diameters}>"

    def __post_init__(self) -> None:
        if self.root_diameter <= 0:
            raise GeometryError("root_diameter", self.root_diameter, "must be above 0 mm: the tool reaches the axis", "mm")
        if self.tip_diameter <= self.form_diameter:
            raise GeometryError(
                "tip_diameter",
                self.tip_diameter,
                f"must be above {at_least(self.form_diameter)} mm, the root form circle: no involute is left on the flank",
                "mm",
            )
        self._refuse_pointed()
        if self.ramp is not None:
            self._refuse_wrong_ramp(self.ramp)
        if self.tip_chamfer:
            self._refuse_wrong_chamfer()
        if self.undercut and self._waist < LEAST_LAND:
            raise GeometryError("teeth", self.teeth, "must be more, or the profile shift larger: undercut severs the tooth")

    def _refuse_pointed(self) -> None:
        if self.tip_thickness < LEAST_LAND:
            raise GeometryError(
                "tip_diameter",
                self.tip_diameter,
                f"must be at most {at_most(self._pointed_diameter)} mm (pointed tooth)",
                "mm",
            )

    def _refuse_wrong_chamfer(self) -> None:
        """Raise GeometryError unless the tip chamfer takes material off and leaves some involute and some tip land."""
        deepest = (self.tip_diameter - self.form_diameter) / 2
        if self.tip_chamfer >= deepest:
            raise GeometryError(
                "tip_chamfer",
                self.tip_chamfer,
                f"must be below {at_most(deepest)} mm: no involute is left above the root form circle",
                "mm",
            )
        if self.land_half_angle >= self._tip_half_angle:
            raise GeometryError(
                "tip_chamfer",
                self.tip_chamfer,
                "must be 0 mm: at this tip circle the flank leans in by more than the chamfer's 45 deg",
                "mm",
            )
        if self.tip_diameter * self.land_half_angle < LEAST_LAND:
            raise GeometryError(
                "tip_chamfer",
                self.tip_chamfer,
                f"must be at most {self._widest_chamfer(deepest)} mm: no tip land is left",
                "mm",
            )

    def _refuse_wrong_ramp(self, ramp: FlankInvolute) -> None:
        """Raise GeometryError unless the ramp takes material off the tips and leaves some involute and some tip land."""
        tip, form = self.tip_diameter / 2, self.form_diameter / 2
        key, height = "ramp", self.tip_diameter
        if tip <= ramp.base_radius or float(ramp.half_angle(tip) - self._involute_half_angle(tip)) * tip > -LEAST_LAND:
            raise GeometryError(key, height, "must be less: the ramp does not reach the finished tips", "mm")
        if float(ramp.half_angle(form) - self._involute_half_angle(form)) <= 0:
            raise GeometryError(key, height, "must be more: the ramp leaves no involute above the root form circle", "mm")
        if self.tip_diameter * self.land_half_angle < LEAST_LAND:
            raise GeometryError(key, height, "must be more: the ramp leaves no tip land", "mm")

    def _widest_chamfer(self, deepest: float) -> str:
        """Return the largest tip chamfer (mm, as text) that leaves a land on the tip."""

        def land(chamfer: float) -> float:
            return self.tip_diameter * float(self._chamfer_of(chamfer).polar(1.0)[1]) - 2 * LEAST_LAND

        if land(0.0) <= 0:
            return "0"
        return at_most(root_between(land, 0.0, min(self.tip_chamfer, deepest)))

    # ------------------------------------------------------------------ characteristic circles

    @cached_property
    def undercut(self) -> bool:
        """True if the tool's tip cuts away part of the involute."""
        if self.root is not None:
            return self.root.corner
        return self.tool.undercuts(self.base_diameter / 2, self._sin_transverse_angle)

    @cached_property
    def form_diameter(self) -> float:
        """Root form circle d_Ff (mm), where involute and trochoid meet (ISO 21771)."""
        if self.root is not None:
            return 2 * self.root.form_radius
        if self.undercut:
            return 2 * float(self.tool.cut(self._last_theta)[0])
        return 2 * self.tool.form_radius(self.base_diameter / 2, self._sin_transverse_angle)

    @property
    def tip_form_diameter(self) -> float:
        """Tip form circle |d_Fa| (mm), where the involute ends: the chamfers lie between it and the tip circle."""
        if self.ramp is not None:
            return 2 * self._ramp_start
        return self.tip_diameter - self._side * 2 * self.tip_chamfer

    @cached_property
    def _ramp_start(self) -> float:
        """Radius (mm) at which the ramp of a semi-topping tool leaves the involute."""
        assert self.ramp is not None
        ramp = self.ramp

        def excess(radius: float) -> float:
            return float(ramp.half_angle(radius) - self._involute_half_angle(radius))

        return root_between(excess, self.form_diameter / 2, self.tip_diameter / 2, xtol=1e-15, rtol=8.9e-16)

    @property
    def outer_diameter(self) -> float:
        """Diameter (mm) of the outer one of root and tip circle."""
        return max(self.root_diameter, self.tip_diameter)

    @property
    def tip_thickness(self) -> float:
        """Transverse tooth thickness s_at on the tip circle (mm), before a tip chamfer."""
        return self.tip_diameter * self._tip_half_angle

    @cached_property
    def _tip_half_angle(self) -> float:
        """Half tooth angle on the tip circle (rad), before a tip chamfer."""
        return float(self._involute_half_angle(self.tip_diameter / 2))

    @cached_property
    def _sin_transverse_angle(self) -> float:
        ratio = self.base_diameter / self.reference_diameter
        return math.sqrt((1 - ratio) * (1 + ratio))

    @cached_property
    def _last_theta(self) -> float:
        """theta of the tool tip where the fillet ends: at the tangent point, or where it crosses the involute."""
        end = self.tool.last_angle
        if not self.undercut:
            return end

        base_radius = self.base_diameter / 2
        start = float(self.tool.theta_at(base_radius, end)[0])
        while self.tool.cut(start)[0] < base_radius:
            start = math.nextafter(start, 2.0)

        def excess(theta: float) -> float:
            radius, angle = self.tool.cut(theta)
            return float(self._half_pitch - angle - self._involute_half_angle(max(float(radius), base_radius)))

        if excess(start) >= 0:  # undercut by less than rounding: the curves meet on the base circle
            return start
        if excess(end) <= 0:
            return end
        return root_between(excess, start, end, xtol=1e-15, rtol=8.9e-16)

    @cached_property
    def _pointed_diameter(self) -> float:
        """Diameter (mm) at which the flanks meet, less what a land of LEAST_LAND needs."""
        angle = math.radians(inverse_involute(math.radians(self.base_half_angle)))
        return self.base_diameter / math.cos(angle) - 2 * LEAST_LAND / math.tan(angle)

    @property
    def _waist(self) -> float:
        """Least tooth thickness along the trochoid (mm); negative where undercut cuts the tooth off."""
        s = np.linspace(0.0, 1.0, 65)
        for _ in range(3):
            radius, angle = self.fillet.polar(s)
            thickness = 2 * radius * angle
            least = int(np.argmin(thickness))
            s = np.linspace(s[max(least - 1, 0)], s[min(least + 1, 64)], 65)
        return float(thickness[least])

    # ------------------------------------------------------------------ the outline

    @property
    def _half_pitch(self) -> float:
        return math.pi / self.teeth

    @cached_property
    def fillet(self) -> RootCurve | FilletChain:
        """Fillet curve that the tools leave between root circle and involute."""
        if self.root is not None:
            return self.root.curve
        return Fillet(self.tool, self._last_theta, self._half_pitch)

    @cached_property
    def involute(self) -> Involute:
        """The involute of the flank, from root form circle to tip form circle."""
        return Involute(
            self.base_diameter / 2,
            math.radians(self.base_half_angle),
            self._roll(self.form_diameter / 2),
            self._roll(self.tip_form_diameter / 2),
            internal=self.internal,
        )

    @cached_property
    def _chamfer(self) -> Chamfer | Involute:
        if self.ramp is not None:
            rolls = self.ramp.roll(self._ramp_start), self.ramp.roll(self.tip_diameter / 2)
            return Involute(self.ramp.base_radius, self.ramp.base_half_angle, *rolls, kind=CurveKind.CHAMFER)
        return self._chamfer_of(self.tip_chamfer)

    def _chamfer_of(self, height: float) -> Chamfer:
        tip = self.tip_diameter / 2
        radius = tip - self._side * height
        run = self._side * (math.sqrt(2 * tip**2 - radius**2) - radius) / 2
        return Chamfer(radius, float(self._involute_half_angle(radius)), run, internal=self.internal)

    @property
    def chamfered(self) -> bool:
        """Whether something is between the involute and the tip land."""
        return bool(self.tip_chamfer) or self.ramp is not None

    @cached_property
    def land_half_angle(self) -> float:
        """Half angle (rad) of the tip land that the chamfers leave."""
        if self.chamfered:
            return float(self._chamfer.polar(1.0)[1])
        return self._tip_half_angle

    @cached_property
    def curves(self) -> tuple[Curve, ...]:
        """Curves of half a tooth from the middle of the space to the middle of the tooth.

        The root land is absent where the tool has a full radius, the chamfer where there is none.
        """
        root, tip = self.root_diameter / 2, self.tip_diameter / 2
        start = float(self.fillet.polar(0.0)[1])
        curves: list[Curve] = [*(self.root.pieces if self.root else [self.fillet]), self.involute]
        if 2 * root * (self._half_pitch - start) >= LEAST_LAND:
            curves.insert(0, Land(CurveKind.ROOT, root, self._half_pitch, start))
        if self.chamfered:
            curves.append(self._chamfer)
        return (*curves, Land(CurveKind.TIP, tip, self.land_half_angle, 0.0))

    @property
    def joined_curves(self) -> tuple[Curve, ...]:
        """The curves with all pieces of the fillet as one, for what goes along a fillet as a whole."""
        others = [curve for curve in self.curves if curve.kind is not CurveKind.FILLET]
        at = 1 if others[0].kind is CurveKind.ROOT else 0
        return (*others[:at], self.fillet, *others[at:])

    def half_angle(self, radius: ArrayLike) -> Any:
        """Transverse half tooth angle in degrees at `radius` (mm), on fillet, involute and tip chamfer alike.

        Scalar or array. Raises ParameterError for a radius that is not between root circle and tip circle.
        """
        given, side = np.asarray(radius, float), self._side
        inner, outer = sorted((self.root_diameter / 2, self.tip_diameter / 2))
        outside = ~((given >= inner * (1 - RADIUS_SLACK)) & (given <= outer * (1 + RADIUS_SLACK)))
        if np.any(outside):
            circles = "tip to root circle" if self.internal else "root to tip circle"
            permitted = f"must be from {inner:.10g} to {outer:.10g} mm ({circles})"
            raise ParameterError("radius", float(given[outside].flat[0]), permitted, "mm")
        flat = np.clip(given.ravel(), inner, outer)
        result = np.asarray(self._involute_half_angle(np.maximum(flat, self.base_diameter / 2)))
        low = side * flat < side * self.form_diameter / 2
        if np.any(low):
            result[low] = self.fillet.half_angle(flat[low])
        high = side * flat > side * self.tip_form_diameter / 2
        if self.chamfered and np.any(high):
            result[high] = self._chamfer.half_angle(flat[high])
        degrees = np.degrees(result).reshape(given.shape)
        return float(degrees) if degrees.ndim == 0 else degrees

    def points(self, chord_error: float = 0.001) -> Floats:
        """Return the outline of tooth 0, counter-clockwise from space to space: (n, 2) in mm, within `chord_error` (mm).

        The first and last points are the middles of the two neighbouring spaces.
        """
        require_number("chord_error", chord_error, "mm", above=0)
        halves = [curve.points(parameters_within(curve, chord_error)) for curve in self.curves]
        left = np.concatenate([half[:-1] for half in halves] + [halves[-1][-1:]])
        if self.curves[0].kind is not CurveKind.ROOT:
            left[0] = self.root_diameter / 2 * np.array([math.cos(self._half_pitch), math.sin(self._half_pitch)])
        return np.concatenate([left[:-1] * [1, -1], left[::-1]])

    def contour(self, chord_error: float = 0.001) -> Floats:
        """Return the outline of the whole gear, counter-clockwise: (n, 2) in mm, not repeating the first point."""
        tooth = self.points(chord_error)[:-1]
        angle = 2 * math.pi / self.teeth * np.arange(self.teeth)[:, None]
        cosine, sine = np.cos(angle), np.sin(angle)
        x, y = tooth.T
        return np.stack([cosine * x - sine * y, sine * x + cosine * y], -1).reshape(-1, 2)

    # ------------------------------------------------------------------ involute in radians

    def _roll(self, radius: float) -> float:
        base = self.base_diameter / 2
        return math.sqrt(max((radius - base) * (radius + base), 0.0)) / base

    def _involute_half_angle(self, radius: ArrayLike) -> Any:
        base = self.base_diameter / 2
        radius = np.asarray(radius, float)
        tangent = np.sqrt((radius - base) * (radius + base)) / base
        return math.radians(self.base_half_angle) - self._side * involute_at_roll(tangent)


@dataclass(frozen=True, kw_only=True, repr=False)
class InternalProfile(ToothProfile):
    """Exact transverse outline of one tooth of a ring: root land outside, fillet, involute, tip chamfer, tip land inside.

    Tooth 0 is centred on +x with its tip towards the axis. Diameters (mm), teeth and roll angles are magnitudes;
    `base_half_angle` (degrees) is s_n/(m_n |z|) - inv alpha_t, the half tooth angle at R less inv alpha_R, and may be negative.
    The messages of its errors have the signs of ISO 21771, as users give and read them.
    """

    internal: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if self.tip_diameter <= self.base_diameter:
            permitted = f"must be below {at_most(-self.base_diameter)} mm: an involute begins outside the base circle"
            raise GeometryError("tip_diameter", -self.tip_diameter, permitted, "mm")
        if self.tip_diameter >= self.form_diameter:
            permitted = (
                f"must be above {at_least(-self.form_diameter)} mm, the root form circle: no involute is left on the flank"
            )
            raise GeometryError("tip_diameter", -self.tip_diameter, permitted, "mm")
        if self.tip_thickness < LEAST_LAND:
            permitted = f"must be at most {at_most(-self._pointed_diameter)} mm (pointed tooth)"
            raise GeometryError("tip_diameter", -self.tip_diameter, permitted, "mm")
        if self.tip_chamfer:
            self._refuse_wrong_chamfer()

    def _refuse_wrong_chamfer(self) -> None:
        deepest = (self.form_diameter - self.tip_diameter) / 2
        if self.tip_chamfer >= deepest:
            permitted = f"must be below {at_most(deepest)} mm: no involute is left between it and the root form circle"
            raise GeometryError("tip_chamfer", self.tip_chamfer, permitted, "mm")
        if self.tip_diameter * self.land_half_angle < LEAST_LAND:
            permitted = f"must be at most {self._widest_chamfer(deepest)} mm: no tip land is left"
            raise GeometryError("tip_chamfer", self.tip_chamfer, permitted, "mm")

    @cached_property
    def _pointed_diameter(self) -> float:
        """Diameter (mm) at which the flanks meet, and what a land of LEAST_LAND needs; a tooth is pointed inside it."""
        angle = math.radians(inverse_involute(max(math.radians(-self.base_half_angle), 0.0)))
        return self.base_diameter / math.cos(angle) + 2 * LEAST_LAND / max(math.tan(angle), 1e-3)
