"""Teeth and body as they are made: outline scaled by the shrinkage and moved out by an offset, exactly.

Every piece of the nominal outline is scaled, then its parallel taken; root, fillet, flank and tip stay separate curves. Where
two pieces meet in a corner that the step opens, the flank and the tip circle go on until they meet (a body), or an arc about
the corner joins them (the path of a wire or beam); where it closes, both are cut where they cross. Lengths in mm, angles in
radians.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, ParameterError, at_most
from gearcad.geometry.curves import Curve, CurveKind, Fillet, FilletChain, Involute, Land
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.gear_parts import LEAST_FEATURE, Body
from gearcad.geometry.involute import root_between
from gearcad.geometry.making import Making
from gearcad.geometry.parallels import (
    Corner,
    CrossingFault,
    ParallelCurve,
    ScaledCurve,
    crossing,
    leaves,
    parallel_involute,
    part_of,
    reaches,
    runs_on,
)
from gearcad.geometry.profile import LEAST_LAND, RADIUS_SLACK, ToothProfile

_SMOOTH = 1e-10
"""Length (mm) of a corner's arc that counts as none."""

_PLACES = 129


@dataclass(frozen=True, kw_only=True, repr=False)
class MadeProfile(ToothProfile):
    """Outline of a tooth as it is made: `outline` from the middle of the space to the middle of the tooth.

    Its diameters are those as made; `base_half_angle` is that of the flank's involute where the flank is one.
    """

    outline: tuple[Curve, ...]

    def __post_init__(self) -> None:
        """Leave the checks to `MadeTeeth`."""

    @property
    def curves(self) -> tuple[Curve, ...]:
        """The curves of half a tooth."""
        return self.outline

    @property
    def undercut(self) -> bool:
        """Whether the fillet meets the flank in a corner."""
        last, first = float(self.fillet.direction(1.0)), float(self.involute.direction(0.0))
        return abs(math.remainder(first - last, 2 * math.pi)) > 1e-9

    @cached_property
    def fillet(self) -> Any:
        """Everything between root land and flank, as one curve."""
        pieces = tuple(curve for curve in self.outline if curve.kind is CurveKind.FILLET)
        return pieces[0] if len(pieces) == 1 else FilletChain(pieces)  # type: ignore[arg-type]

    @cached_property
    def involute(self) -> Any:
        """The flank: an involute unless teeth shrink otherwise than radii."""
        return next(curve for curve in self.outline if curve.kind is CurveKind.INVOLUTE)

    @property
    def form_diameter(self) -> float:
        """Diameter (mm) at which the flank begins."""
        return 2 * float(self.involute.polar(0.0)[0])

    @property
    def tip_form_diameter(self) -> float:
        """Diameter (mm) at which the flank ends."""
        return 2 * float(self.involute.polar(1.0)[0])

    @property
    def land_half_angle(self) -> float:
        """Half angle (rad) of the tip land."""
        return float(self.outline[-1].polar(0.0)[1])

    def half_angle(self, radius: ArrayLike) -> Any:
        """Half tooth angle in degrees at radii (mm) between root and tip circle. Raises ParameterError outside."""
        given = np.asarray(radius, float)
        degrees = np.degrees([self._half_angle_at(each) for each in given.ravel().tolist()]).reshape(given.shape)
        return float(degrees) if degrees.ndim == 0 else degrees

    def _half_angle_at(self, radius: float) -> float:
        inner, outer = sorted((self.root_diameter / 2, self.tip_diameter / 2))
        if not inner * (1 - RADIUS_SLACK) <= radius <= outer * (1 + RADIUS_SLACK):
            circles = "tip to root circle" if self.internal else "root to tip circle"
            raise ParameterError("radius", radius, f"must be from {inner:.10g} to {outer:.10g} mm ({circles})", "mm")
        for curve in self.outline:
            first, last = (float(curve.polar(s)[0]) - radius for s in (0.0, 1.0))
            if first * last <= 0 and first != last and not isinstance(curve, Land):
                s = root_between(lambda s, curve=curve: float(curve.polar(s)[0]) - radius, 0.0, 1.0, xtol=1e-16)  # type: ignore[misc]
                return float(curve.polar(s)[1])
        return self.land_half_angle


class MadeInternalProfile(MadeProfile):
    """Outline of a ring's tooth as it is made."""

    internal: ClassVar[bool] = True


@dataclass(frozen=True)
class MadeTeeth:
    """Teeth of a gear as they are made, from its inputs `gear` and its nominal `profile`.

    `rounded`: as the path of a wire or beam, with its half width, and with arcs about the corners. `set_back` (mm) is taken
    off the outline besides. Raises GeometryError, in the words of the keys of `making`, where this leaves no outline.
    """

    gear: GearData
    nominal: ToothProfile
    rounded: bool = False
    set_back: float = 0.0

    def __post_init__(self) -> None:
        making, gear = self.making, self.gear
        if making.cuts and gear.helix_angle:
            permitted = f'must be 0 deg for process "{making.process}": a straight cut makes no helical teeth'
            raise GeometryError("helix_angle", gear.helix_angle, permitted, "deg")
        if gear.body.step is not None:
            raise GeometryError("body.step", gear.body.step, "must be left out beside making: the blank is not scaled")
        if self.root_radius <= LEAST_LAND or self.tip_radius <= LEAST_LAND:
            raise self._fault("no tooth is left")
        self.profile  # noqa: B018 - checks the outline

    @property
    def making(self) -> Making:
        return self.gear.making

    @property
    def _out(self) -> int:
        """Sign of a step out of the material along a radius."""
        return -1 if self.gear.internal else 1

    @property
    def offset(self) -> float:
        """Step e (mm) out of the material after scaling."""
        return self.making.offset - self.set_back + (self.making.path_offset if self.rounded else 0.0)

    @cached_property
    def angular_scale(self) -> float:
        """Scale of half tooth angles: that of the thickness over that of the radii."""
        return 1.0 if self.making.shrinkage_tangential is None else self.making.tangential_scale / self.making.radial_scale

    @cached_property
    def twist(self) -> float:
        """Angle (rad) by which the section turns for each mm along the axis."""
        slope = math.tan(math.radians(self.gear.helix_angle)) / (abs(self.gear.reference_diameter) / 2)
        return slope / self.making.axial_scale

    @property
    def base_radius(self) -> float:
        """Base radius (mm) of the scaled flank; of one that is an involute."""
        return self.making.radial_scale * abs(self.gear.base_diameter) / 2

    @property
    def tip_radius(self) -> float:
        """Radius (mm) of the tip circle."""
        return self.making.radial_scale * self.nominal.tip_diameter / 2 + self._out * self.offset

    @property
    def root_radius(self) -> float:
        """Radius (mm) of the root circle."""
        return self.making.radial_scale * self.nominal.root_diameter / 2 + self._out * self.offset

    # ------------------------------------------------------------------ the outline

    @cached_property
    def profile(self) -> MadeProfile:
        """The outline of a tooth as it is made."""
        nominal, scale = self.nominal, self.making.radial_scale
        outline = self._outline()
        kind = MadeInternalProfile if self.gear.internal else MadeProfile
        flank = next(curve for curve in outline if curve.kind is CurveKind.INVOLUTE)
        half = flank.base_half_angle if isinstance(flank, Involute) else math.radians(nominal.base_half_angle)
        made = kind(
            teeth=nominal.teeth,
            reference_diameter=nominal.reference_diameter * scale,
            base_diameter=nominal.base_diameter * scale,
            tip_diameter=2 * self.tip_radius,
            root_diameter=2 * self.root_radius,
            base_half_angle=math.degrees(half),
            tool=nominal.tool,
            outline=outline,
        )
        self._check(made)
        return made

    def _outline(self) -> tuple[Curve, ...]:
        self._check_tool()
        inner = [curve for curve in self.nominal.curves if not isinstance(curve, Land)]
        try:
            flank = self._joined(inner, [self._moved(curve) for curve in inner])
        except CrossingFault:
            raise self._fault("the parallel of its outline crosses itself") from None
        half_pitch, start = math.pi / self.gear.tooth_count, float(flank[0].polar(0.0)[1])
        if 2 * self.root_radius * (half_pitch - start) >= LEAST_LAND:
            flank.insert(0, Land(CurveKind.ROOT, self.root_radius, half_pitch, start))
        return (*flank, Land(CurveKind.TIP, self.tip_radius, float(flank[-1].polar(1.0)[1]), 0.0))

    def _moved(self, curve: Curve) -> Curve:
        """Return a piece of the outline, scaled and moved out."""
        scale, angular = self.making.radial_scale, self.angular_scale
        if angular == 1 and isinstance(curve, Involute):
            return parallel_involute(replace(curve, base_radius=curve.base_radius * scale), self.offset, self.twist)
        scaled = curve if scale == angular == 1 else ScaledCurve(curve, scale, angular)
        return ParallelCurve(scaled, self.offset, self.twist, self.gear.internal) if self.offset else scaled

    def _joined(self, nominal: list[Curve], moved: list[Curve]) -> list[Curve]:
        """Return the moved pieces, joined where their nominal ones meet, up to the tip circle."""
        found = moved[:1]
        for one, other, after in zip(nominal, nominal[1:], moved[1:], strict=False):
            found += self._corner(one, other, found.pop(), after)
        return [*found[:-1], *self._to_tip(nominal[-1], found[-1])]

    def _corner(self, one: Curve, other: Curve, before: Curve, after: Curve) -> list[Curve]:
        """Return two moved pieces with what is between them."""
        if not self.offset:
            return [before, after]
        turn = math.remainder(self._heading(other, 0.0) - self._heading(one, 1.0), 2 * math.pi)
        if isinstance(after, Involute) and after.kind is CurveKind.INVOLUTE and after.first < 0:
            return self._left(before, after)
        if abs(turn * self.offset) < _SMOOTH:
            return [before, after]
        if self._out * turn * self.offset < 0:  # the corner opens
            if self.rounded or after.kind is not CurveKind.CHAMFER:
                kind = CurveKind.CHAMFER if after.kind is CurveKind.CHAMFER else CurveKind.FILLET
                return [before, self._arc(one, 1.0, turn, kind), after]
        elif after.kind is CurveKind.INVOLUTE and not self.gear.internal and isinstance(after, Involute):
            return self._left(before, after)
        a, b = crossing(before, after)
        return [part_of(before, 0.0, a), part_of(after, b, 1.0)]

    def _left(self, fillet: Curve, flank: Involute) -> list[Curve]:
        """Return a fillet's piece up to where it crosses the flank, and the flank from there."""
        at = leaves(fillet, flank)
        radius = float(fillet.polar(at)[0])
        roll = math.sqrt((radius - flank.base_radius) * (radius + flank.base_radius)) / flank.base_radius
        return [part_of(fillet, 0.0, at), replace(flank, first=roll)]

    def _heading(self, curve: Curve, s: float) -> float:
        return float(self._scaled(curve).direction(s))

    def _scaled(self, curve: Curve) -> Curve:
        return ScaledCurve(curve, self.making.radial_scale, self.angular_scale)

    def _arc(self, curve: Curve, s: float, turn: float, kind: CurveKind) -> Curve:
        """Return the arc about the end of a nominal piece."""
        radius, angle = (float(each) for each in self._scaled(curve).polar(s))
        heading = self._heading(curve, s)
        corner = Corner(radius, angle, heading, heading + turn, kind)
        return ParallelCurve(corner, self.offset, self.twist, self.gear.internal)

    def _to_tip(self, nominal: Curve, last: Curve) -> list[Curve]:
        """Return the last piece up to the tip circle, or with an arc about the corner there."""
        if not self.offset:
            return [last]
        if self.rounded and self.offset > 0:
            angle = float(self._scaled(nominal).polar(1.0)[1])
            turn = math.remainder(angle - math.pi / 2 - self._heading(nominal, 1.0), 2 * math.pi)
            if -self._out * turn * self.offset > _SMOOTH:
                return [last, self._arc(nominal, 1.0, turn, CurveKind.CHAMFER)]
        return [part_of(last, 0.0, reaches(last, self.tip_radius))]

    # ------------------------------------------------------------------ checks

    def _fault(self, why: str, key: str = "offset") -> GeometryError:
        making, path = self.making, ""
        if self.rounded:
            path = f" (with half the kerf and the spark gap {self.offset:.6g} mm)"
            key = "kerf" if making.kerf else "offset"
        if self.set_back:
            return GeometryError("making.first_layer", making.first_layer, f"must be less: {why} at the lower end", "mm")
        if not self.offset:
            key = "shrinkage_radial" if making.shrinkage_tangential is None else "shrinkage_tangential"
            return GeometryError(f"making.{key}", getattr(making, key), f"must be nearer to 0 %: {why}", "%")
        return GeometryError(f"making.{key}", getattr(making, key), f"must be nearer to 0 mm: {why}{path}", "mm")

    def _check_tool(self) -> None:
        """Raise GeometryError where the tip radius of the tool that would leave the parallel is negative."""
        pieces = [curve for curve in self.nominal.curves if isinstance(curve, Fillet)]
        radii = [radius for curve in pieces if (radius := getattr(curve.tool, "radius", None)) is not None]
        least = min(radii, default=math.inf) * min(self.making.radial_scale, self.making.tangential_scale)
        if self.offset > least:
            most = max(least - (self.offset - self.making.offset), 0.0)
            reason = f"the fillets, of tip radius {least:.6g} mm, have no parallel beyond that"
            if self.rounded and self.making.offset <= least:
                widest = 2 * (least - self.making.offset - self.making.spark_gap)
                permitted = f"must be at most {at_most(max(widest, 0.0))} mm with this spark gap and offset: {reason}"
                key = "kerf" if widest > 0 or not self.making.spark_gap else "spark_gap"
                raise GeometryError(f"making.{key}", getattr(self.making, key), permitted, "mm")
            raise GeometryError("making.offset", self.making.offset, f"must be at most {at_most(most)} mm: {reason}", "mm")

    def _check(self, made: MadeProfile) -> None:
        """Raise GeometryError unless the outline is that of a tooth."""
        half_pitch, internal = math.pi / self.gear.tooth_count, self.gear.internal
        s = np.linspace(0.0, 1.0, _PLACES)
        pieces = [curve for curve in made.curves if not isinstance(curve, Land)]
        if not all(runs_on(curve) for curve in pieces):
            raise self._fault("the parallel of its outline crosses itself")
        if (made.tip_diameter <= made.base_diameter) if internal else (made.tip_diameter <= made.form_diameter):
            raise self._fault("no flank is left")
        for curve in pieces:
            radius, half = curve.polar(s)
            if np.any(radius * half < LEAST_LAND / 2):
                raise self._fault("the tooth closes")
            if np.any(half > half_pitch * (1 + 1e-12) + 1e-12):
                raise self._fault("the space between two teeth closes")
        if 2 * self.tip_radius * made.land_half_angle < LEAST_LAND:
            raise self._fault("no tip land is left")

    # ------------------------------------------------------------------ what gauges find

    @property
    def base_cosine(self) -> float:
        """Cosine of the base helix angle."""
        return 1 / math.hypot(1.0, self.twist * self.base_radius)

    def thickness_at(self, radius: float) -> float:
        """Normal tooth thickness (mm) on a circle."""
        normal = math.cos(math.atan(self.twist * radius))
        return 2 * radius * math.radians(self.profile.half_angle(radius)) * normal

    def span_over(self, teeth: int) -> float | None:
        """Span measurement W_k (mm) over external teeth; None where flanks are no involutes, and for a ring."""
        flank = self.profile.involute
        if self.gear.internal or not isinstance(flank, Involute):
            return None
        pitch = 2 * math.pi / self.gear.tooth_count
        return self.base_radius * self.base_cosine * ((teeth - 1) * pitch + 2 * flank.base_half_angle)

    def ball_centre(self, ball: float, *, cavity: bool = False) -> float | None:
        """Return the radius (mm) of the centre of a ball that touches two flanks; None where it does not.

        It is in a space of the teeth, or in the `cavity` that a tooth fills.
        """
        flank = self.profile.involute
        middle = 0.0 if cavity else math.pi / self.gear.tooth_count
        path = ParallelCurve(flank, -ball / 2 if cavity else ball / 2, self.twist, self.gear.internal)

        def excess(s: float) -> float:
            return float(path.polar(s)[1]) - middle

        return float(path.polar(_root(excess))[0]) if excess(0.0) * excess(1.0) <= 0 else None

    def over_balls(self, ball: float, *, cavity: bool = False) -> float | None:
        """Return the dimension (mm) over two balls in spaces of a gear, between two in those of a ring; or in the `cavity`."""
        centre = self.ball_centre(ball, cavity=cavity)
        if centre is None:
            return None
        odd = math.cos(math.pi / (2 * self.gear.tooth_count)) if self.gear.tooth_count % 2 else 1.0
        between = self.gear.internal != cavity
        return 2 * centre * odd - ball if between else 2 * centre * odd + ball

    def cavity_ball(self) -> float | None:
        """Return the diameter (mm) of a ball that touches the cavity of a tooth near the middle of the flank, to two digits."""
        flank = self.profile.involute

        def excess(ball: float) -> float:
            path = ParallelCurve(flank, -ball / 2, self.twist, self.gear.internal)
            return float(path.polar(0.5)[1])

        most = 4 * float(flank.polar(0.5)[0]) * float(flank.polar(0.5)[1])
        if excess(most) > 0:
            return None
        found = root_between(excess, 0.0, most)
        return float(f"{found:.2g}") if found < 10 else round(found, 1)

    def cavity_document(self) -> dict[str, float | None]:
        """Return the ball (mm) for the cavities of the teeth, and the dimension with two of them; None where none fits."""
        ball = self.cavity_ball()
        name = "over_balls" if self.gear.internal else "between_balls"
        return {"ball_diameter": ball, name: None if ball is None else self.over_balls(ball, cavity=True)}

    # ------------------------------------------------------------------ the body

    @property
    def face_width(self) -> float:
        """Face width (mm), scaled along the axis."""
        return self.gear.face_width * self.making.axial_scale

    @cached_property
    def body(self) -> Body:
        """The body, scaled; outer walls moved out, those of bore and holes in. Raises GeometryError for one that vanishes."""
        given, radial, axial = self.gear.body, self.making.radial_scale, self.making.axial_scale
        if given.bore_spline:
            permitted = "must be a number beside a table making: the teeth of a splined bore have no correction"
            raise GeometryError("body.bore", given.bore_spline, permitted)
        if self.rounded and given.keyway_width and self.offset >= self._keyway_wall:
            raise self._fault(f"the keyway's walls are {self._keyway_wall:.6g} mm high")
        step, growth = 2 * self.offset, 0.0 if self.rounded else self.making.hole_growth
        slope = math.tan(math.radians(given.end_chamfer_angle)) * radial / axial
        changed: dict[str, Any] = {
            "keyway": False,
            "bore": self._hole("bore", radial * given.bore - step + growth),
            "keyway_width": self._hole("keyway_width", radial * given.keyway_width - step),
            "keyway_depth": self._hole("keyway_depth", radial * given.keyway_depth - growth / 2),
            "bolt_diameter": self._hole("bolt_diameter", radial * given.bolt_diameter - step + growth),
            "bolt_circle": radial * given.bolt_circle,
            "hub_diameter": self._hole("hub_diameter", radial * given.hub_diameter + step),
            "hub_length": axial * given.hub_length,
            "end_chamfer": axial * given.end_chamfer,
            "end_chamfer_angle": math.degrees(math.atan(slope)),
            "tip_chamfer": 0.0,
            "web_thickness": 0.0,
            "rim_thickness": 0.0,
            "rim_diameter": None if given.rim_diameter is None else radial * given.rim_diameter + step,
        }
        return replace(given, **changed)

    @property
    def _keyway_wall(self) -> float:
        """Height (mm) of the walls of the keyway, from the bore to its floor."""
        body = self.gear.body
        return body.bore / 2 + body.keyway_depth - math.sqrt(body.bore**2 - body.keyway_width**2) / 2

    def _hole(self, name: str, size: float) -> float:
        if not getattr(self.gear.body, name):
            return 0.0
        if size < LEAST_FEATURE:
            why = f"body.{name} would be {size:.6g} mm, less than {LEAST_FEATURE} mm"
            if self.making.hole_growth < 0:
                raise GeometryError("making.hole_growth", self.making.hole_growth, f"must be nearer to 0 mm: {why}", "mm")
            raise self._fault(why)
        return size


def _root(function: Callable[[float], float]) -> float:
    return root_between(function, 0.0, 1.0, xtol=1e-16)
