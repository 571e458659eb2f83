"""Many numbers as text of fixed columns, by tables of four digits: ten times as fast as Python's own formatting."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats
from gearcad.errors import ParameterError

__all__ = ["DECIMALS", "Letters", "chunks", "decimals", "decimals_width", "lines", "wholes"]

Letters = NDArray[np.uint8]
"""Characters of ASCII; those of a column are the last axis."""

DECIMALS = 12
"""Digits behind the point: 1e-12 mm is what a float holds of a gear. CalculiX reads 20 characters of a number."""

_CHUNK = 1 << 14
"""Rows at a time: text that fits into the cache is written fastest."""

_MOST_DIGITS = 6
"""Before the point."""

_WITH_ZEROS, _WITH_BLANKS = (np.array([form % k for k in range(10000)], "S4").view(np.uint32) for form in (b"%04d", b"%4d"))
_BLANKS = np.frombuffer(b"    ", np.uint32)[0]


def chunks(stop: int, start: int = 0) -> Iterator[slice]:
    """Rows from `start` to `stop`, as many at a time as are written fastest."""
    return (slice(at, min(at + _CHUNK, stop)) for at in range(start, stop, _CHUNK))


def wholes(numbers: NDArray[np.integer], width: int) -> Letters:
    """Whole numbers (...), not negative, below 2**32 and right-aligned in columns (..., width), which must be wide enough."""
    words = -(-width // 4)
    text = np.empty((*numbers.shape, words), np.uint32)
    rest = numbers.astype(np.uint32)
    for word in reversed(range(words)):
        rest, low = rest // 10000, rest % 10000
        first = rest == 0
        text[..., word] = np.where(first, _WITH_BLANKS[low], _WITH_ZEROS[low])
        if word < words - 1:
            text[..., word][first & (low == 0)] = _BLANKS
    return text.view(np.uint8)[..., 4 * words - width :]


def decimals_width(largest: float) -> int:
    """Width of the columns that hold numbers up to this size (mm). Raises ParameterError from a kilometre on."""
    whole = round(largest, DECIMALS)  # as it is written: 9.9999999999999 has two digits before the point
    if not whole < 10**_MOST_DIGITS:
        raise ParameterError("mesh", largest, f"must lie within {10**_MOST_DIGITS} mm of the origin", "mm")
    return len(str(int(whole))) + 2 + DECIMALS


def decimals(numbers: Floats, width: int) -> Letters:
    """Numbers (...) with 12 decimals, right-aligned in columns (..., width), whose width is that of `decimals_width`."""
    scaled = np.rint(numbers * 10.0**DECIMALS)
    rest = np.abs(scaled).astype(np.int64)
    text = np.empty((*numbers.shape, DECIMALS // 4), np.uint32)
    for word in reversed(range(DECIMALS // 4)):
        rest, low = rest // 10000, rest % 10000
        text[..., word] = _WITH_ZEROS[low]
    before = _before_point(width - DECIMALS - 2)
    # A number that rounds to zero has no sign.
    return np.concatenate([before[(scaled < 0).view(np.int8), rest], text.view(np.uint8)], axis=-1)


@cache
def _before_point(digits: int) -> Letters:
    """Text (2, n, digits + 2) of the numbers up to so many digits with their point, without and with a minus."""
    texts = [f"{sign}{k}.".rjust(digits + 2) for sign in ("", "-") for k in range(10**digits)]
    return np.frombuffer("".join(texts).encode(), np.uint8).reshape(2, 10**digits, digits + 2)


def lines(*pieces: bytes | Letters) -> str:
    """Text of as many lines as the columns among the pieces have rows (n, ...); what is the same in each line is bytes."""
    columns = [piece if isinstance(piece, bytes) else piece.reshape(len(piece), -1) for piece in (*pieces, b"\n")]
    rows = next(len(column) for column in columns if not isinstance(column, bytes))
    text = np.empty((rows, sum(len(each) if isinstance(each, bytes) else each.shape[1] for each in columns)), np.uint8)
    place = 0
    for column in columns:
        letters = np.frombuffer(column, np.uint8) if isinstance(column, bytes) else column
        text[:, place : place + letters.shape[-1]] = letters
        place += letters.shape[-1]
    return text.tobytes().decode("ascii")
