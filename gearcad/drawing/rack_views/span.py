"""Span: a rack along its length on paper; a long one is broken in its middle (ISO 128-3). Lengths of part and paper in mm."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from gearcad.geometry import Rack

__all__ = ["Span"]

_SHOWN = 6.0
"""Greatest length that is shown, over the larger of height and face width."""

_PITCHES = 7
"""So many pitches are shown at least."""

_WORTH = 1.6
"""A rack is broken only where it is that much longer than what would be shown of it."""

_GAP = 3.0
"""Between the two parts (mm of paper)."""

_END_TEETH = 2
"""So many whole teeth are drawn at each end."""

_ROUNDING = 1e-9
"""Share of a pitch that is nothing."""


@dataclass(frozen=True)
class Span:
    """One looks at the end face at z = face width, x to the right; the middle of what is shown is at the origin."""

    rack: Rack
    scale: float

    @cached_property
    def kept(self) -> float | None:
        """What is shown at each end (mm of the part); None of a rack that is shown whole."""
        rack = self.rack
        shown = max(_SHOWN * max(rack.total_height, rack.face_width), _PITCHES * rack.transverse_pitch)
        return shown / 2 if rack.length > _WORTH * shown else None

    @property
    def right(self) -> float:
        """Where the right end is on paper; the left one is as far to the left."""
        if self.kept is None:
            return self.scale * self.rack.length / 2
        return self.scale * self.kept + _GAP / 2

    def across(self, place: float) -> float:
        """Of a place along the rack; of those between the ends that are shown, the nearest of them."""
        if self.kept is None or place <= self.rack.length / 2:
            return -self.right + self.scale * (place if self.kept is None else min(place, self.kept))
        return self.right - self.scale * min(self.rack.length - place, self.kept)

    @property
    def parts(self) -> tuple[tuple[float, float], ...]:
        """From where to where the rack is shown: all of it, or both ends."""
        length = self.rack.length
        return ((0.0, length),) if self.kept is None else ((0.0, self.kept), (length - self.kept, length))

    # ------------------------------------------------------------------ teeth

    @property
    def first_middle(self) -> float:
        """The middle of the first whole tooth at the end face that one sees."""
        pitch = self.rack.transverse_pitch
        shift = (self.rack.drift * self.rack.face_width) % pitch
        near = _ROUNDING * pitch
        return pitch / 2 + (shift if near < shift < pitch - near else 0.0)

    @property
    def whole_teeth(self) -> int:
        """How many are whole at that end face."""
        pitch = self.rack.transverse_pitch
        return math.floor((self.rack.length - self.first_middle) / pitch + 0.5 + _ROUNDING)

    @property
    def toothed(self) -> tuple[tuple[float, float], ...]:
        """From where to where teeth are drawn: at both ends, or all along a rack of few."""
        pitch = self.rack.transverse_pitch
        low = self.first_middle + (_END_TEETH - 0.5) * pitch
        high = self.first_middle + (self.whole_teeth - _END_TEETH - 0.5) * pitch
        if high - low < pitch:
            return ((0.0, self.rack.length),)
        return (0.0, low), (high, self.rack.length)
