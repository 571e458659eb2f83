"""Pictures of how far everything moves over speed, and of what bearings carry."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.charts.chart import KvChart
from gearcad.dynamics.train_result import TrainStudy
from gearcad.plots.labels import plain
from gearcad.plots.paper import FIGURE_INCHES, MARKED, SERIES, layered, new_figure, prepared
from gearcad.plots.speeds import mark_modes, shade_unstable, tooth_axis

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["bearing_inches", "displacement_inches", "plot_bearings", "plot_displacements"]

_PANEL, _ABOVE = 2.3, 0.7
"""Inches of a panel, and of the axis above."""

_WIDE = 50.0
"""Ratio of the greatest value to the median of those of all speeds above which an axis is logarithmic."""

Curve = Callable[[KvChart], Floats]


def displacement_inches(study: TrainStudy) -> tuple[float, float]:
    """Size of a figure of displacements."""
    return FIGURE_INCHES[0], _PANEL * (3 if study.up.bearings is not None else 2) + _ABOVE


def plot_displacements(study: TrainStudy, figure: Figure | None = None) -> Figure:
    """Amplitudes of the inertias' turns, of the approach of the flanks, and of travels on bearings; running down dashed."""
    of = new_figure(displacement_inches(study)) if figure is None else figure
    up = study.up
    panels = of.subplots(3 if up.bearings is not None else 2, 1, sharex=True)
    _draw(panels[0], study, up.displacements.inertia_names, "turn in arcsec", lambda chart: chart.displacements.turns)
    _draw(panels[1], study, up.mesh_names, "approach y in µm", lambda chart: chart.displacements.approaches)
    if up.bearings is not None:
        gears = up.bearings.gears
        _draw(panels[2], study, gears, "travel along the\nline of action in µm", _travels)
    _finish(panels, study)
    return of


def _travels(chart: KvChart) -> Floats:
    assert chart.bearings is not None  # whoever asks has them
    return chart.bearings.travels_along


def bearing_inches() -> tuple[float, float]:
    """Size of a figure of bearings."""
    return FIGURE_INCHES[0], 3.3 + _ABOVE


def plot_bearings(study: TrainStudy, figure: Figure | None = None) -> Figure:
    """Greatest force on the bearings of each gear over speed, and at rest."""
    of = new_figure(bearing_inches()) if figure is None else figure
    panel, loads = of.subplots(), study.up.bearings
    assert loads is not None  # a pair on bearings has them
    _draw(panel, study, loads.gears, "greatest force on the bearings in N", _forces)
    panel.axhline(float(loads.static[0]), color=MARKED, linewidth=1.0, linestyle="--", label="at rest, and mean")
    panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    _finish([panel], study)
    return of


def _forces(chart: KvChart) -> Floats:
    assert chart.bearings is not None  # whoever asks has them
    return chart.bearings.greatest


def _draw(axes: Axes, study: TrainStudy, names: Sequence[str], words: str, curve: Curve) -> None:
    """A curve for each name, running up, and dashed running down."""
    prepared(axes, "", words)
    drawn = curve(study.up)
    for number, (name, width) in enumerate(zip(names, layered(len(names)), strict=True)):
        colour = SERIES[number % len(SERIES)]
        axes.plot(study.speeds, drawn[:, number], color=colour, linewidth=width, label=plain(name))
        if study.down is not None:
            axes.plot(study.speeds, curve(study.down)[:, number], "--", color=colour, linewidth=1.1)
    drawn = drawn[np.isfinite(drawn)]
    if drawn.size and drawn.min() > 0 and drawn.max() > _WIDE * np.median(drawn):
        axes.set_yscale("log")
    else:
        axes.set_ylim(bottom=0)
    shade_unstable(axes, study.speeds, study.up)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)


def _finish(panels: Sequence[Axes], study: TrainStudy) -> None:
    """Speeds below, tooth frequency above, lines where natural frequencies are met."""
    for panel in panels:
        panel.set_xlim(float(study.speeds[0]), float(study.speeds[-1]))
        mark_modes(panel, study)
    panels[-1].set_xlabel("speed of the pinion in rpm")
    tooth_axis(panels[0], study)
