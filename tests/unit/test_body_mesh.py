"""Bodies in hexahedra: closed, named all over, cuts that fit, nodes where formulas of the tests' own have them."""

from __future__ import annotations

import math
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from support.checks import COARSE
from support.clearance import distance_to_section
from support.modified import depth_off, unturned
from support.samples import GEARS, modified

from gearcad import Body, Gear, ParameterError
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.body_mesh import body_planes, mesh_body, swept_notices
from gearcad.meshing.bodies.quality import quality
from gearcad.meshing.outline import MeshSizes

EXACT = 1e-9
"""mm: the promise; rounding is below 1e-13."""

KINDS = (Element.HEX8, Element.HEX20)


def body(gear: Gear, teeth: int | None = 1, element: Element = Element.HEX20, sizes: MeshSizes = COARSE) -> ElementMesh:
    inner = gear.root_diameter / 2 - 1.5 * gear.normal_module
    return mesh_body(gear, teeth=teeth, held_radius=inner, sizes=sizes, planes=None, element=element)


def flux(mesh: ElementMesh, faces: np.ndarray) -> float:
    """Volume (mm³) inside faces by their vertices: of tetrahedra with the origin, for both ways to halve a face."""
    a, b, c, d = (mesh.points[faces[:, k]] for k in range(4))
    return (
        float(sum(np.linalg.det(np.stack(corners, 1)).sum() for corners in ((a, b, c), (a, c, d), (a, b, d), (b, c, d)))) / 12
    )


@pytest.mark.parametrize("element", KINDS)
@pytest.mark.parametrize("teeth", [1, 3, None])
def test_names_cover_the_surface(element: Element, teeth: int | None) -> None:
    """Each side of an element that no other shares has one name, and faces look outwards: they hold the elements' volume."""
    gear = modified(GEARS["undercut"])
    mesh = body(gear, teeth, element)
    local = np.array(element.shape.faces)
    every = np.sort(mesh.cells[:, local[:, :4]].reshape(-1, 4), axis=1)
    _, first, uses = np.unique(every, axis=0, return_index=True, return_counts=True)
    assert uses.max() == 2
    named = np.concatenate([faces.elements.astype(int) * 6 + faces.sides for faces in mesh.sides.values()])
    assert sorted(named.tolist()) == sorted(first[uses == 1].tolist())
    assert len(np.unique(mesh.cells)) == len(mesh.points) == mesh.cells.max() + 1
    outside = flux(mesh, np.concatenate([mesh.face_cells(name) for name in mesh.sides]))
    inside = flux(mesh, mesh.cells[:, local].reshape(-1, local.shape[1]))
    assert outside == pytest.approx(inside, rel=1e-12) and outside > 0
    assert set(mesh.matched) == (set() if teeth is None else {"cut"})
    assert {"end_back", "end_front", "bore", "left_flank_0"} < set(mesh.sides)
    ends = [mesh.points[mesh.nodes(name), 2] for name in ("end_back", "end_front")]
    assert [set(z) for z in ends] == [{0.0}, {gear.face_width}]


@pytest.mark.parametrize("element", KINDS)
def test_cuts_turn_into_each_other(element: Element) -> None:
    gear = modified(GEARS["left hand"])
    mesh = body(gear, 3, element)
    behind, ahead = mesh.matched["cut"].T
    assert sorted(behind) == mesh.nodes("cut_behind").tolist() and sorted(ahead) == mesh.nodes("cut_ahead").tolist()
    turn = 3 * 2 * math.pi / gear.teeth
    turned = mesh.points[behind] @ np.array(
        [[math.cos(turn), math.sin(turn), 0], [-math.sin(turn), math.cos(turn), 0], [0, 0, 1]]
    )
    assert turned == pytest.approx(mesh.points[ahead], abs=EXACT)


@pytest.mark.parametrize("name", [*GEARS])
@pytest.mark.parametrize("changed", [False, True])
def test_nodes_are_on_the_helicoid(name: str, changed: bool) -> None:
    """Of all flanks and fillets, ends of the body included: turned back by the depth that is specified, on the screw."""
    gear = modified(GEARS[name]) if changed else GEARS[name]
    mesh = body(gear, 3)
    for side in ("left", "right"):
        for tooth in (gear.teeth - 1, 0, 1):
            flank, fillet = (mesh.points[mesh.nodes(f"{side}_{part}_{tooth}")] for part in ("flank", "fillet"))
            assert np.abs(depth_off(gear, flank)).max() < EXACT
            assert distance_to_section(gear, unturned(gear, fillet)).max() < EXACT
            assert distance_to_section(gear, unturned(gear, flank)).max() < EXACT
    middles = mesh.points[mesh.cells[:, 8:]] - mesh.points[mesh.cells[:, np.array(mesh.element.shape.edges)]].mean(axis=2)
    assert np.abs(middles[:, 8:, 2]).max() < EXACT, "half-way up"


def test_planes_are_where_reliefs_begin() -> None:
    gear = modified(GEARS["spur"], "end_relief")
    planes = body_planes(gear, COARSE)
    assert planes[0] == 0 and planes[-1] == gear.face_width and (np.diff(planes) > 0).all()
    for start in gear.flank_form.height_breaks:
        assert start in planes
    thick = np.diff(body_planes(replace(gear, face_width=100), MeshSizes()))
    assert thick[0] < thick[len(thick) // 2] / 2 and np.maximum(thick[1:] / thick[:-1], thick[:-1] / thick[1:]).max() < 1.5
    assert len(body_planes(gear, COARSE, layers=11)) == 12
    assert len(body_planes(replace(GEARS["spur"], face_width=0.1), COARSE)) == 3
    with pytest.raises(ParameterError, match="layers = 2: must be at least 3"):
        body_planes(gear, COARSE, layers=2)


@pytest.mark.parametrize(("element", "planes"), [("quad8", None), ("hex20", [0.0, 5.0]), ("hex20", [0.0, 6.0, 5.0, 10.0])])
def test_what_cannot_be_swept_is_refused(element: str, planes: list[float] | None) -> None:
    given = None if planes is None else np.array(planes)
    with pytest.raises(ParameterError, match="must"):
        mesh_body(GEARS["spur"], teeth=1, held_radius=20.0, sizes=COARSE, planes=given, element=Element(element))


def test_what_is_left_out_is_said() -> None:
    assert swept_notices(GEARS["spur"]) == []
    (notice,) = swept_notices(GEARS["chamfered"])
    assert notice.text == "hexahedra are swept along the helix, without keyway, hub and end chamfers; tet10 has them"
    (notice,) = swept_notices(Gear(teeth=20, normal_module=2.0, face_width=10, body=Body(end_chamfer=1)))
    assert "without end chamfers;" in notice.text


def test_meshing_takes_no_more_than_twice_the_mesh() -> None:
    """Of a modified ring; its quality takes no more either."""
    gear = modified(GEARS["right hand"])
    body(gear)  # what is imported the first time is no mesh
    tracemalloc.start()
    mesh = body(gear, None, sizes=replace(COARSE.refined(3), deviation=None))
    made = tracemalloc.get_traced_memory()[1]
    tracemalloc.reset_peak()
    assert quality(mesh).least_jacobian > 0.5
    measured = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert mesh.nbytes > 4e6 and max(made, measured) < 2 * mesh.nbytes
