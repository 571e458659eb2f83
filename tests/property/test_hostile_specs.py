"""Whatever a spec holds, a command answers with a status and one line; every default is marked as assumed."""

import copy
import re
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from enum import Enum
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from support.hostile import CHEAP, hostile_rows, hostile_specs, physical_specs, put, run_politely, toml_text

from gearcad import Material, read
from gearcad.core.errors import SpecError
from gearcad.core.output import json_text
from gearcad.core.quantities import TORQUE, FieldSchema
from gearcad.core.records import is_assumed
from gearcad.core.runtime import templates
from gearcad.designs import Design, PairDesign, PlanetaryDesign, read_spec
from gearcad.designs.keys import FIELDS
from gearcad.designs.reader import starter_text
from gearcad.designs.spec_writers import MeshPairs, pair_text
from gearcad.designs.table import open_table
from gearcad.designs.train_keys import PLANETARY
from gearcad.jobs.draw import drawn_gears
from gearcad.jobs.strength import Rate
from gearcad.mounting import Mounting
from gearcad.page.panels.drawn_data import of_last
from gearcad.page.panels.sheet_content import shown_figures, strength_figures
from gearcad.page.panels.views import sheet_figures
from gearcad.page.words import PageLanguage, PageWords
from gearcad.planetary import TrainLoad
from gearcad.planetary.power import power_flow
from gearcad.rating import RatingOptions
from gearcad.rating.strength import StrengthRating
from gearcad.report.document import load_rows
from gearcad.report.planetary_tables import power_rows
from gearcad.report.strength import rate_html
from gearcad.sheet import sheet_of

FZG = tomllib.loads(starter_text("fzg-c")[1]) | {"check": CHEAP}
TRAIN = tomllib.loads(starter_text("train-1-stage")[1])

HUGE = 10**400


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One for all examples: each writes over what the last one left."""
    return tmp_path_factory.mktemp("hostile")


def spec_file(folder: Path, text: str, name: str = "x.toml") -> str:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return str(path)


@settings(max_examples=100)
@given(text=hostile_specs(trains=False))
def test_data_of_a_hostile_spec(folder: Path, text: str) -> None:
    run_politely("data", spec_file(folder, text))


@settings(max_examples=100)
@given(text=hostile_specs(trains=True))
def test_reading_a_hostile_train(folder: Path, text: str) -> None:
    try:
        read_spec(spec_file(folder, text))
    except SpecError as error:
        assert str(error).isprintable()


@settings(max_examples=100)
@given(text=hostile_specs(planetary=True))
def test_reading_a_hostile_planetary_train(folder: Path, text: str) -> None:
    try:
        json_text(read_spec(spec_file(folder, text)).to_dict())
    except SpecError as error:
        assert str(error).isprintable() and len(str(error)) < 1200


@settings(max_examples=100)
@given(text=hostile_rows())
def test_reading_a_hostile_table(folder: Path, text: str) -> None:
    try:
        faults = [fault for row in open_table(spec_file(folder, text, "x.csv")).rows() for fault in row.all_faults()]
    except SpecError as error:
        faults = str(error).split("\n")
    assert all(fault.isprintable() for fault in faults)


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("load.torque", 1e300, "load.torque = 1e+300 N·m: must be a number, 0 or from 1e-09 to 1e+09 N·m in size"),
        ("load.torque", 1e-300, "load.torque = 1e-300 N·m: must be a number, 0 or from 1e-09 to 1e+09 N·m in size"),
        ("load.torque", [[]], "load.torque = [[]]: must be a number, 0 or from 1e-09 to 1e+09 N·m in size"),
        (
            "material.youngs_modulus",
            1e300,
            "material.youngs_modulus = 1e+300 MPa: must be a number at least 0.1 MPa and at",
        ),
        ("material.youngs_modulus", 1e-300, "material.youngs_modulus = 1e-300 MPa: must be a number at least 0.1 MPa and at"),
        ("material.contact_limit", HUGE, "material.contact_limit: must be a smaller number; this is a number of 401 digits"),
        ("material.contact_limit", [1.0, HUGE], "material.contact_limit: must be a smaller number; this is a number of 401"),
        ("check.torques", [HUGE], "check.torques: must be a smaller number; this is a number of 401 digits"),
        ("check.torques", [16**5000], "check.torques: must be a smaller number; this is a number of 6021 digits"),
        ("pair.name", 10**19, "pair.name = 1e+19: must be a text, in quotation marks"),
        ("drawing.title", 10**19, "drawing.title = 1e+19: must be a text, in quotation marks"),
        ("check.plane", [], 'check.plane = []: must be "strain" or "stress"'),
        ("check.convergence", {}, 'check.convergence = {}: must be "on" or "off"'),
        ("dynamics.tooth_errors", {}, 'dynamics.tooth_errors = {}: must be "on" or "off"'),
        ("pinion.\x1b[31m" + "k" * 3000, 1, "pinion.\\x1b[31mkkkk"),
    ],
)
def test_what_no_gear_can_be(folder: Path, key: str, value: Any, said: str) -> None:
    spec = copy.deepcopy(FZG)
    put(spec, tuple(key.split(".", 1)), value)
    result = run_politely("check", spec_file(folder, toml_text(spec)))
    assert result.exit_code == 2 and f": {said}" in result.stderr


LONG = "x" * 5000
LONGEST_LINE = 600
"""Characters of an error line that hold a command, a wrong value and what is permitted."""


@pytest.mark.parametrize(
    "arguments",
    [
        [LONG],
        ["new", LONG],
        ["data", LONG],
        ["data", f"{LONG}.toml"],
        ["batch", f"{LONG}.csv"],
        ["build", "spec.toml", f"--{LONG}"],
        ["build", "spec.toml", "--chord-error", LONG],
        ["build", "spec.toml", "--chord-error", "x " * 2500],
        ["build", "spec.toml", "--format", LONG],
        ["identify", "--teeth", LONG],
        ["plot", f"{LONG}.csv", "--x", "a", "--y", "b"],
        ["completion", LONG],
    ],
)
def test_what_is_wrong_is_repeated_in_part_only(folder: Path, arguments: list[str]) -> None:
    spec_file(folder, toml_text(FZG))
    result = run_politely(*arguments)
    assert result.exit_code == 2 and len(result.stderr) < LONGEST_LINE, len(result.stderr)


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (("inertia", 0, "inertia"), HUGE, "train.inertia[0].inertia: must be a smaller number; this is a number of 401 digits"),
        (("mesh", 0, "base_radii"), [HUGE, 1], "train.mesh[0].base_radii: must be a smaller number; this is a number of 401"),
        (("torques", "pinion"), HUGE, "train.torques.pinion: must be a smaller number; this is a number of 401 digits"),
        (
            ("mesh", 0, "stiffness"),
            1e300,
            "stiffness = 1e+300 N/µm: must be a number at least 1e-09 N/µm and at most",
        ),
        (("shaft", 0, "length"), 1e-300, "length = 1e-300 mm: must be a number at least 0.001 mm and at most 10000000 mm"),
        (("shaft", 0, "name"), "x" * 3000, "x..."),
        (("mesh", 0, "preload"), 1e-300, "preload = 1e-300 N: must be a number, 0 or from 1e-09 to 1e+12 N"),
        (("mesh", 0, "teeth"), [1e300, 20], "must be a whole number from 1 to"),
    ],
)
def test_what_no_train_can_be(folder: Path, path: tuple[Any, ...], value: Any, said: str) -> None:
    spec = copy.deepcopy(TRAIN)
    put(spec, ("train", *path), value)
    if path[0] == "shaft":
        put(spec, ("train", "shaft", 0, "start"), "nobody")
    result = run_politely("dynamics", spec_file(folder, toml_text(spec)))
    assert result.exit_code == 2 and said in result.stderr


def test_five_hundred_lists_in_each_other(folder: Path) -> None:
    result = run_politely("data", spec_file(folder, "[gear]\nteeth = " + 500 * "[" + 500 * "]"))
    assert "lists or tables nested hundreds deep" in result.stderr


def test_a_thousand_tables_in_each_other(folder: Path) -> None:
    result = run_politely("data", spec_file(folder, "[gear]\nteeth = 20\n[x" + 1000 * ".a" + "]"))
    assert result.exit_code == 2 and "has lists or tables nested more than 50 deep" in result.stderr


@pytest.mark.parametrize(("torque", "modulus"), [(3e6, 206000.0), (TORQUE.most, 206000.0), (302.0, 0.1)])
def test_load_that_no_teeth_can_carry_is_said_with_its_torque(folder: Path, torque: float, modulus: float) -> None:
    """a = sqrt(4 F rho/(pi E*)) at the pitch point, above the depth of the teeth."""
    spec = copy.deepcopy(FZG)
    put(spec, ("load", "torque"), torque)
    put(spec, ("material", "youngs_modulus"), modulus)
    result = run_politely("check", spec_file(folder, toml_text(spec)), "--quiet")
    assert result.exit_code == 2
    width = 48.88 * (torque / 3e6 * 206000 / modulus) ** 0.5
    assert f"the contact would be {width:.4g} mm wide on teeth 10.04 mm deep" in result.stderr
    (most,) = re.findall(r"must be at most (\S+) N·m in size", result.stderr)
    assert float(most) == pytest.approx(torque * (2 * 10.04 / width) ** 2, rel=2e-3)


PHYSICAL = (
    *(("load", key) for key in ("torque", "speed", "application_factor")),
    *(("material", key) for key in ("youngs_modulus", "poisson_ratio", "density", "yield_strength", "contact_limit")),
    *(("mounting", key) for key in ("misalignment", "pinion_pitch_error", "centre_distance_change")),
    *(("dynamics", key) for key in ("pinion_inertia", "damping_ratio", "speed_to", "bearing_damping", "tooth_stiffness")),
    *(("check", key) for key in ("pinion_inner_diameter", "root_band")),
    *(("pair", key) for key in ("axial_offset", "tooth_thinning", "face_width")),
)
OF_TRAINS = (
    *(("train", "inertia", 0, key) for key in ("inertia",)),
    *(
        ("train", "shaft", 0, key)
        for key in ("torsional_stiffness", "length", "diameter", "density", "damping", "damping_ratio")
    ),
    *(("train", "mesh", 0, key) for key in ("stiffness", "variation", "damping", "damping_ratio", "backlash", "preload")),
    *(("train", key) for key in ("speed", "order")),
    *(("dynamics", key) for key in ("speed_from", "speed_to")),
)


@pytest.mark.long
@pytest.mark.parametrize("command", ["check", "dynamics"])
@settings(max_examples=60)
@given(text=physical_specs(FZG | {"dynamics": {"speeds": 20, "stiffness": "potential-energy"}}, PHYSICAL))
def test_numbers_of_any_size(folder: Path, command: str, text: str) -> None:
    run_politely(command, spec_file(folder, text), "--quiet", "-o", str(folder))


@pytest.mark.long
@settings(max_examples=150)
@given(text=physical_specs(TRAIN | {"dynamics": {"speeds": 20}}, OF_TRAINS))
def test_trains_of_any_size(folder: Path, text: str) -> None:
    run_politely("dynamics", spec_file(folder, text), "--quiet", "-o", str(folder))


SHAPES = ("rack.", "body.end_chamfer_angle")
"""Keys whose defaults are the shape of a gear: it is made so."""

COMPUTED_SO = {
    "check": "refinement root_band stiffness_band contact_band",
    "mesh": "positions",
    "dynamics": "frequencies level_tolerance error_samples duration sampling transient.duration transient.torque_from",
    "drawing": "surface_roughness",
    "verify": "tolerance",
}
"""Keys that say how the program computes or draws; what a sheet asks for is what is made."""

TABLES = ("material", "load", "rating", "check", "dynamics")
"""Tables of a pair with defaults that stand for what the program cannot know."""


def defaults(fields: Any) -> Iterator[tuple[str, str, FieldSchema]]:
    """Yield table, key and field of every option that has a default."""
    for table in fields:
        for key, field in fields[table].items():
            if not field.required and field.default is not None and not getattr(field.default, "derived", False):
                yield table, key, field


@pytest.mark.parametrize("fields", [FIELDS, PLANETARY], ids=["pairs", "planetary"])
def test_every_default_is_nothing_a_choice_a_shape_or_assumed(fields: Any) -> None:
    """A number that is not 0 is assumed, unless it is the shape of a gear or says how the program computes."""
    left = [
        f"{table}.{key} = {field.default}"
        for table, key, field in defaults(fields)
        if field.default and not isinstance(field.default, bool | Enum) and not is_assumed(field.default)
        if not (isinstance(field.default, str) and (field.text or field.words))
        if not any(shape in key for shape in SHAPES) and key not in COMPUTED_SO.get(table, "").split()
    ]
    assert left == []


ASSUMED = [(table, key, field) for table, key, field in defaults(FIELDS) if table in TABLES and is_assumed(field.default)]
"""All options that are marked, as the schema has them."""


def spec(given: Any) -> str:
    """The text of a spec with the defaults of these options written in it."""
    tables = {
        "pair": ["normal_module = 3.0", "face_width = 30.0"],
        "pinion": ["teeth = 21"],
        "wheel": ["teeth = 43"],
        "material": ["group = 'Eh'", "quality = 'MQ'", "hardness = 720.0"],
        "load": ["torque = 20.0", "speed = 1450.0"],
        "rating": ["life = 1000.0", "oil_viscosity_40 = 220.0"],
        "check": ["model = '2d'"],
        "dynamics": ["speed_to = 3000.0"],
    }
    for table, key, field in given:
        tables[table].append(f"{key} = {str(field.default)!r}" if field.text else f"{key} = {field.default}")
    return "\n".join(line for table, lines in tables.items() for line in (f"[{table}]", *lines))


def made(folder: Path, given: Any) -> PairDesign:
    """The design of a spec in which these options are given."""
    path = folder / "it.toml"
    path.write_text(spec(given), encoding="utf-8")
    design = read(path)
    assert isinstance(design, PairDesign)
    return design


def told(assumed: list[str], table: str, key: str) -> bool:
    """Whether a list of what was assumed has this option."""
    return any(f"{table}.{key} = " in each or each.startswith(f"{key} = ") for each in assumed)


def shown(design: Design, table: str, key: str) -> list[str]:
    """What the data sheet has of an option."""
    rows = [row for section in sheet_of(design).sections for each in section.blocks for row in each.rows]
    return [text for row in rows if row.key == f"{table}.{key}" for text in row.texts]


def report_texts(rating: StrengthRating, design: PairDesign) -> list[str]:
    """Every value in the tables of a check's load."""
    assert design.load is not None
    return [text for row in load_rows(rating.materials.pinion, design.load, Mounting()) for text in row.values]


def test_all_options_are_marked_where_they_are_told(tmp_path: Path) -> None:
    """One option after the other is given: it loses its mark in data.json, data sheet and rate.json, and no other does."""
    assert len(ASSUMED) > 12
    for number in (None, *range(len(ASSUMED))):
        design = made(tmp_path, [] if number is None else [ASSUMED[number]])
        document = design.to_dict()
        rated = (
            Rate(report=False).run(design).to_dict()
            if number is None or ASSUMED[number][0] not in ("check", "dynamics")
            else {}
        )
        for other, (table, key, field) in enumerate(ASSUMED):
            assert document[table][key] == field.default
            assert told(document["assumed"], table, key) is (other != number), (table, key)
            texts = shown(design, table, key)
            assert all(text.endswith(" (assumed)") is (other != number) for text in texts), (table, key, texts)
            if table == "rating" or (rated and table in ("material", "load") and key != "name"):
                assert not rated or told(rated["assumed"], table, key) is (other != number), (table, key)
        for symbol, (table, key) in {"K_A": ("load", "application_factor"), "K_gamma": ("rating", "mesh_load_factor")}.items():
            if rated:
                given = number is not None and ASSUMED[number][:2] == (table, key)
                assert rated["sources"][symbol] == ("given" if given else "assumed")


@pytest.mark.parametrize("given", [False, True])
def test_reports_mark_what_nobody_gave(tmp_path: Path, given: bool) -> None:
    design = made(tmp_path, ASSUMED if given else [])
    rating = Rate(report=False).run(design)
    assert isinstance(rating, StrengthRating)
    page, loads = rate_html(rating, "it"), " ".join(report_texts(rating, design))
    assert ("(assumed)" in page) is not given
    assert ("(assumed)" in loads) is not given
    assert loads.count("(assumed)") == (0 if given else sum(table in ("material", "load") for table, *_ in ASSUMED))
    assert [each.grade for each in drawn_gears(design)] == ([6, 6] if given else [None, None])
    assert rating.asked
    unlimited = replace(design, material=Material())
    assert Rate(report=False).run(unlimited).asked is given  # a required safety that is given asks for a verdict


def test_specs_that_are_written_keep_what_was_given(tmp_path: Path) -> None:
    for keys in ([], ASSUMED):
        text = pair_text(made(tmp_path, keys))
        (tmp_path / "written.toml").write_text(text, encoding="utf-8")
        again = read(tmp_path / "written.toml")
        assert [told(again.to_dict()["assumed"], table, key) for table, key, _ in ASSUMED] == [not keys] * len(ASSUMED)


def test_the_page_tells_a_given_default_from_an_assumed_one(tmp_path: Path) -> None:
    """Both designs are equal, and have other verdicts."""
    calls: list[Design] = []
    find = of_last(lambda design: (calls.append(design), len(calls))[1])
    found = [find(made(tmp_path, given)) for given in ([], [], ASSUMED, ASSUMED)]
    assert found == [1, 1, 2, 2]


def test_changed_options_keep_what_was_assumed() -> None:
    changed = replace(RatingOptions(), life=100.0)
    assert is_assumed(changed.accuracy_grade) and not changed.asks_strength
    assert not is_assumed(RatingOptions(accuracy_grade=6).accuracy_grade)
    assert RatingOptions(required_safety_root=1.4).asks_strength
    assert RatingOptions(required_safety_root=1.4) == RatingOptions()


@pytest.mark.parametrize("given", [False, True])
def test_an_efficiency_that_nobody_gave_is_no_result(given: bool) -> None:
    design = read(templates() / "planetary-24-21-66.toml")
    assert isinstance(design, PlanetaryDesign)
    train, load = design.train, TrainLoad(torque=100.0, speed=1000.0)
    if given:
        load = replace(load, mesh_efficiency=1.0)
    flow = power_flow(train, load)
    rows, document = power_rows(train, flow), flow.to_dict()
    assert document["mesh_efficiency_source"] == ("given" if given else "assumed")
    assert document["self_locking"] is (False if given else None)
    words = " ".join(f"{row.words} {row.source}" for row in rows)
    assert ("assumed" in words) is not given
    assert ("efficiency of a mesh, given" in words) is given
    assert ("not self-locking" in words) is given
    assert ("whether it is self-locking is not known" in words) is not given


@pytest.mark.parametrize("key", ["mesh_efficiency", "application_factor"])
def test_loads_of_planetary_trains_are_marked(key: str) -> None:
    design = read(templates() / "planetary-24-21-66.toml")
    assert isinstance(design, PlanetaryDesign)
    for is_set in (False, True):
        load = TrainLoad(torque=100.0, speed=1000.0, **({key: 1.0} if is_set else {}))
        loaded = replace(design, load=load)
        assert told(loaded.to_dict()["assumed"], "load", key) is not is_set
        assert all(text.endswith("(assumed)") is not is_set for text in shown(loaded, "load", key))
        if key == "application_factor":
            comments = " ".join(MeshPairs(design=loaded).texts.values())
            assert ("K_A 1 (assumed)" in comments) is not is_set


@pytest.mark.parametrize(("key", "value"), [("lubrication", "dip"), ("bearing_arrangement", "a")])
def test_choices_that_nobody_made_are_told(key: str, value: str, tmp_path: Path) -> None:
    """What a choice says of the machine is assumed where it is not made, and changes nothing else."""
    shaft = "[rating]\nbearing_span = 100.0\npinion_offset = 10.0\nshaft_diameter = 50.0\nscuffing_stage = 12\n"
    found = []
    for line in ("", f"{key} = '{value}'\n"):
        path = tmp_path / "it.toml"
        path.write_text(spec([]).replace("[rating]\n", shaft + line), encoding="utf-8")
        found.append(Rate(report=False).run(read(path)).to_dict())
    assert [told(each["assumed"], "rating", key) for each in found] == [True, False]
    assert found[0]["factors"] == found[1]["factors"] and found[0]["scuffing"]["flash"] == found[1]["scuffing"]["flash"]


@pytest.mark.parametrize("given", [False, True])
def test_the_page_shows_the_marks(tmp_path: Path, given: bool) -> None:
    """In its words, and as values that a browser can have: its encoder takes no numbers of other classes."""
    orjson = pytest.importorskip("orjson")
    design = made(tmp_path, ASSUMED if given else [])
    for language, word in zip(PageLanguage, ("assumed", "angenommen"), strict=True):
        for found in (sheet_figures(design), strength_figures(design)):
            shown = orjson.dumps(shown_figures(found, PageWords.of(language), kept=found)).decode()
            assert (f"({word})" in shown) is not given
