"""Pictures of stresses at the worst positions of a check: in the teeth, around and below the contact, along the fillets."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.check.plane.result import PlaneCheck
from gearcad.per_gear import PerGear
from gearcad.plots.paper import DARK, GEARS, MARKED, SERIES, legend_above, new_figure, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["plot_contact_zone", "plot_depth_profile", "plot_fillets", "plot_stress_field"]

_COLOUR_MAP = "viridis"
_TEETH_SHOWN = 3.6
_ZONE = 3.0
"""Half the width of the pictures: in normal modules for the teeth, in half widths for the contact."""

_ON_WHITE = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 2.0}

_OVER = 1.1
"""The end of the colours of the teeth, in greatest stresses of the fillets."""

_LEAST_ANGLE = 20.0
"""Tangent angle (deg) from which on a fillet is the root."""


def plot_stress_field(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Von Mises stress of both gears in mesh; colours end a little above the greatest of the fillets."""
    position = result.shown.position
    most = max(abs(stress.stress) for stress in (*position.tension, *position.compression))
    module = result.pair.pinion.normal_module
    return _plot_field(result, ax, _TEETH_SHOWN * module, _OVER * most, PerGear((0.12, 0.5), (0.88, 0.5)))


def plot_contact_zone(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Von Mises stress around the contact of `plot_stress_field`, some half widths wide."""
    reach, most = _ZONE * result.shown.contact.hertz_half_width, result.stress_field.greatest
    return _plot_field(result, ax, reach, most, PerGear((0.5, 0.06), (0.5, 0.94)))


def _plot_field(result: PlaneCheck, ax: Axes | None, reach: float, most: float, names: PerGear[tuple[float, float]]) -> Axes:
    """Fields within `reach` (mm) of the contact, colours up to `most` (MPa), the gears' names at parts of the axes."""
    axes, stress = new_figure().subplots() if ax is None else ax, result.stress_field
    for field in stress.fields:
        drawn = axes.tripcolor(
            *field.points.T, field.triangles, field.von_mises, shading="gouraud", vmin=0, vmax=most, cmap=_COLOUR_MAP
        )
        drawn.set_rasterized(True)
        axes.plot(*field.outline.T, color=DARK, linewidth=0.9)
    extend = "max" if stress.greatest > most else "neither"
    axes.figure.colorbar(drawn, ax=axes, label="von Mises stress in MPa", extend=extend)
    axes.set_aspect("equal")
    axes.set_xlim(stress.x - 1.45 * reach, stress.x + 1.45 * reach)
    axes.set_ylim(stress.y - reach, stress.y + reach)
    sense = "away from the ring's" if result.pair.internal else "towards the wheel's"
    axes.set_xlabel(f"from the pinion's axis {sense} in mm")
    axes.set_ylabel("across in mm")
    for role, place in names.items():
        axes.text(*place, role.value, transform=axes.transAxes, ha="center", va="center", fontsize=9, bbox=_ON_WHITE)
    return axes


def plot_fillets(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Stress along both fillets of each gear at its worst position, over the tangent's angle to the middle of the tooth."""
    axes = prepared(ax, "tangent angle, from the middle of the tooth, in °", "stress along the fillet in MPa")
    for role, (words, colour, marker) in GEARS.items():
        curves, found = result.fillet_curves.pick(role), result.root_peaks.pick(role)
        for kind, curve, style in (("tension", curves.tension, "-"), ("compression", curves.compression, "--")):
            root = curve.angles >= _LEAST_ANGLE
            axes.plot(curve.angles[root], curve.stresses[root], color=colour, linestyle=style, label=f"{words}, {kind}")
        all_round = " of all teeth" if result.bending.pick(role) else ""
        label = f"{words}, greatest{all_round}: {found.tangent_angle:.0f}°"
        axes.plot([found.tangent_angle], [found.stress], marker, color=colour, label=label)
    for angle in sorted({root.section.lean for root in result.rating.roots}):
        axes.axvline(angle, color=MARKED, linestyle=":", label=f"{angle:g}°, ISO 6336-3")
    axes.axhline(0, color=MARKED, linewidth=0.8)
    legend_above(axes, 3)
    return axes


def plot_depth_profile(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Stresses below the middle of the worst contact by the pressures found (lines), and by Hertz (dots)."""
    axes = prepared(ax, "depth below the flank in mm", "stress in MPa")
    profile = result.depth_profile
    depth = profile.found.depth
    for (name, words), colour in zip(_DEPTH_WORDS.items(), SERIES, strict=True):
        axes.plot(depth, getattr(profile.found, name), color=colour, linewidth=1.3, label=words)
        axes.plot(depth[::10], getattr(profile.hertz, name)[::10], "o", color=colour, markersize=3.5, markerfacecolor="none")
    axes.plot([], [], "o", color=DARK, markersize=3.5, markerfacecolor="none", label="dots: Hertz")
    axes.axhline(0, color=MARKED, linewidth=0.8)
    axes.set_xlim(left=0)
    legend_above(axes, 3)
    return axes


_DEPTH_WORDS = {
    "sigma_x": r"$\sigma_x$, along the profile",
    "sigma_y": r"$\sigma_y$, along the tooth",
    "sigma_z": r"$\sigma_z$, into the tooth",
    "largest_shear": r"$\tau$, greatest shear",
    "von_mises": "von Mises",
}
"""Stresses of a depth profile as the legend has them."""
