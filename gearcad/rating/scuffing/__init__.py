"""Scuffing of two gears: integral temperature (ISO/TR 13989-2:2000) and flash temperature (ISO/TR 13989-1:2000)."""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.rating.scuffing.flash import FlashPath, FlashTemperature
    from gearcad.rating.scuffing.integral import IntegralTemperature
    from gearcad.rating.scuffing.limits import ScuffingLimits
    from gearcad.rating.scuffing.oil import Oil
    from gearcad.rating.scuffing.result import Scuffing
    from gearcad.rating.scuffing.risk import Risk
    from gearcad.rating.scuffing.scuffing import scuffing
    from gearcad.rating.scuffing.sliding import SlidingMesh

__all__ = [
    "FlashPath",
    "FlashTemperature",
    "IntegralTemperature",
    "Oil",
    "Risk",
    "Scuffing",
    "ScuffingLimits",
    "SlidingMesh",
    "scuffing",
]

if not TYPE_CHECKING:
    import sys

    from gearcad.lazy import NamesFirst, lazily

    __getattr__ = lazily(
        __name__,
        __all__,
        (
            "flash",
            "integral",
            "limits",
            "oil",
            "result",
            "risk",
            "scuffing",
            "sliding",
        ),
    )
    sys.modules[__name__].__class__ = NamesFirst
