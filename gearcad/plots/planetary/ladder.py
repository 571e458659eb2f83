"""The lever of a set: speeds of its members and of its planets, which lie on one line."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from gearcad.planetary import PlanetaryTrain
from gearcad.plots.labels import plain
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, new_figure, prepared, short
from gearcad.plots.planetary.callouts import LINE, lines_of, spread
from gearcad.plots.planetary.parts import PLANETS, colour_of, role_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["lever_places", "plot_ladder"]


def lever_places(train: PlanetaryTrain) -> dict[str, float]:
    """How far from the carrier members and "planets" stand on the lever, that of the first central being 1.

    Speeds against the carrier are as these: (w_b - w_c)/(w_a - w_c) = 1/i_0, and (w_p - w_c)/(w_a - w_c) = -z_a/z_2.
    """
    first, second = train.meshes
    planet = -first.central.gear.teeth / first.rim.gear.teeth
    return {first.central.name: 1.0, second.central.name: 1 / train.basic_ratio, train.carrier.name: 0.0, "planets": planet}


def plot_ladder(train: PlanetaryTrain, speeds: Mapping[str, float], planet: float, unit: str, ax: Axes | None = None) -> Axes:
    """Speeds of members by name and of a planet, in a unit: rungs from standstill to the line that all of them are on."""
    axes = prepared(new_figure().subplots() if ax is None else ax, f"speed in {unit}", "")
    places = lever_places(train)
    found = {name: speeds[name] for name in train.members} | {"planets": planet}
    colours = {name: colour_of(train, name) for name in train.members} | {"planets": PLANETS}
    ends = sorted(places, key=lambda name: places[name])
    axes.plot([found[ends[0]], found[ends[-1]]], [places[ends[0]], places[ends[-1]]], color=DARK, linewidth=1.0, zorder=2)
    axes.axvline(0.0, color=MARKED, linewidth=0.8)
    for name, place in places.items():
        axes.plot([0.0, found[name]], [place, place], color=colours[name], linewidth=2.0, solid_capstyle="butt", zorder=3)
        axes.plot(found[name], place, "o", color=colours[name], markersize=6, zorder=4)
    axes.set_yticks([])
    axes.grid(False, axis="y")
    axes.spines["left"].set_visible(False)
    axes.margins(x=0.06, y=0.12)
    axes.autoscale(axis="x", enable=True)
    right = axes.get_xlim()[1]
    axes.hlines(list(places.values()), [found[name] for name in places], right, color=MARKED, linewidth=0.6, zorder=1)
    axes.set_xlim(right=right)
    _name(axes, train, places, found)
    return axes


def _name(axes: Axes, train: PlanetaryTrain, places: Mapping[str, float], speeds: Mapping[str, float]) -> None:
    """Names beside their rungs, apart where these are near each other."""
    low, high = axes.get_ylim()
    inches = (FIGURE_INCHES[1] - 0.7) / (high - low)
    names = list(places)
    texts = []
    for name in names:
        role = role_of(train, name)
        words = f"{short(speeds[name])}{f', {role}' if role else ''}".replace("-", "−")
        texts.append(lines_of(name, words))
    heights = spread([places[name] * inches for name in names], [LINE * len(lines) for lines in texts], gap=0.04)
    for name, lines, height in zip(names, texts, heights, strict=True):
        across = axes.get_yaxis_transform()
        axes.annotate(
            plain("\n".join(lines)),
            (1.0, places[name]),
            (1.05, height / inches),
            across,
            across,
            arrowprops={"arrowstyle": "-", "color": MARKED, "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0, "relpos": (0, 0.5)},
            va="center",
            fontsize=8,
            color=DARK,
            linespacing=1.25,
            annotation_clip=False,
        )
