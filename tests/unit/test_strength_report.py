"""Tables and words of the report of a rating: whose values they are, how symbols and keys are written, what is cited."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import gearcad
from gearcad.cli.strength import strength_lines
from gearcad.core.quantities import symbols_of
from gearcad.core.records import PerGear, Role
from gearcad.core.symbols import STRENGTH, STRENGTH_FACTORS, STRENGTH_FIGURES, Symbol
from gearcad.designs import read_spec
from gearcad.jobs.strength import rate_columns
from gearcad.material import Material
from gearcad.rating import RatingOptions
from gearcad.rating.strength import StrengthRating, task
from gearcad.rating.strength.duty import Resistance
from gearcad.rating.strength.permissible import flank_resistance
from gearcad.rating.strength.rating import called
from gearcad.report.document import indexed, listed, written
from gearcad.report.strength import factor_groups, rate_html, safety_rows
from gearcad.sheet.trains import strength_sections

STARTER = Path(gearcad.__file__).parents[1] / "templates" / "reducer-21-43.toml"


@pytest.fixture(scope="module")
def rating() -> StrengthRating:
    return gearcad.rate(read_spec(STARTER))


def test_the_factors_of_one_gear_stand_under_it(rating: StrengthRating) -> None:
    rows = {row.symbol: row for group in factor_groups(rating, rating.to_dict()) for row in group.rows}
    assert rows["Z_B"].values == ("1.047", "–")
    assert rows["Z_D"].values == ("–", "1")
    assert rows["Z_H"].values == ("2.394",)  # one cell, that a page spans over both columns


def test_a_new_factor_is_seen_wherever_factors_are(rating: StrengthRating, monkeypatch: pytest.MonkeyPatch) -> None:
    def with_new(*arguments: Any) -> Resistance:
        found = flank_resistance(*arguments)
        both = ({**factors, "Z_new": 0.97} for factors in (found.static, found.endurance))
        return replace(found, **dict(zip(("static", "endurance"), both, strict=True)))

    monkeypatch.setattr(task, "flank_resistance", with_new)
    monkeypatch.setitem(STRENGTH, "Z_new", Symbol("Z_new", "", "nobody", "new factor"))
    other = gearcad.rate(read_spec(STARTER))
    assert other.flank.pinion.safety == pytest.approx(0.97 * rating.flank.pinion.safety, rel=1e-12)
    assert other.to_dict()["factors"]["Z_new"] == {"pinion": 0.97, "wheel": 0.97}
    assert any(line.endswith("Z_new 0.97") for line in strength_lines(other) if line.startswith("flanks bear"))
    rows = [row for section in strength_sections(other) for block in section.blocks for row in block.rows]
    assert [row.texts for row in rows if row.symbol.symbol == "Z_new"] == [("0.97", "0.97")]
    assert "new factor" in rate_html(other, "pair")


def test_every_factor_has_a_symbol(rating: StrengthRating) -> None:
    found = [symbol for group in rating.factors.values() for symbol in group]
    assert found == list(rating.to_dict()["factors"])
    assert sorted(found) == sorted(STRENGTH_FACTORS)
    inputs = {"K_A", "K_gamma"}  # which have columns of their own
    assert set(STRENGTH_FACTORS) - inputs == {symbol for symbol in STRENGTH_FIGURES if symbol in STRENGTH_FACTORS}
    columns = rate_columns(rating.to_dict())
    assert set(STRENGTH_FACTORS) - inputs <= columns.keys()
    assert columns["Z_L"] == rating.to_dict()["factors"]["Z_L"] and columns["Z_L"].keys() == {"pinion", "wheel"}


def test_each_part_cites_its_own_standard(rating: StrengthRating) -> None:
    document = rating.to_dict()
    cycles = [row.source for row in safety_rows(rating, document) if row.symbol == "N_L"]
    assert [each.partition(",")[0] for each in cycles] == ["ISO 6336-2", "ISO 6336-3"]
    part = {"Z": "ISO 6336-2", "Y": "ISO 6336-3", "K": "ISO 6336-1"}
    told = {key: source for key, source in document["sources"].items() if source not in ("given", "assumed")}
    assert all(source.startswith(part[key[0]]) for key, source in told.items() if key[0] in part)
    assert told["sigma_Hlim"] == "ISO 6336-5:2016, Eh MQ, 720 HV"


def test_inputs_are_not_called_as_what_the_rating_finds() -> None:
    found = {STRENGTH[key].words for key in ("sigma_HP", "sigma_FP", "sigma_HG", "sigma_FG")}
    symbols = {STRENGTH[key].symbol for key in STRENGTH}
    given = [symbols_of(Material)[key] for key in ("contact_limit", "root_limit")]
    assert not found & {each.words for each in given}
    assert not symbols & {each.symbol for each in given}


@pytest.mark.parametrize(
    ("text", "page"),
    [
        ("oil_viscosity_100 = 18.75: of K_Hbeta", "<code>oil_viscosity_100</code> = 18.75: of K<sub>Hβ</sub>"),
        ("rating.dynamic_factor = 'B'", "<code>rating.dynamic_factor</code> = &#39;B&#39;"),
        ("sigma_Hlim is not known; X_Gamma.", "σ<sub>Hlim</sub> is not known; X<sub>Γ</sub>."),
        ("Y_delta_relT", "Y<sub>δrelT</sub>"),
        ("F_t K_A/b", "F<sub>t</sub> K<sub>A</sub>/b"),
    ],
)
def test_symbols_and_keys(text: str, page: str) -> None:
    assert str(indexed(written(text))) == page


def test_lists_say_whose_symbols_they_are() -> None:
    assert listed(["sigma_Flim", "planet.Y_M", "planet.Y_M"]) == "σ_Flim, Y_M of the planet"


def test_gears_of_a_set_are_called_by_their_names(rating: StrengthRating) -> None:
    found = called(rating, PerGear("planet", "sun"))
    assert [name for name, _ in found.every] == [
        "flank of the planet",
        "flank of the sun",
        "root of the planet",
        "root of the sun",
    ]
    assert found.to_dict()["safety"] == rating.to_dict()["safety"]
    assert found.to_dict()["gears"] == {Role.PINION.value: "planet", Role.WHEEL.value: "sun"}
    assert "torque on the planet at the required safety" in {row.words for row in safety_rows(found, found.to_dict())}


def test_a_page_says_which_load_of_a_spectrum_its_stresses_are_of() -> None:
    design = read_spec(STARTER)
    bins = RatingOptions(life=100.0, spectrum=((0.1, 1.25), (0.9, 0.8)))
    page = rate_html(gearcad.rate(design, rating=bins), "pair")
    assert "Load spectrum: stresses, load factors and Z<sub>v</sub> are of load 1: 250 N·m" in page
