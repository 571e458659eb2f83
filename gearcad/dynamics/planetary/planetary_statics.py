"""Statics of a planetary train: the equilibrium of its springs under load, and the torsional stiffness at its output.

Losses are left out: meshes are springs, and springs have no friction. Forces in N, lengths in µm.

The force method: forces in balance with the load are F = F_0 + Z y, and of all these the true ones make F C F/2 + e F least. A
spring may be rigid, C = 0. The number of unknowns is the number of springs beyond those that the balance needs: 0 where a set
shares its load by balance alone. A spring that can only press has a compliance above 0, and the rest of the springs is not
overdetermined, so there is one least. Lawson and Hanson's least distance programming finds it in a finite number of steps, or
that there is none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from enum import Enum
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, ParameterError, SolverError
from gearcad.core.records import Bools, Floats, JsonObject, Notice, texts
from gearcad.dynamics.planetary.planar_model import (
    PlanarMember,
    PlanarTrain,
    Spring,
    SpringKind,
    TrainSprings,
    TurningPart,
    gaps,
    mesh_force,
    planar_train,
    set_members,
    springs_of,
    turning_and_standing,
)
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.members import torque_key
from gearcad.planetary.power import PowerFlow, lossless_flow
from gearcad.planetary.train_data import shafts_of

_RANK = 1e-10
"""Singular values below this part of the greatest are none."""

_BALANCE = 1e-9
"""Part of a load that may be left unbalanced by rounding."""

_PULL = 1e-12
"""Part of the greatest force by which rounding may let a spring pull."""

_NONE = 1e-10
"""Distance from a solution of the dual problem, of at most 1, below which there are no forces that only press."""


class _Balance(NamedTuple):
    """Geometry of the springs: `inverse` (n, m) of V, self-stresses `redundant` (m, r), motions `free` (n, f)."""

    inverse: Floats
    redundant: Floats
    free: Floats


class _Measure(NamedTuple):
    """Self-stresses of equal energy, `moved` (m, r), and the compliance of the softest spring."""

    moved: Floats
    softest: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Equilibrium:
    """m springs of elongations V q - e between n coordinates: `vectors` V (m, n); those that can only `press` (m,) have F >= 0.

    In all arrays a row is a case: compliances (s, m), gaps e (s, m) and loads (s, n), each for all cases or (1, ...) for every
    one. They may be in any units that fit each other.
    """

    vectors: Floats
    press: Bools

    @cached_property
    def _balance(self) -> _Balance:
        left, values, right = np.linalg.svd(self.vectors)
        rank = int((values > _RANK * values[0]).sum())
        inverse = (right[:rank].T / values[:rank]) @ left[:, :rank].T
        return _Balance(inverse, left[:, rank:], right[rank:].T)

    @property
    def redundancy(self) -> int:
        """Number of springs beyond those that the balance needs.

        Only where it is above 0 do forces depend on stiffnesses and errors.
        """
        return int(self._balance.redundant.shape[1])

    @property
    def free(self) -> Floats:
        """Motions (n, f) that stretch no spring."""
        return self._balance.free

    def unbalanced(self, load: Floats) -> Floats:
        """Return the part (s, n) of a load that no spring can carry; 0 but for rounding if all of it is carried."""
        found: Floats = load @ self.free @ self.free.T
        found[np.abs(found).max(axis=1) <= _BALANCE * np.abs(load).max(axis=1)] = 0.0
        return found

    def forces(self, compliance: Floats, gap: Floats, load: Floats) -> tuple[Floats, Floats]:
        """Return the forces (s, m), and the openings (s, m) of springs that can only press.

        Raises SolverError where something would have to pull.
        """
        forces = self.two_sided(compliance, gap, load)
        opening = np.zeros_like(forces)
        pulling = forces[:, self.press] < -_PULL * np.abs(forces).max(axis=1, keepdims=True)
        measure = None
        for case in np.flatnonzero(pulling.any(axis=1)):
            if measure is None or len(compliance) > 1:
                measure = self._measured(compliance[case if len(compliance) > 1 else 0])
            forces[case], opening[case] = self._pressed(measure, forces[case])
        forces[:, self.press] = np.maximum(forces[:, self.press], 0.0)
        return forces, opening

    def two_sided(self, compliance: Floats, gap: Floats, load: Floats) -> Floats:
        """Return the forces (s, m) that would act if all springs could also pull."""
        inverse, redundant, _ = self._balance
        cases = max(map(len, (compliance, gap, load)))
        balanced = np.broadcast_to(load @ inverse, (cases, len(redundant)))
        if not self.redundancy:
            return balanced.copy()
        products = np.einsum("mi,mj->mij", redundant, redundant).reshape(len(redundant), -1)
        matrix = (compliance @ products).reshape(-1, self.redundancy, self.redundancy)
        needed = (compliance * balanced + gap) @ redundant
        found: Floats = balanced - np.linalg.solve(matrix, needed[..., None])[..., 0] @ redundant.T
        return found

    def displacement(self, elongation: Floats) -> Floats:
        """Return q (s, n) of elongations V q (s, m), which are C F + e less the openings.

        Motions that no spring holds are the least ones.
        """
        found: Floats = elongation @ self._balance.inverse.T
        return found

    def _measured(self, compliance: Floats) -> _Measure:
        """Return the measure of energy for compliances (m,): L L' = Z' C Z over the softest spring."""
        redundant, softest = self._balance.redundant, compliance.max()
        root = np.linalg.cholesky((redundant.T * (compliance / softest)) @ redundant)
        return _Measure(np.asarray(np.linalg.solve(root, redundant.T).T, float), float(softest))

    def _pressed(self, measure: _Measure, forces: Floats) -> tuple[Floats, Floats]:
        """Return forces (m,) of springs that cannot pull, and openings (m,), from the `forces` (m,) of a case as if they could.

        The least of L' (y - y_0) is sought that keeps all F >= 0 (Lawson and Hanson, chapter 23).
        """
        from scipy.optimize import nnls

        scale = np.abs(forces).max()
        rows = np.vstack([measure.moved[self.press].T, -forces[self.press] / scale])
        target = np.r_[np.zeros(self.redundancy), 1.0]
        weights, rest = nnls(rows, target)
        if rest < _NONE:
            raise SolverError("no compressive forces are in equilibrium with the load")
        left = rows @ weights - target
        opening = np.zeros_like(forces)
        opening[self.press] = -weights / left[-1] * scale * measure.softest
        found: Floats = forces - scale * (measure.moved @ left[:-1]) / left[-1]
        return found, opening


_MICRO = 1e6
"""Factor from m to µm."""

_FREE = 1e-9
"""Part of a motion without springs below which a member stands still in it."""

_PRESENT = 1.0
"""Stiffness (N/m) that distinguishes a rigid spring from an absent one; its compliance is 0."""


class SpringState(NamedTuple):
    """Springs of the train in cases (s, m): forces in N; openings of teeth, elastic deflections `yielding` and gaps in µm."""

    forces: Floats
    opening: Floats
    yielding: Floats
    gap: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class TrainStatics:
    """m springs between n coordinates, seen from the carrier: `compliance` (m,) in µm/N, 0 where a spring is rigid.

    `gap` (m,) in µm and `load` (n,) in N are without the gaps and loads that are `turning`. `flow` is the power flow without
    losses.
    """

    train: PlanetaryTrain
    flow: PowerFlow
    springs: TrainSprings
    compliance: Floats
    gap: Floats
    load: Floats
    turning: tuple[TurningPart, ...]

    @cached_property
    def equilibrium(self) -> Equilibrium:
        """Equilibrium of the springs: teeth can only press."""
        press = np.array([spring.kind is SpringKind.MESH for spring in self.springs.springs])
        return Equilibrium(vectors=self.springs.vectors, press=press)

    @property
    def meshes(self) -> Floats:
        """Places (2, N) of the springs of both meshes, by planets."""
        return np.array([self.springs.select(SpringKind.MESH, mesh.name) for mesh in self.train.meshes])

    @property
    def pins(self) -> Floats:
        """Places (2, N) of the radial and the tangential springs of the pins."""
        return np.array([self.springs.select(kind) for kind in (SpringKind.PIN_RADIAL, SpringKind.PIN_TANGENTIAL)])

    @property
    def output(self) -> str:
        """Name of the member of the set that turns with the output."""
        return shafts_of(self.train)[self.train.output].member

    @property
    def torque(self) -> float:
        """Magnitude of the torque on the output (N·m)."""
        return abs(self.flow.torques[self.train.output])

    @property
    def output_work(self) -> float:
        """T²/K of the shaft that the output drives through its member (N·µm), 0 where it is rigid."""
        stiffness = next(each.torsional_stiffness for each in set_members(self.train) if each.name == self.output)
        return 0.0 if stiffness is None else 1e6 * self.flow.set_torques[self.output] ** 2 / stiffness

    def state(self, angles: Floats | None = None, compliance: Floats | None = None) -> SpringState:
        """Return the state of the springs, with what turns at angles (s, t) in rad or without it.

        `compliance` (s, m) in µm/N is the train's own if not given. Raises SolverError where teeth would have to pull.
        """
        c = self.compliance[None] if compliance is None else compliance
        gap, load = self.gap[None], self.load[None]
        if angles is not None and self.turning:
            waves = np.hstack([np.cos(angles), np.sin(angles)])
            gap = gap + waves @ np.vstack([each.gap[axis] for axis in (0, 1) for each in self.turning])
            load = load + waves @ np.vstack([each.load[axis] for axis in (0, 1) for each in self.turning])
        try:
            forces, opening = self.equilibrium.forces(c, gap, load)
        except SolverError:
            because = f", as {_floating(self.train)}" if _floating(self.train) else ""
            raise SolverError(
                f"{self.train.name}: the planets cannot carry the load: teeth would have to pull{because}"
            ) from None
        return SpringState(forces=forces, opening=opening, yielding=c * forces, gap=np.broadcast_to(gap, forces.shape))

    def places(self, state: SpringState) -> Floats:
        """Return x and y (s, 3, 2) in µm of carrier and centrals.

        Where no spring holds them, these are the least.
        """
        return self._across(self.equilibrium.displacement(state.yielding + state.gap - state.opening))

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Names of members whose place no spring decides."""
        moved = np.abs(self._across(self.equilibrium.free.T)).max(axis=(0, 2), initial=0.0)
        return tuple(name for name, size in zip(self.springs.members, moved, strict=True) if size > _FREE)

    def _across(self, motion: Floats) -> Floats:
        """Return x and y (s, 3, 2) of carrier and centrals in motions (s, n)."""
        rows = np.array([[3 * place, 3 * place + 1] for place in range(3)])
        found: Floats = np.einsum("paj,sj->spa", self.springs.basis[rows], motion)
        return found


def train_statics(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: Mapping[str, ArrayLike],
    given_speeds: Mapping[str, float] | None = None,
) -> TrainStatics:
    """Return the statics of a train with `stiffness` (N/µm) of each mesh by its name: one for all planets, or (N,) of each.

    Input and all other members but the output are held against turning. Raises ParameterError without torque or with the wrong
    number of errors, GeometryError where nothing carries the forces of stages across the axis.
    """
    if not load.given_torque:
        permitted = "must not be 0: without load no flanks are pressed together"
        raise ParameterError(torque_key(load), load.given_torque, permitted, "N·m")
    flow = lossless_flow(train, load, given_speeds)
    sense = 1 if flow.set_torques[train.centrals[0].name] > 0 else -1
    output = shafts_of(train)[train.output].member
    a, b = (_member_stiffness(stiffness, mesh.name) for mesh in train.meshes)
    held = [name for name in train.members if name != output]
    planar = planar_train(train, (a, b), held=held, sense=sense)
    springs, compliance = _with_rigid(planar, output)
    pressed = springs.turning(output) * flow.set_torques[output]
    turning, standing = turning_and_standing(train, springs, flow)
    found = TrainStatics(
        train=train,
        flow=flow,
        springs=springs,
        compliance=compliance,
        gap=gaps(train, springs, sense),
        load=pressed + standing,
        turning=turning,
    )
    _check_carried(found)
    return found


def _member_stiffness(stiffness: Mapping[str, ArrayLike], name: str) -> ArrayLike:
    if name not in stiffness:
        raise ParameterError("stiffness", sorted(stiffness), f"must have the stiffness of {name}")
    return stiffness[name]


def planar_notices(train: PlanetaryTrain) -> tuple[Notice, ...]:
    """Return a notice if forces would tilt planets, which stand parallel in this model; empty otherwise."""
    middles = {rim.axial_position + rim.gear.face_width / 2 for rim in train.rims}
    helical = any(mesh.rim.gear.helix_angle and not mesh.pair.double_helical for mesh in train.meshes)
    if len(middles) == 1 and not helical:
        return ()
    because = " and ".join(["meshes in different planes"] * (len(middles) > 1) + ["axial forces"] * helical)
    return (Notice("planets-parallel", f"planets stand parallel: how far {because} tilt them is left out"),)


def _with_rigid(planar: PlanarTrain, output: str) -> tuple[TrainSprings, Floats]:
    """Return springs that stand for all rigid parts, too, and the compliances (m,) of all in µm/N.

    Nothing holds the output.
    """

    def present(member: PlanarMember) -> PlanarMember:
        support = _PRESENT if member.support is None else member.support
        torsion = 0.0 if member.name == output else _PRESENT if member.torsion is None else member.torsion
        return replace(member, support=support, torsion=torsion)

    first, second, third = map(present, planar.members)
    pin = _PRESENT if planar.pin is None else planar.pin
    springs = springs_of(replace(planar, members=(first, second, third), pin=pin))
    rigid = {member.name: (member.support is None, member.torsion is None) for member in planar.members}
    compliance = _MICRO / springs.stiffness
    for place, spring in enumerate(springs.springs):
        if spring.kind in (SpringKind.PIN_RADIAL, SpringKind.PIN_TANGENTIAL):
            held = planar.pin is None
        else:
            held = spring.kind is not SpringKind.MESH and rigid[spring.owner][spring.kind is SpringKind.TORSION]
        if held:
            compliance[place] = 0.0
    return springs, compliance


def _check_carried(statics: TrainStatics) -> None:
    """Raise GeometryError if members float that together carry nothing across the axis."""
    loads = np.vstack([statics.load[None], *(each.load for each in statics.turning)])
    if not statics.equilibrium.unbalanced(loads).any():
        return
    first = next(each for each in set_members(statics.train) if each.support_stiffness == 0)
    permitted = (
        f"must be above 0, or none, which holds it: nothing carries the load across the axis, as {_floating(statics.train)}"
    )
    raise GeometryError(f"{first.name}.support_stiffness", 0.0, permitted, "N/µm")


def _floating(train: PlanetaryTrain) -> str:
    """Return in words the members that float, such as "sun floats"; "" if none does."""
    names = [each.name for each in set_members(train) if each.support_stiffness == 0]
    return f"{' and '.join(names)} float{'s' if len(names) == 1 else ''}" if names else ""


_TURNS = 72
"""Angles of the carrier over which the squares of forces are averaged: exact, as they are harmonics of order 2."""

_ROUNDING = 1e-12
"""Share of the twist that rounding leaves to springs that carry nothing."""


class TwistSource(Enum):
    """Kind of the springs that add to the twist."""

    MESH = "mesh"
    PIN = "pin"
    SUPPORT = "support"
    SHAFT = "shaft"
    STAGE = "stage"


_SOURCES = {
    SpringKind.MESH: TwistSource.MESH,
    SpringKind.PIN_RADIAL: TwistSource.PIN,
    SpringKind.PIN_TANGENTIAL: TwistSource.PIN,
    SpringKind.SUPPORT_X: TwistSource.SUPPORT,
    SpringKind.SUPPORT_Y: TwistSource.SUPPORT,
    SpringKind.TORSION: TwistSource.SHAFT,
}


@dataclass(frozen=True, kw_only=True)
class Contribution:
    """Contribution of the springs of `name` to the twist: `twist` in degrees, `share` of the whole.

    `square_force` (N², of shafts N²·m²) is the sum of the squares of their forces, in the mean over a turn.
    """

    name: str
    source: TwistSource
    square_force: float
    twist: float
    share: float


@dataclass(frozen=True, kw_only=True)
class TorsionalStiffness:
    """Twist (degrees) of the output of a train under `torque` (N·m) on it, with all else held, and its contributions.

    It is without errors, with mean mesh stiffnesses and in the mean over a turn of the forces of stages across the axis.
    `rigid` names the parts that were given no stiffness.
    """

    train: PlanetaryTrain
    torque: float
    twist: float
    contributions: tuple[Contribution, ...]
    rigid: tuple[str, ...]

    @property
    def stiffness(self) -> float:
        """Torsional stiffness T/theta (N·m/rad)."""
        return self.torque / float(np.radians(self.twist))

    def share(self, source: TwistSource) -> float:
        """Return the share of the twist that springs of a kind have (1 is all of it)."""
        return sum(each.share for each in self.contributions if each.source is source)

    def implied_pin_stiffness(self, stiffness: float) -> float:
        """Return the stiffness of one pin (N/µm) that would make `stiffness` (N·m/rad) of the train.

        All other springs are as they are. Raises ParameterError where that is not softer than the train with rigid pins.
        """
        pins = [each for each in self.contributions if each.source is TwistSource.PIN]
        others = float(np.radians(self.twist - sum(each.twist for each in pins)))
        left = self.torque / stiffness - others
        if left <= 0:
            permitted = f"must be below {self.torque / others:.6g}, what it is with rigid pins"
            raise ParameterError("stiffness", stiffness, permitted, "N·m/rad")
        return sum(each.square_force for each in pins) / (self.torque * left) / 1e6

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of what is left out and of parts that are taken for rigid."""
        found = [*planar_notices(self.train)]
        if self.rigid:
            text = f"taken for rigid, without a stiffness: {', '.join(self.rigid)}; the train is softer"
            found.append(Notice("taken-for-rigid", text))
        return tuple(notice.within("torsional stiffness") for notice in found)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> JsonObject:
        """Return the part of `planetary.json`: N·m/rad, degrees."""
        return {
            "stiffness": self.stiffness,
            "torque": self.torque,
            "twist": self.twist,
            "contributions": [asdict(each) | {"source": each.source.value} for each in self.contributions],
            "rigid": list(self.rigid),
            "notices": [notice.to_dict() for notice in self.notices],
        }


def twist_of(work: ArrayLike, torque: float) -> Floats:
    """Return theta = sum F delta/T in degrees, for a `torque` T (N·m), linear or not.

    `work` (N·µm) are the sums of forces times the deflections of the springs under them.
    """
    return np.degrees(np.asarray(work, float) / (1e6 * torque))


def torsional_stiffness(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: Mapping[str, ArrayLike],
    given_speeds: Mapping[str, float] | None = None,
) -> TorsionalStiffness:
    """Return the torsional stiffness of a train with `stiffness` (N/µm) of each mesh and stage by its name.

    A stage without a stiffness is rigid. Raises the errors of `train_statics`.
    """
    statics = train_statics(_flawless(train), load, stiffness, given_speeds)
    squares = _mean_squares(statics)
    found = [*_of_set(statics, squares), *_of_shafts(statics), *_of_stages(statics, stiffness)]
    whole = sum(each.twist for each in found)
    found = [each for each in found if abs(each.twist) > _ROUNDING * abs(whole) or each.source is TwistSource.PIN]
    return TorsionalStiffness(
        train=train,
        torque=statics.torque,
        twist=whole,
        contributions=tuple(replace(each, share=each.twist / whole) for each in found),
        rigid=(*_rigid(train), *(stage.name for stage in train.stages if stage.name not in stiffness)),
    )


def _flawless(train: PlanetaryTrain) -> PlanetaryTrain:
    """Return the same train without errors."""
    return replace(
        train,
        centrals=tuple(replace(central, run_out=0.0) for central in train.centrals),
        rims=tuple(replace(rim, tooth_errors=()) for rim in train.rims),
        carrier=replace(train.carrier, run_out=0.0, pin_errors=()),
    )


def _mean_squares(statics: TrainStatics) -> Floats:
    """Return the squares (m,) of the forces in N², in the mean over a turn of the carrier."""
    angles = np.linspace(0, 2 * np.pi, _TURNS, endpoint=False)[:, None]
    found: Floats = (statics.state(angles).forces ** 2).mean(axis=0)
    return found


def _of_set(statics: TrainStatics, squares: Floats) -> Iterator[Contribution]:
    """Yield the contributions of meshes, pins, supports and shafts that hold members, in the order of the springs."""
    groups: dict[tuple[TwistSource, str], list[int]] = {}
    for place, spring in enumerate(statics.springs.springs):
        groups.setdefault((_SOURCES[spring.kind], _name(spring)), []).append(place)
    for (source, name), places in groups.items():
        work = squares[places] @ statics.compliance[places]
        if work or source is TwistSource.PIN:
            yield _contribution(name, source, float(squares[places].sum()), float(work), statics.torque)


def _name(spring: Spring) -> str:
    kinds = {TwistSource.PIN: "pins", TwistSource.SUPPORT: f"support of {spring.owner}", TwistSource.SHAFT: spring.owner}
    return kinds.get(_SOURCES[spring.kind], spring.owner)


def _of_shafts(statics: TrainStatics) -> Iterator[Contribution]:
    """Yield the contribution of the shaft that the output drives through its member."""
    if statics.output_work:
        square = statics.flow.set_torques[statics.output] ** 2
        yield _contribution(statics.output, TwistSource.SHAFT, square, statics.output_work, statics.torque)


def _of_stages(statics: TrainStatics, stiffness: Mapping[str, ArrayLike]) -> Iterator[Contribution]:
    for stage in statics.train.stages:
        if stage.name in stiffness:
            square = mesh_force(stage, statics.flow.stage_torques[stage.name]) ** 2
            work = square / float(np.asarray(stiffness[stage.name]))
            yield _contribution(stage.name, TwistSource.STAGE, square, work, statics.torque)


def _contribution(name: str, source: TwistSource, square: float, work: float, torque: float) -> Contribution:
    """Return a contribution from its work F delta in N·µm; its share is not known yet."""
    return Contribution(name=name, source=source, square_force=square, twist=float(twist_of(work, torque)), share=0.0)


def _rigid(train: PlanetaryTrain) -> Iterator[str]:
    """Yield the names of pins and shafts without a stiffness."""
    if train.carrier.pin_stiffness is None:
        yield "pins"
    yield from (f"shaft of {each.name}" for each in set_members(train) if each.torsional_stiffness is None)
