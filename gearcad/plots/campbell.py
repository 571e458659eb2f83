"""Pictures of a Campbell study: amplitudes over speed and frequency, and one speed over time and frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.dynamics.tooth_springs.campbell_study import CampbellStudy
from gearcad.dynamics.tooth_springs.history import TimeHistory
from gearcad.plots.paper import DARK, MARKED, SERIES, new_figure, prepared, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["plot_campbell", "plot_history", "plot_motion", "plot_spectrum"]

DECADES = 4.0
"""Range of the colours below the greatest amplitude."""

HARMONICS = 7
"""Tooth frequencies drawn in, as in the thesis."""

_CELLS = 280
"""Most rows of colours, so that a sharp peak can be seen: a row shows the greatest amplitude of its frequencies."""

_SHOWN = 6
"""Tooth meshes that a motion over time shows, at the end of it."""

_LABELLED = 4
_OMEGA = "amplitude of pinion speed in rad/s"


def plot_campbell(study: CampbellStudy, ax: Axes | None = None, highest: float = 7000.0) -> Axes:
    """Amplitudes of the pinion's speed on a logarithmic scale, up to a frequency (Hz); lines of teeth and natural frequencies.

    A triangle above marks each chaotic speed: its column is a sample of what may come, not a result to be met again.
    """
    from matplotlib.colors import LogNorm

    axes = prepared(ax, "speed of the pinion in rpm", "frequency in Hz")
    highest = min(highest, float(study.frequency[-1]))
    kept = np.count_nonzero(study.frequency <= highest)
    group = -(-kept // _CELLS)
    starts = np.arange(1, kept, group)  # without the mean
    amplitude = np.maximum.reduceat(study.pinion_speed[:, :kept], starts, axis=1)
    greatest = float(amplitude.max())
    norm = LogNorm(greatest / 10**DECADES, greatest, clip=True)
    edges = _edges(study.speeds)
    rows = study.frequency[np.append(starts, kept - 1)] - study.frequency[1] / 2
    colours = axes.pcolormesh(edges, rows, np.maximum(amplitude.T, 1e-300), norm=norm, cmap="viridis", rasterized=True)
    axes.grid(False)
    axes.set_xlim(edges[0], edges[-1])
    axes.set_ylim(0, highest)
    _draw_lines(study, axes, highest)
    figure = axes.get_figure(root=True)
    assert figure is not None  # prepared() has put them on one
    figure.colorbar(colours, ax=axes, label=_OMEGA, pad=0.02, extend="min")
    return axes


def plot_motion(history: TimeHistory, ax: Axes | None = None) -> Axes:
    """Speed of the pinion over time: the last tooth meshes, or all of a motion that is shorter or stands still."""
    axes = prepared(ax, "time in ms", "pinion speed in rad/s")
    frequency = history.model.tooth_frequency(history.speed)
    whole = len(history.approach)
    count = min(whole, int(_SHOWN / frequency * history.sampling) + 1) if frequency > 0 else whole
    axes.plot(1e3 * history.time[-count:], history.pinion_speed[-count:], color=SERIES[0], linewidth=1.2)
    axes.axhline(history.speed * np.pi / 30, color=MARKED, linewidth=0.8, linestyle="--")
    axes.margins(x=0)
    return axes


def plot_spectrum(history: TimeHistory, ax: Axes | None = None, highest: float = 7000.0) -> Axes:
    """Spectrum of the pinion's speed up to a frequency (Hz), with its highest peaks and the tooth frequencies."""
    axes = prepared(ax, "frequency in Hz", _OMEGA)
    spectrum = history.spectrum(highest)
    shown = spectrum.frequency > 0
    axes.semilogy(spectrum.frequency[shown], np.maximum(spectrum.amplitude[shown], 1e-300), color=SERIES[0], linewidth=1.0)
    greatest = float(spectrum.amplitude[shown].max())
    axes.set_ylim(greatest / 10**DECADES, 4 * greatest)
    axes.set_xlim(0, highest)
    tooth = history.model.tooth_frequency(history.speed)
    if tooth > 0:
        for harmonic in range(1, min(HARMONICS, int(highest / tooth)) + 1):
            axes.axvline(harmonic * tooth, color=MARKED, linewidth=0.8, linestyle=":", zorder=0)
    for peak in spectrum.peaks(_LABELLED, distance=highest / 10):
        axes.annotate(
            f"{short(round(peak.frequency, 1))} Hz", peak, (3, 3), textcoords="offset points", fontsize=8, color=DARK
        )  # fmt: skip
    return axes


def plot_history(history: TimeHistory, highest: float = 7000.0) -> Figure:
    """Motion and spectrum of one speed, side by side."""
    figure = new_figure((9.0, 3.4))
    left, right = figure.subplots(1, 2)
    plot_motion(history, left)
    plot_spectrum(history, right, highest)
    words = ", chaotic" if history.chaotic else ""
    figure.suptitle(f"{history.speed:g} rpm{words}", fontsize=10)
    return figure


def _edges(speeds: np.ndarray) -> np.ndarray:
    """Edges of the columns: half-way between the speeds."""
    if len(speeds) == 1:
        return np.array([speeds[0] - 0.5, speeds[0] + 0.5])
    middle = (speeds[1:] + speeds[:-1]) / 2
    return np.concatenate(([2 * speeds[0] - middle[0]], middle, [2 * speeds[-1] - middle[-1]]))


def _draw_lines(study: CampbellStudy, axes: Axes, highest: float) -> None:
    """Tooth frequencies, labelled where they leave the picture, natural frequencies, and marks of chaotic speeds."""
    from matplotlib.patheffects import AbstractPathEffect, withStroke

    right = axes.get_xlim()[1]
    outlined: list[AbstractPathEffect] = [withStroke(linewidth=2, foreground=DARK)]
    for harmonic in range(1, HARMONICS + 1):
        slope = study.model.tooth_frequency(1.0, harmonic)
        end = min(right, highest / slope)
        axes.plot([0, end], [0, slope * end], color="white", linewidth=0.8, linestyle=":", alpha=0.9)
        place = (end - 0.01 * right, slope * end - 0.01 * highest)
        label = axes.text(*place, f"{harmonic}", ha="right", va="top", fontsize=8, color="white")
        label.set_path_effects(outlined)
    axes.plot([], [], color=MARKED, linewidth=0.8, linestyle=":", label=f"tooth frequencies 1 ... {HARMONICS}")
    for (name, frequency), style in zip(study.natural_frequencies.items(), ("--", "-."), strict=False):
        words = f"natural, {name}: {short(frequency)} Hz"
        axes.axhline(frequency, color=SERIES[1], linewidth=0.9, linestyle=style, label=words)
    chaotic = study.speeds[study.chaotic]
    if len(chaotic):
        top, height = np.ones(len(chaotic)), axes.get_xaxis_transform()
        axes.plot(
            chaotic, top, "v", color=SERIES[3], markersize=6, transform=height, clip_on=False, label="chaotic speed"
        )  # fmt: skip
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.02), ncols=2, frameon=False, fontsize=9, borderaxespad=0.2)
