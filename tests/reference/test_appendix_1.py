"""The trochoid of the Chalmers/Volvo thesis, appendix 1, as its authors built it: how far it is from the exact one.

Equations A1.4-A1.21 with the transverse module and pressure angle and a CIRCULAR tool tip in the transverse section. They
are exact for spur gears once the sine in A1.21 is the tangent it must be; for helical gears the tip is an ellipse.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import brentq
from support.cases import case

from gearcad.geometry.fillets import ToolTip

ARC = 1e-6
"""mm: the tolerance of the listed deviations."""

EXACT = 1e-11
"""mm: rounding of the deviation where both curves are the same."""

GEARS = {
    "s001_1": "s001_gear1_profile",
    "s001_2": "s001_gear2_profile",
    "s000_1": "s000_gear1_profile",
    "s000_3": "s000_gear3_profile",
}


@dataclass(frozen=True)
class Appendix1:
    """The thesis's trochoid; symbols as printed there."""

    m: float
    z: int
    alpha: float
    X: float
    r_t: float
    dedendum: float
    corrected: bool

    @property
    def r(self) -> float:
        return self.m * self.z / 2

    @property
    def B(self) -> float:
        return self.dedendum - self.r_t - self.X  # A1.6

    @property
    def W(self) -> float:
        """Angle from the middle of the trochoid to the middle of the tooth: A1.18-A1.21."""
        slope = math.tan(self.alpha) if self.corrected else math.sin(self.alpha)
        T = math.pi * self.m / 2 - 2 * self.X * slope  # A1.21: space width
        L = 0.5 * T - self.B * math.tan(self.alpha) - self.r_t / math.cos(self.alpha)  # A1.19
        return (math.pi * self.m / 2 - L) / self.r

    def point(self, E: float) -> tuple[float, float]:
        r, B = self.r, self.B
        x = r * E * math.cos(E) - (r - B) * math.sin(E)  # A1.4
        y = (r - B) * math.cos(E) + r * E * math.sin(E)  # A1.5
        A = math.atan2(B * math.cos(E) - r * E * math.sin(E), r * E * math.cos(E) + B * math.sin(E))  # A1.11
        return x + self.r_t * math.cos(A), y - self.r_t * math.sin(A)  # A1.8, A1.9

    def half_angle(self, radius: float) -> float:
        E = float(brentq(lambda E: math.hypot(*self.point(E)) - radius, 1e-9, math.radians(30), xtol=1e-15))
        x, y = self.point(E)
        return self.W - math.atan2(x, y)


def _deviations(name: str, variant: str) -> np.ndarray:
    """Arc (mm) by which the thesis's half tooth exceeds the exact one, at the listed radii."""
    given = case(GEARS[name])["inputs"]
    beta, alpha_n = math.radians(given["beta"]), math.radians(given["alpha_n"])
    m_t, shift = given["mn"] / math.cos(beta), given["x"] * given["mn"]
    printed = Appendix1(
        m=m_t,
        z=given["z"],
        alpha=math.atan(math.tan(alpha_n) / math.cos(beta)),
        X=shift,
        r_t=given["rho"],
        dedendum=given["hfP"] * given["mn"],
        corrected=variant == "tan_t_xn",
    )
    tool = ToolTip.cutting(
        normal_module=given["mn"],
        pressure_angle=alpha_n,
        helix_angle=beta,
        reference_radius=m_t * given["z"] / 2,
        depth=given["hfP"] * given["mn"] - shift,
        shift=shift,
        radius=given["rho"],
        thinning=0.0,
    )
    radii = np.array(case("s001_appendix1")["verified"][name][variant]["R_mm"])
    exact = math.pi / given["z"] - tool.cut(tool.theta_at(radii, tool.last_angle))[1]
    return radii * ([printed.half_angle(radius) for radius in radii] - exact)


@pytest.mark.parametrize("name", GEARS)
@pytest.mark.parametrize("variant", ["lit_t", "tan_t_xn"])
def test_deviation_is_the_listed_one(name: str, variant: str) -> None:
    listed = case("s001_appendix1")["verified"][name][variant]["arc_dev_mm"]
    assert _deviations(name, variant) == pytest.approx(listed, abs=ARC, rel=0)


@pytest.mark.parametrize("name", ["s000_1", "s000_3"])
def test_spur_is_exact_once_corrected(name: str) -> None:
    assert _deviations(name, "tan_t_xn") == pytest.approx(np.zeros(6), abs=EXACT, rel=0)


def test_helical_is_wrong_by_a_tenth_of_a_millimetre() -> None:
    assert _deviations("s001_1", "tan_t_xn")[0] == pytest.approx(-0.0998, abs=5e-5)
    assert _deviations("s001_2", "tan_t_xn")[0] == pytest.approx(-0.0719, abs=5e-5)
