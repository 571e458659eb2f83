"""DXF of a rack's side view: one closed contour of true arcs for laser and wire cutting."""

from __future__ import annotations

from pathlib import Path

from gearcad.dxf import CUT, NOT_CUT, add_layers, drawing
from gearcad.geometry.rack import Rack
from gearcad.solids.files.contour import extent_of
from gearcad.solids.files.rack_contour import rack_contour

__all__ = ["write_rack_dxf"]


def write_rack_dxf(rack: Rack, path: Path | str, *, accuracy: float = 0.0005, lines: bool = False) -> None:
    """Write the section at z = 0 as DXF (R2010, mm), as a `Rack` lies: teeth up, the reference line on y = 0.

    Layer PROFILE holds the contour (see `rack_contour`); LINES, with `lines`, those of tips, reference and roots, which are not
    to be cut. The header states how far the drawing reaches. Equal input gives equal bytes.
    Raises ParameterError for an `accuracy` (mm) below 1e-7.
    """
    contour = rack_contour(rack, accuracy)
    with drawing(path, {"PROFILE": CUT}) as document:
        space = document.modelspace()
        space.add_lwpolyline(contour.tolist(), format="xyb", close=True, dxfattribs={"layer": "PROFILE"})
        if lines:
            add_layers(document, {"LINES": NOT_CUT})
            for y in (rack.tip_height, 0.0, -rack.root_depth):
                space.add_line((0.0, y), (rack.length, y), dxfattribs={"layer": "LINES"})
        low, high = extent_of(contour)
        space.reset_extents((*low, 0.0), (*high, 0.0))
