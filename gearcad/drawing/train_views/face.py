"""A planetary train seen along its axis: its set without the carrier, planets at their true angles, stages in thin lines.

Which of two circles on one axis is hidden follows from heights; gears in mesh do not hide each other (ISO 2203).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial

from gearcad.drawing.assembled import BEYOND_AXIS, Front, overall_height, overall_width
from gearcad.drawing.layout import Candidates, View
from gearcad.drawing.marks import Side, centre_circle, centre_line, centre_star, linear_dimension
from gearcad.drawing.shapes import Box, Figure, Pen, Point
from gearcad.drawing.train_views.cutting import cutting_line
from gearcad.drawing.train_views.pitch import pitch_radii
from gearcad.drawing.train_views.plan import TrainPlan
from gearcad.drawing.words import Draughting, Size
from gearcad.solids.train_layout import Standing

__all__ = ["planet_centres", "train_face"]

_ON_AXIS = 1e-6
"""mm from an axis of the train that are none."""


def train_face(plan: TrainPlan, draughting: Draughting, looking: int = -1) -> View:
    """The axis of the train at the origin, the first planet above it, seen from +z; with centre distance and sizes over all.

    `looking` is which way one looks at a bent section: -1 to the left, 1 to the right.
    """
    fronts, scale = list(_fronts(plan)), draughting.scale
    whole = Box.of_all(Box(*front.centre, *front.centre).grown(front.reach) for front in fronts)
    box = Box(*(scale * side for side in whole))
    figure = Figure.of(*(front.figure(scale) for front in fronts)) + _centre_lines(plan, fronts, box, scale)
    if plan.below is not None and plan.bent:
        reach = scale * max(math.hypot(*front.centre) + front.reach for front in fronts) + BEYOND_AXIS
        figure += cutting_line(math.radians(90 + plan.turns[plan.below]), scale * plan.distance, reach, looking)
    round_about = any(front.gear.internal and 2 * front.reach >= whole.height for front in fronts)
    marks: list[Candidates] = [
        partial(_distance, plan, box, draughting),
        partial(overall_height, box, whole.height, draughting, "⌀" if round_about else ""),
    ]
    if not round_about:
        marks.append(partial(overall_width, box, whole.width, draughting))
    return View("face", figure, tuple(marks))


def _distance(plan: TrainPlan, box: Box, draughting: Draughting) -> Iterator[Figure]:
    """From the axis of the train to that of the first planet."""
    scale, size = draughting.scale, Size(value=plan.distance)
    half = scale * max(rim.body.gear.tip_diameter for rim in plan.layout.planets[0]) / 2
    for side, edge in ((Side.RIGHT, box.right), (Side.LEFT, box.left)):
        first = side.outwards * half, scale * plan.distance
        yield from linear_dimension(first, (edge + side.outwards * BEYOND_AXIS, 0.0), side, size, draughting, clear=edge)


def planet_centres(plan: TrainPlan) -> list[Point]:
    """Their axes (mm)."""
    turns = [math.radians(90 + turn) for turn in plan.turns]
    return [(plan.distance * math.cos(turn), plan.distance * math.sin(turn)) for turn in turns]


def _fronts(plan: TrainPlan) -> Iterator[Front]:
    train = plan.train
    centrals, rims = plan.layout.centrals, plan.layout.planets[0]
    for central in centrals:
        yield Front(central.body.gear, (0.0, 0.0), pitch_radii(train, central.body.key), _tip(central, centrals))
    for centre in planet_centres(plan):
        for rim in rims:
            yield Front(rim.body.gear, centre, pitch_radii(train, rim.body.key), _tip(rim, rims))
    first = math.radians(90 - plan.layout.pose.planets[0].angle)
    for gear in plan.layout.stages:
        x, y = gear.axle.x, gear.axle.y
        at = x * math.cos(first) - y * math.sin(first), x * math.sin(first) + y * math.cos(first)
        yield Front(gear.body.gear, at, pitch_radii(train, gear.body.key), Pen.THIN, bare=True)


def _tip(one: Standing, others: Sequence[Standing]) -> Pen:
    """The pen of a tip circle: dashed behind a body on the same axis that is nearer and larger, of rings smaller inside."""
    own = one.body.gear
    for other in others:
        gear = other.body.gear
        if other is not one and other.z > one.z and gear.internal is own.internal and gear.tip_diameter > own.tip_diameter:
            return Pen.HIDDEN
    return Pen.OUTLINE


def _centre_lines(plan: TrainPlan, fronts: Sequence[Front], box: Box, scale: float) -> Figure:
    """Of all axes, but of the planet through which a bent section goes; with the circle on which those of planets are."""
    centres = [(scale * x, scale * y) for x, y in planet_centres(plan)]
    half = scale * max(rim.body.gear.tip_diameter for rim in plan.layout.planets[0]) / 2
    (x, y), *others = centres
    crossed = [each for number, each in enumerate(centres) if not plan.bent or number != plan.below]
    stages = [front for front in fronts if front.bare and math.hypot(*front.centre) > _ON_AXIS]
    crossed += [_paper(front, scale) for front in stages if min(map(abs, front.centre)) <= _ON_AXIS]
    figure = centre_star(box.grown(BEYOND_AXIS), crossed, half) + centre_line((x - half, y), (x, y), (x + half, y))
    if others:
        figure += centre_circle(scale * plan.distance, centres)
    for front in stages:
        figure += _stage_lines(_paper(front, scale), scale * front.reach + BEYOND_AXIS)
    return figure


def _paper(front: Front, scale: float) -> Point:
    """Its centre."""
    return scale * front.centre[0], scale * front.centre[1]


def _stage_lines(centre: Point, reach: float) -> Figure:
    """A cross, without what would lie on a centre line of the train."""
    (x, y), figure = centre, Figure()
    if abs(y) > _ON_AXIS:
        figure += centre_line((x - reach, y), centre, (x + reach, y))
    if abs(x) > _ON_AXIS:
        figure += centre_line((x, y - reach), centre, (x, y + reach))
    return figure
