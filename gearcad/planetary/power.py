"""Torques, powers, efficiency and tooth forces of a planetary train under its load."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from enum import Enum
from typing import NamedTuple

from gearcad.core.errors import ParameterError, SolverError, require_number
from gearcad.core.records import JsonObject, PerGear, Role, is_assumed
from gearcad.geometry import GearPair
from gearcad.geometry.tooth_friction import ohlendorf_loss_factor
from gearcad.load import Load
from gearcad.planetary.members import PairStage, SetMesh, TrainLoad, base_radius
from gearcad.planetary.train_data import Link, Speeds, TrainData, TrainShaft, shafts_of, speeds, willis_row

ROUNDING = 1e-12
"""Share of a speed below which a difference of speeds is rounding."""


@dataclass(frozen=True, kw_only=True)
class Balance:
    """Torques from outside, in the unit of the one that was given, positive counter-clockwise seen from +z.

    `torques` are those on the shafts of the train, `members` on the members of the set (through stages, too), `stages` on
    the gears of each stage by their shafts.
    """

    torques: dict[str, float]
    members: dict[str, float]
    stages: dict[str, PerGear[float]]


def balance(
    train: TrainData, speeds: Mapping[str, float], ends: Mapping[str, TrainShaft], known: TrainShaft, torque: float, eta: float
) -> Balance:
    """Return all torques, from the `torque` on the shaft `known`; of `speeds` only the signs and the zeros matter.

    `ends` has the shaft of each member on which the world acts; `eta` is the efficiency of every mesh.
    Raises SolverError where nothing balances it: the train locks itself.
    """
    stages = dict.fromkeys((stage.name for stage in train.stages), PerGear(0.0, 0.0))
    inward = torque
    for link in reversed(known.path):
        inward = _passed(stages, link, inward, speeds, eta)
    members = _members(train, speeds, known.member, inward, eta**2)
    torques = dict.fromkeys(shafts_of(train), 0.0)
    for member, value in members.items():
        outward = value
        if member == known.member:
            outward = torque
        else:
            for link in ends[member].path:
                outward = _outer_torque(stages, link, outward, speeds, eta)
        torques[known.name if member == known.member else ends[member].name] = outward
    return Balance(torques=torques, members=members, stages=stages)


def _passed(stages: dict[str, PerGear[float]], link: Link, torque: float, speeds: Mapping[str, float], eta: float) -> float:
    """Return the torque on the inner shaft of a stage caused by a torque on its outer shaft; set both in `stages`."""
    inner, outer = link.teeth
    through = -torque * inner / outer * _power_ratio(torque * speeds[link.shafts[1]], eta)
    _note(stages, link, -through, torque)
    return through


def _outer_torque(
    stages: dict[str, PerGear[float]], link: Link, torque: float, speeds: Mapping[str, float], eta: float
) -> float:
    """Return the torque on the outer shaft of a stage that causes a given torque on its inner shaft."""
    inner, outer = link.teeth
    asked = -torque * outer / inner / _power_ratio(torque * speeds[link.shafts[0]], eta)
    _note(stages, link, -torque, asked)
    return asked


def _power_ratio(power: float, eta: float) -> float:
    """Return the ratio of the power behind a mesh to that before it, seen in the direction in which `power` is positive."""
    return eta ** ((power > 0) - (power < 0))


def _note(stages: dict[str, PerGear[float]], link: Link, inner: float, outer: float) -> None:
    stages[link.stage.name] = PerGear(outer, inner) if link.outer is Role.PINION else PerGear(inner, outer)


def _members(train: TrainData, speeds: Mapping[str, float], known: str, torque: float, eta: float) -> dict[str, float]:
    """Return the torques on the members of the set: T_b = -i_0 eta^s T_a, T_a + T_b + T_c = 0, s the sign of T_a (w_a - w_c).

    Where both signs agree with themselves - power that could as well be lost altogether - the one that loses less.
    """
    row = willis_row(train)
    of_a, of_b = (row[central.name] for central in train.centrals)
    found = []
    for sign in (1, -1) if rolling_speed(train, speeds) and eta != 1 else (0,):
        kept = eta**sign
        shares = dict(zip(row, (float(of_a), of_b * kept, -(of_a + of_b * kept)), strict=True))
        if not shares[known]:
            continue
        torques = {name: torque * share / shares[known] + 0.0 for name, share in shares.items()}
        if rolling_power(train, torques, speeds) * sign >= 0:
            found.append(torques)
    if not found:
        least = locking_efficiency(train)
        raise SolverError(
            f"{known}: no torque elsewhere turns it against its load at a mesh efficiency of {math.sqrt(eta):.6g}: the train "
            f"locks itself; it turns where meshes keep more than {least:.6g}"
        )
    return min(found, key=lambda torques: sum(torques[name] * speeds[name] for name in torques))


def rolling_speed(train: TrainData, speeds: Mapping[str, float]) -> float:
    """w_a - w_c, 0 where the set turns as one but for rounding."""
    first, carrier = speeds[train.centrals[0].name], speeds[train.carrier.name]
    difference = first - carrier
    return difference if abs(difference) > ROUNDING * max(abs(first), abs(carrier)) else 0.0


def rolling_power(train: TrainData, torques: Mapping[str, float], speeds: Mapping[str, float]) -> float:
    """Return T_a (w_a - w_c), in N·m·rpm: the power that rolls from the first central to the second, seen from the carrier."""
    return torques[train.centrals[0].name] * rolling_speed(train, speeds)


def locking_efficiency(train: TrainData) -> float:
    """Return the efficiency of a mesh up to which the set cannot be driven by a central to turn the carrier; 0:
    it always can.
    """
    of_a, of_b, _ = willis_row(train).values()
    ratio = -of_b / of_a
    return math.sqrt(min(ratio, 1 / ratio)) if ratio > 0 else 0.0


_WATT = math.pi / 30
"""Factor from N·m times rpm to W."""


@dataclass(frozen=True, kw_only=True)
class PowerFlow:
    """Loads on a train from outside, in N·m, rpm and W; torques and speeds are positive counter-clockwise seen from +z.

    `torques` and `powers` (positive where power goes in) by the names of members and shafts, 0 where nothing acts: those of
    the fixed member are what holds it. `set_torques` act on the members of the set, through stages too; `stage_torques` on
    the gears of each stage by their shafts. `losses` are of both meshes of the set and of each stage.
    `efficiency` is that from input to output, `efficiency_back` that from output to input, 0 or below where no torque
    turns the train in that direction. Of a differential `efficiency` is all power that goes out over all that goes in, and
    `efficiency_back` None. `rolling_power` is what rolls through the meshes of the set as seen from the carrier, and
    `rolling_ratio` the same over the power that goes into the set; None without load. `mesh_efficiencies` are those of the
    meshes of the set by the friction of the load, none where the efficiency is given.
    """

    load: TrainLoad
    speeds: Speeds
    torques: Mapping[str, float]
    powers: Mapping[str, float]
    set_torques: Mapping[str, float]
    stage_torques: Mapping[str, PerGear[float]]
    losses: Mapping[str, float]
    efficiency: float | None
    efficiency_back: float | None
    rolling_power: float
    rolling_ratio: float | None
    mesh_efficiencies: Mapping[str, float] = field(default_factory=dict)

    @property
    def self_locking(self) -> bool:
        """Whether the output cannot drive the input."""
        return self.efficiency_back is not None and self.efficiency_back <= 0

    @property
    def circulates(self) -> bool:
        """Whether more power flows through the meshes than goes into the set."""
        return self.rolling_ratio is not None and self.rolling_ratio > 1

    @property
    def circulation(self) -> str:
        """Sentence that states whether power circulates."""
        if self.rolling_ratio is None:
            return "no power flows"
        if self.circulates:
            return f"power circulates: {self.rolling_ratio:.4g} times what goes in rolls through the meshes"
        return f"no power circulates: {self.rolling_ratio:.4g} of what goes in rolls through the meshes"

    @property
    def source(self) -> str:
        """Source of the efficiency of a mesh: "given", "assumed", or "friction", which is Ohlendorf's loss factor."""
        return "friction" if self.mesh_efficiencies else "assumed" if is_assumed(self.load.mesh_efficiency) else "given"

    def to_dict(self) -> JsonObject:
        """Return the flow of power as a document for JSON."""
        return {
            "speeds": self.speeds.to_dict(),
            "torques": dict(self.torques),
            "powers": dict(self.powers),
            "set_torques": dict(self.set_torques),
            "stage_torques": {name: torques._asdict() for name, torques in self.stage_torques.items()},
            "losses": dict(self.losses),
            "efficiency": self.efficiency,
            "efficiency_back": self.efficiency_back,
            "mesh_efficiency": self.load.mesh_efficiency,
            "mesh_efficiency_source": self.source,
            **({"mesh_efficiencies": dict(self.mesh_efficiencies)} if self.mesh_efficiencies else {}),
            "self_locking": None if is_assumed(self.load.mesh_efficiency) else self.self_locking,
            "rolling_power": self.rolling_power,
            "rolling_ratio": self.rolling_ratio,
            "circulation": self.circulation,
        }


def power_flow(train: TrainData, load: TrainLoad, given_speeds: Mapping[str, float] | None = None) -> PowerFlow:
    """Return the flow of power through a train that runs at `load`, with the second speed (rpm) that a differential needs.

    The torque of `load` is positive where the input takes power and the output gives it away: from outside it then acts along
    the input's motion, or against the output's. At rest the motion is what a positive speed of the input would bring. A
    differential shares torque as a set with a fixed member does; its speeds decide which way power goes.
    Raises ParameterError where speeds are missing or too many, SolverError where the train locks itself against the load.
    """
    by_friction = efficiencies_by_friction(train, load)
    if by_friction:
        load = replace(load, mesh_efficiency=math.sqrt(math.prod(by_friction.values())))
    given = dict(given_speeds or {})
    actual = speeds(train, {train.input: load.speed, **given})
    signs = actual.members
    if not any(signs.values()):
        signs = speeds(train, {**given, train.input: 1.0}).members
    at, way = (train.input, 1.0) if load.on_input else (train.output, -1.0)
    torque = way * math.copysign(load.given_torque, load.given_torque * (signs[at] or 1.0))
    found = _balance(train, signs, at, torque, load.mesh_efficiency, given)
    rolling = rolling_power(train, found.members, signs)
    entering = sum(max(found.members[name] * signs[name], 0.0) for name in found.members)
    powers = {name: value * actual.members[name] * _WATT + 0.0 for name, value in found.torques.items()}
    return PowerFlow(
        load=load,
        speeds=actual,
        torques=found.torques,
        powers=powers,
        set_torques=found.members,
        stage_torques=found.stages,
        losses=_losses(train, found, actual.members, load.mesh_efficiency),
        efficiency=_efficiency_of_all(found, signs) if train.fixed is None else efficiency(train, load.mesh_efficiency),
        efficiency_back=None if train.fixed is None else efficiency(train, load.mesh_efficiency, back=True),
        rolling_power=abs(rolling_power(train, found.members, actual.members)) * _WATT,
        rolling_ratio=abs(rolling) / entering if entering else None,
        mesh_efficiencies=by_friction,
    )


def efficiencies_by_friction(train: TrainData, load: TrainLoad) -> dict[str, float]:
    """Return 1 - mu H_V of both meshes of the set, by Ohlendorf's loss factors; none where the efficiency is given, or a mesh
    has no such factor.

    Of both in a row the efficiency is the product, so the square root of it stands for each, and for stages.
    """
    if load.friction is None or not is_assumed(load.mesh_efficiency):
        return {}
    factors = {mesh.name: ohlendorf_loss_factor(mesh.pair) for mesh in train.meshes}
    found = {name: 1 - load.friction * factor for name, factor in factors.items() if factor is not None}
    return found if len(found) == len(factors) else {}


def lossless_flow(train: TrainData, load: TrainLoad, given_speeds: Mapping[str, float] | None = None) -> PowerFlow:
    """Return the flow of power without losses under the torque that `load` gives the output; raises as `power_flow`."""
    if load.on_input:
        torque = power_flow(train, load, given_speeds).torques[train.output]
        load = replace(load, input_torque=None, output_torque=math.copysign(torque, load.given_torque))
    return power_flow(train, replace(load, mesh_efficiency=1.0), given_speeds)


def efficiency(train: TrainData, mesh_efficiency: float, *, back: bool = False) -> float:
    """Return the power out over power in, from the input to the output or `back`, of a train with a fixed member.

    0 or below where the train locks itself: then the driven end would have to be driven, too.
    """
    driving, driven = (train.output, train.input) if back else (train.input, train.output)
    signs = speeds(train, {driving: 1.0}).members
    found = _balance(train, signs, driving, 1.0, mesh_efficiency, {})
    return -found.torques[driven] * signs[driven]


def _balance(
    train: TrainData, signs: Mapping[str, float], at: str, torque: float, eta: float, given: Mapping[str, float]
) -> Balance:
    shafts = shafts_of(train)
    return balance(train, signs, _ends(train, shafts, given), shafts[at], torque, eta)


def _ends(train: TrainData, shafts: Mapping[str, TrainShaft], given: Mapping[str, float]) -> dict[str, TrainShaft]:
    """Return the shaft through which each member is held or driven: one of a role, of a given speed, or the member itself."""
    spoken = [train.input, train.output, train.fixed, *given, *train.members]
    ends: dict[str, TrainShaft] = {}
    for name in spoken:
        if name is not None:
            ends.setdefault(shafts[name].member, shafts[name])
    return ends


def _losses(train: TrainData, found: Balance, members: Mapping[str, float], eta: float) -> dict[str, float]:
    """Return the power (W) that each mesh of the set and each stage turns into heat."""
    rolling = rolling_power(train, found.members, members)
    first, second = train.centrals
    entering = rolling if rolling > 0 else -rolling * eta**-2
    lost = {
        first.mesh_name: entering * (1 - eta) * (1 if rolling > 0 else eta),
        second.mesh_name: entering * (1 - eta) * (eta if rolling > 0 else 1),
    }
    for stage in train.stages:
        torques = found.stages[stage.name]
        lost[stage.name] = torques.pinion * members[stage.pinion] + torques.wheel * members[stage.wheel]
    return {name: value * _WATT + 0.0 for name, value in lost.items()}


def _efficiency_of_all(found: Balance, signs: Mapping[str, float]) -> float | None:
    """Return the power that goes out over power that goes in, of all shafts; None without load."""
    powers = [torque * signs[name] for name, torque in found.torques.items()]
    entering = sum(power for power in powers if power > 0)
    return -sum(power for power in powers if power < 0) / entering if entering else None


@dataclass(frozen=True, kw_only=True)
class MeshForce:
    """Force in a mesh (N): of a central on one planet, or of the pinion of a stage on its wheel.

    `normal` is its size in the transverse plane, along the line of action: F_bt = T/r_b. The others are its parts at the
    working pitch circles: `tangential` is positive where it turns counter-clockwise about the central (of a stage: about
    the pinion), `radial` where it pushes the axes apart, as all but rings do, `axial` along +z.
    """

    normal: float
    tangential: float
    radial: float
    axial: float


@dataclass(frozen=True, kw_only=True)
class PinForce:
    """Force of one planet's teeth on its pin (N), in the plane of rotation away from the train's axis and counter-clockwise.

    `axial` is what is left along +z. `tilting_radial` and `tilting_tangential` (N·m) are the moment about the middle of the
    planet's teeth, about the directions of the two forces, of meshes in different planes and of axial forces.
    `centrifugal` (N, away from the axis, not in `radial`) is the planet's own; None where its mass is not known.
    """

    radial: float
    tangential: float
    axial: float
    tilting_radial: float
    tilting_tangential: float
    centrifugal: float | None

    @property
    def size(self) -> float:
        """Size (N) of the force in the plane of rotation, the centrifugal force included."""
        return math.hypot(self.radial + (self.centrifugal or 0.0), self.tangential)

    @property
    def tilting_moment(self) -> float:
        """Size of the moment that tilts the planet (N·m)."""
        return math.hypot(self.tilting_radial, self.tilting_tangential)


@dataclass(frozen=True, kw_only=True)
class TrainForces:
    """Forces of a planetary train, at the torques that its members bring in where power is lost.

    `meshes` by the name of the mesh, on one planet; `pin` of one planet; `stages` by name, on their wheels.
    """

    meshes: Mapping[str, MeshForce]
    pin: PinForce
    stages: Mapping[str, MeshForce]

    def to_dict(self) -> JsonObject:
        """Return the forces as a document for JSON."""
        return {
            "meshes": {name: asdict(force) for name, force in self.meshes.items()},
            "pin": asdict(self.pin) | {"size": self.pin.size, "tilting_moment": self.pin.tilting_moment},
            "stages": {name: asdict(force) for name, force in self.stages.items()},
        }


def forces(train: TrainData, flow: PowerFlow) -> TrainForces:
    """Return the forces of a flow of power; each mesh of the set has its N-th part of the torque on its central."""
    return TrainForces(
        meshes={mesh.name: _on_planet(train, mesh, flow) for mesh in train.meshes},
        pin=_on_pin(train, flow),
        stages={stage.name: _on_wheel(stage, flow) for stage in train.stages},
    )


def _on_planet(train: TrainData, mesh: SetMesh, flow: PowerFlow) -> MeshForce:
    torque = flow.set_torques[mesh.central.name] / train.planets
    # Counter-clockwise about the train is clockwise about the planet where it meshes with a sun.
    turning = -torque if mesh.external else torque
    return _force(mesh.pair, torque, mesh.central_base_radius, mesh.rim.gear.helix_angle * math.copysign(1, turning))


def _on_wheel(stage: PairStage, flow: PowerFlow) -> MeshForce:
    wheel, torque = stage.pair.wheel, flow.stage_torques[stage.name].wheel
    # The shaft's torque is held by the teeth, so these turn the wheel the other way.
    about_pinion = torque if not wheel.internal else -torque
    return _force(stage.pair, about_pinion, base_radius(wheel), wheel.helix_angle * math.copysign(1, -torque))


def _force(pair: GearPair, torque: float, radius: float, helix_angle: float) -> MeshForce:
    """Return the force of a mesh from a torque (N·m) at a base radius (mm).

    `helix_angle` is that of the gear pushed, negative where it is pushed clockwise.
    """
    normal = abs(torque) * 1e3 / radius
    angle = math.radians(pair.working_transverse_pressure_angle)
    hand = 0.0 if pair.double_helical else math.copysign(math.radians(pair.pinion.base_helix_angle), helix_angle)
    return MeshForce(
        normal=normal,
        tangential=math.copysign(normal * math.cos(angle), torque) + 0.0,
        radial=normal * math.sin(angle) * (-1 if pair.internal else 1) + 0.0,
        axial=-normal * math.tan(hand) + 0.0,
    )


def _on_pin(train: TrainData, flow: PowerFlow) -> PinForce:
    """Return the force on the pin, summed over the meshes: a sun's at the near side of the planet, a ring's at the far side."""
    bottom = min(rim.axial_position for rim in train.rims)
    top = max(rim.axial_position + rim.gear.face_width for rim in train.rims)
    radial = tangential = axial = about_radial = about_tangential = 0.0
    for mesh in train.meshes:
        force = _on_planet(train, mesh, flow)
        height = mesh.rim.axial_position + mesh.rim.gear.face_width / 2 - (bottom + top) / 2
        arm = mesh.rim_base_radius / math.cos(mesh.working_pressure_angle) * (-1 if mesh.external else 1)
        radial, tangential, axial = radial + force.radial, tangential + force.tangential, axial + force.axial
        about_radial -= height * force.tangential / 1e3
        about_tangential += (height * force.radial - arm * force.axial) / 1e3
    return PinForce(
        radial=radial,
        tangential=tangential,
        axial=axial,
        tilting_radial=about_radial,
        tilting_tangential=about_tangential,
        centrifugal=_centrifugal(train, flow),
    )


def _centrifugal(train: TrainData, flow: PowerFlow) -> float | None:
    """m a w_c^2 of one planet (N)."""
    mass = train.carrier.planet_mass
    if mass is None:
        return None
    turning = flow.speeds.members[train.carrier.name] * math.pi / 30
    return mass * train.centre_distance / 1e3 * turning**2


_ROUNDING = 1e-9
"""Largest rounding error of a computed K_gamma."""

_SLOWEST = 1e-6
"""Least speed of a load (rpm), below which differences of speeds are rounding."""


class FactorSource(Enum):
    """Source of K_gamma."""

    GIVEN = "given"
    COMPUTED = "computed"
    """Computed from the errors, stiffnesses and supports of the train."""

    EQUAL = "equal shares"
    """None was given and none computed: 1."""


class MeshLoadFactor(NamedTuple):
    """Mesh load factor K_gamma of ISO 6336-1, and its source."""

    value: float
    source: FactorSource


def mesh_load_factor(train: TrainData, load: TrainLoad, computed: float | None = None) -> MeshLoadFactor:
    """K_gamma of a train: the one that its load gives, else the one that was `computed`, else 1.

    Raises ParameterError for a given one above the number of planets: then one planet carries all.
    """
    if (given := load.mesh_load_factor) is not None:
        require_number("load.mesh_load_factor", given, at_least=1, at_most=train.planets)
        return MeshLoadFactor(given, FactorSource.GIVEN)
    if computed is not None:
        # The shares have the mean 1: what is nearer to it than solvers are, or below it, is rounding.
        return MeshLoadFactor(float(computed) if computed > 1 + _ROUNDING else 1.0, FactorSource.COMPUTED)
    return MeshLoadFactor(1.0, FactorSource.EQUAL)


@dataclass(frozen=True, kw_only=True)
class MeshLoad:
    """The load of the mesh of a central with one planet, seen from the carrier.

    The torque of `load` (N·m) is the N-th part of that on the central, on the pair's pinion: positive where it presses the
    flanks that a pinion which is driven counter-clockwise presses; its speed (rpm) is that of the pinion against the carrier.
    `application_factor` K_A is the train's, `mesh_load_factor` K_gamma; that of the load is their product. `driver` drives its
    mate, with the carrier at rest.
    """

    mesh: SetMesh
    planets: int
    load: Load
    driver: Role
    application_factor: float
    mesh_load_factor: MeshLoadFactor

    @property
    def even(self) -> Load:
        """The load of a planet that carries its N-th part: with K_A, without K_gamma."""
        return replace(self.load, application_factor=self.application_factor)

    @property
    def normal_force(self) -> float:
        """Normal force F_bt (N) of one planet's share, without any factor."""
        return abs(self.load.torque) * 2000 / self.mesh.pair.pinion.base_diameter

    @property
    def contacts(self) -> PerGear[int]:
        """Number of contacts of a flank of each gear in one turn against the carrier."""
        return PerGear.each(lambda role: self.planets if role is self.mesh.central_role else 1)

    @property
    def cycles_per_minute(self) -> PerGear[float]:
        """Load cycles of a flank of each gear in a minute."""
        rolled = abs(self.load.speed) * self.mesh.pair.pinion.teeth
        gears = self.mesh.pair.gears
        return PerGear.each(lambda role: rolled / gears.pick(role).tooth_count * self.contacts.pick(role))

    def to_dict(self) -> JsonObject:
        """Return the load as a document for JSON: N·m, rpm and N."""
        return {
            "torque": self.load.torque,
            "speed": self.load.speed,
            "normal_force": self.normal_force,
            "K_A": self.application_factor,
            "K_gamma": self.mesh_load_factor.value,
            "K_gamma_source": self.mesh_load_factor.source.value,
            "driver": self.mesh.pair.gears.pick(self.driver).name,
            "contacts": self.contacts._asdict(),
            "cycles_per_minute": self.cycles_per_minute._asdict(),
        }


def mesh_loads(train: TrainData, flow: PowerFlow, computed_factor: float | None = None) -> dict[str, MeshLoad]:
    """Return the loads of both meshes of a set by their names, under a flow of power; K_gamma is by `mesh_load_factor`."""
    found = mesh_load_factor(train, flow.load, computed_factor)
    first, second = train.meshes
    central_drives = _rolling(train, flow) >= 0
    drivers = {
        first.name: first.central_role if central_drives else first.rim_role,
        second.name: second.rim_role if central_drives else second.central_role,
    }
    return {mesh.name: _mesh_load(train, mesh, flow, found, drivers[mesh.name]) for mesh in train.meshes}


def _mesh_load(train: TrainData, mesh: SetMesh, flow: PowerFlow, found: MeshLoadFactor, driver: Role) -> MeshLoad:
    """Return the load of one mesh. Errors of the load name the mesh."""
    factor = flow.load.application_factor
    try:
        load = Load(
            torque=_on_pinion(train, mesh, flow),
            speed=_pinion_speed(train, mesh, flow),
            application_factor=factor * found.value,
        )
    except ParameterError as error:
        raise error.within(mesh.name) from error
    return MeshLoad(
        mesh=mesh,
        planets=train.planets,
        load=load,
        driver=driver,
        application_factor=factor,
        mesh_load_factor=found,
    )


def stage_loads(train: TrainData, flow: PowerFlow) -> dict[str, Load]:
    """Return the load of each pair before and behind the set by its name.

    The torque (N·m) is the load of the wheel, on the pinion.
    """
    return {
        stage.name: Load(
            torque=flow.stage_torques[stage.name].wheel / stage.pair.gear_ratio + 0.0,
            speed=flow.speeds.members[stage.pinion],
            application_factor=flow.load.application_factor,
        )
        for stage in train.stages
    }


def _on_pinion(train: TrainData, mesh: SetMesh, flow: PowerFlow) -> float:
    """Return the torque on the pinion of a mesh (N·m): T_1 = T_2 z_1/z_2 with signed teeth, T_2 that on the central."""
    ratio = mesh.pair.pinion.teeth / mesh.central.gear.teeth
    return flow.set_torques[mesh.central.name] / train.planets * ratio + 0.0


def _pinion_speed(train: TrainData, mesh: SetMesh, flow: PowerFlow) -> float:
    """Return the speed (rpm) of the pinion against the carrier; 0 if it is below the least speed."""
    members = flow.speeds.members
    central = members[mesh.central.name] - members[train.carrier.name]
    # A planet is one body, whatever the rim.
    relative = flow.speeds.planet_relative if mesh.rim_role is Role.PINION else central
    return relative if abs(relative) >= _SLOWEST else 0.0


def _rolling(train: TrainData, flow: PowerFlow) -> float:
    """Return the sign of the rolling power at a resting carrier: 1 from the first central to the second; 0 if there is none.

    For a train at rest the sign is that for a positive speed of its input; for a differential at rest it is 0.
    """
    members = flow.speeds.members
    if not any(members.values()):
        try:
            members = speeds(train, {train.input: 1.0}).members
        except ParameterError:
            return 0.0
    central = train.centrals[0].name
    relative = members[central] - members[train.carrier.name]
    return math.copysign(1.0, flow.set_torques[central] * relative) if relative else 0.0
