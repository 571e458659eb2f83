"""Convergence of the figures on refined meshes, and the figures at each torque of a sweep."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.check.summary import STRESSES, by_name, figures
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.shared.loaded import Cycle
from gearcad.core.records import JsonObject, PerGear, Role

if TYPE_CHECKING:
    from gearcad.contact.solid.cycle import SolidCycle

FEW_POSITIONS = 12
"""Positions of a mesh cycle where only its extremes matter."""

FACTORS = (0.5, 1.0, 2.0)
"""Refinement of three meshes; the check itself is the middle one."""

LEAST_ORDER = 1.0
"""Order below which the changes from mesh to mesh are taken for noise."""

_SAFETY = 1.25
"""Factor on the change to the finest mesh where the changes go back and forth (Roache)."""

SOLID_FACTORS = (0.794, 1.0, 1.26)
"""Refinement of three solid meshes, each of twice the dofs of the one before; the check itself is the middle one.

Two coarser ones in place of the finer one cannot tell its error: few layers and columns of unit loads move root tensions to and
fro. Of 22 on eleven pairs nine errors were told less than half as great as they are; with the finer mesh four.
"""

SOLID_ORDER = 2.0
"""The greatest order that solid meshes are credited with, and that which is taken where they show a lower one than 1.

It is less than the quadratic elements' own, for what singular edges of tip and face leave of it; and between meshes so close to
each other the roundings of the numbers of elements can feign any order.
"""


_FIGURES = {
    "mean mesh stiffness": "mesh_stiffness_mean",
    "root tension, pinion": "root_tension_pinion",
    "root tension, wheel": "root_tension_wheel",
}
"""Watched figures in words, with their names in a summary."""


@dataclass(frozen=True)
class Convergence:
    """One quantity on meshes of falling size; `order` observed (None where the changes show none); `error` relative."""

    quantity: str
    values: tuple[float, ...]
    factors: tuple[float, ...]
    order: float | None
    error: float

    @property
    def key(self) -> str:
        """Name of the figure in a summary."""
        return _FIGURES[self.quantity]

    @property
    def order_words(self) -> str:
        """The observed order in words."""
        if self.order is None or self.order < LEAST_ORDER:
            return "the changes from mesh to mesh show no order"
        return f"observed order {self.order:.1f}"

    def to_dict(self) -> JsonObject:
        """Return the convergence as `check.json` has it."""
        return asdict(self)


def three_meshes(cycles: Iterable[PlaneCycle]) -> tuple[Convergence, ...]:
    """Return the convergence of each quantity from the cycles on meshes refined by FACTORS.

    The error is Richardson's estimate of the middle mesh's error.
    """
    on_edge: list[tuple[bool, ...]] = []

    def watched() -> Iterator[PlaneCycle]:
        for cycle in cycles:
            on_edge.append((False, *(_on_edge(cycle, role) for role in Role)))
            yield cycle

    every = _values(watched())
    return tuple(
        _of_plane(quantity, values, singular=any(edges))
        for (quantity, values), edges in zip(every, zip(*on_edge, strict=True), strict=True)
    )


def _on_edge(cycle: PlaneCycle, role: Role) -> bool:
    """Return whether the edge of a tip carries load where the root tension of a gear is greatest."""
    return any(contact.edge for contact in cycle.worst_position(role).contacts)


def three_solid_meshes(cycles: Iterable[SolidCycle]) -> tuple[Convergence, ...]:
    """Return the convergence of each quantity from the cycles on meshes refined by SOLID_FACTORS.

    The error is Richardson's estimate of the middle mesh's error.
    """
    return tuple(_of_solids(quantity, values) for quantity, values in _values(cycles))


def _values(cycles: Iterable[Cycle]) -> list[tuple[str, tuple[float, ...]]]:
    """Return mean mesh stiffness and root tension of both gears, mesh by mesh, as a summary of each cycle would tell them.

    A cycle is let go before the next is made.
    """
    every = (figures(cycle) for cycle in cycles)
    found = [(each.mesh_stiffness, *each.root_tension) for each in every]
    return list(zip(_FIGURES, zip(*found, strict=True), strict=True))


def _order(values: tuple[float, ...], refinement: float) -> float | None:
    """Order p at which the changes from mesh to mesh fall, each finer by `refinement`; None where they change sign."""
    coarse, middle, fine = values
    first, second = coarse - middle, middle - fine
    ratio = first / second if second else math.inf
    return math.log(ratio) / math.log(refinement) if 0 < ratio < math.inf else None


def _of_plane(quantity: str, values: tuple[float, ...], *, singular: bool = False) -> Convergence:
    """Return Richardson's estimate by the observed order, or by LEAST_ORDER if that is higher or a `singular` tip edge governs.

    An edge shares the load by how finely it is meshed: the mesh error of such a figure falls slowly. Changes that go back and
    forth show no order.
    """
    _, middle, fine = values
    change, order = abs((middle - fine) / fine), _order(values, 2.0)
    if order is None and not singular:
        return Convergence(quantity, values, FACTORS, order, _SAFETY * change)
    credited = LEAST_ORDER if singular or order is None else max(order, LEAST_ORDER)
    error = change * 2**credited / (2**credited - 1)
    if singular:
        error = max(error, abs(max(values) - min(values)) / abs(fine))
    return Convergence(quantity, values, FACTORS, order, error)


def _of_solids(quantity: str, values: tuple[float, ...]) -> Convergence:
    """Return the convergence of a quantity of solid bodies by its `values` on three meshes, the coarsest first.

    Where the changes go back and forth, the error is their range, twice the uncertainty of F. Stern et al. (J. Fluids Eng. 123,
    2001).

    Else it follows from an order p between LEAST_ORDER and SOLID_ORDER. Where less shows, p is SOLID_ORDER, and the error is
    the greater of what the two changes give: delta r^p/(r^p - 1) from the finer mesh, delta/(r^p - 1) from the coarser one.
    """
    coarse, middle, fine = values
    refinement = SOLID_FACTORS[2]
    order = _order(values, refinement)
    shown = order is not None and order >= LEAST_ORDER
    rest = refinement ** (min(order, SOLID_ORDER) if order is not None and shown else SOLID_ORDER) - 1
    error = abs(middle - fine) * (1 + 1 / rest)
    if (coarse - middle) * (middle - fine) < 0:
        error = max(values) - min(values)
    elif not shown:
        error = max(error, abs(coarse - middle) / rest)
    return Convergence(quantity, values, SOLID_FACTORS, order, error / abs(fine))


class SweepPoint(NamedTuple):
    """One torque (N·m on the pinion) of the sweep: mean mesh stiffness (N/(mm·µm)), greatest pressure (None where all contacts
    are near edges) and root tensions (MPa).

    `torsional_stiffness` is M/phi of each gear (N·m/rad); of a rack force over travel (N/µm).
    """

    torque: float
    mesh_stiffness: float
    contact_pressure: float | None
    root_tension: PerGear[float]
    torsional_stiffness: PerGear[float]

    def to_dict(self) -> JsonObject:
        """Return the point as `check.json` has it."""
        return by_name(self._asdict())


class SweepTrends(NamedTuple):
    """Figures of a sweep over the torque: its `points` in rising order."""

    points: tuple[SweepPoint, ...]

    @classmethod
    def of(cls, sweep: Iterable[SweepPoint]) -> SweepTrends:
        """Return the trends of points that are in any order."""
        return cls(tuple(sorted(sweep, key=lambda point: point.torque)))

    @property
    def first(self) -> SweepPoint:
        """Point of the least torque."""
        return self.points[0]

    @property
    def last(self) -> SweepPoint:
        """Point of the greatest torque."""
        return self.points[-1]

    @property
    def pressure_everywhere(self) -> bool:
        """Whether some contact is away from edges at every torque."""
        return all(point.contact_pressure is not None for point in self.points)

    @property
    def pressure_exponent(self) -> float | None:
        """Power of the torque with which the greatest pressure grows; None where it is missing, or of a single torque."""
        found = [point.contact_pressure for point in self.points if point.contact_pressure is not None]
        return self._exponent(found) if self.pressure_everywhere else None

    @property
    def root_exponents(self) -> PerGear[float] | None:
        """Powers of the torque with which root tensions grow; None of a single torque."""
        powers = [self._exponent(tensions) for tensions in zip(*(point.root_tension for point in self.points), strict=True)]
        known = [power for power in powers if power is not None]
        return PerGear(*known) if len(known) == len(powers) else None

    def _exponent(self, values: Sequence[float]) -> float | None:
        """Return the power of the torque with which values grow from the least torque to the greatest; None for a single
        torque.
        """
        low, high = self.first.torque, self.last.torque
        return math.log(values[-1] / values[0]) / math.log(high / low) if high > low else None

    def to_dict(self) -> JsonObject:
        """Return the exponents as `check.json` has them."""
        roots = self.root_exponents
        return {
            "contact_pressure_exponent": self.pressure_exponent,
            "root_tension_exponents": roots._asdict() if roots is not None else None,
        }


def sweep_point(cycle: Cycle) -> SweepPoint:
    """Return the figures of a cycle at its torque."""
    few, model = figures(cycle), cycle.model
    turns, _ = cycle.mean("approach_parts")
    # A gear whose flank gives way by u along the line of action turns by u/r_b under the torque F r_b. A rack moves by
    # u/cos alpha_t under the force F cos alpha_t.
    radii = np.array([body.flank.lever for body in model.bodies])
    force = model.force(cycle.torque) * model.width
    stiffness = PerGear(*(force * radii**2 / turns / 1000).tolist())
    return SweepPoint(abs(cycle.torque), few.mesh_stiffness, few.contact_pressure, few.root_tension, stiffness)


def sweep_points(cycle: Cycle, torques: Iterable[float]) -> tuple[SweepPoint, ...]:
    """Return the figures of a cycle's model at each of the torques (N·m on the pinion)."""
    cycles = (type(cycle).run(cycle.model, torque, FEW_POSITIONS) for torque in torques)
    return tuple(sweep_point(each.searched(STRESSES)) for each in cycles)
