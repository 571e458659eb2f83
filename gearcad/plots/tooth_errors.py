"""K_v over speed with tooth errors that were drawn many times: median, band of quantiles, and what it is without errors."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.tooth_errors.result import BAND, ErrorStudy
from gearcad.dynamics.train_result import TrainStudy
from gearcad.plots.labels import plain
from gearcad.plots.paper import MARKED, PALE, SERIES, prepared
from gearcad.plots.speeds import SPEED_WORDS, finish_speeds, mark_modes, speed_ranges

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["plot_tooth_errors"]

_APART = 0.02
"""Of the height of the smooth curve: one that differs less from another is not drawn over it."""

_ROOM = 1.16
"""Above the curves, for the names of natural frequencies."""


def plot_tooth_errors(study: TrainStudy, ax: Axes | None = None) -> Axes:
    """Median and band of every mesh, nominal teeth dashed, and the smooth stiffness of the other charts as a thin line.

    Raises ValueError for a study without tooth errors of their own.
    """
    if study.errors is None:
        raise ValueError(f"no tooth errors were drawn for {study.name}")
    found, axes = study.errors, prepared(ax, SPEED_WORDS, "dynamic factor $K_{\\mathrm{v}}$")
    several = len(found.mesh_names) > 1
    if study.up.standard is not None:
        axes.plot(study.speeds, study.up.standard, color=MARKED, linewidth=2.2, label="ISO 6336-1, Method B")
    for mesh, name in enumerate(found.mesh_names):
        _draw_mesh(axes, found, mesh, f"{plain(name)}, " if several else "")
        _draw_smooth(axes, study, mesh)
    axes.set_xlim(float(found.speeds[0]), float(found.speeds[-1]))
    _set_height(axes, study, found)
    _mark_restless(axes, found)
    mark_modes(axes, study)
    finish_speeds(axes, study)
    return axes


def _draw_mesh(axes: Axes, found: ErrorStudy, mesh: int, owner: str) -> None:
    colour, speeds = SERIES[mesh % len(SERIES)], found.speeds
    many = found.samples > 1
    if many:
        lower, upper = found.band
        words = f"{owner}{100 * BAND[0]:g} % to {100 * BAND[1]:g} %"
        axes.fill_between(speeds, lower[:, mesh], upper[:, mesh], color=colour, alpha=0.25, linewidth=0, label=words)
    middle = "median" if many else "with errors" if found.grade is not None else "single teeth"
    axes.plot(speeds, found.median[:, mesh], color=colour, linewidth=1.4, label=f"{owner}{middle}")
    if found.grade is not None:
        axes.plot(speeds, found.nominal[:, mesh], "--", color=colour, linewidth=1.1, label=f"{owner}without errors")


def _draw_smooth(axes: Axes, study: TrainStudy, mesh: int) -> None:
    """K_v of the other charts, where teeth without errors do not have the same."""
    assert study.errors is not None  # whoever draws has seen to it
    found, smooth = study.errors, study.up.factors[:, mesh]
    inside = (study.speeds >= found.speeds[0]) & (study.speeds <= found.speeds[-1])
    others = [found.median[:, mesh], found.nominal[:, mesh]]
    apart = [np.abs(np.interp(study.speeds, found.speeds, each) - smooth)[inside] for each in others]
    if not inside.any() or min(float(each.max()) for each in apart) < _APART * max(float(np.ptp(smooth[inside])), 0.02):
        return
    known = "smooth" in axes.get_legend_handles_labels()[1]
    colour = SERIES[mesh % len(SERIES)]
    axes.plot(study.speeds, smooth, ":", color=colour, linewidth=1.2, label="" if known else "smooth")


def _set_height(axes: Axes, study: TrainStudy, found: ErrorStudy) -> None:
    inside = (study.speeds >= found.speeds[0]) & (study.speeds <= found.speeds[-1])
    drawn: list[Floats] = [found.median, found.nominal, *found.band, study.up.factors[inside]]
    if study.up.standard is not None:
        drawn.append(study.up.standard[inside])
    values = np.concatenate([each.ravel() for each in drawn])
    lowest, highest = min(1.0, float(values.min())), float(max(values.max(), 1.0))
    axes.set_ylim(lowest - 0.04 * (highest - lowest), lowest + _ROOM * max(highest - lowest, 0.02))


def _mark_restless(axes: Axes, found: ErrorStudy) -> None:
    """Ranges in which most motions did not settle."""
    label = "most do not settle"
    for start, end in speed_ranges(found.speeds, found.restless):
        axes.axvspan(start, end, color=PALE, alpha=0.45, linewidth=0, label=label, zorder=0)
        label = ""
