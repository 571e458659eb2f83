"""The two mesh-stiffness programs printed in the Alm thesis (appendices 1 and 2), errors included: evidence, never the product.

`python docs/alm_listings.py` prints what they give as they are printed, with each error set right by itself, and with all set
right, as JSON (N/mm: mean over the path of contact, greatest, smallest).

Each error has a `Correction` that takes it away alone or together with others. Units are those of the listings: mm, N, N/mm,
radians. Arrays hold the 100 positions of the listing: gear 1 from its foot to its tip, gear 2 likewise, so that gear 2
meets gear 1 in reverse. The listings' names are kept where they have one.
"""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Flag, auto
from functools import cached_property

import numpy as np

from gearcad.core.records import Floats


class Correction(Flag):
    """What may be set right in the listings, one by one."""

    SQUARED_COSINE = auto()
    """Foundation: cos^2 a and tan^2 a, where the listings take the cosine and the tangent of a^2."""
    OWN_GEAR = auto()
    """Gear 2 with its own thickness (Tian) and its own lever (Weber-Banaschek), where gear 1's are written."""
    HERTZ_ONCE = auto()
    """The Hertz term of the pair once: 1/kh, not 2/kh (Tian); not once per gear (Weber-Banaschek)."""
    COMMON_WIDTH = auto()
    """The common face width, where 15 and 10 mm are mixed."""
    FOUNDATION_BRACKETS = auto()
    """Weber-Banaschek: 18/pi (u/S)^2 + ..., where a bracket has drawn the other terms into the denominator."""
    CONJUGATE_RADII = auto()
    """Weber-Banaschek: Hertz with the two flanks that touch, where both run from foot to tip."""
    HALF_THICKNESS = auto()
    """Weber-Banaschek: k = (s/2)/cos a_F along the line of action, where s cos a is written."""
    THICKNESS_AT_RADIUS = auto()
    """Thickness at the diameter 2 (r_f + y), where the height y is added to a diameter."""
    ANGLE_AT_RADIUS = auto()
    """Pressure angle at the diameter 2 (r_f + u), likewise."""
    LOAD_ANGLE = auto()
    """Load against the tooth's centre line: a - psi, where the pressure angle a stands."""
    CENTRE_LINE_LEVER = auto()
    """Lever to where the line of action cuts the centre line, where the height of the point of contact stands."""
    CONTACT_ON_PATH = auto()
    """Point of contact from its place on the line of action, where the heights are spaced evenly."""


AS_PRINTED = Correction(0)
POSITIONS = 100
M_N, ADDENDUM, CLEARANCE = 1.5, 1.0, 0.25
ALPHA_N = math.pi / 9
TEETH, SHIFTS, WIDTHS = (18, 161), (0.3422, 0.1682), (15.0, 10.0)
CONTACT_RATIO = 1.573
E, NU, TORQUE = 206000.0, 0.3, 12700.0
G = E / (2 * (1 + NU))
BASE_PITCH = math.pi * M_N * math.cos(ALPHA_N)

N = np.arange(1, POSITIONS + 1)
GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(40)


def _stepped_working_angle() -> float:
    """The listings' alfw: up in steps of 0.0001 until its involute is no longer too small."""
    target = 2 * sum(SHIFTS) / sum(TEETH) * math.tan(ALPHA_N) + math.tan(ALPHA_N) - ALPHA_N
    angle = 0.0
    while math.tan(angle) - angle < target:
        angle += 0.0001
    return angle


@dataclass(frozen=True, kw_only=True)
class _Tooth:
    z: int
    x: float
    b: float
    fixed: Correction

    @property
    def r_b(self) -> float:
        return M_N * self.z * math.cos(ALPHA_N) / 2

    @property
    def r_f(self) -> float:
        return (M_N * self.z - 2 * (ADDENDUM + CLEARANCE - self.x) * M_N) / 2

    @property
    def r_a(self) -> float:
        return M_N * (self.z + 2 * ADDENDUM + 2 * self.x) / 2

    @cached_property
    def d_0(self) -> float:
        """The listings' dy_min: where the straight foot ends, up in steps of 0.01 to the base circle."""
        diameter = 2 * (self.r_f + 0.25 * M_N)
        while diameter < 2 * self.r_b:
            diameter += 0.01
        return diameter

    @property
    def foot(self) -> float:
        """Height of the straight foot, of constant thickness."""
        return self.d_0 / 2 - self.r_f

    def angle(self, diameter: Floats | float) -> Floats:
        # Some corrected points lie below the base circle: no involute there, so no pressure angle.
        return np.arccos(np.minimum(2 * self.r_b / diameter, 1.0))

    def involute_thickness(self, diameter: Floats | float) -> Floats:
        a = self.angle(diameter)
        at_base = math.pi / (2 * self.z) + 2 * self.x * math.tan(ALPHA_N) / self.z + math.tan(ALPHA_N) - ALPHA_N
        return diameter * (at_base - (np.tan(a) - a))

    def thickness(self, y: Floats | float) -> Floats:
        """The listings' t at the height y over the root circle, any shape; as printed it jumps where the foot ends."""
        diameter = 2 * (self.r_f + y) if Correction.THICKNESS_AT_RADIUS in self.fixed else y + self.d_0
        on_flank = self.involute_thickness(np.maximum(diameter, self.d_0))
        return np.where(y <= self.foot, self.involute_thickness(self.d_0), on_flank)

    def integral(self, of: Callable[[Floats], Floats], upper: Floats) -> Floats:
        """Integral from the root circle to `upper` (100,), in two parts since the thickness jumps where the foot ends."""
        bend = np.minimum(self.foot, upper)
        total = np.zeros_like(upper)
        for low, high in ((np.zeros_like(upper), bend), (bend, upper)):
            half = (high - low) / 2
            y = (low + half)[:, None] + half[:, None] * GAUSS_POINTS
            total += half * (of(y) @ GAUSS_WEIGHTS)
        return total


@dataclass(frozen=True, kw_only=True)
class _Contact:
    """One gear at its 100 positions, from foot to tip."""

    s: Floats  # radius of curvature of the flank
    u: Floats  # height of the point of contact over the root circle
    t: Floats
    alpha: Floats
    alpha_load: Floats  # of the normal force against the perpendicular to the tooth's centre line
    alpha_used: Floats  # what the formulas take for it
    lever: Floats


def _teeth(fixed: Correction) -> tuple[_Tooth, _Tooth]:
    widths = (min(WIDTHS),) * 2 if Correction.COMMON_WIDTH in fixed else WIDTHS
    first, second = (_Tooth(z=z, x=x, b=b, fixed=fixed) for z, x, b in zip(TEETH, SHIFTS, widths, strict=True))
    return first, second


def _action() -> tuple[float, tuple[float, float], tuple[float, float]]:
    """Distance of the base circles' points of tangency, and the ends of the path of contact seen from each of them."""
    first, second = _teeth(AS_PRINTED)
    s_c = (first.r_b + second.r_b) * math.tan(_stepped_working_angle())
    low = s_c - math.sqrt(second.r_a**2 - second.r_b**2)
    high = math.sqrt(first.r_a**2 - first.r_b**2)
    return s_c, (low, high), (s_c - high, s_c - low)


def _contact(tooth: _Tooth, ends: tuple[float, float]) -> _Contact:
    fixed = tooth.fixed
    if Correction.CONTACT_ON_PATH in fixed:
        s = np.linspace(*ends, POSITIONS)
        u = np.sqrt(tooth.r_b**2 + s**2) - tooth.r_f
    else:
        s = ends[0] + N / POSITIONS * (ends[1] - ends[0])
        u = N / POSITIONS * (tooth.r_a - tooth.r_f) + (POSITIONS - N) / POSITIONS * 0.25 * M_N
    t = tooth.thickness(u)
    alpha = tooth.angle(2 * (tooth.r_f + u) if Correction.ANGLE_AT_RADIUS in fixed else u + tooth.d_0)
    alpha_load = alpha - t / (2 * (tooth.r_f + u))
    used = alpha_load if Correction.LOAD_ANGLE in fixed else alpha
    lever = u - t / 2 * np.tan(used) if Correction.CENTRE_LINE_LEVER in fixed else u
    return _Contact(s=s, u=u, t=t, alpha=alpha, alpha_load=alpha_load, alpha_used=used, lever=lever)


def _contacts(teeth: tuple[_Tooth, _Tooth]) -> tuple[_Contact, _Contact]:
    _, *ends = _action()
    return _contact(teeth[0], ends[0]), _contact(teeth[1], ends[1])


def _foundation_cosine(alpha: Floats, fixed: Correction) -> tuple[Floats, Floats]:
    """Squared cosine and tangent of the foundation's formula; as printed, of the squared angle."""
    if Correction.SQUARED_COSINE in fixed:
        return np.cos(alpha) ** 2, np.tan(alpha) ** 2
    return np.cos(alpha**2), np.tan(alpha**2)


# ---------------------------------------------------------------------- appendix 1


def _tian_tooth(tooth: _Tooth, borrowed: _Tooth, c: _Contact) -> Floats:
    """Bending, shear, axial and foundation compliance (mm/N); `borrowed` is the tooth whose thickness is written."""
    cos, sin = np.cos(c.alpha_used), np.sin(c.alpha_used)
    arm = borrowed.thickness(c.u) / 2 * sin

    def bending(y: Floats) -> Floats:
        moment = (c.u[:, None] - y) * cos[:, None] - arm[:, None]
        return moment**2 / (E * tooth.thickness(y) ** 3 * tooth.b / 12)

    along = borrowed.integral(lambda y: 1 / borrowed.thickness(y), c.u) / tooth.b
    cos2, tan2 = _foundation_cosine(c.alpha_used, tooth.fixed)
    ratio = c.lever / tooth.thickness(0.0)
    foundation = cos2 / (tooth.b * E) * (5.306 * ratio**2 + 1.4 * ratio + 1.4 * (1 + 0.32 * tan2))
    return tooth.integral(bending, c.u) + (1.2 * cos**2 / G + sin**2 / E) * along + foundation


def tian(fixed: Correction = AS_PRINTED) -> Floats:
    """Stiffness of a single pair (N/mm) by appendix 1, (100,) along the path of contact."""
    teeth = _teeth(fixed)
    borrowed = teeth if Correction.OWN_GEAR in fixed else (teeth[0], teeth[0])
    first, second = (_tian_tooth(*of) for of in zip(teeth, borrowed, _contacts(teeth), strict=True))
    hertz = 4 * (1 - NU**2) / (math.pi * E * teeth[0].b)
    return 1 / (first + second[::-1] + (1 if Correction.HERTZ_ONCE in fixed else 2) * hertz)


# ---------------------------------------------------------------------- appendix 2


def _weber_tooth(tooth: _Tooth, c: _Contact, linear_lever: Floats) -> Floats:
    """Bending and foundation compliance (mm/N); `linear_lever` stands in the foundation's linear term."""
    tan2 = np.tan(c.alpha_used) ** 2
    cubic = tooth.integral(lambda y: (c.lever[:, None] - y) ** 2 / tooth.thickness(y) ** 3, c.lever)
    plain = tooth.integral(lambda y: 1 / tooth.thickness(y), c.lever)
    bending = np.cos(c.alpha_used) ** 2 * (12 * cubic + (2.4 / (1 - NU) + tan2) * plain)
    t_0 = tooth.thickness(0.0)
    rest = 2 * (1 - 2 * NU) / (1 - NU) * linear_lever / t_0 + 4.8 / math.pi * (1 + (1 - NU) / 2.4 * tan2)
    if Correction.FOUNDATION_BRACKETS in tooth.fixed:
        bracket = 18 / math.pi * (c.lever / t_0) ** 2 + rest
    else:
        bracket = 18 / math.pi * c.lever**2 / (t_0**2 + rest)
    foundation = _foundation_cosine(c.alpha_used, tooth.fixed)[0] * bracket
    return (1 - NU**2) / (E * tooth.b) * (bending + foundation)


def _weber_hertz(teeth: tuple[_Tooth, _Tooth], contacts: tuple[_Contact, _Contact]) -> Floats:
    """The listing's Hertz term deltah over the force (mm/N)."""
    fixed, (first, second) = teeth[0].fixed, contacts
    if Correction.HALF_THICKNESS in fixed:
        k_1, k_2 = (c.t / 2 / np.cos(c.alpha_load) for c in contacts)
    else:
        k_1, k_2 = (c.t * np.cos(c.alpha) for c in contacts)
    s_1, s_2 = first.s, second.s
    if Correction.CONJUGATE_RADII in fixed:
        s_2, k_2 = _action()[0] - s_1, k_2[::-1]
    force = TORQUE / teeth[0].r_b
    a = np.sqrt(8 * force / teeth[0].b * s_1 * s_2 / (s_1 + s_2) * (1 - NU**2) / (math.pi * E))
    bracket = np.log(2 * np.sqrt(k_1 * k_2) / a) - NU / (2 * (1 - NU))
    return 4 / teeth[1].b * (1 - NU**2) / (math.pi * E) * bracket


def weber(fixed: Correction = AS_PRINTED) -> Floats:
    """Stiffness of a single pair (N/mm) by appendix 2, (100,) along the path of contact."""
    teeth = _teeth(fixed)
    contacts = _contacts(teeth)
    linear = contacts[0].lever, contacts[1].lever if Correction.OWN_GEAR in fixed else contacts[0].u
    first, second = (_weber_tooth(*of) for of in zip(teeth, contacts, linear, strict=True))
    hertz = _weber_hertz(teeth, contacts)
    return 1 / (first + second[::-1] + (hertz if Correction.HERTZ_ONCE in fixed else hertz + hertz[::-1]))


# ---------------------------------------------------------------------- pairs together


def path() -> Floats:
    """Places of the 100 positions on the line of action, from gear 1's point of tangency (mm)."""
    return np.linspace(*_action()[1], POSITIONS)


def over_path(single: Floats) -> Floats:
    """Mesh stiffness over the path as printed: the second pair fixed 50 places on or, wrapped, 49 places back."""
    s, length = path(), float(np.ptp(path()))
    second = np.array([single[n + 49] if n + 50 < POSITIONS else single[n - 50] for n in N])
    double = (s < s[-1] - length / CONTACT_RATIO) | (s >= s[0] + length / CONTACT_RATIO)
    return single + np.where(double, second, 0.0)


def over_base_pitch(single: Floats, points: int = 2001) -> Floats:
    """Mesh stiffness over one base pitch, ends included, with the second pair one base pitch on."""
    s = path()
    place = np.linspace(s[0], s[0] + BASE_PITCH, points)
    return sum(np.interp(place + shift, s, single, left=0.0, right=0.0) for shift in (0.0, BASE_PITCH))


def base_pitch_mean(single: Floats) -> float:
    """Mean of `over_base_pitch`: every pair passes once, so the integral of the single stiffness by the base pitch."""
    return float(np.trapezoid(single, path()) / BASE_PITCH)


# ---------------------------------------------------------------------- what the manual shows


ALL = ~AS_PRINTED
LISTINGS = {"tian": tian, "weber": weber}


def extent(single: Floats) -> dict[str, float]:
    """Return mean, greatest and smallest of the mesh stiffness over the path of contact (N/mm), as in table 4."""
    found = over_path(single)
    return {"mean": float(found.mean()), "max": float(found.max()), "min": float(found.min())}


def document() -> dict[str, dict[str, dict[str, float]]]:
    """Return the rows of both programs: as printed, each error set right by itself, and all of them over one base pitch."""
    fixes = {"as_printed": AS_PRINTED} | {str(fix.name).lower(): fix for fix in Correction}
    rows = {name: {key: extent(single(fix)) for key, fix in fixes.items()} for name, single in LISTINGS.items()}
    return {
        name: row | {"all_right_over_base_pitch": {"mean": base_pitch_mean(LISTINGS[name](ALL))}} for name, row in rows.items()
    }


if __name__ == "__main__":
    print(json.dumps(document(), indent=1))
