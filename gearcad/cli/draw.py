"""Sheets for the workshop: draw."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, parse_choices, spec_argument
from gearcad.cli.job import echo_warnings, json_option, output_option, perform, quiet_option

if TYPE_CHECKING:
    from gearcad.drawing.sheets import Drawing

__all__ = ["draw"]


@click.command(short_help="Draw SPEC's gears and what they make, with gear data: DXF, SVG, PDF.")
@spec_argument
@click.option("--sheet", metavar="A3", help="A4 to A0, or auto: the smallest that has room.  [default: auto]")
@click.option("--scale", metavar="1:2", help="One of ISO 5455, or auto: the largest for which there is room.  [default: auto]")
@click.option("--language", metavar="en", help="en, de or sv.  [default: en]")
@click.option("--projection", metavar="first", help="first or third angle.  [default: first]")
@click.option("--format", "formats", default="dxf,svg,pdf", show_default=True, help="Comma-separated list of dxf, svg, pdf.")
@output_option
@json_option
@quiet_option
@debug_option
def draw(
    spec: Path,
    sheet: str | None,
    scale: str | None,
    language: str | None,
    projection: str | None,
    formats: str,
    output: Path | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Draw SPEC for the workshop: a sheet of each gear with its dimensions and gear data, one of the pair or train they make.

    [drawing] in SPEC fills the title block, and has what dimensions are toleranced with; a gear may have its own, such as
    [pinion.drawing]. These options win over it.

    Writes drawing.dxf, drawing.svg and drawing.pdf of a gear, drawing-pinion.dxf and so on of a pair, whose drawing.pdf has all
    sheets, and draw.json with every number on them.
    """
    from gearcad.jobs.draw import Draw, SheetFormat

    asked = {
        "sheet": sheet and (sheet.lower() if sheet.lower() == "auto" else sheet.upper()),
        "scale": scale and scale.lower(),
        "language": language and language.lower(),
        "projection": projection and projection.lower(),
    }
    given = {name: value for name, value in asked.items() if value is not None}
    job = Draw(formats=parse_choices("format", formats, SheetFormat), given=given)
    perform(job, spec, output, partial(_show, quiet=quiet), as_json=as_json, quiet=quiet)


def _show(_name: str, drawing: Drawing, *, quiet: bool) -> None:
    """Print the sheets, a line each, then the warnings about them unless `quiet`."""
    from gearcad.jobs.draw import paper_of, scale_of

    width = max(len(sheet.name) for sheet in drawing.sheets)
    for sheet in drawing.sheets:
        click.echo(f"{sheet.name:<{width}}  {paper_of(sheet):<3} {scale_of(sheet):>6}  {sheet.title}")
    if not quiet:
        echo_warnings(drawing.notices)
