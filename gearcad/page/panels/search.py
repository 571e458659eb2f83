"""Panel of a search: its form, how far the run in a process of its own is, and what it has found so far."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, ClassVar, NamedTuple

from nicegui import ui

from gearcad.core.errors import GearcadError, ParameterError
from gearcad.core.symbols import parts_of
from gearcad.page.fields import given_texts
from gearcad.page.forms import FormField, fields_in, form_fields, missing_keys, options_of, usual_text
from gearcad.page.runs import Run, Runs, RunState
from gearcad.page.words import PageLanguage, PageWords
from gearcad.page.workbench import Workbench

_LOOK = 0.3
"""Seconds between two looks at a search."""

_LONG_LIST = 10
"""Number of choices from which they are found by typing."""


class TaskPlace(NamedTuple):
    """The workbench and the runs of a session, and what takes results.

    `opened` takes the text and the name of a new design, `written` another text of the present one, `changed` values
    under keys.
    """

    bench: Workbench
    words: PageWords
    runs: Runs
    opened: Callable[[str, str], None]
    written: Callable[[str], None]
    changed: Callable[[Mapping[str, str]], None]

    @property
    def comma(self) -> bool:
        """Whether numbers have a decimal comma."""
        return self.words.language is PageLanguage.GERMAN


class FormView:
    """Fields of a form in the language of the page; `enter` is called where somebody presses Enter in one."""

    def __init__(self, kind: str, place: TaskPlace, enter: Callable[[], None]) -> None:
        self._kind, self._place, self._words, self._enter = kind, place, place.words, enter
        self._fields: dict[str, Any] = {}
        fields = fields_in(kind, place.words.units)
        with ui.element("div").classes("task-form"):
            for field in fields:
                if field.first:
                    self._field(field)
        if not all(field.first for field in fields):
            self._more = ui.expansion(self._words["more"]).classes("task-more").props("dense")
            with self._more, ui.element("div").classes("task-form"):
                for field in fields:
                    if not field.first:
                        self._field(field)

    @property
    def typed(self) -> dict[str, str]:
        """What stands in the fields."""
        return {key: str(field.value).strip() for key, field in self._fields.items() if field.value not in (None, "")}

    def fill(self, typed: Mapping[str, str]) -> None:
        """Put texts into fields."""
        for key, text in typed.items():
            if key in self._fields:
                self._fields[key].set_value(text)

    def summary(self) -> str:
        """Return what was typed, with symbols and units."""
        typed, words = self.typed, self._words
        parts = (
            " ".join(filter(None, (_called(field, words), typed[field.key], words[field.unit])))
            for field in fields_in(self._kind, words.units)
            if field.key in typed
        )
        return " · ".join(parts) or words["task"]

    def options(self) -> dict[str, Any] | None:
        """Return the options of the search, or None where a field is wrong, which then says so."""
        for field in self._fields.values():
            field.error = None
        if missing := missing_keys(self._kind, self.typed):
            for key in missing:
                self._fields[key].error = self._words["must be given"]
            self._fields[missing[0]].run_method("focus")
            return None
        try:
            return options_of(self._kind, self.typed, comma=self._place.comma, units=self._words.units)
        except ParameterError as error:
            self.blame(error)
            return None

    def blame(self, error: ParameterError) -> None:
        """Say what is wrong at its field, and go there."""
        field = self._fields.get(error.parameter) or next(iter(self._fields.values()))
        field.error = self._words.message(str(error))
        if all(each is not field for each in self._firsts()):
            self._more.open()
        field.run_method("focus")

    def _firsts(self) -> list[Any]:
        return [self._fields[field.key] for field in form_fields(self._kind) if field.first]

    def _field(self, field: FormField) -> None:
        said = self._words.divided(self._words[field.words])
        label = f"{self._words['wheel']}: {said}" if field.of_wheel else said
        name = f"task-{self._kind}-{field.key}"
        with field_row(label, field.symbol, self._words[field.unit], name, self._words[field.hint]) as row:
            row.classes("required" if field.required else "")
            row.classes("wide" if len(field.choices) > _LONG_LIST else "")
            if field.choices:
                is_long = len(field.choices) > _LONG_LIST
                made: Any = choice_field(_choices(field, self._words), with_input=is_long, clearable=not field.required)
            else:
                made = ui.input(placeholder=self._words[usual_text(field, comma=self._place.comma)])
                made.on("keydown.enter", self._enter)
            made.props(f'dense outlined for={name} hide-bottom-space no-error-icon input-class="task-input"')
            made.props("options-dense" if field.choices else "autocomplete=off")
        self._fields[field.key] = made


def _called(field: FormField, words: PageWords) -> str:
    """Return the symbol of a field, or its words; nothing for a choice, whose text says what it is."""
    return field.symbol or ("" if field.choices else words[field.words])


@contextmanager
def field_row(words: str, symbol: str, unit: str, name: str, hint: str = "") -> Iterator[ui.element]:
    """Make a row with the words of a field, its symbol and its unit. The field is made within; its own name is `name`."""
    with ui.element("div").classes("task-field") as row:
        label = ui.element("label").props(f"for={name}")
        label.props["title"] = hint
        with label:
            ui.label(words)
            with ui.element("span").classes("symbol"):
                for text, index in parts_of(symbol):
                    ui.label(text)
                    if index:
                        ui.label(index).classes("index")
        yield row
        ui.label(unit).classes("unit")


def choice_field(choices: dict[str, str], *, with_input: bool, clearable: bool = False) -> Any:
    """Make a field for one of several values with their words. With input, Enter takes the first that has what was typed."""
    made = ui.select(choices, with_input=with_input, clearable=clearable)
    if not with_input:
        return made
    typed = [""]

    def type_in(event: Any) -> None:
        typed[0] = str(event.args or "").strip().casefold()

    def take() -> None:
        words = made.options if isinstance(made.options, dict) else {}
        if typed[0] and typed[0] != str(words.get(made.value, "")).casefold():
            matching = [value for value, said in words.items() if typed[0] in said.casefold()]
            exact = [value for value in matching if value.casefold() == typed[0]]
            if found := [*exact, *matching]:
                made.set_value(found[0])
                made.run_method("hidePopup")

    made.on("input-value", type_in)
    made.on("keydown.enter", take)
    made.on("blur", take)
    return made


def _choices(field: FormField, words: PageWords) -> dict[str, str]:
    """Return the words of each choice by its value; of materials also those of their groups."""
    own = choice_words(words)
    groups = _material_words(words)
    set_types = {"A": words["sun and ring"], "B": words["stepped planets"], "C": words["two suns"], "D": words["two rings"]}
    found = {}
    for each in field.choices:
        group = groups.get(each.rpartition(" ")[0], "") if field.key.endswith("material") else ""
        kind = set_types.get(each, "") if field.key == "type" else ""
        found[each] = f"{each}: {group or kind}" if group or kind else own.get(each, each)
    return found


def choice_words(words: PageWords) -> dict[str, str]:
    """Return the words of choices that are none of a standard."""
    return {
        "mass": words["mass"],
        "safety": words["safety"],
        "quiet": words["quiet running"],
        "sliding": words["little sliding"],
        "scuffing": words["little scuffing"],
        "efficiency": words["efficiency of a mesh"],
        "true": words["yes"],
        "sun": words["sun"],
        "ring": words["ring"],
        "carrier": words["carrier"],
        "sun_2": words["second sun"],
        "ring_2": words["second ring"],
        "linear": words["linear"],
        "parabolic": words["parabolic"],
    }


def _material_words(words: PageWords) -> dict[str, str]:
    """Return the words of the groups of ISO 6336-5 by their abbreviations."""
    return {
        "St": words["structural steel"],
        "St (cast)": words["cast steel"],
        "V": words["through-hardened alloy steel"],
        "V (carbon)": words["through-hardened carbon steel"],
        "V (cast)": words["through-hardened alloy cast steel"],
        "V (cast carbon)": words["through-hardened carbon cast steel"],
        "GGG": words["nodular cast iron"],
        "GGG (ferr.)": words["ferritic nodular cast iron"],
        "GTS": words["malleable cast iron"],
        "GG": words["grey cast iron"],
        "Eh": words["case-hardened steel"],
        "IF": words["flame or induction hardened steel"],
        "NT": words["nitriding steel, nitrided"],
        "NV": words["steel, nitrided"],
        "NV (nitrocar.)": words["steel, nitrocarburised"],
    }


class SearchPanel:
    """A form, the search that it starts, how far that is, and what it has found so far."""

    kind: ClassVar[str]

    def __init__(self, place: TaskPlace, begin: str) -> None:
        self._place, self._words = place, place.words
        self._steps = _steps(place.words)
        self._run: Run | None = next((run for run in reversed(place.runs.all) if run.asked.kind == self.kind), None)
        self._shown: Mapping[str, Any] = {}
        self._task = ui.expansion(place.words["task"], value=True).classes("task-task").props("dense")
        with self._task:
            self._build_form()
        with ui.element("div").classes("task-begin"):
            self._begin = ui.button(begin, on_click=self.start, color=None).props("unelevated no-caps dense").classes("task-go")
            self._bar = ui.linear_progress(0, show_value=False).classes("task-progress")
            self._step = ui.label().classes("task-step").props("role=status")
            self._cancel = ui.button(self._words["cancel"], on_click=self._stop, color=None).props("flat no-caps dense")
        self._line = ui.label().classes("task-line").props("role=status")
        self._results = ui.element("div").classes("task-results")
        self._timer = ui.timer(_LOOK, self.look, active=self._run is not None)
        self.look()

    # ------------------------------------------------------------------ what each search has of its own

    def _build_form(self) -> None:
        self._form = FormView(self.kind, self._place, self.start)

    def _options(self) -> dict[str, Any] | None:
        """Return the options of the search; None where something is wrong, which is then said."""
        return self._form.options()

    def _summary(self, _options: Mapping[str, Any]) -> str:
        """Return the task in few words, as the heading of its folded form."""
        return self._form.summary()

    def _show(self, found: Mapping[str, Any]) -> None:
        """Show what was found so far."""
        raise NotImplementedError

    # ------------------------------------------------------------------ the run

    def start(self) -> None:
        """Begin the search, in place of the one before."""
        bench = self._place.bench
        if (options := self._options()) is None:
            return
        try:
            if self._run is not None and not self._run.state.ended:
                self._place.runs.cancel(self._run)
            given = given_texts(bench.tables)
            self._run = self._place.runs.start(self.kind, bench.text, bench.name, bench.folder, given, options)
        except GearcadError as error:
            self._line.set_text(self._words.message(str(error)))
            return
        self._line.set_text("")
        self._task.set_text(self._summary(options))
        self._task.close()
        self._timer.activate()
        self.look()

    def _stop(self) -> None:
        if self._run is not None:
            self._place.runs.cancel(self._run)

    def look(self) -> None:
        """Show how far the search is, and what is new."""
        run = self._run
        busy = run is not None and not run.state.ended
        for each in (self._bar, self._step, self._cancel):
            each.set_visibility(busy)
        if run is None:
            return
        if busy:
            step, _, detail = run.step.partition(", ")
            told = ", ".join(filter(None, (self._steps.get(step, step), detail, run.left and f"≈ {_figure(run.left)}")))
            self._bar.set_value(run.share)
            self._step.set_text(self._words.message(told) if run.state is RunState.RUNNING else self._words["waiting"])
        if run.found is not self._shown and run.found:
            self._shown = run.found
            self._show(run.found)
        if not busy:
            self._timer.deactivate()
            cancelled = self._words["cancelled"] if run.state is RunState.CANCELLED else ""
            lines = (run.line or cancelled, *run.notices)
            self._line.set_text("\n".join(self._words.message(line) for line in lines if line))
            self._line.classes(remove="fault", add="fault" if run.state is RunState.FAILED else "")


def _figure(words: str) -> str:
    """Return a rough figure without the words around it."""
    return words.removeprefix("about ").removesuffix(" left")


def _steps(words: PageWords) -> dict[str, str]:
    """Return the words of the steps of searches."""
    return {
        "variants": words["variants"],
        "tooth numbers": words["tooth numbers"],
        "sizes": words["sizes"],
        "refinement": words["refinement"],
        "transmission error": words["transmission error"],
        "designs": words["designs"],
        "bodies of pinion and wheel": words["bodies of pinion and wheel"],
        "mesh cycle": words["mesh cycle"],
        "search": words["search"],
        "robustness": words["robustness"],
    }
