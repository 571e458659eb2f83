"""Designs that are compared: up to five, only what differs, the best marked where it is known which is better."""

import math
from typing import Any

import pytest
from support.specs import TEMPLATES

from gearcad.core import symbols
from gearcad.core.errors import ParameterError
from gearcad.core.symbols import Better
from gearcad.core.units import UnitSystem
from gearcad.designs.reader import design_from_tables, read_spec
from gearcad.page.panels.compare import _compared, compared_design, compared_rows
from gearcad.page.panels.sheet_content import sections_in
from gearcad.page.words import PageLanguage, PageWords
from gearcad.page.workbench import BesideDesign, Workbench

ENGLISH, GERMAN = (PageWords.of(each) for each in PageLanguage)


def _beside() -> BesideDesign:
    text = (TEMPLATES / "reducer-21-43.toml").read_text(encoding="utf-8")
    return BesideDesign(Workbench(text, "reducer-21-43", TEMPLATES))


def _rows(beside: BesideDesign, words: PageWords = ENGLISH) -> dict[str, dict[str, Any]]:
    designs = [beside.bench.design, *(each.design for each in beside.all)]
    found = compared_rows([_compared(each.name, compared_design(each)) for each in designs], words)
    return {row["key"]: row for row in found}


def test_up_to_five_designs_each_once() -> None:
    beside = _beside()
    for width in (25, 26, 27, 28):
        beside.bench.change({"pair.face_width": str(width)})
        beside.keep()
        beside.keep()
    assert [each.design.gears["pinion"].face_width for each in beside.all] == [25, 26, 27, 28]  # type: ignore[attr-defined]
    beside.bench.change({"pair.face_width": "29"})
    with pytest.raises(ParameterError, match="designs = 6: must be at most 5: let go of one first"):
        beside.keep()
    beside.let_go(1)
    beside.keep()
    assert [each.design.gears["pinion"].face_width for each in beside.all] == [25, 27, 28, 29]  # type: ignore[attr-defined]


def test_any_of_them_changes_places_with_the_edited_one() -> None:
    beside = _beside()
    for width in (25, 26):
        beside.bench.change({"pair.face_width": str(width)})
        beside.keep()
    beside.bench.change({"pair.face_width": "30"})
    beside.swap(0)
    widths = [each.design.gears["pinion"].face_width for each in beside.all]  # type: ignore[attr-defined]
    assert (beside.bench.design.gears["pinion"].face_width, widths) == (25, [30, 26])
    assert beside.copied().all == beside.all


def test_only_what_differs_has_a_row_and_the_best_is_marked() -> None:
    beside = _beside()
    beside.keep()
    beside.bench.change({"pair.face_width": "30"})
    rows = _rows(beside)
    assert not {"gear.teeth pinion", "pair.centre_distance", "gear.normal_module pinion"} & rows.keys()
    assert [cell["text"] for cell in rows["gear.face_width pinion"]["cells"]] == ["30.0000", "25.0000"]
    assert not any(cell["best"] for cell in rows["gear.face_width pinion"]["cells"])  # wider is neither better nor worse
    assert [cell["best"] for cell in rows["strength.safety.flank pinion"]["cells"]] == [True, False]
    assert [cell["best"] for cell in rows["strength.safety.root wheel"]["cells"]] == [True, False]
    assert [cell["best"] for cell in rows["mass pinion"]["cells"]] == [False, True]
    assert [cell["best"] for cell in rows["strength.factors.sigma_H pinion"]["cells"]] == [True, False]


def test_the_mass_is_that_of_a_ring_of_the_mean_tooth_height() -> None:
    """pi/4 (d_m² - bore²) b rho with d_m halfway between tip and root: 5 % is what teeth are not half of their height."""
    design = read_spec(TEMPLATES / "reducer-21-43.toml")
    (section,) = [each for each in compared_design(design) if each.blocks[0].rows[0].key == "mass"]
    for gear, mass in zip(design.gears.values(), section.blocks[0].rows[0].values, strict=True):
        mean = (gear.tip_diameter + gear.root_diameter) / 2
        disc = math.pi / 4 * (mean**2 - gear.body.bore**2) * gear.face_width * 7850e-9
        assert mass == pytest.approx(disc, rel=0.05)


def test_equal_designs_have_no_row() -> None:
    beside = _beside()
    beside.keep()
    assert _rows(beside) == {}


def test_what_a_design_does_not_have_is_a_dash_and_words_are_those_of_the_page() -> None:
    beside = _beside()
    beside.open("ring-22-70.toml")
    rows = _rows(beside, GERMAN)
    cutter = rows["gear.cutter.teeth wheel"]
    assert [cell["text"] for cell in cutter["cells"]] == ["–", "25"]
    assert rows["mass pinion"]["gear"] == "Ritzel"
    life = rows["strength.life.root pinion"]["cells"]
    assert [(cell["text"], cell["best"]) for cell in life] == [("unendlich", False), ("–", False)]


def test_an_infinite_life_is_the_best_one() -> None:
    beside = _beside()
    beside.keep()
    beside.bench.change({"load.torque": "400"})
    life = _rows(beside)["strength.life.root pinion"]["cells"]
    assert [cell["best"] for cell in life] == [False, True]
    assert life[1]["text"] == "infinite"


def test_inches_are_compared_like_millimetres() -> None:
    designs = [read_spec(TEMPLATES / f"{name}.toml") for name in ("reducer-21-43", "fzg-c")]
    metric, inch = (
        compared_rows([_compared(each.name, sections_in(compared_design(each), system)) for each in designs], ENGLISH)
        for system in UnitSystem
    )
    best = [{row["key"]: [cell["best"] for cell in row["cells"]] for row in rows} for rows in (metric, inch)]
    assert {key: value for key, value in best[0].items() if key in best[1]} == best[1]
    assert next(row for row in inch if row["key"] == "mass pinion")["unit"] == "lb"


def test_directions_are_known_of_safeties_and_not_of_geometry() -> None:
    assert {symbols.STRENGTH[key].better for key in ("S_H", "S_F", "S_int", "S_B")} == {Better.HIGHER}
    assert symbols.PLANETARY["efficiency"].better is Better.HIGHER
    assert symbols.MASS.better is Better.LOWER
    assert {symbol.better for symbol in symbols.GEAR.values()} == {None}


@pytest.mark.parametrize("name", ["spur", "rack", "train-2-stage", "double-23-81", "ring-22-70"])
def test_every_kind_of_design_is_compared(name: str) -> None:
    design = read_spec(TEMPLATES / f"{name}.toml")
    other = design_from_tables(
        {"gear": {"teeth": 20, "normal_module": 3.0, "face_width": 20.0}}, where=lambda key: key, default_name="other"
    )
    rows = compared_rows([_compared(each.name, compared_design(each)) for each in (design, other)], ENGLISH)
    assert rows
    assert all(len(row["cells"]) == 2 for row in rows)
