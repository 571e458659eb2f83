"""Base of all commands: one-line errors, exit statuses, common options."""

from __future__ import annotations

import errno
import signal
from collections.abc import Callable
from enum import Enum
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn, TypeVar

import click

from gearcad.cli.language import require_language, say
from gearcad.core.errors import GearcadError, ParameterError, SolverError, as_choice, out_of_memory, printable, shortened, shown
from gearcad.core.output import source_date
from gearcad.core.runtime import distribution_of
from gearcad.jobs import VERBS

__all__ = ["Commands", "debug_option", "job_commands", "parse_choices", "require_new_file", "spec_argument"]

Command = TypeVar("Command", bound=Callable[..., Any])
Choice = TypeVar("Choice", bound=Enum)

_LONGEST_USAGE, _LONGEST_LINE = 300, 1000
"""Largest number of characters in a message about wrong usage, which repeats what was typed, and in any line of a message."""

_LONGEST_FAULT = 500
"""Largest number of characters shown of an unexpected error."""

INTERRUPTED = 128 + signal.SIGINT
"""Exit status after Ctrl-C, that of a shell."""


_MODULES = {
    **dict.fromkeys(("new", "data", "open", "completion"), "basics"),
    **dict.fromkeys(("draw", "picture"), "build"),
    **dict.fromkeys(("study", "plot"), "batch"),
    **dict.fromkeys(("export", "import"), "exchange"),
    **dict.fromkeys(("check", "rate", "stiffness", "modify"), "strength"),
}
"""The module of `gearcad.cli` with a command, where it is not called as the command."""


_FUNCTIONS = {"import": "import_specs"}
"""The function of a command, where it is not called as the command."""


class Commands(click.Group):
    """A group whose commands end with one line instead of a traceback, and with the exit status that fits."""

    def list_commands(self, _ctx: click.Context) -> list[str]:
        """Return the names of the commands in the order of use, not in alphabetical order."""
        beside = ["size", "identify", "tools", "export", "import", "study", "batch", "plot", "open", "doctor", "completion"]
        return ["new", *job_commands(), "wear", *beside]

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """Return a command, whose module is imported now: a command is as quick to start as what it needs."""
        if name not in self.list_commands(ctx):
            return None
        found: click.Command = getattr(import_module(f"gearcad.cli.{_MODULES.get(name, name)}"), _FUNCTIONS.get(name, name))
        return found

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; raises SystemExit by way of `ctx.exit`."""
        try:
            require_language(ctx)
            source_date()  # a date that is none is told before any work
            return super().invoke(ctx)
        except click.UsageError as error:
            say(f"Error: {shortened(error.format_message(), _LONGEST_USAGE)}", err=True)
            ctx.exit(2)
        except (click.ClickException, click.Abort, click.exceptions.Exit):
            raise
        except KeyboardInterrupt:
            _leave_interrupted(ctx)
        except Exception as error:
            if isinstance(error, OSError) and error.errno == errno.EPIPE:
                raise  # click ends quietly when the reader of a pipe has gone
            if _interrupted(error):
                _leave_interrupted(ctx)
            if ctx.meta.get("gearcad.debug"):
                raise
            if isinstance(error, GearcadError):
                lines = (shortened(line, _LONGEST_LINE) for line in str(error).split("\n"))
                say("".join(f"Error: {line}\n" for line in lines), err=True, nl=False)
                ctx.exit(1 if isinstance(error, SolverError) else 2)
            if isinstance(error, ModuleNotFoundError) and (error.name or "gearcad").partition(".")[0] != "gearcad":
                say(f"Error: {_missing(str(error.name))}", err=True)
                ctx.exit(1)
            if isinstance(error, OSError):  # the system's fault, such as a full disk behind stdout
                say(f"Error: {printable(error.strerror or str(error))}", err=True)
                ctx.exit(1)
            if isinstance(error, MemoryError):
                say(f"Error: {out_of_memory(error)}", err=True)
                ctx.exit(1)
            what = shown(" ".join(f"{type(error).__name__}: {error}".split()), _LONGEST_FAULT)
            say(f"Error: unexpected {what} (a fault of gearcad: please report it, with what --debug shows)", err=True)
            ctx.exit(1)


def _missing(module: str) -> str:
    """Return the sentence for a module that is not installed, with the command that installs it."""
    package = distribution_of(module)
    return f"the package {package} is not installed, and this command needs it: pip install {package}"


def _leave_interrupted(ctx: click.Context) -> NoReturn:
    say("Aborted!", err=True)
    ctx.exit(INTERRUPTED)


def _interrupted(error: BaseException | None) -> bool:
    """True for an error that began as Ctrl-C: an extension module that is being imported turns one into the other."""
    seen: set[int] = set()
    while error is not None and id(error) not in seen:
        if isinstance(error, KeyboardInterrupt):
            return True
        seen.add(id(error))
        error = error.__cause__ or error.__context__
    return False


def job_commands() -> tuple[str, ...]:
    """Return the jobs that are commands: all of them."""
    return VERBS


def debug_option(command: Command) -> Command:
    def remember(ctx: click.Context, _parameter: click.Parameter, value: bool) -> None:
        # `meta` is shared by a command and its group, so the option works in both places.
        ctx.meta["gearcad.debug"] = ctx.meta.get("gearcad.debug", False) or value

    option = click.option(
        "--debug", is_flag=True, expose_value=False, callback=remember, help="Show the traceback of an error."
    )
    return option(command)


def spec_argument(command: Command) -> Command:
    return click.argument("spec", type=click.Path(path_type=Path))(command)


def parse_choices(parameter: str, text: str, kind: type[Choice]) -> tuple[Choice, ...]:
    """Members of an enum from a comma-separated list of their values; raises ParameterError."""
    return tuple(as_choice(parameter, name.strip().lower(), kind) for name in text.split(","))


def require_new_file(path: Path, force: bool) -> None:
    """Raise ParameterError for the name of a folder, and without `force` for that of a file that exists."""
    if path.is_dir():
        raise ParameterError("output", str(path), "is a folder; give the name of a file")
    if (path.exists() or path.is_symlink()) and not force:
        raise ParameterError("output", str(path), "exists; give another name, or --force to replace it")
