"""Data sheet and rating of the page: what `data.json` and `gearcad rate --json` hold, with all digits."""

import time
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from support.specs import TEMPLATES

from gearcad.core.records import Notice, Role
from gearcad.core.symbols import parts_of
from gearcad.core.units import UnitSystem
from gearcad.designs.design import Design
from gearcad.designs.reader import design_from_tables, read_spec
from gearcad.designs.train_designs import TrainDesign
from gearcad.designs.train_meshes import train_meshes
from gearcad.jobs.strength import Rate
from gearcad.load import Load
from gearcad.page.panels.sheet_content import (
    Figures,
    called,
    cells_of,
    changed_cells,
    figures_in,
    quantity_in,
    shown_figures,
    shown_notices,
    shown_sections,
    strength_figures,
    warm_up,
)
from gearcad.page.panels.views import sheet_figures
from gearcad.page.words import PageLanguage, PageWords
from gearcad.page.workbench import Workbench
from gearcad.rating.options import RatingOptions
from gearcad.sheet import sheet_of
from gearcad.sheet.blocks import flattened

ENGLISH, GERMAN = (PageWords.of(each) for each in PageLanguage)


def starter(name: str) -> Design:
    return read_spec(TEMPLATES / f"{name}.toml")


def values(design: Design) -> dict[tuple[str, str], Any]:
    return {place: cell.value for place, cell in cells_of(sheet_of(design).sections).items()}


@pytest.mark.parametrize("name", ["spur", "volvo-13-44", "ring-22-70", "double-23-81", "rack"])
def test_values_are_those_of_data_json_with_all_digits(name: str) -> None:
    design = starter(name)
    document = design.to_dict()
    of = {each: flattened(document[each]) for each in ("gear", "pinion", "wheel", "rack", "pair") if each in document}
    of["pair"] = of.get("pair", {}) | document.get("drive", {})
    gears = list(design.gears)
    compared = 0
    for (key, column), value in values(design).items():
        table, _, inner = key.partition(".")
        if table == "gear":
            expected = of[column or gears[0]].get(inner)
            if expected != value:  # what belongs to something that is not there, and modifications that do nothing
                assert value is None
                continue
        elif table == "pair" and column:
            expected = document["pair"][inner][gears.index(column)]
        elif table in of:
            expected = of[table][inner]
        else:
            continue
        assert value == expected
        compared += 1
    assert compared > 25


def test_meshes_of_a_planetary_train_have_their_own_columns() -> None:
    design = starter("planetary-24-21-66")
    meshes = design.to_dict()["planetary"]["meshes"]
    found = values(design)
    for name, mesh in meshes.items():
        assert found["pair.transverse_contact_ratio", name] == mesh["transverse_contact_ratio"]


def test_what_a_step_changes_has_what_it_was_beside_it() -> None:
    before, after = (cells_of(sheet_of(pair(centre)).sections) for centre in (91.5, 91.6))
    changed = changed_cells(after, before)
    assert changed["pair.centre_distance", ""] == "91.5000"
    assert ("gear.teeth", "pinion") not in changed
    assert changed_cells(after, after) == {}
    assert changed_cells(after, {}) == {}


def test_a_kept_design_stands_beside_with_the_difference_of_all_digits() -> None:
    this, kept = (sheet_figures(pair(centre)) for centre in (91.6, 91.5))
    rows = shown_rows(shown_figures(this, ENGLISH, kept=kept))
    centre = rows["pair.centre_distance"]["cells"]
    assert centre == [{"text": "91.6000", "former": "", "kept": "91.5000", "difference": "+0.1000"}]
    assert "kept" not in rows["gear.teeth"]["cells"][0]
    ratio = this.cells["pair.total_contact_ratio", ""].value - kept.cells["pair.total_contact_ratio", ""].value
    assert rows["pair.total_contact_ratio"]["cells"][0]["difference"] == f"{ratio:+.4f}"


def test_first_figures_of_a_pair_are_known() -> None:
    found = sheet_figures(pair(91.5))
    rows = shown_rows(shown_figures(found, ENGLISH))
    assert len([key for key in found.pins if key in rows]) >= 10


def test_notices_lead_to_fields_of_the_spec() -> None:
    keys = {"pinion.profile_shift", "wheel.profile_shift", "wheel.face_width"}
    found = shown_notices([Notice("undercut", "undercut", "wheel"), Notice("unheard-of", "?", "")], keys)
    assert [each["keys"] for each in found] == [["wheel.profile_shift"], []]
    assert [each["text"] for each in found] == ["wheel: undercut", "?"]


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("volvo-13-44", "volvo-13-44: schrägverzahntes Radpaar, z = 13 / 44"),
        ("ring-22-70", "ring-22-70: geradverzahntes Innenradpaar, z = 22 / -70"),
        ("planetary-24-21-66", "planetary-24-21-66: Planetengetriebe der Bauart A, z = 24 / -66 / 21"),
        ("train-2-stage", "train-2-stage: Getriebezug, 4 Drehmassen"),
    ],
)
def test_a_sheet_says_in_the_words_of_the_page_what_a_design_is(name: str, line: str) -> None:
    found = sheet_figures(starter(name))
    assert shown_figures(found, GERMAN)["lines"] == [{"label": "", "text": line}]
    assert shown_figures(found, ENGLISH)["lines"][0]["text"] == f"{name}: {sheet_of(starter(name)).title}"


def test_words_among_the_values_names_and_units_are_those_of_the_page() -> None:
    sheet = shown_figures(sheet_figures(starter("planetary-24-21-66")), GERMAN)
    rows = shown_rows(sheet)
    assert rows["gear.undercut"]["cells"][0]["text"] == "nein"
    assert rows["gear.helix_angle"]["unit"] == "°"
    assert ["Sonnenrad-Planetenrad", "Hohlrad-Planetenrad"] in [section["columns"] for section in sheet["sections"]]
    assert called(GERMAN, "sun-nobody") == "sun-nobody"
    assert quantity_in(GERMAN, "single contact factor of the planet") == "Einzeleingriffsfaktor (Planetenrad)"
    assert quantity_in(ENGLISH, "single contact factor of the planet") == "single contact factor of the planet"


def test_a_hostile_name_stays_text() -> None:
    name = "<img src=x onerror=alert(1)>"
    section = sheet_of(starter("planetary-24-21-66")).sections[0]
    shown = shown_sections([section._replace(columns=tuple(name for _ in section.columns))], ENGLISH)
    assert set(shown[0]["columns"]) == {name}
    text = (Path(__file__).parents[2] / "gearcad" / "page" / "components" / "gear_sheet.js").read_text(encoding="utf-8")
    assert "innerHTML" not in text
    assert "v-html" not in text


def pair(centre: float) -> Design:
    tables = {
        "pair": {"name": "trial", "normal_module": 3.0, "face_width": 20.0, "centre_distance": centre},
        "pinion": {"teeth": 20},
        "wheel": {"teeth": 40, "profile_shift": "auto"},
    }
    return design_from_tables(tables, where=lambda key: key, default_name="trial")


def shown_rows(sheet: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {row["key"]: row for section in sheet["sections"] for block in section["blocks"] for row in block["rows"]}


LONGEST = 0.15
"""Seconds of one rating of a pair, many times what it takes: the page has 0.3 s for it."""


def document(design: Design) -> dict[str, Any]:
    job = Rate(report=False)
    return job.document(job.run(design))


def value(found: Figures, key: str, column: str = "") -> Any:
    return found.cells[key, column].value


@pytest.mark.parametrize("name", ["reducer-21-43", "volvo-13-44", "ring-22-70", "rack"])
def test_values_are_those_of_rate_json_with_all_digits(name: str) -> None:
    design = starter(name)
    found, expected = strength_figures(design), document(design)
    compared = 0
    for (key, column), cell in found.cells.items():
        _, table, *inner = key.split(".")
        of = expected
        for each in (table, *inner):
            of = of[each] if each in of else expected["stresses"][each]
        compared += 1
        if isinstance(of, dict):
            of = of[column]
        elif column:  # Z_B and Z_D are of one gear each
            of = of if cell.value is not None else None
        assert cell.value == of
    assert compared > 20
    assert found.title.startswith(f"strength {expected['strength']}")


def test_a_rating_follows_within_its_time() -> None:
    design = starter("reducer-21-43")
    warm_up(design)
    begun = time.thread_time()
    strength_figures(design)
    assert time.thread_time() - begun < LONGEST


def test_without_a_load_one_line_says_what_to_give() -> None:
    design = replace(starter("reducer-21-43"), load=None)
    found = strength_figures(design)
    text = "load.torque is missing: must be given, in N·m on the pinion: without it there is no stress"
    assert found.notices == ({"text": text, "keys": ["load.torque"]},)
    assert not found.cells


@pytest.mark.parametrize("name", ["spur", "train-1-stage"])
def test_what_carries_nothing_has_no_rating_and_no_warning(name: str) -> None:
    shown = shown_figures(strength_figures(starter(name)), PageWords.of(PageLanguage.GERMAN))
    assert shown["lines"] == [{"label": "", "text": "Für diese Art von Auslegung gibt es keinen Tragfähigkeitsnachweis."}]
    assert not shown["notices"]


def test_why_nothing_is_judged_stands_apart_from_the_verdict() -> None:
    found = strength_figures(starter("double-23-81"))
    shown = shown_figures(found, PageWords.of(PageLanguage.GERMAN))
    assert shown["title"] == "Tragfähigkeit nicht verlangt"
    reason = "keine Dauerfestigkeit, örtliche Grenze, Werkstoffqualität oder Mindestsicherheit ist angegeben"
    assert shown["reason"] == reason
    english = shown_figures(found, PageWords.of(PageLanguage.ENGLISH))
    assert found.title == f"strength not asked for: {english['reason']}"


def test_what_only_the_document_of_a_rating_finds_to_be_wrong_is_a_line_too(tmp_path: Path) -> None:
    bench = Workbench((TEMPLATES / "reducer-21-43.toml").read_text(encoding="utf-8"), "trial", tmp_path)
    bench.change({"pinion.material.root_endurance_limit": "0.001"})
    assert bench.fault is None
    assert "N·m in size" in strength_figures(bench.design).notices[0]["text"]


def test_finite_elements_are_left_to_a_run() -> None:
    design = replace(starter("reducer-21-43"), rating=RatingOptions(face_load_factor="fe"))
    found = strength_figures(design)
    assert found.notices[0]["keys"] == ["rating.face_load_factor"]
    assert not found.cells


def test_a_verdict_is_coloured_and_stands_beside_that_of_a_kept_design() -> None:
    design = starter("reducer-21-43")
    passed = strength_figures(design)
    failed = strength_figures(replace(design, load=Load(torque=10 * design.load.torque, speed=design.load.speed)))  # type: ignore[attr-defined]
    assert (passed.verdict, failed.verdict) == ("passed", "failed")
    shown = shown_figures(failed, PageWords.of(PageLanguage.ENGLISH), kept=passed)
    assert shown["title"].startswith("strength NOT passed")
    assert shown["beside"] == passed.title


def test_values_in_inches_are_those_in_mm_and_words_and_modules_stay() -> None:
    found = sheet_figures(starter("volvo-13-44"))
    inches = figures_in(found, UnitSystem.INCH)
    rows = shown_rows(shown_figures(inches, PageWords.of(PageLanguage.ENGLISH, UnitSystem.INCH)))
    compared = 0
    for place, cell in found.cells.items():
        other, unit = inches.cells[place], rows[place[0]]["unit"]
        if unit == "in":
            assert isinstance(cell.value, float)
            assert other.value == pytest.approx(cell.value / 25.4, rel=1e-15)
            assert float(other.text) == pytest.approx(other.value, abs=1e-5)
            compared += 1
        elif not unit.startswith(("lb", "ks", "µin")):
            assert other == cell
    assert compared > 40
    assert (rows["gear.normal_module"]["unit"], rows["gear.normal_module"]["cells"][0]["text"]) == ("mm", "2.5000")
    assert rows["pair.centre_distance"]["cells"][0]["text"] == "3.14961"
    assert rows["load.torque"]["cells"][0]["text"] == "1947"  # lbf·in of 220 N·m
    assert figures_in(found, UnitSystem.METRIC) is found


def test_stresses_and_forces_of_a_rating_in_inches() -> None:
    found = strength_figures(starter("reducer-21-43"))
    inches = figures_in(found, UnitSystem.INCH)
    rows = shown_rows(shown_figures(inches, ENGLISH))
    sigma = next(row for row in rows.values() if row["symbol"] == "σ_Hlim")
    assert (sigma["unit"], sigma["cells"][0]["text"]) == ("ksi", "217.6")  # 1500 MPa


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("m_n", (("m", "n"),)),
        ("F_t K_A/b", (("F", "t"), (" K", "A"), ("/b", ""))),
        ("h_aP*", (("h", "aP"), ("*", ""))),
        ("σ_Hlim", (("σ", "Hlim"),)),
        ("Θ_S - Θ_B", (("Θ", "S"), (" - Θ", "B"))),
        ("T1A", (("T1A", ""),)),
        ("", ()),
    ],
)
def test_indices_of_symbols_stand_apart(text: str, parts: tuple[tuple[str, str], ...]) -> None:
    assert parts_of(text) == parts


def test_no_symbol_of_a_sheet_has_an_underscore_left_and_clauses_name_their_standard() -> None:
    for found in (sheet_figures(starter("volvo-13-44")), strength_figures(starter("reducer-21-43"))):
        for row in shown_rows(shown_figures(found, GERMAN)).values():
            assert not any("_" in text + index for parts in row["parts"] for text, index in parts), row
            assert "".join(f"{text}_{index}" if index else text for text, index in row["parts"][1]) == row["symbol"]
    rows = shown_rows(shown_figures(sheet_figures(starter("volvo-13-44")), GERMAN))
    assert rows["pair.transverse_contact_ratio"]["source"] == "ISO 21771, Abschnitt 5.4"
    assert rows["gear.span_measurement"]["source"] == "ISO 21771, Annex A"
    assert rows["gear.thickness_limits.allowance_upper"]["source"] == "DIN 3967"


def test_a_train_of_pairs_has_the_ratings_of_its_meshes_and_the_verdict_of_the_worst() -> None:
    """As `gearcad rate` of the pair of each mesh under the load that the train gives it."""
    design = read_spec(TEMPLATES / "two-stage.toml")
    assert isinstance(design, TrainDesign)
    found = strength_figures(design)
    assert (found.title, found.verdict) == ("strength passed", "passed")
    pairs = [mesh.design for mesh in train_meshes(design).meshes]
    assert [pair.load.torque for pair in pairs if pair.load is not None] == pytest.approx([60.0, -60.0 * 61 / 20])
    for section, name, pair in zip(found.sections, ("stage 1", "stage 2"), pairs, strict=True):
        (row,) = [row for block in section.blocks for row in block.rows if row.key == f"{name}.safety.flank"]
        safeties = Rate().document(Rate(report=False).run(pair))["safety"]["flank"]
        assert list(row.values) == [safeties[role.value] for role in Role]
    tables = tomllib.loads((TEMPLATES / "two-stage.toml").read_text(encoding="utf-8"))
    weak = strength_figures(design_from_tables(_weakened(tables), where=lambda key: key, default_name="weak"))
    assert (weak.title, weak.verdict) == ("strength NOT passed: stage 2", "failed")


def _weakened(tables: dict[str, Any]) -> dict[str, Any]:
    """Ask more of the second mesh than it can bear."""
    tables["train"]["mesh"][1]["pair"]["rating"]["required_safety_flank"] = 3.0
    return tables
