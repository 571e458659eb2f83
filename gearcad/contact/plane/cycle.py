"""PlaneCycle: contact of plane gears over a base pitch, the limits of the model, and stresses anywhere in the teeth.

A tooth that is thinner along the axis than across is free to swell: solid bodies show plane stress there, but plane strain in
the contact, which is narrow against any face width.

What the elements carry is smooth: it is averaged at the nodes and interpolated. What the pressures do is added point by point
in closed form, as if the flank were its tangent plane. So the zone of contact, smaller than an element, is resolved.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gearcad.contact.plane.flank import PlaneCompliance, ToothLoad, seen_from
from gearcad.contact.plane.pair import ContactPair, ContactSolution, PlanePair
from gearcad.contact.plane.sector import Plane, PlaneElasticity
from gearcad.contact.shared.line_of_action import overlap
from gearcad.contact.shared.loaded import FAIR, INTERIOR, TOOTH_ORDER, LoadedCycle, LoadedPosition, PairContact, RootStress
from gearcad.contact.shared.local_contact import HollowContact, conformal_notices, onsets, start_distance
from gearcad.core.records import Floats, Notice, PerGear, Role, Wholes
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.geometry.tooth_friction import sliding_levers
from gearcad.material import Materials, of_both
from gearcad.meshing.fem import field_gradients, node_places, shape_values
from gearcad.meshing.outline import OutlineSide
from gearcad.rating.contact_stress import half_width_by_curvature

_RESOLVED = 4
"""Cells over a transition with which its pressure is right within 0.25 %."""


@dataclass(frozen=True)
class PlanePairContact(PairContact):
    """One pair of flanks in contact: what it carries, and the comparison with two cylinders under the same load.

    Pressures in MPa, half widths in mm, `force` in N per mm. `interior` is False where the edge of a flank or the start of a
    linear relief is near. `even_distance` (mm) is that from a parabolic relief, `start_distances` those from the transitions of
    each gear's linear reliefs, `start_pressures` the greatest (MPa) near these, NaN where none is told.
    `bent` (1/mm) is what the flanks' relative curvature gains there as the bodies give way.
    """

    pair: ContactPair
    pressures: Floats
    force: float
    share: float
    modulus: float
    edge_distance: float
    even_distance: float
    start_distances: PerGear[float]
    start_pressures: PerGear[float]
    bent: float

    @property
    def tooth(self) -> int:
        """Tooth of the pinion, 0 is the middle one."""
        return self.pair.tooth

    @property
    def place(self) -> float:
        """Roll length (mm) of the pinion's flank: where the pair touches on the line of action, from T1."""
        return self.pair.lengths.pinion

    @property
    def edge(self) -> bool:
        """True if the edge of a tip touches, beyond the end of an involute."""
        return self.edge_distance < 0

    @property
    def arms(self) -> PerGear[float]:
        """Lever arms of the force on both gears, over their base radii: the mean of the cells by their pressures."""
        if self.pair.edges is None:
            return PerGear(1.0, 1.0)
        # What they have beyond 1 is averaged: a gear on whose flank the force is normal has an arm of 1 to the last digit.
        return self._mean(self.pair.edges.arms.map(lambda arms: arms - 1)).map(lambda beyond: 1 + beyond)

    @property
    def tilts(self) -> PerGear[float]:
        """Angles (rad) from the normal of each gear's flank to the force on it."""
        return PerGear(0.0, 0.0) if self.pair.edges is None else self._mean(self.pair.edges.tilts)

    def _mean(self, values: PerGear[Floats]) -> PerGear[float]:
        return values.map(lambda of: float(of @ self.pressures / self.pressures.sum()))

    @property
    def lever_arms(self) -> PerGear[float]:
        """Lever arms of the force and its friction together, over the base radii."""
        levers = zip(self.arms, self.pair.friction_levers, strict=True)
        return PerGear(*(arm + self.pair.friction * lever for arm, lever in levers))

    @property
    def peak_pressure(self) -> float:
        """Greatest cell pressure."""
        return float(self.pressures.max())

    @property
    def hertz_half_width(self) -> float:
        """Half width of the contact by Hertz: a = sqrt(4 F rho/(pi E*))."""
        return half_width_by_curvature(self.force, 1 / self.pair.radius + self.bent, self.modulus)

    @property
    def hertz_pressure(self) -> float:
        """Greatest pressure by Hertz: p0 = 2 F/(pi a)."""
        return 2 * self.force / (math.pi * self.hertz_half_width)

    @property
    def interior(self) -> bool:
        """True where the ends of both flanks and the starts of their linear reliefs are some half widths away."""
        return min(self.edge_distance, *self.start_distances) > _reach(self.pair, self.force, self.modulus)

    @property
    def two_cylinders(self) -> bool:
        """True where no parabolic relief is near either, along which the curvature changes."""
        return self.interior and self.even_distance > INTERIOR * self.hertz_half_width

    @property
    def interior_pressure(self) -> float | None:
        """The greatest cell pressure; None near an edge of a flank."""
        return self.peak_pressure if self.interior else None

    @cached_property
    def half_width(self) -> float:
        """Half width by a fit of p^2 over x^2 in the loaded cells: counting cells would be quantised.

        NaN where too few cells are loaded, or their pressures have no such shape.
        """
        loaded = self.pressures > 0.5 * self.peak_pressure
        x, squared = self.pair.cells.place[loaded], self.pressures[loaded] ** 2
        if len(x) < 4:
            return math.nan
        middle, scale = x.mean(), np.ptp(x)
        two, one, zero = np.polyfit((x - middle) / scale, squared, 2)
        inside = one**2 - 4 * two * zero
        return float(scale * math.sqrt(inside) / (2 * abs(two))) if two < 0 < inside else math.nan

    def centre(self, role: Role) -> float:
        """Return the roll length (mm) at the centre of pressure on a gear's flank."""
        return float((self.pair.cells.lengths.pick(role) * self.pressures).sum() / self.pressures.sum())


@dataclass(frozen=True)
class PlanePosition(LoadedPosition[PlanePairContact]):
    """One position of two sections."""

    @property
    def interior_contacts(self) -> tuple[PlanePairContact, ...]:
        """Contacts away from the ends of the flanks that carry a fair share."""
        return tuple(contact for contact in self.contacts if contact.interior and contact.share > FAIR)


@dataclass(frozen=True)
class PlaneCycle(LoadedCycle[PlanePair, PlanePosition, PlanePairContact]):
    """Two sections over one base pitch; forces, stiffness and pressures are those of the common face width, all alike."""

    def solve(self, angle: float) -> PlanePosition:
        """Return the position at a roll angle (deg). Raises SolverError."""
        model, solution = self.model, self.model.solve(angle, self.torque)
        contacts = _contacts(model, solution)
        loads = PerGear.each(lambda role: tooth_loads(contacts, role))

        def extreme(side: OutlineSide) -> PerGear[RootStress]:
            return PerGear.each(lambda role: model.fillets.pick(role).extreme(side, loads.pick(role)))

        return PlanePosition(
            roll_angle=angle,
            approach=solution.approach,
            approach_parts=solution.parts,
            rigid_approach=model.rigid_approach(angle),
            force=model.force(self.torque),
            contacts=contacts,
            tension=extreme(OutlineSide.LEFT_FILLET),
            compression=extreme(OutlineSide.RIGHT_FILLET),
            bore_tension=PerGear.each(lambda role: model.fillets.pick(role).bore_tension(loads.pick(role))),
            torques=PerGear.each(lambda role: _hub_torque(model, contacts, role)),
            lost_torque=sum(_loss(model, contact) for contact in contacts) * model.width / 1000,
        )

    def contacts_at(self, angle: float) -> tuple[PlanePairContact, ...]:
        """Return the contacts alone at a roll angle (deg). Raises SolverError."""
        return _contacts(self.model, self.model.solve(angle, self.torque))


def tooth_loads(contacts: tuple[PlanePairContact, ...], role: Role) -> list[ToothLoad]:
    """Return the loads on the teeth of a gear, counted as its own teeth follow each other."""
    sense = TOOTH_ORDER.pick(role)
    return [
        ToothLoad(
            sense * contact.tooth,
            contact.centre(role),
            contact.force,
            contact.arms.pick(role),
            contact.tilts.pick(role),
            contact.pair.friction,
        )
        for contact in contacts
    ]


def root_loads(contacts: tuple[PlanePairContact, ...], role: Role) -> list[list[ToothLoad]]:
    """Return, for each tooth in contact, the loads on the gear as seen from that tooth."""
    loads = tooth_loads(contacts, role)
    return [seen_from(load.tooth, loads) for load in loads]


def _hub_torque(model: PlanePair, contacts: tuple[PlanePairContact, ...], role: Role) -> float:
    """Return the torque (N·m) that the loads put on a gear's hub."""
    body = model.bodies.pick(role)
    each = (body.hub_torque(of.centre(role)) * (of.force * of.arms.pick(role)) for of in contacts)
    rubbed = sum(
        model.fillets.pick(role).friction_torque(of.centre(role)) * (of.force * of.pair.friction)
        for of in contacts
        if of.pair.friction
    )
    return (sum(each) + rubbed) * model.width / 1000


def _loss(model: PlanePair, contact: PlanePairContact) -> float:
    """Return the power that friction takes over the angular speed of the pinion (N mm per mm of width)."""
    if not contact.pair.friction:
        return 0.0
    return contact.force * abs(contact.pair.friction) * float(sliding_levers(model.gear_pair, contact.place))


def _contacts(model: PlanePair, solution: ContactSolution) -> tuple[PlanePairContact, ...]:
    loaded = [
        (pair, pressures, float(force))
        for pair, pressures, force in zip(solution.pairs, solution.pressures, solution.forces, strict=True)
        if force > 0
    ]
    total = float(solution.forces.sum())
    return tuple(
        PlanePairContact(
            pair,
            pressures,
            force,
            force / total,
            model.modulus,
            _distance(model, pair, even=False),
            _distance(model, pair, even=True),
            to_starts := _start_distances(model, pair),
            _start_pressures(model, pair, pressures, to_starts),
            _bent(model, loaded, place),
        )
        for place, (pair, pressures, force) in enumerate(loaded)
    )


def _bent(model: PlanePair, loaded: list[tuple[ContactPair, Floats, float]], place: int) -> float:
    """Curvature (1/mm) of the gap of one pair of flanks by the smooth response of the bodies to the loads of all."""
    pair, pressures, force = loaded[place]
    half = half_width_by_curvature(force, 1 / pair.radius, model.modulus)
    if not math.isfinite(half):
        return 0.0
    order = np.argsort(pair.cells.place)
    middle = float((pair.cells.place * pressures).sum() / pressures.sum())
    total = 0.0
    for role, body in model.bodies.items():
        lengths = pair.cells.lengths.pick(role)
        around = np.interp(middle + half * np.array([-1.0, 0.0, 1.0]), pair.cells.place[order], lengths[order])
        before, here, behind = body.by_unit_loads(around)
        bends = (before - 2 * here + behind) / half**2
        centres = [other.cells.lengths.pick(role) @ carried / carried.sum() for other, carried, _ in loaded]
        for (other, _, load), parts in zip(loaded, body.parts_of_loads(np.array(centres)), strict=True):
            apart = TOOTH_ORDER.pick(role) * (pair.tooth - other.tooth)
            if abs(apart) <= body.neighbours:
                total += load * float(bends[apart + body.neighbours] @ parts)
    return total


def _distance(model: PlanePair, pair: ContactPair, *, even: bool) -> float:
    """Return the distance (mm along the tangent) to the nearest end of an involute, negative beyond it.

    With `even` it is the distance to the end of the even part.
    """
    distances: list[float] = []
    for flank, length in zip(model.line.flanks, pair.lengths, strict=True):
        first, last = flank.even if even else (flank.first, flank.last)
        distances += (flank.along_tangent(length, last), -flank.along_tangent(length, first))
    return min(distances)


def _start_distances(model: PlanePair, pair: ContactPair) -> PerGear[float]:
    """Return the distance (mm along the tangent) to the nearest transition of a linear relief of each gear, as
    `start_distance`.

    It is infinite for a gear without one.
    """
    found = []
    for flank, length in zip(model.line.flanks, pair.lengths, strict=True):
        every = (start_distance(flank.base_radius, of, np.array(length), pair.plain_radius) for of in onsets(flank))
        found.append(min(map(float, every), default=math.inf))
    return PerGear(*found)


def _reach(pair: ContactPair, force: float, modulus: float) -> float:
    """Return the distance (mm) from edges and starts of reliefs beyond which a contact is that of two cylinders."""
    return INTERIOR * half_width_by_curvature(force, 1 / pair.plain_radius, modulus)


def _start_pressures(model: PlanePair, pair: ContactPair, pressures: Floats, to_starts: PerGear[float]) -> PerGear[float]:
    """Return the greatest pressures (MPa) near the starts of each gear's reliefs; NaN where cells are too wide for a
    transition, or an end of a flank lies in the contact.
    """
    cells, (low, high) = pair.cells, overlap(model.line, pair.lengths.pinion)
    pressed = cells.place[pressures > 0]
    shortest = min((onset.length for flank in model.line.flanks for onset in onsets(flank)), default=math.inf)
    narrow = cells.width <= shortest / _RESOLVED
    sound = narrow and low + cells.width < pressed.min() and pressed.max() < high - cells.width
    reach, peak = _reach(pair, float(pressures.sum() * cells.width), model.modulus), float(pressures.max())
    return to_starts.map(lambda to: peak if sound and to < reach else math.nan)


def conformal(contact: PlanePairContact) -> bool:
    """Return whether a contact in a hollow flank is too wide to be treated as that of two cylinders."""
    return not contact.pair.flat and contact.pair.lengths.wheel < 0 and _hollow(contact).conformal


def wide_plane_contacts(cycle: PlaneCycle) -> Iterator[Notice]:
    """Yield a notice for a ring whose contact is conformal."""
    pair = cycle.model.pair
    if isinstance(pair, GearPair) and pair.internal:
        yield from conformal_notices(_hollow(contact) for _, contact in cycle.interior_contacts)


def _hollow(contact: PlanePairContact) -> HollowContact:
    return HollowContact(contact.hertz_half_width, contact.pair.lengths.pinion)


def thin_faces(pair: GearPair | RackPair, material: Materials, plane: Plane) -> Iterator[Notice]:
    """Yield a notice for each gear that is too thin for plane strain."""
    if plane is Plane.STRESS:
        return
    mate: Gear | Rack = pair.rack if isinstance(pair, RackPair) else pair.wheel
    for role, gear in PerGear[Gear | Rack](pair.pinion, mate).items():
        stiffer = 100 * of_both(material).pick(role).poisson_ratio ** 2
        width, thickness = gear.face_width, gear.transverse_tooth_thickness
        if width < thickness:
            name = "rack" if isinstance(gear, Rack) else role.value
            text = (
                f"the {name}'s face width of {width:.4g} mm is below its tooth thickness, {thickness:.4g} mm: so thin a "
                "body is nearer to plane stress than to plane strain, which "
                f"makes it up to {stiffer:.2g} % too stiff; plane stress or solid bodies (3d) show it"
            )
            yield Notice("thin-face", text)


def plane_pressure(material: Materials, plane: Plane) -> Iterator[Notice]:
    """Yield a notice in plane stress: by how much (%) the pressure of the contact, in plane strain, is higher."""
    if plane is Plane.STRAIN:
        return
    higher = 100 * (1 / math.sqrt(1 - max(of.poisson_ratio for of in of_both(material)) ** 2) - 1)
    text = f"plane stress: the contact itself stays in plane strain, where its pressure is up to {higher:.2g} % higher"
    yield Notice("plane-stress-pressure", text)


def strip_stresses(x: Floats, depth: Floats, places: Floats, width: float, pressures: Floats) -> tuple[Floats, Floats, Floats]:
    """Return sigma_x, sigma_z and tau_xz (MPa) at points (x, depth) below strips of `width` (mm) centred on `places`."""
    right, left, z = x[..., None] - places + width / 2, x[..., None] - places - width / 2, depth[..., None]
    to_right, to_left = (np.maximum(end**2 + z**2, np.finfo(float).tiny) for end in (right, left))
    scale = pressures / np.pi
    # From the angles at which both ends of a strip are seen: their difference, and those of their sines and cosines, doubled.
    turned = np.arctan2(z * width, right * left + z**2) @ scale
    sines = (z * (left / to_left - right / to_right)) @ scale
    shear: Floats = (z**2 * (1 / to_right - 1 / to_left)) @ scale
    return -(turned + sines), -(turned - sines), shear


def von_mises(x: Floats, y: Floats, shear: Floats, elasticity: PlaneElasticity) -> Floats:
    """Von Mises stress (...,) in MPa of a plane state; along the axis there is nu (x + y) in plane strain, else nothing."""
    along = elasticity.material.poisson_ratio * (x + y) if elasticity.plane is Plane.STRAIN else np.zeros_like(x)
    result: Floats = np.sqrt(((x - y) ** 2 + (y - along) ** 2 + (along - x) ** 2) / 2 + 3 * shear**2)
    return result


def greatest_von_mises(
    places: Floats, width: float, pressures: Floats, half_width: float, elasticity: PlaneElasticity
) -> tuple[float, float]:
    """Return the greatest von Mises stress (MPa) below a contact, and its depth (mm)."""
    middle = float((places * pressures).sum() / pressures.sum())
    x, depth = np.meshgrid(
        middle + half_width * np.linspace(-1.2, 1.2, 49), half_width * np.linspace(0.05, 2.0, 79), indexing="ij"
    )
    across, down, shear = strip_stresses(x, depth, places, width, pressures)
    mises = von_mises(across, down, shear, elasticity)
    at = np.unravel_index(np.argmax(mises), mises.shape)
    return float(mises[at]), float(depth[at])


_INSIDE = (OutlineSide.AHEAD, OutlineSide.HELD, OutlineSide.BEHIND)
"""Sides of a sector that are no profile."""

_MIRRORED = np.array([1.0, -1.0])
"""Columns of a matrix that turn a vector into its mirror image."""

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
    """Return the centre of a contact (mm) in the frame of the field; directions to the pinion's tip and into the wheel, as
    columns.
    """
    model = cycle.model
    angle = np.radians(model.pair.working_transverse_pressure_angle)
    beside, along = np.array([np.cos(angle), -np.sin(angle)]), np.array([np.sin(angle), np.cos(angle)])
    cells = contact.pair.cells
    place = float((cells.place * contact.pressures).sum() / contact.pressures.sum())
    centre: Floats = (model.base_radius + place) * beside + contact.place * along
    return centre, np.stack([beside, along], -1)


def tooth_field(cycle: PlaneCycle, position: PlanePosition, role: Role, tooth: int) -> ToothField:
    """Return the field in a tooth of a gear, counted like the pairs of teeth in contact.

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
        shape = shape_values("tri6", local)
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
    along, pair = np.radians(model.pair.working_transverse_pressure_angle), model.pair
    if role is Role.PINION:
        return _turn(-along - heading), np.zeros(2)
    if isinstance(pair, RackPair):
        return _turn(np.array(np.pi)), np.array([pair.mounting_distance, _moved_rack(cycle, lengths.wheel)])
    if pair.internal:
        return _turn(heading - along) * _MIRRORED, np.array([pair.centre_distance, 0.0])
    return _turn(np.pi - along - heading), np.array([pair.centre_distance, 0.0])


def _moved_rack(cycle: PlaneCycle, length: float) -> float:
    """Return where along y (mm) the middle of a rack's tooth is that touches at a place of its flank (mm)."""
    model = cycle.model
    angle = np.radians(model.pair.working_transverse_pressure_angle)
    _, half = model.wheel.flank.points(length)
    along = model.line.whole - length  # from T1 on the line of action
    return float(-model.base_radius * np.sin(angle) + along * np.cos(angle) + half)


def _turn(angle: Floats) -> Floats:
    """Return the matrix (2, 2) that turns by an angle (rad)."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _smooth_stresses(
    body: PlaneCompliance, position: PlanePosition, role: Role, tooth: int, own: PlanePairContact | None
) -> Floats:
    """Return the stresses (n, 3) - xx, yy, xy - at the nodes of a tooth in its frame, less those of the strips."""
    mesh = body.ring.sector.mesh
    smooth, singular = np.zeros((2, 2 * len(mesh.points)))
    for contact in position.contacts:
        apart = TOOTH_ORDER.pick(role) * (tooth - contact.tooth)
        if abs(apart) <= body.neighbours:
            smooth += _at_length(body, body.displacements[body.neighbours + apart], contact.centre(role)) * contact.force
        if apart == 0:
            singular += _at_length(body, body.singular, contact.centre(role)) * contact.force
    near = np.zeros(len(mesh.triangles), bool)
    near[body.flank.near_elements(mesh)] = True
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
    """Return the stresses (m, 6, 3) at the nodes of the elements by displacements of all nodes."""
    corners = body.ring.sector.mesh.points[triangles]
    gradient = field_gradients("tri6", corners, moved.reshape(-1, 2)[triangles], node_places("tri6"))
    lame, shear = body.elasticity.lame
    spread = lame * (gradient[..., 0, 0] + gradient[..., 1, 1])
    across, up = (spread + 2 * shear * gradient[..., axis, axis] for axis in (0, 1))
    return np.stack([across, up, shear * (gradient[..., 0, 1] + gradient[..., 1, 0])], -1)


def _strips(body: PlaneCompliance, contact: PlanePairContact, role: Role, points: Floats) -> Floats:
    """Return the stresses (..., 3) - xx, yy, xy - at points of the tooth's frame (mm) by the pressures of its contact."""
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
    """Return the elements that a circle around the contact reaches: their own circles meet it."""
    mesh = body.ring.sector.mesh
    corners = mesh.points[mesh.triangles[:, :3]]
    middle = corners.mean(axis=1)
    size = np.hypot(*np.moveaxis(corners - middle[:, None], -1, 0)).max(axis=1)
    centre = body.flank.points(contact.centre(role))
    near: NDArray[np.bool_] = np.hypot(*(middle - centre).T) < size + _NEAR * contact.hertz_half_width
    return near


def _lattice(parts: int) -> tuple[Floats, Wholes]:
    """Return the points (n, 2) that divide the edges of a triangle into parts, and the small triangles (parts^2, 3) between
    them.
    """
    number = {(i, j): 0 for j in range(parts + 1) for i in range(parts + 1 - j)}
    number = {place: index for index, place in enumerate(number)}
    upright = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in number if i + j < parts]
    inverted = [(number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]) for i, j in number if i + j < parts - 1]
    return np.array(list(number)) / parts, np.array(upright + inverted)
