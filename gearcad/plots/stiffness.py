"""Pictures of the mesh stiffness by several methods: over the line of action, in its parts, and over the load."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gearcad.core.records import Floats
from gearcad.mesh_cycle import MeshCycle
from gearcad.plots.check import mark_path
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, legend_above, new_figure, prepared
from gearcad.stiffness.comparison import StiffnessComparison

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["parts_inches", "plot_load_dependence", "plot_parts", "plot_parts_of_all", "plot_stiffness"]


_PLACE = "place $s_1$ of the middle pair on the line of action, from T$_1$, in mm"
_ROLL = "roll angle of the pinion in °, 0 at C"


class _Look(NamedTuple):
    """Colour (Okabe and Ito), style of the curve, width, and marker of a method."""

    colour: str
    style: str | tuple[float, tuple[float, ...]]
    width: float
    marker: str


_LOOKS = {
    "potential-energy": _Look("#e69f00", (0, (5, 1.5)), 1.6, "^"),
    "weber-banaschek": _Look("#56b4e9", (0, (5, 1.5)), 1.6, "v"),
    "iso6336": _Look("#777777", "-", 1.4, "D"),
    "strain-energy": _Look("#009e73", (0, (6, 1.5, 1, 1.5)), 1.6, "P"),
    "plane-stress": _Look("#cc79a7", "-", 1.6, "o"),
    "plane-strain": _Look("#0072b2", "-", 1.6, "s"),
    "3d": _Look("#d55e00", "-", 2.4, "*"),
}
"""Closed forms are dashed, finite elements in contact are whole lines."""

_OWNERS = {
    "pinion": ("#00334f", "#0072b2", "#4c9fd1", "#9fd0ec", "#d6ecf8"),
    "wheel": ("#5a2600", "#d55e00", "#e88a45", "#f4b98c", "#fbe0cd"),
    "contact": ("#009e73",),
    "gaps closed": ("#999999",),
}
"""Shades of the parts, by the owner's name that they begin with."""

_SHADES = ("foundation", "", "bending", "shear", "axial")
"""Parts of the compliance by shade, the darkest first; "" for a method that does not divide the gear's part."""

_HEADROOM = 1.12
"""Factor on the height of the curves that leaves room for the names of A to E."""

_MARGIN = 0.015
"""Part of the path of contact drawn beyond A and E, where the curve goes on."""

_TOP_AXIS = 34.0
"""Points that a second axis above takes."""


def plot_stiffness(comparison: StiffnessComparison, ax: Axes | None = None) -> Axes:
    """Secant stiffness of the mesh by every method while the middle pair goes from A to E; of ISO 6336 both its means."""
    axes = prepared(ax, _PLACE, "mesh stiffness in N/µm")
    for cycle in comparison.cycles:
        look, title = _LOOKS[cycle.method], comparison.titles[cycle.method]
        if cycle.mean_only:
            axes.axhspan(cycle.mean, cycle.tangent_mean, color=look.colour, alpha=0.18, linewidth=0)
            for value, words, style in (
                (cycle.mean, r"$c_{\gamma\beta}$ (secant)", "-"),
                (cycle.tangent_mean, r"$c_{\gamma\alpha}$ (tangent)", ":"),
            ):
                axes.axhline(value, color=look.colour, linestyle=style, linewidth=look.width, label=f"{title}: {words}")
        else:
            places, stiffness = _along_path(comparison, cycle, cycle.mesh_stiffness)
            axes.plot(places, stiffness, color=look.colour, linestyle=look.style, linewidth=look.width, label=title)
    lowest, greatest = axes.get_ylim()
    axes.set_ylim(top=lowest + _HEADROOM * (greatest - lowest))
    _mark_mesh(axes, comparison)
    legend_above(axes, 2, raised=_TOP_AXIS)
    return axes


def plot_parts(comparison: StiffnessComparison, cycle: MeshCycle, ax: Axes | None = None) -> Axes:
    """Draw the compliance (µm/N) of pinion, wheel and contact, stacked, by one method, over the line of action from A to E."""
    axes = prepared(ax, _PLACE, "compliance in µm/N")
    _stack(axes, comparison, cycle)
    axes.set_ylim(0, _HEADROOM / cycle.minimum)
    handles, labels = axes.get_legend_handles_labels()
    # In the order in which they lie on each other.
    axes.legend(handles[::-1], labels[::-1], loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize=9)
    return axes


def parts_inches(comparison: StiffnessComparison) -> tuple[float, float]:
    """Return the size of a figure of all parts."""
    return FIGURE_INCHES[0], 1.1 + 2.0 * math.ceil(len(comparison.divided) / 2)


def plot_parts_of_all(comparison: StiffnessComparison, figure: Figure | None = None) -> Figure:
    """Draw the parts by every method that knows them, side by side on axes of one scale."""
    cycles = comparison.divided
    rows = math.ceil(len(cycles) / 2)
    of = new_figure(parts_inches(comparison)) if figure is None else figure
    panels = of.subplots(rows, min(2, len(cycles)), sharex=True, sharey=True, squeeze=False).ravel()
    known: dict[str, Any] = {}
    for panel, cycle in zip(panels, cycles, strict=False):
        prepared(panel, "", "")
        _stack(panel, comparison, cycle)
        panel.set_title(comparison.titles[cycle.method], fontsize=10, loc="left")
        handles, labels = panel.get_legend_handles_labels()
        known |= dict(zip(labels, handles, strict=True))
    panels[0].set_ylim(0, _HEADROOM / min(cycle.minimum for cycle in cycles))
    for panel in panels[len(cycles) :]:
        panel.set_visible(False)
    for panel in panels[: len(cycles)][-2:]:
        panel.tick_params(labelbottom=True)  # also over an empty place
    of.supxlabel(_PLACE, fontsize=10)
    of.supylabel("compliance in µm/N", fontsize=10)
    of.legend(known.values(), known.keys(), loc="outside upper left", ncols=3, frameon=False, fontsize=9)
    return of


def plot_load_dependence(comparison: StiffnessComparison, ax: Axes | None = None) -> Axes:
    """Draw the mean secant and mean tangent stiffness by every method over the torque."""
    from matplotlib.lines import Line2D

    axes = prepared(ax, "torque on the pinion in N·m", "mean mesh stiffness in N/µm")
    most = comparison.torques[1]
    for method, points in comparison.over_load.items():
        look, title = _LOOKS[method], comparison.titles[method]
        torques, secant, tangent = (
            np.array([getattr(point, name) for point in points]) for name in ("torque", "mean", "tangent_mean")
        )
        if len(points) == 1:
            torques, secant = np.array([0.0, most]), np.repeat(secant, 2)
            words, marker = f"{title}, whatever the load", ""
        else:
            words, marker = title, look.marker
            axes.plot(torques, tangent, color=look.colour, marker=marker, markersize=4, linewidth=1.2, linestyle="--")
        axes.plot(torques, secant, color=look.colour, marker=marker, markersize=5, linewidth=1.5, label=words)
    axes.set_xlim(0, 1.03 * most)
    axes.set_ylim(bottom=0)
    handles, _ = axes.get_legend_handles_labels()
    handles += [
        Line2D([], [], color=DARK, linestyle=style, label=words) for words, style in (("secant", "-"), ("tangent", "--"))
    ]
    axes.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False, fontsize=9)
    return axes


def _along_path(comparison: StiffnessComparison, cycle: MeshCycle, values: Floats) -> tuple[Floats, Floats]:
    """Return the places (m,) on the line of action from A to E and a little beyond, and values (m,) there.

    The cycle's own points, again every base pitch: where it jumps, the same place stands twice.
    """
    first, last = _limits(comparison)
    places = comparison.path_position(cycle.roll_angle)
    pitch = float(places[-1] - places[0])
    turns = np.arange(math.floor((first - places[-1]) / pitch), math.ceil((last - places[0]) / pitch) + 1)
    along = (places + turns[:, None] * pitch).ravel()
    near = (along > first - pitch) & (along < last + pitch)
    return along[near], np.tile(values, len(turns))[near]


def _limits(comparison: StiffnessComparison) -> tuple[float, float]:
    """Return the limits (mm) of the axis along the line of action."""
    path = comparison.pair.path_of_contact
    margin = _MARGIN * (path.E - path.A)
    return path.A - margin, path.E + margin


def _mark_mesh(axes: Axes, comparison: StiffnessComparison) -> None:
    """A to E by name, and the roll angle on a second axis."""
    axes.set_xlim(_limits(comparison))
    mark_path(axes, comparison.pair)
    pitch_point, radius = comparison.pair.path_of_contact.C, comparison.pair.pinion.base_diameter / 2

    def angles(places: Any) -> Any:
        return np.degrees((places - pitch_point) / radius)

    def places(angles: Any) -> Any:
        return pitch_point + np.radians(angles) * radius

    above = axes.secondary_xaxis("top", functions=(angles, places))
    above.set_xlabel(_ROLL)
    above.spines["top"].set_color(MARKED)


def _stack(axes: Axes, comparison: StiffnessComparison, cycle: MeshCycle) -> None:
    """The parts on each other, with a thin line between them."""
    axes.set_xlim(_limits(comparison))
    below: Floats | float = 0.0
    for name, values in cycle.telling_parts.items():
        places, part = _along_path(comparison, cycle, values)
        axes.fill_between(places, below, below + part, color=_shade(name), linewidth=0, label=_words(name))
        below = below + part
        axes.plot(places, below, color="white", linewidth=0.6)
    mark_path(axes, comparison.pair)


def _shade(name: str) -> str:
    owner = next(owner for owner in _OWNERS if name.startswith(owner))
    shades = _OWNERS[owner]
    return shades[_SHADES.index(name.removeprefix(owner).strip())] if len(shades) > 1 else shades[0]


def _words(name: str) -> str:
    return f"{name} as a whole" if name in ("pinion", "wheel") else name
