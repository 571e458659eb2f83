"""Tooth numbers for a ratio: what `gearcad planetary --ratio` asks for and shows."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from gearcad.cli.group import require_new_file
from gearcad.errors import ParameterError, as_choice
from gearcad.reprs import grouped

if TYPE_CHECKING:
    from gearcad.planetary.search import Candidate, SearchResult, SearchTask

__all__ = ["require_no_search", "search_options", "search_sets"]

Command = TypeVar("Command", bound=Callable[..., Any])

_OPTIONS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("--ratio", {"type": float, "metavar": "I", "help": "Search: speed of the input over that of the output."}),
    ("--type", {"metavar": "TYPES", "help": "A sun and ring, B with stepped planets, C two suns, D two rings.  [default: A]"}),
    ("--module", {"type": float, "metavar": "MM", "help": "Normal module; needed for a search."}),
    ("--module-2", {"type": float, "metavar": "MM", "help": "That of the second mesh of stepped planets."}),
    ("--planets", {"metavar": "N[:N]", "help": "How many planets.  [default: 3:5]"}),
    ("--fixed", {"metavar": "MEMBER", "help": "sun, ring, carrier, sun_2 or ring_2; so for --in and --out."}),
    ("--in", {"metavar": "MEMBER", "help": "The input."}),
    ("--out", {"metavar": "MEMBER", "help": "The output."}),
    ("--tolerance", {"type": float, "metavar": "%", "help": "Most deviation of the ratio.  [default: 1]"}),
    ("--teeth", {"metavar": "Z[:Z]", "help": "Of suns and planets.  [default: 17:100]"}),
    ("--ring-teeth", {"metavar": "Z[:Z]", "help": "Of rings.  [default: 30:200]"}),
    ("--diameter", {"type": float, "metavar": "MM", "help": "Most diameter over all teeth."}),
    ("--helix-angle", {"type": float, "metavar": "DEG", "help": "Of the first sun or ring.  [default: 0]"}),
    ("--face-width", {"type": float, "metavar": "MM", "help": "Of all gears.  [default: 10 modules]"}),
    ("--tip-distance", {"type": float, "metavar": "MM", "help": "Least between planets.  [default: 1 module]"}),
    ("--mesh-efficiency", {"type": float, "metavar": "ETA", "help": "Of a mesh, to compare sets.  [default: 0.99]"}),
    ("--count", {"type": int, "metavar": "N", "help": "Most sets that are listed.  [default: 20]"}),
)

_NAMES = {"in": "input", "out": "output", "type": "types"}
"""Fields of the task that options call otherwise."""

_RANGES = ("planets", "teeth", "ring_teeth")

_COUNT = 20
_MOST_COUNT = 1000


def search_options(command: Command) -> Command:
    """The options of a search."""
    for name, how in reversed(_OPTIONS):
        command = click.option(name, name.lstrip("-").replace("-", "_"), **how)(command)
    force = click.option("--force", is_flag=True, help="Search: replace a table that exists.")
    return force(command)


def require_no_search(given: Mapping[str, Any], *, force: bool) -> None:
    """Raise ParameterError for an option of a search where no ratio is wanted."""
    for name, value in {**given, "force": force or None}.items():
        if value is not None:
            raise ParameterError(name, value, "is of a search: needs --ratio")


def search_sets(given: Mapping[str, Any], output: Path | None, *, force: bool, as_json: bool, quiet: bool) -> None:
    """Search for what options ask for; show it, or print its document, and write the design table if there is a place.

    Ends the command with status 1 where nothing is found.
    """
    from gearcad.designs.found_sets import write_found
    from gearcad.output import json_text
    from gearcad.planetary.search import search

    task, count = _task(given), _COUNT if given["count"] is None else given["count"]
    if not 1 <= count <= _MOST_COUNT:
        raise ParameterError("count", count, f"must be a whole number from 1 to {_MOST_COUNT}")
    if output is not None:
        require_new_file(output, force)
        if output.suffix.lower() != ".csv":
            raise ParameterError("output", str(output), "must end in .csv: a search writes a design table")
    result = search(task, count)
    if output is not None and result.found:
        write_found(result, output)
    if as_json:
        click.echo(json_text(result.to_dict()), nl=False)
    elif result.found:
        click.echo("\n".join(_table(result)))
    if not result.found:
        click.echo(_nothing(result), err=True)
        click.get_current_context().exit(1)
    if not quiet:
        click.echo("\n".join(_remarks(result, output)), err=True)
    if output is not None and not as_json:
        click.echo(output)


# ---------------------------------------------------------------------- what is asked


def _task(given: Mapping[str, Any]) -> SearchTask:
    """The task of the options that are given. Raises ParameterError."""
    from gearcad.planetary.mesh import SetType
    from gearcad.planetary.search import SearchTask

    if given.get("module") is None:
        raise ParameterError("module", None, "must be given, in mm, with --ratio")
    fields: dict[str, Any] = {}
    for name, value in given.items():
        if value is None or name == "count":
            continue
        field = _NAMES.get(name, name)
        if field == "types":
            value = tuple(as_choice("type", each.strip().upper(), SetType) for each in value.split(","))
        elif field in _RANGES:
            value = _ends(name, value)
        fields[field] = value
    try:
        return SearchTask(**fields)
    except ParameterError as error:
        called = {field: name for name, field in _NAMES.items()}
        raise ParameterError(called.get(error.parameter, error.parameter), error.value, error.permitted, error.unit) from error


def _ends(name: str, text: str) -> tuple[int, int]:
    """Least and most of "3:5", or twice the one of "3"."""
    try:
        ends = tuple(int(each) for each in text.split(":"))
    except ValueError:
        ends = ()
    if len(ends) not in (1, 2):
        raise ParameterError(name, text, "must be a whole number or two, the least and the most: 3:5")
    return ends[0], ends[-1]


# ---------------------------------------------------------------------- what is shown


def _table(result: SearchResult) -> Iterator[str]:
    """A line for each set, under a heading, and what their members do."""
    for kind in dict.fromkeys(candidate.kind for candidate in result.found):
        roles = result.task.roles(kind)
        gears = ", ".join(next(each for each in result.found if each.kind is kind).teeth)
        yield f"type {kind.value}: {gears}; input {roles.input}, output {roles.output}, fixed {roles.fixed}"
    rows = [_HEADING, *(_row(candidate) for candidate in result.found)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        name, *numbers = row
        cells = (f"{cell:>{width}}" for cell, width in zip(numbers, widths[1:], strict=True))
        yield "  ".join((f"{name:<{widths[0]}}", *cells)).rstrip()


_HEADING = ("set", "ratio", "off %", "diameter mm", "a mm", "N", "q", "z mod N", "gcd", "efficiency", "error share")


def _row(each: Candidate) -> tuple[str, ...]:
    return (
        each.name,
        f"{each.ratio:.6g}",
        f"{each.deviation:+.3f}" if each.deviation else "0",
        f"{each.diameter:.2f}",
        f"{each.centre_distance:.3f}",
        str(each.planets),
        str(each.positions),
        " ".join(map(str, each.phases)),
        " ".join(map(str, each.common)),
        f"{each.efficiency:.4f}",
        f"{each.error_share:.2f}",
    )


def _remarks(result: SearchResult, output: Path | None) -> Iterator[str]:
    """How many more there are, what could not be made, and how to go on."""
    if result.left:
        yield f"{grouped(result.left)} more meet all conditions: --count"
    if result.unmade:
        yield f"{len(result.unmade)} could not be made; the first: {result.unmade[0]}"
    yield "a centre distance, N planets, on q places where their teeth fit; z mod N is 0 where they are in phase; gcd 1 is a"
    yield "hunting tooth; error share: of the load that an error of one planet brings, what is left while a central floats"
    yield "No set has backlash yet: planetary.tooth_thinning is 0 in the table"
    yield f"Next: gearcad batch {output}" if output is not None else "-o FILE.csv writes a design table for gearcad batch"


def _nothing(result: SearchResult) -> str:
    """One line: which condition removed what, and the ratios that are nearest."""
    kinds = ", ".join(kind.value for kind in result.task.types)
    took = ", ".join(f"{grouped(number)} by {name}" for name, number in result.removed.items() if number)
    text = f"No set of type {kinds} has ratio {result.task.ratio:g} within {result.task.tolerance:g} %"
    text += f": of {grouped(result.considered)} within the limits, removed {took}" if took else ": none is within the limits"
    if result.unmade:
        text += f", and {len(result.unmade)} could not be made: {result.unmade[0]}"
    nearest = " and ".join(f"{ratio:.6g}" for ratio in result.nearest)
    return text + (f"; nearest ratios {nearest}" if nearest else "")
