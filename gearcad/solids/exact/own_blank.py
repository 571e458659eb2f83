"""Blanks of one's own: a STEP file with webs, holes, hubs or spokes as one likes, onto whose rim the teeth are put by CadQuery.

The blank is turned down to a circle just below the root circle, over the face width; there the ring of teeth of
`gear_boundary`, whose bore is that circle, is fused to it. The faces of the teeth stay those of our own STEP files.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcad.core.errors import GeometryError, SolverError
from gearcad.geometry import Body, Gear
from gearcad.geometry.gear_data import LEAST_RIM
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.exact.solid import AssembledProduct, cad_assembly, gear_boundary, product_name

if TYPE_CHECKING:
    import cadquery

_MISSING = 1e-7
"""Share of the rim that may be missing by rounding."""

_VOLUME = 1e-6
"""Largest relative difference of the volume of a whole from that of its parts."""

_LARGEST = 32
"""Blanks that are kept."""

_BEGINNING, _BLANKS = b"ISO-10303-21", 1000
"""First word of a STEP file, and how many spaces may stand before it."""


def toothed_blank(gear: Gear) -> cadquery.Solid:
    """Return the blank of a gear's `body.step` with its teeth, as one closed solid.

    Raises GeometryError for a file that is no single sound solid, and for a blank whose rim does not reach from below the root
    circle up to it, with the place where it does not; SolverError where the kernel fails.
    """
    path = Path(str(gear.body.step))
    try:
        stamp = path.stat().st_mtime_ns
    except OSError as error:
        raise _fault(gear, f"cannot be read ({error.strerror or error})") from None
    return _toothed(gear, str(path), stamp)


def _fault(gear: Gear, permitted: str) -> GeometryError:
    return GeometryError("body.step", Path(str(gear.body.step)).name, permitted)


@lru_cache(maxsize=_LARGEST)
def _toothed(gear: Gear, path: str, _stamp: int) -> cadquery.Solid:
    import cadquery
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy

    blank = _read(gear, path)
    root, width = gear.root_diameter / 2, gear.face_width
    inner = root - LEAST_RIM * gear.normal_module
    _require_rim(gear, blank, _tube(inner, root, 0.0, width))
    outer = 2 * (root + max(blank.BoundingBox().DiagonalLength, gear.tip_diameter))
    turned = blank.cut(_tube(inner, outer, 0.0, width))
    teeth = replace(gear, body=_of_teeth(gear.body, 2 * inner))
    ring = cadquery.Solid(BRepBuilderAPI_Copy(kernel_solid(gear_boundary(teeth))).Shape())
    whole = turned.fuse(ring).Solids()
    parts = sum(each.Volume() for each in turned.Solids()) + ring.Volume()
    if len(whole) != 1 or not whole[0].isValid() or abs(whole[0].Volume() / parts - 1) > _VOLUME:
        raise SolverError(f"the CAD kernel does not put the teeth onto the blank {Path(path).name}")
    solid: cadquery.Solid = whole[0]
    return solid


def _of_teeth(body: Body, bore: float) -> Body:
    """Return the body of the ring of teeth: its chamfers, and the circle to which the blank is turned as its bore."""
    return Body(bore=bore, end_chamfer=body.end_chamfer, end_chamfer_angle=body.end_chamfer_angle, tip_chamfer=body.tip_chamfer)


def _read(gear: Gear, path: str) -> cadquery.Solid:
    """Return the one solid of a STEP file. Raises GeometryError."""
    import cadquery

    try:
        with Path(path).open("rb") as file:
            if not file.read(len(_BEGINNING) + _BLANKS).lstrip().startswith(_BEGINNING):
                raise ValueError
        solids = cadquery.importers.importStep(path).solids().vals()
    except Exception:  # what a broken file does to the reader is not known beforehand
        raise _fault(gear, "must be a STEP file with one solid: it cannot be read") from None
    if len(solids) != 1:
        raise _fault(gear, f"must hold one solid, not {len(solids)}")
    if not solids[0].isValid():
        raise _fault(gear, "must hold a sound solid: its faces do not close, or cross each other")
    solid: cadquery.Solid = solids[0]
    return solid


def _tube(inner: float, outer: float, low: float, high: float) -> Any:
    import cadquery

    start, up = cadquery.Vector(0, 0, low), cadquery.Vector(0, 0, 1)
    tube = cadquery.Solid.makeCylinder(outer, high - low, start, up)
    return tube.cut(cadquery.Solid.makeCylinder(inner, high - low, start, up))


def _require_rim(gear: Gear, blank: cadquery.Solid, rim: Any) -> None:
    """Raise GeometryError unless the blank has material all over the `rim`, from below the root circle up to it."""
    missing = rim.cut(blank)
    pieces = missing.Solids()
    if not pieces or sum(each.Volume() for each in pieces) <= _MISSING * rim.Volume():
        return
    piece = max(pieces, key=lambda each: each.Volume())
    middle, box = piece.Center(), piece.BoundingBox()
    radius, angle = math.hypot(middle.x, middle.y), round(math.degrees(math.atan2(middle.y, middle.x)), 3) % 360
    where = f"angle {angle:.4g} deg"
    inner, root = gear.root_diameter / 2 - LEAST_RIM * gear.normal_module, gear.root_diameter / 2
    if radius < inner:  # it goes round
        radius, where = min(max(abs(box.xmax), abs(box.xmin)), root), "all round"
    place = f"radius {radius:.6g} mm, z = {middle.z:.6g} mm, {where}"
    reach = f"must have a rim about z that reaches from {inner:.6g} to {root:.6g} mm, the root circle"
    raise _fault(gear, f"{reach}: nothing is at {place}")


def assembly_with_blanks(product: AssembledProduct, gears: Mapping[str, Gear]) -> cadquery.Assembly:
    """Return an assembly whose parts of these product names are toothed blanks."""
    assembly = cad_assembly(product)
    for node in assembly.traverse():
        if (gear := gears.get(product_name(node[1]))) is not None and node[1].obj is not None:
            node[1].obj = toothed_blank(gear)
    return assembly
