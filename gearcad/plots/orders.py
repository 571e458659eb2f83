"""Pictures of orders: amplitudes of single orders over speed, order tracks of a run beside them, and its spectrogram."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.core.records import Floats
from gearcad.dynamics.response.order_chart import OrderChart
from gearcad.dynamics.time_domain.order_tracks import OrderTracks
from gearcad.dynamics.trains.speed_orders import SpeedOrder
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, SERIES, legend_above, new_figure, plain, prepared, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PANEL = 2.5
"""Height of a panel (inches)."""

MOST_PANELS = 6
"""Greatest number of members that one figure shows: meshes first, then shafts."""

_MOST_ORDERS = 5
"""Greatest number of orders in a panel: those of the greatest amplitudes."""

_DECADES = 4.0
"""Range of the colours of a spectrogram below its greatest amplitude."""

_CELLS = 160
"""Greatest number of rows of colours in a panel: a row shows the greatest amplitude of its frequencies."""


class _Member(NamedTuple):
    """A mesh or shaft: its name, what is drawn of it with the unit, and its column in the arrays."""

    name: str
    words: str
    mesh: bool
    column: int


def _members(names: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]) -> list[_Member]:
    meshes = [_Member(name, "force in N", True, at) for at, name in enumerate(names[0])]
    shafts = [_Member(name, "torque in N·m", False, at) for at, name in enumerate(names[2])]
    return [*meshes, *shafts][:MOST_PANELS]


def orders_inches(of: OrderChart | OrderTracks) -> tuple[float, float]:
    """Return the size of a figure with a panel for each mesh and shaft."""
    return FIGURE_INCHES[0], 0.6 + _PANEL * max(len(_members(of.names)), 1)


def _speed_words(names: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]) -> str:
    """Return the label of the axis of speed: without meshes it is that of the first inertia."""
    return f"speed of the first {'pinion' if names[0] else 'inertia'} in rpm"


def _order_words(order: SpeedOrder) -> str:
    return f"order {order.order:.5g}" + (f" ({plain(order.source)})" if order.source else "")


def _greatest(amplitudes: Floats) -> list[int]:
    """Return the orders with the greatest amplitudes (s, k), rising."""
    most = np.nan_to_num(amplitudes).max(axis=0, initial=0.0)
    kept = np.argsort(-most, kind="stable")[:_MOST_ORDERS]
    return sorted(int(at) for at in kept if most[at] > 0)


def plot_orders(chart: OrderChart, figure: Figure | None = None) -> Figure:
    """Draw the amplitudes of the greatest orders over speed, a panel for each mesh and shaft."""
    of, members = new_figure(orders_inches(chart)) if figure is None else figure, _members(chart.names)
    panels = of.subplots(len(members), 1, sharex=True, squeeze=False)[:, 0]
    for panel, member in zip(panels, members, strict=True):
        values = (chart.forces if member.mesh else chart.torques)[:, :, member.column]
        prepared(panel, "", member.words)
        panel.set_title(plain(member.name), fontsize=9, loc="left", pad=3)
        for number, at in enumerate(_greatest(values)):
            colour = SERIES[number % len(SERIES)]
            panel.plot(chart.speeds, values[:, at], color=colour, linewidth=1.2, label=_order_words(chart.orders[at]))
        panel.set_ylim(bottom=0)
        panel.legend(frameon=False, fontsize=8, loc="upper right")
    panels[0].set_xlim(float(chart.speeds[0]), float(chart.speeds[-1]))
    panels[-1].set_xlabel(_speed_words(chart.names))
    return of


def plot_tracks(tracks: OrderTracks, chart: OrderChart | None, figure: Figure | None = None) -> Figure:
    """Draw the amplitudes of orders along the speed of a run; broad and pale those of the steady motion, where it is known."""
    of, members = new_figure(orders_inches(tracks)) if figure is None else figure, _members(tracks.names)
    panels = of.subplots(len(members), 1, sharex=True, squeeze=False)[:, 0]
    for panel, member in zip(panels, members, strict=True):
        values = (tracks.forces if member.mesh else tracks.torques)[:, :, member.column]
        prepared(panel, "", member.words)
        panel.set_title(plain(member.name), fontsize=9, loc="left", pad=3)
        for number, at in enumerate(_greatest(values)):
            colour, order = SERIES[number % len(SERIES)], tracks.orders[at]
            if chart is not None and order in chart.orders:
                steady = (chart.forces if member.mesh else chart.torques)[:, chart.orders.index(order), member.column]
                panel.plot(chart.speeds, steady, color=colour, linewidth=3.4, alpha=0.3)
            panel.plot(tracks.speeds, values[:, at], color=colour, linewidth=1.1, label=_order_words(order))
        panel.set_ylim(0, 1.12 * float(values.max(initial=0.0)) or 1.0)
        panel.legend(frameon=False, fontsize=8, loc="upper right")
    panels[0].set_xlim(float(tracks.speeds.min()), float(tracks.speeds.max()))
    panels[-1].set_xlabel(_speed_words(tracks.names))
    return of


def plot_spectrogram(tracks: OrderTracks, natural: Floats, figure: Figure | None = None) -> Figure:
    """Draw the amplitudes over speed and frequency, a panel for each mesh and shaft, with the orders and natural frequencies.

    `natural` (n,) are natural frequencies in Hz.
    """
    of, members = new_figure(orders_inches(tracks)) if figure is None else figure, _members(tracks.names)
    panels = of.subplots(len(members), 1, sharex=True, squeeze=False)[:, 0]
    for panel, member in zip(panels, members, strict=True):
        prepared(panel, "", "frequency in Hz")
        panel.set_title(plain(member.name), fontsize=9, loc="left", pad=3)
        _draw_map(panel, tracks, member)
        _draw_orders(panel, tracks, natural)
    legend_above(panels[0], 2, raised=10)
    panels[-1].set_xlabel(_speed_words(tracks.names))
    return of


def _draw_map(axes: Axes, tracks: OrderTracks, member: _Member) -> None:
    from matplotlib.colors import LogNorm

    values = (tracks.force_map if member.mesh else tracks.torque_map)[:, 1:, member.column]
    order = np.argsort(tracks.map_speeds, kind="stable")
    greatest = float(values.max(initial=0.0)) or 1.0
    norm = LogNorm(greatest / 10**_DECADES, greatest, clip=True)
    starts = np.arange(0, values.shape[1], -(-values.shape[1] // _CELLS))
    shown = np.maximum(np.maximum.reduceat(values[order], starts, axis=1).T, 1e-300)
    edges = tracks.frequency[1:][np.append(starts, values.shape[1] - 1)]
    speeds = tracks.map_speeds[order]
    columns = np.concatenate([[speeds[0]], (speeds[1:] + speeds[:-1]) / 2, [speeds[-1]]])
    axes.grid(False)
    colours = axes.pcolormesh(columns, edges, shown, norm=norm, cmap="viridis", rasterized=True)
    axes.set_xlim(float(tracks.map_speeds.min()), float(tracks.map_speeds.max()))
    axes.set_ylim(0, float(tracks.frequency[-1]))
    figure = axes.get_figure(root=True)
    assert figure is not None  # prepared() has put them on one
    figure.colorbar(colours, ax=axes, label=f"amplitude of {member.words}", pad=0.02, extend="min")


def _draw_orders(axes: Axes, tracks: OrderTracks, natural: Floats) -> None:
    """Draw lines of the orders with their numbers where they leave the picture, and lines of the natural frequencies."""
    from matplotlib.patheffects import AbstractPathEffect, withStroke

    (left, right), top = axes.get_xlim(), axes.get_ylim()[1]
    outlined: list[AbstractPathEffect] = [withStroke(linewidth=2, foreground=DARK)]
    last = -1.0
    for each in tracks.orders:
        end = min(right, 60 * top / each.order)
        if end <= left:
            continue
        axes.plot(
            [left, end], [left * each.order / 60, end * each.order / 60], color="white", linewidth=0.6, linestyle=":", alpha=0.6
        )
        height = end * each.order / 60
        if height - last < 0.04 * top and end == right:
            continue
        last = height if end == right else last
        label = axes.text(end, min(height, 0.985 * top), f"{each.order:.5g}", ha="right", va="top", fontsize=7, color="white")
        label.set_path_effects(outlined)
    axes.plot([], [], color=MARKED, linewidth=0.8, linestyle=":", label="orders of this speed")
    words = "natural frequencies: "
    inside = [hertz for hertz in natural.tolist() if 0 < hertz < top]
    for number, hertz in enumerate(inside):
        label_words = words + ", ".join(map(short, inside)) + " Hz" if not number else ""
        axes.axhline(hertz, color=SERIES[1], linewidth=0.8, linestyle="--", label=label_words)
