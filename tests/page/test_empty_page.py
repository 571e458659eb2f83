"""An empty page: a workbench that waits for a design, and what it is after one has come and gone."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from support.commands import invoke

from gearcad.designs.reader import starter_text
from gearcad.page.workbench import DesignStatus, Workbench

REDUCER = starter_text("reducer")[1]


def test_an_empty_workbench_shows_no_design_and_has_no_fault() -> None:
    bench = Workbench("", "new", Path())
    assert bench.is_empty and bench.is_saved and not bench.can_undo
    assert (bench.shown_design, bench.status, bench.faults(), bench.tables) == (None, DesignStatus.OTHER, (), {})


def test_a_design_ends_it_in_one_step_and_undo_brings_it_back() -> None:
    bench = Workbench("", "new", Path())
    bench.open(REDUCER, "found", saved="")
    assert (bench.is_empty, bench.status, bench.is_saved) == (False, DesignStatus.PRESENT, False)
    assert bench.shown_design is not None and bench.shown_design.name == "reducer-21-43"
    bench.undo()
    assert bench.is_empty and bench.shown_design is None and not bench.can_undo and bench.fault is None
    bench.redo()
    assert bench.status is DesignStatus.PRESENT and bench.text == REDUCER


def test_a_file_whose_text_was_deleted_is_no_empty_page() -> None:
    bench = Workbench(REDUCER, "reducer", Path())
    bench.write("")
    assert not bench.is_empty
    assert bench.fault is not None and "[gear]" in bench.fault.line


def test_a_new_design_begins_empty_and_can_be_undone() -> None:
    bench = Workbench(REDUCER, "reducer", Path())
    bench.open("", "new")
    assert bench.is_empty and bench.shown_design is None and bench.name == "new"
    bench.undo()
    assert bench.status is DesignStatus.PRESENT and bench.name == "reducer"


def test_open_without_a_spec_begins_empty(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []
    monkeypatch.setattr("gearcad.page.server.serve", lambda *given, **options: asked.append(given))
    told = invoke("open", "--no-browser")
    assert told.exit_code == 0, told.output
    assert asked == [("", "new", Path())]
