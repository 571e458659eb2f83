"""The standard basic rack tooth profile (ISO 53:1998) and the tool it stands for.

All lengths are coefficients of the normal module. The tool that cuts the gear is the counterpart of the rack, so the
tip radius of the tool equals the root radius of the rack.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from gearcad.errors import ParameterError
from gearcad.ranges import Range
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields

__all__ = ["ISO53_A", "ISO53_B", "ISO53_C", "ISO53_D", "NAMED_RACKS", "BasicRack"]


_HEIGHT = Range("", 0, 5, ends="(]")
_RADIUS = Range("", 0, 5)


@dataclass(frozen=True, kw_only=True)
class BasicRack:
    """Basic rack in the normal section: pressure angle in degrees, the rest in normal modules.

    `addendum` h_aP*, `dedendum` h_fP*, `root_radius` rho_fP* (a number, or "full" for one arc across the space).
    Raises ParameterError for a single value out of range; what depends on the gear (shift, thinning) is checked there.
    """

    pressure_angle: Annotated[float, Range("deg", 5, 45), Words("normal pressure angle", "α_n", "ISO 53")] = 20.0
    addendum: Annotated[float, _HEIGHT, Words("addendum of the rack", "h_aP*", "ISO 53")] = 1.0
    dedendum: Annotated[float, _HEIGHT, Words("dedendum of the rack", "h_fP*", "ISO 53")] = 1.25
    root_radius: Annotated[float | Literal["full"], _RADIUS, Words("root radius of the rack", "ρ_fP*", "ISO 53")] = 0.38

    __repr__ = concise

    def __post_init__(self) -> None:
        if isinstance(self.root_radius, str) and self.root_radius != "full":
            raise ParameterError("root_radius", self.root_radius, 'must be a number at least 0, or "full"')
        require_fields(self)

    def full_root_radius(self, dedendum: float | None = None, thinning: float = 0.0) -> float:
        """Largest root radius (in normal modules): the arc that touches both flanks and the bottom of the rack's space.

        rho = (pi/4 + t/2 - h_fP tan a) cos a / (1 - sin a), with the tooth thinning t in normal modules (the tool's
        tooth is thicker by as much). `dedendum` replaces the rack's own where a root diameter is prescribed.
        Negative where the tool's flanks meet before its tip: no such tool exists.
        """
        angle = math.radians(self.pressure_angle)
        depth = self.dedendum if dedendum is None else dedendum
        half_tip = math.pi / 4 + thinning / 2 - depth * math.tan(angle)
        return half_tip * math.cos(angle) / (1 - math.sin(angle))


ISO53_A = BasicRack(dedendum=1.25, root_radius=0.38)
"""Rack A of ISO 53: dedendum 1.25, root radius 0.38."""

ISO53_B = BasicRack(dedendum=1.25, root_radius=0.30)
"""Rack B of ISO 53: dedendum 1.25, root radius 0.30."""

ISO53_C = BasicRack(dedendum=1.25, root_radius=0.25)
"""Rack C of ISO 53: dedendum 1.25, root radius 0.25."""

ISO53_D = BasicRack(dedendum=1.40, root_radius=0.39)
"""Rack D of ISO 53: dedendum 1.40, root radius 0.39."""

NAMED_RACKS = {"ISO53_A": ISO53_A, "ISO53_B": ISO53_B, "ISO53_C": ISO53_C, "ISO53_D": ISO53_D}
