"""Screen and document of `gearcad planetary` for a gearbox of several sets: a line for each of its states."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import click

from gearcad.cli.job import aligned_columns, folder_of
from gearcad.cli.language import say
from gearcad.core.output import json_text, staged_files
from gearcad.core.records import JsonObject
from gearcad.jobs.job import with_summary
from gearcad.planetary.gearbox import Gearbox, StateResult
from gearcad.version import __version__

_FILE = "planetary.json"


def tell_gearbox(gearbox: Gearbox, output: Path | None, *, as_json: bool) -> None:
    """Write planetary.json of all states of a gearbox, and print it, or a table and its path.

    Raises GeometryError and SolverError for a state that cannot be, OutputError.
    """
    results = {state.name: gearbox.solve(state) for state in gearbox.states}
    text, folder = json_text(gearbox_document(gearbox, results)), folder_of(output, gearbox.name)
    with staged_files(folder) as staging:
        (staging / _FILE).write_text(text, encoding="utf-8")
    if as_json:
        click.echo(text, nl=False)
        return
    say("\n".join(_lines(gearbox, results)))
    click.echo(folder / _FILE)


def gearbox_document(gearbox: Gearbox, results: dict[str, StateResult]) -> JsonObject:
    """Return the content of planetary.json for a gearbox: what each state does, by its name."""
    return with_summary(
        {
            "kind": "planetary",
            "name": gearbox.name,
            "gearcad": __version__,
            "input": gearbox.input,
            "output": gearbox.output,
            "mesh_efficiency": gearbox.mesh_efficiency,
            "states": {name: each.to_dict() for name, each in results.items()},
        }
    )


def _lines(gearbox: Gearbox, results: dict[str, StateResult]) -> Iterator[str]:
    """Yield a line for each state under a heading, then what each brake and clutch carries."""
    yield f"{gearbox.name}: {len(gearbox.sets)} planetary sets, from {gearbox.input} to {gearbox.output}"
    yield "torques over that of the input; held: on the brake; joined: by the clutch on the second"
    rows: list[tuple[str, ...]] = [("state", "ratio", "step", "efficiency", "held", "joined")]
    before: float | None = None
    for name, each in results.items():
        step = "" if before is None or before * each.ratio < 0 else f"{before / each.ratio:.3f}"
        before = each.ratio
        held = ", ".join(f"{brake} {_number(each.torques[brake])}" for brake in each.state.held)
        clutches = ", ".join(f"{clutch} {_number(torque)}" for clutch, torque in each.clutches.items())
        efficiency = f"{100 * each.efficiency:.2f} %" if gearbox.mesh_efficiency < 1 else "-"
        rows.append((name, f"{each.ratio:.4f}", step, efficiency, held or "-", clutches or "-"))
    yield from aligned_columns(rows, left=(0, 4, 5))


def _number(torque: float | None) -> str:
    return "shared" if torque is None else f"{torque:.3f}"
