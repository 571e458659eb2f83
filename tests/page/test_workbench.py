"""The text of a spec under change: steps back and forth, what is typed without a pause, faults and what stays."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
import tomlkit

from gearcad.core.errors import SpecError
from gearcad.designs.reader import read_spec, starter_text
from gearcad.page.workbench import Fault, Workbench

SPEC = """\
# a pair
[pair]
normal_module = 4.5  # mm
face_width = 14.0

[pinion]
teeth = 16
profile_shift = 0.1817

[wheel]
teeth = 24
"""


class Clock:
    """Seconds that pass when a test says so."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def bench(clock: Clock) -> Workbench:
    return Workbench(SPEC, "pair", Path(), clock)


def test_what_is_typed_without_a_pause_is_one_step(bench: Workbench, clock: Clock) -> None:
    for at, typed in enumerate(("1", "17", "170")):
        clock.now = 0.9 * at
        bench.change({"pinion.teeth": typed})
    assert bench.tables["pinion"]["teeth"] == 170
    assert bench.former["pinion"]["teeth"] == 16
    bench.undo()
    assert bench.text == SPEC
    assert not bench.can_undo
    bench.redo()
    assert bench.tables["pinion"]["teeth"] == 170


@pytest.mark.parametrize(("key", "seconds"), [("pinion.teeth", 1.1), ("wheel.teeth", 0.1)])
def test_a_pause_or_another_field_begins_a_step(bench: Workbench, clock: Clock, key: str, seconds: float) -> None:
    bench.change({"pinion.teeth": "17"})
    clock.now = seconds
    bench.change({key: "25"})
    bench.undo()
    assert (bench.tables["pinion"]["teeth"], bench.tables["wheel"]["teeth"]) == (17, 24)


def test_numbered_steps_are_undone_as_they_were_typed(bench: Workbench, clock: Clock) -> None:
    """However late they come, or how soon one after the other."""
    for step, seconds, typed in ((1, 0.0, "17"), (1, 5.0, "18"), (2, 5.1, "19")):
        clock.now = seconds
        bench.change({"pinion.teeth": typed}, step)
    bench.undo()
    assert bench.tables["pinion"]["teeth"] == 18
    bench.undo()
    assert bench.text == SPEC


def test_after_undo_typing_begins_a_step(bench: Workbench) -> None:
    bench.change({"pinion.teeth": "17"})
    bench.undo()
    bench.change({"pinion.teeth": "18"})
    assert bench.can_undo
    assert not bench.can_redo
    bench.undo()
    assert bench.text == SPEC


def test_comments_stay_and_a_key_goes(bench: Workbench) -> None:
    bench.change({"pair.normal_module": "5,5"})
    assert "normal_module = 5.5  # mm" in bench.text
    bench.change({"pinion.profile_shift": ""})
    assert "profile_shift" not in bench.text
    assert bench.design.gears["pinion"].profile_shift == 0


def test_a_fault_is_the_line_of_the_command_line_and_the_last_good_design_stays(bench: Workbench, tmp_path: Path) -> None:
    bench.change({"pinion.teeth": "3"})
    (spec := tmp_path / "pair.toml").write_text(bench.text)
    with pytest.raises(SpecError) as refused:
        read_spec(spec)
    assert bench.fault is not None
    assert str(refused.value) == f"{tmp_path}/{bench.fault.line}"
    assert bench.fault.key == refused.value.key
    assert bench.design.gears["pinion"].teeth == 16
    bench.change({"pinion.teeth": "18"})
    assert bench.fault is None


def test_text_that_is_no_toml_says_where(bench: Workbench) -> None:
    bench.write(SPEC.replace("teeth = 24", "teeth = "), "text")
    assert bench.fault is not None
    assert bench.fault.line.startswith("pair.toml line 11")
    assert bench.tables["wheel"]["teeth"] == 24


def test_what_cannot_be_written_is_no_step(bench: Workbench) -> None:
    assert not bench.change({"pair.normal_module": "1.234,5"})
    assert bench.fault == Fault(
        "pair.normal_module = '1.234,5': has a comma and a point; write it without a thousands separator",
        "pair.normal_module",
        written=False,
    )
    assert bench.text == SPEC
    assert not bench.can_undo


def test_what_a_named_file_names_must_be_in_the_folder_too(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    folder.mkdir()
    (tmp_path / "title.toml").write_text("", encoding="utf-8")
    tables = tomllib.loads(starter_text("train-pairs")[1])
    mesh = tables["train"]["mesh"][0]
    inner = {"pair": mesh["pair"], "drawing": {"template": "../title.toml"}}
    inner |= {role: inner["pair"].pop(role) for role in ("pinion", "wheel")}
    (folder / "inner.toml").write_text(tomlkit.dumps(inner), encoding="utf-8")
    mesh["pair"] = "inner.toml"
    with pytest.raises(SpecError, match="must be a file in the folder of the page"):
        Workbench(tomlkit.dumps(tables), "train", folder)


def test_the_eldest_steps_go_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.page.workbench._MOST_STEPS", 3)
    bench = Workbench(SPEC, "pair", Path())
    for teeth in range(17, 22):
        bench.write(SPEC.replace("teeth = 16", f"teeth = {teeth}"))
    for _ in range(5):
        bench.undo()
    assert "teeth = 18\n" in bench.text
