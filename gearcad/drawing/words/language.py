"""Language: what sheets are written in."""

from __future__ import annotations

from enum import Enum

__all__ = ["Language"]


class Language(Enum):
    """By its code of ISO 639-1."""

    ENGLISH = "en"
    GERMAN = "de"
    SWEDISH = "sv"

    @property
    def decimal_mark(self) -> str:
        """What stands between a number's whole part and its fraction."""
        return "." if self is Language.ENGLISH else ","
