"""Bodies as assemblies show them: cut by the plane of a section, seen along their axes, with their item numbers."""

from gearcad.drawing.assembled.balloons import balloons, dots
from gearcad.drawing.assembled.cut import Cut, cut_gear, cut_rack
from gearcad.drawing.assembled.distance import distance_size
from gearcad.drawing.assembled.front import BEYOND_AXIS, Front
from gearcad.drawing.assembled.overall import overall_height, overall_width
from gearcad.drawing.assembled.section import Across, Sectioned, pitch_lines, section_figure

__all__ = [
    "BEYOND_AXIS",
    "Across",
    "Cut",
    "Front",
    "Sectioned",
    "balloons",
    "cut_gear",
    "cut_rack",
    "distance_size",
    "dots",
    "overall_height",
    "overall_width",
    "pitch_lines",
    "section_figure",
]
