"""A picture of a pair: both gears in mesh as they stand, seen along their axes."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import GeometryError
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.helix import twist
from gearcad.plots.paper import DARK, GEARS, MARKED, SERIES, legend_above, new_figure, prepared
from gearcad.rating.rim import outer_diameter

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["fill_gear", "pair_inches", "plot_backlash", "plot_pair", "plot_sliding"]


_CHORD = 2e-3
"""Error of the outlines, in normal modules: nobody sees it."""

_WIDTH, _LEAST, _MOST = 6.6, 2.2, 5.0
"""Inches: width of the picture, and between what its height lies."""

_MARGIN = 0.4
"""Around the gears, in normal modules."""

_MOVED, _PLACES = 0.06, 61
"""How far the centre distance changes where backlash is drawn, in normal modules, and at how many places."""


def pair_inches(pair: GearPair) -> tuple[float, float]:
    """Size of a picture of the pair, as high as its larger gear asks for."""
    if pair.internal:
        return _WIDTH, _MOST
    tips = [gear.tip_diameter for gear in (pair.pinion, pair.wheel)]
    height = _WIDTH * max(tips) / (sum(tips) / 2 + pair.centre_distance)
    return _WIDTH, min(max(height, _LEAST), _MOST)


def plot_pair(pair: GearPair, ax: Axes | None = None) -> Axes:
    """A transverse section of both gears, a tooth of the pinion in a space of the wheel, by the exact outlines unmodified.

    Working pitch circles are dash-dotted; the path of contact of left flanks, from A to E, is drawn on the line of action.
    """
    from matplotlib.patches import Circle

    axes = new_figure(pair_inches(pair)).subplots() if ax is None else ax
    turn = _helix_turn(pair)
    gears = ((pair.pinion, 0.0, 0.0), (pair.wheel, pair.centre_distance, pair.wheel_pose(-turn).rotation))
    for (gear, x, rotation), (_, colour, _), pitch in zip(gears, GEARS, pair.working_pitch_diameters, strict=True):
        fill_gear(axes, gear, (x, 0.0), math.radians(rotation), colour)
        axes.add_patch(Circle((x, 0), abs(pitch) / 2, fill=False, edgecolor=DARK, linestyle="-.", linewidth=0.7))
        axes.plot(x, 0, "+", color=DARK, markersize=9, markeredgewidth=0.8)
    line = _line_of_action(pair)
    axes.plot(*line.T, color=MARKED, linewidth=0.8)
    axes.plot(*line[1:3].T, color=DARK, linewidth=2.2, solid_capstyle="butt")
    axes.set_aspect("equal")
    axes.margins(0)
    margin = _MARGIN * pair.pinion.normal_module
    if pair.internal:
        reach = outer_diameter(pair.wheel) / 2 + margin
        axes.set_xlim(pair.centre_distance - reach, pair.centre_distance + reach)
        axes.set_ylim(-reach, reach)
    else:
        axes.set_xlim(-pair.pinion.tip_diameter / 2 - margin, pair.centre_distance + pair.wheel.tip_diameter / 2 + margin)
        axes.set_ylim(*(side * (max(pair.pinion.tip_diameter, pair.wheel.tip_diameter) / 2 + margin) for side in (-1, 1)))
    axes.set_axis_off()
    return axes


def plot_backlash(pair: GearPair, ax: Axes | None = None) -> Axes:
    """Backlash at the working circles and along the base normal over the centre distance, where the pair can be mounted."""
    axes = prepared(ax, "change of the centre distance in µm", "backlash in µm")
    moved, found = [], []
    reach, side = _MOVED * pair.pinion.normal_module, -1 if pair.internal else 1
    for change in np.linspace(-reach, reach, _PLACES).tolist():
        with suppress(GeometryError):
            at = replace(pair, centre_distance=pair.centre_distance + side * change)
            moved.append(1000 * change)
            found.append((1000 * at.circumferential_backlash, 1000 * at.normal_backlash))
    for values, words, colour in zip(
        np.transpose(found), ("circumferential, at the working circles", "along the base normal"), SERIES, strict=False
    ):
        axes.plot(moved, values, color=colour, label=words)
    axes.axvline(0, color=MARKED, linewidth=0.8)
    nominal = (pair.circumferential_backlash, pair.normal_backlash)
    axes.plot([0, 0], [1000 * each for each in nominal], "o", color=DARK, label=f"at {abs(pair.centre_distance):.7g} mm")
    axes.set_ylim(bottom=0)
    legend_above(axes, 3)
    return axes


def plot_sliding(pair: GearPair | RackPair, ax: Axes | None = None) -> Axes:
    """Draw the specific sliding of both flanks along the path of contact, from the first to the last contact."""
    axes = prepared(ax, "distance from T1 in mm", "specific sliding ζ")
    path, (first, last) = pair.path_of_contact, pair.usable_path
    along = np.linspace(first, last, _PLACES)
    names = ("pinion", "wheel" if isinstance(pair, GearPair) else "rack")
    for values, name, (_, colour, _) in zip(pair.specific_sliding_at(along), names, GEARS, strict=True):
        axes.plot(along, np.where(np.isfinite(values), values, np.nan), color=colour, label=name)
    axes.axhline(0, color=MARKED, linewidth=0.8)
    for name, place in path._asdict().items():
        if first <= place <= last:
            axes.axvline(place, color=MARKED, linewidth=0.5, linestyle=":")
            axes.annotate(name, (place, 1), xycoords=("data", "axes fraction"), ha="center", va="bottom")
    axes.legend()
    return axes


def _helix_turn(pair: GearPair) -> float:
    """How far (deg) a helical pinion's section at the wheel's lower end is turned: what `wheel_pose` takes into account."""
    return math.degrees(twist(pair.pinion, pair.wheel_pose().z))


def fill_gear(
    axes: Axes, gear: Gear, place: tuple[float, float], rotation: float, colour: str, chord: float | None = None
) -> None:
    """A section about a place, turned by `rotation` (rad), its bore left out; that of a ring out to its rim.

    `chord` (mm) is the greatest error of the outline; none: what nobody sees where a pair fills the picture.
    """
    from matplotlib.patches import Circle, PathPatch
    from matplotlib.path import Path

    cosine, sine = math.cos(rotation), math.sin(rotation)
    outline = gear.profile.contour(chord or _CHORD * gear.normal_module) @ np.array([[cosine, sine], [-sine, cosine]]) + place
    if gear.internal:
        rim = Path.circle(place, outer_diameter(gear) / 2)
        opening = Path(np.r_[outline[::-1], outline[-1:]], closed=True)
        axes.add_patch(
            PathPatch(Path.make_compound_path(rim, opening), facecolor=f"{colour}40", edgecolor=colour, linewidth=0.9)
        )
        return
    axes.fill(*outline.T, facecolor=f"{colour}40", edgecolor=colour, linewidth=0.9)
    if gear.body.bore:
        axes.add_patch(Circle(place, gear.body.bore / 2, facecolor="white", edgecolor=colour, linewidth=0.9))


def _line_of_action(pair: GearPair) -> Floats:
    """T1, A, E and T2 (4, 2) in mm, where the pinion's left flanks press the wheel's."""
    angle = math.radians(pair.working_transverse_pressure_angle)
    base = pair.pinion.base_diameter / 2
    path, whole = pair.path_of_contact, pair.centre_distance * math.sin(angle)
    first = base * np.array([math.cos(angle), -math.sin(angle)])
    result: Floats = first + np.outer([0.0, path.A, path.E, whole], [math.sin(angle), math.cos(angle)])
    return result
