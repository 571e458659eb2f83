"""Size: a length of the part, as a dimension says it. Lengths in mm."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Size"]


@dataclass(frozen=True, kw_only=True)
class Size:
    """A nominal size, the code of its fit ("H7") and its limit deviations; without deviations general tolerances hold.

    `prefix` stands before it ("⌀", "R"), `suffix` behind ("×45°"). `envelope` is the E in a ring of ISO 14405-1, `reference`
    puts it in brackets: it is for information. `exact` puts it in a
    box: what is there has a geometrical tolerance instead (ISO 1101).
    """

    value: float
    prefix: str = ""
    suffix: str = ""
    fit: str = ""
    upper: float | None = None
    lower: float | None = None
    decimals: int = 3
    envelope: bool = False
    reference: bool = False
    exact: bool = False
