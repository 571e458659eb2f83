"""Pictures of a rating, of a search for sizes, and of a measured gear."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gearcad.core.errors import GeometryError
from gearcad.core.records import Role
from gearcad.dynamics.planetary.planetary_strength import TrainStrength
from gearcad.plots.paper import DARK, GEARS, MARKED, SERIES, legend_above, new_figure, plain, prepared, short
from gearcad.rating.scuffing import Scuffing
from gearcad.rating.strength import RatedPart, StrengthRating

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from gearcad.identify import Candidate, Identification
    from gearcad.sizing import Sizing


_FEWEST, _MOST = 1e2, 1e11
"""Least and largest number of load cycles on the axis."""

_ABOVE, _BELOW = 1.12, 0.88
_BAR = 0.36
"""Width of a bar, of the distance between gears."""


def plot_life(rating: StrengthRating, part: RatedPart = RatedPart.FLANK, ax: Axes | None = None) -> Axes:
    """Strength over load cycles in logarithms, with the loads: stress and cycles of each gear.

    Raises GeometryError where no strength is known.
    """
    if all(of.resistance is None for of in rating.parts[part]):
        raise GeometryError("material", rating.name, f"must have limits of the {part.value}, for its life to be drawn")
    axes = prepared(ax, "load cycles of a tooth", f"{'contact' if part is RatedPart.FLANK else 'root'} stress in MPa")
    axes.set_xscale("log")
    axes.set_yscale("log")
    seen: list[float] = []
    for role in Role:
        of = rating.parts[part].pick(role)
        if of.resistance is None:
            continue
        (_, colour, _), own = GEARS.pick(role), rating.gear_names.pick(role)
        cycles, stress = map(np.array, zip(*of.resistance.curve, strict=True))
        ends = np.concatenate([[_FEWEST], cycles, [_MOST]]), np.concatenate([stress[:1], stress, stress[-1:]])
        style = "-" if role is Role.PINION else "--"
        axes.plot(*ends, color=colour, linestyle=style, label=f"strength of the {own}")
        seen += [*stress, *_loads(axes, rating, part, role)]
    axes.set_xlim(_FEWEST, _MOST)
    low, high = _BELOW * min(seen), _ABOVE * max(seen)
    axes.set_ylim(low, high)
    ticks = [each for each in (50, 100, 150, 200, 300, 400, 500, 700, 1000, 1500, 2000, 3000, 5000) if low <= each <= high]
    axes.set_yticks(ticks, [short(each) for each in ticks])
    axes.minorticks_off()
    legend_above(axes, 2)
    return axes


def _loads(axes: Axes, rating: StrengthRating, part: RatedPart, role: Role) -> list[float]:
    """Return a mark for each load of a gear; a line where its cycles are not known. Returns the stresses (MPa)."""
    (_, colour, marker), cycles = GEARS.pick(role), rating.parts[part].pick(role).cycles
    stresses = [case.stresses[part].pick(role) for case in rating.cases]
    words = f"stress of the {rating.gear_names.pick(role)}"
    if cycles is not None:
        counts = [cycles * case.cycle_share for case in rating.cases]
        axes.plot(np.clip(counts, _FEWEST, _MOST), stresses, marker, color=colour, markersize=7, label=words)
    elif stresses:
        axes.axhline(max(stresses), color=colour, linewidth=0.9, linestyle=":", label=f"{words}, {short(max(stresses))} MPa")
    return stresses


def plot_safeties(strength: TrainStrength, ax: Axes | None = None) -> Axes:
    """Draw the least safety of flank and root of every gear of a train, with the safeties that are required.

    Raises GeometryError where none was judged.
    """
    gears, columns = strength.members, tuple(RatedPart)
    known = [each for gear in gears.values() for each in map(gear.least, columns) if each is not None]
    if not known:
        raise GeometryError("material", strength.name, "must have limits, for safeties to be drawn")
    axes = prepared(ax, "", "least safety")
    for number, part in enumerate(columns):
        off = (number - 0.5) * _BAR
        found = [(place + off, least.safety) for place, gear in enumerate(gears.values()) if (least := gear.least(part))]
        if found:
            places, safeties = zip(*found, strict=True)
            axes.bar(places, safeties, 0.9 * _BAR, color=SERIES[number], label=part.value)
        required = {each.required for gear in gears.values() for each in gear.every if each.part is part}
        for value in sorted(required):
            axes.axhline(value, color=SERIES[number], linestyle="--", linewidth=1.1, label=f"required, {short(value)}")
    axes.set_xticks(range(len(gears)), list(map(plain, gears)))
    axes.set_ylim(0, 1.1 * max(each.safety for each in known))
    legend_above(axes, 2)
    return axes


def plot_flash(scuffing: Scuffing, ax: Axes | None = None) -> Axes:
    """Contact temperature along the path of contact, above that of the teeth, with the one at which the oil fails."""
    axes = prepared(ax, "place on the path of contact, Γ (0: pitch point)", "temperature in °C")
    found = scuffing.flash
    assert found is not None  # asked for where there is one
    axes.plot(found.path.places, found.contact, color=SERIES[1], label=f"contact, at most {short(found.value)} °C")
    axes.axhline(found.bulk, color=SERIES[0], linewidth=1.1, label=f"teeth, {short(found.bulk)} °C")
    axes.axhline(found.oil_temperature, color=SERIES[2], linewidth=1.1, label=f"oil, {short(found.oil_temperature)} °C")
    if scuffing.limits is not None:
        limit = scuffing.limits.flash
        axes.axhline(limit, color=DARK, linestyle="-.", linewidth=1.2, label=f"scuffing, {short(limit)} °C")
    axes.axvline(0, color=MARKED, linewidth=0.8)
    axes.set_ymargin(0.1)
    axes.set_ylim(bottom=0)
    legend_above(axes, 2)
    return axes


_INCHES, _DOTS = (7.2, 4.6), 150
_BLUE, _RED = (each[1] for each in GEARS)
_WIDE = 3.0
"""Greatest mass shown, as a multiple of the lightest: heavier pairs were never candidates."""


def plot_front(result: Sizing, ax: Axes | None = None) -> Axes:
    """Draw masses (kg) over margins: the best of each combination, the front, and the pairs that are listed."""
    given = ax if ax is not None else new_figure(_INCHES).subplots()
    axes = prepared(given, "mass of both gears in kg", "least safety over that required")
    axes.plot(*result.cloud, ".", color="#bbbbbb", markersize=3, label="best of each teeth, module and helix angle")
    places = np.array([(each.mass, each.margin) for each in result.front]).T
    axes.step(*places, where="post", color=_RED, linewidth=1.2, label="front: none of the variants is lighter and safer")
    listed = [(each.mass, each.margin) for each in result.found]
    axes.plot(*zip(*listed, strict=True), "o", color=_BLUE, markersize=4, label="listed, refined")
    load = result.task.load
    axes.set_title(f"{load.torque:.4g} N·m at {load.speed:g} rpm, u = {result.task.ratio:g}", fontsize=10)
    lightest = min(float(places[0, 0]), *(mass for mass, _ in listed))
    heaviest = min(float(places[0, -1]), _WIDE * lightest) if places.shape[1] > 1 else 1.2 * lightest
    heaviest = max(heaviest, *(mass for mass, _ in listed))
    axes.set_xlim(0.95 * lightest, 1.03 * heaviest)
    shown = [float(margin) for mass, margin in places.T if mass <= heaviest] + [margin for _, margin in listed]
    axes.set_ylim(0.98, 1.03 * max(shown))
    axes.legend(loc="upper left", fontsize=8)
    return axes


def save_front(result: Sizing, path: Path) -> None:
    """Write the picture as PNG, in the style of matplotlib whatever the user's own is."""
    from matplotlib import style

    with style.context("default"):
        figure = new_figure(_INCHES)
        plot_front(result, figure.subplots())
        figure.savefig(path, dpi=_DOTS)


_MEASURED_MOST = 3
_USUAL = 2.0
"""Uncertainties by which a reading is off now and then."""

_MARKS = "osD"


def plot_residuals(found: Identification, ax: Axes | None = None) -> Axes:
    """Draw the residuals of the most probable candidates for each reading, in uncertainties of the reading."""
    axes = prepared(ax, "off, in uncertainties", "")
    rows = [place for place, each in enumerate(found.measured.readings) if each.value]
    axes.axvspan(-_USUAL, _USUAL, color="#eeeeee", zorder=0)
    for number, (each, mark) in enumerate(zip(found.candidates[:_MEASURED_MOST], _MARKS, strict=False)):
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
