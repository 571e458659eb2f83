"""Path of contact of gear pairs, and of pinion and rack: ends, contact ratios, sliding, lines of contact (ISO 21771).

The line of action is measured from T1, where it touches the pinion's base circle (mm, transverse section). Diameters and
centre distance are signed: with an internal gear as the wheel its diameters and the centre distance are negative, and T2 lies
behind T1.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Floats, Notice, PerGear, texts
from gearcad.core.values import Values, hypot, larger, magnitude, radians, sin, smaller, tan, with_sign
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.involute import tangent_length


class PathOfContact(NamedTuple, Generic[Values]):
    """Distances from T1 (mm): A first contact, B and D single-contact limits, C pitch point, E last contact."""

    A: Values
    B: Values
    C: Values
    D: Values
    E: Values


@dataclass(frozen=True)
class BaseTangent(Generic[Values]):
    """The common tangent of both base circles, which is the line of action. Lengths in mm.

    `pressure_angle` is the working transverse one (degrees), `pitch` the transverse base pitch.
    """

    base_diameters: PerGear[Values]
    centre_distance: Values
    pressure_angle: Values
    pitch: Values

    @cached_property
    def length(self) -> Values:
        """T1T2 = a sin alpha_wt."""
        return self.centre_distance * sin(radians(self.pressure_angle))

    def path(self, tip_diameters: PerGear[Values]) -> PathOfContact[Values]:
        """Characteristic points, limited by the tip form circles of both gears."""
        start = self.length - tangent_length(tip_diameters.wheel, self.base_diameters.wheel)
        end = tangent_length(tip_diameters.pinion, self.base_diameters.pinion)
        middle = self.base_diameters.pinion / 2 * tan(radians(self.pressure_angle))
        return PathOfContact(start, end - self.pitch, middle, start + self.pitch, end)

    def lowest(self, path: PathOfContact[Values]) -> PerGear[Values]:
        """Return the lengths of the base tangent out to the lowest points that the mate's tip reaches; beyond the base circle
        negative.
        """
        return PerGear(path.A, self.length - path.E)

    def usable(self, path: PathOfContact[Values], form_diameters: PerGear[Values]) -> tuple[Values, Values]:
        """First and last contact (mm from T1) when the root form circles limit the path as well."""
        first = larger(path.A, tangent_length(form_diameters.pinion, self.base_diameters.pinion))
        last = smaller(path.E, self.length - tangent_length(form_diameters.wheel, self.base_diameters.wheel))
        return first, last

    def active_root_diameters(self, path: PathOfContact[Values]) -> PerGear[Values]:
        """d_Nf: the lowest points that the mate's tip form circle would touch (mm).

        Where a tip passes beyond the base tangent point, the base circle is the lowest point an involute has.
        """
        lowest = self.lowest(path)

        def circle(base: Values, along: Values) -> Values:
            side = with_sign(1.0, base)
            return side * hypot(base, 2 * larger(side * along, 0.0))

        return PerGear.each(lambda role: circle(self.base_diameters.pick(role), lowest.pick(role)))


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
        """Return the specific sliding from velocities (2,) along the tangent in A and E, in any unit."""
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


def overlap_ratio_of(width: Values, helix_angle: Values, normal_module: Values) -> Values:
    """epsilon_beta = b sin |beta|/(pi m_n) of a width b (mm) of teeth of one hand."""
    return width * sin(radians(magnitude(helix_angle))) / (math.pi * normal_module)


@dataclass(frozen=True)
class ContactZone:
    """Zone where flanks touch in the plane of action: a rectangle, the path of contact times the common face width (mm).

    Lines cross it at the base helix angle (degrees), one transverse base pitch apart; `base_diameter` is the pinion's.
    A double helical pair has two such rectangles, of the width of one half; `phases` (base pitches) is how far lines are on
    in each.
    """

    path: PathOfContact[float]
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
        """Distance (mm) along the path over which a line of contact extends across the face width."""
        return self.width * math.tan(self._helix)

    def line_length(self, roll_angle: ArrayLike) -> Any:
        """Total length (mm) of the lines of contact at a roll angle of the pinion (degrees), scalar or array.

        Roll angle 0 puts contact at the pitch point in the middle plane of the common face width.
        """
        travel = self.path.C + np.radians(np.asarray(roll_angle, float)) * self.base_diameter / 2
        total = sum(self._length(travel + phase * self.pitch) for phase in self.phases)
        return float(total) if np.ndim(total) == 0 else total

    def _length(self, travel: Floats) -> Floats:
        """Return the length (mm) of the lines in one rectangle where one of them is at `travel` (mm) on the line of action."""
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


class Mated(Generic[Values]):
    """Contact ratio and sliding by formula, which pairs of gears share with pairs of a pinion and a rack."""

    @property
    def path_of_contact(self) -> PathOfContact[Values]:
        """A, B, C, D, E on the line of action between the tips, less tip chamfers, as distances from T1 (mm)."""
        raise NotImplementedError

    @property
    def _base_pitch(self) -> Values:
        """Transverse base pitch p_bt (mm)."""
        raise NotImplementedError

    def rolling_speeds(self, distances: ArrayLike) -> PerGear[Floats]:
        """Velocities (n,) of both flanks along their common tangent (mm per radian of the pinion) at distances (mm) from T1."""
        raise NotImplementedError

    def specific_sliding_at(self, distances: ArrayLike) -> PerGear[Floats]:
        """Specific sliding zeta (n,) of pinion and wheel, or rack, at distances (mm) from T1 along the path of contact
        (ISO 21771).
        """
        return sliding_along(self.rolling_speeds(distances))

    @cached_property
    def transverse_contact_ratio(self) -> Values:
        """epsilon_alpha from the tips, less tip chamfers."""
        path = self.path_of_contact
        return (path.E - path.A) / self._base_pitch


class MatedPair(Mated[float]):
    """Usable path of contact, lines of contact and notices in words, shared by gear pairs and pinion-rack pairs."""

    pinion: GearData

    @property
    def usable_path(self) -> tuple[float, float]:
        """First and last contact (mm from T1) when the ends of the flanks at both roots limit the path as well."""
        raise NotImplementedError

    @property
    def _width_of_one_hand(self) -> float:
        """Common face width (mm) of teeth of one hand."""
        raise NotImplementedError

    @property
    def _phases(self) -> tuple[float, ...]:
        """How far the lines of contact are on, in base pitches, in each half of the face width."""
        return (0.0,)

    @property
    def specific_sliding(self) -> SpecificSliding:
        """Specific sliding of both flanks at the first and the last contact, and the greatest; a rack counts as the wheel."""
        return SpecificSliding.between(self.rolling_speeds(self.usable_path))

    @property
    def usable_contact_ratio(self) -> float:
        """epsilon_alpha also limited by the ends of the flanks at the roots; 0 where nothing is left."""
        first, last = self.usable_path
        return max(last - first, 0.0) / self._base_pitch

    @property
    def overlap_ratio(self) -> float:
        """epsilon_beta = b sin |beta|/(pi m_n) on the common face width, that of one half of double helical gears."""
        return overlap_ratio_of(self._width_of_one_hand, self.pinion.helix_angle, self.pinion.normal_module)

    @property
    def total_contact_ratio(self) -> float:
        """epsilon_gamma = epsilon_alpha + epsilon_beta."""
        return self.transverse_contact_ratio + self.overlap_ratio

    @cached_property
    def _zone(self) -> ContactZone:
        pinion, width = self.pinion, self._width_of_one_hand
        helix, base = pinion.base_helix_angle, pinion.base_diameter
        return ContactZone(self.path_of_contact, self._base_pitch, width, helix, base, self._phases)

    def contact_line_length(self, roll_angle: ArrayLike) -> Any:
        """Total length (mm) of the lines of contact at a roll angle of the pinion (degrees), scalar or array.

        Roll angle 0 puts contact at the pitch point in the middle plane of the common face width.
        """
        return self._zone.line_length(roll_angle)

    @cached_property
    def contact_line_lengths(self) -> ContactLineLengths:
        """Least, mean and greatest total length of the lines of contact over the cycle (mm)."""
        return self._zone.line_lengths

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices about this pair that an engineer should read before making it."""
        raise NotImplementedError

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)
