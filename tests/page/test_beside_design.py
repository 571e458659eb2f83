"""A second design beside the one that is edited: it is kept, opened, changes places with it, and is let go."""

from __future__ import annotations

from pathlib import Path

import pytest

from gearcad.core.errors import GearcadError, ParameterError
from gearcad.page.workbench import BesideDesign, Workbench

GEAR = '[gear]\nname = "{name}"\nteeth = {teeth}\nnormal_module = 2.0\nface_width = 10.0\n'


@pytest.fixture
def bench(tmp_path: Path) -> Workbench:
    (tmp_path / "other.toml").write_text(GEAR.format(name="other", teeth=40), encoding="utf-8")
    return Workbench(GEAR.format(name="trial", teeth=20), "trial", tmp_path)


def teeth(design: object) -> int:
    return int(design.gears["gear"].teeth)  # type: ignore[attr-defined]


def test_the_kept_design_stays_while_the_other_changes(bench: Workbench) -> None:
    beside = BesideDesign(bench)
    assert beside.design is None
    beside.keep()
    bench.change({"gear.teeth": "25"})
    assert (teeth(beside.design), teeth(bench.design)) == (20, 25)
    beside.let_go()
    assert beside.design is None


def test_both_change_places_and_back(bench: Workbench) -> None:
    beside = BesideDesign(bench)
    beside.swap()
    assert beside.design is None
    beside.open("other.toml")
    text = bench.text
    beside.swap()
    assert (bench.design.name, teeth(bench.design), teeth(beside.design)) == ("other", 40, 20)
    assert bench.can_undo
    beside.swap()
    assert (bench.text, teeth(beside.design)) == (text, 40)


def test_what_makes_no_gear_is_not_kept(bench: Workbench) -> None:
    beside = BesideDesign(bench)
    beside.open("other.toml")
    bench.change({"gear.teeth": "2"})
    for ask in (beside.keep, beside.swap):
        with pytest.raises(GearcadError, match=r"gear\.teeth = 2: must be a whole number"):
            ask()
    assert teeth(beside.design) == 40


@pytest.mark.parametrize("file", ["../other.toml", "/etc/passwd", "none.toml", ""])
def test_only_specs_of_the_folder_are_opened(bench: Workbench, file: str) -> None:
    with pytest.raises(ParameterError):
        BesideDesign(bench).open(file)
