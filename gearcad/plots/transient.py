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

__all__ = ["factors_inches", "plot_transient", "plot_transient_factors", "transient_inches"]

_BINS = 600
"""Stretches of time that a course is drawn by, each from its least to its greatest."""


def factors_inches(run: Transient) -> tuple[float, float]:
    """Size of a figure over speed."""
    return FIGURE_INCHES[0], 1.4 + 2.6 * len(run.names[0])


def plot_transient_factors(study: TrainStudy, run: Transient, figure: Figure | None = None) -> Figure:
    """Greatest force of every tooth period over speed, a panel for each mesh; broad and grey what lasts at each speed."""
    of, names = new_figure(factors_inches(run)) if figure is None else figure, run.names[0]
    panels = of.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    speeds = np.abs(run.window_speed)
    for mesh, (panel, name) in enumerate(zip(panels, names, strict=True)):
        prepared(panel, "", (f"{plain(name)}: " if len(names) > 1 else "") + "force / static one")
        _draw_lasting(panel, study, run, mesh)
        panel.plot(speeds, run.factor[:, mesh], color=SERIES[mesh % len(SERIES)], linewidth=1.0, label="this run")
        panel.set_ylim(bottom=min(0.9, float(run.factor[:, mesh].min())))
    panels[0].set_xlim(float(speeds.min()), float(speeds.max()))
    panels[-1].set_xlabel("speed of the pinion in rpm" + ", backwards" * bool(np.mean(run.window_speed) < 0))
    legend_above(panels[0], 3)
    return of


def _draw_lasting(axes: Axes, study: TrainStudy, run: Transient, mesh: int) -> None:
    """Of both charts, under the torques of the run where these are not those of the train."""
    for chart, style in ((study.up, "-"), (study.down, "--")):
        if chart is None:
            continue
        label = "what lasts" + (", running down" if chart is study.down else ", running up" if study.down else "")
        speeds, values = study.speeds, chart.factors[:, mesh]
        if not run.whole_load.all():
            speeds, values = np.abs(run.window_speed), study.lasting_course(chart, mesh)
        if np.isfinite(values).any():
            axes.plot(speeds, values, style, color=MARKED, linewidth=2.6, label=label)


def transient_inches(run: Transient) -> tuple[float, float]:
    """Size of a figure over time."""
    meshes, _, shafts = run.names
    return FIGURE_INCHES[0], 2.0 + 1.45 * (2 * len(meshes) + len(shafts))


def plot_transient(run: Transient, figure: Figure | None = None) -> Figure:
    """Over time: speed and torques; approach of the flanks and force between them over the static one; torques of the shafts.

    Each mesh and each shaft has panels of its own.
    """
    of = new_figure(transient_inches(run)) if figure is None else figure
    meshes, _, shafts = run.names
    courses = 2 * len(meshes) + len(shafts)
    panels = of.subplots(1 + courses, 1, sharex=True, height_ratios=[0.8] + [1] * courses)
    _draw_given(run, panels[0])
    each = [
        (run.approach, meshes, "approach in µm"),
        (run.force / run.static_forces, meshes, "force / static one"),
        (run.shaft_torque, shafts, "torque in N·m"),
    ]
    drawn = [(values[:, n], n, name, words) for values, names, words in each for n, name in enumerate(names)]
    for panel, (values, number, name, words) in zip(panels[1:], drawn, strict=True):
        prepared(panel, "", words)
        panel.set_title(plain(name), fontsize=9, loc="left", pad=3)
        _draw_course(panel, run.time, values, SERIES[number % len(SERIES)])
    for panel, mesh in zip(panels[1 + len(meshes) :], meshes, strict=False):
        _shade_partings(run, mesh, panel)
        panel.axhline(0, color=MARKED, linewidth=0.8)
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


def _draw_course(axes: Axes, time: Floats, values: Floats, colour: str) -> None:
    """A line, or where it has too many samples for one the band from its least to its greatest."""
    if len(time) <= 3 * _BINS:
        axes.plot(time, values, color=colour, linewidth=1.0)
        return
    starts = np.linspace(0, len(time), _BINS, endpoint=False).astype(int)
    least, most = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    axes.fill_between(time[starts], least, most, color=colour, alpha=0.65, linewidth=0.4, step="post")


def _shade_partings(run: Transient, mesh: str, axes: Axes) -> None:
    """Stretches of time in which flanks of a mesh part."""
    for each in run.partings:
        if each.mesh != mesh:
            continue
        axes.axvspan(each.begin, each.end, color=PALE, alpha=0.35, linewidth=0, zorder=0)
