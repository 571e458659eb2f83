"""Files of whole trains: scenes that turn as the train does, meshes written once, sections in place, pictures, and a table."""

import math
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from zipfile import ZipFile

import ezdxf
import numpy as np
import pytest
import trimesh
from matplotlib.path import Path as Outline
from PIL import Image
from support.gltf import Glb
from support.train_solids import alm_train, simple_set, small_train

from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.train_data import speeds
from gearcad.solids import FileOptions, Format
from gearcad.solids.exact.solid import cad_solid
from gearcad.solids.files.train_products import TrainProduct, turning_of
from gearcad.solids.train_plan import TrainLayout
from gearcad.verification.facets import read_facets

COARSE = FileOptions(chord_error=0.05)


def _write(train: PlanetaryTrain, kind: Format, path: Path, **options: bool) -> Path:
    write = kind.entry.write_train
    assert write is not None
    file = path / f"assembly.{kind.value}"
    write(TrainProduct(train, replace(COARSE, **options)), file)
    return file


# ---------------------------------------------------------------------- GLB

TURNING = {
    "carrier held": replace(simple_set(24, 20, -64, 4, 15.0), fixed="carrier", output="b"),
    "differential": replace(simple_set(24, 21, -66, 3), fixed=None, output="b"),
    "stepped, with a stage": small_train(),
    "the thesis's": alm_train(),
}


@pytest.mark.parametrize("name", TURNING)
def test_a_scene_turns_as_the_train_does(name: str, tmp_path: Path) -> None:
    """At times on keyframes and between them, every part is where the train's pose puts it."""
    train = TURNING[name]
    glb = Glb(_write(train, Format.GLB, tmp_path, turning=True, carrier=True))
    members = [central.name for central in train.centrals]
    for share in (0.0, 0.013, 0.1234, 0.5, 0.87, 1.0):
        time = share * glb.duration
        places = glb.places(time)
        # The pose is told by the carrier and by the central that is held, else by the second one.
        held = train.fixed if train.fixed in members else members[1]
        layout = TrainLayout(train, train.pose(glb.turned(train.carrier.name, time), glb.turned(held, time)))
        assert train.fixed is None or glb.turned(train.fixed, time) == 0
        for standing in layout.standing:
            seen = places[standing.name]
            angle = math.radians(standing.rotation)
            assert seen[:3, 3] == pytest.approx(standing.offset, abs=2e-4), standing.name
            assert (seen[0, 0], seen[1, 0]) == pytest.approx((math.cos(angle), math.sin(angle)), abs=5e-6), standing.name
    assert abs(glb.turned(train.input, glb.duration)) > 359


@pytest.mark.parametrize("name", TURNING)
def test_a_scene_turns_with_the_senses_of_its_speeds(name: str) -> None:
    train = TURNING[name]
    for sense in (700.0, -700.0):
        given = {train.input: sense} | ({} if train.fixed else {"carrier": sense / 7})
        turns = turning_of(TrainLayout(train, train.pose()), given).turns
        meant = speeds(train, given).members
        assert [np.sign(turns[member]) for member in train.members] == [np.sign(meant[member]) for member in train.members]


@pytest.mark.parametrize(("name", "times"), [("carrier held", 1), ("stepped, with a stage", 5), ("the thesis's", 1)])
def test_a_scene_ends_when_all_teeth_have_come_round(name: str, times: int) -> None:
    """Rims of 20 and 18, or so, are whole only where both are. The thesis's train would need 11 turns, its pinion then 98."""
    layout = TrainLayout(TURNING[name], TURNING[name].pose())
    turns = turning_of(layout).turns
    assert abs(turns["carrier"] or turns["a"]) == times
    for shorter in range(1, times + 1):
        passed = [
            turns[each.axle.name] * shorter / times * each.body.gear.tooth_count
            for each in (*layout.centrals, *layout.planets[0], *layout.stages)
        ]
        whole = np.allclose(passed, np.round(passed), atol=1e-6)
        assert whole == (shorter == times) or name == "the thesis's"


def test_another_reader_plays_the_animation_alike(tmp_path: Path) -> None:
    """VTK's, which knows nothing of ours: as many bodies, at the same places."""
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - registers the renderer
    from vtkmodules.vtkIOImport import vtkGLTFImporter
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    path = _write(small_train(), Format.GLB, tmp_path, turning=True, carrier=True)
    glb, reader, window = Glb(path), vtkGLTFImporter(), vtkRenderWindow()
    bodies = [node["name"] for node in glb.tree["nodes"] if "mesh" in node]
    root = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1]])  # metres, y up
    window.SetOffScreenRendering(1)
    reader.SetFileName(str(path))
    reader.SetRenderWindow(window)
    reader.Update()
    assert reader.GetNumberOfAnimations() == 1
    reader.EnableAnimation(0)
    for time in (0.0, 1.37, 6.2):
        reader.UpdateAtTimeValue(time)
        places = glb.places(time)
        ours = np.array([root @ places[name] for name in bodies])
        actors = window.GetRenderers().GetFirstRenderer().GetActors()
        actors.InitTraversal()
        theirs = []
        while (actor := actors.GetNextActor()) is not None:
            matrix = actor.GetUserMatrix()
            theirs.append([[matrix.GetElement(row, column) for column in range(4)] for row in range(4)])
        assert len(theirs) == len(ours) == 11
        apart = np.abs(ours[:, None] - np.array(theirs)).max(axis=(2, 3))
        assert apart.min(axis=0).max() < 1e-7 and apart.min(axis=1).max() < 1e-7  # m


@pytest.mark.parametrize("turns", [1.0, -8.9444, 60.0])
def test_keyframes_are_so_dense_that_nothing_takes_the_short_way(turns: float) -> None:
    """Interpolated on the sphere or along the chord, as some viewers do, a wheel is never 0.01 degrees off."""
    from gearcad.solids.files.scenes import Turning, quaternions

    shares = Turning(duration=10.0, turns={"wheel": turns}).keyframes()
    keys = quaternions(2 * math.pi * turns * shares)
    for between in (0.2, 0.5, 0.8):
        chord = (1 - between) * keys[:-1] + between * keys[1:]
        seen = 2 * np.arctan2(chord[:, 2], chord[:, 3])
        meant = 2 * math.pi * turns * ((1 - between) * shares[:-1] + between * shares[1:])
        off = np.degrees(np.abs(np.angle(np.exp(1j * (seen - meant)))))
        assert off.max() < 0.01


def test_planets_are_carried_and_share_their_mesh(tmp_path: Path) -> None:
    glb = Glb(_write(small_train(), Format.GLB, tmp_path))
    nodes = {node["name"]: node for node in glb.tree["nodes"]}

    def beneath(name: str) -> list[str]:
        return [glb.tree["nodes"][child]["name"] for child in nodes[name].get("children", ())]

    assert beneath("carrier") == ["planet_1", "planet_2", "planet_3", "pre-wheel"]
    assert beneath("planet_2") == ["planet_2 rim_a", "planet_2 rim_b"]
    assert len(glb.tree["meshes"]) == len(glb.tree["materials"]) == 6
    assert len({nodes[f"planet_{n} rim_a"]["mesh"] for n in (1, 2, 3)}) == 1
    assert "animations" not in glb.tree
    scene = trimesh.load_scene(tmp_path / "assembly.glb")
    assert len(scene.graph.nodes_geometry) == 10


# ---------------------------------------------------------------------- 3MF, DXF, PNG


def test_3mf_holds_each_mesh_once_and_every_part_by_name(tmp_path: Path) -> None:
    train = small_train()
    path = _write(train, Format.THREE_MF, tmp_path, carrier=True)
    with ZipFile(path) as archive:
        model = archive.read("3D/3dmodel.model").decode()
    assert (model.count("<mesh>"), model.count("<component "), model.count("<item ")) == (7, 6, 11)
    assert re.findall(r'name="(planet_\d rim_\w)"', model) == [f"planet_{n} rim_{r}" for n in (1, 2, 3) for r in "ab"]
    numbers = re.findall(r'<object id="(\d+)"', model)
    assert len(set(numbers)) == len(numbers) == 13
    parts = trimesh.load_scene(path).dump()
    solids = TrainProduct(train, replace(COARSE, carrier=True)).scene()
    volumes = [part.facets.volume for part in solids]
    assert sorted(part.volume for part in parts) == pytest.approx(sorted(volumes), rel=1e-5)
    assert all(part.is_watertight for part in parts)


def test_verify_reads_a_gear_in_several_places_from_3mf_as_from_glb(tmp_path: Path) -> None:
    """Our reader follows the components of 3MF; that of GLB is trimesh's."""
    found = {}
    for kind in (Format.THREE_MF, Format.GLB):
        parts = read_facets(_write(small_train(), kind, tmp_path, carrier=True))
        places = [(part.name, *part.place[:3].ravel().round(4) + 0.0, len(part.mesh.faces)) for part in parts]
        found[kind] = sorted(places)
    assert len(found[Format.GLB]) > 9
    for ours, theirs in zip(found[Format.THREE_MF], found[Format.GLB], strict=True):
        assert (ours[0], ours[-1]) == (theirs[0], theirs[-1])
        assert ours[1:-1] == pytest.approx(theirs[1:-1], abs=2e-4)


def test_a_carriers_facets_are_its_solid() -> None:
    train = simple_set(24, 21, -66, 3)
    from gearcad.solids import train_assembly

    exact = train_assembly(train, carrier=True).objects["carrier"].obj.Volume()
    for chord_error in (0.02, 0.005):
        part = TrainProduct(train, FileOptions(carrier=True, chord_error=chord_error)).scene()[-1]
        assert part.name == "carrier"
        assert part.facets.volume == pytest.approx(exact, rel=chord_error / 5)


@pytest.mark.parametrize("train", [small_train(), simple_set(18, 15, -48, 3, 15.0)], ids=["spur", "helical"])
def test_sections_in_the_dxf_are_closed_and_in_mesh(train: PlanetaryTrain, tmp_path: Path) -> None:
    """Contours of rims keep out of those of suns, and inside those of rings, whose contours are openings."""
    document = ezdxf.readfile(_write(train, Format.DXF, tmp_path))
    assert not document.audit().errors
    space, outlines = document.modelspace(), {}
    for line in space.query("LWPOLYLINE"):
        assert line.closed
        points = np.array([(point.x, point.y) for point in ezdxf.path.make_path(line).flattening(0.002)])
        outlines.setdefault(line.dxf.layer, []).append(points)
    counts = {layer: len(each) for layer, each in outlines.items()}
    assert counts == {rim.name: train.planets for rim in train.rims} | dict.fromkeys(counts.keys() - {"rim_a", "rim_b"}, 1)
    for mesh in train.meshes:
        (central,), rims = outlines[mesh.central.name], outlines[mesh.rim.name]
        for rim in rims:
            assert set(Outline(central).contains_points(rim)) == {mesh.central.gear.internal}
            assert not Outline(rim).contains_points(central).any()
    if train.stages:
        (pinion,), (wheel,) = outlines["pre-pinion"], outlines["pre-wheel"]
        assert not Outline(pinion).contains_points(wheel).any() and not Outline(wheel).contains_points(pinion).any()
    rim = train.centrals[1].gear.body.rim_diameter
    assert (document.header["$EXTMIN"][0], document.header["$EXTMAX"][1]) == pytest.approx((-rim / 2, rim / 2))


def test_a_picture_shows_every_part_in_its_colour_from_three_sides_and_apart(tmp_path: Path, capfd: object) -> None:
    train = small_train()
    path = _write(train, Format.PNG, tmp_path, carrier=True)
    pixels = np.array(Image.open(path).convert("RGB")).astype(int)
    height, width, _ = pixels.shape
    hue = np.round(_hues(pixels[height // 2 :, width // 2 :].reshape(-1, 3)), 2)
    for part in TrainProduct(train, replace(COARSE, carrier=True)).scene():
        if np.ptp(part.colour) > 0.05:  # grey has no hue
            own = _hues(np.array([part.colour]) * 255)[0]
            assert (np.abs(hue - own) < 0.02).sum() > 300, part.name
    for view in (pixels[: height // 2, : width // 2], pixels[: height // 2, width // 2 :], pixels[height // 2 :, : width // 2]):
        painted = (view < 250).any(axis=2)
        assert 0.1 < painted.mean() < 0.9
        assert painted.any(axis=0).sum() > 0.85 * width / 2 or painted.any(axis=1).sum() > 0.85 * height / 2
    assert capfd.readouterr().err == ""  # type: ignore[attr-defined]
    # Of a train that is apart, the last view shows it in mesh.
    apart = np.array(Image.open(_write(train, Format.PNG, tmp_path, carrier=True, exploded=True)).convert("RGB")).astype(int)
    views = {
        key: [image[height // 2 :, : width // 2], image[height // 2 :, width // 2 :]]
        for key, image in (("mesh", pixels), ("apart", apart))
    }
    for one, other in ((0, 1), (1, 0)):
        assert np.abs(views["apart"][one] - views["mesh"][other]).mean() < 0.5
    assert np.abs(views["apart"][0] - views["apart"][1]).mean() > 5


@pytest.mark.parametrize("train", [small_train(), simple_set(24, 21, -66, 3)], ids=["stepped", "plain"])
def test_a_carrier_is_a_part_of_its_own(train: PlanetaryTrain) -> None:
    assert TrainProduct(train, COARSE).carrier is None
    made = TrainProduct(train, replace(COARSE, carrier=True))
    assert made.carrier is not None and made.carrier.name == f"{train.name} carrier"
    placed = made.scene()[-1]
    (alone,) = made.carrier.scene()
    assert alone.facets is placed.facets and alone.offset == (0.0, 0.0, 0.0)
    solid = cad_solid(made.carrier.solid().boundary)
    assert solid.Volume() == pytest.approx(alone.facets.volume, rel=0.02)
    assert solid.BoundingBox().zmin == pytest.approx(alone.facets.vertices[:, 2].min(), abs=1e-6)


# ---------------------------------------------------------------------- bytes

_AGAIN = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from planetary.test_train_files import write_some
write_some(Path(sys.argv[2]))
"""


def write_some(folder: Path) -> None:
    """What the kernel and sets of Python might order by chance."""
    for kind in (Format.STEP, Format.GLB, Format.DXF):
        _write(small_train(), kind, folder, carrier=True, turning=True)


@pytest.mark.long
def test_equal_input_gives_equal_bytes_in_every_process(tmp_path: Path) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    for folder in (here, there):
        folder.mkdir()
    write_some(here)
    command = [sys.executable, "-c", _AGAIN, str(Path(__file__).parents[1]), str(there)]
    subprocess.run(command, check=True, env={**os.environ, "PYTHONHASHSEED": "7"})
    assert [file.name for file in here.iterdir() if file.read_bytes() != (there / file.name).read_bytes()] == []


def _hues(colours: np.ndarray) -> np.ndarray:
    """0 ... 1, NaN for greys."""
    red, green, blue = colours.T
    spread = np.ptp(colours, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        hue = np.where(
            colours.argmax(axis=1) == 0,
            (green - blue) / spread,
            np.where(colours.argmax(axis=1) == 1, 2 + (blue - red) / spread, 4 + (red - green) / spread),
        )
    return np.where(spread > 8, hue / 6 % 1, np.nan)
