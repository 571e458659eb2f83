"""`gearcad identify`: table, document, spec, wrong input."""

import json
from pathlib import Path

import pytest
from click.testing import Result
from support.commands import invoke

from gearcad.core.quantities import schema_of
from gearcad.designs import GearDesign, read_spec
from gearcad.designs.reader import starter_text
from gearcad.designs.spec_writers import read_measurements
from gearcad.identify import Measurements

READINGS = "--teeth 24 --tip-diameter 52.02 --root-diameter 43.01 --span 3:15.40 --span 4:21.30"


def run(words: str, *others: object) -> Result:
    return invoke("identify", *words.split(), *map(str, others))


def test_table_says_what_it_is_and_how_far_it_is_off() -> None:
    found = run(READINGS)
    assert found.exit_code == 0, found.output
    heading, first, *_ = found.stdout.splitlines()
    assert heading.split()[:4] == ["size", "%", "chi²", "m_n"] and first.split()[6:8] == ["2", "20"]
    assert "Certain" in found.stdout
    rows = {line.split("  ")[0]: line.split() for line in found.stdout.splitlines()}
    assert rows["tip diameter"][2:5] == ["52.020", "0.02", "+1.0"]


def test_spec_reproduces_the_measurements(tmp_path: Path) -> None:
    path = tmp_path / "wheel.toml"
    found = run(READINGS, "--write", path, "--json")
    assert found.exit_code == 0, found.output
    document = json.loads(found.stdout)
    assert document["certain"] and document["candidates"][0]["normal_module"] == 2.0
    design = read_spec(path)
    assert isinstance(design, GearDesign) and design.name == "wheel"
    inspection = design.gear.inspection
    read = [design.gear.tip_diameter, design.gear.root_diameter, *(inspection.span_measurement(count) for count in (3, 4))]
    for value, reading in zip(read, document["readings"], strict=True):
        assert abs(value - reading["value"]) < 1.5 * reading["uncertainty"]
    assert "# span over 3 teeth" in path.read_text(encoding="utf-8")
    again = run(READINGS, "--write", path)
    assert again.exit_code == 2 and "exists; give another name" in again.stderr


def test_another_candidate_a_pitch_and_a_ring_are_written_too(tmp_path: Path) -> None:
    path = tmp_path / "ring.toml"
    words = "--teeth -48 --tip-diameter 97.53 --root-diameter 107.69 --between-pins 3.5:96.55+-0.1 --helix-angle 0"
    found = run(words, "--count", 9, "--write", path, "--json")
    assert found.exit_code == 0, found.output
    first = json.loads(found.stdout)["candidates"][0]
    design = read_spec(path)
    assert isinstance(design, GearDesign) and design.gear.internal
    assert design.gear.normal_diametral_pitch == first["normal_diametral_pitch"] == 12.0
    second = run(words, "--candidate", 2, "--write", path, "--force")
    assert second.exit_code == 0 and "# Candidate 2" in path.read_text(encoding="utf-8")


def test_an_ambiguous_gear_is_told_with_what_would_decide() -> None:
    found = run("--teeth 24 --tip-diameter 52.0 --helix-angle 0")
    assert found.exit_code == 0 and "Ambiguous: 1 or 2" in found.stdout
    assert "What would decide:\n  span over " in found.stdout and "1: " in found.stdout.splitlines()[-1]


def test_what_does_not_fit_ends_with_1() -> None:
    found = run("--teeth 24 --tip-diameter 52 --root-diameter 43 --span 2:9.49 --span 3:15.40 --span 4:21.6 --helix-angle 0")
    assert found.exit_code == 1 and "no candidate fits" in found.stderr


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--teeth 24 --tip-diameter wide", "tip_diameter = 'wide': must be a number, or a number and its uncertainty"),
        ("--teeth 24 --tip-diameter 52+-0.1+-0.2", "must have one uncertainty: 52.3+-0.1"),
        ("--teeth 24 --span 15.4", "span = '15.4': must be teeth spanned and reading, such as 3:15.40"),
        ("--teeth 24 --span 3:15.4 --span 3:15.5", "span = '3:15.5': must be given once for 3"),
        ("--teeth 24 --over-pins x:50", "over_pins = 'x': must have a number for the diameter of pins or balls"),
        ("--teeth 24 --tip-diameter 52 --candidate 9", "candidate = 9: must be a whole number from 1 to 5"),
        ("--teeth 24 --chordal-thickness 3.1", "must be height below the tip and reading, such as 3.5:56.21"),
        ("--tip-diameter 52", "teeth is missing: must be given, as counted, or a FILE of measurements"),
    ],
)
def test_wrong_input_is_one_line(words: str, message: str) -> None:
    found = run(words)
    assert found.exit_code == 2 and message in found.stderr and len(found.stderr.splitlines()) == 1


FILE = """[measured]
teeth = 24
tip_diameter = [52.02, 0.03]
root_diameter = "43.01+-0.04"
span.3 = 15.40
span.4 = 21.30
helix_angle = 0
"""


def test_a_file_says_what_options_say_and_options_count_before_it(tmp_path: Path) -> None:
    path = tmp_path / "measured.toml"
    path.write_text(FILE, encoding="utf-8")
    by_options = (
        "--teeth 24 --tip-diameter 52.02+-0.03 --root-diameter 43.01+-0.04 --span 3:15.40 --span 4:21.30 --helix-angle 0"
    )
    assert run("--json", path).stdout == run(f"{by_options} --json").stdout
    found = json.loads(run("--json --tip-diameter 52.04 --span 5:27.21 --uncertainty 0.01", path).stdout)
    read = {(each["gauge"], each.get("teeth")): (each["value"], each["uncertainty"]) for each in found["readings"]}
    assert read["tip_diameter", None] == (52.04, 0.01) and read["span", 5] == (27.21, 0.01) and read["span", 3] == (15.4, 0.01)
    assert read["root_diameter", None] == (43.01, 0.04)


def test_the_starter_is_identified(tmp_path: Path) -> None:
    """With its own comments taken away where they hold other readings, for no gear has all of them."""
    text = starter_text("measured")[1]
    path = tmp_path / "measured.toml"
    path.write_text(text, encoding="utf-8")
    found = run("", path)
    assert found.exit_code == 0 and "Certain" in found.stdout
    keys = {line.lstrip("# ").partition(" ")[0].partition(".")[0] for line in text.splitlines() if " = " in line}
    assert keys >= set(schema_of(Measurements)) - {"over_balls", "between_pins", "between_balls"}


def test_pins_have_their_diameter_in_the_key(tmp_path: Path) -> None:
    """TOML takes 3.5 for a key in a key."""
    texts = ("over_pins.3.5 = 52.93", '"over_pins"."3.5" = 52.93', 'over_pins = {"3.5" = 52.93}')
    for text in texts:
        (tmp_path / "pins.toml").write_text(f"[measured]\nteeth = 24\n{text}\n", encoding="utf-8")
        assert read_measurements(tmp_path / "pins.toml").over_pins == {3.5: 52.93}


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("teeth = 24\n", "", "m.toml line 1: measured.teeth is missing: must be given, as counted"),
        ("teeth = 24", "teeth = 24.0", "m.toml line 2: measured.teeth = 24: must be a whole number from 3 to 2000"),
        ("[52.02, 0.03]", "[52.02, 0.03, 1]", "m.toml line 3: measured.tip_diameter = [52.02, 0.03, 1]: must be a number, or"),
        ("[52.02, 0.03]", "-52.0", "m.toml line 3: measured.tip_diameter = -52 mm: must be a number above 0 mm"),
        ("[52.02, 0.03]", "true", "m.toml line 3: measured.tip_diameter = True: must be a number above 0 mm"),
        ("43.01+-0.04", "deep", "m.toml line 4: measured.root_diameter = 'deep': must be a number, or a number and its"),
        ("span.3", "span.x", "m.toml line 5: measured.span = 'x': must have a number for the teeth spanned"),
        ("span.4", "span.25", "m.toml line 6: measured.span_teeth = 25: must be a whole number from 1 to 24"),
        ("21.30", "11.30", "m.toml line 6: measured.span = 11.3 mm: must be above the span over 3, 15.4 mm"),
        (
            "span.3 = 15.40\nspan.4",
            "span",
            "line 5: measured.span = 21.3: must have the teeth spanned before the reading",
        ),
        ("tip_diameter", "tip_diametre", "m.toml line 3: measured.tip_diametre: unknown key; did you mean tip_diameter?"),
        ("[measured]", "[gear]", "m.toml line 1: [gear]: unknown table; what was measured stands in [measured]"),
        ("[measured]", "measured = 3\n[other]", "unknown table"),
        (
            "helix_angle = 0",
            "helix_angle = 0\nlead = 300",
            "line 8: measured.lead = 300 mm: must be left out",
        ),
    ],
)
def test_what_is_wrong_in_a_file_is_one_line_with_its_place(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = tmp_path / "m.toml"
    assert old in FILE
    path.write_text(FILE.replace(old, new, 1), encoding="utf-8")
    found = run("", path)
    assert found.exit_code == 2 and message in found.stderr and len(found.stderr.splitlines()) == 1


def test_a_wrong_option_beside_a_file_is_not_put_on_the_file(tmp_path: Path) -> None:
    path = tmp_path / "m.toml"
    path.write_text(FILE, encoding="utf-8")
    assert run("--tip-diameter -52", path).stderr.startswith("Error: tip_diameter = -52 mm: must be a number above 0 mm")
