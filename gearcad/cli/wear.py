"""Command `wear`: how a pair wears step by step, and what the worn pair is under load."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import echo_warnings, json_option, output_option, perform, quiet_option
from gearcad.cli.language import say

if TYPE_CHECKING:
    from gearcad.check.wear import WearResult

_SHOWN = 8
"""Rows of the table on the screen, the first and the last state among them."""


@click.command(short_help="Wear of SPEC's pair step by step: profile, sharing, life until a loss.")
@spec_argument
@output_option
@click.option("--loss", type=float, metavar="UM", help="Depth (µm) at which the wear ends.  [default: 0.1 m_n]")
@click.option("--steps", type=int, default=50, show_default=True, metavar="N", help="Steps until then, at the least.")
@click.option("--positions", type=int, default=30, show_default=True, metavar="N", help="Over one base pitch.")
@json_option
@quiet_option
@debug_option
def wear(spec: Path, output: Path | None, loss: float | None, steps: int, positions: int, as_json: bool, quiet: bool) -> None:
    """Wear the spur gears of SPEC under their [load], step by step, until a flank has lost --loss.

    Archard's law takes k_w times force times sliding off each place of a flank (wear_coefficient of [material], in mm³/(N·m)),
    by the pressures of our own contact in the plane. After each step the pair is pressed again: load sharing, transmission
    error and root stress are those of the worn teeth. A gear without a coefficient does not wear.

    Writes wear.json (states and profiles) and wear.html.
    """
    from gearcad.jobs.wear import Wear

    perform(Wear(loss=loss, steps=steps, positions=positions), spec, output, _show, as_json=as_json, quiet=quiet)


def _show(_name: str, result: WearResult) -> None:
    """Print some of the states, the notices and the life."""
    say("\n".join(wear_lines(result)))
    echo_warnings(result.notices)
    say(result.conclusion, bold=True)


def wear_lines(result: WearResult) -> Iterator[str]:
    """Yield a table of some of the states, and the depth after the load cycles that are asked for beside that of VDI 2736-2."""
    yield f"{'':>14}{'depth':>20}{'T.E.':>10}{'contact':>10}{'root tension':>20}"
    units = f"{'µm':>20}{'µm':>10}{'ratio':>10}{'MPa':>20}"
    yield f"{'load cycles':>14}{units}"
    last = len(result.states) - 1
    for at in sorted({round(last * part / (_SHOWN - 1)) for part in range(_SHOWN)}):
        state = result.states[at]
        depth, root = (" / ".join(f"{each:.4g}" for each in both) for both in (state.depth, state.root_stresses))
        yield f"{state.cycles:>14.4g}{depth:>20}{state.transmission_error:>10.4g}{state.contact_ratio:>10.4g}{root:>20}"
    if result.asked_cycles is None or (found := result.depth_at(result.asked_cycles)) is None:
        return
    for role, depth_there in found.items():
        if result.coefficients.pick(role):
            mean = result.guideline.get(role.value)
            beside = "" if mean is None else f"; mean by VDI 2736-2 {mean:.4g} µm"
            yield f"{role.value}: {depth_there:.4g} µm after {result.asked_cycles:.4g} load cycles of the pinion{beside}"
