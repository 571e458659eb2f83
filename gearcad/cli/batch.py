"""The command on a design table: batch."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.build import files_options, format_option
from gearcad.cli.group import debug_option, job_commands, parse_choices
from gearcad.cli.progress import row_progress
from gearcad.errors import ParameterError, as_choice
from gearcad.jobs import job_of
from gearcad.solids import FileOptions, Format
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.batch import Summary

__all__ = ["batch"]


@click.command(short_help="Make every row of a design table, in parallel.")
@click.argument("table", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder.  [default: output/TABLE]")
@click.option("-j", "--jobs", type=int, metavar="N", help="Processes at work.  [default: the cores]")
@click.option("--do", "steps", default="build", show_default=True, help=f"Comma-separated list of {', '.join(job_commands())}.")
@format_option
@files_options
@click.option("--time-limit", default=600.0, show_default=True, metavar="S", help="Longest time for one row, in seconds.")
@click.option("--fresh", is_flag=True, help="Make everything again, also what is there and unchanged.")
@click.option("--keep-going", is_flag=True, help="Make the good rows of a table that has faults.")
@click.option(
    "--decimal", default="point", show_default=True, help="Of results.csv: point, or comma (and semicolons) for Excel."
)
@click.option("--cluster", metavar="ADDRESS", help="Work on a Dask cluster: tcp://HOST:PORT, or local.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document: the results and the failures.")
@click.option("--quiet", is_flag=True, help="No progress on the screen.")
@debug_option
def batch(
    table: Path,
    output: Path | None,
    jobs: int | None,
    steps: str,
    formats: str,
    options: FileOptions,
    time_limit: float,
    fresh: bool,
    keep_going: bool,
    decimal: str,
    cluster: str | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Make every row of TABLE (CSV or xlsx) in a folder of its own, and results.csv with all derived numbers.

    columns.csv beside it has symbol and unit of each number.
    All rows are checked before anything is made. Run it again after a change, a crash or a Ctrl-C: it makes only what is
    missing or changed. `gearcad new pairs` writes a commented table to begin with.
    """
    from gearcad.batch import Decimal, InterruptedRunError, run_table
    from gearcad.jobs.build import Build

    build = Build(formats=parse_choices("format", formats, Format), options=options)
    wanted = [build if verb == build.verb else job_of(verb)() for verb in _verbs(steps)]
    chosen = as_choice("decimal", decimal.lower(), Decimal)
    folder = output if output is not None else Path("output") / table.stem
    began = time.perf_counter()
    try:
        with row_progress(shown=not quiet) as progress:
            summary = run_table(
                table,
                folder,
                wanted,
                jobs=jobs,
                cluster=cluster,
                time_limit=time_limit,
                fresh=fresh,
                keep_going=keep_going,
                decimal=chosen,
                progress=progress,
            )
    except InterruptedRunError as error:
        if not quiet:
            click.echo(f"{_counts(error.summary)}; the same command makes the rest", err=True)
        raise
    _report(summary, time.perf_counter() - began, as_json=as_json, quiet=quiet)
    if summary.failed or summary.not_run or summary.short or summary.stopped:
        click.get_current_context().exit(1)


def _verbs(text: str) -> list[str]:
    """The jobs of a comma-separated list, each once; raises ParameterError."""
    found = [name.strip().lower() for name in text.split(",")]
    for verb in found:
        if verb not in job_commands():
            raise ParameterError("do", verb, f"must be one of {', '.join(map(repr, job_commands()))}")
    return list(dict.fromkeys(found))


def _report(summary: Summary, seconds: float, *, as_json: bool, quiet: bool) -> None:
    from gearcad.output import json_text

    results = [str(path) for path in summary.results]
    if as_json:
        counts = {"ok": summary.ok, "failed": summary.failed, "not_run": summary.not_run, "short": summary.short}
        document = {
            "kind": "batch",
            "gearcad": __version__,
            "results": results,
            **counts,
            "errors": list(summary.errors),
        }
        click.echo(json_text(document), nl=False)
    else:
        click.echo("".join(f"{path}\n" for path in results), nl=False)
    for line in (*summary.errors, *filter(None, [summary.stopped])):
        click.echo(f"Error: {line}", err=True)
    if not quiet:
        rate = (summary.ok + summary.failed) / seconds
        click.echo(f"{_counts(summary)} in {seconds:.1f} s ({rate:.3g} rows/s)", err=True)


def _counts(summary: Summary) -> str:
    rest = f", {summary.not_run} not run" if summary.not_run else ""
    rest += f", {summary.short} with checks or ratings not passed" if summary.short else ""
    return f"{summary.ok} rows ok, {summary.failed} failed{rest}"
