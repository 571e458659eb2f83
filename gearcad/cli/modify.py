"""Flank modifications for a load: modify."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, require_new_file, spec_argument
from gearcad.cli.job import echo_warnings
from gearcad.cli.progress import job_progress
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.jobs.proposal import Proposal

__all__ = ["modify"]


@click.command(short_help="Propose tip relief and crowning for SPEC's load.")
@spec_argument
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="[default: NAME-modified.toml here]")
@click.option("--torque", type=float, metavar="N·m", help="On the pinion.  [default: that of the load, times its factor]")
@click.option("--pressure", type=float, metavar="MPa", help="Most contact pressure.  [default: the material's limit]")
@click.option("--shape", metavar="SHAPE", help="Of the tip relief: linear or parabolic.  [default: the better one]")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document and nothing else.")
@click.option("--quiet", is_flag=True, help="No progress and no warnings on the screen.")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@debug_option
def modify(
    spec: Path,
    output: Path | None,
    torque: float | None,
    pressure: float | None,
    shape: str | None,
    as_json: bool,
    quiet: bool,
    force: bool,
) -> None:
    """Propose tip relief on both gears and lead crowning on the pinion for the load of SPEC, and write the modified spec.

    The transmission error is made as small as it gets with the contact pressure kept below --pressure and, if possible, the
    edges of the tips out of contact. By default the bound is the lower end of the material's contact_limit or, where no
    modification gets there, 5 % more than without. Against a misalignment of [mounting] the pinion's helix angle is modified
    too.
    """
    from gearcad.designs import read_spec
    from gearcad.designs.edit import edit_spec
    from gearcad.errors import as_choice
    from gearcad.geometry import ReliefShape
    from gearcad.jobs.modify import Modify
    from gearcad.output import json_text, staged_files

    wanted = None if shape is None else as_choice("shape", shape, ReliefShape)
    job = Modify(torque=torque, pressure=pressure, shape=wanted)
    design = read_spec(spec)
    path = output or Path(f"{design.name}-modified.toml")
    require_new_file(path, force)
    with job_progress(shown=not quiet) as progress:
        proposal = job.run(design, progress)
    text = edit_spec(spec.read_bytes().decode("utf-8-sig"), proposal.changes, proposal.notes)
    text = text.replace(f"go to output/{design.name}/", f"go to output/{proposal.name}/")  # as starters say behind a name
    with staged_files(path.parent) as staging:
        (staging / path.name).write_text(text, encoding="utf-8", newline="")
    if as_json:
        head = {"kind": "modify", "name": proposal.name, "gearcad": __version__, "output": str(path)}
        click.echo(json_text(head | job.document(proposal)), nl=False)
    else:
        click.echo("\n".join([*_lines(proposal), str(path)]))
    if not quiet:
        echo_warnings((*design.notices, *proposal.notices), err=True)


def _lines(proposal: Proposal) -> list[str]:
    """The proposal, and what it does to the mesh."""
    lines = [f"{proposal.design.name} at {proposal.torque:g} N·m, {proposal.variants} variants"]
    for key, value in proposal.changes.items():
        if key != "pair.name":
            lines.append(f"  {key} = {value}{'' if isinstance(value, str) else ' ' + proposal.notes[key]}")
    before, after = proposal.before, proposal.after
    rows: list[tuple[str, str, float, float]] = [
        (
            "transmission error, peak to peak",
            "µm",
            before.transmission_error_peak_to_peak,
            after.transmission_error_peak_to_peak,
        )
    ]
    harmonics = zip(before.transmission_error_harmonics, after.transmission_error_harmonics, strict=True)
    rows += [(f"  harmonic {number}", "µm", *pair) for number, pair in enumerate(harmonics, 1)]
    rows += [
        ("contact pressure", "MPa", before.contact_pressure, after.contact_pressure),
        ("root stress, pinion", "MPa", before.root_tension_pinion, after.root_tension_pinion),
        ("root stress, wheel", "MPa", before.root_tension_wheel, after.root_tension_wheel),
        ("face load factor K_Hβ", "", before.face_load_factor, after.face_load_factor),
        ("positions with a tip edge in contact", "", before.edge_positions, after.edge_positions),
    ]
    lines.append(f"{'':<42}{'before':>10}{'after':>10}")
    lines += [f"{words:<42}{one:>10.4g}{other:>10.4g} {unit}".rstrip() for words, unit, one, other in rows]
    over = after.contact_pressure / proposal.bound - 1
    beyond = f"; the proposal is {100 * over:.2g} % above it" if over > 0 else ""
    lines.append(f"bound of the contact pressure: {proposal.bound:.4g} MPa{beyond}")
    lines.append(f"figures of solid bodies, as gearcad check --model {proposal.model.value} has them")
    lines.append("transmission error, peak to peak, under other conditions")
    for each in proposal.robustness:
        of = each.condition
        words = f"  {of.torque:g} N·m"
        words += f", misaligned by {of.misalignment:+g} µm more" if of.misalignment else ""
        words += f", pitch error of {of.pitch_error:g} µm" if of.pitch_error else ""
        lines.append(f"{words:<42}{each.before:>10.4g}{each.after:>10.4g} µm")
    return lines
