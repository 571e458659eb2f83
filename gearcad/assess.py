"""Assess: the structural check of what a spec describes."""

from __future__ import annotations

from gearcad.check.result import CheckResult
from gearcad.check.run import check_pair, expected_check
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.progress import Expected, Progress
from gearcad.spec.design import Design

__all__ = ["assess", "expected_assessment"]


def assess(design: Design, progress: Progress | None = None) -> CheckResult:
    """Check the design's pair as mounted, under its load, with the options of its [check].

    Raises ParameterError for a design without pair or load, and what `check_pair` raises.
    """
    pair, load = _loaded(design)
    from threadpoolctl import threadpool_limits

    # The dense systems are small, and solid bodies are solved side by side: more threads cost more than they bring.
    with threadpool_limits(1):
        material = design.material or Material()
        return check_pair(pair, material, load, design.check, progress, design.mounting, design.rating)


def expected_assessment(design: Design) -> Expected:
    """What `assess` is expected to take. Raises what it raises for a design that cannot be checked."""
    pair, load = _loaded(design)
    return expected_check(pair, design.material or Material(), load, design.check, design.mounting, design.rating)


def _loaded(design: Design) -> tuple[GearPair, Load]:
    return design.loaded_pair("nothing to press against", "without it there is no stress")
