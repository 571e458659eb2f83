"""Pictures of results, drawn on Figures of their own and never through pyplot: no screen is needed, no state stays behind."""

from gearcad.plots.labels import axis_label
from gearcad.plots.study import plot_contours, plot_scatter, require_picture, save_plot

__all__ = ["axis_label", "plot_contours", "plot_scatter", "require_picture", "save_plot"]
