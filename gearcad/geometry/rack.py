"""The standard basic rack tooth profile (ISO 53:1998) and the tool it stands for.

All lengths are coefficients of the normal module. The tool that cuts the gear is the counterpart of the rack, so the
tip radius of the tool equals the root radius of the rack.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from gearcad.errors import ParameterError, plain_numbers, require_number
from gearcad.reprs import concise

__all__ = ["ISO53_A", "ISO53_B", "ISO53_C", "ISO53_D", "NAMED_RACKS", "BasicRack"]


@dataclass(frozen=True, kw_only=True)
class BasicRack:
    """Basic rack in the normal section: pressure angle in degrees, the rest in normal modules.

    `addendum` h_aP*, `dedendum` h_fP*, `root_radius` rho_fP* (a number, or "full" for one arc across the space).
    Raises ParameterError for a single value out of range; what depends on the gear (shift, thinning) is checked there.
    """

    pressure_angle: float = 20.0
    addendum: float = 1.0
    dedendum: float = 1.25
    root_radius: float | Literal["full"] = 0.38

    __repr__ = concise

    def __post_init__(self) -> None:
        plain_numbers(self)
        require_number("pressure_angle", self.pressure_angle, "deg", at_least=5, at_most=45)
        require_number("addendum", self.addendum, above=0, at_most=5)
        require_number("dedendum", self.dedendum, above=0, at_most=5)
        if isinstance(self.root_radius, str):
            if self.root_radius != "full":
                raise ParameterError("root_radius", self.root_radius, 'must be a number at least 0, or "full"')
        else:
            require_number("root_radius", self.root_radius, at_least=0, at_most=5)

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
ISO53_B = BasicRack(dedendum=1.25, root_radius=0.30)
ISO53_C = BasicRack(dedendum=1.25, root_radius=0.25)
ISO53_D = BasicRack(dedendum=1.40, root_radius=0.39)
NAMED_RACKS = {"ISO53_A": ISO53_A, "ISO53_B": ISO53_B, "ISO53_C": ISO53_C, "ISO53_D": ISO53_D}
