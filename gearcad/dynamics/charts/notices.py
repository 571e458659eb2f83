"""What to know before trusting a chart over speed."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.charts.resonances import LEAST_RATIO
from gearcad.dynamics.charts.speed_curves import HIGHEST_SOUGHT, LEFT_OUT, SpeedCurves, Told
from gearcad.dynamics.response.notices import frequency_ranges
from gearcad.errors import SolverError
from gearcad.notice import Notice

__all__ = ["fixed_harmonics", "hardly_damped", "left_out", "not_looked_for", "standstill", "stuck"]


def left_out(curves: SpeedCurves, told: Told) -> tuple[Notice, ...]:
    """Where there are fewer harmonics than a hundredth asks for."""
    short = told.left_out > LEFT_OUT
    if not short.any():
        return ()
    most = curves.most_orders // max(curves.excitation.orders)
    text = (
        f"more than {most} harmonics of the tooth frequency would be needed at tooth frequencies (1/s) "
        f"{frequency_ranges(told.frequencies, short)}: what is left out may be more than 1 % of the load"
    )
    return (Notice("harmonics-left-out", text),)


def standstill(curves: SpeedCurves) -> tuple[Notice, ...]:
    """Where loads do not come down to those at rest, however slowly gears turn."""
    factor = curves.standstill
    if factor < 1 + LEFT_OUT:
        return ()
    text = (
        f"the stiffness of a mesh jumps where teeth come into mesh, at any speed at once: towards standstill K_v tends to "
        f"{factor:.3f}, not to 1"
    )
    return (Notice("stiffness-jumps", text),)


def not_looked_for(frequencies: Floats) -> tuple[Notice, ...]:
    """Low speeds, between which there is one resonance after the other."""
    if not len(frequencies):
        return ()
    text = (
        f"up to a tooth frequency of {frequencies[-1]:.5g} 1/s resonances between the speeds are not looked for: they are met "
        f"there by harmonics beyond the {HIGHEST_SOUGHT}th"
    )
    return (Notice("low-resonances", text),)


def hardly_damped(curves: SpeedCurves, frequencies: Floats) -> tuple[Notice, ...]:
    """Resonances that are narrower than is looked for."""
    sharp = curves.sharp(frequencies)
    if not len(sharp):
        return ()
    text = (
        f"natural frequencies of {', '.join(f'{each:.5g}' for each in sharp / (2 * np.pi))} Hz have a damping ratio below "
        f"{LEAST_RATIO:g}: their resonances are higher than shown, and a chart may pass them by"
    )
    return (Notice("hardly-damped", text),)


def stuck(reason: SolverError) -> Notice:
    """That no motion was found in which flanks part."""
    return Notice("flanks-stuck", f"flanks are taken to stick to each other, for want of a motion in which they part: {reason}")


def fixed_harmonics(period: int, harmonics: int) -> Notice:
    """That all comes again too late to have all its orders."""
    text = (
        f"the teeth of all meshes come again after {period} teeth only: K_v holds {harmonics} harmonics of the "
        "tooth frequencies, and what is left out, and resonances between the speeds, are not looked for"
    )
    return Notice("long-period", text)
