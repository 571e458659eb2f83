"""What standards permit flanks to be off by. Deviations in µm, lengths in mm."""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.rating.tolerances.editions import Accuracy, grades
    from gearcad.rating.tolerances.gear_tolerances import GearTolerances, gear_tolerances
    from gearcad.rating.tolerances.iso1328 import FlankTolerances, flank_tolerances

__all__ = ["Accuracy", "FlankTolerances", "GearTolerances", "flank_tolerances", "gear_tolerances", "grades"]

if not TYPE_CHECKING:
    import sys

    from gearcad.lazy import NamesFirst, lazily

    __getattr__ = lazily(
        __name__,
        __all__,
        (
            "editions",
            "gear_tolerances",
            "iso1328",
        ),
    )
    sys.modules[__name__].__class__ = NamesFirst
