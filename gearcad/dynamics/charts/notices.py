"""What to know before trusting a chart over speed."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.dynamics.charts.resonances import LEAST_RATIO
from gearcad.dynamics.charts.speed_curves import HIGHEST_SOUGHT, LEFT_OUT, SpeedCurves, Told
from gearcad.dynamics.response.notices import frequency_ranges
from gearcad.notice import Notice

__all__ = ["fixed_harmonics", "hardly_damped", "in_time", "left_out", "no_value", "not_looked_for", "standstill"]


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


def in_time(frequencies: Floats, marked: Bools) -> tuple[Notice, ...]:
    """Where loads are those of motions that were integrated in time."""
    if not marked.any():
        return ()
    text = (
        f"flanks part at tooth frequencies (1/s) {frequency_ranges(frequencies, marked)}: the loads there are integrated in "
        "time, running up slowly from standstill and down from the last speed"
    )
    return (Notice("integrated-in-time", text),)


def no_value(frequencies: Floats, marked: Bools, reason: str) -> Notice:
    """Where no loads are given, and why."""
    places = frequencies[marked]
    text = (
        f"no loads at {len(places)} speeds between tooth frequencies of {places[0]:g} and {places[-1]:g} 1/s, where flanks "
        f"would part: {reason}; more damping"
        ' (damping_ratio), fewer speeds, or [dynamics.transient] or campbell = "on", which integrate in time, give some'
    )
    return Notice("no-value", text)


def fixed_harmonics(period: int, harmonics: int) -> Notice:
    """That all comes again too late to have all its orders."""
    text = (
        f"the teeth of all meshes come again after {period} teeth only: K_v holds {harmonics} harmonics of the "
        "tooth frequencies, and what is left out, and resonances between the speeds, are not looked for"
    )
    return Notice("long-period", text)
