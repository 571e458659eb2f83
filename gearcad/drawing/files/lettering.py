"""Which font of a PDF has a letter, and in which order letters stand there: a PDF does not turn or join them itself."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable
from enum import Enum
from functools import cache
from itertools import groupby, pairwise
from typing import NamedTuple

from gearcad.drawing.shapes.font import has_glyph

__all__ = ["Face", "Run", "runs", "unshowable"]


class Face(Enum):
    """Fonts. Those of East Asia are not in the file: who reads it has them, or some like them."""

    SHEET = "DejaVuSans"
    CHINESE = "STSong-Light"
    JAPANESE = "HeiseiMin-W3"
    KOREAN = "HYSMyeongJo-Medium"


class Run(NamedTuple):
    """Letters of one font, in the order in which they stand from left to right."""

    face: Face
    letters: str


_MISSING = "□"

_HANGUL = ((0x1100, 0x11FF), (0x3130, 0x318F), (0xAC00, 0xD7A3))
_KANA = ((0x3040, 0x30FF), (0x31F0, 0x31FF), (0xFF66, 0xFF9F))
_HAN = ((0x3000, 0x303F), (0x4E00, 0x9FFF), (0xFF00, 0xFF65))

_RIGHT_TO_LEFT = ("R", "AL")
_DIGITS = ("EN", "AN")


def runs(words: str) -> list[Run]:
    """A text as its letters stand, from left to right. What no font has is a small box.

    >>> runs("Rad 齿轮 1")
    [Run(face=<Face.SHEET: 'DejaVuSans'>, letters='Rad '), Run(face=<Face.CHINESE: 'STSong-Light'>, letters='齿轮'), \
Run(face=<Face.SHEET: 'DejaVuSans'>, letters=' 1')]
    """
    han = Face.JAPANESE if any(_within(letter, _KANA) for letter in words) else Face.CHINESE
    faces = [(_face(letter, han), letter) for letter in _as_seen(words)]
    found = [(face or Face.SHEET, letter if face else _MISSING) for face, letter in faces]
    return [Run(face, "".join(letter for _, letter in row)) for face, row in groupby(found, key=lambda pair: pair[0])]


def unshowable(words: Iterable[str]) -> dict[Face | None, str]:
    """The letters of texts that the font of the sheets lacks, by the face that has them; None for those that no face has."""
    letters = sorted({letter for text in words for letter in text if not has_glyph(letter)})
    han = Face.JAPANESE if any(_within(letter, _KANA) for letter in letters) else Face.CHINESE
    found: dict[Face | None, str] = {}
    for letter in letters:
        face = _face(letter, han)
        found[face] = found.get(face, "") + letter
    return found


def _face(letter: str, han: Face) -> Face | None:
    """The font that has a letter."""
    if has_glyph(letter):
        return Face.SHEET
    for face, ranges in ((Face.KOREAN, _HANGUL), (Face.JAPANESE, _KANA), (han, _HAN)):
        if _within(letter, ranges):
            return face
    return None


def _within(letter: str, ranges: tuple[tuple[int, int], ...]) -> bool:
    return any(low <= ord(letter) <= high for low, high in ranges)


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
