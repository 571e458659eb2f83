"""Solid bodies put together from sectors: patches, rigid motions, and condensation against the same body in full."""

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg

from gearcad import Gear, Material
from gearcad.contact.shared.bodies import Cuts
from gearcad.contact.solid.body import SolidBody, SolidSector, assemble_body
from gearcad.contact.solid.elements import lame
from gearcad.contact.solid.flank import solid_compliance
from gearcad.contact.solid.fronts import joined
from gearcad.contact.solid.root import _between
from gearcad.core.errors import SolverError
from gearcad.meshing.outline import MeshSizes, OutlineSide
from gearcad.meshing.quads import mesh_quads
from gearcad.meshing.sector import SweptMesh, sweep

STEEL = Material()
GEAR = Gear(teeth=8, normal_module=2.0, face_width=8, helix_angle=25, profile_shift=0.5)
INNER = 5.0
"""mm: radius of the hub."""

SIZES = MeshSizes(flank=0.6, corner=0.5, fillet=0.4, outline=0.75, cut=0.75, rim=2.0, growth=0.5)
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
    points = mesh.section.points[mesh.section.sides[OutlineSide.LEFT_FLANK]]
    radii = np.hypot(*points.T)
    assert np.degrees(np.arctan2(points[:, 1], points[:, 0])) == pytest.approx(GEAR.profile.half_angle(radii), abs=1e-10)


def test_mesh_is_a_screw(mesh: SweptMesh) -> None:
    """The nodes above a node of the section lie on its helix of the gear's lead."""
    above = mesh.over(np.array([0]))
    x, y, z = mesh.points[above].T
    angle = np.arctan2(y, x) - np.arctan2(*mesh.section.points[0][::-1])
    assert angle == pytest.approx(2 * math.pi * z / GEAR.lead, abs=1e-12)
    assert z.max() == pytest.approx(GEAR.face_width)


def test_layers_that_half_a_turn_changes_are_refused(mesh: SweptMesh) -> None:
    """The condensation of half a sector tells the other half only where planes are symmetric about the middle."""
    first, middle, last = mesh.planes
    lower = replace(mesh, planes=np.array([first, middle - 1e-3 * GEAR.face_width, last]))
    with pytest.raises(SolverError, match="layers of a gear are not symmetric"):
        _ = SolidSector(lower, STEEL).condensed


def test_bodies_let_go_are_condensed_again(mesh: SweptMesh) -> None:
    """What fields of teeth need is kept where that is asked for; else it is made again, and gives the same."""
    found = []
    for fields in (True, False):
        body = assemble_body(mesh, GEAR.teeth, 1, STEEL, 3, Cuts.FIXED)
        given = solid_compliance(GEAR, body, STEEL, 0.0, fields=fields)
        assert ("_made" in vars(given.body.sector)) is fields
        found.append(given.tooth_displacements(0, [(0, np.ones(given.unit_loads))]))
    np.testing.assert_array_equal(*found)


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
    nodes = sector.mesh.over(sector.mesh.side(OutlineSide.LEFT_FLANK))
    found[3 * nodes[3]] = 1
    found[3 * nodes[-1] + 1, 1] = -2
    found[3 * nodes[20] + 2, 2] = 3
    found[3 * nodes + 1, 3] = 0.1
    return found


@pytest.mark.parametrize(
    ("cuts", "held"),
    [
        (None, 0),
        (Cuts.FIXED, 3),
        (Cuts.SLIDING, 5),
        (Cuts.FREE, 3),
        *(pytest.param(cuts, 5, marks=pytest.mark.long) for cuts in (Cuts.FREE, Cuts.FIXED)),
    ],
)
def test_condensed_body_is_that_in_full(mesh: SweptMesh, sector: SolidSector, loads: Any, cuts: Cuts | None, held: int) -> None:
    teeth = GEAR.teeth if cuts is None else held
    body = assemble_body(mesh, GEAR.teeth, 1, STEEL, None if cuts is None else held, cuts or Cuts.FIXED)
    moved = body.solve(loads).displacements
    reference = explicit(sector, teeth, cuts, loads)
    assert np.abs(moved - reference).max() < EXACT * np.abs(reference).max()


@pytest.mark.parametrize(
    ("layers", "finer", "teeth", "neighbours"),
    [
        *((1, 0.8, 7, 3), (2, 0.8, 6, 2), (5, 0.8, 3, 1), (4, 0.5, 9, 3)),
        *(pytest.param(*each, marks=pytest.mark.long) for each in ((1, 1.0, 4, 1), (3, 0.8, 4, 1), (5, 0.5, 8, 2))),
    ],
)
def test_halves_tell_of_all(layers: int, finer: float, teeth: int, neighbours: int) -> None:
    """Of layers or of the section, with hexahedra in the middle or without, rings odd and even, up to the opposite cut."""
    mesh = sweep(GEAR, mesh_quads(GEAR, INNER, SIZES.scaled(finer)), layers)
    sector = SolidSector(mesh, STEEL)
    nodes = np.random.default_rng(layers).choice(mesh.over(mesh.side(OutlineSide.LEFT_FLANK)), 3, replace=False)
    forces = np.random.default_rng(teeth).normal(size=(9, 2))
    everywhere = np.zeros((mesh.nodes, 3, 2))
    everywhere[nodes] = forces.reshape(3, 3, 2)
    reference = explicit(sector, teeth, None, everywhere.reshape(-1, 2)).reshape(3, mesh.nodes, 3, 2)
    wanted = np.random.default_rng(0).permutation(mesh.nodes)[: mesh.nodes // 2]
    body = assemble_body(mesh, teeth, neighbours, STEEL, None, Cuts.FIXED)
    moved = body.solve(forces, wanted, at=nodes).displacements[neighbours - 1 : neighbours + 2]
    assert np.abs(moved.reshape(3, -1, 3, 2) - reference[:, wanted]).max() < EXACT * np.abs(reference).max()


@pytest.mark.parametrize("held", [None, 3])
def test_torque_on_the_hub_is_that_of_the_loads(mesh: SweptMesh, loads: Any, held: int | None) -> None:
    body: SolidBody = assemble_body(mesh, GEAR.teeth, 1, STEEL, held, Cuts.FIXED)
    x, y = mesh.in_section.T
    applied = np.einsum("n,nm->m", x, loads[1::3]) - np.einsum("n,nm->m", y, loads[0::3])
    assert body.solve(loads).torques == pytest.approx(applied, rel=1e-7, abs=1e-7)


# ---------------------------------------------------------------------- free bores


def explicit_free(sector: SolidSector, teeth: int, loads: Any) -> Any:
    """Displacements of teeth -1, 0, 1 of a ring of all sectors in full, in fixed axes, its bore's mean motion nought.

    The mean is weighted with the surface's area and leaves out what is square to it.
    """
    mesh, pitch = sector.mesh, 2 * np.pi / teeth
    own = mesh.nodes
    ahead, behind = (mesh.over(nodes) for nodes in (mesh.section.ahead, mesh.section.behind))
    number = np.arange(teeth * own).reshape(teeth, own)
    for tooth in range(1, teeth):
        number[tooth, behind] = number[tooth - 1, ahead]
    number[0, behind] = number[-1, ahead]
    _, number = np.unique(number, return_inverse=True)
    number = number.reshape(teeth, own)
    size = 3 * (int(number.max()) + 1)
    turning = sector.stiffness()
    weights = _bore_weights(sector)
    matrix, mean = scipy.sparse.csr_matrix((size, size)), np.zeros((size, 6))
    places = []
    for tooth in range(teeth):
        angles = mesh.rate * mesh.heights + tooth * pitch
        place = _from_axes(number[tooth], angles, size)
        matrix = matrix + place @ turning @ place.T
        mean += _from_axes(number[tooth], np.full(own, tooth * pitch), size) @ _turned_motions(weights, tooth * pitch)
        places.append(place)
    whole = scipy.sparse.bmat([[matrix, mean], [mean.T, None]], format="csc")
    right = np.r_[places[0] @ loads, np.zeros((6, loads.shape[1]))]
    moved = scipy.sparse.linalg.splu(whole).solve(right)[:-6]
    return np.stack([places[k].T @ moved for k in (-1, 0, 1)])


def _from_axes(nodes: Any, angles: Any, size: int) -> Any:
    """Matrix from vectors at a sector's nodes, in axes turned by angles about z, to all dofs in fixed axes."""
    count = len(nodes)
    row, column, value = [], [], []
    for to, of, factor in ((0, 0, np.cos(angles)), (0, 1, -np.sin(angles)), (1, 0, np.sin(angles)), (1, 1, np.cos(angles))):
        row.append(3 * nodes + to)
        column.append(3 * np.arange(count) + of)
        value.append(factor)
    row.append(3 * nodes + 2)
    column.append(3 * np.arange(count) + 2)
    value.append(np.ones(count))
    parts = [np.concatenate(each) for each in (value, row, column)]
    return scipy.sparse.csr_matrix((parts[0], (parts[1], parts[2])), shape=(size, 3 * count))


def _turned_motions(weights: Any, angle: float) -> Any:
    """Weights (3 n, 6) of a sector, whose motions are along its own axes, as those of motions along fixed ones."""
    cosine, sine = np.cos(angle), np.sin(angle)
    found = weights.copy()
    for first in (1, 4):
        one, two = weights[:, first], weights[:, first + 1]
        found[:, first], found[:, first + 1] = cosine * one - sine * two, sine * one + cosine * two
    return found


def _bore_weights(sector: SolidSector) -> Any:
    """Integral over the bore of N (m less its radial part), (3 nodes, 6), in fixed axes: motions m as a screw has them."""
    from skfem import ElementQuadS2

    mesh, element = sector.mesh, ElementQuadS2()
    found = np.zeros((mesh.nodes, 3, 6))
    arc = mesh.side(OutlineSide.HELD)
    s, w = np.polynomial.legendre.leggauss(3)  # the area is no polynomial: other rules differ by 1e-7
    middle = GEAR.face_width / 2
    for layer in range(mesh.layers):
        low, high = mesh.plane(layer), mesh.plane(layer + 1)
        half = mesh.elements(mesh.section.quads[:1], layer)[0, 16] - mesh.section.quads[0, 0]
        for a, b, c in zip(arc[:-1:2], arc[1::2], arc[2::2], strict=True):
            nodes = [a + low, c + low, c + high, a + high, b + low, c + half, b + high, a + half]
            for x, wx in zip((s + 1) / 2, w / 2, strict=True):
                for y, wy in zip((s + 1) / 2, w / 2, strict=True):
                    basis = [element.lbasis(np.array([[x], [y]]), k) for k in range(8)]
                    shape = np.array([float(each[0][0]) for each in basis])
                    slopes = np.array([each[1][:, 0] for each in basis])
                    point, (first, second) = shape @ mesh.points[nodes], slopes.T @ mesh.points[nodes]
                    area = np.linalg.norm(np.cross(first, second)) * wx * wy
                    out = np.array([point[0], point[1], 0]) / np.hypot(point[0], point[1])
                    arm = point - [0, 0, middle]
                    shifts, turns = np.eye(3), [np.cross(axis, arm) for axis in np.eye(3)]
                    motions = np.stack([turns[2], *shifts, turns[0], turns[1]], -1)
                    found[nodes] += shape[:, None, None] * area * (motions - np.outer(out, out @ motions))
    return found.reshape(-1, 6)


def test_a_free_bore_is_that_of_the_body_in_full(mesh: SweptMesh, sector: SolidSector, loads: Any) -> None:
    """And the cuts of all teeth up to the opposite one meet, from both sides: round the ring the way back is the way on."""
    body = assemble_body(mesh, GEAR.teeth, 3, STEEL, None, Cuts.FIXED, free=True)
    moved, torques = body.solve(loads)
    reference = explicit_free(sector, GEAR.teeth, loads)
    assert np.abs(moved[2:5] - reference).max() < EXACT * np.abs(reference).max()
    x, y = mesh.in_section.T
    applied = np.einsum("n,nm->m", x, loads[1::3]) - np.einsum("n,nm->m", y, loads[0::3])
    assert torques == pytest.approx(applied, rel=1e-7, abs=1e-7)
    polar = [body.sector.cut_turn.T @ each for each in moved]
    for one, other in pairwise(polar):
        assert np.abs(one[body.sector.ahead] - other[body.sector.behind]).max() < EXACT * np.abs(reference).max()


def test_places_between_rows_reach_both_ends() -> None:
    """Four steps to each interval, of the cubic through the rows: x, x^2 and x^3 stay what they are, up to the last row."""
    rows = np.array([-1.0, 0.0, 1.5, 2.0, 4.0])
    weights = _between(rows)
    places = np.interp(np.arange(17) / 4, np.arange(5), rows)
    for power in range(4):
        np.testing.assert_allclose(weights @ rows**power, places**power, atol=1e-12)
    np.testing.assert_array_equal(_between(np.array([2.0])), [[1.0]])


@pytest.mark.parametrize("teeth", [4, 5])
def test_rows_doubled_are_rows_joined_one_by_one(sector: SolidSector, teeth: int) -> None:
    doubled, whole = sector.span.repeated(teeth), joined(sector.span, sector.span.repeated(teeth - 2))[0]
    assert doubled.teeth == whole.teeth == teeth
    for one, other in zip(doubled.matrices, whole.matrices, strict=True):
        assert np.abs(one - other).max() < EXACT * np.abs(other).max()
