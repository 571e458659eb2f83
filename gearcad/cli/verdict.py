"""What the screen shows of a check: its comparisons, what to know before trusting it, and the verdict."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from gearcad.check.comparison import Comparison, ComparisonRole
from gearcad.cli.job import echo_warnings

if TYPE_CHECKING:
    from gearcad.check.result import CheckResult

__all__ = ["print_verdict", "verdict_line"]

_WIDE = 130
"""Console width from which the column of sources fits."""

_LEAST = (7, 42, 9, 9, 9, 9, 8)
"""Least widths of the columns but the last."""

_TO_THE_RIGHT = (2, 3, 5, 6)
"""Columns of numbers."""

_WORDS = (
    "ok, FAILED: gates, which decide. in band, OUTSIDE: information; how far it may be from ISO 6336 is set in [check] "
    "(root_band, stiffness_band, contact_band) and decides nothing. reached, BELOW: safeties by finite elements beside those "
    "required: the standard's decide."
)
_LOCAL = " below, ABOVE: the local pressure where a linear relief starts, beside the contact limit: no gate."


class _Line(NamedTuple):
    cells: tuple[str, ...]
    style: str = ""


def print_verdict(name: str, result: CheckResult) -> None:
    """The comparisons, gates first, what could not be evaluated, notices, and the verdict on numerics and strength."""
    from rich.console import Console
    from rich.text import Text

    console = Console(highlight=False)
    heading = _Line(("", "quantity", "computed", "reference", "unit", "deviation", "permitted", "source"), "bold")
    rows = [heading, *(_row(each) for each in result.comparisons)]
    if console.width < _WIDE:
        rows = [_Line(row.cells[:-1], row.style) for row in rows]
    lines = [*_aligned(rows), (_WORDS + _LOCAL * bool(result.relief_starts), "")]
    lines += [(f"Not evaluated: {', '.join(quantities)}: {reason}", "yellow") for reason, quantities in _reasons(result)]
    for text, style in lines:
        # Soft wrap: a narrow window may break a line, but never cut a number.
        console.print(Text(text, style=style), soft_wrap=True)
    echo_warnings(result.all_notices)
    console.print(Text(verdict_line(name, result), style="bold green" if result.passed else "bold red"), soft_wrap=True)


def verdict_line(name: str, result: CheckResult) -> str:
    """What a check comes to."""
    from gearcad.jobs.check import Check

    return Check().conclusion(name, result)


def _row(of: Comparison) -> _Line:
    """A comparison; a limit is told by how much of it is used up."""
    gate = of.role is ComparisonRole.GATE
    good, bad = ("ok", "FAILED") if gate else ("reached", "BELOW") if of.least else ("in band", "OUTSIDE")
    if not gate and of.tolerance is None and not of.least:
        good, bad = "below", "ABOVE"
    word = good if of.passed else bad if gate or of.evaluated else "-"
    if of.deviation is None:
        deviation = "-"
    else:
        deviation = f"{100 * (1 + of.deviation):.4g} %" if of.tolerance is None else f"{100 * of.deviation:+.2f} %"
    limit = "at least" if of.least else "of limit"
    permitted = limit if of.tolerance is None else f"±{100 * of.tolerance:g} %"
    figures = ("-" if value is None else f"{value:.5g}" for value in (of.computed, of.reference))
    cells = (word, of.quantity, *figures, of.unit, deviation, permitted, of.source.split(":")[0])
    return _Line(cells, "" if of.passed else "bold red" if gate else "yellow")


def _reasons(result: CheckResult) -> Iterable[tuple[str, list[str]]]:
    """Why quantities were not evaluated, each reason once."""
    found: dict[str, list[str]] = {}
    for each in result.comparisons:
        if not each.evaluated:
            found.setdefault(each.reason, []).append(each.quantity)
    return found.items()


def _aligned(rows: list[_Line]) -> list[tuple[str, str]]:
    """Lines and styles, columns as wide as what stands in them."""
    widths = [max(map(len, column)) for column in zip(*(row.cells for row in rows), strict=True)]
    widths[: len(_LEAST)] = map(max, widths, _LEAST)
    found = []
    for cells, style in rows:
        padded = (
            cell.rjust(width) if at in _TO_THE_RIGHT else cell.ljust(width)
            for at, (cell, width) in enumerate(zip(cells, widths, strict=True))
        )
        found.append(("  ".join(padded).rstrip(), style))
    return found
