"""K_v chart: how much the load between the teeth and in the shafts exceeds the static one, over speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats, Indices
from gearcad.dynamics.charts.chart import KvChart
from gearcad.dynamics.charts.displacements import bearing_loads, displacements
from gearcad.dynamics.charts.extremes import Extremes, extremes
from gearcad.dynamics.charts.transmission import transmission_errors
from gearcad.dynamics.response.flexibility import StaticState
from gearcad.dynamics.response.periodic import PeriodicResponse
from gearcad.dynamics.trains.system import System
from gearcad.errors import GeometryError, ParameterError
from gearcad.notice import Notice
from gearcad.rating.dynamic_factor import DynamicFactor

__all__ = ["chart_of", "idle_shafts", "kv_chart", "torque_references"]


_IDLE, _IDLE_MOSTLY = 50.0, 3.0
"""A shaft whose torque exceeds its static one so many times, and at half of the speeds still so many times, carries nothing at
rest that a factor could refer to: one that only resonates is quiet at most speeds."""


def kv_chart(
    response: PeriodicResponse,
    *,
    shaft_references: Sequence[float | None] | None = None,
    method_b: DynamicFactor | None = None,
) -> KvChart:
    """The chart of a response over speed, linear or of a sweep.

    `shaft_references` (N·m), one per shaft, replace the static torque where given: for shafts that carry none. `method_b` are
    the data of the pair of the first mesh. Raises GeometryError where a mesh carries no static load that K_v could refer to.
    """
    means = response.static.others[response.system.torque_outputs]
    _, signs = torque_references(means, shaft_references)
    return chart_of(
        response.system,
        response.static,
        response.frequencies,
        extremes(response, signs, response.harmonics[1:]),
        response.harmonics[1:],
        orders_per_tooth=response.excitation.orders[0],
        shaft_references=shaft_references,
        method_b=method_b,
        stable=response.stable,
        notices=response.notices,
    )


def chart_of(
    system: System,
    static: StaticState,
    frequencies: Floats,
    found: Extremes,
    orders: Indices,
    *,
    orders_per_tooth: int,
    shaft_references: Sequence[float | None] | None = None,
    method_b: DynamicFactor | None = None,
    stable: NDArray[np.bool_],
    notices: tuple[Notice, ...],
) -> KvChart:
    """The chart of `extremes` that were found somehow, their lines at `orders` (k,), so many of them for a tooth frequency.

    Raises GeometryError for a mesh without static force, to which K_v could not refer.
    """
    forces = np.abs(system.stiffness * static.approach)
    if forces.min() <= 1e-9 * forces.max():
        name = system.names[0][int(forces.argmin())]
        raise GeometryError("static_force", float(forces.min()), f"of mesh {name} must not be 0 N: K_v refers to it", "N")
    means = static.others[system.torque_outputs]
    references, _ = torque_references(means, shaft_references)
    given = np.array([value is not None for value in shaft_references or [None] * len(means)], bool)
    references = np.where(given | ~idle_shafts(found.torques, references), references, np.nan)
    return KvChart(
        frequencies=frequencies,
        factors=found.most / forces,
        damped=found.damped / forces,
        least=found.least / forces,
        static_forces=forces,
        shaft_factors=found.torques / references,
        shaft_references=references,
        displacements=displacements(system, found),
        transmission=transmission_errors(orders / orders_per_tooth, found.lines),
        bearings=bearing_loads(system, static, found),
        standard=None if method_b is None else method_b.values(frequencies * 30 / (np.pi * method_b.teeth)),
        stable=stable,
        mesh_names=system.names[0],
        shaft_names=system.names[2],
        notices=notices,
    )


def idle_shafts(torques: Floats, references: Floats) -> NDArray[np.bool_]:
    """Which shafts (n,) have greatest torques (s, n) over speed that have little to do with those at rest (n,)."""
    if not torques.size:
        return np.zeros(len(references), bool)
    torques = torques[np.isfinite(torques).all(axis=1)]
    idle = (torques.max(axis=0) >= _IDLE * references) & (np.median(torques, axis=0) >= _IDLE_MOSTLY * references)
    return np.asarray(idle, bool)


def torque_references(means: Floats, given: Sequence[float | None] | None = None) -> tuple[Floats, Floats]:
    """Reference torques (n,), and the sense (n,) in which they act: 0 where it is unknown.

    Raises ParameterError unless as many are `given` as shafts, each above 0 N·m or None.
    """
    count = len(means)
    if given is not None and len(given) != count:
        raise ParameterError("shaft_references", len(given), f"must be one number or None for each of {count} shafts")
    loaded = np.abs(means) > 1e-9 * np.abs(means).max(initial=0.0)
    references = np.where(loaded, np.abs(means), np.nan)
    for i, value in enumerate(given or ()):
        if value is not None:
            if not np.isfinite(value) or value <= 0:
                raise ParameterError("shaft_references", value, "must be above 0 N·m", "N·m")
            references[i] = value
    return references, np.where(loaded, np.sign(means), 0.0)
