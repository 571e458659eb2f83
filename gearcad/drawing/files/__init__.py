"""Files of sheets: each is made into one DXF document, and DXF, SVG and PDF are all written from that."""

from gearcad.drawing.files.document import sheet_document
from gearcad.drawing.files.pdf import write_pdf
from gearcad.drawing.files.svg import write_svg
from gearcad.drawing.files.unshown import unshown
from gearcad.dxf import write_document as write_dxf

__all__ = ["sheet_document", "unshown", "write_dxf", "write_pdf", "write_svg"]
