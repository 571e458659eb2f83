"""Pictures of what a check varies: the torque, and the size of the elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.check.result import CheckResult
from gearcad.plots.paper import DARK, GEARS, MARKED, PALE, SERIES, legend_above, prepared, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["plot_convergence", "plot_sweep_pressure", "plot_sweep_stiffness"]


_TORQUE = "torque on the pinion in N·m"
_MARKERS = ("o", "s", "^")


def plot_sweep_pressure(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Greatest contact pressure over torque, beside the square root that Hertz has for a load shared in the same way."""
    axes = prepared(ax, _TORQUE, "peak pressure in MPa")
    torques, pressures = _swept(result, "contact_pressure")
    fine = np.linspace(0, torques[-1], 100)
    words = "as the square root of the torque"
    axes.plot(fine, pressures[-1] * np.sqrt(fine / torques[-1]), color=PALE, linewidth=3.5, label=words)
    axes.plot(torques, pressures, "o", color=SERIES[0], label="finite elements")
    axes.set_ylim(bottom=0)
    axes.set_xlim(left=0)
    legend_above(axes, 2)
    return axes


def plot_sweep_stiffness(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Mean mesh stiffness and M/phi of each gear over torque, as parts of their values at the greatest torque."""
    axes = prepared(ax, _TORQUE, "part of the value at full torque in %")
    torques, stiffness = _swept(result, "mesh_stiffness")
    axes.plot(torques, 100 * stiffness / stiffness[-1], "^-", color=DARK, label=f"mesh: {short(stiffness[-1])} N/(mm µm)")
    _, turning = _swept(result, "torsional_stiffness")
    for (gear, colour, marker), values in zip(GEARS, turning.T, strict=True):
        words = rf"$M/\varphi$, {gear}: {short(values[-1])} N·m/rad"
        axes.plot(torques, 100 * values / values[-1], marker=marker, linestyle="--", color=colour, label=words)
    axes.axhline(100, color=MARKED, linewidth=0.8)
    axes.set_xlim(left=0)
    legend_above(axes, 2)
    return axes


def plot_convergence(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Difference of each quantity from its value on the finest mesh, over the refinement of the mesh."""
    axes = prepared(ax, "refinement of the mesh (1: the check itself)", "difference from the finest mesh in %")
    for each, colour, marker in zip(result.convergence, SERIES, _MARKERS, strict=False):
        difference = 100 * (np.array(each.values) / each.values[-1] - 1)
        axes.plot(each.factors, difference, marker=marker, color=colour, label=each.quantity)
    axes.axhline(0, color=MARKED, linewidth=0.8)
    axes.set_xscale("log", base=2)
    axes.set_xticks(result.convergence[0].factors, [f"{factor:g}" for factor in result.convergence[0].factors])
    axes.minorticks_off()
    legend_above(axes, 3)
    return axes


def _swept(result: CheckResult, name: str) -> tuple[Floats, Floats]:
    """Torques (N·m) in rising order, and a quantity at each; NaN where there is none."""
    points = result.trends.points
    return np.array([point.torque for point in points]), np.array([getattr(point, name) for point in points], float)
