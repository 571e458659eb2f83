"""Pictures of motions in time: Campbell study, course at one speed, changing speed or torque, transmission error."""

from __future__ import annotations

import math
from itertools import cycle
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gearcad.core.records import Floats
from gearcad.dynamics.time_domain.contact_model import EngagedPairs
from gearcad.dynamics.time_domain.spectra import SpeedSpectra
from gearcad.dynamics.time_domain.time_history import TimeHistory
from gearcad.dynamics.time_domain.transient_result import Transient
from gearcad.dynamics.train_result import ModalStudy, TrainStudy
from gearcad.plots.paper import (
    DARK,
    FIGURE_INCHES,
    GEARS,
    MARKED,
    PALE,
    SERIES,
    legend_above,
    new_figure,
    plain,
    prepared,
    short,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


DECADES = 4.0
"""Range of the colours below the greatest amplitude."""

HARMONICS = 7
"""Tooth frequencies drawn in, as in the thesis."""

_CELLS = 280
"""Largest number of rows of colours, so that a sharp peak can be seen: a row shows the greatest amplitude of its frequencies.
"""

PINION_SPEED = "amplitude of pinion speed in rad/s"


def plot_campbell(study: SpeedSpectra, ax: Axes | None = None, highest: float = 7000.0) -> Axes:
    """Draw the amplitudes of the pinion's speed on a logarithmic scale, up to a frequency (Hz); lines of teeth and natural
    frequencies.

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
    """Return the edges of the columns: half-way between the speeds."""
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


MOTION_INCHES = (6.6, 5.2)
"""Size of a figure of speeds, or of angles, over time, in inches."""

_MESHES, _VIBRATIONS = 6, 12
"""Tooth meshes at the end of a motion that are seen closely; natural vibrations at its begin, of a mesh that nothing varies."""

_BINS = 900
"""Bins of a long motion, each drawn from its least to its greatest value."""

_LABELLED = 4


class _Window(NamedTuple):
    """The samples shown in detail, and a description of them in words."""

    samples: slice
    words: str


def _close(history: TimeHistory) -> _Window:
    """Return the last tooth meshes; where the mesh does not vary the first vibrations,
    for nothing is left of them in the end.
    """
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
    """Draw the speeds of both gears over time, both counter-clockwise: the whole motion on the left, closely on the right."""
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
    """Draw the angles of both gears over time (degrees); below, in detail, their deviation from uniform rotation."""
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


_TRANSIENT_BINS = 600
"""Stretches of time that a course is drawn by, each from its least to its greatest."""


def factors_inches(run: Transient) -> tuple[float, float]:
    """Return the size of a figure over speed."""
    return FIGURE_INCHES[0], 1.4 + 2.6 * len(run.names[0])


def plot_transient_factors(study: TrainStudy | ModalStudy, run: Transient, figure: Figure | None = None) -> Figure:
    """Draw the greatest force of every tooth period over speed, a panel for each mesh; broad and grey what lasts, where it is
    known.
    """
    of, names = new_figure(factors_inches(run)) if figure is None else figure, run.names[0]
    panels = of.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    speeds = np.abs(run.window_speed)
    for mesh, (panel, name) in enumerate(zip(panels, names, strict=True)):
        prepared(panel, "", (f"{plain(name)}: " if len(names) > 1 else "") + "force / static one")
        if not isinstance(study, ModalStudy):
            _draw_lasting(panel, study, run, mesh)
        panel.plot(speeds, run.factor[:, mesh], color=SERIES[mesh % len(SERIES)], linewidth=1.0, label="this run")
        panel.set_ylim(bottom=min(0.9, float(run.factor[:, mesh].min())))
    panels[0].set_xlim(float(speeds.min()), float(speeds.max()))
    panels[-1].set_xlabel("speed of the pinion in rpm" + ", backwards" * bool(np.mean(run.window_speed) < 0))
    legend_above(panels[0], 3)
    return of


def _draw_lasting(axes: Axes, study: TrainStudy, run: Transient, mesh: int) -> None:
    """Draw the steady factors of both charts, under the torques of the run if they differ from those of the train."""
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
    """Return the size of a figure over time."""
    meshes, _, shafts = run.names
    return FIGURE_INCHES[0], 2.0 + 1.45 * (2 * len(meshes) + len(shafts))


def plot_transient(run: Transient, figure: Figure | None = None) -> Figure:
    """Plot a run over time: speed and torques; approach of the flanks and the force between them over the static one; torques
    of the shafts.

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
    if len(time) <= 3 * _TRANSIENT_BINS:
        axes.plot(time, values, color=colour, linewidth=1.0)
        return
    starts = np.linspace(0, len(time), _TRANSIENT_BINS, endpoint=False).astype(int)
    least, most = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    axes.fill_between(time[starts], least, most, color=colour, alpha=0.65, linewidth=0.4, step="post")


def _shade_partings(run: Transient, mesh: str, axes: Axes) -> None:
    """Stretches of time in which flanks of a mesh part."""
    for each in run.partings:
        if each.mesh != mesh:
            continue
        axes.axvspan(each.begin, each.end, color=PALE, alpha=0.35, linewidth=0, zorder=0)


_DECADES = 3.0
"""Range of amplitudes below the greatest."""

_MOST_PIECES = 400
"""Greatest number of pieces of a line over speed: each shows the greatest amplitude of its speeds."""

_LEAST_AMPLITUDE = 0.02
"""Share of the greatest amplitude: frequencies go up to the highest of a line that reaches it."""

_NEAR = 0.05
"""Part of the axis below which names of natural frequencies would lie on each other."""

_PAPER: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "pad": 0.4, "alpha": 0.7}
"""Style of the box below names in a picture."""

_PANEL = 3.4
_TOP_AXIS = 36.0
"""Height (inches) of a panel, and space (points) for a second axis above."""


def plot_lines(study: TrainStudy, ax: Axes | None = None) -> Axes:
    """Draw the amplitudes at the speed of the course, over orders of the tooth frequency, and of the pinion's shaft above."""
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
    """Return the size of a figure with a panel for each mesh."""
    return FIGURE_INCHES[0], _PANEL * len(study.up.mesh_names) + 0.4


def plot_waterfall(study: TrainStudy, figure: Figure | None = None) -> Figure:
    """Draw every line over speed and its own frequency, coloured by its amplitude, running up; natural frequencies across."""
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
        top = max(top, float(frequencies[1:][amplitudes[:, line] > _LEAST_AMPLITUDE * greatest].max(initial=0.0)))
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
    """Return the natural frequencies (Hz) that teeth can shake."""
    if study.on_bearings is not None:
        return study.on_bearings.frequency[study.on_bearings.shaken]
    return study.modes.frequency[study.modes.rigid :]


def _of_first(study: TrainStudy) -> str:
    return f" of {plain(study.up.mesh_names[0])}" if len(study.up.mesh_names) > 1 else ""
