"""Tetrahedra of a whole gear: teeth, bore, keyway, hubs and chamfers, as the exact solid has them."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import ParameterError, SolverError, require_number, require_whole
from gearcad.geometry import Gear
from gearcad.geometry.helix import section_turn
from gearcad.meshing.bodies.brep import BrepFace, EdgeLengths, Filled, Stage, fill_brep
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.exact_tetrahedra import quadratic
from gearcad.meshing.bodies.gear_faces import ROOT, GearFace, GearFaces
from gearcad.meshing.bodies.mesh import Cells, ElementMesh, Faces
from gearcad.meshing.bodies.tetrahedron_sizes import TetrahedronGrading, edge_lengths, expected_tetrahedra
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.exact.solid import gear_boundary

__all__ = ["mesh_tetrahedra"]

_MOST = 10_000_000
"""Most tetrahedra that gmsh is asked for: they take some 10 GB, and minutes."""

_NEAR = 0.1
"""Share of the elements asked for by which there may be more or less without another try."""

_TRIES = 3

STANDARD = TetrahedronGrading()


def mesh_tetrahedra(
    gear: Gear,
    *,
    size: float | None = None,
    elements: int | None = None,
    refined_teeth: Collection[int] = (),
    grading: TetrahedronGrading = STANDARD,
    stage: Callable[[Stage], None] = lambda _stage: None,
) -> ElementMesh:
    """Mesh the whole part with tetrahedra of second order: edges of at most `size` (mm) on teeth, or about so many `elements`.

    One of both is given; with `elements` edges are as far off the flanks as comes of that. `refined_teeth` are numbers of teeth
    (taken modulo all of them) with finer ones. Nodes of the surface are on the exact faces, modified flanks among them. Sides
    are "left_flank_3", "right_flank_3", "left_fillet_3", "right_fillet_3" and "tip_3", which has its chamfers, of each tooth;
    "left_root_3" and "right_root_3" if there is a root land, which a jagged line parts in the middle of the space; "end_back"
    at z = 0, "end_front", and what there is of "end_chamfers", "bore", "keyway", "hub", which is round, and its ends "hub_back"
    and "hub_front", of rings "rim" and "bolt_holes". `stage` is told what begins. Quality is for the caller to measure.
    Raises ParameterError for sizes that take too many elements, and SolverError.
    """
    for tooth in refined_teeth:
        require_whole("refined_teeth", tooth, at_least=1 - gear.tooth_count, at_most=gear.tooth_count - 1)
    refined = {tooth % gear.tooth_count for tooth in refined_teeth}
    part = _Part(gear, kernel_solid(gear_boundary(gear)), refined, grading, stage)
    if size is not None and elements is None:
        require_number("size", size, above=0)
        return part.mesh(lambda _expected: size)
    if elements is None or size is not None:
        raise ParameterError("size", size, "must be given in mm, or else a number of elements")
    require_whole("elements", elements, at_least=1, at_most=_MOST)
    return replace(part, grading=replace(grading, deviation=None)).mesh_counted(elements)


_Expected = Callable[[float], float]
"""How many tetrahedra there may be for a size (mm)."""


@dataclass(frozen=True)
class _Part:
    """A gear to be meshed, and what all tries to do so have in common."""

    gear: Gear
    shape: Any
    refined: Collection[int]
    grading: TetrahedronGrading
    stage: Callable[[Stage], None]

    def mesh_counted(self, elements: int) -> ElementMesh:
        """Mesh it with a number of elements, which are expected, made, counted, and made again if they are too many or few."""

        def size(expected: _Expected) -> float:
            least = expected(self.gear.profile.tip_diameter)
            if least > aim:
                raise ParameterError("elements", elements, f"must be at least about {least * elements / aim:.0f} for this gear")
            return _solved(expected, aim, self.gear.profile.tip_diameter)

        aim = float(elements)
        for _ in range(_TRIES):
            mesh = self.mesh(size)
            if abs(len(mesh.cells) / elements - 1) < _NEAR:
                break
            aim *= elements / len(mesh.cells)
        return mesh

    def mesh(self, size: Callable[[_Expected], float]) -> ElementMesh:
        """Mesh it with the size (mm) that is answered when it is known what one makes of it."""
        told: list[GearFace] = []

        def lengths(faces: Sequence[BrepFace]) -> EdgeLengths:
            told.extend(GearFaces(self.gear).told(faces))

            def of(size: float) -> EdgeLengths:
                return edge_lengths(self.gear, size, self.grading, self.refined, told, faces)

            chosen = of(size(lambda each: expected_tetrahedra(of(each), faces)))
            _require_few(chosen, told, faces)
            return chosen

        filled = fill_brep(self.shape, lengths, self.stage)
        points, cells = quadratic(self.gear, told, filled)
        sides = _sides(self.gear, told, filled, cells)
        return ElementMesh(Element.TET10, points, cells, {"gear": slice(0, len(cells))}, sides)


def _solved(expected: _Expected, aim: float, most: float) -> float:
    """The size (mm), at most `most`, for which so many are expected: the smaller it is, the more there are."""
    low, high = 0.0, most
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if expected(middle) > aim else (low, middle)
    return high


def _require_few(lengths: EdgeLengths, told: Sequence[GearFace], faces: Sequence[BrepFace]) -> None:
    """Raise ParameterError for sizes, or faces, so small that there would be too many elements."""
    if (expected := expected_tetrahedra(lengths, faces)) <= _MOST:
        return
    narrow = int(np.argmin([face.width for face in faces]))
    where = f"{told[narrow].name} is {faces[narrow].width:.2g} mm wide"
    permitted = f"makes about {expected:.2g} tetrahedra, which must be at most {_MOST}; the narrowest face, {where}"
    raise ParameterError("size", min(lengths.faces), permitted, "mm")


# ---------------------------------------------------------------------- named sides


def _sides(gear: Gear, faces: Sequence[GearFace], filled: Filled, cells: Cells) -> dict[str, Faces]:
    """The triangles on faces of each name, as sides of tetrahedra."""
    groups: dict[str, list[Cells]] = {}
    for face, triangles in zip(faces, filled.triangles, strict=True):
        parts = _halved(gear, face.tooth, triangles, filled.points) if face.name == ROOT else {face.name: triangles}
        for name, part in parts.items():
            groups.setdefault(name, []).append(part)
    together = {name: np.concatenate(groups[name]) for name in sorted(groups, key=_in_order)}
    at = _found(cells, np.concatenate(list(together.values())))
    ends = np.cumsum([len(part) for part in together.values()])[:-1]
    return {
        name: Faces((where // 4).astype(np.int32), (where % 4).astype(np.int8))
        for name, where in zip(together, np.split(at, ends), strict=True)
    }


def _in_order(name: str) -> tuple[float, str]:
    """Sides of teeth, tooth by tooth, then the others."""
    side, _, tooth = name.rpartition("_")
    return (int(tooth), side) if tooth.isdigit() else (math.inf, name)


def _halved(gear: Gear, tooth: int, triangles: Cells, points: Floats) -> dict[str, Cells]:
    """A root land parted at the middle of the space: what is of this tooth, and of the next. No edges run along there."""
    x, y, z = points[triangles].mean(1).T
    middle = (tooth + 0.5) * 2 * math.pi / gear.tooth_count
    ahead = np.mod(np.arctan2(y, x) - section_turn(gear, z) - middle, 2 * math.pi) < math.pi
    before, after = ("right", "left") if gear.internal else ("left", "right")
    return {
        f"{before}_root_{tooth}": triangles[~ahead],
        f"{after}_root_{(tooth + 1) % gear.tooth_count}": triangles[ahead],
    }


def _found(cells: Cells, triangles: Cells) -> Wholes:
    """Where triangles (k, 3) are among the sides of tetrahedra (m, 10), four of each. Raises SolverError."""
    number = np.full(int(cells.max()) + 1, -1)
    nodes = np.unique(triangles)
    number[nodes] = np.arange(len(nodes))
    sides = np.sort(number[cells[:, [face[:3] for face in Element.TET10.shape.faces]]].reshape(-1, 3), -1)
    outer = np.flatnonzero(sides[:, 0] >= 0)
    keys = _keys(sides[outer], len(nodes))
    order = np.argsort(keys, kind="stable")
    wanted = _keys(np.sort(number[triangles], -1), len(nodes))
    first, last = (np.searchsorted(keys, wanted, side=side, sorter=order) for side in ("left", "right"))
    if np.any(last - first != 1):
        raise SolverError("gmsh left a hole in the surface of the gear")
    found: Wholes = outer[order[first]]
    return found


def _keys(triples: Wholes, count: int) -> Wholes:
    """A number for each triple of nodes, which are as many as `count`: some million, or it would not be one of its own."""
    found: Wholes = (triples[:, 0] * count + triples[:, 1]) * count + triples[:, 2]
    return found
