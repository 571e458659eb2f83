"""The data sheet of a design: data."""

from __future__ import annotations

from pathlib import Path

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import json_option

__all__ = ["data"]


@click.command()
@spec_argument
@json_option
@debug_option
def data(spec: Path, as_json: bool) -> None:
    """Show the geometry of SPEC: every derived quantity, and warnings."""
    from gearcad.designs import read_spec
    from gearcad.jobs.data import Data
    from gearcad.output import json_text

    job = Data()
    design = job.run(read_spec(spec))
    if as_json:
        click.echo(json_text(job.document(design)), nl=False)
        return
    from rich.console import Console

    from gearcad.cli.datasheet import print_datasheet

    print_datasheet(design, Console(highlight=False))
