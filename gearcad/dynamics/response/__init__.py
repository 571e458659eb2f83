"""The steady vibration at a speed: harmonic balance, flanks that part, stability."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.dynamics.response.branch import Branch, sweep, trace
    from gearcad.dynamics.response.direction import Direction
    from gearcad.dynamics.response.floquet import growth
    from gearcad.dynamics.response.linear import periodic_response
    from gearcad.dynamics.response.periodic import PeriodicResponse
else:
    from gearcad.lazy import lazily

__all__ = [
    "Branch",
    "Direction",
    "PeriodicResponse",
    "growth",
    "periodic_response",
    "sweep",
    "trace",
]

if not TYPE_CHECKING:
    __getattr__ = lazily(__name__, __all__, ("direction", "periodic", "linear", "branch", "floquet"))
