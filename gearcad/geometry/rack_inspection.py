"""Measuring a rack over a pin that lies in a space, on plain numbers. Lengths in mm, angles in degrees."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gearcad.errors import GeometryError, require_number
from gearcad.geometry.limits import at_least, at_most
from gearcad.notice import Notice

__all__ = ["RackInspection"]


@dataclass(frozen=True, kw_only=True)
class RackInspection:
    """What a pin or a ball in a space finds, whose cross-section square to the teeth is that of the basic rack.

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
        """e_n on the reference line."""
        return self.normal_pitch - self.normal_tooth_thickness

    @property
    def pin_diameter(self) -> float:
        """The pin that touches on the reference line, D = e_n/cos alpha_n, rounded up to two significant digits."""
        ideal = self._normal_space / math.cos(math.radians(self.pressure_angle))
        step = 10.0 ** (math.floor(math.log10(ideal)) - 1)
        return round(math.ceil(ideal / step) * step, 9)

    def pin_centre(self, pin: float) -> float:
        """Height of its centre over the reference line: (D/cos alpha_n - e_n)/(2 tan alpha_n). Raises ParameterError."""
        require_number("pin_diameter", pin, "mm", above=0)
        angle = math.radians(self.pressure_angle)
        return (pin / math.cos(angle) - self._normal_space) / (2 * math.tan(angle))

    def pin_contact(self, pin: float) -> float:
        """Height over the reference line where it touches the flanks."""
        return self.pin_centre(pin) - pin / 2 * math.sin(math.radians(self.pressure_angle))

    def over_pin(self, pin: float) -> float:
        """From the back to the highest line of the pin, M = H_0 + centre + D/2.

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
        """What to know of the suggested pin."""
        pin = self.pin_diameter
        try:
            over = self.over_pin(pin)
        except GeometryError:
            yield Notice("no-pin", f"no pin: one of {pin:g} mm touches no flank; choose another pin_diameter")
            return
        if over < self.height + self.tip_height:
            yield Notice("low-pin", f"low pin: one of {pin:g} mm stays below the tips; choose a larger one")
