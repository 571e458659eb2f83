"""MeshResult: the meshes of a design, and what was found of them when they were judged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from gearcad.geometry import Gear
from gearcad.meshing.bodies.exactness import Deviations
from gearcad.meshing.bodies.measure import Measure, openness, together
from gearcad.meshing.bodies.mesh import ElementMesh
from gearcad.meshing.bodies.other_sides import SideDeviations
from gearcad.meshing.bodies.quality import Quality
from gearcad.meshing.plan import MeshPlan
from gearcad.notice import Notice
from gearcad.reprs import Pictured

__all__ = ["COARSE", "Deck", "Gate", "JudgedMesh", "MeshResult"]

COARSE = 0.5
"""How far (µm) faces may be from the exact gear between their nodes, where nobody asks for larger ones."""


@dataclass(frozen=True)
class Gate:
    """What decides whether a mesh is passed: a value, and its limit, which it must reach (`least`) or not exceed."""

    quantity: str
    value: float
    limit: float
    unit: str
    least: bool = False

    @property
    def passed(self) -> bool:
        """False for what is no number, too."""
        return bool(self.value >= self.limit if self.least else self.value <= self.limit)

    def __str__(self) -> str:
        bound = f"{'at least' if self.least else 'at most'} {self.limit:g}"
        return f"{self.quantity}: {self.value:.3g}, must be {bound}{' ' if self.unit else ''}{self.unit}"

    def to_dict(self) -> dict[str, Any]:
        """As mesh.json has it."""
        bound = "at_least" if self.least else "at_most"
        return {"quantity": self.quantity, "value": self.value, bound: self.limit, "unit": self.unit, "passed": self.passed}


@dataclass(frozen=True)
class JudgedMesh:
    """What was found of the mesh of one gear, in the gear's own coordinates.

    `teeth` are those that are meshed; `others` are the sides that are no flanks and fillets; `unmatched` is by how much (mm)
    nodes of cuts miss each other; `exact` is the area (mm²) of a section or the volume (mm³) of a body that the gear has there.
    """

    gear: Gear
    teeth: int
    nodes: int
    elements: int
    bytes: int
    sides: Mapping[str, tuple[int, Measure]]
    matched: Mapping[str, int]
    quality: Quality
    deviations: Deviations
    others: SideDeviations
    unmatched: float
    exact: float
    gates: tuple[Gate, ...] = ()

    @property
    def passed(self) -> bool:
        """True if every gate is."""
        return all(gate.passed for gate in self.gates)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know of it."""
        off = self.deviations
        if off.between <= COARSE:
            return ()
        instead = "smaller elements" if self.quality.element.shape.order == 2 else "smaller elements, or those of second order,"
        text = f"{off.worst} is {off.between:.2g} µm off the exact one between nodes: {instead} follow it"
        return (Notice("coarse", text),)

    @property
    def _surface(self) -> Measure:
        return together(measure for _, measure in self.sides.values())

    @property
    def whole(self) -> float:
        """Area (mm²) of a section or volume (mm³) of a body, by its sides."""
        return self._surface.enclosed / self.quality.element.shape.dimension

    @property
    def openness(self) -> float:
        """What share of the surface has no name, or two; 0 if every side is there once."""
        return openness(self._surface, self.quality.element.shape.dimension)

    @property
    def mean_offset(self) -> float:
        """How far (µm) the surface is from the exact one on the mean: by how much area or volume differ."""
        return 1000 * abs(self.whole - self.exact) / self._surface.size

    @property
    def greatest_offset(self) -> float:
        """How far (µm) the surface is from the exact one at the most, as far as it is measured between nodes."""
        return max(self.deviations.between, self.others.between)

    def to_dict(self) -> dict[str, Any]:
        """As mesh.json has it."""
        solid = self.quality.element.shape.dimension == 3
        size = "area" if solid else "length"
        return {
            "teeth": self.teeth,
            "nodes": self.nodes,
            "elements": self.elements,
            "bytes": self.bytes,
            "quality": self.quality.to_dict(),
            "deviations": self.deviations.to_dict(),
            "other_sides": self.others.to_dict(),
            "volume" if solid else "area": {"mesh": self.whole, "exact": self.exact},
            "sides": {name: {"faces": count, size: measure.size} for name, (count, measure) in self.sides.items()},
            "matched": dict(self.matched),
            "gates": [gate.to_dict() for gate in self.gates],
            "passed": self.passed,
        }


class Deck(Protocol):
    """Input of another solver that runs as it is."""

    @property
    def expected(self) -> dict[str, Any]:
        """What our own check finds of the same, to be compared with."""

    def write(self, path: Path) -> None:
        """Write it."""


@dataclass(frozen=True)
class MeshResult(Pictured):
    """The meshes of a design by the names of their files - one a gear, or that of the pair in mesh - and what was found of each
    gear's; decks by the names of their files.
    """

    name: str
    plan: MeshPlan
    meshes: Mapping[str, ElementMesh]
    judged: Mapping[str, JudgedMesh]
    decks: Mapping[str, Deck] = field(default_factory=dict)

    def __repr__(self) -> str:
        parts = (
            f"{name}: {len(mesh.cells)} {mesh.element.value}, {len(mesh.points)} nodes" for name, mesh in self.meshes.items()
        )
        return f"<MeshResult of {self.name!r}: {'; '.join(parts)}>"

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before using the meshes."""
        found = (notice.within(name) for name, judged in self.judged.items() for notice in judged.notices)
        return (*self.plan.notices, *found)

    @property
    def mesh(self) -> ElementMesh:
        """The mesh, where there is one only. Raises LookupError where there are two."""
        if len(self.meshes) > 1:
            raise LookupError(f"there are several meshes: {', '.join(self.meshes)}")
        return next(iter(self.meshes.values()))

    @property
    def passed(self) -> bool:
        """True if every gate is."""
        return all(each.passed for each in self.judged.values())

    @property
    def verdict(self) -> str:
        """The gates in a word."""
        return "passed" if self.passed else "failed"
