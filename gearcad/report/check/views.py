"""Teeth in three dimensions: what the page needs to draw them, and a still picture where it cannot."""

from __future__ import annotations

import base64
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from gearcad.check.solid.pictures import ToothSurface
from gearcad.per_gear import Role
from gearcad.plots.paper import short
from gearcad.plots.tooth import COLOUR_MAP, PITCH, YAW, plot_tooth
from gearcad.report.check.figures import picture_address

__all__ = ["ToothView", "tooth_view"]

_COLOURS = 256
_STOPS = 9
"""Colours of the legend."""


class ToothView(NamedTuple):
    """One view: title, address of the still picture, numbers for the page, colours and words of the legend, caption."""

    title: str
    address: str
    data: dict[str, Any]
    colours: list[str]
    legend: list[str]
    caption: str


def tooth_view(surface: ToothSurface, role: Role, caption: str) -> ToothView:
    """That of a gear."""
    return ToothView(
        title=f"Stress in a tooth of the {role.value}",
        address=picture_address(partial(plot_tooth, surface), "png"),
        data=_data(surface),
        colours=[f"rgb({red}, {green}, {blue})" for red, green, blue in _colours(_STOPS)],
        legend=[short(round(part * surface.most)) for part in (0.0, 0.25, 0.5, 0.75, 1.0)],
        caption=caption,
    )


def _data(surface: ToothSurface) -> dict[str, Any]:
    """Arrays in base64: points as 32-bit floats, triangles as 16- or 32-bit numbers, stresses as numbers of colours."""
    small = len(surface.points) <= np.iinfo("<u2").max
    stress = np.clip(surface.von_mises / surface.most, 0, 1) * (_COLOURS - 1)
    return {
        "points": _packed(surface.points, "<f4"),
        "triangles": _packed(surface.triangles, "<u2" if small else "<u4"),
        "bytes": 2 if small else 4,
        "stress": _packed(stress.round(), "u1"),
        "colours": _packed(_colours(_COLOURS), "u1"),
        "size": float(np.linalg.norm(surface.points, axis=1).max()),
        "yaw": YAW,
        "pitch": PITCH,
    }


def _packed(values: np.typing.NDArray[Any], kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values, kind).tobytes()).decode("ascii")


def _colours(count: int) -> np.typing.NDArray[np.uint8]:
    """Colours (count, 3) of the map from its one end to the other."""
    from matplotlib import colormaps

    found: np.typing.NDArray[np.uint8] = colormaps[COLOUR_MAP](np.linspace(0, 1, count), bytes=True)[:, :3]
    return found
