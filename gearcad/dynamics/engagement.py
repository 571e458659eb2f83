"""Pairs of a train under its loads: static forces, the flanks that carry, and the course of the stiffness of each mesh."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from gearcad.contact.shared.bodies import BodyModel
from gearcad.core.errors import InputError, ParameterError, SolverError
from gearcad.core.quantities import TORQUE
from gearcad.core.records import Floats, Notice, Role
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.trains.members import MeshCourse, MeshPair, ToothMesh
from gearcad.dynamics.trains.solid_inertias import solid_notices
from gearcad.dynamics.trains.train import EngagedMesh, Train, pressing_forces
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting
from gearcad.stiffness.method import StiffnessMethod

__all__ = ["PinionLoad", "engaged", "pair_notices", "pinion_loads"]


_FIRST_GUESS = 15.0
"""Mean stiffness per face width (N/(mm·µm)) with which the iteration of the static forces begins."""

_SAME = 1e-7
"""Relative change of the static forces below which they count as settled."""

_MOST_ROUNDS = 30

_NO_FORCE = 1e-9
"""Part of the greatest mesh force below which a mesh carries no force."""

_ROUNDING = 1e-9
"""Relative rounding error of the equations of a train."""

_OTHER = 1e-3
"""Relative difference above which two loads count as different."""


class PinionLoad(NamedTuple):
    """Load of the pinion of a mesh: torque (N·m) and speed (rpm), counter-clockwise positive, and the gear that drives."""

    torque: float
    speed: float
    driver: Role


def pinion_loads(train: Train, options: DynamicsOptions | None = None) -> dict[str, PinionLoad]:
    """Return what a train gives the pinions of its meshes by their names: torques at rest, without losses, and speeds.

    They are the static forces under which `engaged` studies the pairs. Only where these depend on the stiffness of the meshes
    the mesh cycles of the pairs are needed. Raises ParameterError for a pair that carries no force, and what `engaged` raises.
    """
    places = [j for j, mesh in enumerate(train.meshes) if mesh.pair is not None and not isinstance(mesh, EngagedMesh)]
    try:
        forces = _static_forces(train, options or DynamicsOptions(), places)
    finally:
        _method.cache_clear()
    return {mesh.name: _pinion_load(train, j, forces) for j, mesh in enumerate(train.meshes)}


def _static_forces(train: Train, options: DynamicsOptions, places: Sequence[int]) -> Floats:
    """Return the signed mesh forces (m,) in N, by mesh cycles only where they depend on the stiffness of the meshes."""
    first = _first_guess(train, places)
    forces = pressing_forces(_lumped(train, first))
    if not places:
        return forces
    other = pressing_forces(_lumped(train, {j: (2.0 + place) * each for place, (j, each) in enumerate(first.items())}))
    if np.abs(other - forces).max() > _SAME * np.abs(forces).max():
        return _settled(train, options, places)[0]
    for j in places:
        _require_force(train.meshes[j], float(forces[j]), float(np.abs(forces).max()))
    return forces


def _pinion_load(train: Train, j: int, forces: Floats) -> PinionLoad:
    """Return the load of the pinion of the mesh with number `j` under the signed mesh forces (m,) in N."""
    mesh = train.meshes[j]
    ratio = train.speed_ratios[mesh.pinion]
    turning = math.copysign(1.0, train.speed or forces[0]) * ratio
    driver = Role.PINION if forces[j] * turning > 0 else Role.WHEEL
    torque = _torque(mesh, forces[j])
    return PinionLoad(torque if mesh.pair is None else _in_range(mesh, torque), train.speed * ratio, driver)


def engaged(train: Train, options: DynamicsOptions | None = None) -> Train:
    """Return the train with its pairs under static loads: each mesh of a pair becomes an EngagedMesh with its stiffness course.

    The options give the stiffness method, the damping ratio of meshes that have none and, if set, the accuracy grade. If static
    forces depend on the stiffness, as in a train held at several places, both are found in turns until the forces settle.
    Without a speed the first pinion turns the way in which it drives.

    Raises ParameterError if a mesh of a pair carries no force, SolverError if the forces do not settle, and errors of the
    methods.
    """
    places = [j for j, mesh in enumerate(train.meshes) if mesh.pair is not None and not isinstance(mesh, EngagedMesh)]
    if not places:
        return train
    options = options or DynamicsOptions()
    try:
        forces, cycles, rounds = _settled(train, options, places)
    finally:
        # Bodies of finite elements are large; the curves are kept.
        _method.cache_clear()
    meshes = list(train.meshes)
    for j in places:
        meshes[j] = _engaged(meshes[j], cycles[j], _pinion_load(train, j, forces), rounds, options)
    return replace(train, meshes=tuple(meshes))


def _settled(train: Train, options: DynamicsOptions, places: Sequence[int]) -> tuple[Floats, dict[int, MeshCycle], int]:
    """Return the signed mesh forces (m,) in N, the mesh cycles of the pairs under them, and the number of rounds."""
    forces = pressing_forces(_lumped(train, _first_guess(train, places)))
    for rounds in range(1, _MOST_ROUNDS + 1):
        cycles = {j: _cycle_of(train.meshes[j], float(forces[j]), np.abs(forces).max(), options) for j in places}
        before, forces = forces, pressing_forces(_lumped(train, {j: cycle.tangent_mean for j, cycle in cycles.items()}))
        if np.abs(forces - before).max() <= _SAME * np.abs(before).max():
            return before, cycles, rounds
    raise SolverError(f"the static forces in the meshes of {train.name} and the stiffness of their pairs do not settle")


def _first_guess(train: Train, places: Sequence[int]) -> dict[int, float]:
    """Return the stiffness (N/µm) of the meshes with these numbers with which the iteration begins."""
    return {j: _FIRST_GUESS * _pair(train.meshes[j]).mounted.common_width.width for j in places}


def _lumped(train: Train, stiffness: Mapping[int, float]) -> Train:
    """Return the train with springs of given stiffness (N/µm) in place of its pairs."""
    meshes = list(train.meshes)
    for j, each in stiffness.items():
        mesh = meshes[j]
        meshes[j] = ToothMesh(
            name=mesh.name,
            pinion=mesh.pinion,
            wheel=mesh.wheel,
            base_radii=mesh.base_radii.map(float),
            stiffness=float(each),
            teeth=int(mesh.teeth),
            preload=mesh.preload,
            internal=mesh.internal,
        )
    return replace(train, meshes=tuple(meshes))


def _pair(mesh: ToothMesh) -> MeshPair:
    assert isinstance(mesh.pair, MeshPair)  # a GearPair became one when the mesh was made
    return mesh.pair


def _torque(mesh: ToothMesh, force: float) -> float:
    """Return the torque on the pinion (N·m) of a force along the line of action (N)."""
    return float(force) * mesh.base_radii.pinion / 1000


def _cycle_of(mesh: ToothMesh, force: float, greatest: float, options: DynamicsOptions) -> MeshCycle:
    """Return the mesh cycle of a mesh under a force (N); `greatest` is the greatest of all mesh forces (N).

    Raises ParameterError if the mesh carries no force.
    """
    _require_force(mesh, force, greatest)
    of, torque = _pair(mesh), _in_range(mesh, _torque(mesh, force))
    try:
        return _cycle(options.method_for(of.mounted), of.pair, of.material, of.body, of.mounting, torque)
    except InputError as error:
        raise error.within(mesh.name) from error


def _require_force(mesh: ToothMesh, force: float, greatest: float) -> None:
    """Raise ParameterError if a mesh carries no force (N); `greatest` is the greatest of all mesh forces (N)."""
    if abs(force) <= _NO_FORCE * greatest or not force:
        permitted = "carries nothing at rest, and its stiffness depends on the load: give torques that reach it, or a preload"
        raise ParameterError(f"{mesh.name}.pair", _pair(mesh).pair.name, permitted)


def _in_range(mesh: ToothMesh, torque: float) -> float:
    """Return a torque (N·m) on the pinion of a mesh, or the end of the permitted range if it is outside by rounding only.

    Raises ParameterError for a torque outside the range that a pair can have.
    """
    least, most = TORQUE.least or 0.0, TORQUE.most or math.inf
    nearest = min(max(abs(torque), least), most)
    if nearest == abs(torque):
        return torque
    if not math.isclose(nearest, abs(torque), rel_tol=_ROUNDING):
        permitted = (
            f"is what torques and preloads give the pinion of mesh {mesh.name} at rest: its pair can be looked at under"
            f" {least:g} to {most:g} N·m"
        )
        raise ParameterError("torques", torque, permitted, "N·m")
    return math.copysign(nearest, torque)


@lru_cache(128)
def _cycle(name: str, pair: GearPair, material: Materials, body: BodyModel, mounting: Mounting, torque: float) -> MeshCycle:
    """Return the mesh cycle under a torque on the pinion (N·m).

    The last results are cached, because the same trains are studied repeatedly.
    """
    return _method(name, pair, material, body, mounting)(Load(torque=torque))


@lru_cache(None)
def _method(name: str, pair: GearPair, material: Materials, body: BodyModel, mounting: Mounting) -> StiffnessMethod:
    from gearcad.stiffness.methods import METHODS  # only here: trains without pairs do not need them

    return METHODS[name](pair=pair, material=material, body=body, mounting=mounting)


def _engaged(mesh: ToothMesh, cycle: MeshCycle, load: PinionLoad, rounds: int, options: DynamicsOptions) -> EngagedMesh:
    from gearcad.stiffness.methods import METHODS

    given = {each.name: getattr(mesh, each.name) for each in fields(ToothMesh)}
    if mesh.damping is None and mesh.damping_ratio is None:
        given["damping_ratio"] = options.damping_ratio
    if options.accuracy_grade is not None:
        rating = replace(_pair(mesh).rating, accuracy_grade=options.accuracy_grade)
        given["pair"] = replace(_pair(mesh), rating=rating)
    # One round: the force does not depend on the stiffness, nor on how far the flanks have approached.
    offset = cycle.mean_of(cycle.transmission_error) - cycle.force / cycle.tangent_mean if rounds > 1 else 0.0
    title = METHODS[cycle.method].title
    course = MeshCourse(cycle=cycle, title=title, torque=load.torque, driver=load.driver, rounds=rounds, offset=offset)
    return EngagedMesh(**given, course=course)


def pair_notices(train: Train) -> tuple[Notice, ...]:
    """Return the notices about the pairs of a train, each with the name of its mesh, and of inertias that are from solids."""
    engaged_meshes = [mesh for mesh in train.meshes if isinstance(mesh, EngagedMesh)]
    of_pairs = (notice.within(mesh.name) for mesh in engaged_meshes for notice in _notices(train, mesh))
    return (*solid_notices(train.inertias, train.meshes), *of_pairs)


def _notices(train: Train, mesh: EngagedMesh) -> Iterator[Notice]:
    """Yield notices of the stiffness method, and of a pair's own load that is not the train's or has an application factor."""
    yield from mesh.course.cycle.notices
    own, torque = mesh.teeth_of.load, abs(mesh.course.torque)
    if own is None:
        return
    speed = abs(train.speed * train.speed_ratios[mesh.pinion])
    other_speed = bool(own.speed and speed) and not math.isclose(abs(own.speed), speed, rel_tol=_OTHER)
    if other_speed or not math.isclose(abs(own.torque), torque, rel_tol=_OTHER):
        at = f" at {speed:.6g} rpm" if speed else ""
        own_at = f" at {abs(own.speed):.6g} rpm" if own.speed else ""
        text = f"the train gives its pinion {torque:.6g} N·m{at}, not {abs(own.torque):.6g} N·m{own_at} of the pair's own load"
        yield Notice("other-load", text)
    if own.application_factor != 1:
        text = f"the application factor {own.application_factor:g} of the pair's own load is for its rating: the train has none"
        yield Notice("no-application-factor", text)
