"""Bodies put together from sectors: constant stress, rigid motions, and condensation against the same ring in full."""

from typing import Any

import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg
from support.brute import stiffness_matrix, summed, tip_loads

from gearcad import Gear, Material
from gearcad.contact.plane.ring import assemble
from gearcad.contact.plane.sector import (
    Plane,
    PlaneElasticity,
    chain_of,
    dissect,
    element_forces,
    element_mass,
    element_stiffness,
    make_sector,
    node_dofs,
)
from gearcad.contact.shared.bodies import Chain, Cuts
from gearcad.meshing.outline import MeshSizes, OutlineSide
from gearcad.meshing.sector import SectorMesh, mesh_sector

STEEL = Material()
GEAR = Gear(teeth=13, normal_module=2.0, face_width=10, profile_shift=0.2)
INNER = 6.0
"""mm: radius of the hub."""

SIZES = MeshSizes(flank=0.25, corner=0.1, fillet=0.2, outline=0.4, cut=0.3)
"""Coarse: equality of two ways through the same mesh does not depend on its fineness."""

EXACT = 1e-9
"""Relative: rounding of a solution with some thousand unknowns."""


@pytest.fixture(scope="module")
def mesh() -> SectorMesh:
    return mesh_sector(GEAR, INNER, SIZES)


@pytest.fixture(scope="module", params=list(Plane), ids=lambda plane: plane.value)
def elasticity(request: Any) -> PlaneElasticity:
    return PlaneElasticity(STEEL, request.param)


def full_strain_law(elasticity: PlaneElasticity, strain: Any) -> Any:
    """Stress (2, 2) by Hooke's law in three dimensions, with eps_z = 0, or with the eps_z that leaves sigma_z = 0."""
    e, nu = elasticity.material.youngs_modulus, elasticity.material.poisson_ratio
    first, shear = e * nu / (1 + nu) / (1 - 2 * nu), e / 2 / (1 + nu)
    across = 0.0 if elasticity.plane is Plane.STRAIN else -first * np.trace(strain) / (first + 2 * shear)
    return first * (np.trace(strain) + across) * np.eye(2) + 2 * shear * strain


def test_patch_of_constant_stress(mesh: SectorMesh, elasticity: PlaneElasticity) -> None:
    """A linear displacement leaves inner nodes in equilibrium, and the energy is that of Hooke's law in space.

    On curved edges too: quadratic elements with quadratic edges hold all linear fields.
    """
    gradient = np.array([[3e-4, -1e-4], [5e-4, 2e-4]])
    strain = (gradient + gradient.T) / 2
    forces = stiffness_matrix(mesh, elasticity) @ (mesh.points @ gradient.T).ravel()
    outline = np.unique(np.concatenate(list(mesh.sides.values())))
    inside = np.setdiff1d(np.arange(len(mesh.points)), outline)
    nodal = forces.reshape(-1, 2)
    assert np.abs(nodal[inside]).max() < 1e-11 * np.abs(nodal).max()
    # Nodal forces of a constant stress are its tractions on the outline: here through their moments.
    moments = nodal.T @ mesh.points
    area = _area(mesh)
    assert moments == pytest.approx(full_strain_law(elasticity, strain) * area, rel=1e-9)


def _area(mesh: SectorMesh) -> float:
    """mm², by the same elements: a divergence of 1 under a bulk modulus that is known."""
    from skfem import Basis, ElementTriP2, MeshTri2

    basis = Basis(MeshTri2(mesh.points.T, mesh.triangles.T), ElementTriP2(), intorder=4)
    return float(basis.dx.sum())


def test_rigid_motions_cost_nothing(mesh: SectorMesh, elasticity: PlaneElasticity) -> None:
    matrix = stiffness_matrix(mesh, elasticity)
    x, y = mesh.points.T
    motions = np.stack([np.ones_like(x), 0 * x, 0 * x, np.ones_like(x), -y, x], -1).reshape(-1, 3, 2)
    motions = motions.transpose(0, 2, 1).reshape(-1, 3)
    forces = matrix @ motions
    assert np.abs(forces).max() < 1e-10 * np.abs(matrix).max() * np.abs(motions).max()


def test_stiffness_is_symmetric_and_has_three_free_motions_only(mesh: SectorMesh) -> None:
    coarse = mesh_sector(GEAR, INNER, MeshSizes(flank=1, corner=1, fillet=1, outline=1, cut=1, rim=2))
    matrix = stiffness_matrix(coarse, PlaneElasticity(STEEL)).toarray()
    assert matrix == pytest.approx(matrix.T, abs=1e-9 * np.abs(matrix).max())
    values = np.linalg.eigvalsh(matrix)
    assert (np.abs(values) < 1e-10 * values[-1]).sum() == 3
    assert values[0] > -1e-10 * values[-1]


def test_part_of_the_elements_adds_up(mesh: SectorMesh) -> None:
    steel = PlaneElasticity(STEEL)
    some = np.arange(0, len(mesh.triangles), 3)
    rest = np.setdiff1d(np.arange(len(mesh.triangles)), some)
    whole = stiffness_matrix(mesh, steel)
    assert (
        abs(stiffness_matrix(mesh, steel, some) + stiffness_matrix(mesh, steel, rest) - whole).max() < 1e-9 * abs(whole).max()
    )


def test_elements_are_those_of_scikit_fem(mesh: SectorMesh) -> None:
    from skfem import Basis, BilinearForm, ElementTriP2, ElementVector, MeshTri2
    from skfem.models.elasticity import linear_elasticity

    steel = PlaneElasticity(STEEL)
    whole = MeshTri2(mesh.points.T, mesh.triangles.T)
    basis = Basis(whole, ElementVector(ElementTriP2()), intorder=4)
    mass = BilinearForm(lambda u, v, _: (u * v).sum(axis=0))
    # Its dofs: those of the vertices, then those of the edges in an order of its own.
    order = np.argsort(basis.doflocs[:, ::2].T @ [1.0, np.pi])
    ours = np.argsort(mesh.points @ [1.0, np.pi])
    for form, matrices in (
        (linear_elasticity(*steel.lame), element_stiffness(mesh, steel)),
        (mass, element_mass(mesh)),
    ):
        found = summed(mesh.triangles, matrices, len(mesh.points))[node_dofs(ours)][:, node_dofs(ours)]
        theirs = form.assemble(basis)[node_dofs(order)][:, node_dofs(order)]
        assert abs(found - theirs).max() < EXACT * abs(theirs).max()


def test_forces_of_elements_are_those_of_their_matrix(mesh: SectorMesh) -> None:
    steel, some = PlaneElasticity(STEEL), np.arange(7, 40)
    moved = np.random.default_rng(3).normal(size=(2 * len(mesh.points), 3))
    forces = element_forces(mesh.triangles[some], element_stiffness(mesh, steel, some), moved)
    assert np.abs(forces - stiffness_matrix(mesh, steel, some) @ moved).max() < EXACT * np.abs(forces).max()


def test_dissection_is_static_condensation(mesh: SectorMesh) -> None:
    """Matrix at the cuts, what arrives there, its work, and displacements inside, by one solution of the whole matrix."""
    steel, random = PlaneElasticity(STEEL), np.random.default_rng(5)
    cuts, held = np.union1d(mesh.behind, mesh.ahead), mesh.sides[OutlineSide.HELD]
    found = dissect(mesh.points, mesh.triangles, element_stiffness(mesh, steel), cuts, held)
    matrix, kept = stiffness_matrix(mesh, steel), node_dofs(np.setdiff1d(cuts, held))
    assert found.kept == pytest.approx(kept)
    inside = np.setdiff1d(np.arange(found.dofs), np.r_[kept, node_dofs(held)])
    solve = scipy.sparse.linalg.splu(matrix[inside][:, inside].tocsc()).solve
    across = matrix[inside][:, kept].toarray()
    condensed = matrix[kept][:, kept].toarray() - across.T @ solve(across)
    assert np.abs(found.matrix - condensed).max() < EXACT * np.abs(condensed).max()
    loads = np.zeros((found.dofs, 2))
    loads[inside[: len(inside) // 3]] = random.normal(size=(len(inside) // 3, 2))
    arrived, by_loads = found.forward(loads), solve(loads[inside])
    assert arrived.loads == pytest.approx(-across.T @ by_loads, abs=EXACT * np.abs(loads).max())
    assert arrived.work == pytest.approx(loads[inside].T @ by_loads, rel=EXACT)
    at_cuts = random.normal(size=(len(kept), 2)) * np.abs(by_loads).max()
    moved = found.backward(at_cuts, arrived)
    assert np.abs(moved[inside] - by_loads + solve(across @ at_cuts)).max() < EXACT * np.abs(moved).max()
    assert (moved[kept] == at_cuts).all()
    assert not moved[node_dofs(held)].any()


def explicit(mesh: SectorMesh, teeth: int, cuts: Cuts | None) -> tuple[Any, Any]:
    """Displacements (teeth, 2 n, 2) and hub torques by loads at the tip of the middle tooth: all sectors in full, in x and y.

    `cuts` None closes the ring. Nothing of `ring.py` is used: nodes are turned into place and merged, held dofs left out.
    """
    pitch = 2 * np.pi / GEAR.teeth
    count = len(mesh.points)
    turned, number, points = [], np.full((teeth, count), -1), []
    for k in range(teeth):
        angle = (k - teeth // 2) * pitch
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        turned.append(turn)
        if k:
            number[k, mesh.behind] = number[k - 1, mesh.ahead]
        if cuts is None and k == teeth - 1:
            number[k, mesh.ahead] = number[0, mesh.behind]
        new = np.flatnonzero(number[k] < 0)
        number[k, new] = len(points) + np.arange(len(new))
        points.extend(mesh.points[new] @ turn.T)
    everywhere = np.array(points)
    whole = SectorMesh(everywhere, number[:, mesh.triangles].reshape(-1, 6), {})
    matrix = stiffness_matrix(whole, PlaneElasticity(STEEL))
    basis = _permitted(mesh, number, turned, everywhere, cuts)
    loads = np.zeros((2 * len(everywhere), 2))
    tip = number[teeth // 2, mesh.sides[OutlineSide.LEFT_FLANK][0]]
    loads[2 * tip, 0], loads[2 * tip + 1, 1] = 1, 1
    moved = basis @ scipy.sparse.linalg.spsolve((basis.T @ matrix @ basis).tocsc(), basis.T @ loads)
    reaction = matrix @ moved - loads
    turn_all = np.stack([-everywhere[:, 1], everywhere[:, 0]], -1).ravel()
    return np.stack([_in_frame(moved, row, turn) for row, turn in zip(number, turned, strict=True)]), -(turn_all @ reaction)


def _permitted(mesh: SectorMesh, number: Any, turned: list[Any], points: Any, cuts: Cuts | None) -> Any:
    """Columns: the motions left free by the hub and by what holds the cuts."""
    held = {int(node) for row in number for node in row[mesh.sides[OutlineSide.HELD]]}
    sliding: set[int] = set()
    for row, nodes in ((number[0], mesh.behind), (number[-1], mesh.ahead)):
        if cuts is Cuts.FIXED:
            held |= set(row[nodes].tolist())
        elif cuts is Cuts.SLIDING:
            sliding |= set(row[nodes].tolist()) - held
    columns = []
    for node in range(len(points)):
        if node in held:
            continue
        if node in sliding:
            radial = points[node] / np.hypot(*points[node])
            columns.append(([2 * node, 2 * node + 1], radial.tolist()))
        else:
            columns += [([2 * node], [1.0]), ([2 * node + 1], [1.0])]
    rows = [row for each, _ in columns for row in each]
    places = [place for place, (each, _) in enumerate(columns) for _ in each]
    values = [value for _, each in columns for value in each]
    return scipy.sparse.csc_matrix((values, (rows, places)), shape=(2 * len(points), len(columns)))


def _in_frame(moved: Any, row: Any, turn: Any) -> Any:
    here = np.stack([moved[2 * row], moved[2 * row + 1]], 1)  # nodes, direction, loads
    return np.einsum("dc,ndm->ncm", turn, here).reshape(2 * len(row), -1)


def assert_same(mesh: SectorMesh, full: int, teeth: int, cuts: Cuts | None) -> None:
    """A body with `full` sectors in full is that with all `teeth` of them."""
    held = None if cuts is None else teeth
    ring = assemble(mesh, mesh, GEAR.teeth, full // 2, PlaneElasticity(STEEL), held, cuts or Cuts.FIXED)
    moved, torque = ring.solve(tip_loads(mesh))
    expected, expected_torque = explicit(mesh, teeth, cuts)
    middle = slice(teeth // 2 - full // 2, teeth // 2 + full // 2 + 1)
    assert np.abs(moved - expected[middle]).max() < EXACT * np.abs(expected).max()
    assert torque == pytest.approx(expected_torque, rel=1e-8)
    tip = mesh.points[mesh.sides[OutlineSide.LEFT_FLANK][0]]
    if cuts is not None and cuts is not Cuts.FREE:
        # The cuts belong to the hub, which so takes all of the torque.
        assert torque == pytest.approx([-tip[1], tip[0]], rel=1e-8)


@pytest.mark.parametrize("full", [3, 5])
def test_condensed_ring_is_the_ring_in_full(mesh: SectorMesh, full: int) -> None:
    assert_same(mesh, full, GEAR.teeth, None)


def test_ring_without_any_condensed_sector(mesh: SectorMesh) -> None:
    assert_same(mesh, GEAR.teeth, GEAR.teeth, None)


@pytest.mark.parametrize("cuts", list(Cuts), ids=lambda cuts: cuts.value)
@pytest.mark.parametrize("teeth", [3, 5, 9])
def test_condensed_body_between_cuts_is_that_in_full(mesh: SectorMesh, teeth: int, cuts: Cuts) -> None:
    assert_same(mesh, 3, teeth, cuts)


def test_hub_takes_the_torque_of_a_full_ring(mesh: SectorMesh) -> None:
    ring = assemble(mesh, mesh, GEAR.teeth, 1, PlaneElasticity(STEEL), None, Cuts.FIXED)
    x, y = mesh.points[mesh.sides[OutlineSide.LEFT_FLANK][0]]
    assert ring.solve(tip_loads(mesh))[1] == pytest.approx([-y, x], rel=1e-8)


def test_coarse_sectors_far_from_the_load_hardly_matter(mesh: SectorMesh) -> None:
    """Below the root both meshes are the same; the teeth of the coarse one carry nothing."""
    fine = mesh_sector(GEAR, INNER)
    coarse = mesh_sector(GEAR, INNER, MeshSizes().coarse())
    loads = tip_loads(fine)
    moved = [
        assemble(fine, rest, GEAR.teeth, 1, PlaneElasticity(STEEL), None, Cuts.FIXED).solve(loads)[0] for rest in (fine, coarse)
    ]
    assert np.abs(moved[1] - moved[0]).max() < 1e-4 * np.abs(moved[0]).max()


@pytest.mark.parametrize("times", [1, 2, 3, 7, 12])
def test_doubling_is_repeating(mesh: SectorMesh, times: int) -> None:
    chain = chain_of(make_sector(mesh, PlaneElasticity(STEEL)))
    one_by_one = chain
    for _ in range(times - 1):
        one_by_one = one_by_one.followed_by(chain)
    scale = np.abs(one_by_one.matrix).max()
    assert np.abs(chain.repeated(times).matrix - one_by_one.matrix).max() < EXACT * scale


def test_a_chain_turns_with_its_hub_without_forces(mesh: SectorMesh) -> None:
    chain: Chain = chain_of(make_sector(mesh, PlaneElasticity(STEEL))).repeated(5)
    turn = np.zeros(2 * chain.cut + 1)
    radii = np.hypot(*mesh.points[mesh.ahead[:-1]].T)
    turn[1 : chain.cut : 2], turn[chain.cut + 1 : -1 : 2], turn[-1] = radii, radii, 1
    assert np.abs(chain.matrix @ turn).max() < EXACT * np.abs(chain.matrix).max() * radii.max()


def test_twice_the_modulus_halves_every_displacement(mesh: SectorMesh) -> None:
    loads = tip_loads(mesh)
    moved = [
        assemble(mesh, mesh, GEAR.teeth, 1, PlaneElasticity(Material(youngs_modulus=modulus)), 7, Cuts.SLIDING).solve(loads)
        for modulus in (1e5, 2e5)
    ]
    assert np.abs(moved[0][0] - 2 * moved[1][0]).max() < EXACT * np.abs(moved[0][0]).max()
    assert moved[1][1] == pytest.approx(moved[0][1], rel=1e-9)
