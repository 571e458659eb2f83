"""The section of a planetary train through its axis, with item numbers and sizes over all."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from gearcad.drawing.assembled import BEYOND_AXIS, Across, balloons, distance_size, dots, overall_width, section_figure
from gearcad.drawing.layout import Candidates, View
from gearcad.drawing.marks import Side, linear_dimension, view_label
from gearcad.drawing.shapes import Box, Figure, Line, Pen, Point
from gearcad.drawing.train_views.bodies import bodies_of
from gearcad.drawing.train_views.cutting import LETTER
from gearcad.drawing.train_views.plan import InPlane, TrainPlan
from gearcad.drawing.words import Draughting
from gearcad.geometry import GearPair

__all__ = ["train_section"]

_ABOVE, _BESIDE = (8.0, 14.0, 22.0, 30.0, 40.0), (0.0, 12.0, -12.0)
"""Where the name of the section may stand."""


def train_section(plan: TrainPlan, items: Mapping[str, int], draughting: Draughting, direction: int = 1) -> View:
    """The axis of the train at height 0, z to the right, or to the left if `direction` is -1; `items` are numbers by keys."""
    bodies = bodies_of(plan)
    extent = Box.around(point for _, body in bodies for polygon in body.cut.covers for point in polygon)
    across = Across(draughting.scale, (extent.left + extent.right) / 2, direction)
    figure = section_figure([body for _, body in bodies], across) + Figure(tuple(_axes(plan, across)))
    box = Box.around(across.points((extent[:2], extent[2:])))
    spots: dict[int, tuple[Point, ...]] = {}
    for key, body in bodies:
        spots[items[key]] = spots.get(items[key], ()) + dots(body.cut.areas, across)
    marks: list[Candidates] = [*_stage_distances(plan, box, across, draughting)]
    marks += [partial(overall_width, box, extent.width, draughting), partial(balloons, spots, box)]
    if plan.bent:
        marks.append(partial(_name, box))
    return View("section", figure, tuple(marks))


def _axes(plan: TrainPlan, across: Across) -> Iterator[Line]:
    """The axis of the train, and those of planets and stages."""
    bodies = (*plan.centrals, *plan.planets, *plan.stages)
    for height in dict.fromkeys(body.height for body in bodies):
        ends = [end for body in bodies if body.height == height for end in body.standing.extent]
        if plan.carrier is not None and any(body.height == height for body in plan.planets):
            ends += plan.carrier.reach
        (left, y), (right, _) = sorted(across.points(((min(ends), height), (max(ends), height))))
        yield Line((left - BEYOND_AXIS, y), (right + BEYOND_AXIS, y), Pen.CENTRE)


def _stage_distances(plan: TrainPlan, box: Box, across: Across, draughting: Draughting) -> Iterator[Candidates]:
    """The centre distance of each stage that is shown."""
    for stage in plan.train.stages:
        if stage.name in plan.left_out:
            continue
        pinion, wheel = plan.stage(stage.name)
        yield partial(_stage_distance, (pinion, wheel), stage.pair, box, across, draughting)


def _stage_distance(
    gears: Sequence[InPlane], pair: GearPair, box: Box, across: Across, draughting: Draughting
) -> Iterator[Figure]:
    """Outside, on the side where the axes' ends are nearer."""
    size = distance_size(pair)
    ends = [sorted(across.points((z, each.height) for z in each.standing.extent)) for each in gears]
    for side, edge, end, way in ((Side.RIGHT, box.right, 1, 1.0), (Side.LEFT, box.left, 0, -1.0)):
        first, second = ((each[end][0] + way * BEYOND_AXIS, each[end][1]) for each in ends)
        yield from linear_dimension(first, second, side, size, draughting, clear=edge)


def _name(box: Box) -> Iterator[Figure]:
    """The letters of a section that is not in one plane, above it."""
    for up in _ABOVE:
        for across in _BESIDE:
            yield view_label(f"{LETTER}–{LETTER}", (box.middle[0] + across, box.top + up))
