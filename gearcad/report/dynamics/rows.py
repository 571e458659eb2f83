"""What vibrates in a pair, as rows of a table: words, symbol, values, unit, source."""

from __future__ import annotations

from gearcad.dynamics.pair_result import ContactStudy, PairStudy
from gearcad.dynamics.trains.six_dof import PairOnBearings
from gearcad.plots.paper import short
from gearcad.report.check.tables import Row
from gearcad.schema import is_assumed

__all__ = ["contact_rows", "pair_dynamics_rows"]

_NONE = "–"  # an en dash where there is no value


def pair_dynamics_rows(study: PairStudy) -> list[Row]:
    """Inertias, mesh stiffness, damping, backlash and resonance of a pair by itself."""
    cycle, of = study.cycle, study.study
    mesh, modes = of.train.meshes[0], of.modes
    row, ratio = modes.rigid, of.options.damping_ratio
    rows = [
        Row("moment of inertia", "J", tuple(map(short, study.inertias)), "kg·m²", ""),
        Row("torque on the pinion", "T_1", (short(cycle.torque),), "N·m", ""),
        Row("force along the line of action, at rest", "F_bt", (short(float(of.up.static_forces[0])),), "N", ""),
        Row("mesh stiffness, mean secant", "k", (short(cycle.mean),), "N/µm", study.method),
        Row("mesh stiffness, mean tangent", "k", (short(cycle.tangent_mean),), "N/µm", "that of small vibrations"),
        Row("damping ratio of the pair", "ζ", (short(ratio),), "", "assumed" if is_assumed(ratio) else "given"),
        Row("damping of the mesh", "c", (short(float(of.system.mesh_damping[0])),), "N·s/m", "2 ζ √(k m)"),
        Row("backlash along the line of action", "", (_NONE if mesh.backlash is None else short(mesh.backlash),), "µm", ""),
    ]
    if study.bearings is not None:
        rows += _bearing_rows(study.bearings)
    elif row < len(modes):
        rows += [
            Row("natural frequency", f"f_{row + 1}", (short(modes.frequency[row]),), "Hz", f"{short(modes.circular[row])} 1/s"),
            Row("speed that meets it", "", (short(modes.rpm[row, 0]),), "rpm", "one tooth a vibration"),
        ]
    if of.method_b is not None:
        speed = short(of.method_b.resonance_speed)
        rows.append(Row("resonance speed", "n_E1", (speed,), "rpm", "ISO 6336-1:2006 (6)"))
    return rows


def _bearing_rows(of: PairOnBearings) -> list[Row]:
    listed = ", ".join(short(each) for each in of.frequencies() if each)
    return [
        Row("mass", "m", tuple(map(short, of.masses)), "kg", ""),
        Row("stiffness of the bearings", "", tuple(short(each[0]) for each in of.bearing_stiffness), "N/µm", "across the axis"),
        Row("damping of a bearing", "", (short(of.bearing_damping),), "N·s/m", ""),
        Row("natural frequencies on bearings", "f_2 to f_6", (listed,), "Hz", "besides 0 Hz: turns as a whole"),
    ]


def contact_rows(study: ContactStudy) -> list[Row]:
    """Parameters of a contact model, and what follows from them."""
    of = study.model
    radii = tuple(map(short, of.base_radii))
    whole = of.contact_ratio
    rows = [
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
    ]
    if whole != 1.0:
        rows.append(Row("natural frequency, mean stiffness", "", (short(of.natural_frequency(whole)),), "Hz", "at high speed"))
    return rows
