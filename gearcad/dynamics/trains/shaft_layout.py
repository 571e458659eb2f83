"""Layout of a shaft of a train: its segments and bearings, the gears on it, and the torsional stiffness between two places."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated

from gearcad.core.errors import GeometryError, ParameterError, require_name
from gearcad.core.quantities import Range, Words, require_fields
from gearcad.core.records import Role, concise
from gearcad.shafts.beam import ShaftBearing, ShaftForce, ShaftSegment, SteppedShaft

_POSITION = Range("mm", 0, 1e7)
_SAME = 1e-9
"""Distance (mm) below which two positions are one."""


@dataclass(frozen=True, kw_only=True)
class ShaftGear:
    """A gear on a shaft of a train: the pinion or wheel of `mesh`, the middle of the common face at `position` (mm).

    Positions are from the left end of the shaft. Raises ParameterError.
    """

    mesh: Annotated[str, Words("mesh of the gear")]
    role: Annotated[Role, Words("pinion or wheel of the mesh")]
    position: Annotated[float, _POSITION, Words("middle of the common face on the shaft")]

    __repr__ = concise

    def __post_init__(self) -> None:
        require_name("mesh", self.mesh)
        require_fields(self)


@dataclass(frozen=True, kw_only=True)
class ShaftLayout:
    """Segments of a shaft from left to right, its `bearings`, the `gears` on it, and other `forces`; positions in mm.

    `coupling` is where the rest of the torque is taken; None stands for the end of the shaft on the side of what it joins to
    its gears, the left end for `start` and the right one for `end`. `span` are the positions between which the shaft twists,
    which a train finds by the gears. Raises GeometryError.
    """

    segments: tuple[ShaftSegment, ...]
    bearings: tuple[ShaftBearing, ...] = ()
    gears: tuple[ShaftGear, ...] = ()
    forces: tuple[ShaftForce, ...] = ()
    coupling: Annotated[float | None, _POSITION, Words("position of the coupling")] = None
    span: tuple[float, float] | None = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        for name in ("segments", "bearings", "gears", "forces"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        if not self.segments:
            raise GeometryError("segments", 0, "must have at least one segment")
        most = self.length
        if self.coupling is not None and self.coupling > most + _SAME:
            raise GeometryError("coupling", self.coupling, f"must be from 0 to {most:g} mm, on the shaft", "mm")
        for number, gear in enumerate(self.gears):
            if gear.position > most + _SAME:
                permitted = f"must be from 0 to {most:g} mm, on the shaft"
                raise GeometryError(f"gears[{number}].position", gear.position, permitted, "mm")

    @property
    def length(self) -> float:
        """Length of the shaft (mm)."""
        return math.fsum(each.length for each in self.segments)

    @property
    def stiffness(self) -> float:
        """Torsional stiffness (N·m/rad) between the positions of the span: springs G I_p/l of its parts in series."""
        low, high = sorted(self.span or (0.0, self.length))
        flexible = math.fsum(
            length / (2 * segment.shear_modulus * segment.second_moment) for segment, length in self._parts(low, high)
        )
        return 1 / (1000 * flexible)

    @property
    def inertia(self) -> float:
        """Moment of inertia about the axis (kg·m²) of the whole shaft."""
        return 1e-15 * math.fsum(2 * each.density * each.second_moment * each.length for each in self.segments)

    def _parts(self, low: float, high: float) -> Iterator[tuple[ShaftSegment, float]]:
        """Yield each segment between two positions with the length of it that lies there (mm)."""
        end = 0.0
        for segment in self.segments:
            start, end = end, end + segment.length
            inside = min(end, high) - max(start, low)
            if inside > 0:
                yield segment, inside

    def require_span(self) -> None:
        """Raise GeometryError for a span without length: the shaft would be infinitely stiff."""
        low, high = self.span or (0.0, self.length)
        if abs(high - low) < _SAME:
            raise GeometryError(
                "gears", low, "must be at two places, or at another than the coupling: the shaft twists between"
            )

    def stepped(
        self,
        forces: Sequence[ShaftForce] = (),
        gravity: tuple[float, float, float] = (0.0, 0.0, 0.0),
        places: tuple[float, ...] = (),
    ) -> SteppedShaft:
        """Return the shaft as a beam with its own forces and `forces` of gears. Raises GeometryError for a loose shaft."""
        return SteppedShaft(
            segments=self.segments,
            bearings=self.bearings,
            forces=(*self.forces, *forces),
            coupling=self.coupling or 0.0,
            gravity=gravity,
            places=places,
        )


def require_distinct(gears: tuple[ShaftGear, ...]) -> None:
    """Raise ParameterError for a gear that is on a shaft twice."""
    for one, other in pairwise(sorted(gears, key=lambda each: (each.mesh, each.role.value))):
        if (one.mesh, one.role) == (other.mesh, other.role):
            raise ParameterError("gears", f"{one.mesh}, {one.role.value}", "must be given once")
