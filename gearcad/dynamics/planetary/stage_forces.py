"""What the stages before and behind a set push its members across the axis, and how they yield."""

from __future__ import annotations

import math

from gearcad.per_gear import PerGear, Role
from gearcad.planetary import PairStage, PlanetaryTrain
from gearcad.planetary.power import PowerFlow

__all__ = ["mesh_force", "stage_forces"]


def stage_forces(train: PlanetaryTrain, flow: PowerFlow) -> dict[str, tuple[float, float]]:
    """Forces (N) along x and y on the members whose gears stages mesh with, in space."""
    found: dict[str, tuple[float, float]] = {}
    for stage in train.stages:
        for role, member in ((Role.PINION, stage.pinion), (Role.WHEEL, stage.wheel)):
            if member in train.members:
                before = found.get(member, (0.0, 0.0))
                x, y = _on_axis(stage, role, flow.stage_torques[stage.name])
                found[member] = before[0] + x, before[1] + y
    return found


def mesh_force(stage: PairStage, torques: PerGear[float]) -> float:
    """F_bt = T/r_b in the transverse plane (N), of the `torques` (N·m) on its gears by their shafts."""
    return abs(torques.wheel) * 2e3 / abs(stage.pair.wheel.base_diameter)


def _on_axis(stage: PairStage, role: Role, torques: PerGear[float]) -> tuple[float, float]:
    """Force on the gear on the train's axis: along the line of action, against its shaft's torque, off an outer mate."""
    own, mate = stage.pair.gears.pick(role), stage.pair.gears.pick(role.mate)
    towards = math.radians(stage.angle) + math.pi * mate.internal
    pressure = math.radians(stage.pair.working_transverse_pressure_angle)
    force = mesh_force(stage, torques)
    turning = -math.copysign(force * math.cos(pressure), torques.pick(role))
    outward = force * math.sin(pressure) * (1 if own.internal else -1)
    return (
        outward * math.cos(towards) - turning * math.sin(towards),
        outward * math.sin(towards) + turning * math.cos(towards),
    )
