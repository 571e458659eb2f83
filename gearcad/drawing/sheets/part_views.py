"""The views of a part, whatever it is: external gear, ring or rack, with a tooth of it in detail."""

from __future__ import annotations

from dataclasses import replace

from gearcad.drawing import gear_views, rack_views, ring_views
from gearcad.drawing.layout import View
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.tooth_views import detail_mark, detail_scale, modification_figures, tooth_figure
from gearcad.drawing.words import Draughting, Words
from gearcad.geometry import Rack

__all__ = ["detail_blocks", "part_rows"]


def part_rows(
    drawn: DrawnGear, requirements: Requirements, draughting: Draughting, *, detailed: bool = True
) -> tuple[tuple[View, ...], ...]:
    """The views at a scale, in the rows in which they stand in first angle projection; `detailed` where a tooth of them is
    drawn in detail."""
    given = drawn, requirements, draughting
    if isinstance(drawn.gear, Rack):
        plan = rack_views.plan_view(*given)
        front = rack_views.front_view(*given)
        front = _with_detail(front, drawn, draughting) if detailed else front
        return ((front, rack_views.end_section(*given)), *(() if plan is None else ((plan,),)))
    views = ring_views if drawn.gear.internal else gear_views
    face = views.face_view(*given)
    return ((views.section_view(*given), _with_detail(face, drawn, draughting) if detailed else face),)


def _with_detail(view: View, drawn: DrawnGear, draughting: Draughting) -> View:
    """A view that says where the detail is taken from."""
    return replace(view, annotations=(*view.annotations, lambda: detail_mark(drawn, view.figure, draughting.scale)))


def detail_blocks(drawn: DrawnGear, words: Words) -> tuple[View, ...]:
    """A tooth in detail, which comes first, and the diagrams of its modifications; they have scales of their own."""
    detail = tooth_figure(drawn, Draughting(words, detail_scale(drawn)))
    diagrams = modification_figures(drawn, Draughting(words))
    return View("detail", detail), *(View(f"diagram {number}", each) for number, each in enumerate(diagrams, 1))
