"""Commands `new`, `data`, `open` and `completion`."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from gearcad.cli.group import debug_option, require_new_file, spec_argument
from gearcad.cli.job import json_option, shows_styles, window_width
from gearcad.cli.language import say, translated
from gearcad.core.records import Notice, texts
from gearcad.core.symbols import Symbol
from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.sheet import Block, Row, Section, Sheet, sheet_of

if TYPE_CHECKING:
    from rich.console import Console


VARIABLE = "_GEARCAD_COMPLETE"
"""Environment variable by which a shell asks for completions."""


@click.command(short_help="Print what lets a shell complete commands.")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
@debug_option
def completion(ctx: click.Context, shell: str) -> None:
    """Print what lets SHELL complete commands, options and names of files. One line where the shell begins turns it on:

    \b
      ~/.bashrc                      source <(gearcad completion bash)
      ~/.zshrc                       source <(gearcad completion zsh)
      ~/.config/fish/config.fish     gearcad completion fish | source
    """
    from click.shell_completion import get_completion_class

    kind = get_completion_class(shell)
    assert kind is not None  # all choices have one
    click.echo(kind(ctx.find_root().command, {}, "gearcad", VARIABLE).source())


def _names(_ctx: click.Context, _parameter: click.Parameter, begun: str) -> list[str]:
    """Return the names of starters that complete the text typed so far."""
    from gearcad.designs.reader import starters

    return [name for name in starters() if name.startswith(begun)]


@click.command()
@click.argument("kind", required=False, shell_complete=_names)
@click.option("-o", "--output", metavar="FILE", help="Where to write it; - prints it.  [default: its own name here]")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@debug_option
def new(kind: str | None, output: str | None, force: bool) -> None:
    """Write a commented starter: a spec of one design, a table of many, or a workflow for continuous integration (ci).

    KIND is the name of a starter or its beginning; without it the starters are listed.
    """
    from gearcad.designs.reader import starter_texts, starters

    if kind is None:
        found = starters()
        width = max(map(len, found)) + 2
        say("".join(f"{name:<{width}}{what}\n" for name, what in found.items()), nl=False)
        return
    from gearcad.core.errors import ParameterError

    texts = starter_texts(kind)
    if len(texts) > 1 and output not in (None, "-"):
        one = " or ".join(f"gearcad new {Path(name).stem}" for name in texts)
        raise ParameterError("output", output, f"must be left out: {kind} is {len(texts)} files; one of them: {one}")
    paths = {name: Path(output or name) for name in texts}
    if output == "-":
        click.echo("".join(texts.values()), nl=False)
        return
    for path in paths.values():
        require_new_file(path, force)
    for name, path in paths.items():
        _write_new(path, texts[name], force)
        click.echo(path)
    name, path = next(iter(paths.items()))
    say(f"Next: {_next(name, texts[name], path)}", err=True)


def _next(name: str, text: str, path: Path) -> str:
    """The command that shows most of what a starter is; a template of drawings is named in specs."""
    if name.startswith("drawing_"):
        return f'keep what you change, and name it in a spec: [drawing] template = "{path}"'
    if name.startswith("ci-"):
        return "put that of your server where its first lines say, beside a design table (gearcad new pairs) for gearcad verify"
    if name.endswith(".csv"):
        return f"gearcad batch {path}"
    commands = {"train": "dynamics", "planetary": "planetary", "measured": "identify"}
    if "\nsegments = [" in text:
        return f"gearcad shafts {path}"
    command = next((command for table, command in commands.items() if f"\n[{table}]\n" in text), "data")
    return f"gearcad {command} {path}"


def _write_new(path: Path, text: str, force: bool) -> None:
    from gearcad.core.output import staged_files

    require_new_file(path, force)
    with staged_files(path.parent) as staging:
        (staging / path.name).write_text(text, encoding="utf-8", newline="\n")


@click.command("open")
@click.argument("spec", type=click.Path(path_type=Path), required=False)
@click.option("--host", metavar="ADDRESS", help="Listen at this address of the machine, for others who have the token.")
@click.option("--port", type=click.IntRange(1, 65535), help="Where it listens.  [default: 8765, or the next that is free]")
@click.option(
    "--token",
    metavar="TEXT",
    envvar="GEARCAD_TOKEN",
    show_envvar=True,
    help="Token for scripts, at least 16 characters; only the variable is hidden from other accounts.  [default: a new one]",
)
@click.option("--no-browser", is_flag=True, help="Only print the address.")
@click.option("--time-limit", type=float, metavar="S", help="Longest time of one run, in seconds.  [default: 3600]")
@click.option(
    "--memory-limit", type=float, metavar="GB", help="Most memory of one run.  [default: half of the machine's, at most 16 GB]"
)
@debug_option
def open(
    spec: Path | None,
    host: str | None,
    port: int | None,
    token: str | None,
    no_browser: bool,
    time_limit: float | None,
    memory_limit: float | None,
) -> None:
    """Open a page in the browser in which the gears move: every change of SPEC is seen at once. Without SPEC the page begins
    with a task (torque, ratio, speed, life, material), a starter, or a measured gear.

    It listens at 127.0.0.1 only, unless --host is given, until Ctrl-C. Only a browser that has opened the address printed, with
    its token, may read and save: the token becomes a cookie, and leaves the address.
    """
    from gearcad.designs.design import spec_text
    from gearcad.page.folder import NEW
    from gearcad.page.runs import GIGABYTE, RunLimits, Runs
    from gearcad.page.server import serve

    given = {"seconds": time_limit, "memory": None if memory_limit is None else memory_limit * GIGABYTE}
    Runs.permitted = RunLimits(**{name: value for name, value in given.items() if value is not None})
    text, spec = ("", Path(NEW)) if spec is None else (spec_text(spec), spec)
    serve(text, spec.stem, spec.parent, host=host, port=port, browser=not no_browser, token=token)


_WIDE = 96
"""Console width from which the column of sources fits."""

_WIDTH = 12
"""Least number of characters in a column of values."""

_TRAIN_WORDS, _TRAIN_UNIT = 50, 9
"""Widths of columns on the sheet of a train; one of values is as wide as its longest."""

_NOTHING = Symbol("", "", "", "")


class _Line(NamedTuple):
    """One line of the sheet and its style on a terminal."""

    text: str
    style: str = ""


def plain_datasheet(design: Design, width: int) -> str:
    """The sheet as `print_datasheet` prints it on what knows no styles, for a window of so many characters."""
    return "".join(f"{line.text}\n" for line in _lines(design, wide=width >= _WIDE))


def print_datasheet(design: Design, console: Console) -> None:
    """Print the sheet: a column per gear, then the pair, material, load, mounting and rating, then the warnings."""
    from rich.text import Text

    for line in _lines(design, wide=console.width >= _WIDE):
        # Soft wrap: a narrow window may break a line, but never cut a number.
        console.print(Text(translated(line.text), style=line.style), soft_wrap=True)


def _lines(design: Design, *, wide: bool) -> Iterator[_Line]:
    sheet = sheet_of(design)
    clauses = sheet.clauses if wide else ""
    yield _Line(f"{sheet.name}: {sheet.title}", "bold")
    yield _Line(", ".join(filter(None, (sheet.units, clauses))), "dim")
    yield _Line("")
    yield from _train_lines(sheet) if design.kind is DesignKind.TRAIN else _usual_lines(sheet, with_source=bool(clauses))
    yield from _warnings(sheet.notices)


def _usual_lines(sheet: Sheet, *, with_source: bool) -> Iterator[_Line]:
    for section in sheet.sections:
        width = max(_WIDTH, *(len(name) + 2 for name in section.columns), 0)
        if section.columns:
            yield _Line(_columns(_NOTHING, section.columns, width), "bold")
        for title, rows in section.blocks:
            yield _Line(title, "bold cyan")
            for row in rows:
                yield _Line(_columns(row.symbol, row.texts, width, with_source=with_source))
            yield _Line("")


def _columns(symbol: Symbol, values: Iterable[str], width: int, *, with_source: bool = False) -> str:
    """One line of 76 characters, or some more with the source behind."""
    first, *others = (f"{value:>{width}}" for value in values)
    numbers = "".join([first, *(each if len(each) <= width else f"  {each}" for each in others)])
    line = f"  {symbol.words:<37}{symbol.symbol:<6} {symbol.unit:<6}{numbers}"
    return f"{line:<{max(80, len(line) + 2)}}{symbol.source}".rstrip() if with_source else line.rstrip()


def _train_lines(sheet: Sheet) -> Iterator[_Line]:
    """A train's parts have names of their own, which stand above the columns of each block."""
    for section in sheet.sections:
        for block in section.blocks:
            yield from _train_block(section, block)


def _train_block(section: Section, block: Block) -> Iterator[_Line]:
    names = section.columns or ("",)
    columns = zip(names, *(row.texts for row in block.rows), strict=True)
    widths = [max(_WIDTH, *(len(each) + 2 for each in column)) for column in columns]
    yield _Line(_train_line(block.title, Row("", _NOTHING, (), names), widths), "bold cyan")
    for row in block.rows:
        yield _Line(_train_line(f"  {row.symbol.words}", row, widths))
    yield _Line("")


def _train_line(words: str, row: Row, widths: list[int]) -> str:
    cells = "".join(f"{value:>{width}}" for value, width in zip(row.texts, widths, strict=True))
    return f"{words:<{_TRAIN_WORDS}} {row.symbol.symbol:<6}{row.symbol.unit:<{_TRAIN_UNIT}}{cells}".rstrip()


def _warnings(notices: tuple[Notice, ...]) -> Iterator[_Line]:
    said = texts(notices)
    if not said:
        yield _Line("No warnings.", "green")
        return
    yield _Line(f"Warnings ({len(said)})", "bold yellow")
    for warning in said:
        yield _Line(f"  {warning}", "yellow")


@click.command()
@spec_argument
@json_option
@debug_option
def data(spec: Path, as_json: bool) -> None:
    """Show the geometry of SPEC: every derived quantity, and warnings."""
    from gearcad.core.output import json_text
    from gearcad.designs.reader import read_spec
    from gearcad.jobs.job import Data

    job = Data()
    design = job.run(read_spec(spec))
    if as_json:
        click.echo(json_text(job.complete_document(design)), nl=False)
        return

    if not shows_styles(sys.stdout):
        say(plain_datasheet(design, window_width()), nl=False)
        return
    from rich.console import Console

    print_datasheet(design, Console(highlight=False))
