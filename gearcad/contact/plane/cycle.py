"""One mesh cycle of the plane model: the contact at positions over a base pitch, and what an engineer reads from it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.contact import ContactPair, ContactSolution
from gearcad.contact.plane.pair import PlanePair
from gearcad.contact.plane.root import ToothLoad, seen_from
from gearcad.contact.shared.engaged import TOOTH_ORDER
from gearcad.contact.shared.line_of_action import overlap
from gearcad.contact.shared.loaded import FAIR, INTERIOR, LoadedCycle, LoadedPosition, PairContact, RootStress
from gearcad.contact.shared.relief_start import onsets, start_distance
from gearcad.meshing.section.outline import Side
from gearcad.per_gear import PerGear, Role
from gearcad.rating.hertz import half_width_by_curvature

__all__ = ["PlaneCycle", "PlanePairContact", "PlanePosition", "root_loads"]

_RESOLVED = 4
"""Cells over a transition with which its pressure is right within 0.25 %."""


@dataclass(frozen=True)
class PlanePairContact(PairContact):
    """One pair of flanks in contact: what it carries, and the comparison with two cylinders under the same load.

    Pressures in MPa, half widths in mm, `force` in N per mm. `interior` is False where the edge of a flank or the start of a
    linear relief is near. `even_distance` (mm) is that from a parabolic relief, `start_distances` those from the transitions of
    each gear's linear reliefs, `start_pressures` the greatest (MPa) near these, NaN where none is told.
    `bent` (1/mm) is what the flanks' relative curvature gains there as the bodies give way.
    """

    pair: ContactPair
    pressures: Floats
    force: float
    share: float
    modulus: float
    edge_distance: float
    even_distance: float
    start_distances: PerGear[float]
    start_pressures: PerGear[float]
    bent: float

    @property
    def tooth(self) -> int:
        """Tooth of the pinion, 0 is the middle one."""
        return self.pair.tooth

    @property
    def place(self) -> float:
        """Roll length (mm) of the pinion's flank: where the pair touches on the line of action, from T1."""
        return self.pair.lengths.pinion

    @property
    def edge(self) -> bool:
        """True if the edge of a tip touches, beyond the end of an involute."""
        return self.edge_distance < 0

    @property
    def peak_pressure(self) -> float:
        """Greatest cell pressure."""
        return float(self.pressures.max())

    @property
    def hertz_half_width(self) -> float:
        """a = sqrt(4 F rho/(pi E*))."""
        return half_width_by_curvature(self.force, 1 / self.pair.radius + self.bent, self.modulus)

    @property
    def hertz_pressure(self) -> float:
        """p0 = 2 F/(pi a)."""
        return 2 * self.force / (math.pi * self.hertz_half_width)

    @property
    def interior(self) -> bool:
        """True where the ends of both flanks and the starts of their linear reliefs are some half widths away."""
        return min(self.edge_distance, *self.start_distances) > _reach(self.pair, self.force, self.modulus)

    @property
    def two_cylinders(self) -> bool:
        """True where no parabolic relief is near either, along which the curvature changes."""
        return self.interior and self.even_distance > INTERIOR * self.hertz_half_width

    @property
    def interior_pressure(self) -> float | None:
        """The greatest cell pressure; None near an edge of a flank."""
        return self.peak_pressure if self.interior else None

    @cached_property
    def half_width(self) -> float:
        """Half width by a fit of p^2 over x^2 in the loaded cells: counting cells would be quantised.

        NaN where too few cells are loaded, or their pressures have no such shape.
        """
        loaded = self.pressures > 0.5 * self.peak_pressure
        x, squared = self.pair.cells.place[loaded], self.pressures[loaded] ** 2
        if len(x) < 4:
            return math.nan
        middle, scale = x.mean(), np.ptp(x)
        two, one, zero = np.polyfit((x - middle) / scale, squared, 2)
        inside = one**2 - 4 * two * zero
        return float(scale * math.sqrt(inside) / (2 * abs(two))) if two < 0 < inside else math.nan

    def centre(self, role: Role) -> float:
        """Roll length (mm) at the centre of pressure on a gear's flank."""
        return float((self.pair.cells.lengths.pick(role) * self.pressures).sum() / self.pressures.sum())


@dataclass(frozen=True)
class PlanePosition(LoadedPosition[PlanePairContact]):
    """One position of two sections."""

    @property
    def interior_contacts(self) -> tuple[PlanePairContact, ...]:
        """Contacts away from the ends of the flanks that carry a fair share."""
        return tuple(contact for contact in self.contacts if contact.interior and contact.share > FAIR)


@dataclass(frozen=True)
class PlaneCycle(LoadedCycle[PlanePair, PlanePosition, PlanePairContact]):
    """Two sections over one base pitch; forces, stiffness and pressures are those of the common face width, all alike."""

    def solve(self, angle: float) -> PlanePosition:
        """The position at a roll angle (deg). Raises SolverError."""
        model, solution = self.model, self.model.solve(angle, self.torque)
        contacts = _contacts(model, solution)
        loads = PerGear.each(lambda role: tooth_loads(contacts, role))

        def extreme(side: Side) -> PerGear[RootStress]:
            return PerGear.each(lambda role: model.fillets.pick(role).extreme(side, loads.pick(role)))

        return PlanePosition(
            roll_angle=angle,
            approach=solution.approach,
            approach_parts=solution.parts,
            rigid_approach=model.rigid_approach(angle),
            force=model.force(self.torque),
            contacts=contacts,
            tension=extreme(Side.LEFT_FILLET),
            compression=extreme(Side.RIGHT_FILLET),
            bore_tension=PerGear.each(lambda role: model.fillets.pick(role).bore_tension(loads.pick(role))),
            torques=PerGear.each(lambda role: _hub_torque(model, contacts, role)),
        )

    def contacts_at(self, angle: float) -> tuple[PlanePairContact, ...]:
        """The contacts alone at a roll angle (deg). Raises SolverError."""
        return _contacts(self.model, self.model.solve(angle, self.torque))


def tooth_loads(contacts: tuple[PlanePairContact, ...], role: Role) -> list[ToothLoad]:
    """Loads on the teeth of a gear, counted as its own teeth follow each other."""
    sense = TOOTH_ORDER.pick(role)
    return [(sense * contact.tooth, contact.centre(role), contact.force) for contact in contacts]


def root_loads(contacts: tuple[PlanePairContact, ...], role: Role) -> list[list[ToothLoad]]:
    """For each tooth in contact the loads as that tooth sees them."""
    loads = tooth_loads(contacts, role)
    return [seen_from(own, loads) for own, *_ in loads]


def _hub_torque(model: PlanePair, contacts: tuple[PlanePairContact, ...], role: Role) -> float:
    """Torque (N·m) that the loads put on a gear's hub."""
    body = model.bodies.pick(role)
    return sum(body.hub_torque(contact.centre(role)) * contact.force for contact in contacts) * model.width / 1000


def _contacts(model: PlanePair, solution: ContactSolution) -> tuple[PlanePairContact, ...]:
    loaded = [
        (pair, pressures, float(force))
        for pair, pressures, force in zip(solution.pairs, solution.pressures, solution.forces, strict=True)
        if force > 0
    ]
    total = float(solution.forces.sum())
    return tuple(
        PlanePairContact(
            pair,
            pressures,
            force,
            force / total,
            model.modulus,
            _distance(model, pair, even=False),
            _distance(model, pair, even=True),
            to_starts := _start_distances(model, pair),
            _start_pressures(model, pair, pressures, to_starts),
            _bent(model, loaded, place),
        )
        for place, (pair, pressures, force) in enumerate(loaded)
    )


def _bent(model: PlanePair, loaded: list[tuple[ContactPair, Floats, float]], place: int) -> float:
    """Curvature (1/mm) of the gap of one pair of flanks by the smooth response of the bodies to the loads of all."""
    pair, pressures, force = loaded[place]
    half = half_width_by_curvature(force, 1 / pair.radius, model.modulus)
    if not math.isfinite(half):
        return 0.0
    order = np.argsort(pair.cells.place)
    middle = float((pair.cells.place * pressures).sum() / pressures.sum())
    total = 0.0
    for role, body in model.bodies.items():
        lengths = pair.cells.lengths.pick(role)
        around = np.interp(middle + half * np.array([-1.0, 0.0, 1.0]), pair.cells.place[order], lengths[order])
        before, here, behind = body.by_unit_loads(around)
        bends = (before - 2 * here + behind) / half**2
        centres = [other.cells.lengths.pick(role) @ carried / carried.sum() for other, carried, _ in loaded]
        for (other, _, load), parts in zip(loaded, body.parts_of_loads(np.array(centres)), strict=True):
            apart = TOOTH_ORDER.pick(role) * (pair.tooth - other.tooth)
            if abs(apart) <= body.neighbours:
                total += load * float(bends[apart + body.neighbours] @ parts)
    return total


def _distance(model: PlanePair, pair: ContactPair, *, even: bool) -> float:
    """How far (mm along the tangent) the nearest end of an involute - or of its even part - is; negative beyond it."""
    distances: list[float] = []
    for flank, length in zip(model.line.flanks, pair.lengths, strict=True):
        first, last = flank.even if even else (flank.first, flank.last)
        distances += (flank.along_tangent(length, last), -flank.along_tangent(length, first))
    return min(distances)


def _start_distances(model: PlanePair, pair: ContactPair) -> PerGear[float]:
    """How far (mm along the tangent) the nearest transition of a linear relief of each gear is, as `start_distance`."""
    found = []
    for flank, length in zip(model.line.flanks, pair.lengths, strict=True):
        every = (start_distance(flank.base_radius, of, np.array(length), pair.plain_radius) for of in onsets(flank))
        found.append(min(map(float, every), default=math.inf))
    return PerGear(*found)


def _reach(pair: ContactPair, force: float, modulus: float) -> float:
    """Distance (mm) from edges and starts of reliefs beyond which a contact is that of two cylinders."""
    return INTERIOR * half_width_by_curvature(force, 1 / pair.plain_radius, modulus)


def _start_pressures(model: PlanePair, pair: ContactPair, pressures: Floats, to_starts: PerGear[float]) -> PerGear[float]:
    """Greatest pressures (MPa) near the starts of each gear's reliefs; NaN where cells are too wide for a transition, or an end
    of a flank lies in the contact.
    """
    cells, (low, high) = pair.cells, overlap(model.line, pair.lengths.pinion)
    pressed = cells.place[pressures > 0]
    shortest = min((onset.length for flank in model.line.flanks for onset in onsets(flank)), default=math.inf)
    narrow = cells.width <= shortest / _RESOLVED
    sound = narrow and low + cells.width < pressed.min() and pressed.max() < high - cells.width
    reach, peak = _reach(pair, float(pressures.sum() * cells.width), model.modulus), float(pressures.max())
    return to_starts.map(lambda to: peak if sound and to < reach else math.nan)
