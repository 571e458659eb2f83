"""Figures whose margins fit the texts around their axes. The renderer that draws the figure measures these."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox, BboxBase

from gearcad.core.records import Floats

__all__ = ["FittedFigure"]

_PAD = 0.045
"""Inches at the edges of a figure, and between what stands beside each other in it."""

_MOST_TICKS = 9
"""Room for more numbers along an axis changes nothing: locators ask for no more."""

_START = {"left": 0.12, "right": 0.98, "bottom": 0.14, "top": 0.84}
"""Places of the axes while they are measured: close to the final ones of most figures."""

_NOTEBOOK = 100
"""Dots per inch of what a notebook shows."""


class FittedFigure(Figure):
    """A figure that measures what stands around its axes and makes room for it, each time it is drawn.

    Its axes are those of one grid of `subplots`; labels of the whole figure, and legends outside of it, stand around them.
    """

    def __init__(self, inches: tuple[float, float]) -> None:
        super().__init__(figsize=inches)
        self.subplots_adjust(**_START)

    def draw(self, renderer: RendererBase) -> None:
        """Draw it, with the margins that its texts need, and no axis over what is rounding alone."""
        for axes in self.axes:
            _widen_rounding(axes)
        measured = _tick_spaces(self)
        _fit(self, renderer)
        if _tick_spaces(self) != measured:  # other numbers stand along the axes
            _fit(self, renderer)
        super().draw(renderer)

    def add_subplot(self, *arguments: Any, **options: Any) -> Axes:
        """Add axes as any figure does; plain axes are those that a notebook shows."""
        if not {"projection", "polar", "axes_class"} & options.keys():
            options["axes_class"] = _ShownAxes
        return super().add_subplot(*arguments, **options)  # type: ignore[no-any-return]

    def _repr_png_(self) -> bytes:
        file = BytesIO()
        self.savefig(file, format="png", dpi=_NOTEBOOK)
        return file.getvalue()


class _ShownAxes(Axes):
    """Axes that a notebook shows as the figure that they are on."""

    def _repr_png_(self) -> bytes:
        figure = self.get_figure(root=True)
        assert isinstance(figure, FittedFigure)  # which has made them
        return figure._repr_png_()


class _Room(NamedTuple):
    """The `columns` and `rows` of the grid that axes take, and what stands beyond these: left and right, above and below
    (2,) in pixels.
    """

    columns: range
    rows: range
    beside: Floats
    over: Floats


_ROUNDING = 1e-9
"""Share of the greatest value along an axis below which differences are rounding."""


def _widen_rounding(axes: Axes) -> None:
    """Let an axis along which all values are the same, but for rounding, show that value and not the rounding."""
    for axis, limit in ((axes.xaxis, axes.set_xlim), (axes.yaxis, axes.set_ylim)):
        first, last = sorted(axis.get_data_interval())
        size, free = max(abs(first), abs(last)), axes.get_autoscalex_on() if axis is axes.xaxis else axes.get_autoscaley_on()
        if not (free and axis.get_scale() == "linear" and np.isfinite(size)):  # without data it ends at infinity
            continue
        if not 0 < last - first <= max(_ROUNDING * size, _NOTHING):
            continue
        middle = 0.0 if size <= _NOTHING else (first + last) / 2
        limit(middle - (abs(middle) / 20 or 1.0), middle + (abs(middle) / 20 or 1.0), auto=True)


_NOTHING = 1e-12
"""Values below this are drawn as 0, in every unit."""


def _tick_spaces(figure: Figure) -> list[int]:
    """Return the number of tick labels that have room along each axis."""
    axes = [axis for of in figure.axes for axis in (of.xaxis, of.yaxis)]
    return [min(axis.get_tick_space(), _MOST_TICKS) for axis in axes]


def _fit(figure: Figure, renderer: RendererBase) -> None:
    """Move the edges of the axes to where all that stands around them has room."""
    rooms = list(_rooms(figure, renderer))
    if not rooms:
        return
    pad, size = _PAD * figure.dpi, figure.bbox.size
    (left, right, wide), (top, bottom, high) = (
        _margins([room.columns for room in rooms], [room.beside for room in rooms]),
        _margins([room.rows for room in rooms], [room.over for room in rooms]),
    )
    (left, right), (top, bottom) = _edges(figure, renderer) + pad + np.array([[left, right], [top, bottom]])
    columns, rows = (max(each.stop for each in spans) for spans in zip(*(room[:2] for room in rooms), strict=True))
    width = (size[0] - left - right - (columns - 1) * (wide + pad)) / columns
    height = (size[1] - top - bottom - (rows - 1) * (high + pad)) / rows
    if width > 0 < height:
        figure.subplots_adjust(
            left=left / size[0],
            right=1 - right / size[0],
            bottom=bottom / size[1],
            top=1 - top / size[1],
            wspace=(wide + pad) / width,
            hspace=(high + pad) / height,
        )


def _rooms(figure: Figure, renderer: RendererBase) -> Iterator[_Room]:
    """Yield the room needed around all axes in the grid; a colour bar counts at the place of its axes."""
    for axes in figure.axes:
        if (spec := axes.get_subplotspec()) is None:
            continue
        place = spec.get_topmost_subplotspec()
        taken = axes.get_tightbbox(renderer, for_layout_only=True)
        if taken is not None:
            grid = place.get_position(figure).transformed(figure.transFigure)
            if axes.get_aspect() != "auto":
                grid = _filled(axes, grid)
            left, bottom, right, top = np.maximum([*np.subtract(grid.min, taken.min), *np.subtract(taken.max, grid.max)], 0)
            yield _Room(place.colspan, place.rowspan, np.array([left, right]), np.array([top, bottom]))


def _filled(axes: Axes, grid: BboxBase) -> Bbox:
    """Return the place of axes of a fixed aspect, as if they filled it: what they leave empty is elsewhere once they are moved.

    Sides of the `grid` where a colour bar stands remain as they are.
    """
    own, room = axes.bbox, axes.get_position(original=True).transformed(axes.figure.transFigure)
    alone = np.isclose(room.get_points(), grid.get_points(), rtol=0, atol=1.0)
    return Bbox(np.where(alone, own.get_points(), grid.get_points()))


def _margins(spans: list[range], needed: list[Floats]) -> tuple[float, float, float]:
    """Return the margins (pixels) that columns or rows need before the first, after the last, and between two."""
    count = max(span.stop for span in spans)
    before, after = np.zeros((2, count))
    for span, (first, last) in zip(spans, needed, strict=True):
        before[span.start] = max(before[span.start], first)
        after[span.stop - 1] = max(after[span.stop - 1], last)
    between = (after[:-1] + before[1:]).max(initial=0.0)
    return before[0], after[-1], float(between)


def _edges(figure: Figure, renderer: RendererBase) -> Floats:
    """Return the room for legends and labels of the whole figure, ((left, right), (top, bottom)) in pixels.

    Legends are above the axes; labels stand upright before them or lie below, and are moved to the edge.
    """
    taken, pad = np.zeros((2, 2)), _PAD * figure.dpi
    for legend in figure.legends:
        taken[1, 0] += legend.get_window_extent(renderer).height + pad
    for label in figure.texts:
        box, size = label.get_window_extent(renderer), figure.bbox.size
        if label.get_rotation():
            label.set_x(pad / size[0])
            taken[0, 0] += box.width + pad
        else:
            label.set_y(pad / size[1])
            taken[1, 1] += box.height + pad
    return taken
