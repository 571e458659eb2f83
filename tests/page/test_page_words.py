"""The words of the page: which language a browser gets, and that no word lacks another language, or is left over."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from gearcad.core import symbols
from gearcad.core.quantities import schema_of
from gearcad.core.runtime import PACKAGE
from gearcad.designs.keys import FIELDS, SHAFTS, SPEEDS
from gearcad.designs.train_keys import MAIN, PLANETARY, TRAIN, TRAIN_PARTS
from gearcad.page.fields import NO_PINION, part_title, table_title, words_of
from gearcad.page.forms import REQUIRED, form_fields
from gearcad.page.panels import drawn_data, sheet_content
from gearcad.page.panels import sheet_content as rating
from gearcad.page.words import PageLanguage, PageWords, language_of
from gearcad.shafts import ShaftOptions
from gearcad.sheet import blocks, trains

_SAME = {"name", "Text"}


@pytest.mark.parametrize(
    ("asked", "accepted", "expected"),
    [
        (None, "", "en"),
        (None, "de-AT,de;q=0.9,en;q=0.5", "de"),
        (None, "en-GB;q=0.7,de;q=0.8", "de"),
        (None, "fr,sv;q=0.9", "en"),
        (None, "de;q=nonsense, en;q=0.1", "en"),
        ("de", "en", "de"),
        ("xx", "de", "de"),
    ],
)
def test_language_of_a_browser(asked: str | None, accepted: str, expected: str) -> None:
    assert language_of(asked, accepted).value == expected


def test_words_without_others_stay_english() -> None:
    german = PageWords.of(PageLanguage.GERMAN)
    assert german["find a key"] == "Eingabe suchen"
    assert german["no word of the page"] == "no word of the page"
    assert PageWords.of(PageLanguage.ENGLISH)["find a key"] == "find a key"


def test_every_word_has_its_german_and_none_is_left_over() -> None:
    assert (
        set(PageWords.of(PageLanguage.GERMAN).table)
        == _own_words() | _words_of_inputs() | _words_of_symbols() | _titles_of_sheets() | _words_of_forms()
    )


def test_germans_are_words_of_their_own() -> None:
    """What is the same in both languages is meant to be."""
    table = PageWords.of(PageLanguage.GERMAN).table
    assert {english for english, german in table.items() if english.lower() == german.lower()} <= _SAME


def _words_of_inputs() -> set[str]:
    """Tables, parts and keys of all specs."""
    found = {part_title(SPEEDS), *(symbol.words for symbol in NO_PINION.values())}
    of_shafts = {SHAFTS: schema_of(ShaftOptions)}
    for tables in (FIELDS, PLANETARY, {table: TRAIN[table] for table in (MAIN, "dynamics")}, of_shafts):
        for table, fields in tables.items():
            found.add(table_title(table))
            for key, field in fields.items():
                found.update((words_of(key, field), *map(part_title, key.split(".")[:-1])))
    return found


def _words_of_symbols() -> set[str]:
    """What is derived and computed."""
    tables = [value for name in symbols.__all__ if isinstance(value := getattr(symbols, name), dict)]
    of_trains = (symbols.TRAIN, *symbols.TRAIN_PARTS.values())
    found = [symbol for table in (*tables, *of_trains) for symbol in table.values() if isinstance(symbol, symbols.Symbol)]
    found += [field.symbol for table in (MAIN, *TRAIN_PARTS) for field in TRAIN[table].values()]
    return {symbol.words for symbol in (*found, symbols.MASS)}


def _words_of_forms() -> set[str]:
    """Fields of the forms of searches, what is said more of them, and words for what stands for empty ones."""
    fields = [field for kind in REQUIRED for field in form_fields(kind)]
    said = {words for field in fields for words in (field.hint, field.usual) if words.replace(" ", "").isalpha()}
    return said | {field.words for field in fields} | {field.hint for field in fields if field.hint}


def _titles_of_sheets() -> set[str]:
    """Blocks of data sheets."""
    single = {
        "Gear mesh",
        "Safety",
        "Least safeties",
        "Planetary train",
        "Train",
        "Material",
        "Load",
        "Mounting",
        "Rating",
        "Shafts",
        trains.OF_PLASTIC,
    }
    single |= {"Shafts", "Segments"}
    return single.union(
        blocks._GEAR_BLOCKS,
        blocks._RACK_BLOCKS,
        blocks._PAIR_BLOCKS,
        blocks._SPLINE_BLOCKS,
        blocks._JOINT_BLOCKS,
        trains._TITLES.values(),
        trains.FACTORS,
        trains._SHORT.values(),
        (*sheet_content._KINDS, *sheet_content._VALUES, *sheet_content._QUANTITIES, rating._NO_RATING, drawn_data._NO_BODIES),
    )


def _own_words() -> set[str]:
    """What the page's code looks up in its words, `words["..."]`."""
    found = set()
    for module in sorted((PACKAGE / "page").rglob("*.py")):
        for node in ast.walk(ast.parse(Path(module).read_text(encoding="utf-8"))):
            if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, str):
                name = node.value.attr if isinstance(node.value, ast.Attribute) else getattr(node.value, "id", "")
                if name.strip("_") == "words":
                    found.add(node.slice.value)
    return found


def test_long_words_may_go_on_in_the_next_line() -> None:
    german = PageWords.of(PageLanguage.GERMAN)
    assert german.divided("Profilverschiebungsfaktor") == "Profil\u00adverschiebungs\u00adfaktor"
    assert german.divided("Zahnbreite am Kopf") == "Zahnbreite am Kopf"
    assert PageWords.of(PageLanguage.ENGLISH).divided("Profilverschiebungsfaktor") == "Profilverschiebungsfaktor"


def test_messages_of_the_page_are_german() -> None:
    line = "reducer.toml line 22: pinion.teeth = 2: must be a whole number from 3 to 2000"
    said = "reducer.toml Zeile 22: pinion.teeth = 2: muss eine ganze Zahl von 3 bis 2000 sein"
    assert PageWords.of(PageLanguage.GERMAN).message(line) == said
    assert PageWords.of(PageLanguage.ENGLISH).message(line) == line


def test_no_error_comes_to_the_page_as_it_was_made() -> None:
    """Panels show errors, steps and notices by way of `message`."""
    shown = [(module.name, line) for module in _PANELS for line in module.read_text(encoding="utf-8").splitlines()]
    raw = [(name, line) for name, line in shown if _RAW.search(line) and "message(" not in line]
    assert not raw


_PANELS = sorted((PACKAGE / "page" / "panels").glob("*.py"))
_RAW = re.compile(
    r"""(line|taken|why)=(self\.)?(str\(error|\w+\.fault\.line)|set_text\(.*(error|fault\.line)|"""
    r""""(line|step)": (each|of|run)\.(line|step)"""
)


@pytest.mark.parametrize(
    ("text", "german"),
    [
        ("-0.25", "-0,25"),
        ("1.2e-05", "1,2e-05"),
        ("50.7 135.3", "50,7 135,3"),
        ("12.6 GB", "12,6 GB"),
        ("6.5.2", "6.5.2"),
        ("A/8.3", "A/8.3"),
        ("18CrNiMo7-6", "18CrNiMo7-6"),
    ],
)
def test_numbers_have_the_decimal_sign_of_the_language(text: str, german: str) -> None:
    assert PageWords.of(PageLanguage.GERMAN).number(text) == german
    assert PageWords.of(PageLanguage.ENGLISH).number(text) == text
