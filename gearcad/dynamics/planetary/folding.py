"""Planets that do the same at the same time, taken for one: what vibrates is then a few meshes, however many planets there are.

Where planets are alike, at equal angles and in phase - all of them, or every second, every third ... - what they do comes again
after that part of a turn. Carrier and centrals then only turn.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from gearcad.arrays import Floats, Indices
from gearcad.dynamics.planetary.planar import PlanarTrain
from gearcad.dynamics.planetary.springs import TrainSprings, all_coordinates
from gearcad.planetary import MeshPhases

__all__ = ["fold", "meshes_of_all", "planets_alike"]

_SAME = 1e-9
"""Relative, or of a base pitch: rounding."""


def planets_alike(planar: PlanarTrain, phases: Mapping[str, MeshPhases]) -> int:
    """How many planets do what planet 0 does: the n-th, the 2 n-th ... after it; 1 where it is the only one."""
    count = planar.planets
    return max(count // step for step in range(1, count + 1) if count % step == 0 and _comes_again(planar, phases, step))


def _comes_again(planar: PlanarTrain, phases: Mapping[str, MeshPhases], step: int) -> bool:
    """Whether all is the same so many planets on."""

    def later(values: Floats) -> Floats:
        return np.roll(values, -step) - values

    turns = [later(planar.angles) / (2 * np.pi) - step / planar.planets]
    turns += [later(np.array(phases[line.name].ahead)) for line in planar.meshes]
    stiffer = max(float(np.abs(later(line.stiffness) / line.stiffness).max()) for line in planar.meshes)
    return stiffer < _SAME and all(np.abs(each - np.round(each)).max() < _SAME for each in turns)


def fold(springs: TrainSprings, alike: int) -> TrainSprings:
    """The first planets of each kind, each with the springs and the masses of `alike` of them."""
    if alike == 1:
        return springs
    kept = springs.planar.planets // alike
    spread, names = _spread(springs, kept)
    vectors = springs.vectors @ spread
    rows = [
        row for row, each in enumerate(springs.springs) if (each.planet is None or each.planet < kept) and vectors[row].any()
    ]
    many = [1 if springs.springs[row].planet is None else alike for row in rows]
    return TrainSprings(
        planar=springs.planar,
        springs=tuple(springs.springs[row] for row in rows),
        vectors=vectors[rows],
        stiffness=springs.stiffness[rows] * np.array(many, float),
        coordinates=tuple(names),
        basis=springs.basis @ spread,
    )


def meshes_of_all(planets: int, alike: int) -> Indices:
    """(2 N,): which of the meshes of the first planets of each kind does what each mesh of all planets does."""
    kept = planets // alike
    return np.concatenate([np.tile(np.arange(kept), alike), np.tile(np.arange(kept, 2 * kept), alike)])


def _spread(springs: TrainSprings, kept: int) -> tuple[Floats, list[str]]:
    """All coordinates (n, f) of those of the kept planets and the turns of the members, and the names of these."""
    every = all_coordinates(springs.planar)
    places = [every.index(name) for name in springs.coordinates]
    leaders = [place if place < 9 else 9 + (place - 9) % (3 * kept) for place in places]
    moving = [place >= 9 or place % 3 == 2 for place in places]
    columns = [each for each, leader, moves in zip(places, leaders, moving, strict=True) if each == leader and moves]
    spread = np.array([[float(leader == column) for column in columns] for leader in leaders])
    return spread, [every[column] for column in columns]
