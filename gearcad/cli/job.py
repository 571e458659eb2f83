"""What the commands of jobs share: a spec in, progress while it lasts, files, what the screen shows, warnings."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from gearcad.cli.progress import file_progress, job_progress
from gearcad.notice import Notice, texts
from gearcad.output import require_folder

if TYPE_CHECKING:
    from gearcad.designs import Design
    from gearcad.jobs.job import Job

__all__ = ["echo_warnings", "folder_of", "json_option", "output_option", "perform", "perform_on", "quiet_option"]

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
    """Where the files of a design go."""
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

    Warnings about the design that the result does not have itself follow on stderr.
    """
    require_folder(folder_of(output, design.name))  # before a long job
    with job_progress(shown=not quiet, expected=None if quiet else job.expected(design)) as progress:
        result = job.run(design, progress)
    with file_progress(shown=not quiet and job.writes_long) as progress:
        files = job.write(result, folder_of(output, design.name), progress)
    if as_json:
        click.echo(next(file for file in files if file.name == f"{job.verb}.json").read_text(encoding="utf-8"), nl=False)
    else:
        show(design.name, result)
        click.echo("".join(f"{file}\n" for file in files), nl=False)
    if not quiet:
        told = {notice.text for notice in job.notices(result)}
        echo_warnings((notice for notice in design.notices if notice.text not in told), err=True)
    return result


def echo_warnings(notices: Iterable[Notice], *, err: bool = False) -> None:
    """What to know, a line each: among results what is about them, on stderr what is about the design."""
    colour = False if os.environ.get("NO_COLOR") else None  # None: where it is a terminal
    for text in texts(notices):
        click.secho(f"Warning: {text}", fg="yellow", err=err, color=colour)
