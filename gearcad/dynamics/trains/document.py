"""What a train says of itself before anything vibrates: speeds, stiffness, inertia, and what its meshes carry at rest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from enum import Enum
from typing import Any

from gearcad.dynamics.trains.members import Inertia, Mesh, Shaft
from gearcad.dynamics.trains.mesh_pair import MeshPair
from gearcad.dynamics.trains.parts import static_forces
from gearcad.dynamics.trains.train import Train

__all__ = ["train_document"]


def train_document(train: Train) -> dict[str, Any]:
    """Inputs and derived quantities of a train and its parts, under the keys of tables; lengths in mm, otherwise SI.

    Speeds (rpm) and tooth frequencies (Hz) are there where `train.speed` is given. Forces (N) are the mean ones of the model.
    Of a pair under no load yet there is its name, but no stiffness, and no forces in its train.
    """
    own = {key: _plain(value) for key, value in _fields(train).items() if key not in ("name", "inertias", "shafts", "meshes")}
    forces = static_forces(train).tolist() if not _waiting(train) else [None] * len(train.meshes)
    return {
        "train": own | {"held": train.held},
        "inertia": {each.name: _of_inertia(train, each) for each in train.inertias},
        "shaft": {each.name: _of_shaft(each) for each in train.shafts},
        "mesh": {each.name: _of_mesh(train, each, force) for each, force in zip(train.meshes, forces, strict=True)},
    }


def _waiting(train: Train) -> bool:
    """Whether static forces are not known: there are no meshes, or pairs whose stiffness depends on them."""
    return not train.meshes or any(mesh.pair is not None and math.isnan(mesh.stiffness) for mesh in train.meshes)


def _fields(part: Any) -> dict[str, Any]:
    return {each.name: _plain(getattr(part, each.name)) for each in fields(part) if each.name != "name"}


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, MeshPair):
        return value.pair.name
    if isinstance(value, float):
        return None if math.isnan(value) else float(value)
    if isinstance(value, int) and not isinstance(value, bool):
        return int(value)
    return value.value if isinstance(value, Enum) else list(value) if isinstance(value, tuple) else value


def _of_inertia(train: Train, inertia: Inertia) -> dict[str, Any]:
    ratio = train.speed_ratios[inertia.name]
    speed = {"speed": ratio * train.speed} if train.speed else {}
    return {**_fields(inertia), "speed_ratio": ratio, **speed, "torque": train.torques.get(inertia.name, 0.0)}


def _of_shaft(shaft: Shaft) -> dict[str, Any]:
    """Stiffness and inertia also of a shaft that is given by its shape."""
    return {**_fields(shaft), "torsional_stiffness": shaft.stiffness, "inertia": shaft.inertia}


def _of_mesh(train: Train, mesh: Mesh, force: float | None) -> dict[str, Any]:
    """1/m_red = sum of r_b²/J of both gears, whatever else hangs on them; the natural frequency is that of both alone."""
    inertias = {each.name: each.inertia for each in train.inertias}
    reduced = 1 / sum(radius**2 / inertias[gear] for gear, radius in zip(mesh.gears, mesh.radii, strict=True))
    speed = {"tooth_frequency": train.tooth_frequencies[mesh.name]} if train.speed else {}
    of_waves = () if mesh.pair is None else ("variation", "shape", "contact_ratio")  # a pair has a stiffness of its own
    return {
        **{key: value for key, value in _fields(mesh).items() if key not in of_waves},
        "gear_ratio": mesh.base_radii.wheel / mesh.base_radii.pinion,
        "reduced_mass": reduced,
        "natural_frequency": _plain(math.sqrt(mesh.stiffness * 1e6 / reduced) / (2 * math.pi)),
        **speed,
        "static_force": force,
    }
