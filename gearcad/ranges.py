"""What the quantities of gears and machines can be: far more than is built, from micromechanics to mine hoists and ships.

Wide enough for any real gear, narrow enough that no formula overflows. Lengths of teeth stand with the geometry.
"""

from __future__ import annotations

import math
from enum import Enum
from typing import Any, NamedTuple

from gearcad.errors import ParameterError, as_choice, is_finite_number, require_number, require_one_of, require_whole

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
    "Choice",
    "Member",
    "Range",
    "Whole",
]


class Range(NamedTuple):
    """A unit, and the least and most that a quantity can be in it; a `signed` one is 0 or of such a size with either sign.

    One that `may_vanish` is 0 or from `least` on; `ends` in round brackets are outside. None has no bound on that side.
    """

    unit: str
    least: float | None
    most: float | None
    signed: bool = False
    may_vanish: bool = False
    ends: str = "[]"

    def require(self, parameter: str, value: Any) -> None:
        """Raise ParameterError unless `value` is a number inside."""
        if not (self.signed or self.may_vanish):
            lower, upper = "above" if self.ends[0] == "(" else "at_least", "below" if self.ends[1] == ")" else "at_most"
            require_number(parameter, value, self.unit, **{lower: self.least, upper: self.most})
            return
        least, most = self.least or 0.0, math.inf if self.most is None else self.most
        inside = is_finite_number(value) and least <= (abs(value) if self.signed else value) <= most
        if not inside and not (is_finite_number(value) and value == 0):
            size = " in size" if self.signed else ""
            permitted = f"must be a number, 0 or from {least:g} to {most:g} {self.unit}{size}"
            raise ParameterError(parameter, value, permitted, self.unit if isinstance(value, int | float) else "")


class Whole(NamedTuple):
    """The least and most that a whole number can be; one that `may_vanish` is 0 or from `least` on.

    With `negative` it may be from minus `most` to that too, which stands for something else.
    """

    least: int
    most: int
    may_vanish: bool = False
    negative: tuple[int, str] | None = None

    def require(self, parameter: str, value: Any) -> None:
        """Raise ParameterError unless `value` is a whole number inside."""
        if self.may_vanish and value == 0:
            return
        if self.negative and is_finite_number(value) and value < 0:
            highest, meaning = self.negative
            if not isinstance(value, int) or not -self.most <= value <= highest:
                also = f"or from {-self.most} to {highest} ({meaning})"
                raise ParameterError(parameter, value, f"must be a whole number from {self.least} to {self.most}, {also}")
            return
        require_whole(parameter, value, at_least=self.least, at_most=self.most)


class Choice(NamedTuple):
    """The words that a text can be."""

    words: tuple[str, ...]

    def require(self, parameter: str, value: Any) -> None:
        """Raise ParameterError unless `value` is one of the words."""
        require_one_of(parameter, value, self.words)


class Member(NamedTuple):
    """The members of an enum that a value, or a text that stands for it, can name."""

    choices: type[Enum]

    def require(self, parameter: str, value: Any) -> None:
        """Raise ParameterError unless `value` is a member, or the value of one."""
        as_choice(parameter, value, self.choices)


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
