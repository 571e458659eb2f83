"""Measuring a gear: base tangent length, dimension over balls and pins, chordal thickness (ISO 21771), on plain numbers.

All lengths in mm, angles in degrees. Tooth thinning is included: these are the dimensions of the gear as cut.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

from gearcad.errors import GeometryError, require_number, require_whole
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.notice import Notice

__all__ = ["ChordalThickness", "Inspection"]


_FARTHEST_CENTRE = math.radians(75)
"""Largest pressure angle at the centre of a suggested ball: there its dimension is 3.9 times the base circle."""


class ChordalThickness(NamedTuple):
    """Along the chord of the reference circle in the normal section, and its height below the tip circle (mm)."""

    thickness: float
    height: float


@dataclass(frozen=True, kw_only=True)
class Inspection:
    """What gauges find on the teeth of an external gear; that of a ring is an `InternalInspection`.

    `middle_diameter` is where a gauge had best touch: d + 2 x m_n, kept on the involute. `base_half_angle` is the half tooth
    angle on the base circle, `addendum` (mm) stands over the reference circle, `lead` is infinite for a spur gear. Teeth,
    diameters and `base_half_angle` have the signs of ISO 21771; what a gauge reads is positive.
    """

    spanned_is: ClassVar[str] = "teeth"
    """What lies between the anvils of a span."""

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
        """Diameter on which the anvils touch: d_y^2 = d_b^2 + (W_k cos beta_b)^2, the anvils placed symmetrically."""
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
        """Diameter d_K on which the ball's centre lies: inv alpha_Kt = inv alpha_t + D/(d_b cos beta_b) - space half angle."""
        require_number("ball_diameter", ball, "mm", above=0)
        half_space = math.pi / self.teeth - self.normal_tooth_thickness / (self.normal_module * self.teeth)
        reach = ball / (self.base_diameter * math.cos(math.radians(self.base_helix_angle)))
        value = involute(self.transverse_pressure_angle) + reach - half_space
        if value <= 0:
            raise self._at_base_circle(ball)
        return self.base_diameter / math.cos(math.radians(inverse_involute(value)))

    def _at_base_circle(self, ball: float) -> GeometryError:
        """The fault of a ball whose centre comes to the base circle."""
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
        """A larger ball touches further up the flank: rounded up."""
        return math.ceil(steps)

    def _touching(self, wanted: float) -> float:
        """Pressure angle (rad) where the ball touches: the one wanted, or less where the centre would be too far out."""
        farthest = max(_FARTHEST_CENTRE, (wanted + math.pi / 2) / 2)
        return min(wanted, math.atan(farthest - self._space_at_base))

    def _centres(self, touching: float, space: float) -> tuple[float, float]:
        """Bounds of the pressure angle (rad) at the centre of a ball that touches at one, half the space there given (rad)."""
        return touching, min(touching + space, math.pi / 2 - 1e-9)

    def ball_contact_diameter(self, ball: float) -> float:
        """Diameter on which a ball of diameter `ball` touches the flanks: tan alpha_y = tan alpha_K - D cos beta_b/d_b.

        The base circle for a ball so large that it would have to touch beyond it.
        """
        centre = math.acos(self.base_diameter / self._ball_circle(ball))
        tangent = math.tan(centre) - ball * math.cos(math.radians(self.base_helix_angle)) / self.base_diameter
        return self.base_diameter * math.hypot(1.0, max(tangent, 0.0))

    def over_balls(self, ball: float) -> float:
        """Dimension over two balls of diameter `ball` in opposite spaces, both centres in one transverse plane.

        M = d_K + D for an even number of teeth, d_K cos(pi/(2 z)) + D for an odd one. Raises GeometryError for a ball so
        small that it drops to the base circle.
        """
        circle = self._ball_circle(ball)
        return circle * (math.cos(math.pi / (2 * self.teeth)) if self.teeth % 2 else 1.0) + ball

    def between_balls(self, ball: float) -> float:
        """Dimension between two balls in opposite spaces of a ring. Raises GeometryError for an external gear."""
        raise GeometryError("teeth", self.teeth, "must be below 0: an external gear is measured over balls, not between them")

    def over_pins(self, pin: float) -> float:
        """Dimension over two pins of diameter `pin` between parallel planes.

        As over balls, but on a helical gear with an odd number of teeth the pins roll along their spaces until they lie
        diametrically opposite, `pin_axial_shift` apart along the axis: M = d_K + D there.
        """
        if self.pin_axial_shift:
            return self._ball_circle(pin) + pin
        return self.over_balls(pin)

    @property
    def pin_axial_shift(self) -> float:
        """How far apart along the axis two pins lie that are measured over (mm): half an axial pitch if z is odd, else 0."""
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

    def notices(self, lowest: float, highest: float, face_width: float) -> Iterator[Notice]:
        """Gauges that touch off the involute, which reaches from diameter `lowest` to `highest`, or beside the face (mm)."""
        if self.spanned and not lowest <= (touching := self.span_contact_diameter(self.spanned)) <= highest:
            yield Notice("span-off-involute", f"span: the anvils would touch at diameter {touching:.4f} mm, off the involute")
        ball = self.ball_diameter
        if not lowest <= (touching := self.ball_contact_diameter(ball)) <= highest:
            text = f"balls: a ball of {ball:g} mm would touch at diameter {touching:.4f} mm, off the involute"
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
