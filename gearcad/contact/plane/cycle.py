"""One mesh cycle: the contact at positions over a base pitch, and what an engineer reads from it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.contact import ContactPair, ContactSolution
from gearcad.contact.plane.loaded import LoadedCycle, LoadedPosition
from gearcad.contact.plane.pair import FlexiblePair
from gearcad.contact.plane.root import FilletStress, ToothLoad, seen_from
from gearcad.geometry.path import usable_path
from gearcad.meshing.outline import Side

__all__ = [
    "FAIR",
    "INTERIOR",
    "Cycle",
    "PairContact",
    "Position",
    "pitch_point_contact",
    "root_loads",
    "run_cycle",
    "single_stiffness",
]


INTERIOR = 3.0
"""Half widths from the ends of both involutes beyond which a contact is that of two cylinders."""

FAIR = 0.1
"""Share of the load below which a contact is coming in or leaving, and its pressure is not that of the load."""


@dataclass(frozen=True)
class PairContact:
    """One pair of flanks in contact: what it carries, and the comparison with two cylinders under the same load.

    Pressures in MPa, half widths in mm, `force` in N per mm. `interior` is False where the edge of a flank is near. `bent`
    (1/mm) is what the flanks' relative curvature gains there as the bodies give way.
    """

    pair: ContactPair
    pressures: Floats
    force: float
    share: float
    modulus: float
    edge_distance: float
    even_distance: float
    bent: float

    @property
    def tooth(self) -> int:
        """Tooth of the pinion, 0 is the middle one."""
        return self.pair.tooth

    @property
    def peak_pressure(self) -> float:
        """Greatest cell pressure."""
        return float(self.pressures.max())

    @property
    def hertz_half_width(self) -> float:
        """a = sqrt(4 F rho/(pi E*))."""
        return _half_width(self.force, 1 / self.pair.radius + self.bent, self.modulus)

    @property
    def hertz_pressure(self) -> float:
        """p0 = 2 F/(pi a)."""
        return 2 * self.force / (math.pi * self.hertz_half_width)

    @property
    def interior(self) -> bool:
        """True where the ends of both flanks, and their tip and root reliefs, are some half widths away."""
        return self.even_distance > INTERIOR * self.hertz_half_width

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

    def centre(self, gear: int) -> float:
        """Roll length (mm) at the centre of pressure on the pinion (0) or the wheel (1)."""
        lengths = (self.pair.cells.pinion, self.pair.cells.wheel)[gear]
        return float((lengths * self.pressures).sum() / self.pressures.sum())


@dataclass(frozen=True)
class Position(LoadedPosition):
    """A position of the plane model: its contacts, and the root stresses of both gears.

    `bore_tension` (MPa) is the greatest on the surface of a bore that nothing keeps round.
    """

    contacts: tuple[PairContact, ...]
    tension: tuple[FilletStress, FilletStress]
    compression: tuple[FilletStress, FilletStress]
    bore_tension: tuple[float | None, float | None]

    @property
    def interior_contacts(self) -> tuple[PairContact, ...]:
        """Contacts away from the ends of the flanks that carry a fair share."""
        return tuple(contact for contact in self.contacts if contact.interior and contact.share > FAIR)

    @property
    def contact_pressure(self) -> float:
        """The greatest pressure (MPa) of them; NaN if there are none."""
        return max((contact.peak_pressure for contact in self.interior_contacts), default=math.nan)


@dataclass(frozen=True)
class Cycle(LoadedCycle[FlexiblePair, Position]):
    """That of the plane model."""

    @property
    def interior_contacts(self) -> Iterator[tuple[Position, PairContact]]:
        """Contacts away from the ends of the flanks that carry a fair share."""
        for position in self.every:
            for contact in position.interior_contacts:
                yield position, contact

    @property
    def worst_contact(self) -> tuple[Position, PairContact] | None:
        """The contact of the greatest pressure away from the ends of the flanks; None if all are near them."""
        return max(self.interior_contacts, key=lambda of: of[1].peak_pressure, default=None)

    @property
    def heaviest_contact(self) -> tuple[Position, PairContact]:
        """The contact of the greatest load, wherever it is."""
        every = [(position, contact) for position in self.every for contact in position.contacts]
        return max(every, key=lambda of: of[1].force)

    def worst_position(self, gear: int) -> Position:
        """The position of the greatest root tension of the pinion (0) or the wheel (1)."""
        return max(self.every, key=lambda position: position.tension[gear].stress)

    def solve(self, angle: float) -> Position:
        """The position at a roll angle (deg). Raises SolverError."""
        return _position(self.model, angle, self.torque)


def run_cycle(model: FlexiblePair, torque: float, count: int = 60) -> Cycle:
    """Solve `count` positions over one base pitch. Raises SolverError."""
    positions = tuple(_position(model, angle, torque) for angle in model.roll_angles(count).tolist())
    return Cycle(model, torque, positions)


def pitch_point_contact(model: FlexiblePair, torque: float) -> PairContact | None:
    """The contact of the middle pair at the pitch point; None if that pair does not touch there."""
    contacts = _contacts(model, model.solve(0.0, torque))
    return next((contact for contact in contacts if contact.pair.tooth == 0), None)


def single_stiffness(model: FlexiblePair, torque: float, count: int = 25) -> float:
    """Greatest stiffness (N/(mm um)) of one pair of teeth alone, over its path of contact."""
    lengths = np.linspace(*usable_path(model.pair), count + 2)[1:-1]
    angles = np.degrees((lengths - model.pair.path_of_contact.C) / model.base_radius)
    approaches = [
        model.solve(angle, torque, single=True).approach - model.rigid_approach(angle, single=True) for angle in angles.tolist()
    ]
    return model.force(torque) / (min(approaches) * 1000)


def _position(model: FlexiblePair, angle: float, torque: float) -> Position:
    solution = model.solve(angle, torque)
    contacts = _contacts(model, solution)
    loads = [tooth_loads(contacts, gear) for gear in (0, 1)]
    tension, compression = (
        tuple(root.extreme(side, seen) for root, seen in zip(model.fillets, loads, strict=True))
        for side in (Side.LEFT_FILLET, Side.RIGHT_FILLET)
    )
    bore = tuple(root.bore_tension(seen) for root, seen in zip(model.fillets, loads, strict=True))
    return Position(
        angle,
        solution.approach,
        solution.parts,
        model.rigid_approach(angle),
        model.force(torque),
        contacts,
        tension,  # type: ignore[arg-type]
        compression,  # type: ignore[arg-type]
        bore,  # type: ignore[arg-type]
    )


def tooth_loads(contacts: tuple[PairContact, ...], gear: int) -> list[ToothLoad]:
    """Loads on the teeth of the pinion (0) or the wheel (1); on the wheel the teeth follow each other the other way round."""
    sense = (1, -1)[gear]
    return [(sense * contact.pair.tooth, contact.centre(gear), contact.force) for contact in contacts]


def root_loads(contacts: tuple[PairContact, ...], gear: int) -> list[list[ToothLoad]]:
    """For each tooth in contact the loads as that tooth sees them."""
    loads = tooth_loads(contacts, gear)
    return [seen_from(own, loads) for own, *_ in loads]


def _half_width(force: float, curvature: float, modulus: float) -> float:
    return math.sqrt(4 * force / (math.pi * modulus * curvature)) if curvature > 0 else math.inf


def _contacts(model: FlexiblePair, solution: ContactSolution) -> tuple[PairContact, ...]:
    loaded = [
        (pair, pressures, float(force))
        for pair, pressures, force in zip(solution.pairs, solution.pressures, solution.forces, strict=True)
        if force > 0
    ]
    total = float(solution.forces.sum())
    return tuple(
        PairContact(
            pair,
            pressures,
            force,
            force / total,
            model.modulus,
            _distance(model, pair, even=False),
            _distance(model, pair, even=True),
            _bent(model, loaded, place),
        )
        for place, (pair, pressures, force) in enumerate(loaded)
    )


def _bent(model: FlexiblePair, loaded: list[tuple[ContactPair, Floats, float]], which: int) -> float:
    """Curvature (1/mm) of the gap of one pair of flanks by the smooth response of the bodies to the loads of all."""
    pair, pressures, force = loaded[which]
    half = _half_width(force, 1 / pair.radius, model.modulus)
    if not math.isfinite(half):
        return 0.0
    order = np.argsort(pair.cells.place)
    middle = float((pair.cells.place * pressures).sum() / pressures.sum())
    total = 0.0
    for gear, body in enumerate((model.pinion, model.wheel)):
        lengths = (pair.cells.pinion, pair.cells.wheel)[gear]
        at = np.interp(middle + half * np.array([-1.0, 0.0, 1.0]), pair.cells.place[order], lengths[order])
        for other, carried, load in loaded:
            apart = (1, -1)[gear] * (pair.tooth - other.tooth)
            if abs(apart) <= body.neighbours:
                centre = (other.cells.pinion, other.cells.wheel)[gear] @ carried / carried.sum()
                moved = body.response(apart)(at, np.array([centre]))[:, 0]
                total += load * float(moved[0] - 2 * moved[1] + moved[2]) / half**2
    return total


def _distance(model: FlexiblePair, pair: ContactPair, *, even: bool) -> float:
    """How far (mm along the tangent) the nearest end of an involute - or of its even part - is; negative beyond it."""
    distances: list[float] = []
    for flank, contact in ((model.line.pinion, pair.pinion), (model.line.wheel, pair.wheel)):
        first, last = flank.even if even else (flank.first, flank.last)
        distances += (flank.along_tangent(contact, last), -flank.along_tangent(contact, first))
    return min(distances)
