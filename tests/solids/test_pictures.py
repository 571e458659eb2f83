"""Pictures: what turns stands as teeth have it and comes round, cuts are closed, images are at scale, from where they say."""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy.spatial import cKDTree
from support.train_solids import alm_train, simple_set, small_train

from gearcad import Body, Gear, GearPair, Rack, RackPair
from gearcad.core.errors import OutputError
from gearcad.planetary.train_data import speeds
from gearcad.solids import Facets, FileOptions, tessellate, tessellate_rack
from gearcad.solids.files import studio
from gearcad.solids.files.cutaway import Cutaway, CutFacets, CutPlanes, SceneView, cut_away
from gearcad.solids.files.products import GearProduct, PairProduct, RackPairProduct, RackProduct
from gearcad.solids.files.scenes import ScenePart
from gearcad.solids.files.shot import MOST_FRAMES, Product, Shot, come_round, frames_for, loop_of
from gearcad.solids.files.studio import Animation, Edges, write_animation
from gearcad.solids.files.train_products import TrainProduct
from gearcad.solids.train_plan import TrainLayout

COARSE = FileOptions(chord_error=0.05)

PINION = Gear(teeth=12, normal_module=2, face_width=10, helix_angle=20, body=Body(bore=8))
PAIR = GearPair(pinion=PINION, wheel=Gear(teeth=19, normal_module=2, face_width=10, helix_angle=-20, body=Body(bore=10)))
RACK_PAIR = RackPair(
    pinion=Gear(teeth=12, normal_module=2, face_width=10), rack=Rack(teeth=14, normal_module=2, face_width=10, height=8)
)


def _keyed(gear: Gear) -> Gear:
    return replace(gear, body=replace(gear.body, keyway_width=2, keyway_depth=1))


def _gear(gear: Gear) -> GearProduct:
    return GearProduct(gear=gear, name="gear", options=COARSE)


TURNING: dict[str, Product] = {
    "gear": _gear(PINION),
    "gear with a keyway": _gear(_keyed(PINION)),
    "pair": PairProduct(PAIR, COARSE),
    "pair with a keyway": PairProduct(replace(PAIR, pinion=_keyed(PAIR.pinion)), COARSE),
    "rack": RackPairProduct(RACK_PAIR, COARSE),
    "set": TrainProduct(simple_set(24, 21, -66, 3), COARSE),
    "star": TrainProduct(replace(simple_set(24, 20, -64, 4, 15.0), fixed="carrier", output="b"), COARSE),
    "stepped": TrainProduct(small_train(), COARSE),
    "too long": TrainProduct(alm_train(), COARSE),
}


def _apart(one: Sequence[ScenePart], other: Sequence[ScenePart]) -> float:
    """How far (mm) any point of a scene is from the nearest point of the same body in another one.

    Round walls inside and outside are left out: their facets are no pitches, which nobody sees.
    """
    clouds: tuple[dict[int, list[np.ndarray]], ...] = ({}, {})
    for cloud, parts in zip(clouds, (one, other), strict=True):
        for part in parts:
            radius = np.hypot(part.facets.vertices[:, 0], part.facets.vertices[:, 1])
            own = part.facets.vertices[(radius > radius.min() + 1e-6) & (radius < radius.max() - 1e-6)]
            cloud.setdefault(id(part.facets), []).append(own @ part.pose[:3, :3].T + part.pose[:3, 3])
    trees = {body: cKDTree(np.concatenate(points)) for body, points in clouds[0].items()}
    return max(float(trees[body].query(np.concatenate(points))[0].max()) for body, points in clouds[1].items())


# ---------------------------------------------------------------------- loops


@pytest.mark.parametrize("name", TURNING)
@pytest.mark.parametrize("view", [SceneView.CORNER, SceneView.MESH])
def test_a_loop_ends_where_it_begins_and_not_before(name: str, view: SceneView) -> None:
    loop = loop_of(TURNING[name], view)
    assert loop.closes
    begun = loop.scene(0.0)
    assert _apart(begun, loop.scene(1.0)) < 1e-9
    assert _apart(begun, loop.scene(0.25)) > 0.01
    if name != "rack":
        assert all(_apart(begun, loop.scene(1 / part)) > 0.01 for part in (2, 3, 5, 7))
    turned = [abs(turns) for turns in loop.turns.values()]
    # Between two frames teeth pass less than half a pitch: they seem to go the way they go.
    assert loop.frames >= 2 * loop.pitches and loop.frames <= MOST_FRAMES
    assert max(turned) > 0 or name == "rack"


@pytest.mark.parametrize("share", [0.0, 0.37, 0.81])
def test_gears_of_a_pair_turn_by_their_teeth_and_a_rack_moves_by_the_arc(share: float) -> None:
    loop = loop_of(TURNING["pair"], SceneView.CORNER)
    begun, (pinion, wheel) = loop.scene(0.0), loop.scene(share)
    assert pinion.rotation == pytest.approx(360 * share / 12)
    assert (wheel.rotation - begun[1].rotation) * 19 == pytest.approx(-pinion.rotation * 12)
    pose = PAIR.wheel_pose(pinion.rotation)
    assert (wheel.rotation, wheel.offset) == (pose.rotation, (pose.x, 0.0, pose.z))
    loop = loop_of(TURNING["rack"], SceneView.CORNER)
    begun, (pinion, rack) = loop.scene(0.0), loop.scene(share)
    assert rack.offset[1] - begun[1].offset[1] == pytest.approx(math.radians(pinion.rotation) * 12, abs=1e-12)


@pytest.mark.parametrize("name", ["set", "star", "stepped", "too long"])
def test_a_train_turns_with_the_speeds_of_willis_where_its_pose_has_it(name: str) -> None:
    product = TURNING[name]
    assert isinstance(product, TrainProduct)
    train, loop = product.train, loop_of(product, SceneView.CORNER)
    held = name in ("stepped", "too long")
    assert [notice.code for notice in loop.notices] == (["carrier-held"] if held else [])
    found = speeds(train, {train.input: 1.0}).members
    still = found[train.carrier.name] if held else 0.0
    first, second = (each.name for each in train.centrals)
    assert loop.turns[first] * (found[second] - still) == pytest.approx(loop.turns[second] * (found[first] - still), abs=1e-12)
    if not held:
        share = 0.3
        turns = loop.turns[first] / found[first] if found[first] else loop.turns[second] / found[second]
        told = next(name for name in (train.fixed, second) if name in (first, second))
        angles = [360 * share * turns * found[each] for each in (train.carrier.name, told)]
        posed = {each.name: each for each in TrainLayout(train, train.pose(*angles)).standing}
        for part in loop.scene(share):
            assert part.rotation == pytest.approx(posed[part.name].rotation, abs=1e-9)
            assert part.offset == pytest.approx(posed[part.name].offset, abs=1e-9)


def test_what_never_comes_round_in_time_is_shown_without_what_hinders_it() -> None:
    gear = replace(_keyed(PINION), teeth=193, helix_angle=0.0)
    loop = loop_of(_gear(gear), SceneView.CORNER)
    assert (loop.pitches, [notice.code for notice in loop.notices]) == (1, ["features-left-out"])
    assert frames_for(192) == MOST_FRAMES and frames_for(193) is None and frames_for(1) == 24
    assert come_round([Fraction(3, 4), Fraction(0), Fraction(5, 6)]) == 12


# ---------------------------------------------------------------------- edges and cuts


def test_edges_of_a_cylinder_are_its_ends_and_two_lines_at_its_sides() -> None:
    ring = tessellate(Gear(teeth=-40, normal_module=2, face_width=10, body=Body(rim_diameter=110)), 0.02)
    edges = Edges.of(ring)
    assert len(edges.ends) == 3 * len(ring.faces) / 2
    seen = ring.vertices[edges.drawn(np.array([0.0, -1.0, 0.0]))]
    outer = seen[np.hypot(seen[..., 0], seen[..., 1]).min(axis=1) > 54.9]
    upright = np.ptp(outer[..., 2], axis=1) > 5
    assert np.abs(outer[upright][..., 0]) == pytest.approx(55, abs=0.2) and upright.sum() >= 2
    rims = outer[~upright]
    assert np.linalg.norm(np.diff(rims, axis=1), axis=-1).sum() == pytest.approx(2 * math.pi * 110, rel=1e-3)


def _volume(left: CutFacets) -> float:
    """Of what a cut leaves, its faces included, which close it."""
    found = left.facets.volume
    for triangles, normal, _ in left.faces:
        areas = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) @ normal / 2
        assert areas.min(initial=0.0) >= -1e-9 * areas.sum()  # all of them face the way the cut does
        found += float((areas * (triangles.mean(axis=1) @ normal)).sum()) / 3
    return found


def _turned(facets: Facets, angle: float) -> Facets:
    cosine, sine = math.cos(angle), math.sin(angle)
    return Facets(facets.vertices @ np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]]), facets.faces.copy())


CUT_OPEN = {
    "keyway and hub": (tessellate(_keyed(replace(PINION, body=Body(bore=8, hub_diameter=14, hub_length=5))), 0.02), (0, 0, 4)),
    "ring": (tessellate(Gear(teeth=-50, normal_module=1, face_width=4, body=Body(rim_diameter=60)), 0.02), (0, 0, 2)),
    "long rack": (tessellate_rack(Rack(teeth=400, normal_module=1, face_width=10, height=10), 0.01), (600.0, 0, 5)),
}


@pytest.mark.parametrize("angle", [0.0, 1.1])
@pytest.mark.parametrize("name", CUT_OPEN)
def test_cuts_are_closed_and_leave_what_they_should(name: str, angle: float) -> None:
    """The pieces on both sides of a plane, and in four quarters, add up to the whole: their faces close each."""
    facets, at = CUT_OPEN[name]
    whole, point = _turned(facets, angle), _turned(Facets(np.array([at], float), np.zeros((0, 3), int)), angle).vertices[0]
    near, aside, up = (np.array(normal, float) for normal in ((0, -1, 0), (1, 0, 0), (0, 0, 1)))
    for one, other in ((near, aside), (up, near)):
        halves = [_volume(cut_away(whole, CutPlanes(point, (normal,)))) for normal in (one, -one)]
        assert sum(halves) == pytest.approx(whole.volume, rel=1e-9)
        rests = [_volume(cut_away(whole, CutPlanes(point, (a, b)))) for a in (one, -one) for b in (other, -other)]
        assert sum(rests) == pytest.approx(3 * whole.volume, rel=1e-9)
        assert rests[0] + rests[1] == pytest.approx(whole.volume + halves[0], rel=1e-9)


def test_the_face_of_a_cut_has_the_area_and_the_outline_of_the_section() -> None:
    """A rack of 400 teeth cut in the middle of its width: its volume over its width, the same around it as at its end."""
    facets, at = CUT_OPEN["long rack"]
    (face,) = cut_away(facets, CutPlanes(np.array(at), (np.array([0.0, 0.0, 1.0]),))).faces
    a, b, c = face.triangles.transpose(1, 0, 2)
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 == pytest.approx(facets.volume / 10, rel=1e-9)
    assert face.triangles[..., 2] == pytest.approx(5)
    # Its back, the lowest line, is in it twice.
    around = np.linalg.norm(np.diff(face.outline, axis=1), axis=-1).sum() - 400 * math.pi
    ends = facets.vertices[Edges.of(facets).drawn(np.array([0.0, 0.0, 1.0]))]
    ends = ends[(ends[..., 2] == 10).all(axis=1)]
    assert around == pytest.approx(np.linalg.norm(np.diff(ends, axis=1), axis=-1).sum(), rel=1e-3)


# ---------------------------------------------------------------------- images


def _pixels(shot: Shot) -> np.ndarray:
    (pixels,) = shot.frames()
    return pixels.astype(float)


def _redness(pixels: np.ndarray) -> list[float]:
    """By how much there is more red than blue in what is painted in the left and in the right third of a picture."""
    third = pixels.shape[1] // 3
    parts = (pixels[:, :third], pixels[:, -third:])
    return [float((part[..., 0] - part[..., 2])[(part[..., :3] < 250).any(axis=-1)].mean()) for part in parts]


def test_a_picture_is_at_scale_and_in_the_middle() -> None:
    """Opacity adds up to the area of the section, and half of a line, a third of a pixel wide, around it."""
    gear = Gear(teeth=20, normal_module=2, face_width=10, body=Body(bore=12))
    shot = Shot(product=_gear(gear), view=SceneView.FRONT, size=(300, 240), transparent=True)
    opacity = _pixels(shot)[..., 3] / 255
    millimetre = 120 / shot.camera.half_height
    area = shot.product.facets.volume / 10  # type: ignore[union-attr]
    around = math.pi * (12 + 2 * 40) * millimetre / 6
    assert opacity.sum() == pytest.approx(area * millimetre**2 + around, rel=3e-3)
    rows, columns = (np.average(np.arange(size) + 0.5, weights=opacity.sum(axis=axis)) for axis, size in ((1, 240), (0, 300)))
    assert (columns, rows) == pytest.approx((150, 120), abs=0.2)
    assert 2 * shot.camera.half_height == pytest.approx(1.06 * gear.tip_diameter, rel=2e-3)


def test_views_are_from_where_they_say() -> None:
    shot = Shot(product=TURNING["pair"], view=SceneView.FRONT, size=(120, 80))
    for view in (SceneView.FRONT, SceneView.TOP, SceneView.MESH):  # brass on the left, steel on the right
        left, right = _redness(_pixels(replace(shot, view=view)))
        assert left > 30 and right < -20
    side = _pixels(replace(shot, view=SceneView.SIDE))[:, 45:75]  # only the wheel is seen from the right
    assert max(_redness(side)) < -20
    rack = RackProduct(rack=RACK_PAIR.rack, name="rack", options=COARSE)
    standing = _pixels(Shot(product=rack, view=SceneView.FRONT, size=(160, 40), transparent=True))[..., 3] > 128
    rows = np.flatnonzero(standing.any(axis=1))
    assert standing[rows[1]].mean() < 0.6 < 0.9 < standing[rows[-2]].mean()  # teeth up


def test_a_cut_shows_its_colour_and_a_pair_apart_a_gap() -> None:
    shot = Shot(product=TURNING["pair"], size=(160, 120))
    for cutaway in Cutaway:
        pixels = _pixels(replace(shot, cutaway=cutaway))
        assert ((pixels[..., 0] > 1.6 * pixels[..., 1]) & (pixels[..., 0] > 1.6 * pixels[..., 2])).sum() > 100
    scene = replace(shot, exploded=True).scene(0.0)
    mates = [part.facets.vertices @ part.pose[:3, :3].T + part.pose[:3, 3] for part in scene]
    assert mates[1][:, 0].min() - mates[0][:, 0].max() == pytest.approx(0.3 * PINION.tip_diameter)


@pytest.fixture(scope="module")
def turning() -> Shot:
    product = TURNING["pair"]
    loop = replace(loop_of(product, SceneView.MESH), frames=5)
    return Shot(product=product, view=SceneView.MESH, size=(64, 48), loop=loop, transparent=True)


@pytest.fixture(scope="module")
def frames(turning: Shot) -> list[np.ndarray]:
    return list(turning.frames())


def test_the_last_frame_leads_on_to_the_first(turning: Shot, frames: list[np.ndarray]) -> None:
    assert turning.loop is not None
    scene = turning.loop.scene
    again = next(replace(turning, loop=replace(turning.loop, scene=lambda share: scene(share + 1))).frames())
    assert np.abs(again.astype(float) - frames[0]).mean() < 0.05
    values = [frame.astype(float) for frame in frames]
    steps = [np.abs(one - other).mean() for one, other in zip(values, [*values[1:], values[0]], strict=True)]
    assert min(steps) > 0.3 and steps[-1] < 1.5 * max(steps[:-1])


@pytest.mark.parametrize("kind", Animation)
def test_loops_are_written_with_all_frames_in_equal_bytes(kind: Animation, frames: list[np.ndarray], tmp_path: Path) -> None:
    for name in ("one", "two"):
        write_animation(frames, tmp_path / name, kind, 40)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()
    with Image.open(tmp_path / "one") as image:
        found = image.n_frames, image.info.get("loop", 0), image.size  # type: ignore[attr-defined]
        assert found == (5, 0, (64, 48))
        image.seek(3)
        image.load()
        assert image.info["duration"] == 40
        shown = np.asarray(image.convert("RGBA")).astype(float)
    opaque = (frames[3][..., 3] == 255) & (shown[..., 3] == 255)
    assert opaque.mean() > 0.7 and np.abs(shown - frames[3])[opaque].mean() < 4


def test_without_opengl_one_line_says_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    class Window:
        def GetClassName(self) -> str:
            return "vtkOSOpenGLRenderWindow"

    opened: list[str] = []

    def missing(name: str) -> None:
        opened.append(name)
        raise OSError(name)

    monkeypatch.setattr(studio.ctypes, "CDLL", missing)
    with pytest.raises(OutputError, match=r"no OpenGL here.*libegl1") as caught:
        studio.require_opengl(Window())  # type: ignore[arg-type]
    assert "\n" not in str(caught.value) and opened
    monkeypatch.setattr(studio.ctypes, "CDLL", opened.append)
    studio.require_opengl(Window())  # type: ignore[arg-type]
