"""Gearboxes of several planetary sets whose members are joined, and held by brakes and clutches: speeds, torques, efficiency.

Each mesh on a carrier is one equation, z_i (w_i - w_c) + z_j (w_j - w_c) = 0, with the teeth of a ring below 0 (R. Willis; VDI
2157). Members that are joined turn as one. A state is complete where its brakes and clutches leave one speed free.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property

import numpy as np

from gearcad.core.errors import GeometryError, ParameterError, SolverError, require_number
from gearcad.core.records import Floats, Indices, JsonObject
from gearcad.planetary.gearbox_assembly import GearboxPhases, SetAssembly
from gearcad.planetary.gearbox_sets import GearboxMesh, MemberSet, meshes_of
from gearcad.planetary.poses import GearPlace

_FREE = 1e-9
"""Share of the greatest singular value below which a motion is free, and a torque not determined."""

_GAP = 5.0
"""Free height (mm) between sets whose place is not given."""

_MOST_TRIES = 64
"""Tries to find the senses in which power rolls through the meshes: losses change them where power nearly balances."""


@dataclass(frozen=True, kw_only=True)
class GearboxShaft:
    """A shaft that twists between two members or shafts, `start` and `end`, by its `torsional_stiffness` (N·m/rad).

    Both ends turn alike in the states. Raises ParameterError.
    """

    name: str
    start: str
    end: str
    torsional_stiffness: float

    def __post_init__(self) -> None:
        require_number("torsional_stiffness", self.torsional_stiffness, "N·m/rad", above=0, at_most=1e12)
        if self.start == self.end:
            raise ParameterError("end", self.end, "must be another member or shaft than the start")


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
    mesh_torques: Mapping[str, float | None]
    """Torques that each mesh puts on its second gear, on all its planets together, by the nominal ratio of its teeth."""

    mesh_signs: Mapping[str, int]
    """Signs of these torques; where the balance does not determine them, those of the least torques that balance."""

    planet_speeds: Mapping[str, float]
    """Speeds of the planets by the names of their bodies."""

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
            "mesh_torques": dict(self.mesh_torques),
            "planet_speeds": dict(self.planet_speeds),
        }


@dataclass(frozen=True, kw_only=True)
class Gearbox:
    """Planetary sets with members `joined` for good, `input` and `output`, and the states of the gearbox.

    A name with a dot is a member of a set, such as "set1.sun"; others are shafts. `mesh_efficiency` is that of each mesh with
    its carrier at rest. `shafts` twist; `inertias` (kg·m²) are those of shafts, and what members have beside their gears.
    `speed` (rpm) is the highest of the input, up to which errors of meshes shake it. Raises ParameterError.
    """

    name: str
    sets: tuple[MemberSet, ...]
    input: str
    output: str
    states: tuple[GearboxState, ...]
    joined: tuple[tuple[str, ...], ...] = ()
    mesh_efficiency: float = 1.0
    shafts: tuple[GearboxShaft, ...] = ()
    inertias: Mapping[str, float] = field(default_factory=dict)
    speed: float | None = None

    def __post_init__(self) -> None:
        require_number("mesh_efficiency", self.mesh_efficiency, above=0, at_most=1)
        if self.speed is not None:
            require_number("speed", self.speed, "rpm", above=0, at_most=1e6)
        if not self.sets:
            raise ParameterError("set", None, "must be given: [[planetary.set]], once for each")
        if not self.states:
            raise ParameterError("states", None, "must be given: for each state the members that are held and joined")
        if len({each.name for each in self.sets}) < len(self.sets):
            raise ParameterError("set", [each.name for each in self.sets], "must have a name of its own each")
        named = [("input", self.input), ("output", self.output), *(("joined", name) for each in self.joined for name in each)]
        named += [(f"shaft.{each.name}", name) for each in self.shafts for name in (each.start, each.end)]
        named += [("inertia", name) for name in self.inertias]
        for name, inertia in self.inertias.items():
            require_number(f"inertia.{name}", inertia, "kg·m²", above=0, at_most=1e9)
        for state in self.states:
            key = f"states.{state.name}"
            named += [(f"{key}.held", name) for name in state.held]
            named += [(f"{key}.joined", name) for each in state.joined for name in each]
        for key, name in named:
            if "." in name and name not in self.members:
                raise ParameterError(key, name, f"must be a shaft without a dot, or one of {', '.join(self.members)}")
        if any(each.gearing for each in self.sets) and not self.assemblies:
            name = next(each.name for each in self.sets if each.gearing is None)
            raise ParameterError(
                f"{name}.planets", None, "must be given with normal_module and face_width, as of the other sets"
            )
        for assembly in self.assemblies.values():
            assembly.check()
        if self.assemblies:
            self._check_heights()

    def _check_heights(self) -> None:
        """Raise GeometryError for gears of two sets that pass through each other at the same height."""
        spans = [(name, *span) for name in self.assemblies for span in self._spans(name)]
        for (first, one, low, top, *near), (second, other, bottom, high, *far) in itertools.combinations(spans, 2):
            apart = min(top, high) <= max(low, bottom) or min(near[1], far[1]) <= max(near[0], far[0])
            if first != second and not apart:
                names = f"{first}.{one} and {second}.{other}"
                permitted = f"must keep {names} apart, which pass through each other at the same height"
                raise GeometryError(f"{second}.axial_position", self.bottoms[second], permitted, "mm")

    def _spans(self, name: str) -> Iterator[tuple[str, float, float, float, float]]:
        """Yield the gears of a set with the heights and radii (mm) between which their teeth pass."""
        assembly, bottom = self.assemblies[name], self.bottoms[name]
        for part, own in assembly.gearing.gears.items():
            inner, outer = assembly.reach(part)
            yield part, bottom + own.axial_position, bottom + own.top, inner, outer

    @property
    def members(self) -> tuple[str, ...]:
        """Names of all members of the sets."""
        return tuple(name for each in self.sets for name in each.members)

    @cached_property
    def assemblies(self) -> dict[str, SetAssembly]:
        """Sets whose gears are known, put together, by their names; none unless the gears of all sets are known."""
        known = all(each.gearing is not None for each in self.sets)
        return {each.name: SetAssembly(each) for each in self.sets} if known else {}

    @cached_property
    def bottoms(self) -> dict[str, float]:
        """Height of the bottom of each set (mm): the given one, or above the set before it, and 0 of the first."""
        found: dict[str, float] = {}
        top = 0.0
        for name, assembly in self.assemblies.items():
            gears = assembly.gearing.gears.values()
            low, high = min(each.axial_position for each in gears), max(each.top for each in gears)
            given = assembly.gearing.axial_position
            found[name] = top - low if given is None else given
            top = max(top, found[name] + high + _GAP)
        return found

    def pose(self, state: StateResult | None = None, angle: float = 0.0) -> dict[str, GearPlace]:
        """Return all gears in mesh by names such as "set1.sun" and "set1.planet 2", the input turned by `angle` (degrees).

        Without a `state` they stand where they were put together.
        """
        found: dict[str, GearPlace] = {}
        for name, assembly in self.assemblies.items():
            speeds = {} if state is None else {**state.speeds, **state.planet_speeds}
            own = {part: speeds.get(f"{name}.{part}", 0.0) * angle for part in assembly.turning}
            places = assembly.places(own, self.bottoms[name])
            found |= {f"{name}.{part}": place for part, place in places.items()}
        return found

    def phases(self, state: StateResult) -> dict[str, GearboxPhases | None]:
        """Return the phases of each mesh in a state with the input turning counter-clockwise and driving, by its name.

        None where the torque of a mesh is not determined. A mesh that carries nothing is taken as on the left flanks.
        """
        found: dict[str, GearboxPhases | None] = {}
        for name, assembly in self.assemblies.items():
            for mesh in assembly.meshes:
                torque = state.mesh_torques[f"{name}.{mesh.name}"]
                member = assembly.subject.body_of(mesh.second)
                relative = state.planet_speeds[f"{name}.{member}"] - state.speeds[f"{name}.{assembly.subject.carrier}"]
                found[f"{name}.{mesh.name}"] = (
                    None
                    if torque is None
                    else assembly.phases(mesh, side=-1 if torque > 0 else 1, turning=-1 if relative < 0 else 1)
                )
        return found

    @cached_property
    def meshes(self) -> tuple[GearboxMesh, ...]:
        """Meshes of all sets: of centrals, and of planets with planets."""
        return tuple(mesh for each in self.sets for mesh in meshes_of(each))

    def to_dict(self) -> JsonObject:
        """Return the sets with their teeth and mates, joined members, and what each state holds and joins."""
        return {
            "input": self.input,
            "output": self.output,
            "mesh_efficiency": self.mesh_efficiency,
            "joined": [list(group) for group in self.joined],
            "speed": self.speed,
            "inertia": dict(self.inertias),
            "shafts": {each.name: asdict(each) for each in self.shafts},
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


def _on_second(mesh: GearboxMesh, torque: float | None) -> float | None:
    """Return the torque on the second gear of a mesh from that on its first one."""
    return None if torque is None else torque * mesh.second_teeth / mesh.first_teeth


class _Bodies:
    """Bodies of a gearbox in a state: members and shafts that are joined for good count once."""

    def __init__(self, gearbox: Gearbox, state: GearboxState) -> None:
        self.gearbox, self.state = gearbox, state
        bodies_of = (f"{each.name}.{each.body_of(planet.name)}" for each in gearbox.sets for planet in each.planets)
        self.planets = tuple(dict.fromkeys(bodies_of))
        twisting = [(each.start, each.end) for each in gearbox.shafts]
        groups = (*gearbox.joined, *twisting, *state.joined, state.held, tuple(gearbox.inertias))
        shafts = {name for group in groups for name in group}
        self.members = tuple(dict.fromkeys((*gearbox.members, gearbox.input, gearbox.output, *sorted(shafts))))
        of = {name: name for name in (*self.members, *sorted(self.planets))}
        for group in (*gearbox.joined, *twisting):
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
        rolling, torques, signs = self._torques(speeds)
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
            mesh_torques={mesh.name: _on_second(mesh, each) for mesh, each in zip(gearbox.meshes, torques, strict=False)},
            mesh_signs={
                mesh.name: sign if mesh.first_teeth > 0 else -sign for mesh, sign in zip(gearbox.meshes, signs, strict=True)
            },
            planet_speeds={name: float(speeds[self.at[name]]) for name in self.planets},
        )

    def _torques(self, speeds: Floats) -> tuple[list[float | None], list[float | None], list[int]]:
        """Return the power that enters each mesh, the torques of meshes, output, brakes and clutches, and signs of the meshes'.

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
                return powers, told, np.where(torques[: len(meshes)] < 0, -1, 1).tolist()
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
