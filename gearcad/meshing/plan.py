"""MeshPlan: what the options of a mesh come to for a gear or a pair, before anything is meshed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from gearcad.errors import GeometryError, ParameterError
from gearcad.geometry import Gear, GearPair
from gearcad.meshing.bodies.body_mesh import swept_notices
from gearcad.meshing.bodies.contact_zone import ContactZone
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.options import AUTO, Extent, MeshOptions, What
from gearcad.meshing.section.inner import inner_radius
from gearcad.meshing.section.outline import MeshSizes
from gearcad.notice import Notice

__all__ = ["MeshPlan", "plan_mesh"]

_KINDS = {2: (Element.QUAD8, Element.TRI6), 3: (Element.HEX20, Element.HEX8)}
"""Elements of what is meshed tooth by tooth, the usual one first, by how many dimensions they have."""

_BESIDE = 1
"""Teeth meshed on each side of those that carry."""


@dataclass(frozen=True)
class MeshPlan:
    """Which `gears` are meshed, by the names of their files, how much of them, and of what elements.

    `pair` is that in which they stand in mesh, their left or right flanks touching; None where each is meshed by itself.
    `contacts` are the zones of short edges of each gear's teeth.
    """

    gears: Mapping[str, Gear]
    pair: GearPair | None
    extent: Extent
    element: Element
    options: MeshOptions
    left: bool = True
    contacts: Mapping[str, Mapping[int, ContactZone]] = field(default_factory=dict)

    @property
    def solid(self) -> bool:
        """True for bodies, False for sections."""
        return self.element.shape.dimension == 3

    def teeth_of(self, gear: Gear) -> int | None:
        """Teeth of a gear that are meshed, None for all of them."""
        teeth = self.extent.teeth
        return None if teeth is None or teeth >= gear.teeth else teeth

    def inner_radius(self, gear: Gear) -> float:
        """Radius (mm) down to which a gear is meshed: the bore, 0 where all teeth stand on a full disc."""
        return 0.0 if not gear.body.bore and self.teeth_of(gear) is None else inner_radius(gear)

    def sizes(self, gear: Gear) -> MeshSizes:
        """Lengths of edges."""
        usual, size = MeshSizes(), self.options.size
        return usual if size is None else usual.scaled(usual.flank * gear.normal_module / size)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before using the meshes."""
        return tuple(notice for name, gear in self.gears.items() for notice in self._of_gear(name, gear))

    def _of_gear(self, name: str, gear: Gear) -> Iterator[Notice]:
        if self.element is Element.TET10:
            return
        if inner := 0.0 if gear.body.bore else self.inner_radius(gear):
            yield Notice("no-bore", f"has no bore: its teeth are meshed down to a diameter of {2 * inner:.4g} mm", name)
        if self.solid:
            yield from (notice.within(name) for notice in swept_notices(gear))


def plan_mesh(options: MeshOptions, gears: Mapping[str, Gear], pair: GearPair | None) -> MeshPlan:
    """What is meshed of a design's `gears`, which are those of a `pair` or one alone. Raises ParameterError, GeometryError."""
    chosen = _chosen(options, gears, pair)
    element_given = None if options.element == AUTO else Element(options.element)
    dimension = _dimension(options, element_given, chosen)
    extent = options.extent or _usual(dimension, element_given, pair if len(chosen) == 2 else None)
    element = element_given or (Element.TET10 if extent.what is What.PART else _KINDS[dimension][0])
    _require_possible(options, extent, element, pair, chosen)
    return MeshPlan(chosen, pair if extent.what is What.PAIR else None, extent, element, options)


def _chosen(options: MeshOptions, gears: Mapping[str, Gear], pair: GearPair | None) -> Mapping[str, Gear]:
    """The gears that are meshed."""
    if options.gear == "both":
        return gears
    if pair is None:
        raise ParameterError("gear", options.gear, "must not be given for a single gear: only a pair has two to choose from")
    return {options.gear: gears[options.gear]}


def _dimension(options: MeshOptions, element: Element | None, gears: Mapping[str, Gear]) -> int:
    """2 for sections, 3 for bodies."""
    whole = options.extent is not None and options.extent.what is What.PART
    if options.model != AUTO:
        wanted = 2 if options.model == "2d" else 3
        if whole and wanted == 2:
            raise GeometryError("model", options.model, "must be 3d for part, which has bore, keyway and hub")
        if element is not None and element.shape.dimension != wanted:
            permitted = ", ".join(each.value for each in Element if each.shape.dimension == wanted)
            raise GeometryError("element", element.value, f"must be one of {permitted} for model {options.model}")
        return wanted
    if element is not None:
        return element.shape.dimension
    return 3 if whole or any(gear.helix_angle for gear in gears.values()) else 2


def _usual(dimension: int, element: Element | None, pair: GearPair | None) -> Extent:
    """How much is meshed where nothing is said of it."""
    if element is Element.TET10:
        return Extent(What.PART)
    if pair is None:
        return Extent(What.RING)
    return Extent(What.PAIR, None if dimension == 2 else _carrying(pair) + 2 * _BESIDE)


def _carrying(pair: GearPair) -> int:
    """Teeth around tooth 0, it among them, that can carry at some roll angle within half a pitch from the pitch point."""
    return 1 + 2 * int(pair.total_contact_ratio / 2 + 0.5)


def _require_possible(
    options: MeshOptions, extent: Extent, element: Element, pair: GearPair | None, gears: Mapping[str, Gear]
) -> None:
    """Raise GeometryError for what cannot be meshed."""
    whole = extent.what is What.PART
    if whole and element is not Element.TET10:
        raise GeometryError("element", element.value, "must be tet10 for part: no other element fills keyway and hub")
    if element is Element.TET10 and not whole and extent != Extent(What.PAIR):
        raise GeometryError("what", options.what, "must be part, or pair, for tet10: tetrahedra fill whole parts")
    if extent.what is What.PAIR and pair is None:
        raise GeometryError("what", options.what, "needs a pair: this design is a single gear")
    if extent.what is What.PAIR and len(gears) < 2:
        raise GeometryError("gear", options.gear, "must be both for a pair in mesh")
    if extent.what is not What.PAIR and options.roll:
        raise GeometryError("roll", options.roll, f"must be 0 for {extent.what.value}: only a pair stands in mesh", "deg")
    fewest = min(gear.teeth for gear in gears.values())
    if extent.what is What.TEETH and extent.teeth is not None and extent.teeth >= fewest:
        raise GeometryError("what", options.what, f"must be of fewer than {fewest} teeth, which the gear has; or ring")
