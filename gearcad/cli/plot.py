"""Pictures of what batch has made: plot."""

from __future__ import annotations

from pathlib import Path

import click

from gearcad.cli.group import debug_option

__all__ = ["plot"]

_LONGEST = 60
"""Characters of a key in the name of a file."""


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
        click.echo(f"{points.omitted} rows are left out: not ok, or without one of these values", err=True)


def _plain(key: str) -> str:
    """A key as a part of a file's name: the parts of trains have names of any kind, or are meant all together."""
    return "".join(sign if sign.isalnum() or sign in "._-" else "-" for sign in key.replace(".*.", "."))[:_LONGEST]
