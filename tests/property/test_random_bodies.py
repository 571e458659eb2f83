"""Bodies and solids of any gear: good hexahedra and tetrahedra, orders of elimination, valid closed solids."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st
from OCP.BRepCheck import BRepCheck_Analyzer
from support.checks import COARSE
from support.clearance import distance_to_section, solid_volume
from support.modified import depth_off, folded, removed_volume, unturned
from support.samples import random_gear
from support.strategies import MODIFICATIONS, build_gear, gear_inputs, modified, names_a_field

from gearcad import Gear
from gearcad.contact.solid.dissection import HalfTurn, Halves, dissected
from gearcad.core.errors import GeometryError, InputError, SolverError
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.body_mesh import mesh_body
from gearcad.meshing.bodies.exactness import deviations
from gearcad.meshing.bodies.gear_faces import TetrahedronGrading
from gearcad.meshing.bodies.quality import measure_whole, quality, require_good
from gearcad.meshing.bodies.tetrahedra import mesh_tetrahedra
from gearcad.meshing.outline import MeshSizes, OutlineSide
from gearcad.meshing.quads import mesh_quads
from gearcad.meshing.sector import SweptMesh, sweep
from gearcad.solids import gear_solid, tessellate

OFF = 1e-9
"""mm, for gears up to a metre: the promise; of larger ones the share of it that rounding takes."""

STEEP = 50.0
"""Degrees: up to this helix angle no gear is refused for its elements, but for those whose edges are straight."""

NEXT_TO_NOTHING = 1e-3
"""Normal modules: a land or fillet so short makes elements that no refinement makes less narrow."""

NOTHING = {"bore": 0.0, "keyway": 0.0, "hub": 0.0, "hub_side": "front", "end_chamfer": 0.0, "end_chamfer_angle": 45.0}
"""Of what a sweep leaves out, and of which many a gear could not be made."""

HALVES = (("left", "flank"), ("left", "fillet"), ("right", "flank"), ("right", "fillet"))

RIMS = st.one_of(st.floats(0.1, 1.0), st.floats(0.1, 10.0))
"""Body below the root circle in normal modules."""

WIDTHS = st.one_of(st.just(None), st.floats(0.1, 1.0), st.floats(10.0, 50.0))
"""Face width in normal modules; None: as drawn with the gear."""


def check_body(gear: Gear, rim: float, element: Element) -> None:
    root = gear.root_diameter / 2
    inner = max(root - rim * gear.normal_module, 0.3 * root)
    mesh = mesh_body(gear, teeth=1, held_radius=inner, sizes=COARSE, planes=None, element=element)
    check_nodes(gear, mesh)
    require_good(quality(mesh))


def check_nodes(gear: Gear, mesh: ElementMesh) -> None:
    """Nodes of flanks and fillets are on the modified helicoid, by two ways.

    Formulas of the tests' own know a flank by its half of the pitch: in which it stays if land is left between the fillets.
    """
    off = OFF * max(1.0, gear.tip_diameter / 1000)
    assert deviations(mesh, gear).nodes < off
    if gear.modification.present and ("left_root_0" not in mesh.sides or beyond(gear, mesh)):
        return
    for side in ("left", "right"):
        flank, fillet = (mesh.points[mesh.nodes(f"{side}_{part}_0")[::7]] for part in ("flank", "fillet"))
        assert np.abs(depth_off(gear, flank)).max() < off
        assert distance_to_section(gear, unturned(gear, fillet)).max() < off


def beyond(gear: Gear, mesh: ElementMesh) -> bool:
    """Whether some of tooth 0 is turned into the other half of its pitch, or of the next."""
    turned = [folded(gear, mesh.points[mesh.nodes(f"{side}_{part}_0")])[1] for side, part in HALVES]
    return bool(min(turned[0].min(), turned[1].min()) <= 0 or max(turned[2].max(), turned[3].max()) >= 0)


def check_inputs(
    inputs: dict[str, Any], drawn: dict[str, float] | None, rim: float, width: float | None, element: Element
) -> None:
    inputs |= {"body": NOTHING | {"tip_chamfer": inputs["body"]["tip_chamfer"]}}
    try:
        gear = modified(build_gear(inputs | ({} if width is None else {"width": width})), drawn)
    except InputError as error:
        event(f"no gear: {error.parameter}")
        return
    try:
        check_body(gear, rim, element)
    except GeometryError as error:
        event("no fillet")
        assert error.parameter == "rack.root_radius" and gear.rack.root_radius < 1e-6
    except SolverError as error:
        event("refused")
        assert "distorted" in str(error)
        assert abs(gear.helix_angle) > STEEP or element is Element.HEX8 or _shortest_curve(gear) < NEXT_TO_NOTHING
    else:
        event("meshed, modified" if drawn else "meshed")


def _shortest_curve(gear: Gear) -> float:
    """Length of the shortest curve of the profile over the normal module."""
    ends = [curve.points(np.array([0.0, 1.0])) for curve in gear.profile.curves]
    return min(float(np.hypot(*(end - start))) for start, end in ends) / gear.normal_module


DRAWN = (gear_inputs(), MODIFICATIONS, RIMS, WIDTHS, st.sampled_from([Element.HEX20, Element.HEX8]))


@settings(max_examples=40)
@given(*DRAWN)
def test_bodies_are_good_meshes(
    inputs: dict[str, Any], drawn: dict[str, float] | None, rim: float, width: float | None, element: Element
) -> None:
    check_inputs(inputs, drawn, rim, width, element)


@pytest.mark.long
@settings(max_examples=3000)
@given(*DRAWN)
def test_bodies_are_good_meshes_long(
    inputs: dict[str, Any], drawn: dict[str, float] | None, rim: float, width: float | None, element: Element
) -> None:
    check_inputs(inputs, drawn, rim, width, element)


EXACT = 1e-9
"""mm: what is promised of nodes."""

ROUND = 1e-4
"""Relative: what edges of second order leave out of round faces is a hundred-thousandth."""


SEEDS = (0, 1, 8, 12, 16, 19, 20, 22, 25, 28, 29, 30, 31, 32, 33, 36, 38)
"""Gears of less than 200,000 tetrahedra. Number 3 is refused: its chamfer begins 0.01 modules beside the root form circle."""


@pytest.mark.long
@pytest.mark.parametrize("seed", SEEDS)
def test_random_gears_are_meshed(seed: int) -> None:
    gear = random_gear(seed)
    mesh = mesh_tetrahedra(gear, size=gear.normal_module, grading=TetrahedronGrading(deviation=None))
    require_good(quality(mesh))
    assert deviations(mesh, gear).nodes < EXACT
    assert measure_whole(mesh) == pytest.approx(solid_volume(gear) - removed_volume(gear), rel=ROUND)


GEAR = Gear(teeth=20, normal_module=2.0, face_width=20, helix_angle=15)
SIZES = MeshSizes(flank=0.6, corner=0.3, fillet=0.3, outline=0.6, cut=0.5, rim=4.0, growth=0.45)


def halves_of(mesh: SweptMesh) -> Halves:
    section = mesh.section
    return dissected(HalfTurn(mesh), np.r_[section.behind, section.ahead], mesh.side(OutlineSide.HELD))


def swept(layers: int, finer: float = 1.0) -> SweptMesh:
    return sweep(GEAR, mesh_quads(GEAR, 12.0, SIZES.scaled(finer)), layers)


@pytest.mark.parametrize(("layers", "finer"), [(1, 1.0), (2, 0.8), (5, 0.8), (8, 1.0), (9, 1.0)])
def test_every_node_goes_once(layers: int, finer: float) -> None:
    """In the half or what the turn makes of it, or between both; none of the cuts or the hub goes."""
    mesh = swept(layers, finer)
    turn, halves = HalfTurn(mesh), halves_of(mesh)
    own = np.concatenate([part.own for part in halves.half.every()])
    every = np.concatenate([own, turn.nodes[own], np.union1d(halves.between, turn.nodes[halves.between])])
    kept = mesh.over(np.r_[mesh.section.behind, mesh.section.ahead, mesh.side(OutlineSide.HELD)])
    assert sorted(every) == sorted(set(range(mesh.nodes)) - set(kept.tolist()))


def test_turn_brings_every_node_to_the_place_of_another() -> None:
    """Seen from the axes that turn with the section, half-way up."""
    mesh = swept(5)
    turn = HalfTurn(mesh)
    assert (turn.nodes[turn.nodes] == np.arange(mesh.nodes)).all()
    places = np.c_[mesh.in_section, mesh.heights - GEAR.face_width / 2]
    assert turn.turned(places.ravel()).reshape(-1, 3) == pytest.approx(places, abs=1e-9)


def test_cost_grows_slower_than_the_square_of_the_width() -> None:
    """Operations and numbers that are kept, from a width of 12 layers on."""
    found = [halves_of(swept(layers)) for layers in (12, 24, 48)]
    for few, many in pairwise(found):
        assert np.log2(many.factors / few.factors) < 1.45
    assert np.log(found[-1].flops / found[0].flops) / np.log(4) < 2.0


VOLUME_TOLERANCE = 1e-7  # 0.1 ppm
CHORD_ERROR = 0.002  # in normal modules


def check_solid(gear: Gear) -> None:
    import trimesh

    solid = gear_solid(gear)
    assert BRepCheck_Analyzer(solid.wrapped).IsValid()
    assert len(solid.Shells()) == 1
    assert solid.Shells()[0].wrapped.Closed()
    expected = solid_volume(gear)
    assert solid.Volume() == pytest.approx(expected, rel=VOLUME_TOLERANCE)
    facets = tessellate(gear, CHORD_ERROR * gear.normal_module)
    mesh = trimesh.Trimesh(facets.vertices, facets.faces, process=False)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert abs(facets.volume - expected) <= CHORD_ERROR * gear.normal_module * mesh.area


def solid_check_inputs(inputs: dict[str, Any]) -> None:
    try:
        gear = build_gear(inputs)
    except InputError as error:
        event(f"refused: {error.parameter}")
        assert names_a_field(error)
        return
    event("solid")
    check_solid(gear)


@settings(max_examples=12, suppress_health_check=[HealthCheck.too_slow])
@given(gear_inputs())
def test_gears_are_valid_solids_or_refused(inputs: dict[str, Any]) -> None:
    solid_check_inputs(inputs)


@pytest.mark.long
@settings(max_examples=10_000, suppress_health_check=[HealthCheck.too_slow])
@given(gear_inputs())
def test_gears_are_valid_solids_or_refused_long(inputs: dict[str, Any]) -> None:
    solid_check_inputs(inputs)
