"""What the screen shows of a rating: safeties, factors, what was assumed, what to verify, the verdict."""

from __future__ import annotations

import math
import os
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import click

from gearcad.cli.job import echo_warnings
from gearcad.cli.train_strength import train_strength_lines

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.strength import TrainStrength
    from gearcad.rating.strength import StrengthRating

__all__ = ["print_strength", "strength_lines", "verdict_line"]

_WIDTH = 110
_LONGEST_LIFE = 1e6
"""Hours above which a life is told as more than that."""

_GROUPS = {
    "load factors": "K_A K_gamma K_v K_Hbeta K_Fbeta K_Halpha K_Falpha",
    "contact stress": "Z_H Z_E Z_eps Z_beta Z_B Z_D",
    "flanks bear": "Z_NT Z_L Z_v Z_R Z_W Z_X",
    "root stress": "Y_F Y_S Y_beta Y_B Y_DT",
    "roots bear": "Y_ST Y_NT Y_delta_relT Y_RrelT Y_X Y_M",
}


def print_strength(name: str, result: StrengthRating | TrainStrength) -> None:
    """All of a rating, or of those of the meshes of a train, its notices, and the verdict."""
    from gearcad.jobs.rate import load_words
    from gearcad.rating.strength import StrengthRating

    if isinstance(result, StrengthRating):
        click.echo("\n".join(strength_lines(result)))
    else:
        for mesh, rating in result.meshes.items():
            click.echo("\n".join([f"{mesh}: {load_words(rating)}", *strength_lines(rating)]))
        click.echo("\n".join(train_strength_lines(result, verdict=False)))
    echo_warnings(result.notices)
    colour = {True: "green", False: "red", None: "yellow"}[result.passed]
    click.secho(verdict_line(name, result), fg=None if os.environ.get("NO_COLOR") else colour, bold=True)


def verdict_line(name: str, result: StrengthRating | TrainStrength) -> str:
    """What a rating comes to."""
    from gearcad.jobs.rate import Rate

    return Rate().conclusion(name, result)


def strength_lines(rating: StrengthRating) -> Iterator[str]:
    """All but notices and verdict, line by line."""
    document, names = rating.to_dict(), tuple(rating.names)
    yield f"{document['standard']}, {rating.options.accuracy.value}"
    yield _row("", (*rating.gear_names, "required"))
    yield from _safeties(document, names)
    yield from _wrapped("spectrum", [rating.told_load], "; ")
    yield from _wrapped("scuffing", _scuffing(rating))
    for words, symbols in _GROUPS.items():
        yield from _wrapped(words, (_factor(symbol, document["factors"].get(symbol), names) for symbol in symbols.split()))
    for words, key in (("assumed", "assumed"), ("verify", "verify")):
        yield from _wrapped(words, document[key], "; ")
    yield from _wrapped("not judged", _not_judged(document["not_judged"]), "; ")


def _not_judged(reasons: Mapping[str, str]) -> Iterator[str]:
    """Each reason once, with all that it is of."""
    for why in dict.fromkeys(reasons.values()):
        yield f"{', '.join(what for what, of in reasons.items() if of == why)}: {why}"


def _safeties(document: Mapping[str, Any], names: tuple[str, ...]) -> Iterator[str]:
    """Safety, stress, strength, torque and life, of flanks and roots."""
    for part, index in (("flank", "H"), ("root", "F")):
        required = document["required"][part]
        yield _row(f"S_{index}, {part}", (*(_text(document["safety"][part][name]) for name in names), _text(required)))
        for symbol, words in ((f"sigma_{index}", "stress"), (f"sigma_{index}G", "strength")):
            yield _row(f"  {symbol}, {words} (MPa)", [_text(document["stresses"][symbol][name]) for name in names])
        yield _row("  permissible torque (N·m)", [_text(document["permissible_torque"][part][name]) for name in names])
        yield _row("  life at the required safety (h)", [_hours(document["life"][part][name]) for name in names])


def _scuffing(rating: StrengthRating) -> Iterator[str]:
    found = rating.scuffing
    if found is None:
        return
    safeties = {"S_int": found.integral_safety, "S_B": found.flash_safety}
    yield from (f"{symbol} {_text(value)}" for symbol, value in safeties.items() if value is not None)
    if found.risk is not None:
        yield f"risk {found.risk.value}"
    if found.reason:
        yield f"not judged: {found.reason}"


def _factor(symbol: str, value: Any, names: tuple[str, ...]) -> str:
    """One number, or those of both gears where they differ; nothing for what is not known."""
    if isinstance(value, Mapping):
        both = list(dict.fromkeys(_text(value[name]) for name in names))
        return f"{symbol} {' / '.join(both)}"
    return "" if value is None else f"{symbol} {_text(value)}"


def _row(words: str, cells: Iterable[str]) -> str:
    return f"{words:<34}" + "".join(f"{cell:>12}" for cell in cells)


def _wrapped(words: str, items: Iterable[str], between: str = "  ") -> Iterator[str]:
    text = between.join(item.replace(" ", "\0") if between == "  " else item for item in items if item)
    if text:
        lines = textwrap.wrap(text, _WIDTH - 16, break_long_words=False, break_on_hyphens=False)
        yield from (f"{words if not at else '':<16}{line}".replace("\0", " ") for at, line in enumerate(lines))


def _text(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _hours(value: float | str | None) -> str:
    """A life in hours; beyond all machines no digits are told."""
    if isinstance(value, float) and math.isfinite(value) and value > _LONGEST_LIFE:
        return f"> {_LONGEST_LIFE:.0e}".replace("e+0", "e")
    return value if isinstance(value, str) else _text(value)
