"""The structural check of a pair: check."""

from __future__ import annotations

from pathlib import Path

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import json_option, output_option, perform, quiet_option
from gearcad.cli.verdict import print_verdict, verdict_line

__all__ = ["check"]


@click.command(short_help="Check the strength of SPEC's pair by finite elements.")
@spec_argument
@output_option
@click.option("--model", type=click.Choice(["2d", "3d"]), help="Plane or solid bodies.  [default: 3d for helical gears]")
@json_option
@quiet_option
@debug_option
def check(spec: Path, output: Path | None, model: str | None, as_json: bool, quiet: bool) -> None:
    """Check the pair of SPEC under its [load]: contact and root stress by finite elements, beside Hertz and ISO 6336.

    Writes check.json and report.html, and for solid bodies the stresses in the loaded teeth (stress_*.vtu). Exit status 1 if a
    gate is not passed or cannot be evaluated, or if the strength that is asked for is not passed or cannot be judged, as in
    `gearcad rate`: contact_limit and root_limit are further gates and replace none.

    [check] in SPEC sets model, body, torques and bands.
    """
    from gearcad.jobs.check import Check

    result = perform(Check(model=model), spec, output, print_verdict, as_json=as_json, quiet=quiet)
    if as_json and not quiet:
        click.echo(verdict_line(result.pair.name, result), err=True)
    if not result.passed:
        click.get_current_context().exit(1)
