"""Where every gear of a train stands in mesh: rotation of its tooth 0, place of its axis, height of its teeth."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from gearcad.geometry.helix import twist
from gearcad.per_gear import PerGear, Role
from gearcad.planetary.fitting import Fit, fit_planets, meshing_angle
from gearcad.planetary.mesh import SetMesh
from gearcad.planetary.shafts import Link, shafts_of
from gearcad.planetary.train_data import TrainData

__all__ = ["GearPlace", "PlanetPose", "StagePose", "TrainPose", "assembled", "heights", "train_pose"]


@dataclass(frozen=True)
class PlanetPose:
    """A planet whose axis stands at `angle` (degrees, from +x) in (x, y) (mm); `rotations` (degrees) of its rims by name."""

    angle: float
    x: float
    y: float
    rotations: Mapping[str, float]


class GearPlace(NamedTuple):
    """Rotation (degrees), axis (x, y) and height of the bottom of the teeth (mm)."""

    rotation: float
    x: float
    y: float
    height: float


@dataclass(frozen=True)
class StagePose:
    """The two gears of a stage."""

    name: str
    gears: PerGear[GearPlace]


@dataclass(frozen=True)
class TrainPose:
    """All gears of a train in mesh, backlash split; planet 0 stands at `carrier_angle` (and its own angle on the carrier).

    A rotation is that of tooth 0 from +x, counter-clockwise seen from +z, in degrees, at the bottom of that gear's own teeth:
    a part is its gear turned by it, and moved to (x, y) and to its height. `rotations` of the centrals by name, `heights` (mm)
    of centrals and rims. Heights are 0 at the bottom of the first rim. As the carrier turns on, rotations run on past 360.
    """

    carrier_angle: float
    rotations: Mapping[str, float]
    planets: tuple[PlanetPose, ...]
    heights: Mapping[str, float]
    stages: tuple[StagePose, ...]


def heights(train: TrainData) -> dict[str, float]:
    """Bottom of the teeth (mm) of rims and centrals, which stand middle by middle."""
    found = {rim.name: rim.axial_position for rim in train.rims}
    for mesh in train.meshes:
        found[mesh.central.name] = mesh.rim.axial_position + (mesh.rim.gear.face_width - mesh.central.gear.face_width) / 2
    return found


def assembled(train: TrainData) -> Fit:
    """How the planets stand at carrier angle 0, with tooth 0 of the second central on +x: rotations (rad) at each bottom."""
    first, second = train.meshes
    angles = [math.radians(angle) for angle in train.angles]
    clocking = 0.0 if train.adjusted else math.radians(float(second.rim.clocking) - float(first.rim.clocking))
    fit = fit_planets(train.teeth, angles, central_b=_lead(second), clocking=clocking)
    if train.adjusted:
        fit = fit.adjusted(train.teeth)
    return fit._replace(central_a=fit.central_a - _lead(first))


def _lead(mesh: SetMesh) -> float:
    """Angle (rad) by which the central's section at the bottom of the rim is turned against its own bottom."""
    return twist(mesh.central.gear, (mesh.central.gear.face_width - mesh.rim.gear.face_width) / 2)


def train_pose(train: TrainData, carrier_angle: float = 0.0, central_turn: float = 0.0) -> TrainPose:
    """The train with its carrier turned to an angle, and its fixed central (without one, the second) turned by another.

    Degrees; by what the other central and the planets turn, follows (Willis). Of a stage the gear on the side of the set
    turns with its member, and its tooth 0 stands on +x at carrier angle 0.
    """
    first, second = train.meshes
    relative = carrier_angle - central_turn  # of the second central
    if train.fixed is not None and shafts_of(train)[train.fixed].member == first.central.name:
        relative /= train.basic_ratio
    turned = {
        first.central.name: carrier_angle - train.basic_ratio * relative,
        second.central.name: carrier_angle - relative,
    }
    planet_turn = carrier_angle + second.central.gear.teeth / second.rim.gear.teeth * relative
    fit = assembled(train)
    rotations = {first.central.name: _degrees(fit.central_a), second.central.name: 0.0}
    return TrainPose(
        carrier_angle=carrier_angle,
        rotations={name: rotations[name] + turned[name] for name in rotations},
        planets=tuple(_planets(train, fit, carrier_angle, planet_turn)),
        heights=heights(train),
        stages=_stages(train, {**turned, train.carrier.name: carrier_angle}),
    )


def _planets(train: TrainData, fit: Fit, carrier_angle: float, turn: float) -> Iterator[PlanetPose]:
    """The planets, turned on from where they fit, by degrees."""
    distance = float(train.centre_distance)
    names = [mesh.rim.name for mesh in train.meshes]
    for own, *rims in zip(train.angles, fit.rims_a, fit.rims_b, strict=True):
        angle, whole = own + carrier_angle, rims[0] // math.tau * math.tau
        psi, rotations = math.radians(angle), [math.degrees(rim - whole) + turn for rim in rims]
        place = distance * math.cos(psi), distance * math.sin(psi)
        yield PlanetPose(angle, *place, dict(zip(names, rotations, strict=True)))


def _degrees(rotation: float) -> float:
    return math.degrees(rotation) % 360


# ---------------------------------------------------------------------- stages


class _Axis(NamedTuple):
    """Where a shaft stands (mm), and how far it has turned (degrees)."""

    turn: float
    x: float
    y: float


def _stages(train: TrainData, turned: Mapping[str, float]) -> tuple[StagePose, ...]:
    """Stages in their order: the gear on the side of the set starts with tooth 0 on +x, the other one follows."""
    axes = {name: _Axis(turn, 0.0, 0.0) for name, turn in turned.items()}
    found = {}
    for shaft in shafts_of(train).values():
        if not shaft.path:
            continue
        link = shaft.path[-1]
        stage, own = link.stage, axes[link.shafts[0]]
        other, rotation = _mate(link, own)
        axes[shaft.name] = other
        z = PerGear(stage.axial_position, stage.axial_position + stage.pair.wheel_pose().z)
        places = {
            link.outer.mate: GearPlace(own.turn, own.x, own.y, z.pick(link.outer.mate)),
            link.outer: GearPlace(rotation, other.x, other.y, z.pick(link.outer)),
        }
        found[stage.name] = StagePose(stage.name, PerGear.each(places.__getitem__))
    return tuple(found[stage.name] for stage in train.stages)


def _mate(link: Link, axis: _Axis) -> tuple[_Axis, float]:
    """The axis of the outer gear of a stage, and that gear's rotation (degrees)."""
    stage, psi = link.stage, math.radians(link.stage.angle)
    inner, outer = stage.pair.gears.pick(link.outer.mate), stage.pair.gears.pick(link.outer)
    towards, outer_towards = psi + math.pi * outer.internal, psi + math.pi * (not inner.internal)
    start = meshing_angle(outer.teeth, outer_towards, inner.teeth, 0.0, towards)
    offset = stage.pair.axial_offset if link.outer is Role.WHEEL else -stage.pair.axial_offset
    start -= twist(outer, (outer.face_width - inner.face_width) / 2 - offset)  # from the plane of the inner gear's bottom
    turn = -axis.turn * inner.teeth / outer.teeth
    distance = abs(stage.pair.centre_distance)
    return _Axis(turn, axis.x + distance * math.cos(psi), axis.y + distance * math.sin(psi)), _degrees(start) + turn
