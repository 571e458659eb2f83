"""The structural check of a pair: check."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.progress import job_progress
from gearcad.cli.verdict import print_verdict
from gearcad.per_gear import PerGear

if TYPE_CHECKING:
    from gearcad.check.result import CheckResult

__all__ = ["check"]

_FIELDS = PerGear("stress_pinion.vtu", "stress_wheel.vtu")


@click.command(short_help="Check the strength of SPEC's pair by finite elements.")
@spec_argument
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder.  [default: output/NAME]")
@click.option("--model", type=click.Choice(["2d", "3d"]), help="Plane or solid bodies.  [default: 3d for helical gears]")
@click.option("--json", "as_json", is_flag=True, help="Print the document of check.json and nothing else.")
@click.option("--quiet", is_flag=True, help="No progress on the screen.")
@debug_option
def check(spec: Path, output: Path | None, model: str | None, as_json: bool, quiet: bool) -> None:
    """Check the pair of SPEC under its [load]: contact and root stress by finite elements, beside Hertz and ISO 6336.

    Writes check.json and report.html, and for solid bodies the stresses in the loaded teeth (stress_*.vtu). Exit status 1 if a
    gate is not passed or cannot be evaluated; [check] in SPEC sets model, body, torques and bands.
    """
    from gearcad.check.document import check_document
    from gearcad.check.options import CheckOptions
    from gearcad.designs import PairDesign, read_spec
    from gearcad.jobs.check import NO_MATE, assess, expected_assessment
    from gearcad.output import json_text, staged_files
    from gearcad.report import write_report

    design = read_spec(spec)
    if model is not None:
        pair = design.accepted(PairDesign, why=NO_MATE)
        design = replace(pair, check=replace(pair.check or CheckOptions(), model=model))
    with job_progress(shown=not quiet, expected=None if quiet else expected_assessment(design)) as progress:
        result = assess(design, progress=progress)
    document = check_document(result)
    folder = output if output is not None else Path("output") / design.name
    with staged_files(folder) as staging:
        (staging / "check.json").write_text(json_text(document), encoding="utf-8")
        write_report(result, design.name, staging / "report.html")
        _write_fields(result, staging)
        files = sorted(file.name for file in staging.iterdir())
    for file in _FIELDS:
        if file not in files:  # those of a former check of solid bodies would belong to another result
            (folder / file).unlink(missing_ok=True)
    if as_json:
        click.echo(json_text(document), nl=False)
    else:
        print_verdict(design.name, result)
        click.echo("".join(f"{folder / file}\n" for file in files), nl=False)
    if not result.passed:
        click.get_current_context().exit(1)


def _write_fields(result: CheckResult, folder: Path) -> None:
    """Stresses of the most stressed tooth of each gear, where the bodies are solid."""
    from gearcad.check.solid.result import SolidCheck
    from gearcad.contact.solid.field import shown_stress, worst_field, write_vtu

    if isinstance(result, SolidCheck):
        for role, name in _FIELDS.items():
            field = worst_field(result.cycle, role)
            write_vtu(field, folder / name, shown_stress(result.cycle, role, field))
