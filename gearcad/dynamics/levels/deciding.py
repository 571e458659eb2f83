"""Which shafts and neighbouring stages a coarse model lacks where it fails: by the energies of the reference's natural modes.

At a speed the forces of the teeth load a mesh or a shaft by several modes. What decides is the mode with the most load in a
part that the coarse model does not have, by its share in the energy of that mode: the mass of shafts where they have none, and
without shafts also their springs, and the inertias and meshes behind them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Set
from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.charts.resonances import LEAST_RATIO, quasi_static_spectrum
from gearcad.dynamics.levels.agreement import CurveName, percent
from gearcad.dynamics.response.flexibility import static_state
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.trains.eigenmodes import NaturalModes
from gearcad.dynamics.trains.members import GROUND
from gearcad.dynamics.trains.modes import natural_modes
from gearcad.dynamics.trains.train import Train, TrainModel

__all__ = ["Decision", "Share", "decision"]


_NAMED, _OF_GREATEST = 0.05, 1 / 3
"""Shares that are named: from a twentieth on, and from a third of the greatest; the greatest always."""

_HARMONICS = 16
"""Of the tooth frequencies that are asked what they shake."""

_HARDLY = 0.02
"""Of the greatest load of a mode: those with less do not decide."""

_RIGID = 1e-9
"""Of the greatest square of a natural frequency: what is below turns as a whole."""


class Share(NamedTuple):
    """Of a mode's energy: what part of the train, as what ("mass" or "spring" of a shaft, "inertia" or "mesh"), and how much.

    `through` are the shafts by which that is joined to the mesh in question.
    """

    kind: str
    name: str
    share: float
    through: tuple[str, ...] = ()

    @property
    def part(self) -> str:
        """In words."""
        part = {
            "mass": f'the mass of shaft "{self.name}"',
            "spring": f'the twist of shaft "{self.name}"',
            "inertia": f'inertia "{self.name}"',
            "mesh": f'the neighbouring mesh "{self.name}"',
        }[self.kind]
        behind = " and ".join(f'"{each}"' for each in self.through)
        return f"{part} behind shaft {behind}" if behind else part

    @property
    def energy(self) -> str:
        """That of which it has a share."""
        return "kinetic" if self.kind in ("mass", "inertia") else "potential"

    @property
    def words(self) -> str:
        """As a sentence has it."""
        return f"{percent(self.share)} of its {self.energy} energy in {self.part}"

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {**self._asdict(), "through": list(self.through), "energy": self.energy}


class Decision(NamedTuple):
    """At a `speed` (rpm) a `harmonic` of the tooth frequency of mesh `teeth` shakes natural mode `mode` of the reference (1 is
    the lowest), of so many Hz; `shares`, the greatest first, are what the level lacks of it."""

    curve: CurveName
    speed: float
    teeth: str
    harmonic: float
    mode: int
    frequency: float
    shares: tuple[Share, ...]

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {**self._asdict(), "curve": self.curve._asdict(), "shares": [each.to_dict() for each in self.shares]}


def decision(reference: TrainStudy, level: TrainModel, curve: CurveName, speed: float) -> Decision:
    """What the level lacks at a speed (rpm) where its curve is off that of the reference.

    Of the modes that load the curve it is the one with the most load in a part that the level does not have.
    """
    shaken = _shaken(reference, curve, speed)
    highest = max(each.omega for each in shaken)
    modes = natural_modes(reference.train, up_to=highest / (2 * np.pi) * (1 + 1e-6))
    found = []
    for each in shaken:
        mode = int(np.abs(modes.circular - each.omega).argmin())
        lacking = sorted(_lacking(reference.train, modes, mode, level, curve), key=lambda share: -share.share)
        found.append((each.load * (lacking[0].share if lacking else 0.0), mode, each, lacking))
    _, mode, most, lacking = max(found, key=lambda each: each[0])
    return Decision(
        curve=curve,
        speed=speed,
        teeth=reference.up.mesh_names[most.teeth],
        harmonic=most.order / reference.excitation.orders[most.teeth],
        mode=mode + 1,
        frequency=float(modes.frequency[mode]),
        shares=_named(lacking),
    )


def _named(shares: list[Share]) -> tuple[Share, ...]:
    """The greatest, and those that are not far below."""
    least = max(_NAMED, _OF_GREATEST * shares[0].share) if shares else 0.0
    return tuple(each for place, each in enumerate(shares) if place == 0 or each.share >= least)


# ---------------------------------------------------------------------- what vibrates


class _Shaken(NamedTuple):
    """A mode of natural frequency `omega` (1/s): how far it loads a curve, at which order of the common period, and the mesh
    that shakes it so."""

    omega: float
    load: float
    order: int
    teeth: int


def _shaken(study: TrainStudy, curve: CurveName, speed: float) -> list[_Shaken]:
    """The modes that load a curve, but those that hardly do.

    Forces are those with which the changing stiffness and the errors of the teeth act on a train that does not vibrate; what
    they would load at rest is left out.
    """
    system, excitation = study.system, study.excitation.bonded
    squares, shapes = np.linalg.eigh(system.stiffness_matrix())
    elastic = squares > _RIGID * squares.max()
    squares, shapes = squares[elastic], shapes[:, elastic]
    damping = np.einsum("nr,nk,kr->r", shapes, system.damping_matrix(), shapes)
    forces = quasi_static_spectrum(system, excitation, static_state(system))[1 : 1 + _HARMONICS * max(excitation.orders)]
    driven = forces[:, None, :] * (shapes.T @ system.mesh)
    rate = excitation.fundamental * speed * np.pi * study.train.meshes[0].teeth / 30
    omega = rate * np.arange(1, len(forces) + 1)[:, None]
    damped = np.maximum(damping, 2 * LEAST_RATIO * np.sqrt(squares))
    receptance = 1 / (squares - omega**2 + 1j * damped * omega) - 1 / squares
    load = np.abs(driven.sum(axis=2) * receptance) * np.abs(shapes.T @ _loaded(study, curve))
    orders, most = load.argmax(axis=0), load.max(axis=0)
    return [
        _Shaken(float(np.sqrt(squares[r])), float(most[r]), int(orders[r]) + 1, int(np.abs(driven[orders[r], r]).argmax()))
        for r in np.flatnonzero(most >= _HARDLY * most.max())
    ]


def _loaded(study: TrainStudy, curve: CurveName) -> Floats:
    """(n,): the load of a curve (N or N·m) when each coordinate is 1."""
    system = study.system
    if curve.kind == "mesh":
        column = system.names[0].index(curve.name)
        return np.asarray(system.mesh[:, column] * system.stiffness[column], float)
    return system.shaft_torques[:, system.names[2].index(curve.name)]


# ---------------------------------------------------------------------- what is lacking


def _lacking(train: Train, modes: NaturalModes, mode: int, level: TrainModel, curve: CurveName) -> Iterator[Share]:
    """Shares of a mode of the reference in what the level does not have, of each shaft the greater of mass and spring."""
    isolated = level is TrainModel.ISOLATED
    for name, moving, bent in zip(modes.shafts, modes.kinetic_shafts[mode], modes.potential_shafts[mode], strict=True):
        if isolated and bent > moving:
            yield Share("spring", name, float(bent))
        else:
            yield Share("mass", name, float(moving))
    if not isolated:
        return
    own = _own_gears(train, curve.name)
    behind = _shafts_between(train, own)
    for name, moving in zip(modes.inertias, modes.kinetic_inertias[mode], strict=True):
        if name not in own:
            yield Share("inertia", name, float(moving), behind[name])
    for mesh, bent in zip(train.meshes, modes.potential_meshes[mode], strict=True):
        if mesh.pinion not in own:
            yield Share("mesh", mesh.name, float(bent), min(behind[mesh.pinion], behind[mesh.wheel], key=len))


def _own_gears(train: Train, mesh: str) -> set[str]:
    """The gears of a mesh, and those that mesh with them: what vibrates together without shafts."""
    own = set[str]()
    for each in train.meshes:
        if each.name == mesh:
            own |= set(each.gears)
    while more := {gear for each in train.meshes if own & set(each.gears) for gear in each.gears} - own:
        own |= more
    return own


def _shafts_between(train: Train, own: Set[str]) -> dict[str, tuple[str, ...]]:
    """Of every inertia the shafts by which it is joined to the `own` gears, on the way with the fewest parts."""
    ways: dict[str, tuple[str, ...]] = dict.fromkeys(sorted(own), ())
    waiting = deque(ways)
    while waiting:
        here = waiting.popleft()
        beside = [(shaft.name, {shaft.start, shaft.end}) for shaft in train.shafts if not shaft.held]
        beside += [("", set(mesh.gears)) for mesh in train.meshes]
        for name, ends in beside:
            for there in sorted(ends - {here, GROUND}) if here in ends else ():
                if there not in ways:
                    ways[there] = (*ways[here], name) if name else ways[here]
                    waiting.append(there)
    return ways
