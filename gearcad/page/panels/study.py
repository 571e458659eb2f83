"""Panel of a study: a result of the design over two of its keys as a map, whose cells can be taken."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from nicegui import background_tasks, run, ui

from gearcad.core.errors import GearcadError, ParameterError
from gearcad.core.symbols import Symbol
from gearcad.core.units import ShownUnit
from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.designs.train_keys import UNITS
from gearcad.designs.variations import column_of_train, column_symbol
from gearcad.page.charts import CELLS, CURSOR, map_chart, nearest
from gearcad.page.components.elements import CHART
from gearcad.page.fields import fields_of, given_texts, used_texts
from gearcad.page.forms import number_of
from gearcad.page.panels.search import SearchPanel, TaskPlace, choice_field, field_row
from gearcad.page.runs import RunState
from gearcad.page.searches import STUDY, figures_of, study_axes, study_cells
from gearcad.page.words import PageWords

_COUNT = 9
"""Number of values of a key unless something else is typed."""

_SHARE = 0.3
"""Share of the present value by which the range of a key goes down and up at first."""

_STEPS = 4
"""Number of steps by which the range of a whole number goes down and up at first."""

_FIRST_KEYS = (
    "pinion.profile_shift",
    "wheel.profile_shift",
    "pair.helix_angle",
    "pair.face_width",
    "pinion.teeth",
    "gear.teeth",
)
_FIRST_RESULTS = ("rate.S_H_min", "rate.S_F_min", "pair.total_contact_ratio", "gear.tip_diameter")
"""Keys and results that are proposed at first."""

_ARROWS = {"ArrowLeft": (-1, 0), "ArrowRight": (1, 0), "ArrowUp": (0, 1), "ArrowDown": (0, -1)}
"""Steps across and up in a map, by keys."""

_KEYS = f"""event => {{
  if (![{", ".join(f"'{key}'" for key in (*_ARROWS, "Enter"))}].includes(event.key)) return;
  event.preventDefault();
  emit(event);
}}"""
"""Script that tells the server of these keys only."""

_LONGEST = 40
"""Largest number of characters of a number."""


class _Axis(NamedTuple):
    """The fields of one key: the key, its first and last value, and the number of values."""

    key: Any
    first: Any
    last: Any
    count: Any


class StudyPanel(SearchPanel):
    """A map of one result over two keys."""

    kind = "study"

    def __init__(self, place: TaskPlace) -> None:
        self._chart: Any = None
        self._design: Design | None = None
        self._axes: list[_Axis] = []
        self._place_marked: tuple[int | None, int | None] = (None, None)
        self._cursor: tuple[int, int] | None = None
        super().__init__(place, place.words["draw the map"])

    def _build_form(self) -> None:
        words = self._words
        with ui.element("div").classes("task-form"):
            for at, (name, title) in enumerate((("across", words["across"]), ("up", words["up"]))):
                with field_row(title, "", "", f"task-study-{name}") as row:
                    row.classes("wide")
                    key = choice_field({}, with_input=True)
                    key.on_value_change(lambda _, at=at: self._propose(at))
                    key.props(f"dense outlined options-dense hide-bottom-space for=task-study-{name}")
                with field_row(words["from, to, number"], "", "", f"task-study-{name}-first"):
                    with ui.element("div").classes("task-range"):
                        first, last, count = (self._number(f"task-study-{name}-{each}") for each in ("first", "last", "count"))
                self._axes.append(_Axis(key, first, last, count))
            with field_row(words["result"], "", "", "task-study-result") as row:
                row.classes("wide")
                self._result = choice_field({}, with_input=True)
                self._result.on_value_change(lambda _: self._choose())
                self._result.props("dense outlined options-dense hide-bottom-space for=task-study-result")

    def _number(self, name: str) -> Any:
        made = ui.input().on("keydown.enter", self.start)
        made.props(f"dense outlined for={name} hide-bottom-space no-error-icon input-class=task-input autocomplete=off")
        made.props["aria-label"] = name.rpartition("-")[2]
        return made

    def follow(self) -> None:
        """Offer the keys and the results of the present design, and mark it in the map."""
        design = self._place.bench.shown_design
        if design is None or design is self._design:
            return
        first = self._design is None or self._design.kind is not design.kind
        self._design = design
        if first:
            background_tasks.create(self._offer(design))
        elif self._shown and self._marked(self._shown) != self._place_marked:
            self._show(self._shown)

    async def _offer(self, design: Design) -> None:
        """Offer what a kind of design has; keys and results that are chosen stay if there are such."""
        figures = await run.io_bound(figures_of, design)
        if figures is None or design is not self._design:
            return
        keys = dict(_keys(design, self._place.bench.tables, self._words))
        proposed = _usual_keys(keys, given_texts(self._place.bench.tables))
        for axis, usual in zip(self._axes, proposed, strict=True):
            chosen = axis.key.value if axis.key.value in keys else usual
            axis.key.set_options(keys, value=chosen)
        results = {key: _column_words(key, design, self._words) for key in figures}
        first = next((key for key in _FIRST_RESULTS if key in results), next(iter(results), None))
        self._result.set_options(results, value=self._result.value if self._result.value in results else first)

    def _propose(self, at: int) -> None:
        """Fill in a range about the present value of the chosen key."""
        axis, bench = self._axes[at], self._place.bench
        design = bench.shown_design
        if design is None or axis.key.value is None:
            return
        text = given_texts(bench.tables).get(axis.key.value) or used_texts(design, bench.tables).get(axis.key.value, "")
        try:
            value = float(text)
        except ValueError:
            value = 0.0
        whole = axis.key.value.endswith("teeth")
        reach = float(_STEPS) if whole else abs(value) * _SHARE or 1.0
        reach = reach if whole else float(f"{reach:.1g}")
        unit = self._unit(axis.key.value)
        for field, number in ((axis.first, value - reach), (axis.last, value + reach)):
            field.set_value(self._words.number(f"{unit.of(number):.6g}"))
        axis.count.set_value(str(2 * _STEPS + 1 if whole else _COUNT))

    def _options(self) -> dict[str, Any] | None:
        bench = self._place.bench
        self._line.set_text("")
        for axis in self._axes:
            for field in axis:
                field.error = None
        try:
            vary = [self._vary(axis) for axis in self._axes]
            study_axes(bench.design, bench.tables, vary)
        except ParameterError as error:
            self._line.set_text(self._words.message(str(error)))
            self._line.classes(add="fault")
            return None
        if bench.fault is not None or self._result.value is None:
            self._line.set_text("" if bench.fault is None else self._words.message(bench.fault.line))
            return None
        return {"vary": vary, "result": self._result.value}

    def _summary(self, options: Mapping[str, Any]) -> str:
        ranges = (f"{axis.first.value} … {axis.last.value}" for axis in self._axes)
        keys = (f"{self._key_words(axis.key.value)} {said}" for axis, said in zip(self._axes, ranges, strict=True))
        return " · ".join((*keys, str(self._result.options.get(options["result"], options["result"]))))

    def _vary(self, axis: _Axis) -> str:
        """Return what was typed for a key as `gearcad study` has it. Raises ParameterError."""
        key, texts = str(axis.key.value), [str(field.value or "").strip()[:_LONGEST] for field in axis[1:]]
        first, last = (number_of(key, self._unit(key).stored(text)) for text in texts[:2])
        if not texts[2].isdecimal():
            raise ParameterError(key, texts[2], "must have a whole number of values")
        return f"{key}={first!r}:{last!r}:{int(texts[2])}".replace(".0:", ":")

    # ------------------------------------------------------------------ the map

    def _show(self, found: Mapping[str, Any]) -> None:
        if self._chart is None:
            with self._results:
                ui.label(self._words["click a cell: the design takes its values"]).classes("task-hint")
                self._chart = CHART({"series": []}, on_point_click=self._click).classes("task-chart")
                self._chart.props["tabindex"], self._chart.props["role"] = 0, "application"
                self._chart.props["aria-label"] = self._words["map: arrow keys go from cell to cell, Enter takes one"]
                self._chart.on("keydown", self._press, ["key"], js_handler=_KEYS)
                self._at = ui.label().classes("task-hint").props("role=status")
                self._told = ui.label().classes("task-hint")
        words = {"across": self._key_words(found["across"]), "up": self._key_words(found["up"])}
        self._place_marked = self._marked(found)
        present = [self._unit(found[side]).of(self._value(found[side])) for side in ("across", "up")]
        chart = map_chart(self._in_units(found), (present[0], present[1]), words, comma=self._place.comma)
        self._chart.options.clear()
        self._chart.options.update(chart)
        self._chart.update()
        faults = [line for *_, line in found["cells"] if line]
        told = f"{self._words['designs without gears']}: {len(faults)} / {len(found['cells'])}. "
        self._told.set_text(told + self._words.message(faults[0]) if faults else "")

    def _unit(self, key: str) -> ShownUnit:
        """Return the unit in which the values of a key are shown."""
        return self._words.unit(UNITS.get(key, ""), key)

    def _in_units(self, found: Mapping[str, Any]) -> dict[str, Any]:
        """Return a map with its axes and its result in the units of the page."""
        axes = {
            ends: [_shown(each, self._unit(found[key])) for each in found[ends]]
            for ends, key in (("xs", "across"), ("ys", "up"))
        }
        symbol = _symbol_of(found["result"], self._design)
        unit = self._words.unit(symbol[1].unit if symbol else "", found["result"])
        cells = [(x, y, None if value is None else unit.of(value), line) for x, y, value, line in found["cells"]]
        return {**found, **axes, "cells": cells}

    def _marked(self, found: Mapping[str, Any]) -> tuple[int | None, int | None]:
        """Return the place across and up of the cell that is nearest to the present design."""
        return nearest(found["xs"], self._value(found["across"])), nearest(found["ys"], self._value(found["up"]))

    def _value(self, key: str) -> float:
        """Return the value that the present design has under a key; nan if it has no number there."""
        bench = self._place.bench
        design = bench.shown_design
        text = given_texts(bench.tables).get(key) or ("" if design is None else used_texts(design, bench.tables).get(key, ""))
        try:
            return float(text)
        except ValueError:
            return math.nan

    def _key_words(self, key: str) -> str:
        return str(self._axes[0].key.options.get(key, key))

    def _choose(self) -> None:
        """Draw another result of the same designs, which their table has."""
        search, found = self._run, self._shown
        if search is None or search.state is not RunState.DONE or not found or self._result.value in (None, found["result"]):
            return
        if self._result.value not in found["keys"] or (path := search.file(STUDY)) is None:
            return
        axes = {found["across"]: found["xs"], found["up"]: found["ys"]}
        self._shown = {**found, "result": self._result.value, "cells": study_cells(path, axes, self._result.value)}
        search.found = self._shown
        self._show(self._shown)

    def _click(self, event: Any) -> None:
        """Let the design take the values of a cell."""
        data, found = event.data, self._shown
        if event.series_name != CELLS or not isinstance(data, list) or len(data) < 2:
            return
        column, line = data[:2]
        if (
            isinstance(column, int)
            and isinstance(line, int)
            and 0 <= column < len(found["xs"])
            and 0 <= line < len(found["ys"])
        ):
            self.take(column, line)

    def _press(self, event: Any) -> None:
        """Go to a neighbouring cell by an arrow key, or take the cell by Enter."""
        key, found = str(event.args.get("key")), self._shown
        if not found:
            return
        if key == "Enter":
            if self._cursor is not None:
                self.take(*self._cursor)
            return
        across, up = _ARROWS.get(key, (0, 0))
        column, line = self._cursor or tuple(0 if each is None else each for each in self._place_marked)
        moved = (column, line) if self._cursor is None else (column + across, line + up)
        self._cursor = min(max(moved[0], 0), len(found["xs"]) - 1), min(max(moved[1], 0), len(found["ys"]) - 1)
        self._chart.run_chart_method("setOption", {"series": [{"name": CURSOR, "data": [list(self._cursor)]}]})
        self._at.set_text(self._told_of(*self._cursor))

    def _told_of(self, column: int, line: int) -> str:
        """Return the values of a cell in words."""
        found = self._in_units(self._shown)
        value = next((value for x, y, value, _ in found["cells"] if (x, y) == (column, line)), None)
        numbers = (found["xs"][column], found["ys"][line], value)
        keys = (self._key_words(found["across"]), self._key_words(found["up"]))
        names = (*keys, str(self._result.options.get(found["result"], found["result"])))
        said = ("-" if number is None else self._words.number(f"{number:.5g}") for number in numbers)
        return " · ".join(f"{name} = {each}" for name, each in zip(names, said, strict=True))

    def take(self, column: int, line: int) -> None:
        """Write the values of a cell into the design, as one step."""
        found = self._shown
        values = {found["across"]: found["xs"][column], found["up"]: found["ys"][line]}
        try:
            self._place.changed({key: _typed(value) for key, value in values.items()})
        except GearcadError as error:
            self._line.set_text(self._words.message(str(error)))


def _shown(value: Any, unit: ShownUnit) -> Any:
    """Return a value of an axis in the unit of the page; a whole number stays one where that is its own."""
    return value if unit.size == 1 or not isinstance(value, int | float) else unit.of(value)


def _typed(value: Any) -> str:
    """Return a value as somebody would type it."""
    return repr(value).removesuffix(".0") if isinstance(value, float) else str(value)


def _keys(design: Design, tables: Mapping[str, Any], words: PageWords) -> Iterator[tuple[str, str]]:
    """Yield the keys of a design that hold one number, each with its words."""
    for table in fields_of(design, tables):
        for group in table["groups"]:
            for field in group["fields"]:
                if field["number"] and not field["choices"]:
                    title = ": ".join(filter(None, (words[table["title"]], *(words[each] for each in group["titles"]))))
                    unit = words.unit(field["unit"], field["key"]).name
                    said = " ".join(filter(None, (f"{title}: {words[field['words']]}", field["symbol"])))
                    yield field["key"], f"{said} ({unit})" if unit else said


def _usual_keys(keys: Mapping[str, str], given: Mapping[str, str]) -> list[str | None]:
    """Return the two keys that are proposed at first, rather those that the spec has."""
    found = [key for key in (*_FIRST_KEYS, *keys) if key in keys and _is_number(given.get(key, ""))] + list(keys)
    return [*found[:2], None, None][:2]


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _symbol_of(key: str, design: Design | None) -> tuple[str, Symbol] | None:
    """Return whose figure a column of a table of results is, and its symbol; None for a column without one."""
    is_train = design is not None and design.kind is DesignKind.PLANETARY
    return (column_of_train if is_train else column_symbol)(key)


def _column_words(key: str, design: Design, words: PageWords) -> str:
    """Return the words of a column of a table of results."""
    found = _symbol_of(key, design)
    if found is None:
        return key
    owner, symbol = found
    unit = words.unit(symbol.unit, key).name
    said = f"{words[symbol.words]} {symbol.symbol}".strip() or key
    said = f"{said} ({unit})" if unit else said
    return f"{words.table.get(owner.capitalize(), owner)}: {said}" if owner else said
