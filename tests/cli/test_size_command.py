"""`gearcad size`: its table, its files, what it says where nothing is found."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main
from gearcad.designs import PairDesign, PlanetaryDesign, read_spec
from gearcad.designs.table import open_table
from gearcad.rating.strength import rate_strength

RANGES = (
    "--teeth 17:20 --module 2,2.5 --helix-angle 0,15 --width-ratio 0.8,1 --shift 0.2:0.6:0.2 --shift-sum 0.5 "
    "--errors 0 --count 3"
)


def run(*words: object, **options: str) -> Result:
    given = {"--torque": "100", "--speed": "1500", "--ratio": "2", "--material": "Eh MQ", "--life": "1e4"}
    given |= {f"--{name.replace('_', '-')}": value for name, value in options.items()}
    return CliRunner().invoke(
        main, ["size", *RANGES.split(), *(each for item in given.items() for each in item), *map(str, words)]
    )


def test_files_and_table(tmp_path: Path) -> None:
    found = run("-o", tmp_path, "--quiet", wheel_material="V MQ", wheel_hardness="320", safety_flank="0.5")
    assert found.exit_code == 0, found.output
    heading, first, *_ = found.stdout.splitlines()
    assert heading.split()[:3] == ["pair", "a", "mm"]
    document = json.loads((tmp_path / "size.json").read_text(encoding="utf-8"))
    best = document["found"][0]
    assert first.split()[0] == best["name"]
    assert document["considered"] == 4 * 2 * 2 * 3 * 2
    design = read_spec(tmp_path / "best.toml")
    assert isinstance(design, PairDesign) and design.load is not None
    one = rate_strength(design.pair, design.materials, design.load, design.rating)
    assert one.passed
    assert [each.safety for each in one.root] == pytest.approx(list(best["root_safeties"].values()), rel=1e-9)
    rows = list(open_table(tmp_path / "pairs.csv").rows())
    made = [row.design() for row in rows]
    assert [each.name for each in made] == [each["name"] for each in document["found"]]
    assert isinstance(made[0], PairDesign) and made[0].pair.to_dict() == design.pair.to_dict()
    front = list(open_table(tmp_path / "front.csv").rows())
    points = document["front"]
    assert [row.design().name[3:] for row in front] == [each["name"] for each in points]
    assert [each["mass"] for each in points] == sorted(each["mass"] for each in points)
    lightest = front[0].design()
    assert isinstance(lightest, PairDesign) and lightest.load is not None
    rated = rate_strength(lightest.pair, lightest.materials, lightest.load, lightest.rating)
    assert [each.safety for each in rated.flank] == pytest.approx(list(points[0]["flank_safeties"].values()), rel=1e-9)
    assert points[0]["teeth"]["pinion"] == lightest.pair.pinion.teeth
    assert (tmp_path / "front.png").read_bytes().startswith(b"\x89PNG")


def test_nothing_found_says_why_and_what_would_help(tmp_path: Path) -> None:
    found = run("-o", tmp_path, "--quiet", torque="10000")
    assert found.exit_code == 1
    assert not found.stdout.startswith("pair")
    lines = found.stderr.splitlines()
    assert lines[0].startswith("No pair of")
    assert "by flank safety" in lines[0]
    assert lines[1].startswith("the safest is")
    assert lines[-1] == "what would help: a larger --module, --width-ratio or --centre-distance, or a harder material"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["size.json"]


def test_an_impossible_centre_distance(tmp_path: Path) -> None:
    found = run("-o", tmp_path, "--quiet", centre_distance="500")
    assert found.exit_code == 1
    assert "by centre distance" in found.stderr
    assert "another --centre-distance" in found.stderr


SETS = (
    "size --planetary --torque 300 --speed 1500 --ratio 5 --life 1000 --module 3 --planets 3 --ratio-tolerance 0.1 "
    "--teeth 18:27 --ring-teeth 72:72 --quiet"
)


def test_planetary_sets(tmp_path: Path) -> None:
    found = CliRunner().invoke(main, [*SETS.split(), "--material", "Eh MQ", "-o", str(tmp_path)])
    assert found.exit_code == 0, found.output
    assert json.loads((tmp_path / "size.json").read_text(encoding="utf-8"))["found"]
    design = read_spec(tmp_path / "best.toml")
    assert isinstance(design, PlanetaryDesign)
    assert design.train.ratio == pytest.approx(5, rel=1e-3)
    assert (tmp_path / "sets.csv").exists()


def test_the_advice_follows_the_condition_that_took_the_last(tmp_path: Path) -> None:
    found = run("-o", tmp_path, "--quiet", max_mass="0.1")
    assert found.exit_code == 1
    lightest = json.loads((tmp_path / "size.json").read_text(encoding="utf-8"))["lightest"]
    *_, said, advice = found.stderr.splitlines()
    assert f"{lightest['name']}, b {lightest['face_width']:g} mm: {lightest['mass']:.3g} kg" in said
    mass = float(advice.split("--max-mass ")[1].split()[0])
    assert lightest["mass"] <= mass <= 1.01 * lightest["mass"]
    assert run("-o", tmp_path, "--quiet", max_mass=str(mass)).exit_code == 0


def test_what_safeties_go_by_and_what_was_not_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.sizing.proposals.FRONT_SAMPLE", 2)
    found = run("-o", tmp_path, by="scuffing", max_mass="100")
    said = found.stderr
    document = json.loads((tmp_path / "size.json").read_text(encoding="utf-8"))
    why = document["not_judged"]["scuffing"]
    assert why == "scuffing not judged: required_safety_scuffing and scuffing_stage not given"
    assert said.count(why) == 1
    assert f"# {why}" in (tmp_path / "best.toml").read_text(encoding="utf-8")
    assert "required S_H 1, S_F 1.4; K_A 1; accuracy grade 6" in said
    assert "in the middle between its bearings" in " ".join(said.split())
    assert "gearcad modify" in said
    lightest, *between, safest = document["front"]
    assert between
    rows = list(open_table(tmp_path / "front.csv").rows())
    assert [row.design().name for row in rows] == [f"01-{lightest['name']}", f"02-{safest['name']}"]
    notices = [each["notices"] for each in document["found"]]
    heading, *lines = found.stdout.splitlines()[: len(notices) + 1]
    assert any(notices) and heading.endswith("notice")
    assert [line.endswith(" 1") for line in lines] == [bool(each) for each in notices]


@pytest.mark.parametrize("name", ["module", "wheel-material", "teeth", "by"])
def test_empty_options_are_refused(name: str, tmp_path: Path) -> None:
    found = run(f"--{name}=", "-o", tmp_path)
    assert found.exit_code != 0
    assert f"{name.replace('-', '_')} = ''" in found.stderr


def test_sets_have_no_most_mass(tmp_path: Path) -> None:
    words = "size --planetary --torque 300 --speed 1500 --ratio 5.2 --max-mass 3 -o"
    found = CliRunner().invoke(main, [*words.split(), str(tmp_path), "--material", "Eh MQ"])
    assert "max_mass = 3: applies to pairs" in found.stderr
