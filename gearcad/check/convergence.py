"""How far the figures are from those of an infinitely fine mesh: refined meshes, and an estimate from what they change."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

from gearcad.check.summary import figures
from gearcad.fea.cycle import Cycle
from gearcad.ltca.solid_cycle import SolidCycle

__all__ = ["FACTORS", "FEW_POSITIONS", "FINER", "LEAST_ORDER", "SOLID_ORDER", "Convergence", "three_meshes", "two_meshes"]

FEW_POSITIONS = 12
"""Positions of a mesh cycle where only its extremes matter."""

FACTORS = (0.5, 1.0, 2.0)
"""Refinement of three meshes; the check itself is the middle one."""

LEAST_ORDER = 1.0
"""Order below which the changes from mesh to mesh are taken for noise."""

_SAFETY = 1.25
"""Factor on the change to the finest mesh where the changes are too small or too uneven to show an order (Roache)."""

FINER = 1.26
"""Refinement of the second of two solid meshes: twice the dofs."""

SOLID_ORDER = 2.0
"""Order at which two solid meshes are taken to converge: less than the quadratic elements' own, for what singular corners of
fillet and face leave of it."""


@dataclass(frozen=True)
class Convergence:
    """One quantity on meshes of falling size; `order` observed (None where the changes show none); `error` relative."""

    quantity: str
    values: tuple[float, ...]
    factors: tuple[float, ...]
    order: float | None
    error: float

    @property
    def last_change(self) -> float:
        """Relative change from the last mesh but one to the last."""
        return abs(self.values[-2] / self.values[-1] - 1)

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        return asdict(self)


def three_meshes(cycles: Iterable[Cycle]) -> tuple[Convergence, ...]:
    """From the cycles on meshes refined by FACTORS: Richardson's estimate of the middle one's error."""
    return tuple(_richardson(quantity, values) for quantity, values in _values(cycles))


def two_meshes(cycles: Iterable[SolidCycle]) -> tuple[Convergence, ...]:
    """From the cycles on a mesh and a refined one: the change, times 1/(1 - FINER^-SOLID_ORDER)."""
    rest = 1 / (1 - FINER**-SOLID_ORDER)
    return tuple(
        Convergence(quantity, values, (1.0, FINER), None, rest * abs(values[0] / values[1] - 1))
        for quantity, values in _values(cycles)
    )


def _values(cycles: Iterable[Cycle | SolidCycle]) -> list[tuple[str, tuple[float, ...]]]:
    """Mean mesh stiffness and root tension of both gears, mesh by mesh."""
    few = [figures(cycle) for cycle in cycles]
    words = ("mean mesh stiffness", "root tension, pinion", "root tension, wheel")
    return list(zip(words, zip(*((of.mesh_stiffness, *of.root_tension) for of in few), strict=True), strict=True))


def _richardson(quantity: str, values: tuple[float, ...]) -> Convergence:
    coarse, middle, fine = values
    first, second = coarse - middle, middle - fine
    ratio = first / second if second else math.inf
    order = math.log2(ratio) if 0 < ratio < math.inf else None
    if order is None or order < LEAST_ORDER:
        return Convergence(quantity, values, FACTORS, order, _SAFETY * abs(second / fine))
    return Convergence(quantity, values, FACTORS, order, abs(second / fine) * 2**order / (2**order - 1))
