"""Whole sheets: views, data, notes and title block of one part or one assembly, where nothing overlaps."""

from gearcad.drawing.sheets.drawing import Drawing, Sheet
from gearcad.drawing.sheets.gear import draw_gear

__all__ = ["Drawing", "Sheet", "draw_gear"]
