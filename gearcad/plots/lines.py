"""Pictures of a check of solid bodies: load along the lines of contact, over the flanks, and along the face width."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.check.solid.result import SolidCheck
from gearcad.per_gear import Role
from gearcad.plots.check import PATH, mark_path
from gearcad.plots.paper import DARK, GEARS, MARKED, SERIES, legend_above, new_figure, prepared, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.tri import Triangulation

__all__ = [
    "plot_contact_pattern",
    "plot_harmonics",
    "plot_line_loads",
    "plot_lines_share",
    "plot_load_along_face",
    "plot_root_along_face",
]


_COLOUR_MAP = "viridis"

_ROUNDED = 6
"""Decimals (mm) of places that count as one."""

_GAP = 3.0
"""Edges of triangles longer than so many times the distance between neighbours span a hole in the map."""

_ACROSS = "across the face, from the middle of the common width, in mm"


def plot_line_loads(result: SolidCheck, ax: Axes | None = None) -> Axes:
    """Line load over the plane of action, and the lines of contact of the position with the greatest pressure, or load."""
    axes = new_figure().subplots() if ax is None else ax
    cells = result.cells
    cells = cells.only(~cells.on_edge | (cells.line_load > 0))
    _map(axes, cells.place, cells.across, cells.line_load, result.summary.line_load_max, "line load in N/mm")
    for contact in result.shown.position.contacts:
        axes.plot(contact.line.nominal, contact.line.across, color="white", linewidth=1.2, linestyle="--")
    axes.set_xlabel(PATH)
    axes.set_ylabel("across the face in mm")
    mark_path(axes, result.pair)
    return axes


def plot_contact_pattern(result: SolidCheck, role: Role, ax: Axes | None = None) -> Axes:
    """Greatest pressure of the cycle at every place of the flank of a gear, in the flank's outline.

    Contact of edges is left out.
    """
    axes = new_figure().subplots() if ax is None else ax
    cells, own = result.cells, result.pair.gears.pick(role)
    cells = cells.only(~cells.on_edge)
    _map(
        axes,
        cells.heights.pick(role),
        cells.rolls.pick(role),
        cells.pressure,
        result.summary.contact_pressure,
        "pressure in MPa",
    )
    form = own.flank_form
    z, roll = np.array([0, 1, 1, 0, 0]) * form.width, np.array([0, 0, 1, 1, 0]) * (form.last - form.first) + form.first
    axes.plot(z, roll, color=DARK, linewidth=1.2, label=f"flank of the {role.value}, tip above")
    root = result.along_face.roots.pick(role)
    for height, words in ((root.low, "ends of the common width"), (root.high, None)):
        axes.axvline(height, color=MARKED, linestyle=":", linewidth=1.2, label=words)
    axes.set_xlabel("along the axis, z in mm")
    axes.set_ylabel("roll length in mm")
    legend_above(axes, 2)
    return axes


def _map(axes: Axes, x: Floats, y: Floats, values: Floats, most: float | None, words: str) -> None:
    """Greatest values at every place as colours, which end at the greatest away from edges, if there is one."""
    (x, y), found = _greatest(x, y, values)
    most = float(found.max()) if most is None else most
    drawn = axes.tripcolor(_joined(x, y), found, shading="gouraud", vmin=0, vmax=most, cmap=_COLOUR_MAP)
    drawn.set_rasterized(True)
    axes.figure.colorbar(drawn, ax=axes, label=words, extend="max" if found.max() > most else "neither")


def _greatest(x: Floats, y: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Places (2, m), each once, and the greatest value there: an edge touches at the same place many times."""
    places, index = np.unique(np.stack([x, y], -1).round(_ROUNDED), axis=0, return_inverse=True)
    found = np.zeros(len(places))
    np.maximum.at(found, index.ravel(), values)
    return places.T, found


def _joined(x: Floats, y: Floats) -> Triangulation:
    """Triangles between places, but for those that would span a hole."""
    from matplotlib.tri import Triangulation

    triangles = Triangulation(x, y)
    corners = np.stack([x, y], -1)[triangles.triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1).max(axis=1)
    triangles.set_mask(longest > _GAP * float(np.median(longest)))
    return triangles


def plot_lines_share(result: SolidCheck, ax: Axes | None = None) -> Axes:
    """Part of the load that a pair of teeth carries, over the place where its line of contact crosses the middle."""
    axes = prepared(ax, PATH, "share of the load")
    axes.plot(result.load_share.places, result.load_share.shares, color=SERIES[0], label="finite elements")
    axes.set_ylim(0, 1.05)
    mark_path(axes, result.pair)
    legend_above(axes, 1)
    return axes


def plot_harmonics(result: SolidCheck, ax: Axes | None = None) -> Axes:
    """Amplitudes of the transmission error at the tooth frequency and its multiples."""
    axes = prepared(ax, "harmonic of the tooth frequency", "amplitude in µm")
    amplitudes = result.summary.transmission_error_harmonics
    bars = axes.bar(np.arange(len(amplitudes)) + 1, amplitudes, width=0.6, color=SERIES[0])
    axes.bar_label(bars, [short(each) for each in amplitudes], fontsize=9, padding=2)
    axes.set_ylim(0, 1.15 * max(amplitudes))
    axes.set_xticks(np.arange(len(amplitudes)) + 1)
    return axes


def plot_load_along_face(result: SolidCheck, ax: Axes | None = None) -> Axes:
    """Load per width over the face width, mean of the cycle, with its own mean."""
    axes = prepared(ax, _ACROSS, "load per width in N/mm")
    along, factor = result.along_face, result.summary.face_load_factor
    axes.step(along.across, along.load, where="mid", color=SERIES[0], label="mean of all positions")
    mean = along.mean
    axes.axhline(mean, color=DARK, linestyle="--", linewidth=1.2, label=f"over the width: {short(mean)} N/mm")
    axes.axhline(factor * mean, color=DARK, linestyle=":", linewidth=1.2, label=rf"$K_{{H\beta}}$ = {factor:.3f}")
    axes.set_ylim(bottom=0)
    legend_above(axes, 3)
    return axes


def plot_root_along_face(result: SolidCheck, ax: Axes | None = None) -> Axes:
    """Greatest root tension of the cycle along the face of both gears; what stands out beyond the common width is pale."""
    axes, part = prepared(ax, _ACROSS, "root tension in MPa"), result.rating.edition.part(3)
    for role, (words, colour, marker) in GEARS.items():
        root = result.along_face.roots.pick(role)
        factor = result.summary.root_face_load_factor.pick(role)
        axes.plot(root.across, root.stress, color=colour, linewidth=1.0, alpha=0.4)
        inside = root.common
        label = rf"{words}, $K_{{F\beta}}$ = {factor:.2f}"
        axes.plot(root.across[inside], root.stress[inside], color=colour, marker=marker, markersize=3.5, label=label)
        standard = result.rating.root_stresses.pick(role)
        axes.axhline(standard, color=colour, linestyle=":", linewidth=1.4, label=f"{words}, {part}: {standard:.0f} MPa")
    axes.set_ylim(bottom=0)
    legend_above(axes, 2)
    return axes
