"""Pictures of a train several times side by side: dynamic factors of its meshes and overload of its shafts over speed."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.charts.chart import KvChart
from gearcad.dynamics.levels.result import LevelStudy
from gearcad.dynamics.operating import OperatingRange
from gearcad.dynamics.side_by_side import SideBySide
from gearcad.dynamics.train_result import TrainStudy
from gearcad.plots.labels import plain
from gearcad.plots.paper import FIGURE_INCHES, MARKED, SERIES, layered, legend_above, new_figure, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "beside_inches",
    "plot_approaches_beside",
    "plot_beside",
    "plot_errors_beside",
    "plot_factors_beside",
    "plot_overloads_beside",
    "study_colours",
]


_SPEED, _FACTOR = "speed of the pinion in rpm", "$K_{\\mathrm{v}}$"
_Curve = Callable[[TrainStudy, KvChart, str], Floats | None]

_PANEL, _ABOVE, _ROW = 2.9, 0.5, 4
"""Inches of a panel, and of axis and legend; studies in a row of the legend."""

_SHORT = 20
"""Letters of a title of which so many stand in a row."""

_WIDE = 20.0
"""Ratio of greatest to least value above which the axis is logarithmic."""


def beside_inches(panels: int, studies: int) -> tuple[float, float]:
    """Size of a figure with a panel for each mesh or shaft."""
    return FIGURE_INCHES[0], _PANEL * panels + _ABOVE + 0.2 * -(-studies // _ROW)


def study_colours(count: int) -> list[str]:
    """A colour for each study; from light to dark, in their order, where there are many."""
    if count <= len(SERIES):
        return list(SERIES[:count])
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    return [to_hex(colormaps["viridis"](place)) for place in np.linspace(0.92, 0.0, count)]


def plot_factors_beside(of: SideBySide, figure: Figure | None = None) -> Figure:
    """K_v of every mesh over speed, a panel each, a colour for each study; running down dashed."""
    return _panels(of, figure, of.mesh_names, _FACTOR, _factor)


def _factor(_study: TrainStudy, chart: KvChart, name: str) -> Floats | None:
    return chart.factors[:, chart.mesh_names.index(name)]


def plot_beside(of: SideBySide, ax: Axes | None = None) -> Axes:
    """K_v of the first mesh over speed, a colour for each study; running down dashed."""
    axes = new_figure().subplots() if ax is None else ax
    _draw(of, axes, of.mesh_names[0], _SPEED, _FACTOR, _factor)
    legend_above(axes, _legend_columns(of))
    return axes


def plot_approaches_beside(of: SideBySide, figure: Figure | None = None) -> Figure:
    """Amplitude of the approach of the flanks of every mesh over speed, a panel each, a colour for each study."""

    def curve(_study: TrainStudy, chart: KvChart, name: str) -> Floats | None:
        return chart.displacements.approaches[:, chart.mesh_names.index(name)]

    drawn = _panels(of, figure, of.mesh_names, "approach y in µm", curve)
    for panel in drawn.axes:
        # As the paper has it: where hardly anything moves is of no interest.
        panel.set_yscale("linear")
        panel.set_ylim(bottom=0)
    return drawn


def plot_overloads_beside(of: SideBySide, figure: Figure | None = None) -> Figure:
    """Greatest torque of every shaft over its static one, a panel each, a colour for each study that has the shaft."""

    def curve(study: TrainStudy, chart: KvChart, name: str) -> Floats | None:
        return chart.shaft_factors[:, chart.shaft_names.index(name)] if name in study.shaft_overloads else None

    return _panels(of, figure, of.shaft_names, "torque over the static one", curve)


def plot_errors_beside(of: SideBySide, figure: Figure | None = None) -> Figure:
    """K_v with errors of teeth: the median of every mesh, a panel each, a colour for each study; the upper quantile dashed."""
    drawn = figure or new_figure(beside_inches(len(of.mesh_names), len(of.studies)))
    panels = drawn.subplots(len(of.mesh_names), 1, sharex=True, squeeze=False)[:, 0]
    colours = dict(zip(of.labels, study_colours(len(of.studies)), strict=True))
    for mesh, (panel, name) in enumerate(zip(panels, of.mesh_names, strict=True)):
        prepared(panel, _SPEED if panel is panels[-1] else "", f"{plain(name)}: $K_{{\\mathrm{{v}}}}$ with errors")
        for width, (label, found) in zip(layered(len(of.errors)), of.errors.items(), strict=True):
            panel.plot(found.speeds, found.median[:, mesh], color=colours[label], linewidth=width, label=plain(of.title(label)))
            if found.samples > 1:
                panel.plot(found.speeds, found.band[1][:, mesh], "--", color=colours[label], linewidth=1.1)
        ends = [float(end) for found in of.errors.values() for end in (found.speeds[0], found.speeds[-1])]
        panel.set_xlim(min(ends), max(ends))
    legend_above(panels[0], _legend_columns(of))
    return drawn


def _panels(
    of: SideBySide,
    figure: Figure | None,
    names: tuple[str, ...],
    words: str,
    curve: _Curve,
) -> Figure:
    """What `curve` has of each name in each chart of each study, None where it has nothing."""
    drawn = figure or new_figure(beside_inches(len(names), len(of.studies)))
    panels = drawn.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    for panel, name in zip(panels, names, strict=True):
        _draw(of, panel, name, _SPEED if panel is panels[-1] else "", words, curve)
    legend_above(panels[0], _legend_columns(of))
    return drawn


def _draw(of: SideBySide, panel: Axes, name: str, below: str, words: str, curve: _Curve) -> None:
    """What `curve` has of a name in each chart of each study, over speed."""
    prepared(panel, below, f"{plain(name)}: {words}")
    shown, widths = [], layered(len(of.studies))
    for width, colour, label, study in zip(widths, study_colours(len(of.studies)), of.labels, of.studies, strict=True):
        for (_, chart), style in zip(study.charts.directions(), ("-", "--"), strict=False):
            values = curve(study, chart, name)
            if values is not None:
                words_of = plain(of.title(label)) if style == "-" else ""
                panel.plot(study.speeds, values, style, color=colour, linewidth=width, label=words_of)
                shown.append(values)
    speeds = [float(end) for study in of.studies for end in (study.speeds[0], study.speeds[-1])]
    panel.set_xlim(min(speeds), max(speeds))
    if isinstance(of, LevelStudy):
        _mark_range(panel, of.over)
    _set_scale(panel, np.concatenate(shown))


def _legend_columns(of: SideBySide) -> int:
    return _ROW if max(map(len, of.titles)) <= _SHORT else _ROW - 1


def _mark_range(axes: Axes, over: OperatingRange) -> None:
    """Both ends of the operating range, where the chart goes on."""
    for end in (over.first, over.last):
        if axes.get_xlim()[0] < end < axes.get_xlim()[1]:
            axes.axvline(end, color=MARKED, linewidth=1.0, linestyle="--")


def _set_scale(axes: Axes, values: Floats) -> None:
    """Logarithmic where values are far apart."""
    if values.max() > _WIDE * max(values.min(), 1.0) and values.min() > 0:
        axes.set_yscale("log")
