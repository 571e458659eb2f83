"""A planetary train as the System of all solvers, and the Excitation of its 2 N meshes, each at its phase. SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction

import numpy as np

from gearcad.arrays import Floats, Indices
from gearcad.dynamics.excitation.deviations import TransmissionError
from gearcad.dynamics.excitation.mesh_curves import CurveStiffness
from gearcad.dynamics.excitation.meshes import Excitation, MeshExcitation
from gearcad.dynamics.excitation.polyline import Polyline
from gearcad.dynamics.planetary.eigenspaces import MassSprings
from gearcad.dynamics.planetary.masses import TrainMasses
from gearcad.dynamics.planetary.mesh_stiffness import MeshStiffness
from gearcad.dynamics.planetary.springs import SpringKind, TrainSprings
from gearcad.dynamics.trains.system import System
from gearcad.planetary import MeshPhases, PlanetaryTrain

__all__ = ["planetary_excitation", "planetary_system", "static_places"]

_FREE = 1e-11
"""Of the greatest frequency of the lines: rounding of what nothing holds."""


def planetary_system(
    springs: TrainSprings,
    masses: TrainMasses,
    torques: Mapping[str, float],
    *,
    driven: tuple[str, ...] = (),
    damping_ratio: float = 0.0,
    alike: int = 1,
) -> System:
    """The train in the modes that its pins, supports and masses have without the meshes.

    With folded springs every planet stands for so many that are `alike`.

    `torques` (N·m) act on members from outside and balance, but for what is held; springs that hold the turning of `driven`
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
    """(n,): where the coordinates (m) are under torques, meshes at their mean; the least that turns freely.

    Springs that hold the turning of `driven` members stand on what drives them, so they ask for nothing.
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
    stiffness: Mapping[str, MeshStiffness],
    phases: Mapping[str, MeshPhases],
    forces: Mapping[str, float],
    *,
    parting: bool = False,
    alike: int = 1,
) -> Excitation:
    """Tangent stiffness and transmission error of every mesh, those of the first central before those of the second.

    `forces` (N) are what each planet's share presses each mesh with at rest, where it lags by its transmission error. With
    `parting` flanks part, and meet behind after the backlash. The first of planets that are `alike` stand for all.
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


def _phase(stiffness: MeshStiffness) -> Floats:
    """Phases (n,) of a mesh, over exactly 2 pi."""
    phase = 2 * np.pi * stiffness.ahead
    phase[-1] = phase[0] + 2 * np.pi
    return phase


def _free_error(stiffness: MeshStiffness, shape: CurveStiffness, force: float) -> TransmissionError:
    """What is left of the loaded transmission error without F/k: at rest under the force the planet lags by just the former.

    Where the mean stiffness was given, what gives way under load does so by it. k is that of the model, mean times `shape`.
    """
    cycle = stiffness.cycle
    unloaded = stiffness.transmission_error - cycle.force / (stiffness.secant * (cycle.mean / stiffness.mean))
    height = unloaded + force / stiffness.secant - force / (stiffness.tangent_mean * shape.stiffness)
    return TransmissionError(line=Polyline(phase=_phase(stiffness), height=height))


# ---------------------------------------------------------------------- pieces


def _line_modes(model: MassSprings, others: Indices) -> tuple[Floats, Floats]:
    """Squares (n,) of the frequencies that the other springs and the masses have, 0 where nothing holds, and the modes."""
    rooted = model.rooted[others]
    _, values, modes = np.linalg.svd(np.vstack([rooted, np.zeros((max(0, len(model.lower) - len(rooted)), len(model.lower)))]))
    values[values <= _FREE * max(float(values.max(initial=0.0)), 1e-300)] = 0.0
    return values**2, modes.T


def _turns(springs: TrainSprings) -> Floats:
    """(N + 3, n): turns of members and planets (rad) per coordinate."""
    planar = springs.planar
    radii = np.array([*(member.radius for member in planar.members), *[planar.planet_radius] * planar.planets])
    return np.asarray(springs.basis[2::3] / radii[:, None], float)


def _alone(springs: TrainSprings, mass: Floats, meshes: Indices) -> Floats:
    """(m,) in kg: the mass that turning central and planet alone have along the line of action; what is held is none."""
    result = []
    for mesh in meshes:
        spring = springs.springs[mesh]
        central = 1 + [line.name for line in springs.planar.meshes].index(spring.owner)
        assert spring.planet is not None  # a mesh has one
        line = springs.planar.meshes[central - 1]
        turns = [(3 * central + 2, 1.0), (11 + 3 * spring.planet, line.rim_ratio)]
        result.append(1 / sum(way**2 / mass[place] for place, way in turns if mass[place]))
    return np.array(result)
