"""Mesh stiffness of a planetary train at its phases, and the train as the System and Excitation of all solvers. SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Floats, Indices, Notice, Role
from gearcad.dynamics.options import AUTO, DynamicsOptions
from gearcad.dynamics.planetary.planar_model import SpringKind, TrainMasses, TrainSprings
from gearcad.dynamics.planetary.planetary_modes import MassSprings
from gearcad.dynamics.trains.mesh_excitation import CurveStiffness, Excitation, MeshExcitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.tooth_deviations import PeriodicLine, TransmissionError
from gearcad.load import Load
from gearcad.material import Material, Materials
from gearcad.mesh_cycle import MeshCycle
from gearcad.planetary import MeshPhases, PlanetaryTrain, SetMesh
from gearcad.planetary.members import TrainMaterial, mesh_material
from gearcad.planetary.poses import mesh_phases
from gearcad.planetary.power import MeshLoad
from gearcad.stiffness.methods import METHODS

QUICK = "strain-energy"
"""Default method: suns and rings, spur and helical, in less than a second a mesh."""

NOMINAL_STRESS = 10.0
"""F_bt/(b m_n) in MPa for a mesh without a load: little, for contact is the stiffer the more it carries."""


_JUMP = 1e-9
"""Change, over the mean, that is not rounding: helical cycles have places twice where they only bend."""


@dataclass(frozen=True, kw_only=True)
class PlanetMeshStiffness:
    """Stiffness of the mesh of a central with one planet, by the MeshCycle of its pair.

    `ahead` is always in base pitches: how far contact is past the pitch point in the direction in which it moves. It is the
    same for every pair of teeth that touches, so that only its fraction counts. Contact moves from root to tip of the gear that
    drives, `driver`, with the carrier at rest. For helical teeth it is that of the middle of the common face width. Where
    `Central.mesh_stiffness` gives the mean, secant and tangent stiffness have that mean, and the course of the cycle.
    `nominal`: the train has no load, and the cycle is that of NOMINAL_STRESS.
    """

    mesh: SetMesh
    cycle: MeshCycle
    driver: Role
    nominal: bool = False

    @property
    def _sense(self) -> int:
        """1 where contact moves as the roll angle of the pinion rises, -1 where the wheel drives."""
        return 1 if self.driver is Role.PINION else -1

    @property
    def given(self) -> bool:
        """Whether the mean stiffness was given."""
        return self.mesh.central.mesh_stiffness is not None

    @cached_property
    def ahead(self) -> Floats:
        """Places (n,) in base pitches, rising over exactly one; equal values where the stiffness jumps."""
        return self._placed(self._sense * self.cycle.roll_angle / self.cycle.pitch_angle)

    @cached_property
    def secant(self) -> Floats:
        """Secant stiffness F/delta (n,) at the load (N/µm), at `ahead`."""
        return self._placed(self.cycle.mesh_stiffness * (self.mean / self.cycle.mean))

    @cached_property
    def tangent(self) -> Floats:
        """Tangent stiffness dF/ddelta (n,) at the load (N/µm), at `ahead`."""
        return self._placed(self.cycle.tangent_stiffness * (self.tangent_mean / self.cycle.tangent_mean))

    @cached_property
    def transmission_error(self) -> Floats:
        """Lag of the driven gear under the load (n,) along the line of action (µm), at `ahead`."""
        return self._placed(self.cycle.transmission_error)

    @property
    def mean(self) -> float:
        """Mean secant stiffness (N/µm)."""
        return self.cycle.mean if self.mesh.central.mesh_stiffness is None else self.mesh.central.mesh_stiffness

    @property
    def tangent_mean(self) -> float:
        """Mean tangent stiffness (N/µm)."""
        return self.cycle.tangent_mean if self.mesh.central.mesh_stiffness is None else self.mesh.central.mesh_stiffness

    @property
    def jumps(self) -> Floats:
        """Places (j,) within one base pitch, from 0 to 1, where the number of pairs in contact changes at once."""
        twice = np.flatnonzero((np.diff(self.ahead) == 0) & (np.abs(np.diff(self.secant)) > _JUMP * self.mean))
        return np.sort(np.mod(self.ahead[twice], 1.0))

    def stiffness_at(self, ahead: ArrayLike, *, tangent: bool = False) -> Floats:
        """Return the secant (or tangent) stiffness (N/µm) at places (...) in base pitches, in their shape."""
        start = self.ahead[0]
        within = np.mod(np.asarray(ahead, float) - start, 1.0) + start
        result: Floats = np.interp(within, self.ahead, self.tangent if tangent else self.secant)
        return result

    def _placed(self, values: Floats) -> Floats:
        """Return values (n,) of the cycle in the order in which they come."""
        return values[:: self._sense]

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of the method, that the load is nominal, and that the mean was given."""
        name, found = self.mesh.name, list(self.cycle.notices)
        if self.nominal:
            text = f"without a load, its stiffness is that at F_bt/(b m_n) = {NOMINAL_STRESS:g} MPa, {self.cycle.force:.4g} N"
            found.append(Notice("nominal-load", text))
        if self.given and not self.cycle.mean_only:
            own = f"by {self.cycle.method} it is {self.cycle.mean:.4g}"
            found.append(Notice("stiffness-given", f"the mean of its stiffness is given, {self.mean:g} N/µm; {own}"))
        return tuple(notice.within(name) for notice in found)


def mesh_stiffness(
    mesh: SetMesh,
    load: Load | None = None,
    *,
    driver: Role = Role.PINION,
    method: str = QUICK,
    material: Materials | None = None,
    positions: int = 0,
) -> PlanetMeshStiffness:
    """Return the stiffness of a mesh under the `load` of one planet, with the torque (N·m) on the pair's pinion.

    Without a load, or a torque, it is that of a small nominal one. `method` is a name of `gearcad.stiffness.METHODS`, or
    "auto": that of `gearcad dynamics`, whose course does not jump. With 0 `positions` the method chooses their number. Raises
    ParameterError for an unknown method, and the errors of methods. GeometryError is raised only where no mean was given: a
    given mean needs no course.
    """
    if method == AUTO:
        method = DynamicsOptions().method_for(mesh.pair)
    if method not in METHODS:
        raise ParameterError("method", method, f"must be one of {', '.join(METHODS)}")
    nominal = load is None or not load.torque
    carried = nominal_load(mesh) if load is None or nominal else load
    try:
        found = METHODS[method](pair=mesh.pair, material=material or Material(), positions=positions)(carried)
    except GeometryError as error:
        if (mean := mesh.central.mesh_stiffness) is None:
            raise
        found = _flat(mesh, carried, mean, str(error))
    return PlanetMeshStiffness(mesh=mesh, cycle=found, driver=driver, nominal=nominal)


def _flat(mesh: SetMesh, load: Load, mean: float, why: str) -> MeshCycle:
    """Return the cycle of a mean (N/µm) for which no method gives a course, with the reason."""
    pinion = mesh.pair.pinion
    torque = abs(load.torque) * load.application_factor
    force, half, constant = 2000 * torque / pinion.base_diameter, 180 / pinion.teeth, np.full(2, mean)
    return MeshCycle(
        method="given",
        holds=(),
        torque=torque,
        force=force,
        width=mesh.pair.common_width.width,
        roll_angle=np.array([-half, half]),
        mesh_stiffness=constant,
        tangent_stiffness=constant.copy(),
        transmission_error=force / constant,
        mean_only=True,
        notices=(Notice("course-unknown", f"its stiffness over the mesh cycle is not known: {why}"),),
    )


def train_stiffness(
    train: PlanetaryTrain,
    loads: Mapping[str, MeshLoad] | None = None,
    *,
    method: str = QUICK,
    material: TrainMaterial | None = None,
    positions: int = 0,
) -> dict[str, PlanetMeshStiffness]:
    """Return the stiffness of both meshes by their names, as `mesh_stiffness` under the even share of `loads` with K_A.

    Without loads the contact moves as the input drives. `stiffness_at(MeshPhases.ahead[n])` is then that of planet n in the
    pose of the phases, if these are of the same drive.
    """
    drivers = {name: each.driver for name, each in (loads or mesh_phases(train)).items()}
    return {
        mesh.name: mesh_stiffness(
            mesh,
            None if loads is None else loads[mesh.name].even,
            driver=drivers[mesh.name],
            method=method,
            material=mesh_material(material, mesh),
            positions=positions,
        )
        for mesh in train.meshes
    }


def nominal_load(mesh: SetMesh) -> Load:
    """Return the load of a mesh without a load of its own: F_bt/(b m_n) = NOMINAL_STRESS."""
    pinion = mesh.pair.pinion
    force = NOMINAL_STRESS * mesh.pair.common_width.width * pinion.normal_module
    return Load(torque=force * pinion.base_diameter / 2000)


_FREE = 1e-11
"""Part of the greatest frequency of the lines: rounding of motions that nothing holds."""


def planetary_system(
    springs: TrainSprings,
    masses: TrainMasses,
    torques: Mapping[str, float],
    *,
    driven: tuple[str, ...] = (),
    damping_ratio: float = 0.0,
    alike: int = 1,
) -> System:
    """Return the System of the train, in the modes that its pins, supports and masses have without the meshes.

    With folded springs every planet stands for `alike` planets.

    `torques` (N·m) act on members from outside and balance, except on held members. Springs that hold the turning of `driven`
    members carry their torques at rest, whatever these are. `damping_ratio` is that of every mode of pins and supports, and of
    every mesh as if central and planet were alone on rigid axes. Raises ParameterError.
    """
    model = MassSprings.of(springs, masses)
    meshes = springs.select(SpringKind.MESH)
    others = np.setdiff1d(np.arange(len(springs.springs)), meshes)
    squares, modes = _line_modes(model, others)
    reduced = np.asarray(np.linalg.solve(model.lower.T, modes), float)
    stiffness = springs.stiffness[meshes]
    mass = model.mass
    load = springs.matrix() @ static_places(springs, torques, driven)
    bodies = _turns(springs)
    members = springs.members
    return System(
        squares=squares,
        damping=2 * damping_ratio * np.sqrt(squares),
        mesh=(springs.vectors[meshes] @ reduced).T,
        inertias=(bodies @ reduced).T,
        shaft_torques=np.zeros((len(squares), 0)),
        load=reduced.T @ load,
        stiffness=stiffness,
        mesh_damping=2 * damping_ratio * np.sqrt(stiffness * alike * _alone(springs, mass, meshes)),
        names=(
            tuple(springs.names[mesh] for mesh in meshes),
            (*members, *(f"planet {n + 1}" for n in range(springs.planar.planets))),
            (),
        ),
    )


def static_places(springs: TrainSprings, torques: Mapping[str, float], driven: tuple[str, ...] = ()) -> Floats:
    """Return the coordinates (n,) in m under torques, with meshes at their mean stiffness.

    Of free turns it is the least. Springs that hold the turning of `driven` members stand on what drives them, so they are not
    deflected.
    """
    loose = [i for i, each in enumerate(springs.springs) if each.kind is SpringKind.TORSION and each.owner in driven]
    kept = springs.stiffness.copy()
    kept[loose] = 0.0
    load = sum((torque * springs.turning(name) for name, torque in torques.items()), np.zeros(len(springs.coordinates)))
    # By elongations, whose rounding is not that of stiffnesses.
    rooted = springs.vectors * np.sqrt(kept)[:, None]
    return np.asarray(np.linalg.pinv(rooted, rcond=_FREE) @ (np.linalg.pinv(rooted.T, rcond=_FREE) @ load), float)


def planetary_excitation(
    train: PlanetaryTrain,
    stiffness: Mapping[str, PlanetMeshStiffness],
    phases: Mapping[str, MeshPhases],
    forces: Mapping[str, float],
    *,
    parting: bool = False,
    alike: int = 1,
) -> Excitation:
    """Return the excitation of every mesh, those of the first central before those of the second.

    It has the tangent stiffness and transmission error. `forces` (N) are those of each planet's share on each mesh at rest,
    where it lags by its transmission error. With `parting` flanks part, and meet behind after the backlash. The first of
    planets that are `alike` stand for all.
    """
    first, second = train.meshes
    ratios = Fraction(1), Fraction(second.rim.gear.teeth, first.rim.gear.teeth)
    meshes: list[MeshExcitation] = []
    for mesh, ratio in zip(train.meshes, ratios, strict=True):
        own = stiffness[mesh.name]
        shape = CurveStiffness(phase=_phase(own), stiffness=own.tangent)
        error = _free_error(own, shape, forces[mesh.name])
        backlash = max(1000 * mesh.pair.circumferential_backlash * math.cos(mesh.working_pressure_angle), 0.0)
        meshes += [
            MeshExcitation(
                stiffness=shape, phase=360 * ahead, frequency_ratio=ratio, error=error, backlash=backlash if parting else None
            )
            for ahead in phases[mesh.name].ahead[: train.planets // alike]
        ]
    return Excitation(meshes=tuple(meshes))


def _phase(stiffness: PlanetMeshStiffness) -> Floats:
    """Return the phases (n,) of a mesh in rad, over exactly 2 pi."""
    phase = 2 * np.pi * stiffness.ahead
    phase[-1] = phase[0] + 2 * np.pi
    return phase


def _free_error(stiffness: PlanetMeshStiffness, shape: CurveStiffness, force: float) -> TransmissionError:
    """Return the loaded transmission error less F/k (µm): at rest under the force (N) the planet lags by just the former.

    Where the mean stiffness was given, the deflection under load follows from it. k is that of the model, mean times `shape`.
    """
    cycle = stiffness.cycle
    unloaded = stiffness.transmission_error - cycle.force / (stiffness.secant * (cycle.mean / stiffness.mean))
    height = unloaded + force / stiffness.secant - force / (stiffness.tangent_mean * shape.stiffness)
    return TransmissionError(line=PeriodicLine(phase=_phase(stiffness), height=height))


# ---------------------------------------------------------------------- pieces


def _line_modes(model: MassSprings, others: Indices) -> tuple[Floats, Floats]:
    """Return squares (n,) of the frequencies of the springs `others` and the masses, and the modes.

    A square is 0 where nothing holds a mode.
    """
    rooted = model.rooted[others]
    _, values, modes = np.linalg.svd(np.vstack([rooted, np.zeros((max(0, len(model.lower) - len(rooted)), len(model.lower)))]))
    values[values <= _FREE * max(float(values.max(initial=0.0)), 1e-300)] = 0.0
    return values**2, modes.T


def _turns(springs: TrainSprings) -> Floats:
    """Return the turns (N + 3, n) of members and planets (rad) per coordinate."""
    planar = springs.planar
    radii = np.array([*(member.radius for member in planar.members), *[planar.planet_radius] * planar.planets])
    return np.asarray(springs.basis[2::3] / radii[:, None], float)


def _alone(springs: TrainSprings, mass: Floats, meshes: Indices) -> Floats:
    """Return the masses (m,) in kg that turning central and planet alone have along the line of action.

    A held gear has no part in it.
    """
    result = []
    for mesh in meshes:
        spring = springs.springs[mesh]
        central = 1 + [line.name for line in springs.planar.meshes].index(spring.owner)
        assert spring.planet is not None  # a mesh has one
        line = springs.planar.meshes[central - 1]
        turns = [(3 * central + 2, 1.0), (11 + 3 * spring.planet, line.rim_ratio)]
        result.append(1 / sum(way**2 / mass[place] for place, way in turns if mass[place]))
    return np.array(result)
