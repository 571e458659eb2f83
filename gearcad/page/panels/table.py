"""A table of results: any two columns of numbers over each other; rows are brushed, and their designs opened."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from nicegui import background_tasks, run, ui

from gearcad.errors import GearcadError
from gearcad.page.components.table import TableView
from gearcad.page.results import ResultsTable, read_results
from gearcad.page.words import Words

__all__ = ["TablePanel", "chart_of", "first_columns"]

_MOST_LISTED = 200
_DIGITS = 6
_WANTED = (
    ("rate.S_H_min", "check.root_tension_pinion", "pair.total_contact_ratio", "gear.tip_diameter"),
    ("rate.S_F_min", "check.contact_pressure", "pair.circumferential_backlash", "gear.root_diameter"),
)
"""Columns that one looks at first, as x and as y."""

_AXES = ("x", "y", "colour")
_INK = "#7a8794"
"""Legible on light and on dark."""


class TablePanel:
    """`opened` takes the spec and the name of a row's design; files that rows name are in `folder`."""

    def __init__(self, words: Words, folder: Path, opened: Callable[[str, str], None]) -> None:
        self._words, self._folder, self._opened = words, folder, opened
        with ui.element("div").classes("table-pane"):
            self._build()
        self._table: ResultsTable | None = None
        self._columns: list[str] = []
        self._points: list[list[float]] = []
        self._client = ui.context.client

    def _build(self) -> None:
        self._view = TableView(self._choose, self._open, _words(self._words))
        self._chart = ui.echart({"series": []}, on_point_click=lambda event: self._open_point(event.value)).classes("chart")
        self._chart.on("chart:brushselected", lambda event: self._brush(event.args), ["batch"], throttle=0.3)
        self._chart.set_visibility(False)

    def take(self, text: str, name: str) -> None:
        """Show another table."""
        background_tasks.create(self._take(text, name))

    async def _take(self, text: str, name: str) -> None:
        with self._client:
            try:
                table = await run.io_bound(_read, text, name)
            except GearcadError as error:
                self._view.show(line=str(error))
                return
            if table is None:  # the server ends
                return
            self._table = table
            told = f"{len(table.rows)} {self._words['designs']}"
            self._view.show(name=name, told=told, line="", columns=list(table.numbers), rows=[], opened=None)
            await self._draw(table, first_columns(table))

    def _choose(self, chosen: Mapping[str, Any]) -> None:
        """Draw other columns; what is no column leaves all as it is."""
        if self._table is not None:
            columns = [str(chosen.get(axis) or "") for axis in _AXES]
            known = all(column in self._table.numbers for column in columns if column)
            background_tasks.create(self._draw(self._table, columns if known and all(columns[:2]) else self._columns))

    async def _draw(self, table: ResultsTable, columns: Sequence[str]) -> None:
        drawn = [column for column in columns if column]
        points = await run.io_bound(_points, table, drawn)
        if points is None or table is not self._table:
            return
        self._columns, self._points = list(columns), points
        self._chart.set_visibility(True)
        self._chart.options.clear()
        self._chart.options.update(chart_of(drawn, self._points))
        self._chart.update()
        self._view.show(chosen=dict(zip(_AXES, columns, strict=True)), heads=drawn)
        self._list(points)

    def _brush(self, told: Any) -> None:
        """List the rows under the brush; without one all."""
        found = _brushed(told, len(self._points))
        self._list([self._points[at] for at in found] if found else self._points)

    def _list(self, points: Sequence[Sequence[float]]) -> None:
        assert self._table is not None
        rows = [
            {
                "number": int(point[-1]),
                "name": self._table.called(int(point[-1])),
                "cells": [f"{value:.{_DIGITS}g}" for value in point[:-1]],
            }
            for point in points[:_MOST_LISTED]
        ]
        self._view.show(rows=rows)

    def _open_point(self, value: Any) -> None:
        if isinstance(value, list) and value and isinstance(value[-1], int | float):
            self._open(int(value[-1]))

    def _open(self, number: int) -> None:
        if self._table is not None and number in self._table.rows:
            background_tasks.create(self._load(self._table, number))

    async def _load(self, table: ResultsTable, number: int) -> None:
        with self._client:
            try:
                text = await run.io_bound(table.spec, number, self._folder)
            except GearcadError as error:
                self._view.show(line=str(error))
                return
            if text is not None:  # or the server ends
                self._view.show(line="", opened=number)
                self._opened(text, table.called(number))


def _points(table: ResultsTable, columns: Sequence[str]) -> list[list[float]]:
    """Values of each row that has all of them, and its number behind."""
    return [[*values, number] for number, values in table.points(*columns)]


def _read(text: str, name: str) -> ResultsTable:
    """The table, with its columns of numbers found."""
    table = read_results(text, name)
    _ = table.numbers
    return table


def first_columns(table: ResultsTable) -> list[str]:
    """What is drawn of a table at first: x, y, and no colour."""
    numbers = table.numbers or ("seconds", "seconds")
    x, y = (next((column for column in wanted if column in numbers), "") for wanted in _WANTED)
    x = x or numbers[0]
    return [x, y or next((column for column in reversed(numbers) if column != x), x), ""]


def chart_of(columns: Sequence[str], points: Sequence[Sequence[float]]) -> dict[str, Any]:
    """The scatter plot of points, each with the number of its row behind its values."""
    ink = {"color": _INK}
    axis = {"type": "value", "scale": True, "nameLocation": "middle", "nameTextStyle": ink, "axisLabel": ink}
    options: dict[str, Any] = {
        "animation": False,
        "grid": {"left": 64, "right": 16, "top": 36, "bottom": 48},
        "xAxis": {**axis, "name": columns[0], "nameGap": 28},
        "yAxis": {**axis, "name": columns[1], "nameGap": 46},
        "tooltip": {"confine": True},
        "toolbox": {"iconStyle": {"borderColor": _INK}},
        "brush": {
            "xAxisIndex": 0,
            "toolbox": ["rect", "polygon", "keep", "clear"],
            "throttleType": "debounce",
            "throttleDelay": 200,
        },
        "series": [
            {
                "type": "scatter",
                "symbolSize": 7,
                "dimensions": [*columns, "row"],
                "encode": {"x": 0, "y": 1, "tooltip": list(range(len(columns)))},
                "data": [list(point) for point in points],
            }
        ],
    }
    if len(columns) > len(_AXES) - 1 and points:
        values = [point[2] for point in points]
        options["visualMap"] = {
            "min": min(values),
            "max": max(values),
            "dimension": 2,
            "calculable": True,
            "orient": "horizontal",
            "left": 56,
            "top": 0,
            "itemHeight": 90,
            "textStyle": ink,
            "inRange": {"color": ["#2c4a8a", "#2f9c8f", "#e0c341"]},
        }
        options["grid"]["top"] = 64
    return options


def _brushed(told: Any, count: int) -> list[int]:
    """Indices of points that the browser says are under the brush, of those that there are."""
    batch: Any = told.get("batch") if isinstance(told, Mapping) else told
    try:
        found = batch[0]["selected"][0]["dataIndex"]
    except (IndexError, KeyError, TypeError):
        return []
    return [at for at in found if isinstance(at, int) and 0 <= at < count] if isinstance(found, list) else []


def _words(words: Words) -> dict[str, str]:
    return {
        "title": words["Table of results"],
        "hint": words["open the results.csv of a batch in the menu of files"],
        "x": "x",
        "y": "y",
        "colour": words["colour"],
        "design": words["design"],
    }
