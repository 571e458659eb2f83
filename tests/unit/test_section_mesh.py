"""Sections of gears as meshes with named sides, and their nodes turned by modifications."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.checks import COARSE
from support.clearance import distance_to_section
from support.modified import depth_off, unturned
from support.samples import GEARS, modified

from gearcad import BasicRack, Body, Gear
from gearcad.core.errors import ParameterError
from gearcad.meshing.bodies.element_mesh import ElementMesh
from gearcad.meshing.bodies.quality import quality
from gearcad.meshing.bodies.section_mesh import mesh_section, modification_turns
from gearcad.meshing.bodies.sectors import ContactRefinement
from gearcad.meshing.fem import Element
from gearcad.meshing.outline import MeshSizes

ROUNDING = 1e-12
"""mm, and mm² over mm²: what 16 digits leave."""

SIZES = MeshSizes().coarse()

GEAR = Gear(teeth=11, normal_module=2.0, face_width=10, profile_shift=0.4, body=Body(bore=8.0))

OWN = ("right_root", "right_fillet", "right_flank", "tip", "left_flank", "left_fillet", "left_root")


def section(teeth: int | None, element: Element, gear: Gear = GEAR) -> ElementMesh:
    return mesh_section(gear, teeth=teeth, held_radius=4.0, sizes=SIZES, element=element)


def area(mesh: ElementMesh) -> float:
    """Enclosed by the named sides (mm²), by Green's theorem on quadratic edges: Simpson's rule is exact for them."""
    first, last, middle = (
        np.concatenate([mesh.points[mesh.face_cells(name)[:, k], :2] for name in mesh.sides]) for k in range(3)
    )

    def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]

    return float((4 * cross(first, middle) + 4 * cross(middle, last) - cross(first, last)).sum() / 6)


PLANE = pytest.mark.parametrize("element", [Element.QUAD8, Element.TRI6])


@PLANE
@pytest.mark.parametrize("teeth", [1, 5, None])
def test_every_edge_of_the_boundary_has_one_name(teeth: int | None, element: Element) -> None:
    mesh = section(teeth, element)
    vertices = element.shape.vertices
    middles, uses = np.unique(mesh.cells[:, vertices:], return_counts=True)
    named = np.concatenate([mesh.face_cells(name)[:, 2] for name in mesh.sides])
    assert sorted(named.tolist()) == middles[uses == 1].tolist()
    assert uses.max() == 2
    assert mesh.cells[:, :vertices].max() + 1 == mesh.cells[:, vertices:].min(), "vertices first"
    numbers = range(11) if teeth is None else {1: [0], 5: [9, 10, 0, 1, 2]}[teeth]
    cuts = set() if teeth is None else {"cut_behind", "cut_ahead"}
    assert set(mesh.sides) == {f"{name}_{tooth}" for name in OWN for tooth in numbers} | {"bore"} | cuts


@PLANE
def test_sectors_add_up(element: Element) -> None:
    one, five, ring = (area(section(teeth, element)) for teeth in (1, 5, None))
    assert five == pytest.approx(5 * one, rel=ROUNDING)
    assert ring == pytest.approx(11 * one, rel=ROUNDING)


@PLANE
def test_sides_stand_at_their_teeth(element: Element) -> None:
    mesh = section(None, element)
    pitch = 2 * math.pi / 11
    for tooth in range(11):
        for name, sign in (("left_flank", 1), ("right_flank", -1)):
            x, y = mesh.points[mesh.nodes(f"{name}_{tooth}"), :2].T
            off = np.remainder(np.arctan2(y, x) - tooth * pitch + math.pi, 2 * math.pi) - math.pi
            assert (sign * off > 0).all()
            assert (sign * off < pitch / 2).all()
    assert np.hypot(*mesh.points[mesh.nodes("bore"), :2].T) == pytest.approx(4.0, abs=ROUNDING)


@PLANE
@pytest.mark.parametrize("teeth", [1, 3])
def test_cuts_match(teeth: int, element: Element) -> None:
    mesh = section(teeth, element)
    behind, ahead = mesh.matched["cut"].T
    assert set(behind) == set(mesh.nodes("cut_behind"))
    assert set(ahead) == set(mesh.nodes("cut_ahead"))
    turn = 2 * math.pi * teeth / 11
    turned = mesh.points[behind, :2] @ np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    assert np.abs(turned - mesh.points[ahead, :2]).max() < 10 * ROUNDING


@pytest.mark.parametrize("teeth", [0, 2, 11, 13])
def test_teeth_are_odd_and_fewer_than_all(teeth: int) -> None:
    with pytest.raises(ParameterError, match="teeth"):
        section(teeth, Element.QUAD8)


def test_a_section_is_made_of_plane_elements() -> None:
    with pytest.raises(ParameterError, match="hex20"):
        section(1, Element.HEX20)


ZONE = ContactRefinement(length=4.5, half_width=0.3, edge=0.04)


@PLANE
@pytest.mark.parametrize("left", [True, False])
def test_edges_are_short_where_teeth_touch(left: bool, element: Element) -> None:
    mesh = mesh_section(
        GEAR, teeth=5, held_radius=4.0, sizes=SIZES, element=element, contacts={-1: replace(ZONE, left=left), 1: ZONE}
    )
    faces = mesh.face_cells(f"{'left' if left else 'right'}_flank_10")
    start, end, middle = (mesh.points[faces[:, k], :2] for k in range(3))
    roll = np.sqrt((middle**2).sum(axis=1) - (GEAR.base_diameter / 2) ** 2)
    arc = np.abs(roll**2 - ZONE.length**2) / GEAR.base_diameter
    edges = np.hypot(*(end - start).T)
    inside = arc < ZONE.half_width
    assert inside.sum() >= 2 * ZONE.half_width / ZONE.edge - 2
    assert edges[inside].max() < 1.05 * ZONE.edge
    assert edges[~inside].max() > 5 * ZONE.edge
    beyond = arc > ZONE.half_width
    assert (edges < ZONE.edge + 0.35 * (arc - ZONE.half_width + edges))[beyond].all(), "they grow gently"
    middles, uses = np.unique(mesh.cells[:, element.shape.vertices :], return_counts=True)
    named = np.concatenate([mesh.face_cells(name)[:, 2] for name in mesh.sides])
    assert sorted(named.tolist()) == middles[uses == 1].tolist(), "teeth of other gradings fit"


def test_other_teeth_are_coarse_if_triangles() -> None:
    sizes = MeshSizes(fillet_turn=7.5)
    mesh = mesh_section(GEAR, teeth=None, held_radius=4.0, sizes=sizes, element=Element.TRI6, contacts={0: ZONE, 11: ZONE})
    counts = [len(mesh.sides[f"left_fillet_{tooth}"]) for tooth in range(11)]
    assert counts[10] == counts[0] == counts[1]
    assert all(counts[tooth] < 0.6 * counts[0] for tooth in range(2, 10))


@PLANE
def test_fillets_turn_as_asked(element: Element) -> None:
    sizes = replace(SIZES, fillet_turn=7.5)
    mesh = mesh_section(GEAR, teeth=1, held_radius=4.0, sizes=sizes, element=element)
    first, last, middle = (mesh.points[mesh.face_cells("left_fillet_0")[:, k], :2] for k in range(3))
    before, after = middle - first, last - middle
    # From chord to chord an edge turns by half of what it turns from end to end.
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turn = 2 * np.degrees(np.arcsin(across / np.hypot(*before.T) / np.hypot(*after.T)))
    assert np.abs(turn).max() == pytest.approx(7.5, rel=0.15)


@PLANE
@pytest.mark.parametrize("teeth", [7, 24])
def test_without_a_bore_the_disc_is_full(teeth: int, element: Element) -> None:
    gear = Gear(teeth=teeth, normal_module=1.0, face_width=5, profile_shift=0.3)
    ring, disc = (mesh_section(gear, teeth=None, held_radius=radius, sizes=SIZES, element=element) for radius in (0.5, 0.0))
    assert "bore" not in disc.sides
    # Edges are parabolas, few along the inner circle of the ring, and one more across each of seven teeth of the disc.
    assert area(disc) == pytest.approx(area(ring) + math.pi * 0.5**2, rel=5e-5)
    middles, uses = np.unique(disc.cells[:, element.shape.vertices :], return_counts=True)
    named = np.concatenate([disc.face_cells(name)[:, 2] for name in disc.sides])
    assert sorted(named.tolist()) == middles[uses == 1].tolist()
    assert disc.cells[:, : element.shape.vertices].max() + 1 == middles.min(), "vertices first"
    assert quality(disc).least_jacobian > 0.3


def test_some_teeth_need_an_inner_circle() -> None:
    with pytest.raises(ParameterError, match="held_radius"):
        mesh_section(GEAR, teeth=3, held_radius=0.0, sizes=SIZES, element=Element.QUAD8)
    with pytest.raises(ParameterError, match="held_radius"):
        mesh_section(GEAR, teeth=3, held_radius=GEAR.root_diameter / 2, sizes=SIZES, element=Element.QUAD8)


def off_envelope(gear: Gear, points: np.ndarray) -> np.ndarray:
    """How far (mm) points (n, 2) on the left fillet of tooth 0 are from what the tool's tip leaves as it rolls past.

    In the tool's normal section its tip is a circle; the least distance from it, over all roll angles, is that of the point.
    """
    tool, pitch = gear.profile.tool, gear.reference_diameter / 2
    radius, angle = np.hypot(*points.T), math.pi / gear.teeth - np.arctan2(points[:, 1], points[:, 0])
    cosine = math.cos(tool.helix_angle)

    def apart(roll: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        across, up = radius * np.sin(angle + roll), radius * np.cos(angle + roll) - pitch
        return (across - pitch * roll) * cosine - tool.u, up - tool.v

    every = np.stack([np.hypot(*apart(np.full(len(points), roll))) for roll in np.linspace(-1.2, 0.4, 1601)])
    roll = np.linspace(-1.2, 0.4, 1601)[every.argmin(axis=0)]
    for _ in range(6):  # Newton's steps to where the distance changes no more: d(across) = up, d(up) = -(across on the gear)
        x, y = apart(roll)
        gear_x, gear_y = radius * np.sin(angle + roll), radius * np.cos(angle + roll)
        slope = x * (gear_y - pitch) * cosine - y * gear_x
        bend = ((gear_y - pitch) * cosine) ** 2 - x * gear_x * cosine + gear_x**2 - y * gear_y
        roll = roll - slope / bend
    return np.abs(np.hypot(*apart(roll)) - tool.radius)


@PLANE
@pytest.mark.parametrize(
    "gear",
    [
        GEAR,
        Gear(teeth=13, normal_module=2.5, face_width=18, helix_angle=28, profile_shift=0.107),
        Gear(teeth=60, normal_module=1.0, face_width=9, rack=BasicRack(root_radius="full")),
        Gear(teeth=10, normal_module=20.0, face_width=9),
    ],
)
def test_fillets_are_what_the_tool_leaves(gear: Gear, element: Element) -> None:
    mesh = mesh_section(gear, teeth=1, held_radius=0.6 * gear.root_diameter / 2, sizes=MeshSizes(), element=element)
    points = mesh.points[mesh.nodes("left_fillet_0"), :2]
    assert len(points) > 20
    assert off_envelope(gear, points).max() < 1e-9
    assert off_envelope(gear, points * (1 + 1e-6)).max() > 1e-7 * gear.normal_module


FULL = Gear(teeth=17, normal_module=3.0, face_width=20, helix_angle=-20, rack=BasicRack(root_radius="full"))
"""Fillets meet in the middle of the space: their turn fades."""


def tooth_section(gear: Gear, teeth: int | None = 1) -> ElementMesh:
    inner = gear.root_diameter / 2 - 1.5 * gear.normal_module
    return mesh_section(gear, modified=False, teeth=teeth, held_radius=inner, sizes=COARSE, element=Element.QUAD8)


def at_height(gear: Gear, section: ElementMesh, angles: np.ndarray, z: float) -> np.ndarray:
    """Nodes (n, 3) at a height, turned by the helix and by angles (n,) of their own."""
    turn = angles + math.tan(math.radians(gear.helix_angle)) / (gear.reference_diameter / 2) * z
    x, y, _ = section.points.T
    return np.stack([np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y, np.full(len(x), z)], -1)


@pytest.mark.parametrize("name", [*GEARS, "full"])
def test_flanks_have_their_depth(name: str) -> None:
    """And fillets turn with the ends of the flanks, or less the deeper they are where their turn fades."""
    gear = modified({**GEARS, "full": FULL}[name])
    section, heights = tooth_section(gear), np.linspace(0, gear.face_width, 7)
    turns = modification_turns(section, gear, heights)
    for number, z in enumerate(heights):
        points = at_height(gear, section, turns.at(number), z)
        for side in ("left", "right"):
            assert np.abs(depth_off(gear, points[section.nodes(f"{side}_flank_0")])).max() < ROUNDING
            if name != "full":
                fillet = unturned(gear, points[section.nodes(f"{side}_fillet_0")])
                assert distance_to_section(gear, fillet).max() < ROUNDING


def test_inside_is_between() -> None:
    """No node turns by more than the outline does; bore not at all; both cuts, and lands in their middle, as the mean."""
    gear = modified(GEARS["chamfered"])
    section = tooth_section(gear)
    turns = modification_turns(section, gear, np.array([0.0, 5.0])).at(0)
    outline = np.concatenate([section.nodes(name) for name in section.sides if name not in ("bore", "cut_behind", "cut_ahead")])
    assert np.abs(turns).max() == np.abs(turns[outline]).max()
    assert np.abs(turns[section.nodes("bore")]).max() < ROUNDING
    behind, ahead = section.matched["cut"].T
    assert turns[ahead] == pytest.approx(turns[behind], abs=ROUNDING)
    left, right = (gear.flank_form.turn(gear.flank_form.last, 0.0, left=side) for side in (True, False))
    tip = section.nodes("tip_0")
    middle = tip[np.argmin(np.abs(section.points[tip, 1]))]
    assert turns[middle] == pytest.approx((left + right) / 2, abs=ROUNDING)
    assert turns[tip].min() == pytest.approx(min(left, right), abs=ROUNDING)


def test_all_teeth_turn_alike() -> None:
    """In the ring as in one sector with its cuts."""
    gear = modified(GEARS["undercut"])
    one, ring = (modification_turns(tooth_section(gear, teeth), gear, np.array([3.0])).at(0) for teeth in (1, None))
    assert np.unique(ring[np.abs(ring) > ROUNDING].round(12)) == pytest.approx(np.unique(one[np.abs(one) > ROUNDING].round(12)))


def test_nothing_where_nothing_is_modified() -> None:
    turns = modification_turns(tooth_section(GEARS["spur"]), GEARS["spur"], np.linspace(0, 10, 3))
    assert not turns.at(2).any() and turns.fields.size == 0
