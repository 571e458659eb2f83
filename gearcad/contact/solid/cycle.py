"""One mesh cycle of solid gears: the contact at positions over a base pitch, and what an engineer reads from it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.contact.shared.engaged import TOOTH_ORDER
from gearcad.contact.shared.loaded import FAIR, INTERIOR, LoadedCycle, LoadedPosition, RootStress
from gearcad.contact.shared.relief_start import onsets
from gearcad.contact.solid.contact import SolidPairContact
from gearcad.contact.solid.contact_lines import start_distances
from gearcad.contact.solid.flank import SolidCompliance, ToothForces
from gearcad.contact.solid.line_contact import LineSolution, plain_widths
from gearcad.contact.solid.pair import SolidPair
from gearcad.contact.solid.root import FilletState, SolidFillet
from gearcad.per_gear import PerGear, Role

__all__ = ["SolidCycle", "SolidPosition", "SolidRootStress", "tooth_loads"]


@dataclass(frozen=True)
class SolidRootStress(RootStress):
    """Also at which height (mm), and the greatest along the profile (n,) at each of the fillet's `heights_between` (MPa)."""

    height: float
    along_face: Floats


@dataclass(frozen=True)
class SolidPosition(LoadedPosition[SolidPairContact]):
    """A position of solid gears; the tension of a bore that is free is that below loaded teeth."""

    tension: PerGear[SolidRootStress]
    compression: PerGear[SolidRootStress]

    @property
    def interior_contacts(self) -> tuple[SolidPairContact, ...]:
        """Contacts with places away from all edges, if these places together carry a fair share of the load."""
        inside = sum(float(contact.forces[contact.interior].sum()) for contact in self.contacts)
        if inside <= FAIR * sum(contact.force for contact in self.contacts):
            return ()
        return tuple(contact for contact in self.contacts if len(contact.inside))

    @property
    def line_load(self) -> float:
        """Greatest line load (N/mm) of the interior contacts away from all edges, NaN if there are none."""
        return max((contact.peak_line_load for contact in self.interior_contacts), default=math.nan)


@dataclass(frozen=True)
class SolidCycle(LoadedCycle[SolidPair, SolidPosition, SolidPairContact]):
    """Solid gears over one base pitch: also how load and root stress are spread over the face width."""

    def solve(self, angle: float) -> SolidPosition:
        """The position at a roll angle (deg). Raises SolverError."""
        model, solution = self.model, self.model.solve(angle, self.torque)
        contacts, flat = _contacts(model, solution), math.cos(model.helix)
        loads = PerGear.each(lambda role: tooth_loads(model, contacts, role))
        return SolidPosition(
            roll_angle=angle,
            approach=solution.approach / flat,
            approach_parts=solution.parts.map(lambda part: part / flat),
            rigid_approach=solution.rigid / flat,
            force=model.force(self.torque),
            contacts=contacts,
            tension=PerGear.each(lambda role: _tension(model.fillets.pick(role).loaded, loads.pick(role))),
            compression=PerGear.each(lambda role: _compression(model.fillets.pick(role).behind, loads.pick(role))),
            bore_tension=PerGear.each(lambda role: _bore_tension(model.fillets.pick(role).bore, loads.pick(role))),
            torques=PerGear.each(lambda role: _hub_torque(model.bodies.pick(role), loads.pick(role))),
        )

    def contacts_at(self, angle: float) -> tuple[SolidPairContact, ...]:
        """The contacts alone at a roll angle (deg). Raises SolverError."""
        return _contacts(self.model, self.model.solve(angle, self.torque))

    @property
    def harmonics(self) -> Floats:
        """Amplitudes (µm) of the transmission error at the tooth frequency and its multiples."""
        error = self.values("transmission_error")
        spectrum = np.fft.rfft(error) / len(error)
        result: Floats = 2 * np.abs(spectrum[1 : (len(error) - 1) // 2 + 1])
        return result

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

    def root_along_face(self, role: Role) -> tuple[Floats, Floats]:
        """Heights (n,) in mm of a gear, and the greatest root tension of the cycle there (n,) in MPa."""
        fillet = self.model.fillets.pick(role).loaded
        stresses: Floats = np.array([position.tension.pick(role).along_face for position in self.every])
        return fillet.heights_between, stresses.max(axis=0)

    def root_face_load_factor(self, role: Role) -> float:
        """K_F_beta: the greatest root tension over its mean along the common face width."""
        heights, stress = self.root_along_face(role)
        low, high = self.model.common_heights(role)
        across = np.linspace(low, high, 201)
        within = np.interp(across, heights, stress)
        return float(within.max() / within.mean())


def tooth_loads(model: SolidPair, contacts: tuple[SolidPairContact, ...], role: Role) -> list[ToothForces]:
    """For each tooth of a gear in contact: its number, as the gear's own teeth follow each other, and the force (N) at each
    unit load's place.
    """
    body, sense = model.bodies.pick(role), TOOTH_ORDER.pick(role)
    return [
        (sense * contact.tooth, body.load_weights(contact.line.places.pick(role)).T @ contact.forces) for contact in contacts
    ]


def _hub_torque(body: SolidCompliance, loads: list[ToothForces]) -> float:
    """Torque (N·m) that the loads put on the hub."""
    return float(sum(force @ -body.torques for _, force in loads)) / 1000


def _tension(fillet: SolidFillet, loads: list[ToothForces]) -> SolidRootStress:
    return _greatest(fillet, [state.greater for state in _states(fillet, loads)], 1)


def _compression(fillet: SolidFillet, loads: list[ToothForces]) -> SolidRootStress:
    return _greatest(fillet, [state.lesser for state in _states(fillet, loads)], -1)


def _states(fillet: SolidFillet, loads: list[ToothForces]) -> list[FilletState]:
    """The fillet of each tooth in contact."""
    return [fillet.state([(tooth - own, force) for tooth, force in loads]) for own, _ in loads]


def _bore_tension(bore: SolidFillet | None, loads: list[ToothForces]) -> float | None:
    return None if bore is None else max(float(state.greater.max()) for state in _states(bore, loads))


def _greatest(fillet: SolidFillet, stresses: list[Floats], sign: int) -> SolidRootStress:
    """The most stressed place of the root of the most stressed tooth."""
    root, along, across = np.flatnonzero(fillet.is_root), fillet.along_root, fillet.along_face
    every = [sign * across @ stress[:, root] @ along.T for stress in stresses]
    worst = max(every, key=np.max)
    row, column = np.unravel_index(int(np.argmax(worst)), worst.shape)
    return SolidRootStress(
        stress=sign * float(worst[row, column]),
        radius=float(along[column] @ fillet.radii[root]),
        height=float(fillet.heights_between[row]),
        tangent_angle=float(along[column] @ fillet.tangent_angles[root]),
        along_face=sign * np.max([stress.max(axis=1) for stress in every], axis=0),
    )


def _contacts(model: SolidPair, solution: LineSolution) -> tuple[SolidPairContact, ...]:
    given, starts = solution.given, solution.starts
    total, sound = solution.forces.sum(), np.zeros(given.cells, bool)
    if starts is not None:
        sound[starts.cells] = starts.sound
    parts = (solution.forces, solution.half_widths, solution.pressures, solution.gaps.radii)
    plain = plain_widths(given, np.concatenate([line.curvature for line in given.lines]), model.helix, solution.forces)
    rounded = [all(onset.length for onset in onsets(flank)) for flank in model.line.flanks]
    every = (given.split(part) for part in (*parts, plain, sound))
    found = []
    for line, forces, widths, pressures, radii, reach, told in zip(given.lines, *every, strict=True):
        if forces.sum() > 0:
            to_end = model.width / 2 - np.abs(line.across)
            to_starts = start_distances(line, model.line)
            distance = np.minimum(np.minimum(line.edge_distance, to_end), np.minimum(*to_starts))
            margin = distance - INTERIOR * reach
            beside = told & (to_end > INTERIOR * reach) & (forces > 0)
            at_start = PerGear(
                *(
                    _greatest_of(pressures, beside & (to < INTERIOR * reach)) if finite else math.nan
                    for to, finite in zip(to_starts, rounded, strict=True)
                )
            )
            edge = float(pressures[np.minimum(line.edge_distance, to_end) < INTERIOR * reach].max(initial=0.0))
            force, share = float(forces.sum()), float(forces.sum() / total)
            found.append(SolidPairContact(line, forces, widths, pressures, radii, margin, at_start, edge, force, share))
    return tuple(found)


def _greatest_of(values: Floats, here: Bools) -> float:
    """Return the greatest of values (n,) at some places (n,), NaN if there are none."""
    return float(values[here].max()) if here.any() else math.nan
