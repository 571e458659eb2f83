"""MeshPlan: what the options of a mesh come to for a gear or a pair, before anything is meshed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from gearcad.errors import GeometryError, ParameterError
from gearcad.geometry import Gear, GearPair
from gearcad.meshing.bodies.contact_zone import ContactZone
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.sizing import Amount, body_sizes, factor_for
from gearcad.meshing.bodies.tetrahedron_sizes import FILLET_ANGLE, TetrahedronGrading
from gearcad.meshing.gear_plan import GearPlan, PartPlan, SectorsPlan
from gearcad.meshing.options import AUTO, Extent, MeshOptions, What
from gearcad.meshing.section.held import held_radius
from gearcad.notice import Notice
from gearcad.per_gear import PerGear

__all__ = ["MeshPlan", "plan_mesh"]

_PART_SIZE = 0.5
"""Usual edge of tetrahedra on teeth, in normal modules."""

_BESIDE = 1
"""Teeth meshed on each side of those that carry."""


@dataclass(frozen=True)
class MeshPlan:
    """How each gear is meshed, by the names of their files, and of what elements.

    `pair` is that in which they stand in mesh, their left or right flanks touching; None where each is meshed by itself.
    """

    gears: Mapping[str, GearPlan]
    pair: GearPair | None
    extent: Extent
    element: Element
    options: MeshOptions
    left: bool = True

    @property
    def solid(self) -> bool:
        """True for bodies, False for sections."""
        return self.element.shape.dimension == 3

    @property
    def usual(self) -> bool:
        """True if nobody asks for a number of elements, or a size."""
        return self.options.size is None and self.options.elements is None

    @property
    def amount(self) -> Amount | None:
        """What all gears will come to, where that is known."""
        every = [amount for each in self.gears.values() if (amount := each.amount) is not None]
        return Amount(*map(sum, zip(*every, strict=True))) if len(every) == len(self.gears) else None

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before using the meshes."""
        return tuple(notice.within(name) for name, each in self.gears.items() for notice in each.notices)

    def pressed(self, zones: PerGear[Mapping[int, ContactZone]], *, left: bool) -> MeshPlan:
        """The plan of a pair whose left or right flanks are pressed: they are fine in zones, by teeth."""
        fine = {role.value: _with_zones(self.gears[role.value], each) for role, each in zones.items()}
        return replace(self, gears=fine, left=left)

    def counted(self) -> MeshPlan:
        """The plan with as many elements in each file as the options ask for. Raises ParameterError where that cannot be."""
        wanted = self.options.elements
        if wanted is None:
            return self
        together = [list(self.gears)] if self.pair is not None else [[name] for name in self.gears]
        return replace(self, gears={name: each for names in together for name, each in self._scaled(names, wanted).items()})

    def _scaled(self, names: Sequence[str], wanted: int) -> dict[str, GearPlan]:
        """Gears of one file, with as many elements together as are wanted; parts share them by their volumes."""
        chosen = {name: self.gears[name] for name in names}
        sectors = {name: each for name, each in chosen.items() if isinstance(each, SectorsPlan)}
        parts = {name: each for name, each in chosen.items() if isinstance(each, PartPlan)}

        def count(factor: float) -> int:
            return sum(each.finer(factor).amount.elements for each in sectors.values())

        factor = factor_for(wanted, count, self.element.shape.dimension) if sectors else 1.0
        volumes = {name: each.exact for name, each in parts.items()} if len(parts) > 1 else dict.fromkeys(parts, 1.0)
        shares = {name: round(wanted * volume / sum(volumes.values())) for name, volume in volumes.items()}
        return {name: each.finer(factor) for name, each in sectors.items()} | {
            name: replace(each, elements=shares[name]) for name, each in parts.items()
        }


def _with_zones(plan: GearPlan, zones: Mapping[int, ContactZone]) -> GearPlan:
    """A gear that is fine where it touches: in zones, or on the whole teeth of a part."""
    if isinstance(plan, PartPlan):
        return replace(plan, refined_teeth=(*plan.refined_teeth, *zones))
    assert isinstance(plan, SectorsPlan)
    return replace(plan, contacts=zones)


def plan_mesh(options: MeshOptions, gears: Mapping[str, Gear], pair: GearPair | None) -> MeshPlan:
    """What is meshed of a design's `gears`, which are those of a `pair` or one alone. Raises ParameterError, GeometryError."""
    chosen = _chosen(options, gears, pair)
    element_given = None if options.element == AUTO else Element(options.element)
    dimension = _dimension(options, element_given, chosen)
    gap = max((gear.double_helix.gap_width or 0.0 for gear in chosen.values()), default=0.0)
    if gap and dimension == 3 and element_given is None:
        element_given = Element.TET10
    extent = options.extent or _usual(dimension, element_given, pair if len(chosen) == 2 else None)
    element = element_given or _usual_element(dimension, extent)
    if gap and element in (Element.HEX20, Element.HEX8):
        permitted = f"must be tet10 for a body with a gap of {gap:g} mm between its halves, where no section is swept"
        raise GeometryError("element", element.value, permitted)
    _require_possible(options, extent, element, pair, chosen)
    plans = {name: _planned(gear, options, extent, element) for name, gear in chosen.items()}
    return MeshPlan(plans, pair if extent.what is What.PAIR else None, extent, element, options)


def _planned(gear: Gear, options: MeshOptions, extent: Extent, element: Element) -> GearPlan:
    """How a gear is meshed."""
    fillet = options.fillet_elements
    if element is Element.TET10:
        grading = TetrahedronGrading() if fillet is None else TetrahedronGrading(fillet_elements=fillet)
        size = options.size if options.size or options.elements else _PART_SIZE * gear.normal_module
        refined = options.refined
        return PartPlan(gear=gear, size=size, elements=options.elements, grading=grading, refined_teeth=refined)
    teeth = None if extent.teeth is None or extent.teeth >= gear.tooth_count else extent.teeth
    full = not (gear.internal or gear.body.bore) and teeth is None
    radius = 0.0 if full else held_radius(gear)
    sizes = body_sizes(gear, options.size)
    if fillet is not None:
        sizes = replace(sizes, fillet_turn=FILLET_ANGLE / fillet)
    return SectorsPlan(gear=gear, element=element, teeth=teeth, held_radius=radius, sizes=sizes)


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


def _usual_element(dimension: int, extent: Extent) -> Element:
    """That of which nothing is said. Triangles become larger inwards from where a pair touches; quadrangles stand in rows."""
    if extent.what is What.PART:
        return Element.TET10
    if dimension == 3:
        return Element.HEX20
    return Element.TRI6 if extent.what is What.PAIR else Element.QUAD8


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
    if options.refined and element is not Element.TET10:
        raise GeometryError(
            "refined_teeth", options.refined_teeth, f"must be left out for {element.value}: it is of tetrahedra"
        )
    if options.decks and pair is None:
        raise GeometryError("deck", options.deck, "needs a pair: this design is a single gear")
    fewest = min(gear.tooth_count for gear in gears.values())
    if extent.what is What.TEETH and extent.teeth is not None and extent.teeth >= fewest:
        raise GeometryError("what", options.what, f"must be of fewer than {fewest} teeth, which the gear has; or ring")
