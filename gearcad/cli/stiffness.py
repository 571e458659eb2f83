"""Mesh stiffness by every method: stiffness."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import echo_warnings, json_option, output_option, perform, quiet_option

if TYPE_CHECKING:
    from gearcad.stiffness import StiffnessComparison

__all__ = ["stiffness"]

_ALL = "all"
_NONE = "-"


@click.command(short_help="Mesh stiffness of SPEC's pair by every method, side by side.")
@spec_argument
@click.option(
    "--method", "methods", multiple=True, metavar="NAME", help="One of them, or all; may be given again.  [default: all]"
)
@click.option("--positions", type=int, default=0, metavar="N", help="Over one base pitch.  [default: the method's own]")
@click.option("--fourier", "harmonics", type=int, default=0, metavar="N", help="Write the first N harmonics of each curve too.")
@output_option
@json_option
@quiet_option
@debug_option
def stiffness(
    spec: Path,
    methods: tuple[str, ...],
    positions: int,
    harmonics: int,
    output: Path | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Mesh stiffness of the pair of SPEC under its [load] over one base pitch, by every method or those of --method:

    \b
    potential-energy   beam of the true tooth, Sainsot's foundation
    weber-banaschek    beam, half-plane below it, Hertz under the load
    iso6336            ISO 6336-1 Method B: the mean
    strain-energy      energy of FE bodies (Pedersen and Jorgensen)
    plane-stress       FE contact of a plane section
    plane-strain
    3d                 FE contact of solid bodies: takes a minute

    Writes stiffness.json, stiffness.csv (the curves) and stiffness.html. Bodies are held where [check] in SPEC says, or in
    their bores. A method that cannot treat the pair is left out, with its reason.
    """
    from gearcad.errors import ParameterError
    from gearcad.jobs.stiffness import Stiffness
    from gearcad.stiffness import METHODS

    for name in methods:
        if name not in (_ALL, *METHODS):
            raise ParameterError("method", name, f"must be one of {', '.join((_ALL, *METHODS))}")
    wanted = tuple(METHODS) if not methods or _ALL in methods else tuple(dict.fromkeys(methods))
    job = Stiffness(methods=wanted, positions=positions, fourier=harmonics)
    perform(job, spec, output, _show, as_json=as_json, quiet=quiet)


def _show(_name: str, comparison: StiffnessComparison) -> None:
    """The methods, a line each, then what to know of them."""
    from gearcad.stiffness import METHODS

    click.echo("\n".join(_table(comparison)))
    echo_warnings(comparison.notices)
    for name, reason in comparison.left_out.items():
        click.echo(f"{METHODS[name].title}: left out: {reason}")


def _table(comparison: StiffnessComparison) -> list[str]:
    """The methods, a line each."""
    from gearcad.stiffness import METHODS

    heads = ("mean", "max", "min", "at C", "c_γβ", "c_γα", "one pair", "to 3d")
    units = ("N/µm", "N/µm", "N/µm", "N/µm", "N/(mm µm)", "N/(mm µm)", "N/µm", "%")
    lines = [_line("secant, over one base pitch", heads), _line("", units)]
    for cycle in comparison.cycles:
        course = (_NONE,) * 3 if cycle.mean_only else (cycle.maximum, cycle.minimum, cycle.pitch_point)
        deviation = comparison.deviation(cycle)
        cells = (
            cycle.mean,
            *course,
            cycle.secant_per_width,
            cycle.tangent_per_width,
            _NONE if cycle.single_stiffness is None else cycle.single_stiffness,
            _NONE if deviation is None else f"{100 * deviation:+.1f}",
        )
        lines.append(_line(METHODS[cycle.method].title, [cell if isinstance(cell, str) else f"{cell:.5g}" for cell in cells]))
    lines.append("c_γβ: mean secant, c_γα: mean tangent stiffness per face width; 'to 3d': of the mean from that of 3d")
    return lines


def _line(words: str, cells: tuple[str, ...] | list[str]) -> str:
    return f"{words:<28}" + "".join(f"{cell:>10}" for cell in cells)
