"""Assess: the structural check of what a spec describes."""

from __future__ import annotations

from gearcad.check.result import CheckResult
from gearcad.check.run import Progress, check_pair
from gearcad.material import Material
from gearcad.spec.design import Design

__all__ = ["assess"]


def assess(design: Design, progress: Progress | None = None) -> CheckResult:
    """Check the design's pair as mounted, under its load, with the options of its [check].

    Raises ParameterError for a design without pair or load, and what `check_pair` raises.
    """
    pair, load = design.loaded_pair("nothing to press against", "without it there is no stress")
    from threadpoolctl import threadpool_limits

    # The dense systems are small, and solid bodies are solved side by side: more threads cost more than they bring.
    with threadpool_limits(1):
        material = design.material or Material()
        return check_pair(pair, material, load, design.check, progress, design.mounting, design.rating)
