"""Charts of searches as options of ECharts: mass over safety of pairs, and a map of two keys."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from gearcad.core.errors import format_number

INK = "#7a8794"
"""Colour that is legible on light and on dark backgrounds."""

_FOUND, _FRONT, _TAKEN = "#2f7fc4", "#2f9c8f", "#d9822b"
_SCALE = ("#2c4a8a", "#2f9c8f", "#e0c341")
_SIZE = 13
"""Size of text (px)."""

_DIGITS = 4
_MARGIN, _MASS = "margin", "mass"

FOUND, FRONT, CELLS = "found", "front", "cells"
"""Names of the series whose points can be taken."""

CURSOR = "cursor"
"""Name of the series that marks the cell which was reached by keys."""

_PLAIN: dict[str, Any] = {"color": INK, "fontSize": _SIZE}


def _axis(name: str, gap: int, comma: bool) -> dict[str, Any]:
    axis: dict[str, Any] = {"type": "value", "scale": True, "name": name, "nameLocation": "middle", "nameGap": gap}
    axis |= {
        "nameTextStyle": _PLAIN,
        "axisLabel": {**_PLAIN, "hideOverlap": True},
        "splitLine": {"lineStyle": {"color": INK, "opacity": 0.25}},
    }
    if comma:
        axis["axisLabel"][":formatter"] = "value => String(value).replace('.', ',')"
    return axis


def pairs_chart(
    found: Mapping[str, Any], taken: str, words: Mapping[str, str], *, comma: bool, unit: str = "kg"
) -> dict[str, Any]:
    """Return the scatter of masses (in `unit`) over least margins of a search for sizes; `taken` is the name of the one taken.

    `words` has those of `margin` and `mass`. A point has margin, mass, name and place.
    The cloud of all combinations is behind, and cannot be taken.
    """
    rows, front = found.get("rows", []), found.get(FRONT, [])
    series = [
        _points("cloud", [[*point] for point in found.get("cloud", [])], 4, INK)
        | {"silent": True, "itemStyle": {"opacity": 0.35}},
        _points(FRONT, [_point(row, place) for place, row in enumerate(front)], 8, _FRONT) | {"symbol": "diamond"},
        _points(FOUND, [_point(row, place) for place, row in enumerate(rows)], 11, _FOUND),
        _points("taken", [_point(row, 0) for row in rows if row["name"] == taken][:1], 18, _TAKEN)
        | {"silent": True, "itemStyle": {"color": "transparent", "borderColor": _TAKEN, "borderWidth": 3}},
    ]
    return {
        "animation": False,
        "textStyle": {"fontSize": _SIZE},
        "grid": {"left": 56, "right": 16, "top": 12, "bottom": 46},
        "xAxis": _axis(words[_MARGIN], 28, comma),
        "yAxis": _axis(words[_MASS], 40, comma),
        "tooltip": {"confine": True, "textStyle": {"fontSize": _SIZE}, ":formatter": _tooltip(unit, comma)},
        "series": series,
    }


def _points(name: str, data: Sequence[Sequence[Any]], size: int, color: str) -> dict[str, Any]:
    return {"type": "scatter", "name": name, "symbolSize": size, "color": color, "data": list(data)}


def _point(row: Mapping[str, Any], place: int) -> list[Any]:
    return [float(f"{row['margin']:.5g}"), float(f"{row['mass']:.5g}"), row["name"], place]


def _tooltip(unit: str, comma: bool) -> str:
    """Return the function that writes the tooltip of a point: its values are numbers, and a name of digits and letters."""
    decimal = ".replace(/\\./g, ',')" if comma else ""
    return (
        f"point => point.value[2] + '<br>S/S_min ' + point.value[0].toFixed(3){decimal}"
        f" + '<br>' + point.value[1].toPrecision(3){decimal} + ' {unit}'"
    )


# ---------------------------------------------------------------------- map


def map_chart(found: Mapping[str, Any], present: tuple[Any, Any], words: Mapping[str, str], *, comma: bool) -> dict[str, Any]:
    """Return the heat map of a result over two keys; the cell nearest to the `present` values of the design is marked.

    The data of a cell are its place across and up, and its value, "-" where there is none.
    """
    xs, ys = found["xs"], found["ys"]
    cells = [[column, line, "-" if value is None else value] for column, line, value, _ in found["cells"]]
    values = [value for *_, value in cells if value != "-"] or [0.0]
    least, most = min(values), max(values)
    text = {"color": INK, "fontSize": _SIZE}
    marked = [place for place in [(nearest(xs, present[0]), nearest(ys, present[1]))] if None not in place]
    decimal = ".replace('.', ',')" if comma else ""
    return {
        "animation": False,
        "textStyle": {"fontSize": _SIZE},
        "grid": {"left": 72, "right": 16, "top": 44, "bottom": 48},
        "xAxis": _categories(words["across"], xs, 28, comma),
        "yAxis": _categories(words["up"], ys, 54, comma),
        "tooltip": {
            "confine": True,
            "textStyle": {"fontSize": _SIZE},
            ":formatter": f"cell => typeof cell.value[2] === 'number' ? cell.value[2].toPrecision(5){decimal} : '-'",
        },
        "visualMap": {
            "min": least,
            "max": most if most > least else least + (abs(least) or 1.0),
            "calculable": False,
            "orient": "horizontal",
            "left": "center",
            "top": 0,
            "itemHeight": 180,
            "itemWidth": 14,
            "text": [_number(most, comma), _number(least, comma)],
            "textStyle": text,
            "inRange": {"color": list(_SCALE)},
            "seriesIndex": 0,
        },
        "series": [
            {
                "type": "heatmap",
                "name": "cells",
                "data": cells,
                "emphasis": {"itemStyle": {"borderColor": INK, "borderWidth": 2}},
            },
            {
                "type": "scatter",
                "name": "present",
                "silent": True,
                "symbol": "circle",
                "symbolSize": 14,
                "data": [list(place) for place in marked],
                "itemStyle": {"color": "transparent", "borderColor": _TAKEN, "borderWidth": 3},
            },
            {
                "type": "scatter",
                "name": CURSOR,
                "silent": True,
                "symbol": "rect",
                "symbolSize": 18,
                "data": [],
                "itemStyle": {"color": "transparent", "borderColor": "#ffffff", "borderWidth": 3, "shadowBlur": 3},
            },
        ],
    }


def _categories(name: str, values: Sequence[Any], gap: int, comma: bool) -> dict[str, Any]:
    text = {"color": INK, "fontSize": _SIZE}
    axis: dict[str, Any] = {"type": "category", "name": name, "nameLocation": "middle", "nameGap": gap, "nameTextStyle": text}
    return axis | {"data": [_number(value, comma) for value in values], "axisLabel": {**text, "hideOverlap": True}}


def _number(value: Any, comma: bool) -> str:
    if isinstance(value, float):
        text = f"{value:.{_DIGITS}g}"
        return text.replace(".", ",") if comma else text
    return format_number(value) if isinstance(value, int) else str(value)


def nearest(values: Sequence[Any], value: Any) -> int | None:
    """Return the place of the value that is nearest to another one; None where they are no numbers, or it is outside."""
    numbers = [each for each in values if isinstance(each, int | float)]
    if not isinstance(value, int | float) or len(numbers) != len(values) or not numbers or not math.isfinite(value):
        return None
    step = (max(numbers) - min(numbers)) / max(len(numbers) - 1, 1)
    place = min(range(len(numbers)), key=lambda at: abs(numbers[at] - value))
    return place if abs(numbers[place] - value) <= max(step, 0.0) / 2 + 1e-9 else None
