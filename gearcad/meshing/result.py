"""MeshResult: the meshes of a design, judged, and its document for mesh.json."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol

from gearcad.core.records import JsonObject, Notice, PerGear, Pictured, naming, texts
from gearcad.core.runtime import Agenda, Progress
from gearcad.geometry import Gear, Rack, RackPair
from gearcad.meshing.bodies.body_mesh import posed
from gearcad.meshing.bodies.element_mesh import ElementMesh
from gearcad.meshing.bodies.exactness import Deviations, SideDeviations
from gearcad.meshing.bodies.quality import (
    LARGEST_ASPECT,
    LEAST_SCALED_JACOBIAN,
    Measure,
    Quality,
    measure_side,
    openness,
    quality,
    require_good,
    together,
)
from gearcad.meshing.bodies.rack_mesh import rack_posed
from gearcad.meshing.fem import Element
from gearcad.meshing.plan import GearPlan, MeshPlan
from gearcad.version import __version__

COARSE = 0.5
"""Largest distance (µm) of faces from the exact gear between their nodes, unless larger elements are asked for."""


@dataclass(frozen=True)
class Gate:
    """A value that decides whether a mesh is passed, with the limit that it must reach (`least`) or not exceed."""

    quantity: str
    value: float
    limit: float
    unit: str
    least: bool = False

    @property
    def passed(self) -> bool:
        """True if the value keeps its limit; False for NaN."""
        return bool(self.value >= self.limit if self.least else self.value <= self.limit)

    def __str__(self) -> str:
        bound = f"{'at least' if self.least else 'at most'} {self.limit:g}"
        return f"{self.quantity}: {self.value:.3g}, must be {bound}{' ' if self.unit else ''}{self.unit}"

    def to_dict(self) -> JsonObject:
        """Return the entry of mesh.json."""
        bound = "at_least" if self.least else "at_most"
        return {"quantity": self.quantity, "value": self.value, bound: self.limit, "unit": self.unit, "passed": self.passed}


@dataclass(frozen=True)
class JudgedMesh:
    """Judgement of the mesh of one gear, in the gear's own coordinates.

    `teeth` are those that are meshed, of `every_tooth`; `others` are the sides that are no flanks and fillets; `unmatched` is
    by how much (mm) nodes of cuts miss each other; `exact` is the area (mm²) of a section, or the volume (mm³) of a body, that
    the gear has there.
    """

    gear: Gear | Rack
    teeth: int
    every_tooth: int
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
        """Notice that elements are too coarse, if flanks or fillets deviate too much between nodes."""
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
        """Share of the surface that has no name, or two; 0 if every side is there once."""
        return openness(self._surface, self.quality.element.shape.dimension)

    @property
    def mean_offset(self) -> float:
        """Mean distance (µm) of the surface from the exact one: the difference in area or volume over the surface's size."""
        return 1000 * abs(self.whole - self.exact) / self._surface.size

    @property
    def greatest_offset(self) -> float:
        """Greatest distance (µm) of the surface from the exact one, as far as measured between nodes."""
        return max(self.deviations.between, self.others.between)

    def to_dict(self) -> JsonObject:
        """Return the entry of mesh.json."""
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
        """Results of gearcad's own check for the same case, to compare with."""

    def write(self, path: Path) -> None:
        """Write the deck to `path`."""


@dataclass(frozen=True)
class MeshResult(Pictured):
    """The meshes of a design with their measured quality, and its decks.

    Meshes and decks go by the names of their files. A mesh is of one gear, or of the pair in mesh.
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
        """Notices to read before the meshes are used."""
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
        """The verdict of all gates in one word."""
        return "passed" if self.passed else "failed"


def mesh_document(result: MeshResult, files: Iterable[str]) -> JsonObject:
    """Return the lengths in mm, areas in mm², volumes in mm³, deviations in µm, angles in degrees, memory in bytes.

    "summary" is of all meshes: sums of counts, the worst of all else. "meshes" are by gear, also where a file has both.
    """
    plan = result.plan
    of_pair = {"roll_angle": plan.options.roll} if plan.pair is not None else {}
    return {
        "kind": "mesh",
        "name": result.name,
        "gearcad": __version__,
        "what": plan.extent.what.value,
        "model": "3d" if plan.solid else "2d",
        "element": plan.element.value,
        **of_pair,
        "passed": result.passed,
        "summary": _summary(result),
        "meshes": {name: judged.to_dict() for name, judged in result.judged.items()},
        **({"decks": {name: deck.expected for name, deck in result.decks.items()}} if result.decks else {}),
        "files": list(files),
        "notices": [notice.to_dict() for notice in result.notices],
        "warnings": list(texts(result.notices)),
    }


def _summary(result: MeshResult) -> dict[str, Any]:
    every = result.judged.values()
    measured = [judged.quality for judged in every]
    return {
        "nodes": sum(judged.nodes for judged in every),
        "elements": sum(judged.elements for judged in every),
        "bytes": sum(judged.bytes for judged in every),
        "least_scaled_jacobian": min(each.least_jacobian for each in measured),
        "largest_aspect": max(each.largest_aspect for each in measured),
        "least_angle": min(each.least_angle for each in measured),
        "node_deviation": max(judged.deviations.nodes for judged in every),
        "face_deviation": max(judged.deviations.between for judged in every),
        "mean_offset": max(judged.mean_offset for judged in every),
    }


_MESHING, _JUDGING = "meshing", "judging"

_FOLDED = 1e-6
"""Least scaled Jacobian of a valid mesh: an element below it has no inside."""

_ON = 1e-9
"""Largest distance (mm) of nodes from the exact sides, and from their matched nodes, that counts as rounding."""

_ON_SOLID = 1e-6
"""The same of sides of tetrahedra that are no flanks: where these end, nodes are as the edges of the boundary representation
are, which its kernel knows to 1e-7 mm.
"""

_CLOSED = 1e-9
"""Largest share of the surface that may be missing: rounding, too."""


def run_mesh(plan: MeshPlan, name: str, progress: Progress | None = None) -> MeshResult:
    """Mesh the gears of a plan, judge what comes out, and put pairs in mesh. Raises GeometryError and SolverError."""
    steps = [f"{step} {role}" for role in plan.gears for step in (_MESHING, _JUDGING)]
    agenda = Agenda(progress, dict.fromkeys(steps, 1.0))
    meshes, judged = dict[str, ElementMesh](), dict[str, JudgedMesh]()
    for role, each in plan.gears.items():
        agenda(f"{_MESHING} {role}")
        with naming(role) if len(plan.gears) > 1 else nullcontext():
            meshes[role] = each.mesh(agenda.within(f"{_MESHING} {role}"))
        agenda(f"{_JUDGING} {role}")
        judged[role] = _judged(meshes[role], each, plan)
    if isinstance(plan.pair, RackPair):
        sections = PerGear(meshes.pop("pinion"), meshes.pop("rack"))
        meshes["pair"] = rack_posed(plan.pair, sections, plan.options.roll, left=plan.left)
    elif plan.pair is not None:
        gears = PerGear(meshes.pop("pinion"), meshes.pop("wheel"))
        meshes["pair"] = posed(plan.pair, gears, plan.options.roll, left=plan.left)
    return MeshResult(name, plan, meshes, judged)


def _judged(mesh: ElementMesh, planned: GearPlan, plan: MeshPlan) -> JudgedMesh:
    """Return one gear's mesh with its quality, deviations and gates. Raises SolverError for a mesh with folded elements."""
    measured = quality(mesh)
    require_good(measured, _FOLDED)
    sides = {name: (len(faces), measure_side(mesh, name)) for name, faces in mesh.sides.items()}
    offsets = planned.offsets(mesh)
    judged = JudgedMesh(
        gear=planned.gear,
        teeth=planned.count,
        every_tooth=planned.every_tooth,
        nodes=len(mesh.points),
        elements=len(mesh.cells),
        bytes=mesh.nbytes,
        sides=sides,
        matched={cut: len(pairs) for cut, pairs in mesh.matched.items()},
        quality=measured,
        deviations=offsets.teeth,
        others=offsets.others,
        unmatched=offsets.unmatched,
        exact=planned.exact,
    )
    return replace(judged, gates=tuple(_gates(judged, plan)))


def _gates(judged: JudgedMesh, plan: MeshPlan) -> Iterator[Gate]:
    """Yield the gates that decide whether a mesh is passed.

    The deviation between nodes has no gate for straight edges, for tet10, or if a size or a number of elements is given.
    Without a gate of its own, the mean distance of the surface must not exceed the greatest between nodes.
    """
    element, off = plan.element, judged.deviations
    yield Gate("least scaled Jacobian", judged.quality.least_jacobian, LEAST_SCALED_JACOBIAN[element], "", least=True)
    yield Gate("longest over shortest edge", judged.quality.largest_aspect, LARGEST_ASPECT, "")
    yield Gate("nodes from the exact flanks and fillets", off.nodes, _ON, "mm")
    yield Gate("nodes from the other exact sides", judged.others.nodes, _ON_SOLID if element is Element.TET10 else _ON, "mm")
    if judged.matched:
        yield Gate("nodes of matched cuts from each other", judged.unmatched, _ON, "mm")
    yield Gate("share of the surface that is missing or named twice", judged.openness, _CLOSED, "")
    if element.shape.order == 2 and plan.usual and element is not Element.TET10:
        yield Gate("flanks and fillets between nodes from the exact ones", off.between, COARSE, "µm")
    if element.shape.order == 2 and plan.usual:
        yield Gate("surface from the exact one on the mean", judged.mean_offset, COARSE, "µm")
    else:
        yield Gate(
            "surface on the mean, which is at most as far off as between nodes",
            judged.mean_offset,
            judged.greatest_offset,
            "µm",
        )
