"""Amplitudes of single orders over speed: forces of meshes, torques of shafts and turns of inertias of the steady motion.

Orders are those of the speed of the first mesh's pinion, or of the first inertia where there is no mesh.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Complexes, Floats, Indices, JsonObject, freeze
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.response.speed_curves import NARROWEST, speeds_between
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.speed_orders import SpeedOrder
from gearcad.dynamics.trains.steady_response import PeriodicResponse, static_state, torque_motion
from gearcad.dynamics.trains.train import Train

_HARMONICS, _FEW, _SHORT = 16, 6, 400
"""Harmonics of the tooth frequency in the motion; fewer where teeth come again after more than so many teeth."""

_BLOCK = 3_000_000
"""Numbers of the courses of one block of speeds."""

_MOST_ROUNDS = 14
"""Rounds of speeds between, of trains without meshes."""


class GreatestOrder(NamedTuple):
    """The greatest amplitude of an order of a member over speed: quantity, unit and speed (rpm)."""

    name: str
    quantity: str
    unit: str
    order: float
    source: str
    amplitude: float
    speed: float


@dataclass(frozen=True, kw_only=True, eq=False)
class OrderChart:
    """Amplitudes at `speeds` (s,) in rpm of the `orders` (k,) of a steady motion.

    `forces` (s, k, m) are those between flanks in N, with that of the dampers, `torques` (s, k, n) those of shafts in N·m, and
    `turns` (s, k, i) those of inertias in degrees.

    They are nan at speeds at which flanks part. `swings` (s, n) is the greatest torque of each shaft (N·m) beyond that at rest,
    of all orders together, nan likewise. `names` are those of meshes, inertias and shafts.
    """

    speeds: Floats
    orders: tuple[SpeedOrder, ...]
    forces: Floats
    torques: Floats
    turns: Floats
    swings: Floats
    names: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]
    static_forces: Floats
    static_torques: Floats

    def __post_init__(self) -> None:
        freeze(self)

    @property
    def greatest(self) -> tuple[GreatestOrder, ...]:
        """The greatest amplitude of every order, of every mesh and shaft that it moves."""
        return tuple(self._greatest())

    def _greatest(self) -> Iterator[GreatestOrder]:
        meshes, _, shafts = self.names
        for values, names, quantity, unit in ((self.forces, meshes, "force", "N"), (self.torques, shafts, "torque", "N·m")):
            for member, name in enumerate(names):
                for at, (order, source) in enumerate(self.orders):
                    own = np.nan_to_num(values[:, at, member])
                    row = int(own.argmax())
                    if own[row] > 0:
                        yield GreatestOrder(name, quantity, unit, order, source, float(own[row]), float(self.speeds[row]))

    def to_dict(self) -> JsonObject:
        """Return the entry of the chart in `dynamics.json`; the amplitudes over speed are arrays."""
        return {
            "orders": [each._asdict() for each in self.orders],
            "greatest": [each._asdict() for each in self.greatest],
        }

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        return {
            "order_speed": self.speeds,
            "order_orders": np.array([each.order for each in self.orders]),
            "order_force": self.forces,
            "order_shaft_torque": self.torques,
            "order_turn": self.turns,
        }


def order_chart(
    train: Train, system: System, excitation: Excitation, speeds: Floats, orders: tuple[SpeedOrder, ...]
) -> OrderChart:
    """Return the amplitudes of orders at speeds (s,) in rpm, of the motion with flanks in contact.

    They are nan where flanks would part. Raises SolverError where no finite motion exists.
    """
    if not train.meshes:
        return _of_torques(train, system, excitation, speeds, orders)
    teeth = train.meshes[0].teeth
    harmonics = _HARMONICS if max(excitation.orders) * len(system.stiffness) <= _SHORT else _FEW
    bonded, frequencies = excitation.bonded, speeds * math.pi * teeth / 30
    response = periodic_response(system, bonded, frequencies, harmonics=harmonics, stability=False)
    places = np.array([each.order * excitation.period / teeth for each in orders])
    rows, whole = np.rint(places).astype(int), np.abs(places - np.rint(places)) < 1e-6
    per = max(1, _BLOCK // (response.samples * max(system.outputs.shape[1], len(system.stiffness))))
    parts = [_amplitudes(response, rows, slice(i, i + per), excitation.parting) for i in range(0, len(speeds), per)]
    forces, torques, turns, swings = (np.concatenate(each) for each in zip(*parts, strict=True))
    for each in (forces, torques, turns):
        each[:, ~whole] = 0.0
    return _chart(system, speeds, orders, forces, torques, turns, swings)


def _amplitudes(
    response: PeriodicResponse, rows: Indices, which: slice, parting: bool
) -> tuple[Floats, Floats, Floats, Floats]:
    """Return amplitudes of some orders of the common period at some speeds, and the swings of the torques."""
    spring = response.spring_forces(which)
    force = spring + response.damping_forces(which)
    spectrum = 2 * np.abs(np.fft.rfft(force, axis=1, norm="forward"))
    torque = response.shaft_torques(which)
    kept = np.minimum(rows, spectrum.shape[1] - 1)
    known = (rows < spectrum.shape[1])[:, None]
    places = np.searchsorted(response.harmonics, rows).clip(max=len(response.harmonics) - 1)
    there = (response.harmonics[places] == rows)[:, None]

    def of(coefficients: Complexes) -> Floats:
        return np.where(there, 2 * np.abs(coefficients[which][:, places]), 0.0)

    found = [
        np.where(known, spectrum[:, kept], 0.0),
        of(response.torque_coefficients),
        np.degrees(of(response.inertia_coefficients)),
    ]
    mean = response.torque_coefficients[which][:, 0].real
    found.append(np.abs(torque - mean[:, None]).max(axis=1))
    if parting:
        apart = (response.senses * spring).min(axis=(1, 2)) <= 0
        for each in found:
            each[apart] = np.nan
    forces, torques, turns, swings = found
    return forces, torques, turns, swings


def _of_torques(
    train: Train, system: System, excitation: Excitation, speeds: Floats, orders: tuple[SpeedOrder, ...]
) -> OrderChart:
    """Return the chart of a train without meshes: closed at each speed, with speeds between where resonances ask for them."""
    found = _closed(system, excitation, speeds, orders)
    for _ in range(_MOST_ROUNDS):
        curves = found.torques.reshape(len(found.speeds), -1)
        more = speeds_between(found.speeds, curves + 1e-9 * curves.max(initial=0.0), NARROWEST)
        if not len(more):
            break
        found = _closed(system, excitation, np.union1d(found.speeds, more), orders)
    return found


def _closed(system: System, excitation: Excitation, speeds: Floats, orders: tuple[SpeedOrder, ...]) -> OrderChart:
    acting, _ = excitation.torque_vectors(system)
    omega = speeds * math.pi / 30 * excitation.fundamental
    moved = torque_motion(system, excitation, omega, np.concatenate([[0], acting]))
    places = {int(order): at for at, order in enumerate(acting)}
    amplitudes = np.zeros((len(speeds), len(orders), moved.others.shape[2]))
    for at, each in enumerate(orders):
        place = places.get(round(each.order * excitation.period))
        if place is not None and abs(each.order * excitation.period - round(each.order * excitation.period)) < 1e-6:
            amplitudes[:, at] = 2 * np.abs(moved.others[:, place])
    torques, inertias = system.torque_outputs, slice(0, system.inertias.shape[1])
    count = 2 ** int(np.ceil(np.log2(16 * max(int(acting.max(initial=1)), 16))))
    per, swings = max(1, _BLOCK // count), []
    for first in range(0, len(speeds), per):
        own = moved.others[first : first + per, :, torques]
        spectrum = np.zeros((len(own), count // 2 + 1, own.shape[2]), complex)
        spectrum[:, acting] = own
        swings.append(np.abs(np.fft.irfft(spectrum, count, axis=1, norm="forward")).max(axis=1))
    none = np.zeros((len(speeds), len(orders), 0))
    turns = np.degrees(amplitudes[:, :, inertias])
    return _chart(system, speeds, orders, none, amplitudes[:, :, torques], turns, np.concatenate(swings))


def _chart(
    system: System,
    speeds: Floats,
    orders: tuple[SpeedOrder, ...],
    forces: Floats,
    torques: Floats,
    turns: Floats,
    swings: Floats,
) -> OrderChart:
    static = static_state(system)
    return OrderChart(
        speeds=np.array(speeds),
        orders=orders,
        forces=forces,
        torques=torques,
        turns=turns,
        swings=swings,
        names=system.names,
        static_forces=np.abs(system.stiffness * static.approach),
        static_torques=static.others[system.torque_outputs],
    )
