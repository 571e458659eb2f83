"""A carrier of planets in triangles."""

from __future__ import annotations

from typing import Any

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.solids.carrier_plan import CarrierPlan
from gearcad.solids.exact.carrier import carrier_boundary
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.facets.tessellation import Facets

__all__ = ["carrier_facets"]

_TURN = 0.1
"""By how much (rad) the normals of neighbouring triangles may differ."""


def carrier_facets(plan: CarrierPlan, chord_error: float) -> Facets:
    """The solid in triangles of the kernel, nowhere more than `chord_error` (mm) from it."""
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopAbs import TopAbs_FACE
    from OCP.TopExp import TopExp_Explorer

    solid = kernel_solid(carrier_boundary(plan))
    BRepMesh_IncrementalMesh(solid, chord_error, True, _TURN)
    explorer, points, triangles, count = TopExp_Explorer(solid, TopAbs_FACE), list[Floats](), list[Wholes](), 0
    while explorer.More():
        nodes, corners = _of_face(explorer.Current())
        points.append(nodes)
        triangles.append(corners + count)
        count += len(nodes)
        explorer.Next()
    # The kernel meshes face by face: along their common edges the points are there twice, to the last bit.
    unique, same = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    return Facets(unique, same.reshape(-1)[np.concatenate(triangles)])


def _of_face(shape: Any) -> tuple[Floats, Wholes]:
    """Points (n, 3) and triangles (m, 3) of a face, counter-clockwise seen from outside."""
    from OCP.BRep import BRep_Tool
    from OCP.TopAbs import TopAbs_REVERSED
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS

    mesh = BRep_Tool.Triangulation_s(TopoDS.Face_s(shape), TopLoc_Location())
    nodes = [mesh.Node(i) for i in range(1, mesh.NbNodes() + 1)]
    order = (1, 3, 2) if shape.Orientation() == TopAbs_REVERSED else (1, 2, 3)
    corners = [[mesh.Triangle(i).Value(k) - 1 for k in order] for i in range(1, mesh.NbTriangles() + 1)]
    return np.array([(node.X(), node.Y(), node.Z()) for node in nodes]), np.array(corners)
