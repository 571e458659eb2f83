"""Parts, natural modes, resonances and speeds of a study of dynamics as tables."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from gearcad.dynamics.charts.findings import MetMode
from gearcad.dynamics.tooth_springs.speed_spectra import SpeedSpectra
from gearcad.dynamics.train_result import ModalStudy, TrainStudy
from gearcad.dynamics.trains.eigenmodes import ComponentModes, NaturalModes
from gearcad.dynamics.trains.engaged_mesh import EngagedMesh
from gearcad.dynamics.trains.members import Mesh, Shaft, StiffnessWave
from gearcad.dynamics.trains.train import TrainModel
from gearcad.plots.paper import short

__all__ = [
    "MOST_PEAKS",
    "WordTable",
    "component_table",
    "factor_text",
    "inertia_table",
    "mesh_table",
    "mode_table",
    "pair_table",
    "peak_table",
    "shaft_table",
    "shape_table",
    "speed_table",
]

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
    """What the pairs of meshes are and carry, by which method their stiffness was found, and what it came to."""
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


def _wave(mesh: Mesh) -> str:
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
    """K_v: three decimals of what is of interest."""
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
