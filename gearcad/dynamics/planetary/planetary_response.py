"""Response of a planetary train to stiffness and transmission errors of its meshes, over speed.

Flanks stay in contact or, where both meshes have one tooth frequency, part; speeds are as close as every maximum needs. Where
planets are alike, at equal angles and in phase - all of them, or every second, every third ... - their motion repeats after
that part of a turn, and one planet stands for them. Carrier and centrals then only turn.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcad.core.errors import GeometryError, ParameterError, SolverError, require_number
from gearcad.core.records import Bools, Floats, Indices, JsonObject, Notice, texts
from gearcad.dynamics.options import DynamicsOptions, OperatingRange, operating_range
from gearcad.dynamics.planetary.load_sharing import share_load
from gearcad.dynamics.planetary.planar_model import (
    PlanarTrain,
    SpringKind,
    TrainMasses,
    TrainSprings,
    all_coordinates,
    held_members,
    set_members,
    train_springs,
)
from gearcad.dynamics.planetary.planetary_excitation import PlanetMeshStiffness, planetary_excitation, planetary_system
from gearcad.dynamics.planetary.planetary_modes import (
    PlanetaryCampbell,
    PlanetaryModes,
    planetary_campbell,
    planetary_modes,
    speeds_per_input,
)
from gearcad.dynamics.response.chart_findings import Charts, GreatestFactor, greatest_factor
from gearcad.dynamics.response.kv_chart import KvChart
from gearcad.dynamics.response.linear_response import UNSTABLE, growth
from gearcad.dynamics.response.speed_charts import OverSpeed, over_speed
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import PeriodicResponse, frequency_ranges
from gearcad.planetary import MeshPhases, PlanetaryTrain, TrainLoad
from gearcad.planetary.poses import drive_of, mesh_phases
from gearcad.planetary.power import lossless_flow

_SAME = 1e-9
"""Rounding, relative or of a base pitch."""

_REMEDIES = "more damping ([dynamics] damping_ratio) or fewer [dynamics] speeds"
"""Inputs of planetary trains that give loads where runs in time would take too long."""


def planets_alike(planar: PlanarTrain, phases: Mapping[str, MeshPhases]) -> int:
    """Return the number of planets that move as planet 0 does, itself included.

    They are the n-th, the 2 n-th ... after it; 1 where it is the only one.
    """
    count = planar.planets
    return max(count // step for step in range(1, count + 1) if count % step == 0 and _repeats(planar, phases, step))


def _repeats(planar: PlanarTrain, phases: Mapping[str, MeshPhases], step: int) -> bool:
    """Return whether all is the same `step` planets further."""

    def later(values: Floats) -> Floats:
        return np.roll(values, -step) - values

    turns = [later(planar.angles) / (2 * np.pi) - step / planar.planets]
    turns += [later(np.array(phases[line.name].ahead)) for line in planar.meshes]
    stiffer = max(float(np.abs(later(line.stiffness) / line.stiffness).max()) for line in planar.meshes)
    return stiffer < _SAME and all(np.abs(each - np.round(each)).max() < _SAME for each in turns)


def fold(springs: TrainSprings, alike: int) -> TrainSprings:
    """Return the springs of the first planets of each kind, each with the springs and the masses of `alike` of them."""
    if alike == 1:
        return springs
    kept = springs.planar.planets // alike
    spread, names = _spread(springs, kept)
    vectors = springs.vectors @ spread
    rows = [
        row for row, each in enumerate(springs.springs) if (each.planet is None or each.planet < kept) and vectors[row].any()
    ]
    many = [1 if springs.springs[row].planet is None else alike for row in rows]
    return TrainSprings(
        planar=springs.planar,
        springs=tuple(springs.springs[row] for row in rows),
        vectors=vectors[rows],
        stiffness=springs.stiffness[rows] * np.array(many, float),
        coordinates=tuple(names),
        basis=springs.basis @ spread,
    )


def meshes_of_all(planets: int, alike: int) -> Indices:
    """Return (2 N,) the mesh of the first planets of each kind that stands for each mesh of all planets."""
    kept = planets // alike
    return np.concatenate([np.tile(np.arange(kept), alike), np.tile(np.arange(kept, 2 * kept), alike)])


def _spread(springs: TrainSprings, kept: int) -> tuple[Floats, list[str]]:
    """Return all coordinates (n, f) from those of the kept planets and the turns of the members.

    The names of these come second.
    """
    every = all_coordinates(springs.planar)
    places = [every.index(name) for name in springs.coordinates]
    leaders = [place if place < 9 else 9 + (place - 9) % (3 * kept) for place in places]
    moving = [place >= 9 or place % 3 == 2 for place in places]
    columns = [each for each, leader, moves in zip(places, leaders, moving, strict=True) if each == leader and moves]
    spread = np.array([[float(leader == column) for column in columns] for leader in leaders])
    return spread, [every[column] for column in columns]


_FAST = 0.05
"""Twice the speed of the carrier over the lowest natural frequency from which on turning axes get a notice."""


def turning_axes(modes: PlanetaryModes, carrier: float, highest_speed: float) -> tuple[Notice, ...]:
    """Return a notice if the rotation of axes with the carrier would have an effect, otherwise none.

    `carrier` is its speed over that of the input; `highest_speed` is in rpm of the input.
    """
    elastic = modes.circular[modes.rigid :]
    rpm = abs(carrier * highest_speed)
    ratio = 2 * rpm * math.pi / 30 / float(elastic.min(initial=math.inf))
    if ratio < _FAST:
        return ()
    text = (
        f"the carrier turns at up to {rpm:.4g} rpm, of which twice the angular speed is {ratio:.2g} of the lowest natural"
        " frequency: gyroscopic and centrifugal terms, which this model leaves out, would shift it there"
    )
    return (Notice("turning-axes", text),)


def stages_left_out(train: PlanetaryTrain) -> tuple[Notice, ...]:
    """Return a notice that stages are no part of the vibrating model, none for a train without stages."""
    if not train.stages:
        return ()
    names = " and ".join(stage.name for stage in train.stages)
    return (Notice("stages-left-out", f"inertias and meshes of {names} are no part of the vibrating model", "stages"),)


def errors_left_out(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: Mapping[str, PlanetMeshStiffness],
    given_speeds: Mapping[str, float] | None,
) -> tuple[Notice, ...]:
    """Return a notice that planets carry even shares in spite of errors, none for a train without errors.

    It says what the errors make of the shares at rest.
    """
    errors = tuple(_errors(train))
    if not errors:
        return ()
    text = (
        f"errors are left out ({', '.join(errors)}): here every planet carries an even share at rest,"
        f" and factors refer to it; {_shares_at_rest(train, load, stiffness, given_speeds)}"
    )
    return (Notice("errors-left-out", text, "response"),)


def _errors(train: PlanetaryTrain) -> Iterator[str]:
    """Yield the names of errors that are not 0."""
    if any(train.carrier.pin_errors):
        yield f"pin errors of {train.carrier.name}"
    for rim in train.rims:
        if any(rim.tooth_errors):
            yield f"tooth errors of {rim.name}"
    for member in set_members(train):
        if member.run_out:
            yield f"run-out of {member.name}"


def _shares_at_rest(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: Mapping[str, PlanetMeshStiffness],
    given_speeds: Mapping[str, float] | None,
) -> str:
    means = {name: each.mean for name, each in stiffness.items()}
    try:
        sharing = share_load(train, load, means, given_speeds)
    except (ParameterError, GeometryError, SolverError) as error:
        return f"their load sharing at rest could not be had: {error}"
    found = f"with them K_gamma at rest is {sharing.mesh_load_factor:.3g}"
    if not sharing.unloaded:
        return found
    planets = ", ".join(str(planet + 1) for planet in sharing.unloaded)
    return f"{found}, and planets without contact at some angle: {planets}"


def planets_differ(frequencies: Floats, growing: Bools) -> tuple[Notice, ...]:
    """Return a notice that planets cease to move alike at some of the tooth frequencies (s,) in 1/s, if they do."""
    if not growing.any():
        return ()
    text = (
        f"planets cease to do the same at tooth frequencies (1/s) {frequency_ranges(frequencies, growing)}: modes in which they"
        " differ grow there while flanks stay in contact, so what is given does not last; what the train does instead is not"
        " computed, and can be greater"
    )
    return (Notice("planets-differ", text),)


def differences_where_parted(over: OverSpeed) -> tuple[Notice, ...]:
    """Return a notice of how planets taken for one are judged where their flanks part.

    There is none where flanks do not part.
    """
    if over.branch is None and over.runs is None:
        return ()
    text = "whether planets go on doing the same where flanks part is judged as if flanks stayed in contact"
    return (Notice("planets-in-contact", text),)


_BEYOND = 1.5
"""Highest speed of a chart over that of the last resonance."""

_SHARE = 0.02
"""Part of a mode's potential energy that the meshes must hold for the mode to be a resonance of theirs."""

_SLOWEST_STEPPED = 1 / 200
"""Part of the highest speed at which a chart of stepped planets begins: their meshes repeat after many teeth only."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanetaryResponse:
    """Loads over `speeds` (s,) of the input (rpm) running up and, where that differs, down.

    The mesh of every planet is one of the charts' meshes: those of the first central, then those of the second, by planets; so
    `system` and `excitation` have them. `alike` planets of each kind do the same at the same time: motions were sought as if
    they were one, but are stable only if they last against any disturbance of the `system`, with flanks in contact.
    `tooth_frequency` (Hz) is that of the first central's meshes at 1 rpm of the input, in the charts in 1/s. Errors of pins and
    teeth and run-out are left out.
    """

    train: PlanetaryTrain
    load: TrainLoad
    modes: PlanetaryModes
    system: System
    excitation: Excitation
    over: OverSpeed
    tooth_frequency: float
    campbell: PlanetaryCampbell
    operating: OperatingRange
    stiffness: Mapping[str, PlanetMeshStiffness]
    alike: int
    found: tuple[Notice, ...]

    @property
    def up(self) -> KvChart:
        """Chart running up."""
        return self.over.up

    @property
    def down(self) -> KvChart | None:
        """Chart running down, where flanks part."""
        return self.over.down

    @property
    def speeds(self) -> Floats:
        """Speeds of the input (s,), in rpm."""
        return self.up.frequencies / (2 * np.pi * self.tooth_frequency)

    @cached_property
    def factors(self) -> dict[str, Floats]:
        """Dynamic load factors (s, N) of each planet's mesh by the names of the meshes: greatest force over that at rest."""
        a, b = self.train.meshes
        count = self.train.planets
        return {a.name: self.up.factors[:, :count], b.name: self.up.factors[:, count:]}

    @property
    def greatest(self) -> GreatestFactor:
        """Greatest factor of the whole chart."""
        return greatest_factor(self._charts)

    @property
    def greatest_in_operation(self) -> GreatestFactor:
        """Greatest factor where the train runs under load."""
        return greatest_factor(self._charts, self.operating.rows(self.speeds))

    @property
    def at_load(self) -> GreatestFactor | None:
        """Greatest factor at the load's speed, None if that is not in the chart."""
        rows = np.isclose(self.speeds, abs(self.load.speed), rtol=1e-9)
        return greatest_factor(self._charts, rows) if (rows & self.up.known).any() else None

    @property
    def _charts(self) -> Charts:
        return Charts(self.speeds, self.up, self.down, (1.0,) * len(self.up.mesh_names))

    @cached_property
    def damping_ratios(self) -> Floats:
        """Damping ratio (n,) of each mode from the damping of meshes, pins and supports.

        It is nan for modes without a frequency.
        """
        squares, modes = np.linalg.eigh(self.system.stiffness_matrix())
        damping = np.einsum("nr,nk,kr->r", modes, self.system.damping_matrix(), modes)
        result = np.full(len(squares), np.nan)
        elastic = slice(self.modes.rigid, None)
        result[elastic] = damping[elastic] / (2 * np.sqrt(squares[elastic]))
        return result

    def at(self, speed: float) -> PeriodicResponse:
        """Return the steady vibration at any one speed of the input (rpm), running up, with the meshes of every planet.

        It is stable where the charts say so. Raises ParameterError unless the input turns.
        """
        require_number("speed", abs(speed), "rpm", above=0)
        found = self.over.response(2 * np.pi * self.tooth_frequency * abs(speed))
        if self.alike == 1:
            return found
        return replace(
            found,
            system=self.system,
            excitation=self.excitation if found.excitation.parting else self.excitation.bonded,
            approach_coefficients=found.approach_coefficients[..., meshes_of_all(self.train.planets, self.alike)],
            stable=found.stable & _lasting(self.system, self.excitation, found.frequencies),
        )

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before the response is used."""
        return (*self.found, *self.over.notices, *self.up.notices)

    def to_dict(self) -> JsonObject:
        """Return plain lists: rpm, N, Hz."""
        at_load = self.at_load
        return {
            "speed": self.speeds.tolist(),
            "tooth_frequency_per_rpm": self.tooth_frequency,
            "load_factor": {name: _or_null(values) for name, values in self.factors.items()},
            "stable": self.up.stable.tolist(),
            "stiffness_method": {name: each.cycle.method for name, each in self.stiffness.items()},
            "at_load": None if at_load is None else _factor_document(at_load),
            "operation": {**self.operating.to_dict(), "greatest": _factor_document(self.greatest_in_operation)},
            "greatest": _factor_document(self.greatest),
            "static_force": dict(zip(self.up.mesh_names, self.up.static_forces.tolist(), strict=True)),
            "campbell": self.campbell.to_dict(),
            "notices": [notice.to_dict() for notice in self.notices],
            "notes": list(texts(self.notices)),
        }


def planetary_response(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: Mapping[str, PlanetMeshStiffness],
    masses: TrainMasses,
    options: DynamicsOptions | None = None,
    *,
    given_speeds: Mapping[str, float] | None = None,
) -> PlanetaryResponse:
    """Return the loads over the speeds of the `options`, at the torque of the load with K_A, without losses.

    `stiffness` of each mesh is that of an even share of the load. A differential needs the second speed (rpm) that it has at
    the load's: both rise alike. Raises ParameterError, GeometryError and SolverError.
    """
    options = options or DynamicsOptions()
    _require_course(stiffness)
    turns = speeds_per_input(train, {**(given_speeds or {}), train.input: load.speed})
    tooth_frequency = abs(train.meshes[0].rim.gear.teeth * turns["planet"]) / 60
    drive = drive_of(train, load)
    springs, phases = train_springs(train, _means(train, stiffness), sense=drive.sense), mesh_phases(train, drive)
    modes = planetary_modes(springs, masses)
    charted = _speeds(train, options, modes, tooth_frequency, load)
    alike = planets_alike(springs.planar, phases)
    torques = _torques(train, load, given_speeds)
    (system, excitation), folded = (
        (
            planetary_system(
                fold(springs, many), masses, torques, driven=_driven(train), damping_ratio=options.damping_ratio, alike=many
            ),
            planetary_excitation(train, stiffness, phases, _forces(train, torques), parting=not train.stepped, alike=many),
        )
        for many in (1, alike)
    )
    frequencies = 2 * np.pi * tooth_frequency * charted
    over = over_speed(*folded, frequencies, harmonics=options.harmonics, remedies=_REMEDIES)
    return PlanetaryResponse(
        train=train,
        load=load,
        modes=modes,
        system=system,
        excitation=excitation,
        over=over if alike == 1 else _of_each(over, alike, system, excitation),
        tooth_frequency=tooth_frequency,
        campbell=planetary_campbell(train, modes, phases, float(charted[-1]), given_speeds=given_speeds),
        operating=operating_range(load.speed, options, (float(charted[0]), float(charted[-1]))).within(charted),
        stiffness=stiffness,
        alike=alike,
        found=(
            *turning_axes(modes, turns[train.carrier.name], float(charted[-1])),
            *stages_left_out(train),
            *errors_left_out(train, load, stiffness, given_speeds),
            *modes.notices,
        ),
    )


def _factor_document(found: GreatestFactor) -> JsonObject:
    """Return a factor as planetary.json has it."""
    return {"factor": found.factor, "mesh": found.mesh, "speed": found.speed, "lasts": found.stable}


def _or_null(values: Floats) -> list[list[float | None]]:
    """Return the columns of values (s, m), null for nan."""
    return [[float(each) if np.isfinite(each) else None for each in column] for column in values.T]


def _require_course(stiffness: Mapping[str, PlanetMeshStiffness]) -> None:
    """Raise ParameterError if no mesh has a stiffness that varies over the mesh cycle: nothing would excite the train."""
    if all(each.cycle.mean_only for each in stiffness.values()):
        method = next(iter(stiffness.values())).cycle.method
        raise ParameterError(
            "stiffness",
            method,
            "must give the stiffness over the mesh cycle for at least one mesh: a mean stiffness excites no vibration",
        )


def _driven(train: PlanetaryTrain) -> tuple[str, ...]:
    """Return the names of members that are not held."""
    held = held_members(train)
    return tuple(name for name in train.members if name not in held)


def _means(train: PlanetaryTrain, stiffness: Mapping[str, PlanetMeshStiffness]) -> tuple[float, float]:
    a, b = train.meshes
    return stiffness[a.name].tangent_mean, stiffness[b.name].tangent_mean


def _torques(train: PlanetaryTrain, load: TrainLoad, given_speeds: Mapping[str, float] | None) -> Mapping[str, float]:
    """Return the torques on the members of the set (N·m), with K_A.

    They are without losses, so they balance; those with losses would not.
    """
    return lossless_flow(train, load.times(load.application_factor), given_speeds).set_torques


def _forces(train: PlanetaryTrain, torques: Mapping[str, float]) -> dict[str, float]:
    """Return the force (N) of each planet's share on each mesh, by the names of meshes."""
    return {
        mesh.name: abs(torques[mesh.central.name]) * 1000 / (train.planets * mesh.central_base_radius) for mesh in train.meshes
    }


def _speeds(
    train: PlanetaryTrain, options: DynamicsOptions, modes: PlanetaryModes, tooth_frequency: float, load: TrainLoad
) -> Floats:
    """Return the speeds of the chart (rpm of the input), with that of the load if it lies within."""
    last = options.speed_to
    if last is None:
        meshes = modes.springs.select(SpringKind.MESH)
        felt = modes.potential[:, meshes].sum(axis=1) > _SHARE
        last = _BEYOND * float(modes.frequency[felt].max(initial=0.0) or modes.frequency.max()) / tooth_frequency
    first = options.speed_from or last * max(options.slowest, _SLOWEST_STEPPED if train.stepped else 0.0)
    asked = np.array([abs(load.speed), options.operating_from or 0.0, options.operating_to or 0.0])
    return np.union1d(np.linspace(first, last, options.chart_speeds), asked[(asked >= first) & (asked <= last)])


def _of_each(over: OverSpeed, alike: int, system: System, excitation: Excitation) -> OverSpeed:
    """Return charts with the forces of each planet, from charts of planets taken for one.

    They have the stability of all planets, with flanks in contact.
    """
    columns = meshes_of_all(len(system.names[0]) // 2, alike)

    def unfolded(chart: KvChart) -> KvChart:
        lasting = _lasting(system, excitation, chart.frequencies)
        return replace(
            chart,
            factors=chart.factors[:, columns],
            damped=chart.damped[:, columns],
            least=chart.least[:, columns],
            static_forces=chart.static_forces[columns] / alike,
            mesh_names=system.names[0],
            displacements=chart.displacements.of_meshes(columns, system.names[0]),
            transmission=chart.transmission.of_meshes(columns),
            stable=chart.stable & lasting,
            notices=(*chart.notices, *planets_differ(chart.frequencies, chart.stable & ~lasting)),
        )

    notices = (*over.notices, *differences_where_parted(over))
    return replace(over, up=unfolded(over.up), down=None if over.down is None else unfolded(over.down), notices=notices)


def _lasting(system: System, excitation: Excitation, frequencies: Floats) -> Bools:
    """Return whether (s,) motions of all planets last while flanks stay in contact."""
    return np.asarray(growth(system, excitation.bonded, frequencies) <= UNSTABLE, bool)
