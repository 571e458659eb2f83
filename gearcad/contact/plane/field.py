"""Stresses anywhere in the teeth at one position of the mesh: elements for the body, strips of pressure for the contact.

What the elements carry is smooth: it is averaged at the nodes and interpolated. What the pressures do is added point by point
in closed form, as if the flank were its tangent plane. So the zone of contact, smaller than an element, is resolved.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats, Wholes
from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact, PlanePosition
from gearcad.contact.plane.flank import PlaneCompliance, near_elements
from gearcad.contact.plane.subsurface import strip_stresses, von_mises
from gearcad.contact.shared.engaged import TOOTH_ORDER
from gearcad.meshing.section.outline import Side
from gearcad.meshing.section.shapes import triangle_shapes, triangle_slopes
from gearcad.per_gear import Role

__all__ = ["ToothField", "contact_frame", "tooth_field"]


_CORNERS = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
"""The nodes of a triangle in its own coordinates."""

_INSIDE = (Side.AHEAD, Side.HELD, Side.BEHIND)
"""Sides of a sector that are no profile."""

_MIRRORED = np.array([1.0, -1.0])
"""Columns of a matrix that is to turn the mirror image of what it is given."""

_COARSE, _FINE = 2, 16
"""Parts of an element's edge between points of the field, away from the contact and near it."""

_NEAR = 5.0
"""Half widths around a contact within which it is near."""


@dataclass(frozen=True)
class ToothField:
    """Von Mises stress (MPa) at `points` (n, 2) in mm of one tooth and its share of the body; `triangles` (m, 3) join them.

    `outline` (k, 2) is the profile from one root to the other. The pinion's axis is the origin, the wheel's lies on the x axis
    at the centre distance; the teeth stand as before they bend.
    """

    points: Floats
    triangles: Wholes
    von_mises: Floats
    outline: Floats


def contact_frame(cycle: PlaneCycle, contact: PlanePairContact) -> tuple[Floats, Floats]:
    """Centre of a contact (mm) in the frame of the field; directions to the pinion's tip and into the wheel, as columns."""
    model = cycle.model
    angle = np.radians(model.pair.working_transverse_pressure_angle)
    beside, along = np.array([np.cos(angle), -np.sin(angle)]), np.array([np.sin(angle), np.cos(angle)])
    cells = contact.pair.cells
    place = float((cells.place * contact.pressures).sum() / contact.pressures.sum())
    centre: Floats = (model.base_radius + place) * beside + contact.place * along
    return centre, np.stack([beside, along], -1)


def tooth_field(cycle: PlaneCycle, position: PlanePosition, role: Role, tooth: int) -> ToothField:
    """The field in a tooth of a gear, counted like the pairs of teeth in contact.

    Loads on teeth further away than the model's neighbours are left out.
    """
    body = cycle.model.bodies.pick(role)
    mesh = body.ring.sector.mesh
    own = next((contact for contact in position.contacts if contact.tooth == tooth), None)
    smooth = _smooth_stresses(body, position, role, tooth, own)
    finely = np.zeros(len(mesh.triangles), bool) if own is None else _near_contact(body, own, role)
    points, stresses, triangles, count = [], [], [], 0
    for elements, parts in ((mesh.triangles[~finely], _COARSE), (mesh.triangles[finely], _FINE)):
        local, split = _lattice(parts)
        shape = triangle_shapes(local)
        points.append(np.einsum("qa,eac->eqc", shape, mesh.points[elements]).reshape(-1, 2))
        stresses.append(np.einsum("qa,eas->eqs", shape, smooth[elements]).reshape(-1, 3))
        triangles.append((count + len(local) * np.arange(len(elements))[:, None, None] + split).reshape(-1, 3))
        count += len(points[-1])
    where, stress = np.concatenate(points), np.concatenate(stresses)
    if own is not None:
        stress = stress + _strips(body, own, role, where)
    turn, axis = _pose(cycle, position, role, tooth)
    profile = np.concatenate([nodes for side, nodes in mesh.sides.items() if side not in _INSIDE])
    outline = mesh.points[profile] @ turn.T + axis
    x, y, shear = np.moveaxis(stress, -1, 0)
    mises = von_mises(x, y, shear, body.elasticity)
    return ToothField(where @ turn.T + axis, np.concatenate(triangles), mises, outline)


def _pose(cycle: PlaneCycle, position: PlanePosition, role: Role, tooth: int) -> tuple[Floats, Floats]:
    """Turn (2, 2) and axis (2,) of a tooth: its flank touches on the line of action, where its normal lies along that line.

    A ring's is mirrored back first, as the model sees it mirrored.
    """
    model = cycle.model
    lengths = model.line.lengths(model.roll_length(position.roll_angle) + tooth * model.line.pitch)
    heading = model.bodies.pick(role).flank.heading(np.asarray(lengths.pick(role)))
    opposite, away = (0.0, 0.0) if role is Role.PINION else (np.pi, model.pair.centre_distance)
    along = np.radians(model.pair.working_transverse_pressure_angle)
    if role is Role.WHEEL and model.pair.internal:
        return _turn(heading - along) * _MIRRORED, np.array([away, 0.0])
    return _turn(opposite - along - heading), np.array([away, 0.0])


def _turn(angle: Floats) -> Floats:
    """Matrix (2, 2) that turns by an angle (rad)."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _smooth_stresses(
    body: PlaneCompliance, position: PlanePosition, role: Role, tooth: int, own: PlanePairContact | None
) -> Floats:
    """Stresses (n, 3) - xx, yy, xy - at the nodes of a tooth in its frame, less those of the strips."""
    mesh = body.ring.sector.mesh
    smooth, singular = np.zeros((2, 2 * len(mesh.points)))
    for contact in position.contacts:
        apart = TOOTH_ORDER.pick(role) * (tooth - contact.tooth)
        if abs(apart) <= body.neighbours:
            smooth += _at_length(body, body.displacements[body.neighbours + apart], contact.centre(role)) * contact.force
        if apart == 0:
            singular += _at_length(body, body.singular, contact.centre(role)) * contact.force
    near = np.zeros(len(mesh.triangles), bool)
    near[near_elements(body.flank.gear, mesh)] = True
    stress = np.empty((len(mesh.triangles), 6, 3))
    stress[near] = _element_stresses(body, mesh.triangles[near], smooth)
    # Beyond, Flamant's field was not taken off: there the strips are, so that both can be averaged where they meet.
    stress[~near] = _element_stresses(body, mesh.triangles[~near], smooth + singular)
    if own is not None:
        stress[~near] -= _strips(body, own, role, mesh.points)[mesh.triangles[~near]]
    total, times = np.zeros((len(mesh.points), 3)), np.zeros(len(mesh.points))
    np.add.at(total, mesh.triangles, stress)
    np.add.at(times, mesh.triangles, 1.0)
    result: Floats = total / times[:, None]
    return result


def _at_length(body: PlaneCompliance, columns: Floats, length: float) -> Floats:
    """Responses to the unit loads, interpolated to a roll length (mm), no nearer to the tip corner than the last of them."""
    result: Floats = columns @ body.between_loads(np.clip(length, body.loads[0], body.loads[-1]))
    return result


def _element_stresses(body: PlaneCompliance, triangles: Wholes, moved: Floats) -> Floats:
    """Stresses (m, 6, 3) at the nodes of the elements by displacements of all nodes."""
    corners = body.ring.sector.mesh.points[triangles]
    slopes = triangle_slopes(_CORNERS)
    jacobian = np.einsum("qad,eac->eqdc", slopes, corners)
    gradient = np.linalg.solve(jacobian, np.einsum("qad,eac->eqdc", slopes, moved.reshape(-1, 2)[triangles]))
    lame, shear = body.elasticity.lame
    spread = lame * (gradient[..., 0, 0] + gradient[..., 1, 1])
    across, up = (spread + 2 * shear * gradient[..., axis, axis] for axis in (0, 1))
    return np.stack([across, up, shear * (gradient[..., 0, 1] + gradient[..., 1, 0])], -1)


def _strips(body: PlaneCompliance, contact: PlanePairContact, role: Role, points: Floats) -> Floats:
    """Stresses (..., 3) - xx, yy, xy - at points of the tooth's frame (mm) by the pressures of its contact."""
    cells = contact.pair.cells
    touch = contact.pair.lengths.pick(role)
    inward = body.flank.inward(np.array(touch))
    up = body.flank.upward * np.array([-inward[1], inward[0]])  # along the flank, towards the tip
    away = points - body.flank.points(touch)
    places = TOOTH_ORDER.pick(role) * cells.place  # the tangent points to the other tip
    across, down, shear = strip_stresses(away @ up, away @ inward, places, cells.width, contact.pressures)
    frame = np.stack([up, inward], -1)
    local = np.stack([np.stack([across, shear], -1), np.stack([shear, down], -1)], -1)
    turned = frame @ local @ frame.T
    return np.stack([turned[..., 0, 0], turned[..., 1, 1], turned[..., 0, 1]], -1)


def _near_contact(body: PlaneCompliance, contact: PlanePairContact, role: Role) -> NDArray[np.bool_]:
    """Elements that a circle around the contact reaches: their own circles meet it."""
    mesh = body.ring.sector.mesh
    corners = mesh.points[mesh.triangles[:, :3]]
    middle = corners.mean(axis=1)
    size = np.hypot(*np.moveaxis(corners - middle[:, None], -1, 0)).max(axis=1)
    centre = body.flank.points(contact.centre(role))
    near: NDArray[np.bool_] = np.hypot(*(middle - centre).T) < size + _NEAR * contact.hertz_half_width
    return near


def _lattice(parts: int) -> tuple[Floats, Wholes]:
    """Points (n, 2) that divide the edges of a triangle into parts, and the small triangles (parts^2, 3) between them."""
    number = {(i, j): 0 for j in range(parts + 1) for i in range(parts + 1 - j)}
    number = {place: index for index, place in enumerate(number)}
    upright = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in number if i + j < parts]
    inverted = [(number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]) for i, j in number if i + j < parts - 1]
    return np.array(list(number)) / parts, np.array(upright + inverted)
