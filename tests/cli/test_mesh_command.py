"""`gearcad mesh` as a user meets it."""

import csv
import json
import subprocess
import sys
from pathlib import Path

import meshio
import pytest
from support.commands import read_json, run

from gearcad.meshing import Element

GEAR = """
[gear]
teeth = 20
normal_module = 2.0
face_width = 8.0
body.bore = 12.0
"""

PAIR = """
[pair]
normal_module = 2.0
face_width = 8.0
[pinion]
teeth = 17
body.bore = 12.0
[wheel]
teeth = 23
body.bore = 20.0
body.keyway_width = 6.0
body.keyway_depth = 2.8
[load]
torque = 50.0
"""

HELICAL = PAIR.replace("[pinion]", "helix_angle = 20.0\n[pinion]")


def spec(text: str) -> str:
    Path("some.toml").write_text(text, encoding="utf-8")
    return "some.toml"


def document() -> dict:
    return read_json("output/some/mesh.json")


def test_a_gear_is_meshed_as_its_ring(here: Path) -> None:
    result = run("mesh", spec(GEAR))
    lines = result.stdout.splitlines()
    assert lines[-4:] == ["some: mesh passed", *(f"output/some/{name}" for name in ("gear.vtu", "gear.msh", "mesh.json"))]
    told, found = document(), meshio.read(here / "output/some/gear.vtu")
    mesh = told["meshes"]["gear"]
    assert (told["kind"], told["what"], told["model"], told["element"], told["passed"]) == ("mesh", "ring", "2d", "quad8", True)
    assert (len(found.points), len(found.cells[0].data)) == (mesh["nodes"], mesh["elements"])
    assert lines[0].replace("\u202f", "") == f"gear: ring of 20 teeth, {mesh['elements']} quad8, {mesh['nodes']} nodes"
    assert {"left_flank_19", "right_fillet_0", "tip_3", "bore"} <= set(mesh["sides"])
    assert [gate["passed"] for gate in mesh["gates"]] == [True] * len(mesh["gates"])
    assert told["files"] == ["gear.vtu", "gear.msh", "mesh.json"]


def test_a_pair_stands_in_mesh_and_is_fine_where_its_load_presses(here: Path) -> None:
    run("mesh", spec(PAIR), "--format", "vtu", "--quiet")
    loaded = document()
    assert (loaded["what"], loaded["roll_angle"], loaded["files"]) == ("pair", 0.0, ["pair.vtu", "mesh.json"])
    run("mesh", spec(PAIR.replace("torque = 50.0", "torque = 0.0")), "--format", "vtu", "--quiet")
    idle = document()
    for gear in ("pinion", "wheel"):
        faces = {side: idle["meshes"][gear]["sides"][side]["faces"] for side in ("left_flank_0", "left_flank_3")}
        touching = loaded["meshes"][gear]["sides"]["left_flank_0"]["faces"]
        assert touching > faces["left_flank_0"] + 5
        assert loaded["meshes"][gear]["sides"]["left_flank_3"]["faces"] <= faces["left_flank_3"]


def test_options_win_over_those_of_the_spec(here: Path) -> None:
    text = GEAR + '[mesh]\nwhat = "teeth:3"\nelement = "tri6"\nsize = 0.5\nformat = "inp"\n'
    run("mesh", spec(text))
    first = document()
    assert (first["what"], first["element"], first["meshes"]["gear"]["teeth"]) == ("teeth", "tri6", 3)
    assert first["meshes"]["gear"]["matched"] == {"cut": first["meshes"]["gear"]["matched"]["cut"]}
    assert first["files"] == ["gear.inp", "mesh.json"]
    run("mesh", spec(text), "--what", "sector", "--element", "quad8", "--size", "0.25")
    second = document()
    assert (second["what"], second["element"], second["meshes"]["gear"]["teeth"]) == ("sector", "quad8", 1)


def test_helical_gears_are_bodies(here: Path) -> None:
    result = run("mesh", spec(HELICAL), "--element", "hex8", "--size", "1.2", "--format", "vtu", "--json")
    told = json.loads(result.stdout)
    assert (told["what"], told["model"], told["element"], told["meshes"]["wheel"]["teeth"]) == ("pair", "3d", "hex8", 5)
    assert told["warnings"][0] == "wheel: hexahedra are swept along the helix, without keyway; tet10 has them"


def test_a_mesh_that_falls_short_is_written_and_told(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.meshing.result.LEAST_SCALED_JACOBIAN", {Element.QUAD8: 0.99})
    result = run("mesh", spec(GEAR), "--what", "sector", "--format", "vtu", status=1)
    assert "FAILED: gear: least scaled Jacobian: 0." in result.stdout and "some: mesh failed" in result.stdout
    assert (document()["passed"], document()["meshes"]["gear"]["passed"]) == (False, False)
    assert Path("output/some/gear.vtu").is_file()


def test_as_many_elements_as_are_asked_for_are_told_before_and_made(here: Path) -> None:
    result = run("mesh", spec(PAIR), "--elements", "9000", "--format", "vtu")
    told = document()["summary"]
    assert told["elements"] == pytest.approx(9000, rel=0.1)
    assert result.stderr.replace("\u202f", "").startswith(f"makes {told['elements']} tri6, ")


def test_decks_over_a_base_pitch_say_what_our_own_check_finds(here: Path) -> None:
    result = run("mesh", spec(PAIR), "--deck", "pair", "--positions", "2", "--format", "vtu", "--size", "1", "--quiet")
    decks = document()["decks"]
    assert document()["files"] == ["pair.vtu", "pair_deck_1.inp", "pair_deck_2.inp", "mesh.json"]
    first, second = (decks[f"pair_deck_{number}.inp"] for number in (1, 2))
    assert second["roll_angle"] - first["roll_angle"] == pytest.approx(360 / 17 / 2)
    assert first["torque"] == 50.0 and first["transmission_error"] > 1
    assert f"{first['transmission_error']:.4g} µm" in result.stdout and "ccx pair_deck_2 runs it" in result.stdout
    text = Path("output/some/pair_deck_1.inp").read_text(encoding="ascii")
    assert "*CONTACT PAIR" in text and text.endswith("*END STEP\n")


def test_each_gear_under_its_contacts_is_a_deck(here: Path) -> None:
    run("mesh", spec(PAIR), "--deck", "tooth", "--format", "vtu", "--size", "1", "--quiet")
    told = document()
    assert told["files"] == ["pair.vtu", "pinion_deck.inp", "wheel_deck.inp", "mesh.json"]
    for gear in ("pinion", "wheel"):
        assert told["decks"][f"{gear}_deck.inp"]["root_stress"] > 50
        assert "*DLOAD" in Path(f"output/some/{gear}_deck.inp").read_text(encoding="ascii")


def test_straight_edges_are_said_to_be_off(here: Path) -> None:
    run("mesh", spec(GEAR), "--what", "sector", "--element", "hex8", "--size", "1", "--format", "vtu", "--quiet")
    told = document()
    assert told["passed"] and told["meshes"]["gear"]["deviations"]["between_nodes"] > 2
    assert [notice["code"] for notice in told["notices"]] == ["coarse"]


def test_solid_gears_are_decks_of_few_teeth(here: Path) -> None:
    text = PAIR + "[check]\nrefinement = 0.5\n"
    run("mesh", spec(text), "--deck", "tooth", "--model", "3d", "--what", "pair:3", "--format", "vtu", "--size", "2", "--quiet")
    pinion = document()["decks"]["pinion_deck.inp"]
    assert pinion["body"].startswith("7 teeth with fixed cuts")
    deck = Path("output/some/pinion_deck.inp").read_text(encoding="ascii")
    assert "*CLOAD" in deck and "TYPE=C3D20, ELSET=pinion" in deck


@pytest.mark.parametrize(
    ("text", "arguments", "message"),
    [
        (
            GEAR,
            ["--what", "gear"],
            'what = \'gear\': must be "sector", "teeth:5" (any odd number), "ring", "pair",',
        ),
        (GEAR, ["--what", "teeth:4"], "what = 'teeth:4': must be of an odd number of teeth: tooth 0 stands in the middle"),
        (GEAR, ["--what", "teeth:21"], "what = 'teeth:21': must be of fewer than 20 teeth, which the gear has; or ring"),
        (GEAR, ["--what", "pair"], "what = 'pair': needs a pair: this design is a single gear"),
        (GEAR, ["--gear", "pinion"], "gear = 'pinion': must not be given for a single gear"),
        (GEAR, ["--roll", "3"], "roll = 3 deg: must be 0 for ring: only a pair stands in mesh"),
        (GEAR, ["--model", "4d"], 'model = \'4d\': must be "2d", "3d" or "auto"'),
        (GEAR, ["--model", "3d", "--element", "quad8"], "element = 'quad8': must be one of hex8, hex20, tet10 for model 3d"),
        (GEAR, ["--what", "part", "--model", "2d"], "model = '2d': must be 3d for part"),
        (GEAR, ["--what", "part", "--element", "hex20"], "element = 'hex20': must be tet10 for part"),
        (GEAR, ["--what", "ring", "--element", "tet10"], "what = 'ring': must be part, or pair, for tet10"),
        (GEAR, ["--element", "hex27"], "element = 'hex27': must be"),
        (GEAR, ["--size", "0"], "size = 0 mm: must be a number at least"),
        (GEAR, ["--size", "1", "--elements", "50"], "elements = 50: must not be given beside size: one follows from the other"),
        (GEAR, ["--elements", "20"], "elements = 20: cannot be met within 10 % by this layout"),
        (GEAR, ["--refined-teeth", "0"], "refined_teeth = '0': must be left out for quad8: it is of tetrahedra"),
        (
            GEAR,
            ["--what", "part", "--refined-teeth", "x"],
            "refined_teeth = 'x': must be whole numbers with commas between them",
        ),
        (GEAR, ["--deck", "pair"], "deck = 'pair': needs a pair: this design is a single gear"),
        (GEAR, ["--positions", "3"], "positions = 3: must be 1 where no deck is wanted"),
        (PAIR, ["--deck", "teeth"], "deck = 'teeth': must be one of 'pair', 'tooth'"),
        (GEAR, ["--format", "stl"], "format = 'stl': must be one of 'msh', 'vtu', 'inp'"),
        (GEAR, ["--format", ""], "format = '': must be a text"),
        (PAIR, ["--what", "pair", "--gear", "wheel"], "gear = 'wheel': must be both for a pair in mesh"),
        (PAIR + "[mesh]\nwhat = 5\n", [], "some.toml line 16: mesh.what = 5: must be"),
        (PAIR + "[mesh]\nelemnt = 5\n", [], "mesh.elemnt: unknown key; did you mean element?"),
    ],
)
def test_what_is_wrong_is_one_line(here: Path, text: str, arguments: list[str], message: str) -> None:
    result = run("mesh", spec(text), *arguments, status=2)
    assert message in result.stderr
    assert result.stderr.count("\n") == 1 and result.stdout == ""
    assert not Path("output").exists()


def test_a_train_has_no_teeth(here: Path) -> None:
    run("new", "train-1-stage")
    assert "a train is for `gearcad dynamics`" in run("mesh", "train-1-stage.toml", status=2).stderr


def test_rows_of_a_table_are_meshed(here: Path) -> None:
    Path("table.csv").write_text(
        "name,gear.teeth,gear.normal_module,gear.face_width,gear.body.bore,mesh.what,mesh.format\n"
        'a,20,2,8,12,sector,vtu\nb,20,2,8,12,teeth:3,"inp,vtu"\n',
        encoding="utf-8",
    )
    run("batch", "table.csv", "--do", "mesh", "-j", "1")
    with Path("output/table/results.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert sorted(path.name for path in Path("output/table/b").iterdir()) == [
        *("data.json", "gear.inp", "gear.vtu", "manifest.json", "mesh.json"),
    ]
    told = read_json("output/table/b/mesh.json")
    assert (rows[1]["mesh.elements"], rows[1]["mesh.passed"]) == (str(told["summary"]["elements"]), "true")
    assert int(rows[1]["mesh.elements"]) == 3 * int(rows[0]["mesh.elements"])


LIMITED = """
import resource, sys
from gearcad.__main__ import run
resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
run()
"""


@pytest.mark.parametrize("kind", ["med", "unv", "vtu", "inp"])
def test_files_larger_than_the_system_permits_leave_nothing(tmp_path: Path, kind: str) -> None:
    """gmsh and VTK crash then, or write a part of the file and say nothing; the lines of HDF5 are its own."""
    (tmp_path / "it.toml").write_text(GEAR)
    # Without -B Python would leave parts of its own files.
    options = f"--what sector --element tri6 --format {kind} --quiet".split()
    command = [sys.executable, "-B", "-c", LIMITED, "mesh", "it.toml", *options]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    said = [line for line in done.stderr.splitlines() if line.startswith("Error: ")]
    assert done.returncode in (1, 2) and said and "Traceback" not in done.stderr, done.stderr
    assert any(words in said[0] for words in ("could not write", "cannot be written", "killed its process")), said
    assert [path.name for path in tmp_path.iterdir()] == ["it.toml"]
