"""What goes wrong on the page is told on the terminal: a line each, and no more than so many a minute."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable

from gearcad.errors import shown

__all__ = ["Lines"]

_MOST = 20
_WITHIN = 60.0
_LONGEST = 500
"""Signs of a line."""

_MORE = " (what else goes wrong within a minute is not told)"


class Lines(logging.Filter):
    """Lets so many records through within so many seconds, each as one printable line: a browser sends what it likes.

    The last of them says that others are not told.
    """

    def __init__(self, most: int = _MOST, within: float = _WITHIN, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__()
        self._most, self._within, self._clock = most, within, clock
        self._begin, self._count = clock(), 0

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether there is room for it; as one line from here on."""
        if (now := self._clock()) - self._begin >= self._within:
            self._begin, self._count = now, 0
        self._count += 1
        record.msg, record.args = _line(record) + (_MORE if self._count == self._most else ""), ()
        record.exc_info = record.exc_text = None
        return self._count <= self._most


def _line(record: logging.LogRecord) -> str:
    """What a record says, or the error that it is about; of the text of a traceback only its end."""
    error = record.msg if isinstance(record.msg, Exception) else record.exc_info[1] if record.exc_info else None
    if error is not None:
        told = f"a page failed ({type(error).__name__}: {error})"
    else:
        told = record.getMessage().strip()
        if told.startswith("Traceback "):
            told = told.splitlines()[-1]
    return shown(told, _LONGEST)
