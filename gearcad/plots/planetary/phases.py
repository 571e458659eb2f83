"""Phases of a train: when each planet meets the pitch point, and what the stiffnesses of all planets come to."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.mesh_stiffness import MeshStiffness
from gearcad.planetary import MeshPhases, PlanetaryTrain, SetMesh
from gearcad.plots.labels import plain
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, new_figure, prepared
from gearcad.plots.planetary.parts import PLANETS, colour_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["phases_inches", "plot_phases", "stiffness_sum"]

_PLACES = 721
"""Of a base pitch, at which stiffnesses are added up."""

_NAMED = 12
"""Most planets whose numbers have room beside their rows."""


def phases_inches(train: PlanetaryTrain, stiffness: Mapping[str, MeshStiffness] | None) -> tuple[float, float]:
    """Size of the picture: rows for the planets, and curves below where stiffnesses are known."""
    return FIGURE_INCHES[0], 1.3 + 0.17 * min(train.planets, _NAMED) + (2.0 if stiffness else 0.0)


def plot_phases(
    train: PlanetaryTrain,
    phases: Mapping[str, MeshPhases],
    stiffness: Mapping[str, MeshStiffness] | None = None,
    figure: Figure | None = None,
) -> Figure:
    """A column for each mesh over one base pitch: dots where planets meet the pitch point, below the sum of stiffnesses."""
    of = new_figure(phases_inches(train, stiffness)) if figure is None else figure
    rows = 0.6 + 0.17 * min(train.planets, _NAMED)
    heights = [rows, 2.0] if stiffness else [rows]
    panels = of.subplots(len(heights), 2, sharex=True, squeeze=False, height_ratios=heights)
    for column, mesh in enumerate(train.meshes):
        _draw_rows(panels[0, column], train, phases[mesh.name].ahead, mesh)
        if stiffness:
            _draw_sum(panels[1, column], train, phases[mesh.name].ahead, stiffness[mesh.name])
        panels[-1, column].set_xlabel("base pitches of this mesh", fontsize=9)
    panels[0, 0].set_xlim(0, 1)
    panels[0, 0].set_ylabel("planet")
    if stiffness:
        panels[1, 0].set_ylabel("stiffness in N/µm")
    return of


def _draw_rows(axes: Axes, train: PlanetaryTrain, ahead: tuple[float, ...], mesh: SetMesh) -> None:
    prepared(axes, "", "")
    colour = colour_of(train, mesh.central.name)
    for planet, place in enumerate(ahead, 1):
        met = -place % 1.0
        met = 0.0 if met > 1 - 1e-9 else met  # a whole pitch but for rounding
        axes.plot([0, 1], [planet, planet], color=PLANETS, linewidth=0.8, alpha=0.6)
        dots = [met, met + 1.0] if met < 1e-9 else [met]  # what is met at the end of the pitch is met at its beginning
        axes.plot(dots, [planet] * len(dots), "o", color=colour, markersize=5, clip_on=False)
    step = -(-train.planets // _NAMED)
    axes.set_yticks(range(1, train.planets + 1, step))
    axes.set_ylim(train.planets + 0.7, 0.3)
    axes.grid(False, axis="y")
    axes.set_title(plain(mesh.name), fontsize=10, loc="left")


def _draw_sum(axes: Axes, train: PlanetaryTrain, ahead: tuple[float, ...], stiffness: MeshStiffness) -> None:
    prepared(axes, "", "")
    places = np.linspace(0, 1, _PLACES)
    for place in ahead:
        axes.plot(places, stiffness.stiffness_at(place + places), color=MARKED, linewidth=0.8)
    axes.plot(
        places, stiffness_sum(ahead, stiffness, places), color=colour_of(train, stiffness.mesh.central.name), linewidth=1.6
    )
    axes.axhline(len(ahead) * stiffness.mean, color=DARK, linewidth=0.8, linestyle="--")
    axes.set_ylim(bottom=0)


def stiffness_sum(ahead: tuple[float, ...], stiffness: MeshStiffness, places: Floats) -> Floats:
    """Stiffness (N/µm) of all planets together at places (n,) of a base pitch."""
    found: Floats = sum((stiffness.stiffness_at(place + places) for place in ahead), np.zeros_like(places))
    return found
