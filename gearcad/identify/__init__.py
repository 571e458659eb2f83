"""Identify: which standard gear has been measured. Every standard size is weighed against readings and their uncertainties."""

import sys

from gearcad.callable_room import CallableRoom
from gearcad.identify.candidates import Candidate, Deciding, Identification
from gearcad.identify.measurements import Gauge, Measured, Measurements, Reading
from gearcad.identify.search import identify_gear

__all__ = ["Candidate", "Deciding", "Gauge", "Identification", "Measured", "Measurements", "Reading", "identify_gear"]

sys.modules[__name__].__class__ = CallableRoom
