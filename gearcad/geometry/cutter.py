"""The pinion-type shaper cutter, as one gives it (ISO 53 has none: its counterpart is a rack)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from gearcad.ranges import Range, Whole
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields

__all__ = ["ShaperCutter"]

_SHIFT = Range("", -5, 5)
_RADIUS = Range("", 0, 5)


@dataclass(frozen=True, kw_only=True)
class ShaperCutter:
    """What shapes the roots of a gear: number of teeth z_0, profile shift x_0, radius of the tip corner in normal modules.

    Without teeth there is no shaper: an external gear is cut by the counterpart of its rack, a ring has a form root, whose
    fillet is the corner itself. Without a tip radius the corner has that of the rack, or the full radius where that is
    smaller. Raises ParameterError.
    """

    teeth: Annotated[int | None, Whole(3, 2000), Words("cutter, number of teeth", "z_0")] = None
    profile_shift: Annotated[float, _SHIFT, Words("cutter, profile shift coefficient", "x_0")] = 0.0
    tip_radius: Annotated[float | None, _RADIUS, Words("cutter, tip radius", "ρ_aP0*")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)

    @property
    def present(self) -> bool:
        """Whether anything of a cutter was given."""
        return self.teeth is not None or self.tip_radius is not None
