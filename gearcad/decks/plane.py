"""Decks of a check in the plane: both sections, or one section under the pressures that the check has found."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, TextIO

import numpy as np

from gearcad.check.run import plane_model
from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact
from gearcad.contact.plane.pair import ContactSolution
from gearcad.contact.plane.sector import Plane
from gearcad.contact.shared.loaded import LEAST_TANGENT_ANGLE, LoadedFlank
from gearcad.core.errors import ParameterError, at_least
from gearcad.core.records import Floats, Role
from gearcad.decks.calculix import number
from gearcad.decks.pair import PairDecks, ToothDeck, require_same_flanks
from gearcad.meshing.bodies import Element, ElementMesh, Faces
from gearcad.meshing.bodies.element_mesh import joined
from gearcad.meshing.bodies.section_mesh import mesh_section
from gearcad.meshing.bodies.sectors import ContactRefinement
from gearcad.meshing.fem import quadrature, shape_slopes
from gearcad.meshing.outline import MeshSizes

PLANE_SIZES = MeshSizes(flank=0.5, corner=0.2, fillet=0.05, outline=0.5, growth=0.4, fillet_turn=5.0)
"""Edges away from the contacts. Root stresses are then within 0.3 %; of a ring, whose fillets are tight, within 0.6 % of the
usual check and 0.15 % of a fine one (measured)."""

_EDGES = 6
"""Edges over the half width of a contact: with one of them the pressure is 2 % low, with four uneven by that (measured)."""

_REACH = 1.6
"""Half widths on each side of a contact over which edges stay short: another solver's may lie a little aside."""

_NARROWEST = 0.3
"""Half width below which that of a pair is not followed, over that of the widest contact: such a pair carries 1/10."""

_LEAST = 1 / 500
"""Least half width of the widest contact over the length of a flank: pressures of narrower ones are uneven (measured)."""


@dataclass(frozen=True)
class PlaneDecks(PairDecks):
    """Sections in the plane; `sizes` are those of the elements away from the contacts."""

    sizes: MeshSizes = PLANE_SIZES

    solid: ClassVar[bool] = False
    begun: ClassVar[float] = 0.05

    def __post_init__(self) -> None:
        super().__post_init__()
        require_same_flanks(self.task)
        if self.task.options.plane_state is not Plane.STRAIN:
            raise ParameterError(
                "check.plane", self.task.options.plane, 'must be "strain" for a deck: CalculiX makes thick sections'
            )

    @cached_property
    def cycle(self) -> PlaneCycle:
        return PlaneCycle(plane_model(self.task), self.task.torque)

    def solution(self, roll_angle: float) -> ContactSolution:
        """Our own contact at a roll angle (deg)."""
        return self.cycle.model.solve(roll_angle, self.task.torque)

    def teeth_near(self, roll_angle: float) -> Iterable[int]:
        return [pair.tooth for pair in self.solution(roll_angle).pairs]

    def zones(self, roll_angle: float, role: Role) -> Mapping[int, ContactRefinement]:
        solution = self.solution(roll_angle)
        centres, halves = dict[int, float](), dict[int, float]()
        for pair, pressures in zip(solution.pairs, solution.pressures, strict=True):
            lengths, total = pair.cells.lengths.pick(role), float(pressures.sum())
            centres[pair.tooth] = float(lengths @ pressures) / total if total else pair.lengths.pick(role)
            halves[pair.tooth] = float(np.count_nonzero(pressures)) * pair.cells.width / 2
        widest = max(halves.values())
        self._require_wide(widest)
        wide = {tooth: max(half, _NARROWEST * widest) for tooth, half in halves.items()}
        return {
            self.tooth(role, tooth): ContactRefinement(
                length=centres[tooth], half_width=_REACH * half, edge=half / _EDGES, left=self.left
            )
            for tooth, half in wide.items()
        }

    @property
    def flank_lengths(self) -> list[float]:
        """Lengths of the flanks of both gears (mm)."""
        return [(gear.flank_form.last**2 - gear.flank_form.first**2) / gear.base_diameter for gear in self.task.gears.values()]

    def _require_wide(self, half: float) -> None:
        """Raise ParameterError where contacts are too narrow for elements that the flank's mesh can still have."""
        least = _LEAST * max(self.flank_lengths)
        if half < least:
            permitted = f"must be at least {at_least(abs(self.task.torque) * (least / half) ** 2)} N·m in size for a deck"
            why = f"the contact is only {2 * half:.2g} mm wide"
            raise ParameterError("load.torque", self.task.torque, f"{permitted}: {why}", "N·m")

    def mesh(self, role: Role, zones: Mapping[int, ContactRefinement]) -> ElementMesh:
        body, gear = self.task.body, self.task.gears[role]
        teeth = body.teeth_held(gear)
        if teeth is not None:
            teeth = max(teeth, 2 * self.cycle.model.bodies.pick(role).neighbours + 1)
        radius = body.inner_radii(self.pair).pick(role)
        return mesh_section(gear, teeth=teeth, held_radius=radius, sizes=self.sizes, element=Element.TRI6, contacts=zones)

    def root_tension(self, mesh: ElementMesh, moved: Floats, role: Role, tooth: int, turn: float) -> float:
        """Return the greatest tension (MPa) by the strain along the surface times E', as our check has it.

        It is taken at Gauss points from a tangent angle on.
        """
        gear, modulus = self.task.gears.get(role), self.cycle.model.bodies.pick(role).elasticity.modulus
        edges = mesh.face_cells(self.side(role, tooth, "fillet"))
        slopes = shape_slopes("line3", quadrature("line3", 3).places)[:, 0]
        along, stretched = (np.einsum("qa,eac->eqc", slopes, of[edges, :2]).reshape(-1, 2) for of in (mesh.points, moved))
        stress = (stretched * along).sum(-1) / (along**2).sum(-1) * modulus
        own_turn = turn if gear is None else turn + 2 * math.pi * tooth / gear.tooth_count
        own = (along[:, 0] + 1j * along[:, 1]) * np.exp(-1j * own_turn)
        # The outline of a ring's tooth, which points inwards, runs the other way.
        rise = own.imag * self.cycle.model.bodies.pick(role).flank.upward
        at_root = np.degrees(np.arctan2(rise, np.abs(own.real))) >= LEAST_TANGENT_ANGLE
        return float(stress[at_root].max())


@dataclass(frozen=True)
class PlaneToothDeck(ToothDeck):
    """Pressures (n,) in MPa on sides of elements of a section."""

    faces: Faces
    pressures: Floats

    def write_loads(self, file: TextIO) -> None:
        """Write pressures on edges."""
        file.write("*DLOAD\n")
        for element, side, pressure in zip(self.faces.elements, self.faces.sides, self.pressures, strict=True):
            file.write(f"{element + 1}, P{side + 1}, {number(pressure)}\n")


def plane_tooth_deck(decks: PlaneDecks, roll_angle: float, role: Role) -> PlaneToothDeck:
    """Return a gear of the pair at a roll angle (deg). Raises ParameterError, GeometryError and SolverError."""
    position = decks.cycle.solve(roll_angle)
    mesh = joined({role.value: decks.mesh(role, decks.zones(roll_angle, role))})
    flank = decks.cycle.model.bodies.pick(role).flank
    assert isinstance(flank, LoadedFlank)  # of a gear
    loaded, pressures = list[Faces](), list[Floats]()
    for contact in position.contacts:
        name = decks.side(role, decks.tooth(role, contact.tooth), "flank")
        laid = _laid(mesh, name, contact, role, flank)
        loaded.append(Faces(mesh.sides[name].elements[laid > 0], mesh.sides[name].sides[laid > 0]))
        pressures.append(laid[laid > 0])
    faces = Faces(np.concatenate([each.elements for each in loaded]), np.concatenate([each.sides for each in loaded]))
    return PlaneToothDeck(decks, role, mesh, position, faces, np.concatenate(pressures))


def _laid(mesh: ElementMesh, flank: str, contact: PlanePairContact, role: Role, exact: LoadedFlank) -> Floats:
    """Pressures (n,) in MPa on the edges of a flank: the forces of the cells of contact on each, over its chord."""
    cells = contact.pair.cells
    lengths = cells.lengths.pick(role)
    ends = np.interp(cells.place[0] - cells.width / 2 + cells.width * np.arange(len(lengths) + 1), cells.place, lengths)
    ends[[0, -1]] += lengths[[0, -1]] - ends[[1, -2]]
    passed = np.r_[0.0, np.cumsum(contact.pressures)] * cells.width
    order = np.argsort(ends)
    points = mesh.points[mesh.face_cells(flank)[:, :2], :2]
    at = exact.roll_lengths(np.hypot(points[..., 0], points[..., 1]))
    force = np.abs(np.diff(np.interp(at, ends[order], passed[order]), axis=1)[:, 0])
    result: Floats = force / np.hypot(*(points[:, 1] - points[:, 0]).T)
    return result
