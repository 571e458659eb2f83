"""What a factor counts for between static strength and endurance limit."""

from __future__ import annotations

import math

from gearcad.rating.factors.elementwise import Values, interpolated_over_log, power
from gearcad.rating.factors.life import Points

__all__ = ["transition"]


def transition(cycles: Values, static: Values, endurance: Values, points: Points) -> Values:
    """A factor after so many load cycles, from its values of static strength and of the endurance limit.

    endurance (static/endurance)^w, w = ln Z_NT(N)/ln Z_NT,stat by the `points` of Z_NT or Y_NT, 0 for long life: so sigma_G
    follows straight lines in log-log with the corners of the life factor (ISO 6336-2 and -3, 5.3; to be verified). So go Z_L,
    Z_v, Z_R, Z_W, Z_X, Y_delta_relT, Y_RrelT and Y_X.
    """
    static_logarithm = math.log(points[0][1])
    shares = [(number, max(0.0, math.log(factor) / static_logarithm)) for number, factor in points]
    return endurance * power(static / endurance, interpolated_over_log(cycles, shares))
