"""Views of a ring, spur or helical (ISO 2203)."""

from gearcad.drawing.ring_views.views import face_view, section_view

__all__ = ["face_view", "section_view"]
