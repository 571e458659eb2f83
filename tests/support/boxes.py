"""Boxes of every kind of element, whose volume and whose sides anybody knows."""

from dataclasses import replace
from itertools import permutations

import numpy as np

from gearcad.meshing import Element, ElementMesh, Faces
from gearcad.meshing.bodies.element_mesh import joined

SIZE = np.array([3.0, 2.0, 1.0])
"""Lengths of the box (mm) along x, y, z; a plane one has no z."""

DIVISIONS = (3, 2, 2)
"""Blocks along x, y, z; a triangle is half a block, six tetrahedra are one."""

AREAS = {"bore": 2.0, "left_flank_0": 2.0, "cut_behind": 3.0, "cut_ahead": 3.0, "end_back": 6.0, "end_front": 6.0}
"""mm²; of a plane box 1 mm thick, which has no ends."""

_PLANES = {
    "bore": (0, 0),
    "left_flank_0": (0, 1),
    "cut_behind": (1, 0),
    "cut_ahead": (1, 1),
    "end_back": (2, 0),
    "end_front": (2, 1),
}
"""Which coordinate a side holds, at the box's beginning or end."""


def outward(name: str) -> np.ndarray:
    """The normal (3,) of a side of the box."""
    axis, end = _PLANES[name]
    normal: np.ndarray = (2 * end - 1) * np.eye(3)[axis]
    return normal


def box(element: Element, divisions: tuple[int, int, int] = DIVISIONS) -> ElementMesh:
    """The box with its sides, as one part."""
    counts = np.array(divisions[: element.shape.dimension])
    grid = np.stack(np.meshgrid(*(np.arange(n + 1) for n in counts), indexing="ij"), -1).reshape(-1, len(counts))
    points = np.zeros((len(grid), 3))
    points[:, : len(counts)] = grid * SIZE[: len(counts)] / counts
    cells = _cells(element, counts)
    if element.shape.order == 2:
        edges = np.sort(cells[:, element.shape.edges], axis=-1)
        ends, number = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
        cells = np.concatenate([cells, len(points) + number.reshape(edges.shape[:2])], axis=1)
        points = np.concatenate([points, points[ends].mean(axis=1)])
    mesh = ElementMesh(element, points, cells.astype(np.int32), {"gear": slice(0, len(cells))}, {})
    sides = {name: faces for name in _PLANES if len(faces := _side(mesh, name))}
    mesh = ElementMesh(element, points, mesh.cells, mesh.parts, sides)
    ends = [mesh.nodes(name) for name in ("cut_behind", "cut_ahead")]
    pairs = np.stack([nodes[np.lexsort(points[nodes].T[[0, 2]])] for nodes in ends], axis=1).astype(np.int64)
    return ElementMesh(element, points, mesh.cells, mesh.parts, sides, {"cut": pairs})


def two_boxes(element: Element) -> ElementMesh:
    """Pinion and wheel, 5 mm apart along x."""
    first = box(element)
    return joined({"pinion": first, "wheel": replace(first, points=first.points + np.array([5.0, 0.0, 0.0]))})


def _cells(element: Element, counts: np.ndarray) -> np.ndarray:
    """Vertices (m, k) of the elements on the grid's points."""
    steps = np.append(np.cumprod((counts + 1)[:0:-1])[::-1], 1)
    corner = np.stack(np.meshgrid(*(np.arange(n) for n in counts), indexing="ij"), -1).reshape(-1, len(counts)) @ steps
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    if element is Element.TRI6:
        offsets = [square[[0, 1, 2]], square[[0, 2, 3]]]
    elif element is Element.QUAD8:
        offsets = [square]
    elif element is Element.TET10:
        offsets = [_path(order) for order in permutations(range(3))]
    else:
        offsets = [np.concatenate([np.c_[square, np.zeros(4, int)], np.c_[square, np.ones(4, int)]])]
    return np.concatenate([corner[:, None] + offset @ steps for offset in offsets])


def _path(order: tuple[int, ...]) -> np.ndarray:
    """A tetrahedron (4, 3) along three edges of a cube, from corner to corner, with positive volume."""
    path = np.concatenate([np.zeros((1, 3), int), np.cumsum(np.eye(3, dtype=int)[list(order)], axis=0)])
    return path if np.linalg.det(path[1:]) > 0 else path[[0, 2, 1, 3]]


def _side(mesh: ElementMesh, name: str) -> Faces:
    axis, end = _PLANES[name]
    centres = mesh.points[mesh.cells[:, np.array(mesh.element.shape.faces)]].mean(axis=2)
    on = np.abs(centres[..., axis] - end * SIZE[axis]) < 1e-9
    if axis >= mesh.element.shape.dimension:
        on[:] = False
    elements, sides = np.nonzero(on)
    return Faces(elements.astype(np.int32), sides.astype(np.int8))
