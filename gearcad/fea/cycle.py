"""One mesh cycle: the contact at positions over a base pitch, and what an engineer reads from it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gearcad.fea.contact import ContactPair, ContactSolution
from gearcad.fea.flexible_pair import FlexiblePair
from gearcad.fea.root import Fillets, FilletStress
from gearcad.geometry.contact import usable_path
from gearcad.meshing.outline import Side

__all__ = [
    "Cycle",
    "LoadedPosition",
    "PairContact",
    "Position",
    "pitch_point_contact",
    "root_loads",
    "run_cycle",
    "single_stiffness",
]

Floats = NDArray[np.float64]

_INTERIOR = 3.0
"""Half widths from the ends of both involutes beyond which a contact is that of two cylinders."""


@dataclass(frozen=True)
class PairContact:
    """One pair of flanks in contact: what it carries, and the comparison with two cylinders under the same load.

    Pressures in MPa, half widths in mm, `force` in N per mm. `interior` is False where the edge of a flank is near.
    """

    pair: ContactPair
    pressures: Floats
    force: float
    share: float
    modulus: float
    edge_distance: float
    even_distance: float

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
        return math.sqrt(4 * self.force * self.pair.radius / (math.pi * self.modulus))

    @property
    def hertz_pressure(self) -> float:
        """p0 = 2 F/(pi a)."""
        return 2 * self.force / (math.pi * self.hertz_half_width)

    @property
    def interior(self) -> bool:
        """True where the ends of both flanks, and their tip and root reliefs, are some half widths away."""
        return self.even_distance > _INTERIOR * self.hertz_half_width

    @cached_property
    def half_width(self) -> float:
        """Half width by a fit of p^2 over x^2 in the loaded cells: counting cells would be quantised."""
        loaded = self.pressures > 0.5 * self.peak_pressure
        x, squared = self.pair.cells.place[loaded], self.pressures[loaded] ** 2
        if len(x) < 4:
            return math.nan
        middle, scale = x.mean(), np.ptp(x)
        two, one, zero = np.polyfit((x - middle) / scale, squared, 2)
        return float(scale * math.sqrt(max(one**2 - 4 * two * zero, 0.0)) / (2 * abs(two)))

    def centre(self, gear: int) -> float:
        """Roll length (mm) at the centre of pressure on the pinion (0) or the wheel (1)."""
        lengths = (self.pair.cells.pinion, self.pair.cells.wheel)[gear]
        return float((lengths * self.pressures).sum() / self.pressures.sum())


@dataclass(frozen=True)
class LoadedPosition:
    """One position of a mesh under load: approach and each gear's part of it along the line of action (mm).

    `rigid_approach` (mm) is what of the approach needs no load: until teeth touch whose flanks are modified or out of place.
    `force` is the normal force in the transverse section (N per mm of common face width).
    """

    roll_angle: float
    approach: float
    approach_parts: tuple[float, float]
    rigid_approach: float
    force: float

    @property
    def stiffness(self) -> float:
        """N/(mm um): normal force over the approach under load, per mm of common face width."""
        return self.force / ((self.approach - self.rigid_approach) * 1000)

    @property
    def transmission_error(self) -> float:
        """um along the line of action by which the wheel lags."""
        return self.approach * 1000


@dataclass(frozen=True)
class Position(LoadedPosition):
    """A position of the plane model: its contacts, and the root stresses of both gears."""

    contacts: tuple[PairContact, ...]
    tension: tuple[FilletStress, FilletStress]
    compression: tuple[FilletStress, FilletStress]


@dataclass(frozen=True)
class Cycle:
    """All positions of one base pitch at one torque (N m on the pinion)."""

    model: FlexiblePair
    torque: float
    positions: tuple[Position, ...]

    def values(self, name: str) -> Floats:
        """A quantity of every position, such as "stiffness"."""
        return np.array([getattr(position, name) for position in self.positions])

    @property
    def interior_contacts(self) -> Iterator[tuple[Position, PairContact]]:
        """Contacts away from the ends of the flanks that carry a fair share."""
        for position in self.positions:
            for contact in position.contacts:
                if contact.interior and contact.share > 0.1:
                    yield position, contact

    @property
    def worst_contact(self) -> tuple[Position, PairContact]:
        """The contact of the greatest pressure away from the ends of the flanks; if none is, that of the greatest load."""
        inside = list(self.interior_contacts)
        if inside:
            return max(inside, key=lambda of: of[1].peak_pressure)
        every = [(position, contact) for position in self.positions for contact in position.contacts]
        return max(every, key=lambda of: of[1].force)

    def worst_position(self, gear: int) -> Position:
        """The position of the greatest root tension of the pinion (0) or the wheel (1)."""
        return max(self.positions, key=lambda position: position.tension[gear].stress)


def run_cycle(model: FlexiblePair, torque: float, count: int = 60) -> Cycle:
    """Solve `count` positions over one base pitch. Raises SolverError."""
    roots = (Fillets(model.pinion), Fillets(model.wheel))
    angles = model.roll_angles(count)
    return Cycle(model, torque, tuple(_position(model, roots, float(angle), torque) for angle in angles))


def pitch_point_contact(model: FlexiblePair, torque: float) -> PairContact:
    """The contact of the middle pair at the pitch point."""
    contacts = _contacts(model, model.solve(0.0, torque))
    return next(contact for contact in contacts if contact.pair.tooth == 0)


def single_stiffness(model: FlexiblePair, torque: float, count: int = 25) -> float:
    """Greatest stiffness (N/(mm um)) of one pair of teeth alone, over its path of contact."""
    lengths = np.linspace(*usable_path(model.pair), count + 2)[1:-1]
    angles = np.degrees((lengths - model.pair.path_of_contact.C) / model.base_radius)
    approaches = [
        model.solve(angle, torque, single=True).approach - model.rigid_approach(angle, single=True) for angle in angles.tolist()
    ]
    return model.force(torque) / (min(approaches) * 1000)


def _position(model: FlexiblePair, roots: tuple[Fillets, Fillets], angle: float, torque: float) -> Position:
    solution = model.solve(angle, torque)
    contacts = _contacts(model, solution)
    tension, compression = (
        tuple(_greatest(root, side, contacts, gear) for gear, root in enumerate(roots))
        for side in (Side.LEFT_FILLET, Side.RIGHT_FILLET)
    )
    return Position(
        angle,
        solution.approach,
        solution.parts,
        model.rigid_approach(angle),
        model.force(torque),
        contacts,
        tension,  # type: ignore[arg-type]
        compression,  # type: ignore[arg-type]
    )


def _greatest(root: Fillets, side: Side, contacts: tuple[PairContact, ...], gear: int) -> FilletStress:
    """The most stressed of the teeth in contact."""
    found = [root.greatest(side, loads) for loads in root_loads(contacts, gear)]
    return max(found, key=lambda stress: abs(stress.stress))


def root_loads(contacts: tuple[PairContact, ...], gear: int) -> list[list[tuple[int, float, float]]]:
    """For each tooth in contact the loads as that tooth sees them: teeth away, roll length (mm), force (N per mm).

    On the wheel the teeth follow each other the other way round.
    """
    sense = (1, -1)[gear]
    loads = [(sense * contact.pair.tooth, contact.centre(gear), contact.force) for contact in contacts]
    return [[(tooth - own, length, force) for tooth, length, force in loads] for own, *_ in loads]


def _contacts(model: FlexiblePair, solution: ContactSolution) -> tuple[PairContact, ...]:
    total = solution.forces.sum()
    return tuple(
        PairContact(
            pair,
            pressures,
            float(force),
            float(force / total),
            model.modulus,
            _distance(model, pair, even=False),
            _distance(model, pair, even=True),
        )
        for pair, pressures, force in zip(solution.pairs, solution.pressures, solution.forces, strict=True)
        if force > 0
    )


def _distance(model: FlexiblePair, pair: ContactPair, *, even: bool) -> float:
    """How far (mm along the tangent) the nearest end of an involute - or of its even part - is; negative beyond it."""
    distances: list[float] = []
    for flank, contact in ((model.line.pinion, pair.pinion), (model.line.wheel, pair.wheel)):
        first, last = flank.even if even else (flank.first, flank.last)
        distances += (flank.along_tangent(contact, last), -flank.along_tangent(contact, first))
    return min(distances)
