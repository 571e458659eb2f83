"""Path and lines of contact of two gears, on plain numbers.

The line of action is measured from T1, where it touches the pinion's base circle (mm, transverse section). Diameters and
centre distance are signed: with an internal gear as the wheel its diameters and the centre distance are negative, and T2 lies
behind T1.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.geometry.involute import tangent_length
from gearcad.per_gear import PerGear

__all__ = [
    "BaseTangent",
    "ContactLineLengths",
    "ContactZone",
    "PathOfContact",
    "SpecificSliding",
    "farthest_centre_distance",
    "sliding_along",
    "sliding_document",
]


class PathOfContact(NamedTuple):
    """Distances from T1 (mm): A first contact, B and D single-contact limits, C pitch point, E last contact."""

    A: float
    B: float
    C: float
    D: float
    E: float


class SpecificSliding(NamedTuple):
    """Specific sliding of both flanks at the first contact A and the last contact E of the usable path, and the greatest.

    ISO 21771: zeta = 1 - v_mate/v_own, with the velocities of both flanks along their common tangent. None where a flank rolls
    to a standstill at its base circle, so that zeta is not limited. `greatest` is the largest of the four in magnitude.
    """

    pinion_A: float | None
    wheel_A: float | None
    pinion_E: float | None
    wheel_E: float | None
    greatest: float | None

    @classmethod
    def between(cls, own: PerGear[Floats]) -> SpecificSliding:
        """That of velocities (2,) along the tangent in A and E, in any unit."""
        sliding = sliding_along(own)
        ends = [float(values[end]) if math.isfinite(values[end]) else None for end in (0, 1) for values in sliding]
        finite = [abs(value) for value in ends if value is not None]
        pinion_a, wheel_a, pinion_e, wheel_e = ends
        return cls(pinion_a, wheel_a, pinion_e, wheel_e, max(finite) if len(finite) == len(ends) else None)


def sliding_along(own: PerGear[Floats]) -> PerGear[Floats]:
    """Specific sliding zeta (n,) of pinion and wheel by the velocities (n,) of their flanks along the common tangent.

    Infinite where a flank stands still.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return PerGear(1 - own.wheel / own.pinion, 1 - own.pinion / own.wheel)


_SLIDING_PLACES = 21


def sliding_document(path: tuple[float, float], sliding_at: Callable[[Floats], PerGear[Floats]]) -> dict[str, Any]:
    """Return specific sliding at places along a usable `path` (mm from T1), for JSON; None where it is not limited."""
    places = np.linspace(*path, _SLIDING_PLACES)
    pinion, wheel = ([value if math.isfinite(value) else None for value in each.tolist()] for each in sliding_at(places))
    return {"distance": places.tolist(), "pinion": pinion, "wheel": wheel}


class ContactLineLengths(NamedTuple):
    """Total length of the simultaneous lines of contact over the cycle (mm)."""

    minimum: float
    mean: float
    maximum: float


def farthest_centre_distance(base_diameters: PerGear[float], tip_diameters: PerGear[float]) -> float:
    """Centre distance (mm) at which the path of contact vanishes: both tip form circles meet on the line of action."""
    tangents = PerGear.each(lambda role: tangent_length(tip_diameters.pick(role), base_diameters.pick(role)))
    return math.hypot(sum(base_diameters) / 2, sum(tangents))


@dataclass(frozen=True)
class BaseTangent:
    """The common tangent of both base circles, which is the line of action. Lengths in mm.

    `pressure_angle` is the working transverse one (degrees), `pitch` the transverse base pitch.
    """

    base_diameters: PerGear[float]
    centre_distance: float
    pressure_angle: float
    pitch: float

    @property
    def length(self) -> float:
        """T1T2 = a sin alpha_wt."""
        return self.centre_distance * math.sin(math.radians(self.pressure_angle))

    def path(self, tip_diameters: PerGear[float]) -> PathOfContact:
        """Characteristic points, limited by the tip form circles of both gears."""
        start = self.length - tangent_length(tip_diameters.wheel, self.base_diameters.wheel)
        end = tangent_length(tip_diameters.pinion, self.base_diameters.pinion)
        middle = self.base_diameters.pinion / 2 * math.tan(math.radians(self.pressure_angle))
        return PathOfContact(start, end - self.pitch, middle, start + self.pitch, end)

    def usable(self, path: PathOfContact, form_diameters: PerGear[float]) -> tuple[float, float]:
        """First and last contact (mm from T1) when the root form circles limit the path as well."""
        first = max(path.A, tangent_length(form_diameters.pinion, self.base_diameters.pinion))
        last = min(path.E, self.length - tangent_length(form_diameters.wheel, self.base_diameters.wheel))
        return first, last

    def active_root_diameters(self, path: PathOfContact) -> PerGear[float]:
        """d_Nf: the lowest points that the mate's tip form circle would touch (mm).

        Where a tip passes beyond the base tangent point, the base circle is the lowest point an involute has.
        """
        lowest = PerGear(path.A, self.length - path.E)

        def circle(base: float, along: float) -> float:
            side = math.copysign(1.0, base)
            return side * math.hypot(base, 2 * max(side * along, 0.0))

        return PerGear.each(lambda role: circle(self.base_diameters.pick(role), lowest.pick(role)))


@dataclass(frozen=True)
class ContactZone:
    """Where flanks touch in the plane of action: a rectangle, the path of contact times the common face width (mm).

    Lines cross it at the base helix angle (degrees), one transverse base pitch apart; `base_diameter` is the pinion's.
    A double helical pair has two such rectangles, of the width of one half; `phases` (base pitches) is how far lines are on
    in each.
    """

    path: PathOfContact
    pitch: float
    width: float
    base_helix_angle: float
    base_diameter: float
    phases: tuple[float, ...] = (0.0,)

    @property
    def _helix(self) -> float:
        """Base helix angle in radians, without its hand."""
        return math.radians(abs(self.base_helix_angle))

    @property
    def _reach(self) -> float:
        """How far a line reaches along the path over the face width (mm)."""
        return self.width * math.tan(self._helix)

    def line_length(self, roll_angle: ArrayLike) -> Any:
        """Total length (mm) of the lines of contact at a roll angle of the pinion (degrees), scalar or array.

        Roll angle 0 puts contact at the pitch point in the middle plane of the common face width.
        """
        travel = self.path.C + np.radians(np.asarray(roll_angle, float)) * self.base_diameter / 2
        total = sum(self._length(travel + phase * self.pitch) for phase in self.phases)
        return float(total) if np.ndim(total) == 0 else total

    def _length(self, travel: Floats) -> Floats:
        """Length (mm) of the lines in one rectangle where one of them is at `travel` (mm) on the line of action."""
        path, pitch, reach = self.path, self.pitch, self._reach
        most = math.ceil((path.E - path.A + reach) / pitch) + 1
        middle = path.A + np.mod(travel - path.A, pitch)
        places = middle[..., None] + np.arange(-most, most + 1) * pitch
        if reach < 1e-12 * self.width:
            inside = (places >= path.A) & (places <= path.E)
            total: Floats = self.width * inside.sum(-1).astype(float)
        else:
            overlap = np.minimum(places + reach / 2, path.E) - np.maximum(places - reach / 2, path.A)
            total = np.clip(overlap, 0, None).sum(-1) / math.sin(self._helix)
        return total

    @property
    def line_lengths(self) -> ContactLineLengths:
        """Least, mean and greatest total length over the cycle.

        The total is piecewise linear in the roll angle, so its extremes lie where a line enters or leaves a corner of the
        zone of contact. Mean = epsilon_alpha b/cos beta_b exactly.
        """
        path, pitch, reach = self.path, self.pitch, self._reach
        corners = np.array([path.A - reach / 2, path.A + reach / 2, path.E - reach / 2, path.E + reach / 2])
        inner = np.sort(np.mod(np.concatenate([corners - path.A - phase * pitch for phase in self.phases]), pitch))
        between = (inner + np.r_[inner[1:], inner[0] + pitch]) / 2
        places = np.r_[inner, between] if reach > 0 else between
        total = self.line_length(np.degrees((path.A + places - path.C) / (self.base_diameter / 2)))
        mean = (path.E - path.A) / pitch * self.width / math.cos(self._helix) * len(self.phases)
        return ContactLineLengths(float(total.min()), mean, float(total.max()))
