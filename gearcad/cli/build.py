"""The files of a design: build."""

from __future__ import annotations

from dataclasses import fields
from functools import wraps
from pathlib import Path
from typing import Any, cast

import click

from gearcad.cli.group import debug_option, parse_choices, spec_argument
from gearcad.cli.job import Command, echo_warnings, folder_of, output_option
from gearcad.cli.progress import file_progress
from gearcad.solids import FileOptions, Format

__all__ = ["build", "files_options", "format_option"]

_HELP = """Write the solids of SPEC: pinion.step, wheel.stl, assembly.step ... and data.json.

\b
""" + "\n".join(f"{kind.value:<6}{kind.entry.words}" for kind in Format)


def format_option(command: Command) -> Command:
    offered = ", ".join(kind.value for kind in Format)
    help_text = f"Comma-separated list of {offered}."
    return click.option("--format", "formats", default="step,stl", show_default=True, help=help_text)(command)


def files_options(command: Command) -> Command:
    """The options of files, which the command gets as `options`, a FileOptions."""
    names = [each.name for each in fields(FileOptions)]

    @wraps(command)
    def with_options(*arguments: Any, **given: Any) -> Any:
        return command(*arguments, options=FileOptions(**{name: given.pop(name) for name in names}), **given)

    for option in reversed(_OPTIONS):
        with_options = option(with_options)
    return cast("Command", with_options)


_TURNING = """Let the assembly turn, as an animation (trains, GLB): with the senses of the speeds that are given, clockwise
where they are negative. It lasts one turn of the carrier, or as many as bring all teeth round if none turns over 60 times."""

_OPTIONS = (
    click.option("--chord-error", default=0.005, show_default=True, metavar="MM", help="Largest error of the facets, in mm."),
    click.option("--bracket", is_flag=True, help="Put the assembly on two shafts with a bracket (STEP)."),
    click.option(
        "--circles", is_flag=True, help="Draw the tip, reference, base and root circles too, of a rack the lines (DXF)."
    ),
    click.option("--carrier", is_flag=True, help="Make a carrier too: plates, and pins in the planets' bores (trains)."),
    click.option("--exploded", is_flag=True, help="Move the members of the assembly apart along the axis (trains)."),
    click.option("--turning", is_flag=True, help=_TURNING),
)


@click.command(short_help="Write the solids of SPEC as STEP, STL and other files.", help=_HELP)
@spec_argument
@output_option
@format_option
@files_options
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document: the files and the warnings.")
@click.option("--quiet", is_flag=True, help="No progress and no warnings on the screen.")
@debug_option
def build(spec: Path, output: Path | None, formats: str, options: FileOptions, as_json: bool, quiet: bool) -> None:
    from gearcad.designs.reader import read_spec
    from gearcad.jobs.build import Build
    from gearcad.output import json_text

    job = Build(formats=parse_choices("format", formats, Format), options=options)
    design = job.run(read_spec(spec))
    folder = folder_of(output, design.name)
    with file_progress(shown=not quiet) as progress:
        files = job.write(design, folder, progress)
    if as_json:
        found = {"output": str(folder), "files": [str(file) for file in files], "warnings": list(design.warnings)}
        click.echo(json_text(job.document(design) | found), nl=False)
    else:
        click.echo("".join(f"{file}\n" for file in files), nl=False)
    if not quiet:
        echo_warnings(design.notices, err=True)
