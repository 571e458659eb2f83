"""A mesh from its plan to its verdict."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import replace

from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.exactness import deviations
from gearcad.meshing.bodies.measure import measure_side
from gearcad.meshing.bodies.mesh import ElementMesh
from gearcad.meshing.bodies.other_sides import matched_distance, side_deviations
from gearcad.meshing.bodies.posed import posed
from gearcad.meshing.bodies.quality import LARGEST_ASPECT, LEAST_SCALED_JACOBIAN, quality, require_good
from gearcad.meshing.gear_plan import GearPlan
from gearcad.meshing.plan import MeshPlan
from gearcad.meshing.result import COARSE, Gate, JudgedMesh, MeshResult
from gearcad.per_gear import PerGear, Role, naming
from gearcad.progress import Agenda, Progress

__all__ = ["run_mesh"]

_MESHING, _JUDGING = "meshing", "judging"

_FOLDED = 1e-6
"""Least scaled Jacobian below which a mesh is none: such an element has no inside."""

_ON = 1e-9
"""How far (mm) nodes may be from the exact sides, and from those they are matched with: that is rounding."""

_ON_SOLID = 1e-6
"""The same of sides of tetrahedra that are no flanks: where these end, nodes are as the edges of the boundary representation
are, which its kernel knows to 1e-7 mm.
"""

_CLOSED = 1e-9
"""What share of the surface may be missing: that is rounding, too."""


def run_mesh(plan: MeshPlan, name: str, progress: Progress | None = None) -> MeshResult:
    """Mesh the gears of a plan, judge what comes out, and put pairs in mesh. Raises GeometryError and SolverError."""
    steps = [f"{step} {role}" for role in plan.gears for step in (_MESHING, _JUDGING)]
    agenda = Agenda(progress, dict.fromkeys(steps, 1.0))
    meshes, judged = dict[str, ElementMesh](), dict[str, JudgedMesh]()
    for role, each in plan.gears.items():
        agenda(f"{_MESHING} {role}")
        with naming(Role(role)) if len(plan.gears) > 1 else nullcontext():
            meshes[role] = each.mesh(agenda.within(f"{_MESHING} {role}"))
        agenda(f"{_JUDGING} {role}")
        judged[role] = _judged(meshes[role], each, plan)
    if plan.pair is not None:
        gears = PerGear(meshes.pop("pinion"), meshes.pop("wheel"))
        meshes["pair"] = posed(plan.pair, gears, plan.options.roll, left=plan.left)
    return MeshResult(name, plan, meshes, judged)


def _judged(mesh: ElementMesh, planned: GearPlan, plan: MeshPlan) -> JudgedMesh:
    """What is found of one gear's mesh. Raises SolverError for one with folded elements."""
    measured = quality(mesh)
    require_good(measured, _FOLDED)
    sides = {name: (len(faces), measure_side(mesh, name)) for name, faces in mesh.sides.items()}
    judged = JudgedMesh(
        gear=planned.gear,
        teeth=planned.count,
        nodes=len(mesh.points),
        elements=len(mesh.cells),
        bytes=mesh.nbytes,
        sides=sides,
        matched={cut: len(pairs) for cut, pairs in mesh.matched.items()},
        quality=measured,
        deviations=deviations(mesh, planned.gear),
        others=side_deviations(mesh, planned.gear, planned.end_radius),
        unmatched=matched_distance(mesh, planned.gear, planned.count),
        exact=planned.exact,
    )
    return replace(judged, gates=tuple(_gates(judged, plan)))


def _gates(judged: JudgedMesh, plan: MeshPlan) -> Iterator[Gate]:
    """What decides. Edges that are straight, or as long as somebody wants, are as far off as comes of that, but area and volume
    then differ by no more than the faces do between their nodes.
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
