"""Runs what a page shows, in a folder of its own, and tells where the page shows something else than what came out."""

from __future__ import annotations

import contextlib
import doctest
import io
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from click.testing import CliRunner

from gearcad.cli import main
from manual.blocks import Block, Command, blocks_of, commands_of

__all__ = ["Fault", "environment", "run_command", "run_page"]

_FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
_WIDTH = "100"
"""Columns of the screen that pages show."""


_PROGRESS = re.compile(r"^\[ *\d+(?: %|/\d+)\].*\n", re.MULTILINE)
"""Lines that tell how far a job is: no two runs have the same, and pages leave them out."""


@dataclass(frozen=True)
class Fault:
    """Where a page is wrong: the line, what it shows and what came out, or what went wrong."""

    line: int
    what: str
    shown: str = ""
    came: str = ""

    def __str__(self) -> str:
        return f"line {self.line}: {self.what}" + (f"\nshown:\n{self.shown}came out:\n{self.came}" if self.came else "")


def run_page(page: Path, folder: Path) -> Iterator[Fault]:
    """Run the `console` and `python` blocks of a page, with the files that it shows."""
    names: dict[str, Any] = {"__name__": "__main__"}
    with contextlib.chdir(folder), environment():
        for block in blocks_of(page.read_text(encoding="utf-8")):
            if block.file is not None:
                Path(block.file).write_text(block.text, encoding="utf-8")
            elif block.language == "console":
                yield from _run_commands(commands_of(block))
            elif block.language == "python":
                yield from _run_python(block, names)


@contextlib.contextmanager
def environment() -> Iterator[None]:
    """The screen that pages show, and our commands within reach of the shell."""
    kept = dict(os.environ)
    os.environ |= {
        "COLUMNS": _WIDTH,
        "NO_COLOR": "1",
        "PATH": os.pathsep.join((str(Path(sys.executable).parent), kept["PATH"])),
    }
    try:
        yield
    finally:
        os.environ.clear()
        os.environ |= kept


def _run_commands(commands: list[Command]) -> Iterator[Fault]:
    """Each command must end well, unless the page shows by `echo $?` how it ends."""
    status = 0
    for command, following in zip(commands, [*commands[1:], None], strict=True):
        if command.text == "echo $?":
            came = f"{status}\n"
        else:
            status, came = run_command(command.text)
            if status and (following is None or following.text != "echo $?"):
                yield Fault(command.line, f"{command.text} ends with {status}", command.shown, came)
                continue
        if command.shown and not doctest.OutputChecker().check_output(
            _stripped(command.shown), _stripped(came), doctest.ELLIPSIS
        ):
            yield Fault(command.line, f"{command.text} shows something else", command.shown, came)


def run_command(command: str) -> tuple[int, str]:
    """Exit status and all output; commands of ours within this process, what else there is by the shell."""
    plain = re.sub(r"\s+# .*", "", command)
    if plain.startswith("gearcad ") and not re.search(r"[|<>;&$*]", re.sub(r"\"[^\"]*\"|'[^']*'", "", plain)):
        result = CliRunner().invoke(main, shlex.split(plain)[1:], prog_name="gearcad")
        return result.exit_code, _PROGRESS.sub("", result.output)
    done = subprocess.run(command, shell=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    return done.returncode, done.stdout


def _stripped(text: str) -> str:
    return "\n".join(line.rstrip() for line in text.rstrip().splitlines()) + "\n"


def _run_python(block: Block, names: dict[str, Any]) -> Iterator[Fault]:
    """A block with prompts as doctest does it, another as a script; all of a page share their names."""
    if not block.text.lstrip().startswith(">>>"):
        exec(compile("\n" * (block.line - 1) + block.text, "page", "exec"), names)
        return
    test = doctest.DocTestParser().get_doctest(block.text, {}, "page", None, block.line - 1)
    test.globs = names
    told = io.StringIO()
    runner = doctest.DocTestRunner(optionflags=_FLAGS, verbose=False)
    if runner.run(test, out=told.write, clear_globs=False).failed:
        yield Fault(block.line, told.getvalue())
