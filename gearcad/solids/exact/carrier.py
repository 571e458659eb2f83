"""The solid of a carrier of planets."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from gearcad.solids.carrier_plan import CarrierPlan
from gearcad.solids.exact.boundary import Boundary, Chain, Recorder
from gearcad.solids.exact.cad import cad_solid
from gearcad.solids.exact.forms import level_plane
from gearcad.solids.exact.tubes import tube

if TYPE_CHECKING:
    import cadquery

__all__ = ["carrier_boundary", "carrier_solid"]

_TOLERANCE = 1e-7
"""Of edges and vertices (mm): planes, cylinders and circles are exact."""


def carrier_boundary(plan: CarrierPlan) -> Boundary:
    """Plates and pins as one closed boundary; pins end flush with the outer faces of plates."""
    recorder = Recorder(_TOLERANCE / 2)
    holes: dict[float, list[Chain]] = {end: [] for plate in plan.plates for end in plate}
    for stretch in _free_stretches(plan):
        for pin in plan.pins:
            contours = tube(recorder, plan.diameter / 2, stretch, pin, outward=True)
            for z, contour, outward in zip(stretch, contours, (False, True), strict=True):
                if z in holes:
                    holes[z].append(contour.loop(along=False))
                else:
                    recorder.face(level_plane(z), [contour.loop(along=True)], outward=outward)
    for plate in plan.plates:
        outer = tube(recorder, plan.outer, plate, outward=True)
        inner = tube(recorder, plan.inner, plate, outward=False) if plan.inner else []
        for which, z in enumerate(plate):
            loops = [outer[which].loop(along=True), *(ring.loop(along=False) for ring in inner[which : which + 1]), *holes[z]]
            recorder.face(level_plane(z), loops, outward=which == 1)
    return recorder.boundary()


def carrier_solid(plan: CarrierPlan) -> cadquery.Solid:
    """The same as a solid to go on with in CadQuery: see `carrier_boundary`."""
    return cad_solid(carrier_boundary(plan))


def _free_stretches(plan: CarrierPlan) -> Iterator[tuple[float, float]]:
    """The heights (mm) between which pins are outside of plates."""
    at, end = plan.reach
    for bottom, top in sorted(plan.plates):
        if at < bottom:
            yield at, bottom
        at = top
    if at < end:
        yield at, end
