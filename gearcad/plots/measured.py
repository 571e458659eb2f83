"""The picture of a measured gear: how far its candidates are off the readings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.plots.labels import plain
from gearcad.plots.paper import SERIES, legend_above, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from gearcad.identify import Candidate, Identification

__all__ = ["plot_residuals"]

_MOST = 3
_USUAL = 2.0
"""Uncertainties by which a reading is off now and then."""

_MARKS = "osD"


def plot_residuals(found: Identification, ax: Axes | None = None) -> Axes:
    """How far the most probable candidates are off each reading, in its uncertainties."""
    axes = prepared(ax, "off, in uncertainties", "")
    rows = [place for place, each in enumerate(found.measured.readings) if each.value]
    axes.axvspan(-_USUAL, _USUAL, color="#eeeeee", zorder=0)
    for number, (each, mark) in enumerate(zip(found.candidates[:_MOST], _MARKS, strict=False)):
        places = [row + 0.2 * (number - 1) for row in range(len(rows))]
        axes.plot([each.residuals[row] for row in rows], places, mark, color=SERIES[number], markersize=6, label=_name(each))
    axes.set_yticks(range(len(rows)), [plain(found.measured.label(found.measured.readings[row])) for row in rows])
    axes.set_ylim(len(rows) - 0.5, -0.5)
    legend_above(axes, 1)
    return axes


def _name(each: Candidate) -> str:
    gear = each.gear
    pitch = None if each.transverse else each.diametral_pitch
    size = f"module {gear.normal_module:.4g}" if pitch is None else f"DP {pitch:g}"
    helix = f", helix {gear.helix_angle:.3g}°" if gear.helix_angle else ""
    return f"{size}, {gear.rack.pressure_angle:.4g}°{helix}, x {gear.profile_shift:.3f}: {100 * each.probability:.1f} %"
