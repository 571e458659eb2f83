"""Messages in German: every text of the package that can reach a person has an entry, and messages are put together rightly."""

from __future__ import annotations

import re

import pytest
from support.message_texts import message_texts

from gearcad.core.errors import GearcadError, ParameterError, require_number, require_whole
from gearcad.core.messages import HOLE, Catalogue, catalogue, english_words, messages_of
from gearcad.core.records import Notice
from gearcad.designs.reader import starters
from gearcad.page.words import PageLanguage, PageWords

_TABLES = messages_of("de")
_PAGE = PageWords.of(PageLanguage.GERMAN).table
_HOLES = re.compile(r"\{\d*\}")


def german(english: str) -> str:
    found = catalogue("de")
    assert found is not None
    return found.text(english)


def test_every_text_of_the_package_has_its_german() -> None:
    known = {*_TABLES["messages"], *_TABLES["words"], *_PAGE}
    missing = [f"{each.module}:{each.line} {each.template!r}" for each in message_texts() if each.template not in known]
    assert not missing, "\n".join(missing)


def test_no_german_is_left_over() -> None:
    there = {each.template for each in message_texts()}
    assert not [english for english in _TABLES["messages"] if english not in there]


def test_translations_have_the_values_of_their_templates() -> None:
    """No value is lost, and holes are numbered all or none."""
    for english, text in {**_TABLES["messages"], **_TABLES["words"]}.items():
        numbers = [hole.strip("{}") for hole in _HOLES.findall(text)]
        if any(numbers):
            assert set(map(int, numbers)) == set(range(english.count(HOLE))), english
        else:
            assert len(numbers) == english.count(HOLE), english


def test_translations_begin_and_end_as_their_templates() -> None:
    """What stands behind another text does so in German."""
    for english, text in _TABLES["messages"].items():
        assert english[:1].isspace() == text[:1].isspace(), english
        assert english[-1:].isspace() == text[-1:].isspace(), english


def test_starters_are_described_in_german() -> None:
    specs = {name: words for name, words in starters().items() if not name.startswith("ci")}
    assert not [name for name, words in specs.items() if german(words) == words]


@pytest.mark.parametrize(
    ("english", "expected"),
    [
        (
            "reducer.toml line 22: pinion.teeth = 2: must be a whole number from 3 to 2000",
            "reducer.toml Zeile 22: pinion.teeth = 2: muss eine ganze Zahl von 3 bis 2000 sein",
        ),
        (
            "a line 9, column 3: is not valid TOML: Expected '=' after a key in a key/value pair; write 3.5 with a point",
            "a Zeile 9, Spalte 3: ist kein gültiges TOML: nach einem Schlüssel wird '=' erwartet; mit Punkt schreiben: 3.5",
        ),
        (
            "wheel: undercut: the involute begins at diameter 23.4 mm",
            "Rad: Unterschnitt: die Evolvente beginnt am Durchmesser 23,4 mm",
        ),
        (
            "pair.normal_module is missing: must be given (here or in [pair])",
            "pair.normal_module fehlt: muss angegeben sein (hier oder in [pair])",
        ),
        (
            "a5-r3p: undercut: contact ends at r3p's root form circle 51.5448 mm; a5's tip reaches beyond it without contact",
            "a5-r3p: Unterschnitt: der Eingriff endet am Fußformkreis am r3p: 51,5448 mm; "
            "der Zahnkopf am a5 reicht ohne Berührung darüber hinaus",
        ),
        (
            "sun-planet: undercut: the involute begins at diameter 8 mm",
            "Sonnenrad-Planet: Unterschnitt: die Evolvente beginnt am Durchmesser 8 mm",
        ),
        ("strength passed; not judged: root of the wheel", "Tragfähigkeit nachgewiesen; nicht beurteilt: Zahnfuß am Rad"),
        ("planetary.output = 'x': must be sun, ring, carrier", "planetary.output = 'x': muss sun, ring, carrier sein"),
        ("mesh cycle, position 3 of 24", "Eingriffsperiode, Stellung 3 von 24"),
        ("about 1.5 h left", "noch etwa 1,5 h"),
        ("6.5.2", "6.5.2"),
        ("S_H = 1.25, S_F = 2.5", "S_H = 1,25, S_F = 2,5"),
        ("no sentence that anybody has written", "no sentence that anybody has written"),
        ("", ""),
    ],
)
def test_messages_in_german(english: str, expected: str) -> None:
    assert german(english) == expected


@pytest.mark.parametrize(
    ("bounds", "expected"),
    [
        ({"at_least": -5, "at_most": 5}, "x = nan: muss eine Zahl von -5 bis 5 sein"),
        ({"above": 0.25}, "x = nan mm: muss eine Zahl über 0,25 mm sein"),
        ({"above": 0, "below": 1.5}, "x = nan: muss eine Zahl über 0 und unter 1,5 sein"),
        ({"below": 7}, "x = nan: muss eine Zahl unter 7 sein"),
        ({}, "x = nan: muss eine Zahl sein"),
    ],
)
def test_bounds_in_german(bounds: dict[str, float], expected: str) -> None:
    with pytest.raises(ParameterError) as caught:
        require_number("x", float("nan"), "mm" if "0,25" in expected else "", **bounds)
    assert german(str(caught.value)) == expected


def test_errors_and_notices_as_they_are_made() -> None:
    with pytest.raises(GearcadError) as caught:
        require_whole("teeth", 20.0, at_least=3, at_most=2000)
    assert german(str(caught.value)) == "teeth = 20: muss eine ganze Zahl von 3 bis 2000 sein (20 schreiben, nicht 20,0)"
    notice = Notice("undercut", "undercut: the involute begins at diameter 5.25 mm", "pinion")
    assert german(str(notice)) == "Ritzel: Unterschnitt: die Evolvente beginnt am Durchmesser 5,25 mm"


def test_values_take_the_places_that_the_language_gives_them() -> None:
    own = Catalogue({"{} of {} is {}": "{2} hat {1} von {0}", " (see {})": " (siehe {})"}, {"much": "viel"})
    assert own.text("A1 of B2 is much") == "viel hat B2 von A1"
    assert own.text("A1 of B2 is much (see C3)") == "viel hat B2 von A1 (siehe C3)"


def test_what_a_user_typed_stays() -> None:
    line = "pair.name = 'the pinion must be 3.5': must be a text"
    assert german(line) == "pair.name = 'the pinion must be 3.5': muss ein Text sein"


def test_a_long_line_of_any_words_is_answered_soon() -> None:
    """A hostile line has a bounded number of readings: it comes back, as it is or in parts."""
    line = "; ".join(f"must be {n}: at most {n} mm, or at least {n} of the pinion's {n}" for n in range(60))
    assert english_words(german(line)) <= english_words(line)


def test_english_needs_no_catalogue() -> None:
    assert catalogue("en") is None
    assert PageWords.of(PageLanguage.ENGLISH).message("must be a number") == "must be a number"
