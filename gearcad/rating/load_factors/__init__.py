"""Load factors of ISO 6336-1 and DIN 3990-1: LoadFactors of a pair, and pure functions of numbers or arrays behind them.

K_v of Method B is in `gearcad.rating.resonance`, K_Hbeta of a misalignment in `gearcad.rating.face_load`.
"""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.rating.load_factors.below_resonance import dynamic_factor_c, speed_measure
    from gearcad.rating.load_factors.load_factors import BodyLoad, LoadFactors
    from gearcad.rating.load_factors.masses import body_mass, mass_of, pair_mass
    from gearcad.rating.load_factors.misalignment import (
        UNLOADED_ENDS,
        HelixFactors,
        arrangement_factor,
        helix_factors,
        initial_misalignment,
        least_misalignment,
        manufacturing_misalignment,
        proven_misalignment,
        shaft_deflection,
        shaft_term,
    )
    from gearcad.rating.load_factors.transverse import flank_limit, root_limit, transverse_load_factor, within

__all__ = [
    "UNLOADED_ENDS",
    "BodyLoad",
    "HelixFactors",
    "LoadFactors",
    "arrangement_factor",
    "body_mass",
    "dynamic_factor_c",
    "flank_limit",
    "helix_factors",
    "initial_misalignment",
    "least_misalignment",
    "manufacturing_misalignment",
    "mass_of",
    "pair_mass",
    "proven_misalignment",
    "root_limit",
    "shaft_deflection",
    "shaft_term",
    "speed_measure",
    "transverse_load_factor",
    "within",
]

if not TYPE_CHECKING:
    from gearcad.lazy import lazily

    __getattr__ = lazily(
        __name__,
        __all__,
        (
            "below_resonance",
            "load_factors",
            "masses",
            "misalignment",
            "transverse",
        ),
    )
