"""How long texts are in the font of the sheets, DejaVu Sans, which comes with matplotlib. Lengths in mm of paper."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from fontTools.ttLib import TTFont

__all__ = ["CAPITAL_HEIGHT", "STRETCH", "Reach", "fitted", "font_file", "has_glyph", "reach", "text_width"]

STRETCH = 0.82
"""Width of the letters over that of the font: ISO 3098 has narrower ones."""

CAPITAL_HEIGHT = 1493 / 2048
"""Height of capital letters over the size of the font."""

_EM = 2048
_ELLIPSIS = "…"


class Reach(NamedTuple):
    """How far letters reach below and above the line on which they stand, over their height."""

    below: float
    above: float


def font_file() -> Path:
    """The file of the font. Nothing of matplotlib is imported."""
    package = find_spec("matplotlib")
    assert package is not None and package.submodule_search_locations is not None  # a dependency
    return Path(package.submodule_search_locations[0], "mpl-data", "fonts", "ttf", "DejaVuSans.ttf")


def has_glyph(letter: str) -> bool:
    """Whether the font has this letter."""
    return ord(letter) in _glyph_names()


def text_width(text: str, height: float, stretch: float = STRETCH) -> float:
    """Length of a text of this height of its capitals. A letter that the font lacks is taken to be as wide as it is high."""
    return sum(map(_advance, text)) * height / CAPITAL_HEIGHT * stretch


def reach(text: str) -> Reach:
    """How far a text reaches below and above its line."""
    extents = [_extent(letter) for letter in text if not letter.isspace()] or [(0.0, CAPITAL_HEIGHT)]
    return Reach(
        max(0.0, *(-low for low, _ in extents), 0.0) / CAPITAL_HEIGHT, max(high for _, high in extents) / CAPITAL_HEIGHT
    )


def fitted(text: str, height: float, room: float, stretch: float = STRETCH) -> tuple[str, bool]:
    """A text that is no longer than `room`, shortened with an ellipsis if it must be, and whether it was."""
    if text_width(text, height, stretch) <= room:
        return text, False
    for length in range(len(text) - 1, -1, -1):
        shorter = text[:length].rstrip() + _ELLIPSIS
        if text_width(shorter, height, stretch) <= room:
            return shorter, True
    return "", True


@cache
def _font() -> TTFont:
    from fontTools.ttLib import TTFont

    return TTFont(font_file(), lazy=True)


@cache
def _glyph_names() -> dict[int, str]:
    names: dict[int, str] = _font().getBestCmap()
    return names


@cache
def _advance(letter: str) -> float:
    """Over the size of the font."""
    name = _glyph_names().get(ord(letter))
    return 1.0 if name is None else float(_font()["hmtx"][name][0] / _EM)


@cache
def _extent(letter: str) -> tuple[float, float]:
    """The least and the greatest height of a letter over the size of the font."""
    name = _glyph_names().get(ord(letter))
    if name is None:
        return -0.2, 0.85
    glyph = _font()["glyf"][name]
    return getattr(glyph, "yMin", 0) / _EM, getattr(glyph, "yMax", 0) / _EM
