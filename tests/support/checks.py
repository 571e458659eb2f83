"""A check to draw and to report: a true mesh cycle of few positions, and a sweep and a convergence that are made up."""

from __future__ import annotations

from functools import lru_cache

from gearcad import Body, Gear, GearPair, Load, Material, Mounting
from gearcad.check.convergence import Convergence
from gearcad.check.judge import compare
from gearcad.check.options import CheckOptions
from gearcad.check.run import CheckResult, SweepPoint
from gearcad.check.summary import summarise
from gearcad.fea.cycle import run_cycle, single_stiffness
from gearcad.fea.flexible_pair import flexible_pair
from gearcad.rating import rate

__all__ = ["NASTY_NAME", "small_check"]

NASTY_NAME = "<script>alert('gear')</script> & \"$x_1$\""
"""A name that would break HTML, and mathtext."""

_POSITIONS = 16


@lru_cache
def small_check() -> CheckResult:
    """FZG's C gears with unequal widths and a limit for contact that they exceed."""
    pinion, wheel = (
        Gear(teeth=teeth, normal_module=4.5, profile_shift=shift, face_width=width, body=Body(bore=30))
        for teeth, shift, width in ((16, 0.1817, 16.0), (24, 0.1715, 14.0))
    )
    pair = GearPair(pinion=pinion, wheel=wheel)
    material, load = Material(name=NASTY_NAME, contact_limit=1500.0, root_limit=(430.0, 500.0)), Load(torque=302.0)
    options = CheckOptions(positions=_POSITIONS)
    model = flexible_pair(pair, material)
    cycle = run_cycle(model, load.torque, _POSITIONS)
    summary, rating = summarise(cycle, single_stiffness(model, load.torque, 5)), rate(pair, material, load)
    convergence = (
        Convergence("mean mesh stiffness", (15.4, 15.3, 15.2), (0.5, 1.0, 2.0), None, 0.008),
        Convergence("root tension, pinion", (380.0, 374.0, 372.0), (0.5, 1.0, 2.0), 1.58, 0.0081),
        Convergence("root tension, wheel", (360.0, 357.0, 356.0), (0.5, 1.0, 2.0), 1.58, 0.0042),
    )
    sweep = (
        SweepPoint(302.0, 15.2, 1700.0, (370.0, 350.0), (5.6e5, 9.8e5)),
        SweepPoint(75.5, 14.5, 850.0, (92.5, 87.5), (5.2e5, 9.2e5)),
    )
    return CheckResult(
        pair=pair,
        material=material,
        load=load,
        mounting=Mounting(),
        options=options,
        cycle=cycle,
        summary=summary,
        sweep=sweep,
        convergence=convergence,
        rating=rating,
        comparisons=compare(cycle, summary, convergence, rating, material, options),
        warnings=("a warning with <b>tags</b>",),
    )
