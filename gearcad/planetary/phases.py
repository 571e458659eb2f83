"""Mesh phases: how far the contact of each planet is past the pitch point, from the poses, whatever the set."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

from gearcad.errors import ParameterError
from gearcad.geometry import involute
from gearcad.geometry.helix import twist
from gearcad.per_gear import Role
from gearcad.planetary.load import TrainLoad
from gearcad.planetary.mesh import SetMesh
from gearcad.planetary.poses import PlanetPose, train_pose
from gearcad.planetary.shafts import shafts_of
from gearcad.planetary.speeds import speeds
from gearcad.planetary.train_data import TrainData

__all__ = ["Drive", "MeshPhases", "drive_of", "mesh_phases", "phases_between"]

_ROUNDING = 1e-10
"""Base pitches by which a phase may miss a whole pitch and still count as 0."""


@dataclass(frozen=True, kw_only=True)
class MeshPhases:
    """Where the contacts of a mesh are, in base pitches from 0 to 1, by planets.

    `ahead`: how far contact is past the pitch point in the direction in which it moves, in the middle plane of the teeth (of
    double helical ones, of the lower half), with the backlash closed towards the flanks that carry, and the planets as they
    are posed. `relative`: the same less that of planet 0, which stays as the train turns. Contact moves from root to tip of
    the gear of the pair that drives, `driver`. `left_flanks`: whether those of the planets that carry are the left ones, seen
    from +z with the tooth up.
    """

    ahead: tuple[float, ...]
    relative: tuple[float, ...]
    driver: Role
    left_flanks: bool

    @property
    def cycle(self) -> tuple[float, ...]:
        """Where each planet is in the mesh cycle of the pair: roll angle of the pinion over that of a base pitch, 0 to 1."""
        return self.ahead if self.driver is Role.PINION else tuple(_fraction(-each) for each in self.ahead)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "ahead": list(self.ahead),
            "relative": list(self.relative),
            "driver": self.driver.value,
            "left_flanks": self.left_flanks,
        }


class Drive(NamedTuple):
    """How a set is driven: the torque on the first central from outside, and its motion against the carrier.

    1 is counter-clockwise, -1 clockwise; where the two are equal the first central drives the planets.
    """

    sense: int = 1
    turning: int = 1


def drive_of(train: TrainData, load: TrainLoad | None = None) -> Drive:
    """How a train with a fixed member is driven at a load, of which the signs count; without one, or at rest, its input turns
    counter-clockwise and drives.

    Losses do not count: what locks itself does not run. Of a differential, which has two inputs, the first central drives.
    """
    if train.fixed is None:
        return Drive()
    speed = math.copysign(1.0, load.speed) if load and load.speed else 1.0
    power = math.copysign(1.0, load.given_torque) if load and load.given_torque else 1.0
    moving = speeds(train, {train.input: speed}).members
    a, b, c = train.members
    i0, member = train.basic_ratio, shafts_of(train)[train.input].member
    torque = power * moving[member] * {a: 1.0, b: -i0, c: i0 - 1}[member]  # T_b = -i_0 T_a, T_a + T_b + T_c = 0
    return Drive(_sign(torque), _sign(moving[a] - moving[c]))


def _sign(value: float) -> int:
    return 1 if value > 0 else -1


def mesh_phases(
    train: TrainData, drive: Drive | None = None, *, carrier_angle: float = 0.0, central_turn: float = 0.0
) -> dict[str, MeshPhases]:
    """The phases of both meshes by their names, in the pose at `carrier_angle` and `central_turn` (degrees; see `train_pose`).

    Without a `drive` the train's input turns counter-clockwise and drives. Raises ParameterError.
    """
    sense, turning = drive_of(train) if drive is None else drive
    for name, value in (("sense", sense), ("turning", turning)):
        if value not in (1, -1):
            raise ParameterError(name, value, "must be 1 or -1")
    first, second = train.meshes
    same = 1 if train.basic_ratio > 0 else -1  # w_a - w_c = i_0 (w_b - w_c), T_b = -i_0 T_a
    planets = train_pose(train, carrier_angle, central_turn).planets
    return {
        first.name: _phases(first, planets, sense, turning),
        second.name: _phases(second, planets, -same * sense, same * turning),
    }


def phases_between(first: MeshPhases, second: MeshPhases) -> tuple[float, ...]:
    """How far the second mesh of each planet is ahead of the first (base pitches, 0 to 1).

    It stays as the train turns where both mesh with the same rim; of stepped planets it is that of the pose.
    """
    return tuple(_fraction(b - a) for a, b in zip(first.ahead, second.ahead, strict=True))


def _phases(mesh: SetMesh, planets: tuple[PlanetPose, ...], sense: int, turning: int) -> MeshPhases:
    """Those of a mesh whose central is turned with `sense` and turns with `turning` against the carrier."""
    outer = 1 if mesh.external else -1
    ahead = [_ahead(mesh, planet, side=sense * outer, turning=-turning * outer) for planet in planets]
    return MeshPhases(
        ahead=tuple(map(_fraction, ahead)),
        relative=tuple(_fraction(each - ahead[0]) for each in ahead),
        driver=mesh.central_role if sense == turning else mesh.rim_role,
        left_flanks=sense * outer > 0,
    )


def _ahead(mesh: SetMesh, planet: PlanetPose, *, side: int, turning: int) -> float:
    """lambda = z_p (theta +- psi_w - psi - pi e)/2 pi, of a planet that turns counter-clockwise (1) or clockwise (-1).

    theta +- psi_w is where the flank of tooth 0 on its left (1) or right `side` cuts the working circle.
    """
    rim = mesh.rim.gear
    middle = twist(rim, _middle_of_hand(mesh))
    half = math.radians(rim.base_half_angle) - involute(mesh.pair.working_transverse_pressure_angle)
    flank = math.radians(planet.rotations[mesh.rim.name]) + middle + side * half
    towards = math.radians(planet.angle) + math.pi * mesh.external
    return turning * rim.teeth * (flank - towards) / (2 * math.pi)


def _middle_of_hand(mesh: SetMesh) -> float:
    """Height (mm) above the bottom of the rim's teeth of the middle of the common width, of double helical teeth of the lower
    half's.
    """
    middle = mesh.rim.gear.face_width / 2
    if not mesh.pair.double_helical:
        return middle
    gap = max(gear.double_helix.gap_width or 0.0 for gear in mesh.pair.gears)
    return middle - gap / 2 - mesh.pair.common_width.width / 4


def _fraction(pitches: float) -> float:
    """From 0 to 1; what only rounding keeps from a whole pitch is 0."""
    within = pitches % 1.0
    return 0.0 if within > 1 - _ROUNDING else within
