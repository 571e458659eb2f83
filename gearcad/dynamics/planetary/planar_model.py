"""Planar model of a planetary train: masses, springs, and what displaces them - errors, run-out, forces of stages.

SI units (N, m, rad). The coordinates are fixed to the carrier: x, y and u = r theta of carrier and centrals, r the base radius
or the radius of the pins; of each planet zeta outwards, eta along the carrier's rotation, and u = r theta. Elongations are
positive where flanks press. For helical teeth it is the transverse section: planets do not tilt.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GearcadError, ParameterError
from gearcad.core.records import Floats, Indices, JsonObject, PerGear, Role
from gearcad.geometry import Gear
from gearcad.planetary import Carrier, Central, PairStage, PlanetaryTrain, SetMesh
from gearcad.planetary.members import TrainMaterial, material_of
from gearcad.planetary.power import PowerFlow
from gearcad.planetary.train_data import shafts_of

_MICRO = 1e6
"""Factor from N/µm to N/m."""


@dataclass(frozen=True, kw_only=True)
class PlanarMember:
    """A central or the carrier: `radius` (m) by which its turn counts, base radius or that of the pins.

    `support` (N/m) on x and y and `torsion` (N/m) on u, which is the turn times the radius: None holds the member, 0 leaves it
    free.
    """

    name: str
    radius: float
    support: float | None
    torsion: float | None


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshLine:
    """Line of action of a central with the planets: `pressure_angle` (rad), `stiffness` (N,) of each mesh in N/m.

    `rim_ratio` is the base radius of its rim over that of the first mesh's. `sense` is 1 where the torque on the central turns
    it counter-clockwise against the planets, -1 where the other flanks carry.
    """

    name: str
    external: bool
    pressure_angle: float
    stiffness: Floats
    rim_ratio: float = 1.0
    sense: int = 1


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanarTrain:
    """Planets at `angles` (N,) in rad on a carrier between two centrals; `members` are carrier, then centrals.

    `pin` is the stiffness (N/m) of a pin in either direction, None where it is rigid; `planet_radius` (m) the base radius by
    which a planet's turn counts.
    """

    angles: Floats
    members: tuple[PlanarMember, PlanarMember, PlanarMember]
    meshes: tuple[MeshLine, MeshLine]
    pin: float | None
    planet_radius: float

    @property
    def planets(self) -> int:
        """Number of planets."""
        return len(self.angles)


def planar_train(
    train: PlanetaryTrain,
    mesh_stiffness: tuple[ArrayLike, ArrayLike],
    *,
    held: Collection[str] | None = None,
    sense: int = 1,
) -> PlanarTrain:
    """Return the planar train with `mesh_stiffness` (N/µm) of each mesh: one for all planets, or (N,) of each.

    `held` members cannot turn where they have no torsional stiffness: by default those that `fixed` holds. The torque on the
    first central is counter-clockwise with `sense` 1, clockwise with -1. Lengths are those of the transverse section. Raises
    ParameterError.
    """
    held = held_members(train) if held is None else held
    if unknown := set(held) - set(train.members):
        raise ParameterError("held", min(unknown), f"must be one of {', '.join(train.members)}")
    if sense not in (1, -1):
        raise ParameterError("sense", sense, "must be 1 or -1")
    a, b = train.meshes
    distance = float(train.centre_distance) / 1000
    senses = sense, sense if train.basic_ratio < 0 else -sense
    return PlanarTrain(
        angles=np.array([math.radians(angle) for angle in train.angles]),
        members=(
            _member(train.carrier, distance, held),
            _member(a.central, a.central_base_radius / 1000, held),
            _member(b.central, b.central_base_radius / 1000, held),
        ),
        meshes=(
            _line(a, train, mesh_stiffness[0], a.rim_base_radius, senses[0]),
            _line(b, train, mesh_stiffness[1], a.rim_base_radius, senses[1]),
        ),
        pin=None if train.carrier.pin_stiffness is None else _MICRO * train.carrier.pin_stiffness,
        planet_radius=a.rim_base_radius / 1000,
    )


def held_members(train: PlanetaryTrain) -> tuple[str, ...]:
    """Return the names of members that the fixed shaft holds.

    They are the member itself, or that to which it is geared by stages.
    """
    return () if train.fixed is None else (shafts_of(train)[train.fixed].member,)


def _member(member: Carrier | Central, radius: float, held: Collection[str]) -> PlanarMember:
    support, torsion = member.support_stiffness, member.torsional_stiffness
    rigid = None if member.name in held else 0.0
    return PlanarMember(
        name=member.name,
        radius=radius,
        support=None if support is None else _MICRO * support,
        torsion=rigid if torsion is None else torsion / radius**2,
    )


def _line(mesh: SetMesh, train: PlanetaryTrain, stiffness: ArrayLike, reference: float, sense: int) -> MeshLine:
    values = np.array(stiffness, float)
    if values.shape not in ((), (train.planets,)):
        raise ParameterError(
            "mesh_stiffness", values.shape, f"must be a number, or one for each of {train.planets} planets", "N/µm"
        )
    if not np.isfinite(values).all() or values.min() <= 0:
        raise ParameterError("mesh_stiffness", float(values.min()), f"of {mesh.name} must be above 0 N/µm", "N/µm")
    return MeshLine(
        name=mesh.name,
        external=mesh.external,
        pressure_angle=mesh.working_pressure_angle,
        stiffness=np.broadcast_to(_MICRO * values, train.planets),
        rim_ratio=mesh.rim_base_radius / reference,
        sense=sense,
    )


@dataclass(frozen=True, kw_only=True)
class MemberMass:
    """Mass of a member: `mass` in kg and `inertia` in kg·m² about its own axis; None where it is unknown, and `why`.

    `given` names those of the two that are not of the solid.
    """

    mass: float | None
    inertia: float | None
    given: tuple[str, ...] = ()
    why: str = ""

    def to_dict(self) -> JsonObject:
        """Return the mass as documents have it."""
        found = {"mass": self.mass, "inertia": self.inertia, "given": list(self.given)}
        return {**found, "why": self.why} if self.why else found


@dataclass(frozen=True, kw_only=True)
class TrainMasses:
    """Masses of both centrals and the carrier by their names (`members`), and of one planet with all its rims.

    The carrier is without its planets.
    """

    members: Mapping[str, MemberMass]
    planet: MemberMass

    @property
    def missing(self) -> tuple[str, ...]:
        """Reasons why masses or inertias are unknown, one line each; () where all are known."""
        return tuple(each.why for each in (*self.members.values(), self.planet) if each.why)

    def to_dict(self) -> JsonObject:
        """Return the masses as documents have them."""
        return {**{name: each.to_dict() for name, each in self.members.items()}, "planet": self.planet.to_dict()}


def train_masses(train: PlanetaryTrain, material: TrainMaterial | None = None) -> TrainMasses:
    """Return the masses of a train whose gears are of one `material`, or of one each, by the name of the central or rim.

    A given mass or inertia wins; only others are computed from the solid. Those of stages are added to their members.
    """
    carrier, densities = train.carrier, _densities(train, material)
    members = {central.name: _central(central, densities[central.name]) for central in train.centrals}
    members[carrier.name] = _carrier(train)
    for name, more in _of_stages(train).items():
        if (own := members[name]).inertia is not None:
            members[name] = replace(own, inertia=own.inertia + more)
    rims = {rim.name: (rim.gear, densities[rim.name]) for rim in train.rims}
    planet = _either(rims, carrier.planet_mass, carrier.planet_inertia)
    return TrainMasses(members=members, planet=planet)


def _of_stages(train: PlanetaryTrain) -> dict[str, float]:
    """Return what the inertias of stages add to those of the members that turn with them: sum J (w/w_member)^2 (kg·m²)."""
    shafts, found = shafts_of(train), dict[str, float]()
    for stage in train.stages:
        for end in ("pinion", "wheel"):
            if (inertia := getattr(stage, f"{end}_inertia")) is not None:
                shaft = shafts[getattr(stage, end)]
                found[shaft.member] = found.get(shaft.member, 0.0) + inertia * float(shaft.speed_ratio) ** 2
    return found


def _densities(train: PlanetaryTrain, material: TrainMaterial | None) -> dict[str, float]:
    """Return the density of each central and rim by its name, in kg/m³."""
    return {each.name: material_of(material, each.name).density for each in (*train.centrals, *train.rims)}


def _central(central: Central, density: float) -> MemberMass:
    return _either({central.name: (central.gear, density)}, central.mass, central.inertia)


def _carrier(train: PlanetaryTrain) -> MemberMass:
    """Return the given mass of the carrier, which has no solid to derive it from."""
    carrier = train.carrier
    values = {"mass": carrier.mass, "inertia": carrier.inertia}
    given = tuple(name for name, value in values.items() if value is not None)
    absent = [name for name, value in values.items() if value is None]
    why = f"{carrier.name}.{' and '.join(absent)}: must be given: a carrier has no solid here" if absent else ""
    return MemberMass(**values, given=given, why=why)


def _either(gears: Mapping[str, tuple[Gear, float]], mass: float | None, inertia: float | None) -> MemberMass:
    """Return the given mass and inertia, or else those of gears of known densities together on one axis."""
    given = tuple(name for name, value in (("mass", mass), ("inertia", inertia)) if value is not None)
    if len(given) == 2:
        return MemberMass(mass=mass, inertia=inertia, given=given)
    try:
        weighed = [_weighed(name, gear, density) for name, (gear, density) in gears.items()]
    except _NoSolid as error:
        return MemberMass(mass=mass, inertia=inertia, given=given, why=str(error))
    own_mass, own_inertia = (sum(column) for column in zip(*weighed, strict=True))
    return MemberMass(mass=own_mass if mass is None else mass, inertia=own_inertia if inertia is None else inertia, given=given)


class _NoSolid(Exception):
    """Raised with the reason why a gear has no solid."""


def _weighed(name: str, gear: Gear, density: float) -> tuple[float, float]:
    """Return mass (kg) and inertia (kg·m²) of a gear. Raises _NoSolid."""
    from gearcad.solids.exact.inertia import mass_properties

    try:
        found = mass_properties(gear, density)
    except GearcadError as error:
        raise _NoSolid(f"{name}.{error}") from error
    return found.mass, found.inertia


class SpringKind(Enum):
    """Kinds of springs."""

    MESH = "mesh"
    PIN_RADIAL = "radial"
    PIN_TANGENTIAL = "tangential"
    SUPPORT_X = "x"
    SUPPORT_Y = "y"
    TORSION = "turning"


@dataclass(frozen=True)
class Spring:
    """A spring of `owner`: a mesh such as "sun-planet", or a member; pins are of the carrier. `planet` counts from 0."""

    kind: SpringKind
    owner: str
    planet: int | None = None

    @property
    def name(self) -> str:
        """Name such as "sun-planet 1", "pin 1 radial", "carrier x"; planets are counted from 1."""
        if self.planet is None:
            return f"{self.owner} {self.kind.value}"
        number = self.planet + 1
        return f"{self.owner} {number}" if self.kind is SpringKind.MESH else f"pin {number} {self.kind.value}"


@dataclass(frozen=True, kw_only=True, eq=False)
class TrainSprings:
    """m springs between n coordinates: elongations `vectors` @ q (m), forces `stiffness` times these (N).

    `vectors` (m, n), `stiffness` (m,) in N/m. `coordinates` (n,) are those that can move, such as "sun.x" and "planet 1.zeta".
    `basis` (3 (N + 3), n) makes all from them, in the order carrier, centrals, planets: coordinates that are held do not move,
    and on rigid pins planets go with the carrier.
    """

    planar: PlanarTrain
    springs: tuple[Spring, ...]
    vectors: Floats
    stiffness: Floats
    coordinates: tuple[str, ...]
    basis: Floats

    def __post_init__(self) -> None:
        for array in (self.vectors, self.stiffness, self.basis):
            array.flags.writeable = False

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the springs."""
        return tuple(spring.name for spring in self.springs)

    @property
    def members(self) -> tuple[str, ...]:
        """Names of carrier, then centrals."""
        return tuple(member.name for member in self.planar.members)

    def matrix(self, stiffness: Floats | None = None) -> Floats:
        """Return K = sum k v v^T (n, n) in N/m, with these stiffnesses or others (m,) in N/m."""
        k = self.stiffness if stiffness is None else stiffness
        result: Floats = (self.vectors.T * k) @ self.vectors
        return result

    def select(self, kind: SpringKind, owner: str | None = None) -> Indices:
        """Return the places of the springs of a kind, of one owner or of all.

        Those of planets are in their order.
        """
        found = [i for i, each in enumerate(self.springs) if each.kind is kind and owner in (None, each.owner)]
        return np.array(found, np.intp)

    def turning(self, member: str) -> Floats:
        """Return the turn (n,) of a member (rad) per coordinate.

        It is also the load on each coordinate of a torque of 1 N·m on the member.
        """
        place = self.members.index(member)
        return np.asarray(self.basis[3 * place + 2] / self.planar.members[place].radius, float)


def train_springs(
    train: PlanetaryTrain,
    mesh_stiffness: tuple[ArrayLike, ArrayLike],
    *,
    held: Collection[str] | None = None,
    sense: int = 1,
) -> TrainSprings:
    """Return the springs of a train; see `planar_train` for the arguments."""
    return springs_of(planar_train(train, mesh_stiffness, held=held, sense=sense))


def springs_of(planar: PlanarTrain) -> TrainSprings:
    """Return Lin and Parker's springs, of any set: K = sum k v v^T."""
    names = all_coordinates(planar)
    basis, free = _basis(planar)
    springs, vectors, stiffness = [], [], []
    for spring, k, vector in _all_springs(planar):
        if k:
            springs.append(spring)
            vectors.append(vector)
            stiffness.append(k)
    return TrainSprings(
        planar=planar,
        springs=tuple(springs),
        vectors=np.array(vectors) @ basis,
        stiffness=np.array(stiffness),
        coordinates=tuple(names[place] for place in free),
        basis=basis,
    )


def all_coordinates(planar: PlanarTrain) -> list[str]:
    """Return the names of the 3 (N + 3) coordinates of carrier, centrals and planets."""
    members = [f"{member.name}.{each}" for member in planar.members for each in ("x", "y", "u")]
    return members + [f"planet {n + 1}.{each}" for n in range(planar.planets) for each in ("zeta", "eta", "u")]


def _basis(planar: PlanarTrain) -> tuple[Floats, list[int]]:
    """Return the matrix that makes all coordinates from those that can move, and the places of these."""
    size = 9 + 3 * planar.planets
    held = set()
    for place, member in enumerate(planar.members):
        held |= {3 * place, 3 * place + 1} if member.support is None else set()
        held |= {3 * place + 2} if member.torsion is None else set()
    moving = np.diag([float(place not in held) for place in range(size)])
    if planar.pin is None:
        for n, psi in enumerate(planar.angles):
            radial, tangential = _pin_place(psi)
            moving[9 + 3 * n : 11 + 3 * n] = 0.0
            moving[9 + 3 * n] = radial @ moving[:3]
            moving[10 + 3 * n] = tangential @ moving[:3]
            held |= {9 + 3 * n, 10 + 3 * n}
    free = [place for place in range(size) if place not in held]
    return moving[:, free], free


def _pin_place(psi: float) -> tuple[Floats, Floats]:
    """Return the motion of a pin outwards (3,) and along the rotation (3,), per x, y, u of the carrier."""
    sin, cos = np.sin(psi), np.cos(psi)
    return np.array([cos, sin, 0.0]), np.array([-sin, cos, 1.0])


def _all_springs(planar: PlanarTrain) -> list[tuple[Spring, float, Floats]]:
    """Return each spring with its stiffness, 0 where there is none, and its vector over all coordinates."""
    size, carrier = 9 + 3 * planar.planets, planar.members[0].name
    result = [
        (Spring(SpringKind.MESH, line.name, n), float(line.stiffness[n]), mesh_vector(line, place, n, psi, size))
        for place, line in enumerate(planar.meshes, 1)
        for n, psi in enumerate(planar.angles)
    ]
    for n, psi in enumerate(planar.angles):
        kinds = SpringKind.PIN_RADIAL, SpringKind.PIN_TANGENTIAL
        for axis, (kind, along) in enumerate(zip(kinds, _pin_place(psi), strict=True)):
            vector = np.zeros(size)
            vector[:3], vector[9 + 3 * n + axis] = along, -1.0
            result.append((Spring(kind, carrier, n), planar.pin or 0.0, vector))
    ways = SpringKind.SUPPORT_X, SpringKind.SUPPORT_Y, SpringKind.TORSION
    for place, member in enumerate(planar.members):
        for axis, (kind, k) in enumerate(zip(ways, (member.support, member.support, member.torsion), strict=True)):
            result.append((Spring(kind, member.name), k or 0.0, np.eye(size)[3 * place + axis]))
    return result


def mesh_vector(line: MeshLine, member: int, planet: int, psi: float, size: int) -> Floats:
    """Return the approach of flanks (size,) per coordinate, with e -1 for a ring.

    It is u + e u_p - x sin(psi - e a) + y cos(psi - e a) - e zeta sin a - eta cos a. The other flanks are at -a, and a torque
    that turns the central the other way presses them.
    """
    e, a = 1.0 if line.external else -1.0, line.sense * line.pressure_angle
    vector = np.zeros(size)
    vector[3 * member : 3 * member + 3] = -np.sin(psi - e * a), np.cos(psi - e * a), 1.0
    vector[9 + 3 * planet : 12 + 3 * planet] = -e * np.sin(a), -np.cos(a), e * line.rim_ratio
    return line.sense * vector


def stage_forces(train: PlanetaryTrain, flow: PowerFlow) -> dict[str, tuple[float, float]]:
    """Return the forces (N) along x and y, in space, on the members with whose gears stages mesh."""
    found: dict[str, tuple[float, float]] = {}
    for stage in train.stages:
        for role, member in ((Role.PINION, stage.pinion), (Role.WHEEL, stage.wheel)):
            if member in train.members:
                before = found.get(member, (0.0, 0.0))
                x, y = _on_axis(stage, role, flow.stage_torques[stage.name])
                found[member] = before[0] + x, before[1] + y
    return found


def mesh_force(stage: PairStage, torques: PerGear[float]) -> float:
    """Return F_bt = T/r_b in the transverse plane (N), of the `torques` (N·m) on its gears by their shafts."""
    return abs(torques.wheel) * 2e3 / abs(stage.pair.wheel.base_diameter)


def _on_axis(stage: PairStage, role: Role, torques: PerGear[float]) -> tuple[float, float]:
    """Return the force (N) along x and y on the gear on the train's axis.

    It is along the line of action, against its shaft's torque, off an outer mate.
    """
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


@dataclass(frozen=True, kw_only=True, eq=False)
class TurningPart:
    """A part that turns against the carrier: gaps (2, m) in µm and loads (2, n) in N, times cosine and sine of the angle.

    It turns with the member `follows`, or stands in space where that is None. `name` says what it is.
    """

    name: str
    follows: str | None
    gap: Floats
    load: Floats


def set_members(train: PlanetaryTrain) -> tuple[Carrier | Central, ...]:
    """Return carrier, then centrals, in the order of the springs."""
    return (train.carrier, *train.centrals)


def gaps(train: PlanetaryTrain, springs: TrainSprings, sense: int) -> Floats:
    """Return the gaps (m,) of the springs in µm.

    Pins that yield to the first central open their springs; teeth that stand proud close theirs. The errors of a rim that
    meshes with both centrals count in the first mesh: the planet turns until both share them.
    """
    gap, told = np.zeros(len(springs.springs)), set()
    if train.carrier.pin_errors:
        gap[springs.select(SpringKind.PIN_TANGENTIAL)] = -sense * np.array(train.carrier.pin_errors)
    for mesh in train.meshes:
        if mesh.rim.tooth_errors and mesh.rim.name not in told:
            gap[springs.select(SpringKind.MESH, mesh.name)] = -np.array(mesh.rim.tooth_errors)
        told.add(mesh.rim.name)
    return gap


def turning_and_standing(
    train: PlanetaryTrain, springs: TrainSprings, flow: PowerFlow
) -> tuple[tuple[TurningPart, ...], Floats]:
    """Return all that turns against the carrier, and forces (n,) in N across the axis that stand still against it."""
    across, turning = _stages_across(train, springs, flow), []
    none = np.zeros_like(across)
    standing = train.fixed is not None and shafts_of(train)[train.fixed].member == train.carrier.name
    if across.any() and not standing:
        turning.append(TurningPart(name="forces of stages", follows=None, gap=np.zeros((2, len(springs.springs))), load=across))
    for member in set_members(train):
        gap = _run_out(train, springs, member.name) * member.run_out
        if gap.any():
            turning.append(TurningPart(name=f"run-out of {member.name}", follows=member.name, gap=gap, load=none))
    return tuple(turning), across[0] if standing else none[0]


def _stages_across(train: PlanetaryTrain, springs: TrainSprings, flow: PowerFlow) -> Floats:
    """Return the forces (2, n) of stages across the axis in N.

    They count times cosine and sine of the angle by which space turns against the carrier.
    """
    found = np.zeros((2, springs.vectors.shape[1]))
    for member, (along_x, along_y) in stage_forces(train, flow).items():
        x, y = _across(springs, member)
        found += [along_x * x + along_y * y, along_x * y - along_y * x]
    return found


def _run_out(train: PlanetaryTrain, springs: TrainSprings, member: str) -> Floats:
    """Return gaps (2, m) for an eccentricity of 1 µm: of a central's teeth in its mesh, of the carrier in its bearing."""
    found = np.zeros((2, len(springs.springs)))
    for axis, along in enumerate(_across(springs, member)):
        for mesh in train.meshes:
            if mesh.central.name == member:
                places = springs.select(SpringKind.MESH, mesh.name)
                found[axis, places] = -springs.vectors[places] @ along
        if member == train.carrier.name:
            places = springs.select((SpringKind.SUPPORT_X, SpringKind.SUPPORT_Y)[axis], member)
            found[axis, places] = 1.0
    return found


def _across(springs: TrainSprings, member: str) -> Floats:
    """Return x and y of a member (2, n) per coordinate."""
    place = 3 * springs.members.index(member)
    return springs.basis[place : place + 2]
