"""FileOptions: how files are made."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.errors import require_number, require_switch

__all__ = ["FileOptions"]


@dataclass(frozen=True, kw_only=True)
class FileOptions:
    """How files are made; which of it matters to a format stands with the format.

    `chord_error` (mm) bounds the facets; `bracket` puts a pair on two shafts with a bracket; `circles` draws the tip,
    reference, base and root circles beside a section. Of a planetary train, `carrier` makes a carrier with pins, `exploded`
    moves members apart along the axis, and `turning` lets the scene turn. Raises ParameterError for a chord error that is not
    positive.
    """

    chord_error: float = 0.005
    bracket: bool = False
    circles: bool = False
    carrier: bool = False
    exploded: bool = False
    turning: bool = False

    def __post_init__(self) -> None:
        require_number("chord_error", self.chord_error, "mm", above=0)
        for name in ("bracket", "circles", "carrier", "exploded", "turning"):
            require_switch(name, getattr(self, name))
