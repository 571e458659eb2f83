"""A quick transmission error: the contact of flexible bodies, with a coarse mesh and few positions.

Plane strain for spur gears, solid bodies for helical ones. Half as fine as a check, it is off by some percent, which is
enough to tell quiet pairs from others.
"""

from __future__ import annotations

import numpy as np

from gearcad.geometry import GearPair
from gearcad.material import Materials

__all__ = ["transmission_error"]

_POSITIONS = 16
_CELLS = 40
_COARSER = 0.5


def transmission_error(pair: GearPair, material: Materials, torque: float) -> float:
    """Peak to peak (µm along the line of action) under a torque on the pinion (N·m, above 0).

    Raises SolverError, ParameterError and GeometryError.
    """
    from gearcad.contact.plane.pair import plane_pair
    from gearcad.contact.shared.engaged import EngagedPair
    from gearcad.contact.solid.pair import SolidSizes, solid_pair

    angles = EngagedPair(pair).roll_angles(_POSITIONS).tolist()
    if pair.pinion.helix_angle == 0:
        plane = plane_pair(pair, material)
        approaches = [plane.solve(angle, torque).approach for angle in angles]
    else:
        solid = solid_pair(pair, material, sizes=SolidSizes().refined(_COARSER), cells=_CELLS)
        approaches = [solid.solve(angle, torque).approach for angle in angles]
    return float(np.ptp(approaches)) * 1000
