"""The structural check: finite element contact over a mesh cycle, its error, and comparisons with Hertz and ISO 6336."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.check.options import CheckOptions, Model
    from gearcad.check.plane.result import PlaneCheck
    from gearcad.check.result import CheckResult
    from gearcad.check.run import check_pair
    from gearcad.check.solid.result import SolidCheck
else:
    from gearcad.lazy import lazily

__all__ = ["CheckOptions", "CheckResult", "Model", "PlaneCheck", "SolidCheck", "check_pair"]

if not TYPE_CHECKING:
    __getattr__ = lazily(__name__, __all__, ("options", "result", "plane.result", "solid.result", "run"))
