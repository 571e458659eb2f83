"""Identify: which standard gear has been measured. Every standard size is weighed against readings and their uncertainties."""

from gearcad.identify.candidate import Candidate
from gearcad.identify.identification import Deciding, Identification
from gearcad.identify.measured import Gauge, Measured, Reading
from gearcad.identify.measurements import Measurements
from gearcad.identify.run import identify_gear

__all__ = ["Candidate", "Deciding", "Gauge", "Identification", "Measured", "Measurements", "Reading", "identify_gear"]
