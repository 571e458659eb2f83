"""Judge of mesh files: read by meshio and gmsh, counted, measured, and their nodes held against the exact surface."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gearcad.core.records import Floats
from gearcad.geometry.bore_teeth import with_round_bore
from gearcad.geometry.gear_data import section_turn
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel
from gearcad.verification.exact_parts import ExactPart, toothed_size

_ON_SURFACE = 1e-6
"""Distance (mm) that nodes of flanks and fillets may be off the exact ones: rounding, and the digits of files."""

_LEAST_BETWEEN = 0.01
"""Distance (µm) that surfaces are permitted to be off the exact one on the mean where they are said to be nearer."""

_UNREADABLE = "Element type not available"
"""Beginning of what meshio says of an element that it does not know in a format."""

_TOOTHED = ("flank", "fillet")
"""Sides whose nodes stand on the exact flanks and fillets."""


@dataclass(frozen=True)
class StatedMesh:
    """What is said of the mesh of one gear: the entry of mesh.json, whether it is of a body, and the least scaled Jacobian.

    `whole` is true of the whole part with its hub and keyway.
    """

    part: ExactPart
    document: Mapping[str, Any]
    solid: bool
    least_jacobian: float
    whole: bool = False

    @property
    def sides(self) -> set[str]:
        """Names of all sides."""
        return set(self.document["sides"])


def judge_mesh(folder: Path, name: str, stated: StatedMesh) -> Iterator[Claim]:
    """Judge the files NAME.vtu, NAME.inp and NAME.msh of the mesh of one gear, in the gear's own coordinates."""
    for path, names in ((folder / f"{name}.vtu", _sides_of_vtu), (folder / f"{name}.inp", _sides_of_inp)):
        judge = Judge(ClaimSubject.MESH, VerificationLevel.FULL, path.name, "meshio")
        try:
            yield from _by_meshio(path, names, judge, stated)
        except Exception as error:  # a reader may raise anything for a broken file
            said = f"{type(error).__name__}: {error}"
            if str(error).startswith(_UNREADABLE):
                yield judge.not_judged("elements, nodes, sides", f"meshio does not know the element: {error}")
            else:
                yield judge.holds("is read", False, place=said)
    yield from _by_gmsh(folder / f"{name}.msh", stated)


Sides = Mapping[str, Floats]
"""Numbers of the nodes of sides, by the names of these."""


def _sides_of_vtu(mesh: Any) -> dict[str, Any]:
    """Sides of a .vtu: fields of the nodes with the number of the tooth, -1 for none, or with 1 where there are no teeth."""
    found: dict[str, Any] = {}
    for name, values in mesh.point_data.items():
        if values.dtype.kind == "u":
            found[name] = np.flatnonzero(values)
        else:
            found |= {f"{name}_{tooth}": np.flatnonzero(values == tooth) for tooth in np.unique(values[values >= 0]).tolist()}
    return found


def _sides_of_inp(mesh: Any) -> dict[str, Any]:
    """Sides of a .inp: sets of nodes."""
    return dict(mesh.point_sets)


def _by_meshio(path: Path, sides_of: Callable[[Any], dict[str, Any]], judge: Judge, stated: StatedMesh) -> Iterator[Claim]:
    """Judge what meshio reads: counts, names of sides, and nodes of flanks and fillets on the exact surface."""
    import meshio

    reader = meshio.vtu if path.suffix == ".vtu" else meshio.abaqus
    mesh = reader.read(path)
    document = stated.document
    yield judge.equal("nodes", document["nodes"], len(mesh.points))
    yield judge.equal("elements", document["elements"], sum(len(cells.data) for cells in mesh.cells))
    sides = sides_of(mesh)
    missing = sorted(stated.sides - {name for name, nodes in sides.items() if len(nodes)})
    yield judge.equal("sides", len(stated.sides), len(stated.sides) - len(missing), place=f"without {', '.join(missing[:5])}")
    toothed = [np.asarray(nodes, int) for name, nodes in sides.items() if any(word in name for word in _TOOTHED)]
    nodes = np.unique(np.concatenate(toothed)) if toothed else np.empty(0, int)
    if not len(nodes):
        yield judge.holds("nodes of flanks and fillets are on the exact surface", False, place="no node is on one")
        return
    points = np.asarray(mesh.points, float)[nodes]
    off = stated.part.surface.tooth_distances(_in_space(points, stated))
    worst = int(off.argmax())
    place = f"node {nodes[worst] + 1} at {', '.join(f'{value:.4g}' for value in points[worst])} mm"
    quantity = "distance of nodes of flanks and fillets from the exact surface"
    yield judge.below(quantity, 1e3 * float(off.max()), 1e3 * _ON_SURFACE, "µm", place=place)


def _in_space(points: Floats, stated: StatedMesh) -> Floats:
    """Return points (n, 3) of a body as they are, and of a section on mid face width, where it is turned by the twist."""
    gear = stated.part.gear
    if stated.solid or gear is None:
        return points
    z = gear.half_width / 2
    turn = float(section_turn(gear, np.array([z]))[0])
    cosine, sine = math.cos(turn), math.sin(turn)
    turned = points[:, :2] @ np.array([[cosine, sine], [-sine, cosine]])
    return np.column_stack([turned, np.full(len(points), z)])


def _by_gmsh(path: Path, stated: StatedMesh) -> Iterator[Claim]:
    """Judge what gmsh reads: counts, groups, Jacobians, and the area or volume against the exact one."""
    judge = Judge(ClaimSubject.MESH, VerificationLevel.FULL, path.name, "gmsh")
    try:
        import gmsh
    except (ImportError, OSError) as error:
        yield judge.not_judged("elements, sides, quality, volume", f"gmsh cannot be loaded: {error}")
        return
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        claims = list(_in_gmsh(gmsh, judge, stated))
    except Exception as error:  # gmsh raises plain exceptions
        claims = [judge.holds("is read", False, place=f"{type(error).__name__}: {error}")]
    finally:
        gmsh.finalize()
    yield from claims


def _in_gmsh(gmsh: Any, judge: Judge, stated: StatedMesh) -> Iterator[Claim]:
    """Judge the model that gmsh has open."""
    dimension, document = 3 if stated.solid else 2, stated.document
    of_model = gmsh.model.mesh
    yield judge.equal("nodes", document["nodes"], len(of_model.getNodes()[0]))
    _, tags, _ = of_model.getElements(dimension)
    elements = np.concatenate(tags) if len(tags) else np.empty(0, np.uint64)
    yield judge.equal("elements", document["elements"], len(elements))
    faces = _groups(gmsh, dimension - 1)
    wrong = sorted(name for name, each in document["sides"].items() if faces.get(name) != each["faces"])
    place = ", ".join(f"{name} has {faces.get(name, 0)} faces" for name in wrong[:5])
    yield judge.equal("sides with all their faces", len(stated.sides), len(stated.sides) - len(wrong), place=place)
    if not len(elements):
        return
    jacobians = of_model.getElementQualities(elements, "minSJ")
    least = float(jacobians.min())
    place = f"{least:.3g}, of element {elements[int(jacobians.argmin())]}"
    yield judge.holds(
        f"least scaled Jacobian is at least {stated.least_jacobian:g}", least >= stated.least_jacobian, place=place
    )
    yield _sized(judge, float(of_model.getElementQualities(elements, "volume").sum()), stated)


def _groups(gmsh: Any, dimension: int) -> dict[str, int]:
    """Number of faces in each group of this dimension, by its name."""
    found = {}
    for group in gmsh.model.getPhysicalGroups(dimension):
        counts = [
            sum(map(len, gmsh.model.mesh.getElements(dimension, entity)[1]))
            for entity in gmsh.model.getEntitiesForPhysicalGroup(*group)
        ]
        found[gmsh.model.getPhysicalName(*group)] = sum(counts)
    return found


def _sized(judge: Judge, size: float, stated: StatedMesh) -> Claim:
    """Judge the area or volume: off by no more than the surface times the distance (µm) that it is said to be off at most.

    Between nodes the elements of second order are parabolas, those of first order chords.
    """
    part, document = stated.part, stated.document
    assert part.gear is not None  # racks have no meshes
    if stated.whole:
        exact = ExactPart(with_round_bore(part.gear)).moments.volume if part.bore is not None else part.moments.volume
    else:
        end = document["end_radius"]
        exact = toothed_size(part.gear, document["teeth"], end, solid=stated.solid)
    surface = sum(each["area" if stated.solid else "length"] for each in document["sides"].values())
    between = max(document[name]["between_nodes"] for name in ("deviations", "other_sides"))
    permitted = surface * max(between, _LEAST_BETWEEN) / 1000 / exact
    return judge.near("volume" if stated.solid else "area", size, exact, permitted, relative=True)
