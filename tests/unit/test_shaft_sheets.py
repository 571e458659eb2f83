"""Sheets of a pair on its shafts: the assembly with bearings, each shaft with lengths and diameters, and their judge."""

from __future__ import annotations

import math
from pathlib import Path

import ezdxf
import pytest

from gearcad.designs import PairDesign, read_spec
from gearcad.drawing.gear_sheet import Drawing
from gearcad.drawing.shapes import Dimension, Hatching, Pen, Text
from gearcad.jobs.draw import Draw, SheetFormat
from gearcad.jobs.job import Data
from gearcad.jobs.verification_sheets import judge_sheets, make_sheets
from gearcad.verification.exact_parts import ExactPart

SPEC = """
[pair]
name = "on-shafts"
normal_module = 2.0
face_width = 20.0
[pinion]
teeth = 24
body.bore = {bore}
mesh_position = 55.0
[[pinion.shaft]]
length = 25.0
outer_diameter = 17.0
[[pinion.shaft]]
length = 45.0
outer_diameter = 20.0
[[pinion.shaft]]
length = 40.0
outer_diameter = 17.0
[[pinion.bearing]]
position = 12.0
kind = "deep groove"
name = "6203"
d = 17.0
D = 40.0
B = 12.0
axial_stiffness = "rigid"
[[pinion.bearing]]
position = 88.0
kind = "deep groove"
name = "6203"
d = 17.0
D = 40.0
B = 12.0
[wheel]
teeth = 51
body.bore = 30.0
mesh_position = 50.0
[[wheel.shaft]]
length = 70.0
outer_diameter = 30.0
inner_diameter = 12.0
[[wheel.shaft]]
length = 35.0
outer_diameter = 25.0
[[wheel.bearing]]
position = 10.0
axial_stiffness = "rigid"
[[wheel.bearing]]
position = 90.0
[material]
density = 7850.0
[drawing]
language = "{language}"
"""

DENSITY = 7850e-9


def design_of(folder: Path, bore: float = 20.0, language: str = "en") -> PairDesign:
    spec = folder / "on-shafts.toml"
    spec.write_text(SPEC.format(bore=bore, language=language), encoding="utf-8")
    found = read_spec(spec)
    assert isinstance(found, PairDesign)
    return found


@pytest.fixture(scope="module")
def drawing(tmp_path_factory: pytest.TempPathFactory) -> Drawing:
    return Draw(formats=(SheetFormat.DXF,)).run(design_of(tmp_path_factory.mktemp("sheets")))


def sizes_on(drawing: Drawing, name: str) -> list[float]:
    """Lengths (mm of the part) between the points of all dimensions of a sheet."""
    sheet = next(each for each in drawing.sheets if each.name == name)
    spans = [(each, each.first, each.second) for each in sheet.figure.shapes if isinstance(each, Dimension)]
    axes = [0 if each.measured.name == "HORIZONTAL" else 1 for each, _, _ in spans]
    return sorted(round(abs(b[k] - a[k]) / sheet.scale, 6) for (_, a, b), k in zip(spans, axes, strict=True))


def texts_on(drawing: Drawing, name: str) -> list[str]:
    sheet = next(each for each in drawing.sheets if each.name == name)
    return [each.words for each in sheet.figure.shapes if isinstance(each, Text)]


def test_a_pair_on_shafts_has_sheets_of_them(drawing: Drawing) -> None:
    assert [sheet.name for sheet in drawing.sheets] == ["assembly", "pinion", "wheel", "pinion-shaft", "wheel-shaft"]


def test_the_assembly_has_the_distances_along_both_shafts(drawing: Drawing) -> None:
    """Left end, bearings, middle of the face and right end of each shaft, its length, and the centre distance."""
    pinion, wheel = [12, 43, 33, 22, 110], [10, 40, 40, 15, 105]
    assert sizes_on(drawing, "assembly") == pytest.approx(sorted([*pinion, *wheel, 2.0 * (24 + 51) / 2]))


def test_the_parts_list_has_gears_shafts_and_bearings(drawing: Drawing) -> None:
    texts = texts_on(drawing, "assembly")
    assert {"Pinion", "Gear wheel", "Shaft of the pinion", "Shaft of the wheel", "Deep groove ball bearing 6203"} <= set(texts)
    assert texts.count("17 × 40 × 12") == 1
    assert texts.count("Deep groove ball bearing 6203") == 1 and "Rolling bearing" in texts


def test_the_assembly_tells_the_mass_of_all_parts(drawing: Drawing) -> None:
    """That of the gears' own sheets, and of the cylinders."""
    masses = {sheet.name: sheet.shown.get("mass") for sheet in drawing.sheets}
    shafts = math.pi / 4 * DENSITY * (17**2 * 25 + 20**2 * 45 + 17**2 * 40 + (30**2 - 12**2) * 70 + 25**2 * 35)
    gears = [sheet.shown["mass"] for sheet in drawing.sheets if sheet.name in ("pinion", "wheel")]
    assert masses["assembly"] == pytest.approx(sum(gears) + shafts, rel=1e-6)


def test_a_shaft_has_its_lengths_and_diameters(drawing: Drawing) -> None:
    """The longest piece follows from the others; a diameter between two others stands at a leader."""
    assert sizes_on(drawing, "pinion-shaft") == pytest.approx(sorted([25, 40, 110, 17, 17]))
    assert any(each.endswith("20") and len(each) <= 3 for each in texts_on(drawing, "pinion-shaft"))
    assert sizes_on(drawing, "wheel-shaft") == pytest.approx(sorted([35, 105, 70, 30, 25, 12]))


def test_only_hollow_shafts_are_cut(drawing: Drawing) -> None:
    hatched = {sheet.name: sum(isinstance(each, Hatching) for each in sheet.figure.shapes) for sheet in drawing.sheets}
    assert hatched["pinion-shaft"] == 0 and hatched["wheel-shaft"] == 1
    assert hatched["assembly"] == 5  # both halves of both gears, and the upper half of the wheel's shaft


def centre_lines(drawing: Drawing, name: str) -> int:
    sheet = next(each for each in drawing.sheets if each.name == name)
    return sum(getattr(each, "pen", None) is Pen.CENTRE for each in sheet.figure.shapes)


def test_a_pinion_shaft_is_drawn_with_its_teeth(drawing: Drawing, tmp_path: Path) -> None:
    """With the lines of its reference cylinder above and below, and without hatching."""
    plain, drawing = drawing, Draw(formats=(SheetFormat.DXF,)).run(design_of(tmp_path, bore=0.0))
    sheet = next(each for each in drawing.sheets if each.name == "pinion-shaft")
    assert sheet.title == "Pinion shaft" and not any(isinstance(each, Hatching) for each in sheet.figure.shapes)
    assert centre_lines(drawing, "pinion-shaft") == centre_lines(plain, "pinion-shaft") + 2
    assert sizes_on(drawing, "pinion-shaft") == pytest.approx(sorted([25, 20, 20, 5, 110, 17, 17]))


def test_the_judge_reads_sheets_of_shafts(tmp_path: Path) -> None:
    """And finds a length that is not the one of the design."""
    design = design_of(tmp_path, language="de")
    assert make_sheets(design, tmp_path) == ""
    for name in ("assembly", "pinion-shaft", "wheel-shaft"):
        assert not ezdxf.readfile(tmp_path / f"drawing-{name}.dxf").audit().errors
    exact = {role: ExactPart(gear) for role, gear in design.gears.items()}
    data = Data().document(design)
    claims = [each for each in judge_sheets(design, tmp_path, exact, data) if each.passed is not None]
    assert len(claims) > 60 and not [each for each in claims if not each.passed]
    other = (tmp_path / "other") / "on-shafts.toml"
    other.parent.mkdir()
    other.write_text(SPEC.format(bore=20.0, language="de").replace("length = 40.0", "length = 41.0"), encoding="utf-8")
    changed = read_spec(other)
    assert isinstance(changed, PairDesign)
    failed = {(each.where, each.quantity) for each in judge_sheets(changed, tmp_path, exact, data) if each.passed is False}
    assert ("drawing-pinion-shaft.dxf", "Länge") in failed
