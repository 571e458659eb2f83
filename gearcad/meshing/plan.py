"""MeshPlan: how a gear or a pair is meshed, and what time and memory that takes, before anything is meshed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError, InputError, ParameterError
from gearcad.core.records import Notice, PerGear, grouped
from gearcad.core.runtime import Expected, Share, machine_memory
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.geometry.bore_teeth import with_round_bore
from gearcad.meshing.bodies.body_mesh import Amount, body_sizes, expected_amount, factor_for, mesh_body, swept_notices
from gearcad.meshing.bodies.element_mesh import ElementMesh
from gearcad.meshing.bodies.exactness import (
    Deviations,
    SideDeviations,
    deviations,
    exact_area,
    exact_volume,
    matched_distance,
    side_deviations,
)
from gearcad.meshing.bodies.gear_faces import FILLET_ANGLE, Stage, TetrahedronGrading
from gearcad.meshing.bodies.rack_exactness import exact_strip_area, strip_deviations, strip_side_deviations
from gearcad.meshing.bodies.rack_mesh import mesh_strip, strip_teeth
from gearcad.meshing.bodies.section_mesh import mesh_section
from gearcad.meshing.bodies.sectors import ContactRefinement
from gearcad.meshing.bodies.tetrahedra import mesh_tetrahedra
from gearcad.meshing.fem import Element
from gearcad.meshing.options import AUTO, DeckKind, Extent, MeshOptions, What
from gearcad.meshing.outline import MeshSizes, held_radius, round_bore_notice
from gearcad.solids.exact.inertia import mass_properties

_OF_VOLUME = 1e9
"""Density (kg/m³) whose mass in kg is the volume in mm³."""


class Offsets(NamedTuple):
    """Distances of a mesh from the exact flanks and fillets and from the other sides, and of matched cuts (mm)."""

    teeth: Deviations
    others: SideDeviations
    unmatched: float


@dataclass(frozen=True, kw_only=True)
class GearPlan(ABC):
    """Plan for the mesh of one gear, or of a rack."""

    gear: Gear | Rack

    @property
    @abstractmethod
    def every_tooth(self) -> int:
        """Teeth of the whole gear."""

    @property
    @abstractmethod
    def count(self) -> int:
        """Teeth that are meshed."""

    @property
    @abstractmethod
    def end_radius(self) -> float:
        """Radius (mm) of the circle where the body ends, which meshes call bore, or rim of a ring; 0 if there is none."""

    @property
    def amount(self) -> Amount | None:
        """Amount of elements and nodes expected; None if not known before."""
        return None

    @property
    @abstractmethod
    def exact(self) -> float:
        """Area (mm²) or volume (mm³) that the exact gear has where it is meshed."""

    @abstractmethod
    def mesh(self, share: Share) -> ElementMesh:
        """Return the mesh, in the gear's coordinates. Raises ParameterError, GeometryError and SolverError."""

    @abstractmethod
    def offsets(self, mesh: ElementMesh) -> Offsets:
        """Return how far the mesh is from the exact gear."""

    @property
    def notices(self) -> Iterable[Notice]:
        """Notices to read before the mesh is used."""
        return ()


@dataclass(frozen=True, kw_only=True)
class WheelPlan(GearPlan):
    """Plan for the mesh of one gear that is no rack."""

    gear: Gear

    @property
    def every_tooth(self) -> int:
        return self.gear.teeth

    def offsets(self, mesh: ElementMesh) -> Offsets:
        gear = self.gear
        others = side_deviations(mesh, gear, self.end_radius)
        return Offsets(deviations(mesh, gear), others, matched_distance(mesh, gear, self.count))


@dataclass(frozen=True, kw_only=True)
class SectorsPlan(WheelPlan):
    """`teeth` of a gear, None for all, up to `held_radius` (mm), 0 for a full disc; short edges where they touch others."""

    element: Element
    teeth: int | None
    held_radius: float
    sizes: MeshSizes
    contacts: Mapping[int, ContactRefinement] = field(default_factory=dict)

    @property
    def count(self) -> int:
        return self.teeth or self.gear.tooth_count

    @property
    def end_radius(self) -> float:
        return self.held_radius

    @property
    def _solid(self) -> bool:
        return self.element.shape.dimension == 3

    @cached_property
    def amount(self) -> Amount:
        return expected_amount(
            self.gear,
            teeth=self.teeth,
            held_radius=self.held_radius,
            sizes=self.sizes,
            element=self.element,
            contacts=self.contacts,
        )

    def finer(self, factor: float) -> SectorsPlan:
        """Return the plan with all edges shorter by a factor, except those of contacts."""
        return replace(self, sizes=self.sizes.scaled(factor))

    @property
    def exact(self) -> float:
        return self.count * (exact_volume if self._solid else exact_area)(self.gear, self.held_radius)

    def mesh(self, _share: Share) -> ElementMesh:
        teeth, inner, sizes, kind, zones = self.teeth, self.held_radius, self.sizes, self.element, self.contacts
        if not self._solid:
            return mesh_section(self.gear, teeth=teeth, held_radius=inner, sizes=sizes, element=kind, contacts=zones)
        return mesh_body(self.gear, teeth=teeth, held_radius=inner, sizes=sizes, planes=None, element=kind, contacts=zones)

    @property
    def notices(self) -> Iterator[Notice]:
        if self.gear.internal:
            if self.gear.body.rim_diameter is None:
                text = f"has no rim diameter: it is meshed out to a diameter of {2 * self.held_radius:.4g} mm"
                yield Notice("no-rim", text)
        elif self.held_radius and not self.gear.body.bore:
            text = f"has no bore: its teeth are meshed down to a diameter of {2 * self.held_radius:.4g} mm"
            yield Notice("no-bore", text)
        elif self.gear.body.bore_spline:
            yield round_bore_notice(self.gear)
        if self._solid:
            yield from swept_notices(self.gear)
        elif self.gear.body.bolt_holes:
            yield Notice("section-body", "sections of a ring are meshed without its bolt holes; tet10 has them")


@dataclass(frozen=True, kw_only=True)
class RackSectionPlan(GearPlan):
    """A strip of so many `teeth` of a rack, in triangles; short edges where they touch others."""

    gear: Rack
    teeth: int
    sizes: MeshSizes
    contacts: Mapping[int, ContactRefinement] = field(default_factory=dict)

    @property
    def every_tooth(self) -> int:
        return self.gear.whole_pitches

    @property
    def count(self) -> int:
        return self.teeth

    @property
    def end_radius(self) -> float:
        return 0.0

    @property
    def exact(self) -> float:
        return exact_strip_area(self.gear, self.teeth)

    def mesh(self, _share: Share) -> ElementMesh:
        return mesh_strip(self.gear, teeth=self.teeth, sizes=self.sizes, contacts=self.contacts)

    def offsets(self, mesh: ElementMesh) -> Offsets:
        return Offsets(strip_deviations(mesh, self.gear), strip_side_deviations(mesh, self.gear), 0.0)


@dataclass(frozen=True, kw_only=True)
class PartPlan(WheelPlan):
    """The whole part in tetrahedra: edges of `size` (mm) on teeth, or so many `elements`; some teeth have finer ones."""

    size: float | None
    elements: int | None
    grading: TetrahedronGrading = field(default_factory=TetrahedronGrading)
    refined_teeth: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        return self.gear.tooth_count

    @property
    def end_radius(self) -> float:
        if self.gear.internal:
            return (self.gear.body.rim_diameter or 0.0) / 2
        return self.gear.body.bore / 2

    @property
    def exact(self) -> float:
        return mass_properties(with_round_bore(self.gear), _OF_VOLUME).mass

    def mesh(self, share: Share) -> ElementMesh:
        begins = {stage: number / len(Stage) for number, stage in enumerate(Stage)}
        return mesh_tetrahedra(
            with_round_bore(self.gear),
            size=self.size,
            elements=self.elements,
            grading=self.grading,
            refined_teeth=self.refined_teeth,
            stage=lambda stage: share(begins[stage]),
        )


_PART_SIZE = 0.5
"""Usual edge of tetrahedra on teeth, in normal modules."""

_BESIDE = 1
"""Teeth meshed on each side of those that carry."""


@dataclass(frozen=True)
class MeshPlan:
    """Plan of each gear, by the names of their files, and of what elements.

    `pair` is that in which they stand in mesh, their left or right flanks touching; None where each is meshed by itself.
    """

    gears: Mapping[str, GearPlan]
    pair: GearPair | RackPair | None
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
        """True if the options give neither a number of elements nor a size."""
        return self.options.size is None and self.options.elements is None

    @property
    def amount(self) -> Amount | None:
        """Amount of elements and nodes expected of all gears together; None if not known before."""
        every = [amount for each in self.gears.values() if (amount := each.amount) is not None]
        return Amount(*map(sum, zip(*every, strict=True))) if len(every) == len(self.gears) else None

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before the meshes are used."""
        return tuple(notice.within(name) for name, each in self.gears.items() for notice in each.notices)

    def pressed(self, zones: PerGear[Mapping[int, ContactRefinement]], *, left: bool) -> MeshPlan:
        """Return the plan of a pair whose left or right flanks are pressed: they are fine in zones, by teeth."""
        fine = {role.value: replace_zones(self.gears[role.value], each) for role, each in zones.items()}
        return replace(self, gears=fine, left=left)

    def counted(self) -> MeshPlan:
        """Return the plan with as many elements in each file as the options ask for. Raises ParameterError where that cannot
        be.
        """
        wanted = self.options.elements
        if wanted is None:
            return self
        together = [list(self.gears)] if self.pair is not None else [[name] for name in self.gears]
        return replace(self, gears={name: each for names in together for name, each in self._scaled(names, wanted).items()})

    def _scaled(self, names: Sequence[str], wanted: int) -> dict[str, GearPlan]:
        """Return the gears of one file, with as many elements together as are wanted; parts share them by their volumes."""
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


def replace_zones(plan: GearPlan, zones: Mapping[int, ContactRefinement]) -> GearPlan:
    """Return a gear that is fine where it touches: in zones, or on the whole teeth of a part."""
    if isinstance(plan, PartPlan):
        return replace(plan, refined_teeth=(*plan.refined_teeth, *zones))
    if isinstance(plan, RackSectionPlan):
        return replace(plan, contacts=zones)
    assert isinstance(plan, SectorsPlan)
    return replace(plan, contacts=zones)


def plan_rack_mesh(options: MeshOptions, pair: RackPair) -> MeshPlan:
    """Return the plan of the sections of a pinion and a rack, in mesh unless teeth are asked for.

    Raises ParameterError and GeometryError.
    """
    helix, extent = pair.pinion.helix_angle, options.extent or Extent(What.PAIR)
    if options.model == "3d" or (helix and options.model == AUTO):
        raise ParameterError("model", options.model, 'must be "2d" for a rack, which is meshed as a section')
    if options.element not in (AUTO, Element.TRI6.value):
        raise ParameterError("element", options.element, "must be tri6 for a rack")
    if options.gear != "both":
        raise ParameterError("gear", options.gear, "must be left out for a rack: pinion and rack are both meshed")
    if options.elements is not None:
        raise ParameterError("elements", options.elements, "must be left out for a rack: give a size (mm)")
    if extent.what not in (What.PAIR, What.TEETH):
        raise GeometryError("what", options.what, "must be pair, pair:5, teeth:5 or the like for a rack")
    if set(options.decks) - {DeckKind.PAIR}:
        raise GeometryError("deck", options.deck, "must be pair, or left out, for a rack")
    sizes = body_sizes(pair.pinion, options.size)
    if options.fillet_elements is not None:
        sizes = replace(sizes, fillet_turn=FILLET_ANGLE / options.fillet_elements)
    teeth = strip_teeth(pair.rack) if extent.teeth is None else extent.teeth
    if teeth > pair.rack.whole_pitches:
        raise GeometryError("what", options.what, f"must be of at most {pair.rack.whole_pitches} teeth, which the rack has")
    own = extent.teeth if extent.teeth is not None and extent.teeth < pair.pinion.teeth else None
    radius = held_radius(pair.pinion)
    pinion = SectorsPlan(gear=pair.pinion, element=Element.TRI6, teeth=own, held_radius=radius, sizes=sizes)
    plans = {"pinion": pinion, "rack": RackSectionPlan(gear=pair.rack, teeth=teeth, sizes=sizes)}
    return MeshPlan(plans, pair if extent.what is What.PAIR else None, extent, Element.TRI6, options)


def plan_mesh(options: MeshOptions, gears: Mapping[str, Gear], pair: GearPair | None) -> MeshPlan:
    """Return the plan of the meshes of a design's `gears`: one gear, or both of a `pair`. Raises ParameterError and
    GeometryError.
    """
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
    """Return the plan of one gear: tetrahedra of the whole part, or sectors of teeth."""
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
    """Return the gears that are meshed."""
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
    """Return the extent where the options name none: the whole part for tet10, one gear's ring, or a pair in mesh."""
    if element is Element.TET10:
        return Extent(What.PART)
    if pair is None:
        return Extent(What.RING)
    return Extent(What.PAIR, None if dimension == 2 else _carrying(pair) + 2 * _BESIDE)


def _usual_element(dimension: int, extent: Extent) -> Element:
    """Return the element where the options name none.

    Triangles become larger inwards from the contact of a pair; quadrangles stand in rows.
    """
    if extent.what is What.PART:
        return Element.TET10
    if dimension == 3:
        return Element.HEX20
    return Element.TRI6 if extent.what is What.PAIR else Element.QUAD8


def _carrying(pair: GearPair) -> int:
    """Return the teeth around tooth 0, it among them, that can carry at some roll angle within half a pitch from the pitch
    point.
    """
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


_SECONDS = {Element.TRI6: 1e-5, Element.QUAD8: 8e-6, Element.HEX8: 6e-6, Element.HEX20: 1.2e-5}
"""Time (s) to mesh, judge and write an element in the usual formats."""

_BEFORE = 0.5
"""Least time (s) that the estimate allows."""

_COPIES, _IMPORTS = 2.2, 1e8
"""Memory at the most over that of nodes and elements, and what there is before."""


def expected_mesh(plan: MeshPlan) -> Expected | None:
    """Return the expected size, time and memory of a mesh; None for tetrahedra, whose number is not known before."""
    amount = plan.amount
    if amount is None:
        return None
    seconds = _BEFORE + _SECONDS[plan.element] * amount.elements
    makes = f"makes {grouped(amount.elements)} {plan.element.value}, {grouped(amount.nodes)} nodes"
    return Expected(seconds, expected_memory(amount), makes)


def expected_memory(amount: Amount) -> float:
    """Bytes that meshing, judging and writing so much take at the most."""
    return _IMPORTS + _COPIES * amount.bytes


_MOST_NODES = int(np.iinfo(np.int32).max)
"""Elements number their nodes so, and files do."""

_MARGIN = 1.25
"""Factor on the size that just suffices, for the size that a message suggests: amounts follow sizes only roughly."""


def require_room(plan: MeshPlan) -> None:
    """Raise ParameterError, or GeometryError where nobody asks for an amount, for more nodes than can be numbered, or more
    memory than the machine has. Of tetrahedra nobody knows before.
    """
    if plan.element is Element.TRI6:
        # Triangles are counted by meshing a sector: there must not be too many for that.
        quads = {
            name: replace(each, element=Element.QUAD8) for name, each in plan.gears.items() if isinstance(each, SectorsPlan)
        }
        _require(replace(plan, gears=quads))
    _require(plan)


def _require(plan: MeshPlan) -> None:
    amount = plan.amount
    if amount is None:
        return
    nodes, needed, there = _most_nodes(plan), expected_memory(amount), machine_memory()
    excess = max(nodes / _MOST_NODES, needed / there)
    if excess > 1:
        many = f", of which a file numbers at most {_MOST_NODES}" if nodes > _MOST_NODES else ""
        text = (
            f"makes {amount.elements:.3g} {plan.element.value} with {amount.nodes:.3g} nodes{many}; "
            f"they take about {needed / 1e9:.3g} GB of memory, and there are {there / 1e9:.3g} GB"
        )
        raise _refusal(plan, text, excess)


def _most_nodes(plan: MeshPlan) -> int:
    """Return the nodes of the largest file; a pair in mesh is one."""
    every = [amount.nodes for each in plan.gears.values() if (amount := each.amount) is not None]
    return sum(every) if plan.pair is not None else max(every)


def _refusal(plan: MeshPlan, text: str, excess: float) -> InputError:
    """Return the error for a mesh that is too large by a factor, with a size that would do."""
    options, excess = plan.options, _MARGIN * excess
    if options.elements is not None:
        return ParameterError("elements", options.elements, f"{text}; about {options.elements / excess:.2g} would do")
    if options.size is not None:
        larger = options.size * excess ** (1 / plan.element.shape.dimension)
        return ParameterError("size", options.size, f"{text}; about {larger:.2g} mm would do", "mm")
    return GeometryError("what", plan.options.what, f"{text}; a larger size, or less of the gear, would do")
