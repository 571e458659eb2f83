"""Every command has its page in the manual, with an example that runs it, what its help says, and the files that it writes."""

from __future__ import annotations

import re
import sys
from fnmatch import fnmatch
from pathlib import Path

import pytest
from click import Context

from gearcad.cli import main

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS))

from manual.blocks import blocks_of, commands_of  # noqa: E402

COMMANDS = main.list_commands(Context(main))
SHOWN_ONLY = ("open",)
"""What lasts until Ctrl-C."""


def _page(command: str) -> str:
    return (DOCS / "commands" / f"{command}.md").read_text(encoding="utf-8")


def test_pages_are_those_of_the_commands_in_their_order() -> None:
    index = (DOCS / "commands" / "index.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```{toctree}\n:maxdepth: 1\n\n(.*?)\n```", index, re.DOTALL)
    assert block.split() == COMMANDS


@pytest.mark.parametrize("command", COMMANDS)
def test_page_has_help_options_and_an_example(command: str) -> None:
    page = _page(command)
    assert page.count(f"```{{command}} {command}\n") == page.count(f"```{{options}} {command}\n") == 1
    run = [each.text for block in blocks_of(page) if block.language == "console" for each in commands_of(block)]
    assert command in SHOWN_ONLY or any(text.startswith(f"gearcad {command}") for text in run)


@pytest.mark.parametrize("command", [each for each in COMMANDS if each not in ("new", "data", "completion", *SHOWN_ONLY)])
def test_page_names_every_file_that_its_example_writes(command: str) -> None:
    """What the example prints at its end, as `test_manual.py` finds it."""
    page = _page(command)
    files = page.partition("## Files")[2].partition("## Options")[0]
    named = [name for row in re.findall(r"^\| ([^|]*) \|", files, re.MULTILINE) for name in re.findall(r"`([^`]+)`", row)]
    commands = [each for block in blocks_of(page) if block.language == "console" for each in commands_of(block)]
    shown = [each.shown for each in commands if each.text.startswith(f"gearcad {command}")]
    written = [line.strip() for text in shown for line in text.splitlines() if re.fullmatch(r"\S+\.\w+", line.strip())]
    starters = {path.name for path in (DOCS.parent / "templates").iterdir()}
    for path in written:
        if path not in starters:
            assert any(fnmatch(path.rpartition("/")[2], name) or fnmatch(path, f"*/{name}") for name in named), path
    assert written
