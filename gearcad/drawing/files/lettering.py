"""Letters of a PDF as they stand there: a PDF does not turn or join them itself, nor take those that its font lacks."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable
from functools import cache
from itertools import pairwise

from gearcad.drawing.shapes.font import has_glyph

__all__ = ["set_letters", "unshowable"]

_MISSING = "□"

_RIGHT_TO_LEFT = ("R", "AL")
_DIGITS = ("EN", "AN")


def set_letters(words: str) -> str:
    """A text as its letters stand, from left to right. What the font of the sheets lacks is a small box.

    Fonts of other scripts are not named in the PDF instead: without them, readers and printers leave the letters out.

    >>> set_letters("Rad 齿轮 1")
    'Rad □□ 1'
    """
    return "".join(letter if has_glyph(letter) else _MISSING for letter in _as_seen(words))


def unshowable(words: Iterable[str]) -> str:
    """The letters of texts that the font of the sheets lacks, each once."""
    return "".join(sorted({letter for text in words for letter in text if not has_glyph(letter)}))


def _as_seen(words: str) -> str:
    """From left to right, what is written from right to left turned round, but not its numbers; Arabic letters joined.

    A simple case of the Unicode bidirectional algorithm (UAX 9): one level, in a line that runs from left to right.
    """
    kinds = [unicodedata.bidirectional(letter) for letter in words]
    at = [place for place, kind in enumerate(kinds) if kind in _RIGHT_TO_LEFT]
    if not at:
        return words
    # Words that run to the right part what runs to the left: "אב cd אב".
    spans, start = [], at[0]
    for before, after in pairwise(at):
        if "L" in kinds[before:after]:
            spans.append((start, before + 1))
            start = after
    spans.append((start, at[-1] + 1))
    found, end = "", 0
    for low, high in spans:
        while high < len(words) and kinds[high] == "NSM":
            high += 1
        found += words[end:low] + _turned(_joined(words[low:high]))
        end = high
    return found + words[end:]


def _turned(words: str) -> str:
    """Last first; marks stay behind the letters on which they stand, digits in their order, brackets open to the other side."""
    parts: list[str] = []
    for letter in words:
        kind = unicodedata.bidirectional(letter)
        if parts and (kind == "NSM" or (kind in _DIGITS and unicodedata.bidirectional(parts[-1][-1]) in _DIGITS)):
            parts[-1] += letter
        else:
            parts.append(_BRACKETS.get(letter, letter))
    return "".join(reversed(parts))


_BRACKETS = dict(zip("()[]{}<>", ")(][}{><", strict=True))


def _joined(words: str) -> str:
    """Arabic letters in the forms that they have between their neighbours."""
    forms = [_forms().get(letter, {}) for letter in words]
    found = ""
    for place, letter in enumerate(words):
        before = place > 0 and "initial" in forms[place - 1] and "final" in forms[place]
        after = place + 1 < len(words) and "initial" in forms[place] and "final" in forms[place + 1]
        name = ("isolated", "initial", "final", "medial")[2 * before + after]
        found += forms[place].get(name, letter)
    return found


@cache
def _forms() -> dict[str, dict[str, str]]:
    """The forms of letters, as Unicode has them for programs that do not join."""
    found: dict[str, dict[str, str]] = {}
    for code in (*range(0xFB50, 0xFC00), *range(0xFE80, 0xFEF5)):
        name, _, origin = unicodedata.decomposition(chr(code)).partition("> ")
        if len(origin) == 4:
            found.setdefault(chr(int(origin, 16)), {})[name[1:]] = chr(code)
    return found
