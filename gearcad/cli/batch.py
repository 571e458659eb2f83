"""Commands `batch`, `study` and `plot`."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gearcad.cli.build import files_options, format_option
from gearcad.cli.group import debug_option, job_commands, parse_choices, require_new_file, spec_argument
from gearcad.cli.job import row_progress
from gearcad.cli.language import say
from gearcad.core.errors import ParameterError, as_choice
from gearcad.jobs import job_of
from gearcad.solids import FileOptions, Format
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.batch import BatchSummary
    from gearcad.batch.study import Sample, Study
    from gearcad.jobs.job import Job


@click.command(short_help="Make every row of a design table, in parallel.")
@click.argument("table", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder.  [default: output/TABLE]")
@click.option("-j", "--jobs", type=int, metavar="N", help="Processes at work.  [default: the cores]")
@click.option("--do", "steps", default="build", show_default=True, help=f"Comma-separated list of {', '.join(job_commands())}.")
@format_option
@files_options
@click.option("--no-report", is_flag=True, help="Leave out the reports (HTML), which take time and 0.1 to 3 MB a row.")
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
    no_report: bool,
    time_limit: float,
    fresh: bool,
    keep_going: bool,
    decimal: str,
    cluster: str | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Make every row of TABLE (CSV or xlsx) in a folder of its own, and results.csv with all derived numbers.

    columns.csv beside it has symbol and unit of each number. check, rate, stiffness, dynamics and planetary write their reports
    into the folder of each row.
    All rows are checked before anything is made. Run it again after a change, a crash or a Ctrl-C: it makes only what is
    missing or changed. `gearcad new pairs` writes a commented table to begin with.
    """
    from gearcad.batch import Decimal, InterruptedRunError, run_table
    from gearcad.jobs.build import Build

    build = Build(formats=parse_choices("format", formats, Format), options=options)
    wanted = [build if verb == build.verb else _job(verb, report=not no_report) for verb in _verbs(steps)]
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
            say(f"{_counts(error.summary)}; the same command makes the rest", err=True)
        raise
    report_summary(summary, time.perf_counter() - began, as_json=as_json, quiet=quiet)
    if not summary.passed:
        click.get_current_context().exit(1)


def _job(verb: str, *, report: bool) -> Job[Any, Any]:
    """Return the job of a verb with its usual options, with or without a report where it has one."""
    from gearcad.jobs.job import ReportedJob

    found = job_of(verb)
    return found(report=report) if issubclass(found, ReportedJob) else found()


def _verbs(text: str) -> list[str]:
    """The jobs of a comma-separated list, each once; raises ParameterError."""
    found = [name.strip().lower() for name in text.split(",")]
    for verb in found:
        if verb not in job_commands():
            raise ParameterError("do", verb, f"must be one of {', '.join(map(repr, job_commands()))}")
    return list(dict.fromkeys(found))


def report_summary(summary: BatchSummary, seconds: float, *, as_json: bool, quiet: bool) -> None:
    from gearcad.core.output import json_text
    from gearcad.jobs.job import with_summary

    results = [str(path) for path in summary.results]
    if as_json:
        counts = {"ok": summary.ok, "failed": summary.failed, "not_run": summary.not_run, "short": summary.short}
        document = {
            "kind": "batch",
            "gearcad": __version__,
            "results": results,
            **counts,
            "errors": list(summary.errors),
            "passed": summary.passed,
        }
        click.echo(json_text(with_summary(document)), nl=False)
    else:
        click.echo("".join(f"{path}\n" for path in results), nl=False)
    for line in (*summary.errors, *filter(None, [summary.stopped])):
        say(f"Error: {line}", err=True)
    if not quiet:
        rate = (summary.ok + summary.failed) / seconds
        say(f"{_counts(summary)} in {seconds:.1f} s ({rate:.3g} rows/s)", err=True)


def _counts(summary: BatchSummary) -> str:
    rest = f", {summary.not_run} not run" if summary.not_run else ""
    rest += f", {summary.short} with checks or ratings not passed" if summary.short else ""
    return f"{summary.ok} rows ok, {summary.failed} failed{rest}"


MOST_CHECKED = 2000
"""Rows of the largest table that is tried at once, about 1 ms for each; batch tries all rows before it begins."""


@click.command(short_help="Write a design table of SPEC with some keys varied.")
@spec_argument
@click.option("--vary", "variations", multiple=True, metavar="KEY=VALUES", help="Repeat it for every key that varies.")
@click.option("--sample", metavar="METHOD", help="Draw the rows: lhs (Latin hypercube) or sobol.  [default: all combinations]")
@click.option("--n", "rows", type=int, metavar="N", help="How many rows to draw.")
@click.option("--seed", type=int, metavar="N", help="Another seed draws other rows.  [default: 0]")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="The table.  [default: NAME-study.csv here]"
)
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@debug_option
def study(
    spec: Path,
    variations: tuple[str, ...],
    sample: str | None,
    rows: int | None,
    seed: int | None,
    output: Path | None,
    force: bool,
) -> None:
    """Write a design table: SPEC with some of its keys varied, a row for every combination.

    \b
    --vary helix_angle=10,20,28             these values
    --vary pinion.profile_shift=-0.2:0.6:9  from -0.2 to 0.6 in 9 values
    --vary wheel.profile_shift=auto         one value for all rows
    --vary "shaft.*.damping_ratio=0.01,0.1" of all shafts of a train, in place of what each has
    --vary "mesh.stage 1.stiffness=500,750" of the mesh of this name
    With --sample the rows are drawn instead, and a range has no count:
    --vary pinion.profile_shift=-0.2:0.6 --sample lhs --n 200
    """
    from gearcad.batch.study import plan_study, write_study

    planned = plan_study(spec, variations, _sample(sample, rows, seed))
    path = output if output is not None else Path(f"{planned.name}-study.csv")
    require_new_file(path, force)
    if path.suffix.lower() != ".csv":
        raise ParameterError("output", str(path), "must end in .csv")
    write_study(planned, path)
    click.echo(path)
    _echo_prospects(planned, path)


def _sample(method: str | None, rows: int | None, seed: int | None) -> Sample | None:
    """Return the sample that --sample, --n and --seed describe, or None for every combination. Raises ParameterError."""
    from gearcad.batch.study import Method, Sample

    if method is None:
        for option, value in (("n", rows), ("seed", seed)):
            if value is not None:
                raise ParameterError(option, value, "needs --sample lhs or --sample sobol; else every combination is a row")
        return None
    chosen = as_choice("sample", method.lower(), Method)
    if rows is None:
        raise ParameterError("sample", method, "needs --n, how many rows to draw")
    if chosen is Method.SOBOL and rows > 0 and rows & (rows - 1):
        say("Note: Sobol points are spread most evenly if --n is a power of 2, such as 128 or 256", err=True)
    return Sample(method=chosen, rows=rows, seed=seed or 0)


def _echo_prospects(planned: Study, path: Path) -> None:
    """Say how many rows make no gear, if they are few enough to try, and how to go on."""
    from gearcad.batch.study import check_table
    from gearcad.designs.keys import DesignKind

    rows, of_train = planned.rows, planned.kind is DesignKind.TRAIN
    faulty, first = check_table(path) if rows <= MOST_CHECKED else (0, "")
    if faulty:
        say(f"{faulty} of {rows} rows make no {'train' if of_train else 'gear'}. The first: {first}", err=True)
    keep_going = f" --keep-going    # {'does' if of_train else 'builds'} the others" if 0 < faulty < rows else ""
    if faulty < rows:
        say(f"Next: {planned.next_command(path)}{keep_going}", err=True)


_LONGEST = 60
"""Largest number of characters of a key in a file name."""


@click.command(short_help="Draw columns of results.csv over each other.")
@click.argument("results", type=click.Path(path_type=Path))
@click.option("--x", required=True, metavar="KEY", help="Column along the x axis.")
@click.option("--y", required=True, metavar="KEY", help="Column along the y axis.")
@click.option("--colour", "--color", metavar="KEY", help="Column that colours the points.")
@click.option("--contour", metavar="KEY", help="Column whose contours to draw over x and y.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="A .png, .svg or .pdf.  [default: a .png beside RESULTS]",
)
@debug_option
def plot(results: Path, x: str, y: str, colour: str | None, contour: str | None, output: Path | None) -> None:
    """Draw one column of RESULTS, the results.csv of a batch, over another.

    KEY is the heading of a column, such as pinion.profile_shift; its beginning may be left out where no other column ends
    alike, such as transverse_contact_ratio.
    """
    from gearcad.plots import plot_contours, plot_scatter, require_picture, save_plot
    from gearcad.plots.table_data import read_points

    if output is not None:
        require_picture(output)
    points = read_points(results, x, y, colour=colour, contour=contour)
    path = (
        output if output is not None else results.with_name(f"{results.stem}-{_plain(points.y.key)}-{_plain(points.x.key)}.png")
    )
    save_plot(plot_scatter if contour is None else plot_contours, points, path)
    click.echo(path)
    if points.omitted:
        say(f"{points.omitted} rows are left out: not ok, or without one of these values", err=True)


def _plain(key: str) -> str:
    """A key as a part of a file's name: the parts of trains have names of any kind, or are meant all together."""
    return "".join(sign if sign.isalnum() or sign in "._-" else "-" for sign in key.replace(".*.", "."))[:_LONGEST]
