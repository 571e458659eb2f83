"""Pictures of the dynamic transmission error: its lines at one speed, and over all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.train_result import TrainStudy
from gearcad.plots.labels import plain
from gearcad.plots.paper import FIGURE_INCHES, MARKED, SERIES, legend_above, new_figure, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["plot_lines", "plot_waterfall", "waterfall_inches"]

_DECADES = 3.0
"""Range of amplitudes below the greatest."""

_MOST_PIECES = 400
"""Of a line over speed: each shows the greatest amplitude of its speeds."""

_SHOWN = 0.02
"""Of the greatest amplitude: frequencies go up to the highest of a line that has as much."""

_NEAR = 0.05
"""Part of the axis below which names of natural frequencies would lie on each other."""

_PAPER: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "pad": 0.4, "alpha": 0.7}
"""Below those names."""

_PANEL = 3.4
_TOP_AXIS = 36.0
"""Inches of a panel, and points that a second axis above takes."""


def plot_lines(study: TrainStudy, ax: Axes | None = None) -> Axes:
    """Amplitudes at the speed of the course, over orders of the tooth frequency, and of the pinion's shaft above."""
    from matplotlib.ticker import MaxNLocator

    course, teeth = study.course, study.train.meshes[0].teeth
    axes = prepared(ax, "order of the tooth frequency" + _of_first(study), "amplitude in µm")
    greatest = float(course.line.max(initial=0.0)) or 1.0
    bottom = greatest / 10**_DECADES
    for mesh, name in enumerate(study.up.mesh_names):
        shown = course.line[:, mesh] > bottom
        orders, colour = course.order[shown], SERIES[mesh % len(SERIES)]
        axes.vlines(orders, bottom, course.line[shown, mesh], color=colour, linewidth=1.6, label=plain(name))
        axes.plot(orders, course.line[shown, mesh], ".", color=colour, markersize=4)
    axes.set_yscale("log")
    axes.set_ylim(bottom, 2 * greatest)
    drawn = course.order[(course.line > bottom).any(axis=1)]
    last = float(drawn.max(initial=1.0)) + 0.5
    axes.set_xlim(0, last)
    axes.xaxis.set_major_locator(MaxNLocator(10, integer=True))
    label = "natural frequencies"
    for hertz in _natural(study):
        order = 60 * hertz / (course.speed * teeth)
        if order < last:
            axes.axvline(order, color=MARKED, linewidth=0.8, linestyle="--", label=label, zorder=0)
            label = ""
    above = axes.secondary_xaxis(
        "top", functions=(lambda order: np.asarray(order) * teeth, lambda order: np.asarray(order) / teeth)
    )
    above.set_xlabel("order of the pinion's shaft")
    above.spines["top"].set_color(MARKED)
    legend_above(axes, 3, raised=_TOP_AXIS)
    return axes


def waterfall_inches(study: TrainStudy) -> tuple[float, float]:
    """Size of a figure with a panel for each mesh."""
    return FIGURE_INCHES[0], _PANEL * len(study.up.mesh_names) + 0.4


def plot_waterfall(study: TrainStudy, figure: Figure | None = None) -> Figure:
    """Every line over speed and its own frequency, coloured by its amplitude, running up; natural frequencies across."""
    of = new_figure(waterfall_inches(study)) if figure is None else figure
    panels = of.subplots(len(study.up.mesh_names), 1, sharex=True, squeeze=False)[:, 0]
    for mesh, (panel, name) in enumerate(zip(panels, study.up.mesh_names, strict=True)):
        prepared(panel, "", "frequency in Hz")
        _draw_rays(panel, study, mesh, name if len(panels) > 1 else "")
        panel.set_xlim(float(study.speeds[0]), float(study.speeds[-1]))
        _mark_natural(panel, _natural(study))
    panels[-1].set_xlabel("speed of the pinion in rpm")
    return of


def _mark_natural(axes: Axes, frequencies: Floats) -> None:
    """Dashed lines over the rays, with their frequency (Hz) where there is room."""
    right, top, last = axes.get_xlim()[1], axes.get_ylim()[1], -1.0
    for hertz in frequencies[frequencies < top].tolist():
        axes.axhline(hertz, color=SERIES[1], linewidth=0.9, linestyle="--", zorder=3)
        if hertz - last > _NEAR * top:
            place, beside = (right, hertz), (-2, 1)
            axes.annotate(f"{hertz:.0f}", place, beside, "data", "offset points", ha="right", fontsize=7, zorder=4, bbox=_PAPER)
            last = hertz


def _draw_rays(axes: Axes, study: TrainStudy, mesh: int, name: str) -> None:
    """Lines through the origin, the faint ones below."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import LogNorm

    errors = study.up.transmission
    starts = np.unique(np.linspace(0, len(study.speeds), min(_MOST_PIECES, len(study.speeds)) + 1).astype(int)[:-1])
    amplitudes = np.maximum.reduceat(np.nan_to_num(errors.amplitudes[:, :, mesh]), starts, axis=0)
    ends = np.append(study.speeds[starts], study.speeds[-1])
    greatest = float(amplitudes.max(initial=0.0)) or 1.0
    norm, floor = LogNorm(greatest / 10**_DECADES, greatest, clip=True), greatest / 10**_DECADES
    per_rpm = study.train.meshes[0].teeth / 60
    top = 0.0
    for line in np.argsort(amplitudes.max(axis=0, initial=0.0)):
        frequencies = errors.orders[line] * per_rpm * ends
        places = np.stack([ends, frequencies], axis=1)
        felt = amplitudes[:, line] > floor
        if not felt.any():
            continue
        top = max(top, float(frequencies[1:][amplitudes[:, line] > _SHOWN * greatest].max(initial=0.0)))
        pieces = np.stack([places[:-1], places[1:]], axis=1)[felt]
        rays = LineCollection(list(pieces), norm=norm, cmap="viridis", linewidth=2.4, rasterized=True)
        rays.set_array(amplitudes[felt, line])
        axes.add_collection(rays)
    axes.set_ylim(0, 1.02 * top if top else 1.0)
    _colour_bar(axes, norm, f"amplitude{f' in {plain(name)}' if name else ''} in µm")


def _colour_bar(axes: Axes, norm: object, words: str) -> None:
    from matplotlib.cm import ScalarMappable

    figure = axes.get_figure(root=True)
    assert figure is not None  # prepared() has put them on one
    figure.colorbar(ScalarMappable(norm, cmap="viridis"), ax=axes, label=words, pad=0.02, extend="min")  # type: ignore[arg-type]


def _natural(study: TrainStudy) -> Floats:
    """Natural frequencies (Hz) that teeth can shake."""
    if study.on_bearings is not None:
        return study.on_bearings.frequency[study.on_bearings.shaken]
    return study.modes.frequency[study.modes.rigid :]


def _of_first(study: TrainStudy) -> str:
    return f" of {plain(study.up.mesh_names[0])}" if len(study.up.mesh_names) > 1 else ""
