"""Pictures of a planetary train that vibrates: modes, Campbell diagram, loads over speed, quasi-static run."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.core.records import Floats
from gearcad.dynamics.planetary.gyroscopic_modes import GyroscopicModes
from gearcad.dynamics.planetary.planetary_modes import (
    CampbellLine,
    LineKind,
    ModeFamily,
    ModeKind,
    PlanetaryCampbell,
    PlanetaryModes,
)
from gearcad.dynamics.planetary.planetary_response import PlanetaryResponse
from gearcad.dynamics.planetary.quasi_static_run import Running
from gearcad.planetary import PlanetaryTrain
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, SERIES, legend_above, new_figure, plain, prepared, short
from gearcad.plots.planetary import PLANETS, colour_of, spread
from gearcad.plots.speeds import mark_parting, shade_unstable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


MOST_MODES = 12
"""Frequencies whose modes are drawn, the lowest that are not 0."""

_COLUMNS = 4

_MOVED = 0.22
"""Greatest travel that is drawn, in centre distances."""

_SPOKES = 4
"""Marks on a body, which show how far it turns."""


class _Body(NamedTuple):
    """A body of the drawing: rest place (2,), travel (2,), turn (rad), radius, colour, and whether marks reach its middle."""

    place: Floats
    travel: Floats
    turn: float
    radius: float
    colour: str
    open: bool


def shown_families(modes: PlanetaryModes) -> list[ModeFamily]:
    """Return the frequencies whose modes are drawn."""
    return [family for family in modes.families if family.frequency > 0][:MOST_MODES]


def modes_inches(modes: PlanetaryModes) -> tuple[float, float]:
    """Return the size of the picture."""
    rows = math.ceil(len(shown_families(modes)) / _COLUMNS)
    return FIGURE_INCHES[0], 1.95 * rows


def mode_title(family: ModeFamily) -> str:
    """Return a title such as "3: 1892 Hz, T, twice"."""
    many = {1: "", 2: ", twice"}.get(family.multiplicity, f", {family.multiplicity} times")
    return f"{family.first + 1}: {short(family.frequency)} Hz\n{family.kind.value}{many}"


def plot_modes(train: PlanetaryTrain, modes: PlanetaryModes, figure: Figure | None = None) -> Figure:
    """Draw a panel for each frequency, with the first of its modes: at rest pale, displaced in colour, much enlarged."""
    of = new_figure(modes_inches(modes)) if figure is None else figure
    families = shown_families(modes)
    panels = of.subplots(math.ceil(len(families) / _COLUMNS), _COLUMNS, squeeze=False).ravel()
    for panel in panels:
        panel.set_axis_off()
    for panel, family in zip(panels, families, strict=False):
        bodies = list(_bodies(train, modes, family.first))
        reach = max(float(np.hypot(*body.place)) + body.radius for body in bodies)
        _draw_carrier(panel, train, bodies)
        for body in bodies[1:]:
            _draw_body(panel, body)
        panel.set_aspect("equal")
        panel.set_xlim(-1.22 * reach, 1.22 * reach)
        panel.set_ylim(-1.22 * reach, 1.22 * reach)
        panel.set_title(mode_title(family), fontsize=8, pad=2)
    return of


def _bodies(train: PlanetaryTrain, modes: PlanetaryModes, mode: int) -> Iterator[_Body]:
    """Carrier, centrals and planets, displaced; lengths in mm."""
    shape, turns = modes.shape[mode], modes.turns[mode]
    distance = float(train.centre_distance)
    scale = _MOVED * distance / max(float(np.hypot(shape[:, 0], shape[:, 1]).max()), float(np.abs(shape[:, 2]).max()))
    members = modes.springs.members
    for name, (x, y, _), turn in zip(members, shape, turns, strict=False):
        mesh = next((each for each in train.meshes if each.central.name == name), None)
        radius = distance if mesh is None else abs(mesh.pair.working_pitch_diameters.pick(mesh.central_role)) / 2
        ring = mesh is not None and not mesh.external
        # Turns are scaled as lengths at the radius by which they count: mm on paper over m, so 1e-3.
        yield _Body(np.zeros(2), scale * np.array([x, y]), scale * turn * 1e-3, radius, colour_of(train, name), ring)
    mesh = train.meshes[0]
    radius = abs(mesh.pair.working_pitch_diameters.pick(mesh.rim_role)) / 2
    for angle, (outwards, along, _), turn in zip(modes.springs.planar.angles, shape[3:], turns[3:], strict=True):
        out, on = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        yield _Body(distance * out, scale * (outwards * out + along * on), scale * turn * 1e-3, radius, PLANETS, False)


def _draw_body(axes: Axes, body: _Body) -> None:
    from matplotlib.patches import Circle

    moved = body.place + body.travel
    axes.add_patch(Circle(tuple(body.place), body.radius, fill=False, edgecolor=MARKED, linewidth=0.5, linestyle=":"))
    axes.add_patch(Circle(tuple(moved), body.radius, fill=False, edgecolor=body.colour, linewidth=1.2))
    for spoke in range(_SPOKES):
        rest = 2 * math.pi * spoke / _SPOKES
        inner = 0.82 * body.radius if body.open else 0.0
        _draw_mark(axes, body.place, rest, (inner, body.radius), MARKED, 0.5)
        _draw_mark(axes, moved, rest + body.turn, (inner, body.radius), body.colour, 1.0)


def _draw_mark(axes: Axes, place: Floats, angle: float, radii: tuple[float, float], colour: str, width: float) -> None:
    direction = np.array([math.cos(angle), math.sin(angle)])
    ends = place + np.outer(radii, direction)
    axes.plot(*ends.T, color=colour, linewidth=width)


def _draw_carrier(axes: Axes, train: PlanetaryTrain, bodies: list[_Body]) -> None:
    """Arms to the pins, which stay on the carrier: planets move away from them as pins bend."""
    carrier = bodies[0]
    for planet in bodies[3:]:
        angle = math.atan2(planet.place[1], planet.place[0])
        _draw_mark(axes, carrier.place, angle, (0.0, carrier.radius), MARKED, 0.5)
        _draw_mark(axes, carrier.place + carrier.travel, angle + carrier.turn, (0.0, carrier.radius), carrier.colour, 1.6)


CAMPBELL_INCHES = (FIGURE_INCHES[0], 5.4)

KIND_COLOURS = {
    ModeKind.ROTATIONAL: DARK,
    ModeKind.TRANSLATIONAL: SERIES[3],
    ModeKind.PLANET: SERIES[2],
    ModeKind.MIXED: "#56b4e9",
}
"""Colours of the kinds of modes; none of them is that of a mesh."""

_LETTERS = {ModeKind.ROTATIONAL: "R", ModeKind.TRANSLATIONAL: "T", ModeKind.PLANET: "P", ModeKind.MIXED: "M"}

_LEAST, _MOST = 3.0, 6.5
"""Diameters (points) of the dots where modes are excited, by their share."""

_ABOVE = 1.05
"""Upper end of the picture, as a multiple of the highest natural frequency."""

_NUMBERED = {True: 0.97, False: 0.9}
"""Place of a line's number, as a share of its length: above the line of the mesh that rises faster, below the other."""

_ROW = 0.14
"""Inches between the numbers of natural frequencies beside the picture."""


def plot_train_campbell(train: PlanetaryTrain, campbell: PlanetaryCampbell, ax: Axes | None = None) -> Axes:
    """Harmonics of meshes over the input's speed across the natural frequencies, by kinds; dots where a mode is excited.

    The larger a dot, the more of what the meshes could do to the mode they do. Crosses: met, but the planets take each other
    off. Lines of stages, of planets that pass and that turn are thin and not judged.
    """
    empty = new_figure(CAMPBELL_INCHES).subplots() if ax is None else ax
    axes = prepared(empty, f"speed of {plain(train.input)} in rpm", "frequency in Hz")
    highest = highest_drawn(campbell)
    families = [family for family in campbell.families if 0 < family.frequency <= highest]
    axes.set_xlim(0, campbell.highest_speed)
    axes.set_ylim(0, highest)
    axes.grid(False)
    for family in families:
        axes.axhline(family.frequency, color=KIND_COLOURS[family.kind], linewidth=1.0, alpha=0.8)
    for line in campbell.lines:
        _draw_line(axes, train, line, campbell, highest)
    for met in campbell.resonances:
        colour = KIND_COLOURS[campbell.families[met.family].kind]
        if met.excited:
            size = _LEAST + (_MOST - _LEAST) * (met.share or 0.0)
            axes.plot(met.speed, met.frequency, "o", color=colour, markersize=size, zorder=4, clip_on=False)
        elif met.excited is False:
            axes.plot(met.speed, met.frequency, "x", color=MARKED, markersize=4, zorder=3)
    _name_families(axes, families, highest)
    _mark_load(axes, campbell)
    _explain(axes, train, campbell)
    return axes


def highest_drawn(campbell: PlanetaryCampbell) -> float:
    """Return the frequency (Hz) up to where the picture goes: the highest natural one, or what the lines reach if that is
    lower.
    """
    natural = [family.frequency for family in campbell.families if family.frequency > 0]
    reached = max((line.per_rpm for line in campbell.lines), default=0.0) * campbell.highest_speed
    return _ABOVE * min(max(natural, default=1.0), max(reached, min(natural, default=1.0)))


def _draw_line(axes: Axes, train: PlanetaryTrain, line: CampbellLine, campbell: PlanetaryCampbell, highest: float) -> None:
    """A line from standstill to where it leaves the picture, its harmonic there."""
    end = min(campbell.highest_speed, highest / line.per_rpm)
    colour, style, width = _style(train, line)
    axes.plot([0, end], [0, line.per_rpm * end], color=colour, linestyle=style, linewidth=width, zorder=2)
    if line.kind is LineKind.MESH:
        rest = [each.per_rpm for each in campbell.lines if each.kind is LineKind.MESH and each.harmonic == line.harmonic]
        # Of meshes of one frequency, the first has its numbers above.
        above = line.per_rpm == max(rest) and (min(rest) < max(rest) or line.source == train.meshes[0].name)
        _number(axes, line, _NUMBERED[above] * end, above=above, colour=colour)


def _number(axes: Axes, line: CampbellLine, speed: float, *, above: bool, colour: str) -> None:
    """The harmonic of a line at a speed, in the colour of its mesh, on that side of the rising line which it does not cross."""
    from matplotlib.patheffects import withStroke

    axes.annotate(
        str(line.harmonic),
        (speed, line.per_rpm * speed),
        (-1, 1) if above else (1, -1),
        textcoords="offset points",
        ha="right" if above else "left",
        va="bottom" if above else "top",
        fontsize=7.5,
        color=colour,
        path_effects=[withStroke(linewidth=2.0, foreground="white")],
        zorder=5,
    )


def _mark_load(axes: Axes, campbell: PlanetaryCampbell) -> None:
    """An upright line at the speed of the load, which is written beside it."""
    from matplotlib.patheffects import withStroke

    speed = campbell.speed
    if speed is None or speed > campbell.highest_speed:
        return
    axes.axvline(speed, color=DARK, linewidth=1.2, zorder=3)
    axes.annotate(
        f"load: {short(speed)} rpm",
        (speed, 1.0),
        (-3, -4),
        axes.get_xaxis_transform(),
        "offset points",
        rotation=90,
        ha="right",
        va="top",
        fontsize=8,
        color=DARK,
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
        zorder=5,
    )


_Dashes = str | tuple[int, tuple[int, int]]


def _style(train: PlanetaryTrain, line: CampbellLine) -> tuple[str, _Dashes, float]:
    """Colour, dashes and width of a line."""
    styles: tuple[_Dashes, _Dashes] = ("-", (0, (5, 5)))
    for mesh, style in zip(train.meshes, styles, strict=True):
        if line.kind is LineKind.MESH and mesh.name == line.source:
            # Dashed on whole, as both meshes of planets with one rim have the same frequency.
            return colour_of(train, mesh.central.name), style, 1.2 if line.harmonic == 1 else 0.7
    return MARKED, {LineKind.STAGE: "-.", LineKind.PASS: "--"}.get(line.kind, ":"), 0.7


def _name_families(axes: Axes, families: list[ModeFamily], highest: float) -> None:
    """Kind and number of the first mode at the right end of each natural frequency, apart where these are close."""
    inches = (CAMPBELL_INCHES[1] - 1.4) / highest
    placed = spread([family.frequency * inches for family in families], [_ROW - 0.02] * len(families), gap=0.02)
    across = axes.get_yaxis_transform()
    for family, height in zip(families, placed, strict=True):
        many = f" ×{family.multiplicity}" if family.multiplicity > 1 else ""
        axes.annotate(
            f"{family.first + 1} {_LETTERS[family.kind]}{many}",
            (1.0, family.frequency),
            (1.03, height / inches),
            across,
            across,
            arrowprops={"arrowstyle": "-", "color": MARKED, "linewidth": 0.5, "shrinkA": 0, "shrinkB": 0, "relpos": (0, 0.5)},
            va="center",
            fontsize=7.5,
            color=KIND_COLOURS[family.kind],
            annotation_clip=False,
        )


def _explain(axes: Axes, train: PlanetaryTrain, campbell: PlanetaryCampbell) -> None:
    """The legend: lines of meshes by their colours, other lines by their kinds."""
    from matplotlib.lines import Line2D

    first: dict[str, CampbellLine] = {}
    for line in campbell.lines:
        name = line.source if line.kind in (LineKind.MESH, LineKind.STAGE) else line.kind.value
        first.setdefault(name, line)
    handles = []
    for name, line in first.items():
        colour, style, width = _style(train, line)
        handles.append(Line2D([], [], color=colour, linestyle=style, linewidth=width, label=plain(name)))
    handles.append(Line2D([], [], color=DARK, marker="o", markersize=6, linestyle="none", label="excited"))
    if any(met.excited is False for met in campbell.resonances):
        handles.append(Line2D([], [], color=MARKED, marker="x", markersize=4, linestyle="none", label="met, but not excited"))
    axes.legend(
        handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4, frameon=False, fontsize=8, borderaxespad=0.2
    )


GYROSCOPIC_INCHES = (FIGURE_INCHES[0], 4.2)


def plot_gyroscopic(train: PlanetaryTrain, modes: GyroscopicModes, ax: Axes | None = None) -> Axes:
    """Draw the change of the natural frequencies over the speed of the carrier, in the frame of the carrier, by kinds."""
    empty = new_figure(GYROSCOPIC_INCHES).subplots() if ax is None else ax
    axes = prepared(empty, f"speed of {plain(train.carrier.name)} in rpm", "change of frequency in Hz")
    told: set[ModeKind] = set()
    for kind, frequency in zip(modes.kinds, modes.frequency.T, strict=True):
        label = "" if kind in told else kind.value
        axes.plot(modes.speed, frequency - frequency[0], color=KIND_COLOURS[kind], linewidth=1.0, label=label)
        told.add(kind)
    if modes.operating:
        axes.axvline(modes.operating, color=DARK, linewidth=1.2, linestyle="--", label="load")
    axes.set_xlim(0, float(modes.speed[-1]))
    legend_above(axes, 5)
    return axes


RESPONSE_INCHES = (FIGURE_INCHES[0], 4.2)


def plot_response(response: PlanetaryResponse, ax: Axes | None = None) -> Axes:
    """Draw the greatest dynamic load factor of all planets of each mesh, running up and, if different, running down.

    Shaded: motions that do not last. The bar below: flanks part at some time of the period.
    """
    train = response.train
    empty = new_figure(RESPONSE_INCHES).subplots() if ax is None else ax
    axes = prepared(empty, f"speed of {plain(train.input)} in rpm", "greatest force over that at rest")
    for mesh in train.meshes:
        colour, factors = colour_of(train, mesh.central.name), response.factors[mesh.name]
        axes.plot(response.speeds, factors.max(axis=1), color=colour, linewidth=1.3, label=plain(mesh.name))
    if response.down is not None:
        for number, mesh in enumerate(train.meshes):
            own = slice(number * train.planets, (number + 1) * train.planets)
            down = response.down.factors[:, own].max(axis=1)
            words = plain(f"{mesh.name}, running down")
            colour = colour_of(train, mesh.central.name)
            axes.plot(response.speeds, down, color=colour, linewidth=1.0, linestyle="--", label=words)
    shade_unstable(axes, response.speeds, response.up)
    mark_parting(axes, response.speeds, response.up, parting=response.excitation.parting)
    if response.load.speed:
        axes.axvline(abs(response.load.speed), color=DARK, linewidth=0.9, linestyle="-.", label="speed of the load")
    axes.axhline(1.0, color=MARKED, linewidth=0.8)
    axes.margins(x=0)
    legend_above(axes, 3)
    return axes


RUNNING_INCHES = (FIGURE_INCHES[0], 4.8)

_BANDS = 300
"""Largest number of pieces of a long run, each drawn from its least to its greatest value."""

_PITCHES = 6.0
"""Number of base pitches that are drawn in detail, fewer if the run is shorter."""

_SHADES = ("#cc79a7", "#0072b2", "#009e73", "#d55e00", "#56b4e9", "#e69f00")
"""Colours of planets; they repeat if there are more planets."""

_ARCSECONDS = 3600.0

_LEVEL = 5e-3
"""Half of the least range of an axis, as a share of the value in its middle."""


def shown_pitches(running: Running) -> float:
    """Base pitches of the first mesh that are drawn close by."""
    return min(_PITCHES, float(running.rolled[-1]))


def plot_running(running: Running, figure: Figure | None = None) -> Figure:
    """Plot the shares of the planets above, the twist below: on the left the whole run, on the right its first base pitches."""
    of = new_figure(RUNNING_INCHES) if figure is None else figure
    panels = of.subplots(2, 2, sharey="row", sharex="col", width_ratios=(1.2, 1))
    near = running.rolled <= shown_pitches(running) + 1e-9
    name = running.train.meshes[0].name
    turn, sense = np.abs(running.carrier_angle), ", clockwise" if running.carrier_angle[-1] < 0 else ""
    for row, (curves, slow, words) in enumerate(_rows(running)):
        prepared(panels[row, 0], "" if row == 0 else f"turn of {running.train.carrier.name} in °{sense}", words)
        prepared(panels[row, 1], "" if row == 0 else f"base pitches of {name}".replace("$", r"\$"), "")
        for number, (curve, mean) in enumerate(zip(curves, slow, strict=True)):
            colour = _SHADES[number % len(_SHADES)] if row == 0 else SERIES[0]
            _draw_band(panels[row, 0], turn, curve, colour)
            panels[row, 1].plot(running.rolled[near], curve[near], color=colour, linewidth=1.2, label=f"planet {number + 1}")
            panels[row, 1].plot(running.rolled[near], mean[near], color=MARKED, linewidth=0.8, linestyle="--")
        for panel in panels[row]:
            panel.margins(x=0)
        _widen(panels[row, 0])
    if len(running.shares) <= len(_SHADES):
        found = panels[0, 1].get_legend_handles_labels()
        panels[0, 0].legend(*found, loc="lower left", bbox_to_anchor=(0, 1), ncols=3, frameon=False, fontsize=8)
    return of


def _widen(axes: Axes) -> None:
    """Room above and below curves that are level but for rounding."""
    low, high = axes.get_ylim()
    middle, half = (low + high) / 2, (high - low) / 2
    if half < _LEVEL * abs(middle):
        axes.set_ylim(middle - _LEVEL * abs(middle), middle + _LEVEL * abs(middle))


def _rows(running: Running) -> tuple[tuple[Floats, Floats, str], tuple[Floats, Floats, str]]:
    """Return the curves, the same without what the meshes do, and their words."""
    twist = (np.atleast_2d(each) * _ARCSECONDS for each in (running.twist, running.slow_twist))
    return (running.shares, running.slow_shares, "share of a planet"), (*twist, "twist in arcsec")  # type: ignore[return-value]


def _draw_band(axes: Axes, turn: Floats, values: Floats, colour: str) -> None:
    """A curve; of one with many places the band between the least and the greatest of each piece."""
    if len(values) <= 4 * _BANDS:
        axes.plot(turn, values, color=colour, linewidth=0.9)
        return
    starts = np.linspace(0, len(values), _BANDS, endpoint=False).astype(int)
    low, high = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    axes.fill_between(turn[starts], low, high, color=colour, linewidth=0.4, alpha=0.6)
