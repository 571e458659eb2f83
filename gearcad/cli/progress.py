"""Progress on stderr: a bar on a terminal, plain lines elsewhere."""

from __future__ import annotations

import math
import re
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

from gearcad.cli.screen import shows_styles
from gearcad.progress import Clock, about, about_memory

if TYPE_CHECKING:
    from gearcad.progress import Expected, Progress

__all__ = ["file_progress", "job_progress", "row_progress"]

_SECONDS_BETWEEN_LINES = 5.0

_LONG = 10.0
"""Seconds from which on it is worth telling beforehand what a job takes."""

_LARGE = 1e9
"""Bytes of memory from which on it is."""


@contextmanager
def file_progress(*, shown: bool) -> Iterator[Progress | None]:
    """A progress bar on stderr; plain lines where that is no terminal."""
    if not shown:
        yield None
        return
    if not shows_styles(sys.stderr):
        yield lambda file, done, total: click.echo(f"[{done + 1:.0f}/{total:.0f}] {file}", err=True)
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
    """What a job takes, if that is long, then percent and time left: a bar on a terminal, a line now and then elsewhere."""
    if not shown:
        yield None
        return
    if expected is not None and (told := _told(expected)):
        click.echo(told, err=True)
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
            task, description=what, completed=done, total=whole, left=clock.left(done / whole)
        )


def _told(expected: Expected) -> str:
    """What is worth telling before a job begins."""
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
        click.echo(f"[{math.floor(100 * done / whole):3d} %] {what}{left and f', {left}'}", err=True)


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
            bar.update(task, description=step, completed=done, total=whole or None, detail=detail, rate=rate)

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
        click.echo(f"{phase}: {done}{f' of {whole}' if whole else ''} rows, {detail}, {rate:.3g} rows/s{left}", err=True)
