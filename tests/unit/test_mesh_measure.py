"""Lengths, areas and volumes of meshes against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gearcad.core.records import Floats
from gearcad.meshing import Element, ElementMesh, Faces
from gearcad.meshing.bodies.quality import measure_side, measure_whole

ROUNDING = 1e-13


def unit_element(element: Element, bend: Floats) -> ElementMesh:
    """One element of the unit square, cube or tetrahedron, its nodes moved by an affine map."""
    corners = {
        Element.TRI6: [[0, 0], [1, 0], [0, 1]],
        Element.QUAD8: [[0, 0], [1, 0], [1, 1], [0, 1]],
        Element.TET10: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    }.get(element, [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    places = np.zeros((len(corners), 3))
    places[:, : len(corners[0])] = corners
    if element.shape.order == 2:
        places = np.concatenate([places, [places[list(edge)].mean(axis=0) for edge in element.shape.edges]])
    count = len(element.shape.faces)
    sides = {f"side_{k}": Faces(np.zeros(1, np.int32), np.array([k], np.int8)) for k in range(count)}
    return ElementMesh(
        element, places @ bend.T + 3.0, np.arange(len(places), dtype=np.int32)[None], {"gear": slice(0, 1)}, sides
    )


@pytest.mark.parametrize("element", Element)
def test_an_element_is_as_large_as_its_map_makes_it(element: Element) -> None:
    bend = np.array([[2.0, 0.5, 0.0], [0.25, 1.5, 0.0], [0.0, 0.0, 3.0]])
    whole = {Element.TRI6: 1 / 2, Element.TET10: 1 / 6}.get(element, 1.0)
    scale = np.linalg.det(bend) if element.shape.dimension == 3 else np.linalg.det(bend[:2, :2])
    mesh = unit_element(element, bend)
    if element.shape.dimension == 2:
        mesh.points[:, 2] = 0.0
    assert measure_whole(mesh) == pytest.approx(whole * scale, rel=ROUNDING)
    for name in mesh.sides:
        corners = mesh.points[mesh.face_cells(name)[0]]
        if element.shape.dimension == 2:
            expected = math.dist(corners[0], corners[1])
        else:
            half = 0.5 * np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
            expected = half if element is Element.TET10 else 2 * half
        assert measure_side(mesh, name).size == pytest.approx(expected, rel=ROUNDING)
