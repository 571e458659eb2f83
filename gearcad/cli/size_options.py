"""Options of the command `size`, of pairs and of planetary sets."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import click

from gearcad.core.errors import ParameterError
from gearcad.jobs.set_size_options import SET_OPTIONS
from gearcad.jobs.size_options import SIZE_OPTIONS

Command = TypeVar("Command", bound=Callable[..., Any])

_SECOND = "Modules of ISO 54 series II within a range, too."
_RATING = "Any key of [rating], such as helix_modification=crowning; repeat it."


def size_options(command: Command) -> Command:
    """The options of a task."""
    command = click.option("--rating", "rating", multiple=True, metavar="KEY=VALUE", help=_RATING)(command)
    command = click.option("--second-series", is_flag=True, help=_SECOND)(command)
    for option in reversed(SIZE_OPTIONS):
        name = f"--{option.name.replace('_', '-')}"
        command = click.option(name, option.name, type=option.type, metavar=option.metavar, help=option.help)(command)
    return command


def set_options(command: Command) -> Command:
    """The options of planetary sets."""
    for option in reversed(SET_OPTIONS):
        name, text = f"--{option.name.replace('_', '-')}", f"Sets: {option.help}"
        command = click.option(name, option.name, type=option.type, metavar=option.metavar, help=text)(command)
    text = "Planetary sets in place of pairs; speed of the input."
    return click.option("--planetary", is_flag=True, help=text)(command)


def require_no_sets(given: Mapping[str, Any]) -> None:
    """Raise ParameterError for an option of sets where pairs are wanted."""
    for option in SET_OPTIONS:
        if given[option.name] is not None:
            raise ParameterError(option.name, given[option.name], "applies to planetary sets only: needs --planetary")
