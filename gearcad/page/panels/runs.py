"""Panel of runs: computations that take longer than a keystroke, with the figures of earlier runs beside them."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from nicegui import background_tasks, run, ui

from gearcad.core.errors import GearcadError, format_number
from gearcad.core.records import Verdict
from gearcad.core.runtime import Expected, about, about_memory
from gearcad.designs.design import Design
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.designs.train_keys import UNITS
from gearcad.designs.variations import column_of_train, column_symbol
from gearcad.page.components.elements import RunsView
from gearcad.page.fields import given_texts
from gearcad.page.panels.sheet_content import called
from gearcad.page.run_process import ANALYSES, RUNS
from gearcad.page.runs import KINDS, Run, Runs, RunState
from gearcad.page.words import PageWords
from gearcad.page.workbench import Workbench

_DIGITS = 5
_MOST_CHANGES = 12


def verb_of(run: Run) -> str:
    """Return the verb of the job of a run; runs of one verb have the same figures."""
    return RUNS[run.asked.kind].job().verb


def changes_between(former: Mapping[str, str], given: Mapping[str, str], words: PageWords) -> list[str]:
    """Return the differences between two specs as words, one for each key; beyond a limit only their number is given."""

    def shown(texts: Mapping[str, str], key: str) -> str:
        unit = words.unit(UNITS.get(key, ""), key)
        return unit.shown(texts[key]) if key in texts else "-"

    keys = [key for key in dict.fromkeys((*former, *given)) if former.get(key) != given.get(key)]
    told = [f"{key} {shown(former, key)} → {shown(given, key)}" for key in keys[:_MOST_CHANGES]]
    return told if len(keys) <= _MOST_CHANGES else [*told, f"+ {len(keys) - _MOST_CHANGES}"]


def figures_beside(runs: Sequence[Run], words: PageWords) -> list[dict[str, Any]]:
    """A row for each figure that any of these runs of one verb has: what it is, and a cell for each run."""
    verb = verb_of(runs[0]) if runs else ""
    symbol_of = column_of_train if verb == "planetary" else column_symbol
    found = []
    for key in dict.fromkeys(key for each in runs for key in each.figures):
        values = [each.figures.get(key) for each in runs]
        owner, symbol = symbol_of(f"{verb}.{key}") or ("", None)
        unit = words.unit(symbol.unit if symbol else "", key)
        cells = [_text(unit.of(value) if isinstance(value, float) else value, words) for value in values]
        if not any(cells):
            continue
        said = words[symbol.words] if symbol and symbol.words else words.message(key.replace("_", " "))
        found.append(
            {
                "key": key,
                "words": words.divided(f"{words.table.get(owner.capitalize(), owner)}: {said}" if owner else said),
                "symbol": symbol.parts if symbol else (),
                "unit": unit.name,
                "cells": cells,
                "differs": len(set(cells)) > 1,
            }
        )
    return found


def _text(value: Any, words: PageWords) -> str:
    """Return a figure as the page shows it; empty if there is none."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return words["yes"] if value else words["no"]
    if (verdict := _verdicts(words).get(value)) is not None:
        return verdict
    if isinstance(value, float):
        return words.number(f"{value:.{_DIGITS}g}") if math.isfinite(value) else ""
    return format_number(value) if isinstance(value, int) else words.message(str(value))


def _verdicts(words: PageWords) -> dict[str, str]:
    """Return the words for each verdict of a computation or a rating."""
    return {
        Verdict.PASSED.value: words["passed"],
        Verdict.FAILED.value: words["not passed"],
        Verdict.NOT_JUDGED.value: words["not judged"],
        Verdict.NOT_ASKED.value: words["not asked for"],
    }


_REST = 1.0
"""Seconds without a change after which it is worth telling what runs would take."""

_LOOK = 0.25


class Outlook(NamedTuple):
    """The expected duration or size of a run, or the reason why it would not begin."""

    told: str = ""
    why: str = ""


class RunsPanel:
    """Follows the workbench; runs belong to the text with which they were started. While `seen` it tells what they take.

    It calls `ended` each time that runs begin or end.
    """

    def __init__(
        self,
        bench: Workbench,
        words: PageWords,
        runs: Runs | None = None,
        seen: Callable[[], bool] = lambda: True,
        ended: Callable[[], None] = lambda: None,
    ) -> None:
        self._bench, self._words, self._runs, self._seen = bench, words, runs or Runs(), seen
        limits = Expected(self._runs.limits.seconds, self._runs.limits.memory)
        self._view = RunsView(
            self._start, self._cancel, _words(words), f"{words['each run has at most']} {_size(limits, words)}"
        )
        self._expected: dict[str, Outlook] = {}
        self._design: Design | None = None
        self._expected_of: Design | None = None
        self._task: asyncio.Task[None] | None = None
        self._names = _names(words)
        self._kinds: list[dict[str, Any]] = []
        self._stale: list[int] = []
        self._ended = ended
        self._timer = ui.timer(_LOOK, self._look, active=False)
        self._states: dict[int, RunState] = {}
        self._handed = False
        if runs is not None:
            self._timer.activate()

    def follow(self) -> None:
        """Show which runs are of another design than that of the workbench, and what can be run on it."""
        design = self._bench.shown_design
        if design is not self._design:
            self._design = design
            self._show_kinds()
            if self._seen():
                self.expect()
        self._show_stale()

    def watch(self) -> None:
        """Show the runs, those that others have started too, until all have ended."""
        self._timer.activate()
        self._look()

    def expect(self) -> None:
        """Find out what runs on the design would take."""
        if self._task is not None:
            self._task.cancel()
        if (design := self._bench.shown_design) is not None:
            self._task = background_tasks.create(self._expect(design))

    @property
    def runs(self) -> Runs:
        """The runs of the session."""
        return self._runs

    def run_name(self, of: Run) -> str:
        """Return the name of a run: its kind, and of a planetary train its mesh."""
        return self._called(of.asked.kind, self._design)

    def hand_over(self) -> Runs:
        """Return the runs of the panel, which go on in the panel that gets them."""
        self._handed = True
        return self._runs

    def close(self) -> None:
        """The tab was closed: its runs end, and their files go, unless they were handed over."""
        if not self._handed:
            self._runs.close()
        if self._task is not None:
            self._task.cancel()

    async def _expect(self, design: Design) -> None:
        if design is self._expected_of:
            return
        await asyncio.sleep(_REST)
        self._expected = await run.io_bound(expected_of, design, self._words) or {}
        self._expected_of = design
        self._show_kinds()

    def _start(self, kind: str) -> None:
        bench, line = self._bench, ""
        if kind not in ANALYSES or not ANALYSES[kind].accepts(bench.design):
            return
        if bench.fault is not None:
            line = self._words.message(bench.fault.line)
        else:
            try:
                self._runs.start(kind, bench.text, bench.name, bench.folder, given_texts(bench.tables))
            except GearcadError as error:
                line = self._words.message(str(error))
        self._view.show(line=line)
        self._timer.activate()
        self._look()

    def _cancel(self, number: int) -> None:
        if 0 <= number < len(self._runs.all):
            self._runs.cancel(self._runs.all[number])

    def _look(self) -> None:
        """Show the progress of the work that is being done."""
        busy = self._runs.busy
        states = {each.number: each.state for each in self._runs.all}
        if states != self._states:
            self._states = states
            self._show_runs()
            self._ended()
        for each in self._runs.all:
            if each.state is RunState.RUNNING:
                self._view.tell(
                    each.number,
                    {
                        "step": self._words.message(each.step),
                        "share": each.share,
                        "left": self._words.message(_time_left(each)),
                    },
                )
        if not busy:
            self._timer.deactivate()

    def _show_kinds(self) -> None:
        design = self._bench.shown_design
        kinds = [
            {"key": key, "words": self._called(key, design), **self._expected.get(key, Outlook())._asdict()}
            for key, kind in ANALYSES.items()
            if design is not None and kind.accepts(design)
        ]
        if kinds != self._kinds:
            self._kinds = kinds
            self._view.show(kinds=kinds)

    def _called(self, key: str, design: Design | None) -> str:
        """Return the name of a kind of run, with the mesh of a planetary train that it is about."""
        mesh = ANALYSES[key].mesh if key in ANALYSES else None
        if mesh is None or not isinstance(design, PlanetaryDesign):
            return self._names[key]
        return f"{self._names[key]}: {called(self._words, design.train.meshes[mesh].name)}"

    def _show_runs(self) -> None:
        self._view.show(runs=[self._told(each) for each in self._runs.all], tables=self._tables())
        self._show_stale()

    def _show_stale(self) -> None:
        stale = [each.number for each in self._runs.all if each.asked.text != self._bench.text]
        if stale != self._stale:
            self._stale = stale
            self._view.show(stale=stale)

    def _told(self, of: Run) -> dict[str, Any]:
        report, address = KINDS[of.asked.kind].report, f"/made/{self._runs.key}/{of.number}"
        return {
            "number": of.number,
            "words": self.run_name(of),
            "state": of.state.value,
            "step": self._words.message(of.step),
            "share": of.share,
            "left": self._words.message(_time_left(of)),
            "line": self._words.message(of.line),
            "notices": list(map(self._words.message, of.notices)),
            "report": f"{address}/{report}" if report in of.files else "",
            "files": address if of.files else "",
        }

    def _tables(self) -> list[dict[str, Any]]:
        """Return a table of figures for each verb, with the newest run first."""
        done = [each for each in reversed(self._runs.all) if each.state is RunState.DONE and each.asked.kind in ANALYSES]
        found = []
        for verb in dict.fromkeys(map(verb_of, done)):
            runs = [each for each in done if verb_of(each) == verb]
            heads = [
                {
                    "number": each.number,
                    "changes": changes_between(former.given, each.given, self._words) if former else [],
                }
                for each, former in zip(runs, [*runs[1:], None], strict=True)
            ]
            found.append({"verb": verb, "words": self._names[verb], "runs": heads, "rows": figures_beside(runs, self._words)})
        return found


def expected_of(design: Design, words: PageWords) -> dict[str, Outlook]:
    """Return the outlook of each run that accepts designs of this kind, by its key."""
    found = {}
    for key, kind in ANALYSES.items():
        if kind.accepts(design):
            try:
                expected = kind.expected(design) if kind.foreseen else None
            except GearcadError as error:
                found[key] = Outlook(why=words.message(str(error)))
            else:
                found[key] = Outlook(f"≈ {_size(expected, words)}" if expected else "")
    return found


def _size(expected: Expected, words: PageWords) -> str:
    memory = f", {about_memory(expected.memory)}" if math.isfinite(expected.memory) else ""
    return words.message(f"{_figure(about(expected.seconds))}{memory}")


def _time_left(of: Run) -> str:
    return f"≈ {_figure(of.left)}" if of.left else ""


def _figure(words: str) -> str:
    """Return a rough figure without the words around it."""
    return words.removeprefix("about ").removesuffix(" left")


def _names(words: PageWords) -> dict[str, str]:
    return {
        "check": words["check"],
        "check-2d": words["check in the plane"],
        "check-3d": words["check of solid bodies"],
        "check-2d-first": words["check in the plane"],
        "check-2d-second": words["check in the plane"],
        "check-3d-first": words["check of solid bodies"],
        "check-3d-second": words["check of solid bodies"],
        "rate": words["rating"],
        "rate-fe": words["rating by the load distribution"],
        "stiffness": words["mesh stiffness"],
        "dynamics": words["dynamics"],
        "planetary": words["planetary train"],
        "shafts": words["shafts and bearings"],
        "mesh": words["meshes of finite elements"],
        "verify": words["verification of the files"],
        "size": words["search for pairs"],
        "size-sets": words["search for planetary sets"],
        "modify": words["search for modifications"],
        "identify": words["identification of a measured gear"],
        "study": words["map of two keys"],
    }


def _words(words: PageWords) -> dict[str, str]:
    return {
        "title": words["Runs"],
        "stale": words["of another design"],
        "waiting": words["waiting"],
        "cancelled": words["cancelled"],
        "failed": words["failed"],
        "done": words["done"],
        "cancel": words["cancel"],
        "report": words["report"],
        "files": words["files"],
        "differing": words["only what differs"],
    }
