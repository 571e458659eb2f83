"""How far meshes are said to be from the exact gear: against closed forms, and what is promised of them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from support.modifying import AMOUNTS, GEARS, modified
from support.sections import COARSE

from gearcad import BasicRack, Gear
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.body_mesh import body_sizes, mesh_body
from gearcad.meshing.bodies.exactness import deviations, exact_volume
from gearcad.meshing.bodies.quality import measure_whole
from gearcad.meshing.bodies.section_mesh import mesh_section
from gearcad.meshing.outline import MeshSizes

PROMISED_NODES, PROMISED_BETWEEN = 1e-9, 0.5
"""mm, and µm for elements of second order at default size."""

STEEP = Gear(teeth=6, normal_module=2, face_width=8, helix_angle=45, profile_shift=0.5)
FADING = Gear(teeth=17, normal_module=3, face_width=9, helix_angle=-20, rack=BasicRack(root_radius="full"))

HIGHEST = {"tip_relief": 300.0, "root_relief": 300.0, "end_relief": 300.0, "lead_crowning": 300.0, "twist": 300.0}
STRETCHED = Gear(teeth=17, normal_module=5, face_width=10, helix_angle=10)
"""Its flank begins near the base circle: there a depth in proportion to the roll is far from a parabola of the arc."""

LARGE = Gear(teeth=23, normal_module=8.0, face_width=60, helix_angle=15)


def body(gear: Gear, sizes: MeshSizes = COARSE, element: Element = Element.HEX20) -> ElementMesh:
    inner = gear.root_diameter / 2 - 1.5 * gear.normal_module
    return mesh_body(gear, teeth=1, held_radius=inner, sizes=sizes, planes=None, element=element)


def only(mesh: ElementMesh, part: str) -> ElementMesh:
    return replace(mesh, sides={name: faces for name, faces in mesh.sides.items() if part in name})


@pytest.mark.parametrize("changed", [False, True])
@pytest.mark.parametrize("name", ["right hand", "spur"])
def test_a_turned_flank_is_off_by_its_lever(name: str, changed: bool) -> None:
    """Turned by delta, an involute helicoid moves by delta r_b cos beta_b along its normals, at every point of it."""
    gear = modified(GEARS[name]) if changed else GEARS[name]
    mesh, turn = body(gear), 1e-6
    turned = mesh.points @ np.array([[math.cos(turn), math.sin(turn), 0], [-math.sin(turn), math.cos(turn), 0], [0, 0, 1]])
    expected = turn * gear.base_diameter / 2 * math.cos(math.radians(gear.base_helix_angle))
    found = deviations(only(replace(mesh, points=turned), "flank"), gear)
    slopes = 0.03 if changed else 1e-5  # of the modified flank to the exact one; the flank is curved
    assert found.nodes == pytest.approx(expected, rel=slopes)
    assert deviations(only(mesh, "flank"), gear).nodes < 1e-6 * expected


def test_straight_edges_are_off_by_their_bulge() -> None:
    """L^2/(8 rho) in the middle of an edge, rho the roll length there."""
    gear = replace(GEARS["spur"], face_width=0.5)
    mesh = body(gear, MeshSizes(), Element.HEX8)
    ends = mesh.points[mesh.face_cells("left_flank_0")[:, :2], :2]
    lengths, middles = np.hypot(*np.diff(ends, axis=1)[:, 0].T), np.hypot(*ends.mean(axis=1).T)
    bulges = lengths**2 / 8 / np.sqrt(middles**2 - gear.base_diameter**2 / 4)
    found = deviations(only(mesh, "left_flank"), gear)
    assert found.between == pytest.approx(1000 * bulges.max(), rel=0.02) and found.worst == "left_flank_0"


@pytest.mark.parametrize(
    "gear",
    [
        *GEARS.values(),
        *map(modified, GEARS.values()),
        STEEP,
        modified(STEEP),
        modified(FADING),
        modified(LARGE, *HIGHEST, **HIGHEST),
        modified(STRETCHED, *AMOUNTS, **{name: 60.0 for name in AMOUNTS}),
    ],
)
def test_meshes_are_as_exact_as_promised(gear: Gear) -> None:
    """Nodes, faces between them, and the volume: no more than the deviation over all the surface."""
    mesh = body(gear, body_sizes(gear))
    found = deviations(mesh, gear)
    assert found.nodes < PROMISED_NODES
    assert found.between < PROMISED_BETWEEN
    exact = exact_volume(gear, gear.root_diameter / 2 - 1.5 * gear.normal_module)
    assert measure_whole(mesh) == pytest.approx(exact, rel=3e-6)


@pytest.mark.parametrize("element", [Element.TRI6, Element.QUAD8])
def test_sections_are_those_at_mid_face_width(element: Element) -> None:
    gear = modified(GEARS["left hand"])
    inner = gear.root_diameter / 2 - 1.5 * gear.normal_module
    found = deviations(mesh_section(gear, teeth=3, held_radius=inner, sizes=body_sizes(gear), element=element), gear)
    assert found.nodes < PROMISED_NODES and found.between < PROMISED_BETWEEN
