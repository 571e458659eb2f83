"""How one gear is meshed: tooth by tooth, or as a whole part."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from gearcad.geometry import Gear
from gearcad.meshing.bodies.body_mesh import mesh_body, swept_notices
from gearcad.meshing.bodies.brep import Stage
from gearcad.meshing.bodies.contact_zone import ContactZone
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.exact_size import exact_area, exact_volume
from gearcad.meshing.bodies.mesh import ElementMesh
from gearcad.meshing.bodies.section_mesh import mesh_section
from gearcad.meshing.bodies.sizing import Amount, expected_amount
from gearcad.meshing.bodies.tetrahedra import mesh_tetrahedra
from gearcad.meshing.bodies.tetrahedron_sizes import TetrahedronGrading
from gearcad.meshing.section.outline import MeshSizes
from gearcad.notice import Notice
from gearcad.progress import Share
from gearcad.solids.exact.inertia import mass_properties

__all__ = ["GearPlan", "PartPlan", "SectorsPlan"]

_OF_VOLUME = 1e9
"""Density (kg/m³) whose mass in kg is the volume in mm³."""


@dataclass(frozen=True, kw_only=True)
class GearPlan(ABC):
    """A gear and how it is meshed."""

    gear: Gear

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
        """What it will come to, where that is known."""
        return None

    @property
    @abstractmethod
    def exact(self) -> float:
        """Area (mm²) or volume (mm³) that the exact gear has where it is meshed."""

    @abstractmethod
    def mesh(self, share: Share) -> ElementMesh:
        """The mesh, in the gear's coordinates. Raises ParameterError, GeometryError and SolverError."""

    @property
    def notices(self) -> Iterable[Notice]:
        """What to know before using the mesh."""
        return ()


@dataclass(frozen=True, kw_only=True)
class SectorsPlan(GearPlan):
    """`teeth` of a gear, None for all, up to `held_radius` (mm), 0 for a full disc; short edges where they touch others."""

    element: Element
    teeth: int | None
    held_radius: float
    sizes: MeshSizes
    contacts: Mapping[int, ContactZone] = field(default_factory=dict)

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
        """The same with all edges shorter by a factor, but for those of contacts."""
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
        if self._solid:
            yield from swept_notices(self.gear)
        elif self.gear.body.bolt_holes:
            yield Notice("section-body", "sections of a ring are meshed without its bolt holes; tet10 has them")


@dataclass(frozen=True, kw_only=True)
class PartPlan(GearPlan):
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
        return mass_properties(self.gear, _OF_VOLUME).mass

    def mesh(self, share: Share) -> ElementMesh:
        begins = {stage: number / len(Stage) for number, stage in enumerate(Stage)}
        return mesh_tetrahedra(
            self.gear,
            size=self.size,
            elements=self.elements,
            grading=self.grading,
            refined_teeth=self.refined_teeth,
            stage=lambda stage: share(begins[stage]),
        )
