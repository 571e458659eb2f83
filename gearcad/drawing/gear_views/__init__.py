"""Views of an external gear, spur, helical or double helical, with whatever body it has (ISO 2203)."""

from gearcad.drawing.gear_views.along import Along
from gearcad.drawing.gear_views.face import end_face
from gearcad.drawing.gear_views.section import half_section
from gearcad.drawing.gear_views.views import face_view, section_view

__all__ = ["Along", "end_face", "face_view", "half_section", "section_view"]
