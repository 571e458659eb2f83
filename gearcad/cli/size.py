"""Command `size`: pairs, or planetary sets, for a task."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gearcad.cli.group import debug_option
from gearcad.cli.job import echo_warnings, job_progress, quiet_option
from gearcad.cli.language import say, translated
from gearcad.cli.size_options import require_no_sets, set_options, size_options
from gearcad.core.errors import ParameterError, SolverError
from gearcad.core.records import grouped, is_assumed

if TYPE_CHECKING:
    from gearcad.rating.options import RatingOptions
    from gearcad.sizing import SizedPair, Sizing
    from gearcad.sizing.planetary_sets import SizedSet, SizedSets


_SIZE_TABLE_HEADING = (
    *("pair", "a mm", "b mm", "x1", "x2", "u", "kg", "S_H", "S_F1", "S_F2", "eps_a", "eps_b", "sliding", "°C", "ripple %"),
    *("TE µm", "efficiency %", "loss W", "front", "notice"),
)

_WIDTH = 120


def table_lines(result: Sizing) -> Iterator[str]:
    """A line for each pair, under a heading."""
    codes = list(notice_texts(result))
    rows = [_SIZE_TABLE_HEADING, *((*_size_table_row(each), _marks(each, codes)) for each in result.found)]
    shown = [number for number, column in enumerate(zip(*rows[1:], strict=True)) if any(column)]
    widths = {number: max(len(row[number]) for row in rows) for number in shown}
    for row in rows:
        first, *others = shown
        cells = (f"{row[number]:>{widths[number]}}" for number in others)
        yield "  ".join((f"{row[first]:<{widths[first]}}", *cells)).rstrip()


def _marks(each: SizedPair, codes: list[str]) -> str:
    """Numbers of the notices of its rating."""
    own = () if each.strength is None else (codes.index(notice.code) + 1 for notice in each.strength.notices)
    return ",".join(map(str, sorted(set(own))))


def notice_texts(result: Sizing) -> dict[str, list[str]]:
    """Return the texts of the ratings' notices by code, each text once. Some notices differ with each pair."""
    found: dict[str, list[str]] = {}
    for each in result.found:
        for notice in () if each.strength is None else each.strength.notices:
            texts = found.setdefault(notice.code, [])
            if str(notice) not in texts:
                texts.append(str(notice))
    return found


def scuffing_line(options: RatingOptions) -> str | None:
    """Return the line that scuffing was not judged, with the options that would judge it, or None if it was judged."""
    from gearcad.sizing.proposals import unjudged_scuffing

    why = unjudged_scuffing(options)
    return None if why is None else f"{why}; --safety-scuffing 1.8 --rating scuffing_stage=12 would judge it"


def basis_lines(options: RatingOptions, application_factor: float, assumed: Iterable[str]) -> Iterator[str]:
    """Yield lines with the basis of all safeties: the required values, the accuracy, and the assumed inputs."""
    grade = f"accuracy grade {options.accuracy_grade} of {options.accuracy.value}"
    grade += " (assumed)" if is_assumed(options.accuracy_grade) else ""
    required = f"S_H {options.required_safety_flank:g}, S_F {options.required_safety_root:g}"
    yield f"required {required}; K_A {application_factor:g}; {grade}; {options.standard.value}"
    yield from _wrapped("assumed ", "; ".join(assumed))


def _wrapped(words: str, text: str) -> list[str]:
    words, text = translated(words), translated(text)
    return textwrap.wrap(text, _WIDTH, initial_indent=words, subsequent_indent=" " * len(words)) if text else []


def _size_table_row(each: SizedPair) -> tuple[str, ...]:
    return (
        each.name,
        f"{each.centre_distance:g}",
        f"{each.face_width:g}",
        f"{each.pinion_shift:.2f}",
        f"{each.shift_sum - each.pinion_shift:.3f}",
        f"{each.ratio:.3f}",
        f"{each.mass:.3g}" if each.mass < 100 else f"{each.mass:.0f}",
        f"{min(each.flank_safeties):.2f}",
        *(f"{safety:.2f}" for safety in each.root_safeties),
        f"{each.transverse_contact_ratio:.2f}",
        f"{each.overlap_ratio:.2f}" if each.overlap_ratio else "",
        f"{each.sliding:.2f}",
        "" if each.temperature is None else f"{each.temperature:.0f}",
        f"{100 * each.ripple:.0f}",
        "" if each.transmission_error is None else f"{each.transmission_error:.2f}",
        "" if each.efficiency is None else f"{100 * each.efficiency:.3f}",
        "" if each.mean_loss is None else f"{each.mean_loss:.3g}",
        "*" if each.front else "",
    )


def size_planetary(given: Mapping[str, Any], count: int, output: Path | None, *, as_json: bool, quiet: bool) -> None:
    """Size sets for what options ask for, write the files and show the table; ends with status 1 where none holds."""
    from gearcad.core.output import json_text
    from gearcad.jobs.searches import size_document, write_set_sizes
    from gearcad.jobs.set_size_options import set_task_of
    from gearcad.sizing.planetary_sets import expected, size_sets

    task = set_task_of(given)
    try:
        with job_progress(shown=not quiet, expected=None if quiet else expected(task, count)) as progress:
            result = size_sets(task, count, progress)
    except SolverError as error:
        say(str(error), err=True)
        click.get_current_context().exit(1)
    files = write_set_sizes(result, Path("output/size") if output is None else output)
    if as_json:
        click.echo(json_text(size_document(result)), nl=False)
        return
    say("\n".join(_table(result)))
    if not quiet:
        echo_warnings(task.notices, err=True)
        say("\n".join(_remarks(result)), err=True)
    click.echo("".join(f"{file}\n" for file in files), nl=False)


# ---------------------------------------------------------------------- what is shown

_HEADING = ("set", "ratio", "off %", "m mm", "b mm", "diameter mm", "a mm", "planets", "K_gamma", "kg", "S_H", "S_F", "weakest")


def _table(result: SizedSets) -> Iterator[str]:
    """A line for each set, under a heading."""
    rows = [_HEADING, *(_row(each) for each in result.found)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        name, *numbers, last = row
        cells = (f"{cell:>{width}}" for cell, width in zip(numbers, widths[1:], strict=False))
        yield "  ".join((f"{name:<{widths[0]}}", *cells, last)).rstrip()


def _row(each: SizedSet) -> tuple[str, ...]:
    from gearcad.rating.strength import RatedPart

    own = each.candidate
    worst = min(each.margins, key=lambda part: each.margins[part] ** (2 if part is RatedPart.FLANK else 1))
    places = [(least, name) for name, gear in each.strength.members.items() if (least := gear.least(worst)) is not None]
    least, gear = min(places)
    return (
        each.name,
        f"{own.ratio:.5g}",
        f"{own.deviation:+.3f}" if own.deviation else "0",
        f"{own.task.module:g}",
        f"{own.task.width:g}",
        f"{own.diameter:.1f}",
        f"{own.centre_distance:.3f}",
        str(own.planets),
        f"{each.load.mesh_load_factor:g}",
        f"{each.mass:.3g}",
        *(f"{each.least[part]:.3f}" for part in RatedPart),
        f"{worst.value} of {gear} in {least.mesh}",
    )


def _remarks(result: SizedSets) -> Iterator[str]:
    """Yield lines with the basis of the safeties, the number of sets considered, and the meaning of the columns."""

    options, task = result.task.rating, result.task
    yield from basis_lines(options, task.application_factor, result.assumed)
    if (line := scuffing_line(options)) is not None:
        yield line
    yield f"{result.considered} sets of tooth numbers, {result.refined} of them sized; lightest first"
    yield "weakest: the part that more torque takes first; off: ratio over the one asked for, less 1"
    yield "mass without bores, rings with rims of 3.5 m_n; diameter over all teeth"
    yield "S_H and S_F are the least of all gears under all load factors; no set has backlash yet: planetary.tooth_thinning"
    if result.refused:
        name, why = next(iter(result.refused.items()))
        yield f"{len(result.refused)} were left out; the first: {name}: {why}"
    yield "Next: gearcad rate best.toml, gearcad planetary best.toml, gearcad batch sets.csv"


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
    from gearcad.core.output import json_text
    from gearcad.jobs.searches import nothing_lines, size_document, write_sizing
    from gearcad.jobs.size_options import task_of
    from gearcad.sizing import search_pairs
    from gearcad.sizing.proposals import expected

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
        click.echo(json_text(size_document(result)), nl=False)
    elif result.found:
        say("\n".join(table_lines(result)))
    if not result.found:
        say("\n".join(nothing_lines(result)), err=True)
        click.get_current_context().exit(1)
    if not quiet:
        say("\n".join(_size_remarks(result, files[1])), err=True)
    if not as_json:
        click.echo("".join(f"{file}\n" for file in files), nl=False)


def _size_remarks(result: Sizing, best: Path) -> Iterator[str]:
    """Yield lines with the basis of the safeties, the meaning of the columns, the pairs left out, and the next commands."""
    rating = result.task.rating
    yield from basis_lines(rating, result.task.load.application_factor, result.assumed)
    if (line := scuffing_line(rating)) is not None:
        yield line
    for number, texts in enumerate(notice_texts(result).values(), 1):
        yield f"notice {number}: {texts[0]}{f' (and alike of others, {len(texts)} in all)' if len(texts) > 1 else ''}"
    yield f"{grouped(result.considered)} variants, {grouped(result.rated)} rated; a line for each teeth, module and helix angle"
    yield "ripple: of the length of the lines of contact; TE: transmission error, peak to peak, FE, no modifications;"
    if result.task.friction is not None:
        yield "efficiency: of the mesh, by H_V of Ohlendorf and the mean coefficient of friction; without shafts and seals"
    yield "front: none of the best is both lighter and safer; front.csv has pairs along the front of all variants"
    yield "mass of plain discs; no pair has backlash yet: tooth_thinning or tooth_allowance gives it"
    if result.unmade:
        yield f"{len(result.unmade)} could not be made or did not pass the full rating; the first: {result.unmade[0]}"
    yield "Next, in this order (edges of teeth without tip relief touch, which a check in 3D may not pass):"
    yield f"  gearcad rate {best}"
    yield f"  gearcad modify {best} -o {best.with_name(_MODIFIED)}"
    yield f"  gearcad check {best.with_name(_MODIFIED)}"
    yield f"  gearcad batch {best.with_name('pairs.csv')} --do rate"
