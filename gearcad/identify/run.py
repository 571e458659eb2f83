"""identify: from readings to candidates."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from gearcad.errors import GeometryError
from gearcad.identify.candidate import Candidate
from gearcad.identify.further import further
from gearcad.identify.identification import Identification
from gearcad.identify.measured import Gauge, Measured
from gearcad.identify.search import fits

__all__ = ["identify_gear"]

_OFF_INVOLUTE = 6.0
"""Logarithm of how improbable a gauge beside the involute makes a candidate: one measures where there is a flank."""

_JUDGED = 40
_LEAST = 1e-4
"""Probability of what is listed beside the best."""

_USUAL_UNCERTAINTY = 0.02


def identify_gear(measured: Measured, count: int = 10) -> Identification:
    """The gears that readings may be of, at most `count`, the most probable first.

    Raises GeometryError where no gear of any size comes near them.
    """
    made = [
        (each, each.fit.log_evidence - _OFF_INVOLUTE * len(each.off_involute))
        for fit in fits(measured)[:_JUDGED]
        if (each := Candidate.of(measured, fit, 0.0)) is not None
    ]
    if not made:
        permitted = "must be counted again, or the readings taken again: no gear of any size comes near them"
        raise GeometryError("teeth", measured.teeth, permitted)
    whole = float(np.logaddexp.reduce([weight for _, weight in made]))
    made.sort(key=lambda each: -each[1])
    likely = [(each, math.exp(weight - whole)) for each, weight in made[:count]]
    found = tuple(replace(each, probability=share) for each, share in likely if share >= _LEAST or share == likely[0][1])
    result = Identification(
        measured=measured, candidates=found, deciding=(), alike=(), chance=_chance(measured, found[0].chi_square)
    )
    rivals = result.rivals
    if not rivals:
        return result
    lengths = [each.uncertainty for each in measured.readings if each.gauge not in (Gauge.HELIX_ANGLE, Gauge.TIP_HELIX_ANGLE)]
    told = further(measured, (found[0], *rivals), min([*lengths, _USUAL_UNCERTAINTY]))
    return replace(result, deciding=told.deciding, alike=told.alike)


def _chance(measured: Measured, chi_square: float) -> float:
    from scipy.special import chdtrc

    return float(chdtrc(len(measured.readings), chi_square))
