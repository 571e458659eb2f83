"""Trains of real pairs as a user writes them: in a file beside, in tables of their own, and what is wrong with them."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from support.commands import read_json, run

from gearcad.core.errors import SolverError
from gearcad.core.records import PerGear
from gearcad.designs import PairDesign, TrainDesign, read_spec
from gearcad.designs.train_designs import DesignedPair
from gearcad.dynamics.engagement import engaged
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.trains.members import Inertia, ToothMesh
from gearcad.dynamics.trains.shaft_lines import system
from gearcad.dynamics.trains.steady_response import flexibility
from gearcad.dynamics.trains.train import EngagedMesh, Train

PAIR = """[pair]
name = "steep"
normal_module = 2.0
face_width = 20.0
tooth_thinning = 0.03
[pinion]
teeth = 20
[wheel]
teeth = 30
[material]
youngs_modulus = 200000.0
[mounting]
centre_distance_change = 0.05
[check]
pinion_inner_diameter = 24.0
[rating]
accuracy_grade = 8
[load]
torque = 7.0
application_factor = 1.5
"""

INLINE = """[train.mesh.pair]
normal_module = 2.5
face_width = 25.0
tooth_thinning = 0.02
[train.mesh.pair.pinion]
teeth = 20
body.bore = 12.0
[train.mesh.pair.wheel]
teeth = 40
"""


def train(first: str = 'pair = "parts/steep.toml"', second: str = INLINE, last: str = "", of_train: str = "") -> str:
    """Two stages: the first pair as the text says, the second behind a shaft."""
    inertias = "".join(f'[[train.inertia]]\nname = "{name}"\ninertia = 0.00{place + 1}\n' for place, name in enumerate("abcd"))
    return f"""[train]
name = "drive"
speed = 1000.0
{of_train}
[train.torques]
a = 60.0
d = -180.0
{inertias}
[[train.shaft]]
name = "middle"
start = "b"
end = "c"
torsional_stiffness = 3e4
[[train.mesh]]
name = "stage 1"
pinion = "a"
wheel = "b"
backlash = "off"
{first}
[[train.mesh]]
name = "stage 2"
pinion = "c"
wheel = "d"
backlash = "off"
phase = 0.25
damping_ratio = 0.1
{second}
[dynamics]
stiffness = "potential-energy"
speed_from = 900.0
speed_to = 1000.0
speeds = 2
harmonics = 4
{last}"""


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a pair in `specs/parts`, and another one to work in."""
    (tmp_path / "specs" / "parts").mkdir(parents=True)
    (tmp_path / "specs" / "parts" / "steep.toml").write_text(PAIR, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def spec(text: str) -> str:
    Path("specs/drive.toml").write_text(text, encoding="utf-8")
    return "specs/drive.toml"


def read(text: str) -> TrainDesign:
    found = read_spec(spec(text))
    assert isinstance(found, TrainDesign)
    return found


def test_pairs_of_files_and_of_tables() -> None:
    """All of a pair's own spec counts but its load; files are found beside the train's, wherever one is."""
    meshes = read(train()).train.meshes
    steep, inline = (mesh.pair for mesh in meshes)
    assert isinstance(steep, DesignedPair) and isinstance(inline, DesignedPair)
    assert steep.design == read_spec("specs/parts/steep.toml")
    assert (steep.material.youngs_modulus, steep.rating.accuracy_grade) == (200000.0, 8)
    assert steep.mounted.centre_distance == pytest.approx(50.05)
    assert (steep.body.inner_diameters.pinion, steep.load and steep.load.torque) == (24.0, 7.0)
    assert (inline.design.name, inline.pair.wheel.teeth, inline.pair.pinion.body.bore) == ("stage 2", 40, 12.0)
    assert inline.pair.wheel.face_width == 25.0
    assert [mesh.backlash for mesh in meshes] == [None, None]
    own = read(train().replace('backlash = "off"\nphase', "phase")).train.meshes[1].backlash
    assert own == pytest.approx(2 * 20.0 * math.cos(math.radians(20)), rel=1e-9)


@pytest.mark.usefixtures("no_pictures")
def test_what_comes_of_it() -> None:
    """Forces by hand, pairs and their specs, which read as pairs under these loads."""
    result = run("dynamics", spec(train()))
    names = [f"output/drive/stage {number}.toml" for number in (1, 2)]
    assert result.stdout.splitlines()[-2:] == names
    assert result.stderr.splitlines()[-1] == f"Next: gearcad check '{names[0]}'"
    assert "stage 1: the train gives its pinion 60 N·m at 1000 rpm, not 7 N·m of the pair's own load" in result.stdout
    document = read_json("output/drive/dynamics.json")
    static = document["chart"]["static_force"]
    radius = 20 * math.cos(math.radians(20))
    assert static == pytest.approx({"stage 1": 60e3 / radius, "stage 2": 90e3 / (1.25 * radius)}, rel=1e-9)
    first, second = (read_spec(name) for name in names)
    assert isinstance(first, PairDesign) and isinstance(second, PairDesign)
    assert first.load is not None and second.load is not None
    assert (first.load.torque, first.load.speed, first.load.application_factor) == (60.0, 1000.0, 1.5)
    assert second.load.torque == -90.0 and second.load.speed == pytest.approx(-1000 / 1.5)
    assert (first.name, second.name) == ("drive-stage 1", "drive-stage 2")
    assert first.mounting is not None and first.check is not None and first.rating is not None
    assert second.dynamics == DynamicsOptions(
        stiffness="potential-energy", damping_ratio=0.1, pinion_inertia=0.003, wheel_inertia=0.004
    )
    again = run("stiffness", names[0], "--method", "potential-energy", "--json", "--quiet")
    alone = json.loads(again.stdout)["methods"]["potential-energy"]
    assert alone["tangent_mean"] == pytest.approx(document["pairs"]["stage 1"]["mesh_stiffness_tangent_mean"] * 1.0, rel=0.02)
    page = Path("output/drive/dynamics.html").read_text(encoding="utf-8")
    assert "Mesh stiffness of stage 1" in page and "potential energy" in page.lower()


def test_other_commands_are_told_where_the_pairs_are() -> None:
    result = run("modify", spec(train()), status=2)
    assert result.stderr.startswith("Error: kind = 'train': must be a ")
    assert "pair" in result.stderr.partition(": `gearcad dynamics` writes the specs")[0]


RACK = "[pair]\nnormal_module = 2.0\n[pinion]\nteeth = 20\nface_width = 10.0\n[rack]\nlength = 100.0\nface_width = 10.0\n"
DOUBLE = PAIR.replace("[pinion]", "helix_angle = 20.0\ndouble_helix.gap_width = 3.0\n[pinion]")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (train('pair = "none.toml"'), "specs/drive.toml line 31: stage 1.pair: specs/none.toml: cannot be read"),
        (train('pair = ""'), "line 31: stage 1.pair = '': must be the file of a pair's spec"),
        (train('pair = "\\u0000"'), "line 31: stage 1.pair = '\\x00': must be the file of a pair's spec"),
        (
            train('pair = "drive.toml"'),
            "stage 1.pair: specs/drive.toml line 1: is the spec of a train; a mesh needs the spec of a pair",
        ),
        (train("pair = 5"), "line 31: stage 1.pair = 5: must be the file of a pair's spec"),
        (train('pair = ["parts/steep.toml"]'), "stage 1.pair = ['parts/steep.toml']: must be the file"),
        (train("pair = {}"), "line 31: stage 1: [train.mesh.pair.pinion] is missing"),
        (train('pair = "parts/rack.toml"'), "stage 1.pair: specs/parts/rack.toml line 6: is the spec of a rack and pinion"),
        (train('pair = "parts/spur.toml"'), "specs/parts/spur.toml line 1: is the spec of a gear; a mesh needs"),
        (train('pair = "parts/broken.toml"'), "specs/parts/broken.toml line 2: pair.teeht"),
        (train('pair = "parts/double.toml"'), "stage 1.pair: specs/parts/double.toml"),
        (train('pair = "parts/steep.toml"\nstiffness = 700.0'), "line 32: stage 1.stiffness = 700: not beside pair"),
        (train('pair = "parts/steep.toml"\ninternal = false'), "line 32: stage 1.internal = False: not beside pair"),
        (train(""), "line 26: base_radii is missing in [[train.mesh]]"),
        (train(second=INLINE.replace("teeth = 40", "teeth = 0")), "line 47: stage 2: wheel.teeth = 0"),
        (train(second=INLINE.replace("2.5", "-2.5")), "line 40: stage 2: pair.normal_module = -2.5 mm"),
        (
            train(second=INLINE.replace("face_width = 25.0", "face_with = 25.0")),
            "line 41: stage 2: pair.face_with: unknown key",
        ),
        (train(second=INLINE.replace("[train.mesh.pair.wheel]\nteeth = 40", "")), "[train.mesh.pair.wheel] is missing"),
        (train().replace("a = 60.0\nd = -180.0", ""), "stage 1.pair = 'steep': carries nothing at rest"),
        (train().replace("potential-energy", "iso-6336-b"), "dynamics.stiffness = 'iso-6336-b': must be one of"),
        (train(last="pinion_inertia = 1.0"), "dynamics.pinion_inertia: unknown key"),
        (train('pair = "parts/steep.toml"\npreload = 1e12'), "line 32: stage 1.preload = 1e+12 N: must be at most 5.32e+10 N"),
        (train(last='error_distribution = "normal"'), "dynamics.error_distribution = 'normal': must be left at uniform unless"),
        (train().replace("a = 60.0", "a = 6e9").replace("-180.0", "-1.8e10"), "torques.a = 6000000000 N·m"),
    ],
)
def test_wrong_input_gets_one_line(text: str, message: str) -> None:
    parts = Path("specs/parts")
    (parts / "rack.toml").write_text(RACK, encoding="utf-8")
    (parts / "spur.toml").write_text("[gear]\nteeth = 20\nnormal_module = 1.0\nface_width = 5.0\n", encoding="utf-8")
    (parts / "broken.toml").write_text("[pair]\nteeht = 2\n[pinion]\nteeth = 20\n[wheel]\nteeth = 20\n", encoding="utf-8")
    (parts / "double.toml").write_text(DOUBLE, encoding="utf-8")
    result = run("dynamics", spec(text), "--quiet", status=2)
    assert result.stderr.startswith("Error: ") and message in result.stderr and len(result.stderr.splitlines()) == 1
    assert not Path("output").exists()


def test_the_least_torque_there_is() -> None:
    """Rounding puts it below what a pair can have."""
    train_of = read(train().replace("a = 60.0", "a = 1e-9").replace("-180.0", "-3e-9")).train
    meshes = engaged(train_of, DynamicsOptions(stiffness="potential-energy")).meshes
    assert [round(mesh.course.torque, 15) for mesh in meshes if isinstance(mesh, EngagedMesh)] == [1e-9, -1.5e-9]


def test_a_mesh_without_damping_is_named() -> None:
    """At its resonance: sqrt(k (r²/J + R²/I)) = 12000/s."""
    train_of = Train(
        inertias=(Inertia(name="a", inertia=0.01), Inertia(name="b", inertia=0.02)),
        meshes=(ToothMesh(name="m", pinion="a", wheel="b", base_radii=PerGear(40.0, 80.0), stiffness=300.0, teeth=20),),
        torques={"a": 10.0, "b": 20.0},
    )
    with pytest.raises(SolverError, match=r"^m\.damping = 0 N·s/m: must be above 0"):
        flexibility(system(train_of), np.array([12000.0]))
