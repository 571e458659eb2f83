"""Campbell diagram of a train: what shakes it over speed, the natural frequencies, and which of these that excites."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.dynamics.planetary.campbell import CampbellLine, LineKind, PlanetaryCampbell
from gearcad.dynamics.planetary.modes import ModeFamily, ModeKind
from gearcad.planetary import PlanetaryTrain
from gearcad.plots.labels import plain
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, SERIES, new_figure, prepared, short
from gearcad.plots.planetary.callouts import spread
from gearcad.plots.planetary.parts import colour_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["CAMPBELL_INCHES", "KIND_COLOURS", "highest_drawn", "plot_train_campbell"]

CAMPBELL_INCHES = (FIGURE_INCHES[0], 5.4)

KIND_COLOURS = {
    ModeKind.ROTATIONAL: DARK,
    ModeKind.TRANSLATIONAL: SERIES[3],
    ModeKind.PLANET: SERIES[2],
    ModeKind.MIXED: "#56b4e9",
}
"""None of them is that of a mesh."""

_LETTERS = {ModeKind.ROTATIONAL: "R", ModeKind.TRANSLATIONAL: "T", ModeKind.PLANET: "P", ModeKind.MIXED: "M"}

_LEAST, _MOST = 3.0, 6.5
"""Diameters (points) of the dots where modes are excited, by their share."""

_ABOVE = 1.05
"""Of the highest natural frequency, up to where the picture goes."""

_NUMBERED = {True: 0.97, False: 0.9}
"""Of a line's length, where its number stands: above the line of the mesh that rises faster, below that of the other."""

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
    """Frequency (Hz) up to where the picture goes: the highest natural one, or what the lines reach if that is lower."""
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
