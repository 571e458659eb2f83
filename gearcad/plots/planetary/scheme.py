"""The scheme of a train: its skeleton in half section, every part named beside it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from gearcad.per_gear import Role
from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.power import PowerFlow
from gearcad.plots.labels import plain
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, new_figure
from gearcad.plots.planetary.callouts import LINE, lines_of, spread
from gearcad.plots.planetary.parts import colour_of, rim_words, role_words, signed, stage_gear
from gearcad.plots.planetary.skeleton import Callout, Ground, Plan, Weight, plan_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["plot_scheme", "scheme_inches"]

_COLUMN, _LEADER = 1.5, 0.25
"""Widths (inches): of a column of names, and of the lines towards it."""

_MARGIN = 0.12

_ARROW = {"arrowstyle": "-|>", "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0}


def scheme_inches(train: PlanetaryTrain, flow: PowerFlow | None = None) -> tuple[float, float]:
    """Size of the scheme of a train."""
    (left, low, right, high), _ = _laid_out(plan_of(train, flow), train)
    return max(FIGURE_INCHES[0], right - left), high - low


def plot_scheme(train: PlanetaryTrain, ax: Axes | None = None, flow: PowerFlow | None = None) -> Axes:
    """Half section of the train in symbols: bars are teeth, hatched lines do not turn, power goes in and out along arrows.

    Without its `flow` these are at input and output.
    """
    plan = plan_of(train, flow)
    (left, low, right, high), names = _laid_out(plan, train)
    axes = new_figure(scheme_inches(train, flow)).subplots() if ax is None else ax
    for stroke in plan.strokes:
        style = (0, (12, 3, 2, 3)) if stroke.weight is Weight.AXIS else "-"
        axes.plot(
            *zip(*stroke.points, strict=True),
            color=colour_of(train, stroke.part) if stroke.part else MARKED,
            linewidth=stroke.weight.value,
            linestyle=style,
            solid_capstyle="butt",
            solid_joinstyle="miter",
            zorder=1 if stroke.weight is Weight.AXIS else 3,
        )
    for ground in plan.grounds:
        _hatch(axes, ground)
    for arrow in plan.arrows:
        colour = colour_of(train, arrow.part)
        axes.annotate(
            "",
            arrow.end,
            arrow.start,
            arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0},
        )
    for callout, lines, height, x in names:
        _name(axes, train, callout, lines, (x, height))
    axes.set_axis_off()
    axes.set_aspect("equal")
    spare = max(FIGURE_INCHES[0] - (right - left), 0.0) / 2
    axes.set_xlim(left - spare, right + spare)
    axes.set_ylim(low, high)
    return axes


_Name = tuple[Callout, list[str], float, float]
"""What is named, in which lines, how high, and from where on."""


def _laid_out(plan: Plan, train: PlanetaryTrain) -> tuple[tuple[float, float, float, float], list[_Name]]:
    """The box of the picture, and all names in it."""
    left, low, right, high = plan.box
    xs = [point[0] for arrow in plan.arrows for point in (arrow.start, arrow.end)]
    left, right = min([left, *xs]) - _LEADER, max([right, *xs]) + _LEADER
    names: list[_Name] = []
    for side, x in ((-1, left), (1, right)):
        here = [each for each in plan.callouts if each.side == side]
        texts = [_words(train, each.part, plan.ways) for each in here]
        heights = spread([each.anchor[1] for each in here], [LINE * len(lines) for lines in texts])
        names += [(each, lines, height, x) for each, lines, height in zip(here, texts, heights, strict=True)]
    low = min([low, *(height - LINE * len(lines) / 2 for _, lines, height, _ in names)])
    high = max([high + 0.1 * bool(plan.grounds), *(height + LINE * len(lines) / 2 for _, lines, height, _ in names)])
    return (left - _COLUMN, low - _MARGIN, right + _COLUMN, high + _MARGIN), names


def _words(train: PlanetaryTrain, part: str, ways: Mapping[str, str]) -> list[str]:
    """A part's name, its teeth, what it is to the train, and which way power goes there."""
    role = role_words(train, part, ways)
    for rim in train.rims:
        if rim.name == part:
            return lines_of(rim_words(train, rim), signed(rim.gear))
    texts = [part]
    texts += [signed(central.gear) for central in train.centrals if central.name == part]
    floating = [each.name for each in train.centrals if each.support_stiffness == 0]
    floating += [train.carrier.name] * (train.carrier.support_stiffness == 0)
    role = ", ".join(each for each in (role, "floating" if part in floating else "") if each)
    for stage in train.stages:
        for gear_role, shaft in ((Role.PINION, stage.pinion), (Role.WHEEL, stage.wheel)):
            if shaft == part:
                name, teeth = stage_gear(stage, gear_role), signed(stage.pair.gears.pick(gear_role))
                texts.append(teeth if name == part else f"{name}: {teeth}")
    return lines_of(*texts, *([role] if role else []))


def _name(axes: Axes, train: PlanetaryTrain, callout: Callout, lines: list[str], at: tuple[float, float]) -> None:
    """A name in its column, and a thin line to its part."""
    (x, y), side = at, callout.side
    axes.plot([callout.anchor[0], x], [callout.anchor[1], y], color=MARKED, linewidth=0.6, zorder=2)
    if callout.dotted:
        axes.plot(*callout.anchor, "o", color=colour_of(train, callout.part), markersize=3, zorder=4)
    align = "right" if side < 0 else "left"
    axes.text(
        x + side * 0.05, y, plain("\n".join(lines)), ha=align, va="center", fontsize=8, color=DARK, linespacing=1.25
    )  # fmt: skip


def _hatch(axes: Axes, ground: Ground) -> None:
    """A line across, and short slanted ones behind it."""
    (x, y), (right, up) = ground.at, ground.away
    half, depth, count = 0.16, 0.08, 5
    across = (abs(up), abs(right))
    if right and y > 0:
        y += half - 0.02  # above a hollow shaft: the one in it does turn
    ends = [(x - sign * half * across[0], y - sign * half * across[1]) for sign in (1, -1)]
    axes.plot(*zip(*ends, strict=True), color=DARK, linewidth=1.4, zorder=4)
    for number in range(count):
        along = -half + (number + 0.3) * 2 * half / count
        start = (x + along * across[0], y + along * across[1])
        end = (start[0] + depth * (right or 1), start[1] + depth * (up or 1))
        axes.plot(*zip(start, end, strict=True), color=DARK, linewidth=0.8, zorder=4)
