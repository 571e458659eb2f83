"""MeshResult: the meshes of a design, and what was found of them when they were judged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from gearcad.geometry import Gear
from gearcad.meshing.bodies.measure import Measure
from gearcad.meshing.bodies.mesh import ElementMesh
from gearcad.meshing.bodies.quality import Quality
from gearcad.meshing.plan import MeshPlan
from gearcad.notice import Notice

__all__ = ["Gate", "JudgedMesh", "MeshResult"]


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

    def to_dict(self) -> dict[str, Any]:
        """As mesh.json has it."""
        bound = "at_least" if self.least else "at_most"
        return {"quantity": self.quantity, "value": self.value, bound: self.limit, "unit": self.unit, "passed": self.passed}


@dataclass(frozen=True)
class JudgedMesh:
    """What was found of the mesh of one gear, in the gear's own coordinates.

    `teeth` are those that are meshed; `whole` is the area (mm²) of a section or the volume (mm³) of a body, `exact` what the
    gear has there.
    """

    gear: Gear
    teeth: int
    nodes: int
    elements: int
    bytes: int
    sides: Mapping[str, tuple[int, Measure]]
    matched: Mapping[str, int]
    quality: Quality
    whole: float
    exact: float
    gates: tuple[Gate, ...]

    @property
    def passed(self) -> bool:
        """True if every gate is."""
        return all(gate.passed for gate in self.gates)

    @property
    def surface(self) -> float:
        """Length (mm) or area (mm²) of all sides."""
        return sum(measure.size for _, measure in self.sides.values())

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
            "volume" if solid else "area": {"mesh": self.whole, "exact": self.exact},
            "sides": {name: {"faces": count, size: measure.size} for name, (count, measure) in self.sides.items()},
            "matched": dict(self.matched),
            "gates": [gate.to_dict() for gate in self.gates],
            "passed": self.passed,
        }


@dataclass(frozen=True)
class MeshResult:
    """The meshes of a design by the names of their files - one a gear, or that of the pair in mesh - and what was found of each
    gear's.
    """

    name: str
    plan: MeshPlan
    meshes: Mapping[str, ElementMesh]
    judged: Mapping[str, JudgedMesh]
    notices: tuple[Notice, ...]

    def __repr__(self) -> str:
        parts = (
            f"{name}: {len(mesh.cells)} {mesh.element.value}, {len(mesh.points)} nodes" for name, mesh in self.meshes.items()
        )
        return f"<MeshResult of {self.name!r}: {'; '.join(parts)}>"

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
