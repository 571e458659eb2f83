"""What the quantities of gears and machines can be: far more than is built, from micromechanics to mine hoists and ships.

Wide enough for any real gear, narrow enough that no formula overflows. Lengths of teeth stand with the geometry.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from gearcad.errors import ParameterError, is_finite_number, require_number

__all__ = [
    "ANGULAR_DAMPING",
    "APPLICATION_FACTOR",
    "BACKLASH",
    "BAND",
    "DAMPING",
    "DAMPING_RATIO",
    "DENSITY",
    "DEVIATION",
    "DURATION",
    "INERTIA",
    "LENGTH",
    "MODULUS",
    "OFFSET",
    "POISSON_RATIO",
    "PRELOAD",
    "SAMPLING",
    "SPEED",
    "STIFFNESS",
    "STRENGTH",
    "TORQUE",
    "TORSIONAL_STIFFNESS",
    "Range",
]


class Range(NamedTuple):
    """A unit, and the least and most that a quantity can be in it; a `signed` one is 0 or of such a size with either sign.

    One that `may_vanish` is 0 or from `least` on.
    """

    unit: str
    least: float
    most: float
    signed: bool = False
    may_vanish: bool = False

    def require(self, parameter: str, value: Any) -> None:
        """Raise ParameterError unless `value` is a number inside."""
        if not (self.signed or self.may_vanish):
            require_number(parameter, value, self.unit, at_least=self.least, at_most=self.most)
            return
        inside = is_finite_number(value) and self.least <= (abs(value) if self.signed else value) <= self.most
        if not inside and not (is_finite_number(value) and value == 0):
            size = " in size" if self.signed else ""
            permitted = f"must be a number, 0 or from {self.least:g} to {self.most:g} {self.unit}{size}"
            raise ParameterError(parameter, value, permitted, self.unit if isinstance(value, int | float) else "")


TORQUE = Range("N·m", 1e-9, 1e9, signed=True)
SPEED = Range("rpm", 1e-6, 1e7, signed=True)
APPLICATION_FACTOR = Range("", 0.01, 100.0)

MODULUS = Range("MPa", 0.1, 1e7)
"""From a gel to some times diamond."""

POISSON_RATIO = Range("", 0.0, 0.499)
"""What is incompressible locks finite elements."""

DENSITY = Range("kg/m³", 1e-3, 1e5)
"""From next to nothing to some times osmium."""

STRENGTH = Range("MPa", 1e-3, 1e6)
BAND = Range("%", 0.01, 1e4)
OFFSET = Range("mm", 1e-6, 1e5, signed=True)
"""How far something stands from its place."""

INERTIA = Range("kg·m²", 1e-21, 1e12)
TORSIONAL_STIFFNESS = Range("N·m/rad", 1e-12, 1e15)
LENGTH = Range("mm", 1e-3, 1e7)
"""Of shafts, and their diameters."""

STIFFNESS = Range("N/µm", 1e-9, 1e9)
DAMPING_RATIO = Range("", 0.0, 100.0)
DAMPING = Range("N·s/m", 0.0, 1e15)
ANGULAR_DAMPING = Range("N·m·s/rad", 0.0, 1e15)
PRELOAD = Range("N", 1e-9, 1e12, may_vanish=True)
BACKLASH = Range("µm", 0.0, 1e7)
DEVIATION = Range("µm", 1e-6, 1e6, signed=True)
DURATION = Range("s", 1e-9, 1e6)
SAMPLING = Range("Hz", 1e-3, 1e12)
