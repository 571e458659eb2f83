"""One mesh cycle of solid gears: the contact at positions over a base pitch, and what an engineer reads from it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gearcad.fea.cycle import LoadedPosition
from gearcad.geometry.contact import usable_path
from gearcad.ltca.contact_lines import ContactLine
from gearcad.ltca.line_contact import LineSolution
from gearcad.ltca.solid_pair import SolidPair
from gearcad.ltca.solid_root import FilletState, SolidFillet

__all__ = [
    "RootPeak",
    "SolidContact",
    "SolidCycle",
    "SolidPosition",
    "run_solid_cycle",
    "solid_single_stiffness",
    "tooth_loads",
]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

INTERIOR = 3.0
"""Half widths from the edges of both flanks beyond which a contact is that of two cylinders."""


@dataclass(frozen=True)
class SolidContact:
    """One pair of teeth in contact: per cell of its line (n,) forces in N, half widths in mm, peak pressures in MPa.

    `interior` cells are away from all edges of both flanks; at the others the pressure depends on the edge.
    """

    line: ContactLine
    forces: Floats
    half_widths: Floats
    pressures: Floats
    radii: Floats
    interior: Bools
    share: float

    @property
    def tooth(self) -> int:
        """Tooth of the pinion, 0 is the middle one."""
        return self.line.tooth

    @property
    def force(self) -> float:
        """Normal force (N)."""
        return float(self.forces.sum())

    @property
    def line_loads(self) -> Floats:
        """Normal load per length of the line (n,) in N/mm."""
        result: Floats = self.forces / self.line.lengths
        return result

    @property
    def edge(self) -> bool:
        """True if the edge of a tip carries load."""
        return bool((self.line.on_edge & (self.forces > 0)).any())

    @property
    def peak_pressure(self) -> float:
        """Greatest pressure (MPa) of the interior cells, 0 if there are none."""
        return float(np.where(self.interior, self.pressures, 0.0).max())


@dataclass(frozen=True)
class RootPeak:
    """The greatest stress of a fillet (MPa): at radius and height (mm), its angle to the middle of the tooth (deg).

    `along_face` (n,) is the greatest along the profile at each of the fillet's `heights_between` (MPa).
    """

    stress: float
    radius: float
    height: float
    tangent_angle: float
    along_face: Floats


@dataclass(frozen=True)
class SolidPosition(LoadedPosition):
    """A position of solid gears: its contacts, the root stresses of both gears, and the torques (N m) on their hubs.

    `bore_tension` (MPa) is the greatest below loaded teeth on a bore that is free.
    """

    contacts: tuple[SolidContact, ...]
    tension: tuple[RootPeak, RootPeak]
    compression: tuple[RootPeak, RootPeak]
    torques: tuple[float, float]
    bore_tension: tuple[float | None, float | None]


@dataclass(frozen=True)
class SolidCycle:
    """All positions of one base pitch at one torque (N m on the pinion)."""

    model: SolidPair
    torque: float
    positions: tuple[SolidPosition, ...]

    def values(self, name: str) -> Floats:
        """A quantity of every position, such as "stiffness"."""
        return np.array([getattr(position, name) for position in self.positions])

    @property
    def harmonics(self) -> Floats:
        """Amplitudes (um) of the transmission error at the tooth frequency and its multiples."""
        error = self.values("transmission_error")
        spectrum = np.fft.rfft(error) / len(error)
        result: Floats = 2 * np.abs(spectrum[1 : (len(error) - 1) // 2 + 1])
        return result

    @property
    def worst_contact(self) -> tuple[SolidPosition, SolidContact]:
        """The contact of the greatest interior pressure."""
        every = [(position, contact) for position in self.positions for contact in position.contacts]
        return max(every, key=lambda of: (of[1].peak_pressure, of[1].force))

    def bore_tension(self, gear: int) -> float | None:
        """The greatest (MPa) on the bore of the pinion (0) or the wheel (1) below loaded teeth; None where it is kept round."""
        return max((of for position in self.positions if (of := position.bore_tension[gear]) is not None), default=None)

    def worst_position(self, gear: int) -> SolidPosition:
        """The position of the greatest root tension of the pinion (0) or the wheel (1)."""
        return max(self.positions, key=lambda position: position.tension[gear].stress)

    @cached_property
    def load_along_face(self) -> tuple[Floats, Floats]:
        """Places across the common width (n,) in mm from its middle, and the load per width there (n,) in N/mm, mean of all
        positions: transverse normal force of all lines.
        """
        count, width = self.model.cells, self.model.width
        step = width / count
        total = np.zeros(count)
        for position in self.positions:
            for contact in position.contacts:
                cell = np.floor(contact.line.across / step + count / 2).astype(int)
                np.add.at(total, cell, contact.forces)
        edges = np.linspace(-width / 2, width / 2, count + 1)
        load: Floats = total * math.cos(self.model.helix) / step / len(self.positions)
        return (edges[1:] + edges[:-1]) / 2, load

    @property
    def face_load_factor(self) -> float:
        """K_H_beta: the greatest load per width over its mean, both of the whole cycle, away from the ends of the face width.

        There, where the end of one gear presses on the other's flank, an edge carries more whatever the gears' alignment.
        """
        across, load = self.load_along_face
        widest = max(contact.half_widths.max() for position in self.positions for contact in position.contacts)
        inside = np.abs(across) < self.model.width / 2 - min(INTERIOR * float(widest), self.model.width / 4)
        return float(load[inside].max() / load.mean())

    def root_along_face(self, gear: int) -> tuple[Floats, Floats]:
        """Heights (n,) in mm of the gear, and the greatest root tension of the cycle there (n,) in MPa."""
        fillet = self.model.fillets[gear][0]
        stresses: Floats = np.array([position.tension[gear].along_face for position in self.positions])
        return fillet.heights_between, stresses.max(axis=0)

    def root_face_load_factor(self, gear: int) -> float:
        """K_F_beta: the greatest root tension over its mean along the common face width."""
        heights, stress = self.root_along_face(gear)
        low, high = self.model.common_heights(gear)
        across = np.linspace(low, high, 201)
        within = np.interp(across, heights, stress)
        return float(within.max() / within.mean())


def run_solid_cycle(
    model: SolidPair, torque: float, count: int = 24, progress: Callable[[int, int], None] = lambda _done, _all: None
) -> SolidCycle:
    """Solve `count` positions over one base pitch. Raises SolverError."""
    positions = []
    for done, angle in enumerate(model.roll_angles(count).tolist()):
        progress(done, count)
        positions.append(_position(model, angle, torque))
    return SolidCycle(model, torque, tuple(positions))


def solid_single_stiffness(model: SolidPair, torque: float, count: int = 15) -> float:
    """Greatest stiffness (N/(mm um)) of one pair of teeth alone, while its line of contact crosses the flanks."""
    (first, last), reach = usable_path(model.pair), model.width * abs(math.tan(model.helix)) / 2
    lengths = np.linspace(first - reach, last + reach, count + 2)[1:-1]
    angles = np.degrees((lengths - model.pair.path_of_contact.C) / model.base_radius).tolist()
    solved = (model.solve(angle, torque, single=True) for angle in angles)
    # Transverse: F cos(beta_b) over the approach delta/cos(beta_b), per mm of width.
    factor = math.cos(model.helix) / 1000
    return max(model.force(torque) * factor / (each.approach - each.rigid) for each in solved)


def _position(model: SolidPair, angle: float, torque: float) -> SolidPosition:
    solution = model.solve(angle, torque)
    contacts = _contacts(model, solution)
    tension, compression, torques, bores = [], [], [], []
    for gear, body in enumerate((model.pinion, model.wheel)):
        loads = tooth_loads(model, contacts, gear)
        pulled, pushed = (_states(fillet, loads) for fillet in model.fillets[gear])
        tension.append(_peak(model.fillets[gear][0], [state.greater for state in pulled], 1))
        compression.append(_peak(model.fillets[gear][1], [state.lesser for state in pushed], -1))
        bores.append(_bore_tension(model.bores[gear], loads))
        torques.append(float(sum(force @ -body.torques for _, force in loads)) / 1000)
    flat = math.cos(model.helix)
    return SolidPosition(
        roll_angle=angle,
        approach=solution.approach / flat,
        approach_parts=(solution.parts[0] / flat, solution.parts[1] / flat),
        rigid_approach=solution.rigid / flat,
        force=model.force(torque),
        contacts=contacts,
        tension=(tension[0], tension[1]),
        compression=(compression[0], compression[1]),
        torques=(torques[0], torques[1]),
        bore_tension=(bores[0], bores[1]),
    )


def tooth_loads(model: SolidPair, contacts: tuple[SolidContact, ...], gear: int) -> list[tuple[int, Floats]]:
    """For each tooth in contact: its number on the pinion (0) or the wheel (1), and the force (N) at each unit load's place."""
    body = (model.pinion, model.wheel)[gear]
    # On the wheel the teeth follow each other the other way round.
    return [
        ((1, -1)[gear] * contact.tooth, body.by((contact.line.pinion, contact.line.wheel)[gear]).T @ contact.forces)
        for contact in contacts
    ]


def _states(fillet: SolidFillet, loads: list[tuple[int, Floats]]) -> list[FilletState]:
    """The fillet of each tooth in contact."""
    return [fillet.state([(tooth - own, force) for tooth, force in loads]) for own, _ in loads]


def _bore_tension(bore: SolidFillet | None, loads: list[tuple[int, Floats]]) -> float | None:
    return None if bore is None else max(float(state.greater.max()) for state in _states(bore, loads))


def _peak(fillet: SolidFillet, stresses: list[Floats], sign: int) -> RootPeak:
    """The most stressed place of the root of the most stressed tooth."""
    root, along, across = np.flatnonzero(fillet.is_root), fillet.along_root, fillet.along_face
    every = [sign * across @ stress[:, root] @ along.T for stress in stresses]
    worst = max(every, key=np.max)
    row, column = np.unravel_index(int(np.argmax(worst)), worst.shape)
    return RootPeak(
        stress=sign * float(worst[row, column]),
        radius=float(along[column] @ fillet.radii[root]),
        height=float(fillet.heights_between[row]),
        tangent_angle=float(along[column] @ fillet.tangent_angles[root]),
        along_face=sign * np.max([stress.max(axis=1) for stress in every], axis=0),
    )


def _contacts(model: SolidPair, solution: LineSolution) -> tuple[SolidContact, ...]:
    given = solution.given
    total = solution.forces.sum()
    parts = (solution.forces, solution.half_widths, solution.pressures, solution.gaps.radii)
    found = []
    for line, forces, widths, pressures, radii in zip(given.lines, *(given.split(part) for part in parts), strict=True):
        if forces.sum() > 0:
            to_end = model.width / 2 - np.abs(line.across)
            interior = (line.edge_distance > INTERIOR * widths) & (to_end > INTERIOR * widths) & (forces > 0)
            found.append(SolidContact(line, forces, widths, pressures, radii, interior, float(forces.sum() / total)))
    return tuple(found)
