"""How planets share the load, and what the train's twist is made of."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.dynamics.planetary.sharing import LoadSharing
from gearcad.dynamics.planetary.torsion import TorsionalStiffness, TwistSource
from gearcad.plots.labels import plain
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, SERIES, legend_above, new_figure, prepared, short
from gearcad.plots.planetary.parts import PLANETS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["SOURCE_COLOURS", "plot_sharing", "plot_torsion", "torsion_inches"]

SOURCE_COLOURS = {
    TwistSource.MESH: SERIES[1],
    TwistSource.PIN: PLANETS,
    TwistSource.SUPPORT: SERIES[2],
    TwistSource.SHAFT: SERIES[0],
    TwistSource.STAGE: DARK,
}

_STYLES = ("--", ":", "-.")
"""Of published factors, which are all grey."""


def plot_sharing(sharing: LoadSharing, ax: Axes | None = None) -> Axes:
    """Shares of the planets, with what turns adding and taking; K_gamma as computed, and published ones beside it."""
    axes = prepared(new_figure().subplots() if ax is None else ax, "planet", "share, 1: all alike")
    planets = np.arange(1, len(sharing.shares) + 1)
    reach = np.array([sharing.shares - sharing.least_shares, sharing.greatest_shares - sharing.shares]).clip(min=0.0)
    axes.bar(planets, sharing.shares, width=0.6, color=PLANETS, label="share")
    if sharing.turning:
        # Without what turns there is nothing between least and greatest.
        axes.errorbar(
            planets, sharing.shares, reach, fmt="none", ecolor=DARK, elinewidth=1.2, capsize=4, label="over all turns"
        )
    factor = sharing.mesh_load_factor
    axes.axhline(factor, color=DARK, linewidth=1.4, label=f"$K_\\gamma$ here, {factor:.3f}")
    for published, style in zip(sharing.published, _STYLES, strict=False):
        recalled = ", recalled" if published.recalled else ""
        words = plain(f"{published.source}{recalled}, {short(published.factor)}")
        axes.axhline(published.factor, color=MARKED, linewidth=1.2, linestyle=style, label=words)
    highest = max(factor, *(each.factor for each in sharing.published), 1.0)
    axes.set_ylim(0, 1.08 * highest)
    axes.set_xticks(planets)
    axes.grid(False, axis="x")
    legend_above(axes, 2)
    return axes


def torsion_inches(torsion: TorsionalStiffness) -> tuple[float, float]:
    """Size of the picture: a bar for each contribution."""
    return FIGURE_INCHES[0], 1.1 + 0.3 * len(torsion.contributions)


def plot_torsion(torsion: TorsionalStiffness, ax: Axes | None = None) -> Axes:
    """What each spring adds to the twist, the greatest first."""
    axes = prepared(new_figure(torsion_inches(torsion)).subplots() if ax is None else ax, "share of the twist in %", "")
    found = sorted(torsion.contributions, key=lambda each: -each.share)
    places = range(len(found))
    bars = axes.barh(
        places, [100 * each.share for each in found], color=[SOURCE_COLOURS[each.source] for each in found], height=0.6
    )
    axes.bar_label(bars, [f"{100 * each.share:.1f}" for each in found], padding=4, fontsize=8, color=DARK)
    axes.set_yticks(places, [plain(each.name) for each in found])
    axes.set_ylim(len(found) - 0.4, -0.6)
    axes.set_xlim(0, 1.12 * max(100 * found[0].share, 1.0))
    axes.grid(False, axis="y")
    return axes
