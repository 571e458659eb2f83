"""What displaces the springs of a planetary train besides its torque: errors, run-out, and what stages push across the axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.springs import SpringKind, TrainSprings
from gearcad.dynamics.planetary.stage_forces import stage_forces
from gearcad.planetary import Carrier, Central, PlanetaryTrain
from gearcad.planetary.power import PowerFlow
from gearcad.planetary.shafts import shafts_of

__all__ = ["Turning", "gaps", "set_members", "turning_and_standing"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Turning:
    """What turns against the carrier: gaps (2, m) in µm and loads (2, n) in N, times cosine and sine of the angle.

    It turns with the member `follows`, or stands in space where that is None. `name` says what it is.
    """

    name: str
    follows: str | None
    gap: Floats
    load: Floats


def set_members(train: PlanetaryTrain) -> tuple[Carrier | Central, ...]:
    """Carrier, then centrals, as springs have them."""
    return (train.carrier, *train.centrals)


def gaps(train: PlanetaryTrain, springs: TrainSprings, sense: int) -> Floats:
    """(m,) in µm: pins that yield to the first central open their springs, teeth that stand proud close theirs.

    The errors of a rim that meshes with both centrals count in the first mesh: the planet turns until both share them.
    """
    gap, told = np.zeros(len(springs.springs)), set()
    if train.carrier.pin_errors:
        gap[springs.select(SpringKind.PIN_TANGENTIAL)] = -sense * np.array(train.carrier.pin_errors)
    for mesh in train.meshes:
        if mesh.rim.tooth_errors and mesh.rim.name not in told:
            gap[springs.select(SpringKind.MESH, mesh.name)] = -np.array(mesh.rim.tooth_errors)
        told.add(mesh.rim.name)
    return gap


def turning_and_standing(train: PlanetaryTrain, springs: TrainSprings, flow: PowerFlow) -> tuple[tuple[Turning, ...], Floats]:
    """All that turns against the carrier, and forces (n,) across the axis that stand still against it."""
    across, turning = _stages_across(train, springs, flow), []
    none = np.zeros_like(across)
    standing = train.fixed is not None and shafts_of(train)[train.fixed].member == train.carrier.name
    if across.any() and not standing:
        turning.append(Turning(name="forces of stages", follows=None, gap=np.zeros((2, len(springs.springs))), load=across))
    for member in set_members(train):
        gap = _run_out(train, springs, member.name) * member.run_out
        if gap.any():
            turning.append(Turning(name=f"run-out of {member.name}", follows=member.name, gap=gap, load=none))
    return tuple(turning), across[0] if standing else none[0]


def _stages_across(train: PlanetaryTrain, springs: TrainSprings, flow: PowerFlow) -> Floats:
    """(2, n) in N: what stages push across the axis, times cosine and sine of how far space turns against the carrier."""
    found = np.zeros((2, springs.vectors.shape[1]))
    for member, (along_x, along_y) in stage_forces(train, flow).items():
        x, y = _across(springs, member)
        found += [along_x * x + along_y * y, along_x * y - along_y * x]
    return found


def _run_out(train: PlanetaryTrain, springs: TrainSprings, member: str) -> Floats:
    """(2, m): gaps for an eccentricity of 1 µm: of a central's teeth in its mesh, of the carrier in its bearing."""
    found = np.zeros((2, len(springs.springs)))
    for axis, along in enumerate(_across(springs, member)):
        for mesh in train.meshes:
            if mesh.central.name == member:
                places = springs.select(SpringKind.MESH, mesh.name)
                found[axis, places] = -springs.vectors[places] @ along
        if member == train.carrier.name:
            places = springs.select((SpringKind.SUPPORT_X, SpringKind.SUPPORT_Y)[axis], member)
            found[axis, places] = 1.0
    return found


def _across(springs: TrainSprings, member: str) -> Floats:
    """(2, n): x and y of a member."""
    place = 3 * springs.members.index(member)
    return springs.basis[place : place + 2]
