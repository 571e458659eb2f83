"""A tooth in detail, and diagrams of its modifications."""

from gearcad.drawing.tooth_views.detail import detail_scale, tooth_figure
from gearcad.drawing.tooth_views.mark import detail_mark
from gearcad.drawing.tooth_views.modifications import modification_figures

__all__ = ["detail_mark", "detail_scale", "modification_figures", "tooth_figure"]
