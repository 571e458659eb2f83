"""A tooth sector of quadratic hexahedra: a section of quadrangles swept along the helix, layer by layer."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.geometry import Gear
from gearcad.geometry.helix import twist
from gearcad.meshing.section.outline import Side
from gearcad.meshing.section.quads import QuadMesh

__all__ = ["Stack", "SweptMesh", "layer_planes", "sweep"]


_CROWDING = 0.5
"""How much thinner than the mean the layers at the ends are, and thicker those in the middle."""


def layer_planes(width: float, layers: int) -> Floats:
    """Heights (layers + 1,) in mm of the planes between layers, closer together towards both ends."""
    share = np.linspace(0.0, 1.0, layers + 1)
    planes: Floats = width * (share - _CROWDING * np.sin(2 * np.pi * share) / (2 * np.pi))
    return planes


@dataclass(frozen=True)
class Stack:
    """How nodes of a swept section, its vertices first, are numbered: `nodes` of each plane in turn, then the vertices, `half`
    of them, half-way up each layer; elements of first order have none there.
    """

    nodes: int
    half: int
    layers: int

    @property
    def total(self) -> int:
        """Nodes in all."""
        return self.middle(self.layers)

    def plane(self, k: int) -> int:
        """Number of the first node of plane k."""
        return k * self.nodes

    def middle(self, k: int) -> int:
        """Number of the first node half-way up layer k."""
        return (self.layers + 1) * self.nodes + k * self.half

    def elements(self, quads: Wholes, layer: int) -> Wholes:
        """Hexahedra (m, 20) over section quadrangles (m, 8): nodes of the lower plane, of the upper one, and half-way up.

        Over four vertices without nodes half-way, those of first order (m, 8).
        """
        above = [quads[:, :4] + self.middle(layer)] if self.half else []
        return np.concatenate([quads + self.plane(layer), quads + self.plane(layer + 1), *above], axis=1)

    def over(self, nodes: Wholes) -> Wholes:
        """All nodes above section nodes: plane by plane, then half-way up layer by layer."""
        half = nodes[nodes < self.half]
        flat = [nodes + self.plane(k) for k in range(self.layers + 1)]
        return np.concatenate([*flat, *(half + self.middle(k) for k in range(self.layers))])


@dataclass(frozen=True)
class SweptMesh:
    """The section turned by `rate` (rad/mm) along z: nodes of each plane in turn, then the vertices half-way up each layer.

    Vectors at a node are seen from axes that turn with the section, so equal layers have equal matrices.
    """

    section: QuadMesh
    planes: Floats
    rate: float

    @property
    def layers(self) -> int:
        """Layers of hexahedra."""
        return len(self.planes) - 1

    @property
    def _stack(self) -> Stack:
        return Stack(len(self.section.points), self.section.vertices, self.layers)

    @property
    def nodes(self) -> int:
        """Nodes in all."""
        return self._stack.total

    def plane(self, k: int) -> int:
        """Number of the first node of plane k."""
        return self._stack.plane(k)

    def elements(self, quads: Wholes, layer: int) -> Wholes:
        """Hexahedra (m, 20) over section quadrangles (m, 8): nodes of the lower plane, of the upper one, and half-way up."""
        return self._stack.elements(quads, layer)

    def side_faces(self, edges: Wholes, layer: int) -> Wholes:
        """Faces (n, 8) of a layer over edges (n, 3) of the section - end, middle, end - seen with the sweep upwards."""
        first, middle, second = edges.T
        low, high, half = self._stack.plane(layer), self._stack.plane(layer + 1), self._stack.middle(layer)
        corners = [first + low, second + low, second + high, first + high]
        return np.stack([*corners, middle + low, second + half, middle + high, first + half], -1)

    def over(self, nodes: Wholes) -> Wholes:
        """All nodes of the mesh above section nodes: plane by plane, then half-way up layer by layer."""
        return self._stack.over(nodes)

    @cached_property
    def _section_node(self) -> Wholes:
        every = np.arange(len(self.section.points))
        result: Wholes = np.r_[np.tile(every, len(self.planes)), np.tile(every[: self.section.vertices], self.layers)]
        return result

    @cached_property
    def heights(self) -> Floats:
        """z (n,) of every node (mm)."""
        middles = (self.planes[1:] + self.planes[:-1]) / 2
        result: Floats = np.r_[np.repeat(self.planes, len(self.section.points)), np.repeat(middles, self.section.vertices)]
        return result

    @cached_property
    def points(self) -> Floats:
        """Places (n, 3) of all nodes (mm)."""
        result: Floats = np.c_[turned(self.section.points[self._section_node], self.rate * self.heights), self.heights]
        return result

    @property
    def in_section(self) -> Floats:
        """Places (n, 2) of all nodes in the turning axes (mm)."""
        return self.section.points[self._section_node]

    def to_space(self, vectors: Floats, nodes: Wholes | slice = slice(None)) -> Floats:
        """Vectors (n, 3, ...) at the nodes, or some of them, from the turning axes to fixed ones."""
        return _turned_vectors(vectors, self.rate * self.heights[nodes])

    def to_turning(self, vectors: Floats, nodes: Wholes | slice = slice(None)) -> Floats:
        """Vectors (n, 3, ...) at the nodes, or some of them, from fixed axes to the turning ones."""
        return _turned_vectors(vectors, -self.rate * self.heights[nodes])

    def side(self, side: Side) -> Wholes:
        """Section nodes of a side of the outline."""
        return self.section.sides[side]


def turned(points: Floats, angles: Floats) -> Floats:
    """Points (n, 2) turned by angles (n,) in rad."""
    cosine, sine = np.cos(angles), np.sin(angles)
    x, y = points.T
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], -1)


def _turned_vectors(vectors: Floats, angles: Floats) -> Floats:
    shape = (-1, *[1] * (vectors.ndim - 2))
    cosine, sine = np.cos(angles).reshape(shape), np.sin(angles).reshape(shape)
    x, y, z = vectors[:, 0], vectors[:, 1], vectors[:, 2]
    result: Floats = np.empty(vectors.shape)
    np.subtract(cosine * x, sine * y, out=result[:, 0])
    np.add(sine * x, cosine * y, out=result[:, 1])
    result[:, 2] = z
    return result


def sweep(gear: Gear, section: QuadMesh, layers: int) -> SweptMesh:
    """Sweep the section of a gear over its face width."""
    return SweptMesh(section, layer_planes(gear.face_width, layers), twist(gear))
