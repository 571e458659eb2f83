"""Double helical teeth: two halves of opposite hand on one gear (ISO 21771, 4.1)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from gearcad.errors import GeometryError
from gearcad.ranges import Range
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields

__all__ = ["HALF_PITCH", "DoubleHelix"]

_GAP = Range("mm", 0, 10000)

HALF_PITCH = 0.5
"""The largest offset of halves, in pitches, alike in both directions."""

_OFFSET = Range("", -HALF_PITCH, HALF_PITCH)


@dataclass(frozen=True, kw_only=True)
class DoubleHelix:
    """What is between the halves of a double helical gear; without a gap width the teeth are those of a single helix.

    `gap_width` (mm) is part of the face width; 0 lets the halves meet in a sharp apex, in one section. `offset` is how far
    the teeth of the upper half (beyond the gap) are turned on, counter-clockwise, in pitches: 0 where each tooth goes on
    behind the gap, 0.5 where it faces a space; -0.5 is the same. `gap_diameter` (mm) is that of the gear between the halves,
    None a quarter of a module below the root circle. The gear's helix angle is that of the lower half, which begins at z = 0.
    End chamfers are on both ends of each half, but for an apex.
    Raises ParameterError, or GeometryError for an offset without a gap.
    """

    gap_width: Annotated[float | None, _GAP, Words("gap between the halves", "b_g", "")] = None
    offset: Annotated[float, _OFFSET, Words("offset of the upper half, in pitches")] = 0.0
    gap_diameter: Annotated[float | None, Range("mm", 0, 2e6, ends="(]"), Words("diameter between the halves")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        if not self.gap_width:
            for name in ("offset", "gap_diameter"):
                if value := getattr(self, name):
                    raise GeometryError("gap_width", self.gap_width, f"must be above 0 mm where {name} is {value:g}", "mm")

    @property
    def present(self) -> bool:
        """Whether there are two halves."""
        return self.gap_width is not None
