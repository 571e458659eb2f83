"""A planetary train as one stiffness matrix, in which stages are springs, too: nothing of the force method."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Bools, Floats
from gearcad.dynamics.planetary.planar_model import SpringKind, TrainSprings, train_springs
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.power import power_flow

_HARD = 1e8
"""N/µm of pins that are rigid, so that they can have errors."""

_OPEN = 1e-8
"""Part of its stiffness that a mesh has left where it is open: nothing is loose."""


def dense_sharing(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: Mapping[str, ArrayLike],
    *,
    carrier_angle: float = 0.0,
    run_out_angles: dict[str, float] | None = None,
) -> tuple[Floats, float]:
    """Forces (2, N) of the meshes (N) and the output's twist (deg) against the load.

    A stage, if any, is one before the set, its wheel on the carrier: here it is a spring of the matrix, from the wheel to a
    pinion that stands in space, which the carrier sees turned back by `carrier_angle` (deg).
    """
    flow = power_flow(train, replace(load, mesh_efficiency=1.0))
    output = train.output
    sense = 1 if flow.set_torques[train.centrals[0].name] > 0 else -1
    staged = {end for stage in train.stages for end in (stage.pinion, stage.wheel)}
    held = [name for name in train.members if name != output and name not in staged]
    pinned = replace(train, carrier=replace(train.carrier, pin_stiffness=train.carrier.pin_stiffness or _HARD))
    first, second = (stiffness[mesh.name] for mesh in train.meshes)
    springs = train_springs(pinned, (first, second), held=held, sense=sense)
    k, v, gap = springs.stiffness, springs.vectors, _gaps(train, springs, sense, run_out_angles or {})
    for stage in train.stages:
        row = _stage_row(train, springs, math.radians(carrier_angle), flow.set_torques[train.carrier.name])
        k, v, gap = np.r_[k, 1e6 * np.asarray(stiffness[stage.name])], np.vstack([v, row]), np.r_[gap, 0.0]
    force = springs.turning(output) * flow.set_torques[output]
    meshes = np.array([springs.select(SpringKind.MESH, mesh.name) for mesh in train.meshes])
    press = np.zeros(len(k), bool)
    press[meshes] = True
    q = _least_energy(k, v, gap, force, press)
    forces = k * (v @ q - gap)
    twist = float(np.degrees(springs.turning(output) @ q)) * np.sign(flow.set_torques[output])
    return np.maximum(forces[meshes], 0.0), twist


def _least_energy(k: Floats, v: Floats, gap: Floats, force: Floats, press: Bools) -> Floats:
    """q of the least of the convex energy of springs of which some are soft when open: Newton's steps, halved as needed."""

    def stiffness(q: Floats) -> Floats:
        return np.where(press & (v @ q < gap), _OPEN * k, k)

    def energy(q: Floats) -> float:
        return float(stiffness(q) @ (v @ q - gap) ** 2 / 2 - force @ q)

    q = np.zeros(v.shape[1])
    for _ in range(200):
        now = stiffness(q)
        full = np.linalg.solve((v.T * now) @ v, force + v.T @ (now * gap))
        step = 1.0
        while step > 1e-9 and energy(q + step * (full - q)) > energy(q):
            step /= 2
        q = q + step * (full - q)
        if (stiffness(q) == now).all():
            return q
    raise AssertionError("the energy has not settled")


def _gaps(train: PlanetaryTrain, springs: TrainSprings, sense: int, angles: dict[str, float]) -> Floats:
    """In m: errors of pins and teeth, and run-outs at the angles (deg) that are given."""
    gap = np.zeros(len(springs.springs))
    gap[springs.select(SpringKind.PIN_TANGENTIAL)] = -sense * 1e-6 * np.array(train.carrier.pin_errors or 0.0)
    for mesh in train.meshes[: len(train.rims)]:
        gap[springs.select(SpringKind.MESH, mesh.name)] = -1e-6 * np.array(mesh.rim.tooth_errors or 0.0)
    for mesh in train.meshes:
        turned = math.radians(angles.get(mesh.central.name, 0.0))
        away = 1e-6 * mesh.central.run_out * np.array([math.cos(turned), math.sin(turned)])
        pressure = mesh.working_pressure_angle
        line = next(each for each in springs.planar.meshes if each.name == mesh.name)
        for n, place in enumerate(springs.select(SpringKind.MESH, mesh.name)):
            # Unit vector of the force on the central: along its rotation, off a sun's planet, out of a ring's.
            psi, back = springs.planar.angles[n], -line.sense
            outward = -1 if mesh.external else 1
            along = back * math.cos(pressure) * np.array([-math.sin(psi), math.cos(psi)])
            normal = along + outward * math.sin(pressure) * np.array([math.cos(psi), math.sin(psi)])
            gap[place] += normal @ away
    return gap


def _stage_row(train: PlanetaryTrain, springs: TrainSprings, carrier_angle: float, torque: float) -> Floats:
    """Elongation of the stage's mesh, positive where the pinion presses the wheel against the carrier's `torque`."""
    (stage,) = train.stages
    towards = math.radians(stage.angle) - carrier_angle
    pressure = math.radians(stage.pair.working_transverse_pressure_angle)
    side = math.copysign(1.0, torque)  # the flank pushes the wheel with the torque that the set asks for
    normal = side * math.cos(pressure) * np.array([-math.sin(towards), math.cos(towards)])
    normal -= math.sin(pressure) * np.array([math.cos(towards), math.sin(towards)])
    row = np.zeros(len(springs.basis))
    row[:2] = -normal
    row[2] = -side * abs(stage.pair.wheel.base_diameter) / 2 / float(train.centre_distance)
    found: Floats = row @ springs.basis
    return found
