"""Planetary sets for a task: what `gearcad size --planetary` asks for and shows."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from gearcad.cli.job import echo_warnings
from gearcad.cli.progress import job_progress
from gearcad.errors import ParameterError, SolverError, as_choice

if TYPE_CHECKING:
    from gearcad.material import Material
    from gearcad.sizing.set_task import SetSizeTask
    from gearcad.sizing.sized_set import SizedSet, SizedSets

__all__ = ["require_no_sets", "set_options", "size_planetary"]

Command = TypeVar("Command", bound=Callable[..., Any])

_OPTIONS: tuple[tuple[str, dict[str, Any]], ...] = (
    (
        "--type",
        {"metavar": "TYPES", "help": "Sets: A sun and ring, B stepped planets, C two suns, D two rings.  [default: A]"},
    ),
    ("--planets", {"metavar": "N[:N]", "help": "Sets: how many planets.  [default: 3:5]"}),
    ("--input-torque", {"type": float, "metavar": "NM", "help": "Sets: on the input; --torque is its old name."}),
    ("--output-torque", {"type": float, "metavar": "NM", "help": "Sets: on the output."}),
    ("--ring-teeth", {"metavar": "Z[:Z]", "help": "Sets: of rings.  [default: 30:200]"}),
    ("--fixed", {"metavar": "MEMBER", "help": "Sets: sun, ring, carrier, sun_2 or ring_2; so for --in and --out."}),
    ("--in", {"metavar": "MEMBER", "help": "Sets: the input."}),
    ("--out", {"metavar": "MEMBER", "help": "Sets: the output."}),
    ("--mesh-load-factor", {"type": float, "metavar": "K_G", "help": "Sets: K_gamma.  [default: by the planets, ABS]"}),
)

_OF_PAIRS = (
    *(
        "centre_distance",
        "max_mass",
        "shift",
        "shift_sum",
        "max_width",
        "contact_ratio",
        "tip_thickness",
        "rack",
        "by",
        "errors",
    ),
)
"""Options of pairs that sets do not have."""

_PLAIN = {"fixed": "fixed", "in": "input", "out": "output", "ratio_tolerance": "tolerance"}
_RANGES = ("planets", "teeth", "ring_teeth")


def set_options(command: Command) -> Command:
    """The options of planetary sets."""
    for name, how in reversed(_OPTIONS):
        command = click.option(name, name.lstrip("-").replace("-", "_"), **how)(command)
    text = "Planetary sets in place of pairs; speed of the input."
    return click.option("--planetary", is_flag=True, help=text)(command)


def require_no_sets(given: Mapping[str, Any]) -> None:
    """Raise ParameterError for an option of sets where pairs are wanted."""
    for option, _ in _OPTIONS:
        name = option.lstrip("-").replace("-", "_")
        if given[name] is not None:
            raise ParameterError(name, given[name], "is of planetary sets: needs --planetary")


def size_planetary(given: Mapping[str, Any], count: int, output: Path | None, *, as_json: bool, quiet: bool) -> None:
    """Size sets for what options ask for, write the files and show the table; ends with status 1 where none holds."""
    from gearcad.jobs.set_sizes import write_set_sizes
    from gearcad.output import json_text
    from gearcad.sizing.planetary_sets import expected, size_sets

    task = _task(given)
    try:
        with job_progress(shown=not quiet, expected=None if quiet else expected(task, count)) as progress:
            result = size_sets(task, count, progress)
    except SolverError as error:
        click.echo(str(error), err=True)
        click.get_current_context().exit(1)
    files = write_set_sizes(result, Path("output/size") if output is None else output)
    if as_json:
        click.echo(json_text(result.to_dict()), nl=False)
        return
    click.echo("\n".join(_table(result)))
    if not quiet:
        echo_warnings(task.notices, err=True)
        click.echo("\n".join(_remarks(result)), err=True)
    click.echo("".join(f"{file}\n" for file in files), nl=False)


# ---------------------------------------------------------------------- what is asked


def _task(given: Mapping[str, Any]) -> SetSizeTask:
    """The task of the options that are given. Raises ParameterError."""
    from gearcad.cli.size_options import ends_of, load_of, material_of, modules_of, rating_of, values_of
    from gearcad.planetary.mesh import SetType
    from gearcad.planetary.search import SearchTask
    from gearcad.sizing.set_task import SetSizeTask

    for name in _OF_PAIRS:
        if given.get(name) is not None:
            raise ParameterError(name, given[name], "is of pairs: leave it out with --planetary")
    for needed, what in (("ratio", "speed of the input over that of the output"), ("material", 'such as "Eh MQ"')):
        if given[needed] is None:
            raise ParameterError(needed, None, f"must be given, {what}")
    fields: dict[str, Any] = {field: given[name] for name, field in _PLAIN.items() if given[name] is not None}
    fields |= {name: ends_of(name, given[name]) for name in _RANGES if given[name] is not None}
    if given["type"] is not None:
        fields["types"] = tuple(as_choice("type", each.strip().upper(), SetType) for each in given["type"].split(","))
    if given["helix_angle"] is not None:
        fields["helix_angle"] = _single("helix_angle", values_of("helix_angle", given["helix_angle"]))
    others: dict[str, Any] = {name: given[name] for name in ("mesh_load_factor", "max_diameter") if given[name] is not None}
    if given["width_ratio"] is not None:
        others["width_ratio"] = max(values_of("width_ratio", given["width_ratio"]))
    if given["module"] is not None or given["second_series"]:
        others["modules"] = modules_of("0.5:50" if given["module"] is None else given["module"], second=given["second_series"])
    torques: dict[str, Any] = {name: given[name] for name in ("input_torque", "output_torque") if given[name] is not None}
    if len(torques) > 1 or (torques and (given["torque"] is not None or given["power"] is not None)):
        name, value = torques.popitem()
        permitted = "must be the only one of --input-torque, --output-torque, --power and --torque"
        raise ParameterError(name, value, permitted, "N·m")
    if not torques and given["torque"] is None and given["power"] is None:
        raise ParameterError("input_torque", None, "must be given, in N·m, or --output-torque, or --power in kW")
    load = load_of({**given, "torque": 1.0} if torques else given)
    if not torques:
        torques = {"torque" if given["power"] is None else "input_torque": load.torque}
    return SetSizeTask(
        sets=SearchTask(ratio=given["ratio"], module=1.0, **fields),
        **torques,
        speed=load.speed,
        application_factor=load.application_factor,
        material=material_of("material", given["material"], given["hardness"]),
        ring_material=_of_rings(given),
        rating=rating_of(given),
        **others,
    )


def _of_rings(given: Mapping[str, Any]) -> Material | None:
    """The one of a wheel is here that of rings."""
    from gearcad.cli.size_options import material_of

    if given["wheel_material"] is None and given["wheel_hardness"] is None:
        return None
    name, hardness = given["material" if given["wheel_material"] is None else "wheel_material"], given["wheel_hardness"]
    found: Material = material_of("wheel_material", name, hardness)
    return found


def _single(name: str, values: tuple[float, ...]) -> float:
    if len(values) != 1:
        raise ParameterError(name, list(values), "must be one number with --planetary, of the first sun or ring")
    return values[0]


# ---------------------------------------------------------------------- what is shown

_HEADING = ("set", "ratio", "off %", "m mm", "b mm", "diameter mm", "a mm", "planets", "K_gamma", "kg", "S_H", "S_F", "weakest")


def _table(result: SizedSets) -> Iterator[str]:
    """A line for each set, under a heading."""
    rows = [_HEADING, *(_row(each) for each in result.found)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        name, *numbers, last = row
        cells = (f"{cell:>{width}}" for cell, width in zip(numbers, widths[1:], strict=False))
        yield "  ".join((f"{name:<{widths[0]}}", *cells, last)).rstrip()


def _row(each: SizedSet) -> tuple[str, ...]:
    from gearcad.rating.strength import Part

    own = each.candidate
    worst = min(each.margins, key=lambda part: each.margins[part] ** (2 if part is Part.FLANK else 1))
    places = [(least, name) for name, gear in each.strength.members.items() if (least := gear.least(worst)) is not None]
    least, gear = min(places)
    return (
        each.name,
        f"{own.ratio:.5g}",
        f"{own.deviation:+.3f}" if own.deviation else "0",
        f"{own.task.module:g}",
        f"{own.task.width:g}",
        f"{own.diameter:.1f}",
        f"{own.centre_distance:.3f}",
        str(own.planets),
        f"{each.load.mesh_load_factor:g}",
        f"{each.mass:.3g}",
        *(f"{each.least[part]:.3f}" for part in Part),
        f"{worst.value} of {gear} in {least.mesh}",
    )


def _remarks(result: SizedSets) -> Iterator[str]:
    """What the safeties go by, how many were looked at, and what the columns are."""
    from gearcad.cli.size_table import basis_lines, scuffing_line

    options, task = result.task.rating, result.task
    yield from basis_lines(options, task.application_factor, result.assumed)
    if (line := scuffing_line(options)) is not None:
        yield line
    yield f"{result.considered} sets of tooth numbers, {result.refined} of them sized; lightest first"
    yield "weakest: the part that more torque takes first; off: ratio over the one asked for, less 1"
    yield "mass without bores, rings with rims of 3.5 m_n; diameter over all teeth"
    yield "S_H and S_F are the least of all gears under all load factors; no set has backlash yet: planetary.tooth_thinning"
    if result.refused:
        name, why = next(iter(result.refused.items()))
        yield f"{len(result.refused)} were left out; the first: {name}: {why}"
    yield "Next: gearcad rate best.toml, gearcad planetary best.toml, gearcad batch sets.csv"
