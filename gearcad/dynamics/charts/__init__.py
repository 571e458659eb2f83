"""Loads over speed: every maximum between the speeds, overload beside the standard."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.dynamics.charts.chart import ForceDefinition, KvChart
    from gearcad.dynamics.charts.kv import kv_chart
    from gearcad.dynamics.charts.over_speed import OverSpeed
else:
    from gearcad.lazy import lazily

__all__ = [
    "ForceDefinition",
    "KvChart",
    "OverSpeed",
    "kv_chart",
]

if not TYPE_CHECKING:
    __getattr__ = lazily(__name__, __all__, ("chart", "kv", "over_speed"))
