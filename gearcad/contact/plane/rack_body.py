"""A pinion and a rack in plane contact: the rack as a strip of teeth that is held along its back.

The strip is the limit of a wheel's ring as its number of teeth grows: its sectors follow each other in a straight line, and its
hub does not turn but moves along the rack. What is told of a wheel's hub in N mm is a force in N here. All other quantities are
those along the line of action, which stay finite.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.contact.plane.flank import PlaneCompliance, SectionFlank, solved_flank
from gearcad.contact.plane.ring import assemble
from gearcad.contact.plane.sector import PlaneElasticity
from gearcad.contact.shared.bodies import Cuts, Support
from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats, Wholes
from gearcad.geometry import Rack
from gearcad.meshing.bodies.rack_mesh import strip_teeth
from gearcad.meshing.outline import MeshSizes, OutlineSide
from gearcad.meshing.rack_section import mesh_rack_sector
from gearcad.meshing.sector import SectorMesh


@dataclass(frozen=True)
class RackFlank(SectionFlank):
    """The loaded flank of a rack's section: its nodes from root to tip, and their places (mm), as `StraightFlank` has them."""

    rack: Rack
    nodes: Wholes
    lengths: Floats

    @classmethod
    def of(cls, rack: Rack, mesh: SectorMesh) -> RackFlank:
        """Return the loaded flank of a sector mesh."""
        nodes = mesh.sides[OutlineSide.LEFT_FLANK][::-1]
        return cls(rack, nodes, mesh.points[nodes, 0] / math.sin(math.radians(rack.transverse_pressure_angle)))

    @property
    def _angle(self) -> float:
        """Transverse pressure angle (rad)."""
        return math.radians(self.rack.transverse_pressure_angle)

    @property
    def lever(self) -> float:
        return math.cos(self._angle)

    @property
    def upward(self) -> int:
        return 1

    def radii(self, lengths: Floats) -> Floats:
        heights: Floats = lengths * math.sin(self._angle)
        return heights

    @property
    def sharp_root(self) -> bool:
        return self.rack.root is not None and self.rack.root.corner

    def near_elements(self, mesh: SectorMesh) -> Wholes:
        heights = mesh.points[mesh.triangles[:, :3], 0].mean(axis=1)
        return np.flatnonzero(heights > -self.rack.root_depth - self.rack.normal_module)

    def arc(self, lengths: Floats) -> Floats:
        """Return the distance along the flank (mm) from the reference line, which rises towards the tip."""
        result: Floats = lengths * math.tan(self._angle)
        return result

    def length_at(self, arc: float) -> float:
        return arc / math.tan(self._angle)

    def heading(self, lengths: Floats) -> Floats:
        return np.full(np.shape(lengths), -self._angle)

    def points(self, lengths: Floats | float) -> Floats:
        heights = np.asarray(lengths, float) * math.sin(self._angle)
        half = self.rack.profile.half_thickness_on_flank(0.0) - heights * math.tan(self._angle)
        return np.stack([heights, half], -1)


def rack_body(
    rack: Rack, elasticity: PlaneElasticity, neighbours: int, sizes: MeshSizes | None = None, reach: float | None = None
) -> PlaneCompliance:
    """Return a strip of a rack's teeth, held along its back, with `neighbours` in full on each side of the loaded tooth.

    The loaded tooth stands in the middle of so many others that they reach `reach` times the height to both sides, if the rack
    is as long. Raises GeometryError for a rack of fewer teeth than can touch, and what a mesh does.
    """
    full = 2 * neighbours + 1
    if rack.whole_pitches < full:
        permitted = f"must be at least {full} here: so many teeth carry or stand beside one that does"
        raise GeometryError("rack.teeth", rack.whole_pitches, permitted)
    sizes = sizes or MeshSizes()
    held = strip_teeth(rack, full) if reach is None else strip_teeth(rack, full, reach)
    fine, coarse = mesh_rack_sector(rack, sizes), mesh_rack_sector(rack, sizes.coarse())
    ring = assemble(fine, coarse, held, neighbours, elasticity, held, Cuts.FREE, Support(teeth=held))
    return solved_flank(RackFlank.of(rack, fine), ring, elasticity)
