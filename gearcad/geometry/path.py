"""Path and lines of contact of an external pair.

The line of action is measured from T1, where it touches the pinion's base circle (mm, transverse section).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.per_gear import PerGear

if TYPE_CHECKING:
    from gearcad.geometry.gear import Gear
    from gearcad.geometry.pair import GearPair

__all__ = [
    "ContactLineLengths",
    "PathOfContact",
    "active_root_diameters",
    "contact_line_length",
    "contact_line_lengths",
    "farthest_centre_distance",
    "path_of_contact",
    "usable_path",
]


class PathOfContact(NamedTuple):
    """Distances from T1 (mm): A first contact, B and D single-contact limits, C pitch point, E last contact."""

    A: float
    B: float
    C: float
    D: float
    E: float


class ContactLineLengths(NamedTuple):
    """Total length of the simultaneous lines of contact over the cycle (mm)."""

    minimum: float
    mean: float
    maximum: float


def _base_tangent_distance(pair: GearPair) -> float:
    """T1T2 = a sin alpha_wt."""
    return pair.centre_distance * math.sin(math.radians(pair.working_transverse_pressure_angle))


def _tangent_length(gear: Gear, diameter: float) -> float:
    """Length of the base tangent out to `diameter`: the involute's radius of curvature there."""
    return math.sqrt(max((diameter - gear.base_diameter) * (diameter + gear.base_diameter), 0.0)) / 2


def path_of_contact(pair: GearPair) -> PathOfContact:
    """Characteristic points on the line of action, limited by the tip form circles of both gears."""
    start = _base_tangent_distance(pair) - _tangent_length(pair.wheel, pair.wheel.tip_form_diameter)
    end = _tangent_length(pair.pinion, pair.pinion.tip_form_diameter)
    pitch = pair.pinion.transverse_base_pitch
    middle = pair.pinion.base_diameter / 2 * math.tan(math.radians(pair.working_transverse_pressure_angle))
    return PathOfContact(start, end - pitch, middle, start + pitch, end)


def farthest_centre_distance(pinion: Gear, wheel: Gear) -> float:
    """Centre distance (mm) at which the path of contact vanishes: both tip form circles meet on the line of action."""
    tangents = _tangent_length(pinion, pinion.tip_form_diameter) + _tangent_length(wheel, wheel.tip_form_diameter)
    return math.hypot((pinion.base_diameter + wheel.base_diameter) / 2, tangents)


def usable_path(pair: GearPair) -> tuple[float, float]:
    """First and last contact (mm from T1) when the root form circles limit the path as well."""
    path = path_of_contact(pair)
    first = max(path.A, _tangent_length(pair.pinion, pair.pinion.form_diameter))
    last = min(path.E, _base_tangent_distance(pair) - _tangent_length(pair.wheel, pair.wheel.form_diameter))
    return first, last


def active_root_diameters(pair: GearPair) -> PerGear[float]:
    """d_Nf: the lowest points that the mate's tip form circle would touch (mm).

    Where a tip passes beyond the base tangent point, the base circle is the lowest point an involute has.
    """
    path, whole = path_of_contact(pair), _base_tangent_distance(pair)
    pinion = math.hypot(pair.pinion.base_diameter, 2 * max(path.A, 0.0))
    wheel = math.hypot(pair.wheel.base_diameter, 2 * max(whole - path.E, 0.0))
    return PerGear(pinion, wheel)


def contact_line_length(pair: GearPair, roll_angle: ArrayLike) -> Any:
    """Total length (mm) of the lines of contact at a roll angle of the pinion (degrees), scalar or array.

    Roll angle 0 puts contact at the pitch point in the middle plane of the common face width. The zone of contact is
    a rectangle, path times width; the lines cross it at the base helix angle, one transverse base pitch apart.
    """
    path, pitch = path_of_contact(pair), pair.pinion.transverse_base_pitch
    width, helix = pair.common_width.width, math.radians(abs(pair.pinion.base_helix_angle))
    travel = path.C + np.radians(np.asarray(roll_angle, float)) * pair.pinion.base_diameter / 2
    reach = width * math.tan(helix)
    lines = np.arange(-math.ceil((path.E - path.A + reach) / pitch) - 1, math.ceil((path.E - path.A + reach) / pitch) + 2)
    middle = path.A + np.mod(travel - path.A, pitch)
    places = middle[..., None] + lines * pitch
    if reach < 1e-12 * width:
        inside = (places >= path.A) & (places <= path.E)
        total = width * inside.sum(-1).astype(float)
    else:
        overlap = np.minimum(places + reach / 2, path.E) - np.maximum(places - reach / 2, path.A)
        total = np.clip(overlap, 0, None).sum(-1) / math.sin(helix)
    return float(total) if total.ndim == 0 else total


def contact_line_lengths(pair: GearPair) -> ContactLineLengths:
    """Least, mean and greatest total length over the cycle.

    The total is piecewise linear in the roll angle, so its extremes lie where a line enters or leaves a corner of the
    zone of contact. Mean = epsilon_alpha b/cos beta_b exactly.
    """
    path, pitch = path_of_contact(pair), pair.pinion.transverse_base_pitch
    helix = math.radians(abs(pair.pinion.base_helix_angle))
    reach = pair.common_width.width * math.tan(helix)
    corners = np.array([path.A - reach / 2, path.A + reach / 2, path.E - reach / 2, path.E + reach / 2])
    inner = np.sort(np.mod(corners - path.A, pitch))
    between = (inner + np.r_[inner[1:], inner[0] + pitch]) / 2
    places = np.r_[inner, between] if reach > 0 else between
    roll = np.degrees((path.A + places - path.C) / (pair.pinion.base_diameter / 2))
    total = contact_line_length(pair, roll)
    mean = (path.E - path.A) / pitch * pair.common_width.width / math.cos(helix)
    return ContactLineLengths(float(total.min()), mean, float(total.max()))
