"""Trains in design tables and studies: keys of parts under their names, wildcards, and what is refused."""

import csv
from dataclasses import replace
from pathlib import Path

import pytest

from gearcad import ParameterError, SpecError
from gearcad.batch.study import Method, Sample, check_table, plan_study, write_study
from gearcad.designs import TrainDesign, open_table, read_spec
from gearcad.designs.reader import starter_text
from gearcad.designs.train_keys import TrainKey, general_key
from gearcad.designs.variations import column_symbol, spec_values

_, ONE_STAGE = starter_text("train-1-stage")

NAMES = ["a.b", 'x, "y"', "stage 1", "k=v", "a*b", "Ritzel ζ₁ 齿", "1", "[0]", "length", "p|q'", "=1+1", "#3"]
"""Names that a spec may have; the last dot of a key is the one before the part's own key."""

HEAD = "name,inertia.a.inertia,shaft.s.start,shaft.s.end,shaft.s.torsional_stiffness,inertia.b.inertia,"
MESH = "mesh.m.pinion,mesh.m.wheel,mesh.m.base_radii,mesh.m.stiffness,mesh.m.teeth"
ROW = "t,0.1,ground,a,1000,0.2,a,b,50 100,500,20"


def spec_of(folder: Path, text: str = ONE_STAGE) -> Path:
    path = folder / "train.toml"
    path.write_text(text, encoding="utf-8")
    return path


def train(path: Path) -> TrainDesign:
    design = read_spec(path)
    assert isinstance(design, TrainDesign)
    return design


def studied(path: Path, *variations: str, sample: Sample | None = None) -> list[TrainDesign]:
    """The designs of the rows of a study, by way of its file."""
    table = path.with_name("table.csv")
    write_study(plan_study(path, variations, sample), table)
    found = [row.design() for row in open_table(table).rows()]
    assert all(isinstance(each, TrainDesign) for each in found)
    return found  # type: ignore[return-value]


def faults(folder: Path, head: str, *rows: str) -> list[str]:
    path = folder / "t.csv"
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return [fault.removeprefix(str(folder) + "/") for row in open_table(path).rows() for fault in row.all_faults()]


def damping(design: TrainDesign) -> list[float]:
    return [shaft.damping_ratio for shaft in design.train.shafts]


# ---------------------------------------------------------------------- keys


@pytest.mark.parametrize("name", NAMES)
def test_a_key_is_its_table_name_and_own_key(name: str) -> None:
    for key in (TrainKey("shaft", name, "length"), TrainKey("mesh", name, "base_radii"), TrainKey("train", name, "torques")):
        assert TrainKey.of(str(key)) == key
    assert general_key(f"shaft.{name}.modes") == "shaft.*.modes"


@pytest.mark.parametrize(
    "key", ["mesh.elements", "shaft.length", "shaft..length", "shaft.a.lenght", "train.torques.", "pair.a.b"]
)
def test_what_is_no_key_of_a_train(key: str) -> None:
    assert TrainKey.of(key) is None
    assert general_key(key) == key


def test_columns_say_whose_they_are() -> None:
    owner, symbol = column_symbol("mesh.stage 1.stiffness") or ("", None)
    assert symbol is not None
    assert (owner, symbol.unit) == ("stage 1", "N/µm")
    found = column_symbol("dynamics.kv_highest.stage 1.5")
    assert found is not None and found[0] == "stage 1.5" and found[1].symbol == "K_v"
    assert (column_symbol("shaft.*.damping_ratio") or ("?",))[0] == "all shafts"
    assert column_symbol("dynamics.kv_highest_of.x") is None


# ---------------------------------------------------------------------- there and back


def test_a_row_is_the_train_of_the_spec_with_the_values_put_in(tmp_path: Path) -> None:
    path = spec_of(tmp_path)
    design = studied(path, "shaft.output.length=900,1100", "train.model=exact,modes", "dynamics.speed_to=9000")[2]
    text = ONE_STAGE.replace("length = 1000.0", "length = 1100.0").replace('"modes" ', '"exact" ').replace("16000.0", "9000.0")
    expected = train(spec_of(tmp_path, text))
    assert design == replace(expected, name="train-1-stage-3", train=replace(expected.train, name="train-1-stage-3"))


@pytest.mark.parametrize("name", NAMES)
def test_any_name_survives_a_table(name: str, tmp_path: Path) -> None:
    quoted = name.replace("\\", "\\\\").replace('"', '\\"')
    text = ONE_STAGE.replace('"pinion"', f'"{quoted}"').replace('"input"', f'"{quoted}"').replace('"mesh"', f'"{quoted}"')
    text = (
        text.replace("# [train.torques]", "[train.torques]")
        .replace("# pinion = ", f'"{quoted}" = ')
        .replace('name = "train-1-stage"        #', 'name = "t" #')
    )
    path = spec_of(tmp_path, text)
    (design,) = studied(path, f"shaft.{name}.length=750", f"mesh.{name}.teeth=18", f"train.torques.{name}=2256")
    expected = train(path)
    assert design.train == replace(expected.train, name="t-1")
    assert expected.train.torques == {name: 2256.0}


def test_headings_survive_a_workbook(tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    text = ONE_STAGE.replace('name = "mesh"', 'name = "stage 1.5"').replace(
        "backlash = 80.0", "backlash = 80.0\ninternal = true"
    )
    path = spec_of(tmp_path, text.replace("# backlash", "backlash"))
    table = tmp_path / "table.csv"
    write_study(plan_study(path, ["mesh.stage 1.5.base_radii=50.7 135.3,50 140"]), table)
    book = openpyxl.Workbook()
    for cells in csv.reader(table.open(encoding="utf-8")):
        book.active.append([_typed(cell) for cell in cells])
    book.save(tmp_path / "table.xlsx")
    rows = [list(open_table(tmp_path / name).rows()) for name in ("table.csv", "table.xlsx")]
    assert [row.design() for row in rows[0]] == [row.design() for row in rows[1]]
    second = rows[1][1].design()
    assert isinstance(second, TrainDesign)
    assert (tuple(second.train.meshes[0].base_radii), second.train.meshes[0].internal) == ((50.0, 140.0), True)


def _typed(cell: str) -> object:
    """As a spreadsheet reads it."""
    if cell in ("true", "false"):
        return cell == "true"
    try:
        return float(cell)
    except ValueError:
        return cell


def test_lists_stand_in_a_cell_with_spaces(tmp_path: Path) -> None:
    deviations = " ".join(str(number) for number in range(18))
    designs = studied(spec_of(tmp_path), f"mesh.mesh.pitch_deviations={deviations}", "mesh.mesh.base_radii=50 130,51 136")
    assert designs[0].train.meshes[0].pitch_deviations == tuple(map(float, range(18)))
    assert [tuple(design.train.meshes[0].base_radii) for design in designs] == [(50.0, 130.0), (51.0, 136.0)]


def test_blank_cells_leave_a_part_out(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text(f"{HEAD}{MESH}\n{ROW}\nu,0.1,,,,0.2,a,b,50 100,500,20\n")
    first, second = (row.design() for row in open_table(tmp_path / "t.csv").rows())
    assert isinstance(first, TrainDesign) and isinstance(second, TrainDesign)
    assert ([shaft.name for shaft in first.train.shafts], second.train.shafts) == (["s"], ())


# ---------------------------------------------------------------------- all of a kind


def test_what_varies_for_all_replaces_what_each_has(tmp_path: Path) -> None:
    designs = studied(spec_of(tmp_path), "shaft.*.damping_ratio=0.001,0.1")
    assert [damping(design) for design in designs] == [[0.001, 0.001], [0.1, 0.1]]


def test_what_a_part_has_of_its_own_goes_first(tmp_path: Path) -> None:
    designs = studied(spec_of(tmp_path), "shaft.*.damping_ratio=0.1", "shaft.output.damping_ratio=0.2,0.3")
    assert [damping(design) for design in designs] == [[0.1, 0.2], [0.1, 0.3]]


def test_what_stands_for_another_key_replaces_it(tmp_path: Path) -> None:
    path = spec_of(tmp_path)
    (design,) = studied(path, "mesh.*.damping_ratio=0.05", "shaft.input.torsional_stiffness=1e5")
    assert (design.train.meshes[0].damping, design.train.meshes[0].damping_ratio) == (None, 0.05)
    assert (design.train.shafts[0].torsional_stiffness, design.train.shafts[0].length) == (1e5, None)


@pytest.mark.parametrize("method", list(Method))
def test_samples_are_drawn(method: Method, tmp_path: Path) -> None:
    designs = studied(
        spec_of(tmp_path), "shaft.*.damping_ratio=0.01:0.1", "shaft.input.modes=1:3", sample=Sample(method=method, rows=8)
    )
    assert len({design.train.shafts[0].damping_ratio for design in designs}) == 8
    assert {design.train.shafts[0].modes for design in designs} == {1, 2, 3}


# ---------------------------------------------------------------------- faults


@pytest.mark.parametrize(
    ("variation", "message"),
    [
        ("shaft.inptu.length=1", "the train has no shaft inptu; did you mean shaft.input.length?"),
        ("shaft.xyz.length=1", "the train has no shaft xyz; it has input, output"),
        ("shaft.input.lenght=1", "unknown key; did you mean shaft.input.length?"),
        ("shaft.*.lenght=1", "unknown key; did you mean shaft.*.length?"),
        ("shfat.input.length=1", "unknown key; did you mean shaft.input.length?"),
        ("damping_ratio=1", "unknown key; did you mean shaft.*.damping_ratio or mesh.*.damping_ratio or "),
        ("modle=exact", "unknown key; did you mean train.model?"),
        ("pinion.teeth=3", "unknown key; did you mean mesh.*.teeth?"),
        ("dynamics.pinion_inertia=3", "unknown key; did you mean inertia.*.inertia or excitation.*.inertia?"),
        ("train.torques.pinoin=3", "the train has no inertia pinoin; did you mean train.torques.pinion?"),
        ("mesh.mesh.k=3", "unknown key; permitted behind mesh.NAME. are pinion, wheel, pair, "),
        ("*=3", "unknown key; must be one of a train, such as train.model"),
        ("train.name=a", "the study numbers the names itself"),
        ("shaft.input.modes=1.5", "must make whole numbers of shaft.input.modes, not 1.5"),
        ("shaft.input.length=1,1", "must have each value once"),
        ("shaft.input.length", "must be KEY="),
        ("shaft.input.length=", "must be KEY="),
    ],
)
def test_wrong_variations(variation: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ParameterError) as caught:
        plan_study(spec_of(tmp_path), [variation])
    assert str(caught.value).startswith(f"vary = '{variation}': ") and message in str(caught.value)


def test_all_of_a_kind_that_is_not_there(tmp_path: Path) -> None:
    start, _, rest = ONE_STAGE.partition("[[train.shaft]]")
    text = start + "[[train.mesh]]" + rest.partition("[[train.mesh]]")[2]
    with pytest.raises(ParameterError, match="the train has no shaft at all"):
        plan_study(spec_of(tmp_path, text), ["shaft.*.length=1"])
    head = "name,inertia.a.inertia,inertia.b.inertia,shaft.*.length," + MESH
    assert faults(tmp_path, head, "t,1,1,5,a,b,50 100,500,20") == [
        "t.csv row 2 column D (t): shaft.*.length: the train has no shaft at all"
    ]


def test_a_key_twice(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="varied more than once"):
        plan_study(spec_of(tmp_path), ["model=exact", "train.model=modes"])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('name = "input"', 'name = "*"', ": train.shaft[0].name = '*': must be a text without space around it"),
        ('name = "input"', 'name = " input"', "must be a text without space around it"),
        ('name = "input"', 'name = "output"', "names must differ"),
        ('name = "input"', 'nmae = "input"', "name is missing in [[train.shaft]]"),
        ("length = 750.0", "lenght = 750.0", "train.shaft[0].lenght: unknown key; did you mean shaft.*.length?"),
        ("length = 750.0", "length = {a = 1}", "must be a number or a text"),
        ("[[train.mesh]]", "[train.mesh]", "must be headed [[train.mesh]], once for each"),
    ],
)
def test_specs_that_no_table_holds(old: str, new: str, message: str, tmp_path: Path) -> None:
    assert old in ONE_STAGE
    with pytest.raises(SpecError) as caught:
        spec_values(spec_of(tmp_path, ONE_STAGE.replace(old, new, 1)))
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("heading", "message"),
    [
        ("shaft.s.lenght", "column L: shaft.s.lenght: unknown key; did you mean shaft.s.length?"),
        ("shaft.length", "column L: shaft.length: unknown key; did you mean shaft.*.length?"),
        ("dynamics.model", "column L: dynamics.model: unknown key; did you mean train.model?"),
        ("train.name", "is the name of the design; write name"),
        ("train.model", "is the same as column K (model); keep one of them"),
        ("pinion.teeth", "cannot stand beside keys of trains"),
        ("sun.teeth", "cannot stand beside keys of trains"),
    ],
)
def test_wrong_headings(heading: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(SpecError) as caught:
        faults(tmp_path, f"{HEAD}{MESH},model,{heading}".replace("mesh.m.teeth,", ""))
    assert message in str(caught.value).splitlines()[-1]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (",0.1,", ",0,", "column B (t): inertia.a.inertia = 0 kg·m²: must be a number at least"),
        ("ground", "gruond", "column C (t): shaft.s.start = 'gruond': must be one of the inertias a, b, or \"ground\""),
        ("50 100", "50", "column I (t): mesh.m.base_radii = (50.0,): must be two lengths in mm"),
        ("50 100", "50 x", "column I (t): mesh.m.base_radii = '50 x': must be"),
        ("1000", "", "(t): shaft.s.length = None: must be given, or else torsional_stiffness"),
        ("ground", "", "column C (t): shaft.s.start is missing: must be given"),
        (",20", ",20.5", "column K (t): mesh.m.teeth = 20.5: must be a whole number"),
        (",20", ",1e99", "column K (t): mesh.m.teeth = 1e+99: must be a whole number"),
        ("t,0.1", "t/u,0.1", "name = 't/u': must be a plain file name"),
        ("a,b,", "a,a,", "mesh.m.wheel = 'a': must differ from pinion"),
        ("a,b,", "a,q,", "column H (t): mesh.m.wheel = 'q': must be one of the inertias a, b"),
        ("500", "#REF!", "column J (t): mesh.m.stiffness = '#REF!': is an error of the spreadsheet"),
    ],
)
def test_wrong_rows(old: str, new: str, message: str, tmp_path: Path) -> None:
    assert ROW.count(old) >= 1
    (fault,) = faults(tmp_path, HEAD + MESH, ROW.replace(old, new, 1))
    assert fault.startswith("t.csv row 2 ") and message in fault


def test_all_faults_of_a_row_are_told(tmp_path: Path) -> None:
    found = faults(tmp_path, HEAD + MESH + ",shaft.s.damping", "t,-1,ground,a,1000,0.2,a,,50 100,-5,2.5,-1")
    assert [fault.partition("): ")[2].partition(" =")[0].partition(" is")[0] for fault in found] == [
        "inertia.a.inertia",
        "mesh.m.wheel",
        "mesh.m.stiffness",
        "mesh.m.teeth",
        "shaft.s.damping",
    ]


def test_a_study_says_how_many_rows_make_no_train(tmp_path: Path) -> None:
    table = tmp_path / "t.csv"
    write_study(plan_study(spec_of(tmp_path), ["shaft.*.damping_ratio=-1,0.05,101"]), table)
    faulty, first = check_table(table)
    assert faulty == 2 and "row 6 column" in first and "shaft.input.damping_ratio = -1: must be" in first


# ---------------------------------------------------------------------- pairs of meshes


def test_files_of_pairs_are_found_from_the_spec_and_from_the_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _, pair = starter_text("fzg-c")
    (tmp_path / "specs").mkdir()
    (tmp_path / "tables").mkdir()
    (tmp_path / "specs" / "a.toml").write_text(pair, encoding="utf-8")
    (tmp_path / "specs" / "b.toml").write_text(pair.replace('name = "fzg-c"', 'name = "other"'), encoding="utf-8")
    path = spec_of(tmp_path / "specs")
    monkeypatch.chdir(tmp_path)
    table = Path("tables/t.csv")
    write_study(plan_study(Path("specs/train.toml"), ["mesh.mesh.pair=a.toml,b.toml"]), table)
    assert "../specs/a.toml" in table.read_text(encoding="utf-8")
    monkeypatch.chdir(path.parent)
    rows = list(open_table("../tables/t.csv").rows())
    assert check_table(Path("../tables/t.csv")).faulty == 0
    found = [row.design() for row in rows]
    assert [each.train.meshes[0].pair.pair.name for each in found if isinstance(each, TrainDesign)] == ["fzg-c", "other"]  # type: ignore[union-attr]
    before = rows[0].inputs
    (path.parent / "a.toml").write_text(pair + "\n", encoding="utf-8")
    assert rows[0].inputs != before and rows[0].inputs.keys() == before.keys()
    assert (
        found[0].to_dict()["mesh"]["mesh"] | {"pair": "fzg-c", "stiffness": None, "static_force": None}
        == (found[0].to_dict()["mesh"]["mesh"])
    )


def test_tables_of_a_pair_stand_in_one_line_of_a_cell(tmp_path: Path) -> None:
    text = ONE_STAGE.replace("[dynamics]", "[train.mesh.pair]\nnormal_module = 2.0\n[dynamics]")
    _, _, values = spec_values(spec_of(tmp_path, text))
    assert [value for key, value in values.items() if key.endswith(".pair")] == ['{"normal_module" = 2.0}']
