"""The data sheet of a design as data: quantities with symbol, values, and values as shown; who shows it lays it out."""

from __future__ import annotations

from gearcad.sheet.blocks import Block, Row, Section, Sheet
from gearcad.sheet.design import sheet_of

__all__ = ["Block", "Row", "Section", "Sheet", "sheet_of"]
