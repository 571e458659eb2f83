"""The response of a planetary train to stiffness and transmission errors of its meshes, over speed.

Flanks stay in contact or, where both meshes have one tooth frequency, part; speeds are as close as every maximum needs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.dynamics.charts.chart import KvChart
from gearcad.dynamics.charts.findings import Charts, GreatestFactor, greatest_factor
from gearcad.dynamics.charts.over_speed import OverSpeed, over_speed
from gearcad.dynamics.excitation.meshes import Excitation
from gearcad.dynamics.operating import OperatingRange, operating_range
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.planetary.campbell import PlanetaryCampbell, planetary_campbell, speeds_per_input
from gearcad.dynamics.planetary.driven import planetary_excitation, planetary_system
from gearcad.dynamics.planetary.folding import fold, meshes_of_all, planets_alike
from gearcad.dynamics.planetary.masses import TrainMasses
from gearcad.dynamics.planetary.mesh_stiffness import MeshStiffness
from gearcad.dynamics.planetary.modes import PlanetaryModes, planetary_modes
from gearcad.dynamics.planetary.planar import held_members
from gearcad.dynamics.planetary.response_notices import (
    differences_where_parted,
    errors_left_out,
    planets_differ,
    stages_left_out,
    turning_axes,
)
from gearcad.dynamics.planetary.springs import SpringKind, train_springs
from gearcad.dynamics.response.floquet import UNSTABLE, growth
from gearcad.dynamics.response.periodic import PeriodicResponse
from gearcad.dynamics.trains.system import System
from gearcad.errors import ParameterError, require_number
from gearcad.notice import Notice, texts
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.phases import drive_of, mesh_phases
from gearcad.planetary.power import lossless_flow

__all__ = ["PlanetaryResponse", "planetary_response"]

_BEYOND = 1.5
"""How far beyond the last resonance a chart goes on."""

_SHARE = 0.02
"""Of a mode's potential energy that the meshes must hold for the mode to be a resonance of theirs."""

_SLOWEST_STEPPED = 1 / 200
"""Of the highest speed, where that of a chart of stepped planets begins: their meshes come again after many teeth only."""


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
    stiffness: Mapping[str, MeshStiffness]
    alike: int
    found: tuple[Notice, ...]

    @property
    def up(self) -> KvChart:
        """Running up."""
        return self.over.up

    @property
    def down(self) -> KvChart | None:
        """Running down, where flanks part."""
        return self.over.down

    @property
    def speeds(self) -> Floats:
        """Of the input (s,), in rpm."""
        return self.up.frequencies / (2 * np.pi * self.tooth_frequency)

    @cached_property
    def factors(self) -> dict[str, Floats]:
        """Dynamic load factors (s, N) of each planet's mesh by the names of the meshes: greatest force over that at rest."""
        a, b = self.train.meshes
        count = self.train.planets
        return {a.name: self.up.factors[:, :count], b.name: self.up.factors[:, count:]}

    @property
    def greatest(self) -> GreatestFactor:
        """The greatest factor of the whole chart."""
        return greatest_factor(self._charts)

    @property
    def greatest_in_operation(self) -> GreatestFactor:
        """The greatest factor where the train runs under load."""
        return greatest_factor(self._charts, self.operating.rows(self.speeds))

    @property
    def at_load(self) -> GreatestFactor | None:
        """The greatest factor at the load's speed, None if that is not in the chart."""
        rows = np.isclose(self.speeds, abs(self.load.speed), rtol=1e-9)
        return greatest_factor(self._charts, rows) if (rows & self.up.known).any() else None

    @property
    def _charts(self) -> Charts:
        return Charts(self.speeds, self.up, self.down, (1.0,) * len(self.up.mesh_names))

    @cached_property
    def damping_ratios(self) -> Floats:
        """(n,): what the damping of meshes, pins and supports comes to in each mode; nan of those without a frequency."""
        squares, modes = np.linalg.eigh(self.system.stiffness_matrix())
        damping = np.einsum("nr,nk,kr->r", modes, self.system.damping_matrix(), modes)
        result = np.full(len(squares), np.nan)
        elastic = slice(self.modes.rigid, None)
        result[elastic] = damping[elastic] / (2 * np.sqrt(squares[elastic]))
        return result

    def at(self, speed: float) -> PeriodicResponse:
        """The steady vibration at any one speed of the input (rpm), running up, with the meshes of every planet.

        It is stable where the charts say so. Raises ParameterError unless it turns.
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
        """What to know before trusting it."""
        return (*self.found, *self.over.notices, *self.up.notices)

    def to_dict(self) -> dict[str, Any]:
        """Plain lists: rpm, N, Hz."""
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
    stiffness: Mapping[str, MeshStiffness],
    masses: TrainMasses,
    options: DynamicsOptions | None = None,
    *,
    given_speeds: Mapping[str, float] | None = None,
) -> PlanetaryResponse:
    """Loads over the speeds of the `options`, at the torque of the load with K_A, without losses.

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
    over = over_speed(*folded, 2 * np.pi * tooth_frequency * charted, harmonics=options.harmonics)
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


def _factor_document(found: GreatestFactor) -> dict[str, Any]:
    """Return a factor as planetary.json has it."""
    return {"factor": found.factor, "mesh": found.mesh, "speed": found.speed, "lasts": found.stable}


def _or_null(values: Floats) -> list[list[float | None]]:
    """Return the columns of values (s, m), null for nan."""
    return [[float(each) if np.isfinite(each) else None for each in column] for column in values.T]


def _require_course(stiffness: Mapping[str, MeshStiffness]) -> None:
    """Raise ParameterError where no mesh has a course of its stiffness: nothing would shake the train."""
    if all(each.cycle.mean_only for each in stiffness.values()):
        method = next(iter(stiffness.values())).cycle.method
        raise ParameterError(
            "stiffness", method, "must know the course over the mesh of one mesh at least: a mean shakes nothing"
        )


def _driven(train: PlanetaryTrain) -> tuple[str, ...]:
    """Members that are not held."""
    held = held_members(train)
    return tuple(name for name in train.members if name not in held)


def _means(train: PlanetaryTrain, stiffness: Mapping[str, MeshStiffness]) -> tuple[float, float]:
    a, b = train.meshes
    return stiffness[a.name].tangent_mean, stiffness[b.name].tangent_mean


def _torques(train: PlanetaryTrain, load: TrainLoad, given_speeds: Mapping[str, float] | None) -> Mapping[str, float]:
    """On the members of the set (N·m), with K_A, which balance as those with losses would not."""
    return lossless_flow(train, load.times(load.application_factor), given_speeds).set_torques


def _forces(train: PlanetaryTrain, torques: Mapping[str, float]) -> dict[str, float]:
    """What each planet's share presses each mesh with (N)."""
    return {
        mesh.name: abs(torques[mesh.central.name]) * 1000 / (train.planets * mesh.central_base_radius) for mesh in train.meshes
    }


def _speeds(
    train: PlanetaryTrain, options: DynamicsOptions, modes: PlanetaryModes, tooth_frequency: float, load: TrainLoad
) -> Floats:
    """Of the chart (rpm of the input), with that of the load if it lies within."""
    last = options.speed_to
    if last is None:
        meshes = modes.springs.select(SpringKind.MESH)
        felt = modes.potential[:, meshes].sum(axis=1) > _SHARE
        last = _BEYOND * float(modes.frequency[felt].max(initial=0.0) or modes.frequency.max()) / tooth_frequency
    first = options.speed_from or last * max(options.slowest, _SLOWEST_STEPPED if train.stepped else 0.0)
    asked = np.array([abs(load.speed), options.operating_from or 0.0, options.operating_to or 0.0])
    return np.union1d(np.linspace(first, last, options.chart_speeds), asked[(asked >= first) & (asked <= last)])


def _of_each(over: OverSpeed, alike: int, system: System, excitation: Excitation) -> OverSpeed:
    """Charts of planets taken for one with the forces of each, and the stability of all, that with flanks in contact."""
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
    """Whether (s,) motions of all planets last while flanks stay in contact."""
    return np.asarray(growth(system, excitation.bonded, frequencies) <= UNSTABLE, bool)
