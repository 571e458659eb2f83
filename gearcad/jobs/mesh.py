"""Mesh: finite elements of a design's gears with named sides, as files of other programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Unpack

from gearcad.designs import Design, DesignKind, GearedDesign, Inputs, PairDesign
from gearcad.geometry import Gear, GearPair
from gearcad.jobs.contact_zones import contact_zones
from gearcad.jobs.job import Job, Writer
from gearcad.jobs.mesh_decks import make_decks
from gearcad.jobs.subject import as_design
from gearcad.load import Load
from gearcad.material import Material, Materials
from gearcad.meshing.bodies.contact_zone import ContactZone
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.document import mesh_document
from gearcad.meshing.expected import expected_mesh
from gearcad.meshing.files.formats import SUFFIXES
from gearcad.meshing.options import MeshOptions
from gearcad.meshing.plan import MeshPlan, plan_mesh
from gearcad.meshing.result import MeshResult
from gearcad.meshing.room import require_room
from gearcad.meshing.run import run_mesh
from gearcad.notice import Notice
from gearcad.per_gear import PerGear
from gearcad.progress import Expected, Progress

__all__ = ["Mesh", "mesh"]


@dataclass(frozen=True, kw_only=True)
class Mesh(Job[GearedDesign, MeshResult]):
    """Meshes of a design in the formats of its options: `gear.vtu`, or `pinion.vtu` and `wheel.vtu`, or `pair.vtu` in mesh.

    What is `given` of the options by their names wins over those of the design's own [mesh]. Raises ParameterError.
    """

    verb = "mesh"
    accepts = (DesignKind.GEAR, DesignKind.PAIR)
    why = "there are no teeth"
    solves = False
    writes_long = True

    given: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        MeshOptions(**self.given)

    def _run(self, design: GearedDesign, progress: Progress | None) -> MeshResult:
        plan = self._plan(design)
        require_room(plan)
        decks = make_decks(design, plan, progress) if isinstance(design, PairDesign) else {}
        return replace(run_mesh(plan, design.name, progress), decks=decks)

    def _plan(self, design: GearedDesign) -> MeshPlan:
        options = replace(design.mesh or MeshOptions(), **self.given)
        for kind in options.formats:
            kind.require()
        pair = design.assembly
        if pair is not None and design.mounting is not None:
            pair = design.mounting.mounted(pair)
        plan = plan_mesh(options, design.gears, pair)
        if plan.pair is not None and design.load is not None and isinstance(design, PairDesign):
            plan = _pressed(plan, plan.pair, design.material or Material(), design.load)
        return plan.counted()

    def _expected(self, design: GearedDesign) -> Expected | None:
        plan = self._plan(design)
        require_room(plan)
        return expected_mesh(plan)

    def document(self, result: MeshResult) -> dict[str, Any]:
        """What mesh.json holds."""
        beside = [f"{name}{end}" for name in result.meshes for kind in result.plan.options.formats for end in kind.entry.beside]
        return mesh_document(result, [*self.files(result), *beside])

    def notices(self, result: MeshResult) -> Sequence[Notice]:
        return result.notices

    def files(self, result: MeshResult) -> dict[str, Writer]:
        """Every mesh in every format, then the document."""
        found: dict[str, Writer] = {}
        for name, each in result.meshes.items():
            found |= {f"{name}.{kind.value}": partial(kind.entry.write, each) for kind in result.plan.options.formats}
        found |= {name: deck.write for name, deck in result.decks.items()}
        return {**found, "mesh.json": partial(self.write_document, result)}

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        """All files together: they are of one mesh."""
        return {self.verb: dict(self.given)}

    def part_of(self, file: str) -> str:
        """Every file of a format is its own."""
        return self.verb if file == "mesh.json" or file.rpartition(".")[2] in SUFFIXES else ""

    def figures(self, document: dict[str, Any]) -> dict[str, Any]:
        """The verdict and the summary."""
        return {"passed": document["passed"], **document["summary"], "warnings": document["warnings"]}


def _pressed(plan: MeshPlan, pair: GearPair, material: Materials, load: Load) -> MeshPlan:
    """The plan of a pair in mesh with the flanks that its load presses, and where these are meshed finely.

    In helical bodies the lines of contact run across whole flanks, which are as fine as their edges are everywhere.
    """
    across = plan.solid and pair.pinion.helix_angle and plan.element is not Element.TET10
    zones = PerGear[Mapping[int, ContactZone]]({}, {}) if across else contact_zones(pair, material, load, plan.options.roll)
    return plan.pressed(zones, left=load.torque >= 0)


def mesh(
    subject: Design | GearPair | Gear,
    load: Load | None = None,
    *,
    progress: Progress | None = None,
    what: str | None = None,
    model: str | None = None,
    element: str | None = None,
    gear: str | None = None,
    size: float | None = None,
    elements: int | None = None,
    fillet_elements: int | None = None,
    roll: float | None = None,
    **inputs: Unpack[Inputs],
) -> MeshResult:
    """Mesh a gear or a pair with finite elements whose sides have names, nodes exactly on the flanks.

    `what` is "sector", "teeth:5", "ring", "pair", "pair:5" or "part"; `model` "2d" or "3d"; `element` "quad8", "tri6", "hex20",
    "hex8" or "tet10"; `gear` "pinion", "wheel" or "both"; `size` (mm) the edge on the flanks, or
    `elements` how many there are; `fillet_elements` how many over 30 degrees of a fillet; `roll` (deg, of the pinion) where a
    pair stands in mesh. What is None is as the design's [mesh] has it, or the MeshOptions given as `mesh`.

    >>> from gearcad import Body, Gear
    >>> result = mesh(Gear(teeth=20, normal_module=2, face_width=10, body=Body(bore=12)), what="sector")
    >>> result.passed, result.mesh.element
    (True, <Element.QUAD8: 'quad8'>)
    >>> result.mesh.points.shape[1], result.mesh.cells.shape[1], sorted(result.mesh.sides)[:3]
    (3, 8, ['bore', 'cut_ahead', 'cut_behind'])

    Raises ParameterError and GeometryError for what cannot be meshed, SolverError where elements come out folded.
    """
    options = {
        "what": what,
        "model": model,
        "element": element,
        "gear": gear,
        "size": size,
        "elements": elements,
        "fillet_elements": fillet_elements,
        "roll": roll,
    }
    job = Mesh(given={name: value for name, value in options.items() if value is not None})
    return job.run(as_design(subject, load, **inputs), progress)
