"""Tables of dynamics results for spreadsheets: named columns, each with its unit in the heading."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from gearcad.core.records import Bools, Floats, Wholes
from gearcad.dynamics.response.chart_findings import Charts
from gearcad.dynamics.response.order_chart import OrderChart
from gearcad.dynamics.time_domain.spectra import SpeedSpectra
from gearcad.dynamics.time_domain.time_history import TimeHistory
from gearcad.dynamics.time_domain.transient_result import Transient
from gearcad.dynamics.trains.speed_orders import SpeedOrder
from gearcad.dynamics.trains.train_modes import ComponentModes, NaturalModes
from gearcad.mesh_cycle import MeshCycle

Columns = Mapping[str, Floats | Bools | Wholes | Sequence[Any]]
"""Columns of a table, in order, all of one length; None and nan are cells without a value."""

Tables = dict[str, Columns]
"""Tables of a result, by name."""

_PEAKS = 6
"""Number of peaks of a spectrum in a row of a Campbell study."""

_MOST_ROWS = 20_000
"""Greatest number of rows of a motion over time: a spreadsheet is slow with more, and the .npz file has them all."""


def named_columns(quantity: str, names: Sequence[str], values: Floats, unit: str = "") -> Columns:
    """Return a column for each of the names, of values (rows, names)."""
    ending = f" ({unit})" if unit else ""
    return {f"{quantity}.{name}{ending}": column for name, column in zip(names, values.T, strict=True)}


def chart_columns(charts: Charts) -> Columns:
    """Return K_v of meshes and overload of shafts over speed, running up and, where that differs, down."""
    up = charts.up
    found: dict[str, Any] = {
        "speed (rpm)": charts.speeds,
        "tooth_frequency (Hz)": up.frequencies / (2 * np.pi),
        "tooth_frequency (1/s)": up.frequencies,
    }
    for direction, chart in charts.directions():
        ending = "" if chart is up else f"_{direction.value}"
        found |= named_columns(f"kv{ending}", chart.mesh_names, chart.factors)
        found |= named_columns(f"kv_with_damping{ending}", chart.mesh_names, chart.damped)
        found |= named_columns(f"least_force{ending}", chart.mesh_names, chart.least * chart.static_forces, "N")
        found |= named_columns(f"shaft_overload{ending}", chart.shaft_names, chart.shaft_factors)
        found[f"stable{ending}"] = chart.stable
    if up.standard is not None:
        found["kv_iso6336"] = up.standard
    return found


def chart_tables(charts: Charts) -> Tables:
    """Return all tables over speed: overload, displacements, lines of the transmission error, and bearing forces."""
    found: Tables = {"chart": chart_columns(charts)}
    speeds = {"speed (rpm)": charts.speeds}
    for direction, chart in charts.directions():
        ending = "" if chart is charts.up else f" {direction.value}"
        moved, lines, bearings = chart.displacements, chart.transmission, chart.bearings
        found[f"displacements{ending}"] = {
            **speeds,
            **named_columns("turn_amplitude", moved.inertia_names, moved.turns, "arcsec"),
            **named_columns("turn_greatest", moved.inertia_names, moved.farthest, "arcsec"),
            **named_columns("approach_amplitude", moved.mesh_names, moved.approaches, "µm"),
            **named_columns("approach_greatest", moved.mesh_names, moved.deepest, "µm"),
        }
        orders = [f"order {order:.12g}" for order in lines.orders.tolist()]
        found[f"transmission error{ending}"] = speeds | {
            heading: column
            for mesh, name in enumerate(chart.mesh_names)
            for heading, column in named_columns(name, orders, lines.amplitudes[:, :, mesh], "µm").items()
        }
        if bearings is not None:
            found[f"bearings{ending}"] = {
                **speeds,
                **named_columns("greatest_force", bearings.gears, bearings.greatest, "N"),
                **named_columns("greatest_along", bearings.gears, bearings.along[:, 0], "N"),
                **named_columns("least_along", bearings.gears, bearings.along[:, 1], "N"),
                **named_columns("greatest_across", bearings.gears, bearings.across[:, 0], "N"),
                **named_columns("least_across", bearings.gears, bearings.across[:, 1], "N"),
                **named_columns("travel_along", bearings.gears, bearings.travels_along, "µm"),
                **named_columns("travel_across", bearings.gears, bearings.travels_across, "µm"),
            }
    return found


def mode_columns(modes: NaturalModes) -> Columns:
    """Return natural frequencies, the speeds that meet them, mode shapes, and the distribution of the energy."""
    return {
        "mode": np.arange(1, len(modes) + 1),
        "frequency (Hz)": modes.frequency,
        "frequency (1/s)": modes.circular,
        **named_columns("met_at", modes.meshes, modes.rpm, "rpm"),
        **named_columns("shape", modes.inertias, modes.shape, "rad"),
        **named_columns("unit_shape", modes.inertias, modes.unit_shape),
        **named_columns("approach", modes.meshes, modes.approach, "mm"),
        **named_columns("kinetic_inertias", modes.inertias, modes.kinetic_inertias),
        **named_columns("kinetic_shafts", modes.shafts, modes.kinetic_shafts),
        **named_columns("potential_shafts", modes.shafts, modes.potential_shafts),
        **named_columns("potential_meshes", modes.meshes, modes.potential_meshes),
        "most_in": [" and ".join(names) for names in modes.leading_parts],
    }


def component_columns(modes: ComponentModes) -> Columns:
    """Return the modes of the lines of which the model "modes" is made."""
    return {
        "component_mode": np.arange(1, len(modes.circular) + 1),
        "frequency (Hz)": modes.circular / (2 * np.pi),
        "frequency (1/s)": modes.circular,
        **named_columns("shape", modes.inertias, modes.shape, "rad"),
        **named_columns("middle", modes.shafts, modes.middle, "rad"),
    }


def modal_tables(modes: NaturalModes) -> Tables:
    """Return the natural modes, and those of the components where the model has some."""
    found: Tables = {"modes": mode_columns(modes)}
    if modes.component_modes is not None:
        found["component modes"] = component_columns(modes.component_modes)
    return found


def cycle_columns(cycle: MeshCycle) -> Columns:
    """Return the stiffness of a mesh over one base pitch."""
    return {
        "roll_angle (deg)": cycle.roll_angle,
        "mesh_stiffness (N/µm)": cycle.mesh_stiffness,
        "tangent_stiffness (N/µm)": cycle.tangent_stiffness,
        "transmission_error (µm)": cycle.transmission_error,
    }


def campbell_columns(study: SpeedSpectra) -> Columns:
    """Return the results at each speed and the highest peaks of its spectrum; whole spectra are in the .npz file."""
    found: dict[str, Any] = {
        "speed (rpm)": study.speeds,
        "tooth_frequency (Hz)": study.tooth_frequencies(),
        "mean_approach (µm)": study.mean_approach,
        "greatest_approach (µm)": study.greatest_approach,
        "deepest (µm)": study.deepest,
        "out_of_contact": study.out_of_contact,
        "growth (1/s)": study.growth,
        "digits_lost": study.digits_lost,
        "chaotic": study.chaotic,
    }
    peaks = [study.peaks(speed, _PEAKS) for speed in study.speeds.tolist()]
    for number in range(_PEAKS):
        each = [of[number] if number < len(of) else (None, None) for of in peaks]
        found[f"peak_{number + 1} (Hz)"] = [frequency for frequency, _ in each]
        found[f"peak_{number + 1}_pinion_speed (rad/s)"] = [amplitude for _, amplitude in each]
    return found


def history_columns(history: TimeHistory) -> Columns:
    """Return a motion over time, thinned to at most 20,000 samples."""
    step = slice(None, None, -(-len(history.approach) // _MOST_ROWS))
    return {
        "time (s)": history.time[step],
        "approach (µm)": history.approach[step],
        "pinion_speed (rad/s)": history.pinion_speed[step],
        "wheel_speed (rad/s)": history.wheel_speed[step],
        "pinion_angle (deg)": history.pinion_angle[step],
        "wheel_angle (deg)": history.wheel_angle[step],
    }


def spectrum_columns(history: TimeHistory, highest: float) -> Columns:
    """Return the spectra of a motion up to a frequency (Hz)."""
    speed, approach = history.spectrum(highest), history.approach_spectrum(highest)
    return {
        "frequency (Hz)": speed.frequency,
        "pinion_speed (rad/s)": speed.amplitude,
        "approach (µm)": approach.amplitude,
    }


def transient_columns(run: Transient) -> Columns:
    """Return the greatest loads of every tooth period of a run with changing speed or torque."""
    meshes, _, shafts = run.names
    return {
        "time (s)": run.middles,
        "speed (rpm)": run.window_speed,
        **named_columns("overload", meshes, run.factor),
        **named_columns("parted", meshes, run.parted),
        **named_columns("shaft_overload", shafts, run.shaft_factor),
    }


def order_tables(chart: OrderChart | None, run: Transient | None) -> Tables:
    """Return the tables of a run in time and of amplitudes of orders over speed, of those that there are."""
    found: Tables = {} if run is None else {"transient": transient_columns(run)}
    if run is not None and run.tracks is not None:
        tracks = run.tracks
        found["order tracks"] = {
            "time (s)": tracks.time,
            "speed (rpm)": tracks.speeds,
            **_order_columns(tracks.orders, (tracks.names[0], tracks.names[2]), (tracks.forces, tracks.torques)),
        }
    if chart is not None:
        found["orders"] = {
            "speed (rpm)": chart.speeds,
            **_order_columns(chart.orders, (chart.names[0], chart.names[2]), (chart.forces, chart.torques)),
            **named_columns("torque_swing", chart.names[2], chart.swings, "N·m"),
        }
    return found


def _order_columns(
    orders: Sequence[SpeedOrder], names: tuple[tuple[str, ...], tuple[str, ...]], values: tuple[Floats, Floats]
) -> Columns:
    """Return columns of the amplitudes (s, k, c) of orders, of the forces of meshes and the torques of shafts."""
    return {
        f"{quantity}.{name}.order {each.order:.12g} ({unit})": amplitudes[:, at, member]
        for quantity, unit, members, amplitudes in zip(("force", "shaft_torque"), ("N", "N·m"), names, values, strict=True)
        for member, name in enumerate(members)
        for at, each in enumerate(orders)
    }


def stacked(what: str, labels: Sequence[str], each: Sequence[Tables]) -> Tables:
    """Return the tables of several results, those of one name under each other; a first column `what` holds their labels."""
    found: dict[str, dict[str, list[Any]]] = {}
    for label, tables in zip(labels, each, strict=True):
        for name, columns in tables.items():
            whole = found.setdefault(name, {what: []})
            before, rows = len(whole[what]), len(next(iter(columns.values())))
            whole[what] += [label] * rows
            for heading, values in columns.items():
                whole.setdefault(heading, [None] * before).extend(_plain(values))
            for values in whole.values():
                values += [None] * (before + rows - len(values))
    return dict(found)


def _plain(values: Floats | Bools | Wholes | Sequence[Any]) -> list[Any]:
    return values.tolist() if isinstance(values, np.ndarray) else list(values)
