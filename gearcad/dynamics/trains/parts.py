"""What of a train takes part in a model: numbers in SI units, flanks that press where the torques press them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats
from gearcad.dynamics.trains.engaged_mesh import require_known
from gearcad.dynamics.trains.graph import turning_pieces
from gearcad.dynamics.trains.members import GROUND, Inertia, Mesh, Shaft
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.errors import GeometryError

__all__ = ["Parts", "parts_of", "pressing_forces", "require_pressed", "static_forces"]


_NO_FORCE = 1e-9
"""Of the greatest mesh force: rounding, which must not turn flanks round."""


@dataclass(frozen=True, eq=False)
class Parts:
    """`inertia` (i,) in kg·m², `approach` (i, m) in m/rad of each mesh, `stiffness` (m,) in N/m, `torque` (i,) in N·m on each
    inertia, of preloads too. `free` (i, r): speeds of each of r pieces that no shaft holds."""

    inertias: tuple[Inertia, ...]
    shafts: tuple[Shaft, ...]
    meshes: tuple[Mesh, ...]
    inertia: Floats
    approach: Floats
    stiffness: Floats
    torque: Floats
    free: Floats

    @property
    def ends(self) -> NDArray[np.int64]:
        """(s, 2): the places of each shaft's ends among the inertias, -1 for ground."""
        places = {inertia.name: place for place, inertia in enumerate(self.inertias)} | {GROUND: -1}
        return np.array([(places[s.start], places[s.end]) for s in self.shafts], dtype=np.int64).reshape(-1, 2)


def _whole_train(train: Train) -> Parts:
    """With all shafts, whatever the model. The approach of a mesh is positive where its flanks are pressed."""
    parts = _parts(train)
    parts = _turned(parts, _mesh_forces(parts))
    parts = replace(parts, torque=parts.torque + parts.approach @ _preloads(train))
    # Once more, for meshes that the torques leave alone: another's preload may turn them round.
    return _turned(parts, _mesh_forces(parts))


def parts_of(train: Train) -> Parts:
    """Those of the train's model: isolated meshes carry the forces that torques give them in the whole train."""
    if train.model is not TrainModel.ISOLATED:
        return _whole_train(train)
    whole = _parts(train)
    forces = _mesh_forces(whole)
    whole = _turned(whole, forces)
    geared = [place for place, row in enumerate(whole.approach) if row.any()]
    inertias = tuple(whole.inertias[place] for place in geared)
    return replace(
        whole,
        inertias=inertias,
        shafts=(),
        inertia=whole.inertia[geared],
        approach=whole.approach[geared],
        torque=whole.approach[geared] @ (np.abs(forces) + _preloads(train)),
        free=_free_turns(inertias, (), whole.meshes),
    )


def static_forces(train: Train) -> Floats:
    """(m,) the mean force in every mesh (N), with torques and preloads at rest."""
    return np.abs(_mesh_forces(parts_of(train)))


def require_pressed(train: Train) -> None:
    """Raise GeometryError for a mesh whose flanks nothing presses: loads over speed refer to that force."""
    forces = static_forces(train)
    if forces.min() <= _NO_FORCE * forces.max():
        mesh = train.meshes[int(forces.argmin())]
        permitted = "must be above 0 where no torque presses the flanks of this mesh: K_v refers to that force"
        raise GeometryError(f"{mesh.name}.preload", mesh.preload, permitted, "N")


def pressing_forces(train: Train) -> Floats:
    """(m,) the same with their signs: positive where a torque that is counter-clockwise on the pinion presses the flanks."""
    parts = parts_of(train)
    places = [inertia.name for inertia in parts.inertias]
    turned = [parts.approach[places.index(mesh.pinion), column] for column, mesh in enumerate(parts.meshes)]
    return np.copysign(_mesh_forces(parts), turned)


def _parts(train: Train) -> Parts:
    """The whole train under its torques alone; approach as both gears turn counter-clockwise."""
    names = [inertia.name for inertia in train.inertias]
    approach = np.zeros((len(names), len(train.meshes)))
    for column, mesh in enumerate(train.meshes):
        require_known(mesh)
        for gear, radius in zip(mesh.gears, mesh.radii, strict=True):
            approach[names.index(gear), column] = radius
    return Parts(
        inertias=train.inertias,
        shafts=train.shafts,
        meshes=train.meshes,
        inertia=np.array([inertia.inertia for inertia in train.inertias]),
        approach=approach,
        stiffness=np.array([mesh.stiffness * 1e6 for mesh in train.meshes]),
        torque=np.array([train.torques.get(name, 0.0) for name in names]),
        free=_free_turns(train.inertias, train.shafts, train.meshes),
    )


def _preloads(train: Train) -> Floats:
    """What presses each mesh (m,) beside the torques, in N."""
    return np.array([mesh.preload for mesh in train.meshes])


def _free_turns(inertias: Sequence[Inertia], shafts: Sequence[Shaft], meshes: Sequence[Mesh]) -> Floats:
    """(i, r): speeds of the inertias of each piece that turns as a whole."""
    names = [inertia.name for inertia in inertias]
    held = {end for shaft in shafts if shaft.held for end in (shaft.start, shaft.end)}
    pieces = [piece for piece in turning_pieces(names, shafts, meshes) if not held & piece.keys()]
    return np.array([[piece.get(name, 0.0) for piece in pieces] for name in names]).reshape(len(names), len(pieces))


def _mesh_forces(parts: Parts) -> Floats:
    """(m,) of the static train with massless shafts (N); what turns freely is held where it is."""
    k = (parts.approach * parts.stiffness) @ parts.approach.T
    for shaft, ends in zip(parts.shafts, parts.ends, strict=True):
        twist = np.zeros(len(k))
        twist[[end for end in ends if end >= 0]] = [sign for end, sign in zip(ends, (-1.0, 1.0), strict=True) if end >= 0]
        k += shaft.stiffness * np.outer(twist, twist)
    turns = parts.free / np.linalg.norm(parts.free, axis=0)
    k += np.trace(k) / len(k) * turns @ turns.T
    result: Floats = parts.stiffness * (parts.approach.T @ np.linalg.solve(k, parts.torque))
    return result


def _turned(parts: Parts, forces: Floats) -> Parts:
    """With the approach turned round where the other flanks carry."""
    other = forces < -_NO_FORCE * np.abs(forces).max(initial=0.0)
    return replace(parts, approach=parts.approach * np.where(other, -1.0, 1.0))
