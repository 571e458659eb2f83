"""The graph of a train: what hangs together with what, how fast everything turns, and whether that can be a train."""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from gearcad.errors import GeometryError, ParameterError

if TYPE_CHECKING:
    from gearcad.dynamics.trains.train import Mesh, Shaft, Train

__all__ = ["GROUND", "check_train", "speed_ratios", "turning_pieces"]

GROUND = "ground"
"""The end of a shaft that does not turn."""

_SAME_SPEED = 1e-6
"""Relative: two ways round a loop must give an inertia the same speed; rounded base radii would lock it."""

_BALANCED = 1e-3
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
        ratio = -mesh.radii[0] / mesh.radii[1]
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


def speed_ratios(train: Train) -> dict[str, float]:
    """Nominal speeds relative to the first mesh's pinion, or to the first inertia where there is no mesh."""
    (speeds,) = turning_pieces([inertia.name for inertia in train.inertias], train.shafts, train.meshes)
    reference = speeds[train.meshes[0].pinion] if train.meshes else 1.0
    return {name: speed / reference for name, speed in speeds.items()}


def check_train(train: Train) -> None:
    """Raise ParameterError or GeometryError unless the parts make one train."""
    if not train.inertias:
        raise ParameterError("inertias", (), "must hold one inertia at least")
    for kind, parts in (("inertias", train.inertias), ("shafts", train.shafts), ("meshes", train.meshes)):
        twice = [name for name, count in Counter(part.name for part in parts).items() if count > 1]
        if twice:
            raise ParameterError(f"{kind}.name", twice[0], "names must differ")
    _check_names(train)
    _check_pieces(train)
    if train.model.value == "isolated" and not train.meshes:
        raise GeometryError("model", train.model, "a train without meshes has nothing that is left without shafts")
    if not train.held:
        _check_balance(train)


def _check_names(train: Train) -> None:
    """Both ends of everything are known, and differ."""
    names = [inertia.name for inertia in train.inertias]
    known = f"must be one of the inertias {', '.join(names)}"
    for shaft in train.shafts:
        for parameter in ("start", "end"):
            if (end := getattr(shaft, parameter)) not in (*names, GROUND):
                raise ParameterError(f"{shaft.name}.{parameter}", end, f'{known}, or "{GROUND}"')
        if shaft.start == shaft.end:
            raise GeometryError(
                f"{shaft.name}.end", shaft.end, "must differ from start: a shaft joins two inertias or holds one"
            )
    for mesh in train.meshes:
        for parameter in ("pinion", "wheel"):
            if (gear := getattr(mesh, parameter)) not in names:
                raise ParameterError(f"{mesh.name}.{parameter}", gear, known)
        if mesh.pinion == mesh.wheel:
            raise GeometryError(f"{mesh.name}.wheel", mesh.wheel, "must differ from pinion")
    for name in train.torques:
        if name not in names:
            raise ParameterError("torques", name, known)


def _check_pieces(train: Train) -> None:
    """Everything hangs together."""
    names = [inertia.name for inertia in train.inertias]
    ends = {end for shaft in train.shafts for end in (shaft.start, shaft.end)}
    gears = {gear for mesh in train.meshes for gear in (mesh.pinion, mesh.wheel)}
    for name in names:
        if name not in ends | gears:
            raise GeometryError("inertias", name, "has neither a shaft nor a mesh: give it one, or leave it out")
    pieces = turning_pieces(names, train.shafts, train.meshes)
    if len(pieces) > 1:
        parts = " | ".join(", ".join(piece) for piece in pieces)
        permitted = f"does not hang together with the rest ({parts}): join the pieces by a shaft or a mesh"
        raise GeometryError("inertias", next(iter(pieces[1])), permitted)


def _check_balance(train: Train) -> None:
    """Torques on a train that nothing holds, each reflected to the reference, leave nothing that would speed it up."""
    ratios = speed_ratios(train)
    reflected = [torque * ratios[name] for name, torque in train.torques.items()]
    left = math.fsum(reflected)
    if reflected and abs(left) > _BALANCED * max(abs(torque) for torque in reflected):
        reference = train.meshes[0].pinion if train.meshes else train.inertias[0].name
        permitted = f"on {reference}, the sum of all, must be 0 on a train that no shaft holds: balance them, or hold it"
        raise GeometryError("torques", left, permitted, "N·m")
