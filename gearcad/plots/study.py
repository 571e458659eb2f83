"""Pictures of a study: one quantity of its results over another, with a third as colours or as contours.

A picture is drawn on a Figure of its own and never through pyplot: it needs no screen and leaves no state behind.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcad.core.errors import ParameterError, format_number
from gearcad.core.output import staged_files
from gearcad.plots.paper import axis_label, new_figure, plain, prepared, wrapped
from gearcad.plots.table_data import Column, Points, read_points

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

__all__ = ["plot_contours", "plot_results", "plot_scatter", "require_picture", "save_plot"]

_INCHES = (6.4, 4.4)
_DOTS_PER_INCH = 150

_METADATA: dict[str, dict[str, None]] = {".png": {}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
"""Kinds of file by suffix, and what to leave out of each so that the same picture is the same bytes."""

_SERIES = (("#0072b2", "o"), ("#d55e00", "s"), ("#009e73", "^"), ("#cc79a7", "D"), ("#e69f00", "v"), ("#56b4e9", "P"))
"""Colours of Okabe and Ito, which the colour-blind can tell apart, and markers that remain in a print without colours."""

_COLOUR_MAP = "viridis"
_CONTOUR_MAP = "YlGnBu"
_LIGHT = 0.7
"""Part of the map of colours that is light enough for points and numbers on it."""

_MOST_BINS = 8
"""Largest number of intervals between the ticks of an axis: with more, large numbers would overlap."""

_MOST_LEVELS = 10
_FLAT = 0.01
"""Least ratio of incircle to circumcircle of a triangle at the border; a flatter one is left out."""

_LONGEST_LABEL = 60
_LONGEST_LEGEND = 22
"""Characters of a line of text, those that typeset a symbol included."""

_DECADES = 100.0
"""Ratio of greatest to least value from which on an axis of contours is logarithmic: else most rows would lie on each other."""

_MANY = 300
"""Points from which on they are drawn small."""

_SAME = 1e-9
"""Relative difference that is rounding."""

Draw = Callable[[Points, "Axes"], "Axes"]
"""A function that draws points on axes."""


def plot_results(
    results: Path | str, x: str, y: str, *, colour: str | None = None, contour: str | None = None, ax: Axes | None = None
) -> Axes:
    """Draw columns of the results.csv of a batch by their keys: y over x, and a third as colours or as contours.

    A key may lack its beginning where that is clear. Raises SpecError for the file, ParameterError for a key.
    """
    points = read_points(results, x, y, colour=colour, contour=contour)
    return (plot_scatter if contour is None else plot_contours)(points, ax)


# ---------------------------------------------------------------------- scatter


def plot_scatter(points: Points, ax: Axes | None = None) -> Axes:
    """Draw y over x. A text, or a number with few values, as third quantity makes a series of each value, others a colour bar.

    The points of a series are joined where the rows of the table go through x in one direction. Raises ParameterError for
    more texts than can be told apart.
    """
    axes = _prepared(points, ax)
    third = points.third
    size = 2.0 if len(points.x.values) > _MANY else 4.5
    series = [("", list(range(len(points.x.values))))] if third is None else _series(third)
    if third is not None and not series:
        drawn = axes.scatter(points.x.numbers, points.y.numbers, s=size**2, c=third.numbers, cmap=_COLOUR_MAP)
        _add_colour_bar(axes, drawn, third.key)
    else:
        _draw_series(axes, points, series, size)
    if third is not None and series:
        _add_legend(axes, third.key, [words for words, _ in series])
    return axes


def _series(column: Column) -> list[tuple[str, list[int]]]:
    """Return each value of the column in words and its rows, numbers in order; none if its numbers are too many for that."""
    distinct: list[Any] = list(dict.fromkeys(column.values)) if column.is_text else sorted(set(column.values))
    if len(distinct) > len(_SERIES):
        if column.is_text:
            permitted = f"has {len(distinct)} different texts, and at most {len(_SERIES)} colours can be told apart"
            raise ParameterError("colour", column.key, permitted)
        return []
    return [
        (value if column.is_text else format_number(value), [row for row, each in enumerate(column.values) if each == value])
        for value in distinct
    ]


def _draw_series(axes: Axes, points: Points, series: list[tuple[str, list[int]]], size: float) -> None:
    x, y = points.x.numbers, points.y.numbers
    line = "-" if all(_is_swept(x[rows]) for _, rows in series) else "none"
    for number, ((_, rows), (colour, marker)) in enumerate(zip(series, _SERIES, strict=False)):
        axes.plot(x[rows], y[rows], linestyle=line, marker=marker, markersize=size, color=colour, label=f"series {number}")


def _is_swept(x: NDArray[np.float64]) -> bool:
    """True for three values or more that only rise or only fall: then a line through them says something."""
    steps = x[1:] - x[:-1]
    return len(steps) > 1 and bool((steps > 0).all() or (steps < 0).all())


def _add_legend(axes: Axes, key: str, entries: list[str]) -> None:
    """A legend beside the axes. Its words replace the labels, because matplotlib hides a label that begins with _."""
    title = wrapped(axis_label(key), _LONGEST_LEGEND)
    legend = axes.legend(title=title, loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, alignment="left")
    for text, words in zip(legend.get_texts(), entries, strict=True):
        text.set_text(wrapped(plain(words), _LONGEST_LEGEND))


def _add_colour_bar(axes: Axes, drawn: Any, key: str) -> None:
    axes.figure.colorbar(drawn, ax=axes, label=wrapped(axis_label(key), _LONGEST_LABEL))


# ---------------------------------------------------------------------- contours


def plot_contours(points: Points, ax: Axes | None = None) -> Axes:
    """Draw the third quantity as filled contours with numbers on their lines, and the points it is known at.

    Points that fill most of a grid make the contours on it, with holes where some are missing, others on their Delaunay
    triangles. Raises ParameterError where the points lie in line, or where one place has two values.
    """
    import matplotlib
    import numpy as np
    from matplotlib.patheffects import withStroke
    from matplotlib.ticker import MaxNLocator

    key, x, y, z = _heights(points)
    grid = _grid(x, y, z)
    wide = _is_wide(x), _is_wide(y)
    across, up = (_straightened(*each) for each in zip(wide, (x, y) if grid is None else grid[:2], strict=True))
    surface = (_triangulation(across, up, key), z) if grid is None else (across, up, grid[2])
    if np.ptp(z) <= _SAME * np.abs(z).max():
        raise ParameterError("contour", key, f"is {format_number(float(z[0]))} everywhere; take another column")
    axes = _prepared(points, ax)
    fill, draw = (axes.tricontourf, axes.tricontour) if grid is None else (axes.contourf, axes.contour)
    levels = MaxNLocator(_MOST_LEVELS).tick_values(z.min(), z.max())
    colours = matplotlib.colormaps[_CONTOUR_MAP](np.linspace(0.0, _LIGHT, len(levels) - 1))
    filled = fill(*surface, levels, colors=colours)
    lines = draw(*surface, levels, colors="#333333", linewidths=0.7)
    _set_wide(axes, wide, (x, y), (filled, lines))
    for number in axes.clabel(lines, fmt=format_number, fontsize=8):
        number.set(path_effects=[withStroke(linewidth=2.5, foreground="white")], clip_on=False, zorder=5)
    _draw_points(axes, x, y)
    _add_colour_bar(axes, filled, key)
    return axes


def _heights(points: Points) -> tuple[str, NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Key of the third quantity; x, y and value of every place once."""
    import numpy as np

    if points.third is None:
        raise ParameterError("contour", "", "must be the key of a column")
    key = points.third.key
    heights: dict[tuple[float, float], float] = {}
    for x, y, z in np.column_stack([points.x.numbers, points.y.numbers, points.third.numbers]).tolist():
        if abs(heights.setdefault((x, y), z) - z) > _SAME * abs(z):
            place = f"{points.x.key} = {format_number(x)}, {points.y.key} = {format_number(y)}"
            raise ParameterError("contour", key, f"has two values at {place}: the rows differ in more; take colour instead")
    xs, ys = np.array(list(heights)).T
    return key, xs, ys, np.array(list(heights.values()))


def _grid(x: NDArray[np.float64], y: NDArray[np.float64], z: NDArray[np.float64]) -> tuple[Any, ...] | None:
    """Return the columns, rows and values of the grid that the points fill for the most part, if they do."""
    import numpy as np

    (columns, column_of), (rows, row_of) = (np.unique(values, return_inverse=True) for values in (x, y))
    if min(len(columns), len(rows)) < 2 or 2 * len(z) <= len(columns) * len(rows):
        return None
    values = np.full((len(rows), len(columns)), np.nan)
    values[row_of, column_of] = z
    return columns, rows, np.ma.masked_invalid(values)


def _triangulation(x: NDArray[np.float64], y: NDArray[np.float64], key: str) -> Any:
    """Return the triangles between the points as they look on the paper, where both axes are about as long."""
    import numpy as np
    from matplotlib.tri import TriAnalyzer, Triangulation

    try:
        scaled = Triangulation(x / (np.ptp(x) or 1.0), y / (np.ptp(y) or 1.0))
        shape = TriAnalyzer(scaled)
        with np.errstate(invalid="ignore"):  # a triangle without area has no circles
            flat = shape.get_flat_tri_mask(_FLAT) | np.isnan(np.ma.filled(shape.circle_ratios(), np.nan))
        if flat.all():
            raise ValueError("no triangle has an area")
    except (RuntimeError, ValueError) as error:
        raise ParameterError("contour", key, "needs three points at least that do not lie in line") from error
    return Triangulation(x, y, scaled.triangles, flat)


def _draw_points(axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64]) -> None:
    """Draw the computed points: dark, with a light rim against contours and lines, and not clipped at the border."""
    size, rim = (2.5, 0.3) if len(x) > _MANY else (4.5, 0.7)
    axes.plot(x, y, "o", color="black", markersize=size, markeredgecolor="white", markeredgewidth=rim, clip_on=False, zorder=4)


def _is_wide(values: NDArray[np.float64]) -> bool:
    """True for values above 0 over more than two decades."""
    return bool(values.min() > 0 and values.max() > _DECADES * values.min())


def _straightened(wide: bool, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return values as plotted: their logarithms (base 10) if the axis is logarithmic."""
    import numpy as np

    return np.log10(values) if wide else values


def _set_wide(axes: Axes, wide: tuple[bool, bool], places: tuple[NDArray[np.float64], ...], drawn: tuple[Any, ...]) -> None:
    """Logarithmic axes. What is `drawn` between logarithms goes where these belong: it is straight there from row to row."""
    for number, values in enumerate(places):
        if not wide[number]:
            continue
        for path in (path for contours in drawn for path in contours.get_paths()):
            path.vertices[:, number] = 10 ** path.vertices[:, number]
        (axes.set_ylim if number else axes.set_xlim)(float(values.min()), float(values.max()))
        (axes.set_yscale if number else axes.set_xscale)("log")


# ---------------------------------------------------------------------- the paper


def _prepared(points: Points, ax: Axes | None) -> Axes:
    """Return the axes with title, labels and grid; those of a new figure if none are given."""
    from matplotlib.ticker import MaxNLocator

    axes = new_figure(_INCHES).subplots() if ax is None else ax
    prepared(axes, *(wrapped(axis_label(column.key), _LONGEST_LABEL) for column in (points.x, points.y)))
    axes.set_title(plain(points.name))
    for axis, column in ((axes.xaxis, points.x), (axes.yaxis, points.y)):
        whole = bool((column.numbers % 1 == 0).all())
        axis.set_major_locator(MaxNLocator(_MOST_BINS, integer=whole, steps=[1, 2, 2.5, 5, 10]))
    return axes


def require_picture(path: Path) -> None:
    """Raise ParameterError unless the name ends like a kind of picture that we can write."""
    if path.suffix.lower() not in _METADATA:
        raise ParameterError("output", str(path), f"must end in {' or '.join(_METADATA)}")


def save_plot(draw: Draw, points: Points, path: Path) -> None:
    """Write the picture that `draw` makes of the points, in the style of matplotlib whatever the user's own is.

    The suffix says the kind: .png (150 dots per inch), .svg or .pdf. Raises ParameterError for another, or what `draw` raises.
    """
    from matplotlib import style

    require_picture(path)
    with style.context(["default", {"svg.hashsalt": "gearcad"}]), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph")  # a name in a script that the font lacks shows boxes
        figure = new_figure(_INCHES)
        draw(points, figure.subplots())
        with staged_files(path.parent) as staging:
            figure.savefig(staging / path.name, dpi=_DOTS_PER_INCH, metadata=_METADATA[path.suffix.lower()])
