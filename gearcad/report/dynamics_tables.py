"""Tables of a study of dynamics: parts, modes, resonances, speeds, and which model is enough."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from gearcad.core.records import is_assumed
from gearcad.dynamics.level_agreement import CurveName, Difference
from gearcad.dynamics.level_verdict import LevelStudy, LevelVerdict
from gearcad.dynamics.pair_result import ContactStudy, PairStudy
from gearcad.dynamics.response.chart_findings import MetMode
from gearcad.dynamics.time_domain.spectra import SpeedSpectra
from gearcad.dynamics.train_result import ModalStudy, TrainStudy
from gearcad.dynamics.trains.members import Shaft, StiffnessWave, ToothMesh
from gearcad.dynamics.trains.pair_on_bearings import PairOnBearings
from gearcad.dynamics.trains.train import EngagedMesh, TrainModel
from gearcad.dynamics.trains.train_modes import ComponentModes, NaturalModes
from gearcad.plots.paper import short
from gearcad.report.document import ReportRow

_NONE = "–"  # an en dash where there is no value

_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")

MOST_PEAKS = 12
"""Resonances of a mesh that are listed, the highest."""

_LISTED = 2
"""Peaks of a spectrum that the table of speeds names: more would make it too wide for a page."""


class WordTable(NamedTuple):
    """Heads and cells (text) of a table; the first `words` columns are words, the others numbers."""

    heads: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    words: int = 1


# ---------------------------------------------------------------------- parts of a train


def inertia_table(study: TrainStudy | ModalStudy) -> WordTable:
    """Inertias of the train with the torques on them and their speeds."""
    train, ratios = study.train, study.train.speed_ratios
    first = "pinion" if train.meshes else "inertia"
    rows = [
        (each.name, short(each.inertia), short(train.torques.get(each.name, 0.0)), short(ratios[each.name]))
        for each in train.inertias
    ]
    return WordTable(("inertia", "kg·m²", "torque, N·m", f"turns per turn of the first {first}"), rows)


def shaft_table(study: TrainStudy | ModalStudy) -> WordTable:
    """Shafts, and where the chart has them, their greatest overload."""
    heads = ("shaft", "from, to", "stiffness, N·m/rad", "inertia, kg·m²", "damping")
    charted = isinstance(study, TrainStudy)
    rows = []
    for shaft in study.train.shafts:
        overload = _overload(study, shaft) if isinstance(study, TrainStudy) else ()
        mass = 0.0 if study.train.model is TrainModel.MASSLESS else shaft.inertia
        fixed = (f"{shaft.start}, {shaft.end}", short(shaft.stiffness), _or_none(mass), _shaft_damping(shaft))
        rows.append((_shaft_words(shaft), *fixed, *overload))
    return WordTable((*heads, "at rest, N·m", "overload", "at rpm") if charted else heads, rows, 2)


def _overload(study: TrainStudy, shaft: Shaft) -> tuple[str, ...]:
    """Torque at rest, greatest overload and its speed, where the chart has them."""
    found = study.shaft_overloads.get(shaft.name)
    return (_NONE,) * 3 if found is None else tuple(map(short, (found.torque, found.factor, found.speed)))


def _shaft_words(shaft: Shaft) -> str:
    if shaft.length is None or shaft.diameter is None:
        return shaft.name
    bore = f"/{short(shaft.inner_diameter)}" if shaft.inner_diameter else ""
    return f"{shaft.name}, ⌀{short(shaft.diameter)}{bore} × {short(shaft.length)} mm"


def _shaft_damping(shaft: Shaft) -> str:
    parts = [f"ratio {short(shaft.damping_ratio)}"] if shaft.damping_ratio else []
    parts += [f"{short(shaft.damping)} N·m·s/rad"] if shaft.damping else []
    return ", ".join(parts) or _NONE


def mesh_table(study: TrainStudy) -> WordTable:
    """Meshes of the train, their damping and the force that they carry at rest."""
    heads = (
        "mesh",
        "of",
        "stiffness",
        "z₁",
        "r_b, mm",
        "mean, N/µm",
        "damping, N·s/m",
        "backlash, µm",
        "force at rest, N",
    )
    rows = []
    for mesh, damping, force in zip(study.train.meshes, study.system.mesh_damping, study.up.static_forces, strict=True):
        radii = " and ".join(short(radius) for radius in mesh.base_radii)
        backlash = _NONE if mesh.backlash is None else short(mesh.backlash)
        gears = f"{mesh.pinion}, {'ring ' if mesh.internal else ''}{mesh.wheel}"
        numbers = (short(mesh.stiffness), _or_none(float(damping)), backlash, short(float(force)))
        rows.append((mesh.name, gears, _wave(mesh), str(mesh.teeth), radii, *numbers))
    return WordTable(heads, rows, 3)


def pair_table(study: TrainStudy) -> WordTable:
    """Return the table of the pairs of meshes: pair, method of its stiffness, torque, stiffness and transmission error."""
    heads = (
        "mesh",
        "pair",
        "method",
        "drives",
        "on its pinion, N·m",
        "secant, N/µm",
        "tangent, N/µm",
        "error, µm peak to peak",
    )
    rows = []
    for name, mesh in study.pairs.items():
        course, cycle = mesh.course, mesh.course.cycle
        numbers = (course.torque, cycle.mean, cycle.tangent_mean, cycle.error_peak_to_peak)
        rows.append((name, mesh.teeth_of.pair.name, course.title, mesh.gears.pick(course.driver), *map(short, numbers)))
    return WordTable(heads, rows, 4)


def _wave(mesh: ToothMesh) -> str:
    if isinstance(mesh, EngagedMesh):
        words = "of its pair"
    elif mesh.shape is StiffnessWave.SQUARE and mesh.contact_ratio is not None:
        words = f"square, contact ratio {short(mesh.contact_ratio)}"
    else:
        words = f"cosine, ± {short(100 * mesh.variation)} %" if mesh.variation else "constant"
    return f"{words}, delayed by {short(mesh.phase)} teeth" if mesh.phase else words


# ---------------------------------------------------------------------- modes and resonances


def mode_table(modes: NaturalModes) -> WordTable:
    """Natural frequencies, the speeds that meet them, and where their energy is."""
    several = len(modes.meshes) > 1
    heads = ["mode", "Hz", "1/s"]
    heads += [f"met at rpm, {name}" if several else "met at rpm" for name in modes.meshes]
    heads += [f"energy in {name}, %" if several else "energy in the mesh, %" for name in modes.meshes]
    rows = []
    for mode in range(len(modes)):
        rigid = mode < modes.rigid
        speeds = [_NONE if rigid else short(speed) for speed in modes.rpm[mode]]
        shares = [_NONE if rigid else f"{100 * share:.1f}" for share in modes.potential_meshes[mode]]
        name = f"{mode + 1}, turns as a whole" if rigid else f"{mode + 1}, most in {' and '.join(modes.leading_parts[mode])}"
        rows.append((name, short(modes.frequency[mode]), short(modes.circular[mode]), *speeds, *shares))
    return WordTable(tuple(heads), rows)


def shape_table(modes: NaturalModes) -> WordTable:
    """Turns of the inertias in every mode, their squares summing up to 1."""
    heads = ("turns in mode", "1/s", *modes.inertias)
    rows = [
        (str(number), short(circular), *(f"{turn:z.4f}" for turn in shape))
        for number, (circular, shape) in enumerate(zip(modes.circular, modes.unit_shape, strict=True), 1)
    ]
    return WordTable(heads, rows)


def component_table(modes: ComponentModes) -> WordTable:
    """Modes of the lines of which the model is made: turns of the inertias and of the middles of the shafts."""
    heads = ("component mode", "Hz", "1/s", *modes.inertias, *(f"middle of {name}" for name in modes.shafts))
    rows = []
    for number, circular in enumerate(modes.circular.tolist(), 1):
        turns = (*modes.shape[number - 1], *modes.middle[number - 1])
        cells = (f"{turn:z.2f}" if turn else _NONE for turn in turns)
        rows.append((str(number), short(circular / (2 * math.pi)), short(circular), *cells))
    return WordTable(heads, rows)


def peak_table(study: TrainStudy) -> WordTable:
    """Resonances of every mesh in the charts, of each the highest, by speed."""
    heads = ("mesh", "near", "pinion, rpm", "tooth frequency, Hz", "1/s", "K_v", "with dampers")
    rows = []
    for name in study.up.mesh_names:
        own = [each for each in study.resonances if each.mesh == name]
        highest = sorted(own, key=lambda each: -each.factor)[:MOST_PEAKS]
        for each in sorted(highest, key=lambda each: (each.frequency, each.factor)):
            senses = " and ".join(direction.value for direction in each.directions)
            words = f"{name}, running {senses}" if senses else name
            last = "" if each.stable else ", unstable"
            numbers = map(short, (each.speed, each.tooth_frequency, each.tooth_circular))
            factors = map(factor_text, (each.factor, each.damped))
            rows.append((words, _met(each.met, study) + last, *numbers, *factors))
    return WordTable(heads, rows, 2)


def _met(mode: MetMode | None, study: TrainStudy) -> str:
    """A natural frequency by its number: f₂, or f₂/3 where the third harmonic meets it; of gears on bearings, what moves."""
    if mode is None:
        return _NONE
    name = "f" + str(mode.mode).translate(_LOWERED)
    owner = f" of {mode.mesh}" if mode.mesh else ""
    part = "" if mode.harmonic == 1 else f"/{mode.harmonic}"
    moves = "" if study.on_bearings is None else f": {study.on_bearings.words[mode.mode - 1]}"
    return f"{name}{part}{owner}{moves}"


def factor_text(factor: float) -> str:
    """Return K_v with three decimals if it is small enough for them to matter."""
    return f"{factor:.3f}" if factor < 10 else short(factor)


def speed_table(study: SpeedSpectra) -> WordTable:
    """Statistics of the motion at every speed of a Campbell study."""
    heads = (
        "rpm",
        "tooth, Hz",
        "mean, µm",
        "greatest",
        "with start",
        "parted, %",
        "growth, 1/s",
        "digits lost",
        "peaks, Hz",
        "",
    )
    columns = (study.mean_approach, study.greatest_approach, study.deepest)
    rows = []
    for row, speed in enumerate(study.speeds.tolist()):
        peaks = ", ".join(short(peak.frequency) for peak in study.peaks(speed, _LISTED))
        numbers = (short(speed), short(float(study.tooth_frequencies()[row])), *(short(float(each[row])) for each in columns))
        parted, growth = f"{100 * study.out_of_contact[row]:.1f}", f"{study.growth[row]:.0f}"
        chaotic = "chaotic" if study.chaotic[row] else ""
        rows.append((*numbers, parted, growth, f"{study.digits_lost[row]:.1f}", peaks or _NONE, chaotic))
    return WordTable(heads, rows, 0)


def _or_none(value: float) -> str:
    return short(value) if value else _NONE


def pair_dynamics_rows(study: PairStudy) -> list[ReportRow]:
    """Inertias, mesh stiffness, damping, backlash and resonance of a pair by itself."""
    cycle, of = study.cycle, study.study
    mesh, modes = of.train.meshes[0], of.modes
    row, ratio = modes.rigid, of.options.damping_ratio
    rows = [
        ReportRow("moment of inertia", "J", tuple(map(short, study.inertias)), "kg·m²", ""),
        *(
            []
            if study.rack_mass is None
            else [ReportRow("mass that moves with the rack", "m_2", (_NONE, short(study.rack_mass)), "kg", "J_2 = m_2 r²")]
        ),
        ReportRow("torque on the pinion", "T_1", (short(cycle.torque),), "N·m", ""),
        ReportRow("force along the line of action, at rest", "F_bt", (short(float(of.up.static_forces[0])),), "N", ""),
        ReportRow("mesh stiffness, mean secant", "k", (short(cycle.mean),), "N/µm", study.method),
        ReportRow("mesh stiffness, mean tangent", "k", (short(cycle.tangent_mean),), "N/µm", "that of small vibrations"),
        ReportRow("damping ratio of the pair", "ζ", (short(ratio),), "", "assumed" if is_assumed(ratio) else "given"),
        ReportRow("damping of the mesh", "c", (short(float(of.system.mesh_damping[0])),), "N·s/m", "2 ζ √(k m)"),
        ReportRow(
            "backlash along the line of action", "", (_NONE if mesh.backlash is None else short(mesh.backlash),), "µm", ""
        ),
    ]
    if study.bearings is not None:
        rows += _bearing_rows(study.bearings)
    elif row < len(modes):
        rows += [
            ReportRow(
                "natural frequency", f"f_{row + 1}", (short(modes.frequency[row]),), "Hz", f"{short(modes.circular[row])} 1/s"
            ),
            ReportRow("speed that meets it", "", (short(modes.rpm[row, 0]),), "rpm", "one tooth a vibration"),
        ]
    if of.method_b is not None:
        speed = short(of.method_b.resonance_speed)
        rows.append(ReportRow("resonance speed", "n_E1", (speed,), "rpm", "ISO 6336-1:2006 (6)"))
    return rows


def _bearing_rows(of: PairOnBearings) -> list[ReportRow]:
    listed = ", ".join(short(each) for each in of.frequencies() if each)
    return [
        ReportRow("mass", "m", tuple(map(short, of.masses)), "kg", ""),
        ReportRow(
            "stiffness of the bearings", "", tuple(short(each[0]) for each in of.bearing_stiffness), "N/µm", "across the axis"
        ),
        ReportRow("damping of a bearing", "", (short(of.bearing_damping),), "N·s/m", ""),
        ReportRow("natural frequencies on bearings", "f_2 to f_6", (listed,), "Hz", "besides 0 Hz: turns as a whole"),
    ]


def contact_rows(study: ContactStudy) -> list[ReportRow]:
    """Parameters of a contact model, and what follows from them."""
    of = study.model
    radii = tuple(map(short, of.base_radii))
    whole = of.contact_ratio
    rows = [
        ReportRow("moment of inertia", "J", tuple(map(short, of.inertias)), "kg·m²", ""),
        ReportRow("base radius", "R_b", radii, "mm", ""),
        ReportRow("reduced mass", "m", (short(of.reduced_mass),), "kg", "of J over squared base radius"),
        ReportRow("torque on the pinion", "T_1", (short(of.torque),), "N·m", ""),
        ReportRow("force along the line of action", "F", (short(of.force),), "N", "torque over base radius"),
        ReportRow("stiffness of a pair of teeth", "k", (short(of.pair_stiffness),), "N/µm", ""),
        ReportRow("damping", "b", (short(of.damping),), "N·s/m", "acts also where flanks have parted"),
        ReportRow("damping ratio, one pair", "ζ", (short(of.damping_ratio),), "", "b/(2 √(k m))"),
        ReportRow("approach at rest, one pair", "y_0", (short(of.static_approach),), "µm", "F/k"),
        ReportRow("pairs that carry, on the mean", "", (short(whole),), "", of.zone.value),
        ReportRow("natural frequency, one pair", "", (short(of.natural_frequency()),), "Hz", "√(k/m)/(2π)"),
    ]
    if whole != 1.0:
        rows.append(
            ReportRow("natural frequency, mean stiffness", "", (short(of.natural_frequency(whole)),), "Hz", "at high speed")
        )
    return rows


def verdict_table(of: LevelStudy) -> WordTable:
    """Return the table of all models but the reference: their status, and their greatest underestimate and overestimate."""
    finest = of.labels[of.reference]
    heads = ("model", "is", "greatest difference", "of", "at rpm", f"{finest}", "model", "% of the load")
    rows = []
    for each in of.verdicts:
        sides = (("too little", each.agreement.underestimate), ("too much", each.agreement.overestimate))
        for number, (words, found) in enumerate(sides):
            head = (each.model.value, each.status.value) if not number else ("", "")
            rows.append((*head, words, *_difference(found, swapped=bool(number))))
    return WordTable(heads, rows, 4)


def _difference(found: Difference | None, *, swapped: bool) -> tuple[str, ...]:
    if found is None:
        return ("nothing that is judged", *(_NONE,) * 4)
    reference, level = (found.other, found.greater) if swapped else (found.greater, found.other)
    numbers = (short(found.speed), factor_text(reference), factor_text(level), f"{100 * max(found.excess, 0.0):.1f}")
    return (_curve(found.curve), *numbers)


def _curve(curve: CurveName) -> str:
    return f"{curve.kind} {curve.name}" if not curve.name.startswith(curve.kind) else curve.name


def level_resonance_table(of: LevelStudy) -> WordTable:
    """Resonances of the reference in the range, and what each model makes of them."""
    heads = ("model", "mesh", "", "at rpm", "K_v", "model: near", "its resonance, rpm", "off, %", "K_v")
    rows = []
    for verdict in of.verdicts:
        for each in verdict.resonances:
            own = (_NONE,) * 3
            if each.own_speed is not None and each.own_factor is not None and each.moved is not None:
                own = (short(each.own_speed), f"{100 * each.moved:+.2f}", factor_text(each.own_factor))
            missed = "missed" if each.missed else ""
            numbers = (short(each.speed), factor_text(each.factor), factor_text(each.near))
            rows.append((verdict.model.value, each.mesh, missed, *numbers, *own))
    return WordTable(heads, rows, 3)


def deciding_table(of: LevelStudy) -> WordTable:
    """Return the table of the effects that each model lacks where it fails."""
    heads = ("model", "of", "shaken by", "what it lacks", "at rpm", "mode", "Hz", "share, %")
    return WordTable(heads, [row for verdict in of.verdicts for row in _decisions(verdict)], 4)


def _decisions(verdict: LevelVerdict) -> Iterator[tuple[str, ...]]:
    for each in verdict.decisions:
        teeth = f"{short(each.harmonic)} × {each.teeth}"
        for share in each.shares:
            part = f"{share.part}, {share.energy} energy"
            numbers = (short(each.speed), str(each.mode), short(each.frequency), f"{100 * share.share:.1f}")
            yield (verdict.model.value, _curve(each.curve), teeth, part, *numbers)


def unjudged_table(of: LevelStudy) -> WordTable:
    """Speeds, and shafts, at which a model is not held against the reference."""
    rows = []
    for verdict in of.verdicts:
        for each in verdict.agreement.not_judged:
            charts = f", in {each.charts[0]}" if len(each.charts) == 1 else ""
            rows.append((verdict.model.value, each.reason.value + charts, short(each.first), short(each.last)))
        for shaft in verdict.agreement.unheld:
            rows.append((verdict.model.value, f"shaft {shaft} has an overload in one of both only", _NONE, _NONE))
        for doubt in verdict.agreement.doubts:
            rows.append((verdict.model.value, f"{doubt.words}, in {' and '.join(doubt.charts)}", _NONE, _NONE))
    rows += [("all", f"shaft {shaft} carries next to nothing at rest", _NONE, _NONE) for shaft in of.idle_shafts]
    return WordTable(("model", "not judged, or not sure", "from rpm", "to rpm"), rows, 2)
