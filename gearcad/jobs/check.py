"""Assess: the structural check of a pair, or of what a spec describes."""

from __future__ import annotations

from typing import Unpack

from gearcad.check.result import CheckResult
from gearcad.check.run import check_pair, expected_check
from gearcad.designs import Design, Inputs, PairDesign, as_design
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.progress import Expected, Progress

__all__ = ["NO_MATE", "assess", "expected_assessment"]

NO_MATE = "a single gear has nothing to press against"


def assess(
    subject: Design | GearPair, load: Load | None = None, *, progress: Progress | None = None, **inputs: Unpack[Inputs]
) -> CheckResult:
    """Check a pair as mounted, under a load, with the options of `check`.

    `material`, `mounting`, `check` and `rating`, as the load, stand in place of those of a design; a pair has the defaults.

    >>> from gearcad import Gear, GearPair, Load
    >>> from gearcad.check import CheckOptions
    >>> gears = [Gear(teeth=z, normal_module=2, face_width=20, tooth_thinning=0.03) for z in (20, 30)]
    >>> quick = CheckOptions(positions=12, refinement=0.5, convergence="off", body_teeth=3, torques=[20])
    >>> result = assess(GearPair(pinion=gears[0], wheel=gears[1]), Load(torque=20), check=quick)
    >>> f"{result.rating.to_dict()['p_0']:.0f} MPa by Hertz, {result.summary.contact_pressure_pitch_point:.0f} MPa here"
    '683 MPa by Hertz, 683 MPa here'

    Raises ParameterError for a design without pair or load, and what `check_pair` raises.
    """
    design, given = _loaded(as_design(subject, load, **inputs))
    from threadpoolctl import threadpool_limits

    # The dense systems are small, and solid bodies are solved side by side: more threads cost more than they bring.
    with threadpool_limits(1):
        material = design.material or Material()
        return check_pair(design.pair, material, given, design.check, progress, design.mounting, design.rating)


def expected_assessment(design: Design) -> Expected:
    """What `assess` is expected to take. Raises what it raises for a design that cannot be checked."""
    of, load = _loaded(design)
    return expected_check(of.pair, of.material or Material(), load, of.check, of.mounting, of.rating)


def _loaded(design: Design) -> tuple[PairDesign, Load]:
    pair = design.accepted(PairDesign, why=NO_MATE)
    return pair, pair.loaded("without it there is no stress")
