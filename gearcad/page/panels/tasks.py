"""Panel of tasks: from what one knows to a design. On an empty page it is all that there is."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from nicegui import ui

from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.designs.reader import NOT_ON_PAGE, starter_text, starters
from gearcad.page.folder import SPECS
from gearcad.page.panels.found import IdentifyPanel, ModifyPanel, SetSizePanel, SizePanel
from gearcad.page.panels.search import TaskPlace
from gearcad.page.panels.study import StudyPanel
from gearcad.page.words import PageWords

_SIZE, _STARTER, _IDENTIFY, _MODIFY, _STUDY = "size", "starter", "identify", "modify", "study"


class TasksPanel:
    """A row of tasks, and the form and the results of the one that is chosen.

    On an empty page these are the three ways to begin; beside a design the ways on from it join them.
    """

    def __init__(self, place: TaskPlace) -> None:
        self._place, self._is_empty = place, False
        words = place.words
        with ui.element("div").classes("tasks"):
            self._title = ui.label(words["What do you begin with?"]).classes("task-title").props("role=heading aria-level=2")
            self._row = ui.tabs(on_change=lambda event: self._choose(str(event.value)))
            self._row.props("dense no-caps align=left inline-label outside-arrows mobile-arrows").classes("tabs task-tabs")
            with self._row:
                self._tabs = {key: ui.tab(key, title) for key, title in self._titles(is_empty=False).items()}
            self._panes = {key: ui.element("div").classes("task-pane") for key in self._tabs}
            with self._panes[_SIZE]:
                self._sizes()
            with self._panes[_STARTER]:
                self._starters()
            with self._panes[_IDENTIFY]:
                IdentifyPanel(place)
            with self._panes[_MODIFY]:
                ModifyPanel(place)
            with self._panes[_STUDY]:
                self._study = StudyPanel(place)
            self._row.set_value(_SIZE)
        self.follow()

    def _sizes(self) -> None:
        """Make the forms for pairs and for planetary sets, of which one is seen."""
        words, forms = self._place.words, dict[str, ui.element]()

        def show(chosen: str) -> None:
            for key, form in forms.items():
                form.set_visibility(key == chosen)

        titles = {SizePanel.kind: words["pair"], SetSizePanel.kind: words["planetary set"]}
        choice = ui.toggle(titles, on_change=lambda event: show(str(event.value))).props(
            "dense no-caps unelevated toggle-color=none toggle-text-color=none"
        )
        choice.classes("task-choice")
        for panel in (SizePanel, SetSizePanel):
            with ui.element("div") as forms[panel.kind]:
                panel(self._place)
        planetary = self._place.bench.shown_design is not None and self._place.bench.design.kind is DesignKind.PLANETARY
        choice.set_value((SetSizePanel if planetary else SizePanel).kind)

    def follow(self) -> None:
        """Offer what can be done with the present design, or without one."""
        bench = self._place.bench
        self._is_empty = bench.is_empty
        self._title.set_visibility(self._is_empty)
        for key, title in self._titles(self._is_empty).items():
            if self._tabs[key].props["label"] != title:
                self._tabs[key].props["label"] = title
                self._tabs[key].update()
        shown = {_SIZE: True, _IDENTIFY: True, _STARTER: self._is_empty, **self._of(bench.shown_design)}
        for key, is_shown in shown.items():
            self._tabs[key].set_visibility(is_shown)
        if not shown.get(str(self._row.value)):
            self._row.set_value(_SIZE)
        if self._row.value == _STUDY:
            self._study.follow()

    @staticmethod
    def _of(design: Design | None) -> dict[str, bool]:
        """Return which tasks a design can have."""
        kind = None if design is None else design.kind
        return {_MODIFY: kind is DesignKind.PAIR, _STUDY: kind not in (None, DesignKind.TRAIN)}

    def _titles(self, is_empty: bool) -> dict[str, str]:
        words = self._place.words
        if is_empty:
            first = {
                _SIZE: words["from a task"],
                _STARTER: words["from a starter"],
                _IDENTIFY: words["from a measured gear"],
            }
        else:
            first = {_SIZE: words["size gears"], _STARTER: words["starters"], _IDENTIFY: words["identify"]}
        return first | {_MODIFY: words["modify"], _STUDY: words["map"]}

    def _choose(self, chosen: str) -> None:
        for key, pane in self._panes.items():
            pane.set_visibility(key == chosen)
        if chosen == _STUDY:
            self._study.follow()

    def _starters(self) -> None:
        with ui.element("div").classes("task-starters"):
            for name, said in starters().items():
                if starter_text(name)[0].endswith(SPECS) and name not in NOT_ON_PAGE:
                    with ui.element("button").props("type=button").on("click", partial(self._begin, name)):
                        ui.label(name).classes("name")
                        ui.label(self._place.words.message(said))

    def _begin(self, name: str) -> None:
        file, text = starter_text(name)
        self._place.opened(text, Path(file).stem)


def ask_to_replace(words: PageWords, replace: Callable[[], None]) -> None:
    """Ask whether a design that is not saved may be replaced, and do so if it may."""

    def answer() -> None:
        question.close()
        replace()

    with ui.dialog(value=True) as question, ui.card().classes("question"):
        ui.label(words["The present design is not saved. Undo brings it back."])
        with ui.row():
            ui.button(words["replace it"], on_click=answer, color=None).props("unelevated no-caps")
            ui.button(words["keep it"], on_click=question.close, color=None).props("flat no-caps autofocus")
    question.on("hide", question.delete)
