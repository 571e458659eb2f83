"""Poses of all gears of a planetary train in mesh, the mesh phases of its planets, and harmonics that cancel."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from gearcad.core.errors import ParameterError
from gearcad.core.records import JsonObject, PerGear, Role
from gearcad.geometry import involute
from gearcad.geometry.gear_data import twist
from gearcad.planetary.members import SetMesh, TrainLoad
from gearcad.planetary.train_data import Fit, Link, TrainData, fit_planets, meshing_angle, shafts_of, speeds


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
    """Return how the planets stand at carrier angle 0, with tooth 0 of the second central on +x.

    Rotations (rad) are those at the bottom of each gear.
    """
    first, second = train.meshes
    angles = [math.radians(angle) for angle in train.angles]
    clocking = 0.0 if train.adjusted else math.radians(float(second.rim.clocking) - float(first.rim.clocking))
    fit = fit_planets(train.teeth, angles, central_b=_lead(second), clocking=clocking)
    if train.adjusted:
        fit = fit.adjusted(train.teeth)
    return fit._replace(central_a=fit.central_a - _lead(first))


def _lead(mesh: SetMesh) -> float:
    """Return the angle (rad) by which the central's section at the bottom of the rim is turned against its own bottom."""
    return twist(mesh.central.gear, (mesh.central.gear.face_width - mesh.rim.gear.face_width) / 2)


def train_pose(train: TrainData, carrier_angle: float = 0.0, central_turn: float = 0.0) -> TrainPose:
    """Return the train with its carrier turned to an angle, and its fixed central (without one, the second) turned by another.

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
    """Yield the planets, turned on from where they fit, by degrees."""
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
    """Place of a shaft (mm), and its rotation (degrees)."""

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
    """Return the axis of the outer gear of a stage, and that gear's rotation (degrees)."""
    stage, psi = link.stage, math.radians(link.stage.angle)
    inner, outer = stage.pair.gears.pick(link.outer.mate), stage.pair.gears.pick(link.outer)
    towards, outer_towards = psi + math.pi * outer.internal, psi + math.pi * (not inner.internal)
    start = meshing_angle(outer.teeth, outer_towards, inner.teeth, 0.0, towards)
    offset = stage.pair.axial_offset if link.outer is Role.WHEEL else -stage.pair.axial_offset
    start -= twist(outer, (outer.face_width - inner.face_width) / 2 - offset)  # from the plane of the inner gear's bottom
    turn = -axis.turn * inner.teeth / outer.teeth
    distance = abs(stage.pair.centre_distance)
    return _Axis(turn, axis.x + distance * math.cos(psi), axis.y + distance * math.sin(psi)), _degrees(start) + turn


_ROUNDING = 1e-10
"""Base pitches by which a phase may miss a whole pitch and still count as 0."""


@dataclass(frozen=True, kw_only=True)
class MeshPhases:
    """Phases of the contacts of a mesh, in base pitches from 0 to 1, by planets.

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
        """Position of each planet in the mesh cycle of the pair, 0 to 1: roll angle of the pinion over that of a base pitch."""
        return self.ahead if self.driver is Role.PINION else tuple(_fraction(-each) for each in self.ahead)

    def to_dict(self) -> JsonObject:
        """Return the phases as a document for JSON."""
        return {
            "ahead": list(self.ahead),
            "relative": list(self.relative),
            "driver": self.driver.value,
            "left_flanks": self.left_flanks,
        }


class Drive(NamedTuple):
    """Drive of a set: the torque on the first central from outside, and its motion against the carrier.

    1 is counter-clockwise, -1 clockwise; where the two are equal the first central drives the planets.
    """

    sense: int = 1
    turning: int = 1


def drive_of(train: TrainData, load: TrainLoad | None = None) -> Drive:
    """Return how a train with a fixed member is driven at a load.

    Only the signs of the load count. Without a load, or at rest, its input turns counter-clockwise and drives.

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
    """Return the phases of both meshes by their names, in the pose at `carrier_angle` and `central_turn` (degrees; see
    `train_pose`).

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
    """Return how far the second mesh of each planet is ahead of the first (base pitches, 0 to 1).

    It stays as the train turns where both mesh with the same rim; of stepped planets it is that of the pose.
    """
    return tuple(_fraction(b - a) for a, b in zip(first.ahead, second.ahead, strict=True))


def _phases(mesh: SetMesh, planets: tuple[PlanetPose, ...], sense: int, turning: int) -> MeshPhases:
    """Return the phases of a mesh whose central is turned with `sense` and turns with `turning` against the carrier."""
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
    """Return the height (mm) above the bottom of the rim's teeth of the middle of the common width, of double helical teeth of
    the lower half's.
    """
    middle = mesh.rim.gear.face_width / 2
    if not mesh.pair.double_helical:
        return middle
    gap = max(gear.double_helix.gap_width or 0.0 for gear in mesh.pair.gears)
    return middle - gap / 2 - mesh.pair.common_width.width / 4


def _fraction(pitches: float) -> float:
    """Return the fraction of a number of base pitches (0 to 1); a rounding error below a whole pitch gives 0."""
    within = pitches % 1.0
    return 0.0 if within > 1 - _ROUNDING else within


HARMONICS = 6

_HARMONICS_ROUNDING = 1e-9
"""Share of the sum of all planets in phase below which a harmonic is rounding."""


class Excited(NamedTuple):
    """Modes of a set that a harmonic excites: rotational ones, by a torque, and translational ones, by a force.

    Neither: the forces of the planets balance, and only modes in which the members rest are shaken.
    """

    rotational: bool
    translational: bool


class HarmonicSum(NamedTuple):
    """Torque and force of a harmonic on a member over those that all planets, in phase and in one direction, would give.

    Torque |sum exp(2 pi i m gamma_n)|/N, force the greater of |sum exp(i (2 pi m gamma_n +- psi_n))|/N.
    """

    harmonic: int
    torque: float
    force: float

    @property
    def excited(self) -> Excited:
        """Modes that the harmonic excites."""
        return Excited(self.torque > 0, self.force > 0)


def excited_modes(teeth: int, planets: int, harmonic: int) -> Excited:
    """Return the modes that a harmonic excites, for planets at equal angles.

    With the teeth z of the central, k = m z mod N is 0 for a torque, and 1 or N - 1 for a force. A planet alone has both. Whole
    numbers leave no rounding.
    """
    remainder = harmonic * teeth % planets
    return Excited(remainder == 0, remainder in (1 % planets, planets - 1))


def harmonic_sums(relative: Sequence[float], angles: Sequence[float], harmonics: int = HARMONICS) -> tuple[HarmonicSum, ...]:
    """Return the sums of the harmonics 1, 2, ... for planets at `angles` (degrees) with `relative` phases (base pitches)."""
    psi = [math.radians(angle) for angle in angles]
    found = []
    for harmonic in range(1, harmonics + 1):
        turns = [2 * math.pi * harmonic * phase for phase in relative]
        torque = _share(turns)
        forces = (_share([turn + sign * angle for turn, angle in zip(turns, psi, strict=True)]) for sign in (1, -1))
        found.append(HarmonicSum(harmonic, torque, max(forces)))
    return tuple(found)


def train_harmonics(
    train: TrainData, phases: dict[str, MeshPhases] | None = None, harmonics: int = HARMONICS
) -> dict[str, tuple[HarmonicSum, ...]]:
    """Return the harmonic sums of both meshes of a train by their names."""
    phases = mesh_phases(train) if phases is None else phases
    return {name: harmonic_sums(mesh.relative, train.angles, harmonics) for name, mesh in phases.items()}


def _share(turns: Sequence[float]) -> float:
    """|sum exp(i turn)|/N, 0 where it is rounding."""
    share = abs(sum(cmath.exp(1j * turn) for turn in turns)) / len(turns)
    return share if share > _HARMONICS_ROUNDING else 0.0
