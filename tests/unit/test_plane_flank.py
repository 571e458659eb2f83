"""A load on a flank: Flamant's field against Johnson, and what is left of it in a tooth."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.brute import nodal_compliance

from gearcad import Gear, Material
from gearcad.contact.plane.flank import (
    Fillets,
    PlaneCompliance,
    ToothLoad,
    edge_displacement,
    flamant_displacement,
    flamant_traction,
    flank_compliance,
)
from gearcad.contact.plane.ring import assemble
from gearcad.contact.plane.sector import Plane, PlaneElasticity
from gearcad.contact.shared.bodies import Cuts
from gearcad.geometry import ShaperCutter
from gearcad.meshing.outline import MeshSizes, OutlineSide
from gearcad.meshing.sector import mesh_sector

STEEL = Material()
INWARD = np.array([0.6, -0.8])
ACROSS = np.array([0.8, 0.6])
PLANES = [PlaneElasticity(STEEL, plane) for plane in Plane]

GEARS = {
    "z18": Gear(teeth=18, normal_module=1.5, face_width=10, profile_shift=0.3422),
    "z8 undercut": Gear(teeth=8, normal_module=3.0, face_width=10),
    "z161": Gear(teeth=161, normal_module=1.5, face_width=10, profile_shift=0.1682),
    "helical": Gear(teeth=13, normal_module=2.5, face_width=18, helix_angle=28, profile_shift=0.107),
    "ring": Gear(teeth=-70, normal_module=2.0, face_width=14, profile_shift=-0.3, cutter=ShaperCutter(teeth=25)),
    "great ring": Gear(teeth=-161, normal_module=1.5, face_width=10, cutter=ShaperCutter(teeth=40, tip_radius=0.2)),
}


def body(gear: Gear, *, sizes: MeshSizes | None = None, plane: Plane = Plane.STRAIN, nodal: bool = False) -> PlaneCompliance:
    """All teeth, with four modules of rim."""
    sizes = sizes or MeshSizes()
    root = abs(gear.root_diameter) / 2
    radius = root + 4 * gear.normal_module if gear.internal else max(root - 4 * gear.normal_module, 0.3 * root)
    fine, coarse = mesh_sector(gear, radius, sizes), mesh_sector(gear, radius, sizes.coarse())
    elasticity = PlaneElasticity(STEEL, plane)
    ring = assemble(fine, coarse, gear.tooth_count, 1, elasticity, None, Cuts.FIXED)
    return (nodal_compliance if nodal else flank_compliance)(gear, ring, elasticity)


@pytest.fixture(scope="module", params=GEARS)
def solved(request: Any) -> PlaneCompliance:
    return body(GEARS[request.param])


# Flamant


@pytest.mark.parametrize("radius", [0.01, 1.0, 30.0])
def test_tractions_on_any_half_circle_carry_the_load(radius: float) -> None:
    angle, weight = np.polynomial.legendre.leggauss(40)
    angle, weight = angle * np.pi / 2, weight * np.pi / 2 * radius
    normals = np.cos(angle)[:, None] * INWARD + np.sin(angle)[:, None] * ACROSS
    traction = flamant_traction(radius * normals, normals, np.zeros(2), INWARD)
    assert weight @ traction == pytest.approx(-INWARD, abs=1e-12)


@pytest.mark.parametrize("elasticity", PLANES, ids=lambda each: each.plane.value)
def test_displacements_belong_to_the_stress(elasticity: PlaneElasticity) -> None:
    """Strains by central differences, through Hooke's law, are the tractions on three planes."""
    points, step = np.array([[0.4, 0.3], [1.0, -1.9], [0.02, -0.05]]), 1e-6
    load = np.array([0.1, 0.2])
    points = points + load + 0.5 * INWARD
    gradient = np.stack(
        [
            (
                flamant_displacement(points + step * unit, load, INWARD, elasticity)
                - flamant_displacement(points - step * unit, load, INWARD, elasticity)
            )
            / (2 * step)
            for unit in np.eye(2)
        ],
        -1,
    )
    strain = (gradient + gradient.transpose(0, 2, 1)) / 2
    first, shear = elasticity.lame
    stress = first * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(2) + 2 * shear * strain
    for normal in (np.array([1.0, 0.0]), np.array([0.0, 1.0]), ACROSS):
        expected = flamant_traction(points, np.broadcast_to(normal, points.shape), load, INWARD)
        assert stress @ normal == pytest.approx(expected, rel=1e-5, abs=1e-6)


@pytest.mark.parametrize("elasticity", PLANES, ids=lambda each: each.plane.value)
def test_the_edge_is_free_and_moves_as_johnson_says(elasticity: PlaneElasticity) -> None:
    """Johnson 2.19: along the edge -(1 - nu) (1 - 2 nu)/(2 E) (1 + nu) P in plane strain, across it -2 P/(pi E') ln r."""
    distance = np.array([0.01, 0.5, 4.0])
    e, nu = elasticity.modulus, elasticity.ratio
    for sense in (1, -1):
        points = sense * distance[:, None] * ACROSS
        moved = flamant_displacement(points, np.zeros(2), INWARD, elasticity)
        assert moved @ INWARD == pytest.approx(edge_displacement(distance, elasticity), rel=1e-12)
        across = np.array([-INWARD[1], INWARD[0]])
        assert moved @ across == pytest.approx(-np.sign(points @ across) * (1 - nu) / (2 * e), rel=1e-9)
        assert flamant_traction(points, np.tile(-INWARD, (3, 1)), np.zeros(2), INWARD) == pytest.approx(0, abs=1e-12)
    assert edge_displacement(np.array([1.0, math.e]), elasticity) == pytest.approx(
        [-(1 + nu) / (math.pi * e), -(3 + nu) / (math.pi * e)], rel=1e-12
    )


def test_plane_strain_constants() -> None:
    """E/(1 - nu^2) and nu/(1 - nu), and Lame's constants of space, which plane strain leaves as they are."""
    strain, stress = (PlaneElasticity(Material(youngs_modulus=200e3, poisson_ratio=0.25), plane) for plane in Plane)
    assert (strain.modulus, strain.ratio) == pytest.approx((200e3 / 0.9375, 1 / 3))
    assert (stress.modulus, stress.ratio) == (200e3, 0.25)
    assert strain.lame == pytest.approx((80e3, 80e3))


# The flank


def test_roll_lengths_and_normals_are_the_involutes(solved: PlaneCompliance) -> None:
    flank = solved.flank
    points = solved.ring.sector.mesh.points[flank.nodes]
    found = np.array([flank.points(float(length)) for length in flank.lengths])
    assert np.abs(found - points).max() < 1e-9 * flank.gear.normal_module
    # The line of a normal touches the base circle at the roll length: its moment about the axis is -r_b.
    inward = flank.inward(flank.lengths)
    moment = points[:, 0] * inward[:, 1] - points[:, 1] * inward[:, 0]
    assert moment == pytest.approx(-flank.base_radius, rel=1e-9)


def test_a_unit_load_turns_the_hub_by_the_base_radius(solved: PlaneCompliance) -> None:
    """Far inside the half per cent that the check permits; near the tip Flamant's tractions are hard to integrate."""
    assert solved.torques == pytest.approx(-solved.flank.base_radius, rel=2e-4)
    middle = solved.loads[len(solved.loads) // 2]
    assert solved.hub_torque(float(middle)) == pytest.approx(solved.flank.base_radius, rel=2e-4)


def test_response_is_symmetric(solved: PlaneCompliance) -> None:
    """Maxwell and Betti: u at x by a load at y is u at y by one at x - also between two teeth."""
    lengths = np.linspace(solved.loads[0], solved.loads[-1], 30)[1:-2]
    own = solved.response(0)(lengths, lengths)
    scale = np.abs(own).max()
    assert np.abs(own - own.T).max() < 6e-4 * scale
    ahead, behind = (solved.response(tooth)(lengths, lengths) for tooth in (1, -1))
    assert np.abs(ahead - behind.T).max() < 1e-3 * np.abs(ahead).max()


def test_response_does_not_depend_on_the_mesh_of_the_flank() -> None:
    """Nothing is resolved there, so nothing need be: the smooth part on meshes of sizes one to three."""
    gear = GEARS["z18"]
    bodies = [body(gear, sizes=replace(MeshSizes(), flank=size)) for size in (0.13, 0.04)]
    lengths = np.linspace(bodies[0].loads[0], bodies[0].loads[-1], 30)[2:-3]
    coarse, fine = (each.response(0)(lengths, lengths) for each in bodies)
    assert np.abs(coarse - fine).max() < 1e-3 * np.abs(fine).max()


def test_nodes_without_subtraction_tell_the_same_at_a_distance() -> None:
    """Two loads half a module apart see each other alike, whether Flamant is taken off or not; one tooth sees the next."""
    gear = GEARS["z18"]
    hybrid, nodal = body(gear), body(gear, sizes=replace(MeshSizes(), flank=0.04), nodal=True)
    lengths = np.linspace(hybrid.loads[0], hybrid.loads[-1], 12)[1:-1]
    arc = hybrid.flank.arc(lengths)
    distance = np.abs(arc[:, None] - arc)
    far = distance > 0.5 * gear.normal_module
    edge = edge_displacement(np.where(far, distance, 1.0), hybrid.elasticity)
    whole, expected = hybrid.response(0)(lengths, lengths) + edge, nodal.response(0)(lengths, lengths)
    assert whole[far] == pytest.approx(expected[far], rel=2e-3)
    assert hybrid.response(1)(lengths, lengths) == pytest.approx(nodal.response(1)(lengths, lengths), rel=2e-3)


def test_another_constant_of_the_logarithm_changes_nothing() -> None:
    """Responses are those of a body, not of Flamant's: with lengths in another unit they only change by the unit."""
    small, large = (body(replace(GEARS["z18"], normal_module=module)) for module in (0.1, 20.0))
    lengths = np.linspace(small.loads[0], small.loads[-1], 9)[1:-1]
    # The edge's part is taken off at d in mm: its logarithm shifts the regular part by a constant.
    shift = 2 * math.log(200) / (math.pi * small.elasticity.modulus)
    whole = small.response(0)(lengths, lengths)
    assert large.response(0)(200 * lengths, 200 * lengths) - shift == pytest.approx(whole, rel=1e-5)
    assert large.response(1)(200 * lengths, 200 * lengths) == pytest.approx(small.response(1)(lengths, lengths), rel=1e-5)


# The root


def test_tension_below_the_load_and_compression_behind(solved: PlaneCompliance) -> None:
    """A load near the tip bends the tooth: the fillet below it is stretched, the other one pressed a little more."""
    fillets = Fillets(solved)
    load = [ToothLoad(0, float(solved.loads[-4]), 100.0)]
    tension, compression = fillets.greatest(OutlineSide.LEFT_FILLET, load), fillets.greatest(OutlineSide.RIGHT_FILLET, load)
    assert 1.05 < -compression.stress / tension.stress < 1.5
    assert 12 <= tension.tangent_angle < 60
    root, form = solved.flank.gear.root_diameter / 2, solved.flank.gear.form_diameter / 2
    assert root <= math.copysign(tension.radius, root) < form


def test_loads_on_two_teeth_superpose(solved: PlaneCompliance) -> None:
    fillets = Fillets(solved)
    loads = [ToothLoad(0, float(solved.loads[3]), 60.0), ToothLoad(1, float(solved.loads[-6]), 40.0)]
    both = fillets.stresses(OutlineSide.LEFT_FILLET, loads)
    alone = sum(fillets.stresses(OutlineSide.LEFT_FILLET, [load]) for load in loads)
    assert both == pytest.approx(alone, rel=1e-12)
    far, own = (fillets.stresses(OutlineSide.LEFT_FILLET, [loads[1]._replace(tooth=tooth)]) for tooth in (1, 0))
    assert 0.05 < np.abs(far).max() / np.abs(own).max() < 0.5


def test_fillet_angles_run_from_the_flank_to_the_root(solved: PlaneCompliance) -> None:
    for side in (OutlineSide.LEFT_FILLET, OutlineSide.RIGHT_FILLET):
        radii, angles = Fillets(solved).places(side)
        inwards = np.argsort(-solved.flank.upward * radii)
        # Where a tooth is undercut the fillet leans the other way at first.
        upright = int(np.argmin(angles[inwards]))
        assert np.all(np.diff(angles[inwards][: upright + 1]) < 0)
        assert np.all(np.diff(angles[inwards][upright:]) > 0)
        assert angles.min() < 30 < 60 < angles.max()
