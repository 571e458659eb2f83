"""Load over the face of a mesh on elastic shafts (ISO 6336-1 annex E): slices, the gap of shafts and flanks, K_Hbeta.

The pinion's axis is z, the wheel's lies at the mesh angle from x, seen from +z; both shafts have z in the same sense. Gaps in
µm along the base tangent in the transverse section, opening positive; loads in N/mm; c_gammabeta in N/(mm·µm).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from gearcad.core.complementarity import complementary
from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats, JsonObject, PerGear, Role
from gearcad.geometry import FlankModification, GearPair
from gearcad.mounting import STATIONS, SupportCompliance
from gearcad.shafts.beam import ShaftState, SteppedShaft

_END_SLICES = 80
"""Slices with which the line load is carried on to the end of the face: 2e-4 from the limit in the given cases."""


def require_modelled(pair: GearPair) -> None:
    """Raise GeometryError for a ring, and for double helical gears: their load over the face on shafts is not modelled."""
    if pair.internal:
        permitted = "must be above 0: the load over the face of a ring on shafts is not modelled"
        raise GeometryError("wheel.teeth", pair.wheel.teeth, permitted)
    if pair.double_helical:
        permitted = "must be left out: the load over the face of double helical gears on shafts is not modelled"
        raise GeometryError("pinion.double_helix.gap_width", pair.pinion.double_helix.gap_width, permitted, "mm")


class _Support(NamedTuple):
    """Effect of a shaft at stations: a part of a SupportCompliance."""

    matrix: Floats
    gap: Floats
    turns: Floats
    turned: float
    slides: Floats


@dataclass(frozen=True, kw_only=True)
class FaceOnShafts:
    """The common face of two gears, `width` (mm), its middle at `positions` (mm) of two shafts; None stands for rigid ones.

    Working pressure angle alpha_wt and base helix angle of the pinion in degrees, pitch radii in mm. `sign` is that of the
    torque on the pinion, 1 or -1: it says which flanks carry. All that follows holds for any load.
    """

    width: float
    pressure_angle: float
    base_helix_angle: float
    pitch_radii: PerGear[float]
    sign: int
    shafts: PerGear[SteppedShaft | None]
    positions: PerGear[float]
    mesh_angle: float
    slices: int

    @classmethod
    def of(
        cls,
        pair: GearPair,
        sign: int,
        shafts: PerGear[SteppedShaft | None],
        positions: PerGear[float],
        mesh_angle: float,
        slices: int,
    ) -> FaceOnShafts:
        """Return the face of a pair of external gears; the last ones are known, whatever the modifications of the flanks."""
        radius = pair.centre_distance / (1 + pair.gear_ratio)
        return _face_on_shafts(
            width=pair.common_width.width,
            pressure_angle=pair.working_transverse_pressure_angle,
            base_helix_angle=pair.pinion.base_helix_angle,
            pitch_radii=PerGear(radius, pair.centre_distance - radius),
            sign=sign,
            shafts=shafts,
            positions=positions,
            mesh_angle=mesh_angle,
            slices=slices,
        )

    @cached_property
    def places(self) -> Floats:
        """Middles (n,) of the slices in mm from the middle of the face."""
        step = self.width / self.slices
        return np.asarray((np.arange(self.slices) + 0.5) * step - self.width / 2, float)

    @cached_property
    def direction(self) -> Floats:
        """Direction (3,) of the force on the wheel for a base tangent force of 1: m - sigma tan beta_b e_z."""
        angle = math.radians(self.pressure_angle)
        across, along = self._frame
        m: Floats = math.sin(angle) * across + self.sign * math.cos(angle) * along
        return m - self.sign * math.tan(math.radians(self.base_helix_angle)) * np.array([0.0, 0.0, 1.0])

    @property
    def _frame(self) -> tuple[Floats, Floats]:
        """e_r towards the wheel, and e_t = e_z x e_r."""
        theta = math.radians(self.mesh_angle)
        return np.array([math.cos(theta), math.sin(theta), 0.0]), np.array([-math.sin(theta), math.cos(theta), 0.0])

    def lever(self, role: Role) -> Floats:
        """Return the lever (3,) from the axis to the pitch point (mm)."""
        return (1 if role is Role.PINION else -1) * self.pitch_radii.pick(role) * self._frame[0]

    @cached_property
    def beams(self) -> PerGear[SteppedShaft | None]:
        """The shafts with nodes at the slices."""

        def beam(role: Role) -> SteppedShaft | None:
            shaft = self.shafts.pick(role)
            return None if shaft is None else replace(shaft, places=tuple(self.stations(role)))

        return PerGear.each(beam)

    def stations(self, role: Role) -> list[float]:
        """Return the positions (mm) of the slices on the shaft of a gear."""
        found: list[float] = (self.positions.pick(role) + self.places).tolist()
        return found

    def vectors(self, role: Role, beam: SteppedShaft) -> Floats:
        """Return load vectors (6 n, slices) of the direction at each slice on a gear's beam: force, and lever x force."""
        found = np.zeros((6 * len(beam.nodes), self.slices))
        own = np.concatenate([self.direction, np.cross(self.lever(role), self.direction)])
        for number, place in enumerate(self.stations(role)):
            first = 6 * beam.node_at(place)
            found[first : first + 6, number] = own
        return found

    @cached_property
    def influence(self) -> PerGear[Floats]:
        """Gap (slices, slices) in mm at each slice by 1 N on each: symmetric; 0 of a rigid shaft."""

        def of(role: Role) -> Floats:
            beam = self.beams.pick(role)
            if beam is None:
                return np.zeros((self.slices, self.slices))
            vectors = self.vectors(role, beam)
            matrix = vectors.T @ beam.compliance @ vectors
            result: Floats = (matrix + matrix.T) / 2
            return result

        return PerGear.each(of)

    @cached_property
    def outer_gaps(self) -> PerGear[Floats]:
        """Gap (slices,) in mm by the other forces, the weight and seats of bearings off the axis."""

        def of(role: Role) -> Floats:
            beam = self.beams.pick(role)
            if beam is None:
                return np.zeros(self.slices)
            moved: Floats = self.vectors(role, beam).T @ beam.solve().moved
            return moved if role is Role.WHEEL else -moved

        return PerGear.each(of)

    @cached_property
    def gear_gaps(self) -> PerGear[Floats]:
        """The part (slices,) in mm of `outer_gaps` by forces of other meshes on the shafts."""

        def of(role: Role) -> Floats:
            beam = self.beams.pick(role)
            if beam is None or not (loads := beam.gear_loads).any():
                return np.zeros(self.slices)
            moved: Floats = self.vectors(role, beam).T @ (beam.compliance @ loads)
            return moved if role is Role.WHEEL else -moved

        return PerGear.each(of)

    def supports(self, stations: int = STATIONS) -> SupportCompliance:
        """Return what both shafts do to a contact at any place of the flanks, by so many stations over the face."""
        places = np.linspace(-self.width / 2, self.width / 2, stations)
        parts = PerGear.each(lambda role: self._support(role, places))
        return SupportCompliance(
            stations=places,
            matrices=parts.map(lambda part: part.matrix),
            gaps=parts.map(lambda part: part.gap),
            turns=parts.map(lambda part: part.turns),
            turned=parts.map(lambda part: part.turned),
            slides=parts.pinion.slides + parts.wheel.slides,
            helix=math.radians(self.base_helix_angle),
        )

    def _support(self, role: Role, places: Floats) -> _Support:
        """Return what the shaft of a gear does at places (k,) in mm from the middle of the face.

        The lever of a place is r_b e_q + s m, e_q from the pinion's axis to T1, m along the line of action; of the wheel it is
        the opposite of that, with its own base radius and roll length.
        """
        count, shaft, middle = len(places), self.shafts.pick(role), self.positions.pick(role)
        if shaft is None:
            return _Support(np.zeros((2 * count, 2 * count)), np.zeros(2 * count), np.zeros(2 * count), 0.0, np.zeros(2))
        beam = replace(shaft, places=(*(middle + places).tolist(), middle))
        d, side = self.direction, PerGear(-1.0, 1.0).pick(role)
        m = d * [1.0, 1.0, 0.0]
        square = self.sign * np.cross(m, [0.0, 0.0, 1.0])
        pitch_radius, angle = self.pitch_radii.pick(role), math.radians(self.pressure_angle)
        fixed = np.concatenate([d, -side * np.cross(pitch_radius * math.cos(angle) * square, d)])
        by_length = np.concatenate([np.zeros(3), -side * np.cross(m, d)])
        vectors, across = np.zeros((6 * len(beam.nodes), 2 * count)), np.zeros((6 * len(beam.nodes), count))
        for number, place in enumerate((middle + places).tolist()):
            first = 6 * beam.node_at(place)
            vectors[first : first + 6, number], vectors[first : first + 6, count + number] = fixed, by_length
            across[first : first + 3, number] = square
        turn = np.zeros(len(vectors))
        turn[6 * beam.node_at(middle) + 5] = fixed[5]
        moved, unloaded = beam.compliance @ vectors, side * beam.solve().moved
        matrix = vectors.T @ moved
        shares = np.where(np.arange(count) % (count - 1), 1.0, 0.5) / (count - 1)
        even = moved @ np.concatenate([shares, pitch_radius * math.sin(angle) * shares])
        return _Support(
            matrix=(matrix + matrix.T) / 2,
            gap=vectors.T @ unloaded,
            turns=turn @ moved,
            turned=float(turn @ unloaded),
            slides=np.array([np.polyfit(places, across.T @ each, 1)[0] for each in (unloaded, even)]),
        )

    @cached_property
    def parts_per_newton(self) -> dict[str, Floats]:
        """Gaps (slices,) in mm per N of an even load, by their causes: bending, torsion, axial_tilt of each shaft."""
        found: dict[str, Floats] = {}
        for number, role in enumerate(Role, 1):
            beam = self.beams.pick(role)
            if beam is None:
                continue
            moved = (beam.compliance @ (self.vectors(role, beam).sum(axis=1) / self.slices)).reshape(-1, 6)
            rows = moved[[beam.node_at(place) for place in self.stations(role)]]
            turned = np.cross(self.lever(role), self.direction)
            found[f"bending_{number}"] = rows[:, :2] @ self.direction[:2]
            found[f"torsion_{number}"] = rows[:, 5] * turned[2]
            found[f"axial_tilt_{number}"] = rows[:, 2] * self.direction[2] + rows[:, 3:5] @ turned[:2]
        return found


_face_on_shafts = lru_cache(16)(FaceOnShafts)
"""Known for the last meshes: loads of a spectrum and torques that are sought ask for them again."""


@dataclass(frozen=True, kw_only=True)
class MeshOnShafts:
    """A pair of external gears on two shafts under a load; positions in mm, None stands for a rigid shaft.

    `torque` in N·m on the pinion, `stiffness` c_gammabeta in N/(mm·µm). `misalignment` (µm over the face, of manufacture or
    mounting) opens the gap towards larger z if positive. Modifications of both gears along the face are gaps too.
    Raises GeometryError for a ring, and for double helical gears.
    """

    pair: GearPair
    torque: float
    shafts: PerGear[SteppedShaft | None]
    positions: PerGear[float]
    mesh_angle: float = 0.0
    stiffness: float = 20.0
    slices: int = 40
    misalignment: float = 0.0
    forces_torque: float | None = None
    """Torque (N·m) at which the shafts' forces of other meshes hold; None: they do not depend on the torque."""

    def __post_init__(self) -> None:
        require_modelled(self.pair)

    @property
    def face(self) -> FaceOnShafts:
        """The face, for any load of this sign."""
        sign = -1 if self.torque < 0 else 1
        return FaceOnShafts.of(self.pair, sign, self.shafts, self.positions, self.mesh_angle, self.slices)

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

    @property
    def places(self) -> Floats:
        """Middles (n,) of the slices in mm from the middle of the face."""
        return self.face.places

    @property
    def influence(self) -> PerGear[Floats]:
        """Gap (slices, slices) in mm at each slice by 1 N on each: symmetric; 0 of a rigid shaft."""
        return self.face.influence

    @property
    def outer_gaps(self) -> PerGear[Floats]:
        """Gap (slices,) in mm by the other forces, the weight and seats of bearings off the axis.

        Forces of other meshes grow with the torque.
        """
        every, more = self.face.outer_gaps, self._growth
        return every if not more else PerGear.each(lambda role: every.pick(role) + more * self.face.gear_gaps.pick(role))

    @property
    def _growth(self) -> float:
        """Share by which forces of other meshes are greater than those of the shafts."""
        return abs(self.torque / self.forces_torque) - 1 if self.forces_torque else 0.0

    def lead_gap(self, role: Role, modification: FlankModification | None = None) -> Floats:
        """Return the gap (slices,) in mm of a gear's modifications along the face, or of others in their place.

        They are crowning, helix angle modification and end relief, over the face width of the gear itself.
        """
        gear = self.pair.gears.pick(role)
        form = gear.flank_form if modification is None else replace(gear.flank_form, modification=modification)
        middle = self.pair.common_width.offset - (self.pair.axial_offset if role is Role.WHEEL else 0.0)
        return form.lead_depth(self.places + middle + gear.face_width / 2, left=self.torque >= 0)

    @cached_property
    def given_gap(self) -> Floats:
        """Gap (slices,) in mm of the flanks' modifications and of the misalignment."""
        flanks = self.lead_gap(Role.PINION) + self.lead_gap(Role.WHEEL)
        result: Floats = flanks + self.misalignment * self.places / self.width / 1000
        return result

    @cached_property
    def _springs(self) -> Floats:
        """Gap (slices, slices) at each slice by 1 N/mm on each, times the width of a slice: of shafts and teeth."""
        step = self.width / self.slices
        matrix: Floats = (self.influence.pinion + self.influence.wheel) * step * step
        matrix[np.diag_indices(self.slices)] += step / (1000 * self.stiffness)
        return matrix

    def carried(self, gap: Floats) -> tuple[Floats, float]:
        """Return the line load (slices,) in N/mm with another gap (slices,) in mm of the flanks, and the approach (mm)."""
        step, every = self.width / self.slices, gap + self.outer_gaps.pinion + self.outer_gaps.wheel
        width = np.full(self.slices, step)
        load, approach = complementary(self._springs, (every - every.min()) * step, width, self.base_force)
        return load, approach + float(every.min())

    @cached_property
    def solution(self) -> tuple[Floats, float]:
        """Line load (slices,) in N/mm, and the approach of the flanks (mm)."""
        return self.carried(self.given_gap)

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
        """Gaps (slices,) in µm under an even load, by their causes: bending, torsion, axial_tilt, outer of each shaft."""
        parts = {name: gap * self.base_force for name, gap in self.face.parts_per_newton.items()}
        outer = {f"outer_{number}": self.outer_gaps.pick(role) for number, role in enumerate(Role, 1)}
        named = {f"{name}_{n}": (parts | outer).get(f"{name}_{n}") for n in (1, 2) for name in _CAUSES}
        return {name: 1000 * gap for name, gap in named.items() if gap is not None and np.any(gap)}

    @cached_property
    def misalignment_of_shafts(self) -> float:
        """f_sh (µm): slope of the gap under an even load by least squares, over the face."""
        every = sum(self.even_gaps.values(), np.zeros(self.slices))
        return float(np.polyfit(self.places, every, 1)[0] * self.width)

    def state(self, role: Role, line_load: Floats | None = None) -> ShaftState | None:
        """Return the shaft of a gear under the load over the face and its other forces; None of a rigid one.

        The load is `line_load` (slices,) in N/mm if it is given, else that of the slices.
        """
        shaft = self.shafts.pick(role)
        if shaft is None:
            return None
        beam = replace(shaft, places=(*shaft.places, *self.face.stations(role)))
        sign, load = 1 if role is Role.WHEEL else -1, self.line_load if line_load is None else line_load
        own = sign * self.face.vectors(role, beam) @ load * self.width / self.slices
        return beam.solve(own + self._growth * beam.gear_loads)

    def to_dict(self) -> JsonObject:
        """Return f_sh under an even load, K_Hbeta, line loads (N/mm) and gaps (µm) slice by slice."""
        return {
            "F_bt": self.base_force,
            "mean_line_load": self.mean_load,
            "f_sh": self.misalignment_of_shafts,
            "misalignment": self.misalignment,
            "K_Hbeta_slices": self.face_load_factor,
            "K_Hbeta_end_of_face": self.face_load_factor_at_end,
            "line_load": self.line_load.tolist(),
            "approach": self.approach,
            "slices_at": self.places.tolist(),
            "gap_at_even_load_at_slices": {name: gap.tolist() for name, gap in self.even_gaps.items()},
        }


_CAUSES = ("bending", "torsion", "axial_tilt", "outer")
"""Causes of the gap that shafts leave."""
