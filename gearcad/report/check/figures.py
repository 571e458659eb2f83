"""Figures of a report as data: URLs, with their captions."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from gearcad.geometry import GearPair
from gearcad.plots.pair import pair_inches, plot_pair
from gearcad.plots.paper import FIGURE_INCHES, new_figure
from gearcad.report.sentences import sentences

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Picture", "figure_address", "pair_picture", "picture_address"]

_DOTS_PER_INCH = 160
"""Of the pictures of fields; the others are lines."""

_PACKED = 4
"""Level at which zlib packs them: half the time of the usual 6, and 6 % more bytes."""


class Picture(NamedTuple):
    """A figure: its title, its address (the picture itself), and what it shows in sentences."""

    title: str
    address: str
    caption: str


def pair_picture(pair: GearPair) -> Picture:
    """Both gears as they stand in mesh."""
    address = picture_address(partial(plot_pair, pair), "svg", pair_inches(pair))
    return Picture("The pair in mesh", address, sentences("captions_check.txt", "pair", pair))


def picture_address(draw: Callable[[Axes], Axes], kind: str, inches: tuple[float, float] = FIGURE_INCHES) -> str:
    """What is drawn on axes, as a data: URL of an "svg" or "png"."""
    return figure_address(lambda figure: draw(figure.subplots()), kind, inches)


def figure_address(draw: Callable[[Figure], object], kind: str, inches: tuple[float, float] = FIGURE_INCHES) -> str:
    """What is drawn on a figure, as a data: URL of an "svg" or "png"."""
    from matplotlib import style

    with style.context(["default", {"svg.hashsalt": "gearcad"}]):
        figure, stream = new_figure(inches), io.BytesIO()
        draw(figure)
        nothing = {"Date": None} if kind == "svg" else {"Software": None}
        packed: dict[str, Any] = {"pil_kwargs": {"compress_level": _PACKED}} if kind == "png" else {}
        figure.savefig(stream, format=kind, dpi=_DOTS_PER_INCH, metadata=nothing, **packed)
    media = {"svg": "image/svg+xml", "png": "image/png"}[kind]
    return f"data:{media};base64,{base64.b64encode(stream.getvalue()).decode('ascii')}"
