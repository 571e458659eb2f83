"""Commands `export` and `import`: files of other programs for drives."""

from __future__ import annotations

from pathlib import Path

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import folder_of, output_option, quiet_option
from gearcad.cli.language import say

_JSON = "Print the document of what was done and nothing else."


@click.command(short_help="A file of REXS, for other programs for drives.")
@spec_argument
@click.option("--format", "form", type=click.Choice(["rexs"]), default="rexs", show_default=True, help="The format.")
@output_option
@click.option("--json", "as_json", is_flag=True, help=_JSON)
@quiet_option
@debug_option
def export(spec: Path, form: str, output: Path | None, as_json: bool, quiet: bool) -> None:
    """Write a gear or a pair as NAME.rexs: REXS 1.6, the open format of the FVA for drives. `gearcad import` reads it back.

    It has the gears with flanks, tools, modifications and allowances, the stage with its load, materials, oil, and shafts with
    bearings and forces. What REXS has no attribute for is kept under names that other programs leave out, and `gearcad import`
    reads; a line for each such key tells so.
    """
    from gearcad.core.output import json_text
    from gearcad.designs.reader import read_spec
    from gearcad.jobs import exchange as job

    assert form == "rexs"
    result = job.export_rexs(read_spec(spec))
    file = job.write_export(result, folder_of(output, result.name))
    if as_json:
        click.echo(json_text(job.export_document(result)), nl=False)
    else:
        click.echo(file)
    if not quiet:
        for line in result.kept:
            say(line, err=True)


@click.command("import", short_help="Specs of a file of REXS.")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", default=".", help="Folder.  [default: here]")
@click.option("--force", is_flag=True, help="Replace files that exist.")
@click.option("--json", "as_json", is_flag=True, help=_JSON)
@quiet_option
@debug_option
def import_specs(file: Path, output: Path, force: bool, as_json: bool, quiet: bool) -> None:
    """Write a spec for each cylindrical stage of FILE, a file of REXS 1.0 to 1.7 in XML; for each gear where there is no stage.

    Lines tell what was left out, and what was assumed because the file does not say it. They stand at the top of the spec too.
    """
    from gearcad.core.output import json_text
    from gearcad.jobs import exchange as job

    result = job.import_rexs(file)
    paths = job.write_import(result, output, force=force)
    document = job.import_document(result)
    if as_json:
        click.echo(json_text(document), nl=False)
    else:
        click.echo("".join(f"{path}\n" for path in paths), nl=False)
    if quiet:
        return
    for warning in document["warnings"]:
        say(f"Warning: {warning}", fg="yellow", err=True)
    if not as_json:
        say(f"Next: gearcad data {paths[0]}", err=True)
