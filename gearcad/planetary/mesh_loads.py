"""What one planet's meshes carry, as loads of their pairs: so that all that exists for pairs takes them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, NamedTuple

from gearcad.errors import ParameterError, require_number
from gearcad.load import Load
from gearcad.per_gear import PerGear, Role
from gearcad.planetary.load import TrainLoad
from gearcad.planetary.mesh import SetMesh
from gearcad.planetary.power import PowerFlow
from gearcad.planetary.speeds import speeds
from gearcad.planetary.train_data import TrainData

__all__ = ["FactorSource", "MeshLoad", "MeshLoadFactor", "mesh_load_factor", "mesh_loads", "stage_loads"]


_ROUNDING = 1e-9
"""By how much a K_gamma that is computed may be off."""

_SLOWEST = 1e-6
"""Least speed of a load (rpm): what differences of speeds leave below it is rounding."""


class FactorSource(Enum):
    """Where K_gamma comes from."""

    GIVEN = "given"
    COMPUTED = "computed"
    """Of the errors, stiffnesses and supports of the train."""

    EQUAL = "equal shares"
    """None was given and none computed: 1."""


class MeshLoadFactor(NamedTuple):
    """K_gamma of ISO 6336-1, and where it comes from."""

    value: float
    source: FactorSource


def mesh_load_factor(train: TrainData, load: TrainLoad, computed: float | None = None) -> MeshLoadFactor:
    """K_gamma of a train: the one that its load gives, else the one that was `computed`, else 1.

    Raises ParameterError for a given one above the number of planets: then one planet carries all.
    """
    if (given := load.mesh_load_factor) is not None:
        require_number("load.mesh_load_factor", given, at_least=1, at_most=train.planets)
        return MeshLoadFactor(given, FactorSource.GIVEN)
    if computed is not None:
        # The shares have the mean 1: what is nearer to it than solvers are, or below it, is rounding.
        return MeshLoadFactor(float(computed) if computed > 1 + _ROUNDING else 1.0, FactorSource.COMPUTED)
    return MeshLoadFactor(1.0, FactorSource.EQUAL)


@dataclass(frozen=True, kw_only=True)
class MeshLoad:
    """What the mesh of a central with one planet carries, seen from the carrier.

    The torque of `load` (N·m) is the N-th part of that on the central, on the pair's pinion: positive where it presses the
    flanks that a pinion which is driven counter-clockwise presses; its speed (rpm) is that of the pinion against the carrier.
    `application_factor` K_A is the train's, `mesh_load_factor` K_gamma; that of the load is their product. `driver` drives its
    mate, with the carrier at rest.
    """

    mesh: SetMesh
    planets: int
    load: Load
    driver: Role
    application_factor: float
    mesh_load_factor: MeshLoadFactor

    @property
    def even(self) -> Load:
        """The load of a planet that carries its N-th part: with K_A, without K_gamma."""
        return replace(self.load, application_factor=self.application_factor)

    @property
    def normal_force(self) -> float:
        """F_bt of one planet's share, without any factor (N)."""
        return abs(self.load.torque) * 2000 / self.mesh.pair.pinion.base_diameter

    @property
    def contacts(self) -> PerGear[int]:
        """How often a flank of each gear's teeth comes into mesh in one of its turns against the carrier."""
        return PerGear.each(lambda role: self.planets if role is self.mesh.central_role else 1)

    @property
    def cycles_per_minute(self) -> PerGear[float]:
        """Load cycles of a flank of each gear in a minute."""
        rolled = abs(self.load.speed) * self.mesh.pair.pinion.teeth
        gears = self.mesh.pair.gears
        return PerGear.each(lambda role: rolled / gears.pick(role).tooth_count * self.contacts.pick(role))

    def to_dict(self) -> dict[str, Any]:
        """For JSON: N·m, rpm and N."""
        return {
            "torque": self.load.torque,
            "speed": self.load.speed,
            "normal_force": self.normal_force,
            "K_A": self.application_factor,
            "K_gamma": self.mesh_load_factor.value,
            "K_gamma_source": self.mesh_load_factor.source.value,
            "driver": self.mesh.pair.gears.pick(self.driver).name,
            "contacts": self.contacts._asdict(),
            "cycles_per_minute": self.cycles_per_minute._asdict(),
        }


def mesh_loads(train: TrainData, flow: PowerFlow, computed_factor: float | None = None) -> dict[str, MeshLoad]:
    """Of both meshes of a set by their names, under a flow of power; K_gamma as `mesh_load_factor` has it."""
    found = mesh_load_factor(train, flow.load, computed_factor)
    first, second = train.meshes
    central_drives = _rolling(train, flow) >= 0
    drivers = {
        first.name: first.central_role if central_drives else first.rim_role,
        second.name: second.rim_role if central_drives else second.central_role,
    }
    return {mesh.name: _mesh_load(train, mesh, flow, found, drivers[mesh.name]) for mesh in train.meshes}


def _mesh_load(train: TrainData, mesh: SetMesh, flow: PowerFlow, found: MeshLoadFactor, driver: Role) -> MeshLoad:
    """That of one mesh; errors of its load say of which."""
    factor = flow.load.application_factor
    try:
        load = Load(
            torque=_on_pinion(train, mesh, flow),
            speed=_pinion_speed(train, mesh, flow),
            application_factor=factor * found.value,
        )
    except ParameterError as error:
        raise error.within(mesh.name) from error
    return MeshLoad(
        mesh=mesh,
        planets=train.planets,
        load=load,
        driver=driver,
        application_factor=factor,
        mesh_load_factor=found,
    )


def stage_loads(train: TrainData, flow: PowerFlow) -> dict[str, Load]:
    """Of the pairs before and behind the set by their names: torque (N·m) of what their wheels carry, on the pinion."""
    return {
        stage.name: Load(
            torque=flow.stage_torques[stage.name].wheel / stage.pair.gear_ratio + 0.0,
            speed=flow.speeds.members[stage.pinion],
            application_factor=flow.load.application_factor,
        )
        for stage in train.stages
    }


def _on_pinion(train: TrainData, mesh: SetMesh, flow: PowerFlow) -> float:
    """Torque on the pinion of a mesh (N·m): T_1 = T_2 z_1/z_2 with signed teeth, T_2 that on the central."""
    ratio = mesh.pair.pinion.teeth / mesh.central.gear.teeth
    return flow.set_torques[mesh.central.name] / train.planets * ratio + 0.0


def _pinion_speed(train: TrainData, mesh: SetMesh, flow: PowerFlow) -> float:
    """Of the pinion against the carrier (rpm); what is too slow to be a speed is 0."""
    members = flow.speeds.members
    central = members[mesh.central.name] - members[train.carrier.name]
    # A planet is one body, whatever the rim.
    relative = flow.speeds.planet_relative if mesh.rim_role is Role.PINION else central
    return relative if abs(relative) >= _SLOWEST else 0.0


def _rolling(train: TrainData, flow: PowerFlow) -> float:
    """Positive where power rolls from the first central to the second, with the carrier at rest; 0 where none rolls.

    Of a train at rest as a positive speed of its input would have it; of a differential that is none.
    """
    members = flow.speeds.members
    if not any(members.values()):
        try:
            members = speeds(train, {train.input: 1.0}).members
        except ParameterError:
            return 0.0
    central = train.centrals[0].name
    relative = members[central] - members[train.carrier.name]
    return math.copysign(1.0, flow.set_torques[central] * relative) if relative else 0.0
