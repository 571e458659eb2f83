"""Stresses in the most stressed tooth of a solid gear: those of the elements, averaged at the nodes.

Near the lines of contact, within an element of them, the field is not resolved: there Hertz's formulas hold instead.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.solid.cycle import SolidCycle, SolidPosition, tooth_loads
from gearcad.contact.solid.hexahedra import PLACES, lame, slopes_at
from gearcad.material import Material
from gearcad.meshing.section.shapes import GAUSS
from gearcad.per_gear import Role

__all__ = ["SolidField", "nodal_stress", "shown_stress", "solid_field", "worst_field", "write_vtu"]


_GAUSS = GAUSS / 2
"""The same in the unit cube."""

_VTK = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 12, 13, 14, 15, 16, 17, 18, 19]
"""Our nodes of a hexahedron in VTK's order: corners below, corners above, then the middles below, above and between."""

_OVER = 1.1
"""How far pictures show stresses, in greatest von Mises stresses of the fillets."""

_DEFORMED, _ROOT = "displacement_mm", "von_mises_root_MPa"
"""The fields of a .vtu that show what one looks for."""

_COMPONENTS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))
"""Axes of the components of stress, in our order and VTK's."""

_FLIPPED = [0, 3, 2, 1, 7, 6, 5, 4, 8, 11, 10, 9, 15, 14, 13, 12, 16, 19, 18, 17]
"""Our nodes of a hexahedron's mirror image, in our order."""

_FACES = np.array(
    [
        [0, 3, 2, 1, 7, 6, 5, 4],
        [8, 9, 10, 11, 12, 13, 14, 15],
        [0, 1, 9, 8, 4, 17, 12, 16],
        [1, 2, 10, 9, 5, 18, 13, 17],
        [2, 3, 11, 10, 6, 19, 14, 18],
        [3, 0, 8, 11, 7, 16, 15, 19],
    ]
)
"""Nodes of the faces of a hexahedron, four corners and the middles between them, counter-clockwise seen from outside."""


@dataclass(frozen=True)
class SolidField:
    """A tooth and its share of the body: `points` (n, 3) in mm, `hexahedra` (m, 20), `displacement` (n, 3) in mm.

    `stress` (n, 6) in MPa: xx, yy, zz, xy, yz, zx. The tooth is gear's own tooth 0, where it stands before it bends.
    """

    points: Floats
    hexahedra: Wholes
    displacement: Floats
    stress: Floats

    def between(self, inner: float, outer: float) -> SolidField:
        """Only the hexahedra whose middles are between two radii (mm)."""
        middles = self.points[self.hexahedra].mean(axis=1)
        radius = np.hypot(middles[:, 0], middles[:, 1])
        return replace(self, hexahedra=self.hexahedra[(radius > inner) & (radius < outer)])

    @property
    def mirrored(self) -> SolidField:
        """The mirror image in the plane x-z."""
        flip = np.array([1.0, -1.0, 1.0])
        turned = np.array([1.0, 1.0, 1.0, -1.0, -1.0, 1.0])
        return SolidField(self.points * flip, self.hexahedra[:, _FLIPPED], self.displacement * flip, self.stress * turned)

    @property
    def surface(self) -> Wholes:
        """Faces (k, 8) that belong to one hexahedron only: corners, then the middles between them, seen from outside."""
        faces = self.hexahedra[:, _FACES].reshape(-1, 8)
        _, place, times = np.unique(np.sort(faces[:, :4], axis=1), axis=0, return_index=True, return_counts=True)
        result: Wholes = faces[place[times == 1]]
        return result

    @property
    def von_mises(self) -> Floats:
        """Von Mises stress (n,) at the points in MPa."""
        xx, yy, zz, xy, yz, zx = self.stress.T
        squares = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
        result: Floats = np.sqrt(squares / 2 + 3 * (xy**2 + yz**2 + zx**2))
        return result


def worst_field(cycle: SolidCycle, role: Role) -> SolidField:
    """The field of the most stressed tooth of a gear where its root tension is greatest."""
    position = cycle.worst_position(role)
    fillet, loads = cycle.model.fillets.pick(role).loaded, tooth_loads(cycle.model, position.contacts, role)

    def tension(own: int) -> float:
        state = fillet.state([(tooth - own, force) for tooth, force in loads])
        return float(state.greater[:, fillet.is_root].max())

    return solid_field(cycle, position, role, max((own for own, _ in loads), key=tension))


def solid_field(cycle: SolidCycle, position: SolidPosition, role: Role, tooth: int = 0) -> SolidField:
    """The field of a tooth of a gear, counted as its teeth follow each other where flanks with y > 0 carry.

    A ring's is that of the ring as it stands, flanks with y < 0 loaded. Loads on teeth further away than the model's neighbours
    are left out.
    """
    body = cycle.model.bodies.pick(role)
    mesh = body.body.sector.mesh
    displacement = body.tooth_displacements(tooth, tooth_loads(cycle.model, position.contacts, role))
    hexahedra = np.concatenate([mesh.elements(mesh.section.quads, layer) for layer in range(mesh.layers)])
    stress = nodal_stress(mesh.points, hexahedra, displacement, body.material)
    found = SolidField(mesh.points, hexahedra, displacement, stress)
    return found.mirrored if body.flank.gear.internal else found


def shown_stress(cycle: SolidCycle, role: Role, field: SolidField) -> float:
    """Where the colours of a picture should end (MPa): a tenth above the greatest von Mises stress of both fillets' roots.

    The contact, which elements do not resolve, lies above.
    """
    mesh = cycle.model.bodies.pick(role).body.sector.mesh
    radius, stress = np.hypot(*mesh.in_section.T), field.von_mises
    found = []
    fillets = cycle.model.fillets.pick(role)
    for fillet in (fillets.loaded, fillets.behind):
        nodes, roots = mesh.over(mesh.side(fillet.side)), fillet.radii[fillet.is_root]
        below = radius[nodes] >= roots.min() if fillet.internal else radius[nodes] <= roots.max()
        found.append(stress[nodes[below]].max())
    return _OVER * float(max(found))


def write_vtu(field: SolidField, path: Path, most: float) -> None:
    """Write a field for ParaView, units in the names; stress as VTK has it, xx, yy, zz, xy, yz, zx.

    `von_mises_root_MPa` ends at `most` (MPa), so that its colours show the root; it is what a viewer shows first.
    """
    import meshio

    stress = field.von_mises
    data = {
        _ROOT: np.minimum(stress, most),
        "von_mises_MPa": stress,
        "stress_MPa": field.stress,
        _DEFORMED: field.displacement,
    }
    meshio.Mesh(field.points, [("hexahedron20", field.hexahedra[:, _VTK])], point_data=data).write(path)
    # meshio does not say which of the fields are the ones to colour and to bend by.
    plain, active = b"<PointData>", f'<PointData Scalars="{_ROOT}" Vectors="{_DEFORMED}">'.encode("ascii")
    path.write_bytes(path.read_bytes().replace(plain, active, 1))


def nodal_stress(points: Floats, hexahedra: Wholes, displacement: Floats, material: Material) -> Floats:
    """Stresses (n, 6) at the nodes: from 2 x 2 x 2 points of each element, outward, and the mean of all elements around."""
    slopes, outward = _slopes(), _outward()
    jacobian = np.einsum("qak,mai->mqik", slopes, points[hexahedra], optimize=True)
    by_local = np.einsum("qak,mai->mqik", slopes, displacement[hexahedra], optimize=True)
    gradient = by_local @ np.linalg.inv(jacobian)
    at_nodes = np.einsum("aq,mqs->mas", outward, _stress(gradient, material), optimize=True)
    total, times = np.zeros((len(points), 6)), np.zeros(len(points))
    np.add.at(total, hexahedra, at_nodes)
    np.add.at(times, hexahedra, 1.0)
    result: Floats = total / times[:, None]
    return result


def _stress(gradient: Floats, material: Material) -> Floats:
    """Stresses (..., 6) by gradients of displacement (..., 3, 3)."""
    first, second = lame(material)
    strain = (gradient + np.swapaxes(gradient, -1, -2)) / 2
    stress = 2 * second * strain + first * np.trace(strain, axis1=-2, axis2=-1)[..., None, None] * np.eye(3)
    return np.stack([stress[..., i, j] for i, j in _COMPONENTS], -1)


@cache
def _gauss_points() -> Floats:
    low, high = 0.5 - _GAUSS, 0.5 + _GAUSS
    return np.array([[x, y, z] for z in (low, high) for y in (low, high) for x in (low, high)])


@cache
def _slopes() -> Floats:
    """Slopes (8, 20, 3) of the shape functions at the points."""
    return slopes_at(_gauss_points().T)


@cache
def _outward() -> Floats:
    """Weights (20, 8) with which values at the points, trilinear between them, give those at the nodes."""
    signs = (_gauss_points() - 0.5) / _GAUSS
    local = (PLACES - 0.5) / _GAUSS
    result: Floats = np.prod(1 + signs[None] * local[:, None], axis=-1) / 8
    return result
