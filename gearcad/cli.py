"""The commands. Results on stdout, progress and messages on stderr; exit status 0, 1 (fell short) or 2 (wrong input)."""

from __future__ import annotations

import errno
import io
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

import gearcad
from gearcad.errors import GearcadError, ParameterError, SolverError, as_choice

if TYPE_CHECKING:
    from gearcad.build import Format, Progress
    from gearcad.spec.design import Design

__all__ = ["main"]

Command = TypeVar("Command", bound=Callable[..., Any])

_EXAMPLE = """\b
Three commands from nothing to a pair of gears:
  gearcad new pair                  writes volvo-13-44.toml, full of comments
  gearcad data volvo-13-44.toml     shows the geometry
  gearcad build volvo-13-44.toml    writes STEP and STL to output/volvo-13-44/
"""


class _Commands(click.Group):
    """A group whose commands end with one line instead of a traceback, and with the exit status that fits."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """In the order of use, not of the alphabet."""
        return list(self.commands)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; raises SystemExit by way of `ctx.exit`."""
        try:
            return super().invoke(ctx)
        except click.UsageError as error:
            click.echo(f"Error: {error.format_message()}", err=True)
            ctx.exit(2)
        except (click.ClickException, click.Abort, click.exceptions.Exit):
            raise
        except Exception as error:
            if isinstance(error, OSError) and error.errno == errno.EPIPE:
                raise  # click ends quietly when the reader of a pipe has gone
            if _interrupted(error):
                raise click.Abort from error
            if ctx.meta.get("gearcad.debug"):
                raise
            if isinstance(error, GearcadError):
                click.echo(f"Error: {error}", err=True)
                ctx.exit(1 if isinstance(error, SolverError) else 2)
            if isinstance(error, OSError):  # the system's fault, such as a full disk behind stdout
                click.echo(f"Error: {error.strerror or error}", err=True)
                ctx.exit(1)
            what = " ".join(f"{type(error).__name__}: {error}".split())
            click.echo(f"Error: unexpected {what} (a fault of gearcad: please report it, with what --debug shows)", err=True)
            ctx.exit(1)


def _interrupted(error: BaseException | None) -> bool:
    """True for an error that began as Ctrl-C: an extension module that is being imported turns one into the other."""
    seen: set[int] = set()
    while error is not None and id(error) not in seen:
        if isinstance(error, KeyboardInterrupt):
            return True
        seen.add(id(error))
        error = error.__cause__ or error.__context__
    return False


def _debug_option(command: Command) -> Command:
    def remember(ctx: click.Context, _parameter: click.Parameter, value: bool) -> None:
        # `meta` is shared by a command and its group, so the option works in both places.
        ctx.meta["gearcad.debug"] = ctx.meta.get("gearcad.debug", False) or value

    option = click.option(
        "--debug", is_flag=True, expose_value=False, callback=remember, help="Show the traceback of an error."
    )
    return option(command)


def _spec_argument(command: Command) -> Command:
    return click.argument("spec", type=click.Path(path_type=Path))(command)


@click.group(cls=_Commands, epilog=_EXAMPLE, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(gearcad.__version__, prog_name="gearcad")
@_debug_option
def main() -> None:
    """Exact cylindrical gears from a handful of numbers: data sheet, STEP, STL and more.

    A gear or a pair is described in a SPEC, a short TOML file. Lengths are in mm, angles in degrees.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # an old terminal shows ? for a Greek letter, and goes on


@main.command()
@click.argument("kind", required=False)
@click.option("-o", "--output", metavar="FILE", help="Where to write it; - prints it.  [default: KIND.toml here]")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@_debug_option
def new(kind: str | None, output: str | None, force: bool) -> None:
    """Write a commented starter spec.

    KIND is the name of a starter or its beginning; without it the starters are listed.
    """
    from gearcad.spec.starters import starter_text, starters

    if kind is None:
        click.echo("".join(f"{name:<14}{what}\n" for name, what in starters().items()), nl=False)
        return
    name, text = starter_text(kind)
    if output == "-":
        click.echo(text, nl=False)
        return
    path = Path(output or f"{name}.toml")
    _write_new(path, text, force)
    click.echo(path)
    click.echo(f"Next: gearcad data {path}", err=True)


def _write_new(path: Path, text: str, force: bool) -> None:
    from gearcad.output import staged_files

    if path.is_dir():
        raise ParameterError("output", str(path), "is a folder; give the name of a file")
    if path.exists() and not force:
        raise ParameterError("output", str(path), "exists; give another name, or --force to replace it")
    with staged_files(path.parent) as staging:
        (staging / path.name).write_text(text, encoding="utf-8")


@main.command()
@_spec_argument
@click.option("--json", "as_json", is_flag=True, help="Print the document of data.json and nothing else.")
@_debug_option
def data(spec: Path, as_json: bool) -> None:
    """Show the geometry of SPEC: every derived quantity, and warnings."""
    from gearcad.output import json_text
    from gearcad.spec import read_spec

    design = read_spec(spec)
    if as_json:
        click.echo(json_text(design.to_dict()), nl=False)
        return
    from rich.console import Console

    from gearcad.datasheet import print_datasheet

    print_datasheet(design, Console(highlight=False))


@main.command(short_help="Write the solids of SPEC as STEP, STL and other files.")
@_spec_argument
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder.  [default: output/NAME]")
@click.option(
    "--format", "formats", default="step,stl", show_default=True, help="Comma-separated list of step, stl, 3mf, glb, dxf, csv."
)
@click.option("--chord-error", default=0.005, show_default=True, metavar="MM", help="Largest error of the facets, in mm.")
@click.option("--bracket", is_flag=True, help="Put the assembly on two shafts with a bracket (STEP).")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document: the files and the warnings.")
@click.option("--quiet", is_flag=True, help="No progress and no warnings on the screen.")
@_debug_option
def build(spec: Path, output: Path | None, formats: str, chord_error: float, bracket: bool, as_json: bool, quiet: bool) -> None:
    """Write the solids of SPEC: pinion.step, wheel.stl, assembly.step ... and data.json.

    \b
    step  the exact solid          stl       facets within --chord-error
    3mf   facets, for printing     glb       facets, for viewers
    dxf   exact section, for cutting         csv  points of flank and fillet
    """
    from gearcad.build import build as build_files
    from gearcad.output import json_text
    from gearcad.spec import read_spec

    wanted = _formats(formats)
    design = read_spec(spec)
    folder = output if output is not None else Path("output") / design.name
    with _progress(shown=not quiet) as progress:
        files = build_files(design, folder, wanted, bracket=bracket, chord_error=chord_error, progress=progress)
    if as_json:
        document = {"kind": "build", "name": design.name, "gearcad": gearcad.__version__, "output": str(folder)}
        click.echo(json_text({**document, "files": [str(file) for file in files], "warnings": list(design.warnings)}), nl=False)
    else:
        click.echo("".join(f"{file}\n" for file in files), nl=False)
    _echo_warnings(design, shown=not quiet)


def _formats(text: str) -> list[Format]:
    from gearcad.build import Format

    return [as_choice("format", name.strip().lower(), Format) for name in text.split(",")]


def _echo_warnings(design: Design, *, shown: bool) -> None:
    for warning in design.warnings if shown else ():
        click.echo(f"Warning: {warning}", err=True)


@contextmanager
def _progress(*, shown: bool) -> Iterator[Progress | None]:
    """A progress bar on stderr; plain lines where that is no terminal."""
    if not shown:
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda file, done, total: click.echo(f"[{done + 1}/{total}] {file}", err=True)
        return
    columns = (TextColumn("{task.description:<15}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None)
        yield lambda file, done, total: bar.update(task, description=file, completed=done, total=total)
