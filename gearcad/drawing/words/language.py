"""Language: what sheets are written in."""

from __future__ import annotations

from enum import StrEnum

__all__ = ["Language"]


class Language(StrEnum):
    """By its code of ISO 639-1."""

    ENGLISH = "en"
    GERMAN = "de"
    SWEDISH = "sv"

    @property
    def decimal_mark(self) -> str:
        """What stands between a number's whole part and its fraction."""
        return "." if self is Language.ENGLISH else ","
