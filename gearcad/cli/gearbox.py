"""Screen of `gearcad planetary` for a gearbox of several sets: a line for each of its states."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.cli.job import aligned_columns
from gearcad.cli.language import say
from gearcad.dynamics.planetary.gearbox_modes import StateVibration
from gearcad.jobs.gearbox import GearboxStudy
from gearcad.planetary.gearbox_assembly import SetAssembly


def show_gearbox(_name: str, study: GearboxStudy) -> None:
    """Print a table of the states of a gearbox."""
    say("\n".join(_lines(study)))


def _lines(study: GearboxStudy) -> Iterator[str]:
    """Yield a line for each state under a heading, then what each brake and clutch carries."""
    gearbox = study.gearbox
    sets = "1 planetary set" if len(gearbox.sets) == 1 else f"{len(gearbox.sets)} planetary sets"
    yield f"{gearbox.name}: {sets}, from {gearbox.input} to {gearbox.output}"
    yield "torques over that of the input; held: on the brake; joined: by the clutch on the second"
    rows: list[tuple[str, ...]] = [("state", "ratio", "step", "efficiency", "held", "joined")]
    before: float | None = None
    for name, each in study.states.items():
        step = "" if before is None or before * each.ratio < 0 else f"{before / each.ratio:.3f}"
        before = each.ratio
        held = ", ".join(f"{brake} {_number(each.torques[brake])}" for brake in each.state.held)
        clutches = ", ".join(f"{clutch} {_number(torque)}" for clutch, torque in each.clutches.items())
        efficiency = f"{100 * each.efficiency:.2f} %" if gearbox.mesh_efficiency < 1 else "-"
        rows.append((name, f"{each.ratio:.4f}", step, efficiency, held or "-", clutches or "-"))
    yield from aligned_columns(rows, left=(0, 4, 5))
    for name, assembly in gearbox.assemblies.items():
        yield from _assembly_lines(name, assembly)
    for name, vibration in study.vibrations.items():
        yield from _vibration_lines(name, vibration)
    if "modes" in study.why_not:
        yield f"no modes: {study.why_not['modes']}"


def _assembly_lines(name: str, assembly: SetAssembly) -> Iterator[str]:
    """Yield the axes of a set's planets, the backlash of its meshes, and the least distance of tips that do not mesh."""
    axes = ", ".join(
        f"{body} at {axis.radius:.6g} mm" + (f" and {math.degrees(axis.angle):.6g} deg" if axis.angle else "")
        for body, axis in assembly.axes.items()
    )
    yield f"{name}: {assembly.gearing.planets} planets of each name, {axes}"
    meshes = ", ".join(f"{mesh} {pair.circumferential_backlash:.4g}" for mesh, pair in assembly.pairs.items())
    yield f"{name}: backlash {meshes} mm"
    if (least := assembly.least_clearance) is not None:
        yield f"{name}: tips that do not mesh are at least {least.distance:.4g} mm apart, {' and '.join(least.between)}"


_MOST_FREQUENCIES = 5
"""Natural frequencies above 0 of a state on the screen."""


def _vibration_lines(name: str, vibration: StateVibration) -> Iterator[str]:
    """Yield the first natural frequencies of a state, and the greatest dynamic forces of its meshes."""
    above = [each for each in vibration.modes.families if each.frequency > 0]
    told = ", ".join(
        f"{each.frequency:.5g} {each.kind.value}" + (f" ({each.multiplicity})" if each.multiplicity > 1 else "")
        for each in above[:_MOST_FREQUENCIES]
    )
    few = f"; first {_MOST_FREQUENCIES} of {len(above)}" if len(above) > _MOST_FREQUENCIES else ""
    yield f"state {name}: natural frequencies {told} Hz{few}"
    if vibration.response is not None:
        mesh, (force, speed) = max(vibration.response.greatest.items(), key=lambda each: each[1][0])
        if not force:
            return  # the gearbox turns as a block
        yield f"state {name}: dynamic force at most {force:.4g} N, of {mesh} at {speed:.5g} rpm"


def _number(torque: float | None) -> str:
    return "shared" if torque is None else f"{torque:.3f}"
