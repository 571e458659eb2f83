"""Sections of any gear, modified or not, are filled by good elements on the exact outline, with named sides."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from support.checks import COARSE
from support.clearance import distance_to_section, section_area
from support.modified import depth_off, unturned
from support.strategies import MODIFICATIONS, build_gear, gear_inputs, modified

from gearcad import Gear
from gearcad.contact.solid.pair import SolidSizes
from gearcad.core.errors import GeometryError, InputError, SolverError
from gearcad.geometry.gear_data import twist
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.exactness import deviations
from gearcad.meshing.bodies.quality import measure_side, measure_whole, quality, require_good
from gearcad.meshing.bodies.section_mesh import mesh_section
from gearcad.meshing.bodies.sectors import ContactRefinement
from gearcad.meshing.fem import scaled_jacobians
from gearcad.meshing.outline import OutlineSide
from gearcad.meshing.quads import QuadMesh, SectorLayout, mesh_quads

SIZES = SolidSizes().section

LEAST_JACOBIAN = 0.2
"""Of the worst quadrangle: its sharpest corner has 12 degrees. A thousand gears drawn had 0.35; a mesher refuses 0.1."""

FOLLOWS = 0.10
"""How far the number of quadrangles may be from the square of the refinement."""

FEWEST = 1.5
"""Edges that the sizes must ask for on each side of a block for the number to follow: whole numbers are coarse below."""

ROUNDING = 1e-9

RIMS = st.one_of(st.just(None), st.floats(0.1, 1.0), st.floats(0.1, 40.0))
"""Body below the root circle in normal modules; None for four, as a check has it without a bore."""


def inner_radius(gear: Gear, rim: float | None) -> float:
    root = gear.root_diameter / 2
    return max(root - (rim or 4.0) * gear.normal_module, 0.3 * root)


def check_section(gear: Gear, rim: float | None, factor: float) -> None:
    radius = inner_radius(gear, rim)
    mesh = mesh_quads(gear, radius, SIZES)
    assert scaled_jacobians(Element.QUAD8, mesh.points[mesh.quads]).min() > LEAST_JACOBIAN
    check_outline(gear, mesh, radius)
    other = SIZES.scaled(factor)
    # A body thinner than an element, or a fillet shorter than one, gets one all the same.
    if min(min(SectorLayout(gear, radius, sizes).wanted) for sizes in (SIZES, other)) > FEWEST:
        event("followed")
        assert len(mesh_quads(gear, radius, other).quads) / len(mesh.quads) == pytest.approx(factor**2, rel=FOLLOWS)


def check_outline(gear: Gear, mesh: QuadMesh, radius: float) -> None:
    """One closed line of edges that belong to one quadrangle each; on the profile; cuts that fit each other."""
    chain = [int(node) for nodes in mesh.sides.values() for node in nodes[:-1]]
    assert len(set(chain)) == len(chain)
    nodes, uses = np.unique(mesh.quads[:, 4:], return_counts=True)
    assert set(nodes[uses == 1].tolist()) == {node for node in chain if node >= mesh.vertices}
    places = mesh.points / gear.tip_diameter
    for side in (OutlineSide.LEFT_FLANK, OutlineSide.LEFT_FILLET, OutlineSide.RIGHT_FLANK, OutlineSide.RIGHT_FILLET):
        x, y = places[mesh.sides[side]].T
        distance = np.hypot(x, y) * gear.tip_diameter
        steep = distance > gear.root_diameter / 2 * (1 + 1e-6)  # below, a radius says little about the angle
        expected = np.radians(gear.profile.half_angle(distance))
        assert np.abs(np.abs(np.arctan2(y, x)) - expected)[steep].max(initial=0.0) < ROUNDING
    pitch = 2 * math.pi / gear.teeth
    turn = np.array([[math.cos(pitch), math.sin(pitch)], [-math.sin(pitch), math.cos(pitch)]])
    assert np.abs(places[mesh.behind] @ turn - places[mesh.ahead]).max() < ROUNDING
    assert np.abs(np.hypot(*mesh.points[mesh.sides[OutlineSide.HELD]].T) - radius).max() < ROUNDING * gear.tip_diameter


def check_inputs(inputs: dict[str, Any], rim: float | None, factor: float) -> None:
    try:
        gear = build_gear(inputs)
    except InputError as error:
        event(f"refused: {error.parameter}")
        return
    try:
        check_section(gear, rim, factor)
    except GeometryError as error:
        event("no fillet")
        assert error.parameter == "rack.root_radius" and gear.rack.root_radius < 1e-6
    else:
        event("section")


@settings(max_examples=60)
@given(gear_inputs(), RIMS, st.floats(0.7, 2.5))
def test_sections_are_good_meshes(inputs: dict[str, Any], rim: float | None, factor: float) -> None:
    check_inputs(inputs, rim, factor)


@pytest.mark.long
@settings(max_examples=1500)
@given(gear_inputs(), RIMS, st.floats(0.7, 2.5))
def test_sections_are_good_meshes_long(inputs: dict[str, Any], rim: float | None, factor: float) -> None:
    check_inputs(inputs, rim, factor)


BULGE = 2e-4
"""How far edges may be from the exact outline between nodes, in normal modules."""

FARTHER, MODIFIED = 1.5, 3.0
"""How many times as far they are where the bend changes along them, and where modifications bend the flanks, too."""

MESH_SIZES = replace(COARSE, deviation=BULGE)

OFF = 1e-9
"""mm, for gears up to a metre: the promise; of larger ones the share of it that rounding takes."""

FEW, SHARP = 6, 1e-3
"""Teeth that may have necks too thin for coarse elements; tool tips, in normal modules, that leave fillets as small as dust.

And modifications may take more than a fillet is long: any of them can be refused, in a line that says where.
"""

MOST = 30
"""Teeth of which all are meshed in a quick test."""

MESH_RIMS = st.one_of(st.none(), st.floats(0.1, 1.0), st.floats(0.1, 10.0))
"""Body below the root circle in normal modules; None: no bore."""

TEETH = st.sampled_from([1, 3, None])

ZONES = st.one_of(st.none(), st.tuples(st.floats(0, 1), st.floats(0.005, 0.1), st.booleans()))
"""Place on the flank, edge in normal modules, whether on the left."""


def zone_of(gear: Gear, drawn: tuple[float, float, bool]) -> ContactRefinement:
    share, edge, left = drawn
    form = gear.flank_form
    length = form.first + share * (form.last - form.first)
    return ContactRefinement(length=length, half_width=3 * edge * gear.normal_module, edge=edge * gear.normal_module, left=left)


def check_mesh(
    gear: Gear, rim: float | None, teeth: int | None, element: Element, zone: tuple[float, float, bool] | None
) -> None:
    if gear.teeth > MOST or (teeth is not None and teeth >= gear.teeth):
        teeth = 1
    root = gear.root_diameter / 2
    inner = max(root - (rim or 4.0) * gear.normal_module, 0.3 * root)
    if rim is None and teeth is None:
        inner = 0.0
    contacts = {0: zone_of(gear, zone)} if zone else {}
    mesh = mesh_section(gear, teeth=teeth, held_radius=inner, sizes=MESH_SIZES, element=element, contacts=contacts)
    require_good(quality(mesh))
    check_sides(gear, mesh, teeth)
    check_nodes(gear, mesh)
    check_area(gear, mesh, inner, teeth)


def check_sides(gear: Gear, mesh: ElementMesh, teeth: int | None) -> None:
    """Every edge of the boundary is in one side; cuts turn into each other."""
    middles, uses = np.unique(mesh.cells[:, mesh.element.shape.vertices :], return_counts=True)
    named = np.concatenate([mesh.face_cells(name)[:, 2] for name in mesh.sides])
    assert sorted(named.tolist()) == middles[uses == 1].tolist()
    if teeth is not None:
        behind, ahead = mesh.points[mesh.matched["cut"]].transpose(1, 0, 2)[:, :, :2]
        turn = 2 * math.pi * teeth / gear.teeth
        turned = behind @ np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
        assert np.abs(turned - ahead).max() < 1e-12 * gear.tip_diameter


def check_nodes(gear: Gear, mesh: ElementMesh) -> None:
    """Nodes are on flanks and fillets as they are at mid face width; fillets that fade are looked at by others."""
    off, middle = OFF * max(1.0, gear.tip_diameter / 1000), gear.face_width / 2
    turn = twist(gear, middle)
    x, y = mesh.points[:, :2].T
    lifted = np.stack(
        [math.cos(turn) * x - math.sin(turn) * y, math.sin(turn) * x + math.cos(turn) * y, np.full_like(x, middle)], -1
    )
    for side in ("left", "right"):
        flank, fillet = (lifted[mesh.nodes(f"{side}_{part}_0")] for part in ("flank", "fillet"))
        assert np.abs(depth_off(gear, flank)).max() < off
        if not gear.modification.present or "left_root_0" in mesh.sides:
            assert distance_to_section(gear, unturned(gear, fillet)).max() < off


def check_area(gear: Gear, mesh: ElementMesh, inner: float, teeth: int | None) -> None:
    """The surface is as near to the exact one as was asked for, and so is what it encloses."""
    bulge = BULGE * gear.normal_module * (MODIFIED if gear.modification.present else FARTHER)
    if not gear.modification.present or "left_root_0" in mesh.sides:  # on coarse edges fillets that fade bulge more
        assert deviations(mesh, gear).between < 1000 * bulge
    if not gear.modification.present:
        exact = (section_area(gear) - math.pi * inner**2) * (teeth or gear.teeth) / gear.teeth
        around = sum(measure_side(mesh, name).size for name in mesh.sides)
        assert abs(measure_whole(mesh) - exact) < bulge * around


def mesh_check_inputs(inputs: dict[str, Any], drawn: dict[str, float] | None, how: tuple[Any, ...]) -> None:
    plain = {"bore": 0.0, "keyway": 0.0, "hub": 0.0, "end_chamfer": 0.0}
    inputs |= {"body": inputs["body"] | plain}
    try:
        gear = modified(build_gear(inputs), drawn)
    except InputError as error:
        event(f"no gear: {error.parameter}")
        return
    try:
        check_mesh(gear, *how)
    except GeometryError as error:
        event("no fillet")
        assert error.parameter == "rack.root_radius" and gear.rack.root_radius < 1e-6
    except SolverError as error:
        event("refused")
        assert "distorted" in str(error)
        assert gear.modification.present or gear.teeth < FEW or gear.profile.tool.radius < SHARP * gear.normal_module
    else:
        event("meshed, modified" if drawn else "meshed")


DRAWN = (gear_inputs(), MODIFICATIONS, st.tuples(MESH_RIMS, TEETH, st.sampled_from([Element.QUAD8, Element.TRI6]), ZONES))


@settings(max_examples=25)
@given(*DRAWN)
def test_section_meshes_are_good(inputs: dict[str, Any], drawn: dict[str, float] | None, how: tuple[Any, ...]) -> None:
    mesh_check_inputs(inputs, drawn, how)


@pytest.mark.long
@settings(max_examples=3000)
@given(*DRAWN)
def test_section_meshes_are_good_long(inputs: dict[str, Any], drawn: dict[str, float] | None, how: tuple[Any, ...]) -> None:
    mesh_check_inputs(inputs, drawn, how)
