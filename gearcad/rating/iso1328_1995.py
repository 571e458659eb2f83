"""ISO 1328-1:1995 and ISO 1328-2:1997: tolerances of accuracy grade 5 in µm, before they are rounded.

They go by the geometric means of the ranges that the sizes (mm) lie in. Numbers or arrays.
"""

from __future__ import annotations

from gearcad.core.values import Values, root
from gearcad.rating.editions import mean_of_range

_DIAMETERS = (5, 20, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6000, 8000, 10000)
_MODULES = (0.5, 2, 3.5, 6, 10, 16, 25, 40, 70)
_WIDTHS = (4, 10, 20, 40, 80, 160, 250, 400, 650, 1000)
_RADIAL_DIAMETERS = (5, 20, 50, 125, 280, 560, 1000)
_RADIAL_MODULES = (0.2, 0.5, 0.8, 1, 1.5, 2.5, 4, 6, 10)
"""Ranges of modules of radial composite deviations; larger gears use their own sizes."""


def single_pitch(d: Values, m_n: Values) -> Values:
    """f_pt = 0.3 (m + 0.4 √d) + 4."""
    return 0.3 * (_module(m_n) + 0.4 * _root_of_diameter(d)) + 4


def sector_pitch(d: Values, m_n: Values, k: Values, _teeth: Values) -> Values:
    """F_pk = f_pt + 1.6 √((k - 1) m) over k pitches."""
    return single_pitch(d, m_n) + 1.6 * root((k - 1) * _module(m_n))


def cumulative_pitch(d: Values, m_n: Values) -> Values:
    """F_p = 0.3 m + 1.25 √d + 7."""
    return 0.3 * _module(m_n) + 1.25 * _root_of_diameter(d) + 7


def profile_slope(d: Values, m_n: Values) -> Values:
    """f_Halpha = 2 √m + 0.14 √d + 0.5."""
    return 2 * root(_module(m_n)) + 0.14 * _root_of_diameter(d) + 0.5


def profile_form(d: Values, m_n: Values) -> Values:
    """f_falpha = 2.5 √m + 0.17 √d + 0.5."""
    return 2.5 * root(_module(m_n)) + 0.17 * _root_of_diameter(d) + 0.5


def profile_total(d: Values, m_n: Values) -> Values:
    """F_alpha = 3.2 √m + 0.22 √d + 0.7."""
    return 3.2 * root(_module(m_n)) + 0.22 * _root_of_diameter(d) + 0.7


def helix_slope(d: Values, b: Values) -> Values:
    """f_Hbeta = 0.07 √d + 0.45 √b + 3."""
    return 0.07 * _root_of_diameter(d) + 0.45 * _root_of_width(b) + 3


def helix_form(d: Values, b: Values) -> Values:
    """f_fbeta, which is f_Hbeta."""
    return helix_slope(d, b)


def helix_total(d: Values, b: Values) -> Values:
    """F_beta = 0.1 √d + 0.63 √b + 4.2."""
    return 0.1 * _root_of_diameter(d) + 0.63 * _root_of_width(b) + 4.2


def runout(d: Values, m_n: Values) -> Values:
    """F_r = 0.24 m + √d + 5.6 (part 2, annex B)."""
    return 0.24 * _module(m_n) + _root_of_diameter(d) + 5.6


def radial_composite(d: Values, m_n: Values) -> Values:
    """F_i'' = 3.2 m + 1.01 √d + 6.4 (part 2, annex A)."""
    m, diameter = _radial(d, m_n)
    return 3.2 * m + 1.01 * root(diameter) + 6.4


def radial_tooth_to_tooth(d: Values, m_n: Values) -> Values:
    """f_i'' = 2.96 m + 0.01 √d + 0.8 (part 2, annex A)."""
    m, diameter = _radial(d, m_n)
    return 2.96 * m + 0.01 * root(diameter) + 0.8


def _module(m_n: Values) -> Values:
    return mean_of_range(m_n, _MODULES)


def _root_of_diameter(d: Values) -> Values:
    return root(mean_of_range(d, _DIAMETERS))


def _root_of_width(b: Values) -> Values:
    return root(mean_of_range(b, _WIDTHS))


def _radial(d: Values, m_n: Values) -> tuple[Values, Values]:
    return mean_of_range(m_n, _RADIAL_MODULES), mean_of_range(d, _RADIAL_DIAMETERS)
