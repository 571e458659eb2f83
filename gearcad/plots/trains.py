"""Pictures of a train's natural modes, and of a train several times side by side."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gearcad.core.records import Floats
from gearcad.dynamics.level_verdict import LevelStudy
from gearcad.dynamics.options import OperatingRange
from gearcad.dynamics.response.kv_chart import KvChart
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.trains.members import GROUND, Shaft
from gearcad.dynamics.trains.train import Train
from gearcad.dynamics.trains.train_modes import NaturalModes
from gearcad.dynamics.variant_comparison import SideBySide
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, SERIES, layered, legend_above, new_figure, plain, prepared, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


MOST_SHAPES = 12
"""Largest number of modes that are drawn, the lowest first."""

_SHADES = {
    "inertia": ("#0072b2", "#56b4e9", "#00334f", "#9fd0ec", "#3d5a80", "#b8c9d9"),
    "shaft": ("#009e73", "#66c5ab", "#004d38", "#b3e2d5", "#5b8c2a", "#c5dba4"),
    "mesh": ("#d55e00", "#f0b27a", "#8a3d00", "#e69f00", "#f7dcc0", "#b5651d"),
}
"""Blue stores the motion of bodies, green is of shafts, orange of teeth."""

_GAP = 0.1
"""Share of all shafts' length that a mesh takes, so that the parts that it joins do not overlap."""

_WORD = 0.018
"""Share of a bar (of 1) that one letter takes."""

_LETTER = 0.011
"""Part of the figure's width that a letter below a panel takes."""

_LETTERS = 30
"""Greatest number of letters of all names along the train below a panel of half the width."""

_Node = tuple[str, str]
"""Node of a train: ("inertia", name), or ("ground", name of the shaft that ends there)."""


_BETWEEN, _LEAST_PLACES = 8, 4
"""Steps of a shape that is drawn from one place where it is known to the next; fewer places are joined by lines."""


class _Way(NamedTuple):
    """A train laid out along x: `places` of inertias and of ends of shafts in the ground, in the length of shafts."""

    places: dict[_Node, float]
    shafts: list[tuple[Shaft, _Node, _Node]]


# ---------------------------------------------------------------------- shapes


def shapes_inches(train: Train, modes: NaturalModes) -> tuple[float, float]:
    """Return the size of a figure of all shapes."""
    rows = math.ceil(min(len(modes), MOST_SHAPES) / _columns(train, modes))
    return FIGURE_INCHES[0], 0.9 + 1.35 * rows


def plot_shapes(train: Train, modes: NaturalModes, figure: Figure | None = None) -> Figure:
    """Draw a panel per mode, of the first twelve: the turn along the train, its greatest 1, with a jump at every mesh."""
    of = new_figure(shapes_inches(train, modes)) if figure is None else figure
    count, columns, way = min(len(modes), MOST_SHAPES), _columns(train, modes), _laid_out(train, modes)
    rows = math.ceil(count / columns)
    panels = of.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
    for mode, panel in enumerate(panels[:count]):
        _draw_shape(panel, train, modes, mode, way)
    panels[0].set_ylim(-1.25, 1.25)
    panels[0].margins(x=0.05 if way.shafts else 0.25)
    panels[0].set_yticks([-1, 0, 1])
    panels[0].set_xticks([])
    for number, panel in enumerate(panels):
        panel.set_visible(number < count)
        if number < count <= number + columns:
            _name_places(panel, train, way, _LETTER * columns)
    of.supylabel("turn, the greatest of a mode is 1", fontsize=9)
    return of


def _columns(train: Train, modes: NaturalModes) -> int:
    return 2 if len(modes) > 1 and sum(map(len, (*modes.inertias, *modes.shafts))) <= _LETTERS else 1


def _draw_shape(axes: Axes, train: Train, modes: NaturalModes, mode: int, way: _Way) -> None:
    prepared(axes, "", "")
    axes.grid(False, axis="x")
    axes.axhline(0, color=MARKED, linewidth=0.7)
    along, shapes = _finely(modes, mode)
    scale = 1 / np.abs(np.concatenate([modes.shape[mode], shapes.ravel()])).max()
    turn = {("inertia", name): scale * each for name, each in zip(modes.inertias, modes.shape[mode].tolist(), strict=True)}
    for node, place in way.places.items():
        axes.axvline(place, color="#dddddd", linewidth=0.6, zorder=0)
        axes.plot(place, turn.get(node, 0.0), "o" if node in turn else "|", color=DARK, markersize=5 if node in turn else 9)
    for (_, start, end), shape in zip(way.shafts, shapes, strict=True):
        x = way.places[start] + along * (way.places[end] - way.places[start])
        axes.plot(x, scale * shape, color=SERIES[0], linewidth=1.6, zorder=1)
    for mesh in train.meshes:
        ends: list[_Node] = [("inertia", mesh.pinion), ("inertia", mesh.wheel)]
        axes.plot([way.places[end] for end in ends], [turn[end] for end in ends], color=SERIES[1], linewidth=1.2, linestyle=":")
    axes.set_title(_title(modes, mode), fontsize=8, loc="left", pad=3)


def _finely(modes: NaturalModes, mode: int) -> tuple[Floats, Floats]:
    """Return the places (q,) along every shaft, those of the modes and more between, and the turns (s, q) there.

    Half waves have few places where they are many: lines between these would cut their tops.
    """
    if len(modes.places) < _LEAST_PLACES:
        return modes.places, modes.shaft_shape[mode]
    from scipy.interpolate import CubicSpline

    parts = np.arange(_BETWEEN * (len(modes.places) - 1) + 1) / _BETWEEN
    along = np.interp(parts, np.arange(len(modes.places)), modes.places)
    return along, CubicSpline(modes.places, modes.shaft_shape[mode].T)(along).T


def _title(modes: NaturalModes, mode: int) -> str:
    if mode < modes.rigid:
        return f"{mode + 1}: 0 Hz, turns as a whole"
    speeds = list(dict.fromkeys(short(speed) for speed in modes.rpm[mode]))
    words = f"; met at {' / '.join(speeds)} rpm" if speeds else ""
    return f"{mode + 1}: {short(modes.frequency[mode])} Hz, {short(modes.circular[mode])} 1/s{words}"


def _name_places(axes: Axes, train: Train, way: _Way, letter: float) -> None:
    """Inertias below their places, gears on their own side of the mesh; shafts below those. Rows as many as have room.

    `letter` is the width of one, in parts of the axis.
    """
    first, last = axes.get_xlim()
    across, row = axes.get_xaxis_transform(), 0
    for labels, colour in ((_gears(train, way), DARK), (_middles(way), SERIES[0])):
        ends: list[float] = []
        for place, words, side in sorted(labels):
            width = letter * len(words) * (last - first)
            start = place - {"left": 0.0, "center": 0.5, "right": 1.0}[side] * width
            free = next((number for number, end in enumerate(ends) if end < start), len(ends))
            ends[free : free + 1] = [start + width]
            offset = (0, -4 - 12 * (row + free))
            axes.annotate(
                plain(words), (place, 0), offset, across, "offset points", ha=side, va="top", fontsize=8, color=colour
            ).set_annotation_clip(False)
        row += len(ends)


def _gears(train: Train, way: _Way) -> list[tuple[float, str, str]]:
    """Place, names and side of all inertias."""
    names: dict[float, list[str]] = {}
    for (kind, name), place in way.places.items():
        if kind == "inertia":
            names.setdefault(round(place, 9), []).append(name)
    mates = [(mesh.pinion, mesh.wheel) for mesh in train.meshes]
    found = []
    for place, here in names.items():
        there = [way.places["inertia", other] for each in mates for name, other in (each, each[::-1]) if name in here]
        right, left = (any(sign * (other - place) > 0 for other in there) for sign in (1, -1))
        side = "center" if right == left or not way.shafts else "right" if right else "left"
        found.append((place, " / ".join(here), side))
    return found


def _middles(way: _Way) -> list[tuple[float, str, str]]:
    return [((way.places[start] + way.places[end]) / 2, shaft.name, "center") for shaft, start, end in way.shafts]


def _laid_out(train: Train, modes: NaturalModes) -> _Way:
    """Every place is as far along x as the shortest way to it from one end of the train is long."""
    shafts = [(each, _node(each, each.start), _node(each, each.end)) for each in train.shafts if each.name in modes.shafts]
    known = [shaft.length for shaft, _, _ in shafts if shaft.length is not None]
    unit = sum(known) / len(known) if known else 1.0
    lengths = [shaft.length if shaft.length is not None else unit for shaft, _, _ in shafts]
    gap = _GAP * sum(lengths) if lengths else unit
    ways: dict[_Node, dict[_Node, float]] = {("inertia", name): {} for name in modes.inertias}
    joined = [(start, end, length) for (_, start, end), length in zip(shafts, lengths, strict=True)]
    joined += [(("inertia", mesh.pinion), ("inertia", mesh.wheel), gap) for mesh in train.meshes]
    for start, end, length in joined:
        for one, other in ((start, end), (end, start)):
            ways.setdefault(one, {})[other] = length
    places: dict[_Node, float] = {}
    for node in ways:
        if node not in places:
            one = _farthest(_distances(ways, node))
            other = _farthest(_distances(ways, one))
            # Whichever end was written down first is on the left.
            piece = _distances(ways, min(one, other, key=list(ways).index))
            begin = max(places.values()) + gap if places else 0.0
            places |= {each: begin + far for each, far in piece.items()}
    return _Way(places, shafts)


def _node(shaft: Shaft, end: str) -> _Node:
    return ("ground", shaft.name) if end == GROUND else ("inertia", end)


def _distances(ways: dict[_Node, dict[_Node, float]], start: _Node) -> dict[_Node, float]:
    """Return the distances from one node to all connected nodes, the nearest first (Dijkstra)."""
    found: dict[_Node, float] = {}
    waiting = [(0.0, start)]
    while waiting:
        far, node = heapq.heappop(waiting)
        if node not in found:
            found[node] = far
            for there, length in ways[node].items():
                heapq.heappush(waiting, (far + length, there))
    return found


def _farthest(distances: dict[_Node, float]) -> _Node:
    return max(distances, key=lambda node: distances[node])


# ---------------------------------------------------------------------- energies


def energies_inches(modes: NaturalModes) -> tuple[float, float]:
    """Return the size of a figure of all energies."""
    return FIGURE_INCHES[0], 1.4 + 0.32 * len(modes)


def plot_energies(modes: NaturalModes, figure: Figure | None = None) -> Figure:
    """Draw the shares of the parts in the kinetic energy of every mode, on the left,
    and in the potential energy, on the right.
    """
    of = new_figure(energies_inches(modes)) if figure is None else figure
    left, right = of.subplots(1, 2, sharey=True)
    kinetic = [("inertia", modes.inertias, modes.kinetic_inertias), ("shaft", modes.shafts, modes.kinetic_shafts)]
    potential = [("shaft", modes.shafts, modes.potential_shafts), ("mesh", modes.meshes, modes.potential_meshes)]
    known: dict[str, Any] = {}
    for axes, title, parts in ((left, "kinetic energy", kinetic), (right, "potential energy", potential)):
        prepared(axes, "share in %", "")
        axes.grid(False, axis="y")
        axes.set_title(title, fontsize=10, loc="left")
        known |= _stack(axes, parts)
    left.set_yticks(range(len(modes)), [f"{number}: {short(each)} Hz" for number, each in enumerate(modes.frequency, 1)])
    left.set_ylim(len(modes) - 0.5, -0.5)
    left.set_xlim(0, 100)
    right.set_xlim(0, 100)
    for mode in range(modes.rigid):
        right.text(2, mode, "none: turns as a whole", va="center", fontsize=8, color=DARK)
    of.legend(known.values(), known.keys(), loc="outside upper left", ncols=4, frameon=False, fontsize=8)
    return of


def _stack(axes: Axes, parts: Sequence[tuple[str, Sequence[str], Floats]]) -> dict[str, Any]:
    """Bars, with the name where it has room; handles of the legend by the part's words. Parts without energy are left out."""
    known: dict[str, Any] = {}
    height = max(len(shares) for _, _, shares in parts)
    below = np.zeros(height)
    for kind, names, shares in parts:
        for number, (name, share) in enumerate(zip(names, shares.T, strict=True)):
            if not share.any():
                continue
            colour = _SHADES[kind][number % len(_SHADES[kind])]
            bars = axes.barh(range(height), 100 * share, left=100 * below, height=0.7, color=colour, edgecolor="white")
            words = plain(name)
            known[f"{kind} {words}" if kind not in name else words] = bars
            for mode in np.flatnonzero(share > _WORD * (len(words) + 2)):
                _name_bar(axes, 100 * (below[mode] + share[mode] / 2), int(mode), words, colour)
            below += share
    return known


def _name_bar(axes: Axes, place: float, mode: int, words: str, colour: str) -> None:
    red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    dark = 0.299 * red + 0.587 * green + 0.114 * blue < 140
    axes.text(place, mode, words, ha="center", va="center", fontsize=7, color="white" if dark else DARK)


_SPEED, _FACTOR = "speed of the pinion in rpm", "$K_{\\mathrm{v}}$"
_Curve = Callable[[TrainStudy, KvChart, str], Floats | None]

_PANEL, _ABOVE, _ROW = 2.9, 0.5, 4
"""Inches of a panel, and of axis and legend; studies in a row of the legend."""

_SHORT = 20
"""Letters of a title of which so many stand in a row."""

_WIDE = 20.0
"""Ratio of greatest to least value above which the axis is logarithmic."""


def beside_inches(panels: int, studies: int) -> tuple[float, float]:
    """Return the size of a figure with a panel for each mesh or shaft."""
    return FIGURE_INCHES[0], _PANEL * panels + _ABOVE + 0.2 * -(-studies // _ROW)


def study_colours(count: int) -> list[str]:
    """Return a colour for each study; from light to dark, in their order, where there are many."""
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
    """Draw the greatest torque of every shaft over its static one, a panel each, a colour for each study that has the shaft."""

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
    """Draw a panel for each name, with the values of `curve` for each chart of each study; None leaves a curve out."""
    drawn = figure or new_figure(beside_inches(len(names), len(of.studies)))
    panels = drawn.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    for panel, name in zip(panels, names, strict=True):
        _draw(of, panel, name, _SPEED if panel is panels[-1] else "", words, curve)
    legend_above(panels[0], _legend_columns(of))
    return drawn


def _draw(of: SideBySide, panel: Axes, name: str, below: str, words: str, curve: _Curve) -> None:
    """Draw the values of `curve` for one name in each chart of each study, over speed."""
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
    """Mark both ends of the operating range if the chart continues beyond them."""
    for end in (over.first, over.last):
        if axes.get_xlim()[0] < end < axes.get_xlim()[1]:
            axes.axvline(end, color=MARKED, linewidth=1.0, linestyle="--")


def _set_scale(axes: Axes, values: Floats) -> None:
    """Logarithmic where values are far apart."""
    if values.max() > _WIDE * max(values.min(), 1.0) and values.min() > 0:
        axes.set_yscale("log")
