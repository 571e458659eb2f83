"""Tetrahedra of whole gears: against formulas of the tests' own, and against each other (reference, identity)."""

import math
import signal
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from support.clearance import distance_to_section, solid_volume
from support.modified import depth_off, removed_volume, unturned
from support.samples import modified

from gearcad import Body, Gear
from gearcad.core.errors import ParameterError
from gearcad.geometry import HubSide
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.bodies.exactness import deviations
from gearcad.meshing.bodies.gear_faces import Stage, TetrahedronGrading
from gearcad.meshing.bodies.quality import measure_side, measure_whole, quality, require_good
from gearcad.meshing.bodies.tetrahedra import mesh_tetrahedra

EXACT = 1e-9
"""mm: what is promised of nodes."""

ROUND = 1e-4
"""Relative: what a circle of 24 edges of second order leaves out is a hundred-thousandth."""

_KEYED = Body(bore=10, keyway_width=3, keyway_depth=1.2, hub_diameter=15, hub_length=2, hub_side=HubSide.BOTH)
PART = modified(
    Gear(
        teeth=12,
        normal_module=2,
        face_width=4,
        helix_angle=25,
        profile_shift=0.5,
        body=replace(_KEYED, end_chamfer=0.6, tip_chamfer=0.2),
    )
)
"""Helical teeth with all modifications, both chamfers, two hubs, bore and keyway."""

COARSE = TetrahedronGrading(deviation=None)

SPUR = Gear(teeth=9, normal_module=1, face_width=1.5, profile_shift=0.4, body=Body(bore=3))

THIN = replace(SPUR, teeth=12, normal_module=0.5, face_width=0.3, body=Body(bore=3))


@pytest.fixture(scope="module")
def part() -> ElementMesh:
    return mesh_tetrahedra(PART, size=2.0, grading=replace(COARSE, growth=0.5))


@pytest.fixture(scope="module")
def spur() -> ElementMesh:
    return mesh_tetrahedra(SPUR, size=0.6, refined_teeth=[-1], grading=COARSE)


@pytest.fixture(scope="module")
def thin() -> ElementMesh:
    return mesh_tetrahedra(THIN, size=0.6)


def nodes_of(mesh: ElementMesh, *words: str) -> np.ndarray:
    """Places (n, 3) of the nodes on sides with one of these words in their names."""
    names = [name for name in mesh.sides if any(word in name for word in words)]
    return mesh.points[np.unique(np.concatenate([mesh.nodes(name) for name in names]))]


@pytest.mark.long
def test_nodes_are_on_the_modified_flanks(part: ElementMesh) -> None:
    """Those between vertices too; and those of fillets and tip chamfers are turned with the ends of the flanks."""
    flanks, fillets = nodes_of(part, "flank"), nodes_of(part, "fillet")
    assert len(flanks) > 500 and len(fillets) > 500
    assert np.abs(depth_off(PART, flanks)).max() < EXACT
    assert distance_to_section(PART, unturned(PART, fillets)).max() < EXACT
    tips = nodes_of(part, "tip")
    inside = np.hypot(*tips[:, :2].T) < PART.tip_diameter / 2 - EXACT
    assert inside.sum() > 50
    assert distance_to_section(PART, unturned(PART, tips[inside])).max() < EXACT


def test_nodes_are_on_the_other_faces(part: ElementMesh) -> None:
    width, body = PART.face_width, PART.body

    def radius(points: np.ndarray) -> np.ndarray:
        return np.hypot(points[:, 0], points[:, 1])

    for name, wanted in (("bore", body.bore), ("root", PART.root_diameter), ("tip", PART.tip_diameter)):
        points = nodes_of(part, name)
        if name == "tip":
            points = points[radius(points) > wanted / 2 - 0.01]
        assert radius(points) == pytest.approx(wanted / 2, abs=EXACT)
    assert radius(part.points[part.nodes("hub")]) == pytest.approx(body.hub_diameter / 2, abs=EXACT)
    heights = {"end_back": 0.0, "end_front": width, "hub_back": -body.hub_length, "hub_front": width + body.hub_length}
    for name, height in heights.items():
        assert part.points[part.nodes(name), 2] == pytest.approx(height, abs=EXACT)
    cones = part.points[part.nodes("end_chamfers")]
    setback = np.minimum(cones[:, 2], width - cones[:, 2])
    slope = math.tan(math.radians(body.end_chamfer_angle))
    assert radius(cones) == pytest.approx(PART.tip_diameter / 2 - (body.end_chamfer - setback) * slope, abs=EXACT)


def test_sides_are_the_whole_surface(part: ElementMesh) -> None:
    """Every face that one tetrahedron has to itself is on one side, and no other face on any."""
    faces = part.cells[:, [face[:3] for face in part.element.shape.faces]].reshape(-1, 3)
    once, counts = np.unique(np.sort(faces, -1), axis=0, return_counts=True)
    named = np.concatenate([part.face_cells(name)[:, :3] for name in part.sides])
    assert counts.max() == 2
    assert np.array_equal(once[counts == 1], np.unique(np.sort(named, -1), axis=0))
    assert (counts == 1).sum() == len(named)
    of_teeth = {f"{side}_{part}" for side in ("left", "right") for part in ("flank", "fillet", "root")} | {"tip"}
    wanted = {f"{name}_{tooth}" for name in of_teeth for tooth in range(PART.teeth)}
    others = {"bore", "keyway", "hub", "hub_back", "hub_front", "end_back", "end_front", "end_chamfers"}
    assert set(part.sides) == wanted | others


def test_sides_of_teeth_are_where_their_names_say(part: ElementMesh) -> None:
    """Left is ahead, counter-clockwise, and numbers grow that way; seen in the middle of the face width."""
    for side, sign in (("left", 1), ("right", -1)):
        for tooth in (0, 5, PART.teeth - 1):
            x, y, z = part.points[part.nodes(f"{side}_flank_{tooth}")].T
            twist = 2 * z * math.tan(math.radians(PART.helix_angle)) / PART.reference_diameter
            angle = np.arctan2(y, x) - twist - 2 * math.pi * tooth / PART.teeth
            off = np.mod(angle + math.pi, 2 * math.pi) - math.pi
            assert (sign * off > 0).all() and (np.abs(off) < math.pi / PART.teeth).all()


def test_volume_and_areas_are_exact(part: ElementMesh) -> None:
    body, length = PART.body, PART.face_width + 2 * PART.body.hub_length
    assert measure_whole(part) == pytest.approx(solid_volume(PART) - removed_volume(PART), rel=ROUND)
    angle = 2 * math.pi - 2 * math.asin(body.keyway_width / body.bore)
    assert measure_side(part, "bore").size == pytest.approx(angle * body.bore / 2 * length, rel=ROUND)
    assert measure_side(part, "hub").size == pytest.approx(math.pi * body.hub_diameter * 2 * body.hub_length, rel=ROUND)
    assert measure_side(part, "hub_back").size == pytest.approx(measure_side(part, "hub_front").size, rel=ROUND)


def test_elements_are_good(part: ElementMesh, spur: ElementMesh) -> None:
    for mesh in (part, spur):
        require_good(quality(mesh))


def test_faces_bulge_as_flanks_do(thin: ElementMesh) -> None:
    """0.5 µm between nodes is promised of default sizes."""
    off = deviations(thin, THIN)
    assert off.nodes < EXACT
    assert off.between < 0.5


def test_linear_fields_are_exact(thin: ElementMesh) -> None:
    """The patch test: what is linear on the surface is so inside, curved elements or not."""
    from skfem import Basis, ElementTetP2, condense, solve
    from skfem.models.poisson import laplace

    from gearcad.meshing.bodies.element_mesh import skfem_mesh

    mesh = skfem_mesh(thin)
    basis = Basis(mesh, ElementTetP2())
    exact = basis.project(lambda x: 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2])
    found = solve(*condense(laplace.assemble(basis), x=exact, D=basis.get_dofs()))
    assert np.abs(found - exact).max() < 1e-8 * np.abs(exact).max()


def test_refined_teeth_have_finer_edges(spur: ElementMesh) -> None:
    """Tooth -1 is the last one."""
    last = SPUR.teeth - 1
    assert len(spur.sides[f"left_flank_{last}"]) > 4 * len(spur.sides["left_flank_3"])
    assert len(spur.sides[f"right_fillet_{last}"]) > 4 * len(spur.sides["right_fillet_3"])


@pytest.mark.long
def test_as_many_elements_as_asked_for() -> None:
    stages: list[Stage] = []
    mesh = mesh_tetrahedra(SPUR, elements=25_000, stage=stages.append)
    assert len(mesh.cells) == pytest.approx(25_000, rel=0.2)
    assert stages[:3] == list(Stage)


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(
        ParameterError, match=r"size = .*: makes about .*e\+.* tetrahedra, which must be at most 10000000; the narrow"
    ):
        mesh_tetrahedra(SPUR, size=0.001)
    with pytest.raises(ParameterError, match=r"elements = 20: must be at least about \d+ for this gear"):
        mesh_tetrahedra(SPUR, elements=20)
    with pytest.raises(ParameterError, match="size = 1: must be given in mm, or else a number of elements"):
        mesh_tetrahedra(SPUR, size=1.0, elements=10_000)
    with pytest.raises(ParameterError, match="refined_teeth = 9: must be a whole number from -8 to 8"):
        mesh_tetrahedra(SPUR, size=1.0, refined_teeth=[9])


@pytest.fixture
def interrupts_as_they_were() -> Iterator[None]:
    """Whatever the one who started these tests wants of them."""
    kept = signal.getsignal(signal.SIGINT)
    yield
    signal.signal(signal.SIGINT, kept)


def interrupt(_stage: object) -> None:
    signal.raise_signal(signal.SIGINT)


@pytest.mark.usefixtures("interrupts_as_they_were")
def test_an_interrupt_leaves_nothing_behind() -> None:
    """It is raised, gmsh is closed, and the next interrupt is as any."""
    import gmsh

    signal.signal(signal.SIGINT, signal.default_int_handler)
    with pytest.raises(KeyboardInterrupt):
        mesh_tetrahedra(SPUR, size=0.6, stage=interrupt)
    assert not gmsh.isInitialized()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.usefixtures("interrupts_as_they_were")
def test_an_interrupt_that_is_ignored_is_none() -> None:
    """As below nohup."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    assert len(mesh_tetrahedra(SPUR, size=2.0, stage=interrupt).points)
