"""Factors of permissible stress, ISO 6336-2 and -3 and DIN 3990: pure functions of numbers, or of arrays of many variants."""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.rating.factors.families import Family
    from gearcad.rating.factors.film import (
        flank_roughness_factor,
        lubricant_factor,
        mesh_radius,
        relative_roughness,
        speed_factor,
    )
    from gearcad.rating.factors.life import (
        Points,
        cycles_at,
        flank_life_factor,
        flank_points,
        root_life_factor,
        root_points,
    )
    from gearcad.rating.factors.limited_life import transition
    from gearcad.rating.factors.mean_stress import mean_stress_factor, mean_stress_sensitivity
    from gearcad.rating.factors.notch import (
        cautious_strength,
        notch_sensitivity_factor,
        static_notch_sensitivity_factor,
        strength_range,
    )
    from gearcad.rating.factors.size import flank_size_factor, root_size_factor
    from gearcad.rating.factors.sources import citations, to_verify
    from gearcad.rating.factors.surface import root_surface_factor
    from gearcad.rating.factors.work_hardening import (
        equivalent_roughness,
        static_work_hardening_factor,
        through_hardened_factor,
        work_hardening_factor,
    )

__all__ = [
    "Family",
    "Points",
    "cautious_strength",
    "citations",
    "cycles_at",
    "equivalent_roughness",
    "flank_life_factor",
    "flank_points",
    "flank_roughness_factor",
    "flank_size_factor",
    "lubricant_factor",
    "mean_stress_factor",
    "mean_stress_sensitivity",
    "mesh_radius",
    "notch_sensitivity_factor",
    "relative_roughness",
    "root_life_factor",
    "root_points",
    "root_size_factor",
    "root_surface_factor",
    "speed_factor",
    "static_notch_sensitivity_factor",
    "static_work_hardening_factor",
    "strength_range",
    "through_hardened_factor",
    "to_verify",
    "transition",
    "work_hardening_factor",
]

if not TYPE_CHECKING:
    from gearcad.lazy import lazily

    __getattr__ = lazily(
        __name__,
        __all__,
        (
            "families",
            "film",
            "life",
            "limited_life",
            "mean_stress",
            "notch",
            "size",
            "sources",
            "surface",
            "work_hardening",
        ),
    )
