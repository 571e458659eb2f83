"""Pictures of a rating: what flanks and roots bear over their load cycles, and temperatures along the path of contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.dynamics.planetary.strength import TrainStrength
from gearcad.errors import GeometryError
from gearcad.per_gear import Role
from gearcad.plots.labels import plain
from gearcad.plots.paper import DARK, GEARS, MARKED, SERIES, legend_above, prepared, short
from gearcad.rating.scuffing import Scuffing
from gearcad.rating.strength import Part, StrengthRating

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["plot_flash", "plot_life", "plot_safeties"]

_FEWEST, _MOST = 1e2, 1e11
"""Load cycles that are shown."""

_ABOVE, _BELOW = 1.12, 0.88
_BAR = 0.36
"""Width of a bar, of the distance between gears."""


def plot_life(rating: StrengthRating, part: Part = Part.FLANK, ax: Axes | None = None) -> Axes:
    """Strength over load cycles in logarithms, with the loads: stress and cycles of each gear.

    Raises GeometryError where no strength is known.
    """
    if all(of.resistance is None for of in rating.parts[part]):
        raise GeometryError("material", rating.name, f"must have limits of the {part.value}, for its life to be drawn")
    axes = prepared(ax, "load cycles of a tooth", f"{'contact' if part is Part.FLANK else 'root'} stress in MPa")
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


def _loads(axes: Axes, rating: StrengthRating, part: Part, role: Role) -> list[float]:
    """A mark for each load of a gear; a line where its cycles are not known. Returns the stresses (MPa)."""
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
    """Least safety of flank and root of every gear of a train, with the safeties that are required.

    Raises GeometryError where none was judged.
    """
    gears, columns = strength.members, tuple(Part)
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
