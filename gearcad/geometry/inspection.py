"""Measuring a gear: base tangent length, dimension over balls and pins, chordal thickness (ISO 21771).

All lengths in mm. Tooth thinning is included: these are the dimensions of the gear as cut.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from gearcad.errors import GeometryError, require_number, require_whole
from gearcad.geometry.involute import inverse_involute, involute

if TYPE_CHECKING:
    from gearcad.geometry.gear import Gear

__all__ = [
    "ball_contact_diameter",
    "chordal_thickness",
    "over_balls",
    "over_pins",
    "pin_axial_shift",
    "span_contact_diameter",
    "span_measurement",
    "span_teeth",
    "suggested_ball_diameter",
]


_FARTHEST_CENTRE = math.radians(75)
"""Largest pressure angle at the centre of a suggested ball: there its dimension is 3.9 times the base circle."""


def _normal_base_pitch(gear: Gear) -> float:
    return math.pi * gear.normal_module * math.cos(math.radians(gear.rack.pressure_angle))


def _middle_diameter(gear: Gear) -> float:
    """d_v = d + 2 x m_n, kept on the involute: where a gauge had best touch."""
    middle = gear.reference_diameter + 2 * gear.profile_shift * gear.normal_module
    return min(max(middle, gear.form_diameter), gear.tip_form_diameter)


def span_measurement(gear: Gear, teeth: int) -> float:
    """Base tangent length over `teeth` teeth: W_k = (k - 1) p_bn + s_bn (ISO 21771).

    s_bn = cos alpha_n (s_n + z m_n inv alpha_t). Raises ParameterError unless 1 <= k <= z.
    """
    require_whole("span_teeth", teeth, at_least=1, at_most=gear.teeth)
    cosine = math.cos(math.radians(gear.rack.pressure_angle))
    across = gear.normal_tooth_thickness + gear.teeth * gear.normal_module * involute(gear.transverse_pressure_angle)
    return (teeth - 1) * _normal_base_pitch(gear) + cosine * across


def span_contact_diameter(gear: Gear, teeth: int) -> float:
    """Diameter on which the anvils touch: d_y^2 = d_b^2 + (W_k cos beta_b)^2, the anvils placed symmetrically."""
    reach = span_measurement(gear, teeth) * math.cos(math.radians(gear.base_helix_angle))
    return math.hypot(gear.base_diameter, reach)


def span_teeth(gear: Gear) -> int:
    """Number of teeth whose anvils touch nearest to d + 2 x m_n."""
    middle = _middle_diameter(gear)
    wanted = math.sqrt(max(middle**2 - gear.base_diameter**2, 0)) / math.cos(math.radians(gear.base_helix_angle))
    count = 1 + round((wanted - span_measurement(gear, 1)) / _normal_base_pitch(gear))
    return min(max(count, 1), gear.teeth)


def _ball_circle(gear: Gear, ball: float) -> float:
    """Diameter d_K on which the ball's centre lies: inv alpha_Kt = inv alpha_t + D/(d_b cos beta_b) - space half angle."""
    require_number("ball_diameter", ball, "mm", above=0)
    half_space = math.pi / gear.teeth - gear.normal_tooth_thickness / (gear.normal_module * gear.teeth)
    reach = ball / (gear.base_diameter * math.cos(math.radians(gear.base_helix_angle)))
    value = involute(gear.transverse_pressure_angle) + reach - half_space
    if value <= 0:
        raise GeometryError("ball_diameter", ball, "must be larger: the ball falls to the base circle", "mm")
    return gear.base_diameter / math.cos(math.radians(inverse_involute(value)))


def suggested_ball_diameter(gear: Gear) -> float:
    """Diameter of the ball that touches the flanks at d + 2 x m_n, rounded up to two significant digits.

    The normal through the ball's centre is tangent to the base cylinder: with the space half angle eta_y at the touching
    point, alpha_K = alpha_y + eta_y - tan^2 beta_b (tan alpha_K - tan alpha_y), D = d_b (tan alpha_K - tan alpha_y)/cos beta_b.
    In the wide spaces of very few teeth these normals meet far out or never; the ball is then made to touch lower, perhaps
    off the involute (see `ball_contact_diameter`).
    """
    touching = math.acos(min(gear.base_diameter / _middle_diameter(gear), 1.0))
    space_at_base = math.pi / gear.teeth - math.radians(gear.profile.base_half_angle)
    farthest = max(_FARTHEST_CENTRE, (touching + math.pi / 2) / 2)
    touching = min(touching, math.atan(farthest - space_at_base))
    space = space_at_base + math.tan(touching) - touching
    base_helix = math.radians(gear.base_helix_angle)
    low, high = touching, min(touching + space, math.pi / 2 - 1e-9)
    for _ in range(60):  # the left side less the right grows steadily with alpha_K
        centre = (low + high) / 2
        if centre - touching - space + math.tan(base_helix) ** 2 * (math.tan(centre) - math.tan(touching)) < 0:
            low = centre
        else:
            high = centre
    ideal = gear.base_diameter * (math.tan(centre) - math.tan(touching)) / math.cos(base_helix)
    step = 10.0 ** (math.floor(math.log10(ideal)) - 1)
    return round(math.ceil(ideal / step) * step, 9)


def ball_contact_diameter(gear: Gear, ball: float) -> float:
    """Diameter on which a ball of diameter `ball` touches the flanks: tan alpha_y = tan alpha_K - D cos beta_b/d_b.

    The base circle for a ball so large that it would have to touch beyond it.
    """
    centre = math.acos(gear.base_diameter / _ball_circle(gear, ball))
    tangent = math.tan(centre) - ball * math.cos(math.radians(gear.base_helix_angle)) / gear.base_diameter
    return gear.base_diameter * math.hypot(1.0, max(tangent, 0.0))


def over_balls(gear: Gear, ball: float) -> float:
    """Dimension over two balls of diameter `ball` in opposite spaces, both centres in one transverse plane.

    M = d_K + D for an even number of teeth, d_K cos(pi/(2 z)) + D for an odd one. Raises GeometryError for a ball so
    small that it drops to the base circle.
    """
    circle = _ball_circle(gear, ball)
    return circle * (math.cos(math.pi / (2 * gear.teeth)) if gear.teeth % 2 else 1.0) + ball


def over_pins(gear: Gear, pin: float) -> float:
    """Dimension over two pins of diameter `pin` between parallel planes.

    As over balls, but on a helical gear with an odd number of teeth the pins roll along their spaces until they lie
    diametrically opposite, `pin_axial_shift` apart along the axis: M = d_K + D there.
    """
    if gear.helix_angle and gear.teeth % 2:
        return _ball_circle(gear, pin) + pin
    return over_balls(gear, pin)


def pin_axial_shift(gear: Gear) -> float:
    """How far apart along the axis two pins lie that are measured over (mm): half an axial pitch if z is odd, else 0."""
    if not gear.helix_angle or gear.teeth % 2 == 0:
        return 0.0
    return gear.lead / gear.teeth / 2


def chordal_thickness(gear: Gear) -> tuple[float, float]:
    """Chordal thickness and chordal height (mm) on the reference circle, in the normal section.

    Taken on the virtual gear of z_v = z/cos^3 beta teeth: s = z_v m_n sin(psi), h = h_a + z_v m_n (1 - cos psi)/2, with
    psi = s_n/(m_n z_v). The height is measured from the actual tip circle.
    """
    virtual = gear.teeth / math.cos(math.radians(gear.helix_angle)) ** 3
    half = gear.normal_tooth_thickness / (gear.normal_module * virtual)
    addendum = (gear.tip_diameter - gear.reference_diameter) / 2
    diameter = virtual * gear.normal_module
    return diameter * math.sin(half), addendum + diameter * (1 - math.cos(half)) / 2
