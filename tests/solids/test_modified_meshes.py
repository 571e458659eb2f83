"""Triangles, contour and points of gears with modified flanks (identity and reference)."""

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import trimesh
from support.clearance import distance_to_section
from support.modified import depth_off, removed_volume, unturned
from support.samples import AMOUNTS, GEARS, crossed, modified, random_gear
from support.solids import check_stl

from gearcad import BasicRack, Gear
from gearcad.geometry.modification import FlankModification
from gearcad.solids import tessellate, write_stl
from gearcad.solids.facets.tessellation import Facets
from gearcad.solids.files.dxf import gear_contour
from gearcad.solids.files.points import gear_points

CHORD_ERROR = 0.001  # mm
LEAST = CHORD_ERROR / 3  # mm: what triangles leave that are not finer than they need be
ON_SURFACE = 1e-9  # mm: corners of the triangles lie on the surface but for rounding
ROUNDING = 1e-13  # mm: one point, worked out from two sides
STEEP = 0.6  # z of the normals: flanks of 28 degrees have less, cones of 45 degrees and end planes more
CASES = [*AMOUNTS, "all"]


def _modified(name: str, amount: str, **others: object) -> Gear:
    return modified(GEARS[name], *(() if amount == "all" else (amount,)), **others)


def _closed(facets: Facets) -> trimesh.Trimesh:
    mesh = trimesh.Trimesh(facets.vertices, facets.faces, process=False)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.area_faces.min() > 0
    assert len(np.unique(facets.faces)) == len(facets.vertices)
    return mesh


def _on_teeth(gear: Gear, points: np.ndarray) -> np.ndarray:
    """True for points outside the root cylinder by more than a chord, clear of the end planes and the cones."""
    slope = math.tan(math.radians(gear.body.end_chamfer_angle))
    radius = np.hypot(*points[:, :2].T)
    face = gear.tip_diameter / 2 - gear.body.end_chamfer * slope
    setback = np.maximum(radius - face, 0) / slope if gear.body.end_chamfer else 0.0
    from_end = np.minimum(points[:, 2], gear.face_width - points[:, 2]) - setback
    return (radius > gear.root_diameter / 2 - CHORD_ERROR) & (from_end > 2 * CHORD_ERROR / min(slope, 1))


def _samples(facets: Facets, most: int = 1500) -> np.ndarray:
    """Points (n, 3) on the edges and inside of at most `most` triangles, evenly picked."""
    corners = facets.vertices[facets.faces[:: math.ceil(len(facets.faces) / most)]]
    weights = np.array([(1, 1, 0), (0, 1, 1), (1, 0, 1), (2, 1, 0), (0, 2, 1), (1, 0, 2), (1, 1, 1), (2, 1, 1), (1, 1, 2)])
    return np.einsum("wk,nkd->nwd", weights / weights.sum(1, keepdims=True), corners).reshape(-1, 3)


def _off_side(gear: Gear, points: np.ndarray) -> np.ndarray:
    """Distance (mm) of points from the modified side: from the unmodified one when they are turned back.

    In the section, and for points of a helical gear that are far from it the least over sections nearby. To turn points back
    changes distances by the slope of the depth, a part in a hundred.
    """
    back = unturned(gear, points)
    off = distance_to_section(gear, back)
    far = off > LEAST if gear.helix_angle else np.zeros(len(off), bool)
    near_by = [np.array([0, 0, share * CHORD_ERROR]) for share in (-1, -2 / 3, -1 / 3, 1 / 3, 2 / 3, 1)]
    off[far] = np.min([off[far], *(np.hypot(d[2], distance_to_section(gear, back[far] + d)) for d in near_by)], axis=0)
    return off


@pytest.mark.parametrize(("name", "amount"), crossed(CASES))
def test_meshes_are_closed_and_on_the_modified_flanks(name: str, amount: str) -> None:
    gear = _modified(name, amount)
    facets = tessellate(gear, CHORD_ERROR)
    mesh = _closed(facets)
    corners = facets.vertices[np.unique(facets.faces[np.abs(mesh.face_normals[:, 2]) < STEEP])]
    radius = np.hypot(*corners[:, :2].T)
    on_flank = corners[(radius > gear.form_diameter / 2 + 1e-7) & (radius < gear.tip_form_diameter / 2 - 1e-7)]
    assert len(on_flank) > 20 * gear.teeth
    assert np.abs(depth_off(gear, on_flank)).max() < ON_SURFACE
    plain = tessellate(GEARS[name], CHORD_ERROR)
    removed = plain.volume - facets.volume
    assert abs(removed - removed_volume(gear)) < CHORD_ERROR * mesh.area / 10


@pytest.mark.parametrize(("name", "amount"), crossed(CASES))
def test_no_triangle_leaves_the_modified_teeth_by_more_than_the_chord_error(name: str, amount: str) -> None:
    gear = _modified(name, amount)
    points = _samples(tessellate(gear, CHORD_ERROR))
    points = points[_on_teeth(gear, points)]
    assert len(points) > 1000
    worst = _off_side(gear, points).max()
    assert LEAST < worst <= CHORD_ERROR


@pytest.mark.parametrize(
    ("name", "share"),
    [
        pytest.param(name, share, marks=[pytest.mark.long] * ((row + column) % 3 == 1))
        for row, name in enumerate(("chamfered", "chamfered, spur", "chamfered to the root"))
        for column, share in enumerate((0.3, 1.0, 1.7))
    ],
)
def test_an_end_relief_that_begins_inside_on_or_beyond_the_cone(name: str, share: float) -> None:
    plain = GEARS[name]
    gear = modified(plain, end_relief_length=min(share * plain.body.end_chamfer, plain.face_width / 2))
    facets = tessellate(gear, CHORD_ERROR)
    _closed(facets)
    points = _samples(facets)
    assert _off_side(gear, points[_on_teeth(gear, points)]).max() <= CHORD_ERROR


def test_fillets_without_a_root_land_stay_closed(tmp_path: Path) -> None:
    gear = modified(replace(GEARS["right hand"], rack=BasicRack(root_radius="full")))
    facets = tessellate(gear, CHORD_ERROR)
    _closed(facets)
    write_stl(facets, tmp_path / "gear.stl")
    assert trimesh.load(tmp_path / "gear.stl").is_watertight


@pytest.mark.parametrize("name", GEARS)
def test_stl_is_closed_when_read_again(name: str, tmp_path: Path) -> None:
    check_stl(tessellate(modified(GEARS[name])), tmp_path / "gear.stl")


def test_idle_lengths_leave_the_mesh_as_it_was() -> None:
    plain = GEARS["chamfered"]
    idle = replace(plain, modification=FlankModification(tip_relief_length=1.0, end_relief_length=2.0))
    assert np.array_equal(tessellate(idle).vertices, tessellate(plain).vertices)


def _check_random(seed: int) -> None:
    gear = random_gear(seed)
    facets = tessellate(gear, CHORD_ERROR)
    mesh = _closed(facets)
    plain = tessellate(replace(gear, modification=FlankModification()), CHORD_ERROR)
    assert abs(plain.volume - facets.volume - removed_volume(gear)) < CHORD_ERROR * mesh.area / 2, gear
    points = _samples(facets, 1500)
    assert _off_side(gear, points[_on_teeth(gear, points)]).max() <= CHORD_ERROR, gear


@pytest.mark.parametrize("seed", [*range(6), 91, 126])  # the last two have been wrong once
def test_random_modifications(seed: int) -> None:
    _check_random(seed)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(6, 300))
def test_random_modifications_long(seed: int) -> None:
    _check_random(seed)


# ---------------------------------------------------------------------- contour and points


SECTIONS = {**{name: GEARS[name] for name in ("spur", "undercut")}, "tip chamfer": GEARS["chamfered"]}
SECTIONS["left hand"] = replace(GEARS["left hand"], teeth=44)
SECTIONS["left hand, z 24"] = replace(GEARS["left hand"], teeth=24)
SECTIONS["full radius"] = replace(GEARS["spur"], rack=BasicRack(root_radius="full"))


def _at_middle(gear: Gear, points: np.ndarray) -> np.ndarray:
    """Points (n, 2) of the section that is not turned by the helix, on that of mid face width (n, 3)."""
    z = gear.face_width / 2
    turn = z * math.tan(math.radians(gear.helix_angle)) / (gear.reference_diameter / 2)
    x, y = points.T
    cosine, sine = math.cos(turn), math.sin(turn)
    return np.stack([cosine * x - sine * y, sine * x + cosine * y, np.full(len(x), z)], -1)


def _on_arcs(contour: np.ndarray, shares: tuple[float, ...] = (0.0, 0.25, 0.5, 0.75)) -> np.ndarray:
    """Points (n, 2) along the arcs of a contour. From its start an arc is seen at half of the angle that is left of it."""
    start, end = contour[:, :2], np.roll(contour[:, :2], -1, axis=0)
    half = 2 * np.arctan(contour[:, 2])
    safe = np.where(half, half, 1.0)
    found = []
    for share in shares:
        along = np.where(half, np.sin(share * safe) / np.sin(safe), share) * np.exp(1j * (share - 1) * half)
        step = along * ((end - start) @ [1, 1j])
        found.append(start + np.stack([step.real, step.imag], -1))
    return np.concatenate(found)


@pytest.mark.parametrize("name", SECTIONS)
def test_contour_is_the_modified_section_at_mid_face_width(name: str) -> None:
    gear, accuracy = modified(SECTIONS[name]), 1e-4
    points = _at_middle(gear, _on_arcs(gear_contour(gear, accuracy), tuple(np.arange(23) / 23)))
    radius = np.hypot(*points[:, :2].T)
    on_involute = (radius > gear.form_diameter / 2 + accuracy) & (radius < gear.tip_form_diameter / 2 - accuracy)
    off = np.abs(depth_off(gear, points[on_involute]))
    assert on_involute.sum() > 30 * gear.teeth
    assert accuracy / 20 < off.max() <= accuracy
    if name != "full radius":  # where fillets turn as a whole
        rest = distance_to_section(gear, unturned(gear, points[~on_involute]))
        assert rest.max() <= accuracy


@pytest.mark.parametrize("name", SECTIONS)
def test_points_are_on_the_modified_flank_and_the_unmodified_tool(name: str) -> None:
    gear = modified(SECTIONS[name])
    blocks, plain = gear_points(gear), gear_points(SECTIONS[name])
    flank = [block.points for block in blocks if block.curve == "involute"]
    assert len(flank) == 5  # parted where the transitions of the reliefs begin and end
    # One point but for rounding: the depth there is a parabola's last value and the next one's first.
    assert max(float(np.abs(before[-1] - after[0]).max()) for before, after in pairwise(flank)) < ROUNDING
    assert np.abs(depth_off(gear, _at_middle(gear, np.concatenate(flank)))).max() < ON_SURFACE
    rest = [block.points for block in blocks if block.curve in ("trochoid", "tip chamfer", "tip land", "root land")]
    if name != "full radius":
        middle = _at_middle(gear, np.concatenate(rest))
        assert distance_to_section(gear, unturned(gear, middle)).max() < ON_SURFACE
    tools = [[block for block in found if block.curve.startswith("tool")] for found in (blocks, plain)]
    assert len(tools[0]) == 3
    assert all(np.array_equal(a.points, b.points) for a, b in zip(*tools, strict=True))


def test_modifications_along_the_face_leave_the_middle_section_alone() -> None:
    for name in ("lead_crowning", "end_relief", "helix_angle_modification", "twist"):
        assert gear_contour(modified(GEARS["undercut"], name)) == pytest.approx(gear_contour(GEARS["undercut"]), abs=1e-9)
