"""The two views of a ring: the section through its axis, and along its axis from the left of that."""

from __future__ import annotations

from gearcad.drawing.layout import View
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.ring_views.face import end_face
from gearcad.drawing.ring_views.face_marks import FaceMarks
from gearcad.drawing.ring_views.meridian import Meridian
from gearcad.drawing.ring_views.section import full_section
from gearcad.drawing.ring_views.section_marks import SectionMarks
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.words import Draughting
from gearcad.geometry import Gear

__all__ = ["face_view", "section_view"]


def section_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """The full section, through a bolt hole; the end that `face_view` shows is at its left."""
    ring = _meridian(drawn, draughting)
    return View("section", full_section(ring), SectionMarks(ring, requirements, draughting).sources)


def face_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """What one sees from the left of the section, a bolt hole up."""
    ring = _meridian(drawn, draughting)
    return View("face", end_face(ring), FaceMarks(ring, requirements, draughting).sources)


def _meridian(drawn: DrawnGear, draughting: Draughting) -> Meridian:
    assert isinstance(drawn.gear, Gear) and drawn.gear.internal
    return Meridian(drawn.gear, draughting.scale)
