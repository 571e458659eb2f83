"""Structured triangulation: closed, outward, within the chord error, and of the exact volume (identity and convergence)."""

import json
import math
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.integrate import quad
from support.clearance import chamfered_volume, distance_to_section, section_area, toothed_volume
from support.samples import SAMPLES
from support.solids import Cone, check_closed, check_outward, check_stl

from gearcad import BasicRack, Body, Gear, GearcadError, ParameterError
from gearcad.solids import ScenePart, write_scene, write_stl
from gearcad.solids.facets.tessellation import Facets, tessellate

DEFAULT = 0.005  # mm
ON_SURFACE = 1e-9  # mm: corners of the triangles lie on the exact surface but for rounding
FLOAT32 = 6e-8  # relative step of the numbers in STL and GLB
SHALLOW = 0.6  # mm: an end chamfer that stays on the flanks of m 2
DEEP = 5.0  # mm: one that reaches below the root circle

KEYED = {"bore": 14.0, "keyway_width": 5.0, "keyway_depth": 2.3}
HUB = {"hub_diameter": 26.0, "hub_length": 8.0}
BODIES = {
    "bore": {"bore": 20.0},
    "keyway": KEYED,
    "hub": {**HUB, "hub_side": "back"},
    "hubs and keyway": {**KEYED, **HUB, "hub_side": "both"},
    "thin rim": {"bore": 34.5},
    "thin rim, keyway": {"bore": 26.0, "keyway_width": 22.4, "keyway_depth": 0.05},
    "thin keyway": {"bore": 24.0, "keyway_width": 0.5, "keyway_depth": 5.2},
    "thin hub": {"bore": 20.0, "hub_diameter": 20.45, "hub_length": 5.0},
    "shallow chamfer": {"end_chamfer": SHALLOW},
    "steep chamfer": {"end_chamfer": 9.0, "end_chamfer_angle": 10},
    "flat chamfer": {"end_chamfer": 0.2, "end_chamfer_angle": 80},
    "chamfer to the root": {"end_chamfer": 4.5},
    "deep chamfer": {**KEYED, "end_chamfer": DEEP},
    "everything": {**KEYED, **HUB, "end_chamfer": SHALLOW, "tip_chamfer": 0.3},
    "everything, deep": {**KEYED, **HUB, "end_chamfer": DEEP, "tip_chamfer": 0.3},
}
HELICES = {"spur": 0.0, "right hand": 25.0, "left hand": -25.0}
BODY_CASES = [
    pytest.param(body, helix, id=f"{name}, {hand}", marks=[pytest.mark.long] * ((row + column) % 3 > 0))
    for row, (name, body) in enumerate(BODIES.items())
    for column, (hand, helix) in enumerate(HELICES.items())
]
"""Every body by default with one helix, which differs from body to body."""


def _gear(body: dict[str, object], helix: float) -> Gear:
    """z 20, m 2 with a transverse section whose circles do not depend on the helix angle."""
    module = 2.0 * math.cos(math.radians(helix))
    rack = BasicRack(addendum=2.0 / module, dedendum=2.5 / module)
    return Gear(teeth=20, normal_module=module, face_width=20, helix_angle=helix, rack=rack, body=Body(**body))


def _mesh(facets: Facets) -> trimesh.Trimesh:
    return facets.to_trimesh()


def _opening_area(body: Body) -> float:
    """Area of bore and keyway: the keyway's strip to its floor, less what of it the bore has taken already."""
    radius, half = body.bore / 2, body.keyway_width / 2
    floor = radius + body.keyway_depth
    return math.pi * radius**2 + 2 * quad(lambda y: floor - math.sqrt(radius**2 - y**2), 0, half, epsabs=1e-13)[0]


def _volume(gear: Gear) -> float:
    body, length = gear.body, gear.face_width + sum(gear.body.hub_ends)
    hubs = math.pi / 4 * body.hub_diameter**2 * sum(body.hub_ends)
    removed = chamfered_volume(gear) if body.end_chamfer else 0.0
    return toothed_volume(gear) + hubs - removed - _opening_area(body) * length


def _closed(gear: Gear, facets: Facets) -> None:
    check_closed(facets, 0 if gear.body.bore else 2)


def _faces_out(gear: Gear, facets: Facets) -> None:
    height, slope = gear.body.end_chamfer, math.tan(math.radians(gear.body.end_chamfer_angle))
    cone = Cone(gear.tip_diameter / 2, height, slope, ON_SURFACE, 2 * gear.teeth) if height else None
    check_outward(facets, gear.face_width, gear.body.hub_ends, cone)


def _samples(facets: Facets, which: np.ndarray, most: int = 1000) -> np.ndarray:
    """Points (n, 3) along the edges and inside of at most `most` of the chosen triangles, evenly picked."""
    chosen = np.flatnonzero(which)
    corners = facets.vertices[facets.faces[chosen[:: math.ceil(len(chosen) / most)]]]
    weights = np.array(
        [(1, 1, 0), (0, 1, 1), (1, 0, 1), (2, 1, 0), (1, 2, 0), (0, 2, 1), (0, 1, 2), (1, 0, 2), (2, 0, 1), (1, 1, 1)]
    )
    return np.einsum("wk,nkd->nwd", weights / weights.sum(1, keepdims=True), corners).reshape(-1, 3)


def _distance_to_side(gear: Gear, points: np.ndarray, reach: float) -> np.ndarray:
    """Distance (mm) from the screw surface: the least over sections up to `reach` away of that within the section."""
    shifts = np.linspace(-reach, reach, 11) if gear.helix_angle else [0.0]
    return np.min([np.hypot(d, distance_to_section(gear, points + np.array([0, 0, d]))) for d in shifts], axis=0)


def _on_side(facets: Facets) -> np.ndarray:
    """Triangles of the teeth's side, in a gear without bore, hub and end chamfer: all that are not flat in z."""
    return np.ptp(facets.vertices[facets.faces][..., 2], axis=1) > 0


@pytest.mark.parametrize("name", SAMPLES)
def test_every_tooth_form_is_closed_and_has_its_volume(name: str) -> None:
    gear = SAMPLES[name]
    error = min(DEFAULT, 0.01 * gear.normal_module)
    facets = tessellate(gear)
    _closed(gear, facets)
    _faces_out(gear, facets)
    assert abs(facets.volume - _volume(gear)) <= error * _mesh(facets).area


@pytest.mark.parametrize(("body", "helix"), BODY_CASES)
def test_every_body_is_closed_and_has_its_volume(body: dict[str, object], helix: float) -> None:
    gear = _gear(body, helix)
    exact = _volume(gear)
    for error in (0.02, 0.001):
        facets = tessellate(gear, error)
        _closed(gear, facets)
        _faces_out(gear, facets)
        assert abs(facets.volume - exact) <= error * _mesh(facets).area
        assert np.ptp(facets.vertices[:, 2]) == pytest.approx(gear.face_width + sum(gear.body.hub_ends), abs=ON_SURFACE)


@pytest.mark.parametrize("name", SAMPLES)
def test_no_triangle_leaves_the_teeth_by_more_than_the_chord_error(name: str) -> None:
    gear = SAMPLES[name]
    error = min(DEFAULT, 0.01 * gear.normal_module)
    facets = tessellate(gear)
    side = _on_side(facets)
    corners = facets.vertices[np.unique(facets.faces[side])]
    assert distance_to_section(gear, corners[:: math.ceil(len(corners) / 800)]).max() < ON_SURFACE
    worst = _distance_to_side(gear, _samples(facets, side), error).max()
    assert 0.5 * error < worst <= error  # the lower bound: none is wasted


CHAMFERED = {
    "shallow": ({"end_chamfer": SHALLOW}, 25.0),
    "shallow, left hand": ({"end_chamfer": SHALLOW}, -25.0),
    "deep, spur": ({"end_chamfer": DEEP}, 0.0),
    "deep": ({"end_chamfer": DEEP}, 25.0),
    "steep": ({"end_chamfer": 9.0, "end_chamfer_angle": 10}, 25.0),
}
STEEPEST = Gear(teeth=8, normal_module=2, face_width=20, helix_angle=60, body=Body(end_chamfer=9.5, end_chamfer_angle=5))


@pytest.mark.parametrize("gear", [*(_gear(*case) for case in CHAMFERED.values()), STEEPEST], ids=[*CHAMFERED, "steepest"])
def test_cone_and_shortened_teeth_keep_the_chord_error(gear: Gear) -> None:
    facets = tessellate(gear)
    _faces_out(gear, facets)
    points = _samples(facets, _on_side(facets), 10**6)
    slope = math.tan(math.radians(gear.body.end_chamfer_angle))
    from_end = np.minimum(points[:, 2], gear.face_width - points[:, 2])
    off_cone = np.hypot(points[:, 0], points[:, 1]) - (gear.tip_diameter / 2 - (gear.body.end_chamfer - from_end) * slope)
    off_cone = np.abs(off_cone) * math.cos(math.atan(slope))
    rest = points[off_cone > DEFAULT]
    assert 0 < len(rest) < len(points)
    assert _distance_to_side(gear, rest[:: math.ceil(len(rest) / 3000)], DEFAULT).max() <= DEFAULT


@pytest.mark.parametrize("teeth", [5, 8])
def test_feet_of_few_teeth_stay_clear_of_a_thin_rim(teeth: int) -> None:
    """A straight line across the foot of a tooth would pass inside the bore: the foot must follow the root circle."""
    plain = Gear(teeth=teeth, normal_module=2, face_width=10, profile_shift=0.3)
    foot = plain.profile.half_angle(plain.root_diameter / 2)
    gear = replace(plain, body=Body(bore=plain.root_diameter - 0.4))
    assert plain.root_diameter * math.cos(math.radians(foot)) < gear.body.bore
    facets = tessellate(gear)
    _closed(gear, facets)
    _faces_out(gear, facets)


def test_bore_and_hub_follow_the_chord_rule() -> None:
    """Regular polygons: every side's middle is within the chord error of its circle, and not needlessly near."""
    gear = _gear({"bore": 20.0, **HUB, "hub_side": "both"}, 0)
    facets = tessellate(gear)
    for radius in (10.0, 13.0):
        on_circle = np.abs(np.hypot(*facets.vertices[:, :2].T) - radius) < ON_SURFACE
        wall = facets.vertices[facets.faces[on_circle[facets.faces].all(axis=1) & _on_side(facets)]]
        drop = radius - np.hypot(*wall.mean(axis=1)[:, :2].T).min()
        assert 0.5 * DEFAULT < drop * 9 / 8 <= DEFAULT  # the centroid lies a third along the side: 8/9 of its sagitta


def test_volume_converges_linearly_with_the_chord_error() -> None:
    gear = _gear({**KEYED, **HUB, "end_chamfer": SHALLOW, "tip_chamfer": 0.3}, 25.0)
    errors = np.array([0.016, 0.004, 0.001, 0.00025])
    misses = np.abs([tessellate(gear, error).volume - _volume(gear) for error in errors])
    rate = np.polyfit(np.log(errors), np.log(misses), 1)[0]
    assert rate == pytest.approx(1.0, abs=0.15)


def test_trimesh_of_a_gear_has_its_section_mass_and_closed_surface() -> None:
    """For users in Python: the section between the ends is as long as an outline by the chord rule, mass goes by volume."""
    facets = tessellate(Gear(teeth=20, normal_module=2.0, face_width=20.0), DEFAULT)
    solid = facets.to_trimesh()
    assert solid.is_watertight and solid.is_winding_consistent and solid.euler_number == 2
    solid.density = 7.85e-6  # kg/mm³
    assert solid.mass == pytest.approx(7.85e-6 * facets.volume, rel=1e-12)
    end = facets.faces[np.all(facets.vertices[facets.faces][..., 2] == 0.0, axis=1)]
    edges, uses = np.unique(np.sort(end[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0, return_counts=True)
    length = np.linalg.norm(np.diff(facets.vertices[edges[uses == 1]], axis=1), axis=-1).sum()
    cut = solid.section(plane_origin=[0.0, 0.0, 10.0], plane_normal=[0.0, 0.0, 1.0])
    assert cut is not None and cut.length == pytest.approx(length, rel=1e-9)
    solid.apply_scale(2.0)
    assert facets.volume * 8 == pytest.approx(solid.volume, rel=1e-12)


def test_end_plane_has_the_area_of_the_section() -> None:
    gear = _gear(KEYED, 25.0)
    facets = tessellate(gear, 1e-4)
    flat = np.all(facets.vertices[facets.faces][..., 2] == gear.face_width, axis=1)
    perimeter = 2 * math.pi * gear.tip_diameter
    assert _mesh(facets).area_faces[flat].sum() == pytest.approx(
        section_area(gear) - _opening_area(gear.body), abs=1e-4 * perimeter
    )


def test_keyway_is_straight_and_under_tooth_0() -> None:
    gear = _gear({**KEYED, **HUB, "hub_side": "both"}, 25.0)
    vertices = tessellate(gear).vertices
    floor = vertices[np.abs(vertices[:, 0] - (7.0 + 2.3)) < ON_SURFACE]
    floor = floor[np.abs(np.abs(floor[:, 1]) - 2.5) < ON_SURFACE]
    assert sorted(map(tuple, floor.round(9))) == [(9.3, y, z) for y in (-2.5, 2.5) for z in (-0.0 - 8, 28.0)]


def test_twist_turns_the_section_as_the_hand_says() -> None:
    """At height z the tooth that is on +x at z = 0 has turned by z tan(beta)/r, counter-clockwise if right-handed."""
    for helix in (25.0, -25.0):
        gear = _gear({}, helix)
        top = tessellate(gear, 1e-3).vertices
        top = top[(top[:, 2] == gear.face_width) & (np.hypot(*top[:, :2].T) > gear.tip_diameter / 2 - ON_SURFACE)]
        turn = math.degrees(gear.face_width * math.tan(math.radians(helix)) / (gear.reference_diameter / 2))
        angle = np.mod(np.degrees(np.arctan2(top[:, 1], top[:, 0])) - turn + 9, 18) - 9
        half = gear.profile.half_angle(gear.tip_diameter / 2)
        assert (angle.min(), angle.max()) == (pytest.approx(-half, abs=1e-9), pytest.approx(half, abs=1e-9))


def _random_gear(rng: np.random.Generator) -> Gear:
    module = float(rng.choice([0.01, 0.25, 1, 3, 20]))
    twisted = Gear(
        teeth=int(rng.choice([3, 4, 6, 9, 14, 25, 60, 150])),
        normal_module=module,
        face_width=module * float(rng.choice([0.1, 2, 10, 25])),
        helix_angle=float(rng.choice([0, rng.uniform(-45, 45), rng.uniform(-70, 70)])),
        profile_shift=float(rng.uniform(-0.4, 1.0)),
        rack=BasicRack(root_radius="full" if rng.random() < 0.2 else float(rng.uniform(0, 0.45))),
    )
    root, body = twisted.root_diameter, dict[str, object]()
    if rng.random() < 0.7:
        body["bore"] = bore = root * float(rng.uniform(0.1, 0.8))
        if rng.random() < 0.6:
            body |= {"keyway_width": bore * float(rng.uniform(0.1, 0.9)), "keyway_depth": bore * float(rng.uniform(0.02, 0.3))}
    if rng.random() < 0.4:
        body |= {
            "hub_diameter": root * float(rng.uniform(0.5, 0.95)),
            "hub_length": module,
            "hub_side": rng.choice(["front", "both"]),
        }
    if rng.random() < 0.6:
        body |= {"end_chamfer": module * float(rng.uniform(0.1, 3)), "end_chamfer_angle": float(rng.uniform(5, 80))}
    if rng.random() < 0.3:
        body["tip_chamfer"] = module * float(rng.uniform(0.1, 0.3))
    return Gear(
        **{
            key: getattr(twisted, key)
            for key in ("teeth", "normal_module", "face_width", "helix_angle", "profile_shift", "rack")
        },
        body=Body(**body),
    )


@pytest.mark.parametrize("wanted", [10, pytest.param(60, marks=pytest.mark.long)])
def test_random_gears_are_closed_and_have_their_volume(wanted: int) -> None:
    rng = np.random.default_rng(20)
    made = 0
    while made < wanted:
        try:
            gear = _random_gear(rng)
        except GearcadError:
            continue
        error = min(0.01, 0.01 * gear.normal_module)
        facets = tessellate(gear, 0.01)
        _closed(gear, facets)
        assert abs(facets.volume - _volume(gear)) <= error * _mesh(facets).area, gear
        made += 1


def test_small_teeth_keep_their_shape() -> None:
    gear = Gear(teeth=20, normal_module=0.1, face_width=1)
    assert np.array_equal(tessellate(gear, 1.0).vertices, tessellate(gear, 0.001).vertices)


@pytest.mark.parametrize("wrong", [0, -0.1, math.nan, 1e-6])
def test_impossible_chord_errors_are_refused(wrong: float) -> None:
    with pytest.raises(ParameterError, match="chord_error"):
        tessellate(SAMPLES["spur"], wrong)


def test_facets_are_read_only() -> None:
    facets = tessellate(SAMPLES["spur"])
    with pytest.raises(ValueError, match="read-only"):
        facets.vertices[0] = 0


# ---------------------------------------------------------------------- files


@pytest.mark.parametrize("name", ["spur", "helical", "tiny", "huge", "nearly sharp tool"])
def test_stl_is_closed_when_read_again(name: str, tmp_path: Path) -> None:
    path = tmp_path / "gear.stl"
    check_stl(tessellate(SAMPLES[name]), path)
    first = path.read_bytes()
    write_stl(tessellate(SAMPLES[name]), path)
    assert path.read_bytes() == first


PARTS = {"pinion & shaft": ((0.8, 0.55, 0.2), 0.0, (0.0, 0.0, 0.0)), "wheel": ((0.45, 0.58, 0.72), 30.0, (80.0, 1.0, -2.0))}


def _parts() -> list[ScenePart]:
    gears = SAMPLES["helical"], SAMPLES["left hand"]
    return [
        ScenePart(name=name, facets=tessellate(gear), colour=colour, rotation=rotation, offset=offset)
        for gear, (name, (colour, rotation, offset)) in zip(gears, PARTS.items(), strict=True)
    ]


def _corner(part: ScenePart) -> np.ndarray:
    """Where the part's first vertex stands in the scene (mm)."""
    x, y, z = part.facets.vertices[0]
    angle = math.radians(part.rotation)
    turned = (x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle), z)
    return np.add(turned, part.offset)


def test_3mf_holds_named_coloured_parts_in_their_places(tmp_path: Path) -> None:
    parts, path = _parts(), tmp_path / "pair.3mf"
    write_scene(parts, path)
    scene = trimesh.load_scene(path)
    assert scene.units == "millimeter"
    assert set(scene.geometry) == set(PARTS)
    for part in parts:
        pose, _ = scene.graph[next(n for n in scene.graph.nodes_geometry if scene.graph[n][1] == part.name)]
        mesh = scene.geometry[part.name]
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(part.facets.volume, rel=1e-8)
        assert pose @ [*mesh.vertices[0], 1] == pytest.approx([*_corner(part), 1], abs=1e-6)
    model = trimesh.util.decompress(path.open("rb"), "zip")["3D/3dmodel.model"].read().decode()
    assert 'displaycolor="#CC8C33FF"' in model
    assert 'displaycolor="#7394B8FF"' in model
    first = path.read_bytes()
    write_scene(_parts(), path)
    assert path.read_bytes() == first


def test_glb_shows_true_size_with_y_up(tmp_path: Path) -> None:
    parts, path = _parts(), tmp_path / "pair.glb"
    write_scene(parts, path)
    data = path.read_bytes()
    document = json.loads(data[20 : 20 + struct.unpack("<I", data[12:16])[0]])
    assert [material["name"] for material in document["materials"]] == list(PARTS)
    # IEC 61966-2-1: 0.8, 0.55, 0.2 on the screen are 0.6038, 0.2633, 0.0331 of light; bytes step by 0.0039
    assert document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] == pytest.approx(
        [0.6038, 0.2633, 0.0331, 1], abs=4e-3
    )
    scene = trimesh.load_scene(path)
    for part in parts:
        pose, geometry = scene.graph[part.name]
        mesh = scene.geometry[geometry]
        assert mesh.is_watertight
        assert np.ptp(mesh.vertices, axis=0) == pytest.approx(np.ptp(part.facets.vertices, axis=0), rel=1e-6)  # data in mm
        x, y, z = _corner(part) / 1000
        nearest = trimesh.transformations.transform_points(mesh.vertices, pose) - [x, z, -y]
        assert np.hypot.reduce(nearest, axis=1).min() < 1e-8  # m
    write_scene(_parts(), path)
    assert path.read_bytes() == data


def test_scene_of_another_kind_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"must end in \.3mf or \.glb"):
        write_scene([], tmp_path / "pair.obj")
