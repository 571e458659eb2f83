"""Life of rolling bearings (ISO 281): equivalent loads, L10, and the factor of lubrication and contamination.

Forces in N, speeds in rpm, diameters in mm, viscosities in mm²/s, lives in million revolutions and hours. Tables and factors of
which no text was at hand are named in RECALLED.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError

BALL_KINDS = ("deep groove", "angular contact")
ROLLER_KINDS = ("cylindrical", "tapered", "spherical")
KINDS = (*BALL_KINDS, *ROLLER_KINDS)

SIDES = ("left", "right")
"""Sides to which a bearing can push its shaft, right towards larger z."""

RECALLED = (
    "ISO 281: factors e and Y of deep groove ball bearings, X of angular contact ones by e, the thrust F_r/(2 Y) of opposed"
    " bearings, a_1, and the constants of a_ISO for rollers"
)
"""Figures that rest on memory, for the list of unconfirmed figures."""

_RELATIVE = (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89)
"""f_0 F_a/C_0 of deep groove ball bearings."""

_LIMIT = (0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44)
_AXIAL = (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00)

_CONTACT = ((0.57, 0.43), (0.68, 0.41), (0.80, 0.39), (0.95, 0.37), (1.14, 0.35), (1.34, 0.33))
"""Limit e and factor X of single-row angular contact ball bearings of 20 to 45 degrees."""

OPPOSED_KINDS = ("angular contact", "tapered")
"""Kinds that push their shaft to one side only, and make thrust of radial forces."""

_RELIABILITY = {90.0: 1.0, 95.0: 0.64, 96.0: 0.55, 97.0: 0.47, 98.0: 0.37, 99.0: 0.25}
"""Factor a_1 by the reliability in %."""

_MOST = 50.0
"""Greatest a_ISO."""

_BALL = ((0.4, 0.054381, 2.2649), (1.0, 0.19087, 1.9987), (math.inf, 0.071739, 1.9987))
_ROLLER = ((0.4, 0.054381, 1.3993), (1.0, 0.19087, 1.2348), (math.inf, 0.071739, 1.2348))
"""Viscosity ratio below which it applies, exponent and numerator."""


class EquivalentLoad(NamedTuple):
    """Dynamic equivalent load P (N), and the limit e and axial factor Y that made it."""

    load: float
    limit: float
    axial_factor: float


def deep_groove_load(radial: float, axial: float, *, f0: float, static_rating: float) -> EquivalentLoad:
    """P = F_r up to F_a/F_r = e, else .56 F_r + Y F_a, with e and Y by f_0 F_a/C_0, linear between the values of the table.

    Without an axial force neither f_0 nor C_0 (N) matters.
    """
    relative = f0 * axial / static_rating if axial else 0.0
    limit, factor = (float(np.interp(relative, _RELATIVE, table)) for table in (_LIMIT, _AXIAL))
    if axial <= limit * radial:
        return EquivalentLoad(radial, limit, factor)
    return EquivalentLoad(0.56 * radial + factor * axial, limit, factor)


def two_factor_load(
    radial: float, axial: float, *, limit: float, below: tuple[float, float], beyond: tuple[float, float]
) -> EquivalentLoad:
    """P = X F_r + Y F_a with the factors (X, Y) below the `limit` of F_a/F_r, or those beyond it."""
    factor, along = below if axial <= limit * radial else beyond
    return EquivalentLoad(factor * radial + along * axial, limit, along)


def one_sided_load(kind: str, radial: float, axial: float, *, limit: float, factor: float) -> EquivalentLoad:
    """P = F_r up to e, else X F_r + Y F_a with X = .4 of tapered bearings, and by e of angular contact ones."""
    limits, factors = zip(*_CONTACT, strict=True)
    across = 0.4 if kind == "tapered" else float(np.interp(limit, limits, factors))
    found = two_factor_load(radial, axial, limit=limit, below=(1.0, 0.0), beyond=(across, factor))
    return found._replace(axial_factor=factor)


def opposed_axial_loads(radial: tuple[float, float], factors: tuple[float, float], outer: float) -> tuple[float, float]:
    """Return the axial loads (N) of two opposed tapered or angular contact bearings A and B, `outer` thrust (N) towards A.

    Each radial load makes F_r/(2 Y) of thrust: F_aA = max(F_rA/2Y_A, F_rB/2Y_B + K_a), F_aB = max(F_rB/2Y_B, F_rA/2Y_A - K_a).
    """
    own = [load / (2 * factor) for load, factor in zip(radial, factors, strict=True)]
    return max(own[0], own[1] + outer), max(own[1], own[0] - outer)


def basic_life(rating: float, load: float, *, ball: bool) -> float:
    """L10 = (C/P)^p million revolutions, p = 3 for balls, 10/3 for rollers; infinite without a load."""
    return (rating / load) ** (3.0 if ball else 10 / 3) if load else math.inf


def life_in_hours(revolutions: float, speed: float) -> float:
    """Return the hours of so many million revolutions at a speed (rpm)."""
    return revolutions * 1e6 / (60 * abs(speed))


def reference_viscosity(speed: float, pitch_diameter: float) -> float:
    """nu_1 (mm²/s) by the pitch diameter D_pw (mm): 45000 n^-.83 D_pw^-.5 below 1000 rpm, 4500 (n D_pw)^-.5 from there on."""
    speed = abs(speed)
    factor = 45000 * speed**-0.83 if speed < 1000 else 4500 * speed**-0.5
    return float(factor * pitch_diameter**-0.5)


def life_factor(viscosity_ratio: float, fatigue: float, *, ball: bool) -> float:
    """Return a_ISO by kappa = nu/nu_1 and `fatigue` = e_C C_u/P: at most 50. Kappa counts up to 4, below .1 is not covered.

    Raises GeometryError.
    """
    if viscosity_ratio < 0.1:
        raise GeometryError("viscosity", viscosity_ratio, "must be at least 0.1 times the reference viscosity of the bearing")
    kappa = min(viscosity_ratio, 4.0)
    _, exponent, numerator = next(row for row in (_BALL if ball else _ROLLER) if kappa < row[0])
    slope = numerator / kappa**exponent
    if ball:
        bracket = 1 - (2.5671 - slope) ** 0.83 * fatigue ** (1 / 3)
        power = -9.3
    else:
        bracket = 1 - (1.5859 - slope) * fatigue**0.4
        power = -9.185
    return _MOST if bracket <= 0 else min(0.1 * bracket**power, _MOST)


def reliability_factor(reliability: float) -> float:
    """Return a_1 by the reliability (%). Raises GeometryError for one that has none."""
    if reliability not in _RELIABILITY:
        known = ", ".join(f"{each:g}" for each in _RELIABILITY)
        raise GeometryError("life_reliability", reliability, f"must be one of {known} %", "%")
    return _RELIABILITY[reliability]


def fatigue_limit_load(static_rating: float, pitch_diameter: float, *, ball: bool) -> float:
    """C_u (N): C_0/22 of balls, C_0/8.2 of rollers, times (100/D_pw)^.5 above a pitch diameter of 100 mm."""
    load = static_rating / (22.0 if ball else 8.2)
    return load * math.sqrt(100 / pitch_diameter) if pitch_diameter > 100 else load


def ball_deflection(radial: float, *, balls: int, ball_diameter: float, contact_angle: float = 0.0) -> float:
    """Return the radial deflection (mm) of a ball bearing: 4.36e-4 (Q^2/D_w)^(1/3), Q = 5 F_r/(Z cos alpha), no clearance."""
    most = 5 * radial / (balls * math.cos(math.radians(contact_angle)))
    return 4.36e-4 * math.cbrt(most**2 / ball_diameter)
