"""Loads of the meshes of a train over the speed of its input."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.dynamics.planetary.response import PlanetaryResponse
from gearcad.plots.labels import plain
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, legend_above, new_figure, prepared
from gearcad.plots.planetary.parts import colour_of
from gearcad.plots.speeds import mark_parting, shade_unstable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["RESPONSE_INCHES", "plot_response"]

RESPONSE_INCHES = (FIGURE_INCHES[0], 4.2)


def plot_response(response: PlanetaryResponse, ax: Axes | None = None) -> Axes:
    """Of each mesh the greatest dynamic load factor of all planets, running up and, where it differs, down.

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
