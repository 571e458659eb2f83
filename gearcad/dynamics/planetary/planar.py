"""PlanarTrain: what of a planetary train its planar model knows, in SI units."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.errors import ParameterError
from gearcad.planetary import Carrier, Central, PlanetaryTrain, SetMesh
from gearcad.planetary.shafts import shafts_of

__all__ = ["MeshLine", "PlanarMember", "PlanarTrain", "held_members", "planar_train"]

_MICRO = 1e6
"""N/m in a N/µm."""


@dataclass(frozen=True, kw_only=True)
class PlanarMember:
    """A central or the carrier: `radius` (m) by which its turn counts, base radius or that of the pins.

    `support` (N/m) on x and y and `torsion` (N/m) on u, which is the turn times the radius: None holds it, 0 leaves it free.
    """

    name: str
    radius: float
    support: float | None
    torsion: float | None


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshLine:
    """How a central presses the planets: `pressure_angle` (rad) of the line of action, `stiffness` (N,) of each mesh in N/m.

    `rim_ratio` is the base radius of its rim over that of the first mesh's. `sense` is 1 where the torque on the central turns
    it counter-clockwise against the planets, -1 where the other flanks carry.
    """

    name: str
    external: bool
    pressure_angle: float
    stiffness: Floats
    rim_ratio: float = 1.0
    sense: int = 1


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanarTrain:
    """Planets at `angles` (N,) in rad on a carrier between two centrals; `members` are carrier, then centrals.

    `pin` is the stiffness (N/m) of a pin in either direction, None where it is rigid; `planet_radius` (m) the base radius by
    which a planet's turn counts.
    """

    angles: Floats
    members: tuple[PlanarMember, PlanarMember, PlanarMember]
    meshes: tuple[MeshLine, MeshLine]
    pin: float | None
    planet_radius: float

    @property
    def planets(self) -> int:
        """How many there are."""
        return len(self.angles)


def planar_train(
    train: PlanetaryTrain,
    mesh_stiffness: tuple[ArrayLike, ArrayLike],
    *,
    held: Collection[str] | None = None,
    sense: int = 1,
) -> PlanarTrain:
    """The train with `mesh_stiffness` (N/µm) of each mesh: of one planet as of all, or (N,) of each.

    `held` members cannot turn where they have no torsional stiffness: by default what `fixed` holds. The torque on the first
    central is counter-clockwise with `sense` 1, clockwise with -1. Lengths are those of the transverse section. Raises
    ParameterError.
    """
    held = held_members(train) if held is None else held
    if unknown := set(held) - set(train.members):
        raise ParameterError("held", min(unknown), f"must be of {', '.join(train.members)}")
    if sense not in (1, -1):
        raise ParameterError("sense", sense, "must be 1 or -1")
    a, b = train.meshes
    distance = float(train.centre_distance) / 1000
    senses = sense, sense if train.basic_ratio < 0 else -sense
    return PlanarTrain(
        angles=np.array([math.radians(angle) for angle in train.angles]),
        members=(
            _member(train.carrier, distance, held),
            _member(a.central, a.central_base_radius / 1000, held),
            _member(b.central, b.central_base_radius / 1000, held),
        ),
        meshes=(
            _line(a, train, mesh_stiffness[0], a.rim_base_radius, senses[0]),
            _line(b, train, mesh_stiffness[1], a.rim_base_radius, senses[1]),
        ),
        pin=None if train.carrier.pin_stiffness is None else _MICRO * train.carrier.pin_stiffness,
        planet_radius=a.rim_base_radius / 1000,
    )


def held_members(train: PlanetaryTrain) -> tuple[str, ...]:
    """What the fixed shaft holds: the member itself, or that which it is geared to by stages."""
    return () if train.fixed is None else (shafts_of(train)[train.fixed].member,)


def _member(member: Carrier | Central, radius: float, held: Collection[str]) -> PlanarMember:
    support, torsion = member.support_stiffness, member.torsional_stiffness
    rigid = None if member.name in held else 0.0
    return PlanarMember(
        name=member.name,
        radius=radius,
        support=None if support is None else _MICRO * support,
        torsion=rigid if torsion is None else torsion / radius**2,
    )


def _line(mesh: SetMesh, train: PlanetaryTrain, stiffness: ArrayLike, reference: float, sense: int) -> MeshLine:
    values = np.array(stiffness, float)
    if values.shape not in ((), (train.planets,)):
        raise ParameterError(
            "mesh_stiffness", values.shape, f"must be a number, or one for each of {train.planets} planets", "N/µm"
        )
    if not np.isfinite(values).all() or values.min() <= 0:
        raise ParameterError("mesh_stiffness", float(values.min()), f"of {mesh.name} must be above 0 N/µm", "N/µm")
    return MeshLine(
        name=mesh.name,
        external=mesh.external,
        pressure_angle=mesh.working_pressure_angle,
        stiffness=np.broadcast_to(_MICRO * values, train.planets),
        rim_ratio=mesh.rim_base_radius / reference,
        sense=sense,
    )
