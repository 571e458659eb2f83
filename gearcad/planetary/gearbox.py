"""Gearboxes of several planetary sets whose members are joined, and held by brakes and clutches: speeds, torques, efficiency.

Each mesh on a carrier is one equation, z_i (w_i - w_c) + z_j (w_j - w_c) = 0, with the teeth of a ring below 0 (R. Willis; VDI
2157). Members that are joined turn as one. A state is complete where its brakes and clutches leave one speed free.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError, ParameterError, SolverError, require_number, require_whole
from gearcad.core.records import Floats, Indices, JsonObject

_MOST_TEETH = 2000
_FREE = 1e-9
"""Share of the greatest singular value below which a motion is free, and a torque not determined."""

_MOST_TRIES = 64
"""Tries to find the senses in which power rolls through the meshes: losses change them where power nearly balances."""


@dataclass(frozen=True, kw_only=True)
class SetPlanet:
    """A planet of a set: `teeth`, the planet that it `meshes` with, or the planet `beside` which it sits on one body."""

    name: str
    teeth: int
    meshes: str = ""
    beside: str = ""

    def __post_init__(self) -> None:
        require_whole("teeth", self.teeth, at_least=3, at_most=_MOST_TEETH)
        if self.meshes and self.beside:
            raise ParameterError("beside", self.beside, "must not be given with meshes: a rim turns with its body")


@dataclass(frozen=True, kw_only=True)
class SetCentral:
    """A sun or a ring (`teeth` below 0) of a set, and the planet that it `meshes` with."""

    name: str
    teeth: int
    meshes: str

    def __post_init__(self) -> None:
        if isinstance(self.teeth, bool) or not isinstance(self.teeth, int) or not 3 <= abs(self.teeth) <= _MOST_TEETH:
            permitted = f"must be a whole number from 3 to {_MOST_TEETH}, or from -{_MOST_TEETH} to -3 for a ring"
            raise ParameterError("teeth", self.teeth, permitted)


@dataclass(frozen=True, kw_only=True)
class MemberSet:
    """A planetary set: its centrals, its planets, and the carrier on which these sit. Raises ParameterError."""

    name: str
    centrals: tuple[SetCentral, ...]
    planets: tuple[SetPlanet, ...]
    carrier: str = "carrier"

    def __post_init__(self) -> None:
        names = [each.name for each in self.planets]
        if not self.centrals or not names:
            raise ParameterError(self.name, None, "must have a sun or a ring, and a planet")
        every = [*names, *(each.name for each in self.centrals), self.carrier]
        if twice := [name for name in every if every.count(name) > 1]:
            raise ParameterError(f"{self.name}.{twice[0]}", twice[0], "must be the name of one member or planet")
        parts: tuple[SetCentral | SetPlanet, ...] = (*self.centrals, *self.planets)
        for part in parts:
            for key in ("meshes", "beside"):
                mate = getattr(part, key, "")
                if mate and (mate not in names or mate == part.name):
                    others = ", ".join(name for name in names if name != part.name) or "none"
                    raise ParameterError(f"{self.name}.{part.name}.{key}", mate, f"must be another planet of the set: {others}")

    @property
    def members(self) -> tuple[str, ...]:
        """Names of carrier and centrals with that of the set, such as "set1.sun"."""
        return tuple(f"{self.name}.{each}" for each in (self.carrier, *(central.name for central in self.centrals)))

    def to_dict(self) -> JsonObject:
        """Return teeth and mates of centrals and planets by their names, and the name of the carrier."""
        planets = {
            each.name: {"teeth": each.teeth, "meshes": each.meshes or None, "beside": each.beside or None}
            for each in self.planets
        }
        centrals = {each.name: {"teeth": each.teeth, "meshes": each.meshes} for each in self.centrals}
        return {"centrals": centrals, "planets": planets, "carrier": self.carrier}

    def body_of(self, planet: str) -> str:
        """Return the name of the planet on whose body a planet sits."""
        beside = next(each.beside for each in self.planets if each.name == planet)
        return self.body_of(beside) if beside else planet


class GearboxMesh(NamedTuple):
    """A mesh: its name, its set's carrier, and body and teeth of both gears."""

    name: str
    carrier: str
    first: str
    first_teeth: int
    second: str
    second_teeth: int


@dataclass(frozen=True, kw_only=True)
class GearboxState:
    """A state of a gearbox by its name: members that brakes hold, and members or shafts that clutches join."""

    name: str
    held: tuple[str, ...] = ()
    joined: tuple[tuple[str, ...], ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False)
class StateResult:
    """Result of a state: speeds over that of the input, torques over that on the input, powers over the input's.

    `speeds` are by the names of members and shafts, `torques` from outside by those of input, output and held members, and
    `clutches` those that a clutch puts on the second of what it joins, by "first-second"; None where brakes and clutches share
    a torque that the balance alone does not divide. `rolling` is the power that enters each mesh, seen from its carrier.
    """

    state: GearboxState
    ratio: float
    efficiency: float
    speeds: Mapping[str, float]
    torques: Mapping[str, float | None]
    clutches: Mapping[str, float | None]
    rolling: Mapping[str, float | None]

    def to_dict(self) -> JsonObject:
        """Return plain values."""
        return {
            "held": list(self.state.held),
            "joined": [list(each) for each in self.state.joined],
            "ratio": self.ratio,
            "efficiency": self.efficiency,
            "speeds": dict(self.speeds),
            "torques": dict(self.torques),
            "clutch_torques": dict(self.clutches),
            "rolling_power": dict(self.rolling),
        }


@dataclass(frozen=True, kw_only=True)
class Gearbox:
    """Planetary sets with members `joined` for good, `input` and `output`, and the states of the gearbox.

    A name with a dot is a member of a set, such as "set1.sun"; others are shafts. `mesh_efficiency` is that of each mesh with
    its carrier at rest. Raises ParameterError.
    """

    name: str
    sets: tuple[MemberSet, ...]
    input: str
    output: str
    states: tuple[GearboxState, ...]
    joined: tuple[tuple[str, ...], ...] = ()
    mesh_efficiency: float = 1.0

    def __post_init__(self) -> None:
        require_number("mesh_efficiency", self.mesh_efficiency, above=0, at_most=1)
        if not self.sets:
            raise ParameterError("set", None, "must be given: [[planetary.set]], once for each")
        if not self.states:
            raise ParameterError("states", None, "must be given: for each state the members that are held and joined")
        if len({each.name for each in self.sets}) < len(self.sets):
            raise ParameterError("set", [each.name for each in self.sets], "must have a name of its own each")
        named = [("input", self.input), ("output", self.output), *(("joined", name) for each in self.joined for name in each)]
        for state in self.states:
            key = f"states.{state.name}"
            named += [(f"{key}.held", name) for name in state.held]
            named += [(f"{key}.joined", name) for each in state.joined for name in each]
        for key, name in named:
            if "." in name and name not in self.members:
                raise ParameterError(key, name, f"must be a shaft without a dot, or one of {', '.join(self.members)}")

    @property
    def members(self) -> tuple[str, ...]:
        """Names of all members of the sets."""
        return tuple(name for each in self.sets for name in each.members)

    @cached_property
    def meshes(self) -> tuple[GearboxMesh, ...]:
        """Meshes of all sets: of centrals, and of planets with planets."""
        return tuple(mesh for each in self.sets for mesh in _meshes_of(each))

    def to_dict(self) -> JsonObject:
        """Return the sets with their teeth and mates, joined members, and what each state holds and joins."""
        return {
            "input": self.input,
            "output": self.output,
            "mesh_efficiency": self.mesh_efficiency,
            "joined": [list(group) for group in self.joined],
            "sets": {each.name: each.to_dict() for each in self.sets},
            "states": {
                each.name: {"held": list(each.held), "joined": [list(group) for group in each.joined]} for each in self.states
            },
        }

    def state(self, name: str) -> StateResult:
        """Return what a state does. Raises ParameterError for an unknown name, GeometryError and SolverError as `solve`."""
        for each in self.states:
            if each.name == name:
                return self.solve(each)
        raise ParameterError("state", name, f"must be one of {', '.join(each.name for each in self.states)}")

    def solve(self, state: GearboxState) -> StateResult:
        """Return the speeds, torques and losses of a state.

        Raises GeometryError for a state that locks the gearbox or leaves more than one speed free, and one whose output
        stands still; SolverError where friction keeps the input from turning the output.
        """
        return _Bodies(self, state).result()


def _meshes_of(each: MemberSet) -> Iterator[GearboxMesh]:
    teeth = {planet.name: planet.teeth for planet in each.planets}
    carrier = f"{each.name}.{each.carrier}"
    parts: Sequence[SetCentral | SetPlanet] = (*each.centrals, *(planet for planet in each.planets if planet.meshes))
    for part in parts:
        own = part.name if isinstance(part, SetCentral) else each.body_of(part.name)
        first, second = (f"{each.name}.{body}" for body in (own, each.body_of(part.meshes)))
        yield GearboxMesh(f"{each.name}.{part.name}-{part.meshes}", carrier, first, part.teeth, second, teeth[part.meshes])


class _Bodies:
    """Bodies of a gearbox in a state: members and shafts that are joined for good count once."""

    def __init__(self, gearbox: Gearbox, state: GearboxState) -> None:
        self.gearbox, self.state = gearbox, state
        planets = {f"{each.name}.{each.body_of(planet.name)}" for each in gearbox.sets for planet in each.planets}
        shafts = {name for group in (*gearbox.joined, *state.joined, state.held) for name in group}
        self.members = tuple(dict.fromkeys((*gearbox.members, gearbox.input, gearbox.output, *sorted(shafts))))
        of = {name: name for name in (*self.members, *sorted(planets))}
        for group in gearbox.joined:
            roots = {_root(of, name) for name in group}
            for root in roots:
                of[root] = min(roots)
        bodies = list(dict.fromkeys(_root(of, name) for name in of))
        self.at = {name: bodies.index(_root(of, name)) for name in of}
        self.count = len(bodies)
        self.clutches = [(first, second) for group in state.joined for first, second in itertools.pairwise(group)]

    @property
    def key(self) -> str:
        """Key of the state in messages."""
        return f"states.{self.state.name}"

    @property
    def words(self) -> str:
        """The state in words for messages."""
        held = [f"{', '.join(self.state.held)} held"] if self.state.held else []
        return "; ".join([*held, *(f"{', '.join(each)} joined" for each in self.state.joined)]) or "nothing held or joined"

    def equation(self, *terms: tuple[str, float]) -> Floats:
        """Return a row over the bodies, with a factor for each of these."""
        found = np.zeros(self.count)
        for name, factor in terms:
            found[self.at[name]] += factor
        return found

    @cached_property
    def speeds(self) -> Floats:
        """Speeds of the bodies over that of the input."""
        rows = []
        for mesh in self.gearbox.meshes:
            ratio = mesh.second_teeth / mesh.first_teeth
            rows.append(self.equation((mesh.first, 1.0), (mesh.second, ratio), (mesh.carrier, -1.0 - ratio)))
        rows += [self.equation((name, 1.0)) for name in self.state.held]
        rows += [self.equation((first, 1.0), (second, -1.0)) for first, second in self.clutches]
        _, values, free = np.linalg.svd(np.array(rows))
        rank = int((values > _FREE * values.max()).sum())
        if self.count - rank > 1:
            permitted = f"must leave one speed free, and leaves {self.count - rank}: hold or join more members"
            raise GeometryError(self.key, self.words, permitted)
        motion = free[rank] if rank < self.count else np.zeros(self.count)
        entering = motion[self.at[self.gearbox.input]]
        if abs(entering) <= _FREE * max(np.abs(motion).max(), _FREE):
            raise GeometryError(self.key, self.words, "must let the input turn: hold or join fewer members")
        found: Floats = motion / entering
        found[np.abs(found) <= _FREE * np.abs(found).max()] = 0.0
        return found

    def result(self) -> StateResult:
        speeds, gearbox = self.speeds, self.gearbox
        leaving = speeds[self.at[gearbox.output]]
        if leaving == 0:
            raise GeometryError(self.key, self.words, "must let the output turn")
        rolling, torques = self._torques(speeds)
        on_output, *rest = torques[len(gearbox.meshes) :]
        brakes, on_clutches = rest[: len(self.state.held)], rest[len(self.state.held) :]
        if on_output is None or not on_output:
            raise GeometryError(self.key, self.words, "must give the input's torque a way to the output")
        return StateResult(
            state=self.state,
            ratio=float(1 / leaving),
            efficiency=float(-on_output * leaving),
            speeds={name: float(speeds[self.at[name]]) for name in self.members},
            torques={gearbox.input: 1.0, gearbox.output: on_output, **dict(zip(self.state.held, brakes, strict=True))},
            clutches={f"{first}-{second}": each for (first, second), each in zip(self.clutches, on_clutches, strict=True)},
            rolling={mesh.name: each for mesh, each in zip(gearbox.meshes, rolling, strict=True)},
        )

    def _torques(self, speeds: Floats) -> tuple[list[float | None], list[float | None]]:
        """Return the power that enters each mesh, and the torques of meshes, output, brakes and clutches.

        Raises SolverError where no senses of the rolling power agree with themselves, or the output would have to drive.
        """
        meshes, loss = self.gearbox.meshes, self.gearbox.mesh_efficiency < 1
        relative = np.array([speeds[self.at[mesh.first]] - speeds[self.at[mesh.carrier]] for mesh in meshes])
        senses = np.zeros(len(meshes))
        for _ in range(_MOST_TRIES):
            torques, known = self._balanced(senses)
            rolling = torques[: len(meshes)] * relative
            found = np.where(np.abs(rolling) <= _FREE, 0.0, np.sign(rolling))
            if not loss or (found == senses).all():
                if torques[len(meshes)] * speeds[self.at[self.gearbox.output]] > _FREE:
                    break
                told = [float(each) if place in known else None for place, each in enumerate(torques)]
                into = np.abs(rolling) / self.gearbox.mesh_efficiency ** np.maximum(found, 0.0)
                powers = [float(each) if place in known or not each else None for place, each in enumerate(into)]
                return powers, told
            senses = found
        raise SolverError(
            f"{self.key}: no torque at {self.gearbox.output} is turned by {self.gearbox.input} at a mesh efficiency of "
            f"{self.gearbox.mesh_efficiency:.6g}: the gearbox locks itself"
        )

    def _balanced(self, senses: Floats) -> tuple[Floats, Indices]:
        """Return torques of meshes on their first gears, then those of output, brakes and clutches, for an input of 1, and the
        places of those that the balance of the bodies determines.

        The sense of a mesh is 1 where it drives its first gear, -1 where the first gear drives it: losses lie behind it.
        """
        columns = []
        for mesh, sense in zip(self.gearbox.meshes, senses.tolist(), strict=True):
            second = mesh.second_teeth / mesh.first_teeth * self.gearbox.mesh_efficiency**-sense
            columns.append(self.equation((mesh.first, 1.0), (mesh.second, second), (mesh.carrier, -1.0 - second)))
        columns += [self.equation((name, 1.0)) for name in (self.gearbox.output, *self.state.held)]
        columns += [self.equation((first, -1.0), (second, 1.0)) for first, second in self.clutches]
        system = np.array(columns).T
        entering = self.equation((self.gearbox.input, -1.0))
        found = np.linalg.lstsq(system, entering, rcond=_FREE)[0]
        if np.abs(system @ found - entering).max() > 1e-6:
            raise GeometryError(self.key, self.words, "must give the input's torque a way to the output")
        _, values, free = np.linalg.svd(system)
        open_ones = free[int((values > _FREE * values.max()).sum()) :]
        found[np.abs(found) <= _FREE] = 0.0
        known: Indices = np.flatnonzero(np.abs(open_ones).max(axis=0, initial=0.0) <= _FREE)
        return np.asarray(found, float), known


def _root(of: Mapping[str, str], name: str) -> str:
    while of[name] != name:
        name = of[name]
    return name
