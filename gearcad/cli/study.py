"""A design table from a spec and what to vary: study."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, require_new_file, spec_argument
from gearcad.errors import ParameterError, as_choice

if TYPE_CHECKING:
    from gearcad.batch.study import Sample, Study

__all__ = ["study"]

MOST_CHECKED = 2000
"""Rows of the largest table that is tried at once, about 1 ms for each; batch tries all rows before it begins."""


@click.command(short_help="Write a design table of SPEC with some keys varied.")
@spec_argument
@click.option("--vary", "variations", multiple=True, metavar="KEY=VALUES", help="Repeat it for every key that varies.")
@click.option("--sample", metavar="METHOD", help="Draw the rows: lhs (Latin hypercube) or sobol.  [default: all combinations]")
@click.option("--n", "rows", type=int, metavar="N", help="How many rows to draw.")
@click.option("--seed", type=int, metavar="N", help="Another seed draws other rows.  [default: 0]")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="The table.  [default: NAME-study.csv here]"
)
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@debug_option
def study(
    spec: Path,
    variations: tuple[str, ...],
    sample: str | None,
    rows: int | None,
    seed: int | None,
    output: Path | None,
    force: bool,
) -> None:
    """Write a design table: SPEC with some of its keys varied, a row for every combination.

    \b
    --vary helix_angle=10,20,28             these values
    --vary pinion.profile_shift=-0.2:0.6:9  from -0.2 to 0.6 in 9 values
    --vary wheel.profile_shift=auto         one value for all rows
    --vary "shaft.*.damping_ratio=0.01,0.1" of all shafts of a train, in place of what each has
    --vary "mesh.stage 1.stiffness=500,750" of the mesh of this name
    With --sample the rows are drawn instead, and a range has no count:
    --vary pinion.profile_shift=-0.2:0.6 --sample lhs --n 200
    """
    from gearcad.batch.study import plan_study, write_study

    planned = plan_study(spec, variations, _sample(sample, rows, seed))
    path = output if output is not None else Path(f"{planned.name}-study.csv")
    require_new_file(path, force)
    if path.suffix.lower() != ".csv":
        raise ParameterError("output", str(path), "must end in .csv")
    write_study(planned, path)
    click.echo(path)
    _echo_prospects(planned, path)


def _sample(method: str | None, rows: int | None, seed: int | None) -> Sample | None:
    """What --sample, --n and --seed say together."""
    from gearcad.batch.study import Method, Sample

    if method is None:
        for option, value in (("n", rows), ("seed", seed)):
            if value is not None:
                raise ParameterError(option, value, "needs --sample lhs or --sample sobol; else every combination is a row")
        return None
    chosen = as_choice("sample", method.lower(), Method)
    if rows is None:
        raise ParameterError("sample", method, "needs --n, how many rows to draw")
    if chosen is Method.SOBOL and rows > 0 and rows & (rows - 1):
        click.echo("Note: Sobol points are spread most evenly if --n is a power of 2, such as 128 or 256", err=True)
    return Sample(method=chosen, rows=rows, seed=seed or 0)


def _echo_prospects(planned: Study, path: Path) -> None:
    """Say how many rows make no gear, if they are few enough to try, and how to go on."""
    from gearcad.batch.study import check_table
    from gearcad.designs.design import DesignKind

    rows, of_train = planned.rows, planned.kind is DesignKind.TRAIN
    faulty, first = check_table(path) if rows <= MOST_CHECKED else (0, "")
    if faulty:
        click.echo(f"{faulty} of {rows} rows make no {'train' if of_train else 'gear'}. The first: {first}", err=True)
    keep_going = f" --keep-going    # {'does' if of_train else 'builds'} the others" if 0 < faulty < rows else ""
    if faulty < rows:
        click.echo(f"Next: {planned.next_command(path)}{keep_going}", err=True)
