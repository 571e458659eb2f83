"""Command `shafts`: deflection, reactions and bearing life of shafts, and the load over the face of their mesh."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import echo_warnings, json_option, output_option, perform, quiet_option
from gearcad.cli.language import say

if TYPE_CHECKING:
    from gearcad.shafts.arrangement import ArrangementResult


@click.command(short_help="Deflection, reactions and bearing life of SPEC's shafts.")
@spec_argument
@output_option
@click.option("--no-report", is_flag=True, help="Without shafts.html, whose pictures take most of the time.")
@json_option
@quiet_option
@debug_option
def shafts(spec: Path, output: Path | None, no_report: bool, as_json: bool, quiet: bool) -> None:
    """Show how the shafts of SPEC bend under their loads: reactions, deflection, stresses, bearing life, critical speeds.

    SPEC has [[shaft]] segments, [[bearing]] and [[force]] of one shaft, or a pair with [[pinion.shaft]], [[pinion.bearing]] and
    pinion.mesh_position, and the same of the wheel: then the load over the face and K_Hbeta on these shafts follow too. Of a
    train all [[train.shaft]] with segments and bearings are shown, under the forces of their gears. Writes shafts.json and
    shafts.html.
    """
    from gearcad.jobs.shafts import Shafts

    perform(Shafts(report=not no_report), spec, output, _show, as_json=as_json, quiet=quiet)


def _show(_name: str, result: ArrangementResult) -> None:
    """Print the figures of the shafts and their notices."""
    say("\n".join(_lines(result)))
    echo_warnings(result.notices)


def _lines(result: ArrangementResult) -> Iterator[str]:
    for name, shaft in result.shafts.items():
        state = shaft.state
        yield f"{name}: length {state.shaft.length:g} mm, torque of the coupling {state.coupling_torque:.5g} N·m"
        for life, force in zip(shaft.lives, state.reactions, strict=True):
            forces = ", ".join(f"{each + 0.0:.5g}" for each in force[:3].round(6))
            hours = "-" if life.hours is None else _hours(life.hours)
            modified = "" if life.modified_hours is None else f", L_nmh {_hours(life.modified_hours)}"
            yield f"  {life.name}: reaction {forces} N, L_10h {hours}{modified}"
        stations = state.stations()
        bent = max(stations, key=lambda each: each["deflection"][0] ** 2 + each["deflection"][1] ** 2)
        stressed = [each[side] for each in stations for side in ("left", "right") if side in each]
        across = (bent["deflection"][0] ** 2 + bent["deflection"][1] ** 2) ** 0.5
        yield f"  greatest deflection {across:.4g} µm at {bent['position']:g} mm"
        yield f"  greatest equivalent stress {max(each['equivalent_stress'] for each in stressed):.4g} MPa (nominal)"
        for each in shaft.shoulders:
            if not each.reason:
                yield f"  shoulder at {each.position:g} mm: S_D {each.fatigue:.4g}, S_F {each.static:.4g} (DIN 743)"
        speeds = ", ".join(f"{each:.4g}" for each in shaft.speeds["critical_speeds"])
        yield f"  critical speeds {speeds} rpm"
    if (mesh := result.mesh) is not None:
        yield f"mesh: f_sh {mesh['f_sh']:.4g} µm, K_Hbeta {mesh['K_Hbeta_end_of_face']:.4g} at the end of the face"
    yield f"not judged: {'; '.join(result.not_judged)}"


def _hours(hours: float) -> str:
    """Return a life in hours; that of a bearing without a load has no limit."""
    return f"{hours:.5g} h" if math.isfinite(hours) else "without limit"
