"""What the page tells on the terminal."""

from __future__ import annotations

import logging

from gearcad.page.server import LogLimiter


class _Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


def _told(lines: LogLimiter, message: object, error: Exception | None = None) -> str | None:
    record = logging.LogRecord(
        "nicegui", logging.ERROR, "", 0, message, (), None if error is None else (type(error), error, None)
    )
    return record.getMessage() if lines.filter(record) else None


def test_no_browser_floods_the_terminal() -> None:
    clock = _Clock()
    lines = LogLimiter(most=3, within=60.0, clock=clock)
    told = [_told(lines, "x") for _ in range(1000)]
    assert told[:2] == ["x", "x"]
    assert told[2] == "x (what else goes wrong within a minute is not told)"
    assert told[3:] == [None] * 997
    clock.now = 60.0
    assert _told(lines, "x") == "x"


def test_each_is_a_line_that_moves_no_cursor() -> None:
    lines = LogLimiter()
    assert _told(lines, "\x1b[2J\nforged: line") == "\\x1b[2J\\nforged: line"
    assert _told(lines, ValueError("a\nb")) == "a page failed (ValueError: a\\nb)"
    assert _told(lines, "while x", KeyError("id")) == "a page failed (KeyError: 'id')"
    assert _told(lines, "Traceback (most recent call last):\n  File x\nValueError: y\n") == "ValueError: y"
    assert len(_told(lines, "x" * 1_000_000) or "") == 500
