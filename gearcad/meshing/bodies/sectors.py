"""The sectors of the teeth of a gear: of tooth 0 each, as finely graded as the tooth in whose place it is turned asks for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.errors import ParameterError, require_number
from gearcad.geometry import Gear
from gearcad.meshing.bodies.contact_zone import ContactZone, lengths_near
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.section.edge_lengths import bent_lengths
from gearcad.meshing.section.held import rim_radius
from gearcad.meshing.section.layout import SectorLayout, quadrangles
from gearcad.meshing.section.outline import HalfLengths, MeshSizes, SectorSides, Side, require_fillet
from gearcad.meshing.section.quads import fill_layout
from gearcad.meshing.section.sector import mesh_sector

__all__ = ["SectorCount", "Sectors"]


_BESIDE = 1.5
"""First edge of a cut over that of the root land or fillet beside it, at most."""


class SectorCount(NamedTuple):
    """Elements of a sector; edges of its outline but for the cuts, those of them on the inner circle, those of a cut."""

    elements: int
    outline: int
    inner: int
    cut: int


class _Kind(NamedTuple):
    """What makes the sector of a tooth: its zone of short edges; whether it is as fine as sizes ask for."""

    zone: ContactZone | None
    fine: bool


@dataclass(frozen=True)
class Sectors:
    """Sectors of tooth 0 as each tooth has them; equal ones are meshed once. `held_radius` (mm) 0 is of a full disc, that of
    a ring is its rim's.

    `zones` are those of the teeth by number, from 0. Raises ParameterError and GeometryError.
    """

    gear: Gear
    held_radius: float
    sizes: MeshSizes
    element: Element
    zones: Mapping[int, ContactZone]
    known: dict[_Kind, SectorSides] = field(default_factory=dict)
    counted: dict[_Kind, SectorCount] = field(default_factory=dict)

    @classmethod
    def of_gear(
        cls, gear: Gear, held_radius: float, sizes: MeshSizes, element: Element, contacts: Mapping[int, ContactZone]
    ) -> Sectors:
        """Those of a gear whose teeth have zones by any number that means them: -1 is the last tooth."""
        return cls(gear, held_radius, sizes, element, {tooth % gear.tooth_count: zone for tooth, zone in contacts.items()})

    def __post_init__(self) -> None:
        if self.element not in (Element.QUAD8, Element.TRI6):
            raise ParameterError("element", self.element.value, 'must be "quad8" or "tri6" for a section')
        require_fillet(self.gear)
        root = self.gear.profile.root_diameter / 2
        if self.gear.internal:
            require_number("held_radius", self.held_radius, "mm", above=root)
        else:
            require_number("held_radius", self.held_radius, "mm", at_least=0, below=root)

    @property
    def disc(self) -> bool:
        """True if there is no bore."""
        return self.held_radius == 0

    @property
    def inside(self) -> float:
        """Radius (mm) where the sectors end."""
        return rim_radius(self.gear) if self.disc else self.held_radius

    def of(self, tooth: int) -> SectorSides:
        """The sector of a tooth. Raises GeometryError and SolverError."""
        kind = self._kind(tooth)
        if kind not in self.known:
            self.known[kind] = self._meshed(kind)
        return self.known[kind]

    def count(self, tooth: int) -> SectorCount:
        """What it has; quadrangles need no mesh to be counted. Raises GeometryError and SolverError."""
        kind = self._kind(tooth)
        if kind not in self.counted:
            self.counted[kind] = self._count(kind) if self.element is Element.QUAD8 else _counted(self.of(tooth))
        return self.counted[kind]

    def _count(self, kind: _Kind) -> SectorCount:
        across, up, outer, deep = counts = self._layout(kind.zone).counts
        return SectorCount(round(quadrangles(*counts)), 2 * (across + up + 2 * outer), across + 2 * outer, deep)

    def _kind(self, tooth: int) -> _Kind:
        near = not self.zones or any((tooth + step) % self.gear.tooth_count in self.zones for step in (-1, 0, 1))
        return _Kind(self.zones.get(tooth % self.gear.tooth_count), near or self.element is Element.QUAD8)

    def _meshed(self, kind: _Kind) -> SectorSides:
        zone = kind.zone
        if self.element is Element.QUAD8:
            return fill_layout(self._layout(zone))
        gear, sizes = self.gear, replace(self.sizes, cut=self._cut)
        sizes = sizes if kind.fine else _carrying(sizes)
        plain, zoned = self._lengths(sizes, None), self._lengths(sizes, zone)
        left, right = (zoned, plain) if zone and zone.left != gear.internal else (plain, zoned)
        return mesh_sector(gear, self.inside, sizes, left, right)

    @cached_property
    def _cut(self) -> float:
        """Edge length (normal modules) of the cuts of all teeth at the root: not much longer than those beside it."""
        root = self.gear.profile.curves[0]
        beside = float(self._lengths(self.sizes, None).curves[root.kind](np.zeros(1), 0.0)[0])
        return min(self.sizes.cut, _BESIDE * beside / self.gear.normal_module)

    def _layout(self, zone: ContactZone | None) -> SectorLayout:
        plain = self._lengths(self.sizes, None)
        rows = self._lengths(self.sizes, zone) if zone else None
        # Quadrangles fill circles of an even number of edges only.
        return SectorLayout(self.gear, self.inside, self.sizes, plain, rows, self.disc and self.gear.tooth_count % 2 == 1)

    def _lengths(self, sizes: MeshSizes, zone: ContactZone | None) -> HalfLengths:
        near = lengths_near(self.gear, zone) if zone else None
        return bent_lengths(self.gear, sizes, near, whole=self.element is Element.TRI6)


def _counted(sector: SectorSides) -> SectorCount:
    edges = {side: (len(chain) - 1) // 2 for side, chain in sector.sides.items()}
    cut = edges[Side.AHEAD]
    return SectorCount(len(sector.cells), sum(edges.values()) - 2 * cut, edges[Side.HELD], cut)


def _carrying(sizes: MeshSizes) -> MeshSizes:
    """Sizes of a tooth that only carries on."""
    coarse = sizes.coarse()
    longer = {name: max(getattr(sizes, name), getattr(coarse, name)) for name in ("flank", "corner", "fillet", "outline")}
    return replace(sizes, **longer, fillet_turn=None)
