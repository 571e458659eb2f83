"""The sweep of double helical teeth without a gap: that of one half, and its mirror image beyond the middle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry.gear import Gear
from gearcad.geometry.halves import halves
from gearcad.solids.exact.outline import FlankSpan, Piece
from gearcad.solids.exact.sweep import Sweep, sweep_of

__all__ = ["MirroredSweep", "whole_sweep"]


def whole_sweep(gear: Gear, pieces: Sequence[Piece]) -> Sweep:
    """How the pieces of a gear's tooth 0 are swept over its face width."""
    if gear.double_helix.present:
        return MirroredSweep(gear, sweep_of(halves(gear)[0].gear, pieces))
    return sweep_of(gear, pieces)


class MirroredSweep(Sweep):
    """The lower half's sweep up to the middle of the face width, and the same turned back from there."""

    def __init__(self, gear: Gear, lower: Sweep) -> None:
        super().__init__(gear)
        self.lower = lower
        self.heights = (*lower.heights, *(self.width - z for z in reversed(lower.heights[:-1])))

    def turn(self, piece: FlankSpan, u: Floats, z: Floats) -> Floats:
        return self.lower.turn(piece, u, np.minimum(z, self.width - z))

    def patches(self, piece: FlankSpan) -> list[Floats]:
        lower = self.lower.patches(piece)
        return [*lower, *(self._mirrored(patch) for patch in reversed(lower))]

    def section(self, piece: FlankSpan, which: int) -> Floats:
        lower = self.lower.section(piece, 0)
        return self._mirrored(lower)[::-1] if which else lower

    def side(self, piece: FlankSpan, u: int, place: tuple[float, float], stretch: int) -> tuple[Floats, Floats]:
        last = len(self.heights) - 2
        poles, angles = self.lower.side(piece, u, place, min(stretch, last - stretch))
        return (poles, angles) if 2 * stretch < last else (self._mirrored(poles), angles[::-1])

    def _mirrored(self, poles: Floats) -> Floats:
        """Poles (..., m + 1, 3), upwards, of what is the mirror image about the middle."""
        return poles[..., ::-1, :] * [1, 1, -1] + [0, 0, self.width]
