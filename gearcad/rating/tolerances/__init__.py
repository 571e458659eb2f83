"""What standards permit flanks to be off by. Deviations in µm, lengths in mm."""

from gearcad.rating.tolerances.editions import Accuracy, grades
from gearcad.rating.tolerances.gear_tolerances import GearTolerances, gear_tolerances
from gearcad.rating.tolerances.iso1328 import FlankTolerances, flank_tolerances

__all__ = ["Accuracy", "FlankTolerances", "GearTolerances", "flank_tolerances", "gear_tolerances", "grades"]
