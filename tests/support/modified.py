"""Modified flanks by formulas of their own: depths in mm, and how far points of a solid are off the surface they make."""

import math
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from gearcad import Gear
from gearcad.core.records import Floats


def _roll(gear: Gear, radius: Floats) -> Floats:
    """Length of roll (mm): the tangent from a circle to the base circle; negative on a ring, where it grows to the tip too."""
    result: Floats = np.sqrt(np.maximum(radius**2 - gear.base_diameter**2 / 4, 0.0))
    return -result if gear.internal else result


def roll_ends(gear: Gear) -> tuple[float, float]:
    """Lengths of roll (mm) of the root and the tip form circle."""
    first, last = _roll(gear, np.array([gear.form_diameter, gear.tip_form_diameter]) / 2)
    return float(first), float(last)


def transition(gear: Gear, end: str) -> float:
    """Return the transition (mm of roll) at the start of a linear "tip" or "root" relief: given, or 0.1 m_n where that fits."""
    m, (first, last) = gear.modification, roll_ends(gear)
    given, length = getattr(m, f"{end}_relief_transition"), getattr(m, f"{end}_relief_length")
    return min(0.1 * gear.normal_module, 2 * length, 2 * (last - first - length)) if given is None else given


def relieved(gear: Gear, end: str, past: Floats) -> Floats:
    """Return how much (µm) a relief takes off at roll lengths `past` its start (mm): nothing, a parabola, a line."""
    m = gear.modification
    amount, length = getattr(m, f"{end}_relief"), getattr(m, f"{end}_relief_length")
    if not amount:
        return 0.0 * past
    if getattr(m, f"{end}_relief_shape").value == "parabolic":
        return np.asarray(amount * (np.clip(past, 0, None) / length) ** 2)
    t = transition(gear, end)
    # The slope of the depth rises evenly from 0 to amount/length.
    grown = np.clip(past + t / 2, 0, t)
    return np.asarray(amount / length * ((grown**2 / (2 * t) if t else 0.0) + np.clip(past - t / 2, 0, None)))


def specified(gear: Gear, radius: Floats, z: Floats, left: NDArray[np.bool_] | bool) -> Floats:
    """Depth (mm) asked for at a radius and a height: what `gear.modification` says, one line per modification.

    On the fillet that at the root form circle, on the tip chamfer that at the tip form circle.
    """
    m = gear.modification
    first, last = roll_ends(gear)
    beyond = radius > -gear.form_diameter / 2 if gear.internal else radius < gear.form_diameter / 2
    roll = np.clip(np.where(beyond, first, _roll(gear, radius)), first, last)
    length, width = last - first, gear.face_width
    middle = roll - (first + last) / 2
    off = z - width / 2
    end_share = np.clip((np.abs(off) - width / 2) / m.end_relief_length + 1, 0, None) if m.end_relief else 0.0 * off
    powers = {"linear": 1, "parabolic": 2}
    steeper = 1.0 if gear.helix_angle >= 0 else -1.0  # the hand
    micrometres = (
        relieved(gear, "tip", roll - last + m.tip_relief_length)
        + relieved(gear, "root", first - roll + m.root_relief_length)
        + m.end_relief * end_share ** powers[m.end_relief_shape.value]
        + m.profile_crowning * (middle / (length / 2)) ** 2
        + m.lead_crowning * (off / (width / 2)) ** 2
        + m.pressure_angle_modification * (roll - first) / length
        # A steeper helix turns the sections above the middle on, which takes off the right flank there.
        + m.helix_angle_modification * steeper * off / width * np.where(left, -1.0, 1.0)
        + m.twist * (off / width) * (middle / length)
    )
    result: Floats = np.asarray(micrometres / 1000)
    return result


def folded(gear: Gear, points: Floats) -> tuple[Floats, Floats, Floats]:
    """Radius (mm), angle from the middle of the tooth (rad) and height (mm) of points (n, 3), the twist taken off."""
    x, y, z = points.T
    rate = math.tan(math.radians(gear.helix_angle)) / (abs(gear.reference_diameter) / 2)
    pitch = 2 * math.pi / gear.tooth_count
    angle = np.mod(np.arctan2(y, x) - rate * z + pitch / 2, pitch) - pitch / 2
    return np.hypot(x, y), angle, z


def depth_off(gear: Gear, points: Floats) -> Floats:
    """How far (mm, along the base tangent) points (n, 3) on the involute flanks are off the depth that is specified."""
    radius, angle, z = folded(gear, points)
    left = angle > 0
    base, grows = abs(gear.base_diameter) / 2, -1 if gear.internal else 1  # of a ring the half angle grows outwards
    pressure = np.arccos(np.clip(base / radius, -1, 1))
    at_reference = math.radians(gear.transverse_pressure_angle)
    half = gear.transverse_tooth_thickness / abs(gear.reference_diameter) + grows * (math.tan(at_reference) - at_reference)
    half = half - grows * (np.tan(pressure) - pressure)
    measured = (half - np.abs(angle)) * base
    result: Floats = measured - specified(gear, radius, z, left)
    return result


def unturned(gear: Gear, points: Floats) -> Floats:
    """Points (n, 3) of the side turned back by what the modifications have turned them: onto the unmodified side."""
    radius, angle, z = folded(gear, points)
    back = specified(gear, radius, z, angle > 0) / (abs(gear.base_diameter) / 2) * np.where(angle > 0, 1, -1)
    x, y, _ = points.T
    cosine, sine = np.cos(back), np.sin(back)
    return np.stack([cosine * x - sine * y, sine * x + cosine * y, z], -1)


def removed_volume(gear: Gear) -> float:
    """Volume (mm³) that the modifications take off: the integral of (left and right depth)/r_b R dR dz over the teeth.

    Gauss points on pieces between all corners of the depth and of the end chamfers.
    """
    m = gear.modification
    first, last = roll_ends(gear)
    slope = math.tan(math.radians(gear.body.end_chamfer_angle))
    side = -1 if gear.internal else 1
    face = side * (gear.tip_diameter / 2 - gear.body.end_chamfer * slope)
    ends = [0.0, m.end_relief_length if m.end_relief else 0.0]
    starts = (("tip", last - m.tip_relief_length), ("root", first + m.root_relief_length))
    rolls = [start + side * transition(gear, end) / 2 for end, start in starts for side in (-1, 0, 1)]
    circles = (gear.root_diameter, gear.form_diameter, gear.tip_form_diameter, gear.tip_diameter)
    radii = [*(side * circle / 2 for circle in circles), *(face + side * z * slope for z in ends)]
    low, high = sorted((radii[0], radii[3]))
    radii += [math.hypot(roll, gear.base_diameter / 2) for roll in rolls if first < roll < last]
    return gear.tooth_count * sum(
        _over_ring(gear, inner, outer, ends, face, slope)
        for inner, outer in pairwise(sorted({min(max(radius, low), high) for radius in radii}))
    )


def _over_ring(gear: Gear, inner: float, outer: float, ends: list[float], face: float, slope: float) -> float:
    """The integral over one tooth between two radii (mm), over the roll xi where there is one: R dR = xi dxi."""
    base, width, side = abs(gear.base_diameter) / 2, gear.face_width, -1 if gear.internal else 1
    core = base if side * (inner + outer) > gear.form_diameter else 0.0
    low_roll, high_roll = (math.sqrt(max(radius**2 - core**2, 0.0)) for radius in (inner, outer))
    nodes, weights = leggauss(12)
    total = 0.0
    for roll, share in zip(*_placed(nodes, weights, low_roll, high_roll), strict=True):
        radius = math.hypot(core, roll)
        setback = max(side * (radius - face), 0.0) / slope if gear.body.end_chamfer else 0.0
        inside = (min(max(z, setback), width - setback) for end in ends for z in (end, width - end))
        for low, high in pairwise(sorted(inside)):
            z, part = _placed(nodes, weights, low, high)
            both = sum(specified(gear, np.full(z.shape, radius), z, left) for left in (True, False))
            total += share * roll * float(both @ part)
    return total / base


def _placed(nodes: Floats, weights: Floats, low: float, high: float) -> tuple[Floats, Floats]:
    return (low + high) / 2 + nodes * (high - low) / 2, weights * (high - low) / 2
