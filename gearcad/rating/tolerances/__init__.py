"""What standards permit teeth, thicknesses and centre distances to be off by. Deviations in µm, lengths in mm."""

from gearcad.rating.tolerances.iso1328 import Accuracy, FlankTolerances, flank_tolerances, grades

__all__ = ["Accuracy", "FlankTolerances", "flank_tolerances", "grades"]
