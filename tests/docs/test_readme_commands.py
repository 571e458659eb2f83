"""Commands of the README and of the overview end well, section by section; the README's Python runs from top to bottom."""

import re
import shlex
from pathlib import Path
from typing import Any

import pytest
from click import Context
from manual.blocks import blocks_of
from manual.running import environment, run_command

from gearcad.cli import main
from gearcad.designs.reader import starter_text, starters

ROOT = Path(__file__).parents[2]


README = (ROOT / "README.md").read_text(encoding="utf-8")
OVERVIEW = (ROOT / "docs" / "overview.md").read_text(encoding="utf-8")
SECTIONS = {
    section.partition("\n")[0]: section
    for page in (README, OVERVIEW)
    for section in re.split(r"^## ", page, flags=re.MULTILINE)[1:]
}
FALLS_SHORT = ("check", "mesh", "rate")
"""Commands whose exit status 1 is their verdict."""


def _lines(section: str) -> list[str]:
    shown = (block.text for block in blocks_of(section) if block.language == "sh")
    return [re.sub(r"\s+# .*", "", line) for text in shown for line in text.splitlines() if line.startswith("gearcad ")]


def _commands() -> list[list[str]]:
    lines = (line for section in SECTIONS.values() for line in _lines(section))
    return [shlex.split(each)[1:] for line in lines for each in line.split(" && ")]


def _write_missing(line: str, folder: Path) -> None:
    """Starters that a line has from an earlier section; one that begins with `gearcad new` makes its own."""
    for name in {starter_text(each)[0] for each in starters()} & set(line.split()):
        if not (folder / name).exists():
            (folder / name).write_text(starter_text(name.partition(".")[0])[1], encoding="utf-8")


@pytest.mark.parametrize("command", _commands(), ids=" ".join)
def test_command_and_its_options_exist(command: list[str]) -> None:
    found = main.get_command(Context(main), command[0])
    assert found is not None
    options = {name for parameter in found.params for name in parameter.opts}
    assert {word for word in command[1:] if re.match(r"--?[a-z]", word)} <= options


@pytest.mark.long
@pytest.mark.parametrize("title", [title for title, section in SECTIONS.items() if _lines(section)])
def test_commands_of_a_section_end_well(title: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with environment():
        for line in _lines(SECTIONS[title]):
            if "gearcad open" in line:
                continue
            if "gearcad new" not in line:
                _write_missing(line, tmp_path)
            status, came = run_command(line)
            falls_short = status == 1 and shlex.split(line)[1] in FALLS_SHORT and "Error:" not in came
            assert status == 0 or falls_short, f"{line} ends with {status}:\n{came}"


@pytest.mark.long
def test_python_runs_from_top_to_bottom(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for block in blocks_of(README):
        if block.language == "python":
            _write_missing(re.sub(r"[^\w.-]", " ", block.text), tmp_path)
            exec(compile("\n" * (block.line - 1) + block.text, "README.md", "exec"), names)
    assert names
