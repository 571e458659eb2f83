"""Loaded pairs of solid gears as decks: hexahedra that are fine along the lines of contact."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from gearcad.arrays import Floats
from gearcad.check.options import Model
from gearcad.check.solid.run import solid_model
from gearcad.check.task import CheckTask
from gearcad.contact.solid.contact import SolidPairContact
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import teeth_moved
from gearcad.decks.pair import PairDecks
from gearcad.decks.solid_root import Fillet, root_tension
from gearcad.errors import ParameterError
from gearcad.geometry.helix import twist
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.body_mesh import mesh_body
from gearcad.meshing.bodies.contact_zone import ContactZone
from gearcad.meshing.section import MeshSizes
from gearcad.meshing.section.swept import layer_planes
from gearcad.per_gear import Role

__all__ = ["SOLID_SIZES", "SolidDecks", "solid_task"]


SOLID_SIZES = MeshSizes(flank=0.5, corner=0.3, fillet=0.11, outline=0.8, cut=0.7, rim=4.0, growth=0.8)
"""Edges away from the contacts; root stresses are then within 1 % (measured)."""

_LAYER = 0.8
"""Mean thickness of a layer in normal modules."""

_EDGE = 0.6
"""Edge where teeth touch over the half width of the widest contact: the approach is then within 0.5 % (measured)."""

_SHORTEST, _LONGEST = 0.02, 4.0
"""Least edge there in normal modules, greatest over the half width: with longer ones the approach is off by more than 1 %."""

_MOST_EDGES = 10
"""Most edges over the stretch of a flank on which an oblique line of contact lies."""

_REACH = 1.6
"""Half widths on each side of a contact over which edges stay short: another solver's may lie a little aside."""

_FEWEST_TEETH = 7
"""Of a body that stands for a ring. Our own check has every tooth that touches in the middle of as many as there are, a deck
has tooth 0 there: with 5 teeth that is worth up to 2 % of the approach where others share the load (measured).
"""


def solid_task(task: CheckTask) -> CheckTask:
    """The task with solid bodies; where it asks for rings, with so few teeth that CalculiX has done within minutes."""
    teeth = task.options.body_teeth or max(_FEWEST_TEETH, 2 * teeth_moved(task.pair) + 1)
    return replace(task, options=replace(task.options, model=Model.SOLID.value, body_teeth=teeth))


@dataclass(frozen=True)
class SolidDecks(PairDecks):
    """Bodies of a `solid_task`; `sizes` are those of the elements away from the contacts, `layers` the fewest over the common
    face width.
    """

    sizes: MeshSizes = SOLID_SIZES
    layers: int = 6

    solid: ClassVar[bool] = True
    begun: ClassVar[float] = 0.15

    @cached_property
    def cycle(self) -> SolidCycle:
        return SolidCycle(solid_model(self.task), self.task.torque)

    def teeth_near(self, roll_angle: float) -> Iterable[int]:
        model = self.cycle.model
        lines = model.responses(roll_angle, model.farthest(self.task.torque)).lines
        return [line.tooth for line in lines if abs(line.tooth) <= self._reach]

    def _contacts(self, roll_angle: float) -> Sequence[SolidPairContact]:
        """Those that carry. Raises ParameterError if not all of their teeth are on the bodies."""
        contacts = self.cycle.contacts_at(roll_angle)
        farthest = max(abs(contact.tooth) for contact in contacts)
        if farthest > self._reach:
            permitted = f"must be at least {2 * farthest + 1} for a deck: so many teeth carry around tooth 0"
            raise ParameterError("check.body_teeth", self.task.options.body_teeth, permitted)
        return contacts

    @property
    def _reach(self) -> int:
        """Teeth beside tooth 0 that both bodies have."""
        return min((self.task.body.teeth_held(gear) or gear.tooth_count) for gear in self.pair.gears) // 2

    def zones(self, roll_angle: float, role: Role) -> Mapping[int, ContactZone]:
        contacts, diameter = self._contacts(roll_angle), abs(self.pair.gears.pick(role).base_diameter)
        squares = [contact.line.places.pick(role)[0][contact.forces > 0] ** 2 for contact in contacts]
        half = max(float(contact.half_widths.max()) for contact in contacts)
        reaches = [float(np.ptp(each)) / diameter / 2 + _REACH * half for each in squares]
        edge = max(_EDGE * half, 2 * max(reaches) / _MOST_EDGES, _SHORTEST * self.pair.pinion.normal_module)
        self._require_wide(half, edge)
        return {
            self.tooth(role, contact.tooth): ContactZone(
                length=math.sqrt((float(each.min()) + float(each.max())) / 2), half_width=reach, edge=edge, left=self.left
            )
            for contact, each, reach in zip(contacts, squares, reaches, strict=True)
        }

    def _require_wide(self, half: float, edge: float) -> None:
        """Raise ParameterError where contacts are too narrow for the edges that a deck can have."""
        if half * _LONGEST < edge:
            least = abs(self.task.torque) * (edge / half / _LONGEST) ** 2
            permitted = f"must be at least {least:.2g} N·m in size for a deck: the contact is only {2 * half:.2g} mm wide"
            raise ParameterError("load.torque", self.task.torque, permitted, "N·m")

    def planes(self, role: Role) -> Floats:
        """Heights (n,) in mm of the planes between layers of a gear: of the common face width, and of what is beyond it."""
        low, high = self.cycle.model.common_heights(role)
        gear = self.pair.gears.pick(role)
        thickness = _LAYER * gear.normal_module
        inside = low + layer_planes(high - low, max(self.layers, round((high - low) / thickness)))
        planes: Floats = np.r_[_beyond(0.0, low, thickness)[:-1], inside, _beyond(high, gear.face_width, thickness)[1:]]
        planes[[0, -1]] = 0.0, gear.face_width
        return planes

    def mesh(self, role: Role, zones: Mapping[int, ContactZone]) -> ElementMesh:
        body, gear = self.task.body, self.pair.gears.pick(role)
        return mesh_body(
            gear,
            teeth=body.teeth_held(gear),
            held_radius=body.inner_radii(self.pair).pick(role),
            sizes=self.sizes,
            planes=self.planes(role),
            element=Element.HEX20,
            contacts=zones,
        )

    def root_tension(self, mesh: ElementMesh, moved: Floats, role: Role, tooth: int, turn: float) -> float:
        """Of the fillet's surface, by strains, as our own check has it."""
        gear = self.pair.gears.pick(role)
        upward, around = -1 if gear.internal else 1, turn + 2 * math.pi * tooth / gear.tooth_count
        fillet = Fillet(mesh, self.side(role, tooth, "fillet"), around, twist(gear), upward)
        return root_tension(fillet, moved, self.task.materials.pick(role))


def _beyond(low: float, high: float, thickness: float) -> Floats:
    """Planes (n,) from a height to another; one if there is nothing between them."""
    return np.linspace(low, high, math.ceil((high - low) / thickness - 1e-6) + 1)
