"""Whole sheets: views, data, notes and title block of one part or one assembly, where nothing overlaps."""

from gearcad.drawing.sheets.drawing import Drawing, Sheet
from gearcad.drawing.sheets.gear import draw_gear
from gearcad.drawing.sheets.pair import draw_pair
from gearcad.drawing.sheets.train import draw_train

__all__ = ["Drawing", "Sheet", "draw_gear", "draw_pair", "draw_train"]
