"""Command `tools`: the shelf of tools, and which of them would cut the gears of a design."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option
from gearcad.cli.job import aligned_columns, json_option, quiet_option
from gearcad.cli.language import say, translated

if TYPE_CHECKING:
    from gearcad.geometry.tool_tables import ShelfTool
    from gearcad.jobs.tools import CutGear, ShelfTools, ToolChoice, ToolChoices

_NAME = 24
"""Characters of a name that are shown."""

_WIDTH = 100

_PLACES = {"design": "here", "user": "user", "gearcad": "gearcad"}
"""Words for the tables of tools."""


def shelf_lines(result: ShelfTools) -> Iterator[str]:
    """Yield a line for each name of a table, with the modules for which it is there, under a heading."""
    rows: list[tuple[str, ...]] = [("tool", "kind", "module mm", "α_n °", "h_aP0*", "ρ_aP0*", "table")]
    for (name, _, _), group in groupby(result.tools, key=lambda tool: (tool.name, tool.place, tool.file)):
        rows.append(_shelf_row(name, list(group)))
    yield from aligned_columns(rows, left=(0, 1, 2, 6))


def _shelf_row(name: str, rows: Sequence[ShelfTool]) -> tuple[str, ...]:
    first, modules = rows[0], sorted(tool.normal_module for tool in rows if tool.normal_module is not None)
    shown = "every" if len(modules) < len(rows) else ""
    if modules:
        series = f"{modules[0]:g}–{modules[-1]:g}" if len(modules) > 2 else ", ".join(f"{each:g}" for each in modules)
        shown = f"{series}{', others' if shown else ''}"
    addenda, radii = zip(*(_tip(tool) for tool in rows), strict=True)
    angle = f"{first.rack.pressure_angle:g}"
    return (_shortened(name, _NAME), first.kind, shown, angle, _several(addenda), _several(radii), _PLACES[first.place.value])


def _tip(tool: ShelfTool) -> tuple[float | None, float | str | None]:
    """Return the addendum of a tool, and the radius of its tip, in normal modules."""
    if tool.premachining.present:
        module = tool.normal_module
        addendum = tool.premachining.tool_addendum if module is None else tool.addendum(module)
        return addendum, tool.premachining.tool_tip_radius
    radius = tool.cutter.tip_radius if tool.cutter.present else tool.rack.root_radius
    return tool.rack.dedendum, radius


def _several(values: Iterable[float | str | None]) -> str:
    """Return the one value that there is, or the least and the greatest."""
    numbers = sorted({float(each) for each in values if isinstance(each, int | float)})
    if not numbers:
        return next((str(each) for each in values if each is not None), "-")
    return f"{numbers[0]:.4g}" if len(numbers) == 1 else f"{numbers[0]:.4g}–{numbers[-1]:.4g}"


def choice_lines(result: ToolChoices) -> Iterator[str]:
    """Yield a table for each gear, and why tools do not hold."""
    for number, (name, each) in enumerate(result.gears.items()):
        if number:
            yield ""
        yield from _gear_lines(name, each)


def _gear_lines(name: str, each: CutGear) -> Iterator[str]:
    gear = each.gear
    size = f"z {gear.teeth}, m_n {gear.normal_module:.6g} mm, α_n {gear.rack.pressure_angle:g}°"
    yield f"{name}: {size}; as asked d_f {gear.root_diameter:.4f}, d_Ff {gear.form_diameter:.4f} mm"
    if not each.choices:
        yield "no tool of the shelf is of this size"
        return
    rows: list[tuple[str, ...]] = [("tool", "table", "off mm", "d_f mm", "+/-", "d_Ff mm", "+/-", "s_pr mm", "c mm", "holds")]
    rows += [_choice_row(choice) for choice in each.choices]
    yield from aligned_columns(rows, left=(0, 1))
    for choice in each.choices:
        name = _shortened(choice.tool.name, _NAME)
        for fault in choice.faults[:1]:
            yield from wrap(f"{name}: {translated(fault)}", _WIDTH, subsequent_indent="  ")
        if choice.wheel is not None and choice.holds:
            end, radius = choice.wheel.end_diameter, choice.wheel.wheel_tip_radius
            rounded = "" if radius is None else f", finishing.wheel_tip_radius = {radius:.6g}"
            yield f"{name}: with finishing.end_diameter = {end:.6g}{rounded}"
        if choice.short_lead is not None and choice.gear is not None:
            pre = choice.gear.premachining
            keys = f"tool_addendum = {pre.tool_addendum:.6g}, tool_tip_radius = {pre.tool_tip_radius:.6g}"
            keys += f", tool_pressure_angle = {pre.tool_pressure_angle:g}"
            yield f"* {name}: short lead, m_0 {choice.short_lead:.6g} mm; in the spec it is premachining with"
            yield f"  {keys}"


def _choice_row(choice: ToolChoice) -> tuple[str, ...]:
    tool, gear = choice.tool, choice.gear
    name = f"{_shortened(tool.name, _NAME)}{' *' if choice.short_lead is not None else ''}"
    if gear is None:
        return (name, _PLACES[tool.place.value], *["-"] * 7, "no")
    return (
        name,
        _PLACES[tool.place.value],
        _number(choice.distance),
        f"{gear.root_diameter:.4f}",
        _number(choice.root_difference, signed=True),
        f"{gear.form_diameter:.4f}",
        _number(choice.form_difference, signed=True),
        _number(choice.residual_undercut),
        _number(choice.clearance),
        "yes" if choice.holds else "no",
    )


def _number(value: float | None, *, signed: bool = False) -> str:
    if value is None:
        return "-"
    rounded = round(value, 4) + 0.0
    return f"{rounded:+.4f}" if signed and rounded else f"{rounded:.4f}"


def _shortened(text: str, most: int) -> str:
    return text if len(text) <= most else f"{text[: most - 1]}…"


@click.command(short_help="The shelf of tools, and which of them would cut the gears of a design.")
@click.argument("design", required=False, type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Write tools.json and tools.csv there.")
@json_option
@quiet_option
@debug_option
def tools(design: Path | None, output: Path | None, as_json: bool, quiet: bool) -> None:
    """List the tools of the shelf: those of tools.csv here, of gearcad/tools.csv in your configuration folder, and of gearcad.

    With a DESIGN, a spec, list those that would cut each of its gears: tools of its module and pressure angle, and hobs with a
    short lead (*) whose base pitch is that of the gear. Beside each stand the root that it would leave, the residual undercut
    s_pr, the clearance c of the mate's tip, whether gear and mates run, and how far the root is off the one that is asked for:
    the greatest distance of the outlines below the flank. The nearest comes first. Its name goes into the spec as tool =
    "name", in place of rack, cutter and premachining. What is written with -o can be the tools.csv of another design.

    \b
    gearcad tools
    gearcad tools pair.toml
    """
    from gearcad.core.output import json_text
    from gearcad.designs.reader import read_spec
    from gearcad.geometry.tool_shelf import Shelf
    from gearcad.jobs import tools as job
    from gearcad.jobs.job import with_summary

    folder = Path() if design is None else design.parent
    result = job.tools(None if design is None else read_spec(design), folder=folder)
    files = [] if output is None else job.write_tools(result, output)
    if as_json:
        click.echo(json_text(with_summary(result.to_dict())), nl=False)
    else:
        say("\n".join(shelf_lines(result) if isinstance(result, job.ShelfTools) else choice_lines(result)))
        click.echo("".join(f"{file}\n" for file in files), nl=False)
    if quiet:
        return
    if isinstance(result, job.ShelfTools):
        own, user = (path for path, _ in Shelf(folder).places[:2])
        say(f"Tools of your own: {own} beside a design, or {user}", err=True)
        return
    for warning in result.warnings:
        say(f"Warning: {warning}", fg="yellow", err=True)
