"""Paper of the pictures: size, colours, axes, labels."""

from __future__ import annotations

import math
import re
import textwrap
from typing import TYPE_CHECKING, Any

from gearcad.core.records import PerGear
from gearcad.designs.variations import column_symbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def axis_label(key: str) -> str:
    """Return the words, symbol (as mathtext) and unit of a column: "pinion: tip diameter $d_{\\mathrm{a}}$ in mm"."""
    found = column_symbol(key)
    if found is None:
        return plain(key)
    owner, symbol = found
    unit = {"deg": "°"}.get(symbol.unit, symbol.unit)
    parts = (owner and f"{plain(owner)}:", symbol.words, mathtext(symbol.symbol), unit and f"in {unit}")
    return " ".join(part for part in parts if part)


def mathtext(symbol: str) -> str:
    """Return the symbol with its index upright: h_aP* becomes $h_{\\mathrm{aP}}^{*}$, and T1A $T_1A$."""
    if not symbol:
        return ""
    body, _, index = symbol.rstrip("*").partition("_")
    body = re.sub(r"(?<=[A-Z])(\d)", r"_\1", body)
    return f"${body}" + (f"_{{\\mathrm{{{index}}}}}" if index else "") + ("^{*}$" if symbol.endswith("*") else "$")


def plain(text: str) -> str:
    """Return a text of the user's, not to be taken for mathtext."""
    return text.replace("$", r"\$")


def wrapped(text: str, width: int) -> str:
    return "\n".join(textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False))


GEARS = PerGear(("pinion", "#0072b2", "o"), ("wheel", "#d55e00", "s"))
"""Name, colour and marker of the gears. Colours are those of Okabe and Ito, which the colour-blind can tell apart."""

SERIES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#333333")
DARK = "#333333"
PALE = "#eaa873"
"""Colour of a broad line under another one."""

MARKED = "#999999"
"""Colour of lines that only mark a place."""

FIGURE_INCHES = (6.6, 3.7)

_LEGEND, _HANDLE, _LETTER = 5.9, 0.55, 0.072
"""Inches that a legend above the axes may take, of a line in it with its margins, and of a letter."""


def new_figure(inches: tuple[float, float] = FIGURE_INCHES) -> Figure:
    """Return an empty figure as wide as the text of a report, with margins as its texts need them."""
    from gearcad.plots.margins import FittedFigure

    return FittedFigure(inches)


def prepared(ax: Axes | None, x: str, y: str) -> Axes:
    """Return the axes with labels and grid; those of a new figure if none are given."""
    axes = new_figure().subplots() if ax is None else ax
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.ticklabel_format(useOffset=False)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    return axes


def layered(count: int) -> list[float]:
    """Widths of so many lines, the first one broad and the last one thin: where they are one, all can be seen."""
    return [1.4] if count == 1 else [3.4 - 2.2 * number / (count - 1) for number in range(count)]


def legend_above(axes: Axes, columns: int, raised: float = 0.0) -> None:
    """A legend over the axes, where it hides nothing: so many points higher where a second axis stands there.

    It has fewer `columns` where long words would not fit, which would make the axes narrow.
    """
    from matplotlib.transforms import ScaledTranslation

    place: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0)}
    if raised:
        figure = axes.get_figure(root=True)
        assert figure is not None  # prepared() has put them on one
        place["bbox_transform"] = axes.transAxes + ScaledTranslation(0, raised / 72, figure.dpi_scale_trans)
    axes.legend(ncols=_fitting(axes, columns), frameon=False, fontsize=9, borderaxespad=0.2, **place)


def _fitting(axes: Axes, most: int) -> int:
    """Return the greatest number of columns, at most `most`, in which the words of a legend have room."""
    widths = [_HANDLE + _LETTER * len(words) for words in axes.get_legend_handles_labels()[1]]
    for columns in range(most, 1, -1):
        rows = math.ceil(len(widths) / columns)
        if sum(max(widths[first : first + rows]) for first in range(0, len(widths), rows)) <= _LEGEND:
            return columns
    return 1


def draw_limit(axes: Axes, limit: float | tuple[float, float] | None) -> None:
    """Draw the limit of a material, or the range in which it lies, with room above; nothing if there is none."""
    if limit is None:
        return
    lowest, highest = limit if isinstance(limit, tuple) else (limit, limit)
    axes.axhline(lowest, color=DARK, linestyle="-.", linewidth=1.2, label=f"limit, {short(lowest)} MPa")
    if highest > lowest:
        axes.axhspan(lowest, highest, color=MARKED, alpha=0.25, label=f"up to {short(highest)} MPa")
    axes.set_ylim(top=max(axes.get_ylim()[1], 1.08 * highest))


_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def short(value: float, digits: int = 4) -> str:
    """Return a number with so many significant digits, or as many as it has, with thousands separated.

    Below 0.0001 and from 1e15 on it has a power of ten.

    >>> short(623.8), short(0.00012345), short(1.74e-7)
    ('623.8', '0.0001234', '1.74·10⁻⁷')
    """
    if not value or not math.isfinite(value):
        return f"{value:g}"
    if not 1e-4 <= abs(value) < 1e15:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{float(mantissa):g}·10{str(int(exponent)).translate(_SUPERSCRIPTS)}"
    places = digits - 1 - math.floor(math.log10(abs(value)))
    text = f"{round(value, places):.{max(places, 0)}f}"
    if "." in text and math.isclose(float(text), value, rel_tol=1e-12):
        text = text.rstrip("0").rstrip(".")
    whole, point, rest = text.partition(".")
    return f"{int(whole):,}".replace(",", "\u202f") + point + rest if abs(value) >= 10000 else text
