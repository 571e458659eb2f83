"""The rating of a pair: rate."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import json_option, output_option, perform, quiet_option
from gearcad.cli.safeties import print_strength, verdict_line
from gearcad.errors import InputError, OutputError, SpecError

__all__ = ["rate"]


@click.command(short_help="Rate SPEC's pair by ISO 6336: safeties, life, permissible torque.")
@spec_argument
@output_option
@json_option
@quiet_option
@debug_option
def rate(spec: Path, output: Path | None, as_json: bool, quiet: bool) -> None:
    """Rate the pair of SPEC under its [load] by ISO 6336 or DIN 3990: safeties of flanks and roots, life, permissible torque.

    Of a planetary train each mesh is rated, under what the planet carries that carries most.

    [rating] in SPEC sets standard, accuracy, life, oil, shafts and required safeties; [material] what the gears bear, by group,
    quality and hardness of ISO 6336-5. What is not given is assumed and told; without its limit a flank or root is not judged.

    Writes rate.json and rate.html, of a train rate-MESH.html of each mesh. Exit status 0 if strength is
    passed, or not asked for: no endurance limit, local limit or quality of a material and no required_safety_* is given. Exit
    status 1 if a required safety is not reached, or if a flank, a root or the scuffing that is asked for cannot be judged.
    """
    from gearcad.jobs.rate import Rate

    with _blaming(spec):
        result = perform(Rate(), spec, output, print_strength, as_json=as_json, quiet=quiet)
    if as_json and not quiet:
        click.echo(verdict_line(result.name, result), err=True)
    if result.strength.falls_short:
        click.get_current_context().exit(1)


@contextmanager
def _blaming(spec: Path) -> Iterator[None]:
    """All that a rating goes by is in the spec: an InputError becomes a SpecError that names it, and the key."""
    from gearcad.jobs.rate import KEYS

    try:
        yield
    except OutputError:
        raise
    except InputError as error:
        key = KEYS.get(error.parameter, error.parameter)
        raise SpecError(f"{spec}: {type(error)(key, error.value, error.permitted, error.unit)}", key) from error
