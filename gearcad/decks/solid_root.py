"""Root stress of a solid tooth by displacements of its nodes, as our own check has it: by strains of the fillet's surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.shared.loaded import LEAST_TANGENT_ANGLE
from gearcad.material import Material
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.bodies.interpolation import shape_slopes, shape_values
from gearcad.meshing.section.shapes import GAUSS

__all__ = ["Fillet", "root_tension"]


@dataclass(frozen=True)
class Fillet:
    """A fillet over the whole face of a posed body of hexahedra. The middle of its tooth is at the angle `turn` (rad) about the
    gear's axis where the gear begins, and turns by `rate` (rad/mm). `upward` is 1, or -1 for a ring's tooth, which points
    inwards.
    """

    mesh: ElementMesh
    name: str
    turn: float
    rate: float
    upward: int = 1


def root_tension(fillet: Fillet, moved: Floats, material: Material) -> float:
    """Greatest principal tension (MPa) of a fillet by displacements (n, 3) in mm of the nodes of its mesh.

    Half-way along each edge of the profile, at the Gauss points over the face; from a tangent angle on, as our own check.
    """
    nodes = fillet.mesh.face_cells(fillet.name)
    lowest = float(fillet.mesh.points[nodes, 2].min())
    face, places = fillet.mesh.element.shape.face, np.array([[0.0, -GAUSS], [0.0, GAUSS]])
    heights = np.einsum("qa,na->qn", shape_values(face, places), fillet.mesh.points[nodes, 2]).ravel() - lowest
    by_place = shape_slopes(face, places)
    bases, slopes = (np.einsum("qda,nac->dqnc", by_place, of[nodes]).reshape(2, -1, 3) for of in (fillet.mesh.points, moved))
    at_root = _tangent_angles(fillet, bases[0], heights) >= LEAST_TANGENT_ANGLE
    return float(_greater(bases, slopes, material)[at_root].max())


def _tangent_angles(fillet: Fillet, along: Floats, z: Floats) -> Floats:
    """Angles (n,) in degrees between the profile's tangents (n, 3) at heights (n,) of the gear and the middle of the tooth."""
    own = (along[:, 0] + 1j * along[:, 1]) * np.exp(-1j * (fillet.turn + fillet.rate * z))
    result: Floats = np.degrees(np.arctan2(fillet.upward * own.imag, np.abs(own.real)))
    return result


def _greater(bases: Floats, slopes: Floats, material: Material) -> Floats:
    """Greater principal stresses (n,) in MPa of a free surface: `slopes` of displacements along `bases`, (2, n, 3) each."""
    length = np.linalg.norm(bases[0], axis=1)
    first = bases[0] / length[:, None]
    lean = (bases[1] * first).sum(1)
    upright = bases[1] - lean[:, None] * first
    height = np.linalg.norm(upright, axis=1)
    second = upright / height[:, None]
    by_first = slopes[0] / length[:, None]
    by_second = (slopes[1] - lean[:, None] * by_first) / height[:, None]
    along, axial = (by_first * first).sum(1), (by_second * second).sum(1)
    shear = (by_first * second).sum(1) + (by_second * first).sum(1)
    e, nu = material.youngs_modulus, material.poisson_ratio
    mean, apart = e / (1 - nu) * (along + axial) / 2, e / (1 + nu) * (along - axial) / 2
    result: Floats = mean + np.hypot(apart, e / (2 * (1 + nu)) * shear)
    return result
