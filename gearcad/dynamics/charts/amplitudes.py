"""Where inertias, flanks and axes swing farthest, and where bearings carry most."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.charts.chart import KvChart
from gearcad.dynamics.charts.findings import Charts
from gearcad.dynamics.response.direction import Direction

__all__ = ["GreatestAmplitude", "GreatestBearingForce", "greatest_amplitudes", "greatest_bearing_forces"]


_ACROSS = "travel across the line of action"
"""Of gears whose bearings are alike in all directions there is none."""


_MICROMETRES = "µm"

_NOISE = 1e-9
"""Of the greatest amplitude: travel across that is no more comes from rounding."""


class GreatestAmplitude(NamedTuple):
    """Half of peak to peak of what `quantity` of an inertia, a mesh or a gear says, in `unit`, where it is greatest.

    `speed` in rpm and `frequency`, that of the teeth of the first mesh, in 1/s; no direction where up and down are the same.
    """

    quantity: str
    name: str
    amplitude: float
    unit: str
    speed: float
    frequency: float
    direction: Direction | None

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {**self._asdict(), "direction": None if self.direction is None else self.direction.value}


class GreatestBearingForce(NamedTuple):
    """The greatest force on the bearings of a `gear` (N), beside that at rest, which is the mean too."""

    gear: str
    force: float
    static: float
    speed: float
    frequency: float
    direction: Direction | None

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {**self._asdict(), "direction": None if self.direction is None else self.direction.value}


def greatest_amplitudes(charts: Charts) -> tuple[GreatestAmplitude, ...]:
    """Of every inertia, mesh, and axis on bearings, over all speeds and both directions."""
    courses = [(direction, _amplitudes(chart)) for direction, chart in charts.directions()]
    found = []
    for quantity, unit, name in courses[0][1]:
        most = _most(charts, [(direction, each[quantity, unit, name]) for direction, each in courses])
        found.append(GreatestAmplitude(quantity, name, most[0], unit, *most[1:]))
    noise = _NOISE * max((each.amplitude for each in found if each.unit == _MICROMETRES), default=0.0)
    return tuple(each for each in found if each.quantity != _ACROSS or each.amplitude > noise)


def greatest_bearing_forces(charts: Charts) -> tuple[GreatestBearingForce, ...]:
    """Of every gear on bearings, over all speeds and both directions."""
    loads = [(direction, chart.bearings) for direction, chart in charts.directions() if chart.bearings is not None]
    found = []
    for i, gear in enumerate(loads[0][1].gears if loads else ()):
        most = _most(charts, [(direction, each.greatest[:, i]) for direction, each in loads])
        found.append(GreatestBearingForce(gear, most[0], float(loads[0][1].static[i]), *most[1:]))
    return tuple(found)


def _amplitudes(chart: KvChart) -> dict[tuple[str, str, str], Floats]:
    """Over speed (s,), by quantity, unit, and name of what moves."""
    moved, bearings = chart.displacements, chart.bearings
    found = {("turn", "arcsec", name): turn for name, turn in zip(moved.inertia_names, moved.turns.T, strict=True)}
    found |= {("approach", _MICROMETRES, name): each for name, each in zip(moved.mesh_names, moved.approaches.T, strict=True)}
    if bearings is not None:
        for i, gear in enumerate(bearings.gears):
            found["travel along the line of action", _MICROMETRES, gear] = bearings.travels_along[:, i]
            found[_ACROSS, _MICROMETRES, gear] = bearings.travels_across[:, i]
    return found


def _most(charts: Charts, courses: list[tuple[Direction, Floats]]) -> tuple[float, float, float, Direction | None]:
    """The greatest value over speed, its speed (rpm), tooth frequency (1/s) and direction."""
    direction, course = max(courses, key=lambda each: float(np.nanmax(each[1])))
    row = int(np.nanargmax(course))
    sense = None if charts.down is None else direction
    return float(course[row]), float(charts.speeds[row]), float(charts.up.frequencies[row]), sense
