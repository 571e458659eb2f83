"""Progress on stderr: a bar on a terminal, plain lines elsewhere."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from gearcad.batch import Progress as RowProgress
    from gearcad.build import Progress

__all__ = ["file_progress", "row_progress"]

_SECONDS_BETWEEN_LINES = 5.0


@contextmanager
def file_progress(*, shown: bool) -> Iterator[Progress | None]:
    """A progress bar on stderr; plain lines where that is no terminal."""
    if not shown:
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda file, done, total: click.echo(f"[{done + 1}/{total}] {file}", err=True)
        return
    columns = (TextColumn("{task.description:<15}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None)
        yield lambda file, done, total: bar.update(task, description=file, completed=done, total=total)


@contextmanager
def row_progress(*, shown: bool) -> Iterator[RowProgress | None]:
    """Rows done, failed, rate and time left, as a bar on stderr; a line now and then where that is no terminal."""
    if not shown:
        yield None
        return
    from rich.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        yield _Lines()
        return
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.description:<9}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[failed]} failed"),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None, failed=0, rate="")
        phase = ""

        def show(what: str, done: int, failed: int, total: int | None) -> None:
            nonlocal phase
            if what != phase:
                bar.reset(task, total=total, completed=0)
                phase = what
            speed = bar.tasks[0].speed
            rate = f"{speed:.3g} rows/s" if speed else ""
            bar.update(task, description=what, completed=done, total=total, failed=failed, rate=rate)

        yield show


class _Lines:
    """Progress where there is no terminal: a line at the end of each phase and every few seconds."""

    def __init__(self) -> None:
        self.began = self.last = time.monotonic()
        self.phase = ""

    def __call__(self, phase: str, done: int, failed: int, total: int | None) -> None:
        now = time.monotonic()
        if phase != self.phase:
            self.phase, self.began = phase, now
        if done != total and now - self.last < _SECONDS_BETWEEN_LINES:
            return
        self.last = now
        rate = done / max(now - self.began, 1e-3)
        left = f", {(total - done) / rate:.0f} s left" if total and rate and done < total else ""
        click.echo(f"{phase}: {done}{f' of {total}' if total else ''} rows, {failed} failed, {rate:.3g} rows/s{left}", err=True)
