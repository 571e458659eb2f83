"""A train as it runs, quasi-statically: shares of its planets and twist of its output, over the whole run and close by."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.running import Running
from gearcad.plots.paper import FIGURE_INCHES, MARKED, SERIES, new_figure, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["RUNNING_INCHES", "plot_running", "shown_pitches"]

RUNNING_INCHES = (FIGURE_INCHES[0], 4.8)

_BANDS = 300
"""Most pieces of a long run, of each of which the least and the greatest are drawn: nobody sees more."""

_PITCHES = 6.0
"""Base pitches that are drawn close by, or fewer where the run is shorter."""

_SHADES = ("#cc79a7", "#0072b2", "#009e73", "#d55e00", "#56b4e9", "#e69f00")
"""Of planets; with more than these they come again."""

_ARCSECONDS = 3600.0

_LEVEL = 5e-3
"""Half of the least range of an axis, over what is in its middle."""


def shown_pitches(running: Running) -> float:
    """Base pitches of the first mesh that are drawn close by."""
    return min(_PITCHES, float(running.rolled[-1]))


def plot_running(running: Running, figure: Figure | None = None) -> Figure:
    """Above shares of the planets, below the twist; on the left the whole run, on the right its first base pitches."""
    of = new_figure(RUNNING_INCHES) if figure is None else figure
    panels = of.subplots(2, 2, sharey="row", sharex="col", width_ratios=(1.2, 1))
    near = running.rolled <= shown_pitches(running) + 1e-9
    name = running.train.meshes[0].name
    turn, sense = np.abs(running.carrier_angle), ", clockwise" if running.carrier_angle[-1] < 0 else ""
    for row, (curves, slow, words) in enumerate(_rows(running)):
        prepared(panels[row, 0], "" if row == 0 else f"turn of {running.train.carrier.name} in °{sense}", words)
        prepared(panels[row, 1], "" if row == 0 else f"base pitches of {name}".replace("$", r"\$"), "")
        for number, (curve, mean) in enumerate(zip(curves, slow, strict=True)):
            colour = _SHADES[number % len(_SHADES)] if row == 0 else SERIES[0]
            _draw_band(panels[row, 0], turn, curve, colour)
            panels[row, 1].plot(running.rolled[near], curve[near], color=colour, linewidth=1.2, label=f"planet {number + 1}")
            panels[row, 1].plot(running.rolled[near], mean[near], color=MARKED, linewidth=0.8, linestyle="--")
        for panel in panels[row]:
            panel.margins(x=0)
        _widen(panels[row, 0])
    if len(running.shares) <= len(_SHADES):
        found = panels[0, 1].get_legend_handles_labels()
        panels[0, 0].legend(*found, loc="lower left", bbox_to_anchor=(0, 1), ncols=3, frameon=False, fontsize=8)
    return of


def _widen(axes: Axes) -> None:
    """Room above and below curves that are level but for rounding."""
    low, high = axes.get_ylim()
    middle, half = (low + high) / 2, (high - low) / 2
    if half < _LEVEL * abs(middle):
        axes.set_ylim(middle - _LEVEL * abs(middle), middle + _LEVEL * abs(middle))


def _rows(running: Running) -> tuple[tuple[Floats, Floats, str], tuple[Floats, Floats, str]]:
    """Curves, the same without what the meshes do, and their words."""
    twist = (np.atleast_2d(each) * _ARCSECONDS for each in (running.twist, running.slow_twist))
    return (running.shares, running.slow_shares, "share of a planet"), (*twist, "twist in arcsec")  # type: ignore[return-value]


def _draw_band(axes: Axes, turn: Floats, values: Floats, colour: str) -> None:
    """A curve; of one with many places the band between the least and the greatest of each piece."""
    if len(values) <= 4 * _BANDS:
        axes.plot(turn, values, color=colour, linewidth=0.9)
        return
    starts = np.linspace(0, len(values), _BANDS, endpoint=False).astype(int)
    low, high = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    axes.fill_between(turn[starts], low, high, color=colour, linewidth=0.4, alpha=0.6)
