"""`gearcad planetary --ratio`: table on the screen, design table, document, and what is said where nothing is found."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main
from gearcad.designs import PlanetaryDesign
from gearcad.designs.table import open_table
from gearcad.planetary.members import SetType
from gearcad.planetary.power import efficiency

KINDS = {
    "A": ("5.2", ()),
    "B": ("7.3", ("--module-2", "2.5")),
    "C": ("-30", ()),
    "D": ("13.9", ()),
}


def run(*words: object) -> Result:
    return CliRunner().invoke(main, ["planetary", *map(str, words)])


def designs(table: Path) -> list[PlanetaryDesign]:
    return [row.design() for row in open_table(table).rows()]


@pytest.mark.parametrize("helix", [0, 15])
@pytest.mark.parametrize("kind", KINDS)
def test_what_is_found_is_a_design_table(tmp_path: Path, kind: str, helix: int) -> None:
    ratio, more = KINDS[kind]
    path = tmp_path / "found.csv"
    words = ("--ratio", ratio, "--module", 2, "--type", kind, "--helix-angle", helix, "--count", 2, *more)
    shown = run(*words, "-o", path)
    assert shown.exit_code == 0, shown.stderr
    assert shown.stderr.endswith(f"Next: gearcad batch {path}\n")
    document = json.loads(run(*words, "--json", "--quiet").stdout)
    members, heading, *lines = shown.stdout.splitlines()[:-1]
    roles = designs(path)[0].train
    assert members.endswith(f"; input {roles.input}, output {roles.output}, fixed {roles.fixed}")
    assert "0000000" not in path.read_text(encoding="utf-8")
    assert heading.split()[:2] == ["set", "ratio"]
    assert [line.split()[0] for line in lines] == [each["name"] for each in document["found"]]
    for design, each in zip(designs(path), document["found"], strict=True):
        train = design.train
        assert design.name == each["name"]
        assert train.set_type is SetType(kind)
        assert train.ratio == pytest.approx(each["ratio"], rel=1e-13)
        assert efficiency(train, 0.99) == pytest.approx(each["efficiency"], rel=1e-12)
        assert {name: gear.teeth for name, gear in design.gears.items()} == each["teeth"]
        for name, gear in design.gears.items():
            assert gear.profile_shift == pytest.approx(each["profile_shifts"][name], abs=1e-9)
            assert gear.tip_alteration == pytest.approx(each["tip_alterations"][name], abs=1e-9)
        assert {notice.code for notice in train.notices} <= {"no-hunting-tooth", "tilting-planets"}


def test_several_types_share_a_table(tmp_path: Path) -> None:
    path = tmp_path / "found.csv"
    assert run("--ratio", 5, "--module", 1.5, "--type", "A,b,C,D", "--count", 5, "-o", path).exit_code == 0
    assert {design.train.set_type.value for design in designs(path)} == {"B", "C", "D"}  # of A, larger ones follow
    rows = [line for line in csv.reader(path.open(encoding="utf-8")) if not line[0].startswith("#")]
    assert rows[0][0] == "name"
    assert {len(row) for row in rows} == {len(rows[0])}


def test_a_table_is_not_replaced_unasked(tmp_path: Path) -> None:
    path = tmp_path / "found.csv"
    path.write_text("mine", encoding="utf-8")
    words = ("--ratio", 5.2, "--module", 2, "--count", 1, "-o", path)
    assert run(*words).exit_code == 2
    assert path.read_text(encoding="utf-8") == "mine"
    assert run(*words, "--force").exit_code == 0
    assert len(designs(path)) == 1


def test_nothing_found_is_one_line(tmp_path: Path) -> None:
    path = tmp_path / "found.csv"
    result = run("--ratio", 5.2, "--module", 2, "--teeth", "17:21", "--ring-teeth", "50:60", "-o", path)
    assert result.exit_code == 1
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert line.startswith("No set of type A has ratio 5.2 within 1 %: of ")
    assert line.endswith("by ratio; nearest ratios 4.47059")
    assert not path.exists()
    document = json.loads(run("--ratio", 5.2, "--module", 2, "--teeth", "17:21", "--ring-teeth", "50:60", "--json").stdout)
    assert document["found"] == []


def test_the_condition_that_removes_all_is_named() -> None:
    result = run("--ratio", 12, "--module", 2, "--planets", 5, "--tolerance", 0.5)
    assert result.exit_code == 1
    assert "by distance of planets; nearest ratios" in result.stderr


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--ratio", 5.2), "module is missing: must be given, in mm, with --ratio"),
        (("--teeth", "17:20"), "teeth = '17:20': applies to a search only: needs --ratio"),
        (("--force",), "force = True: applies to a search only: needs --ratio"),
        (("x.toml", "--ratio", 3, "--module", 1), "ratio = 3: searches without a spec: leave out x.toml"),
        (("--ratio", 3, "--module", 1, "--type", "E"), "type = 'E': must be one of"),
        (("--ratio", 3, "--module", 1, "--in", "wheel"), "in = 'wheel': must be sun, ring, carrier in a set of type A"),
        (("--ratio", 3, "--module", 1, "--planets", "3:4:5"), "planets = '3:4:5': must be a whole number or two"),
        (("--ratio", 3, "--module", 1, "--planets", "0"), "planets = 0: must be a whole number from 1 to 24"),
        (("--ratio", 3, "--module", 1, "--count", 0), "count = 0"),
        (("--ratio", 3, "--module", 1, "-o", "folder"), "output = 'folder': must end in .csv"),
        (("--ratio", 0, "--module", 1), "ratio = 0: must be at least 0.0001 in size"),
        ((), "spec is missing: must be given"),
    ],
)
def test_wrong_words_get_one_line(words: tuple[object, ...], message: str) -> None:
    result = run(*words)
    assert result.exit_code == 2
    (line,) = result.stderr.splitlines()
    assert line.startswith(f"Error: {message}")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--planetary",), "ratio is missing: must be given, speed of the input over that of the output"),
        (
            ("--planetary", "--ratio", 5, "--shift", "0.2"),
            "shift = '0.2': applies to pairs only: leave it out with --planetary",
        ),
        (("--ratio", 5, "--planets", "3"), "planets = '3': applies to planetary sets only: needs --planetary"),
        (("--planetary", "--ratio", 5, "--helix-angle", "0,10"), "must be one number with --planetary"),
        (("--planetary", "--ratio", 5, "--wheel-hardness", 90), "ring_material.hardness = 90 HV: must be from 660 to 800 HV"),
    ],
)
def test_sizes_of_sets_need_what_sets_have(words: tuple[object, ...], said: str, tmp_path: Path) -> None:
    common = ("size", "--torque", 300, "--speed", 1500, "--material", "Eh MQ", "-o", tmp_path / "out")
    result = CliRunner().invoke(main, [str(each) for each in (*common, *words)])
    assert result.exit_code == 2
    assert said in result.output
    assert len(result.output.strip().splitlines()) == 1
    assert not (tmp_path / "out").exists()
