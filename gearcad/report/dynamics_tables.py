"""Parts, natural modes, resonances and speeds of a study of dynamics as tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gearcad.dynamics.campbell import CampbellStudy
from gearcad.dynamics.modes import NaturalModes
from gearcad.dynamics.pair_study import ContactStudy, PairStudy
from gearcad.dynamics.shafts import shaft_inertia, shaft_stiffness
from gearcad.dynamics.study import TrainStudy
from gearcad.dynamics.train import Mesh, Shaft, StiffnessWave, TrainModel
from gearcad.plots.paper import short
from gearcad.report.tables import Row
from gearcad.stiffness import METHODS

__all__ = [
    "Table",
    "contact_rows",
    "inertia_table",
    "mesh_table",
    "mode_table",
    "pair_dynamics_rows",
    "peak_table",
    "shaft_table",
    "speed_table",
]

_NONE = "–"  # an en dash where there is no value

_NEAR = 0.04
"""How far a resonance may be from a natural frequency whose name it gets: damping and parting flanks move it."""

_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")

_LISTED = 3
"""Peaks of a spectrum that the table of speeds names."""


class Table(NamedTuple):
    """Heads and cells (text) of a table; the first `words` columns are words, the others numbers."""

    heads: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    words: int = 1


# ---------------------------------------------------------------------- parts of a train


def inertia_table(study: TrainStudy) -> Table:
    """Inertias of the train with the torques on them and their speeds."""
    train, ratios = study.train, study.train.speed_ratios
    rows = [
        (each.name, short(each.inertia), short(train.torques.get(each.name, 0.0)), short(ratios[each.name]))
        for each in train.inertias
    ]
    return Table(("inertia", "kg·m²", "torque, N·m", "turns per turn of the first pinion"), rows)


def shaft_table(study: TrainStudy) -> Table:
    """Shafts, and where the chart has them, their greatest overload."""
    chart = study.up
    heads = ("shaft", "from, to", "stiffness, N·m/rad", "inertia, kg·m²", "damping", "at rest, N·m", "overload", "at rpm")
    rows = []
    for shaft in study.train.shafts:
        own = chart.shaft_names.index(shaft.name) if shaft.name in chart.shaft_names else None
        known = own is not None and bool(np.isfinite(chart.shaft_factors[:, own]).all())
        overload = (_NONE, _NONE, _NONE)
        if own is not None and known:
            row = int(chart.shaft_factors[:, own].argmax())
            overload = tuple(map(short, (chart.shaft_references[own], chart.shaft_factors[row, own], study.speeds[row])))  # type: ignore[assignment]
        mass = 0.0 if study.train.model is TrainModel.MASSLESS else shaft_inertia(shaft)
        fixed = (f"{shaft.start}, {shaft.end}", short(shaft_stiffness(shaft)), _or_none(mass), _shaft_damping(shaft))
        rows.append((_shaft_words(shaft), *fixed, *overload))
    return Table(heads, rows, 2)


def _shaft_words(shaft: Shaft) -> str:
    if shaft.length is None or shaft.diameter is None:
        return shaft.name
    bore = f"/{short(shaft.inner_diameter)}" if shaft.inner_diameter else ""
    return f"{shaft.name}, ⌀{short(shaft.diameter)}{bore} × {short(shaft.length)} mm"


def _shaft_damping(shaft: Shaft) -> str:
    parts = [f"ratio {short(shaft.damping_ratio)}"] if shaft.damping_ratio else []
    parts += [f"{short(shaft.damping)} N·m·s/rad"] if shaft.damping else []
    return ", ".join(parts) or _NONE


def mesh_table(study: TrainStudy) -> Table:
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
    return Table(heads, rows, 3)


def _wave(mesh: Mesh) -> str:
    if mesh.shape is StiffnessWave.SQUARE and mesh.contact_ratio is not None:
        words = f"square, contact ratio {short(mesh.contact_ratio)}"
    else:
        words = f"cosine, ± {short(100 * mesh.variation)} %" if mesh.variation else "constant"
    return f"{words}, phase {short(mesh.phase)}" if mesh.phase else words


# ---------------------------------------------------------------------- modes and resonances


def mode_table(modes: NaturalModes) -> Table:
    """Natural frequencies, the speeds that meet them, and where their energy is."""
    several = len(modes.meshes) > 1
    heads = ["mode", "Hz", "1/s"]
    heads += [f"rpm, by {name}" if several else "met at rpm" for name in modes.meshes]
    heads += [f"energy in {name}, %" if several else "energy in the mesh, %" for name in modes.meshes]
    rows = []
    for mode in range(len(modes)):
        rigid = mode < modes.rigid
        numbers = [modes.frequency[mode], modes.circular[mode], *modes.rpm[mode]]
        shares = [_NONE if rigid else f"{100 * share:.1f}" for share in modes.potential_meshes[mode]]
        name = f"{mode + 1}, turns as a whole" if rigid else f"{mode + 1}, {_greatest(modes, mode)}"
        rows.append((name, *(_or_none(float(number)) if rigid else short(number) for number in numbers), *shares))
    return Table(tuple(heads), rows)


def _greatest(modes: NaturalModes, mode: int) -> str:
    """Which parts move most and give way most."""
    moving = _named(modes.inertias, modes.kinetic_inertias[mode]) + _named(modes.shafts, modes.kinetic_shafts[mode], "shaft ")
    bent = _named(modes.shafts, modes.potential_shafts[mode], "shaft ")
    bent += _named(modes.meshes, modes.potential_meshes[mode], "mesh ")
    names = dict.fromkeys(max(each)[1] for each in (moving, bent))
    return f"most in {' and '.join(names)}"


def _named(names: tuple[str, ...], shares: np.ndarray, kind: str = "") -> list[tuple[float, str]]:
    return [
        (float(share), name if name.startswith(kind.strip()) else kind + name)
        for name, share in zip(names, shares, strict=True)
    ]


def peak_table(study: TrainStudy) -> Table:
    """Resonances of every mesh in the charts, by speed."""
    heads = ("mesh", "near", "pinion, rpm", "tooth frequency, Hz", "1/s", "K_v")
    rows = []
    for mesh, name in enumerate(study.up.mesh_names):
        senses: dict[tuple[float, str], list[str]] = {}
        for sense, chart in (("up", study.up), ("down", study.down)):
            for peak in chart.peaks(mesh) if chart is not None else ():
                senses.setdefault((peak.frequency, f"{peak.factor:.3f}"), []).append(sense)
        for (frequency, factor), each in sorted(senses.items()):
            own = _ratio(study, mesh) * frequency
            numbers = (float(study.rpm(np.array(frequency))), own / (2 * np.pi), own)
            words = name if study.down is None else f"{name}, running {' and '.join(each)}"
            rows.append((words, _near(study, mesh, frequency), *map(short, numbers), factor))
    return Table(heads, rows, 2)


def _ratio(study: TrainStudy, mesh: int) -> float:
    return float(study.excitation.meshes[mesh].frequency_ratio)


def _near(study: TrainStudy, mesh: int, frequency: float) -> str:
    """The natural frequency that the lowest harmonic of a tooth frequency (1/s of the first mesh) meets there."""
    found = [
        (harmonic, abs(harmonic * _ratio(study, other) * frequency / circular - 1), mode + 1, other)
        for other in range(len(study.excitation.meshes))
        for harmonic in range(1, study.options.harmonics + 1)
        for mode, circular in enumerate(study.modes.circular)
        if circular
    ]
    near = [each for each in found if each[1] < _NEAR]
    if not near:
        return _NONE
    # Its own teeth before those of another mesh.
    harmonic, _, mode, other = min(near, key=lambda each: (each[0], each[3] != mesh, each[1]))
    of = "" if _ratio(study, other) == _ratio(study, mesh) else f" of {study.up.mesh_names[other]}"
    name = "f" + str(mode).translate(_LOWERED)
    return f"{name}{of}" if harmonic == 1 else f"{name}/{harmonic}{of}"


# ---------------------------------------------------------------------- pairs


def pair_dynamics_rows(study: PairStudy) -> list[Row]:
    """Inertias, mesh stiffness, damping, backlash and resonance of a pair by itself."""
    cycle, of = study.cycle, study.study
    mesh, modes = of.train.meshes[0], of.modes
    row = modes.rigid
    rows = [
        Row("moment of inertia", "J", tuple(map(short, study.inertias)), "kg·m²", ""),
        Row("torque on the pinion", "T_1", (short(cycle.torque),), "N·m", ""),
        Row("force along the line of action, at rest", "F_bt", (short(float(of.up.static_forces[0])),), "N", ""),
        Row("mesh stiffness, mean secant", "k", (short(cycle.mean),), "N/µm", METHODS[cycle.method].title),
        Row("mesh stiffness, mean tangent", "k", (short(cycle.tangent_mean),), "N/µm", "that of small vibrations"),
        Row("damping ratio of the pair", "ζ", (short(of.options.damping_ratio),), "", ""),
        Row("damping of the mesh", "c", (short(float(of.system.mesh_damping[0])),), "N·s/m", "2 ζ √(k m)"),
        Row("backlash along the line of action", "", (_NONE if mesh.backlash is None else short(mesh.backlash),), "µm", ""),
    ]
    if row < len(modes):
        rows += [
            Row("natural frequency", f"f_{row + 1}", (short(modes.frequency[row]),), "Hz", f"{short(modes.circular[row])} 1/s"),
            Row("speed that meets it", "", (short(modes.rpm[row, 0]),), "rpm", "one tooth a vibration"),
        ]
    if of.method_b is not None:
        speed = short(of.method_b.resonance_speed)
        rows.append(Row("resonance speed", "n_E1", (speed,), "rpm", "ISO 6336-1:2006 (6)"))
    return rows


def contact_rows(study: ContactStudy) -> list[Row]:
    """Parameters of a contact model, and what follows from them."""
    of = study.model
    radii = tuple(map(short, of.base_radii))
    whole = of.contact_ratio
    return [
        Row("moment of inertia", "J", tuple(map(short, of.inertias)), "kg·m²", ""),
        Row("base radius", "R_b", radii, "mm", ""),
        Row("reduced mass", "m", (short(of.reduced_mass),), "kg", "of J over squared base radius"),
        Row("torque on the pinion", "T_1", (short(of.torque),), "N·m", ""),
        Row("force along the line of action", "F", (short(of.force),), "N", "torque over base radius"),
        Row("stiffness of a pair of teeth", "k", (short(of.pair_stiffness),), "N/µm", ""),
        Row("damping", "b", (short(of.damping),), "N·s/m", "acts also where flanks have parted"),
        Row("damping ratio, one pair", "ζ", (short(of.damping_ratio),), "", "b/(2 √(k m))"),
        Row("approach at rest, one pair", "y_0", (short(of.static_approach),), "µm", "F/k"),
        Row("pairs that carry, on the mean", "", (short(whole),), "", of.zone.value),
        Row("natural frequency, one pair", "", (short(of.natural_frequency()),), "Hz", "√(k/m)/(2π)"),
        Row("natural frequency, mean stiffness", "", (short(of.natural_frequency(whole)),), "Hz", "at high speed"),
    ]


def speed_table(study: CampbellStudy) -> Table:
    """Statistics of the motion at every speed of a Campbell study."""
    heads = (
        "rpm",
        "tooth frequency, Hz",
        "approach, mean, µm",
        "greatest",
        "with the start",
        "parted, %",
        "growth, 1/s",
        "digits lost",
        "highest peaks, Hz",
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
    return Table(heads, rows, 0)


def _or_none(value: float) -> str:
    return short(value) if value else _NONE
