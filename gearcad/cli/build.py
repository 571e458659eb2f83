"""Commands `build`, `draw` and `picture`."""

from __future__ import annotations

import re
from dataclasses import fields
from functools import partial, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from gearcad.cli.group import debug_option, parse_choices, spec_argument
from gearcad.cli.job import Command, echo_warnings, file_progress, folder_of, json_option, output_option, perform, quiet_option
from gearcad.cli.language import say
from gearcad.solids import FileOptions, Format

if TYPE_CHECKING:
    from gearcad.drawing.gear_sheet import Drawing
    from gearcad.jobs.job import Job


_HELP = """Write the solids of SPEC: pinion.step, wheel.stl, assembly.step ... and data.json.

Of a train of pairs each pair is in a folder of its mesh, and assembly.step has all gears and shafts.

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
    click.option("--ap242", is_flag=True, help="Write STEP in AP242 in place of AP214: the same solids, names and colours."),
)


@click.command(short_help="Write the solids of SPEC as STEP, STL and other files.", help=_HELP)
@spec_argument
@output_option
@format_option
@files_options
@click.option("--stage", default="finished", show_default=True, help="precut (before the flanks are finished) or finished.")
@click.option("--as-made", is_flag=True, help="Write each gear with a table making as its mould, print or path is made, too.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document: the files and the warnings.")
@click.option("--quiet", is_flag=True, help="No progress and no warnings on the screen.")
@debug_option
def build(
    spec: Path,
    output: Path | None,
    formats: str,
    options: FileOptions,
    stage: str,
    as_made: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    from gearcad.core.output import json_text
    from gearcad.core.records import texts
    from gearcad.designs.reader import read_spec
    from gearcad.jobs import job_for
    from gearcad.jobs.build import Build
    from gearcad.jobs.job import with_summary

    wanted = Build(formats=parse_choices("format", formats, Format), options=options, stage=stage, as_made=as_made)
    design = read_spec(spec)
    job: Job[Any, Any] = job_for(wanted, design)
    result = job.run(design)
    folder = folder_of(output, design.name)
    with file_progress(shown=not quiet) as progress:
        files = job.write(result, folder, progress)
    if as_json:
        found = {"output": str(folder), "files": [str(file) for file in files], "warnings": texts(job.notices(result))}
        click.echo(json_text(with_summary(job.document(result) | found)), nl=False)
    else:
        click.echo("".join(f"{file}\n" for file in files), nl=False)
    if not quiet:
        echo_warnings(job.notices(result), err=True)


@click.command(short_help="Draw SPEC's gears and what they make, with gear data: DXF, SVG, PDF.")
@spec_argument
@click.option("--sheet", metavar="A3", help="A4 to A0, or auto: the smallest that has room.  [default: auto]")
@click.option("--scale", metavar="1:2", help="One of ISO 5455, or auto: the largest for which there is room.  [default: auto]")
@click.option("--language", metavar="en", help="en, de or sv.  [default: en]")
@click.option("--projection", metavar="first", help="first or third angle.  [default: first]")
@click.option("--format", "formats", default="dxf,svg,pdf", show_default=True, help="Comma-separated list of dxf, svg, pdf.")
@click.option("--what", default="parts", show_default=True, help="parts, or tool: the tools that cut and finish them.")
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
    what: str,
    output: Path | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Draw SPEC for the workshop: a sheet of each gear with its dimensions and gear data, one of the pair or train they make.

    Of a train of pairs there is a sheet of the arrangement, and those of each pair in a folder of its mesh.

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
    job = Draw(formats=parse_choices("format", formats, SheetFormat), given=given, what=what)
    perform(job, spec, output, partial(_show, quiet=quiet), as_json=as_json, quiet=quiet)


def _show(_name: str, drawing: Drawing, *, quiet: bool) -> None:
    """Print the sheets, a line each, then the warnings about them unless `quiet`."""
    from gearcad.jobs.draw import paper_of, scale_of

    width = max(len(sheet.name) for sheet in drawing.sheets)
    for sheet in drawing.sheets:
        say(f"{sheet.name:<{width}}  {paper_of(sheet):<3} {scale_of(sheet):>6}  {sheet.title}")
    if not quiet:
        echo_warnings(drawing.notices)


_IMAGES = (".png", ".gif", ".apng", ".webp")
_OTHERS = tuple(".avi .bmp .eps .jpe .jpeg .jpg .mov .mp4 .pdf .ps .svg .tga .tif .tiff .webm".split())
"""Suffixes of images and films, which cannot be meant for a folder."""


@click.command(short_help="Write a picture of SPEC, still or turning.")
@spec_argument
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="PATH", help="Image, or folder.  [default: output/NAME]"
)
@click.option("--view", default="corner", show_default=True, metavar="VIEW", help="corner, front, side, top or mesh.")
@click.option("--size", metavar="WxH", help="Pixels.  [default: 1600x1200, turning 800x600]")
@click.option("--cutaway", metavar="PART", help="Take off a quarter or half of each part: quarter, half.")
@click.option("--explode", is_flag=True, help="Move parts apart.")
@click.option(
    "--turning", is_flag=False, flag_value="gif", metavar="[FORMAT]", help="Let it turn: gif, apng or webp.  [default: gif]"
)
@click.option("--background", default="white", show_default=True, metavar="WORD", help="white or transparent.")
@json_option
@quiet_option
@debug_option
def picture(
    spec: Path,
    output: Path | None,
    view: str,
    size: str | None,
    cutaway: str | None,
    explode: bool,
    turning: str | None,
    background: str,
    as_json: bool,
    quiet: bool,
) -> None:
    """Write a picture of the gear, rack, pair or train of SPEC: picture.png, without a display.

    \b
    corner    from above one corner
    front     along the axes
    side      from the right, along the line of centres
    top       from above
    mesh      close by along the axes, where teeth mesh

    With --turning it moves, in a loop of whole tooth pitches after which all looks as at first: picture.gif. A rack goes forth
    and back; a train turns as its speeds say until planets stand where planets stood, or with its carrier held still where
    that takes too long, which is told. Its mesh is always seen from the carrier. --output with the name of an image writes
    that alone, else picture.json beside it says what is on it.
    """
    from gearcad.core.errors import ParameterError, as_choice
    from gearcad.core.output import json_text
    from gearcad.designs import read_spec
    from gearcad.jobs.draw import Background, Picture
    from gearcad.solids.files.cutaway import Cutaway, SceneView
    from gearcad.solids.files.studio import Animation

    if output is not None and output.suffix.lower() in _OTHERS and not output.is_dir():
        permitted = f"must end in {', '.join(_IMAGES[:-1])} or {_IMAGES[-1]}, or be a folder"
        raise ParameterError("output", str(output), permitted)
    job = Picture(
        view=as_choice("view", view.lower(), SceneView),
        size=None if size is None else _pixels(size),
        cutaway=None if cutaway is None else as_choice("cutaway", cutaway.lower(), Cutaway),
        explode=explode,
        turning=None if turning is None else as_choice("turning", turning.lower(), Animation),
        background=as_choice("background", background.lower(), Background),
    )
    design = read_spec(spec)
    result = job.run(design)
    if output is not None and output.suffix.lower() in _IMAGES:
        job.write_image(result, output)
        files = [output]
    else:
        with file_progress(shown=not quiet) as progress:
            files = job.write(result, folder_of(output, design.name), progress)
    if as_json:
        click.echo(json_text(job.complete_document(result)), nl=False)
    else:
        click.echo("".join(f"{file}\n" for file in files), nl=False)
    if not quiet:
        echo_warnings((*job.notices(result), *job.design_notices(design)), err=True)


def _pixels(text: str) -> tuple[int, int]:
    """Width and height, such as 1600x1200. Raises ParameterError."""
    from gearcad.core.errors import ParameterError

    if (found := re.fullmatch(r"\s*(\d{1,6})\s*[xX×]\s*(\d{1,6})\s*", text, re.ASCII)) is None:
        raise ParameterError("size", text, "must be width and height in pixels, such as 1600x1200")
    return int(found[1]), int(found[2])
