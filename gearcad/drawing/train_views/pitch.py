"""The pitch circles of a train's gears: the working ones, which touch at any centre distance."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.geometry import GearPair
from gearcad.per_gear import Role
from gearcad.planetary import PlanetaryTrain
from gearcad.solids.train_layout import stage_keys

__all__ = ["meshes_of", "pitch_radii"]

_DIGITS = 9


def pitch_radii(train: PlanetaryTrain, key: str) -> tuple[float, ...]:
    """Radii (mm) of the working pitch circles of a gear; a planet has one with each of its mates, unless they are one."""
    radii = [abs(pair.working_pitch_diameters.pick(role)) / 2 for pair, role in meshes_of(train, key)]
    return tuple(dict.fromkeys(round(radius, _DIGITS) for radius in radii))


def meshes_of(train: PlanetaryTrain, key: str) -> Iterator[tuple[GearPair, Role]]:
    """The pairs that a gear is part of, and as which of the two."""
    for mesh in train.meshes:
        if key == mesh.central.name:
            yield mesh.pair, mesh.central_role
        elif key == mesh.rim.name:
            yield mesh.pair, mesh.rim_role
    for stage, keys in zip(train.stages, stage_keys(train), strict=True):
        yield from ((stage.pair, role) for role, name in keys.items() if name == key)
