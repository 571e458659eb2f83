"""How far the figures are from those of an infinitely fine mesh: three meshes, observed order, Richardson's estimate."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

from gearcad.check.options import CheckOptions
from gearcad.check.summary import figures
from gearcad.fea.cycle import run_cycle
from gearcad.fea.flexible_pair import FlexiblePair, flexible_pair
from gearcad.material import Material
from gearcad.meshing import MeshSizes

__all__ = ["LEAST_ORDER", "Convergence", "study_convergence"]

_FACTORS = (0.5, 1.0, 2.0)
"""Refinement of the three meshes; the check itself is the middle one."""

_POSITIONS = 12
LEAST_ORDER = 1.0
"""Order below which the changes from mesh to mesh are taken for noise."""

_SAFETY = 1.25
"""Factor on the change to the finest mesh where the changes are too small or too uneven to show an order (Roache)."""


@dataclass(frozen=True)
class Convergence:
    """One quantity on meshes of falling size; `order` observed (None where the changes show none); `error` relative."""

    quantity: str
    values: tuple[float, ...]
    factors: tuple[float, ...]
    order: float | None
    error: float

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        return asdict(self)


def study_convergence(
    middle: FlexiblePair, material: Material, options: CheckOptions, torque: float
) -> tuple[Convergence, ...]:
    """Mean mesh stiffness and root tension of both gears on the mesh of `middle`, one half as fine and one twice as fine."""
    found: dict[str, list[float]] = {"mean mesh stiffness": [], "root tension, pinion": [], "root tension, wheel": []}
    for factor in _FACTORS:
        sizes = MeshSizes().refined(factor)
        model = middle
        if factor != 1:
            error = 1000 * middle.line.proud
            model = flexible_pair(
                middle.pair, material, plane=options.plane_state, body=options.body, sizes=sizes, pitch_error=error
            )
        few = figures(run_cycle(model, torque, _POSITIONS))
        for values, value in zip(found.values(), (few.mesh_stiffness, *few.root_tension), strict=True):
            values.append(value)
    return tuple(_estimate(quantity, tuple(values)) for quantity, values in found.items())


def _estimate(quantity: str, values: tuple[float, ...]) -> Convergence:
    coarse, middle, fine = values
    first, second = coarse - middle, middle - fine
    ratio = first / second if second else math.inf
    order = math.log2(ratio) if 0 < ratio < math.inf else None
    if order is None or order < LEAST_ORDER:
        return Convergence(quantity, values, _FACTORS, order, _SAFETY * abs(second / fine))
    return Convergence(quantity, values, _FACTORS, order, abs(second / fine) * 2**order / (2**order - 1))
