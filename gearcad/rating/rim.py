"""The rim that carries the teeth: how thick it is, and the factor Y_B of a thin one (ISO 6336-3:2006, clause 9).

An external gear's rim is measured in tooth heights, that of a ring in normal modules.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass

from gearcad.geometry import Gear
from gearcad.notice import Notice
from gearcad.rating.editions import Edition

__all__ = [
    "RIM_LIMIT",
    "RING_RIM_LIMIT",
    "Rim",
    "outer_diameter",
    "rim_of",
    "rim_thickness_factor",
    "rim_thickness_ratio",
    "ring_rim_factor",
    "ring_rim_ratio",
]

RIM_LIMIT = 1.2
"""s_R/h_t (external gears) from which on a rim is as good as a solid body."""

RING_RIM_LIMIT = 3.5
"""s_R/m_n (rings) from which on it is."""

THINNEST = 0.5
"""s_R/h_t that the standard asks to stay above."""

THINNEST_RING = 1.75
"""s_R/m_n that it asks of rings to stay above."""


def rim_thickness_ratio(gear: Gear) -> float:
    """s_R/h_t: rim below the root circle, down to the web if one is given, else to bore and keyway, over the tooth height."""
    rim = gear.body.rim_thickness or (gear.root_diameter - gear.body.opening_diameter) / 2
    return rim / ((gear.tip_diameter - gear.root_diameter) / 2)


def rim_thickness_factor(ratio: float, edition: Edition) -> float:
    """Y_B = 1.6 ln(2.242 h_t/s_R) (clause 9) for s_R/h_t below 1.2, else 1; DIN 3990-3 has none."""
    return 1.0 if ratio >= RIM_LIMIT or edition is Edition.DIN_1987 else 1.6 * math.log(2.242 / ratio)


def ring_rim_ratio(gear: Gear) -> float | None:
    """s_R/m_n of a ring: from the root circle out to the rim diameter, or as given; None where neither is."""
    body = gear.body
    if body.rim_thickness:
        return body.rim_thickness / gear.normal_module
    return None if body.rim_diameter is None else (body.rim_diameter + gear.root_diameter) / 2 / gear.normal_module


def outer_diameter(ring: Gear) -> float:
    """Diameter (mm) of a ring's rim or, where none is given, of one as good as a solid body."""
    rim = ring.body.rim_diameter
    return ring.profile.root_diameter + 2 * RING_RIM_LIMIT * ring.normal_module if rim is None else rim


def ring_rim_factor(ratio: float, edition: Edition) -> float:
    """Y_B = 1.15 ln(8.324 m_n/s_R) (clause 9, to be verified) for s_R/m_n below 3.5, else 1; DIN 3990-3 has none."""
    return 1.0 if ratio >= RING_RIM_LIMIT or edition is Edition.DIN_1987 else 1.15 * math.log(8.324 / ratio)


@dataclass(frozen=True)
class Rim(ABC):
    """The rim of one gear, as thick as `ratio` says; None of a ring whose rim is not given."""

    ratio: float | None

    @abstractmethod
    def factor(self, edition: Edition) -> float:
        """Y_B."""

    @abstractmethod
    def notices(self, edition: Edition, where: str) -> Iterator[Notice]:
        """What to know of its strength."""

    @abstractmethod
    def not_covered(self) -> str:
        """Why the standard has no Y_B for it; "" where it has."""


class ExternalRim(Rim):
    """Below the teeth of an external gear; `ratio` s_R/h_t."""

    ratio: float

    def factor(self, edition: Edition) -> float:
        return rim_thickness_factor(self.ratio, edition)

    def notices(self, edition: Edition, where: str) -> Iterator[Notice]:
        if self.ratio < RIM_LIMIT:
            avoid = f"is at most {THINNEST:g}, which the standard asks to avoid"
            said = avoid if self.ratio <= THINNEST else f"weakens the root (below {RIM_LIMIT:g})"
            yield Notice("thin-rim", f"{self.ratio:.3g} tooth heights under the root {said}; {_known(self, edition)}", where)

    def not_covered(self) -> str:
        if self.ratio > THINNEST:
            return ""
        return f"Y_B holds for rims of more than {THINNEST:g} tooth heights under the root, here {self.ratio:.3g}"


class RingRim(Rim):
    """Outside the teeth of a ring; `ratio` s_R/m_n."""

    def factor(self, edition: Edition) -> float:
        return 1.0 if self.ratio is None else ring_rim_factor(self.ratio, edition)

    def notices(self, edition: Edition, where: str) -> Iterator[Notice]:
        if self.ratio is None:
            text = f"body.rim_diameter is not given: Y_B is 1, as of a rim of at least {RING_RIM_LIMIT:g} m_n"
            yield Notice("rim-not-given", text, where)
        elif self.ratio < RING_RIM_LIMIT:
            avoid = f"is at most {THINNEST_RING:g}, which the standard asks to avoid"
            said = avoid if self.ratio <= THINNEST_RING else f"weakens the root (below {RING_RIM_LIMIT:g})"
            yield Notice("thin-rim", f"{self.ratio:.3g} m_n outside the root {said}; {_known(self, edition)}", where)

    def not_covered(self) -> str:
        if self.ratio is None or self.ratio > THINNEST_RING:
            return ""
        return f"Y_B holds for rims of more than {THINNEST_RING:g} m_n outside the root, here {self.ratio:.3g}"


def _known(rim: Rim, edition: Edition) -> str:
    factor = rim.factor(edition)
    return f"Y_B = {factor:.4g}" if factor > 1 else "the standard chosen has no factor for it"


def rim_of(gear: Gear) -> Rim:
    """The rim of a gear or a ring."""
    return RingRim(ring_rim_ratio(gear)) if gear.internal else ExternalRim(rim_thickness_ratio(gear))
