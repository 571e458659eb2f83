"""Ctrl-C that is not lost: Python drops an exception that is raised while an object is thrown away, KeyboardInterrupt too."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

__all__ = ["remembered_interrupt"]


@contextmanager
def remembered_interrupt() -> Iterator[Callable[[], None]]:
    """What raises KeyboardInterrupt if Ctrl-C was pressed since, whatever became of the one that was raised then.

    Elsewhere than in the main thread, and where somebody else minds Ctrl-C, it does nothing.
    """
    if (
        threading.current_thread() is not threading.main_thread()
        or signal.getsignal(signal.SIGINT) is not signal.default_int_handler
    ):
        yield lambda: None
        return
    pressed = threading.Event()
    told = sys.unraisablehook

    def remember(number: int, frame: FrameType | None) -> None:
        pressed.set()
        signal.default_int_handler(number, frame)

    def tell(unraisable: Any) -> None:
        if not (pressed.is_set() and unraisable.exc_type is KeyboardInterrupt):
            told(unraisable)

    def look() -> None:
        if pressed.is_set():
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, remember)
    sys.unraisablehook = tell
    try:
        yield look
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        sys.unraisablehook = told
