"""`gearcad size` and `gearcad planetary --ratio`: tables, files, and what is said where nothing is found."""

import csv
import itertools
import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from support.commands import invoke, read_json

from gearcad.cli import main
from gearcad.designs import PairDesign, PlanetaryDesign, read_spec
from gearcad.designs.table import open_table
from gearcad.jobs.strength import Rate
from gearcad.planetary.members import SetType
from gearcad.planetary.power import efficiency
from gearcad.rating.strength import StrengthRating, rate_strength

RANGES = (
    "--teeth 17:20 --module 2,2.5 --helix-angle 0,15 --width-ratio 0.8,1 --shift 0.2:0.6:0.2 --shift-sum 0.5 "
    "--errors 0 --count 3"
)


def run(*words: object, **options: str) -> Result:
    given = {"--torque": "100", "--speed": "1500", "--ratio": "2", "--material": "Eh MQ", "--life": "1e4"}
    given |= {f"--{name.replace('_', '-')}": value for name, value in options.items()}
    return invoke("size", *RANGES.split(), *(each for item in given.items() for each in item), *map(str, words))


def test_files_and_table(tmp_path: Path) -> None:
    found = run("-o", tmp_path, "--quiet", wheel_material="V MQ", wheel_hardness="320", safety_flank="0.5")
    assert found.exit_code == 0, found.output
    heading, first, *_ = found.stdout.splitlines()
    assert heading.split()[:3] == ["pair", "a", "mm"]
    document = read_json(tmp_path / "size.json")
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


_LONG = pytest.mark.long


@pytest.mark.parametrize("friction", ["integral", pytest.param("0.05", marks=_LONG), pytest.param("niemann", marks=_LONG)])
def test_efficiency_of_the_first_is_that_of_rate(tmp_path: Path, friction: str) -> None:
    """`rate` makes each pair from its drawing and rates it alone."""
    ranges = {"count": "10", "module": "2,2.5,3", "helix_angle": "0,10,15,20", "shift": "0:0.6:0.2"}
    found = run("-o", tmp_path, "--by", "efficiency", friction=friction, **ranges)
    assert found.exit_code == 0, found.output
    assert "efficiency %" in found.stdout.splitlines()[0]
    figures = read_json(tmp_path / "size.json")["found"]
    designs = [row.design() for row in open_table(tmp_path / "pairs.csv").rows()]
    values = [each["efficiency"] for each in figures]
    assert len(designs) == len(values) == 10
    # Efficiencies count as equal within 0.01 %.
    assert all(first >= second - 1.01e-4 for first, second in itertools.pairwise(values))
    for design, own in zip(designs, figures, strict=True):
        assert isinstance(design, PairDesign)
        rating = Rate(report=False).run(design)
        assert isinstance(rating, StrengthRating) and rating.efficiency is not None
        assert own["efficiency"] == pytest.approx(rating.efficiency.efficiency, rel=1e-12)
        assert own["mean_loss"] == pytest.approx(rating.efficiency.mean_loss, rel=1e-9)


def test_laws_without_a_coefficient_are_told(tmp_path: Path) -> None:
    assert "friction = 'flash'" in run("-o", tmp_path, friction="flash").output
    assert "0 rpm" in run("-o", tmp_path, "--rating", "dynamic_factor=1", speed="0", friction="integral", life="1").output
    assert "efficiency" not in run("-o", tmp_path).stdout


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
    found = invoke(*SETS.split(), "--material", "Eh MQ", "-o", str(tmp_path))
    assert found.exit_code == 0, found.output
    assert read_json(tmp_path / "size.json")["found"]
    design = read_spec(tmp_path / "best.toml")
    assert isinstance(design, PlanetaryDesign)
    assert design.train.ratio == pytest.approx(5, rel=1e-3)
    assert (tmp_path / "sets.csv").exists()


def test_the_advice_follows_the_condition_that_took_the_last(tmp_path: Path) -> None:
    found = run("-o", tmp_path, "--quiet", max_mass="0.1")
    assert found.exit_code == 1
    lightest = read_json(tmp_path / "size.json")["lightest"]
    *_, said, advice = found.stderr.splitlines()
    assert f"{lightest['name']}, b {lightest['face_width']:g} mm: {lightest['mass']:.3g} kg" in said
    mass = float(advice.split("--max-mass ")[1].split()[0])
    assert lightest["mass"] <= mass <= 1.01 * lightest["mass"]
    assert run("-o", tmp_path, "--quiet", max_mass=str(mass)).exit_code == 0


def test_what_safeties_go_by_and_what_was_not_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.sizing.proposals.FRONT_SAMPLE", 2)
    found = run("-o", tmp_path, by="scuffing", max_mass="100")
    said = found.stderr
    document = read_json(tmp_path / "size.json")
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
    found = invoke(*words.split(), str(tmp_path), "--material", "Eh MQ")
    assert "max_mass = 3: applies to pairs" in found.stderr


KINDS = {
    "A": ("5.2", ()),
    "B": ("7.3", ("--module-2", "2.5")),
    "C": ("-30", ()),
    "D": ("13.9", ()),
}


def planetary_run(*words: object) -> Result:
    return invoke("planetary", *map(str, words))


def designs(table: Path) -> list[PlanetaryDesign]:
    return [row.design() for row in open_table(table).rows()]


@pytest.mark.parametrize("helix", [0, 15])
@pytest.mark.parametrize("kind", KINDS)
def test_what_is_found_is_a_design_table(tmp_path: Path, kind: str, helix: int) -> None:
    ratio, more = KINDS[kind]
    path = tmp_path / "found.csv"
    words = ("--ratio", ratio, "--module", 2, "--type", kind, "--helix-angle", helix, "--count", 2, *more)
    shown = planetary_run(*words, "-o", path)
    assert shown.exit_code == 0, shown.stderr
    assert shown.stderr.endswith(f"Next: gearcad batch {path}\n")
    document = json.loads(planetary_run(*words, "--json", "--quiet").stdout)
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
    assert planetary_run("--ratio", 5, "--module", 1.5, "--type", "A,b,C,D", "--count", 5, "-o", path).exit_code == 0
    assert {design.train.set_type.value for design in designs(path)} == {"B", "C", "D"}  # of A, larger ones follow
    rows = [line for line in csv.reader(path.open(encoding="utf-8")) if not line[0].startswith("#")]
    assert rows[0][0] == "name"
    assert {len(row) for row in rows} == {len(rows[0])}


def test_a_table_is_not_replaced_unasked(tmp_path: Path) -> None:
    path = tmp_path / "found.csv"
    path.write_text("mine", encoding="utf-8")
    words = ("--ratio", 5.2, "--module", 2, "--count", 1, "-o", path)
    assert planetary_run(*words).exit_code == 2
    assert path.read_text(encoding="utf-8") == "mine"
    assert planetary_run(*words, "--force").exit_code == 0
    assert len(designs(path)) == 1


def test_nothing_found_is_one_line(tmp_path: Path) -> None:
    path = tmp_path / "found.csv"
    result = planetary_run("--ratio", 5.2, "--module", 2, "--teeth", "17:21", "--ring-teeth", "50:60", "-o", path)
    assert result.exit_code == 1
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert line.startswith("No set of type A has ratio 5.2 within 1 %: of ")
    assert line.endswith("by ratio; nearest ratios 4.47059")
    assert not path.exists()
    document = json.loads(
        planetary_run("--ratio", 5.2, "--module", 2, "--teeth", "17:21", "--ring-teeth", "50:60", "--json").stdout
    )
    assert document["found"] == []


def test_the_condition_that_removes_all_is_named() -> None:
    result = planetary_run("--ratio", 12, "--module", 2, "--planets", 5, "--tolerance", 0.5)
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
    result = planetary_run(*words)
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
