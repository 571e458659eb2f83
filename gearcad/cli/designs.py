"""Commands on one design: new, data, build."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

import gearcad
from gearcad.cli.group import debug_option, format_option, parse_choices, require_new_file, spec_argument
from gearcad.cli.progress import file_progress
from gearcad.solids import FileOptions, Format

if TYPE_CHECKING:
    from gearcad.designs.design import Design

__all__ = ["build", "data", "new"]


@click.command()
@click.argument("kind", required=False)
@click.option("-o", "--output", metavar="FILE", help="Where to write it; - prints it.  [default: its own name here]")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@debug_option
def new(kind: str | None, output: str | None, force: bool) -> None:
    """Write a commented starter: a spec of one design, or a table of many.

    KIND is the name of a starter or its beginning; without it the starters are listed.
    """
    from gearcad.designs.starters import starter_text, starters

    if kind is None:
        click.echo("".join(f"{name:<14}{what}\n" for name, what in starters().items()), nl=False)
        return
    name, text = starter_text(kind)
    if output == "-":
        click.echo(text, nl=False)
        return
    path = Path(output or name)
    _write_new(path, text, force)
    click.echo(path)
    command = "batch" if name.endswith(".csv") else "dynamics" if "\n[train]\n" in text else "data"
    click.echo(f"Next: gearcad {command} {path}", err=True)


def _write_new(path: Path, text: str, force: bool) -> None:
    from gearcad.output import staged_files

    require_new_file(path, force)
    with staged_files(path.parent) as staging:
        (staging / path.name).write_text(text, encoding="utf-8")


@click.command()
@spec_argument
@click.option("--json", "as_json", is_flag=True, help="Print the document of data.json and nothing else.")
@debug_option
def data(spec: Path, as_json: bool) -> None:
    """Show the geometry of SPEC: every derived quantity, and warnings."""
    from gearcad.designs import GearDesign, PairDesign, read_spec
    from gearcad.output import json_text

    design = read_spec(spec).accepted(GearDesign, PairDesign, why="there are no teeth")
    if as_json:
        click.echo(json_text(design.to_dict()), nl=False)
        return
    from rich.console import Console

    from gearcad.cli.datasheet import print_datasheet

    print_datasheet(design, Console(highlight=False))


_BUILD = """Write the solids of SPEC: pinion.step, wheel.stl, assembly.step ... and data.json.

\b
""" + "\n".join(f"{kind.value:<6}{kind.entry.words}" for kind in Format)


@click.command(short_help="Write the solids of SPEC as STEP, STL and other files.", help=_BUILD)
@spec_argument
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder.  [default: output/NAME]")
@format_option
@click.option("--chord-error", default=0.005, show_default=True, metavar="MM", help="Largest error of the facets, in mm.")
@click.option("--bracket", is_flag=True, help="Put the assembly on two shafts with a bracket (STEP).")
@click.option("--circles", is_flag=True, help="Draw the tip, reference, base and root circles too (DXF).")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document: the files and the warnings.")
@click.option("--quiet", is_flag=True, help="No progress and no warnings on the screen.")
@debug_option
def build(
    spec: Path,
    output: Path | None,
    formats: str,
    chord_error: float,
    bracket: bool,
    circles: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    from gearcad.designs import read_spec
    from gearcad.jobs.build import build as build_files
    from gearcad.output import json_text

    wanted = parse_choices("format", formats, Format)
    design = read_spec(spec)
    folder = output if output is not None else Path("output") / design.name
    with file_progress(shown=not quiet) as progress:
        options = FileOptions(chord_error=chord_error, bracket=bracket, circles=circles)
        files = build_files(design, folder, wanted, options, progress)
    if as_json:
        document = {"kind": "build", "name": design.name, "gearcad": gearcad.__version__, "output": str(folder)}
        click.echo(json_text({**document, "files": [str(file) for file in files], "warnings": list(design.warnings)}), nl=False)
    else:
        click.echo("".join(f"{file}\n" for file in files), nl=False)
    _echo_warnings(design, shown=not quiet)


def _echo_warnings(design: Design, *, shown: bool) -> None:
    for warning in design.warnings if shown else ():
        click.echo(f"Warning: {warning}", err=True)
