"""The commands of a parameter study: study, which writes a design table, and plot, which draws what batch made of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, require_new_file, spec_argument
from gearcad.errors import ParameterError, as_choice

if TYPE_CHECKING:
    from gearcad.batch.study import Sample

__all__ = ["plot", "study"]

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
    _echo_prospects(path, planned.rows)


def _sample(method: str | None, rows: int | None, seed: int | None) -> Sample | None:
    """What --sample, --n and --seed say together."""
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
        click.echo("Note: Sobol points are spread most evenly if --n is a power of 2, such as 128 or 256", err=True)
    return Sample(method=chosen, rows=rows, seed=seed or 0)


def _echo_prospects(path: Path, rows: int) -> None:
    """Say how many rows make no gear, if they are few enough to try, and how to go on."""
    from gearcad.batch.study import check_table

    faulty, first = check_table(path) if rows <= MOST_CHECKED else (0, "")
    if faulty:
        click.echo(f"{faulty} of {rows} rows make no gear. The first: {first}", err=True)
    keep_going = " --keep-going    # builds the others" if 0 < faulty < rows else ""
    if faulty < rows:
        click.echo(f"Next: gearcad batch {path}{keep_going}", err=True)


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
    path = output if output is not None else results.with_name(f"{results.stem}-{points.y.key}-{points.x.key}.png")
    save_plot(plot_scatter if contour is None else plot_contours, points, path)
    click.echo(path)
    if points.omitted:
        click.echo(f"{points.omitted} rows are left out: not ok, or without one of these values", err=True)
