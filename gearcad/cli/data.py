"""The data sheet of a design: data."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import json_option
from gearcad.cli.screen import shows_styles, window_width

__all__ = ["data"]


@click.command()
@spec_argument
@json_option
@debug_option
def data(spec: Path, as_json: bool) -> None:
    """Show the geometry of SPEC: every derived quantity, and warnings."""
    from gearcad.designs.reader import read_spec
    from gearcad.jobs.data import Data
    from gearcad.output import json_text

    job = Data()
    design = job.run(read_spec(spec))
    if as_json:
        click.echo(json_text(job.document(design)), nl=False)
        return
    from gearcad.cli.datasheet import plain_datasheet, print_datasheet

    if not shows_styles(sys.stdout):
        click.echo(plain_datasheet(design, window_width()), nl=False)
        return
    from rich.console import Console

    print_datasheet(design, Console(highlight=False))
