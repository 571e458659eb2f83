"""`gearcad identify`: table, document, spec, wrong input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main
from gearcad.designs import GearDesign, read_spec

READINGS = "--teeth 24 --tip-diameter 52.02 --root-diameter 43.01 --span 3:15.40 --span 4:21.30"


def run(words: str, *others: object) -> Result:
    return CliRunner().invoke(main, ["identify", *words.split(), *map(str, others)])


def test_table_says_what_it_is_and_how_far_it_is_off() -> None:
    found = run(READINGS)
    assert found.exit_code == 0, found.output
    heading, first, *_ = found.stdout.splitlines()
    assert heading.split()[:3] == ["size", "m_n", "mm"] and first.split()[:6] == ["1", "ISO", "54", "I", "2", "20"]
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
        ("--teeth 24 --over-pins x:50", "over_pins = 'x:50': must be diameter of pins or balls and reading"),
        ("--teeth 24 --tip-diameter 52 --candidate 9", "candidate = 9: must be a whole number from 1 to 5"),
        ("--tip-diameter 52", "Missing option '--teeth'"),
    ],
)
def test_wrong_input_is_one_line(words: str, message: str) -> None:
    found = run(words)
    assert found.exit_code == 2 and message in found.stderr and len(found.stderr.splitlines()) == 1
