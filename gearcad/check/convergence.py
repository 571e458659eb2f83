"""How far the figures are from those of an infinitely fine mesh: refined meshes, and an estimate from what they change."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

from gearcad.check.summary import figures
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.shared.loaded import Cycle
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.per_gear import Role

__all__ = [
    "FACTORS",
    "FEW_POSITIONS",
    "LEAST_ORDER",
    "SOLID_FACTORS",
    "SOLID_ORDER",
    "Convergence",
    "three_meshes",
    "three_solid_meshes",
]

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
"""What is watched, in words, and its name in a summary."""


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
        """Of the figure in a summary."""
        return _FIGURES[self.quantity]

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        return asdict(self)


def three_meshes(cycles: Iterable[PlaneCycle]) -> tuple[Convergence, ...]:
    """From the cycles on meshes refined by FACTORS: Richardson's estimate of the middle one's error."""
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
    """Whether the edge of a tip carries load where the root tension of a gear is greatest."""
    return any(contact.edge for contact in cycle.worst_position(role).contacts)


def three_solid_meshes(cycles: Iterable[SolidCycle]) -> tuple[Convergence, ...]:
    """From the cycles on meshes refined by SOLID_FACTORS: Richardson's estimate of the middle one's error."""
    return tuple(_of_solids(quantity, values) for quantity, values in _values(cycles))


def _values(cycles: Iterable[Cycle]) -> list[tuple[str, tuple[float, ...]]]:
    """Mean mesh stiffness and root tension of both gears, mesh by mesh, as a summary of each cycle would tell them.

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
    """Richardson's estimate by the order that shows; LEAST_ORDER where it is less, or where a `singular` tip edge leads.

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
    """Where the changes go back and forth, their range, twice the uncertainty of F. Stern et al. (J. Fluids Eng. 123, 2001).

    Else with an order p between LEAST_ORDER and SOLID_ORDER, or where less shows with the latter and the greater of what the
    two changes give: delta r^p/(r^p - 1) from the finer mesh, delta/(r^p - 1) from the coarser one.
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
