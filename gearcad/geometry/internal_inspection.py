"""Measuring a ring: span over spaces, dimension between balls and pins (ISO 21771), on plain numbers with signs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from gearcad.errors import GeometryError, require_whole
from gearcad.geometry.inspection import Inspection
from gearcad.geometry.involute import involute
from gearcad.geometry.limits import at_most

__all__ = ["InternalInspection"]

_NEAREST_CENTRE = math.radians(5)
"""Least pressure angle at the centre of a suggested ball: nearer the base circle its place tells little of the thickness."""


@dataclass(frozen=True, kw_only=True)
class InternalInspection(Inspection):
    """What gauges find on the teeth of a ring. Teeth and diameters are negative; what a gauge reads is positive."""

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
        """Diameter (negative) on which the anvils touch, placed symmetrically: d_y^2 = d_b^2 + W_k^2."""
        return -math.hypot(self.base_diameter, self.span_measurement(spaces))

    @cached_property
    def spanned(self) -> int | None:
        """Number of spaces whose anvils touch nearest to d + 2 x m_n; None for a helical ring."""
        return None if self.helix_angle else super().spanned

    # ------------------------------------------------------------------ balls and pins

    def _whole(self, steps: float) -> int:
        """A larger ball may come to the base circle: rounded down."""
        return math.floor(steps)

    def _touching(self, wanted: float) -> float:
        """Pressure angle (rad) where the ball touches: the one wanted, or more where the centre would be too far in."""
        nearest = min(_NEAREST_CENTRE, wanted / 2)
        return max(wanted, math.atan(nearest - self._space_at_base))

    def _centres(self, touching: float, space: float) -> tuple[float, float]:
        """The centre of the ball is further in than where it touches."""
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
        """Dimension between two balls of diameter `ball` in opposite spaces, both centres in one transverse plane.

        M = |d_K| - D for an even number of teeth, |d_K| cos(pi/(2 z)) - D for an odd one. Raises GeometryError for a ball so
        large that its centre would be inside the base circle.
        """
        circle = -self._ball_circle(ball)
        return circle * (math.cos(math.pi / (2 * self.teeth)) if self.teeth % 2 else 1.0) - ball

    def over_pins(self, pin: float) -> float:
        """Raises GeometryError: a ring is measured between pins."""
        raise GeometryError("teeth", self.teeth, "must be above 0: a ring is measured between pins, not over them")

    def between_pins(self, pin: float) -> float:
        """Dimension between two pins of diameter `pin` in a spur ring, as between balls.

        Raises GeometryError for a helical ring: a straight pin touches its hollow flanks at the pin's ends.
        """
        if self.helix_angle:
            permitted = "must be 0 deg for pins: a helical ring is measured between balls"
            raise GeometryError("helix_angle", self.helix_angle, permitted, "deg")
        return self.between_balls(pin)

    @property
    def pin_axial_shift(self) -> float:
        """Straight pins lie in spur rings only, and side by side."""
        return 0.0
