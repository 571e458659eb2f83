"""Identify: which standard gear has been measured. Every standard size is weighed against readings and their uncertainties."""

import sys

from gearcad.callable_room import CallableRoom
from gearcad.identify.candidates import Candidate, Deciding, Identification
from gearcad.identify.measurements import Gauge, Measured, Measurements, Reading
from gearcad.identify.search import identify_gear
from gearcad.identify.splines import SplineCandidate, SplineIdentification, identify_spline

__all__ = [
    "Candidate",
    "Deciding",
    "Gauge",
    "Identification",
    "Measured",
    "Measurements",
    "Reading",
    "SplineCandidate",
    "SplineIdentification",
    "identify_gear",
    "identify_spline",
]

sys.modules[__name__].__class__ = CallableRoom
