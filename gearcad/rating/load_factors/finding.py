"""Finding: a load factor or two, how they were found, and what to know of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from gearcad.notice import Notice

__all__ = ["ASSUMED", "GIVEN", "Finding"]

GIVEN = "given"
ASSUMED = "assumed"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """`factors` and the `details` behind them under their symbols, µm, N/mm, N/(mm·µm), rpm, kg/mm; a mapping is of both gears.

    `sources` are the clauses that factors are from. `unknown` are symbols of factors in whose place 1 stands, `verify` those
    that rest on a text that was not at hand.
    """

    factors: Mapping[str, float]
    sources: Mapping[str, str]
    details: Mapping[str, float | Mapping[str, float]] = field(default_factory=dict)
    unknown: tuple[str, ...] = ()
    notices: tuple[Notice, ...] = ()
    assumed: tuple[str, ...] = ()
    verify: tuple[str, ...] = ()
