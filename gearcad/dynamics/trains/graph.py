"""The graph of a train: what hangs together with what, how fast everything turns, and whether that can be a train."""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from gearcad.dynamics.trains.members import GROUND, Inertia, Mesh, Shaft
from gearcad.errors import GeometryError, ParameterError, format_number

__all__ = ["Graph", "turning_pieces"]

_SAME_SPEED = 1e-6
"""Relative: two ways round a loop must give an inertia the same speed; rounded base radii would lock it."""

_BALANCED = 1e-3

_WRONG_SIGN = 0.05
"""How near the torque that balances is to the given one with the other sign, relative to it, to be called its sign."""

"""Of the greatest torque: torques of four digits balance as well as that."""


def turning_pieces(names: Sequence[str], shafts: Iterable[Shaft], meshes: Iterable[Mesh]) -> list[dict[str, float]]:
    """The pieces that hang together, each with its inertias' speeds relative to its first inertia.

    Raises GeometryError where a loop would turn an inertia at two speeds.
    """
    neighbours: dict[str, list[tuple[str, float]]] = {name: [] for name in names}
    for shaft in shafts:
        if not shaft.held:
            neighbours[shaft.start].append((shaft.end, 1.0))
            neighbours[shaft.end].append((shaft.start, 1.0))
    for mesh in meshes:
        ratio = -mesh.radii.pinion / mesh.radii.wheel
        neighbours[mesh.pinion].append((mesh.wheel, ratio))
        neighbours[mesh.wheel].append((mesh.pinion, 1 / ratio))
    pieces: list[dict[str, float]] = []
    for name in names:
        if not any(name in piece for piece in pieces):
            pieces.append(_piece(name, neighbours))
    return pieces


def _piece(first: str, neighbours: dict[str, list[tuple[str, float]]]) -> dict[str, float]:
    """Speeds of what hangs together with one inertia, relative to it."""
    speeds, waiting = {first: 1.0}, deque([first])
    while waiting:
        here = waiting.popleft()
        for there, ratio in neighbours[here]:
            speed = speeds[here] * ratio
            if there not in speeds:
                speeds[there] = speed
                waiting.append(there)
            elif not math.isclose(speeds[there], speed, rel_tol=_SAME_SPEED):
                permitted = f"a loop of meshes and shafts turns {there} at {speeds[there]:.9g} and {speed:.9g} times the "
                raise GeometryError("meshes", there, permitted + f"speed of {first}: base radii must agree, unrounded")
    return speeds


class Graph(NamedTuple):
    """The members of a train, which by their names know what they join."""

    inertias: tuple[Inertia, ...]
    shafts: tuple[Shaft, ...]
    meshes: tuple[Mesh, ...]

    @property
    def reference(self) -> str:
        """The first mesh's pinion, or the first inertia where there is no mesh."""
        return self.meshes[0].pinion if self.meshes else self.inertias[0].name

    def pieces(self) -> list[dict[str, float]]:
        """What hangs together; see `turning_pieces`."""
        return turning_pieces([inertia.name for inertia in self.inertias], self.shafts, self.meshes)

    def speed_ratios(self) -> dict[str, float]:
        """Nominal speeds of a train in one piece, relative to the reference."""
        (speeds,) = self.pieces()
        reference = speeds[self.reference]
        return {name: speed / reference for name, speed in speeds.items()}

    def require_one_train(self, torques: Mapping[str, float]) -> None:
        """Raise ParameterError or GeometryError unless the members make one train, on whose inertias the torques act."""
        if not self.inertias:
            raise ParameterError("inertias", (), "must hold one inertia at least")
        for kind, members in zip(self._fields, self, strict=True):
            twice = [name for name, count in Counter(member.name for member in members).items() if count > 1]
            if twice:
                raise ParameterError(f"{kind}.name", twice[0], "names must differ")
        self._require_names(torques)
        self._require_one_piece()

    def require_balance(self, torques: Mapping[str, float]) -> None:
        """Raise GeometryError where torques, each reflected to the reference, leave something that would speed a train up."""
        ratios = self.speed_ratios()
        reflected = [torque * ratios[name] for name, torque in torques.items()]
        left = math.fsum(reflected)
        if reflected and abs(left) > _BALANCED * max(abs(torque) for torque in reflected):
            wrong, needed = _balancing(torques, ratios, left)
            permitted = (
                f"on {self.reference}, the sum of all, must be 0 on a train that no shaft holds: "
                f"give {wrong} = {needed:.10g} instead of {format_number(torques[wrong])} N·m, or hold the train"
            )
            raise GeometryError("torques", left, permitted, "N·m")

    def _require_names(self, torques: Mapping[str, float]) -> None:
        """Both ends of everything are known, and differ."""
        names = [inertia.name for inertia in self.inertias]
        known = f"must be one of the inertias {', '.join(names)}"
        for shaft in self.shafts:
            for parameter in ("start", "end"):
                if (end := getattr(shaft, parameter)) not in (*names, GROUND):
                    raise ParameterError(f"{shaft.name}.{parameter}", end, f'{known}, or "{GROUND}"')
            if shaft.start == shaft.end:
                permitted = "must differ from start: a shaft joins two inertias or holds one"
                raise GeometryError(f"{shaft.name}.end", shaft.end, permitted)
        for mesh in self.meshes:
            for role, gear in mesh.gears.items():
                if gear not in names:
                    raise ParameterError(f"{mesh.name}.{role.value}", gear, known)
            if mesh.pinion == mesh.wheel:
                raise GeometryError(f"{mesh.name}.wheel", mesh.wheel, "must differ from pinion")
        for name in torques:
            if name not in names:
                raise ParameterError("torques", name, known)

    def _require_one_piece(self) -> None:
        """Everything hangs together."""
        ends = {end for shaft in self.shafts for end in (shaft.start, shaft.end)}
        geared = {gear for mesh in self.meshes for gear in mesh.gears}
        for inertia in self.inertias:
            if inertia.name not in ends | geared:
                raise GeometryError("inertias", inertia.name, "has neither a shaft nor a mesh: give it one, or leave it out")
        pieces = self.pieces()
        if len(pieces) > 1:
            parts = " | ".join(", ".join(piece) for piece in pieces)
            permitted = f"does not hang together with the rest ({parts}): join the pieces by a shaft or a mesh"
            raise GeometryError("inertias", next(iter(pieces[1])), permitted)


def _balancing(torques: Mapping[str, float], ratios: Mapping[str, float], left: float) -> tuple[str, float]:
    """Return the member to change first, and its torque (N·m) that balances the train: one with a wrong sign, else the last."""
    needed = {name: torque - left / ratios[name] for name, torque in torques.items() if ratios[name]}
    turned = [name for name, torque in needed.items() if math.isclose(torque, -torques[name], rel_tol=_WRONG_SIGN)]
    name = (turned or list(needed))[-1]
    return name, needed[name]
