"""The picture of a search for sizes: mass over safety of all that hold, with the front of those that nothing is better than."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gearcad.plots.paper import GEARS, new_figure, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from gearcad.sizing import Sizing

__all__ = ["plot_front", "save_front"]

_INCHES, _DOTS = (7.2, 4.6), 150
_BLUE, _RED = (each[1] for each in GEARS)
_WIDE = 3.0
"""How many times the mass of the lightest is shown: what is heavier was never a candidate."""


def plot_front(result: Sizing, ax: Axes | None = None) -> Axes:
    """Draw masses (kg) over margins: the best of each combination, the front, and the pairs that are listed."""
    given = ax if ax is not None else new_figure(_INCHES).subplots()
    axes = prepared(given, "mass of both gears in kg", "least safety over that required")
    axes.plot(*result.cloud, ".", color="#bbbbbb", markersize=3, label="best of each teeth, module and helix angle")
    places = np.array([(each.mass, each.margin) for each in result.front]).T
    axes.step(*places, where="post", color=_RED, linewidth=1.2, label="front: none of the variants is lighter and safer")
    listed = [(each.mass, each.margin) for each in result.found]
    axes.plot(*zip(*listed, strict=True), "o", color=_BLUE, markersize=4, label="listed, refined")
    load = result.task.load
    axes.set_title(f"{load.torque:.4g} N·m at {load.speed:g} rpm, u = {result.task.ratio:g}", fontsize=10)
    lightest = min(float(places[0, 0]), *(mass for mass, _ in listed))
    heaviest = min(float(places[0, -1]), _WIDE * lightest) if places.shape[1] > 1 else 1.2 * lightest
    heaviest = max(heaviest, *(mass for mass, _ in listed))
    axes.set_xlim(0.95 * lightest, 1.03 * heaviest)
    shown = [float(margin) for mass, margin in places.T if mass <= heaviest] + [margin for _, margin in listed]
    axes.set_ylim(0.98, 1.03 * max(shown))
    axes.legend(loc="upper left", fontsize=8)
    return axes


def save_front(result: Sizing, path: Path) -> None:
    """Write the picture as PNG, in the style of matplotlib whatever the user's own is."""
    from matplotlib import style

    with style.context("default"):
        figure = new_figure(_INCHES)
        plot_front(result, figure.subplots())
        figure.savefig(path, dpi=_DOTS)
