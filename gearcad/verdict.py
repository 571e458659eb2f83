"""Verdict: the result of judging something, and the one rule of the verdict on strength."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

__all__ = ["NOT_ASKED_WORDS", "Verdict", "strength_verdict", "together"]


class Verdict(Enum):
    """The result of judging something; `falls_short` decides exit statuses."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_JUDGED = "not judged"
    NOT_ASKED = "not asked for"

    @property
    def falls_short(self) -> bool:
        """Return whether a command ends with exit status 1: failed, or not judged although it was asked for."""
        return self in (Verdict.FAILED, Verdict.NOT_JUDGED)


def together(verdicts: Iterable[Verdict]) -> Verdict:
    """Failed if one is, and passed if all are.

    >>> together([Verdict.PASSED, Verdict.NOT_JUDGED]).value
    'not judged'
    """
    found = set(verdicts)
    if Verdict.FAILED in found:
        return Verdict.FAILED
    return Verdict.PASSED if found == {Verdict.PASSED} else Verdict.NOT_JUDGED


def strength_verdict(asked: bool, required: Iterable[Verdict], limits: Iterable[Verdict] = ()) -> Verdict:
    """Return the verdict on strength of a pair or a train: the only rule of ratings, checks, tables, page and reports.

    `required` are flanks and roots of all gears, and scuffing where its safety is required; each must be judged to pass.
    `limits` are further gates, such as local limits: one that is not passed fails, and none replaces a required verdict.

    >>> strength_verdict(True, [Verdict.PASSED, Verdict.NOT_JUDGED], [Verdict.PASSED]).value
    'not judged'
    >>> strength_verdict(False, [Verdict.NOT_JUDGED]).value
    'not asked for'
    """
    every = [*required, *limits]
    return together(every) if asked or Verdict.FAILED in every else Verdict.NOT_ASKED


NOT_ASKED_WORDS = "not asked for: no endurance limit, local limit, quality or required safety is given"
"""Words of a verdict on strength that nobody asked for."""
