"""Triangles of a solid by the CAD kernel, for bodies that have no mesher of their own."""

from __future__ import annotations

from typing import Any

import numpy as np

from gearcad.core.records import Floats, Wholes
from gearcad.solids.facets.tessellation import Facets

_SAME = 1e-9
"""Distance (mm) of points that differ by rounding."""

_TURN = 0.1
"""Largest angle (rad) between the normals of neighbouring triangles."""


def kernel_facets(solid: Any, chord_error: float) -> Facets:
    """Return a solid of the kernel in its triangles, nowhere more than `chord_error` (mm) from it."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopAbs import TopAbs_FACE
    from OCP.TopExp import TopExp_Explorer

    solid = BRepBuilderAPI_Copy(solid).Shape()  # faces that are copies of one another would be meshed as one
    BRepMesh_IncrementalMesh(solid, chord_error, True, _TURN)
    explorer, points, triangles, count = TopExp_Explorer(solid, TopAbs_FACE), list[Floats](), list[Wholes](), 0
    while explorer.More():
        nodes, corners = _of_face(explorer.Current())
        points.append(nodes)
        triangles.append(corners + count)
        count += len(nodes)
        explorer.Next()
    # The kernel meshes face by face: along their common edges the points are there twice, or differ by rounding.
    unique, same = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    first = _first_alike(unique)
    kept, renumbered = np.unique(first, return_inverse=True)
    return Facets(unique[kept], renumbered.reshape(-1)[same.reshape(-1)][np.concatenate(triangles)])


def _first_alike(points: Floats) -> Wholes:
    """Return for each point (n, 3) the number of the first one of those that are the same but for rounding."""
    from scipy.spatial import cKDTree

    first = np.arange(len(points))
    pairs = cKDTree(points).query_pairs(_SAME, output_type="ndarray")
    np.minimum.at(first, pairs[:, 1], pairs[:, 0])
    return first[first]


def _of_face(shape: Any) -> tuple[Floats, Wholes]:
    """Return the points (n, 3) and triangles (m, 3) of a face, counter-clockwise seen from outside."""
    from OCP.BRep import BRep_Tool
    from OCP.TopAbs import TopAbs_REVERSED
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS

    location = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(TopoDS.Face_s(shape), location)
    nodes = [mesh.Node(i).Transformed(location.Transformation()) for i in range(1, mesh.NbNodes() + 1)]
    order = (1, 3, 2) if shape.Orientation() == TopAbs_REVERSED else (1, 2, 3)
    corners = [[mesh.Triangle(i).Value(k) - 1 for k in order] for i in range(1, mesh.NbTriangles() + 1)]
    return np.array([(node.X(), node.Y(), node.Z()) for node in nodes]), np.array(corners)
