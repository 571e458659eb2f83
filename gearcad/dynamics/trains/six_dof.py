"""A pair of gears on elastic bearings: turn, and travel in both directions, of pinion and wheel.

The pinion's axis stands at the origin and the wheel's on +x; both angles count counter-clockwise. The pinion drives with its
left flanks: the force on the wheel points along n = (sin alpha_wt, cos alpha_wt), and the approach of the flanks is
y = n (u_1 - u_2) + r_b1 phi_1 + r_b2 phi_2. A ring stands on -x, and its base radius is negative: it turns with the pinion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.dynamics.trains.bearing_modes import BearingModes, modes_on_bearings
from gearcad.dynamics.trains.system import Bearings, System
from gearcad.errors import plain_numbers, require_number
from gearcad.per_gear import PerGear

__all__ = ["PairOnBearings"]


@dataclass(frozen=True, kw_only=True)
class PairOnBearings:
    """Masses (kg), inertias (kg·m²), base radii (mm), bearings (N/µm in x and y; damping N·s/m) of pinion and wheel.

    The base radius of a ring is negative.

    `working_transverse_pressure_angle` in degrees, `mesh_stiffness` in N/µm, `mesh_damping` in N·s/m, `torque` on the pinion
    in N·m (the wheel's holds it). Raises ParameterError.
    """

    masses: PerGear[float]
    inertias: PerGear[float]
    base_radii: PerGear[float]
    working_transverse_pressure_angle: float
    mesh_stiffness: float
    bearing_stiffness: PerGear[tuple[float, float]]
    mesh_damping: float = 0.0
    bearing_damping: float = 0.0
    torque: float = 0.0

    def __post_init__(self) -> None:
        for name in ("masses", "inertias", "base_radii", "bearing_stiffness"):
            object.__setattr__(self, name, PerGear(*getattr(self, name)))
        plain_numbers(self)
        for name, unit in (("masses", "kg"), ("inertias", "kg·m²"), ("base_radii", "mm")):
            for value in getattr(self, name):
                require_number(name, abs(value), unit, above=0)
        for value in (each for bearing in self.bearing_stiffness for each in bearing):
            require_number("bearing_stiffness", value, "N/µm", above=0)
        require_number("mesh_stiffness", self.mesh_stiffness, "N/µm", above=0)
        require_number("working_transverse_pressure_angle", self.working_transverse_pressure_angle, "deg", at_least=0, below=90)
        for name in ("mesh_damping", "bearing_damping"):
            require_number(name, getattr(self, name), "N·s/m", at_least=0)
        require_number("torque", self.torque, "N·m")

    def system(self) -> System:
        """The six coordinates x_1, y_1, phi_1, x_2, y_2, phi_2, each times the root of its mass or inertia."""
        angle = math.radians(self.working_transverse_pressure_angle)
        first, second = (radius / 1000 for radius in self.base_radii)
        approach = np.array([math.sin(angle), math.cos(angle), first, -math.sin(angle), -math.cos(angle), second])
        masses = np.array(
            [value for mass, turn in zip(self.masses, self.inertias, strict=True) for value in (mass, mass, turn)]
        )
        springs, dampers, turns = np.zeros(6), np.zeros(6), np.zeros((6, 2))
        for gear, (bearing, inertia) in enumerate(zip(self.bearing_stiffness, self.inertias, strict=True)):
            springs[3 * gear : 3 * gear + 2] = [1e6 * each for each in bearing]
            dampers[3 * gear : 3 * gear + 2] = self.bearing_damping
            turns[3 * gear + 2, gear] = 1 / math.sqrt(inertia)
        load = np.zeros(6)
        load[2], load[5] = self.torque, self.torque * second / first
        root = np.sqrt(masses)
        return System(
            squares=springs / masses,
            damping=dampers / masses,
            mesh=(approach / root)[:, None],
            inertias=turns,
            shaft_torques=np.zeros((6, 0)),
            load=load / root,
            stiffness=np.array([1e6 * self.mesh_stiffness]),
            mesh_damping=np.array([self.mesh_damping]),
            names=(("mesh",), ("pinion", "wheel"), ()),
            bearings=self._bearings(),
        )

    def _bearings(self) -> Bearings:
        """Seen along the line of action and across it."""
        sine, cosine = math.sin(angle := math.radians(self.working_transverse_pressure_angle)), math.cos(angle)
        turned = np.array([[sine, cosine], [cosine, -sine]])
        travel, stiffness = np.zeros((6, 4)), np.zeros((4, 4))
        for gear, (mass, bearing) in enumerate(zip(self.masses, self.bearing_stiffness, strict=True)):
            own = slice(2 * gear, 2 * gear + 2)
            travel[3 * gear : 3 * gear + 2, own] = turned.T / math.sqrt(mass)
            stiffness[own, own] = 1e6 * (turned * bearing) @ turned.T
        return Bearings(("pinion", "wheel"), travel, stiffness, self.bearing_damping * np.eye(4))

    def modes(self) -> BearingModes:
        """The six natural modes, seen along the line of action and across it."""
        sine, cosine = math.sin(angle := math.radians(self.working_transverse_pressure_angle)), math.cos(angle)
        first, second = (radius / 1000 for radius in self.base_radii)
        approach = np.array([1.0, 0.0, first, -1.0, 0.0, second])
        springs = np.zeros((3, 6, 6))
        springs[0] = 1e6 * self.mesh_stiffness * np.outer(approach, approach)
        for gear, (x, y) in enumerate(self.bearing_stiffness):
            along, across = 3 * gear, 3 * gear + 1
            # Sums that are exact where both are alike: then nothing couples along and across.
            springs[1 + gear, along, along] = 1e6 * (y + (x - y) * sine**2)
            springs[1 + gear, across, across] = 1e6 * (y + (x - y) * cosine**2)
            springs[1 + gear, along, across] = springs[1 + gear, across, along] = 1e6 * (x - y) * sine * cosine
        masses = [value for mass, turn in zip(self.masses, self.inertias, strict=True) for value in (mass, mass, turn)]
        return modes_on_bearings(springs.sum(axis=0), np.array(masses), springs, (first, second))

    def frequencies(self) -> tuple[float, ...]:
        """The six natural frequencies (Hz), lowest first; that of the gears' free turning is 0."""
        squares = np.linalg.eigvalsh(self.system().stiffness_matrix())
        squares[0] = 0.0  # but for rounding: nothing holds the gears' turning
        return tuple((np.sqrt(squares) / (2 * math.pi)).tolist())
