"""Mesh load factors K_gamma that rules give for numbers of planets, to be seen beside a computed one; none is a default."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

__all__ = ["PUBLISHED", "PublishedFactor", "PublishedFactors", "published_factors"]


@dataclass(frozen=True, kw_only=True)
class PublishedFactor:
    """K_gamma of a source for the planets of a train; `recalled`: not read in the source itself, verify it."""

    source: str
    factor: float
    recalled: bool

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {"source": self.source, "factor": self.factor, "recalled": self.recalled}


@dataclass(frozen=True, kw_only=True)
class PublishedFactors:
    """K_gamma by the number of planets, up to `most` of them; that of the last key holds for more where `most` allows."""

    source: str
    by_planets: Mapping[int, float]
    most: int
    recalled: bool

    def of(self, planets: int) -> PublishedFactor | None:
        """That of a number of planets; None where the source has none."""
        known = [count for count in self.by_planets if count <= planets]
        if not known or planets > self.most:
            return None
        return PublishedFactor(source=self.source, factor=self.by_planets[max(known)], recalled=self.recalled)


_ANY = 10**6

PUBLISHED = (
    PublishedFactors(
        source="ABS, as the FVA-Workbench applies it",
        by_planets={1: 1.0, 4: 1.2, 5: 1.3, 6: 1.4},
        most=_ANY,
        recalled=False,
    ),
    PublishedFactors(
        source="IEC 61400-4",
        by_planets={3: 1.10, 4: 1.25, 5: 1.35, 6: 1.44},
        most=6,
        recalled=True,
    ),
)
"""ABS is read in the help of the FVA-Workbench (attribute abs_force_distribution_factor). ANSI/AGMA 6123 has a table by level
of application, which was not at hand; ISO 6336-1 itself has none."""


def published_factors(planets: int) -> tuple[PublishedFactor, ...]:
    """What the sources have for so many planets.

    >>> [(each.factor, each.recalled) for each in published_factors(4)]
    [(1.2, False), (1.25, True)]
    """
    found = (table.of(planets) for table in PUBLISHED)
    return tuple(each for each in found if each is not None)
