"""Hertz's elliptical contact in closed form."""

from __future__ import annotations

import math

from scipy.optimize import brentq
from scipy.special import ellipe, ellipk


def hertz_ellipse(force: float, across: float, along: float, modulus: float) -> tuple[float, float, float]:
    """p_0 (MPa), greater and lesser half axis (mm) of an elliptical contact (Johnson, Contact Mechanics, 4.26 to 4.32)."""

    def ratio(slim: float) -> float:
        m = 1 - slim**2
        return float((ellipe(m) / slim**2 - ellipk(m)) / (ellipk(m) - ellipe(m))) - along / across

    slim = float(brentq(ratio, 1e-4, 1 - 1e-9))
    m = 1 - slim**2
    greater = (3 * force * (ellipk(m) - ellipe(m)) * along / (math.pi * m * modulus)) ** (1 / 3)
    return 3 * force / (2 * math.pi * greater**2 * slim), greater, greater * slim
