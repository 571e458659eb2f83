"""Pictures of results, drawn on Figures of their own and never through pyplot: no screen is needed, no state stays behind."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.plots.labels import axis_label
    from gearcad.plots.study import plot_contours, plot_scatter, require_picture, save_plot
else:
    from gearcad.lazy import lazily

__all__ = ["axis_label", "plot_contours", "plot_scatter", "require_picture", "save_plot"]

if not TYPE_CHECKING:
    __getattr__ = lazily(
        __name__,
        __all__,
        (),
        (),
        {name: f"labels.{name}" if name == "axis_label" else f"study.{name}" for name in __all__},
    )
