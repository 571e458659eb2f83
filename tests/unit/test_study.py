"""Parameter studies: which rows a table gets, how they are written, and which variations are refused."""

import csv
import itertools
import tracemalloc
import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from gearcad import ParameterError, SpecError
from gearcad.batch.study import Method, Sample, Study, check_table, plan_study, write_study
from gearcad.designs import open_table, read_spec
from gearcad.designs.design import require_plain_name
from gearcad.designs.reader import starter_text

_, VOLVO = starter_text("volvo")
_, SPUR = starter_text("spur")

BASE_KEYS = (
    "pair.normal_module pair.helix_angle pair.centre_distance pair.centre_distance_tolerance "
    "pinion.teeth pinion.profile_shift pinion.face_width pinion.tooth_thinning "
    "pinion.tooth_allowance pinion.rack.root_radius pinion.body.bore "
    "wheel.teeth wheel.profile_shift wheel.face_width wheel.tooth_thinning "
    "wheel.tooth_allowance wheel.rack.root_radius wheel.body.bore "
    "material.name material.group material.youngs_modulus material.contact_limit material.root_limit load.torque"
).split()
"""What the reference pair's spec says, in its order."""


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    path = tmp_path / "volvo-13-44.toml"
    path.write_text(VOLVO, encoding="utf-8")
    return path


def written(study: Study, folder: Path) -> Path:
    path = folder / "table.csv"
    write_study(study, path)
    return path


def column(study: Study, key: str) -> list[str]:
    """The cells under one key."""
    place = ("name", *study.keys).index(key)
    return [line[place] for line in study.lines()]


def drawn(spec: Path, variation: str, method: Method, rows: int, seed: int = 0) -> list[str]:
    study = plan_study(spec, [variation], Sample(method=method, rows=rows, seed=seed))
    return column(study, study.variations[0].key)


# ---------------------------------------------------------------------- every combination


def test_every_combination_is_a_row_and_the_last_key_changes_fastest(spec: Path) -> None:
    study = plan_study(spec, ["helix_angle=26,27.5", "pinion.teeth=12:14:3"])
    assert study.rows == 6
    rows = list(zip(column(study, "name"), column(study, "pair.helix_angle"), column(study, "pinion.teeth"), strict=True))
    combinations = itertools.product(("26.0", "27.5"), ("12", "13", "14"))
    assert rows == [(f"volvo-13-44-{number}", *point) for number, point in enumerate(combinations, 1)]


def test_columns_are_those_of_the_spec_then_what_is_new(spec: Path) -> None:
    study = plan_study(spec, ["pinion.body.end_chamfer=0.5", "wheel.profile_shift=auto", "axial_offset=0:1:2"])
    assert list(study.keys) == [*BASE_KEYS, "pinion.body.end_chamfer", "pair.axial_offset"]
    first = dict(zip(study.keys, next(iter(study.lines()))[1:], strict=True))
    assert first["wheel.profile_shift"] == "auto"
    assert (first["pinion.teeth"], first["pair.centre_distance"], first["load.torque"]) == ("13", "80.0", "220.0")


@pytest.mark.parametrize(
    ("variation", "cells"),
    [
        ("-0.2:0.6:9", "-0.2 -0.1 0.0 0.1 0.2 0.3 0.4 0.5 0.6"),
        ("0.6:-0.2:5", "0.6 0.4 0.2 0.0 -0.2"),
        ("0:1:4", "0.0 0.3333333333333333 0.6666666666666666 1.0"),
        ("1e-7:3e-7:3", "1e-07 2e-07 3e-07"),
        ("-0,0.5", "0.0 0.5"),
        (" 1 , auto ", "1.0 auto"),
    ],
)
def test_values_are_the_nearest_to_the_true_ones(variation: str, cells: str, spec: Path) -> None:
    assert column(plan_study(spec, [f"pinion.profile_shift={variation}"]), "pinion.profile_shift") == cells.split()


@settings(max_examples=50, deadline=None)
@given(first=st.floats(-100, 100), last=st.floats(-100, 100), count=st.integers(2, 40))
def test_a_range_has_its_ends_and_goes_one_way(
    first: float, last: float, count: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    assume(len({first + step * (last - first) / (count - 1) for step in range(count)}) == count)
    path = tmp_path_factory.mktemp("spec") / "volvo.toml"
    path.write_text(VOLVO, encoding="utf-8")
    values = [
        float(cell) for cell in column(plan_study(path, [f"axial_offset={first!r}:{last!r}:{count}"]), "pair.axial_offset")
    ]
    assert (values[0], values[-1], len(values)) == (first, last, count)
    assert values == sorted(values, reverse=first > last)


def test_a_row_is_the_design_of_the_spec_with_the_values_put_in(spec: Path, tmp_path: Path) -> None:
    study = plan_study(spec, ["wheel.profile_shift=auto", "pinion.profile_shift=0.05,0.107", "helix_angle=27:29:3"])
    rows = list(open_table(written(study, tmp_path)).rows())
    assert [row.name for row in rows] == [f"volvo-13-44-{number}" for number in range(1, 7)]
    by_hand = VOLVO.replace("-0.378", '"auto"').replace("0.107 ", "0.05 ").replace("28.0 ", "29.0 ")
    spec.write_text(by_hand.replace('"volvo-13-44"', '"volvo-13-44-3"'), encoding="utf-8")
    assert rows[2].design() == read_spec(spec)


def test_a_gears_bare_key_is_one_of_the_gear(tmp_path: Path) -> None:
    path = tmp_path / "spur.toml"
    path.write_text(SPUR, encoding="utf-8")
    study = plan_study(path, ["teeth=20:40:3", "rack=ISO53_A,ISO53_C", "body.end_chamfer=0.5"])
    assert [variation.key for variation in study.variations] == ["gear.teeth", "gear.rack", "gear.body.end_chamfer"]
    designs = [row.design() for row in open_table(written(study, tmp_path)).rows()]
    assert [design.gear.teeth for design in designs if design.gear] == [20, 20, 30, 30, 40, 40]
    assert [design.gear.rack.root_radius for design in designs[:2] if design.gear] == [0.38, 0.25]


def test_texts_stay_as_they_are_and_no_spreadsheet_runs_them(spec: Path, tmp_path: Path) -> None:
    study = plan_study(spec, ["material.name=1.0570,=1+1,@x,42:7"])
    assert column(study, "material.name") == ["1.0570", "'=1+1", "'@x", "42:7"]
    names = [row.design().material for row in open_table(written(study, tmp_path)).rows()]
    assert [material.name for material in names if material] == ["1.0570", "=1+1", "@x", "42:7"]


def test_one_text_with_colons_is_a_name_where_texts_are_meant(spec: Path) -> None:
    assert column(plan_study(spec, ["material.name=a:b:3"]), "material.name") == ["a:b:3"]


# ---------------------------------------------------------------------- names


@pytest.mark.parametrize("name", ["x", "n" * 100, "歯" * 66, "é" * 100, "two words. and more", "=1+1"])
def test_names_are_numbered_plain_file_names(name: str, spec: Path) -> None:
    spec.write_text(VOLVO.replace('"volvo-13-44"', f'"{name}"'), encoding="utf-8")
    study = plan_study(spec, ["helix_angle=20:29:10", "axial_offset=0:9:10"])
    names = [cell.removeprefix("'") for cell in column(study, "name")]
    assert len({each.casefold() for each in names}) == 100
    for number, each in enumerate(names, 1):
        require_plain_name(each)
        stem, _, digits = each.rpartition("-")
        assert name.startswith(stem) and digits == f"{number:03d}"


def test_a_spec_without_a_name_lends_that_of_its_file(spec: Path) -> None:
    spec.write_text(VOLVO.replace('name = "volvo-13-44"', ""), encoding="utf-8")
    assert column(plan_study(spec, ["helix_angle=20"]), "name") == ["volvo-13-44-1"]


def test_a_name_that_would_make_comments_of_the_rows_is_refused(spec: Path) -> None:
    spec.write_text(VOLVO.replace('"volvo-13-44"', '"#1"'), encoding="utf-8")
    with pytest.raises(ParameterError, match="name = '#1': must not begin with #"):
        plan_study(spec, ["helix_angle=20"])


# ---------------------------------------------------------------------- samples


@pytest.mark.parametrize("method", Method)
@pytest.mark.parametrize("ends", ["-0.2:0.6", "0.6:-0.2"])
def test_every_stratum_of_a_range_has_one_point(method: Method, ends: str, spec: Path) -> None:
    """What defines a Latin hypercube holds for a Sobol sequence of 2^m points as well."""
    values = [float(cell) for cell in drawn(spec, f"pinion.profile_shift={ends}", method, 64)]
    assert sorted(int((value + 0.2) / 0.8 * 64) for value in values) == list(range(64))


@pytest.mark.parametrize("method", Method)
def test_whole_numbers_and_listed_values_are_drawn_evenly(method: Method, spec: Path) -> None:
    assert Counter(drawn(spec, "pinion.teeth=12:15", method, 64)) == {"12": 16, "13": 16, "14": 16, "15": 16}
    assert Counter(drawn(spec, "wheel.teeth=-12:-15", method, 64)) == {"-12": 16, "-13": 16, "-14": 16, "-15": 16}
    assert Counter(drawn(spec, "helix_angle=10,20", method, 64)) == {"10.0": 32, "20.0": 32}


@pytest.mark.parametrize("method", Method)
def test_a_seed_says_all(method: Method, spec: Path, tmp_path: Path) -> None:
    def table(seed: int) -> bytes:
        sample = Sample(method=method, rows=50, seed=seed)
        return written(plan_study(spec, ["helix_angle=20:30", "pinion.teeth=12:15"], sample), tmp_path).read_bytes()

    assert table(0) == table(0)
    assert table(0).splitlines()[6:] != table(1).splitlines()[6:]


def test_a_sobol_sample_of_any_size_begins_like_the_longer_one_and_does_not_warn(spec: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        some, all_of_them = (drawn(spec, "helix_angle=20:30", Method.SOBOL, rows) for rows in (100, 128))
    assert some == all_of_them[:100]


def test_blocks_of_a_large_sample_join(spec: Path) -> None:
    """More rows than are turned into values at a time, each still in its own stratum."""
    values = [float(cell) for cell in drawn(spec, "helix_angle=0:1", Method.LATIN_HYPERCUBE, 5000)]
    assert sorted(int(value * 5000) for value in values) == list(range(5000))


@settings(max_examples=30, deadline=None)
@given(first=st.floats(-1e6, 1e6), last=st.floats(-1e6, 1e6), method=st.sampled_from(Method), seed=st.integers(0, 2**32 - 1))
def test_a_sample_stays_between_the_ends(
    first: float, last: float, method: Method, seed: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    assume(first != last)
    path = tmp_path_factory.mktemp("spec") / "volvo.toml"
    path.write_text(VOLVO, encoding="utf-8")
    cells = drawn(path, f"axial_offset={first!r}:{last!r}", method, 16, seed)
    assert all(min(first, last) <= float(cell) <= max(first, last) for cell in cells)
    assert "-0.0" not in cells


# ---------------------------------------------------------------------- the file


def test_the_head_says_what_the_table_is(spec: Path, tmp_path: Path) -> None:
    text = written(plan_study(spec, ["wheel.profile_shift=auto", "helix_angle=26,27"]), tmp_path).read_bytes().decode()
    assert "\r" not in text
    assert text.splitlines()[:6] == [
        "# A study of volvo-13-44 (volvo-13-44.toml): 2 rows.",
        "# Every combination of these values; the last key changes fastest:",
        "#   wheel.profile_shift = auto",
        '"#   pair.helix_angle = 26,27"',
        "# Next: gearcad batch table.csv",
        ",".join(["name", *BASE_KEYS]),
    ]


def test_the_head_of_a_sample_names_method_and_seed(spec: Path, tmp_path: Path) -> None:
    sample = Sample(method=Method.SOBOL, rows=8, seed=3)
    lines = written(plan_study(spec, ["helix_angle=20:30"], sample), tmp_path).read_text().splitlines()
    assert lines[:3] == [
        "# A study of volvo-13-44 (volvo-13-44.toml): 8 rows.",
        "# Drawn as a scrambled Sobol sequence (seed 3) from:",
        "#   pair.helix_angle = 20:30",
    ]


def test_a_large_study_is_written_row_by_row(spec: Path, tmp_path: Path) -> None:
    study = plan_study(spec, ["helix_angle=20:30:100", "pinion.profile_shift=0:0.5:200"])
    tracemalloc.start()
    path = written(study, tmp_path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert path.stat().st_size > 2_000_000
    assert peak < 500_000
    with path.open(newline="") as file:
        assert sum(1 for _ in csv.reader(file)) == 5 + 1 + 20_000


def test_a_table_that_cannot_be_finished_leaves_what_was_there(
    spec: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "table.csv"
    path.write_text("precious")

    def interrupted(_study: Study, _folder: Path) -> Iterator[list[str]]:
        yield ["x"]
        raise KeyboardInterrupt

    monkeypatch.setattr(Study, "lines", interrupted)
    with pytest.raises(KeyboardInterrupt):
        written(plan_study(spec, ["helix_angle=20"]), tmp_path)
    assert path.read_text() == "precious"
    assert sorted(each.name for each in tmp_path.iterdir()) == ["table.csv", "volvo-13-44.toml"]


def test_rows_that_make_no_gear_are_counted(spec: Path, tmp_path: Path) -> None:
    path = written(plan_study(spec, ["centre_distance=79,79.5,80,80.5"]), tmp_path)
    faulty, first = check_table(path)
    assert faulty == 2
    assert first.startswith(f"{path} row 6 column D (volvo-13-44-1): pair.centre_distance = 79 mm: must be at least 79.646")
    assert check_table(written(plan_study(spec, ["centre_distance=80,80.5"]), tmp_path)) == (0, "")


# ---------------------------------------------------------------------- what is refused

REFUSED = {
    "": "vary = '': must be KEY=FIRST:LAST:COUNT or KEY=VALUE,VALUE ...",
    "helix_angle": "vary = 'helix_angle': must be KEY=FIRST:LAST:COUNT or KEY=VALUE,VALUE ...",
    "=3": "vary = '=3': must be KEY=FIRST:LAST:COUNT or KEY=VALUE,VALUE ...",
    "teeth=3": "vary = 'teeth=3': unknown column; did you mean pinion.teeth or wheel.teeth?",
    "pinon.teeth=3": "vary = 'pinon.teeth=3': unknown column; did you mean pinion.teeth?",
    "pinion.teth=3": "vary = 'pinion.teth=3': unknown column; did you mean pinion.teeth?",
    "gear.teeth=3": "vary = 'gear.teeth=3': the spec makes a pair; "
    "permitted are keys of [pair], [pinion], [wheel], [material], [load], [mounting], [check], [mesh], [dynamics], "
    "[rating], [drawing], [verify], [modify]",
    "name=a": "vary = 'name=a': the study numbers the names itself; vary another key",
    "pair.name=a": "vary = 'pair.name=a': the study numbers the names itself; vary another key",
    "pinion.teeth=12:20:4": "vary = 'pinion.teeth=12:20:4': "
    "must make whole numbers of pinion.teeth, not 12, 14.66666667, 17.33333333, 20",
    "pinion.teeth=1:2:9": "vary = 'pinion.teeth=1:2:9': "
    "must make whole numbers of pinion.teeth, not 1, 1.125, 1.25, 1.375, 1.5, 1.625 ...",
    "pinion.teeth=12.5,auto": "vary = 'pinion.teeth=12.5,auto': must make whole numbers of pinion.teeth, not 12.5, 'auto'",
    "helix_angle=1:2": "vary = 'helix_angle=1:2': must be FIRST:LAST:COUNT in numbers",
    "helix_angle=1:b:3": "vary = 'helix_angle=1:b:3': must be FIRST:LAST:COUNT in numbers",
    "helix_angle=:2:3": "vary = 'helix_angle=:2:3': must be FIRST:LAST:COUNT in numbers",
    "helix_angle=1:nan:3": "vary = 'helix_angle=1:nan:3': must be FIRST:LAST:COUNT in numbers",
    "helix_angle=1:2:3:4": "vary = 'helix_angle=1:2:3:4': must be FIRST:LAST:COUNT in numbers",
    "helix_angle=1:2:1": "vary = 'helix_angle=1:2:1': must have a whole number from 2 to 1000000 as its count",
    "helix_angle=1:2:2.5": "vary = 'helix_angle=1:2:2.5': must have a whole number from 2 to 1000000 as its count",
    "helix_angle=1:2:1000001": "vary = 'helix_angle=1:2:1000001': must have a whole number from 2 to 1000000 as its count",
    "helix_angle=5:5.0:3": "vary = 'helix_angle=5:5.0:3': must not have the same number at both ends; for one value write 5",
    "helix_angle=1,,2": "vary = 'helix_angle=1,,2': must have a value on both sides of a comma",
    "helix_angle=1,2,1.0": "vary = 'helix_angle=1,2,1.0': must have each value once; 1 is there 2 times",
    "helix_angle=1e999": "pair.helix_angle = '1e999': must be a smaller number",
}


@pytest.mark.parametrize("variation", REFUSED)
def test_a_wrong_variation_is_one_line(variation: str, spec: Path) -> None:
    with pytest.raises(ParameterError) as caught:
        plan_study(spec, [variation])
    assert str(caught.value) == REFUSED[variation]


@pytest.mark.parametrize(
    ("variation", "message"),
    [
        ("helix_angle=1:2:3", "vary = 'helix_angle=1:2:3': must be FIRST:LAST in numbers; --n says how many rows"),
        ("pinion.teeth=12:14.5", "vary = 'pinion.teeth=12:14.5': must make whole numbers of pinion.teeth, not 12, 14.5"),
    ],
)
def test_a_variation_that_does_not_suit_a_sample_is_one_line(variation: str, message: str, spec: Path) -> None:
    with pytest.raises(ParameterError) as caught:
        plan_study(spec, [variation], Sample(method=Method.SOBOL, rows=8))
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("variations", "message"),
    [
        ([], "vary = '': must be given, such as helix_angle=10,20,28 or pinion.profile_shift=-0.2:0.6:9"),
        (
            ["helix_angle=1,2", "pair.helix_angle=3"],
            "vary = 'helix_angle=1,2': pair.helix_angle is varied more than once; put all its values in one --vary",
        ),
        (
            ["helix_angle=1:9:2000", "axial_offset=0:1:2000"],
            "rows = 4000000: must be at most 1000000; take fewer values, or a sample",
        ),
    ],
)
def test_wrong_variations_together_are_one_line(variations: list[str], message: str, spec: Path) -> None:
    with pytest.raises(ParameterError) as caught:
        plan_study(spec, variations)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("rows", "seed", "message"),
    [
        (0, 0, "n = 0: must be a whole number from 1 to 1000000"),
        (1_000_001, 0, "n = 1000001: must be a whole number from 1 to 1000000"),
        (1, -1, "seed = -1: must be a whole number from 0 to 4294967295"),
    ],
)
def test_a_wrong_sample_is_one_line(rows: int, seed: int, message: str) -> None:
    with pytest.raises(ParameterError) as caught:
        Sample(method=Method.SOBOL, rows=rows, seed=seed)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("teeth = 13", "teeth = [13]", "line 31: pinion.teeth = [13]: must be a number or a text"),
        ("teeth = 13", "teeth = true", "line 31: pinion.teeth = True: must be a number or a text"),
        ("teeth = 13", "teth = 13", "line 31: pinion.teth: unknown key; did you mean teeth?"),
    ],
)
def test_a_spec_that_no_table_can_hold_is_refused(old: str, new: str, message: str, spec: Path) -> None:
    spec.write_text(VOLVO.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(SpecError) as caught:
        plan_study(spec, ["helix_angle=20"])
    assert str(caught.value) == f"{spec} {message}"


def test_a_spec_that_makes_no_gear_yet_may_be_varied_into_one(spec: Path, tmp_path: Path) -> None:
    spec.write_text(VOLVO.replace("teeth = 13", "", 1), encoding="utf-8")
    path = written(plan_study(spec, ["pinion.teeth=12,13"]), tmp_path)
    pairs = [row.design().pair for row in open_table(path).rows()]
    assert [pair.pinion.teeth for pair in pairs if pair] == [12, 13]
