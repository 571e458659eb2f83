"""How the bore of a gear body is held: all round, on a shaft that gives way, by a key, or free.

A bore that is not held rests on a hub that follows its motion in the mean: what the hub gives back is a traction shaped like
a rigid motion - its part along the bore, for a bore may slide and lift but not shear - that balances the teeth. The mean
motion of the bore, weighted like that traction, is nought, so the body stays where its hub is, and responses are symmetric.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.plane.elasticity import mass_matrix
from gearcad.errors import GeometryError, format_number
from gearcad.geometry import Gear
from gearcad.material import Material
from gearcad.meshing import SectorMesh
from gearcad.meshing.outline import Side
from gearcad.meshing.shaft import with_shaft

__all__ = ["Hold", "Support", "rim_ratio", "support_of"]


STEEL = 206000.0
"""Modulus (MPa) of a shaft of which nothing is said."""

LEAST_RIM = 1.2
"""s_R/h_t from which on a rim is thick (ISO 6336-3:2006, clause 9)."""

_SAME = 1e-9
"""mm: radii that do not differ."""

_THINNEST_SHAFT = 0.98
"""Greatest bore of a shaft, over its diameter."""

_GAUSS = 4
"""Points on a part of an edge for the tractions on the bore."""

_PARTS = 16
"""Parts of an edge, so that a keyway may end inside it."""


class Hold(Enum):
    """What holds the bore of a gear."""

    AUTO = "auto"
    """Rigid where the rim is thick; else free, or by the key if there is a keyway."""

    RIGID = "rigid"
    """Held all round, as by a stiff shaft in a tight fit."""

    SHAFT = "shaft"
    """Bonded to a shaft or hub ring that gives way, whose section the torque enters like St Venant's shear, as r."""

    KEY = "key"
    """Free, but the torque comes from a keyway: stresses are those with the key where it is worst."""

    FREE = "free"
    """Shear all round, as from splines or a thin web, gives torque and force; nothing keeps the bore round."""


@dataclass(frozen=True)
class Support:
    """What holds the bore of a body of `teeth` sectors (not AUTO).

    `shaft` is the shaft's material and `shaft_bore` (mm) its own bore; `key` the half width (rad) of the keyway, seen from the
    axis.
    """

    hold: Hold = Hold.RIGID
    teeth: int = 1
    shaft: Material = field(default_factory=Material)
    shaft_bore: float = 0.0
    key: float = 0.0

    @property
    def floats(self) -> bool:
        """True if the hub follows the bore in the mean, and so has three dofs, the torque and two forces; else its turn."""
        return self.hold is not Hold.RIGID

    @property
    def words(self) -> str:
        """How the body is held, before "diameter ..." in a sentence."""
        return _WORDS[self.hold]

    @property
    def bends(self) -> bool:
        """True if nothing keeps the bore round, so that the whole rim is stressed, not only near the loaded teeth."""
        return self.hold in (Hold.KEY, Hold.FREE)

    def whole(self, mesh: SectorMesh) -> SectorMesh:
        """The sector with what of the shaft belongs to it."""
        return with_shaft(mesh, self.shaft_bore) if self.hold is Hold.SHAFT else mesh

    def held(self, mesh: SectorMesh) -> Wholes:
        """Nodes that belong to the hub."""
        return np.empty(0, int) if self.floats else mesh.sides[Side.INNER]

    def seen_by(self, tooth: int) -> Floats:
        """Dofs of the hub as the sector of a tooth, counted from the loaded one, sees them, from those that that one sees."""
        if not self.floats:
            return np.eye(1)
        cosine, sine = math.cos(tooth * 2 * math.pi / self.teeth), math.sin(tooth * 2 * math.pi / self.teeth)
        return np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])

    def tractions(self, mesh: SectorMesh, whole: SectorMesh) -> Floats:
        """Nodal forces (2 n, 3) on the `whole` of a sector by torque and forces of unit shape, of a hub that floats."""
        if self.hold is Hold.SHAFT:
            shaft = np.arange(len(mesh.triangles), len(whole.triangles))
            return np.asarray(mass_matrix(whole, shaft) @ rigid_motions(whole.points).reshape(-1, 3))
        return _on_bore(mesh, math.pi)

    def key_load(self, mesh: SectorMesh) -> Floats:
        """Nodal forces (2 n, 1) by which a key under the middle of the sector gives a torque of 1 (N mm per mm).

        The shear over a bore as wide as the keyway, or as the sector if that is narrower.
        """
        forces = _on_bore(mesh, self.key)[:, :1]
        return forces / (forces[:, 0] @ rigid_motions(mesh.points)[..., 0].ravel())


_WORDS = {
    Hold.RIGID: "held on",
    Hold.SHAFT: "bonded to an elastic shaft on",
    Hold.KEY: "free, but for shear and a key, on",
    Hold.FREE: "free, but for shear, on",
}


def rigid_motions(points: Floats) -> Floats:
    """Displacements (n, 2, 3) of points by a turn of 1 rad and by shifts along x and y of 1."""
    x, y = points.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    return np.stack([np.stack([-y, x], -1), np.stack([one, zero], -1), np.stack([zero, one], -1)], -1)


def _on_bore(mesh: SectorMesh, half: float) -> Floats:
    """Nodal forces (2 n, 3) by rigid motions' parts along the bore, as tractions up to `half` (rad) from its middle."""
    arc = mesh.sides[Side.INNER]
    edges = np.stack([arc[:-1:2], arc[1::2], arc[2::2]], -1)
    s, weight = np.polynomial.legendre.leggauss(_GAUSS)
    s = (np.arange(_PARTS)[:, None] + (s + 1) / 2).ravel() * 2 / _PARTS - 1
    weight = np.tile(weight / _PARTS, _PARTS)
    shape = np.stack([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2], -1)
    slope = np.stack([s - 0.5, -2 * s, s + 0.5], -1)
    points = np.einsum("qa,eac->eqc", shape, mesh.points[edges])
    length = np.hypot(*np.moveaxis(np.einsum("qa,eac->eqc", slope, mesh.points[edges]), -1, 0)) * weight
    angle = np.arctan2(points[..., 1], points[..., 0])
    length = np.where(np.abs(angle) <= half, length, 0.0)
    along = np.stack([-np.sin(angle), np.cos(angle)], -1)
    motions = rigid_motions(points.reshape(-1, 2)).reshape(*points.shape, 3)
    sheared = np.einsum("eqc,eqd,eqdj->eqcj", along, along, motions)
    forces = np.zeros((len(mesh.points), 2, 3))
    np.add.at(forces, edges, np.einsum("qa,eq,eqcj->eacj", shape, length, sheared))
    return forces.reshape(-1, 3)


def rim_ratio(gear: Gear, inner_radius: float) -> float:
    """s_R/h_t: the rim from the root circle down to a radius (mm), or to the keyway if that is the bore, over tooth depth."""
    opening = gear.body.opening_diameter / 2 if abs(inner_radius - gear.body.bore / 2) < _SAME else inner_radius
    return (gear.root_diameter / 2 - opening) / ((gear.tip_diameter - gear.root_diameter) / 2)


def support_of(
    gear: Gear, inner_radius: float, hold: Hold = Hold.AUTO, shaft: Material | None = None, shaft_bore: float = 0.0
) -> Support:
    """What holds a gear at `inner_radius` (mm). Raises GeometryError if there is no keyway, or no room for the shaft's bore."""
    if hold is Hold.AUTO:
        thin = Hold.KEY if gear.body.keyway_width else Hold.FREE
        hold = Hold.RIGID if rim_ratio(gear, inner_radius) >= LEAST_RIM else thin
    if hold is Hold.KEY and not gear.body.keyway_width:
        raise GeometryError("body.keyway_width", 0.0, "must be given where the key holds the bore", "mm")
    if hold is Hold.SHAFT and shaft_bore > _THINNEST_SHAFT * 2 * inner_radius:
        most = format_number(_THINNEST_SHAFT * 2 * inner_radius)
        raise GeometryError("shaft_bore", shaft_bore, f"must be at most {most} mm ({_THINNEST_SHAFT} of the gear's bore)", "mm")
    key = math.asin(min(1.0, gear.body.keyway_width / 2 / inner_radius))
    return Support(hold, gear.teeth, shaft or Material(), shaft_bore, key)
