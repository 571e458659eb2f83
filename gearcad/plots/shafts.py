"""Pictures of shafts: outline with bearings and forces, deflection, inclination, moments, stress; load over the face."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcad.core.records import Floats, JsonObject
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, PALE, SERIES, legend_above, new_figure, prepared, short
from gearcad.shafts.beam import ShaftState, SteppedShaft

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SHAFT_INCHES = (FIGURE_INCHES[0], 9.6)
"""Size of the picture of a shaft, which has six panels."""

_ALONG = "position from the left end in mm"
_ACROSS = "position from the middle of the face in mm"


def plot_shaft(state: ShaftState, figure: Figure | None = None) -> Figure:
    """Draw a shaft, and below it deflection, inclination, bending moments, torque and nominal stress along it."""
    of = new_figure(SHAFT_INCHES) if figure is None else figure
    panels = of.subplots(6, 1, sharex=True, height_ratios=[1.1, 1, 1, 1, 0.7, 0.9])
    nodes, moved = state.shaft.nodes, state.moved.reshape(-1, 6)
    _draw_outline(panels[0], state)
    across = 1000 * moved[:, :2]
    for panel, words, values in (
        (panels[1], "deflection\nin µm", across),
        (panels[2], "inclination\nin µm/mm", 1000 * np.column_stack([moved[:, 4], -moved[:, 3]])),
    ):
        prepared(panel, "", words)
        for number, (name, column) in enumerate(zip(("in x–z", "in y–z"), values.T, strict=True)):
            panel.plot(nodes, column, color=SERIES[number], label=name)
        panel.plot(nodes, np.hypot(*values.T), color=DARK, linewidth=1.0, linestyle="--", label="resultant")
    legend_above(panels[1], 3)
    places = np.column_stack([nodes[:-1], nodes[1:]]).ravel()
    cuts = state.cuts.reshape(-1, 6) / 1000
    prepared(panels[3], "", "bending\nmoment\nin N·m")
    for number, (name, column) in enumerate((("about y, in x–z", cuts[:, 4]), ("about x, in y–z", cuts[:, 3]))):
        panels[3].plot(places, column, color=SERIES[number], label=name)
    panels[3].plot(places, np.hypot(cuts[:, 3], cuts[:, 4]), color=DARK, linewidth=1.0, linestyle="--", label="resultant")
    legend_above(panels[3], 3)
    prepared(panels[4], "", "torque\nin N·m")
    panels[4].plot(places, cuts[:, 5], color=SERIES[2])
    prepared(panels[5], _ALONG, "equivalent\nstress\nin MPa")
    panels[5].plot(places, state.stresses.ravel(), color=SERIES[1])
    panels[5].set_ylim(bottom=0)
    panels[5].set_xlim(0, state.shaft.length)
    return of


def _draw_outline(axes: Axes, state: ShaftState) -> None:
    """Draw the segments with bores, bearings as triangles, the coupling as a square and forces as arrows."""
    shaft = state.shaft
    prepared(axes, "", "diameter\nin mm")
    for start, part in zip(shaft.ends, shaft.segments, strict=False):
        outer, inner = part.outer_diameter / 2, part.inner_diameter / 2
        axes.fill_between([start, start + part.length], -outer, outer, color="#e6ecf2", edgecolor=DARK, linewidth=0.8)
        if inner:
            axes.plot([start, start + part.length], [inner, inner], color=DARK, linewidth=0.6, linestyle="--")
            axes.plot([start, start + part.length], [-inner, -inner], color=DARK, linewidth=0.6, linestyle="--")
    axes.axhline(0, color=MARKED, linewidth=0.6, linestyle="-.")
    radii = {each.position: shaft.segment_at(each.position).outer_diameter / 2 for each in shaft.bearings}
    axes.plot(
        list(radii), [-each for each in radii.values()], "^", color=SERIES[0], markersize=8, label="bearing", clip_on=False
    )
    for number, force in enumerate(shaft.forces):
        label = "force" if not number else None
        axes.plot([force.position], [shaft.segment_at(force.position).outer_diameter / 2], "v", color=SERIES[1], label=label)
    axes.plot([shaft.coupling], [0.0], "s", color=SERIES[2], label="coupling", clip_on=False)
    reach = 1.25 * _greatest_radius(shaft)
    axes.set_ylim(-reach, reach)
    legend_above(axes, 3)


def _greatest_radius(shaft: SteppedShaft) -> float:
    return max(each.outer_diameter for each in shaft.segments) / 2


def plot_load_on_shafts(mesh: JsonObject, ax: Axes | None = None) -> Axes:
    """Draw the line load of the slices over the face, with its mean and K_Hbeta at the end of the face."""
    axes = prepared(ax, _ACROSS, "line load in N/mm")
    mean, factor = mesh["mean_line_load"], mesh["K_Hbeta_end_of_face"]
    axes.step(mesh["slices_at"], mesh["line_load"], where="mid", color=SERIES[0], label="on the shafts")
    axes.axhline(mean, color=DARK, linestyle="--", linewidth=1.2, label=f"mean: {short(mean)} N/mm")
    axes.axhline(factor * mean, color=DARK, linestyle=":", linewidth=1.2, label=rf"$K_{{H\beta}}$ = {factor:.3f}")
    axes.set_ylim(bottom=0)
    legend_above(axes, 3)
    return axes


def plot_gaps_on_shafts(mesh: JsonObject, ax: Axes | None = None) -> Axes:
    """Draw the gap that the shafts leave over the face under an even load, and its parts by their causes."""
    axes = prepared(ax, _ACROSS, "gap in µm")
    parts: Mapping[str, Any] = mesh["gap_at_even_load_at_slices"]
    whole: Floats = np.sum([np.asarray(each) for each in parts.values()], axis=0)
    places = np.asarray(mesh["slices_at"])
    axes.plot(places, whole - whole.min(), color=PALE, linewidth=4.0, label="all, from its least on")
    for number, (name, gap) in enumerate(parts.items()):
        cause, _, of = name.rpartition("_")
        colour, style = SERIES[number % len(SERIES)], "-" if of == "1" else "--"
        words = f"{cause.replace('_', ' ')}, {'pinion' if of == '1' else 'wheel'}"
        axes.plot(places, np.asarray(gap) - np.mean(gap), style, color=colour, linewidth=1.2, label=words)
    legend_above(axes, 3)
    return axes
