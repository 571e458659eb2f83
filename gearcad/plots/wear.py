"""Pictures of wear: profiles of a flank, and transmission error, root stress and load share of new and worn teeth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.check.wear import WearResult, WornState
from gearcad.core.records import Role
from gearcad.plots.paper import GEARS, SERIES, legend_above, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CURVES = 5
"""States that a picture shows, the first and the last among them."""


def shown_states(result: WearResult) -> list[WornState]:
    """Return some of the states, from the first to the last."""
    last = len(result.states) - 1
    return [result.states[at] for at in sorted({round(last * part / (_CURVES - 1)) for part in range(_CURVES)})]


def _words(state: WornState) -> str:
    return f"{state.cycles:.3g} load cycles" if state.cycles else "new"


def plot_worn_profile(result: WearResult, role: Role, ax: Axes | None = None) -> Axes:
    """Draw the depth of a flank over its roll, from the root to the tip, in some states."""
    axes = prepared(ax, f"roll length on the {role.value} in mm, root to tip", "depth in µm")
    for at, state in enumerate(shown_states(result)[1:]):
        axes.plot(*result.profile(state, role), color=SERIES[at % len(SERIES)], label=_words(state))
    axes.invert_yaxis()
    legend_above(axes, 2)
    return axes


def plot_worn_share(result: WearResult, ax: Axes | None = None) -> Axes:
    """Draw the load share of a pair of teeth along the line of action, of the new and of the worn pair."""
    axes = prepared(ax, "place on the line of action, from T$_1$, in mm", "load share")
    for at, state in enumerate((result.states[0], result.states[-1])):
        found = [(contact.place, contact.share) for position in state.cycle.positions for contact in position.contacts]
        places, shares = np.array(sorted(found)).T
        axes.plot(places, shares, color=SERIES[at], label=_words(state))
    legend_above(axes, 2)
    return axes


def plot_worn_error(result: WearResult, ax: Axes | None = None) -> Axes:
    """Draw the transmission error over one base pitch in some states."""
    axes = prepared(ax, "roll angle of the pinion in °, 0 at C", "transmission error in µm")
    for at, state in enumerate(shown_states(result)):
        cycle = state.cycle
        axes.plot(
            cycle.values("roll_angle"),
            cycle.values("transmission_error"),
            color=SERIES[at % len(SERIES)],
            label=_words(state),
        )
    legend_above(axes, 2)
    return axes


def plot_worn_roots(result: WearResult, ax: Axes | None = None) -> Axes:
    """Draw the greatest root tension of both gears over the load cycles."""
    axes = prepared(ax, "load cycles of the pinion", "greatest root tension in MPa")
    cycles = [state.cycles for state in result.states]
    for role, (name, colour, _) in GEARS.items():
        axes.plot(cycles, [state.root_stresses.pick(role) for state in result.states], color=colour, label=name)
    legend_above(axes, 2)
    return axes
