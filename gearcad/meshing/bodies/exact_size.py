"""How large sections and bodies of exact gears are, by quadrature along their curves: what meshes are held against."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise

from numpy.polynomial import Chebyshev
from numpy.polynomial.chebyshev import chebpts1
from numpy.polynomial.legendre import leggauss

from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve
from gearcad.geometry.turned import flank_curves, middle_section

__all__ = ["exact_area", "exact_volume"]

_DEGREE = 48
"""Of the polynomials that stand for a curve's radius and angle: they come within rounding of all of them."""

_PLACES, _WEIGHTS = leggauss(16)


def exact_area(gear: Gear, held_radius: float) -> float:
    """Area (mm²) of one tooth and its share of the body up to `held_radius` (mm), in the section at mid face width."""
    return _body(gear, middle_section(gear), held_radius)


def exact_volume(gear: Gear, held_radius: float) -> float:
    """Volume (mm³) of the same over the face width, flanks modified as they are."""
    plain = _body(gear, gear.profile.curves, held_radius) * gear.face_width
    if not gear.modification.present:
        return plain
    taken = sum(_taken(gear, left=left) for left in (True, False))
    return plain - (2 * taken if gear.double_helix.present else taken)


def _body(gear: Gear, curves: Iterable[Curve], held_radius: float) -> float:
    """Area (mm²) between the curves of half a tooth, twice, and the circle where the body ends."""
    between = _area(curves) - math.pi / gear.tooth_count * held_radius**2
    return -between if gear.internal else between


def _area(curves: Iterable[Curve]) -> float:
    """Area (mm²) from the curves of half a tooth, twice, down to the centre."""
    area = 0.0
    for curve in curves:
        radius, angle = _polar(curve)
        swept = (radius**2 * angle.deriv()).integ()
        area += float(swept(0.0) - swept(1.0))  # angles fall from the middle of the space to that of the tooth
    return area


def _polar(curve: Curve) -> tuple[Chebyshev, Chebyshev]:
    """Radius (mm) and half tooth angle (rad) along a curve."""
    places = (1 + chebpts1(_DEGREE + 1)) / 2
    radius, angle = (Chebyshev.fit(places, values, _DEGREE, domain=[0, 1]) for values in curve.polar(places))
    return radius, angle


def _taken(gear: Gear, *, left: bool) -> float:
    """Volume (mm³) that modifications take from one side of a tooth, of one half: each point goes its turn times its radius."""
    form, taken = gear.flank_form, 0.0
    sense = (-1 if left else 1) * (-1 if gear.internal else 1)  # radii of a ring fall along its curves
    for low, high in pairwise(sorted((0.0, *form.height_breaks, gear.half_width / 2, gear.half_width))):
        z = (low + high) / 2 + (high - low) / 2 * _PLACES
        for piece in flank_curves(gear):
            radius, _ = _polar(piece.curve)
            s = (1 + _PLACES) / 2
            moved = sense * piece.turn(form, s[:, None], z[None], left=left)
            lever = radius(s) * radius.deriv()(s) * _WEIGHTS / 2
            taken += float(lever @ moved @ _WEIGHTS) * (high - low) / 2
    return taken
