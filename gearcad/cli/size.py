"""Pairs for a task: size."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gearcad.cli.group import debug_option
from gearcad.cli.job import quiet_option
from gearcad.cli.progress import job_progress
from gearcad.cli.size_options import size_options, task_of
from gearcad.cli.size_sets import require_no_sets, set_options, size_planetary
from gearcad.cli.size_table import basis_lines, nothing_lines, notice_texts, scuffing_line, table_lines
from gearcad.errors import ParameterError
from gearcad.reprs import grouped

if TYPE_CHECKING:
    from gearcad.sizing import Sizing

__all__ = ["size"]

_COUNT, _MOST_COUNT = 20, 1000
_MODIFIED = "best-modified.toml"


@click.command(short_help="Pairs, or planetary sets, for a torque, a ratio, a life and a material.")
@size_options
@set_options
@click.option("--count", type=int, metavar="N", help="Most pairs that are listed.  [default: 20]")
@click.option("--errors", type=int, metavar="N", help="How many of them get a transmission error by FE.  [default: all]")
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder.  [default: output/size]")
@click.option("--json", "as_json", is_flag=True, help="Print the document of size.json and nothing else.")
@quiet_option
@debug_option
def size(count: int | None, errors: int | None, output: Path | None, as_json: bool, quiet: bool, **given: Any) -> None:
    """Pairs of external gears that carry a torque for a life: every combination of teeth, module, helix angle, shifts and face
    width within ranges is rated by ISO 6336, Method B, and the best of each teeth, module and helix angle are refined.

    Writes pairs.csv, a design table for `gearcad batch`; best.toml, the spec of the first; front.csv and front.png, variants
    that none is both lighter and safer than; and size.json. Lists of numbers have commas, ranges are FIRST:LAST:STEP.

    With --planetary sets of planets for the ratio, the --input-torque or --output-torque and the speed of the input: tooth
    numbers as `gearcad planetary --ratio` finds them, then the module of ISO 54 and the face width that just have the safeties,
    lightest first; writes sets.csv, best.toml and size.json. --wheel-material is that of rings.

    \b
    gearcad size --torque 302 --ratio 1.5 --life 20000 --material "Eh MQ" --speed 1500
    gearcad size --power 5 --speed 400 --ratio 4 --life 5000 --material "Eh MQ" --application-factor 1.25 --by quiet
    gearcad size --planetary --input-torque 300 --speed 1500 --ratio 5.2 --life 20000 --material "Eh MQ"
    """
    from gearcad.jobs.sizes import write_sizing
    from gearcad.output import json_text
    from gearcad.sizing import search_pairs
    from gearcad.sizing.run import expected

    number = _COUNT if count is None else count
    for name, value, least in (("count", number, 1), ("errors", errors, 0)):
        if value is not None and not least <= value <= _MOST_COUNT:
            raise ParameterError(name, value, f"must be a whole number from {least} to {_MOST_COUNT}")
    if given["planetary"]:
        size_planetary({**given, "errors": errors}, number, output, as_json=as_json, quiet=quiet)
        return
    require_no_sets(given)
    task = task_of(given)
    wanted = number if errors is None else min(errors, number)
    with job_progress(shown=not quiet, expected=None if quiet else expected(task, number, wanted)) as progress:
        result = search_pairs(task, count=number, errors=wanted, progress=progress)
    files = write_sizing(result, Path("output/size") if output is None else output)
    if as_json:
        click.echo(json_text(result.to_dict()), nl=False)
    elif result.found:
        click.echo("\n".join(table_lines(result)))
    if not result.found:
        click.echo("\n".join(nothing_lines(result)), err=True)
        click.get_current_context().exit(1)
    if not quiet:
        click.echo("\n".join(_remarks(result, files[1])), err=True)
    if not as_json:
        click.echo("".join(f"{file}\n" for file in files), nl=False)


def _remarks(result: Sizing, best: Path) -> Iterator[str]:
    """What the safeties go by, what the columns are, what was left out, and how to go on from the spec of the best."""
    rating = result.task.rating
    yield from basis_lines(rating, result.task.load.application_factor, result.assumed)
    if (line := scuffing_line(rating)) is not None:
        yield line
    for number, texts in enumerate(notice_texts(result).values(), 1):
        yield f"notice {number}: {texts[0]}{f' (and alike of others, {len(texts)} in all)' if len(texts) > 1 else ''}"
    yield f"{grouped(result.considered)} variants, {grouped(result.rated)} rated; a line for each teeth, module and helix angle"
    yield "ripple: of the length of the lines of contact; TE: transmission error, peak to peak, FE, no modifications;"
    yield "front: none of the best is both lighter and safer; front.csv has pairs along the front of all variants"
    yield "mass of plain discs; no pair has backlash yet: tooth_thinning or tooth_allowance gives it"
    if result.unmade:
        yield f"{len(result.unmade)} could not be made or did not pass the full rating; the first: {result.unmade[0]}"
    yield "Next, in this order (edges of teeth without tip relief touch, which a check in 3D may not pass):"
    yield f"  gearcad rate {best}"
    yield f"  gearcad modify {best} -o {best.with_name(_MODIFIED)}"
    yield f"  gearcad check {best.with_name(_MODIFIED)}"
    yield f"  gearcad batch {best.with_name('pairs.csv')} --do rate"
