"""Language of what commands say: `say` prints a text in the language that `--language` names; files and JSON are not said."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import click

from gearcad.core.errors import require_one_of
from gearcad.core.messages import LANGUAGES

if TYPE_CHECKING:
    from collections.abc import Callable

    from gearcad.core.messages import Catalogue


_KEY = "gearcad.language"
"""Key under which a context of click and those of its commands keep the language."""

_GAP = re.compile(r"( {2,})")
"""Space between columns on the screen."""


def language_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option of the language to a group of commands. `require_language` says whether there is such a language."""

    def remember(ctx: click.Context, _parameter: click.Parameter, value: str) -> None:
        ctx.meta[_KEY] = value

    return click.option(
        "--language",
        metavar="LANGUAGE",
        default=LANGUAGES[0],
        expose_value=False,
        callback=remember,
        help="Language of messages: en or de; drawings have a key of their own.",
    )(command)


def require_language(ctx: click.Context) -> None:
    """Raise ParameterError if the language that was asked for is none of ours."""
    asked = ctx.meta.get(_KEY, LANGUAGES[0])
    ctx.meta[_KEY] = asked if asked in LANGUAGES else LANGUAGES[0]  # of the message itself
    require_one_of("language", asked, LANGUAGES)


def say(text: str, *, err: bool = False, nl: bool = True, **style: Any) -> None:
    """Print a text in the language of the command, styled as by `click.secho`."""
    click.secho(translated(text), err=err, nl=nl, **style)


def translated(text: str) -> str:
    """Return the lines of a text in the language of the command; columns keep their places as far as they can."""
    catalogue = _catalogue()
    return text if catalogue is None else "\n".join(_line(line, catalogue) for line in text.split("\n"))


def _catalogue() -> Catalogue | None:
    """Return the catalogue of the command's language, which is read when it is first needed; None for English."""
    ctx = click.get_current_context(silent=True)
    language = LANGUAGES[0] if ctx is None else ctx.meta.get(_KEY, LANGUAGES[0])
    if language == LANGUAGES[0]:
        return None
    from gearcad.core.messages import catalogue

    return catalogue(language)


def _line(line: str, catalogue: Catalogue) -> str:
    """Return a line whose columns, which have two spaces between them at least, are translated one by one."""
    if not _GAP.search(line.strip()):
        return catalogue.text(line)
    told, due = "", 0
    for part in _GAP.split(line):
        if _GAP.fullmatch(part):
            due += len(part)
            told += " " * max(due - len(told), min(len(part), 2) if told else len(part))
        else:
            due += len(part)
            told += catalogue.text(part)
    return told
