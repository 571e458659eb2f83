"""The two views of an external gear: half section, and along its axis from the left of that."""

from __future__ import annotations

from gearcad.drawing.gear_views.along import Along
from gearcad.drawing.gear_views.face import end_face
from gearcad.drawing.gear_views.face_marks import FaceMarks
from gearcad.drawing.gear_views.section import half_section
from gearcad.drawing.gear_views.section_demands import SectionDemands
from gearcad.drawing.gear_views.section_sizes import SectionSizes
from gearcad.drawing.gear_views.silhouette import Silhouette
from gearcad.drawing.layout import View
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.words import Draughting
from gearcad.geometry import Gear

__all__ = ["face_view", "section_view"]


def section_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """The half section: cut above the axis, through the keyway; the end that `face_view` shows is at its left."""
    gear = _external(drawn)
    along = Along.of(gear, draughting.scale, drawn.direction)
    outline = Silhouette(gear, along)
    sizes = SectionSizes(outline, requirements, draughting).sources
    demands = SectionDemands(outline, requirements, draughting).sources
    return View("section", half_section(gear, along), (*sizes, *demands))


def face_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """What one sees from the left of the section, the keyway up: the end with the hub, of one with two hubs the front."""
    gear = _external(drawn)
    figure = end_face(gear, draughting.scale, front=drawn.direction < 0)
    return View("face", figure, FaceMarks(gear, figure, requirements, draughting).sources)


def _external(drawn: DrawnGear) -> Gear:
    assert isinstance(drawn.gear, Gear) and not drawn.gear.internal  # rings and racks have views of their own
    return drawn.gear
