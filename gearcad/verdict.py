"""Verdict: what is said of something that is judged."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

__all__ = ["Verdict", "together"]


class Verdict(Enum):
    """What was judged has passed or failed; of what was not, nothing is said."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_JUDGED = "not judged"


def together(verdicts: Iterable[Verdict]) -> Verdict:
    """Failed if one is, and passed if all are.

    >>> together([Verdict.PASSED, Verdict.NOT_JUDGED]).value
    'not judged'
    """
    found = set(verdicts)
    if Verdict.FAILED in found:
        return Verdict.FAILED
    return Verdict.PASSED if found == {Verdict.PASSED} else Verdict.NOT_JUDGED
