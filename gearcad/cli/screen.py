"""What commands write to: whether it shows styles and bars, and how wide it is. Rich is imported for those that do."""

from __future__ import annotations

import os
from contextlib import suppress
from typing import TextIO

__all__ = ["shows_styles", "window_width"]

_USUAL_WIDTH = 80


def shows_styles(stream: TextIO) -> bool:
    """Whether a stream is a terminal, or is to be taken for one."""
    return bool(os.environ.get("FORCE_COLOR")) or stream.isatty()


def window_width() -> int:
    """The characters of a line: what COLUMNS says, or those of the terminal that any standard stream is."""
    if (given := os.environ.get("COLUMNS", "")).isdigit():
        return int(given)
    for number in range(3):
        with suppress(OSError):
            return os.get_terminal_size(number).columns
    return _USUAL_WIDTH
