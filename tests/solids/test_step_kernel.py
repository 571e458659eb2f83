"""STEP of what was gone on with in CadQuery: the names, colours and bytes that a user may count on, by the kernel's writer."""

from __future__ import annotations

from pathlib import Path

import cadquery
import pytest
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Controller
from support.step_witness import product_tree

from gearcad import Gear, GearPair
from gearcad.solids import gear_solid, pair_assembly, write_step
from gearcad.solids.body_plan import PART_COLOURS, STEEL

SAME = 1e-9
"""Relative: booleans of planes and round walls are exact."""

GEAR, MATE = (Gear(teeth=teeth, normal_module=2, face_width=6) for teeth in (8, 9))
NAMES = (
    "plain",
    "O'Brien",
    r"back\\slash",
    "Zahnrad \xe4\xf6\xfc\xdf",
    "\u6b6f\u8eca \U0001f600",
    "long " * 60 + "name",
    "gearcad-name-1",
)


def _drilled() -> cadquery.Shape:
    return cadquery.Workplane(obj=gear_solid(GEAR)).faces(">Z").workplane(origin=(0, 0, 0)).hole(4).val()


def test_a_drilled_or_moved_gear_is_one_part_of_its_name_in_steel(tmp_path: Path) -> None:
    path, drilled, moved = tmp_path / "changed.step", _drilled(), gear_solid(GEAR)
    volume = moved.Volume()
    moved.move(cadquery.Location(cadquery.Vector(0, 0, 5)))
    for shape, expected in ((drilled, (drilled.Volume(), 3.0)), (moved, (volume, 8.0))):
        write_step(shape, path, name="Getriebe 'A'")
        (again,) = cadquery.importers.importStep(str(path)).solids().vals()
        assert (again.Volume(), again.Center().z) == pytest.approx(expected, rel=SAME)
        (part,) = product_tree(path)
        assert (part.product, part.children) == ("Getriebe 'A'", ())
        assert part.colour == pytest.approx(STEEL, abs=1e-4)


@pytest.mark.parametrize("name", NAMES)
def test_any_name_reads_back(name: str, tmp_path: Path) -> None:
    path = tmp_path / "box.step"
    write_step(cadquery.Solid.makeBox(1, 1, 1), path, name=name)
    assert [part.product for part in product_tree(path)] == [name]
    assert f"FILE_NAME('{name[:5]}" in path.read_text("ascii").replace(r"O\X\27", "O'") or not name[:5].isascii()


def _gone_on_with() -> cadquery.Assembly:
    """A pair and boxes with it, of which two are of one colour, and two the same product."""
    red, peg = cadquery.Color(1.0, 0.0, 0.0), cadquery.Solid.makeBox(1, 2, 3)
    whole = pair_assembly(GearPair(pinion=GEAR, wheel=MATE))
    for number, name in enumerate((*NAMES[:3], "first", "second")):
        box, product = (peg, {"product": "peg"}) if number > 2 else (cadquery.Solid.makeBox(1, 1, 1), {})
        whole.add(box, name=name, loc=cadquery.Location(cadquery.Vector(0, 0, 9 + number)), color=red, metadata=product)
    return whole


def test_an_assembly_keeps_products_places_and_colours(tmp_path: Path) -> None:
    path = tmp_path / "assembly.step"
    write_step(_gone_on_with(), path, name="any")
    (whole,) = product_tree(path)
    assert [part.name for part in whole.children[2:]] == [*NAMES[:3], "first", "second"]
    assert [part.product for part in whole.children[2:]] == [*NAMES[:3], "peg", "peg"]
    assert [part.place[11] for part in whole.children[2:]] == [9, 10, 11, 12, 13]
    light = [tuple(_light(share) for share in PART_COLOURS[gear]) for gear in ("pinion", "wheel")]
    for part, colour in zip(whole.children, [*light, *[(1.0, 0.0, 0.0)] * 5], strict=True):
        assert part.colour == pytest.approx(colour, abs=1e-4)


def _light(share: float) -> float:
    """sRGB as shares of light (IEC 61966-2-1), in which the kernel has colours."""
    return share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4


def test_equal_input_gives_equal_bytes_and_settings_stay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    STEPCAFControl_Controller.Init_s()
    before = Interface_Static.IVal_s("write.surfacecurve.mode"), Interface_Static.CVal_s("write.step.schema")
    found = set()
    for number in range(10):  # occurrences are numbered through the session, and lines broken by it
        pair = pair_assembly(GearPair(pinion=GEAR, wheel=MATE)).add(cadquery.Solid.makeBox(1, 1, 1), name="box")
        write_step(pair, tmp_path / f"{number}.step", name="any")
        found.add((tmp_path / f"{number}.step").read_bytes())
    assert len(found) == 1
    assert before == (Interface_Static.IVal_s("write.surfacecurve.mode"), Interface_Static.CVal_s("write.step.schema"))
    text = found.pop().decode("ascii")
    assert "'2000-01-01T00:00:00'" in text and "PCURVE" not in text
