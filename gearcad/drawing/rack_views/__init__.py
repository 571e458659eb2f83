"""Views of a rack, spur or helical (ISO 2203)."""

from gearcad.drawing.rack_views.views import end_section, front_view, plan_view

__all__ = ["end_section", "front_view", "plan_view"]
