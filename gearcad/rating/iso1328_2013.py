"""ISO 1328-1:2013: flank tolerances of class 5 in µm, before they are rounded, of sizes in mm. Numbers or arrays."""

from __future__ import annotations

from gearcad.core.values import Values, root


def single_pitch(d: Values, m_n: Values) -> Values:
    """f_pT = 0.001 d + 0.4 m_n + 5."""
    return 0.001 * d + 0.4 * m_n + 5


def sector_pitch(d: Values, m_n: Values, k: Values, teeth: Values) -> Values:
    """F_pkT = f_pT + (4 k/z) (0.001 d + 0.55 √d + 0.3 m_n + 7) over k pitches: F_pT over a quarter of the teeth."""
    return single_pitch(d, m_n) + 4 * k / teeth * (0.001 * d + 0.55 * root(d) + 0.3 * m_n + 7)


def cumulative_pitch(d: Values, m_n: Values) -> Values:
    """F_pT = 0.002 d + 0.55 √d + 0.7 m_n + 12."""
    return 0.002 * d + 0.55 * root(d) + 0.7 * m_n + 12


def profile_slope(d: Values, m_n: Values) -> Values:
    """f_HalphaT = 0.4 m_n + 0.001 d + 4."""
    return 0.4 * m_n + 0.001 * d + 4


def profile_form(_d: Values, m_n: Values) -> Values:
    """f_falphaT = 0.55 m_n + 5, whatever the diameter."""
    return 0.55 * m_n + 5


def profile_total(d: Values, m_n: Values) -> Values:
    """F_alphaT = √(f_HalphaT² + f_falphaT²), of those not rounded."""
    return _together(profile_slope(d, m_n), profile_form(d, m_n))


def helix_slope(d: Values, b: Values) -> Values:
    """f_HbetaT = 0.05 √d + 0.35 √b + 4."""
    return 0.05 * root(d) + 0.35 * root(b) + 4


def helix_form(d: Values, b: Values) -> Values:
    """f_fbetaT = 0.07 √d + 0.45 √b + 4."""
    return 0.07 * root(d) + 0.45 * root(b) + 4


def helix_total(d: Values, b: Values) -> Values:
    """F_betaT = √(f_HbetaT² + f_fbetaT²), of those not rounded."""
    return _together(helix_slope(d, b), helix_form(d, b))


def runout(d: Values, m_n: Values) -> Values:
    """F_rT = 0.9 F_pT (annex)."""
    return 0.9 * cumulative_pitch(d, m_n)


def _together(slope: Values, form: Values) -> Values:
    return root(slope * slope + form * form)
