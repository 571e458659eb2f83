"""Pictures of a run with changing speed or torque: loads over speed beside the charts, and over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.in_time.transient_result import Transient
from gearcad.dynamics.train_result import TrainStudy
from gearcad.plots.labels import plain
from gearcad.plots.paper import FIGURE_INCHES, MARKED, PALE, SERIES, legend_above, new_figure, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["plot_transient", "plot_transient_factors", "transient_inches"]

_BINS = 600
"""Stretches of time that a course is drawn by, each from its least to its greatest."""


def plot_transient_factors(study: TrainStudy, run: Transient, ax: Axes | None = None) -> Axes:
    """Greatest force of every tooth period over speed; pale the charts, that show what lasts at each speed."""
    axes = prepared(ax, "speed of the pinion in rpm", "greatest force over the static one")
    names, backwards = run.names[0], float(np.mean(run.window_speed)) < 0
    speeds = np.abs(run.window_speed)
    for chart, style in ((study.up, "-"), (study.down, "--")):
        if chart is not None:
            label = "what lasts" + (", running down" if chart is study.down else ", running up" if study.down else "")
            for mesh in range(len(names)):
                axes.plot(study.speeds, chart.factors[:, mesh], style, color=PALE, linewidth=2.2, label=label)
                label = ""
    for mesh, name in enumerate(names):
        words = plain(name) if len(names) > 1 else "this run"
        axes.plot(speeds, run.factor[:, mesh], color=SERIES[mesh % len(SERIES)], linewidth=1.0, label=words)
    axes.set_xlim(float(speeds.min()), float(speeds.max()))
    axes.set_ylim(bottom=min(0.9, float(run.factor.min())))
    if backwards:
        axes.set_xlabel("speed of the pinion in rpm, backwards")
    legend_above(axes, 3)
    return axes


def transient_inches(run: Transient) -> tuple[float, float]:
    """Size of a figure over time."""
    return FIGURE_INCHES[0], 5.0 + 1.5 * bool(run.names[2])


def plot_transient(run: Transient, figure: Figure | None = None) -> Figure:
    """Speed and torques; approach of the flanks; force between them over the static one; torques of the shafts: over time."""
    of = new_figure(transient_inches(run)) if figure is None else figure
    panels = of.subplots(3 + bool(run.names[2]), 1, sharex=True, height_ratios=[0.7] + [1] * (2 + bool(run.names[2])))
    _draw_given(run, panels[0])
    each = [
        (run.approach, run.names[0], "approach in µm"),
        (run.force / run.static_forces, run.names[0], "force / static one"),
        (run.shaft_torque, run.names[2], "shaft torque in N·m"),
    ]
    for panel, (values, names, words) in zip(panels[1:], each, strict=False):
        prepared(panel, "", words)
        for number, name in enumerate(names):
            _draw_course(panel, run.time, values[:, number], SERIES[number % len(SERIES)], plain(name))
        if len(names) > 1:
            panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    _shade_partings(run, panels[2])
    panels[2].axhline(0, color=MARKED, linewidth=0.8)
    panels[-1].set_xlabel("time in s")
    panels[0].set_xlim(0, run.options.duration)
    return of


def _draw_given(run: Transient, axes: Axes) -> None:
    """Speed on the left, the factor of the torques on the right."""
    prepared(axes, "", "speed in rpm")
    axes.plot(run.windows, np.interp(run.windows, [0, run.options.duration], run.speeds), color=SERIES[0], linewidth=1.4)
    axes.yaxis.label.set_color(SERIES[0])
    right = axes.twinx()
    right.plot(run.time, run.torque, color=SERIES[1], linewidth=1.2, linestyle="--")
    right.set_ylabel("torque factor", color=SERIES[1])
    lowest, highest = min(0.0, float(run.torque.min())), max(float(run.torque.max()), 0.0)
    right.set_ylim(lowest - 0.1 * (highest - lowest or 1), highest + 0.15 * (highest - lowest or 1))
    right.spines[["top"]].set_visible(False)


def _draw_course(axes: Axes, time: Floats, values: Floats, colour: str, label: str) -> None:
    """A line, or where it has too many samples for one the band from its least to its greatest."""
    if len(time) <= 3 * _BINS:
        axes.plot(time, values, color=colour, linewidth=1.0, label=label)
        return
    starts = np.linspace(0, len(time), _BINS, endpoint=False).astype(int)
    least, most = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    axes.fill_between(time[starts], least, most, color=colour, alpha=0.65, linewidth=0.4, step="post", label=label)


def _shade_partings(run: Transient, axes: Axes) -> None:
    """Stretches of time in which flanks part."""
    for each in run.partings:
        axes.axvspan(each.begin, each.end, color=PALE, alpha=0.35, linewidth=0, zorder=0)
