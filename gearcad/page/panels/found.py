"""Panels of searches whose results are lists: pairs for a task, flank modifications, and gears that were measured."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from nicegui import ui

from gearcad.core.errors import GearcadError
from gearcad.core.units import ShownUnit
from gearcad.designs.reader import edit_spec
from gearcad.designs.train_keys import UNITS
from gearcad.designs.variations import column_symbol
from gearcad.identify.standards import FREE
from gearcad.page.charts import FOUND, FRONT, pairs_chart
from gearcad.page.components.elements import CHART
from gearcad.page.panels.search import SearchPanel, TaskPlace
from gearcad.page.searches import IDENTIFIED
from gearcad.page.words import PageLanguage, PageWords

_ROW = """
<q-tr :props="props" :class="{ taken: props.row.taken }" @click="() => $parent.$emit('take', props.row.id)">
  <q-td v-for="(col, at) in props.cols" :key="col.name" :props="props">
    <button v-if="at === 0" type="button" class="take">{{ col.value }}</button><template v-else>{{ col.value }}</template>
  </q-td>
</q-tr>
"""
"""Row of a table that is taken by a click, or by the keys that press the button in its first cell."""

_HEAD = '<q-th :props="props" :title="props.col.title">{{ props.col.label }}</q-th>'


class FoundColumn(NamedTuple):
    """A column of a table: the key of its values, its heading, words, the number of decimals (None: text), and the unit.

    Decimals and unit are those of the values; the page may show another unit.
    """

    key: str
    label: str
    title: str
    decimals: int | None = None
    unit: str = ""


class FoundTable:
    """A table whose rows can be sorted, and taken: `take` hears the place of a row in its list."""

    def __init__(self, columns: Sequence[FoundColumn], take: Callable[[int], None], words: PageWords) -> None:
        self._columns, self._words = columns, words
        self._table = ui.table(columns=[], rows=[], row_key="id", pagination=0)
        self._table.props("dense flat hide-pagination binary-state-sort").classes("found-table")
        self._table.add_slot("body", _ROW)
        self._table.add_slot("header-cell", _HEAD)
        self._table.on("take", lambda event: take(event.args) if isinstance(event.args, int) else None)

    def show(self, rows: Iterable[Mapping[str, Any]], taken: int | None) -> None:
        """Show rows; the one at a place is marked as taken."""
        rows = list(rows)
        filled = [column for column in self._columns if any(row.get(column.key) is not None for row in rows)]
        self._table.columns = [_column(column, self._words) for column in filled]
        self._table.rows = [
            {column.key: _shown(row[column.key], column, self._words) for column in filled}
            | {"id": place, "taken": place == taken}
            for place, row in enumerate(rows)
        ]


def _shown(value: Any, column: FoundColumn, words: PageWords) -> Any:
    """Return a value of a column in the unit of the page."""
    return words.unit(column.unit, column.key).of(value) if column.unit and isinstance(value, float) else value


def _column(column: FoundColumn, words: PageWords) -> dict[str, Any]:
    unit = words.unit(column.unit, column.key)
    label = f"{column.label} {unit.name}".strip()
    made = {"name": column.key, "field": column.key, "label": label, "title": column.title, "sortable": True}
    if column.decimals is None:
        return made | {"align": "left"}
    decimal = ".replace('.', ',')" if words.language is PageLanguage.GERMAN else ""
    decimals = max(column.decimals + unit.more_digits, 0)
    return made | {
        "align": "right",
        ":format": f"value => typeof value === 'number' ? value.toFixed({decimals}){decimal} : ''",
    }


class SizePanel(SearchPanel):
    """Pairs for a torque, a ratio, a speed, a life and a material."""

    kind = "size"

    def __init__(self, place: TaskPlace) -> None:
        self._chart: Any = None
        self._table: FoundTable | None = None
        self._taken = ""
        super().__init__(place, self._begin_words(place.words))

    @staticmethod
    def _begin_words(words: PageWords) -> str:
        return words["find pairs"]

    @staticmethod
    def _columns(words: PageWords) -> list[FoundColumn]:
        """Return the columns of the table."""
        return _pair_columns(words)

    def _show(self, found: Mapping[str, Any]) -> None:
        if self._table is None:
            with self._results:
                self._hint = ui.label(self._words["click a row or a point: it stands there as the design"]).classes("task-hint")
                self._chart = CHART({"series": []}, on_point_click=self._point).classes("task-chart")
                self._table = FoundTable(self._columns(self._words), self._take, self._words)
        self._draw(found)

    def _draw(self, found: Mapping[str, Any]) -> None:
        assert self._table is not None
        places = {row["name"]: place for place, row in enumerate(found["rows"])}
        self._table.show(found["rows"], places.get(self._taken))
        unit = self._words.unit("kg")
        words = {"margin": self._words["least safety over the required one"], "mass": f"{self._words['mass']} ({unit.name})"}
        chart = pairs_chart(_with_masses(found, unit), self._taken, words, comma=self._place.comma, unit=unit.name)
        self._chart.options.clear()
        self._chart.options.update(chart)
        self._chart.update()
        self._results.set_visibility(bool(found["rows"]))

    def _point(self, event: Any) -> None:
        value = event.value
        place = value[3] if isinstance(value, list) and len(value) > 3 else None
        if isinstance(place, int) and event.series_name in (FOUND, FRONT):
            self._take_of("rows" if event.series_name == FOUND else FRONT, place)

    def _take(self, place: int) -> None:
        self._take_of("rows", place)

    def _take_of(self, of: str, place: int) -> None:
        """Make one of the pairs the design."""
        rows = self._shown.get(of, [])
        if 0 <= place < len(rows):
            self._taken = rows[place]["name"]
            self._place.opened(rows[place]["text"], self._taken)
            self._draw(self._shown)


def _with_masses(found: Mapping[str, Any], unit: ShownUnit) -> dict[str, Any]:
    """Return what a search for sizes has found, with its masses in the unit of the page."""
    lists = {key: [row | {"mass": unit.of(row["mass"])} for row in found[key]] for key in ("rows", FRONT)}
    return {**found, **lists, "cloud": [[margin, unit.of(mass)] for margin, mass in found["cloud"]]}


class SetSizePanel(SizePanel):
    """Planetary sets for a torque, a ratio, a speed, a life and a material."""

    kind = "size-sets"

    @staticmethod
    def _begin_words(words: PageWords) -> str:
        return words["find sets"]

    @staticmethod
    def _columns(words: PageWords) -> list[FoundColumn]:
        return [
            FoundColumn("name", words["set"], words["kind, teeth, planets, normal module and face width"]),
            FoundColumn("mass", "", words["mass"], 2, "kg"),
            FoundColumn("S_H", "S_H", words["safety of the flank against pitting"], 2),
            FoundColumn("S_F", "S_F", words["safety of the root against breakage"], 2),
            FoundColumn("i", "i", words["ratio"], 4),
            FoundColumn("off", "%", words["deviation from the ratio wanted"], 2),
            FoundColumn("planets", "N", words["number of planets"], 0),
            FoundColumn("normal_module", "m_n", words["normal module"], 2, "mm"),
            FoundColumn("b", "b", words["face width"], 1, "mm"),
            FoundColumn("diameter", "⌀", words["diameter over all teeth"], 1, "mm"),
            FoundColumn("a", "a", words["centre distance"], 2, "mm"),
            FoundColumn("K_gamma", "K_γ", words["mesh load factor"], 2),
        ]


def _pair_columns(words: PageWords) -> list[FoundColumn]:
    return [
        FoundColumn("name", words["pair"], words["teeth, normal module and helix angle"]),
        FoundColumn("mass", "", words["mass"], 2, "kg"),
        FoundColumn("S_H", "S_H", words["safety of the flank against pitting"], 2),
        FoundColumn("S_F", "S_F", words["safety of the root against breakage"], 2),
        FoundColumn("a", "a", words["centre distance"], 1, "mm"),
        FoundColumn("b", "b", words["face width"], 1, "mm"),
        FoundColumn("u", "u", words["gear ratio"], 3),
        FoundColumn("eps_a", "ε_α", words["transverse contact ratio"], 2),
        FoundColumn("eps_b", "ε_β", words["overlap ratio"], 2),
        FoundColumn("sliding", "ζ", words["greatest specific sliding"], 2),
        FoundColumn("temperature", "", words["integral temperature"], 0, "°C"),
        FoundColumn("ripple", "%", words["change of the length of the lines of contact"], 0),
        FoundColumn("error", "TE", words["transmission error, peak to peak"], 2, "µm"),
        FoundColumn("efficiency", "η %", words["efficiency of a mesh"], 3),
    ]


class IdentifyPanel(SearchPanel):
    """The standard gears that readings may be of."""

    kind = "identify"

    def __init__(self, place: TaskPlace) -> None:
        self._table: FoundTable | None = None
        super().__init__(place, place.words["identify the gear"])

    def _show(self, found: Mapping[str, Any]) -> None:
        if self._table is None:
            with self._results:
                ui.label(self._words["click a row: it stands there as the design"]).classes("task-hint")
                self._table = FoundTable(_gear_columns(self._words), self._take, self._words)
        self._table.show(self._rows(), None)

    def _take(self, place: int) -> None:
        """Make the gear of a row the design."""
        rows = self._shown.get("rows", [])
        if 0 <= place < len(rows) and self._table is not None:
            self._place.opened(rows[place]["text"], IDENTIFIED)
            self._table.show(self._rows(), place)

    def _rows(self) -> list[dict[str, Any]]:
        """Return the candidates with the name of their series in the language of the page."""
        free = self._words["no series"]
        return [{**row, "name": free if row["name"] == FREE else row["name"]} for row in self._shown.get("rows", [])]


def _gear_columns(words: PageWords) -> list[FoundColumn]:
    return [
        FoundColumn("name", words["series"], words["series of the module or diametral pitch"]),
        FoundColumn("probability", "%", words["probability"], 1),
        FoundColumn("normal_module", "m_n", words["normal module"], 4, "mm"),
        FoundColumn("pressure_angle", "α_n °", words["normal pressure angle"], 2),
        FoundColumn("helix_angle", "β °", words["helix angle"], 2),
        FoundColumn("shift", "x", words["profile shift"], 3),
        FoundColumn("thinning", "A_sn", words["tooth thinning (normal)"], 3, "mm"),
        FoundColumn("chi_square", "χ²", words["sum of the squared deviations"], 1),
    ]


class ModifyPanel(SearchPanel):
    """Tip relief and crowning for the load of the design."""

    kind = "modify"

    def __init__(self, place: TaskPlace) -> None:
        super().__init__(place, place.words["find modifications"])

    def _show(self, found: Mapping[str, Any]) -> None:
        self._results.clear()
        with self._results:
            take = ui.button(self._words["put them into the design"], on_click=self._take, color=None)
            take.props("unelevated no-caps dense").classes("task-go")
            with ui.element("table").classes("task-table"):
                _line("th", "", self._words["before"], self._words["after"], "")
                for key, (words, unit, digits) in _figures(self._words).items():
                    shown = self._words.unit(unit)
                    values = (self._words.number(shown.text(found[side][key], digits)) for side in ("before", "after"))
                    _line("td", words, *values, shown.name)
            with ui.element("table").classes("task-table"):
                for key, value in found["changes"].items():
                    if key != "pair.name":
                        said = value if isinstance(value, str) else self._words.measure(value, 2, UNITS.get(key, "")).strip()
                        _line("td", self._key_words(key), "", said, self._words.message(found["notes"].get(key, "")))

    def _key_words(self, key: str) -> str:
        """Return the words of a key of a gear's modification."""
        owner, symbol = column_symbol(f"{self.kind}.{key}") or ("", None)
        return key if symbol is None else f"{self._words.table.get(owner.capitalize(), owner)}: {self._words[symbol.words]}"

    def _take(self) -> None:
        """Write the modifications into the text of the design, whatever else has changed there since."""
        run, bench = self._run, self._place.bench
        if run is None or not run.found:
            return
        try:
            same = run.asked.text == bench.text
            text = run.found["text"] if same else edit_spec(bench.text, run.found["changes"], run.found["notes"])
        except GearcadError as error:
            self._line.set_text(self._words.message(str(error)))
            return
        self._place.written(text)


def _line(tag: str, *cells: str) -> None:
    """Make a row of a table whose first cell is a heading."""
    with ui.element("tr"):
        for place, cell in enumerate(cells):
            with ui.element("th" if place == 0 else tag):
                ui.label(cell)


def _figures(words: PageWords) -> dict[str, tuple[str, str, int]]:
    """Return words, unit and decimals of the figures of a mesh cycle."""
    return {
        "transmission_error_peak_to_peak": (words["transmission error, peak to peak"], "µm", 3),
        "contact_pressure": (words["contact pressure"], "MPa", 0),
        "root_tension_pinion": (words["root stress of the pinion"], "MPa", 1),
        "root_tension_wheel": (words["root stress of the wheel"], "MPa", 1),
        "face_load_factor": (words["face load factor"], "", 3),
        "edge_positions": (words["positions with a tip edge in contact"], "", 0),
    }
