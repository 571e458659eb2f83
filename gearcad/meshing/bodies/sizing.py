"""How fine meshes of bodies are, and how many elements that makes, before anything is meshed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from gearcad.errors import ParameterError, require_number, require_whole
from gearcad.geometry import Gear
from gearcad.meshing.bodies.contact_zone import ContactZone
from gearcad.meshing.bodies.core import disc
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.layers import body_planes
from gearcad.meshing.bodies.section_mesh import NO_CONTACTS, teeth_of
from gearcad.meshing.bodies.sectors import Sectors
from gearcad.meshing.section.outline import MeshSizes

__all__ = ["Amount", "body_sizes", "expected_amount", "factor_for"]


_FLANK = 0.25
"""Usual edge on the flanks, in normal modules."""

_FILLET_TURN = 7.5
"""Degrees that an edge of a fillet turns at most: four of them over 30 degrees."""

_DEVIATION = 0.3e-3
"""How far (mm) an edge's parabola may be from the curve; what modifications add is less than another 0.2 µm."""

_NEAR = 0.1
"""How far the number of elements may be from what is asked for."""

_TRIES = 16

_CLOSEST = 1e-3
"""Factors closer than this are one."""


class Amount(NamedTuple):
    """What a mesh consists of; `bytes` is the memory that its nodes and elements take."""

    elements: int
    nodes: int
    bytes: int


def body_sizes(gear: Gear, size: float | None = None) -> MeshSizes:
    """Sizes with edges of `size` (mm) on the flanks, None for what root stress asks for, and all others after them.

    Raises ParameterError.
    """
    if size is not None:
        require_number("size", size, "mm", above=0)
    module = gear.normal_module
    flank = _FLANK if size is None else size / module
    return MeshSizes(
        flank=flank,
        corner=0.4 * flank,
        fillet=0.5 * flank,
        outline=1.6 * flank,
        cut=1.2 * flank,
        rim=8 * flank,
        growth=0.4,
        fillet_turn=_FILLET_TURN,
        deviation=_DEVIATION / module,
    )


def expected_amount(
    gear: Gear,
    *,
    teeth: int | None,
    held_radius: float,
    sizes: MeshSizes,
    element: Element,
    contacts: Mapping[int, ContactZone] = NO_CONTACTS,
) -> Amount:
    """What `mesh_section` or `mesh_body` will make of the same. Of triangles one sector of each kind is meshed for it.

    Raises ParameterError, also for tetrahedra, of which nobody knows, GeometryError and SolverError.
    """
    if element is Element.TET10:
        raise ParameterError("element", element.value, "must not be tet10: how many there will be is not known before")
    solid = element.shape.dimension == 3
    flat = Element.QUAD8 if solid else element
    section = _Section.of(Sectors.of_gear(gear, held_radius, sizes, flat, contacts), teeth)
    nodes = section.vertices + section.edges
    if not solid:
        return _amount(element, section.elements, nodes)
    layers = len(body_planes(gear, sizes)) - 1
    over = section.vertices if element is Element.HEX8 else nodes
    between = 0 if element is Element.HEX8 else section.vertices
    return _amount(element, layers * section.elements, (layers + 1) * over + layers * between)


def _amount(element: Element, elements: int, nodes: int) -> Amount:
    coordinate, number = np.dtype(float).itemsize, np.dtype(np.int32).itemsize
    return Amount(elements, nodes, 3 * coordinate * nodes + number * element.shape.nodes * elements)


class _Section(NamedTuple):
    """Of a section: its elements, vertices and edges."""

    elements: int
    vertices: int
    edges: int

    @classmethod
    def of(cls, sectors: Sectors, teeth: int | None) -> _Section:
        """By Euler's formula, from elements and edges of the outline."""
        counts = [sectors.count(tooth) for tooth in teeth_of(sectors.gear, teeth)]
        elements, outline = (sum(getattr(count, name) for count in counts) for name in ("elements", "outline"))
        holes = 1 if teeth is None and not sectors.disc else 0
        if teeth is not None:
            outline += counts[0].cut + counts[-1].cut
        if sectors.disc:
            inner = sum(count.inner for count in counts)
            elements += _in_disc(sectors, inner)
            outline -= inner
        edges = (sectors.element.shape.vertices * elements + outline) // 2
        return cls(elements, 1 - holes + edges - elements, edges)


def _in_disc(sectors: Sectors, edges: int) -> int:
    """Elements inside the inner circle."""
    angles = 2 * math.pi * np.arange(edges) / edges
    circle = sectors.inside * np.stack([np.cos(angles), np.sin(angles)], -1)
    return len(disc(circle, sectors.element, sectors.sizes.growth).cells)


def factor_for(elements: int, count: Callable[[float], int], dimension: int) -> float:
    """By how much shorter all edges must be for `count`, which gives elements for such a factor, to come to `elements`.

    It comes within 10 %, or raises ParameterError with what is near.
    """
    require_whole("elements", elements, at_least=1, at_most=10**9)
    factor, low, high = 1.0, 0.0, math.inf
    tried: dict[float, int] = {}
    for _ in range(_TRIES):
        found = tried.setdefault(factor, count(factor))
        if abs(found - elements) <= _NEAR * elements:
            return factor
        low, high = (factor, high) if found < elements else (low, factor)
        factor *= float(np.clip((elements / found) ** (1 / dimension), 0.05, 20.0))
        if not low < factor < high:
            factor = math.sqrt(low * high)
        if high / max(low, 1e-300) < 1 + _CLOSEST or factor < 1e-4:
            break
    near = min(tried.values(), key=lambda found: abs(found - elements))
    raise ParameterError("elements", elements, f"cannot be met within 10 % by this layout: near is {near}")
