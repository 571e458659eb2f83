"""Full rating of a pair by ISO 6336 or DIN 3990: what it bears, how safely, for how long, up to which torque."""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.rating.strength.part import INFINITE, Part, PartStrength
    from gearcad.rating.strength.rating import StrengthRating
    from gearcad.rating.strength.run import rate_strength

__all__ = ["INFINITE", "Part", "PartStrength", "StrengthRating", "rate_strength"]

if not TYPE_CHECKING:
    from gearcad.lazy import lazily

    __getattr__ = lazily(
        __name__,
        __all__,
        (
            "part",
            "rating",
            "run",
        ),
    )
