"""Sheets of splined shafts and hubs: the printed example of DIN 5480, dashes for what is not known, and the judge of sheets."""

import json
from pathlib import Path
from typing import Any

import pytest

from gearcad import SplineJoint, draw
from gearcad.designs import SplineDesign
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.gear_data_rows import GearDataRow
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.spline_rows import spline_rows
from gearcad.drawing.words import Language, SheetWords
from gearcad.geometry import HubInputs
from gearcad.jobs.draw import Draw, SheetFormat, drawn_gears
from gearcad.jobs.job import Data
from gearcad.jobs.verification_sheets import judge_sheets

REFERENCE = json.loads((Path(__file__).parents[1] / "data" / "splines.json").read_text(encoding="utf-8"))
PRINTED = REFERENCE["din5480_example_hub"]
JOINT = SplineJoint(
    name="seat", designation="N 120 x 3 x 38 x 9H / W 120 x 3 x 38 x 8f", length=40.0, hub=HubInputs(pin_diameter=5.25)
)


def rows_of(joint: SplineJoint, part: str, language: Language = Language.ENGLISH) -> dict[str, GearDataRow]:
    design = SplineDesign(name=joint.name, spline=joint)
    drawn: DrawnGear = next(each for each in drawn_gears(design) if each.role == part)
    found = spline_rows(drawn, joint.parts[part], SheetWords.of(language), DrawingOptions())
    assert len({row.key for row in found}) == len(found)
    return {row.key: row for row in found}


def test_the_printed_hub_of_din_5480() -> None:
    rows, printed = rows_of(JOINT, "hub"), PRINTED["expected"]
    assert rows["designation"].text == "DIN 5480 - N 120 x 3 x 38 x 9H"
    assert rows["mate"].text == "DIN 5480 - W 120 x 3 x 38 x 8f"
    assert rows["space_width_actual"].limits == (f"{printed['space_width_max']:.3f}", f"{printed['space_width_min']:.3f}")
    assert rows["go_gauge"].text == f"{printed['effective_space_width_min']:.3f}"
    assert rows["form_diameter_min"].text == f"{printed['form_diameter_min']:.3f}"
    limits = rows["between_pins"].limits
    assert limits is not None
    expected = [printed["between_pins_max"], printed["between_pins_min"]]
    assert [float(each) for each in limits] == pytest.approx(expected, abs=PRINTED["tolerance"]["between_pins"])


def test_what_is_not_known_has_a_dash() -> None:
    alone = SplineJoint(designation="W 30 x 1.25 x 22 x 8f")
    rows = rows_of(alone, "shaft")
    unknown = {key for key, row in rows.items() if row.text.startswith("—")}
    assert unknown == {
        *("mate", "circle_limits", "form_diameter_max", "tolerance_actual", "tolerance_effective"),
        *("tooth_thickness_effective", "tooth_thickness_actual", "no_go_gauge", "over_pins", "span_teeth"),
    }
    assert rows["over_pins"].text == "— (not given)"
    assert rows_of(alone, "shaft", Language.GERMAN)["over_pins"].text == "— (nicht angegeben)"


@pytest.mark.parametrize(
    ("designation", "shaft", "hub"),
    [
        ("INT/EXT 24z x 2.5m x 30P x 5H/5f", "ISO 4156 - EXT 24z x 2.5m x 30P x 5f", "ISO 4156 - INT 24z x 2.5m x 30P x 5H"),
        ("INT/EXT 24T x 12/24P x 37.5R x 5/5", "ANSI B92.1 - EXT 24T x 12/24P x 37.5R x 5", "ANSI B92.1 - INT 24T x 12/24P"),
    ],
)
def test_designations_are_those_that_are_read(designation: str, shaft: str, hub: str) -> None:
    joint = SplineJoint(designation=designation, length=20.0)
    assert rows_of(joint, "shaft")["designation"].text == shaft
    assert rows_of(joint, "hub")["designation"].text.startswith(hub)
    again = SplineJoint(designation=shaft, length=20.0).parts["shaft"]
    assert again.to_dict() == joint.parts["shaft"].to_dict()


def test_sheets_of_both_parts() -> None:
    sheets = draw(JOINT).sheets
    assert [(sheet.name, sheet.title) for sheet in sheets] == [("shaft", "Splined shaft"), ("hub", "Splined hub")]
    assert sheets[1].shown["between_pins_max"] == JOINT.parts["hub"].to_dict()["between_pins_max"]
    assert {notice.code for notice in draw(JOINT).notices} == {"no-material", "assumed-rim"}


def judged(folder: Path, data: dict[str, Any]) -> set[str]:
    """Claims about the sheets in a folder that fail against data."""
    design = SplineDesign(name="seat", spline=JOINT)
    return {claim.quantity for claim in judge_sheets(design, folder, {}, data) if claim.passed is False}


def test_the_judge_finds_a_wrong_row(tmp_path: Path) -> None:
    design, job = SplineDesign(name="seat", spline=JOINT), Draw(formats=(SheetFormat.DXF,))
    job.write(job.run(design), tmp_path)
    data = Data().document(design)
    assert judged(tmp_path, data) == set()
    data["hub"]["between_pins_max"] += 0.001
    data["shaft"]["tolerance_actual"] = 41
    assert judged(tmp_path, data) == {"Between two pins", "Tolerance of the actual size"}
