"""The gap between two modified, misaligned flanks from points of both surfaces, and Hertz's elliptical contact."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize
from scipy.special import ellipe, ellipk

from gearcad import FlankModification, Gear, GearPair, Mounting, ReliefShape
from support.modified import relieved

Floats = NDArray[np.float64]

_SAMPLES = 40_001
"""Points of a flank in one transverse section: a quarter of a µm apart, chords 1e-9 mm off the curve."""


def middle_height(pair: GearPair) -> float:
    """z of the middle of the common face width (mm)."""
    return pair.pinion.face_width / 2 + pair.common_width.offset


def _rolls(gear: Gear) -> tuple[float, float]:
    """Roll lengths of the ends of the flank, root and tip (mm): r_b tan of the pressure angle there, negative on a ring."""
    ends = (gear.form_diameter, gear.tip_form_diameter)
    return tuple(gear.base_diameter / 2 * math.tan(math.acos(min(gear.base_diameter / end, 1.0))) for end in ends)  # type: ignore[return-value]


def _relief(amount: float, length: float, shape: ReliefShape, from_end: Floats) -> Floats:
    """Of a relief at distances from the end where it is deepest (µm)."""
    if not amount:
        return np.zeros_like(from_end)
    linear = np.interp(from_end, [0.0, length], [1.0, 0.0])
    return amount * (linear if shape is ReliefShape.LINEAR else linear * linear)


def taken_back(gear: Gear, lengths: Floats, heights: Floats) -> Floats:
    """How far (mm) the flank that meets its mate is taken back at roll lengths and heights over the gear's own z = 0."""
    of: FlankModification = gear.modification
    first, last = _rolls(gear)
    lengths, heights = np.broadcast_arrays(np.clip(lengths, first, last), np.clip(heights, 0, gear.face_width))
    middle, half = (first + last) / 2, (last - first) / 2
    centre, side = gear.face_width / 2, gear.face_width / 2
    amount = relieved(gear, "tip", lengths - last + of.tip_relief_length)
    amount = amount + relieved(gear, "root", first + of.root_relief_length - lengths)
    for from_end in (heights, gear.face_width - heights):
        amount = amount + _relief(of.end_relief, of.end_relief_length, of.end_relief_shape, from_end)
    amount = amount + of.profile_crowning * ((lengths - middle) / half) ** 2
    amount = amount + of.lead_crowning * ((heights - centre) / side) ** 2
    amount = amount + np.interp(lengths, [first, last], [0.0, of.pressure_angle_modification])
    # A right-hand screw turns counter-clockwise with z, the left flank away from its tooth: more of it adds material above.
    # Of a ring it is the other flank that meets the pinion.
    hand = (-1.0 if gear.helix_angle < 0 else 1.0) * math.copysign(1.0, gear.teeth)
    amount = amount - hand * np.interp(heights, [0.0, gear.face_width], [-0.5, 0.5]) * of.helix_angle_modification
    # Opposite corners alike: the diagonals rise and fall by a quarter.
    amount = amount + of.twist / 4 * ((lengths - middle) / half) * ((heights - centre) / side)
    return amount / 1000


def _section(base: float, contact: Floats, lengths: Floats, turned: Floats) -> tuple[Floats, Floats]:
    """Involute through (base, contact) with its normal along y, its points turned clockwise about the origin by an angle."""
    angle = (contact - lengths) / base - turned
    return base * np.cos(angle) - lengths * np.sin(angle), base * np.sin(angle) + lengths * np.cos(angle)


def _contact(pair: GearPair, roll_length: float, tooth: int, heights: Floats) -> Floats:
    """Roll length on the pinion at which exact flanks touch at heights: the line of contact leans by the base helix angle."""
    lean = math.tan(math.radians(pair.pinion.base_helix_angle))
    return roll_length + tooth * pair.pinion.transverse_base_pitch + (np.asarray(heights) - middle_height(pair)) * lean


def _whole(pair: GearPair) -> float:
    """T1T2 (mm), negative where the wheel is a ring."""
    square = pair.centre_distance**2 - ((pair.pinion.base_diameter + pair.wheel.base_diameter) / 2) ** 2
    return math.copysign(math.sqrt(square), pair.wheel.teeth)


def pinion_points(
    pair: GearPair, mounting: Mounting, roll_length: float, tooth: int, lengths: Floats, heights: Floats
) -> Floats:
    """Points (..., 3) of the pinion's flank at roll lengths and heights z, when tooth 0 touches at `roll_length` in the middle.

    The pair is as mounted (`Mounting.mounted`).
    """
    base = pair.pinion.base_diameter / 2
    proud = mounting.pinion_pitch_error / 1000 if tooth == 0 else 0.0
    turned = (taken_back(pair.pinion, lengths, heights) - proud) / base
    x, y = _section(base, _contact(pair, roll_length, tooth, heights), lengths, turned)
    return np.stack(np.broadcast_arrays(x, y, heights), -1)


def wheel_points(
    pair: GearPair, mounting: Mounting, roll_length: float, tooth: int, lengths: Floats, heights: Floats
) -> Floats:
    """The same of the wheel's flank that faces it; heights are z of the pinion, lengths the wheel's own from T2."""
    base, whole = abs(pair.wheel.base_diameter) / 2, _whole(pair)
    own = heights - (pair.pinion.face_width - pair.wheel.face_width) / 2 - pair.axial_offset
    proud = mounting.wheel_pitch_error / 1000 if tooth == 0 else 0.0
    turned = (taken_back(pair.wheel, lengths, own) - proud) / base
    touching, first = _contact(pair, roll_length, tooth, heights), pair.pinion.base_diameter / 2
    if pair.wheel.teeth > 0:
        # Half a turn about the middle of T1T2 lays the wheel's flank where a pinion's would be.
        x, y = _section(base, whole - touching, lengths, turned)
        x, y = first + base - x, whole - y
    else:
        # The base circles touch the line of action from the same side; what comes off the ring's flank moves it towards +y.
        x, y = _section(base, touching - whole, -lengths, -turned)
        x, y = first - base + x, whole + y
    along = (heights - middle_height(pair)) / pair.common_width.width / 1000
    x, y = x + mounting.misalignment_across * along, y + mounting.misalignment * along
    return np.stack(np.broadcast_arrays(x, y, heights), -1)


def gap_along_action(
    pair: GearPair, mounting: Mounting, roll_length: float, tooth: int, heights: Floats, places: Floats
) -> Floats:
    """Gap (mm) in the direction of the line of action at heights z and places x - r_b1 on the tangent: (heights, places).

    NaN where one of the flanks does not reach the place.
    """
    gap = np.full((len(heights), len(places)), math.nan)
    for row, z in enumerate(heights):
        curves = []
        for gear, points in ((pair.pinion, pinion_points), (pair.wheel, wheel_points)):
            lengths = np.linspace(*_rolls(gear), _SAMPLES)
            found = points(pair, mounting, roll_length, tooth, lengths, np.full_like(lengths, z))
            x, y = found[:, 0] - pair.pinion.base_diameter / 2, found[:, 1]
            order = np.argsort(x)
            curves.append(np.interp(places, x[order], y[order], left=math.nan, right=math.nan))
        gap[row] = curves[1] - curves[0]
    return gap


def distance_in_space(
    pair: GearPair, mounting: Mounting, roll_length: float, tooth: int, length: float, height: float
) -> float:
    """Distance (mm) of one point of the pinion's flank from the wheel's flank, the nearest of all its points."""
    point = pinion_points(pair, mounting, roll_length, tooth, np.array(length), np.array(height))

    def squared(where: Floats) -> float:
        other = wheel_points(pair, mounting, roll_length, tooth, np.array(where[0]), np.array(where[1]))
        return float(1e6 * ((other - point) ** 2).sum())

    start = _whole(pair) - float(_contact(pair, roll_length, tooth, np.array(height)))
    best = minimize(squared, [start, height], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-15, "maxiter": 4000})
    return math.sqrt(best.fun) / 1000


def hertz_ellipse(force: float, across: float, along: float, modulus: float) -> tuple[float, float, float]:
    """p_0 (MPa), greater and lesser half axis (mm) of an elliptical contact (Johnson, Contact Mechanics, 4.26 to 4.32)."""

    def ratio(slim: float) -> float:
        m = 1 - slim**2
        return float((ellipe(m) / slim**2 - ellipk(m)) / (ellipk(m) - ellipe(m))) - along / across

    slim = float(brentq(ratio, 1e-4, 1 - 1e-9))
    m = 1 - slim**2
    greater = (3 * force * (ellipk(m) - ellipe(m)) * along / (math.pi * m * modulus)) ** (1 / 3)
    return 3 * force / (2 * math.pi * greater**2 * slim), greater, greater * slim
