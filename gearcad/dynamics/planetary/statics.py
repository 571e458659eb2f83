"""TrainStatics: a planetary train under its load as springs, what presses and displaces them, and what of it turns.

Losses are left out: meshes are springs, and springs have no friction. Forces in N, lengths in µm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.disturbances import Turning, gaps, set_members, turning_and_standing
from gearcad.dynamics.planetary.equilibrium import Equilibrium
from gearcad.dynamics.planetary.planar import PlanarMember, PlanarTrain, planar_train
from gearcad.dynamics.planetary.springs import SpringKind, TrainSprings, springs_of
from gearcad.errors import GeometryError, ParameterError, SolverError
from gearcad.notice import Notice
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.load import torque_key
from gearcad.planetary.power import PowerFlow, lossless_flow
from gearcad.planetary.shafts import shafts_of

__all__ = ["State", "TrainStatics", "planar_notices", "train_statics"]

_MICRO = 1e6
"""µm in a m."""

_FREE = 1e-9
"""Part of a motion without springs below which a member stands still in it."""

_PRESENT = 1.0
"""N/m by which a rigid spring is told from one that is not there; its compliance is 0."""


class State(NamedTuple):
    """Springs of the train in cases (s, m): forces in N, and in µm gaps, how far they yield, and how far teeth are open."""

    forces: Floats
    opening: Floats
    yielding: Floats
    gap: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class TrainStatics:
    """m springs between n coordinates, seen from the carrier: `compliance` (m,) in µm/N, 0 where one is rigid.

    Without what is `turning`, gaps are `gap` (m,) in µm and loads `load` (n,) in N. `flow` is that without losses.
    """

    train: PlanetaryTrain
    flow: PowerFlow
    springs: TrainSprings
    compliance: Floats
    gap: Floats
    load: Floats
    turning: tuple[Turning, ...]

    @cached_property
    def equilibrium(self) -> Equilibrium:
        """Of the springs: teeth can only press."""
        press = np.array([spring.kind is SpringKind.MESH for spring in self.springs.springs])
        return Equilibrium(vectors=self.springs.vectors, press=press)

    @property
    def meshes(self) -> Floats:
        """(2, N): places of the springs of both meshes, by planets."""
        return np.array([self.springs.select(SpringKind.MESH, mesh.name) for mesh in self.train.meshes])

    @property
    def pins(self) -> Floats:
        """(2, N): places of the radial and the tangential springs of the pins."""
        return np.array([self.springs.select(kind) for kind in (SpringKind.PIN_RADIAL, SpringKind.PIN_TANGENTIAL)])

    @property
    def output(self) -> str:
        """The member of the set that turns with the output."""
        return shafts_of(self.train)[self.train.output].member

    @property
    def torque(self) -> float:
        """On the output (N·m), a magnitude."""
        return abs(self.flow.torques[self.train.output])

    @property
    def output_work(self) -> float:
        """T²/K of the shaft that the output drives through its member (N·µm), 0 where it is rigid."""
        stiffness = next(each.torsional_stiffness for each in set_members(self.train) if each.name == self.output)
        return 0.0 if stiffness is None else 1e6 * self.flow.set_torques[self.output] ** 2 / stiffness

    def state(self, angles: Floats | None = None, compliance: Floats | None = None) -> State:
        """The train with what turns at angles (s, t) in rad, or without it, and compliances (s, m) in µm/N or its own.

        Raises SolverError where teeth would have to pull.
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
        return State(forces=forces, opening=opening, yielding=c * forces, gap=np.broadcast_to(gap, forces.shape))

    def places(self, state: State) -> Floats:
        """(s, 3, 2): x and y (µm) of carrier and centrals; of what no spring holds, the least."""
        return self._across(self.equilibrium.displacement(state.yielding + state.gap - state.opening))

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Members whose place no spring decides."""
        moved = np.abs(self._across(self.equilibrium.free.T)).max(axis=(0, 2), initial=0.0)
        return tuple(name for name, size in zip(self.springs.members, moved, strict=True) if size > _FREE)

    def _across(self, motion: Floats) -> Floats:
        """(s, 3, 2) of motions (s, n)."""
        rows = np.array([[3 * place, 3 * place + 1] for place in range(3)])
        found: Floats = np.einsum("paj,sj->spa", self.springs.basis[rows], motion)
        return found


def train_statics(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: Mapping[str, ArrayLike],
    given_speeds: Mapping[str, float] | None = None,
) -> TrainStatics:
    """The springs of a train with `stiffness` (N/µm) of each mesh by its name, of one planet as of all or (N,) of each.

    Input and what else is not the output are held against turning. Raises ParameterError without torque or with the wrong
    number of errors, GeometryError where nothing carries what stages push across the axis.
    """
    if not load.given_torque:
        permitted = "must not be 0: without load no flanks are pressed together"
        raise ParameterError(torque_key(load), load.given_torque, permitted, "N·m")
    flow = lossless_flow(train, load, given_speeds)
    sense = 1 if flow.set_torques[train.centrals[0].name] > 0 else -1
    output = shafts_of(train)[train.output].member
    a, b = (_given(stiffness, mesh.name) for mesh in train.meshes)
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


def _given(stiffness: Mapping[str, ArrayLike], name: str) -> ArrayLike:
    if name not in stiffness:
        raise ParameterError("stiffness", sorted(stiffness), f"must have that of {name}")
    return stiffness[name]


def planar_notices(train: PlanetaryTrain) -> tuple[Notice, ...]:
    """That planets which their forces tilt stand parallel here."""
    middles = {rim.axial_position + rim.gear.face_width / 2 for rim in train.rims}
    helical = any(mesh.rim.gear.helix_angle and not mesh.pair.double_helical for mesh in train.meshes)
    if len(middles) == 1 and not helical:
        return ()
    because = " and ".join(["meshes in different planes"] * (len(middles) > 1) + ["axial forces"] * helical)
    return (Notice("planets-parallel", f"planets stand parallel: how far {because} tilt them is left out"),)


def _with_rigid(planar: PlanarTrain, output: str) -> tuple[TrainSprings, Floats]:
    """Springs in the place of all that is rigid, too, and compliances (m,) in µm/N of all; nothing holds the output."""

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
    """Raise GeometryError where members float that together carry nothing across the axis."""
    loads = np.vstack([statics.load[None], *(each.load for each in statics.turning)])
    if not statics.equilibrium.unbalanced(loads).any():
        return
    first = next(each for each in set_members(statics.train) if each.support_stiffness == 0)
    permitted = (
        f"must be above 0, or none, which holds it: nothing carries the load across the axis, as {_floating(statics.train)}"
    )
    raise GeometryError(f"{first.name}.support_stiffness", 0.0, permitted, "N/µm")


def _floating(train: PlanetaryTrain) -> str:
    """Such as "sun floats", "" where nothing does."""
    names = [each.name for each in set_members(train) if each.support_stiffness == 0]
    return f"{' and '.join(names)} float{'s' if len(names) == 1 else ''}" if names else ""
