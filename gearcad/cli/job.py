"""Base of the commands of jobs: the screen, progress on stderr, a spec in, files out."""

from __future__ import annotations

import math
import os
import re
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO, TypeVar, cast

import click

from gearcad.cli.language import say, translated
from gearcad.core.output import require_folder
from gearcad.core.records import Notice, texts
from gearcad.core.runtime import Clock, about, about_memory

if TYPE_CHECKING:
    from gearcad.core.runtime import Expected, Progress
    from gearcad.designs import Design
    from gearcad.jobs.job import Job
    from gearcad.jobs.train import MeshResults, OverMeshes


_USUAL_WIDTH = 80


def shows_styles(stream: TextIO) -> bool:
    """Return whether a stream is a terminal, or is to be treated as one."""
    return bool(os.environ.get("FORCE_COLOR")) or stream.isatty()


def window_width() -> int:
    """The characters of a line: what COLUMNS says, or those of the terminal that any standard stream is."""
    if (given := os.environ.get("COLUMNS", "")).isdigit():
        return int(given)
    for number in range(3):
        with suppress(OSError):
            return os.get_terminal_size(number).columns
    return _USUAL_WIDTH


_SECONDS_BETWEEN_LINES = 5.0

_LONG = 10.0
"""Time (s) from which the expected time of a job is shown beforehand."""

_LARGE = 1e9
"""Memory (bytes) from which the expected memory of a job is shown beforehand."""


@contextmanager
def file_progress(*, shown: bool) -> Iterator[Progress | None]:
    """A progress bar on stderr; plain lines where that is no terminal."""
    if not shown:
        yield None
        return
    if not shows_styles(sys.stderr):
        yield lambda file, done, total: say(f"[{done + 1:.0f}/{total:.0f}] {file}", err=True)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    console = Console(stderr=True)
    columns = (TextColumn("{task.description:<15}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None)
        yield lambda file, done, total: bar.update(task, description=file, completed=done, total=total)


@contextmanager
def job_progress(*, shown: bool, expected: Expected | None = None) -> Iterator[Progress | None]:
    """Show the progress of a job while the context is open; yield the function to report it, or None.

    First the expected effort is printed if the job takes long. Then percent and time left follow: a bar on a terminal,
    otherwise a line now and then.
    """
    if not shown:
        yield None
        return
    if expected is not None and (told := _effort_note(expected)):
        say(told, err=True)
    clock = Clock(expected)
    if not shows_styles(sys.stderr):
        yield _JobLines(clock)
        return
    from rich.console import Console
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn
    from rich.progress import Progress as Bar

    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TextColumn("{task.fields[left]}"))
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None, left="")
        yield lambda what, done, whole: bar.update(
            task, description=translated(what), completed=done, total=whole, left=translated(clock.left(done / whole))
        )


def _effort_note(expected: Expected) -> str:
    """Return a note on the job before it begins: what it makes, and time and memory if they are large."""
    takes = f"takes {about(expected.seconds)} and {about_memory(expected.memory)} of memory"
    return ", ".join(filter(None, (expected.makes, takes if expected.seconds >= _LONG or expected.memory >= _LARGE else "")))


class _JobLines:
    """Progress where there is no terminal: a line for each step, and every few seconds."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.last, self.step = -math.inf, ""

    def __call__(self, what: str, done: float, whole: float) -> None:
        now, step = time.monotonic(), re.sub(r"\d+", "", what)  # positions are counted within a step
        if step == self.step and now - self.last < _SECONDS_BETWEEN_LINES:
            return
        self.last, self.step = now, step
        left = self.clock.left(done / whole)
        say(f"[{math.floor(100 * done / whole):3d} %] {what}{left and f', {left}'}", err=True)


@contextmanager
def row_progress(*, shown: bool) -> Iterator[Progress | None]:
    """Rows done, failed, rate and time left, as a bar on stderr; a line now and then where that is no terminal."""
    if not shown:
        yield None
        return
    if not shows_styles(sys.stderr):
        yield _RowLines()
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    console = Console(stderr=True)
    columns = (
        TextColumn("{task.description:<9}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[detail]}"),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None, detail="", rate="")
        phase = ""

        def show(what: str, done: float, whole: float) -> None:
            nonlocal phase
            step, _, detail = what.partition(", ")
            if step != phase:
                bar.reset(task, total=whole or None, completed=0)
                phase = step
            speed = bar.tasks[0].speed
            rate = f"{speed:.3g} rows/s" if speed else ""
            bar.update(
                task,
                description=translated(step),
                completed=done,
                total=whole or None,
                detail=translated(detail),
                rate=translated(rate),
            )

        yield show


class _RowLines:
    """Progress where there is no terminal: a line at the end of each phase and every few seconds."""

    def __init__(self) -> None:
        self.began = self.last = time.monotonic()
        self.phase = ""

    def __call__(self, what: str, done: float, whole: float) -> None:
        now, (phase, _, detail) = time.monotonic(), what.partition(", ")
        if phase != self.phase:
            self.phase, self.began = phase, now
        if done != whole and now - self.last < _SECONDS_BETWEEN_LINES:
            return
        self.last = now
        rate = done / max(now - self.began, 1e-3)
        left = f", {(whole - done) / rate:.0f} s left" if rate and done < whole else ""
        say(f"{phase}: {done}{f' of {whole}' if whole else ''} rows, {detail}, {rate:.3g} rows/s{left}", err=True)


Command = TypeVar("Command", bound=Callable[..., Any])
Result = TypeVar("Result")


def output_option(command: Command) -> Command:
    return click.option(
        "-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder.  [default: output/NAME]"
    )(command)


def json_option(command: Command) -> Command:
    words = f"Print the document of {command.__name__}.json and nothing else."
    return click.option("--json", "as_json", is_flag=True, help=words)(command)


def quiet_option(command: Command) -> Command:
    return click.option("--quiet", is_flag=True, help="No progress and no warnings of the design on the screen.")(command)


def folder_of(output: Path | None, name: str) -> Path:
    """Return the folder for the files of a design: `output`, otherwise output/NAME."""
    return output if output is not None else Path("output") / name


def perform(
    job: Job[Any, Result], spec: Path, output: Path | None, show: Callable[[str, Result], None], *, as_json: bool, quiet: bool
) -> Result:
    """Do a job on the design of a spec as `perform_on` does."""
    from gearcad.designs.reader import read_spec

    return perform_on(job, read_spec(spec), output, show, as_json=as_json, quiet=quiet)


def perform_on(
    job: Job[Any, Result],
    design: Design,
    output: Path | None,
    show: Callable[[str, Result], None],
    *,
    as_json: bool,
    quiet: bool,
) -> Result:
    """Do a job on a design, write its files, and print its document, or what `show` prints and the files.

    Warnings about the design that the result does not have itself follow on stderr. Of a train a job of pairs is done with each
    mesh.
    """
    if design.kind.value == "train":
        job, show = _of_train(job, design, show)
    require_folder(folder_of(output, design.name))  # before a long job
    job, missing = job.without_missing()
    with job_progress(shown=not quiet, expected=None if quiet else job.expected(design)) as progress:
        result = job.run(design, progress)
    with file_progress(shown=not quiet and job.writes_long) as progress:
        files = job.headed(design).write(result, folder_of(output, design.name), progress)
    if as_json:
        click.echo(next(file for file in files if file.name == f"{job.verb}.json").read_text(encoding="utf-8"), nl=False)
    else:
        show(design.name, result)
        click.echo("".join(f"{file}\n" for file in files), nl=False)
    if missing:
        say(f"{job.verb}.html is left out: the package {missing} is not installed: pip install {missing}", err=True)
    if not quiet:
        told = {notice.text for notice in job.notices(result)}
        echo_warnings((notice for notice in job.design_notices(design) if notice.text not in told), err=True)
    return result


def _of_train(
    job: Job[Any, Result], design: Design, show: Callable[[str, Result], None]
) -> tuple[Job[Any, Result], Callable[[str, Result], None]]:
    """Return the job for a train and what shows its result; a job of pairs is done with each mesh of a train of pairs."""
    from gearcad.jobs.train import OverMeshes
    from gearcad.jobs.train_sheets import job_for

    found = job_for(job, design)
    return found, cast("Callable[[str, Result], None]", partial(_show_meshes, found)) if isinstance(found, OverMeshes) else show


def _show_meshes(job: OverMeshes, name: str, result: MeshResults) -> None:
    """Print a line for each mesh of a train, then the notices and the verdict of the train."""
    say("\n".join(mesh_lines(result)))
    echo_warnings(result.notices)
    if line := job.conclusion(name, result):
        colour = "red" if result.falls_short else "green" if result.passed else "yellow"
        say(line, fg=None if os.environ.get("NO_COLOR") else colour, bold=True)


def mesh_lines(result: MeshResults) -> Iterator[str]:
    """Yield a line for each mesh of a train: its load, least safeties where there are any, and its verdict."""
    safeties = [(name, words) for name, words in _SAFETIES.items() if any(name in each.figures for each in result.meshes)]
    rows = [["mesh", "N·m", "rpm", *(words for _, words in safeties), "verdict", "folder"]]
    for each in result.meshes:
        load, told = each.mesh.load, each.strength.value if each.strength is not None else _PASSED[each.passed]
        told = _PASSED[False] if each.passed is False else told
        numbers = [each.figures.get(name) for name, _ in safeties]
        cells = ["-" if value is None else f"{value:.4g}" for value in numbers]
        rows.append([each.mesh.name, f"{load['torque']:.6g}", f"{load['speed']:.6g}", *cells, told, each.mesh.folder])
    rows += [[name, *("-" for _ in rows[0][2:-1]), "not judged", "-"] for name in result.without]
    yield from aligned_columns(rows, left=(0, len(rows[0]) - 2, len(rows[0]) - 1))


_SAFETIES = {"S_H_min": "S_H", "S_F_min": "S_F"}
_PASSED = {True: "passed", False: "failed", None: "-"}


def echo_warnings(notices: Iterable[Notice], *, err: bool = False) -> None:
    """Print the notices as warnings, a line each: among results those about results, on stderr those about the design."""
    colour = False if os.environ.get("NO_COLOR") else None  # None: where it is a terminal
    for text in texts(notices):
        say(f"Warning: {text}", fg="yellow", err=err, color=colour)


def aligned_columns(rows: Sequence[Sequence[str]], left: Sequence[int]) -> Iterator[str]:
    """Yield rows as lines whose columns are as wide as their contents; those whose numbers are in `left` begin at the left."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (
            f"{cell:<{width}}" if number in left else f"{cell:>{width}}"
            for number, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        yield "  ".join(cells).rstrip()
