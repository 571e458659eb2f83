"""Pictures over speed: dynamic factors, overload of shafts, displacements, bearing loads, tooth errors."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gearcad.core.records import Floats
from gearcad.dynamics.response.kv_chart import KvChart
from gearcad.dynamics.tooth_errors.error_result import BAND, ErrorStudy
from gearcad.dynamics.train_result import TrainStudy
from gearcad.mesh_cycle import MeshCycle
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, PALE, SERIES, layered, legend_above, new_figure, plain, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


SPEED_WORDS = "speed of the pinion in rpm"

_TOP_AXIS = 36.0
"""Points that a second axis above takes."""

_NEAR = 0.035
"""Part of the axis below which the names of two natural frequencies would lie on each other."""

_PAPER: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.85}
"""Style of the box below names where a line passes through."""

_ROOM = 1.16
"""Factor on the height of the curves that leaves room for names above."""

_APART = 0.02
"""Share of the height of the curves: K_v with the dampers' force is drawn only if it differs by more."""

_WIDE = 20.0
"""Overload, or ratio of greatest to least overload, above which the axis is logarithmic."""

_LEAST_TEETH, _MOST_TEETH = 3.0, 24.0
"""Tooth periods that a course shows: shorter ones come again, longer ones are cut."""


def plot_factors(study: TrainStudy, ax: Axes | None = None) -> Axes:
    """K_v of every mesh over speed: running up, down dashed, with jumps; where tooth frequencies meet natural ones."""
    axes = prepared(ax, SPEED_WORDS, "dynamic factor $K_{\\mathrm{v}}$")
    up, down = study.up, study.down
    if up.standard is not None:
        axes.plot(study.speeds, up.standard, color=MARKED, linewidth=2.2, label="ISO 6336-1, Method B")
    for mesh, (name, width) in enumerate(zip(up.mesh_names, layered(len(up.mesh_names)), strict=True)):
        colour, words = SERIES[mesh % len(SERIES)], plain(name) if len(up.mesh_names) > 1 else "this model"
        for chart, style, sense in ((up, "-", ", running up"), (down, "--", ", running down")):
            if chart is not None:
                label = words + (sense if down is not None else "")
                axes.plot(study.speeds, chart.factors[:, mesh], style, color=colour, linewidth=width, label=label)
        _draw_jumps(axes, study, mesh)
    _draw_damped(axes, study)
    axes.set_xlim(float(study.speeds[0]), float(study.speeds[-1]))
    _set_height(axes, [chart for chart in (up, down) if chart is not None])
    shade_unstable(axes, study.speeds, study.up)
    mark_parting(axes, study.speeds, study.up, parting=study.excitation.parting)
    mark_modes(axes, study)
    if study.speeds[0] <= abs(study.train.speed) <= study.speeds[-1]:
        axes.plot(abs(study.train.speed), 0, "^", color=DARK, transform=axes.get_xaxis_transform(), label="speed asked for")
    finish_speeds(axes, study)
    return axes


def plot_shaft_overload(study: TrainStudy, ax: Axes | None = None) -> Axes:
    """Draw the greatest torque of every shaft over its static one, where it has one, over speed."""
    axes = prepared(ax, SPEED_WORDS, "greatest torque over the static one")
    kept = study.up.referred_shafts
    for shaft, width in zip(kept, layered(len(kept)), strict=True):
        colour, words = SERIES[shaft % len(SERIES)], plain(study.up.shaft_names[shaft])
        axes.plot(study.speeds, study.up.shaft_factors[:, shaft], color=colour, linewidth=width, label=words)
        if study.down is not None:
            axes.plot(study.speeds, study.down.shaft_factors[:, shaft], color=colour, linewidth=1.4, linestyle="--")
    factors = study.up.shaft_factors[:, kept]
    axes.set_xlim(float(study.speeds[0]), float(study.speeds[-1]))
    factors = factors[np.isfinite(factors)]
    if factors.size and factors.max() > _WIDE * factors.min() > 0:
        axes.set_yscale("log")
    finish_speeds(axes, study)
    return axes


def _set_height(axes: Axes, charts: list[KvChart]) -> None:
    """Set the range of the axis from 1 or below to the greatest K_v, with room for names above.

    The axis is logarithmic if the greatest K_v is far above 1.
    """
    drawn = [chart.factors.ravel() for chart in charts] + [each.standard for each in charts if each.standard is not None]
    factors = np.concatenate(drawn)
    factors = factors[np.isfinite(factors)]
    lowest, highest = min(1.0, float(factors.min())), float(max(factors.max(), 1.0))
    if highest > _WIDE and lowest > 0:
        axes.set_yscale("log")
        axes.set_ylim(lowest * (highest / lowest) ** -0.04, lowest * (highest / lowest) ** _ROOM)
    else:
        axes.set_ylim(lowest - 0.04 * (highest - lowest), lowest + _ROOM * max(highest - lowest, 0.02))


def _draw_damped(axes: Axes, study: TrainStudy) -> None:
    """Thin, the same with the force of the dampers, running up, where that can be told apart."""
    up, label = study.up, "with the dampers' force"
    known = up.known
    if np.abs(up.damped - up.factors)[known].max() < _APART * np.ptp(up.factors[known]):
        return
    for mesh in range(len(up.mesh_names)):
        axes.plot(study.speeds, up.damped[:, mesh], ":", color=SERIES[mesh % len(SERIES)], linewidth=0.9, label=label)
        label = ""


def _draw_jumps(axes: Axes, study: TrainStudy, mesh: int) -> None:
    """An arrow from where a motion ends to where another takes over."""
    for chart, jumps, before in ((study.up, study.jumps[0], -1), (study.down, study.jumps[1], 1)):
        if chart is None:
            continue
        for jump in jumps:
            after = int(np.abs(chart.frequencies - jump).argmin())
            if not 0 <= after + before < len(study.speeds):
                continue
            start, end = ((float(study.speeds[i]), float(chart.factors[i, mesh])) for i in (after + before, after))
            axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": DARK, "linewidth": 1.0})


def shade_unstable(axes: Axes, speeds: Floats, chart: KvChart) -> None:
    """Ranges in which no periodic motion lasts."""
    label = "unstable"
    for start, end in speed_ranges(speeds, ~chart.stable):
        axes.axvspan(start, end, color=PALE, alpha=0.45, linewidth=0, label=label, zorder=0)
        label = ""


def mark_parting(axes: Axes, speeds: Floats, chart: KvChart, *, parting: bool) -> None:
    """A bar along the axis where flanks part, or would if they could."""
    label = "flanks part" if parting else "flanks would part"
    for start, end in speed_ranges(speeds, chart.apart):
        axes.plot([start, end], [0.012, 0.012], color=DARK, linewidth=3, transform=axes.get_xaxis_transform(), label=label)
        label = ""


def speed_ranges(speeds: Floats, marked: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Runs of marked speeds, each with half the way to its neighbours."""
    edges = np.concatenate([speeds[:1], (speeds[1:] + speeds[:-1]) / 2, speeds[-1:]])
    turns = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(int)))
    return [(float(edges[start]), float(edges[end])) for start, end in turns.reshape(-1, 2)]


def _mode_lines(study: TrainStudy) -> dict[float, tuple[str, str]]:
    """Name and colour of the speeds (rpm) at which tooth frequencies meet natural frequencies, or half of them."""
    # Where meshes have frequencies of their own, a line has the colour of the mesh that meets the mode there.
    several = len({mesh.frequency_ratio for mesh in study.excitation.meshes}) > 1
    found: dict[float, tuple[str, str]] = {}
    for each in study.mode_speeds:
        words = f"$f_{{{each.mode}}}$" + ("/2" if each.part == 2 else "")
        found.setdefault(round(each.speed, 6), (words, SERIES[each.mesh % len(SERIES)] if several else MARKED))
    return found


def mark_modes(axes: Axes, study: TrainStudy) -> None:
    """Thin lines where tooth frequencies meet natural ones, named where there is room."""
    first, last = axes.get_xlim()
    ends = [-math.inf, -math.inf]
    for speed, (words, colour) in sorted(_mode_lines(study).items()):
        if not first <= speed <= last:
            continue
        axes.axvline(speed, color=colour, linewidth=0.8, linestyle="--" if words.endswith("/2") else "-", zorder=0)
        row = next((row for row, end in enumerate(ends) if speed - end > _NEAR * (last - first)), None)
        if row is not None:
            ends[row] = speed
            place, across = (speed, 0.985 - 0.06 * row), axes.get_xaxis_transform()
            axes.annotate(words, place, (3, 0), across, "offset points", va="top", fontsize=8, color=DARK, bbox=_PAPER)


def finish_speeds(axes: Axes, study: TrainStudy) -> None:
    """The tooth frequency on a second axis, and a legend above it."""
    tooth_axis(axes, study)
    legend_above(axes, 3, raised=_TOP_AXIS)


def tooth_axis(axes: Axes, study: TrainStudy) -> None:
    """The tooth frequency on a second axis, above."""
    teeth = study.train.meshes[0].teeth
    functions = (lambda speed: np.asarray(speed) * teeth / 60, lambda hertz: np.asarray(hertz) * 60 / teeth)
    above = axes.secondary_xaxis("top", functions=functions)
    name = f" of {plain(study.train.meshes[0].name)}" if len(study.train.meshes) > 1 else ""
    above.set_xlabel(f"tooth frequency{name} in Hz")
    above.spines["top"].set_color(MARKED)


# ---------------------------------------------------------------------- one speed


def course_inches(study: TrainStudy) -> tuple[float, float]:
    """Return the size of a figure of the course."""
    return FIGURE_INCHES[0], 4.0 + 1.7 * bool(study.up.shaft_names)


def plot_course(study: TrainStudy, figure: Figure | None = None) -> Figure:
    """Approach of the flanks, force between them over the static one, and torques of the shafts over some tooth periods.

    The force is that of the springs, which K_v counts; thin, with that of the dampers.
    """
    of = new_figure(course_inches(study)) if figure is None else figure
    course, shafts = study.course, study.up.shaft_names
    panels = of.subplots(2 + bool(shafts), 1, sharex=True)
    each = [
        (course.approach, study.up.mesh_names, "approach in µm"),
        (course.spring_force / study.up.static_forces, study.up.mesh_names, "force / static one"),
        (course.shaft_torque, shafts, "shaft torque in N·m"),
    ]
    for panel, (values, names, words) in zip(panels, each, strict=False):
        prepared(panel, "", words)
        for number, (name, width) in enumerate(zip(names, layered(len(names)), strict=True)):
            turn, drawn = _repeated(course.turn, values[:, number])
            panel.plot(turn, drawn, color=SERIES[number % len(SERIES)], linewidth=width, label=plain(name))
        if len(names) > 1:
            panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    for number, force in enumerate((course.force / study.up.static_forces).T):
        colour = SERIES[number % len(SERIES)]
        panels[1].plot(*_repeated(course.turn, force), ":", color=colour, linewidth=0.8, zorder=1.5)
    panels[1].axhline(0, color=MARKED, linewidth=0.8)
    panels[1].axhline(1, color=MARKED, linewidth=0.8, linestyle="--")
    name = f" of {plain(study.up.mesh_names[0])}" if len(study.up.mesh_names) > 1 else ""
    panels[-1].set_xlabel(f"time in tooth periods{name}")
    panels[0].set_xlim(0, float(_repeated(course.turn, course.turn)[0][-1]))
    return of


def _repeated(turn: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return turns and values over several tooth periods of a curve with the period `turn`, with its first point again at the
    end.
    """
    step = float(turn[1] - turn[0])
    times = math.ceil(_LEAST_TEETH / (step * len(turn)))
    count = min(times * len(turn), round(_MOST_TEETH / step)) + 1
    return np.asarray(step * np.arange(count), float), np.resize(values, count)


def plot_cycle(cycle: MeshCycle, ax: Axes | None = None) -> Axes:
    """Mesh stiffness over one base pitch, secant and tangent, with the mean that the dynamics refer to."""
    axes = prepared(ax, "roll angle of the pinion in °, 0 at the pitch point", "mesh stiffness in N/µm")
    curves = [(cycle.tangent_stiffness, "tangent", "-"), (cycle.mesh_stiffness, "secant", "--")]
    if np.allclose(cycle.tangent_stiffness, cycle.mesh_stiffness, rtol=1e-9):
        curves = [(cycle.mesh_stiffness, "tangent and secant", "-")]
    for values, words, style in curves:
        axes.plot(cycle.roll_angle, values, color=SERIES[0], linewidth=1.5, linestyle=style, label=words)
    axes.axhline(cycle.tangent_mean, color=MARKED, linewidth=1.2, label="mean of the tangent")
    axes.set_xlim(float(cycle.roll_angle[0]), float(cycle.roll_angle[-1]))
    legend_above(axes, 3)
    return axes


_PANEL, _ABOVE = 2.3, 0.7
"""Inches of a panel, and of the axis above."""

_DISPLACEMENTS_WIDE = 50.0
"""Ratio of the greatest value to the median of those of all speeds above which an axis is logarithmic."""

Curve = Callable[[KvChart], Floats]


def displacement_inches(study: TrainStudy) -> tuple[float, float]:
    """Return the size of a figure of displacements."""
    return FIGURE_INCHES[0], _PANEL * (3 if study.up.bearings is not None else 2) + _ABOVE


def plot_displacements(study: TrainStudy, figure: Figure | None = None) -> Figure:
    """Draw the amplitudes of the inertias' turns, of the approach of the flanks, and of travels on bearings; running down
    dashed.
    """
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
    """Return the size of a figure of bearings."""
    return FIGURE_INCHES[0], 3.3 + _ABOVE


def plot_bearings(study: TrainStudy, figure: Figure | None = None) -> Figure:
    """Draw the greatest force on the bearings of each gear over speed, and at rest."""
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
    if drawn.size and drawn.min() > 0 and drawn.max() > _DISPLACEMENTS_WIDE * np.median(drawn):
        axes.set_yscale("log")
    else:
        axes.set_ylim(bottom=0)
    shade_unstable(axes, study.speeds, study.up)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)


def _finish(panels: Sequence[Axes], study: TrainStudy) -> None:
    """Label the speed axis below and the tooth frequency axis above, and draw lines where natural frequencies are met."""
    for panel in panels:
        panel.set_xlim(float(study.speeds[0]), float(study.speeds[-1]))
        mark_modes(panel, study)
    panels[-1].set_xlabel("speed of the pinion in rpm")
    tooth_axis(panels[0], study)


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
    _tooth_errors_set_height(axes, study, found)
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


def _tooth_errors_set_height(axes: Axes, study: TrainStudy, found: ErrorStudy) -> None:
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
