"""Command `dynamics`."""

from __future__ import annotations

import shlex
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import echo_warnings, folder_of, json_option, output_option, perform_on, quiet_option
from gearcad.cli.language import say

if TYPE_CHECKING:
    from gearcad.designs import Design
    from gearcad.dynamics.pair_result import ContactStudy
    from gearcad.dynamics.response.kv_chart import KvChart
    from gearcad.dynamics.tooth_errors.error_result import ErrorStudy
    from gearcad.dynamics.train_result import ModalStudy, TrainStudy
    from gearcad.dynamics.trains.pair_on_bearings import BearingModes
    from gearcad.dynamics.trains.train import EngagedMesh
    from gearcad.dynamics.trains.train_modes import NaturalModes
    from gearcad.dynamics.variant_comparison import SideBySide
    from gearcad.jobs.dynamics import Dynamics, Study


def displacement_lines(study: TrainStudy) -> list[str]:
    """Return lines with the greatest amplitudes of all motions, and the greatest forces on bearings."""
    swings = {
        quantity: [
            f"{each.name} {each.amplitude:.4g} {each.unit} at {each.speed:.5g} rpm"
            for each in study.greatest_amplitudes
            if each.quantity == quantity
        ]
        for quantity in ("turn", "approach")
    }
    lines = [f"amplitude of {quantity}: {', '.join(listed)}" for quantity, listed in swings.items()]
    return lines + [
        f"bearings of {each.gear}: at most {each.force:.5g} N at {each.speed:.5g} rpm, {each.static:.5g} N at rest"
        for each in study.greatest_bearing_forces
    ]


def bearing_mode_lines(modes: BearingModes) -> list[str]:
    """The six modes of gears on bearings."""
    lines = [f"{'on bearings':<20}{'Hz':>10}{'1/s':>12}{'in mesh, %':>12}  what moves most"]
    for number, words in enumerate(modes.words):
        share = 100 * modes.potential[number, 0]
        lines.append(
            f"{number + 1:<20}{modes.frequency[number]:>10.6g}{modes.circular[number]:>12.6g}{share:>12.1f}  {words}"
            + ("" if modes.shaken[number] or not number else ": teeth do not shake it")
        )
    return lines


def beside_lines(study: SideBySide) -> list[str]:
    """The greatest loads of each study, and the highest resonances of all."""
    from gearcad.dynamics.level_verdict import LevelStudy

    wide = max(len(label) for label in (study.what, *study.labels))
    what = f"{study.what} ({study.key})" if study.key else study.what
    lines = [f"natural frequencies in 1/s, those that move alike below each other; {what}:"]
    for at, label in enumerate(study.labels):
        shown = ("–" if group[at] is None else f"{group[at]:.6g}" for group in study.natural_frequencies)
        lines.append(f"  {label:<{wide}}  {' '.join(f'{each:<9}' for each in shown)}".rstrip())
    for mesh in study.mesh_names:
        lines.append(f"K_v of {mesh}")
        lines += [f"  {label:<{wide}}  {_resonance_line(study, mesh, at)}" for at, label in enumerate(study.labels)]
    for mesh in study.mesh_names if study.errors else ():
        lines.append(f"K_v of {mesh} with tooth errors")
        lines += [f"  {label:<{wide}}  {_errors_line(found, mesh)}" for label, found in study.errors.items()]
    for shaft in study.shaft_names:
        lines.append(f"overload of {shaft}")
        own = [each for each in study.shaft_overloads if each.shaft == shaft]
        lines += [f"  {each.label:<{wide}}  {each.factor:.3f} at {each.speed:.5g} rpm" for each in own]
    return [*lines, *study.headlines] if isinstance(study, LevelStudy) else lines


def _errors_line(found: ErrorStudy, mesh: str) -> str:
    """The greatest median of a mesh, and the greatest of its upper quantile where there are several samples."""
    (most,) = (each for each in found.greatest if each.mesh == mesh)
    upper = f", 95 % quantile {most.upper:.3f} at {most.upper_speed:.5g} rpm" if found.samples > 1 else ""
    return f"at most {most.median:.3f} at {most.median_speed:.5g} rpm{' (median)' if upper else ''}{upper}"


def _resonance_line(study: SideBySide, mesh: str, at: int) -> str:
    """Return a line with the resonances of a mesh in one study, or with its greatest K_v if there are none."""
    shown = [each.shown[at] for each in study.resonances if each.mesh == mesh]
    if not any(shown):
        (found,) = (each for each in study.greatest if each.mesh == mesh and each.label == study.labels[at])
        return f"at most {found.factor:.3f}, at {found.speed:.5g} rpm: no resonance in the chart"
    return " ".join(f"{'' if peak is None else f'{peak.factor:.3f} at {peak.speed:.5g} rpm':<21}" for peak in shown).rstrip()


_MOST_PEAKS = 8

_MOST_ORDERS = 4
"""Greatest number of orders in a line."""


@click.command(short_help="Natural frequencies, dynamic factors and spectra of SPEC's pair or train.")
@spec_argument
@click.option(
    "--vary", "variations", multiple=True, metavar="KEY=VALUES", help="Another value, or several side by side; repeatable."
)
@click.option("--wav", is_flag=True, help="Write dynamics.wav too: what one would hear of the run in time or of one speed.")
@output_option
@json_option
@quiet_option
@debug_option
def dynamics(spec: Path, variations: tuple[str, ...], wav: bool, output: Path | None, as_json: bool, quiet: bool) -> None:
    """Dynamics of the pair of SPEC, under its [load], or of its [train]: what the stiffness of the teeth does to the machine.

    A train has its natural frequencies and modes, and the overload of its meshes and shafts over speed, for shafts that are
    left out, springs or continua (model). A pair by itself has its dynamic factor K_v beside that of ISO 6336-1, with flanks
    that part; with model "contact" in [dynamics] its Campbell diagram. Both run in time as well: with changing speed or torques
    by [dynamics.transient], or for the spectra of a Campbell diagram by campbell = "on". Inertias come from the gears' own
    solids, mesh stiffness from one of the methods of `gearcad stiffness`. Writes dynamics.html, dynamics.json, dynamics.npz
    (the arrays) and a CSV for every chart and table; of a train whose meshes are those of pairs also a spec of each pair under
    its load.

    --wav writes the forces between the flanks as a sound, without what is below 20 Hz: of the run in time, where there is one,
    else 3 s at the speed of the course. Screen and dynamics.json (sound) tell the greatest value, by which it is normalised.

    \b
    --vary train.model=exact                       this value in place of the spec's
    --vary "shaft.*.damping_ratio=0.01,0.05,0.1"   all over each other in one chart and table
    """
    if variations:
        job, design = _varied(spec, variations)
        job = replace(job, wav=wav)
    else:
        from gearcad.designs import read_spec
        from gearcad.jobs.dynamics import Dynamics

        job, design = Dynamics(wav=wav), read_spec(spec)
    study = perform_on(job, design, output, partial(_show, wav=wav), as_json=as_json, quiet=quiet)
    if not (quiet or as_json):
        _echo_next(study, output)


def _varied(spec: Path, variations: tuple[str, ...]) -> tuple[Dynamics, Design]:
    """Return the job for the variants of a spec, and the first of these designs."""
    from gearcad.designs.variations import read_variants
    from gearcad.jobs.dynamics import Dynamics, DynamicsBeside

    variants = read_variants(spec, variations)
    job = DynamicsBeside(variants=variants) if len(variants.designs) > 1 else Dynamics()
    return job, variants.designs[0]


def _echo_next(study: Study, output: Path | None) -> None:
    """Print the next command for the specs of a train's pairs, if there are any."""
    from gearcad.jobs.dynamics import specs_of

    folder = folder_of(output, study.name)
    if files := [shlex.quote(str(folder / name)) for name in specs_of(study)]:
        say(f"Next: gearcad check {files[0]}", err=True)


def _show(_name: str, study: Study, *, wav: bool = False) -> None:
    from gearcad.dynamics.sound import sound_of

    say("\n".join([*_lines(study), *([f"sound: {sound_of(study).words}"] if wav else [])]))
    echo_warnings(study.notices)


def _lines(study: Study) -> list[str]:
    """Return the results of a study in a few lines."""
    from gearcad.dynamics.pair_result import ContactStudy, PairStudy
    from gearcad.dynamics.train_result import ModalStudy
    from gearcad.dynamics.variant_comparison import SideBySide

    if isinstance(study, ContactStudy):
        return _contact_lines(study)
    if isinstance(study, ModalStudy):
        return [*_mode_lines(study.modes), *_order_lines(study), *_transient_lines(study)]
    if isinstance(study, SideBySide):
        return beside_lines(study)
    if not isinstance(study, PairStudy):
        return _train_lines(study)
    lines = [
        f"inertias                    {study.inertias[0]:.5g} and {study.inertias[1]:.5g} kg·m²",
        f"mesh stiffness              {study.cycle.mean:.5g} N/µm mean secant, {study.cycle.tangent_mean:.5g} tangent "
        f"({study.cycle.method})",
    ]
    factor = study.study.method_b
    if factor is not None:
        lines.append(f"resonance speed, ISO 6336-1 {factor.resonance_speed:.5g} rpm")
    return lines + _train_lines(study.study)


def _mode_lines(modes: NaturalModes) -> list[str]:
    heads = "".join(f"{name + ', rpm':>16}" for name in modes.meshes)
    lines = [f"{'natural frequency':<20}{'Hz':>10}{'1/s':>12}{heads}"]
    for number, (hertz, circular, speeds) in enumerate(zip(modes.frequency, modes.circular, modes.rpm, strict=True), 1):
        met = "  turns as a whole" if number <= modes.rigid else "".join(f"{speed:>16.5g}" for speed in speeds)
        lines.append(f"{number:<20}{hertz:>10.6g}{circular:>12.6g}{met}")
    return lines


def _train_lines(study: TrainStudy) -> list[str]:
    lines = [*map(_pair_line, study.pairs.values()), *_mode_lines(study.modes)]
    if study.on_bearings is not None:
        lines += bearing_mode_lines(study.on_bearings)
    if study.operating.heading:
        most = study.greatest_in_operation
        lines.append(f"K_v {study.operating.heading}at most {most.factor:.3f}, of {most.mesh} at {most.speed:.5g} rpm")
    for mesh, name in enumerate(study.up.mesh_names):
        up = _peaks(study, study.up, mesh)
        down = up if study.down is None else _peaks(study, study.down, mesh)
        lines += (
            [f"K_v of {name}: {up}"]
            if up == down
            else [f"K_v of {name}, running up: {up}", f"K_v of {name}, running down: {down}"]
        )
    factors = ", ".join(f"{factor:.3f} of {name}" for name, factor in zip(study.up.mesh_names, study.course.kv, strict=True))
    return [
        *lines,
        f"K_v at {study.course.speed:.6g} rpm: {factors}",
        *_error_lines(study),
        *_order_lines(study),
        *_transient_lines(study),
        *displacement_lines(study),
        *_campbell_lines(study),
    ]


def _order_lines(study: TrainStudy | ModalStudy) -> list[str]:
    """Return the greatest amplitudes of orders of each mesh and shaft, of a train with torques on its inertias."""
    if study.orders is None or not study.train.excitations:
        return []
    found: dict[str, list[str]] = {}
    for each in sorted(study.orders.greatest, key=lambda each: -each.amplitude):
        words = f"{each.amplitude:.4g} {each.unit} of order {each.order:.5g} ({each.source}) at {each.speed:.5g} rpm"
        found.setdefault(f"amplitude of {each.quantity} of {each.name}", []).append(words)
    return [f"{name}: {', '.join(words[:_MOST_ORDERS])}" for name, words in found.items()]


def _error_lines(study: TrainStudy) -> list[str]:
    """K_v with tooth errors that were drawn."""
    of = study.errors
    if of is None:
        return []
    if of.grade is None:
        return [f"K_v of {each.mesh}, single teeth: {each.most:.3f} at {each.most_speed:.5g} rpm" for each in of.greatest]
    if of.samples == 1:
        return [
            f"K_v of {each.mesh}, tooth errors of grade {of.grade}: up to {each.most:.3f} at {each.most_speed:.5g} rpm"
            for each in of.greatest
        ]
    return [
        f"K_v of {each.mesh}, tooth errors of grade {of.grade}, {of.samples} samples: median up to {each.median:.3f} at "
        f"{each.median_speed:.5g} rpm, 95 % quantile {each.upper:.3f} at {each.upper_speed:.5g} rpm, greatest "
        f"{each.most:.3f} at {each.most_speed:.5g} rpm"
        for each in of.greatest
    ]


def _pair_line(mesh: EngagedMesh) -> str:
    """Return the line of a pair: its torque, its driving gear, and the stiffness of its teeth."""
    course, cycle = mesh.course, mesh.course.cycle
    carried = f"{course.torque:.6g} N·m on its pinion, {mesh.gears.pick(course.driver)} drives"
    return (
        f"pair of {mesh.name}: {carried}; {cycle.mean:.5g} N/µm mean secant, {cycle.tangent_mean:.5g} tangent ({cycle.method})"
    )


def _campbell_lines(study: TrainStudy) -> list[str]:
    """Return the line about integrated spectra: number of speeds, chaotic ones, and the share of time without contact.

    Empty without spectra.
    """
    of = study.campbell
    if of is None:
        return []
    parted = of.out_of_contact
    flanks = f"flanks part for up to {100 * parted.max():.1f} %" if parted.any() else "flanks never part"
    runs = f"spectra at {len(of.speeds)} speeds, {of.duration:g} s each after {of.settled:.3g} s"
    return [f"{runs}: {int(of.chaotic.sum())} chaotic, {flanks}"]


def _transient_lines(study: TrainStudy | ModalStudy) -> list[str]:
    """The greatest loads of a run with changing speed or torque."""
    run = study.transient
    if run is None:
        return []
    (begin, end), options = run.speeds, run.options
    given = [f"{begin:.6g} to {end:.6g} rpm" if begin != end else f"{begin:.6g} rpm"]
    if options.torque_from != 1 or options.final_torque != 1:
        given.append(f"torques times {options.torque_from:g} to {options.final_torque:g}")
    lines = [f"in time: {', '.join(given)}, {options.duration:g} s by {1e6 * run.step:.3g} µs"]
    for mesh, each in enumerate(run.greatest):
        lasting = study.lasting(mesh)
        where = "speeds" if run.whole_load.all() else "speeds and torques"
        more = "" if lasting is None else f"; what lasts at these {where}: {lasting:.3f}"
        lines.append(f"greatest force of {each.name}: {each.factor:.3f} at {each.time:.4g} s, {each.speed:.5g} rpm{more}")
    lines += [
        f"greatest torque of {each.name}: {each.factor:.3f} at {each.time:.4g} s, {each.speed:.5g} rpm"
        for each in run.greatest_of_shafts
    ]
    times = {name: [each for each in run.partings if each.mesh == name] for name in run.names[0]}
    return lines + [
        f"flanks of {name} part first at {each[0].begin:.4g} s, last at {each[-1].end:.4g} s"
        for name, each in times.items()
        if each
    ]


def _peaks(study: TrainStudy, chart: KvChart, mesh: int) -> str:
    """The highest resonances of a mesh."""
    peaks = sorted(chart.peaks(mesh), key=lambda peak: -peak.factor)[:_MOST_PEAKS]
    listed = ", ".join(f"{peak.factor:.3f} at {float(study.rpm(peak.frequency)):.5g} rpm" for peak in peaks)
    return listed or "no resonance in the chart"


def _contact_lines(study: ContactStudy) -> list[str]:
    model, found = study.model, study.study
    several = f", {model.natural_frequency(model.contact_ratio):.6g} Hz with {model.contact_ratio:.4g}"
    natural = f"{model.natural_frequency():.6g} Hz with one pair of teeth" + several * (model.contact_ratio != 1)
    lines = [
        f"natural frequency           {natural}",
        f"damping ratio               {model.damping_ratio:.4g}",
        f"approach at rest            {model.static_approach:.5g} µm with one pair",
        f"{'rpm':>8}{'mean µm':>12}{'greatest µm':>14}{'parted %':>10}  highest peaks of the pinion's speed, Hz",
    ]
    for row, speed in enumerate(found.speeds.tolist()):
        peaks = ", ".join(f"{peak.frequency:.5g}" for peak in found.peaks(speed, 3))
        lines.append(
            f"{speed:>8g}{found.mean_approach[row]:>12.5g}{found.greatest_approach[row]:>14.5g}"
            f"{100 * found.out_of_contact[row]:>10.1f}  {peaks}{'  chaotic' if found.chaotic[row] else ''}"
        )
    return lines
