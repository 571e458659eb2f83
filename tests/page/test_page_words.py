"""The words of the page: which language a browser gets, and that no word lacks another language, or is left over."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from gearcad.page.words import Language, Words, language_of
from gearcad.shipped import PACKAGE


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
    german = Words.of(Language.GERMAN)
    assert german["find a key"] == "Eingabe suchen"
    assert german["no word of the page"] == "no word of the page"
    assert Words.of(Language.ENGLISH)["find a key"] == "find a key"


def test_every_word_of_the_page_has_its_german() -> None:
    assert set(Words.of(Language.GERMAN).table) == _own_words()


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
