"""A planetary train as one stiffness matrix, what is held on very stiff springs: nothing of the force method."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.springs import SpringKind, TrainSprings, train_springs
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.power import power_flow

__all__ = ["dense_sharing"]

_HARD = 1e7
"""N/µm of what is held."""


def _hard(stiffness: float | None) -> float:
    return _HARD if stiffness is None else stiffness


def _on_springs(train: PlanetaryTrain, output: str) -> PlanetaryTrain:
    """The same with hard springs for what is held; only the output can turn, and what a stage holds."""
    staged = {end for stage in train.stages for end in (stage.pinion, stage.wheel)}

    def turning(name: str, stiffness: float | None) -> float | None:
        return None if name == output or name in staged else stiffness or 1e12

    centrals = tuple(
        replace(
            each,
            support_stiffness=_hard(each.support_stiffness),
            torsional_stiffness=turning(each.name, each.torsional_stiffness),
        )
        for each in train.centrals
    )
    carrier = replace(
        train.carrier,
        support_stiffness=_hard(train.carrier.support_stiffness),
        torsional_stiffness=turning(train.carrier.name, train.carrier.torsional_stiffness),
        pin_stiffness=_hard(train.carrier.pin_stiffness),
    )
    return replace(train, centrals=centrals, carrier=carrier)


def dense_sharing(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: dict[str, float],
    *,
    carrier_angle: float = 0.0,
    run_out_angles: dict[str, float] | None = None,
) -> tuple[Floats, float]:
    """Forces (2, N) of the meshes (N) and the output's twist (deg) against the load; springs that pull are dropped one by one.

    A stage, if any, is one before the set, its wheel on the carrier: here it is a spring of the matrix, from the wheel to a
    pinion that stands in space, which the carrier sees turned back by `carrier_angle` (deg).
    """
    flow = power_flow(train, replace(load, mesh_efficiency=1.0))
    output = train.output
    sense = 1 if flow.set_torques[train.centrals[0].name] > 0 else -1
    pairs = tuple(stiffness[mesh.name] for mesh in train.meshes)
    springs = train_springs(_on_springs(train, output), (pairs[0], pairs[1]), held=(), sense=sense)
    k, v, gap = springs.stiffness, springs.vectors, _gaps(train, springs, sense, run_out_angles or {})
    for stage in train.stages:
        row = _stage_row(train, springs, math.radians(carrier_angle), flow.set_torques[train.carrier.name])
        k, v, gap = np.r_[k, 1e6 * stiffness[stage.name]], np.vstack([v, row]), np.r_[gap, 0.0]
    force = springs.turning(output) * flow.set_torques[output]
    meshes = np.array([springs.select(SpringKind.MESH, mesh.name) for mesh in train.meshes])
    on = np.ones(len(k), bool)
    for _ in range(100):
        active = v[on]
        q, *_ = np.linalg.lstsq((active.T * k[on]) @ active, force + active.T @ (k[on] * gap[on]), rcond=1e-15)
        forces = k * (v @ q - gap)
        wrong = np.zeros(len(k), bool)
        wrong[meshes] = (on == (forces <= 0))[meshes]
        if not wrong.any():
            break
        worst = np.argmax(np.abs(np.where(wrong, forces, 0)))
        on[worst] = not on[worst]
    twist = float(np.degrees(springs.turning(output) @ q)) * np.sign(flow.set_torques[output])
    return np.where(on, forces, 0.0)[meshes], twist


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
