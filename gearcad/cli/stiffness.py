"""Mesh stiffness by every method: stiffness."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.progress import job_progress

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
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder.  [default: output/NAME]")
@click.option("--json", "as_json", is_flag=True, help="Print the document of stiffness.json and nothing else.")
@click.option("--quiet", is_flag=True, help="No progress on the screen.")
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
    from gearcad.designs import read_spec
    from gearcad.errors import ParameterError, require_whole
    from gearcad.jobs.stiffness import compare, curves_csv, expected_comparison, stiffness_document
    from gearcad.output import json_text, staged_files
    from gearcad.report import write_stiffness_report
    from gearcad.stiffness import METHODS

    for name in methods:
        if name not in (_ALL, *METHODS):
            raise ParameterError("method", name, f"must be one of {', '.join((_ALL, *METHODS))}")
    wanted = tuple(METHODS) if not methods or _ALL in methods else tuple(dict.fromkeys(methods))
    most = min(positions or METHODS[name].default_positions for name in wanted) // 4
    require_whole("fourier", harmonics, at_least=0, at_most=max(most, 0))
    design = read_spec(spec)
    expected = None if quiet else expected_comparison(design, wanted, positions)
    with job_progress(shown=not quiet, expected=expected) as progress:
        comparison = compare(design, methods=wanted, positions=positions, progress=progress)
    document = stiffness_document(comparison, design.name, harmonics)
    folder = output if output is not None else Path("output") / design.name
    with staged_files(folder) as staging:
        (staging / "stiffness.json").write_text(json_text(document), encoding="utf-8")
        (staging / "stiffness.csv").write_text(curves_csv(comparison), encoding="utf-8", newline="")
        write_stiffness_report(comparison, design.name, staging / "stiffness.html")
        files = sorted(file.name for file in staging.iterdir())
    if as_json:
        click.echo(json_text(document), nl=False)
        return
    for line in (*_table(comparison), *(str(folder / file) for file in files)):
        click.echo(line)


def _table(comparison: StiffnessComparison) -> list[str]:
    """The methods, a line each, then what to know of them."""
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
    lines += [f"Warning: {METHODS[cycle.method].title}: {note}" for cycle in comparison.cycles for note in cycle.notes]
    lines += [f"{METHODS[name].title}: left out: {reason}" for name, reason in comparison.left_out.items()]
    return lines


def _line(words: str, cells: tuple[str, ...] | list[str]) -> str:
    return f"{words:<28}" + "".join(f"{cell:>10}" for cell in cells)
