"""Inspection of teeth (ISO 21771): span, dimension over balls and pins, chords, and their limits.

All lengths in mm, angles in degrees. Tooth thinning is included: these are the dimensions of the gear as cut.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from gearcad.core.errors import GeometryError, at_least, at_most, require_number, require_whole
from gearcad.core.records import Notice
from gearcad.geometry.fits import ToothAllowance
from gearcad.geometry.involute import base_half_angle, inverse_involute, involute, root_between

if TYPE_CHECKING:
    from gearcad.geometry.gear_data import GearData

_FARTHEST_CENTRE = math.radians(75)
"""Largest pressure angle at the centre of a suggested ball: there its dimension is 3.9 times the base circle."""


class ChordalThickness(NamedTuple):
    """Chordal thickness in the normal section on the reference circle, and height of its chord below the tip circle (mm)."""

    thickness: float
    height: float


@dataclass(frozen=True, kw_only=True)
class Inspection:
    """Inspection of the teeth of an external gear by gauges; a ring has an `InternalInspection`.

    `middle_diameter` is where a gauge had best touch: d + 2 x m_n, kept on the involute. `base_half_angle` is the half tooth
    angle on the base circle, `addendum` (mm) stands over the reference circle, `lead` is infinite for a spur gear. Teeth,
    diameters and `base_half_angle` have the signs of ISO 21771; what a gauge reads is positive.
    """

    spanned_is: ClassVar[str] = "teeth"
    """Word for what lies between the anvils of a span."""

    teeth: int
    normal_module: float
    pressure_angle: float
    helix_angle: float
    transverse_pressure_angle: float
    base_helix_angle: float
    base_diameter: float
    normal_tooth_thickness: float
    base_half_angle: float
    middle_diameter: float
    addendum: float
    lead: float

    # ------------------------------------------------------------------ over teeth

    @property
    def _normal_base_pitch(self) -> float:
        return math.pi * self.normal_module * math.cos(math.radians(self.pressure_angle))

    def span_measurement(self, teeth: int) -> float:
        """Base tangent length over `teeth` teeth: W_k = (k - 1) p_bn + s_bn (ISO 21771).

        s_bn = cos alpha_n (s_n + z m_n inv alpha_t). Raises ParameterError unless 1 <= k <= z.
        """
        require_whole("span_teeth", teeth, at_least=1, at_most=self.teeth)
        cosine = math.cos(math.radians(self.pressure_angle))
        across = self.normal_tooth_thickness + self.teeth * self.normal_module * involute(self.transverse_pressure_angle)
        return (teeth - 1) * self._normal_base_pitch + cosine * across

    def span_contact_diameter(self, teeth: int) -> float:
        """Return the diameter on which the anvils touch: d_y^2 = d_b^2 + (W_k cos beta_b)^2,
        the anvils placed symmetrically.
        """
        reach = self.span_measurement(teeth) * math.cos(math.radians(self.base_helix_angle))
        return math.hypot(self.base_diameter, reach)

    @cached_property
    def spanned(self) -> int | None:
        """Number of teeth (of spaces, on a ring) whose anvils touch nearest to d + 2 x m_n; None where none can be spanned."""
        square = max(self.middle_diameter**2 - self.base_diameter**2, 0)
        wanted = math.sqrt(square) / math.cos(math.radians(self.base_helix_angle))
        count = 1 + round((wanted - self.span_measurement(1)) / self._normal_base_pitch)
        return min(max(count, 1), abs(self.teeth))

    # ------------------------------------------------------------------ balls and pins

    @property
    def _space_at_base(self) -> float:
        """Half space angle on the base circle (rad), signed like the diameters."""
        return math.pi / self.teeth - math.radians(self.base_half_angle)

    def _ball_circle(self, ball: float) -> float:
        """Return the diameter d_K on which the ball's centre lies: inv alpha_Kt = inv alpha_t + D/(d_b cos beta_b) - space half
        angle.
        """
        require_number("ball_diameter", ball, "mm", above=0)
        half_space = math.pi / self.teeth - self.normal_tooth_thickness / (self.normal_module * self.teeth)
        reach = ball / (self.base_diameter * math.cos(math.radians(self.base_helix_angle)))
        value = involute(self.transverse_pressure_angle) + reach - half_space
        if value <= 0:
            raise self._at_base_circle(ball)
        return self.base_diameter / math.cos(math.radians(inverse_involute(value)))

    def _at_base_circle(self, ball: float) -> GeometryError:
        """Return the error for a ball whose centre comes to the base circle."""
        return GeometryError("ball_diameter", ball, "must be larger: the ball falls to the base circle", "mm")

    @cached_property
    def ball_diameter(self) -> float:
        """Diameter of the ball that touches the flanks at d + 2 x m_n, rounded to two significant digits, upwards.

        Its centre lies on the normals to both flanks: alpha_K + tan^2 beta_b (tan alpha_K - tan alpha_y) = space half angle at
        the touching circle + alpha_y, D = d_b (tan alpha_K - tan alpha_y)/cos beta_b.
        In the wide spaces of very few teeth these normals meet far out or never; the ball is then made to touch lower, perhaps
        off the involute (see `ball_contact_diameter`).
        """
        touching = self._touching(math.acos(min(self.base_diameter / self.middle_diameter, 1.0)))
        space = self._space_at_base + math.tan(touching) - touching
        base_helix, tangent = math.radians(self.base_helix_angle), math.tan(touching)
        lean = math.tan(base_helix) ** 2
        low, high = self._centres(touching, space)
        for _ in range(60):  # the left side less the right grows steadily with alpha_K
            centre = (low + high) / 2
            if centre - touching - space + lean * (math.tan(centre) - tangent) < 0:
                low = centre
            else:
                high = centre
        ideal = self.base_diameter * (math.tan(centre) - tangent) / math.cos(base_helix)
        step = 10.0 ** (math.floor(math.log10(ideal)) - 1)
        return round(self._whole(ideal / step) * step, 9)

    def _whole(self, steps: float) -> int:
        """Return the steps rounded up, as a larger ball touches further up the flank."""
        return math.ceil(steps)

    def _touching(self, wanted: float) -> float:
        """Return the pressure angle (rad) where the ball touches: the one wanted, or less where the centre would be too far
        out.
        """
        farthest = max(_FARTHEST_CENTRE, (wanted + math.pi / 2) / 2)
        return min(wanted, math.atan(farthest - self._space_at_base))

    def _centres(self, touching: float, space: float) -> tuple[float, float]:
        """Return bounds of the pressure angle (rad) at the centre of a ball that touches at `touching`.

        `space` is half the space there (rad).
        """
        return touching, min(touching + space, math.pi / 2 - 1e-9)

    def ball_contact_diameter(self, ball: float) -> float:
        """Return the diameter on which a ball of diameter `ball` touches the flanks: tan alpha_y = tan alpha_K - D cos
        beta_b/d_b.

        The base circle for a ball so large that it would have to touch beyond it.
        """
        centre = math.acos(self.base_diameter / self._ball_circle(ball))
        tangent = math.tan(centre) - ball * math.cos(math.radians(self.base_helix_angle)) / self.base_diameter
        return self.base_diameter * math.hypot(1.0, max(tangent, 0.0))

    def over_balls(self, ball: float) -> float:
        """Return the dimension over two balls of diameter `ball` in opposite spaces, both centres in one transverse plane.

        M = d_K + D for an even number of teeth, d_K cos(pi/(2 z)) + D for an odd one. Raises GeometryError for a ball so
        small that it drops to the base circle.
        """
        circle = self._ball_circle(ball)
        return circle * (math.cos(math.pi / (2 * self.teeth)) if self.teeth % 2 else 1.0) + ball

    def between_balls(self, ball: float) -> float:
        """Return the dimension between two balls in opposite spaces of a ring. Raises GeometryError for an external gear."""
        raise GeometryError("teeth", self.teeth, "must be below 0: an external gear is measured over balls, not between them")

    def over_pins(self, pin: float) -> float:
        """Return the dimension over two pins of diameter `pin` between parallel planes.

        As over balls, but on a helical gear with an odd number of teeth the pins roll along their spaces until they lie
        diametrically opposite, `pin_axial_shift` apart along the axis: M = d_K + D there.
        """
        if self.pin_axial_shift:
            return self._ball_circle(pin) + pin
        return self.over_balls(pin)

    @property
    def pin_axial_shift(self) -> float:
        """Distance (mm) along the axis between two measuring pins: half an axial pitch if z is odd, else 0."""
        if not self.helix_angle or self.teeth % 2 == 0:
            return 0.0
        return self.lead / self.teeth / 2

    # ------------------------------------------------------------------ in the normal section

    @property
    def chordal_thickness(self) -> ChordalThickness:
        """Chordal thickness and chordal height on the reference circle.

        Taken on the virtual gear of z_v = z/cos^3 beta teeth: s = z_v m_n sin(psi), h = h_a + z_v m_n (1 - cos psi)/2, with
        psi = s_n/(m_n z_v). The height is measured from the actual tip circle.
        """
        virtual = self.teeth / math.cos(math.radians(self.helix_angle)) ** 3
        half = self.normal_tooth_thickness / (self.normal_module * virtual)
        diameter = virtual * self.normal_module
        return ChordalThickness(diameter * math.sin(half), self.addendum + diameter * (1 - math.cos(half)) / 2)

    # ------------------------------------------------------------------ what to know before measuring

    def _touches_root(self, ball: float, root: float) -> bool:
        """Return whether a ball that touches both flanks would reach beyond the root circle of diameter `root` (mm)."""
        inwards = 1 if self.teeth > 0 else -1
        return inwards * (abs(self._ball_circle(ball)) - inwards * ball - abs(root)) < 0

    def notices(self, lowest: float, highest: float, face_width: float, root: float) -> Iterator[Notice]:
        """Yield notices on gauges that touch off the involute, which reaches from diameter `lowest` to `highest` (mm).

        They may also touch beside the face, or on the root circle of diameter `root` (mm).
        """
        if self.spanned and not lowest <= (touching := self.span_contact_diameter(self.spanned)) <= highest:
            yield Notice("span-off-involute", f"span: the anvils would touch at diameter {touching:.4f} mm, off the involute")
        ball = self.ball_diameter
        if not lowest <= (touching := self.ball_contact_diameter(ball)) <= highest:
            text = f"balls: a ball of {ball:g} mm would touch at diameter {touching:.4f} mm, off the involute"
            yield Notice("balls-off-involute", text)
        elif self._touches_root(ball, root):
            text = f"balls: a ball of {ball:g} mm would touch the root circle, diameter {abs(root):.4f} mm, off the involute"
            yield Notice("balls-off-involute", text)
        if face_width < (width := self.pin_axial_shift):
            text = f"pins: the dimension over two pins needs a face width of {width:.4f} mm; use balls, or one pin"
            yield Notice("narrow-for-pins", text)
        if not self.spanned:
            return
        width = self.span_measurement(self.spanned) * math.sin(math.radians(abs(self.base_helix_angle)))
        if face_width < width:
            text = f"span: measuring over {self.spanned} {self.spanned_is} needs a face width of {width:.4f} mm"
            yield Notice("narrow-for-span", text)


_NEAREST_CENTRE = math.radians(5)
"""Least pressure angle at the centre of a suggested ball: nearer the base circle its place tells little of the thickness."""


@dataclass(frozen=True, kw_only=True)
class InternalInspection(Inspection):
    """Inspection of the teeth of a ring by gauges. Teeth and diameters are negative; readings of gauges are positive."""

    spanned_is: ClassVar[str] = "spaces"

    # ------------------------------------------------------------------ over spaces

    def span_measurement(self, spaces: int) -> float:
        """Base tangent length over `spaces` spaces of a spur ring: W_k = (k - 1) p_bn + e_bn (ISO 21771).

        e_bn = cos alpha_n (pi m_n - s_n - z m_n inv alpha_t). Raises ParameterError unless 1 <= k <= |z|, and GeometryError for
        a helical ring, which is measured between balls.
        """
        if self.helix_angle:
            permitted = "must be 0 deg for a span: a helical ring is measured between balls"
            raise GeometryError("helix_angle", self.helix_angle, permitted, "deg")
        require_whole("span_spaces", spaces, at_least=1, at_most=-self.teeth)
        cosine = math.cos(math.radians(self.pressure_angle))
        space = math.pi * self.normal_module - self.normal_tooth_thickness
        across = space - self.teeth * self.normal_module * involute(self.transverse_pressure_angle)
        return (spaces - 1) * self._normal_base_pitch + cosine * across

    def span_contact_diameter(self, spaces: int) -> float:
        """Return the diameter (negative) on which the anvils touch, placed symmetrically: d_y^2 = d_b^2 + W_k^2."""
        return -math.hypot(self.base_diameter, self.span_measurement(spaces))

    @cached_property
    def spanned(self) -> int | None:
        """Number of spaces whose anvils touch nearest to d + 2 x m_n; None for a helical ring."""
        return None if self.helix_angle else super().spanned

    # ------------------------------------------------------------------ balls and pins

    def _whole(self, steps: float) -> int:
        """Return the steps rounded down, as a larger ball may come to the base circle."""
        return math.floor(steps)

    def _touching(self, wanted: float) -> float:
        """Return the pressure angle (rad) where the ball touches: the one wanted,
        or more where the centre would be too far in.
        """
        nearest = min(_NEAREST_CENTRE, wanted / 2)
        return max(wanted, math.atan(nearest - self._space_at_base))

    def _centres(self, touching: float, space: float) -> tuple[float, float]:
        """Return bounds of the pressure angle (rad) at the ball's centre, which is further in than where the ball touches."""
        return 0.0, touching

    def _at_base_circle(self, ball: float) -> GeometryError:
        half_space = math.pi / self.teeth - self.normal_tooth_thickness / (self.normal_module * self.teeth)
        base = self.base_diameter * math.cos(math.radians(self.base_helix_angle))
        most = base * (half_space - involute(self.transverse_pressure_angle))
        permitted = f"must be below {at_most(most)} mm: its centre would be inside the base circle"
        return GeometryError("ball_diameter", ball, permitted, "mm")

    def over_balls(self, ball: float) -> float:
        """Raises GeometryError: a ring is measured between balls."""
        raise GeometryError("teeth", self.teeth, "must be above 0: a ring is measured between balls, not over them")

    def between_balls(self, ball: float) -> float:
        """Return the dimension between two balls of diameter `ball` in opposite spaces, both centres in one transverse plane.

        M = |d_K| - D for an even number of teeth, |d_K| cos(pi/(2 z)) - D for an odd one. Raises GeometryError for a ball so
        large that its centre would be inside the base circle.
        """
        circle = -self._ball_circle(ball)
        return circle * (math.cos(math.pi / (2 * self.teeth)) if self.teeth % 2 else 1.0) - ball

    def over_pins(self, pin: float) -> float:
        """Raises GeometryError: a ring is measured between pins."""
        raise GeometryError("teeth", self.teeth, "must be above 0: a ring is measured between pins, not over them")

    def between_pins(self, pin: float) -> float:
        """Return the dimension between two pins of diameter `pin` in a spur ring, as between balls.

        Raises GeometryError for a helical ring: a straight pin touches its hollow flanks at the pin's ends.
        """
        if self.helix_angle:
            permitted = "must be 0 deg for pins: a helical ring is measured between balls"
            raise GeometryError("helix_angle", self.helix_angle, permitted, "deg")
        return self.between_balls(pin)

    @property
    def pin_axial_shift(self) -> float:
        """Return 0: straight pins lie in spur rings only, and side by side."""
        return 0.0


@dataclass(frozen=True, kw_only=True)
class RackInspection:
    """Inspection of a rack by a pin or ball in a space, whose cross-section square to the teeth is that of the basic rack.

    Heights count from the reference line: the back is `height` below it, flanks are straight from `form_depth` below it to
    `tip_form_height` above.
    """

    normal_pitch: float
    normal_tooth_thickness: float
    pressure_angle: float
    height: float
    tip_height: float
    tip_form_height: float
    form_depth: float
    root_depth: float

    @property
    def _normal_space(self) -> float:
        """Normal space width e_n (mm) on the reference line."""
        return self.normal_pitch - self.normal_tooth_thickness

    @property
    def pin_diameter(self) -> float:
        """The pin that touches on the reference line, D = e_n/cos alpha_n, rounded up to two significant digits."""
        ideal = self._normal_space / math.cos(math.radians(self.pressure_angle))
        step = 10.0 ** (math.floor(math.log10(ideal)) - 1)
        return round(math.ceil(ideal / step) * step, 9)

    def pin_centre(self, pin: float) -> float:
        """Return the height (mm) of a pin's centre over the reference line.

        That height is (D/cos alpha_n - e_n)/(2 tan alpha_n). Raises ParameterError.
        """
        require_number("pin_diameter", pin, "mm", above=0)
        angle = math.radians(self.pressure_angle)
        return (pin / math.cos(angle) - self._normal_space) / (2 * math.tan(angle))

    def pin_contact(self, pin: float) -> float:
        """Return the height (mm) over the reference line where a pin touches the flanks."""
        return self.pin_centre(pin) - pin / 2 * math.sin(math.radians(self.pressure_angle))

    def over_pin(self, pin: float) -> float:
        """Return the distance (mm) from the rack's back to the highest line of the pin, M = H_0 + centre + D/2.

        Raises GeometryError for a pin that rests on the root, or on no flank.
        """
        centre, (least, most) = self.pin_centre(pin), self.pin_limits
        if pin < least:
            raise GeometryError("pin_diameter", pin, f"must be at least {at_least(least)} mm: the pin falls to the root", "mm")
        if pin > most:
            raise GeometryError("pin_diameter", pin, f"must be at most {at_most(most)} mm: the pin rests on the tips", "mm")
        return self.height + centre + pin / 2

    @property
    def pin_limits(self) -> tuple[float, float]:
        """Least and greatest diameter of a pin that touches the flanks: at their ends, D = (e_n + 2 y tan alpha_n)/cos alpha_n.

        Nor may it rest on the root, D = (e_n/tan alpha_n - 2 h_f) sin alpha_n/(1 - sin alpha_n).
        """
        angle = math.radians(self.pressure_angle)
        sine, tangent = math.sin(angle), math.tan(angle)
        lowest, highest = (
            (self._normal_space + 2 * y * tangent) / math.cos(angle) for y in (-self.form_depth, self.tip_form_height)
        )
        return max(lowest, (self._normal_space / tangent - 2 * self.root_depth) * sine / (1 - sine)), highest

    def notices(self) -> Iterator[Notice]:
        """Yield a notice if the suggested pin touches no flank, or stays below the tips."""
        pin = self.pin_diameter
        try:
            over = self.over_pin(pin)
        except GeometryError:
            yield Notice("no-pin", f"no pin: one of {pin:g} mm touches no flank; choose another pin_diameter")
            return
        if over < self.height + self.tip_height:
            yield Notice("low-pin", f"low pin: one of {pin:g} mm stays below the tips; choose a larger one")


class Chord(NamedTuple):
    """Reading of a tooth caliper, and the diameter on which it touches the flanks (mm)."""

    thickness: float
    diameter: float


def chord_below_tip(teeth: Inspection, addendum: float, height: float) -> Chord:
    """Return the chord of a tooth of an external gear at a height below its tip circle, `addendum` over the reference circle
    (mm).

    Taken on the virtual gear of z_v = z/cos^3 beta teeth, as the chordal thickness is: there d_y = d_b/cos alpha_y,
    psi_y = psi + inv alpha_n - inv alpha_y, s = d_y sin psi_y and h = r_a - d_y cos(psi_y)/2. Raises GeometryError for a height
    at which there is no involute.
    """
    require_number("height", height, "mm", above=0)
    if teeth.teeth < 0:
        raise GeometryError("teeth", teeth.teeth, "must be above 0: no tooth caliper goes into a ring")
    virtual = teeth.teeth / math.cos(math.radians(teeth.helix_angle)) ** 3
    reference, angle = virtual * teeth.normal_module, math.radians(teeth.pressure_angle)
    at_base = teeth.normal_tooth_thickness / reference + math.tan(angle) - angle
    base, tip = reference * math.cos(angle), reference / 2 + addendum

    def place(here: float) -> tuple[float, float]:
        """Return the diameter and half tooth angle (rad) where the pressure angle is `here` (rad)."""
        return base / math.cos(here), at_base - math.tan(here) + here

    def too_deep(here: float) -> float:
        diameter, half = place(here)
        return tip - diameter * math.cos(half) / 2 - height

    highest = math.acos(min(base / (2 * tip), 1.0))
    if not too_deep(0.0) > 0 > too_deep(highest):
        least, most = too_deep(highest) + height, too_deep(0.0) + height
        permitted = f"must be between {max(least, 0.0):.4g} and {max(most, 0.0):.4g} mm, where the involute is"
        raise GeometryError("height", height, permitted, "mm")
    diameter, half = place(root_between(too_deep, 0.0, highest))
    wider = teeth.teeth * teeth.normal_module / math.cos(math.radians(teeth.helix_angle)) - reference
    return Chord(diameter * math.sin(half), diameter + wider)


def inspection_of(gear: GearData, middle_diameter: float) -> Inspection:
    """Return the inspection of a gear, external or internal. Gauges should touch on `middle_diameter` (mm, signed as the gear's
    own).

    If the tip diameter of the data is not known yet, the inspection gives everything but chordal heights.
    """
    kind = InternalInspection if gear.internal else Inspection
    thickness, angle = gear.normal_tooth_thickness, gear.transverse_pressure_angle
    return kind(
        teeth=gear.teeth,
        normal_module=gear.normal_module,
        pressure_angle=gear.rack.pressure_angle,
        helix_angle=gear.helix_angle,
        transverse_pressure_angle=angle,
        base_helix_angle=gear.base_helix_angle,
        base_diameter=gear.base_diameter,
        normal_tooth_thickness=thickness,
        base_half_angle=base_half_angle(gear.teeth, thickness, gear.normal_module, angle),
        middle_diameter=middle_diameter,
        addendum=(gear.tip_diameter - gear.reference_diameter) / 2,
        lead=gear.lead,
    )


class Limits(NamedTuple):
    """The least and the greatest of a dimension (mm)."""

    least: float
    greatest: float


@dataclass(frozen=True, kw_only=True)
class ThicknessLimits:
    """The dimensions (mm) between which teeth are good, by the gauges of the gear itself; None for those that do not fit it."""

    allowance: ToothAllowance
    normal_tooth_thickness: Limits
    span_measurement: Limits | None
    over_balls: Limits | None
    over_pins: Limits | None
    between_balls: Limits | None
    between_pins: Limits | None

    @classmethod
    def of(cls, inspection: Inspection, allowance: ToothAllowance) -> ThicknessLimits:
        """Return the thickness limits of a gear. Its `inspection` is of teeth in the middle of their allowances."""
        half, internal = allowance.tolerance / 2000, inspection.teeth < 0
        extremes = tuple(_with_thickness(inspection, inspection.normal_tooth_thickness + each) for each in (-half, half))
        count, ball = inspection.spanned, inspection.ball_diameter

        def limits(measure: Callable[[Inspection], float], measured: bool) -> Limits | None:
            """Return the least and greatest reading (mm); None if `measured` is false or a ball falls to the base circle.

            Thick teeth make spans larger, but spans over the spaces of a ring smaller.
            """
            with suppress(GeometryError):  # a ball that falls to the base circle of thin teeth measures nothing
                return Limits(*sorted(map(measure, extremes))) if measured else None
            return None

        return cls(
            allowance=allowance,
            normal_tooth_thickness=Limits(*(each.normal_tooth_thickness for each in extremes)),
            span_measurement=limits(lambda gauge: gauge.span_measurement(count or 1), count is not None),
            over_balls=limits(lambda gauge: gauge.over_balls(ball), not internal),
            over_pins=limits(lambda gauge: gauge.over_pins(ball), not internal),
            between_balls=limits(lambda gauge: gauge.between_balls(ball), internal),
            between_pins=limits(lambda gauge: gauge.between_balls(ball), internal and not inspection.helix_angle),
        )

    def to_dict(self) -> dict[str, float]:
        """A_sne and A_sni in µm, and the limits of each gauge that fits, in mm: `over_balls_least`."""
        allowances = {"allowance_upper": self.allowance.upper, "allowance_lower": self.allowance.lower}
        for each in fields(self):
            if isinstance(limits := getattr(self, each.name), Limits):
                allowances |= {f"{each.name}_{side}": value for side, value in limits._asdict().items()}
        return allowances


def _with_thickness(inspection: Inspection, thickness: float) -> Inspection:
    half_angle = base_half_angle(inspection.teeth, thickness, inspection.normal_module, inspection.transverse_pressure_angle)
    return replace(inspection, normal_tooth_thickness=thickness, base_half_angle=half_angle)
