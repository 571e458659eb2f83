"""Pictures of one pair at one speed: speeds and angles of both gears over time, and the spectrum of the pinion's speed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.tooth_springs.contact_model import EngagedPairs
from gearcad.dynamics.tooth_springs.history import TimeHistory
from gearcad.plots.campbell import DECADES, HARMONICS, PINION_SPEED
from gearcad.plots.paper import DARK, GEARS, MARKED, SERIES, legend_above, new_figure, prepared, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["MOTION_INCHES", "plot_angles", "plot_motion", "plot_spectrum"]

MOTION_INCHES = (6.6, 5.2)
"""Of a figure of speeds, or of angles, over time."""

_MESHES, _VIBRATIONS = 6, 12
"""Tooth meshes at the end of a motion that are seen closely; natural vibrations at its begin, of a mesh that nothing varies."""

_BINS = 900
"""Of a long motion, each drawn from its least to its greatest value."""

_LABELLED = 4


class _Window(NamedTuple):
    """The samples that are seen closely, and what they are in words."""

    samples: slice
    words: str


def _close(history: TimeHistory) -> _Window:
    """The last tooth meshes; where the mesh does not vary the first vibrations, for nothing is left of them in the end."""
    constant = history.model.zone is EngagedPairs.ONE_PAIR
    frequency = history.model.natural_frequency() if constant else history.model.tooth_frequency(history.speed)
    if not frequency:
        return _Window(slice(None), "all of it")
    count = int((_VIBRATIONS if constant else _MESHES) / frequency * history.sampling) + 1
    if count >= len(history.approach):
        return _Window(slice(None), "all of it")
    if constant:
        return _Window(slice(count), f"the first {_VIBRATIONS} vibrations")
    return _Window(slice(-count, None), f"the last {_MESHES} tooth meshes")


def plot_motion(history: TimeHistory, figure: Figure | None = None) -> Figure:
    """Speeds of both gears over time, both counter-clockwise: the whole motion on the left, closely on the right."""
    of = new_figure(MOTION_INCHES) if figure is None else figure
    panels, window, time = of.subplots(2, 2, sharey="row"), _close(history), 1e3 * history.time
    pinion, wheel = history.model.base_radii
    mean = history.speed * math.pi / 30
    each = ((history.pinion_speed, mean, "\\omega_1"), (history.wheel_speed, -mean * pinion / wheel, "\\omega_2"))
    for row, ((name, colour, _), (speed, uniform, symbol)) in enumerate(zip(GEARS, each, strict=True)):
        whole, close = panels[row]
        prepared(whole, "", f"{name}, ${symbol}$ in rad/s")
        _draw_long(whole, time, speed, colour)
        prepared(close, "", "")
        close.plot(time[window.samples], speed[window.samples], color=colour, linewidth=1.2)
        for panel in (whole, close):
            panel.axhline(uniform, color=MARKED, linewidth=0.8, linestyle="--")
            panel.margins(x=0)
    for panel, words in zip(panels[0], ("the whole time", window.words), strict=True):
        panel.set_title(words, fontsize=9, loc="left")
    for panel in panels[1]:
        panel.set_xlabel("time in ms")
    return of


def plot_angles(history: TimeHistory, figure: Figure | None = None) -> Figure:
    """How far both gears have turned; below, closely, how far beyond the uniform turning, which hides it above."""
    of = new_figure(MOTION_INCHES) if figure is None else figure
    above, below = of.subplots(2, 1)
    prepared(above, "time in ms", "turn in °")
    prepared(below, "time in ms", "beyond uniform, in °")
    window, time = _close(history), 1e3 * history.time
    angles = (history.pinion_angle, history.wheel_angle)
    deviations = (history.pinion_deviation, history.wheel_deviation)
    for (name, colour, _), symbol, angle, deviation in zip(GEARS, ("_1", "_2"), angles, deviations, strict=True):
        _draw_long(above, time, angle, colour, f"{name}, $\\varphi{symbol}$")
        below.plot(time[window.samples], deviation[window.samples], color=colour, linewidth=1.2)
    below.set_title(window.words, fontsize=9, loc="left")
    legend_above(above, 2)
    for panel in (above, below):
        panel.margins(x=0)
    return of


def _draw_long(axes: Axes, time: Floats, values: Floats, colour: str, label: str = "") -> None:
    """A line through the least and the greatest value of many samples at a time, where there are more than can be told."""
    group = len(values) // _BINS
    if group > 2:
        starts = np.arange(0, len(values), group)
        extremes = (np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts))
        time, values = np.repeat(time[starts], 2), np.stack(extremes, axis=1).ravel()
    axes.plot(time, values, color=colour, linewidth=1.0, label=label)


def plot_spectrum(history: TimeHistory, ax: Axes | None = None, highest: float = 7000.0) -> Axes:
    """Spectrum of the pinion's speed up to a frequency (Hz), with its highest peaks and the tooth frequencies."""
    axes = prepared(ax, "frequency in Hz", PINION_SPEED)
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
        if peak.amplitude > axes.get_ylim()[0]:
            words = f"{short(round(peak.frequency, 1))} Hz"
            axes.annotate(words, peak, (3, 3), textcoords="offset points", fontsize=8, color=DARK)
    return axes
