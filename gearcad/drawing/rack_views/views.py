"""The views of a rack: from the front, its teeth up; the section square to its length; from above."""

from __future__ import annotations

from gearcad.drawing.layout import View
from gearcad.drawing.rack_views.figures import end_figure, front_figure, plan_figure
from gearcad.drawing.rack_views.marks import EndMarks, FrontMarks
from gearcad.drawing.rack_views.span import Span
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.words import Draughting
from gearcad.geometry import Rack

__all__ = ["end_section", "front_view", "plan_view"]


def front_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """One looks at the end faces at z = face width; the reference line is at height 0."""
    span = Span(_rack(drawn), draughting.scale)
    return View("front", front_figure(span), FrontMarks(span, requirements, draughting).sources)


def end_section(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """What one sees from the left of the front view, cut; the reference line is at height 0."""
    rack = _rack(drawn)
    half, tip, back = (draughting.paper(each) for each in (rack.face_width / 2, rack.tip_height, -rack.height))
    marks = EndMarks(requirements, draughting, half, tip, back)
    return View("end", end_figure(rack, draughting.scale), marks.sources)


def plan_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View | None:
    """What one sees from above, for the direction of the teeth; None of a spur rack, of which it would say nothing."""
    rack = _rack(drawn)
    return View("plan", plan_figure(Span(rack, draughting.scale))) if rack.helix_angle else None


def _rack(drawn: DrawnGear) -> Rack:
    assert isinstance(drawn.gear, Rack)
    return drawn.gear
