"""What a tab leaves to the page that it opens next, in another language: its designs, and its runs, which go on."""

from __future__ import annotations

import secrets
import threading
from typing import NamedTuple

from gearcad.page.beside_design import BesideDesign
from gearcad.page.runs import Runs

__all__ = ["Handed", "hand_over", "take_over"]

_SECONDS = 60.0
"""Until nobody comes for it any more."""


class Handed(NamedTuple):
    """A workbench with what is kept beside it, and the runs of its session."""

    beside: BesideDesign
    runs: Runs


_HANDED: dict[str, Handed] = {}


def hand_over(handed: Handed) -> str:
    """Leave it under a key, which nobody else knows; who does not come in time finds nothing."""
    key = secrets.token_urlsafe(12)
    _HANDED[key] = handed
    waiting = threading.Timer(_SECONDS, _drop, (key,))
    waiting.daemon = True
    waiting.start()
    return key


def take_over(key: str) -> Handed | None:
    """What was left under a key, once."""
    return _HANDED.pop(key, None)


def _drop(key: str) -> None:
    if (left := take_over(key)) is not None:
        left.runs.close()
