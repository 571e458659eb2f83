"""Sheets of the drawing in the page: those that `gearcad draw` writes, for every kind of design; they run no scripts."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from support.page_server import awaited
from support.specs import TEMPLATES

from gearcad.designs.reader import design_from_tables, read_spec
from gearcad.jobs.draw import Draw
from gearcad.page.panels.drawing import drawn_sheets
from gearcad.page.run_process import result_in_process


@pytest.mark.parametrize(
    ("name", "sheets"),
    [
        ("spur", ["gear"]),
        ("reducer-21-43", ["assembly", "pinion", "wheel"]),
        ("rack", ["assembly", "pinion", "rack"]),
        ("planetary-24-21-66", ["assembly", "sun", "ring", "planet"]),
    ],
)
def test_sheets_are_the_files_of_the_command(
    name: str, sheets: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1")
    design = read_spec(TEMPLATES / f"{name}.toml")
    job = Draw(formats=("svg",))
    job.write(job.run(design), tmp_path)
    written = {path.read_text(encoding="utf-8") for path in tmp_path.rglob("*.svg")}
    found = drawn_sheets(design)
    assert [each.name for each in found.sheets] == sheets
    assert {each.svg for each in found.sheets} == written
    assert found.why_not == ""
    assert all(each.paper[:1] == "A" and ":" in each.paper for each in found.sheets)


def test_a_train_has_no_drawing_and_the_page_says_so() -> None:
    found = drawn_sheets(read_spec(TEMPLATES / "train-2-stage.toml"))
    assert found == ((), "This kind of design has no drawing.", "")


def test_they_are_drawn_beside_the_server() -> None:
    design = read_spec(TEMPLATES / "spur.toml")

    async def asked() -> object:
        return await result_in_process(drawn_sheets, design)

    assert [sheet.paper for sheet in awaited(asked()).sheets] == ["A3, 2:1"]  # type: ignore[attr-defined]


def test_texts_of_a_user_stay_texts() -> None:
    tables = {
        "gear": {"name": "plain", "teeth": 20, "normal_module": 2.0, "face_width": 10.0},
        "drawing": {"title": "</svg><script>alert(1)</script>", "owner": '"><img src=x onerror=alert(1)>'},
    }
    (sheet,) = drawn_sheets(design_from_tables(tables, where=lambda key: key, default_name="plain")).sheets
    root = ElementTree.fromstring(sheet.svg)
    tags = {element.tag.rpartition("}")[2].lower() for element in root.iter()}
    assert not tags & {"script", "foreignobject", "image", "img", "a", "use"}
    assert not [name for element in root.iter() for name in element.attrib if name.lower().startswith("on")]
