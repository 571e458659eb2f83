"""One mesh cycle of solid gears: the contact at positions over a base pitch, and what an engineer reads from it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.cycle import FAIR
from gearcad.contact.plane.loaded import LoadedCycle, LoadedPosition
from gearcad.contact.solid.contact import INTERIOR, SolidContact
from gearcad.contact.solid.line_contact import LineSolution
from gearcad.contact.solid.pair import SolidPair
from gearcad.contact.solid.root import FilletState, SolidFillet
from gearcad.geometry.path import usable_path

__all__ = [
    "RootPeak",
    "SolidCycle",
    "SolidPosition",
    "run_solid_cycle",
    "solid_pitch_point_contact",
    "solid_single_stiffness",
    "tooth_loads",
]


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

    @property
    def interior_contacts(self) -> tuple[SolidContact, ...]:
        """Contacts with places away from all edges, if these places together carry a fair share of the load."""
        inside = sum(float(contact.forces[contact.interior].sum()) for contact in self.contacts)
        if inside <= FAIR * sum(contact.force for contact in self.contacts):
            return ()
        return tuple(contact for contact in self.contacts if len(contact.inside))

    @property
    def contact_pressure(self) -> float:
        """Greatest pressure (MPa) of them away from all edges, NaN if there are none."""
        return max((contact.peak_pressure for contact in self.interior_contacts), default=math.nan)

    @property
    def line_load(self) -> float:
        """Greatest line load (N/mm) of them away from all edges, NaN if there are none."""
        return max((contact.peak_line_load for contact in self.interior_contacts), default=math.nan)


@dataclass(frozen=True)
class SolidCycle(LoadedCycle[SolidPair, SolidPosition]):
    """That of solid gears."""

    def solve(self, angle: float) -> SolidPosition:
        """The position at a roll angle (deg). Raises SolverError."""
        return _position(self.model, angle, self.torque)

    @property
    def harmonics(self) -> Floats:
        """Amplitudes (um) of the transmission error at the tooth frequency and its multiples."""
        error = self.values("transmission_error")
        spectrum = np.fft.rfft(error) / len(error)
        result: Floats = 2 * np.abs(spectrum[1 : (len(error) - 1) // 2 + 1])
        return result

    @property
    def worst_contact(self) -> tuple[SolidPosition, SolidContact] | None:
        """The contact of the greatest pressure away from all edges; None if there is none."""
        every = ((position, contact) for position in self.every for contact in position.interior_contacts)
        return max(every, key=lambda of: of[1].peak_pressure, default=None)

    @property
    def heaviest_contact(self) -> tuple[SolidPosition, SolidContact]:
        """The contact of the greatest load, wherever it is."""
        every = [(position, contact) for position in self.every for contact in position.contacts]
        return max(every, key=lambda of: of[1].force)

    def worst_position(self, gear: int) -> SolidPosition:
        """The position of the greatest root tension of the pinion (0) or the wheel (1)."""
        return max(self.every, key=lambda position: position.tension[gear].stress)

    @cached_property
    def load_along_face(self) -> tuple[Floats, Floats]:
        """Places across the common width (n,) in mm from its middle, and the load per width there (n,) in N/mm, mean of the
        even positions: transverse normal force of all lines.
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
        stresses: Floats = np.array([position.tension[gear].along_face for position in self.every])
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


def solid_pitch_point_contact(model: SolidPair, torque: float) -> SolidContact | None:
    """The contact of the pair whose line crosses the pitch point in the middle of the face; None if it does not touch."""
    contacts = _contacts(model, model.solve(0.0, torque))
    return next((contact for contact in contacts if contact.tooth == 0), None)


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
            margin = np.minimum(line.edge_distance, to_end) - INTERIOR * widths
            found.append(SolidContact(line, forces, widths, pressures, radii, margin, float(forces.sum() / total)))
    return tuple(found)
