"""`gearcad stiffness` as a user meets it."""

import csv
import json
from pathlib import Path

import pytest
from support.commands import invoke, read_json, run, spec_file

pytestmark = pytest.mark.usefixtures("no_pictures")

PAIR = """
[pair]
normal_module = 2.0
face_width = 20.0
[pinion]
teeth = 20
body.bore = 12.0
[wheel]
teeth = 30
body.bore = 20.0
[load]
torque = 50.0
"""

QUICK = ("--method", "potential-energy", "--method", "weber-banaschek", "--method", "iso6336")


def test_table_and_files(here: Path) -> None:
    result = run("stiffness", spec_file(PAIR), *QUICK, "--fourier", "4")
    lines = result.stdout.splitlines()
    assert lines[-3:] == [f"output/pair/stiffness.{kind}" for kind in ("csv", "html", "json")]
    document = read_json(here / "output/pair/stiffness.json")
    assert (document["kind"], document["name"], document["common_width"]) == ("stiffness", "pair", 20.0)
    assert list(document["methods"]) == ["potential-energy", "weber-banaschek", "iso6336"]
    energy = document["methods"]["potential-energy"]
    row = next(line for line in lines if line.startswith("Potential energy "))
    assert row.split()[2:4] == [f"{energy['mean']:.5g}", f"{energy['maximum']:.5g}"]
    assert len(energy["fourier"]["cosine"]) == 4
    assert energy["fourier"]["mean"] == pytest.approx(energy["mean"])
    assert "fourier" not in document["methods"]["iso6336"] and "maximum" not in document["methods"]["iso6336"]
    assert {point["method"] for point in document["load_dependence"]} == set(document["methods"])
    with (here / "output/pair/stiffness.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["method"] == "potential-energy"]
    assert [float(row["mesh_stiffness"]) for row in rows] == energy["mesh_cycle"]["mesh_stiffness"]
    parts = [sum(float(row[key]) for key in row if key.startswith("compliance.") and row[key]) for row in rows]
    assert [1 / part for part in parts] == pytest.approx([float(row["mesh_stiffness"]) for row in rows], rel=1e-6)


def test_json_is_one_document(here: Path) -> None:
    result = invoke("stiffness", spec_file(PAIR), *QUICK, "--json", "--quiet", "--positions", "40")
    assert result.exit_code == 0 and result.stderr == ""
    document = json.loads(result.stdout)
    assert len(document["methods"]["weber-banaschek"]["mesh_cycle"]["roll_angle"]) < 60


def test_a_method_that_cannot_treat_the_pair_is_left_out_with_its_reason(here: Path) -> None:
    helical = spec_file(PAIR.replace("[pinion]", "helix_angle = 20.0\n[pinion]"))
    result = run("stiffness", helical, *QUICK, "--method", "plane-strain")
    assert "FE contact, plane strain: left out: pair.helix_angle = 20 deg: must be 0 for plane-strain" in result.stdout
    alone = run("stiffness", helical, "--method", "plane-strain", "-o", "other", status=2)
    assert alone.stderr.splitlines()[-1].startswith("Error: pair.helix_angle = 20 deg: must be 0 for plane-strain")
    assert not Path("other").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--method", "tian"], "method = 'tian': must be one of all, potential-energy, weber-banaschek, iso6336,"),
        (["--positions", "3"], "positions = 3: must be a whole number from 12 to 5000"),
        ([*QUICK, "--fourier", "80"], "fourier = 80: must be a whole number from 0 to 50"),
        (["--fourier", "20"], "fourier = 20: must be a whole number from 0 to 15"),
    ],
)
def test_wrong_options(here: Path, arguments: list[str], message: str) -> None:
    result = run("stiffness", spec_file(PAIR), *arguments, status=2)
    assert message in result.stderr and "Traceback" not in result.stderr
    assert not Path("output").exists()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (PAIR.replace("[load]\ntorque = 50.0\n", ""), "load.torque is missing: must be given"),
        (PAIR.replace("torque = 50.0", "torque = 0.0"), "load.torque = 0 N·m: must not be 0"),
        ("[gear]\nteeth = 20\nnormal_module = 2.0\nface_width = 10.0\n", "must be a pair"),
        (PAIR.replace("teeth = 30", "teeth = -60"), "wheel.body.bore = 20 mm: must be left out: it is for external gears"),
    ],
)
def test_specs_without_a_mesh(here: Path, text: str, message: str) -> None:
    result = run("stiffness", spec_file(text), *QUICK, status=2)
    assert message in result.stderr and result.stdout == ""


def test_closed_forms_warn_of_a_thin_rim(here: Path) -> None:
    """A rim of 2 mm below teeth of 4.5 mm, h_f = 17.5/15.5 = 1.129: none of the three knows such a body."""
    result = run("stiffness", spec_file(PAIR.replace("body.bore = 12.0", "body.bore = 31.0")), *QUICK)
    warned = [line for line in result.stdout.splitlines() if "pinion" in line and "theta_f" not in line]
    thin = "0.444 tooth heights"
    assert warned == [
        "Warning: Potential energy: pinion: h_f = 1.129 is outside the 1.4 ... 7 of Sainsot's foundation",
        f"Warning: Weber-Banaschek: pinion: only {thin} of body lie under the root, where the method has a half-plane",
        f"Warning: ISO 6336-1, Method B: c': C_R is 1 of a solid disc, but the pinion has only {thin} under the root",
    ]
    text = (here / "output/pair/stiffness.html").read_text(encoding="utf-8")
    assert "1.129" in text and text.count(thin) == 2


def test_double_helical_pairs_are_refused_before_any_method_begins(tmp_path: Path) -> None:
    double = {"pair.face_width": "40.0", "pair.helix_angle": "25.0", "pair.double_helix.gap_width": "8.0"}
    text = "".join(f"{key} = {value}\n" for key, value in double.items())
    spec = tmp_path / "double.toml"
    spec.write_text(f"pair.normal_module = 2.0\npinion.teeth = 24\nwheel.teeth = 40\nload.torque = 60.0\n{text}")
    result = run("stiffness", str(spec), "-o", str(tmp_path / "files"), status=2)
    assert result.output.splitlines() == [
        "Error: double_helix.gap_width = 8 mm: must be left out for a mesh stiffness: take one half, of face width 16 mm,"
        " and half the torque"
    ]
