"""The side view of a rack at z = 0, as one closed contour of true arcs."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.errors import require_number
from gearcad.geometry.rack import Rack
from gearcad.geometry.rack_profile import RackCurveKind
from gearcad.solids.files.arcs import Arcs, arcs_of, joined
from gearcad.solids.rack_plan import SNAP, Piece, outline_pieces

__all__ = ["rack_contour"]


@dataclass(frozen=True)
class _FilletPart:
    """A fillet from left to right between two of its angles from the lowest point (rad, in the normal section)."""

    piece: Piece
    first: float
    last: float
    kind: RackCurveKind = RackCurveKind.FILLET

    def points(self, s: ArrayLike) -> Floats:
        theta, fillet = self._theta(s), self.piece.fillet
        assert fillet is not None
        across = self.piece.centre + fillet.radius * np.sin(theta) * fillet.stretch
        return np.stack([across, fillet.y - fillet.radius * np.cos(theta)], -1)

    def direction(self, s: ArrayLike) -> Floats:
        theta, fillet = self._theta(s), self.piece.fillet
        assert fillet is not None
        return np.arctan2(np.sin(theta), np.cos(theta) * fillet.stretch)

    def _theta(self, s: ArrayLike) -> Floats:
        return self.first + np.asarray(s, float) * (self.last - self.first)


def rack_contour(rack: Rack, accuracy: float = 0.0005) -> Floats:
    """Closed contour (n, 3), counter-clockwise: x, y in mm and the bulge of the arc to the next vertex, as in DXF.

    From the back at x = 0 along it and back over the teeth. Fillets of a spur rack are single arcs, those of a helical one,
    ellipses here, pairs of arcs within `accuracy` (mm).
    """
    require_number("accuracy", accuracy, "mm", at_least=1e-7)
    chains = [chain for piece in outline_pieces(rack) if (chain := _chain(piece, rack.length, accuracy)) is not None]
    teeth = joined(chains)
    vertices, bulges = teeth.vertices[::-1], -teeth.bulges[::-1]
    back = np.array([[0.0, -rack.height, 0.0], [rack.length, -rack.height, 0.0]])
    return np.concatenate([back, np.column_stack([vertices, np.r_[bulges, 0.0]])])


def _chain(piece: Piece, length: float, accuracy: float) -> Arcs | None:
    """What of a piece is between x = 0 and `length`, from left to right; None for nothing."""
    (first, _), (last, _) = piece.start, piece.end
    low, high = max(first, 0.0), min(last, length)
    if high - low < SNAP:
        return None
    if piece.fillet is None:
        left = piece.start if low == first else (low, piece.height(low))
        right = piece.end if high == last else (high, piece.height(high))
        return Arcs(np.array([left, right]), np.zeros(1))
    scale = piece.fillet.radius * piece.fillet.stretch
    start, end = (math.asin(max(-1.0, min(1.0, (c - piece.centre) / scale))) for c in (low, high))
    part = _FilletPart(piece, start, end)
    if piece.fillet.stretch == 1:
        return Arcs(part.points(np.array([0.0, 1.0])), np.array([math.tan((part.last - part.first) / 4)]))
    return arcs_of(part, accuracy)
