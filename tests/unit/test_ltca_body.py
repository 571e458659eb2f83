"""Solid bodies put together from sectors: patches, rigid motions, and condensation against the same body in full."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg

from gearcad import Gear, Material
from gearcad.fea.chain import Cuts
from gearcad.ltca.body import SolidBody, SolidSector, assemble_body
from gearcad.ltca.hexahedra import lame
from gearcad.ltca.swept import SweptMesh, sweep
from gearcad.meshing import MeshSizes
from gearcad.meshing.outline import Side
from gearcad.meshing.quads import mesh_quads

STEEL = Material()
GEAR = Gear(teeth=8, normal_module=2.0, face_width=8, helix_angle=25, profile_shift=0.5)
INNER = 5.0
"""mm: radius of the hub."""

SIZES = MeshSizes(flank=1.2, corner=1.0, fillet=0.8, outline=1.5, cut=1.5, rim=4.0, growth=1.0)
"""Coarse: equality of two ways through the same mesh does not depend on its fineness."""

EXACT = 1e-8
"""Relative: rounding of a solution with some ten thousand unknowns."""


@pytest.fixture(scope="module")
def mesh() -> SweptMesh:
    return sweep(GEAR, mesh_quads(GEAR, INNER, SIZES), 2)


@pytest.fixture(scope="module")
def sector(mesh: SweptMesh) -> SolidSector:
    return SolidSector(mesh, STEEL)


def test_quads_fill_the_section(mesh: SweptMesh) -> None:
    """Every quadrangle is the right way round, and their areas add up to the outline's, exact curves included."""
    section = mesh.section
    corners = section.points[section.quads[:, :4]]
    x, y = corners[..., 0], corners[..., 1]
    areas = (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1) / 2
    assert areas.min() > 0
    outline = np.concatenate([section.points[nodes[:-1:2]] for nodes in section.sides.values()])
    x, y = outline.T
    assert areas.sum() == pytest.approx((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2, rel=1e-12)


def test_outline_lies_on_the_tooth(mesh: SweptMesh) -> None:
    """Vertices and middle nodes of the left flank have the profile's half angle at their radius."""
    points = mesh.section.points[mesh.section.sides[Side.LEFT_FLANK]]
    radii = np.hypot(*points.T)
    assert np.degrees(np.arctan2(points[:, 1], points[:, 0])) == pytest.approx(GEAR.profile.half_angle(radii), abs=1e-10)


def test_mesh_is_a_screw(mesh: SweptMesh) -> None:
    """The nodes above a node of the section lie on its helix of the gear's lead."""
    above = mesh.over(np.array([0]))
    x, y, z = mesh.points[above].T
    angle = np.arctan2(y, x) - np.arctan2(*mesh.section.points[0][::-1])
    assert angle == pytest.approx(2 * math.pi * z / GEAR.lead, abs=1e-12)
    assert z.max() == pytest.approx(GEAR.face_width)


def test_patch_of_constant_strain(sector: SolidSector) -> None:
    """A linear displacement leaves inner nodes in equilibrium; its energy is Hooke's for the volume of the mesh."""
    mesh = sector.mesh
    gradient = np.array([[3e-4, -1e-4, 2e-4], [5e-4, 2e-4, -3e-4], [1e-4, 4e-4, -2e-4]])
    moved = mesh.points @ gradient.T
    turning = mesh.to_turning(moved[..., None])[..., 0]
    forces = (sector.stiffness() @ turning.ravel()).reshape(-1, 3)
    outline = np.unique(mesh.over(np.unique(np.concatenate(list(mesh.section.sides.values())))))
    ends = np.concatenate([np.arange(len(mesh.section.points)) + mesh.plane(k) for k in (0, mesh.layers)])
    inside = np.setdiff1d(np.arange(mesh.nodes), np.r_[outline, ends])
    assert np.abs(forces[inside]).max() < 1e-10 * np.abs(forces).max()
    strain, (first, second) = (gradient + gradient.T) / 2, lame(STEEL)
    stress = first * np.trace(strain) * np.eye(3) + 2 * second * strain
    energy = float((forces * turning).sum())
    corners = mesh.section.points[mesh.section.quads]
    assert energy == pytest.approx(float((stress * strain).sum()) * _area(corners) * GEAR.face_width, rel=1e-3)


def _area(quads: Any) -> float:
    """Of quadratic quadrangles, by their outlines: Simpson's rule is exact for a quadratic edge's x dy to the third order."""
    total = 0.0
    for k in range(4):
        start, middle, end = quads[:, k], quads[:, 4 + k], quads[:, (k + 1) % 4]
        s, weight = np.polynomial.legendre.leggauss(3)
        for at, w in zip(s, weight, strict=True):
            shape = np.array([at * (at - 1) / 2, 1 - at * at, at * (at + 1) / 2])
            slope = np.array([at - 0.5, -2 * at, at + 0.5])
            x, y = (shape[0] * start + shape[1] * middle + shape[2] * end).T
            dx, dy = (slope[0] * start + slope[1] * middle + slope[2] * end).T
            total += w * float((x * dy - y * dx).sum()) / 2
    return total


def test_rigid_motions_cost_nothing(sector: SolidSector) -> None:
    mesh, matrix = sector.mesh, sector.stiffness()
    x, y, z = mesh.points.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    motions = [(one, zero, zero), (zero, one, zero), (zero, zero, one), (-y, x, zero), (zero, -z, y), (z, zero, -x)]
    stiffest = np.abs(matrix.diagonal()).max()
    for motion in motions:
        turning = mesh.to_turning(np.stack(motion, -1)[..., None]).ravel()
        assert np.abs(matrix @ turning).max() < 1e-12 * stiffest * np.abs(turning).max()


# ---------------------------------------------------------------------- condensation


def explicit(sector: SolidSector, teeth: int, cuts: Cuts | None, loads: Any) -> Any:
    """Displacements (teeth, dofs, m) with all sectors in full; tooth 0 loaded; `cuts` None closes the ring."""
    own = sector.dofs
    numbers = np.arange(teeth * own).reshape(teeth, own)
    for tooth in range(1, teeth):
        numbers[tooth, sector.behind] = numbers[tooth - 1, sector.ahead]
    if cuts is None:
        numbers[0, sector.behind] = numbers[-1, sector.ahead]
    held = np.concatenate([row[sector.hub] for row in numbers])
    if cuts is not None and cuts is not Cuts.FREE:
        step = slice(None) if cuts is Cuts.FIXED else slice(1, None, 3)
        held = np.r_[held, numbers[0, sector.behind[step]], numbers[-1, sector.ahead[step]]]
    entries = (sector.cut_turn.T @ sector.stiffness() @ sector.cut_turn).tocoo()
    row, column = (np.concatenate([numbers[tooth][part] for tooth in range(teeth)]) for part in (entries.row, entries.col))
    size = teeth * own
    matrix = scipy.sparse.csr_matrix((np.tile(entries.data, teeth), (row, column)), shape=(size, size))
    free = np.setdiff1d(np.unique(numbers), held)
    right = np.zeros((size, loads.shape[1]))
    middle = teeth // 2 if cuts is not None else 0
    np.add.at(right, numbers[middle], sector.cut_turn.T @ loads)
    moved = np.zeros((size, loads.shape[1]))
    moved[free] = scipy.sparse.linalg.splu(matrix[free][:, free].tocsc()).solve(right[free])
    return np.stack([sector.cut_turn @ moved[numbers[(middle + k) % teeth]] for k in (-1, 0, 1)])


@pytest.fixture(scope="module")
def loads(sector: SolidSector) -> Any:
    """Forces on some nodes of the tooth, in all directions."""
    found = np.zeros((sector.dofs, 4))
    nodes = sector.mesh.over(sector.mesh.side(Side.LEFT_FLANK))
    found[3 * nodes[3]] = 1
    found[3 * nodes[-1] + 1, 1] = -2
    found[3 * nodes[20] + 2, 2] = 3
    found[3 * nodes + 1, 3] = 0.1
    return found


@pytest.mark.parametrize(
    ("cuts", "held"), [(None, 0), (Cuts.FIXED, 3), (Cuts.SLIDING, 5), (Cuts.FREE, 3), (Cuts.FREE, 5), (Cuts.FIXED, 5)]
)
def test_condensed_body_is_that_in_full(mesh: SweptMesh, sector: SolidSector, loads: Any, cuts: Cuts | None, held: int) -> None:
    teeth = GEAR.teeth if cuts is None else held
    body = assemble_body(mesh, GEAR.teeth, 1, STEEL, None if cuts is None else held, cuts or Cuts.FIXED)
    moved = body.solve(loads).displacements
    reference = explicit(sector, teeth, cuts, loads)
    assert np.abs(moved - reference).max() < EXACT * np.abs(reference).max()


@pytest.mark.parametrize("held", [None, 3])
def test_torque_on_the_hub_is_that_of_the_loads(mesh: SweptMesh, loads: Any, held: int | None) -> None:
    body: SolidBody = assemble_body(mesh, GEAR.teeth, 1, STEEL, held, Cuts.FIXED)
    x, y = mesh.in_section.T
    applied = np.einsum("n,nm->m", x, loads[1::3]) - np.einsum("n,nm->m", y, loads[0::3])
    assert body.solve(loads).torques == pytest.approx(applied, rel=1e-7, abs=1e-7)
