"""[drawing] and the drawings of gears: in specs of every kind, in tables, in documents; what is wrong is one line."""

from __future__ import annotations

import json
import re
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest

from gearcad.core.errors import ParameterError, SpecError
from gearcad.designs import read_spec
from gearcad.designs.gear_designs import ToothedDesign
from gearcad.designs.pair_designs import PairDesign
from gearcad.designs.reader import design_from_tables, design_from_values, starter_text
from gearcad.designs.spec_writers import pair_text
from gearcad.designs.table import open_table
from gearcad.designs.variations import spec_values
from gearcad.drawing.options import DrawingOptions, PartDrawing, Projection, Revision, SheetSize
from gearcad.drawing.words import Language

_GEAR: dict[str, Any] = {"teeth": 20, "normal_module": 2.0, "face_width": 20.0}
_SET = {"planets": 3, "input": "S1", "output": "carrier", "fixed": "ring", "normal_module": 2.0, "face_width": 20.0}
_OWN = {"number": "P-1", "bore_tolerance": "H6"}

KINDS: dict[str, tuple[dict[str, Any], str]] = {
    "gear": ({"gear": {**_GEAR, "drawing": _OWN}}, "gear"),
    "pair": ({"pair": {}, "pinion": {**_GEAR, "drawing": _OWN}, "wheel": {**_GEAR, "teeth": 41}}, "pinion"),
    "rack": ({"rack": {**_GEAR, "height": 20.0, "drawing": _OWN}}, "rack"),
    "rack_pair": ({"pair": {}, "pinion": _GEAR, "rack": {**_GEAR, "height": 20.0, "drawing": _OWN}}, "rack"),
    "planetary": (
        {
            "planetary": _SET,
            "sun": {"teeth": 24, "name": "S1", "drawing": _OWN},
            "planet": {"teeth": 21},
            "ring": {"teeth": -66},
        },
        "S1",
    ),
}
"""Tables of each kind of design, and the name of the gear that has a drawing of its own."""


def _design(tables: dict[str, Any]) -> ToothedDesign:
    design = design_from_tables(tables, where=lambda key: f"<{key}>", default_name="some")
    assert isinstance(design, ToothedDesign)
    return design


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_reads_the_drawing_and_that_of_a_gear(kind: str) -> None:
    tables, gear = KINDS[kind]
    design = _design({**tables, "drawing": {"number": "4711", "sheet": "A2", "language": "sv", "notes": ["a", "b"]}})
    options = DrawingOptions(number="4711", sheet=SheetSize.A2, language=Language.SWEDISH, notes=("a", "b"))
    assert design.kind.value == kind
    assert (design.drawing, design.drawings) == (options, {gear: PartDrawing(**_OWN)})
    document = json.loads(json.dumps(design.to_dict()))
    assert (document["drawing"]["number"], document["drawings"]) == ("4711", {gear: _OWN})


@pytest.mark.parametrize("kind", KINDS)
def test_a_document_without_a_drawing_has_no_key_more(kind: str) -> None:
    tables, gear = KINDS[kind]
    table = "sun" if gear == "S1" else gear
    bare = {**tables, table: {key: value for key, value in tables[table].items() if key != "drawing"}}
    with_it, without = _design({**tables, "drawing": {"title": "x"}}).to_dict(), _design(bare).to_dict()
    assert with_it.keys() - without.keys() == {"drawing", "drawings"}
    assert {key: with_it[key] for key in without} == without


def test_a_part_has_what_the_drawing_has_but_for_its_own_and_for_what_names_the_assembly() -> None:
    options = DrawingOptions(number="1", title="Drive", revision="B", owner="me", material="steel", bore_tolerance="H8")
    part = PartDrawing(number="2", bore_tolerance="H6")
    found = options.of_part(part, alone=False)
    assert (found.number, found.title, found.revision, found.owner) == ("2", "", "", "me")
    assert (found.material, found.bore_tolerance) == ("steel", "H6")
    assert options.of_part(None, alone=True) == options
    assert options.of_part(None, alone=False).number == ""
    assert options.of_part(part, alone=True).title == "Drive"


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"sheet": "A7"}, "drawing.sheet = 'A7': must be one of 'auto', 'A4', 'A3', 'A2', 'A1', 'A0'"),
    ({"scale": "3:7"}, "drawing.scale = '3:7': must be \"auto\" or a scale of ISO 5455: "),
    ({"language": "fr"}, "drawing.language = 'fr': must be one of 'en', 'de', 'sv'"),
    ({"projection": "second"}, "drawing.projection = 'second': must be one of 'first', 'third'"),
    ({"bore_tolerance": "Z99"}, "drawing.bore_tolerance = 'Z99': must be a letter ("),
    ({"bore_tolerance": "p6"}, "drawing.bore_tolerance = 'p6': must be the class of a hole, in capitals, such as \"P6\""),
    ({"keyway_tolerance": "js9"}, "drawing.keyway_tolerance = 'js9': must be the class of a hole"),
    ({"face_width_tolerance": "H11"}, "drawing.face_width_tolerance = 'H11': must be the class of a shaft, in small letters"),
    ({"rim_tolerance": "K7"}, "drawing.rim_tolerance = 'K7': must be the class of a shaft, in small letters, such as \"k7\""),
    ({"title": 7}, "drawing.title = 7: must be a text"),
    ({"title": "a\x07"}, "drawing.title = 'a\\x07': must be a text without hidden or control characters; U+0007 is one"),
    ({"owner": "a\u202eb"}, "drawing.owner = 'a\\u202eb': must be a text without hidden or control characters; U+202E is one"),
    ({"owner": "a\u200bb"}, "drawing.owner = 'a\\u200bb': must be a text without hidden or control characters; U+200B is one"),
    ({"owner": "a\u2060b"}, "drawing.owner = 'a\\u2060b': must be a text without hidden or control characters; U+2060 is one"),
    ({"owner": "a\u00adb"}, "drawing.owner = 'a\\xadb': must be a text without hidden or control characters; U+00AD is one"),
    ({"title": "a" * 2001}, "must be a text of at most 2000 characters, not 2001"),
    ({"notes": 3}, "drawing.notes = 3: must be a list of texts"),
    ({"notes": [3]}, "drawing.notes = 3: must be a text"),
    ({"revisions": ["A"]}, "drawing.revisions = 'A': must be a list of lists of index, text, date and name"),
    ({"date": "31.1.2026"}, "drawing.date = '31.1.2026': must be a date as year-month-day"),
    ({"date": "2026-02-30"}, "drawing.date = '2026-02-30': must be a date as year-month-day"),
    ({"surface_roughness": -1.0}, "drawing.surface_roughness = -1 µm: must be a number at least 0.005 µm"),
    ({"titel": "x"}, "drawing.titel: unknown key; did you mean title?"),
]


@pytest.mark.parametrize(("values", "message"), WRONG)
def test_what_is_wrong_is_one_line(values: dict[str, Any], message: str) -> None:
    with pytest.raises(SpecError) as caught:
        _design({"gear": _GEAR, "drawing": values})
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_the_drawing_of_a_gear_is_checked_alike() -> None:
    for values, message in (
        ({"tip_tolerance": "h99"}, "<pinion.drawing.tip_tolerance>: pinion.drawing.tip_tolerance = 'h99': must be"),
        ({"sheat": "A3"}, "pinion.drawing.sheat: unknown key; did you mean drawing.sheet?"),
        ({"owner": "me"}, "pinion.drawing.owner: unknown key"),
    ):
        with pytest.raises(SpecError) as caught:
            _design({"pair": {}, "pinion": {**_GEAR, "drawing": values}, "wheel": _GEAR})
        assert message in str(caught.value) and "\n" not in str(caught.value)


def test_texts_become_one_line_and_lists_are_read_from_one_text_too() -> None:
    options = DrawingOptions(
        title=" Gear\n\tof  teeth ", notes="one | two\nthree", revisions="A; first; 2026-01-31; MB | B; wider"
    )
    assert options.title == "Gear of teeth" and options.notes == ("one", "two", "three")
    assert options.changes == (Revision("A", "first", "2026-01-31", "MB"), Revision("B", "wider"))
    assert (options.index, options.factor, DrawingOptions(scale="1:5").factor) == ("B", None, 0.2)
    assert DrawingOptions(revision="C", revisions=(("A", "x"),)).index == "C"
    for text in ("Ω δοκός", "Шестерня", "歯車", "ترس مسنن", "⚙️ 👩‍🔧", "<img src=x onerror=alert(1)>", "%%c \\P {x}"):
        assert DrawingOptions(title=text).title == text


def test_the_date_is_that_of_the_files_unless_it_is_given(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert DrawingOptions().issued == "2023-11-14"
    assert DrawingOptions(date="2026-01-31").issued == "2026-01-31"


def test_a_table_has_columns_of_drawings(tmp_path: Path) -> None:
    table = tmp_path / "t.csv"
    heading = "name,pinion.teeth,wheel.teeth,normal_module,face_width"
    heading += ",drawing.number,pinion.drawing.number,drawing.notes,drawing.template"
    table.write_text(f"{heading}\na,20,41,2,20,4711,007,one | two,company.toml\nb,20,41,2,20,,,,\n", encoding="utf-8")
    first, second = (row.design() for row in open_table(table).rows())
    assert isinstance(first, ToothedDesign) and isinstance(second, ToothedDesign)
    template = str(tmp_path / "company.toml")
    assert first.drawing == DrawingOptions(number="4711", notes=("one", "two"), template=template)
    assert first.drawings == {"pinion": PartDrawing(number="007")} and (second.drawing, second.drawings) == (None, {})
    table.write_text("name,teeth,normal_module,face_width,drawing.sheet,gear.drawing.rim_tolerance\na,20,2,20,A7,Z9\n", "utf-8")
    faults = next(iter(open_table(table).rows())).all_faults()
    assert [fault.partition(" (a): ")[2].partition(" = ")[0] for fault in faults] == [
        "drawing.sheet",
        "gear.drawing.rim_tolerance",
    ]


_SPEC = """
[pair]
normal_module = 2.0
face_width = 20.0
[pinion]
teeth = 20
drawing.revisions = [["A", "first issue", 2026-01-31, "MB"], ["B", "wider"]]
[wheel]
teeth = 41
[drawing]
date = 2026-01-31
notes = ["one", "two, and three"]
template = "company.toml"
projection = "third"
"""


def test_a_spec_comes_back_from_cells_and_from_the_spec_of_its_pair(tmp_path: Path) -> None:
    path = tmp_path / "some.toml"
    path.write_text(_SPEC, encoding="utf-8")
    design = read_spec(path)
    assert isinstance(design, PairDesign) and design.drawing is not None
    assert design.drawing.date == "2026-01-31" and design.drawing.projection is Projection.THIRD
    assert design.drawing.template == str(tmp_path / "company.toml")
    assert design.to_dict()["drawing"]["template"] == "company.toml"
    kind, name, values = spec_values(path)
    assert values["pinion.drawing.revisions"] == "A; first issue; 2026-01-31; MB | B; wider"
    again = design_from_values(values, kind, where=str, default_name=name)
    assert again == design
    path.write_text(pair_text(design), encoding="utf-8")
    assert read_spec(path) == design
    path.write_text(_SPEC.replace("two, and three", "two | three"), encoding="utf-8")
    with pytest.raises(
        SpecError, match=r"line 12: drawing.notes = 'two \| three': cannot stand in a table: has \| or a new line"
    ):
        spec_values(path)


def test_python_gives_lists_and_words() -> None:
    assert PartDrawing(revisions=[["A", "x"]]).revisions == (("A", "x"),)  # type: ignore[arg-type]
    assert DrawingOptions(language="de").language is Language.GERMAN  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=r"^case_depth = 0.8: must be a text, in quotation marks"):
        PartDrawing(case_depth=0.8)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["spur", "volvo-13-44", "planetary-24-21-66"])
def test_what_starters_have_in_comments_of_drawings_can_be_used(name: str, tmp_path: Path) -> None:
    _, text = starter_text(name)
    head, found, options = text.partition("# [drawing]")
    spec = tmp_path / f"{name}.toml"
    spec.write_text(head + (found + options).replace("\n# ", "\n").removeprefix("# "), encoding="utf-8")
    design = read_spec(spec)
    assert isinstance(design, ToothedDesign) and design.drawing is not None and design.drawing.number.startswith("471")
    if name == "spur":  # it shows all there is
        assert all(re.search(rf"\b{field.name}\b", options) for field in fields(DrawingOptions) if field.name != "revision")
    else:
        assert design.drawings and all(each.number for each in design.drawings.values())
