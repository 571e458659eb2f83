"""How many elements a mesh has is known before it is made, and as many are made as are asked for."""

from __future__ import annotations

import pytest

from gearcad import Body, Gear
from gearcad.core.errors import ParameterError
from gearcad.meshing.bodies.body_mesh import Amount, body_sizes, expected_amount, factor_for, mesh_body
from gearcad.meshing.bodies.element_mesh import Element, ElementMesh
from gearcad.meshing.bodies.exactness import deviations
from gearcad.meshing.bodies.section_mesh import mesh_section
from gearcad.meshing.bodies.sectors import ContactRefinement

GEARS = {
    "z7": Gear(teeth=7, normal_module=2.0, face_width=4, profile_shift=0.4),
    "z17 full radius": Gear(teeth=17, normal_module=0.5, face_width=3, profile_shift=0.2, body=Body(tip_chamfer=0.05)),
    "z30": Gear(teeth=30, normal_module=5.0, face_width=8, helix_angle=20),
}

ZONES = {-1: ContactRefinement(length=5.0, half_width=0.2, edge=0.05)}


def amount(mesh: ElementMesh) -> Amount:
    return Amount(len(mesh.cells), len(mesh.points), mesh.nbytes)


@pytest.mark.parametrize("name", GEARS)
@pytest.mark.parametrize("element", [Element.QUAD8, Element.TRI6])
@pytest.mark.parametrize(("teeth", "share"), [(1, 0.7), (5, 0.5), (None, 0.0)])
def test_sections_have_as_many_elements_as_expected(teeth: int | None, share: float, element: Element, name: str) -> None:
    gear = GEARS[name]
    radius = share * gear.root_diameter / 2
    contacts = ZONES if name == "z30" else {}
    what = dict(teeth=teeth, held_radius=radius, sizes=body_sizes(gear).scaled(0.4), element=element)
    found = amount(mesh_section(gear, **what, contacts=contacts))
    expected = expected_amount(gear, **what, contacts=contacts)
    if element is Element.TRI6 and not share:
        assert expected == pytest.approx(found, rel=2e-3), "where gmsh fills a disc, it hangs on the last digits"
    else:
        assert expected == found


@pytest.mark.parametrize("element", [Element.HEX8, Element.HEX20])
@pytest.mark.parametrize(("teeth", "share"), [(3, 0.7), (None, 0.0)])
def test_bodies_have_as_many_elements_as_expected(teeth: int | None, share: float, element: Element) -> None:
    gear = GEARS["z7"]
    what = dict(teeth=teeth, held_radius=share * gear.root_diameter / 2, sizes=body_sizes(gear, 1.5), element=element)
    assert expected_amount(gear, **what) == amount(mesh_body(gear, **what, planes=None))


@pytest.mark.parametrize("name", GEARS)
@pytest.mark.parametrize(
    ("element", "teeth", "elements"),
    [
        (Element.QUAD8, 1, 150),
        (Element.QUAD8, None, 100_000),
        (Element.TRI6, 1, 1000),
        (Element.HEX20, None, 10**6),
        (Element.HEX8, 3, 10**7),
    ],
)
def test_as_many_elements_as_asked_for(element: Element, teeth: int | None, elements: int, name: str) -> None:
    gear = GEARS[name]
    usual = body_sizes(gear)

    def count(factor: float) -> int:
        sizes = usual.scaled(factor)
        radius = 0.7 * gear.root_diameter / 2
        return expected_amount(gear, teeth=teeth, held_radius=radius, sizes=sizes, element=element).elements

    factor = factor_for(elements, count, element.shape.dimension)
    assert count(factor) == pytest.approx(elements, rel=0.1)


def test_what_no_layout_has_is_refused() -> None:
    with pytest.raises(ParameterError, match="near is 12"):
        factor_for(5, lambda factor: 12 * max(1, round(factor)), 2)
    with pytest.raises(ParameterError, match="elements"):
        factor_for(0, round, 2)
    with pytest.raises(ParameterError, match="tet10"):
        expected_amount(GEARS["z7"], teeth=None, held_radius=1.0, sizes=body_sizes(GEARS["z7"]), element=Element.TET10)


@pytest.mark.parametrize("element", [Element.QUAD8, Element.TRI6])
@pytest.mark.parametrize("module", [0.2, 20.0])
@pytest.mark.parametrize(("teeth", "shift"), [(6, 0.35), (14, -0.1), (200, 0.3)])
def test_usual_sizes_are_within_half_a_micrometre(teeth: int, shift: float, module: float, element: Element) -> None:
    gear = Gear(teeth=teeth, normal_module=module, face_width=module, profile_shift=shift)
    mesh = mesh_section(gear, teeth=1, held_radius=0.8 * gear.root_diameter / 2, sizes=body_sizes(gear), element=element)
    found = deviations(mesh, gear)
    assert found.nodes < 1e-9
    assert found.between < 0.5


def test_a_size_is_the_edge_on_the_flank() -> None:
    gear = GEARS["z30"]
    mesh = mesh_section(gear, teeth=1, held_radius=60.0, sizes=body_sizes(gear, 0.9), element=Element.TRI6)
    faces = mesh.points[mesh.face_cells("left_flank_0")[:, :2]]
    lengths = ((faces[:, 1] - faces[:, 0]) ** 2).sum(axis=1) ** 0.5
    assert lengths.max() == pytest.approx(0.9, rel=0.1)
