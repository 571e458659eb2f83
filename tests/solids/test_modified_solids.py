"""The B-rep of gears and rings with modified flanks, measured before and after STEP against formulas."""

import math
from dataclasses import replace
from pathlib import Path

import cadquery
import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepClass import BRepClass_FaceClassifier
from OCP.GeomAbs import GeomAbs_BSplineSurface, GeomAbs_Cylinder
from OCP.gp import gp_Pnt2d
from OCP.TopAbs import TopAbs_IN
from support.clearance import distance_to_section
from support.modified import depth_off, folded, removed_volume, specified, unturned
from support.rings import RingSection
from support.samples import AMOUNTS, GEARS, crossed, modified, random_gear
from support.solids import reopened, valid_and_closed

from gearcad import BasicRack, Body, Gear, GeometryError
from gearcad.geometry import ShaperCutter
from gearcad.geometry.modification import FlankModification
from gearcad.solids import gear_solid, write_step

ON_FLANK = 1e-6  # mm: what section and sweep together are fitted to; the promise is 0.01 µm
VOLUME_TOLERANCE = 1e-7  # of the whole volume: what the kernel's own integration reaches
EDGE = 1e-6  # mm: radii this close to a circle are on it


def _sides(shape: cadquery.Shape, most: int = 32) -> list[cadquery.Face]:
    """At most so many B-spline faces (flanks, fillets, chamfers), from all teeth."""
    faces = [face for face in shape.Faces() if BRepAdaptor_Surface(face.wrapped).GetType() == GeomAbs_BSplineSurface]
    assert len(faces) >= 16, "a gear without flanks"
    return faces[:: math.ceil(len(faces) / most)]


def _points(faces: list[cadquery.Face], grid: int = 6) -> np.ndarray:
    """Points (n, 3) of the faces, inside their edges."""
    found = []
    for face in faces:
        surface = BRepAdaptor_Surface(face.wrapped)
        (u0, u1), (v0, v1) = face._uvBounds()[:2], face._uvBounds()[2:]
        for u in u0 + (u1 - u0) * (np.arange(grid) + 0.37) / grid:
            for v in v0 + (v1 - v0) * (np.arange(grid) + 0.41) / grid:
                if BRepClass_FaceClassifier(face.wrapped, gp_Pnt2d(u, v), 1e-7).State() == TopAbs_IN:
                    point = surface.Value(u, v)
                    found.append((point.X(), point.Y(), point.Z()))
    return np.array(found)


def _edge_points(faces: list[cadquery.Face], count: int = 6) -> np.ndarray:
    """Points (n, 3) of the faces' edges, ends included."""
    curves = [BRepAdaptor_Curve(edge.wrapped) for face in faces for edge in face.Edges()]
    points = [c.Value(t) for c in curves for t in np.linspace(c.FirstParameter(), c.LastParameter(), count)]
    return np.array([(point.X(), point.Y(), point.Z()) for point in points])


def _on_involute(gear: Gear, points: np.ndarray) -> np.ndarray:
    radius = np.hypot(*points[:, :2].T)
    return points[(radius > gear.form_diameter / 2 + EDGE) & (radius < gear.tip_form_diameter / 2 - EDGE)]


def _measure(gear: Gear, shape: cadquery.Shape) -> None:
    """Flanks, fillets and chamfers lie where they are specified, inside of faces and on edges."""
    faces = _sides(shape)
    points = np.concatenate([_points(faces), _edge_points(faces)])
    flank = _on_involute(gear, points)
    assert len(flank) > 200
    assert np.abs(depth_off(gear, flank)).max() < ON_FLANK
    radius = np.hypot(*points[:, :2].T)
    rest = points[(radius < gear.form_diameter / 2 - EDGE) | (radius > gear.tip_form_diameter / 2 + EDGE)]
    assert len(rest) > 100
    assert distance_to_section(gear, unturned(gear, rest)).max() < ON_FLANK


@pytest.mark.parametrize(("name", "amount"), crossed(AMOUNTS))
def test_each_modification_is_measured_on_the_solid(name: str, amount: str) -> None:
    gear = modified(GEARS[name], amount)
    solid = gear_solid(gear)
    assert valid_and_closed(solid)
    _measure(gear, solid)


_LIKE_OTHERS = ("spur", "right hand", "chamfered", "chamfered, spur")
"""What the kernel reads of them it reads of the others too, and reading takes it most of the time."""


@pytest.mark.parametrize("shape", ["linear", pytest.param("parabolic", marks=pytest.mark.long)])
@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name in _LIKE_OTHERS)) for name in GEARS])
def test_all_modifications_after_step(name: str, shape: str, tmp_path: Path) -> None:
    gear = modified(GEARS[name], tip_relief_shape=shape, root_relief_shape=shape, end_relief_shape=shape)
    solid = gear_solid(gear)
    assert valid_and_closed(solid)
    again = reopened(solid, tmp_path / "gear.step")
    assert valid_and_closed(again)
    _measure(gear, again)


@pytest.mark.parametrize(("name", "amount"), crossed([*AMOUNTS, "all"]))
def test_the_volume_taken_off(name: str, amount: str) -> None:
    gear = modified(GEARS[name], *(() if amount == "all" else (amount,)))
    exact = gear_solid(GEARS[name])
    removed = exact.Volume() - gear_solid(gear).Volume()
    assert removed == pytest.approx(removed_volume(gear), abs=VOLUME_TOLERANCE * exact.Volume())


@pytest.mark.parametrize("share", [1.0, *(pytest.param(share, marks=pytest.mark.long) for share in (0.3, 1.7))])
@pytest.mark.parametrize(
    "name",
    ["chamfered", *(pytest.param(name, marks=pytest.mark.long) for name in ("chamfered, spur", "chamfered to the root"))],
)
def test_an_end_relief_that_begins_inside_on_or_beyond_the_cone(name: str, share: float, tmp_path: Path) -> None:
    """Where the cone crosses the height at which the relief begins, faces end in a corner."""
    plain = GEARS[name]
    gear = modified(plain, end_relief_length=min(share * plain.body.end_chamfer, plain.face_width / 2))
    solid = gear_solid(gear)
    again = reopened(solid, tmp_path / "gear.step")
    assert valid_and_closed(again)
    _measure(gear, again)
    removed = gear_solid(plain).Volume() - solid.Volume()
    assert removed == pytest.approx(removed_volume(gear), abs=VOLUME_TOLERANCE * solid.Volume())


def test_reliefs_that_meet_in_one_line() -> None:
    """Tip and root relief that begin in one place, end reliefs that meet in the middle: one break each."""
    plain = GEARS["spur"]
    flank = plain.flank_form.last - plain.flank_form.first
    lengths = {"tip_relief_length": flank / 2, "root_relief_length": flank / 2, "end_relief_length": plain.face_width / 2}
    lengths |= {"tip_relief_transition": 0.0, "root_relief_transition": 0.0}
    gear = modified(plain, "tip_relief", "root_relief", "end_relief", **lengths)
    solid = gear_solid(gear)
    assert valid_and_closed(solid)
    _measure(gear, solid)
    more = len(solid.Faces()) - len(gear_solid(plain).Faces())
    assert more == plain.teeth * (2 * 3 * 2 - 2 * 2)  # fillet and two parts of the flank, in two halves, for fillet and flank


@pytest.mark.parametrize(
    "gap", [pytest.param(1e-4, marks=pytest.mark.long), 1e-6, 1e-7, pytest.param(1e-8, marks=pytest.mark.long)]
)
def test_reliefs_that_all_but_meet(gap: float, tmp_path: Path) -> None:
    """A stretch between two breaks that is narrower than the kernel can tell is left out."""
    plain = GEARS["undercut"]
    flank = plain.flank_form.last - plain.flank_form.first
    lengths = {"tip_relief_length": flank / 2, "root_relief_length": flank / 2 - gap}
    gear = modified(plain, **lengths, end_relief_length=plain.face_width / 2 - gap)
    solid = gear_solid(gear)
    for made in (solid, reopened(solid, tmp_path / "gear.step")):
        assert valid_and_closed(made)
    _measure(gear, solid)


def test_lands_reach_from_flank_to_flank() -> None:
    """Tip and root land stay cylinders; their edges have turned with the flanks."""
    gear = modified(GEARS["left hand"])
    lands = [face for face in gear_solid(gear).Faces() if BRepAdaptor_Surface(face.wrapped).GetType() == GeomAbs_Cylinder]
    assert len(lands) == 2 * gear.teeth
    radius, angle, z = folded(gear, _edge_points(lands))
    tip = np.abs(radius - gear.tip_diameter / 2) < EDGE
    inside = (z > EDGE) & (z < gear.face_width - EDGE)
    left = angle > 0
    for on_land, circle in ((tip, gear.tip_diameter), (~tip, gear.root_diameter)):
        side = inside & on_land
        half = math.radians(gear.profile.half_angle(circle / 2))
        turned = half - specified(gear, radius[side], z[side], left[side]) / (gear.base_diameter / 2)
        assert side.sum() > 4 * gear.teeth
        assert np.abs(np.abs(angle[side]) - turned).max() * circle / 2 < ON_FLANK


def test_fillets_without_a_root_land_go_on_meeting() -> None:
    """A full root radius leaves no land to open: the fillets turn less and less towards the middle of the space."""
    plain = replace(GEARS["right hand"], rack=BasicRack(root_radius="full"))
    gear = modified(plain)
    solid = gear_solid(gear)
    assert valid_and_closed(solid)
    points = _edge_points(_sides(solid, 150))
    root = points[np.abs(np.hypot(*points[:, :2].T) - gear.root_diameter / 2) < EDGE]
    assert len(root) > 100
    assert distance_to_section(gear, root).max() < ON_FLANK
    flank = _on_involute(gear, _points(_sides(solid)))
    assert np.abs(depth_off(gear, flank)).max() < ON_FLANK


def test_no_modification_leaves_the_solid_as_it_was(tmp_path: Path) -> None:
    """Lengths and shapes without amounts change nothing, to the byte."""
    plain = GEARS["chamfered"]
    idle = replace(plain, modification=FlankModification(tip_relief_length=1.0, end_relief_length=2.0))
    for name, gear in (("plain", plain), ("idle", idle)):
        write_step(gear_solid(gear), tmp_path / name, name="gear")
    assert (tmp_path / "plain").read_bytes() == (tmp_path / "idle").read_bytes()


def test_two_turns_of_twist_are_parted() -> None:
    """A long helical gear needs more than one polynomial along z."""
    width = 7.9 * math.pi * 10 / math.tan(math.radians(30)) / math.cos(math.radians(30)) / 2
    gear = modified(Gear(teeth=10, normal_module=2.0, face_width=width, helix_angle=30, profile_shift=0.3))
    solid = gear_solid(gear)
    assert valid_and_closed(solid)
    _measure(gear, solid)


def _check_random(seed: int, path: Path) -> None:
    gear = random_gear(seed)
    solid = gear_solid(gear)
    for made in (solid, reopened(solid, path)):
        assert valid_and_closed(made), gear
    _measure(gear, solid)
    removed = gear_solid(replace(gear, modification=FlankModification())).Volume() - solid.Volume()
    assert removed == pytest.approx(removed_volume(gear), abs=VOLUME_TOLERANCE * solid.Volume()), gear


@pytest.mark.parametrize("seed", [109, 239])  # these have been wrong once
def test_random_modifications(seed: int, tmp_path: Path) -> None:
    _check_random(seed, tmp_path / "gear.step")


@pytest.mark.long
@pytest.mark.parametrize("seed", range(300))
def test_random_modifications_long(seed: int, tmp_path: Path) -> None:
    _check_random(seed, tmp_path / "gear.step")


_RIM = Body(rim_diameter=110)
_PLAIN = {"teeth": -40, "normal_module": 2.0, "face_width": 12.2, "body": _RIM}
_CUTTER = ShaperCutter(teeth=25, tip_radius=0.2)

RINGS = {
    "spur, form root": Gear(**_PLAIN),
    "right hand, shaped": Gear(**_PLAIN | {"helix_angle": 28.0, "cutter": _CUTTER}),
    "left hand": Gear(**_PLAIN | {"helix_angle": -15.0, "profile_shift": -0.4, "cutter": ShaperCutter(tip_radius=0.2)}),
    "chamfered": Gear(**_PLAIN | {"helix_angle": 25.0, "body": replace(_RIM, end_chamfer=1.2, tip_chamfer=0.3)}),
    "chamfered beyond the root": Gear(**_PLAIN | {"helix_angle": -17.0, "body": replace(_RIM, end_chamfer=5.2)}),
}  # fmt: skip


def _ring_points(shape: cadquery.Shape, most: int = 48, grid: int = 5) -> np.ndarray:
    """Points (n, 3) of the B-spline faces (flanks, fillets, chamfers), inside their edges and on some of them."""
    faces = [face for face in shape.Faces() if BRepAdaptor_Surface(face.wrapped).GetType() == GeomAbs_BSplineSurface]
    found = []
    for face in faces[:: math.ceil(len(faces) / most)]:
        surface = BRepAdaptor_Surface(face.wrapped)
        u0, u1, v0, v1 = face._uvBounds()
        for u in u0 + (u1 - u0) * (np.arange(grid) + 0.37) / grid:
            for v in v0 + (v1 - v0) * (np.arange(grid) + 0.41) / grid:
                if BRepClass_FaceClassifier(face.wrapped, gp_Pnt2d(u, v), 1e-7).State() == TopAbs_IN:
                    found.append(surface.Value(u, v))
        found += [edge.positionAt(t).toPnt() for edge in face.Edges() for t in (0.0, 0.3, 1.0)]
    return np.array([(point.X(), point.Y(), point.Z()) for point in found])


def _ring_measure(gear: Gear, shape: cadquery.Shape) -> None:
    """Flanks, fillets and chamfers lie where they are specified, inside of faces and on edges."""
    section, points = RingSection(gear), _ring_points(shape)
    radius = np.hypot(*points[:, :2].T)
    flank = (radius < section.form - ON_FLANK) & (radius > section.tip_form + ON_FLANK)
    assert flank.sum() > 200
    assert np.abs(depth_off(gear, points[flank])).max() < ON_FLANK
    rest = (radius > section.form + ON_FLANK) | (radius < section.tip_form - ON_FLANK)
    assert rest.sum() > 100
    assert section.off(unturned(gear, points[rest])).max() < ON_FLANK


_LONG = ("spur, form root", "right hand, shaped", "chamfered", "chamfered beyond the root")


@pytest.mark.long
@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name in _LONG)) for name in RINGS])
def test_all_modifications_before_and_after_step(name: str, tmp_path: Path) -> None:
    gear = modified(RINGS[name])
    solid = gear_solid(gear)
    for made in (solid, reopened(solid, tmp_path / "ring.step")):
        assert valid_and_closed(made)
    _ring_measure(gear, solid)
    removed = gear_solid(RINGS[name]).Volume() - solid.Volume()
    assert removed == pytest.approx(removed_volume(gear), abs=VOLUME_TOLERANCE * solid.Volume())


def _crossed() -> list[object]:
    """Every ring with every modification: an eighth of them by default, the others long."""
    return [
        pytest.param(name, amount, marks=() if (row + column) % 8 == 0 else pytest.mark.long)
        for row, name in enumerate(RINGS)
        for column, amount in enumerate(AMOUNTS)
    ]


@pytest.mark.parametrize(("name", "amount"), _crossed())
def test_ring_each_modification_is_measured_on_the_solid(name: str, amount: str) -> None:
    gear = modified(RINGS[name], amount)
    solid = gear_solid(gear)
    assert valid_and_closed(solid)
    _ring_measure(gear, solid)


def test_ring_fillets_without_a_root_land_go_on_meeting() -> None:
    """A full radius leaves no land to open: the fillets turn less and less towards the middle of the space."""
    gear = modified(Gear(**_PLAIN | {"helix_angle": 20.0, "rack": BasicRack(root_radius="full")}))
    section, solid = RingSection(gear), gear_solid(gear)
    assert valid_and_closed(solid)
    points = _ring_points(solid, 160)
    radius = np.hypot(*points[:, :2].T)
    flank = (radius < section.form - ON_FLANK) & (radius > section.tip_form + ON_FLANK)
    assert np.abs(depth_off(gear, points[flank])).max() < ON_FLANK
    root = np.abs(radius - section.root) < ON_FLANK
    assert root.sum() > 50
    angle = section.folded(points[root])[1]
    assert np.abs(section.pitch / 2 - np.abs(angle)).max() * section.root < ON_FLANK


def test_sharp_corners_turn_with_their_flanks() -> None:
    kinks = {"tip_relief_transition": 0.0, "root_relief_transition": 0.0}
    gear = modified(Gear(**_PLAIN | {"helix_angle": 15.0, "cutter": ShaperCutter(tip_radius=0.0)}), **kinks)
    solid = gear_solid(gear)
    assert valid_and_closed(solid)
    points = _ring_points(solid)
    assert np.abs(depth_off(gear, points)).max() < ON_FLANK
    assert np.hypot(*points[:, :2].T).max() == pytest.approx(RingSection(gear).root, abs=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(200))
def test_random_rings_long(seed: int, tmp_path: Path) -> None:
    """Random rings, two in three of them modified, chamfered or bolted: sides, volume, validity, STEP."""
    plain, gear = _random(seed)
    before, solid = gear_solid(plain), gear_solid(gear)
    again = reopened(solid, tmp_path / "ring.step")
    for made in (before, solid, again):
        assert valid_and_closed(made), gear
    assert before.Volume() == pytest.approx(RingSection(plain).volume, rel=VOLUME_TOLERANCE), plain
    assert again.Volume() == pytest.approx(solid.Volume(), rel=VOLUME_TOLERANCE), gear
    _ring_measure(gear, solid)
    assert before.Volume() - solid.Volume() == pytest.approx(removed_volume(gear), abs=VOLUME_TOLERANCE * solid.Volume()), gear


def _random(seed: int) -> tuple[Gear, Gear]:
    """A random ring, and the same with random modifications or none."""
    rng = np.random.default_rng(seed)
    while True:
        try:
            plain = _draw(rng)
            if rng.random() < 0.3:
                return plain, plain
            names = [name for name in AMOUNTS if rng.random() < 0.5] or ["tip_relief"]
            amounts = {name: AMOUNTS[name] * min(plain.normal_module, 2.0) / 2 for name in names}
            lengths = {"end_relief_length": rng.uniform(0.02, 0.5) * plain.face_width}
            return plain, modified(plain, *names, **amounts, **lengths)
        except GeometryError:
            continue


def _draw(rng: np.random.Generator) -> Gear:
    module = float(rng.choice([0.05, 0.5, 2.0, 6.0, 100.0]))
    teeth, width = int(rng.integers(30, 120)), module * rng.uniform(0.2, 20)
    cutter = ShaperCutter(tip_radius=rng.uniform(0.05, 0.3))
    if rng.random() < 0.6:
        cutter = replace(cutter, teeth=int(rng.integers(12, teeth - 10)), profile_shift=rng.uniform(-0.2, 0.3))
    bare = Gear(
        teeth=-teeth,
        normal_module=module,
        face_width=width,
        helix_angle=float(rng.choice([0, rng.uniform(-40, 40)])),
        profile_shift=rng.uniform(-1.0, 0.3),
        tooth_thinning=module * rng.uniform(0, 0.05),
        cutter=cutter,
    )
    root = -bare.root_diameter
    body = {"rim_diameter": root + module * rng.uniform(0.3, 12)}
    if rng.random() < 0.5:
        body |= {"end_chamfer": module * rng.uniform(0.05, 1.5), "end_chamfer_angle": rng.uniform(15, 65)}
    if rng.random() < 0.3:
        body["tip_chamfer"] = module * rng.uniform(0.05, 0.2)
    if rng.random() < 0.3:
        middle = (root + body["rim_diameter"]) / 2
        body |= {"bolt_circle": middle, "bolt_holes": 7, "bolt_diameter": module * rng.uniform(0.1, 2)}
    return replace(bare, body=Body(**body))
