"""Load over the face of a mesh on shafts that give way (ISO 6336-1 annex E): slices, the gap of the shafts, K_Hbeta.

The pinion's axis is z, the wheel's lies at the mesh angle from x, seen from +z; both shafts have z in the same sense. Gaps in
µm along the base tangent in the transverse section, opening positive; loads in N/mm; c_gammabeta in N/(mm·µm).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcad.contact.shared.local_contact import complementary
from gearcad.core.records import Floats, JsonObject, PerGear, Role
from gearcad.geometry import GearPair
from gearcad.shafts.beam import ShaftState, SteppedShaft

_END_SLICES = 160
"""Slices with which the line load is carried on to the end of the face."""


@dataclass(frozen=True, kw_only=True)
class MeshOnShafts:
    """A pair of external gears whose common face is at `positions` (mm, its middle) of two shafts; None stands for rigid ones.

    `torque` in N·m on the pinion, `stiffness` c_gammabeta. `crowning` and `slope` (µm over the face, helix modification and
    manufacturing misalignment) are gaps of their own.
    """

    pair: GearPair
    torque: float
    shafts: PerGear[SteppedShaft | None]
    positions: PerGear[float]
    mesh_angle: float = 0.0
    stiffness: float = 20.0
    slices: int = 40
    crowning: float = 0.0
    slope: float = 0.0

    @property
    def width(self) -> float:
        """Common face width (mm)."""
        return self.pair.common_width.width

    @property
    def base_force(self) -> float:
        """F_bt = 2000 T_1/d_b1 (N)."""
        return 2000 * abs(self.torque) / self.pair.pinion.base_diameter

    @property
    def mean_load(self) -> float:
        """Mean line load (N/mm)."""
        return self.base_force / self.width

    @cached_property
    def places(self) -> Floats:
        """Middles (n,) of the slices in mm from the middle of the face."""
        step = self.width / self.slices
        return np.asarray((np.arange(self.slices) + 0.5) * step - self.width / 2, float)

    @cached_property
    def direction(self) -> Floats:
        """Direction (3,) of the force on the wheel for a base tangent force of 1: m - sigma tan beta_b e_z."""
        sign = math.copysign(1.0, self.torque)
        angle = math.radians(self.pair.working_transverse_pressure_angle)
        across, along = self._frame
        m: Floats = math.sin(angle) * across + sign * math.cos(angle) * along
        return m - sign * math.tan(math.radians(self.pair.pinion.base_helix_angle)) * np.array([0.0, 0.0, 1.0])

    @property
    def _frame(self) -> tuple[Floats, Floats]:
        """e_r towards the wheel, and e_t = e_z x e_r."""
        theta = math.radians(self.mesh_angle)
        return np.array([math.cos(theta), math.sin(theta), 0.0]), np.array([-math.sin(theta), math.cos(theta), 0.0])

    def _lever(self, role: Role) -> Floats:
        """Lever (3,) from the axis to the pitch point (mm)."""
        radius = self.pair.centre_distance / (1 + self.pair.gear_ratio)
        if role is Role.PINION:
            return radius * self._frame[0]
        return -(self.pair.centre_distance - radius) * self._frame[0]

    @cached_property
    def _beams(self) -> PerGear[SteppedShaft | None]:
        """The shafts with nodes at the slices."""

        def beam(role: Role) -> SteppedShaft | None:
            shaft = self.shafts.pick(role)
            return None if shaft is None else replace(shaft, places=tuple(self.positions.pick(role) + self.places))

        return PerGear.each(beam)

    def _vectors(self, role: Role) -> Floats:
        """Load vectors (6 n, slices) of the direction at each slice: force, and lever x force."""
        beam = self._beams.pick(role)
        assert beam is not None
        found = np.zeros((6 * len(beam.nodes), self.slices))
        own = np.concatenate([self.direction, np.cross(self._lever(role), self.direction)])
        for number, place in enumerate((self.positions.pick(role) + self.places).tolist()):
            first = 6 * beam.node_at(place)
            found[first : first + 6, number] = own
        return found

    @cached_property
    def influence(self) -> PerGear[Floats]:
        """Gap (slices, slices) in mm at each slice by 1 N on each: symmetric; 0 of a rigid shaft."""

        def of(role: Role) -> Floats:
            beam = self._beams.pick(role)
            if beam is None:
                return np.zeros((self.slices, self.slices))
            vectors = self._vectors(role)
            matrix = vectors.T @ beam.compliance @ vectors
            result: Floats = (matrix + matrix.T) / 2
            return result

        return PerGear.each(of)

    @cached_property
    def outer_gaps(self) -> PerGear[Floats]:
        """Gap (slices,) in mm by the other forces, the weight and seats of bearings off the axis."""

        def of(role: Role) -> Floats:
            beam = self._beams.pick(role)
            if beam is None:
                return np.zeros(self.slices)
            moved: Floats = self._vectors(role).T @ beam.solve().moved
            return moved if role is Role.WHEEL else -moved

        return PerGear.each(of)

    @cached_property
    def given_gap(self) -> Floats:
        """Gap (slices,) in mm of crowning, helix modification and misalignment."""
        x = self.places / self.width
        result: Floats = (self.crowning * (2 * x) ** 2 + self.slope * x) / 1000
        return result

    @cached_property
    def solution(self) -> tuple[Floats, float]:
        """Line load (slices,) in N/mm, and the approach of the flanks (mm)."""
        step = self.width / self.slices
        matrix = (self.influence.pinion + self.influence.wheel) * step * step
        matrix[np.diag_indices(self.slices)] += step / (1000 * self.stiffness)
        gap = self.given_gap + self.outer_gaps.pinion + self.outer_gaps.wheel
        width = np.full(self.slices, step)
        load, approach = complementary(matrix, (gap - gap.min()) * step, width, self.base_force)
        return load, approach + float(gap.min())

    @property
    def line_load(self) -> Floats:
        """Line load (slices,) in N/mm."""
        return self.solution[0]

    @property
    def approach(self) -> float:
        """Approach of the flanks along the base tangent (µm)."""
        return 1000 * self.solution[1]

    @property
    def face_load_factor(self) -> float:
        """K_Hbeta: greatest slice over the mean."""
        return float(self.line_load.max() / self.mean_load)

    @cached_property
    def face_load_factor_at_end(self) -> float:
        """K_Hbeta of ever narrower slices, the line load carried on to the end of the face."""
        load = replace(self, slices=_END_SLICES).line_load
        ends = (load[0] + (load[0] - load[1]) / 2, load[-1] + (load[-1] - load[-2]) / 2)
        return float(max(*ends, load.max()) / self.mean_load)

    @cached_property
    def even_gaps(self) -> dict[str, Floats]:
        """Gaps (slices,) in µm under an even load, by what makes them: bending, torsion, axial_tilt, outer of each shaft."""
        found: dict[str, Floats] = {}
        for number, role in enumerate(Role, 1):
            beam = self._beams.pick(role)
            if beam is None:
                continue
            loads = self._vectors(role).sum(axis=1) * self.base_force / self.slices
            moved = (beam.compliance @ loads).reshape(-1, 6)
            rows = moved[[beam.node_at(place) for place in (self.positions.pick(role) + self.places).tolist()]]
            lever, d = self._lever(role), self.direction
            turned = np.cross(lever, d)
            parts = {
                "bending": rows[:, :2] @ d[:2],
                "torsion": rows[:, 5] * turned[2],
                "axial_tilt": rows[:, 2] * d[2] + rows[:, 3:5] @ turned[:2],
                "outer": self.outer_gaps.pick(role),
            }
            found |= {f"{name}_{number}": 1000 * gap for name, gap in parts.items() if np.any(gap)}
        return found

    @cached_property
    def misalignment_of_shafts(self) -> float:
        """f_sh (µm): slope of the gap under an even load by least squares, over the face."""
        every = sum(self.even_gaps.values(), np.zeros(self.slices))
        return float(np.polyfit(self.places, every, 1)[0] * self.width)

    def state(self, role: Role) -> ShaftState | None:
        """Return the shaft of a gear under the load over the face and its other forces; None of a rigid one."""
        beam = self._beams.pick(role)
        if beam is None:
            return None
        sign = 1 if role is Role.WHEEL else -1
        return beam.solve(sign * self._vectors(role) @ self.line_load * self.width / self.slices)

    def to_dict(self) -> JsonObject:
        """Return f_sh under an even load, K_Hbeta, line loads (N/mm) and gaps (µm) slice by slice."""
        return {
            "F_bt": self.base_force,
            "mean_line_load": self.mean_load,
            "f_sh": self.misalignment_of_shafts,
            "K_Hbeta_slices": self.face_load_factor,
            "K_Hbeta_end_of_face": self.face_load_factor_at_end,
            "line_load": self.line_load.tolist(),
            "approach": self.approach,
            "slices_at": self.places.tolist(),
            "gap_at_even_load_at_slices": {name: gap.tolist() for name, gap in self.even_gaps.items()},
        }
