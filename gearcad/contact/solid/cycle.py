"""SolidCycle: contact of solid gears over a base pitch, the limits of the model, and stresses of the most stressed tooth.

Near the lines of contact, within an element of them, the field is not resolved: there Hertz's formulas hold instead.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property
from pathlib import Path

import numpy as np

from gearcad.contact.shared.loaded import FAIR, INTERIOR, TOOTH_ORDER, LoadedCycle, LoadedPosition, PairContact, RootStress
from gearcad.contact.shared.local_contact import HollowContact, conformal_notices, onsets
from gearcad.contact.solid.elements import lame
from gearcad.contact.solid.flank import SolidCompliance, ToothForces
from gearcad.contact.solid.line_contact import ContactLine, LineSolution, plain_widths, start_distances
from gearcad.contact.solid.pair import SolidPair
from gearcad.contact.solid.root import FilletState, SolidFillet
from gearcad.core.records import Bools, Floats, Notice, PerGear, Role, Wholes
from gearcad.geometry.tooth_friction import sliding_levers
from gearcad.material import Material
from gearcad.meshing.bodies.element_mesh import vtk_elements
from gearcad.meshing.fem import BY_LEVELS, SWEPT, Element, field_gradients, node_places, quadrature, shape_values
from gearcad.meshing.files import write_vtu


@dataclass(frozen=True)
class SolidPairContact(PairContact):
    """One pair of teeth in contact, `force` (N): per cell of its line (n,) forces in N, half widths in mm, pressures in MPa.

    `margin` (n,) in mm is by how much a cell is further than INTERIOR half widths of the plain flanks from all edges of both
    flanks and from the transitions of linear reliefs: where it is not positive the pressure depends on these. `start_pressures`
    are the greatest (MPa) at the starts of each gear's linear reliefs, NaN where none is told; `edge_pressure` (MPa) is the
    greatest beside edges of the flanks.
    """

    line: ContactLine
    forces: Floats
    half_widths: Floats
    pressures: Floats
    radii: Floats
    margin: Floats
    start_pressures: PerGear[float]
    edge_pressure: float
    force: float
    share: float

    @property
    def tooth(self) -> int:
        """Tooth of the pinion, 0 is the middle one."""
        return self.line.tooth

    @property
    def place(self) -> float:
        """Place (mm from T1) where the line crosses the middle of the common face width."""
        return self.line.middle

    @property
    def line_loads(self) -> Floats:
        """Normal load per length of the line (n,) in N/mm."""
        result: Floats = self.forces / self.line.lengths
        return result

    @property
    def edge(self) -> bool:
        """True if the edge of a tip carries load."""
        return bool((self.line.on_edge & (self.forces > 0)).any())

    @property
    def arms(self) -> PerGear[float]:
        """Lever arms of the force on both gears, over their base radii: the mean of the cells by their forces."""
        return self.line.edges.arms.map(lambda arms: float((self.forces * arms).sum() / self.forces.sum()))

    @property
    def lever_arms(self) -> PerGear[float]:
        """Lever arms of the force and its friction together, over the base radii, as `arms`."""
        levers = zip(self.line.edges.arms, self.line.friction_levers, strict=True)
        both = (np.asarray(arm + self.line.friction * lever) for arm, lever in levers)
        return PerGear(*(float((self.forces * arms).sum() / self.forces.sum()) for arms in both))

    @property
    def interior(self) -> Bools:
        """Cells (n,) that carry away from all edges."""
        result: Bools = (self.margin > 0) & (self.forces > 0)
        return result

    @cached_property
    def inside(self) -> Floats:
        """Places (m,) away from all edges, in cells: those of interior cells, and where the edges' reach ends beside them.

        With these the greatest values along a line do not depend on which cell happens to lie inside.
        """
        across = np.diff(self.line.across)
        joined = (self.forces[1:] > 0) & (self.forces[:-1] > 0) & (across < 1.5 * across.min(initial=math.inf))
        ends = np.flatnonzero(joined & ((self.margin[1:] > 0) != (self.margin[:-1] > 0)))
        here, there = self.margin[ends], self.margin[ends + 1]
        return np.sort(np.r_[np.flatnonzero(self.interior), ends + here / (here - there)])

    def between(self, values: Floats, place: float | Floats) -> Floats:
        """Return the values (n,) of the cells at places between them."""
        return np.asarray(np.interp(place, np.arange(len(values)), values))

    @property
    def peak_pressure(self) -> float:
        """Greatest pressure (MPa) away from all edges, NaN if no place is."""
        return float(self.between(self.pressures, self.inside).max()) if len(self.inside) else math.nan

    @property
    def interior_pressure(self) -> float | None:
        """Greatest pressure (MPa) away from all edges; None if no place is."""
        return self.peak_pressure if len(self.inside) else None

    @property
    def peak_line_load(self) -> float:
        """Greatest line load (N/mm) away from all edges, NaN if no place is."""
        return float(self.between(self.line_loads, self.inside).max()) if len(self.inside) else math.nan


@dataclass(frozen=True)
class SolidRootStress(RootStress):
    """Root stress with its height (mm), and the greatest along the profile (n,) at each of the fillet's `heights_between`
    (MPa).
    """

    height: float
    along_face: Floats


@dataclass(frozen=True)
class SolidPosition(LoadedPosition[SolidPairContact]):
    """A position of solid gears; the tension of a bore that is free is that below loaded teeth."""

    tension: PerGear[SolidRootStress]
    compression: PerGear[SolidRootStress]

    @property
    def interior_contacts(self) -> tuple[SolidPairContact, ...]:
        """Contacts with places away from all edges, if these places together carry a fair share of the load."""
        inside = sum(float(contact.forces[contact.interior].sum()) for contact in self.contacts)
        if inside <= FAIR * sum(contact.force for contact in self.contacts):
            return ()
        return tuple(contact for contact in self.contacts if len(contact.inside))

    @property
    def line_load(self) -> float:
        """Greatest line load (N/mm) of the interior contacts away from all edges, NaN if there are none."""
        return max((contact.peak_line_load for contact in self.interior_contacts), default=math.nan)


@dataclass(frozen=True)
class SolidCycle(LoadedCycle[SolidPair, SolidPosition, SolidPairContact]):
    """Solid gears over one base pitch: also how load and root stress are spread over the face width."""

    def solve(self, angle: float) -> SolidPosition:
        """Return the position at a roll angle (deg). Raises SolverError."""
        model, solution = self.model, self.model.solve(angle, self.torque)
        contacts, flat = _contacts(model, solution), math.cos(model.helix)
        loads = PerGear.each(lambda role: tooth_loads(model, contacts, role))
        return SolidPosition(
            roll_angle=angle,
            approach=solution.approach / flat,
            approach_parts=solution.parts.map(lambda part: part / flat),
            rigid_approach=solution.rigid / flat,
            force=model.force(self.torque),
            contacts=contacts,
            tension=PerGear.each(lambda role: _tension(model.fillets.pick(role).loaded, loads.pick(role))),
            compression=PerGear.each(lambda role: _compression(model.fillets.pick(role).behind, loads.pick(role))),
            bore_tension=PerGear.each(lambda role: _bore_tension(model.fillets.pick(role).bore, loads.pick(role))),
            torques=PerGear.each(lambda role: _hub_torque(model.bodies.pick(role), contacts, role)),
            support_approach=solution.by_supports / flat,
            support_turn=solution.turn_of_supports / flat,
            lost_torque=sum(_loss(model, contact) for contact in contacts) / 1000,
        )

    def contacts_at(self, angle: float) -> tuple[SolidPairContact, ...]:
        """Return the contacts alone at a roll angle (deg). Raises SolverError."""
        return _contacts(self.model, self.model.solve(angle, self.torque))

    @property
    def harmonics(self) -> Floats:
        """Amplitudes (µm) of the transmission error at the tooth frequency and its multiples."""
        error = self.values("transmission_error")
        spectrum = np.fft.rfft(error) / len(error)
        result: Floats = 2 * np.abs(spectrum[1 : (len(error) - 1) // 2 + 1])
        return result

    @cached_property
    def load_along_face(self) -> tuple[Floats, Floats]:
        """Places across the common width (n,) in mm from its middle, and the load per width there (n,) in N/mm, mean of the
        even positions: transverse normal force of all lines.
        """
        count, width = self.model.cells, self.model.width
        step = width / count
        total = np.zeros(count)
        for position in self.positions:
            for contact in position.contacts:
                cell = np.floor(contact.line.across / step + count / 2).astype(int)
                np.add.at(total, cell, contact.forces)
        edges = np.linspace(-width / 2, width / 2, count + 1)
        load: Floats = total * math.cos(self.model.helix) / step / len(self.positions)
        return (edges[1:] + edges[:-1]) / 2, load

    @property
    def face_load_factor(self) -> float:
        """K_H_beta: the greatest load per width over its mean, both of the whole cycle, away from the ends of the face width.

        There, where the end of one gear presses on the other's flank, an edge carries more whatever the gears' alignment.
        """
        across, load = self.load_along_face
        widest = max(contact.half_widths.max() for position in self.positions for contact in position.contacts)
        inside = np.abs(across) < self.model.width / 2 - min(INTERIOR * float(widest), self.model.width / 4)
        return float(load[inside].max() / load.mean())

    def root_along_face(self, role: Role) -> tuple[Floats, Floats]:
        """Return the heights (n,) in mm of a gear, and the greatest root tension of the cycle there (n,) in MPa."""
        fillet = self.model.fillets.pick(role).loaded
        stresses: Floats = np.array([position.tension.pick(role).along_face for position in self.every])
        return fillet.heights_between, stresses.max(axis=0)

    def root_face_load_factor(self, role: Role) -> float:
        """K_F_beta: the greatest root tension over its mean along the common face width."""
        heights, stress = self.root_along_face(role)
        low, high = self.model.common_heights(role)
        across = np.linspace(low, high, 201)
        within = np.interp(across, heights, stress)
        return float(within.max() / within.mean())


def tooth_loads(model: SolidPair, contacts: tuple[SolidPairContact, ...], role: Role) -> list[ToothForces]:
    """For each tooth of a gear in contact: its number, as the gear's own teeth follow each other, and the force (N) at each
    unit load's place; with friction those along the flank after them.
    """
    body, sense, rubbed = model.bodies.pick(role), TOOTH_ORDER.pick(role), _rubbed(contacts)
    found = []
    for contact in contacts:
        weights = body.load_weights(contact.line.places.pick(role)).T
        forces = weights @ contact.forces
        forces = np.r_[forces, weights @ (contact.forces * contact.line.friction)] if rubbed else forces
        found.append((sense * contact.tooth, forces))
    return found


def _rubbed(contacts: tuple[SolidPairContact, ...]) -> bool:
    """Return whether there is friction."""
    return any(np.any(contact.line.friction) for contact in contacts)


def _loss(model: SolidPair, contact: SolidPairContact) -> float:
    """Return the power that friction takes over the angular speed of the pinion (N mm)."""
    levers = sliding_levers(model.pair, contact.line.nominal)
    return float((contact.forces * np.abs(contact.line.friction) * levers).sum())


def _hub_torque(body: SolidCompliance, contacts: tuple[SolidPairContact, ...], role: Role) -> float:
    """Return the torque (N·m) that the loads put on the hub of a gear, those on tip edges by their lever arms."""
    total, rubbed = 0.0, _rubbed(contacts)
    for contact in contacts:
        weights = body.load_weights(contact.line.places.pick(role)).T
        total += float((weights @ (contact.forces * contact.line.edges.arms.pick(role))) @ -body.torques)
        if rubbed:
            total += float((weights @ (contact.forces * contact.line.friction)) @ -body.by_friction[1])
    return total / 1000


def _tension(fillet: SolidFillet, loads: list[ToothForces]) -> SolidRootStress:
    return _greatest(fillet, [state.greater for state in _states(fillet, loads)], 1)


def _compression(fillet: SolidFillet, loads: list[ToothForces]) -> SolidRootStress:
    return _greatest(fillet, [state.lesser for state in _states(fillet, loads)], -1)


def _states(fillet: SolidFillet, loads: list[ToothForces]) -> list[FilletState]:
    """Return the fillet of each tooth in contact."""
    return [fillet.state([(tooth - own, force) for tooth, force in loads]) for own, _ in loads]


def _bore_tension(bore: SolidFillet | None, loads: list[ToothForces]) -> float | None:
    return None if bore is None else max(float(state.greater.max()) for state in _states(bore, loads))


def _greatest(fillet: SolidFillet, stresses: list[Floats], sign: int) -> SolidRootStress:
    """Return the most stressed place of the root of the most stressed tooth."""
    root, along, across = np.flatnonzero(fillet.is_root), fillet.along_root, fillet.along_face
    every = [sign * across @ stress[:, root] @ along.T for stress in stresses]
    worst = max(every, key=np.max)
    row, column = np.unravel_index(int(np.argmax(worst)), worst.shape)
    return SolidRootStress(
        stress=sign * float(worst[row, column]),
        radius=float(along[column] @ fillet.radii[root]),
        height=float(fillet.heights_between[row]),
        tangent_angle=float(along[column] @ fillet.tangent_angles[root]),
        along_face=sign * np.max([stress.max(axis=1) for stress in every], axis=0),
    )


def _contacts(model: SolidPair, solution: LineSolution) -> tuple[SolidPairContact, ...]:
    given, starts = solution.given, solution.starts
    total, sound = solution.forces.sum(), np.zeros(given.cells, bool)
    if starts is not None:
        sound[starts.cells] = starts.sound
    parts = (solution.forces, solution.half_widths, solution.pressures, solution.gaps.radii)
    plain = plain_widths(given, np.concatenate([line.curvature for line in given.lines]), model.helix, solution.forces)
    rounded = [all(onset.length for onset in onsets(flank)) for flank in model.line.flanks]
    every = (given.split(part) for part in (*parts, plain, sound))
    found = []
    for line, forces, widths, pressures, radii, reach, told in zip(given.lines, *every, strict=True):
        if forces.sum() > 0:
            to_end = model.width / 2 - np.abs(line.across)
            to_starts = start_distances(line, model.line)
            distance = np.minimum(np.minimum(line.edge_distance, to_end), np.minimum(*to_starts))
            margin = distance - INTERIOR * reach
            beside = told & (to_end > INTERIOR * reach) & (forces > 0)
            at_start = PerGear(
                *(
                    _greatest_of(pressures, beside & (to < INTERIOR * reach)) if finite else math.nan
                    for to, finite in zip(to_starts, rounded, strict=True)
                )
            )
            edge = float(pressures[np.minimum(line.edge_distance, to_end) < INTERIOR * reach].max(initial=0.0))
            force, share = float(forces.sum()), float(forces.sum() / total)
            found.append(SolidPairContact(line, forces, widths, pressures, radii, margin, at_start, edge, force, share))
    return tuple(found)


def _greatest_of(values: Floats, here: Bools) -> float:
    """Return the greatest of values (n,) at some places (n,), NaN if there are none."""
    return float(values[here].max()) if here.any() else math.nan


def wide_solid_contacts(cycle: SolidCycle) -> Iterator[Notice]:
    """Rings whose contact is conformal."""
    if cycle.model.pair.internal:
        yield from conformal_notices(each for _, contact in cycle.interior_contacts for each in _hollow(contact))


def _hollow(contact: SolidPairContact) -> Iterator[HollowContact]:
    """Yield the cells away from all edges."""
    lengths = contact.line.places.pinion[0]
    return map(HollowContact, contact.half_widths[contact.interior].tolist(), lengths[contact.interior].tolist())


_AT_STRAINS = 3
"""Order of the quadrature whose 2 x 2 x 2 places have the most accurate strains of quadratic hexahedra."""

_OVER = 1.1
"""Range of stresses in pictures, in greatest von Mises stresses of the fillets."""

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
    """Return the field of the most stressed tooth of a gear where its root tension is greatest."""
    position = cycle.worst_position(role)
    fillet, loads = cycle.model.fillets.pick(role).loaded, tooth_loads(cycle.model, position.contacts, role)

    def tension(own: int) -> float:
        state = fillet.state([(tooth - own, force) for tooth, force in loads])
        return float(state.greater[:, fillet.is_root].max())

    return solid_field(cycle, position, role, max((own for own, _ in loads), key=tension))


def solid_field(cycle: SolidCycle, position: SolidPosition, role: Role, tooth: int = 0) -> SolidField:
    """Return the field of a tooth of a gear, counted as its teeth follow each other where flanks with y > 0 carry.

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
    """Return the stress (MPa) at which the colours of a picture should end.

    It is a tenth above the greatest von Mises stress of the roots of both fillets. The contact, which elements do not resolve,
    lies above.
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


def write_field(field: SolidField, path: Path, most: float) -> None:
    """Write a field for ParaView, units in the names; stress as VTK has it, xx, yy, zz, xy, yz, zx.

    `von_mises_root_MPa` ends at `most` (MPa), so that its colours show the root; it is what a viewer shows first.
    """
    stress = field.von_mises
    fields = {
        _ROOT: np.minimum(stress, most),
        "von_mises_MPa": stress,
        "stress_MPa": field.stress,
        _DEFORMED: field.displacement,
    }
    grid = vtk_elements(Element.HEX20, field.points, field.hexahedra[:, BY_LEVELS], fields)
    grid.GetPointData().SetActiveScalars(_ROOT)
    grid.GetPointData().SetActiveVectors(_DEFORMED)
    write_vtu(grid, path)


def nodal_stress(points: Floats, hexahedra: Wholes, displacement: Floats, material: Material) -> Floats:
    """Return the stresses (n, 6) at the nodes: from 2 x 2 x 2 points of each element, outward, and the mean of all elements
    around.
    """
    gradient = field_gradients(SWEPT, points[hexahedra], displacement[hexahedra], quadrature(SWEPT, _AT_STRAINS).places)
    at_nodes = np.einsum("aq,mqs->mas", _outward(), _stress(gradient, material), optimize=True)
    total, times = np.zeros((len(points), 6)), np.zeros(len(points))
    np.add.at(total, hexahedra, at_nodes)
    np.add.at(times, hexahedra, 1.0)
    result: Floats = total / times[:, None]
    return result


def _stress(gradient: Floats, material: Material) -> Floats:
    """Return the stresses (..., 6) by gradients of displacement (..., 3, 3)."""
    first, second = lame(material)
    strain = (gradient + np.swapaxes(gradient, -1, -2)) / 2
    stress = 2 * second * strain + first * np.trace(strain, axis1=-2, axis2=-1)[..., None, None] * np.eye(3)
    return np.stack([stress[..., i, j] for i, j in _COMPONENTS], -1)


@cache
def _outward() -> Floats:
    """Return the weights (20, 8) with which values at the points, trilinear between them, give those at the nodes."""
    points = quadrature(SWEPT, _AT_STRAINS).places
    low, high = points.min(), points.max()
    order = [int(np.abs(low + (high - low) * corner - points).sum(axis=1).argmin()) for corner in node_places("hex8")]
    weights = np.empty((20, 8))
    weights[:, order] = shape_values("hex8", (node_places(SWEPT) - low) / (high - low))
    return weights
