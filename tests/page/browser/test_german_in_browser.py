"""The German page in a browser: no English sentence on it, whatever design or fault it shows, and decimal commas."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from support.specs import starter_specs

from gearcad.core.messages import messages_of
from gearcad.page.folder import pack

STARTERS = {path.stem: path.read_text(encoding="utf-8") for path in starter_specs()}

ENGLISH = frozenset(
    "the of and is are must be with at least most its for from not no that which this than below above where by to has have on"
    " it or were been does then only here there given nothing between without".split()
)
"""Common English words that are no German ones."""

FAULTS = {
    "one tooth too few": ("teeth = 21", "teeth = 2"),
    "no number": ("teeth = 21", 'teeth = "many"'),
    "half a tooth": ("teeth = 21", "teeth = 21.5"),
    "unknown key": ("teeth = 21", "teeth = 21\nteeths = 3"),
    "unknown table": ("[pinion]", "[pinon]"),
    "broken text": ("teeth = 21", "teeth 21"),
    "comma in the text": ("teeth = 21", "teeth = 2,1"),
    "axes too near": ("centre_distance = 97", "centre_distance = 90"),
    "twice": ("teeth = 21", "teeth = 21\nteeth = 22"),
    "other material": ("[material]", '[material]\nyoungs_modulus = "steel"'),
}
"""Changes of the reducer that make a fault."""

_SHOWN = """() => {
  const found = [];
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walk.nextNode(); node; node = walk.nextNode()) {
    const owner = node.parentElement;
    if (owner.closest("script, style, .cm-editor, textarea, code, .key, option, datalist, [id$=popup], [lang=en]")) continue;
    if (node.textContent.trim()) found.push(node.textContent.trim().replaceAll("\\u00ad", ""));
  }
  for (const each of document.querySelectorAll("[title], [aria-label], [placeholder]"))
    for (const name of ["title", "aria-label", "placeholder"])
      if (each.getAttribute(name) && !each.closest(".cm-editor")) found.push(each.getAttribute(name).replaceAll("\\u00ad", ""));
  return [...new Set(found)];
}"""

_TEMPLATES = [english.split("{}") for english in messages_of("de")["messages"] if len(english.replace("{}", "")) > 20]
"""Pieces of English messages between what is put into them."""


def english_texts(texts: list[str]) -> list[str]:
    """Return the texts with English words, or of an English template of a message."""
    return list(filter(_is_english, texts))


@cache
def _is_english(text: str) -> bool:
    return _has_english_words(text) or any(_is_made_of(text, pieces) for pieces in _TEMPLATES)


def _is_made_of(text: str, pieces: list[str]) -> bool:
    """Return whether a text is these pieces with something between each two, in a time that grows with its length only."""
    first, *others = pieces
    if not others:
        return text == first
    end = len(text) - len(others[-1])
    if not (text.startswith(first) and text.endswith(others[-1])):
        return False
    at = len(first)
    for piece in others[:-1]:
        found = text.find(piece, at + 1)
        if found < 0:
            return False
        at = found + len(piece)
    return at < end


def test_a_text_is_known_by_its_template() -> None:
    assert _is_made_of("must be 3 mm", ["must be ", " mm"]) and _is_made_of("a-b-c", ["a", "b", "c"])
    assert not _is_made_of("must be  mm", ["must be ", "  mm"]) and not _is_made_of("ab", ["a", "b"])


def _has_english_words(text: str) -> bool:
    plain = re.sub(r"'[^']*'|\"[^\"]*\"|`[^`]*`", "", text)
    return bool(ENGLISH.intersection(re.findall(r"(?<![\w.\[-])[a-z]+(?![\w.\]-])", plain)))


def _open(tab: Any, name: str, text: str) -> None:
    tab.page.goto("about:blank")
    tab.page.goto(f"{tab.address}?lang=de&design={pack(name, text)}")
    tab.page.wait_for_selector("html[lang=de]", state="attached")
    tab.page.wait_for_selector(".gear-sheet tr, .inputs .fault, .spec-fault", state="attached")
    tab.page.wait_for_timeout(1500)


@pytest.mark.parametrize(
    "name",
    [pytest.param(each, marks=[] if each == "reducer-21-43" else pytest.mark.long) for each in STARTERS],
)
def test_the_page_of_a_starter_is_german(tab: Any, name: str) -> None:
    _open(tab, name, STARTERS[name])
    texts = tab.page.evaluate(_SHOWN)
    assert len(texts) > 50
    assert english_texts(texts) == []
    cells = tab.page.locator(".gear-sheet td").all_inner_texts()
    assert not [cell for cell in cells if re.fullmatch(r"[-+−]?\d+\.\d+", cell.strip())]


def test_faults_are_german(tab: Any, tmp_path: Path) -> None:
    """The first comes by a link, the others are opened in the same page; each names its file."""
    text = STARTERS["reducer-21-43"]
    for number, (what, (good, bad)) in enumerate(FAULTS.items()):
        assert good in text, what
        name, faulty = f"faulty-{number}", text.replace(good, bad, 1)
        if number:
            (tmp_path / f"{name}.toml").write_text(faulty, encoding="utf-8")
            tab.page.locator('.files input[type="file"]').first.set_input_files(tmp_path / f"{name}.toml")
        else:
            _open(tab, name, faulty)
        tab.page.wait_for_selector(f":is(.fault, .spec-fault):has-text('{name}.toml')", state="attached")
        tab.page.wait_for_function("name => document.querySelector('.bar .name').textContent === name", arg=name)
        assert english_texts(tab.page.evaluate(_SHOWN)) == [], what


@pytest.mark.long
def test_lists_of_lists_have_decimal_commas(tab: Any) -> None:
    text = STARTERS["reducer-21-43"].replace("[rating]", "[rating]\nspectrum = [[0.1, 1.25], [0.9, 0.8]]", 1)
    _open(tab, "spectrum", text)
    assert tab.page.locator('[id="in-rating.spectrum"]').input_value() == "0,1:1,25 0,9:0,8"
