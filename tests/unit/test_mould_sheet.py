"""The sheet of a mould: what it shows is the cavity, with the sizes of the part behind those of the cavity."""

from __future__ import annotations

from pathlib import Path

import pytest

from gearcad import draw
from gearcad.designs import GearDesign
from gearcad.geometry import Body, Gear
from gearcad.geometry.making import Making
from gearcad.jobs.draw import Draw, SheetFormat

MOULDED = Making(process="mould", shrinkage_radial=2.0, shrinkage_axial=1.5, offset=0.02)
GEAR = Gear(teeth=24, normal_module=1.0, face_width=6.0, helix_angle=10.0, body=Body(bore=6.0), making=MOULDED)


def test_a_moulded_gear_has_a_sheet_of_its_cavity_beside_its_own() -> None:
    own, mould = draw(GEAR).sheets
    assert (own.name, mould.name) == ("gear", "gear-mould")
    assert own.shown["reference_diameter"] == pytest.approx(GEAR.reference_diameter)
    assert mould.shown["making.as_made.tip_diameter"] == pytest.approx(GEAR.tip_diameter / 0.98 + 0.04, abs=1e-9)
    assert mould.shown["making.as_made.face_width"] == pytest.approx(6.0 / 0.985, abs=1e-9)
    assert mould.shown["sizes.bore"] == pytest.approx(6.0 / 0.98 - 0.04, abs=1e-9)
    assert mould.shown["making.as_made.span_measurement"] > 1.02 * GEAR.span_measurement
    assert not [notice for notice in mould.notices if notice.code.startswith("no-")]


def test_the_table_of_a_mould_has_sizes_of_cavity_and_part(tmp_path: Path) -> None:
    job = Draw(formats=(SheetFormat.SVG,), given={"language": "de"})
    files = job.write(job.run(GearDesign(name="m", gear=GEAR)), tmp_path)
    assert {file.name for file in files} == {"drawing.svg", "drawing-gear-mould.svg", "draw.json"}
    sheet = next(each for each in job.run(GearDesign(name="m", gear=GEAR)).sheets if each.name == "gear-mould")
    texts = {entity.dxf.text for entity in sheet.document().modelspace() if entity.dxftype() in ("TEXT", "ATTRIB")}
    tip, nominal = (f"{value:.3f}".replace(".", ",") for value in (GEAR.tip_diameter / 0.98 + 0.04, GEAR.tip_diameter))
    assert f"{tip} ({nominal})" in texts
    assert "2 / 2 / 1,5 %" in texts


def test_gears_that_are_not_moulded_have_one_sheet() -> None:
    assert [sheet.name for sheet in draw(Gear(teeth=24, normal_module=1.0, face_width=6.0)).sheets] == ["gear"]
