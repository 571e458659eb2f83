"""Facets of rings: closed, away from the body, within the chord error also inside triangles, of the exact volume."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from support.clearance import distance_to_section
from support.modified import depth_off, unturned
from support.rings import RingSection
from support.samples import RINGS, SAMPLES, SHAPED, random_ring
from support.solids import Cone, check_closed, check_outward, check_stl

from gearcad import Body, FlankModification, Gear, GearPair, GeometryError, ParameterError
from gearcad.geometry import ShaperCutter
from gearcad.geometry.curves import Curve, CurveKind
from gearcad.geometry.fillets import ShaperTip
from gearcad.geometry.gear_data import twist
from gearcad.solids import FileOptions, write_3mf, write_glb
from gearcad.solids.exact.inertia import mass_properties
from gearcad.solids.facets.tessellation import Facets, tessellate
from gearcad.solids.files.products import PairProduct

DEFAULT = 0.005  # mm
ON_SURFACE = 1e-9  # of the diameters: corners lie on the exact surface but for rounding
FLOAT32 = 6e-8  # relative step of the numbers in STL and GLB
FLAT = 1e-3  # a curvature relative to its parts: those of second differences agree so well
UNMODIFIED = [name for name, gear in RINGS.items() if not gear.modification.present]

CHAMFERS = {
    "no chamfer": {},
    "shallow": {"end_chamfer": 0.4},
    "flat": {"end_chamfer": 1.0, "end_chamfer_angle": 70.0},
    "steep": {"end_chamfer": 4.0, "end_chamfer_angle": 12.0},
    "onto the body": {"end_chamfer": 3.0},
}
"""In normal modules."""


def _mesh(facets: Facets) -> trimesh.Trimesh:
    return trimesh.Trimesh(facets.vertices, facets.faces, process=False)


def _closed(gear: Gear, facets: Facets) -> None:
    check_closed(facets, -2 * gear.body.bolt_holes)  # 2 - 2 g: one hole more than bolts go through


def _faces_out(gear: Gear, facets: Facets) -> None:
    height, slope, tip = gear.body.end_chamfer, math.tan(math.radians(gear.body.end_chamfer_angle)), -gear.tip_diameter / 2
    cone = Cone(tip, height, -slope, ON_SURFACE * max(tip, 1), 2 * gear.tooth_count) if height else None
    check_outward(facets, gear.face_width, (0.0, 0.0), cone)


def _error(gear: Gear, asked: float = DEFAULT) -> float:
    return min(asked, 0.01 * gear.normal_module)


def _chamfered(gear: Gear, name: str) -> Gear:
    sizes = {key: value * (1 if key.endswith("angle") else gear.normal_module) for key, value in CHAMFERS[name].items()}
    return replace(gear, body=replace(gear.body, **sizes))


@pytest.mark.parametrize("chamfer", CHAMFERS)
@pytest.mark.parametrize("name", RINGS)
def test_every_ring_is_closed_and_has_its_volume(name: str, chamfer: str) -> None:
    try:
        gear = _chamfered(RINGS[name], chamfer)
    except GeometryError:  # a face too narrow for that chamfer
        assert chamfer in ("steep", "onto the body")
        return
    facets = tessellate(gear)
    _closed(gear, facets)
    _faces_out(gear, facets)
    assert np.ptp(facets.vertices, axis=0) == pytest.approx([gear.body.rim_diameter] * 2 + [gear.face_width], rel=1e-3)
    if not gear.modification.present:
        assert abs(facets.volume - RingSection(gear).volume) <= _error(gear) * _mesh(facets).area / 2


def test_volume_converges_linearly_with_the_chord_error() -> None:
    gear = replace(
        RINGS["shaped, helical"],
        body=Body(rim_diameter=250, bolt_circle=235, bolt_holes=5, bolt_diameter=9, end_chamfer=1, tip_chamfer=0.3),
    )
    errors = np.array([0.016, 0.004, 0.001, 0.00025])
    misses = np.abs([tessellate(gear, error).volume - RingSection(gear).volume for error in errors])
    assert np.polyfit(np.log(errors), np.log(misses), 1)[0] == pytest.approx(1.0, abs=0.15)


@pytest.mark.parametrize("name", ["modified", "form root"])
def test_mass_properties_are_those_of_the_exact_solid(name: str) -> None:
    """Of a modified ring, and of one with bolt holes: volume and moment about the axis, as far as triangles can have them."""
    gear, error = RINGS[name], 0.0005
    mesh, exact = _mesh(tessellate(gear, error)), mass_properties(gear, 1e9)
    most = error * mesh.area / mesh.volume
    assert mesh.volume == pytest.approx(exact.mass, rel=most / 2)
    turned = mesh.moment_inertia[2, 2] + mesh.volume * float(np.hypot(*mesh.center_mass[:2])) ** 2
    assert turned == pytest.approx(exact.inertia * 1e6, rel=most)


def test_modifications_take_off_what_they_do_from_the_exact_solid() -> None:
    gear, error = RINGS["modified"], 0.0002
    plain = replace(gear, modification=FlankModification())
    removed = tessellate(plain, error).volume - tessellate(gear, error).volume
    exact = mass_properties(plain, 1e9).mass - mass_properties(gear, 1e9).mass
    assert removed == pytest.approx(exact, abs=error * _mesh(tessellate(gear, error)).area / 10)
    assert exact > error * _mesh(tessellate(gear, error)).area  # far more than that


# ---------------------------------------------------------------------- how far triangles are off

_INSIDE = np.array([(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]) / 4


def _on_side(gear: Gear, facets: Facets, most: int) -> np.ndarray:
    """Corners (n, 3, 3) of at most so many triangles of the teeth's side, of a ring without end chamfers."""
    corners = facets.vertices[facets.faces]
    reach = np.hypot(corners[..., 0], corners[..., 1]).max(axis=1)
    side = corners[(np.ptp(corners[..., 2], axis=1) > 0) & (reach < gear.profile.root_diameter / 2 * (1 + ON_SURFACE))]
    return side[np.random.default_rng(7).permutation(len(side))[:most]]


def _off(gear: Gear, corners: np.ndarray, error: float) -> np.ndarray:
    """Distance (mm) of points in triangles from the side: the least over sections nearby, by formulas of the tests' own.

    On lands that from the cylinder.
    """
    section, shifts = RingSection(gear), np.linspace(-error, error, 5) if gear.helix_angle else [0.0]
    points = np.einsum("wk,nkd->nwd", _INSIDE, corners)
    radius = np.hypot(corners[..., 0], corners[..., 1])
    ends = np.array([section.root, section.tip])[:, None, None]
    land = np.any(np.all(np.abs(radius - ends) < ON_SURFACE * section.root, axis=2), axis=0)
    from_land = np.abs(np.hypot(points[land, :, 0], points[land, :, 1])[..., None] - ends[:, 0, 0]).min(axis=-1).ravel()
    rest = points[~land].reshape(-1, 3)
    return np.r_[from_land, np.min([np.hypot(d, section.off(rest + np.array([0, 0, d]))) for d in shifts], axis=0)]


@pytest.mark.parametrize("name", UNMODIFIED)
def test_no_triangle_leaves_the_teeth_by_more_than_the_chord_error(name: str) -> None:
    gear = RINGS[name]
    error = _error(gear, 0.002)
    corners = _on_side(gear, tessellate(gear, error), 200)
    assert distance_to_section(gear, corners.reshape(-1, 3)).max() < ON_SURFACE * gear.profile.root_diameter
    off = _off(gear, corners, error)
    assert 0.5 * error < off.max() <= error  # the lower bound: none is wasted


def test_triangles_on_modified_flanks_keep_the_chord_error() -> None:
    error = 0.001
    for gear in (
        RINGS["modified"],
        replace(RINGS["modified"], helix_angle=0.0, body=Body(rim_diameter=140.0, tip_chamfer=0.2)),
    ):
        corners = _on_side(gear, tessellate(gear, error), 600)
        vertices = corners.reshape(-1, 3)
        radius = np.hypot(*vertices[:, :2].T) * 2
        on_flank = (radius < -gear.form_diameter - 1e-6) & (radius > -gear.tip_form_diameter + 1e-6)
        assert np.abs(depth_off(gear, vertices[on_flank])).max() < ON_SURFACE * gear.profile.root_diameter
        points = unturned(gear, np.einsum("wk,nkd->nwd", _INSIDE, corners).reshape(-1, 3))
        shifts = np.linspace(-error, error, 7) if gear.helix_angle else [0.0]
        off = np.min([np.hypot(d, distance_to_section(gear, points + np.array([0, 0, d]))) for d in shifts], axis=0)
        assert error / 3 < off.max() <= error


def test_bolt_holes_and_rim_follow_the_chord_rule() -> None:
    gear = RINGS["form root"]
    facets = tessellate(gear)
    upright = facets.vertices[facets.faces]
    upright = upright[np.ptp(upright[..., 2], axis=1) > 0]
    body = gear.body
    centres = [(0.0, 0.0, body.rim_diameter / 2)]
    for angle in 2 * np.pi / body.bolt_holes * np.arange(body.bolt_holes):
        centres.append((body.bolt_circle / 2 * np.cos(angle), body.bolt_circle / 2 * np.sin(angle), body.bolt_diameter / 2))
    for x, y, radius in centres:
        on_wall = np.all(np.abs(np.hypot(upright[..., 0] - x, upright[..., 1] - y) - radius) < ON_SURFACE * 100, axis=1)
        assert on_wall.any()
        drop = radius - np.hypot(*(upright[on_wall].mean(axis=1)[:, :2] - [x, y]).T).min()
        assert 0.4 * DEFAULT < drop * 9 / 8 <= DEFAULT  # the centroid lies a third along the side: 8/9 of its sagitta


BOLTED = {
    "one hole": (138.0, 1, 6.0),
    "two": (138.0, 2, 6.0),
    "far apart, large": (145.0, 3, 14.5),
    "thinnest walls": (142.7, 6, 16.8),
    "thinnest walls all round": (142.7, 26, 16.8),
    "as many as there is room for": (140.0, 98, 4.2),
}


@pytest.mark.parametrize("holes", BOLTED)
def test_bolt_holes_of_any_number_and_size(holes: str) -> None:
    circle, count, diameter = BOLTED[holes]
    for chamfer in (0.0, 1.0):
        body = Body(rim_diameter=160.0, bolt_circle=circle, bolt_holes=count, bolt_diameter=diameter, end_chamfer=chamfer)
        gear = Gear(teeth=-60, normal_module=2, face_width=12, helix_angle=5, body=body)
        for error in (0.02, 0.001):
            facets = tessellate(gear, error)
            _closed(gear, facets)
            _faces_out(gear, facets)
            assert abs(facets.volume - RingSection(gear).volume) <= error * _mesh(facets).area


# ---------------------------------------------------------------------- what cells.py rests on


def _bulge(gear: Gear, curve: Curve) -> np.ndarray:
    """(L N - M^2)/(|L N| + M^2) of the swept side, the sign of its curvature: from differences of points in space."""
    s, h, rate = np.linspace(0.05, 0.95, 19), 2e-3, twist(gear)
    step = h / abs(rate)

    def surface(i: int, k: int) -> np.ndarray:
        radius, angle = curve.polar(s + i * h)
        turned = angle + rate * k * step
        return np.stack([radius * np.cos(turned), radius * np.sin(turned), np.full(len(s), k * step)], -1)

    middle = surface(0, 0)
    normal = np.cross(surface(1, 0) - surface(-1, 0), surface(0, 1) - surface(0, -1))
    bends = (
        surface(1, 0) - 2 * middle + surface(-1, 0),
        (surface(1, 1) - surface(1, -1) - surface(-1, 1) + surface(-1, -1)) / 4,
        surface(0, 1) - 2 * middle + surface(0, -1),
    )
    ss, sz, zz = (np.sum(bend * normal, -1) for bend in bends)
    return (ss * zz - sz**2) / (np.abs(ss * zz) + sz**2)


def test_gaussian_curvature_has_the_sign_that_triangles_rest_on() -> None:
    """Below zero on fillets of external teeth, hobbed or shaped, and on tip chamfers; above on fillets of helical rings."""
    rng, seen = np.random.default_rng(16), set()
    gears = [*SAMPLES.values(), *SHAPED.values(), *RINGS.values(), *(random_ring(rng) for _ in range(60))]
    for z in (9, 17, 40):
        gears += [Gear(teeth=z, normal_module=2, face_width=9, helix_angle=b, cutter=ShaperCutter(teeth=30)) for b in (8, -35)]
    gears.append(Gear(teeth=20, normal_module=2, face_width=9, helix_angle=20, body=Body(tip_chamfer=0.3)))
    for gear in (gear for gear in gears if abs(gear.helix_angle) > 1):
        for curve in (curve for curve in gear.profile.curves if curve.kind is not CurveKind.ROOT):
            if curve.kind is CurveKind.FILLET:
                low, high = (0.3, 1.0) if gear.internal else (-1.0, -0.01)
            else:
                low, high = (-1.0, -0.5) if curve.kind is CurveKind.CHAMFER else (-FLAT, FLAT)
            bulge = _bulge(gear, curve)
            assert low <= bulge.min(), (gear, curve.kind)
            assert bulge.max() <= high, (gear, curve.kind)
            seen.add((gear.internal, isinstance(gear.profile.tool, ShaperTip), curve.kind))
    assert len(seen) == 4 + 3 + 4  # hobbed, shaped without a chamfer, rings: with every kind of curve


# ---------------------------------------------------------------------- anywhere


def _check_random(gear: Gear, share: float) -> None:
    error = _error(gear, 0.01 * gear.normal_module * share)
    facets = tessellate(gear, error)
    _closed(gear, facets)
    _faces_out(gear, facets)
    assert abs(facets.volume - RingSection(gear).volume) <= error * _mesh(facets).area, gear
    if not gear.body.end_chamfer:
        assert _off(gear, _on_side(gear, facets, 12), error).max() <= error, gear


def test_random_rings_are_closed_within_the_chord_error_and_have_their_volume() -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        _check_random(random_ring(rng), float(rng.choice([1, 0.3])))


@pytest.mark.long
def test_random_rings_are_closed_within_the_chord_error_and_have_their_volume_long() -> None:
    rng = np.random.default_rng(33)
    for _ in range(5000):
        _check_random(random_ring(rng), float(rng.choice([1, 0.3, 0.05])))


def test_a_ring_without_a_rim_has_no_facets() -> None:
    with pytest.raises(GeometryError, match=r"body.rim_diameter is missing: must be given, at least 125.4 mm"):
        tessellate(Gear(teeth=-60, normal_module=2, face_width=12))


def test_a_chord_error_below_single_precision_is_refused() -> None:
    with pytest.raises(ParameterError, match="rim diameter of 150 mm"):
        tessellate(RINGS["form root"], 1e-6)


# ---------------------------------------------------------------------- files


@pytest.mark.parametrize("name", RINGS)
def test_stl_is_closed_when_read_again(name: str, tmp_path: Path) -> None:
    check_stl(tessellate(RINGS[name]), tmp_path / "ring.stl")


def _pair(helix: float = 0.0) -> GearPair:
    ring = Gear(
        teeth=-60, normal_module=2, face_width=12, helix_angle=helix, body=Body(rim_diameter=145.0), tooth_thinning=0.05
    )
    pinion = Gear(teeth=24, normal_module=2, face_width=10, helix_angle=helix, tooth_thinning=0.05)
    return GearPair(pinion=pinion, wheel=ring)


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_a_pair_stands_in_mesh_in_its_files(helix: float, tmp_path: Path) -> None:
    """The pinion at the origin, the ring at x = a < 0: pinion and ring come near, nowhere inside each other."""
    pair = _pair(helix)
    product = PairProduct(pair, FileOptions())
    parts = product.scene()
    assert parts[1].offset[0] == pair.centre_distance < 0
    for write, name in ((write_3mf, "pair.3mf"), (write_glb, "pair.glb")):
        write(parts, tmp_path / name)
        scene = trimesh.load_scene(tmp_path / name)
        assert len(scene.geometry) == 2
        scale = 1.0 if name.endswith("3mf") else 1000.0
        assert scene.extents.max() * scale == pytest.approx(145.0, rel=1e-3)
    model = trimesh.util.decompress((tmp_path / "pair.3mf").open("rb"), "zip")["3D/3dmodel.model"].read().decode()
    assert 'displaycolor="#CC8C33FF"' in model  # pinion
    assert 'displaycolor="#7394B8FF"' in model  # wheel
    pinion, ring = ((part.facets.vertices @ part.pose[:3, :3].T + part.pose[:3, 3]) for part in parts)
    # Points of the pinion, seen from the ring and turned back to its tooth 0: in its opening.
    seen = pinion - np.array(parts[1].offset)
    seen[:, :2] = seen[:, :2] @ parts[1].pose[:2, :2]
    section = RingSection(pair.wheel)
    radius, angle = section.folded(seen)
    half = np.interp(radius, (profile := _half_angles(pair.wheel))[0], profile[1])
    room = radius * (np.abs(angle) - half)
    near = radius > section.tip
    assert near.sum() > 100
    assert pair.circumferential_backlash / 2 * 0.5 < room[near].min() < 0.1
    assert len(ring) > 1000


def _half_angles(ring: Gear) -> tuple[np.ndarray, np.ndarray]:
    radius = np.linspace(ring.profile.tip_diameter / 2, ring.profile.root_diameter / 2, 2000)
    return radius, np.radians(ring.profile.half_angle(radius))
