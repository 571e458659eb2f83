"""Load sharing of planets, quasi-static: with errors of pins and teeth, run-out, and members that float."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Floats, JsonObject, Notice, texts
from gearcad.dynamics.planetary.planetary_statics import TrainStatics, planar_notices, train_statics
from gearcad.dynamics.planetary.planetary_strength import PublishedFactor, published_factors
from gearcad.planetary import PlanetaryTrain, TrainLoad

_POINTS = (1, 360, 60, 24, 12)
"""Angles of the grid over a turn, by the number of parts that turn."""

SMALLEST_STEP = 1e-4
"""Steps (rad) at which the search ends: near a maximum, a hundred-millionth of the part that turns."""

_CASES = 4096
"""Cases that are computed together, to limit memory."""


def grid_points(turning: int) -> int:
    """Return the number of angles of the grid over a turn of each of `turning` parts."""
    return _POINTS[turning]


def greatest(quantities: Callable[[Floats], Floats], turning: int) -> tuple[Floats, Floats]:
    """Return the greatest (k,) of the `quantities` (s, k) at angles (s, turning) in rad, and the angles (k, turning) there."""
    grid = 2 * np.pi * np.array(list(product(range(grid_points(turning)), repeat=turning))) / grid_points(turning)
    values = np.vstack([quantities(grid[start : start + _CASES]) for start in range(0, len(grid), _CASES)])
    best = values.argmax(axis=0)
    angles, found = grid[best], values.max(axis=0)
    if not turning:
        return found, angles
    step = np.full(len(found), np.pi / grid_points(turning))
    around = np.vstack([np.eye(turning), -np.eye(turning)])
    while (step > SMALLEST_STEP).any():
        tried = angles[:, None] + step[:, None, None] * around
        values = quantities(tried.reshape(-1, turning)).reshape(len(found), len(around), len(found))
        own = np.einsum("kak->ka", values)
        better = own.max(axis=1) > found
        angles = np.where(better[:, None], tried[np.arange(len(found)), own.argmax(axis=1)], angles)
        found = np.where(better, own.max(axis=1), found)
        step = np.where(better, step, step / 2)
    return found, angles


_UNLOADED = 1e-9
"""Share of the mean load below which a planet counts as unloaded."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshLoads:
    """Forces (N,) in N of a mesh along the line of action, in the transverse section, by planets.

    `force` is without run-out and forces of stages, which turn; `greatest` and `least` are over all turns.
    """

    force: Floats
    greatest: Floats
    least: Floats

    def to_dict(self) -> JsonObject:
        """Return plain lists for JSON."""
        return {name: value.tolist() for name, value in vars(self).items()}


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanetPins:
    """Forces (N,) in N of the planets on their pins, outwards and counter-clockwise; `greatest` size over all turns."""

    radial: Floats
    tangential: Floats
    greatest: Floats

    def to_dict(self) -> JsonObject:
        """Return plain lists for JSON."""
        return {name: value.tolist() for name, value in vars(self).items()}


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadSharing:
    """Load sharing of the planets of a train; losses are left out.

    Shares are 1 where all planets carry the same, and alike in both meshes, as each planet is in balance by itself. `shares`
    (N,) are without what turns. `greatest_shares` and `least_shares` (N,) are over all turns, where each of `turning` - run-out
    of members, forces of stages - stands at whatever angle is worst. `displacements` {member: (x, y)} in µm, seen from the
    carrier with planet 0 on +x, are without what turns; `excursions` {member: µm} are the greatest distances over all turns.
    `unloaded` are planets (from 0) that carry nothing at some angle.
    """

    train: PlanetaryTrain
    shares: Floats
    greatest_shares: Floats
    least_shares: Floats
    meshes: Mapping[str, MeshLoads]
    pins: PlanetPins
    displacements: Mapping[str, tuple[float, float]]
    excursions: Mapping[str, float]
    turning: tuple[str, ...]
    undetermined: tuple[str, ...]

    @property
    def mesh_load_factor(self) -> float:
        """K_gamma = N max F/F: the greatest share of a planet over all turns."""
        return float(self.greatest_shares.max())

    @property
    def unloaded(self) -> tuple[int, ...]:
        """Numbers (from 0) of the planets that are unloaded at some angle."""
        return tuple(int(planet) for planet in np.flatnonzero(self.least_shares <= _UNLOADED))

    @property
    def published(self) -> tuple[PublishedFactor, ...]:
        """Published values of K_gamma for the number of planets, whatever their errors."""
        return published_factors(self.train.planets)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before the load sharing is used."""
        found = [*planar_notices(self.train)]
        if self.unloaded:
            planets = ", ".join(str(planet + 1) for planet in self.unloaded)
            at = "" if (self.shares[list(self.unloaded)] <= _UNLOADED).all() else " at some angles of what turns"
            found.append(
                Notice("planet-unloaded", f"planets without contact{at}: {planets}; errors exceed what the load bends")
            )
        if self.undetermined:
            names = " and ".join(self.undetermined)
            verb = "float" if len(self.undetermined) > 1 else "floats"
            text = f"nothing decides where {names} {verb}: forces do not depend on it, and the least displacements are shown"
            found.append(Notice("position-undetermined", text))
        if self.turning:
            steps = 360 / grid_points(len(self.turning))
            text = (
                f"the greatest over all angles of {', '.join(self.turning)}, each by itself, sought in steps of {steps:g} deg"
                f" and round the best of them down to {np.degrees(SMALLEST_STEP):.2g} deg"
            )
            found.append(Notice("over-all-turns", text))
        if recalled := [each.source for each in self.published if each.recalled]:
            text = f"K_gamma of {', '.join(recalled)} is recalled, not read in the source: verify it before it decides"
            found.append(Notice("published-to-verify", text))
        return tuple(notice.within("load sharing") for notice in found)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> JsonObject:
        """Return the load sharing as a part of `planetary.json`."""
        return {
            "mesh_load_factor": self.mesh_load_factor,
            "published": [each.to_dict() for each in self.published],
            "shares": self.shares.tolist(),
            "greatest_shares": self.greatest_shares.tolist(),
            "least_shares": self.least_shares.tolist(),
            "meshes": {name: loads.to_dict() for name, loads in self.meshes.items()},
            "pins": self.pins.to_dict(),
            "displacements": {name: list(place) for name, place in self.displacements.items()},
            "excursions": dict(self.excursions),
            "unloaded": list(self.unloaded),
            "turning": list(self.turning),
            "notices": [notice.to_dict() for notice in self.notices],
        }


def share_load(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: Mapping[str, ArrayLike],
    given_speeds: Mapping[str, float] | None = None,
) -> LoadSharing:
    """Return the load sharing of a train with `stiffness` (N/µm) of each mesh by its name.

    A stiffness is one for all planets, or (N,) of each. Raises ParameterError without torque, GeometryError where members float
    that carry nothing across the axis, SolverError where planets would have to pull.
    """
    statics = train_statics(train, load, stiffness, given_speeds)
    state = statics.state()
    displaced, count = statics.places(state)[0], train.planets
    most, _ = greatest(lambda angles: _extremes(statics, angles), len(statics.turning))
    upper, lower, pins, places = np.split(most, [2 * count, 4 * count, 5 * count])
    now, upper, lower = state.forces[0, statics.meshes], upper.reshape(2, -1), -lower.reshape(2, -1)
    shares = [values[0] / now[0].mean() for values in (now, upper, lower)]
    radial, tangential = -state.forces[0, statics.pins]
    return LoadSharing(
        train=train,
        shares=shares[0],
        greatest_shares=shares[1],
        least_shares=shares[2],
        meshes={
            mesh.name: MeshLoads(force=now[place], greatest=upper[place], least=lower[place])
            for place, mesh in enumerate(train.meshes)
        },
        pins=PlanetPins(radial=radial, tangential=tangential, greatest=pins),
        displacements={name: (float(x), float(y)) for name, (x, y) in zip(statics.springs.members, displaced, strict=True)},
        excursions={name: float(size) for name, size in zip(statics.springs.members, places, strict=True)},
        turning=tuple(each.name for each in statics.turning),
        undetermined=statics.undetermined,
    )


def _extremes(statics: TrainStatics, angles: Floats) -> Floats:
    """Return the quantities (s, k) whose greatest values are sought, at `angles` (s, t) in rad.

    They are forces of meshes, the same negative, sizes of pin forces (all in N), and sizes of displacements (µm).
    """
    state = statics.state(angles)
    meshes, places = state.forces[:, statics.meshes.ravel()], statics.places(state)
    pins = np.hypot(*(state.forces[:, each] for each in statics.pins))
    return np.hstack([meshes, -meshes, pins, np.hypot(places[..., 0], places[..., 1])])
