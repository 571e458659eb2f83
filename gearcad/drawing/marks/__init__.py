"""What stands beside outlines: dimensions, leaders, tolerance frames, symbols, tables. Where a mark has several places, they
come best first."""

from gearcad.drawing.marks.arrows import ARROW, arrow
from gearcad.drawing.marks.broken import freehand, zigzag
from gearcad.drawing.marks.centres import centre_circle, centre_cross, centre_line, centre_star
from gearcad.drawing.marks.frames import FRAME_HEIGHT, Characteristic, datum, tolerance_frame
from gearcad.drawing.marks.leaders import circle_dimension, frame_leader, landing_of, leader, with_frame
from gearcad.drawing.marks.linear import FIRST_LANE, LANE_PITCH, linear_dimension
from gearcad.drawing.marks.roughness import general_roughness, roughness, roughness_symbol
from gearcad.drawing.marks.sections import section_arrows, view_label
from gearcad.drawing.marks.sheet_symbols import projection_symbol
from gearcad.drawing.marks.side import Side
from gearcad.drawing.marks.size_text import written_size
from gearcad.drawing.marks.tables import Cell, table
from gearcad.drawing.marks.written import Written, deviations, plain, ringed, symbol

__all__ = [
    "ARROW",
    "FIRST_LANE",
    "FRAME_HEIGHT",
    "LANE_PITCH",
    "Cell",
    "Characteristic",
    "Side",
    "Written",
    "arrow",
    "centre_circle",
    "centre_cross",
    "centre_line",
    "centre_star",
    "circle_dimension",
    "datum",
    "deviations",
    "frame_leader",
    "freehand",
    "general_roughness",
    "landing_of",
    "leader",
    "linear_dimension",
    "plain",
    "projection_symbol",
    "ringed",
    "roughness",
    "roughness_symbol",
    "section_arrows",
    "symbol",
    "table",
    "tolerance_frame",
    "view_label",
    "with_frame",
    "written_size",
    "zigzag",
]
