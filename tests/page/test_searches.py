"""Searches as runs of the page: they find what the commands find, and write the same files."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support.commands import invoke
from support.specs import TEMPLATES

from gearcad.cli.size import size as size_command
from gearcad.core.errors import ParameterError, SpecError
from gearcad.core.quantities import schema_of
from gearcad.core.units import UnitSystem
from gearcad.designs import PairDesign, read_spec
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.designs.reader import edit_spec, starter_text
from gearcad.designs.table import open_table
from gearcad.identify.measurements import Measurements
from gearcad.jobs.size_options import SIZE_OPTIONS, option_fields
from gearcad.jobs.strength import Rate
from gearcad.page.charts import CURSOR, FOUND, map_chart, nearest, pairs_chart
from gearcad.page.forms import fields_in, form_fields, missing_keys, options_of, usual_text
from gearcad.page.panels.table import read_results
from gearcad.page.run_process import design_of
from gearcad.page.runs import Run, Runs, RunState, download_file
from gearcad.page.searches import MOST_CELLS, SEARCHES, figures_of, study_axes, study_cells
from gearcad.page.workbench import Workbench
from gearcad.rating.strength import rate_strength

ENOUGH = 120.0
REDUCER = starter_text("reducer")[1]
TASK = {"torque": "100", "speed": "1500", "ratio": "2", "life": "1e4", "material": "Eh MQ", "wheel_material": "V MQ"}
TASK |= {"wheel_hardness": "320", "safety_flank": "0.5", "count": "3"}
RANGES = {"teeth": "17:20", "module": "2,2.5", "helix_angle": "0,15", "width_ratio": "0.8,1", "shift": "0.2:0.6:0.2"}
RANGES |= {"shift_sum": "0.5"}
SET_TASK = {"input_torque": "300", "speed": "1500", "ratio": "5.2", "life": "20000", "material": "Eh MQ", "planets": "3"}
SET_TASK |= {"module": "2,2.5", "teeth": "20:34", "ring_teeth": "80:90", "count": "2"}
READINGS = {"teeth": "24", "tip_diameter": "52.02", "root_diameter": "43.01", "span": "3:15.40; 4:21.30", "helix_angle": "0"}


@pytest.fixture
def runs() -> Iterator[Runs]:
    made = Runs()
    yield made
    made.close()


def done(runs: Runs, kind: str, options: dict[str, Any], text: str = "", name: str = "new") -> Run:
    run = runs.start(kind, text, name, Path(), {}, options)
    assert run.ended.wait(ENOUGH)
    assert run.state is RunState.DONE, run.line
    return run


# ---------------------------------------------------------------------- sizes


def test_pairs_are_those_of_the_command_and_so_are_their_files(runs: Runs, tmp_path: Path) -> None:
    run = done(runs, "size", options_of("size", TASK | RANGES, comma=False))
    words = [word for key, text in (TASK | RANGES).items() for word in (f"--{key.replace('_', '-')}", text)]
    told = invoke("size", *words, "--errors", "0", "-o", str(tmp_path), "--quiet")
    assert told.exit_code == 0, told.output
    for name in ("best.toml", "pairs.csv", "front.csv", "size.json"):
        assert (found := run.file(name)) is not None
        assert found.read_bytes() == (tmp_path / name).read_bytes(), name
    document = json.loads((tmp_path / "size.json").read_text(encoding="utf-8"))
    rows = run.found["rows"]
    assert [row["name"] for row in rows] == [each["name"] for each in document["found"]]
    assert [row["mass"] for row in rows] == [each["mass"] for each in document["found"]]
    assert rows[0]["text"] == (tmp_path / "best.toml").read_text(encoding="utf-8")
    assert len(run.found["cloud"]) > 3
    assert download_file(run)[0] == "pairs-size.zip"


def test_a_pair_that_is_taken_is_the_row_of_the_table_and_is_rated_at_once(runs: Runs) -> None:
    run = done(runs, "size", options_of("size", TASK | RANGES, comma=False))
    table = run.file("pairs.csv")
    assert table is not None
    for row, written in zip(run.found["rows"], open_table(table).rows(), strict=True):
        design, same = design_of(row["text"], "x", Path()), written.design()
        assert isinstance(design, PairDesign) and isinstance(same, PairDesign)
        assert design.name == row["name"] and design.pair.to_dict() == same.pair.to_dict()
        assert design.load is not None and (design.load.torque, design.load.speed) == (100.0, 1500.0)
        assert design.rating is not None and design.rating.life == 1e4
        rated = rate_strength(design.pair, design.materials, design.load, design.rating)
        assert rated.passed
        assert min(each.safety for each in rated.flank) == pytest.approx(row["S_H"], rel=1e-9)
    for row in run.found["front"]:
        assert design_of(row["text"], "x", Path()).name == row["name"]


def test_sets_are_those_of_the_command_and_so_are_their_files(runs: Runs, tmp_path: Path) -> None:
    run = done(runs, "size-sets", options_of("size-sets", SET_TASK, comma=False))
    words = [word for key, text in SET_TASK.items() for word in (f"--{key.replace('_', '-')}", text)]
    told = invoke("size", "--planetary", *words, "-o", str(tmp_path), "--quiet")
    assert told.exit_code == 0, told.output
    for name in ("best.toml", "sets.csv", "size.json"):
        assert (found := run.file(name)) is not None
        assert found.read_bytes() == (tmp_path / name).read_bytes(), name
    document = json.loads((tmp_path / "size.json").read_text(encoding="utf-8"))
    rows = run.found["rows"]
    assert [(row["name"], row["mass"], row["K_gamma"]) for row in rows] == [
        (each["name"], each["mass"], each["K_gamma"]) for each in document["found"]
    ]
    assert rows[0]["text"] == (tmp_path / "best.toml").read_text(encoding="utf-8")
    for row, rated in zip(rows, document["found"], strict=True):
        design = design_of(row["text"], "x", Path())
        assert isinstance(design, PlanetaryDesign) and design.train.planets == row["planets"] == 3
        assert row["S_H"] == rated["safety"]["flank"] and row["i"] == pytest.approx(5.2, rel=0.01)


@pytest.mark.parametrize(
    ("typed", "key"),
    [
        ({"ratio": "0"}, "ratio"),
        ({"ratio_tolerance": "-1"}, "ratio_tolerance"),
        ({"wheel_hardness": "-5"}, "wheel_hardness"),
        ({"planets": "0"}, "planets"),
        ({"fixed": "carrier", "in": "carrier"}, None),
        ({"output_torque": "100"}, None),
    ],
)
def test_what_no_set_can_have_is_said_at_its_field(typed: dict[str, str], key: str | None) -> None:
    with pytest.raises(ParameterError) as found:
        options_of("size-sets", SET_TASK | typed, comma=False)
    assert found.value.parameter in {field.key for field in form_fields("size-sets")}
    assert key in (None, found.value.parameter)


def test_a_torque_on_the_output_stands_for_that_on_the_input() -> None:
    assert missing_keys("size-sets", {"speed": "1", "ratio": "5", "material": "Eh MQ"}) == ["input_torque"]
    assert not missing_keys("size-sets", {"speed": "1", "ratio": "5", "material": "Eh MQ", "output_torque": "9"})


def test_where_nothing_is_found_the_run_says_what_would_help(runs: Runs) -> None:
    run = done(runs, "size", options_of("size", TASK | RANGES | {"max_diameter": "20"}, comma=False))
    assert run.line.startswith("No pair of ") and not run.found["rows"]
    assert any("a larger max-diameter" in each for each in run.notices)
    assert run.files == ("size.json",)


# ---------------------------------------------------------------------- a measured gear


def test_a_measured_gear_is_that_of_the_command(runs: Runs, tmp_path: Path) -> None:
    run = done(runs, "identify", options_of("identify", READINGS, comma=False))
    words = ["--teeth", "24", "--tip-diameter", "52.02", "--root-diameter", "43.01", "--span", "3:15.40", "--span", "4:21.30"]
    for place, row in enumerate(run.found["rows"], 1):
        path = tmp_path / f"{place}" / "identified.toml"
        path.parent.mkdir()
        told = invoke("identify", *words, "--helix-angle", "0", "--candidate", str(place), "--write", str(path))
        assert told.exit_code == 0, told.output
        assert row["text"] == path.read_text(encoding="utf-8")
    assert run.line == "Certain: all others together are less probable than 5 %"
    assert (run.found["rows"][0]["normal_module"], run.found["rows"][0]["pressure_angle"]) == (2.0, 20.0)


# ---------------------------------------------------------------------- modifications


@pytest.mark.long
def test_modifications_are_those_of_the_command(runs: Runs, tmp_path: Path) -> None:
    spec = tmp_path / "reducer-21-43.toml"
    spec.write_text(REDUCER, encoding="utf-8")
    told = invoke("modify", str(spec), "--shape", "linear", "-o", str(tmp_path / "out.toml"), "--quiet")
    assert told.exit_code == 0, told.output
    run = done(runs, "modify", options_of("modify", {"shape": "linear"}, comma=False), REDUCER, "reducer-21-43")
    assert run.found["text"] == (tmp_path / "out.toml").read_text(encoding="utf-8")
    assert (written := run.file("reducer-21-43-modified.toml")) is not None
    assert written.read_text(encoding="utf-8") == run.found["text"]
    assert run.found["after"]["transmission_error_peak_to_peak"] < run.found["before"]["transmission_error_peak_to_peak"]


# ---------------------------------------------------------------------- a map


def test_a_cell_of_a_map_has_what_the_command_has_for_its_values(runs: Runs) -> None:
    vary = ["pair.face_width=20:30:3", "pair.centre_distance=60:97:2"]
    run = done(runs, "study", {"vary": vary, "result": "rate.S_H_min"}, REDUCER, "reducer-21-43")
    found = run.found
    assert (found["xs"], found["ys"], len(found["cells"])) == ([20.0, 25.0, 30.0], [60.0, 97.0], 6)
    for column, line, value, why in found["cells"]:
        text = edit_spec(REDUCER, {found["across"]: found["xs"][column], found["up"]: found["ys"][line]})
        if line == 0:
            assert value is None and "centre_distance" in why
            with pytest.raises(SpecError):
                design_of(text, "x", Path())
            continue
        job = Rate()
        rated = job.document(job.run(design_of(text, "x", Path())))
        assert value == pytest.approx(min(rated["safety"]["flank"].values()), rel=1e-12) and not why


def test_the_table_of_a_map_has_every_other_result_too(runs: Runs) -> None:
    vary = ["pair.face_width=20:30:3", "load.torque=100,200"]
    run = done(runs, "study", {"vary": vary, "result": "rate.S_H_min"}, REDUCER, "reducer-21-43")
    path = run.file("study.csv")
    assert path is not None
    table = read_results(path.read_text(encoding="utf-8"), "study.csv")
    assert len(table.rows) == 6 and "rate.S_F_min" in table.numbers
    axes = {run.found["across"]: run.found["xs"], run.found["up"]: run.found["ys"]}
    again = study_cells(path, axes, "rate.S_H_min")
    assert [list(each) for each in again] == run.found["cells"]
    for column, _, value, _ in study_cells(path, axes, "pair.gear_ratio"):
        assert value == pytest.approx(43 / 21) and column in (0, 1, 2)


@pytest.mark.parametrize(
    ("vary", "line"),
    [
        (["pair.face_width=20:30:3"], "must be 2 keys"),
        (["pair.face_width=20:30:60", "load.torque=1:2:60"], f"must make at most {MOST_CELLS} designs"),
        (["pair.nothing=1,2", "load.torque=1,2"], "unknown"),
        (["pair.face_width=1,2", "pair.face_width=1,3"], "more than once"),
    ],
)
def test_what_is_no_map_is_refused_before_a_run(vary: list[str], line: str) -> None:
    bench = Workbench(REDUCER, "reducer", Path())
    with pytest.raises(ParameterError, match=line):
        study_axes(bench.design, bench.tables, vary)


@pytest.mark.parametrize("starter", ["spur", "planetary-24-21-66", "rack", "volvo-13-44"])
def test_every_kind_of_design_has_figures_for_a_map(starter: str) -> None:
    figures = figures_of(read_spec(TEMPLATES / starter_text(starter)[0]))
    assert len(figures) > 20
    assert all(isinstance(value, float) for value in figures.values())


# ---------------------------------------------------------------------- forms


def test_forms_have_every_option_of_the_commands() -> None:
    of_sets = {"planetary", "type", "planets", "input_torque", "output_torque", "ring_teeth", "fixed", "in", "out"}
    others = {"mesh_load_factor", "output", "as_json", "quiet", "debug"}
    options = {parameter.name for parameter in size_command.params} - of_sets - others
    assert {field.key for field in form_fields("size")} == options
    assert {field.key for field in form_fields("identify")} == {*schema_of(Measurements), "candidates"}
    assert all(field.words for kind in ("size", "identify", "modify") for field in form_fields(kind))


def test_options_have_words_and_units_of_the_fields_that_they_set() -> None:
    fields = {field.key: field for field in form_fields("size")}
    for option in SIZE_OPTIONS:
        if option.field:
            symbol = option_fields()[option.name].symbol
            assert (fields[option.name].words, fields[option.name].symbol) == (symbol.words, symbol.symbol)
    assert fields["torque"].unit == "N·m" and fields["centre_distance"].unit == "mm"


def test_numbers_may_have_a_comma_and_lists_then_have_semicolons() -> None:
    typed = TASK | {"ratio": "2,5", "module": "2; 2,5", "shift": "0,2:0,6:0,2", "speed": "\N{MINUS SIGN}1500"}
    given = options_of("size", typed, comma=True)
    assert (given["ratio"], given["module"], given["shift"], given["speed"]) == (2.5, "2,2.5", "0.2:0.6:0.2", -1500.0)
    assert options_of("size", TASK | {"module": "2,2.5"}, comma=False)["module"] == "2,2.5"
    given = options_of("identify", READINGS | {"span": "3:15,40 4:21,30+-0,05"}, comma=True)
    assert given["sized"]["span"] == [(3, 15.4), (4, (21.3, 0.05))]


def test_what_an_empty_field_stands_for_is_shown_as_it_would_be_typed() -> None:
    fields = {field.key: field for field in form_fields("size")}
    assert usual_text(fields["helix_angle"], comma=True) == "0; 8:24:2"
    assert usual_text(fields["shift"], comma=True) == "0:0,7:0,1"
    typed = {key: usual_text(fields[key], comma=True) for key in ("helix_angle", "shift", "teeth", "safety_root")}
    given = options_of("size", TASK | typed, comma=True)
    assert (given["helix_angle"], given["shift"], given["safety_root"]) == ("0,8:24:2", "0:0.7:0.1", 1.4)


@pytest.mark.parametrize(
    ("kind", "typed", "key", "line"),
    [
        ("size", TASK | {"torque": "x"}, "torque", "must be a number"),
        ("size", TASK | {"torque": "nan"}, "torque", "must be a number"),
        ("size", TASK | {"ratio": "55"}, "ratio", "at most 20"),
        ("size", TASK | {"material": "V MQ"}, "hardness", "HV"),
        ("size", TASK | {"wheel_hardness": "9"}, "wheel_hardness", "at least 50"),
        ("size", TASK | {"material": "<b>x</b>"}, "material", "must be a group and a quality"),
        ("size", TASK | {"module": "1:10:0.0000001"}, "module", "must"),
        ("size", TASK | {"teeth": "5:500", "shift": "0:2:0.004", "ratio_tolerance": "50"}, "ranges", "variants"),
        ("size", TASK | {"count": "100000"}, "count", "from 1 to 100"),
        ("size", TASK | {"rating": "nothing=3"}, "rating", "KEY=VALUE"),
        ("size", TASK | {"by": "beauty"}, "by", "must"),
        ("size", TASK | {"teeth": "1" * 300}, "teeth", "at most 200 characters"),
        ("identify", {"tip_diameter": "5"}, "teeth", "must be given"),
        ("identify", READINGS | {"span": "15.4"}, "span", "3:15.40"),
        ("identify", READINGS | {"span": "99:15.4"}, "span", "must be a whole number"),
        ("identify", READINGS | {"tip_diameter": "-5"}, "tip_diameter", "must be"),
        ("modify", {"pressure": "-5"}, "pressure", "must be"),
        ("modify", {"shape": "round"}, "shape", "must be"),
    ],
)
def test_what_is_wrong_is_told_at_its_field_before_a_run(kind: str, typed: dict[str, str], key: str, line: str) -> None:
    with pytest.raises(ParameterError, match=line) as told:
        options_of(kind, typed, comma=False)
    assert told.value.parameter == key


def test_fields_that_must_be_filled_in() -> None:
    assert missing_keys("size", {"speed": "3"}) == ["torque", "ratio", "material"]
    assert missing_keys("size", {"speed": "3", "power": "2", "ratio": "2", "material": "Eh MQ"}) == []
    assert missing_keys("identify", {}) == ["teeth"] and missing_keys("modify", {}) == []


def test_options_of_searches_can_be_sent_to_a_process() -> None:
    for kind, typed in (
        ("size", TASK),
        ("size-sets", SET_TASK),
        ("identify", READINGS),
        ("modify", {"torque": "5", "shape": "linear"}),
    ):
        options = options_of(kind, typed, comma=False)
        assert json.loads(json.dumps(options)).keys() == options.keys()
    assert list(SEARCHES) == ["size", "size-sets", "modify", "identify", "study"]


INCHES = {
    "size": (
        {
            "torque": "885.0745791",
            "speed": "1500",
            "ratio": "2",
            "material": "Eh MQ",
            "centre_distance": "4",
            "module": "2,2.5",
        },
        {"torque": pytest.approx(100.0), "centre_distance": 101.6, "module": "2,2.5", "speed": 1500.0},
    ),
    "identify": (
        {"teeth": "24", "tip_diameter": "2.0480±0.0010", "span": "3:.6063; 4:0.8386", "over_pins": "0.1378:2.2130"},
        {
            "tip_diameter": [52.0192, 0.0254],
            "sized": {"span": [[3, 15.40002], [4, 21.30044]], "over_pins": [[3.50012, 56.2102]]},
        },
    ),
    "modify": ({"torque": "88.50745791", "pressure": "145.03773773"}, {"torque": 10.0, "pressure": 1000.0}),
}
"""What is typed in inches and pounds, and the options that it means: 1 N·m is 8.850745791 lbf·in, 1 ksi 6.894757293 MPa."""


@pytest.mark.parametrize("kind", INCHES)
def test_what_is_typed_in_inches_are_options_in_millimetres(kind: str) -> None:
    typed, expected = INCHES[kind]
    options = json.loads(json.dumps(options_of(kind, typed, comma=False, units=UnitSystem.INCH)))
    for key, value in expected.items():
        if key == "sized":
            assert options[key].keys() == value.keys()
            for gauge, pairs in value.items():
                assert options[key][gauge] == [pytest.approx(pair) for pair in pairs]
        else:
            assert options[key] == (value if isinstance(value, str) else pytest.approx(value)), key


def test_fields_in_inches_have_their_units_and_modules_stay() -> None:
    fields = {field.key: field for field in fields_in("size", UnitSystem.INCH)}
    assert (fields["centre_distance"].unit, fields["torque"].unit, fields["module"].unit) == ("in", "lbf·in", "mm")
    assert fields["module"].usual == "1:10"
    readings = {field.key: field for field in fields_in("identify", UnitSystem.INCH)}
    assert (readings["span"].usual, readings["over_pins"].usual) == ("K:in", "D:in")
    assert float(readings["uncertainty"].usual) == pytest.approx(0.02 / 25.4, rel=1e-6)
    assert fields_in("size", UnitSystem.METRIC) == form_fields("size")


# ---------------------------------------------------------------------- charts


def test_points_of_pairs_can_be_taken_and_the_cloud_cannot() -> None:
    row = {"margin": 1.01, "mass": 2.0, "name": "20-40-m2-h0"}
    found = {"rows": [row, row | {"name": "other", "mass": 3.0}], "front": [row], "cloud": [[1.0, 2.0], [1.5, 3.0]]}
    chart = pairs_chart(found, "other", {"margin": "m", "mass": "kg"}, comma=True)
    series = {each["name"]: each for each in chart["series"]}
    assert series[FOUND]["data"] == [[1.01, 2.0, "20-40-m2-h0", 0], [1.01, 3.0, "other", 1]]
    assert series["taken"]["data"][0][:3] == [1.01, 3.0, "other"]
    assert series["cloud"]["silent"] and len(series["cloud"]["data"]) == 2


def test_the_present_design_is_marked_in_the_nearest_cell_of_a_map() -> None:
    found = {"xs": [1.0, 2.0, 3.0], "ys": [10, 20], "cells": [[0, 0, 5.0, ""], [1, 1, None, "why"]], "result": "r"}
    chart = map_chart(found, (2.2, 20.0), {"across": "a", "up": "b"}, comma=False)
    cells, present, cursor = chart["series"]
    assert (cursor["name"], cursor["data"]) == (CURSOR, [])
    assert cells["data"] == [[0, 0, 5.0], [1, 1, "-"]] and present["data"] == [[1, 1]]
    assert nearest([1.0, 2.0], 9.0) is None and nearest(["a", "b"], 1.0) is None and nearest([1.0, 2.0], float("nan")) is None


def test_specs_of_pairs_are_toml_with_their_task_in_comments(runs: Runs) -> None:
    run = done(runs, "size", options_of("size", TASK | RANGES | {"count": "2"}, comma=False))
    first, second = (row["text"].splitlines()[0] for row in run.found["rows"])
    assert first == "# 100 N·m at 1500 rpm, u = 2, 10000 h: best by mass" and second.endswith("number 2 by mass")
    assert tomllib.loads(run.found["rows"][1]["text"])["load"] == {"torque": 100.0, "speed": 1500.0}
