"""Decks of a pinion and a rack: both sections in mesh, as CalculiX runs them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from gearcad.check.task import CheckTask
from gearcad.core.records import PerGear, Role
from gearcad.decks.plane import PlaneDecks
from gearcad.geometry import RackPair
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.bodies.rack_mesh import mesh_strip, pinion_turn, rack_posed
from gearcad.meshing.bodies.sectors import ContactRefinement

_RACK = """\
A pinion and a rack in mesh at the roll angle {roll_angle:.6g} deg, the pinion pressed against the rack by {torque:.6g} N m.
CalculiX runs this deck as it is:  ccx NAME  for NAME.inp

The pinion turns about the z axis; the rack's reference line is at x = {distance:.10g} mm, and its sides have "wheel" in their
names. All of the rack's back is held, and all of the bore of the pinion, which turns with the node "reference", whose first
degree of freedom is the angle in rad. The flanks of pairs of teeth that may touch are surfaces; pressure is a stiffness times
overlap.

The pinion stands turned by {approach_in_mesh:.6g} um along the line of action already, so that there is contact in the first
iteration. The transmission error is that and the angle times the base radius, {base_radius:.10g} mm; along the rack it is as
much over the cosine of the pressure angle.

gearcad's own check of the same pair: transmission error {transmission_error:.5g} um, angle {reference_turn:.6e} rad,
greatest tension along the fillets, pinion {root_pinion:.5g} MPa, rack {root_wheel:.5g} MPa."""


@dataclass(frozen=True)
class RackDecks(PlaneDecks):
    """Sections of a pinion and a rack. Raises ParameterError and GeometryError."""

    @property
    def rack_pair(self) -> RackPair:
        """The pinion and the rack."""
        assert isinstance(self.task.pair, RackPair)
        return self.task.pair

    @property
    def flank_lengths(self) -> list[float]:
        profile = self.rack_pair.rack.profile
        cosine = math.cos(math.radians(self.rack_pair.working_transverse_pressure_angle))
        return [*super().flank_lengths, (profile.tip_form_height + profile.form_depth) / cosine]

    def tooth(self, role: Role, tooth: int) -> int:
        sense = (1 if role is Role.PINION else -1) * (1 if self.left else -1)
        pair = self.rack_pair
        return sense * tooth % (pair.pinion.teeth if role is Role.PINION else pair.rack.whole_pitches)

    def mesh(self, role: Role, zones: Mapping[int, ContactRefinement]) -> ElementMesh:
        if role is Role.PINION:
            return super().mesh(role, zones)
        teeth = self.cycle.model.bodies.wheel.ring.support.teeth
        return mesh_strip(self.rack_pair.rack, teeth=teeth, sizes=self.sizes, contacts=zones)

    def posed(self, meshes: PerGear[ElementMesh], roll_angle: float, approach: float) -> ElementMesh:
        return rack_posed(self.rack_pair, meshes, roll_angle, approach, left=self.left)

    def turn(self, role: Role, roll_angle: float) -> float:
        return math.pi if role is Role.WHEEL else pinion_turn(self.rack_pair, roll_angle, left=self.left)

    def words(self, expected: Mapping[str, Any]) -> list[str]:
        roots = {f"root_{gear}": stress for gear, stress in expected["root_stress"].items()}
        distance = self.rack_pair.mounting_distance
        return _RACK.format(**expected, **roots, distance=distance, base_radius=self._base_radius).splitlines()

    @property
    def _base_radius(self) -> float:
        return self.rack_pair.pinion.base_diameter / 2


def plane_decks(task: CheckTask) -> PlaneDecks:
    """Return the decks of sections of a pair, or of a pinion and a rack. Raises ParameterError and GeometryError."""
    return RackDecks(task) if isinstance(task.pair, RackPair) else PlaneDecks(task)
