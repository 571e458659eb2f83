"""Transverse load factors K_Halpha and K_Falpha by ISO 6336-1:2006, 8.3 (Method B). Numbers give a number, arrays broadcast."""

from __future__ import annotations

from gearcad.rating.factors.elementwise import Values, chosen, root
from gearcad.rating.load_factors.misalignment import larger

__all__ = ["flank_limit", "root_limit", "transverse_load_factor", "within"]


def transverse_load_factor(
    total_contact_ratio: Values, mesh_stiffness: Values, deviation: Values, allowance: Values, mean_load: Values
) -> Values:
    """K_Halpha = K_Falpha before their limits, (71) up to eps_gamma = 2 and (72) above.

    eps_gamma/2 (0.9 + 0.4 q) and 0.9 + 0.4 sqrt(2 (eps_gamma - 1)/eps_gamma) q, with q = c_gamma_alpha (f - y_alpha)/(F_tH/b):
    stiffness in N/(mm·µm), deviation and what runs in in µm, F_tH/b = F_t K_A K_gamma K_v K_Hbeta/b in N/mm.
    """
    e, q = total_contact_ratio, mesh_stiffness * (deviation - allowance) / mean_load
    return chosen(e <= 2, e / 2 * (0.9 + 0.4 * q), 0.9 + 0.4 * root(2 * (e - 1) / e) * q)


def flank_limit(total_contact_ratio: Values, transverse_contact_ratio: Values, contact_ratio_factor: Values) -> Values:
    """eps_gamma/(eps_alpha Z_eps^2): all of the load on one pair of teeth."""
    return total_contact_ratio / (transverse_contact_ratio * contact_ratio_factor**2)


def root_limit(total_contact_ratio: Values, transverse_contact_ratio: Values) -> Values:
    """eps_gamma/(0.25 eps_alpha + 0.75): the same of the root."""
    return total_contact_ratio / (0.25 * transverse_contact_ratio + 0.75)


def within(factor: Values, limit: Values) -> Values:
    """A factor, at most its limit, and never below 1."""
    return larger(chosen(factor < limit, factor, limit), 1.0)
