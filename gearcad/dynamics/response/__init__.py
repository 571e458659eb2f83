"""The steady vibration at a speed: harmonic balance, flanks that part, stability; and vibration in time, its witness."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.dynamics.response.branch import Branch, sweep, trace
    from gearcad.dynamics.response.direction import Direction
    from gearcad.dynamics.response.floquet import floquet_multipliers, growth, monodromy
    from gearcad.dynamics.response.linear import periodic_response
    from gearcad.dynamics.response.periodic import PeriodicResponse
    from gearcad.dynamics.response.transient import Transient, integrate
else:
    from gearcad.lazy import lazily

__all__ = [
    "Branch",
    "Direction",
    "PeriodicResponse",
    "Transient",
    "floquet_multipliers",
    "growth",
    "integrate",
    "monodromy",
    "periodic_response",
    "sweep",
    "trace",
]

if not TYPE_CHECKING:
    __getattr__ = lazily(__name__, __all__, ("direction", "periodic", "linear", "branch", "floquet", "transient"))
