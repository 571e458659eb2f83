"""Panel of a table of results: columns over each other, brushed rows, designs of rows."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from io import StringIO
from pathlib import Path
from typing import Any

from nicegui import background_tasks, run, ui

from gearcad.batch.row import flat_document
from gearcad.core.errors import GearcadError, SpecError
from gearcad.designs.cells import CellReader, Layout, plain_number, plain_text, read_headings
from gearcad.designs.design import Design, files_only_in
from gearcad.designs.keys import MAIN_TABLES, Cell, DesignKind
from gearcad.designs.reader import nested
from gearcad.designs.spec_writers import toml_text
from gearcad.designs.table import DesignRow
from gearcad.page.charts import INK
from gearcad.page.components.elements import CHART, TableView
from gearcad.page.words import PageWords
from gearcad.plots.table_data import opened_records

MOST_ROWS = 50_000

_STATES = ("name", "status", "error", "warnings", "seconds")
"""Columns before those of files and inputs."""

_SAME = 1e-9
"""Relative deviation of a figure that is made again from the one in the table."""


@dataclass(frozen=True)
class ResultsTable:
    """The rows that are ok of a table of results, each with the number that a spreadsheet gives it."""

    name: str
    headings: tuple[str, ...]
    rows: Mapping[int, Sequence[str]] = field(repr=False)

    @cached_property
    def numbers(self) -> tuple[str, ...]:
        """Columns that hold numbers, in any row."""
        places = {heading: place for place, heading in enumerate(self.headings) if not heading.startswith("files.")}
        return tuple(
            heading
            for heading, place in places.items()
            if any(plain_number(cells[place]) is not None for cells in self.rows.values())
        )

    def points(self, *columns: str) -> Iterator[tuple[int, tuple[float, ...]]]:
        """Yield the rows that have numbers in all of these columns: their indices, and the numbers."""
        places = [self.headings.index(column) for column in columns]
        for number, cells in self.rows.items():
            values = [plain_number(cells[place]) for place in places]
            if None not in values:
                yield number, tuple(value for value in values if value is not None)

    def called(self, number: int) -> str:
        """The name of the design of a row."""
        return plain_text(self.rows[number][self.headings.index("name")])

    @cached_property
    def _inputs(self) -> tuple[str, ...]:
        """The columns that can be inputs: all keys of a design behind the files, up to the first that is none.

        Derived quantities follow the inputs, and some of them have names of inputs.
        """
        found: list[str] = []
        for heading in self.headings:
            if heading in _STATES or heading.startswith("files."):
                continue
            try:
                read_headings(("name", *found, heading), self.name)
            except SpecError:
                break
            found.append(heading)
        return tuple(found)

    def spec(self, number: int, folder: Path) -> str:
        """The spec of a row: the fewest of its first columns that make its figures again. Raises SpecError.

        Files that it names must be in `folder`.
        """
        cells = {heading: cell for heading, cell in zip(self.headings, self.rows[number], strict=True) if cell}
        where, fault = f"{self.name} row {number}", "it has no inputs"
        values, reader = dict[str, Cell](), CellReader(Layout.COMMA)
        for count, key in enumerate(self._inputs, 1):
            if key not in cells:
                continue
            try:
                if (value := reader.value(key, cells[key], number)) is None:
                    continue
                values[key] = value
                row = DesignRow(
                    number, self.called(number), values, (), (), str(folder / self.name), ("name", *self._inputs[:count])
                )
                with files_only_in(folder):
                    design = row.design()
            except GearcadError as error:
                fault = str(error)
                continue
            if _explains(design, {key: cells[key] for key in self._inputs[count:] if key in cells}):
                return _text(design, values, where)
        raise SpecError(f"{where}: no longer makes a design: {fault}")


def read_results(text: str, name: str) -> ResultsTable:
    """A table of results, called `name`. Raises SpecError for what is none."""
    with opened_records(StringIO(text, newline=""), name) as (headings, records):
        if "name" not in headings:
            raise SpecError(f"{name}: is no table of results, for it has no column name")
        status, rows = headings.index("status"), dict[int, Sequence[str]]()
        for number, cells in enumerate(records, 2):
            if len(cells) == len(headings) and cells[status] == "ok":
                rows[number] = cells
            if len(rows) > MOST_ROWS:
                raise SpecError(f"{name}: has more than {MOST_ROWS} rows; take a part of it")
    if not rows:
        raise SpecError(f"{name}: has nothing to show: no row is ok")
    return ResultsTable(name, tuple(headings), rows)


def _explains(design: Design, cells: Mapping[str, str]) -> bool:
    """Whether the cells that could still be inputs are what the design gives by itself."""
    figures = dict(flat_document(design.to_dict()))
    return all(key in figures and _is_same(figures[key], cell) for key, cell in cells.items())


def _is_same(figure: Any, cell: str) -> bool:
    """Return whether a cell of the table equals a figure; several numbers, and words, are compared as they are."""
    number = plain_number(cell)
    if number is None or isinstance(figure, bool) or not isinstance(figure, int | float):
        return figure is not None
    return math.isclose(figure, number, rel_tol=_SAME, abs_tol=_SAME)


def _text(design: Design, values: Mapping[str, Cell], where: str) -> str:
    """The spec of these values."""
    if design.kind is DesignKind.TRAIN:
        import tomlkit

        from gearcad.designs.train_designs import tables_of

        tables: dict[str, Any] = tables_of(values, lambda _key: where).tables
        tables["train"] = {"name": design.name, **tables["train"]}
        return f"# {where}\n\n{tomlkit.dumps(tables)}"
    tables = nested(values, design.kind)
    main = MAIN_TABLES[design.kind][0]
    return toml_text(tables | {main: {"name": design.name, **tables[main]}}, [where])


_MOST_LISTED = 200
_DIGITS = 6
_FIRST_COLUMNS = (
    ("rate.S_H_min", "check.root_tension_pinion", "pair.total_contact_ratio", "gear.tip_diameter"),
    ("rate.S_F_min", "check.contact_pressure", "pair.circumferential_backlash", "gear.root_diameter"),
)
"""Columns that one looks at first, as x and as y."""

_AXES = ("x", "y", "colour")


class TablePanel:
    """`opened` takes the spec and the name of a row's design; files that rows name are in `folder`."""

    def __init__(self, words: PageWords, folder: Path, opened: Callable[[str, str], None]) -> None:
        self._words, self._folder, self._opened = words, folder, opened
        with ui.element("div").classes("table-pane"):
            self._build()
        self._table: ResultsTable | None = None
        self._columns: list[str] = []
        self._points: list[list[float]] = []
        self._client = ui.context.client

    def _build(self) -> None:
        self._view = TableView(self._choose, self._open, _words(self._words))
        self._chart_place = ui.element("div").classes("chart-place")
        self._chart: Any = None

    def _make_chart(self) -> None:
        """Make the chart with the first table: the browser fetches its package then."""
        with self._chart_place:
            self._chart = CHART({"series": []}, on_point_click=lambda event: self._open_point(event.value)).classes("chart")
            self._chart.on("chart:brushselected", lambda event: self._brush(event.args), ["batch"], throttle=0.3)

    def take(self, text: str, name: str) -> None:
        """Show another table."""
        background_tasks.create(self._take(text, name))

    async def _take(self, text: str, name: str) -> None:
        with self._client:
            try:
                table = await run.io_bound(_read, text, name)
            except GearcadError as error:
                self._view.show(line=self._words.message(str(error)))
                return
            if table is None:  # the server ends
                return
            self._table = table
            told = f"{len(table.rows)} {self._words['designs']}"
            self._view.show(name=name, told=told, line="", columns=list(table.numbers), rows=[], opened=None)
            await self._draw(table, first_columns(table))

    def _choose(self, chosen: Mapping[str, Any]) -> None:
        """Draw other columns; names that are no columns change nothing."""
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
        if self._chart is None:
            self._make_chart()
        self._chart.options.clear()
        self._chart.options.update(chart_of(drawn, self._points))
        self._chart.update()
        self._view.show(chosen=dict(zip(_AXES, columns, strict=True)), heads=drawn)
        self._list(points)

    def _brush(self, told: Any) -> None:
        """List the rows that the user selected in the chart; all rows if none is selected."""
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
                self._view.show(line=self._words.message(str(error)))
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
    """Return the columns drawn at first: x, y, and "" for no colour."""
    numbers = table.numbers or ("seconds", "seconds")
    x, y = (next((column for column in wanted if column in numbers), "") for wanted in _FIRST_COLUMNS)
    x = x or numbers[0]
    return [x, y or next((column for column in reversed(numbers) if column != x), x), ""]


def chart_of(columns: Sequence[str], points: Sequence[Sequence[float]]) -> dict[str, Any]:
    """The scatter plot of points, each with the number of its row behind its values."""
    ink = {"color": INK}
    axis = {"type": "value", "scale": True, "nameLocation": "middle", "nameTextStyle": ink, "axisLabel": ink}
    options: dict[str, Any] = {
        "animation": False,
        "grid": {"left": 64, "right": 16, "top": 36, "bottom": 48},
        "xAxis": {**axis, "name": columns[0], "nameGap": 28},
        "yAxis": {**axis, "name": columns[1], "nameGap": 46},
        "tooltip": {"confine": True},
        "toolbox": {"iconStyle": {"borderColor": INK}},
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


def _words(words: PageWords) -> dict[str, str]:
    return {
        "title": words["Table of results"],
        "hint": words["open the results.csv of a batch in the menu of files"],
        "x": "x",
        "y": "y",
        "colour": words["colour"],
        "design": words["design"],
    }
