"""Texts from a browser name no file outside the folder of the page, however they spell it."""

from __future__ import annotations

from pathlib import Path

import pytest

from gearcad.core.errors import SpecError
from gearcad.designs.reader import starter_text
from gearcad.page.run_process import design_of
from gearcad.page.workbench import Workbench

PAIR = starter_text("fzg-c")[1]
_HEAD, _, _REST = starter_text("train-pairs")[1].partition("# pair = ")
TRAIN = f'{_HEAD}pair = "NAMED"\n\n[[train.mesh]]{_REST.partition("[[train.mesh]]")[2]}'
MATING = "[pair]\nnormal_module = 2.0\nface_width = 24.0\n[pinion]\nteeth = 18\n[wheel]\nteeth = 54\n"
REFUSED = "must be a file in the folder of the page"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "secret.toml").write_text(PAIR, encoding="utf-8")
    inside = tmp_path / "inside"
    inside.mkdir()
    (inside / "led-out.toml").symlink_to(tmp_path / "secret.toml")
    return inside


@pytest.mark.parametrize("name", ["../secret.toml", "sub/../../secret.toml", "/etc/passwd", "led-out.toml", "../no"])
def test_files_outside_are_refused_whether_they_are_there_or_not(folder: Path, name: str) -> None:
    drawn = f'{PAIR}\n[drawing]\ntemplate = "{name}"\n'
    with pytest.raises(SpecError, match=REFUSED) as told:
        design_of(drawn, "mine", folder)
    assert told.value.key == "drawing.template"
    meshed = TRAIN.replace("NAMED", name)
    with pytest.raises(SpecError, match=REFUSED):
        design_of(meshed, "mine", folder)


def test_files_inside_are_found_and_theirs_must_be_inside_too(folder: Path) -> None:
    (folder / "fzg-c.toml").write_text(MATING, encoding="utf-8")
    train = TRAIN.replace("NAMED", "fzg-c.toml")
    assert len(design_of(train, "mine", folder).train.meshes) == 2  # type: ignore[attr-defined]
    assert design_of(PAIR + '\n[drawing]\ntemplate = "mine.toml"\n', "mine", folder).drawing.template == str(
        folder / "mine.toml"
    )
    bad = MATING + '\n[drawing]\ntemplate = "../secret.toml"\n'
    (folder / "fzg-c.toml").write_text(bad, encoding="utf-8")
    with pytest.raises(SpecError, match=REFUSED):
        design_of(train, "mine", folder)


def test_the_workbench_refuses_them_as_a_fault_and_keeps_the_last_design(folder: Path) -> None:
    bench = Workbench(PAIR, "mine", folder)
    design = bench.design
    bench.write(PAIR + '\n[drawing]\ntemplate = "/etc/passwd"\n')
    assert bench.fault is not None and REFUSED in bench.fault.line and bench.fault.key == "drawing.template"
    assert bench.design is design
