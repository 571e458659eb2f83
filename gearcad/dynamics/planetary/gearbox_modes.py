"""Natural modes of a gearbox of planetary sets in a state, and its steady vibration under errors of its meshes.

All sets stand where they were put together. Carriers of different sets turn against each other, which changes modes in which
joined members travel. Without gyroscopic terms and damping; SI units inside.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.core.errors import ParameterError, require_number
from gearcad.core.records import Floats, Indices, JsonObject, freeze
from gearcad.dynamics.planetary.gearbox_model import GearboxModel
from gearcad.dynamics.planetary.planetary_modes import ModeFamily, ModeKind, runs, split_kinds
from gearcad.planetary.gearbox import Gearbox, StateResult

_RIGID = 1e-7
"""Share of the highest frequency below which a mode bends no spring, but for rounding."""

_NEAR = 1e-6
"""Relative distance within which modes are told apart by their motion, not by their frequencies."""

_MICRO = 1e-6
"""Factor from µm to m."""


@dataclass(frozen=True, kw_only=True, eq=False)
class GearboxModes:
    """The n natural modes by rising `frequency` (n,) in Hz.

    `shape` (n, P, 3) is x, y (m) and turn (rad) of the parts of the model for a modal mass of 1 kg, `elongation` (n, m) that of
    the springs (m, of shafts and torsion rad). `potential` (n, m) and `kinetic` (n, P) are the shares of springs and parts in
    the energies; the first `rigid` modes, at 0 Hz, have no potential energy.
    """

    model: GearboxModel
    frequency: Floats
    kinds: tuple[ModeKind, ...]
    families: tuple[ModeFamily, ...]
    shape: Floats
    elongation: Floats
    potential: Floats
    kinetic: Floats
    rigid: int

    def __post_init__(self) -> None:
        freeze(self)

    def to_dict(self) -> JsonObject:
        """Return families, and of each mode kind, frequency and what moves and bends most in it."""
        springs, parts = self.model.springs, self.model.parts
        return {
            "families": [family.to_dict() for family in self.families],
            "rigid": self.rigid,
            "modes": [
                {
                    "frequency": float(frequency),
                    "kind": kind.value,
                    "kinetic": _greatest(dict(zip(parts, kinetic.tolist(), strict=True))),
                    "potential": _greatest(_summed([each.owner for each in springs], potential)),
                }
                for frequency, kind, kinetic, potential in zip(
                    self.frequency, self.kinds, self.kinetic, self.potential, strict=True
                )
            ],
            "mesh_stiffness": {
                name: {"mean": value, "method": origin} for name, (value, origin) in self.model.mesh_stiffness.items()
            },
        }


_MOST_SHARES = 4
"""Largest number of shares of an energy that a document names."""

_LEAST_SHARE = 0.01


def _greatest(shares: Mapping[str, float]) -> dict[str, float]:
    """Return the greatest shares of an energy, greatest first."""
    found = sorted(shares.items(), key=lambda each: -each[1])[:_MOST_SHARES]
    return {name: share for name, share in found if share >= _LEAST_SHARE}


def _summed(owners: list[str], values: Floats) -> dict[str, float]:
    """Return the sums of values with the same owner."""
    found = dict.fromkeys(owners, 0.0)
    for owner, value in zip(owners, values.tolist(), strict=True):
        found[owner] += value
    return found


def gearbox_modes(model: GearboxModel) -> GearboxModes:
    """Return the modes of a gearbox in a state. Raises ParameterError where a mass is missing."""
    basis, mass = model.basis, model.mass
    reduced = (basis.T * mass) @ basis
    for column in np.flatnonzero(np.diag(reduced) <= 0)[:1]:
        part = model.parts[int(np.flatnonzero(basis[:, column])[0]) // 3]
        raise ParameterError(f"inertia.{part}", None, "must be given in kg·m²: a shaft twists beside it")
    lower = np.linalg.cholesky(reduced)
    elongations = model.vectors @ basis
    back = np.linalg.inv(lower).T
    rooted = (elongations * np.sqrt(model.stiffness)[:, None]) @ back
    _, values, within = np.linalg.svd(rooted)
    size = len(lower)
    omega = np.zeros(size)
    omega[: min(size, len(values))] = values[:size]
    omega, modes = omega[::-1].copy(), within.T[:, ::-1]
    omega[omega <= _RIGID * omega.max(initial=0.0)] = 0.0
    places = basis @ back
    members = 3 * len(model.members)
    rows = np.arange(members)
    kinds: list[ModeKind] = []
    ordered = np.array(modes)
    families: list[ModeFamily] = []
    for near in runs(omega, _NEAR):
        travel, turn = (_moved(places, mass, rows[test], modes[:, near]) for test in (rows % 3 < 2, rows % 3 == 2))
        start = int(near[0])
        for kind, space in split_kinds(travel, turn, modes[:, near]):
            count = space.shape[1]
            ordered[:, start : start + count] = space
            families.append(ModeFamily(float(omega[near].mean() / (2 * np.pi)), kind, count, start))
            kinds += [kind] * count
            start += count
    shape = places @ ordered
    stretched = (elongations @ back @ ordered).T
    squares = (omega**2)[:, None]
    potential = np.divide(model.stiffness * stretched**2, squares, out=np.zeros_like(stretched), where=squares > 0)
    totals = potential.sum(axis=1, keepdims=True)
    return GearboxModes(
        model=model,
        frequency=omega / (2 * np.pi),
        kinds=tuple(kinds),
        families=tuple(families),
        shape=shape.T.reshape(size, -1, 3),
        elongation=stretched,
        potential=np.divide(potential, totals, out=np.zeros_like(potential), where=totals > 0),
        kinetic=(mass[:, None] * shape**2).T.reshape(size, -1, 3).sum(axis=2),
        rigid=int((omega == 0).sum()),
    )


def _moved(places: Floats, mass: Floats, rows: Indices, modes: Floats) -> Floats:
    """Return the motion of some coordinates in modes by their kinetic energy."""
    found: Floats = np.sqrt(mass[rows])[:, None] * (places[rows] @ modes)
    return found


@dataclass(frozen=True, kw_only=True, eq=False)
class GearboxResponse:
    """Steady vibration of a gearbox under errors of its meshes, at speeds (s,) of the input in rpm.

    `forces` (s, c) are the amplitudes of the dynamic force of each of the `meshes` (N), the greatest of its planets.
    Errors of one tooth frequency act together with their phases; those of different frequencies are added by amounts.
    """

    speed: Floats
    meshes: tuple[str, ...]
    forces: Floats

    def __post_init__(self) -> None:
        freeze(self)

    @cached_property
    def greatest(self) -> dict[str, tuple[float, float]]:
        """Greatest amplitude of the force of each mesh (N), and its speed (rpm)."""
        rows = self.forces.argmax(axis=0)
        return {
            mesh: (float(self.forces[row, column]), float(self.speed[row]))
            for column, (mesh, row) in enumerate(zip(self.meshes, rows.tolist(), strict=True))
        }

    def to_dict(self) -> JsonObject:
        """Return plain lists."""
        return {
            "speed": self.speed.tolist(),
            "forces": {mesh: self.forces[:, column].tolist() for column, mesh in enumerate(self.meshes)},
            "greatest": {mesh: {"force": force, "speed": speed} for mesh, (force, speed) in self.greatest.items()},
        }


def mesh_forces(modes: GearboxModes, errors: Floats, frequencies: Floats, damping_ratio: float) -> Floats:
    """Return complex forces (f, m) in N of all springs at frequencies (f,) in Hz, under errors (m,) in m of the springs.

    An error presses its flanks: M q" + C q' + K q = -V^T k e, each mode with a `damping_ratio`, and the force is k (v q + e).
    """
    stiffness, stretched = modes.model.stiffness, modes.elongation
    circular, own = 2 * np.pi * np.asarray(frequencies, float), 2 * np.pi * modes.frequency
    pushed = -stretched @ (stiffness * errors)
    turned = own[None, :] ** 2 - circular[:, None] ** 2 + 2j * damping_ratio * own[None, :] * circular[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        amplitudes = np.where(turned == 0, 0.0, pushed[None, :] / turned)
    found: Floats = stiffness * (amplitudes @ stretched + errors[None, :])
    return found


_STEPS = 200
"""Speeds of a vibration beside those of resonances."""


def response_speeds(modes: GearboxModes, highest: float) -> Floats:
    """Return speeds of the input (s,) in rpm up to the highest: even steps, and where a tooth frequency meets a mode."""
    orders = {modes.model.tooth_order(mesh) for mesh, error in modes.model.mesh_errors.items() if error}
    met = [60 * modes.frequency / order for order in orders if order]
    every = np.concatenate([np.linspace(highest / _STEPS, highest, _STEPS), *met])
    found: Floats = np.unique(every[(every > 0) & (every <= highest)])
    return found


@dataclass(frozen=True, kw_only=True, eq=False)
class StateVibration:
    """Modes of a gearbox in a state, and its vibration under the errors of its meshes, None without a speed or errors."""

    modes: GearboxModes
    response: GearboxResponse | None = None


def state_vibration(gearbox: Gearbox, state: StateResult) -> StateVibration:
    """Return modes and vibration of a state. Raises ParameterError where a mass is missing."""
    modes = gearbox_modes(GearboxModel(gearbox, state))
    if gearbox.speed is None or not any(modes.model.mesh_errors.values()):
        return StateVibration(modes=modes)
    return StateVibration(modes=modes, response=gearbox_response(modes, response_speeds(modes, gearbox.speed)))


def gearbox_response(modes: GearboxModes, speeds: Floats, *, damping_ratio: float = 0.03) -> GearboxResponse:
    """Return the vibration under the errors of the meshes at speeds (s,) of the input (rpm). Raises ParameterError."""
    require_number("damping_ratio", damping_ratio, above=0, at_most=1)
    speeds = np.asarray(speeds, float)
    if speeds.ndim != 1 or not len(speeds) or not np.isfinite(speeds).all() or speeds.min() < 0:
        raise ParameterError("speeds", speeds.tolist(), "must be speeds of at least 0 rpm", "rpm")
    model = modes.model
    meshes = tuple(model.mesh_stiffness)
    springs = [each for each in model.springs if each.kind == "mesh"]
    groups: dict[float, Floats] = {}
    phases = model.gearbox.phases(model.state)
    for place, spring in enumerate(springs):
        told, error = phases[spring.owner], model.mesh_errors[spring.owner]
        if not error or told is None:
            continue
        order = round(model.tooth_order(spring.owner), 9)
        turn = told.ahead[spring.number - 1]
        errors = groups.setdefault(order, np.zeros(len(model.springs), complex))
        errors[place] = _MICRO * error * np.exp(2j * np.pi * turn)
    total = np.zeros((len(speeds), len(springs)))
    for order, errors in groups.items():
        if order:
            total += np.abs(mesh_forces(modes, errors, order * speeds / 60, damping_ratio)[:, : len(springs)])
    owners = [each.owner for each in springs]
    forces = np.array([total[:, [owner == mesh for owner in owners]].max(axis=1) for mesh in meshes]).T
    return GearboxResponse(speed=speeds, meshes=meshes, forces=forces)
