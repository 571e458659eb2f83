"""Pictures of one gear: its section, how its flanks are modified, and how far its profile can be shifted."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from gearcad.errors import GeometryError
from gearcad.geometry import Gear
from gearcad.geometry.bracketed import root_between
from gearcad.geometry.involute import involute
from gearcad.geometry.tooling import shaped
from gearcad.plots.pair import fill_gear
from gearcad.plots.paper import DARK, GEARS, MARKED, SERIES, legend_above, new_figure, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["plot_gear", "plot_modification", "plot_shift_limits", "pointed_shift", "undercut_shift"]

_SQUARE = (4.6, 4.6)
"""Inches of a picture of one gear."""

_ROUND = 721
"""Places on a circle."""

_ALONG, _UP = 61, 81
"""Places along the face and the profile at which a modification is drawn."""

_FEWEST, _LEAST_MOST = 6, 40
"""Teeth from which shifts are drawn, and up to which at least."""

_LANDS = (0.0, 0.2, 0.4)
"""Thicknesses of the tip, in normal modules, whose shifts are drawn."""

_FARTHEST = 5.0
"""Shift up to which a tip that thin is looked for."""


def plot_gear(gear: Gear, ax: Axes | None = None) -> Axes:
    """A transverse section by the exact outline, unmodified, with reference and base circle."""
    axes = new_figure(_SQUARE).subplots() if ax is None else ax
    fill_gear(axes, gear, (0.0, 0.0), 0.0, GEARS.pinion[1])
    round_about = np.linspace(0, 2 * math.pi, _ROUND)
    for name, diameter, style in (
        ("reference", abs(gear.reference_diameter), "-."),
        ("base", abs(gear.base_diameter), ":"),
    ):
        circle = diameter / 2 * np.cos(round_about), diameter / 2 * np.sin(round_about)
        axes.plot(*circle, color=DARK, linestyle=style, linewidth=0.8, label=f"{name} circle {diameter:.5g} mm")
    axes.plot(0, 0, "+", color=DARK, markersize=9, markeredgewidth=0.8)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.02)
    axes.set_axis_off()
    legend_above(axes, 2)
    return axes


def plot_modification(gear: Gear, ax: Axes | None = None) -> Axes:
    """How far (µm) the left flank is taken back, along the face and from the root form circle to the tip form circle.

    Raises GeometryError for a gear whose flanks are not modified.
    """
    form = gear.flank_form
    if not form.modification.present:
        raise GeometryError("modification", "none", "must be given, to be drawn: such as tip_relief")
    axes = prepared(new_figure().subplots() if ax is None else ax, "along the axis, z in mm", "diameter in mm")
    heights, rolls = np.linspace(0, form.width, _ALONG), np.linspace(form.first, form.last, _UP)
    depth = 1000 * form.depth(rolls[:, None], heights[None, :])
    diameters = 2 * np.hypot(rolls, form.base_radius)
    drawn = axes.pcolormesh(heights, diameters, depth, cmap="viridis", shading="gouraud")
    drawn.set_rasterized(True)
    if np.ptp(depth) > 0:
        lines = axes.contour(heights, diameters, depth, colors="white", linewidths=0.7)
        axes.clabel(lines, fontsize=8)
    axes.figure.colorbar(drawn, ax=axes, label="taken back in µm")
    return axes


def plot_shift_limits(gear: Gear, ax: Axes | None = None) -> Axes:
    """Shifts over numbers of teeth at which the gear's hob undercuts and tips get thin, and where the gear itself is.

    Raises GeometryError for a ring and a gear of a shaper cutter.
    """
    if shaped(gear):
        raise GeometryError("teeth", gear.teeth, "must be those of an external gear that is hobbed, for its shift to be drawn")
    axes = prepared(ax, "number of teeth", "profile shift x")
    most = max(_LEAST_MOST, round(1.5 * gear.teeth))
    teeth = np.arange(_FEWEST, most + 1)
    axes.plot(teeth, [undercut_shift(gear, int(z)) for z in teeth], color=SERIES[1], label="undercut below")
    for land, style in zip(_LANDS, ("-", "--", ":"), strict=True):
        words = f"tip thickness {land:g} $m_n$" if land else "pointed above"
        axes.plot(teeth, [pointed_shift(gear, int(z), land) for z in teeth], color=SERIES[0], linestyle=style, label=words)
    axes.plot(
        gear.teeth, gear.profile_shift, "o", color=DARK, label=f"this gear: z = {gear.teeth}, x = {gear.profile_shift:.4g}"
    )
    axes.axhline(0, color=MARKED, linewidth=0.8)
    axes.set_xlim(_FEWEST, most)
    legend_above(axes, 3)
    return axes


def undercut_shift(gear: Gear, teeth: int) -> float:
    """x_E: the shift below which the gear's hob undercuts so many teeth.

    The straight flank of the hob ends h_fP - rho_fP (1 - sin alpha_n) below its datum line, and where that is deeper than
    z sin² alpha_t/(2 cos beta) below the pitch line it cuts into the involute (DIN 3960).
    """
    sine = math.sin(math.radians(gear.transverse_pressure_angle))
    straight = gear.dedendum - gear.root_radius * (1 - math.sin(math.radians(gear.rack.pressure_angle)))
    return straight - teeth * sine**2 / (2 * math.cos(math.radians(gear.helix_angle)))


def pointed_shift(gear: Gear, teeth: int, land: float) -> float:
    """The shift at which so many teeth with the gear's rack and tip alteration are `land` normal modules thick at the tip.

    Not a number where that is above 5.
    """
    beta, alpha = math.radians(gear.helix_angle), math.radians(gear.transverse_pressure_angle)
    normal, radius = math.radians(gear.rack.pressure_angle), teeth / (2 * math.cos(beta))
    thinned = gear.tooth_thinning / gear.normal_module

    def excess(shift: float) -> float:
        tip = radius + gear.rack.addendum + shift + gear.tip_alteration
        half = (math.pi / 2 + 2 * shift * math.tan(normal) - thinned) / (2 * radius * math.cos(beta))
        angle = math.degrees(math.acos(radius * math.cos(alpha) / tip))
        helix = math.atan(math.tan(beta) * tip / radius)
        return 2 * tip * (half + involute(math.degrees(alpha)) - involute(angle)) * math.cos(helix) - land

    least = -gear.rack.addendum - gear.tip_alteration
    return root_between(excess, least, _FARTHEST, xtol=1e-12) if excess(_FARTHEST) < 0 else math.nan
