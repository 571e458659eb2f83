"""A double helical pair, as one of its halves under half the torque; its load factors, with the bending of the whole pinion."""

from __future__ import annotations

from dataclasses import replace

from gearcad.geometry import GearPair
from gearcad.geometry.halves import halves
from gearcad.load import Load
from gearcad.material import Material
from gearcad.per_gear import PerGear
from gearcad.rating.load_factors import LoadFactors, helix_factors, shaft_deflection
from gearcad.rating.options import RatingOptions

__all__ = ["half_of", "load_factors_of_half"]


def half_of(pair: GearPair) -> GearPair:
    """The lower half: by which contact lines, overlap ratio and stresses go."""
    return replace(pair, pinion=halves(pair.pinion)[0].gear, wheel=halves(pair.wheel)[0].gear)


def load_factors_of_half(half: GearPair, materials: PerGear[Material], load: Load, options: RatingOptions) -> LoadFactors:
    """Those of a half under its half of the load: f_sh by (58) of ISO 6336-1, where it is not given.

    The pinion is taken to be in the middle between its bearings. Raises what `LoadFactors.of` raises.
    """
    found = LoadFactors.of(half, materials, load, options)
    mean_load = found.details.get("F_m_b")
    if options.shaft_deflection is not None or not isinstance(mean_load, float):
        return found
    deflection = shaft_deflection(
        mean_load,
        half.common_width.width,
        half.pinion.reference_diameter,
        shaft_term=0.0,
        compliance=helix_factors(options.helix_modification, options.standard).compliance,
        double_helical=True,
    )
    bent = LoadFactors.of(half, materials, load, replace(options, shaft_deflection=deflection))
    return replace(bent, assumed=found.assumed)
