"""Engaged gears under load, whatever the model: contacts, root stresses, a position, and the positions of one base pitch."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter, itemgetter
from typing import Any, Generic, Self, TypeAlias, TypeVar

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.shared.engaged import FlankCompliance, FlexiblePair
from gearcad.contact.shared.extremes import Extreme, Quantity, RollRange, add_positions, extreme
from gearcad.per_gear import PerGear, Role

__all__ = ["FAIR", "INTERIOR", "LEAST_TANGENT_ANGLE", "Cycle", "LoadedCycle", "LoadedPosition", "PairContact", "RootStress"]


INTERIOR = 3.0
"""Half widths from the edges of both flanks beyond which a contact is that of two cylinders."""

FAIR = 0.1
"""Share of the load below which a contact is coming in or leaving, and its pressure is not that of the load."""

LEAST_TANGENT_ANGLE = 12.0
"""Tangent angle (deg) from which on a fillet counts as the root: above, a contact near the start of the flank presses on it.

It is negative where undercut draws the tooth in.
"""


@dataclass(frozen=True)
class RootStress:
    """The greatest stress of a fillet (MPa), its radius (mm), and its angle to the middle of the tooth (deg).

    ISO 6336-3 looks where that angle is 30.
    """

    stress: float
    radius: float
    tangent_angle: float


class PairContact(ABC):
    """One pair of teeth in contact: what it carries, and how far its pressure is that of two cylinders."""

    force: float
    """Normal force: N, per mm of width in the plane."""

    share: float
    """Of the load that all pairs carry."""

    start_pressures: PerGear[float]
    """The greatest (MPa) at the starts of each gear's linear reliefs, NaN where none is told."""

    @property
    @abstractmethod
    def tooth(self) -> int:
        """Tooth of the pinion, 0 is the middle one."""

    @property
    @abstractmethod
    def place(self) -> float:
        """Where on the line of action (mm from T1) the pair touches in the middle of the common face width."""

    @property
    @abstractmethod
    def edge(self) -> bool:
        """True if the edge of a tip touches."""

    @property
    @abstractmethod
    def interior_pressure(self) -> float | None:
        """Greatest pressure (MPa) away from all edges of both flanks; None if all of the contact is near them."""


C = TypeVar("C", bound=PairContact, covariant=True)


@dataclass(frozen=True)
class LoadedPosition(ABC, Generic[C]):
    """One position of engaged gears under load: approach and each gear's part of it along the line of action (mm).

    `rigid_approach` (mm) is what of the approach needs no load: until teeth touch whose flanks are modified or out of place.
    `force` is the normal force in the transverse section (N per mm of common face width), `torques` (N·m) act on the hubs.
    `tension` and `compression` are the greatest of the roots, `bore_tension` (MPa) that of a bore that nothing keeps round.
    """

    roll_angle: float
    approach: float
    approach_parts: PerGear[float]
    rigid_approach: float
    force: float
    contacts: tuple[C, ...]
    tension: PerGear[RootStress]
    compression: PerGear[RootStress]
    bore_tension: PerGear[float | None]
    torques: PerGear[float]

    @property
    def stiffness(self) -> float:
        """N/(mm·µm): normal force over the approach under load, per mm of common face width."""
        return self.force / ((self.approach - self.rigid_approach) * 1000)

    @property
    def transmission_error(self) -> float:
        """µm along the line of action by which the wheel lags."""
        return self.approach * 1000

    @property
    @abstractmethod
    def interior_contacts(self) -> tuple[C, ...]:
        """Contacts away from the edges of the flanks that carry a fair share."""

    @property
    def contact_pressure(self) -> float:
        """Greatest pressure (MPa) of the interior contacts; NaN if there are none."""
        pressures = (contact.interior_pressure for contact in self.interior_contacts)
        return max((pressure for pressure in pressures if pressure is not None), default=math.nan)


M = TypeVar("M", bound=FlexiblePair[FlankCompliance], covariant=True)
P = TypeVar("P", bound=LoadedPosition[Any], covariant=True)


@dataclass(frozen=True)
class LoadedCycle(ABC, Generic[M, P, C]):
    """Positions evenly over one base pitch at one torque (N·m on the pinion), and those `between` them at extremes."""

    model: M
    torque: float
    positions: tuple[P, ...] = ()
    between: tuple[P, ...] = ()

    @classmethod
    def run(
        cls,
        model: M,  # type: ignore[misc]  # a class method does not go through an instance
        torque: float,
        count: int,
        progress: Callable[[int, int], None] = lambda _done, _all: None,
    ) -> Self:
        """Solve `count` positions over one base pitch. Raises SolverError."""
        cycle, positions = cls(model, torque), []
        for done, angle in enumerate(model.roll_angles(count).tolist()):
            progress(done, count)
            positions.append(cycle.solve(angle))
        return replace(cycle, positions=tuple(positions))

    @abstractmethod
    def solve(self, angle: float) -> P:
        """The position at a roll angle (deg). Raises SolverError."""

    @abstractmethod
    def contacts_at(self, angle: float) -> tuple[C, ...]:
        """The contacts alone at a roll angle (deg). Raises SolverError."""

    @property
    def every(self) -> tuple[P, ...]:
        """All positions in the order of the roll angles."""
        return tuple(sorted((*self.positions, *self.between), key=attrgetter("roll_angle")))

    # ------------------------------------------------------------------ contacts and roots

    @property
    def contacts(self) -> Iterator[tuple[P, C]]:
        """Contacts of all positions."""
        return ((position, contact) for position in self.every for contact in position.contacts)

    @property
    def interior_contacts(self) -> Iterator[tuple[P, C]]:
        """Those away from the edges of the flanks that carry a fair share."""
        return ((position, contact) for position in self.every for contact in position.interior_contacts)

    @property
    def worst_contact(self) -> tuple[P, C] | None:
        """The contact of the greatest pressure away from the edges of the flanks; None if all are near them."""
        return max(self.interior_contacts, key=lambda found: found[1].interior_pressure or 0.0, default=None)

    @property
    def heaviest_contact(self) -> tuple[P, C]:
        """The contact of the greatest load, wherever it is."""
        return max(self.contacts, key=lambda found: found[1].force)

    @property
    def pitch_point_contact(self) -> C | None:
        """The contact of the pair that touches at the pitch point in the middle of the face; None if it does not touch."""
        return next((contact for contact in self.contacts_at(0.0) if contact.tooth == 0), None)

    @property
    def edge_positions(self) -> int:
        """Even positions at which the edge of a tip touches."""
        return sum(any(contact.edge for contact in position.contacts) for position in self.positions)

    def worst_position(self, role: Role) -> P:
        """The position of the greatest root tension of a gear."""
        return max(((position.tension.pick(role).stress, position) for position in self.every), key=itemgetter(0))[1]

    # ------------------------------------------------------------------ courses over the base pitch

    def values(self, name: str) -> Floats:
        """A quantity at the even positions, such as "stiffness"."""
        return np.array([getattr(position, name) for position in self.positions])

    def course(self, name: str) -> Floats:
        """A quantity at all positions, such as "roll_angle", in the order of the roll angles."""
        return np.array([getattr(position, name) for position in self.every])

    def mean(self, name: str) -> tuple[Floats, Floats]:
        """The mean of a quantity over the base pitch, by a curve through all positions, and how far straight lines are off."""
        from scipy.interpolate import PchipInterpolator

        if not self.model.repeats:  # nothing joins the last position to the first
            even = self.values(name).mean(axis=0)
            return even, np.zeros_like(even)
        angles, values, pitch = self.course("roll_angle"), self.course(name), self._span.pitch
        beside = np.r_[angles[-3:] - pitch, angles, angles[:3] + pitch]
        curve = PchipInterpolator(beside, np.r_[values[-3:], values, values[:3]])
        mean = curve.integrate(-pitch / 2, pitch / 2) / pitch
        lines = np.diff(angles, append=angles[0] + pitch) @ (values + np.roll(values, -1, axis=0)) / 2 / pitch
        return mean, np.abs(lines - mean)

    def searched(self, quantities: Sequence[Quantity[P]]) -> Self:
        """With positions between the even ones, so that the quantities' greatest values are found."""
        return replace(self, between=(*self.between, *add_positions(self._known, self._span, self.solve, quantities)))

    def extreme(self, quantity: Quantity[P]) -> Extreme | None:
        """The greatest value of all positions, and what may be missed of it; None where there is none."""
        return extreme(self._known, self._span, quantity)

    @property
    def _known(self) -> list[tuple[float, P]]:
        return [(position.roll_angle, position) for position in self.every]

    @property
    def _span(self) -> RollRange:
        return RollRange(360 / self.model.pair.pinion.teeth, self.model.repeats)


Cycle: TypeAlias = LoadedCycle[FlexiblePair[FlankCompliance], LoadedPosition[PairContact], PairContact]
"""That of any model."""
