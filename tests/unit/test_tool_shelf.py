"""Tools of the shelf: where a name is looked for, faults of tables, and gears that a tool makes as by hand."""

import copy
import pickle
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gearcad import ISO53_A, ISO53_D, BasicRack, Gear, GearPair, read
from gearcad.core.errors import GeometryError, ParameterError, SpecError
from gearcad.core.shelf_tables import Place
from gearcad.designs.design import files_only_in
from gearcad.designs.reader import read_spec
from gearcad.designs.spec_writers import pair_text
from gearcad.designs.table import open_table
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.gear_data_rows import gear_rows
from gearcad.drawing.tool_sheet import tool_rows
from gearcad.drawing.words import Language, SheetWords
from gearcad.geometry.premachining import Finishing
from gearcad.geometry.tool_shelf import Shelf, ToolName
from gearcad.sheet import sheet_of

PAIR = """[pair]
normal_module = 3
face_width = 30
centre_distance = 92
[pinion]
teeth = 20
profile_shift = "auto"
tool = "{}"
[wheel]
teeth = 40
profile_shift = "auto"
{}
"""


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder to work in, and an empty configuration folder of the user."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setattr("gearcad.geometry.tool_shelf.user_table", lambda: tmp_path / "config" / "gearcad" / "tools.csv")
    monkeypatch.chdir(tmp_path)
    yield tmp_path


def gear(tool: str | None = None, **changes: object) -> Gear:
    return Gear(**{"teeth": 25, "normal_module": 3.0, "face_width": 20.0, "profile_shift": 0.1, "tool": tool} | changes)


def table(text: str, folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "tools.csv"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(("tool", "rack"), [("ISO 53 A", ISO53_A), ("ISO 53 D", ISO53_D)])
@pytest.mark.parametrize("helix", [0.0, 14.0])
def test_a_tool_is_the_rack_typed_by_hand_to_the_bit(tool: str, rack: BasicRack, helix: float) -> None:
    named, typed = gear(tool, helix_angle=helix), gear(rack=rack, helix_angle=helix)
    assert replace(named, tool=None) == typed
    s = np.linspace(0, 1, 33)
    for one, other in zip(named.profile.curves, typed.profile.curves, strict=True):
        assert np.array_equal(one.points(s), other.points(s))
    document = named.to_dict()
    assert (document.pop("tool"), document.pop("tool_file")) == (tool, "tool_shelf.csv")
    assert document == typed.to_dict()


def test_a_tool_that_cuts_first_is_premachining_typed_by_hand(folders: Path) -> None:
    table(
        "name,normal_module,rack.pressure_angle,premachining.tool_addendum,premachining.tool_tip_radius,"
        "premachining.protuberance,premachining.protuberance_angle,premachining.stock\nP3,3,20,1.4,0.3,0.14,8,0.1\n",
        folders,
    )
    typed = {"tool_addendum": 1.4, "tool_tip_radius": 0.3, "protuberance": 0.14, "protuberance_angle": 8.0, "stock": 0.1}
    named = gear("P3")
    assert replace(named, tool=None) == gear(premachining=replace(named.premachining, **typed))
    assert named.residual_undercut == pytest.approx(0.04)


def test_first_the_folder_then_the_users_then_ours(folders: Path) -> None:
    assert gear("ISO 53 A").rack == ISO53_A
    table("name,rack.dedendum,rack.root_radius\nISO 53 A,1.3,0.3\nonly here,1.31,0.3\n", folders / "config" / "gearcad")
    assert gear("ISO 53 A").rack.dedendum == 1.3
    assert gear("only here").rack.dedendum == 1.31
    table("name,rack.dedendum,rack.root_radius\nISO 53 A,1.2,0.3\n", folders / "design")
    (folders / "design" / "pair.toml").write_text(PAIR.format("ISO 53 A", 'tool = "only here"'), encoding="utf-8")
    design = read("design/pair.toml")
    assert [each.rack.dedendum for each in design.gears.values()] == [1.2, 1.31]
    places = [each.tool.tool.place for each in design.gears.values() if isinstance(each.tool, ToolName) and each.tool.tool]
    assert places == [Place.DESIGN, Place.USER]


def test_a_name_takes_the_row_of_the_module(folders: Path) -> None:
    table("name,module,rack.dedendum\nH,2,1.2\nH,3,1.3\nH,,1.25\nonly 2,2,1.2\n", folders)
    found = [gear("H", normal_module=module).rack.dedendum for module in (2.0, 3.0, 2.5)]
    assert found == [1.2, 1.3, 1.25]
    assert gear("h", normal_module=3.0).tool == "H"
    with pytest.raises(GeometryError, match=r"tool = 'only 2': must be a tool of module 3 mm; it is there for module 2 mm"):
        gear("only 2")


def test_an_unknown_name_tells_the_nearest_and_where_it_was_sought(folders: Path) -> None:
    (folders / "pair.toml").write_text(PAIR.format("DIN 3972 2", ""), encoding="utf-8")
    with pytest.raises(SpecError) as told:
        read_spec("pair.toml")
    text = str(told.value)
    assert text.startswith("pair.toml line 8: pinion.tool = 'DIN 3972 2': must be a tool of the shelf; the nearest are ")
    assert '"DIN 3972 I"' in text
    assert f"looked in tools.csv, {folders / 'config' / 'gearcad' / 'tools.csv'} and the table of gearcad" in text
    assert "\n" not in text


@pytest.mark.parametrize(
    ("heading", "row", "told"),
    [
        (
            "name,rack.dedendum",
            "T,7",
            "tools.csv row 2 column B (T): rack.dedendum = 7: must be a number above 0",
        ),
        ("name,rack.dedendum", "T,deep", "tools.csv row 2 column B (T): rack.dedendum = 'deep': must be a number"),
        ("name,cutter.teeth", "T,20.5", "tools.csv row 2 column B (T): cutter.teeth = 20.5: must be a whole number"),
        ("name,normal_module,rack.dedendum", "T,-3,1.2", "column B (T): normal_module = -3 mm: must be a number at least 0.01"),
        ("name,rack.dedendum,premachining.tool_addendum", "T,1.2,1.4", "column B (T): rack.dedendum = 1.2: must be left out"),
        ("name,premachining.tool_addendum", "T,1.4", "row 2 (T): premachining.tool_tip_radius is missing: must be given"),
        ("name,premachining.tool_addendum,premachining.tool_tip_radius,premachining.stock", "T,1.4,0.2,0.1", "normal_module"),
        ("name,source", "T,a shop", "column A (T): name = 'T': must describe a tool"),
        ("name,rack.dedendum", "T,1.2,3", "row 2 column C (T): 3: has no heading above it"),
        ("name,rack.dedendun", "T,1.2", "row 1 column B: rack.dedendun: unknown column; did you mean rack.dedendum?"),
        ("tool,rack.dedendum", "T,1.2", "row 1 column A: tool: unknown column"),
        ("rack.addendum,rack.dedendum", "1,1.2", "row 1: has no column name"),
        ("name,rack.dedendum,rack.dedendum", "T,1,1", "row 1 column C: rack.dedendum: is the same as column B"),
    ],
)
def test_faulty_rows_are_told_with_row_and_column(heading: str, row: str, told: str, folders: Path) -> None:
    table(f"{heading}\n{row}\n", folders)
    with pytest.raises(SpecError) as error:
        gear("T")
    assert told in str(error.value)
    assert "\n" not in str(error.value)


def test_another_row_that_is_wrong_does_no_harm(folders: Path) -> None:
    table("name,rack.dedendum\nwrong,9\nright,1.2\n", folders)
    assert gear("right").rack.dedendum == 1.2


def test_semicolons_come_with_decimal_commas_and_comments(folders: Path) -> None:
    table("# ours\n\nname;rack.dedendum;rack.root_radius;source\nH;1,3;0,35;shop; \n", folders)
    assert gear("H").rack == BasicRack(dedendum=1.3, root_radius=0.35)


@pytest.mark.parametrize("line", ["rack.dedendum = 1.3", 'rack = "ISO53_B"', "cutter.teeth = 20", "premachining.stock = 0.1"])
def test_a_tool_and_keys_of_another_are_refused(line: str, folders: Path) -> None:
    (folders / "pair.toml").write_text(PAIR.format("ISO 53 A", f'tool = "ISO 53 D"\n{line}'), encoding="utf-8")
    with pytest.raises(SpecError, match=r"pair.toml line 13: wheel\.\S+ = .*: must be left out: the tool is given"):
        read_spec("pair.toml")
    with pytest.raises(GeometryError, match=r"rack = .*: must be left out: the tool is given"):
        gear("ISO 53 A", rack=ISO53_D)


def test_a_shared_tool_gives_way_to_what_a_gear_has(folders: Path) -> None:
    text = PAIR.replace("[pinion]", 'tool = "ISO 53 D"\nrack.addendum = 1\n[pinion]')
    with pytest.raises(SpecError, match=r"line 6: pair.rack.addendum = 1: must be left out"):
        (folders / "pair.toml").write_text(text.format("ISO 53 C", ""), encoding="utf-8")
        read_spec("pair.toml")
    text = PAIR.replace("[pinion]", 'tool = "ISO 53 D"\n[pinion]').format("ISO 53 C", "rack.dedendum = 1.3")
    (folders / "pair.toml").write_text(text, encoding="utf-8")
    assert [each.rack.dedendum for each in read_spec("pair.toml").gears.values()] == [1.25, 1.3]


def test_a_value_of_the_tool_that_is_wrong_for_the_gear_says_so(folders: Path) -> None:
    table("name,rack.dedendum,rack.root_radius\ndeep,1.25,0.9\n", folders)
    (folders / "pair.toml").write_text(PAIR.format("ISO 53 A", 'tool = "deep"'), encoding="utf-8")
    with pytest.raises(SpecError, match=r"wheel.rack.root_radius = 0.9 \(of the tool deep\): must be at most"):
        read_spec("pair.toml")


def test_a_gear_keeps_its_tool_as_long_as_it_has_its_teeth(folders: Path) -> None:
    table("name,module,rack.dedendum\nH,3,1.3\n", folders)
    named = gear("H")
    for same in (replace(named, profile_shift=0.3), copy.deepcopy(named), pickle.loads(pickle.dumps(named))):
        assert same.tool == "H" and same.rack.dedendum == 1.3
    assert replace(named, rack=ISO53_A).tool is None
    assert replace(named, normal_module=4.0).tool is None


def test_written_specs_have_the_name_of_a_tool_that_is_known_everywhere(folders: Path) -> None:
    table("name,module,rack.dedendum\nH,3,1.3\n", folders)
    (folders / "pair.toml").write_text(PAIR.format("ISO 53 D", 'tool = "H"'), encoding="utf-8")
    design = read_spec("pair.toml")
    text = pair_text(design)  # type: ignore[arg-type]
    assert text.count("tool = ") == 1 and 'tool = "ISO 53 D"' in text and "rack.dedendum = 1.3" in text
    (folders / "elsewhere").mkdir()
    (folders / "elsewhere" / "pair.toml").write_text(text, encoding="utf-8")
    again = read_spec("elsewhere/pair.toml").gears
    assert {name: each.rack for name, each in again.items()} == {name: each.rack for name, each in design.gears.items()}


def test_cells_of_a_table_name_tools_of_its_folder(folders: Path) -> None:
    table("name,rack.dedendum\nH,1.3\n", folders / "tables")
    path = folders / "tables" / "gears.csv"
    rows = "a,20,2,20,H\nb,20,2,20,ISO 53 D\nc,20,2,20,X\n"
    path.write_text(f"name,teeth,normal_module,face_width,tool\n{rows}", encoding="utf-8")
    first, second, third = open_table(path).rows()
    assert [row.design().gears["gear"].rack.dedendum for row in (first, second)] == [1.3, 1.4]
    (fault,) = third.all_faults()
    assert "gears.csv row 4 column E (c): gear.tool = 'X': must be a tool of the shelf" in fault
    before = first.inputs
    table("name,rack.dedendum\nH,1.31\n", folders / "tables")
    assert first.inputs != before  # a row is made again where its tool has changed


def test_a_name_seen_from_another_folder_leads_to_its_table(folders: Path) -> None:
    table("name,rack.dedendum\nH,1.3\n", folders / "design")
    name = ToolName.of("H", folders / "design")
    assert name.seen_from(folders / "studies") == "../design/H"
    assert ToolName.of("ISO 53 A", folders / "design").seen_from(folders) == "ISO 53 A"
    assert gear("design/H").rack.dedendum == 1.3


def test_a_page_reads_no_table_outside_its_folder(folders: Path) -> None:
    table("name,rack.dedendum\nH,1.3\n", folders)
    (folders / "page").mkdir()
    (folders / "page" / "pair.toml").write_text(PAIR.format("ISO 53 A", 'tool = "../H"'), encoding="utf-8")
    assert read_spec("page/pair.toml").gears["wheel"].rack.dedendum == 1.3
    with files_only_in(folders / "page"), pytest.raises(SpecError, match="must be of a table in the folder of the page"):
        read_spec("page/pair.toml")


def test_every_tool_of_ours_is_one_and_has_a_source() -> None:
    rows = Shelf.own()
    assert len({(row.name, row.module) for row in rows}) == len(rows)
    for row in rows:
        assert row.tool.source
        made = gear(row.name, normal_module=row.module or 3.0, **_ends(row.name, row.module or 3.0))
        assert isinstance(made.tool, ToolName) and made.tool.tool is not None


def _ends(name: str, module: float) -> dict[str, object]:
    """Where a wheel ends that grinds what the tools III and IV leave."""
    wheel = Finishing(end_diameter=24.1 * module, wheel_tip_radius=max(0.2 * module, 0.34))
    return {"finishing": wheel} if name.endswith((" III", " IV")) else {}


def test_no_tool_is_no_text() -> None:
    with pytest.raises(ParameterError, match="tool = 3: must be the name of a tool, a text"):
        gear(3)  # type: ignore[arg-type]


def test_a_pair_takes_gears_with_tools() -> None:
    pair = GearPair(pinion=gear("ISO 53 A"), wheel=gear("ISO 53 D", teeth=40))
    assert pair.tip_clearances.pinion - pair.tip_clearances.wheel == pytest.approx(0.45)


def test_sheets_tell_the_tool_and_its_table(folders: Path) -> None:
    table("name,rack.dedendum\nH,1.3\n", folders)
    (folders / "pair.toml").write_text(PAIR.format("ISO 53 D", 'tool = "H"'), encoding="utf-8")
    design = read_spec("pair.toml")
    shown = {"pinion": "ISO 53 D (tool_shelf.csv)", "wheel": "H (tools.csv)"}
    for role, own in design.gears.items():
        rows = gear_rows(DrawnGear(role=role, gear=own), SheetWords.of(Language.GERMAN))
        assert [(row.words, row.text) for row in rows if row.key == "tool"] == [("Werkzeug", shown[role])]
        assert next(tool_rows(own, SheetWords.of(Language.ENGLISH))).text == shown[role]
    (section, *_) = sheet_of(design).sections
    (block,) = (each for each in section.blocks if each.title == "Tool of the shelf")
    assert [row.texts for row in block.rows] == [("ISO 53 D", "H"), ("tool_shelf.csv", "tools.csv")]
