"""Pictures of a check over the mesh: pressure and load share along the path of contact, stiffness, error and root stress."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.check.plane.result import PlaneCheck
from gearcad.check.result import CheckResult
from gearcad.geometry import GearPair
from gearcad.material import Limit, by_gear
from gearcad.plots.paper import DARK, GEARS, MARKED, PALE, SERIES, draw_limit, legend_above, prepared, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = [
    "PATH",
    "mark_path",
    "plot_contact_pressure",
    "plot_load_share",
    "plot_mesh_stiffness",
    "plot_root_stress",
    "plot_transmission_error",
]


PATH = "place on the line of action, from T$_1$, in mm"
_ROLL = "roll angle of the pinion in °, 0 at the pitch point"


def plot_contact_pressure(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Peak pressure of every pair of teeth along the path of contact, beside Hertz's under the load that the pair carries.

    Near the ends of the flanks there is no line: there the pressure is that of an edge. Contact of a corner is marked below.
    """
    axes = prepared(ax, PATH, "peak pressure in MPa")
    contacts = result.contacts_along_path
    lengths = np.array([contact.place for contact in contacts])
    inside = np.array([contact.interior for contact in contacts])
    corner = np.array([contact.edge for contact in contacts])
    for name, words, colour, width in (
        ("hertz_pressure", "Hertz, under the load carried", PALE, 3.5),
        ("peak_pressure", "finite elements", SERIES[0], 1.3),
    ):
        values = np.array([getattr(contact, name) for contact in contacts])
        axes.plot(lengths, np.where(inside, values, np.nan), color=colour, linewidth=width, label=words)
    axes.set_ylim(0, 1.12 * max(contact.peak_pressure for contact in contacts if contact.interior) if inside.any() else None)
    edge = ~inside & ~corner
    for places, words, marker in ((edge, "near an edge", "|"), (corner, "a corner touches", "x")):
        if places.any():
            height = np.zeros(places.sum())
            across = axes.get_xaxis_transform()
            axes.plot(lengths[places], height + 0.03, marker, color=DARK, markersize=5, transform=across, label=words)
    for limit in _limits(result, "contact_limit"):
        draw_limit(axes, limit)
    mark_path(axes, result.pair)
    legend_above(axes, 3)
    return axes


def plot_load_share(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Part of the load that a pair of teeth carries along the path of contact, contact of corners beyond it included."""
    axes = prepared(ax, PATH, "share of the load")
    contacts = result.contacts_along_path
    lengths = np.array([contact.place for contact in contacts])
    shares = np.array([contact.share for contact in contacts])
    corner = np.array([contact.edge for contact in contacts])
    axes.plot(lengths, shares, color=SERIES[0], label="finite elements")
    if corner.any():
        axes.plot(lengths[corner], shares[corner], "x", color=DARK, markersize=5, label="a corner touches")
    axes.set_ylim(0, 1.05)
    mark_path(axes, result.pair)
    legend_above(axes, 2)
    return axes


def plot_mesh_stiffness(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Mesh stiffness over one base pitch, its mean and the greatest of a single pair, beside c_gamma and c' of ISO 6336-1."""
    axes = prepared(ax, _ROLL, "stiffness in N/(mm µm)")
    summary, standard, part = result.summary, result.rating.stiffness, result.rating.edition.part(1)
    axes.plot(result.cycle.course("roll_angle"), result.cycle.course("stiffness"), color=SERIES[0], label="mesh stiffness")
    for value, words, colour, style in (
        (summary.mesh_stiffness_mean, "its mean", SERIES[0], "--"),
        (standard.mesh_alpha, rf"$c_{{\gamma\alpha}}$, {part}", SERIES[1], "--"),
        (summary.single_stiffness, "one pair alone, greatest", SERIES[0], ":"),
        (standard.single, f"$c'$, {part}", SERIES[1], ":"),
    ):
        axes.axhline(value, color=colour, linestyle=style, linewidth=1.4, label=f"{words}: {value:.2f}")
    legend_above(axes, 2)
    return axes


def plot_transmission_error(result: CheckResult, ax: Axes | None = None) -> Axes:
    """How far the wheel lags under load over one base pitch, and what each gear gives of it; all about their means."""
    axes = prepared(ax, _ROLL, "along the line of action, less the mean, in µm")
    cycle = result.cycle
    curves = [("transmission error", cycle.course("transmission_error"), result.mean_lag.whole, DARK, "-", 1.5)]
    parts = 1000 * cycle.course("approach_parts")
    for (gear, colour, _), part, mean in zip(GEARS, parts.T, result.mean_lag.parts, strict=True):
        curves.append((f"part of the {gear}", part, mean, colour, "--", 1.2))
    for words, values, mean, colour, style, width in curves:
        label = f"{words}, mean {short(mean)} µm"
        axes.plot(cycle.course("roll_angle"), values - mean, color=colour, linestyle=style, linewidth=width, label=label)
    legend_above(axes, 2)
    return axes


def plot_root_stress(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Greatest tension and compression of both fillets over one base pitch, beside the root stress of ISO 6336-3."""
    axes = prepared(ax, _ROLL, "root stress in MPa")
    angles = result.cycle.course("roll_angle")
    standard = r"$\sigma_{F0}$" if result.load.application_factor == 1 else r"$\sigma_{F0} K_A$"
    for role, (words, colour, _) in GEARS.items():
        for name, style in (("tension", "-"), ("compression", "--")):
            stresses = [getattr(position, name).pick(role).stress for position in result.cycle.every]
            axes.plot(angles, stresses, color=colour, linestyle=style, label=f"{words}, {name}")
        reference = result.rating.root_stresses.pick(role)
        axes.axhline(reference, color=colour, linestyle=":", linewidth=1.4, label=f"{words}, {standard} = {reference:.0f} MPa")
    for limit in _limits(result, "root_limit"):
        draw_limit(axes, limit)
    axes.axhline(0, color=MARKED, linewidth=0.8)
    legend_above(axes, 3)
    return axes


def _limits(result: CheckResult, name: str) -> list[Limit]:
    """Those of the materials, each once."""
    return list(dict.fromkeys(getattr(material, name) for material in by_gear(result.material).values()))


def mark_path(axes: Axes, pair: GearPair) -> None:
    """The points A to E of the path of contact, by name."""
    across = axes.get_xaxis_transform()
    for name, place in pair.path_of_contact._asdict().items():
        axes.axvline(place, color=MARKED, linewidth=0.9, zorder=0.5)
        axes.text(place, 0.985, f" {name}", transform=across, ha="left", va="top", fontsize=9, color=DARK)
