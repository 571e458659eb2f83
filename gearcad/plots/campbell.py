"""The picture of a Campbell study: amplitudes over speed and frequency."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from gearcad.dynamics.tooth_springs.speed_spectra import SpeedSpectra
from gearcad.plots.paper import DARK, MARKED, SERIES, prepared, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["DECADES", "HARMONICS", "PINION_SPEED", "plot_campbell"]

DECADES = 4.0
"""Range of the colours below the greatest amplitude."""

HARMONICS = 7
"""Tooth frequencies drawn in, as in the thesis."""

_CELLS = 280
"""Most rows of colours, so that a sharp peak can be seen: a row shows the greatest amplitude of its frequencies."""

PINION_SPEED = "amplitude of pinion speed in rad/s"


def plot_campbell(study: SpeedSpectra, ax: Axes | None = None, highest: float = 7000.0) -> Axes:
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
    figure.colorbar(colours, ax=axes, label=PINION_SPEED, pad=0.02, extend="min")
    return axes


def _edges(speeds: np.ndarray) -> np.ndarray:
    """Edges of the columns: half-way between the speeds."""
    if len(speeds) == 1:
        return np.array([speeds[0] - 0.5, speeds[0] + 0.5])
    middle = (speeds[1:] + speeds[:-1]) / 2
    return np.concatenate(([2 * speeds[0] - middle[0]], middle, [2 * speeds[-1] - middle[-1]]))


def _draw_lines(study: SpeedSpectra, axes: Axes, highest: float) -> None:
    """Tooth frequencies, labelled where they leave the picture, natural frequencies, and marks of chaotic speeds."""
    from matplotlib.patheffects import AbstractPathEffect, withStroke

    right = axes.get_xlim()[1]
    outlined: list[AbstractPathEffect] = [withStroke(linewidth=2, foreground=DARK)]
    for harmonic in range(1, HARMONICS + 1):
        slope = harmonic * study.teeth / 60
        end = min(right, highest / slope)
        axes.plot([0, end], [0, slope * end], color="white", linewidth=0.8, linestyle=":", alpha=0.9)
        place = (end - 0.01 * right, slope * end - 0.01 * highest)
        label = axes.text(*place, f"{harmonic}", ha="right", va="top", fontsize=8, color="white")
        label.set_path_effects(outlined)
    axes.plot([], [], color=MARKED, linewidth=0.8, linestyle=":", label=f"tooth frequencies 1 ... {HARMONICS}")
    for (name, frequency), style in zip(study.natural_frequencies.items(), cycle(("--", "-.")), strict=False):
        words = f"natural, {name}: {short(frequency)} Hz"
        axes.axhline(frequency, color=SERIES[1], linewidth=0.9, linestyle=style, label=words)
    chaotic = study.speeds[study.chaotic]
    if len(chaotic):
        top, height = np.ones(len(chaotic)), axes.get_xaxis_transform()
        axes.plot(
            chaotic, top, "v", color=SERIES[3], markersize=6, transform=height, clip_on=False, label="chaotic speed"
        )  # fmt: skip
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.02), ncols=2, frameon=False, fontsize=9, borderaxespad=0.2)
