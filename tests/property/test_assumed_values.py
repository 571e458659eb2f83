"""What nobody gave: every default of every option is marked as assumed wherever it is told, and what is given never is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from enum import Enum
from pathlib import Path
from typing import Any

import pytest

from gearcad import Material, read
from gearcad.core.quantities import FieldSchema
from gearcad.core.records import is_assumed
from gearcad.core.runtime import templates
from gearcad.designs import Design, PairDesign, PlanetaryDesign
from gearcad.designs.keys import FIELDS
from gearcad.designs.spec_writers import MeshPairs, pair_text
from gearcad.designs.train_keys import PLANETARY
from gearcad.jobs.draw import drawn_gears
from gearcad.jobs.strength import Rate
from gearcad.mounting import Mounting
from gearcad.page.panels.drawn_data import of_last
from gearcad.page.panels.sheet_content import shown_figures, strength_figures
from gearcad.page.panels.views import sheet_figures
from gearcad.page.words import PageLanguage, PageWords
from gearcad.planetary import TrainLoad
from gearcad.planetary.power import power_flow
from gearcad.rating import RatingOptions
from gearcad.rating.strength import StrengthRating
from gearcad.report.document import load_rows
from gearcad.report.planetary_tables import power_rows
from gearcad.report.strength import rate_html
from gearcad.sheet import sheet_of

SHAPES = ("rack.", "body.end_chamfer_angle")
"""Keys whose defaults are the shape of a gear: it is made so."""

COMPUTED_SO = {
    "check": "refinement root_band stiffness_band contact_band",
    "mesh": "positions",
    "dynamics": "frequencies level_tolerance error_samples duration sampling transient.duration transient.torque_from",
    "drawing": "surface_roughness",
}
"""Keys that say how the program computes or draws; what a sheet asks for is what is made."""

TABLES = ("material", "load", "rating", "check", "dynamics")
"""Tables of a pair with defaults that stand for what the program cannot know."""


def defaults(fields: Any) -> Iterator[tuple[str, str, FieldSchema]]:
    """Yield table, key and field of every option that has a default."""
    for table in fields:
        for key, field in fields[table].items():
            if not field.required and field.default is not None and not getattr(field.default, "derived", False):
                yield table, key, field


@pytest.mark.parametrize("fields", [FIELDS, PLANETARY], ids=["pairs", "planetary"])
def test_every_default_is_nothing_a_choice_a_shape_or_assumed(fields: Any) -> None:
    """A number that is not 0 is assumed, unless it is the shape of a gear or says how the program computes."""
    left = [
        f"{table}.{key} = {field.default}"
        for table, key, field in defaults(fields)
        if field.default and not isinstance(field.default, bool | Enum) and not is_assumed(field.default)
        if not (isinstance(field.default, str) and (field.text or field.words))
        if not any(shape in key for shape in SHAPES) and key not in COMPUTED_SO.get(table, "").split()
    ]
    assert left == []


ASSUMED = [(table, key, field) for table, key, field in defaults(FIELDS) if table in TABLES and is_assumed(field.default)]
"""All options that are marked, as the schema has them."""


def spec(given: Any) -> str:
    """The text of a spec with the defaults of these options written in it."""
    tables = {
        "pair": ["normal_module = 3.0", "face_width = 30.0"],
        "pinion": ["teeth = 21"],
        "wheel": ["teeth = 43"],
        "material": ["group = 'Eh'", "quality = 'MQ'", "hardness = 720.0"],
        "load": ["torque = 20.0", "speed = 1450.0"],
        "rating": ["life = 1000.0", "oil_viscosity_40 = 220.0"],
        "check": ["model = '2d'"],
        "dynamics": ["speed_to = 3000.0"],
    }
    for table, key, field in given:
        tables[table].append(f"{key} = {str(field.default)!r}" if field.text else f"{key} = {field.default}")
    return "\n".join(line for table, lines in tables.items() for line in (f"[{table}]", *lines))


def made(folder: Path, given: Any) -> PairDesign:
    """The design of a spec in which these options are given."""
    path = folder / "it.toml"
    path.write_text(spec(given), encoding="utf-8")
    design = read(path)
    assert isinstance(design, PairDesign)
    return design


def told(assumed: list[str], table: str, key: str) -> bool:
    """Whether a list of what was assumed has this option."""
    return any(f"{table}.{key} = " in each or each.startswith(f"{key} = ") for each in assumed)


def shown(design: Design, table: str, key: str) -> list[str]:
    """What the data sheet has of an option."""
    rows = [row for section in sheet_of(design).sections for each in section.blocks for row in each.rows]
    return [text for row in rows if row.key == f"{table}.{key}" for text in row.texts]


def report_texts(rating: StrengthRating, design: PairDesign) -> list[str]:
    """Every value in the tables of a check's load."""
    assert design.load is not None
    return [text for row in load_rows(rating.materials.pinion, design.load, Mounting()) for text in row.values]


def test_all_options_are_marked_where_they_are_told(tmp_path: Path) -> None:
    """One option after the other is given: it loses its mark in data.json, data sheet and rate.json, and no other does."""
    assert len(ASSUMED) > 12
    for number in (None, *range(len(ASSUMED))):
        design = made(tmp_path, [] if number is None else [ASSUMED[number]])
        document = design.to_dict()
        rated = (
            Rate(report=False).run(design).to_dict()
            if number is None or ASSUMED[number][0] not in ("check", "dynamics")
            else {}
        )
        for other, (table, key, field) in enumerate(ASSUMED):
            assert document[table][key] == field.default
            assert told(document["assumed"], table, key) is (other != number), (table, key)
            texts = shown(design, table, key)
            assert all(text.endswith(" (assumed)") is (other != number) for text in texts), (table, key, texts)
            if table == "rating" or (rated and table in ("material", "load") and key != "name"):
                assert not rated or told(rated["assumed"], table, key) is (other != number), (table, key)
        for symbol, (table, key) in {"K_A": ("load", "application_factor"), "K_gamma": ("rating", "mesh_load_factor")}.items():
            if rated:
                given = number is not None and ASSUMED[number][:2] == (table, key)
                assert rated["sources"][symbol] == ("given" if given else "assumed")


@pytest.mark.parametrize("given", [False, True])
def test_reports_mark_what_nobody_gave(tmp_path: Path, given: bool) -> None:
    design = made(tmp_path, ASSUMED if given else [])
    rating = Rate(report=False).run(design)
    assert isinstance(rating, StrengthRating)
    page, loads = rate_html(rating, "it"), " ".join(report_texts(rating, design))
    assert ("(assumed)" in page) is not given
    assert ("(assumed)" in loads) is not given
    assert loads.count("(assumed)") == (0 if given else sum(table in ("material", "load") for table, *_ in ASSUMED))
    assert [each.grade for each in drawn_gears(design)] == ([6, 6] if given else [None, None])
    assert rating.asked
    unlimited = replace(design, material=Material())
    assert Rate(report=False).run(unlimited).asked is given  # a required safety that is given asks for a verdict


def test_specs_that_are_written_keep_what_was_given(tmp_path: Path) -> None:
    for given in ([], ASSUMED):
        text = pair_text(made(tmp_path, given))
        (tmp_path / "written.toml").write_text(text, encoding="utf-8")
        again = read(tmp_path / "written.toml")
        assert [told(again.to_dict()["assumed"], table, key) for table, key, _ in ASSUMED] == [not given] * len(ASSUMED)


def test_the_page_tells_a_given_default_from_an_assumed_one(tmp_path: Path) -> None:
    """Both designs are equal, and have other verdicts."""
    calls: list[Design] = []
    find = of_last(lambda design: (calls.append(design), len(calls))[1])
    found = [find(made(tmp_path, given)) for given in ([], [], ASSUMED, ASSUMED)]
    assert found == [1, 1, 2, 2]


def test_changed_options_keep_what_was_assumed() -> None:
    changed = replace(RatingOptions(), life=100.0)
    assert is_assumed(changed.accuracy_grade) and not changed.asks_strength
    assert not is_assumed(RatingOptions(accuracy_grade=6).accuracy_grade)
    assert RatingOptions(required_safety_root=1.4).asks_strength
    assert RatingOptions(required_safety_root=1.4) == RatingOptions()


@pytest.mark.parametrize("given", [False, True])
def test_an_efficiency_that_nobody_gave_is_no_result(given: bool) -> None:
    design = read(templates() / "planetary-24-21-66.toml")
    assert isinstance(design, PlanetaryDesign)
    train, load = design.train, TrainLoad(torque=100.0, speed=1000.0)
    if given:
        load = replace(load, mesh_efficiency=1.0)
    flow = power_flow(train, load)
    rows, document = power_rows(train, flow), flow.to_dict()
    assert document["mesh_efficiency_source"] == ("given" if given else "assumed")
    assert document["self_locking"] is (False if given else None)
    words = " ".join(f"{row.words} {row.source}" for row in rows)
    assert ("assumed" in words) is not given
    assert ("efficiency of a mesh, given" in words) is given
    assert ("not self-locking" in words) is given
    assert ("whether it is self-locking is not known" in words) is not given


@pytest.mark.parametrize("key", ["mesh_efficiency", "application_factor"])
def test_loads_of_planetary_trains_are_marked(key: str) -> None:
    design = read(templates() / "planetary-24-21-66.toml")
    assert isinstance(design, PlanetaryDesign)
    for given in (False, True):
        load = TrainLoad(torque=100.0, speed=1000.0, **({key: 1.0} if given else {}))
        loaded = replace(design, load=load)
        assert told(loaded.to_dict()["assumed"], "load", key) is not given
        assert all(text.endswith("(assumed)") is not given for text in shown(loaded, "load", key))
        if key == "application_factor":
            comments = " ".join(MeshPairs(design=loaded).texts.values())
            assert ("K_A 1 (assumed)" in comments) is not given


@pytest.mark.parametrize(("key", "value"), [("lubrication", "dip"), ("bearing_arrangement", "a")])
def test_choices_that_nobody_made_are_told(key: str, value: str, tmp_path: Path) -> None:
    """What a choice says of the machine is assumed where it is not made, and changes nothing else."""
    shaft = "[rating]\nbearing_span = 100.0\npinion_offset = 10.0\nshaft_diameter = 50.0\nscuffing_stage = 12\n"
    found = []
    for given in ("", f"{key} = '{value}'\n"):
        path = tmp_path / "it.toml"
        path.write_text(spec([]).replace("[rating]\n", shaft + given), encoding="utf-8")
        found.append(Rate(report=False).run(read(path)).to_dict())
    assert [told(each["assumed"], "rating", key) for each in found] == [True, False]
    assert found[0]["factors"] == found[1]["factors"] and found[0]["scuffing"]["flash"] == found[1]["scuffing"]["flash"]


@pytest.mark.parametrize("given", [False, True])
def test_the_page_shows_the_marks(tmp_path: Path, given: bool) -> None:
    """In its words, and as values that a browser can have: its encoder takes no numbers of other classes."""
    orjson = pytest.importorskip("orjson")
    design = made(tmp_path, ASSUMED if given else [])
    for language, word in zip(PageLanguage, ("assumed", "angenommen"), strict=True):
        for found in (sheet_figures(design), strength_figures(design)):
            shown = orjson.dumps(shown_figures(found, PageWords.of(language), kept=found)).decode()
            assert (f"({word})" in shown) is not given
