"""Where teeth touch: a stretch of a flank whose edges are short."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import require_number
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, Involute
from gearcad.meshing.section.outline import EdgeLength, HalfLengths

__all__ = ["ContactZone", "lengths_near"]


_GROWTH = 0.25
"""By how much of the distance from the zone edges are longer than in it."""


@dataclass(frozen=True, kw_only=True)
class ContactZone:
    """Edges of `edge` (mm) over `half_width` (mm of arc) on both sides of the flank's point at roll length `length` (mm).

    It is on the left flank, or, if not `left`, on the right one; signs of roll lengths do not matter. Raises ParameterError.
    """

    length: float
    half_width: float
    edge: float
    left: bool = True

    def __post_init__(self) -> None:
        require_number("length", self.length)
        require_number("half_width", self.half_width, at_least=0.0)
        require_number("edge", self.edge, above=0)


def lengths_near(gear: Gear, zone: ContactZone) -> HalfLengths:
    """Longest edges on all curves of the half of the tooth whose flank has the zone."""
    curves = gear.profile.curves
    flank = next(curve for curve in curves if isinstance(curve, Involute))
    first, last = (roll * flank.base_radius for roll in (flank.first, flank.last))
    at, whole = (abs(length**2 - first**2) / (2 * flank.base_radius) for length in (zone.length, last))
    # Distances on the other curves are counted as if each of them began where the involute ends.
    begins = {CurveKind.INVOLUTE: 0.0, CurveKind.CHAMFER: whole, CurveKind.TIP: whole + _length(curves, CurveKind.CHAMFER)}

    def lengths(kind: CurveKind) -> EdgeLength:
        def on_curve(run: Floats, own: float) -> Floats:
            distance = np.abs(run + begins.get(kind, -own) - at)
            longest: Floats = zone.edge + _GROWTH * np.maximum(distance - zone.half_width, 0.0)
            return longest

        return on_curve

    return HalfLengths({kind: lengths(kind) for kind in (CurveKind.FILLET, *begins)})


def _length(curves: tuple[Curve, ...], kind: CurveKind) -> float:
    """Length (mm) of a straight piece of the outline, 0 if there is none."""
    return sum(
        float(np.hypot(*np.diff(curve.points(np.array([0.0, 1.0])), axis=0)[0])) for curve in curves if curve.kind is kind
    )
