"""A gear from measurements: identify."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from gearcad.cli.group import debug_option, require_new_file
from gearcad.cli.job import echo_warnings, quiet_option
from gearcad.errors import ParameterError

if TYPE_CHECKING:
    from gearcad.identify import Candidate, Identification

__all__ = ["identify"]

Command = TypeVar("Command", bound=Callable[..., Any])

_SINGLE: tuple[tuple[str, str, str], ...] = (
    ("--tip-diameter", "MM", "Over the tips; calipers read less over an odd number of teeth."),
    ("--root-diameter", "MM", "Of the bottoms of the spaces."),
    ("--helix-angle", "DEG", "On the reference circle; 0 for spur teeth; below 0 for a left hand."),
    ("--tip-helix-angle", "DEG", "On the tips, as the gear rolled over paper prints it."),
    ("--lead", "MM", "Along the axis, of one whole turn of a tooth."),
    ("--centre-distance", "MM", "Of the pair in which it runs; with --mate-teeth."),
    ("--mate-tip-diameter", "MM", "Of the gear with which it runs."),
)
_SIZED: tuple[tuple[str, str, str], ...] = (
    ("--span", "K:MM", "Over K teeth, of a spur ring over K spaces; repeat it with other K."),
    ("--over-pins", "D:MM", "Over two pins of diameter D; repeat it with another D."),
    ("--over-balls", "D:MM", "Over two balls."),
    ("--between-pins", "D:MM", "Of a spur ring."),
    ("--between-balls", "D:MM", "Of a ring."),
)
_UNCERTAIN = re.compile(r"\s*(?:\+-|\+/-|±)\s*")


def _gauge_options(command: Command) -> Command:
    for name, metavar, words in reversed(_SIZED):
        command = click.option(name, multiple=True, metavar=metavar, help=words)(command)
    for name, metavar, words in reversed(_SINGLE):
        command = click.option(name, metavar=metavar, help=words)(command)
    return command


@click.command(short_help="The standard gear that was measured: module, pressure angle, shift.")
@click.option("--teeth", type=int, required=True, metavar="Z", help="Counted; below 0 for a ring.")
@_gauge_options
@click.option("--mate-teeth", type=int, metavar="Z", help="Of the gear with which it runs; below 0 for a ring.")
@click.option("--uncertainty", type=float, default=0.02, show_default=True, metavar="MM", help="Of lengths without their own.")
@click.option(
    "--angle-uncertainty", type=float, default=1.0, show_default=True, metavar="DEG", help="Of angles; of a lead 1 %."
)
@click.option("--count", type=int, default=5, show_default=True, metavar="N", help="Most candidates that are listed.")
@click.option("--write", type=click.Path(path_type=Path), metavar="FILE", help="Write the spec of a candidate.")
@click.option("--candidate", type=int, default=1, show_default=True, metavar="N", help="Which one.")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@click.option("--json", "as_json", is_flag=True, help="Print the candidates as a document and nothing else.")
@quiet_option
@debug_option
def identify(
    teeth: int,
    mate_teeth: int | None,
    uncertainty: float,
    angle_uncertainty: float,
    count: int,
    write: Path | None,
    candidate: int,
    force: bool,
    as_json: bool,
    quiet: bool,
    **given: Any,
) -> None:
    """Which standard gear has been measured: modules of ISO 54 and DIN 780, diametral pitches and sizes of no series, with all
    usual pressure angles and racks, spur or helical, external or a ring, ranked by how well they fit.

    A reading may have its own standard uncertainty, such as 52.3+-0.1 for a worn tip; it is of measuring and of making. Two
    spans tell most: they differ by the base pitch. Probabilities weigh the fit with how usual a gear is, as we judge it.

    \b
    gearcad identify --teeth 24 --tip-diameter 52.02 --root-diameter 43.01 --span 3:15.40 --span 4:21.30
    gearcad identify --teeth 31 --tip-diameter 74.6 --over-pins 3.5:75.52 --tip-helix-angle 16 --write gear.toml
    gearcad identify --teeth 30 --tip-diameter 81.2+-0.2 --centre-distance 101.6 --mate-teeth 50
    """
    from gearcad.jobs.identify import identify as identified
    from gearcad.output import json_text

    if write is not None:
        require_new_file(write, force)
    if not 1 <= candidate <= count:
        raise ParameterError("candidate", candidate, f"must be a whole number from 1 to {count}, as many as are listed")
    readings: dict[str, Any] = {name: _value(name, text) for name in _names(_SINGLE) if (text := given[name]) is not None}
    readings |= {name: _values(name, texts) for name in _names(_SIZED) if (texts := given[name])}
    found = identified(
        teeth,
        mate_teeth=mate_teeth,
        uncertainty=uncertainty,
        angle_uncertainty=angle_uncertainty,
        count=count,
        **readings,
    )
    chosen = _chosen(found, candidate)
    if write is not None:
        _write(found, chosen, write)
    if as_json:
        click.echo(json_text(found.to_dict()), nl=False)
    else:
        from gearcad.cli.identify_table import identification_lines

        click.echo("\n".join(identification_lines(found)))
        if write is not None:
            click.echo(write)
    if not quiet:
        echo_warnings(found.notices, err=True)
        if write is not None:
            click.echo(f"Next: gearcad data {write}", err=True)
    if not found.fits:
        click.get_current_context().exit(1)


def _names(options: Sequence[tuple[str, str, str]]) -> list[str]:
    return [name.lstrip("-").replace("-", "_") for name, _, _ in options]


def _value(name: str, text: str) -> Any:
    """A reading, with its own uncertainty if there is one."""
    try:
        numbers = tuple(map(float, _UNCERTAIN.split(text.strip())))
    except ValueError:
        raise ParameterError(name, text, "must be a number, or a number and its uncertainty: 52.3 or 52.3+-0.1") from None
    if len(numbers) > 2:
        raise ParameterError(name, text, "must have one uncertainty: 52.3+-0.1")
    return numbers[0] if len(numbers) == 1 else numbers


def _values(name: str, texts: Sequence[str]) -> dict[Any, Any]:
    """Readings by the number of teeth spanned, or by the diameter of pins or balls."""
    found: dict[Any, Any] = {}
    for text in texts:
        first, colon, reading = text.partition(":")
        spans = name == "span"
        example = "3:15.40" if spans else "3.5:56.21"
        try:
            size = int(first) if spans else float(first)
        except ValueError:
            colon = ""
        if not colon:
            what = "teeth spanned" if spans else "diameter of pins or balls"
            raise ParameterError(name, text, f"must be {what} and reading, such as {example}")
        if size in found:
            raise ParameterError(name, text, f"must be given once for {size:g}")
        found[size] = _value(name, reading)
    return found


def _chosen(found: Identification, number: int) -> Candidate:
    if number > len(found.candidates):
        permitted = f"must be a whole number from 1 to {len(found.candidates)}, as many as there are"
        raise ParameterError("candidate", number, permitted)
    return found.candidates[number - 1]


def _write(found: Identification, chosen: Candidate, path: Path) -> None:
    from gearcad.designs.identified import write_identified
    from gearcad.output import staged_files

    with staged_files(path.parent) as staging:
        write_identified(found, chosen, path.stem, staging / path.name)
