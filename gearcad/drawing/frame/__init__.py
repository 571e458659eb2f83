"""What frames the views of a sheet: border (ISO 5457), title block (ISO 7200), parts list, revisions, notes, data table.

Where a company wants them otherwise, a template of its own says so.
"""

from gearcad.drawing.frame.border import border, free_area, inside_frame
from gearcad.drawing.frame.data_table import TableRow, data_table
from gearcad.drawing.frame.fitting import Fitted, fit
from gearcad.drawing.frame.framed import Framed
from gearcad.drawing.frame.furniture import Furnished, Furniture
from gearcad.drawing.frame.lists import PartLine, parts_list, revisions
from gearcad.drawing.frame.notes import common_notes, notes
from gearcad.drawing.frame.template import SheetTemplate
from gearcad.drawing.frame.title_block import title_block, title_values

__all__ = [
    "Fitted",
    "Framed",
    "Furnished",
    "Furniture",
    "PartLine",
    "SheetTemplate",
    "TableRow",
    "border",
    "common_notes",
    "data_table",
    "fit",
    "free_area",
    "inside_frame",
    "notes",
    "parts_list",
    "revisions",
    "title_block",
    "title_values",
]
