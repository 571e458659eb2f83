"""Exact solid of a stepped shaft, solid or hollow: cylinders, shoulders and ends on shared circles."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from gearcad.shafts.beam import SteppedShaft
from gearcad.solids.exact.boundary import Boundary, Recorder, level_plane
from gearcad.solids.exact.solid import cad_solid
from gearcad.solids.exact.teeth import Contour, tube
from gearcad.solids.shaft_plan import Cylinder, TurnedPlan

if TYPE_CHECKING:
    from collections.abc import Sequence

    import cadquery

_TOLERANCE = 1e-7
"""Tolerance (mm) of edges and vertices: planes, cylinders and circles are exact."""

_Ends = tuple[Contour, Contour] | None
"""Circles at both ends of a cylinder; None where there is no bore."""


def shaft_boundary(shaft: SteppedShaft) -> Boundary:
    """Return the shaft as a closed boundary, its axis on z, its left end at z = 0.

    Neighbouring segments of one diameter are one face. Raises GeometryError for a cavity that is closed, and for segments that
    do not hang together.
    """
    return turned_boundary(TurnedPlan(shaft))


def shaft_solid(shaft: SteppedShaft) -> cadquery.Solid:
    """Return the shaft as a CadQuery solid: see `shaft_boundary`."""
    return cad_solid(shaft_boundary(shaft))


def turned_boundary(plan: TurnedPlan) -> Boundary:
    """Return the cylinders of a plan as a closed boundary."""
    recorder = Recorder(_TOLERANCE / 2)
    outside, bore = _walls(recorder, plan.outside, outward=True), _walls(recorder, plan.bore, outward=False)
    _shoulders(recorder, plan.outside, outside, solid_within=True)
    _shoulders(recorder, plan.bore, bore, solid_within=False)
    for which, number in ((0, 0), (1, -1)):
        around, hole = outside[number], bore[number]
        assert around is not None
        loops = [around[which].loop(along=True), *([] if hole is None else [hole[which].loop(along=False)])]
        z = plan.outside[number].high if which else plan.outside[number].low
        recorder.face(level_plane(z), loops, outward=which == 1)
    return recorder.boundary()


def _walls(recorder: Recorder, cylinders: Sequence[Cylinder], *, outward: bool) -> list[_Ends]:
    """Add the walls of cylinders. Return the circles at both ends of each."""
    found: list[_Ends] = []
    for each in cylinders:
        if each.radius:
            low, high = tube(recorder, each.radius, (each.low, each.high), outward=outward)
            found.append((low, high))
        else:
            found.append(None)
    return found


def _shoulders(recorder: Recorder, cylinders: Sequence[Cylinder], walls: Sequence[_Ends], *, solid_within: bool) -> None:
    """Add the plane rings where the diameter changes; material is within the outer cylinders, and around those of the bore."""
    for (left, right), (before, after) in zip(pairwise(cylinders), pairwise(walls), strict=True):
        left_wider = left.radius > right.radius
        wide, narrow = (before, after) if left_wider else (after, before)
        wide_end, narrow_end = (1, 0) if left_wider else (0, 1)
        assert wide is not None
        loops = [wide[wide_end].loop(along=True)]
        if narrow is not None:
            loops.append(narrow[narrow_end].loop(along=False))
        recorder.face(level_plane(left.high), loops, outward=left_wider is solid_within)
