"""Findings of a K_v chart: resonances with their natural frequencies, greatest loads, displacements and bearing forces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Bools, Floats, JsonObject
from gearcad.dynamics.response.kv_chart import KvChart
from gearcad.dynamics.trains.steady_response import Direction
from gearcad.dynamics.trains.train_modes import NaturalModes

_NEAR = 0.04
"""Relative distance from a natural frequency within which a resonance gets its name: damping and parting flanks move it."""

_NAMED = 8
"""Harmonics of a tooth frequency that give a resonance its name: beyond, each lies near the next."""

_LEAST_MESH_ENERGY = 0.02
"""Share of a mode's potential energy that the meshes must hold for half its frequency to be a speed to know."""


class Charts(NamedTuple):
    """A chart over `speeds` (s,) of the first pinion (rpm) running up and, where that differs, running down.

    `ratios` are tooth frequencies of the meshes over that of the first.
    """

    speeds: Floats
    up: KvChart
    down: KvChart | None
    ratios: tuple[float, ...]

    def directions(self) -> list[tuple[Direction, KvChart]]:
        """Return each chart with the direction in which it was run through."""
        return [(Direction.UP, self.up), *([] if self.down is None else [(Direction.DOWN, self.down)])]

    def speed(self, frequency: float) -> float:
        """Return the speed (rpm) at one of the charts' circular tooth frequencies of the first mesh (1/s)."""
        return float(self.speeds[self.up.frequencies == frequency][0])


class GreatestFactor(NamedTuple):
    """The greatest K_v of all meshes and its `speed` (rpm); no direction where up and down are the same."""

    factor: float
    mesh: str
    speed: float
    direction: Direction | None
    stable: bool

    def to_dict(self) -> JsonObject:
        """Return the entry of the factor in `dynamics.json`."""
        return {**self._asdict(), "direction": None if self.direction is None else self.direction.value}


class MetMode(NamedTuple):
    """The natural frequency (1 is the lowest) that a `harmonic` of a tooth frequency meets: of another `mesh`, if named."""

    mode: int
    harmonic: int
    mesh: str = ""


class ChartResonance(NamedTuple):
    """A maximum of K_v, to three decimals, of a mesh at a `speed` (rpm) and its own tooth frequency (Hz and 1/s).

    `damped` is what K_v is there with the force of the dampers. `frequency` is that of the first mesh (1/s); `directions` in
    which it shows, none where up and down are the same.
    """

    mesh: str
    factor: float
    speed: float
    frequency: float
    tooth_frequency: float
    tooth_circular: float
    directions: tuple[Direction, ...]
    stable: bool
    met: MetMode | None
    damped: float

    def to_dict(self) -> JsonObject:
        """Return the entry of the resonance in `dynamics.json`."""
        plain = {
            "directions": [each.value for each in self.directions],
            "met": None if self.met is None else self.met._asdict(),
        }
        return {**self._asdict(), **plain}


class ShaftOverload(NamedTuple):
    """Torque of a shaft at rest (N·m), its greatest overload, and the speed (rpm) of that."""

    shaft: str
    torque: float
    factor: float
    speed: float


class ModeSpeed(NamedTuple):
    """A speed (rpm) at which the tooth frequency of a mesh is a natural frequency (1 is the lowest), or its half: `part` 2."""

    mode: int
    part: int
    mesh: int
    speed: float


def greatest_factor(charts: Charts, rows: Bools | None = None) -> GreatestFactor:
    """Return the greatest K_v of all meshes and directions, in some `rows` (s,) of the charts if given.

    All rows count if none of those given has a value.
    """
    inside = np.ones(len(charts.speeds), bool) if rows is None else rows
    if not any(np.isfinite(chart.factors[inside]).any() for _, chart in charts.directions()):
        inside = np.ones(len(charts.speeds), bool)
    found = [(np.where(inside[:, None], chart.factors, np.nan), chart, way) for way, chart in charts.directions()]
    factors, chart, direction = max(found, key=lambda each: float(np.nanmax(each[0])))
    row, mesh = np.unravel_index(int(np.nanargmax(factors)), factors.shape)
    return GreatestFactor(
        factor=float(factors[row, mesh]),
        mesh=chart.mesh_names[mesh],
        speed=float(charts.speeds[row]),
        direction=None if charts.down is None else direction,
        stable=bool(chart.stable[row]),
    )


def chart_resonances(charts: Charts, natural: Floats) -> tuple[ChartResonance, ...]:
    """Return the resonances mesh by mesh, those running up first.

    `natural` (n,) are the circular natural frequencies (1/s), 0 for free turning.
    """
    found = []
    for mesh, name in enumerate(charts.up.mesh_names):
        shown: dict[tuple[float, float], list[Direction]] = {}
        damped: dict[tuple[float, float], float] = {}
        for direction, chart in charts.directions():
            for peak in chart.peaks(mesh):
                key = peak.frequency, round(peak.factor, 3)
                shown.setdefault(key, []).append(direction)
                damped.setdefault(key, float(chart.damped[chart.frequencies == peak.frequency, mesh][0]))
        for (frequency, factor), directions in shown.items():
            own = charts.ratios[mesh] * frequency
            found.append(
                ChartResonance(
                    mesh=name,
                    factor=factor,
                    speed=charts.speed(frequency),
                    frequency=frequency,
                    tooth_frequency=own / (2 * np.pi),
                    tooth_circular=own,
                    directions=() if charts.down is None else tuple(directions),
                    stable=bool(charts.up.stable[charts.up.frequencies == frequency].all()),
                    met=_met_mode(charts, natural, mesh, frequency),
                    damped=damped[frequency, factor],
                )
            )
    return tuple(found)


def _met_mode(charts: Charts, natural: Floats, mesh: int, frequency: float) -> MetMode | None:
    """Return the natural frequency met there by the lowest harmonic of a tooth frequency (1/s of the first mesh), if any."""
    found = [
        (harmonic, abs(harmonic * ratio * frequency / circular - 1), mode, other)
        for other, ratio in enumerate(charts.ratios)
        for harmonic in range(1, _NAMED + 1)
        for mode, circular in enumerate(natural, 1)
        if circular
    ]
    near = [each for each in found if each[1] < _NEAR]
    if not near:
        return None
    # Its own teeth before those of another mesh.
    harmonic, _, mode, other = min(near, key=lambda each: (each[0], each[3] != mesh, each[1]))
    same = charts.ratios[other] == charts.ratios[mesh]
    return MetMode(mode, harmonic, "" if same else charts.up.mesh_names[other])


def shaft_overloads(charts: Charts) -> tuple[ShaftOverload, ...]:
    """Return the greatest overloads of the shafts that carry a torque at rest, running up."""
    chart, found = charts.up, []
    for shaft in chart.referred_shafts:
        row = int(np.nanargmax(chart.shaft_factors[:, shaft]))
        torque, factor = float(chart.shaft_references[shaft]), float(chart.shaft_factors[row, shaft])
        found.append(ShaftOverload(chart.shaft_names[shaft], torque, factor, float(charts.speeds[row])))
    return tuple(found)


def mode_speeds(modes: NaturalModes, teeth: int, others: Sequence[float] = ()) -> tuple[ModeSpeed, ...]:
    """Return the speeds that meet elastic modes, and those that meet half the frequency of modes that bend teeth.

    If `others` (Hz) are given, they and their halves are used instead, met by a pinion with that number of `teeth`.
    """
    if others:
        elastic = [(mode, hertz) for mode, hertz in enumerate(others, 1) if hertz]
        return tuple(ModeSpeed(mode, part, 0, 60 * hertz / teeth / part) for mode, hertz in elastic for part in (1, 2))
    felt = modes.potential_meshes.sum(axis=1) > _LEAST_MESH_ENERGY
    return tuple(
        ModeSpeed(mode + 1, part, mesh, speed)
        for mode in range(modes.rigid, len(modes))
        for part in ((1, 2) if felt[mode] else (1,))
        for mesh, speed in enumerate((modes.rpm[mode] / part).tolist())
    )


_ACROSS = "travel across the line of action"
"""Quantity that gears do not have if their bearings are alike in all directions."""


_MICROMETRES = "µm"

_NOISE = 1e-9
"""Part of the greatest amplitude below which travel across the line of action comes from rounding."""


class GreatestAmplitude(NamedTuple):
    """The greatest amplitude, half of peak to peak, of a `quantity` of an inertia, a mesh or a gear, in `unit`.

    `speed` in rpm and `frequency`, that of the teeth of the first mesh, in 1/s; no direction where up and down are the same.
    """

    quantity: str
    name: str
    amplitude: float
    unit: str
    speed: float
    frequency: float
    direction: Direction | None

    def to_dict(self) -> JsonObject:
        """Return the entry of the amplitude in `dynamics.json`."""
        return {**self._asdict(), "direction": None if self.direction is None else self.direction.value}


class GreatestBearingForce(NamedTuple):
    """The greatest force on the bearings of a `gear` (N), and the `static` one at rest (N), which is the mean too."""

    gear: str
    force: float
    static: float
    speed: float
    frequency: float
    direction: Direction | None

    def to_dict(self) -> JsonObject:
        """Return the entry of the force in `dynamics.json`."""
        return {**self._asdict(), "direction": None if self.direction is None else self.direction.value}


def greatest_amplitudes(charts: Charts) -> tuple[GreatestAmplitude, ...]:
    """Return the greatest amplitude of every inertia, mesh, and axis on bearings, over all speeds and both directions."""
    courses = [(direction, _amplitudes(chart)) for direction, chart in charts.directions()]
    found = []
    for quantity, unit, name in courses[0][1]:
        most = _most(charts, [(direction, each[quantity, unit, name]) for direction, each in courses])
        found.append(GreatestAmplitude(quantity, name, most[0], unit, *most[1:]))
    noise = _NOISE * max((each.amplitude for each in found if each.unit == _MICROMETRES), default=0.0)
    return tuple(each for each in found if each.quantity != _ACROSS or each.amplitude > noise)


def greatest_bearing_forces(charts: Charts) -> tuple[GreatestBearingForce, ...]:
    """Return the greatest bearing force of every gear on bearings, over all speeds and both directions."""
    loads = [(direction, chart.bearings) for direction, chart in charts.directions() if chart.bearings is not None]
    found = []
    for i, gear in enumerate(loads[0][1].gears if loads else ()):
        most = _most(charts, [(direction, each.greatest[:, i]) for direction, each in loads])
        found.append(GreatestBearingForce(gear, most[0], float(loads[0][1].static[i]), *most[1:]))
    return tuple(found)


def _amplitudes(chart: KvChart) -> dict[tuple[str, str, str], Floats]:
    """Return amplitudes over speed (s,), by quantity, unit, and name of the moving part."""
    moved, bearings = chart.displacements, chart.bearings
    found = {("turn", "arcsec", name): turn for name, turn in zip(moved.inertia_names, moved.turns.T, strict=True)}
    found |= {("approach", _MICROMETRES, name): each for name, each in zip(moved.mesh_names, moved.approaches.T, strict=True)}
    if bearings is not None:
        for i, gear in enumerate(bearings.gears):
            found["travel along the line of action", _MICROMETRES, gear] = bearings.travels_along[:, i]
            found[_ACROSS, _MICROMETRES, gear] = bearings.travels_across[:, i]
    return found


def _most(charts: Charts, courses: list[tuple[Direction, Floats]]) -> tuple[float, float, float, Direction | None]:
    """Return the greatest value over speed, its speed (rpm), tooth frequency (1/s) and direction."""
    direction, course = max(courses, key=lambda each: float(np.nanmax(each[1])))
    row = int(np.nanargmax(course))
    sense = None if charts.down is None else direction
    return float(course[row]), float(charts.speeds[row]), float(charts.up.frequencies[row]), sense
