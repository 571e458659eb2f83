"""Pictures of a design: picture."""

from __future__ import annotations

import re
from pathlib import Path

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import echo_warnings, folder_of, json_option, quiet_option
from gearcad.cli.progress import file_progress

__all__ = ["picture"]

_IMAGES = (".png", ".gif", ".apng", ".webp")
_OTHERS = tuple(".avi .bmp .eps .jpe .jpeg .jpg .mov .mp4 .pdf .ps .svg .tga .tif .tiff .webm".split())
"""Of images and films that nobody means for a folder."""


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
    from gearcad.designs import read_spec
    from gearcad.errors import ParameterError, as_choice
    from gearcad.jobs.picture import Background, Picture
    from gearcad.output import json_text
    from gearcad.solids.files.pictures.cutaway import Cutaway
    from gearcad.solids.files.pictures.images import Animation
    from gearcad.solids.files.pictures.views import View

    if output is not None and output.suffix.lower() in _OTHERS and not output.is_dir():
        permitted = f"must end in {', '.join(_IMAGES[:-1])} or {_IMAGES[-1]}, or be a folder"
        raise ParameterError("output", str(output), permitted)
    job = Picture(
        view=as_choice("view", view.lower(), View),
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
        click.echo(json_text(job.document(result)), nl=False)
    else:
        click.echo("".join(f"{file}\n" for file in files), nl=False)
    if not quiet:
        echo_warnings((*job.notices(result), *design.notices), err=True)


def _pixels(text: str) -> tuple[int, int]:
    """Width and height, such as 1600x1200. Raises ParameterError."""
    from gearcad.errors import ParameterError

    if (found := re.fullmatch(r"\s*(\d{1,6})\s*[xX×]\s*(\d{1,6})\s*", text, re.ASCII)) is None:
        raise ParameterError("size", text, "must be width and height in pixels, such as 1600x1200")
    return int(found[1]), int(found[2])
