"""SteppedShaft: a round beam of segments on bearings, under forces, its weight and a coupling (Timoshenko, Cowper).

z runs along the shaft from its left end, x and y are square to it. Lengths in mm, forces in N, torques and moments in N·m,
stiffness of bearings in N/µm, tilting stiffness in N·m/rad; deflections in µm, inclinations in µm/mm, twist in degrees. Inside
formulas N, mm and rad.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Annotated, Literal

import numpy as np

from gearcad.core.errors import GeometryError, InputError, ParameterError
from gearcad.core.quantities import DENSITY, LENGTH, MODULUS, POISSON_RATIO, Choice, Range, Words, require_fields
from gearcad.core.records import Floats, JsonObject, Wholes, concise
from gearcad.material import STEEL_MODULUS
from gearcad.shafts.bearing_life import KINDS, SIDES

_POSITION = Range("mm", 0, 1e7)
_STIFFNESS = Range("N/µm", 0, 1e9)
_TILTING = Range("N·m/rad", 0, 1e15)
_RATING = Range("N", 1, 1e9)
_FACTOR = Range("", 0, 100)
_STRENGTH = Range("MPa", 1, 5000)
_SAME = 1e-9
"""Distance (mm) below which two positions are one."""

_ENDS = 1e-6
"""Distance (mm) by which a position may lie beyond the end of a shaft by rounding."""

_DOFS = 6
"""Displacements along x, y, z and turns about them of each node."""

_GRAVITY = 1e-9
"""N/mm³ of a density of 1 kg/m³ at 1 m/s²."""


_SAME_CORE = 1e-3
"""Distance (mm) within which a given outer diameter is the core of a spline."""


@lru_cache(64)
def core_diameter(designation: str) -> float:
    """Return the root diameter (mm) of a splined shaft by its designation, such as "W 30 x 1.25 x 22 x 8f".

    Raises ParameterError for a designation that names no shaft.
    """
    from gearcad.geometry import SplineJoint

    try:
        parts = SplineJoint(designation=designation).parts
    except InputError as error:
        raise ParameterError("spline", designation, error.permitted) from error
    if "shaft" not in parts:
        raise ParameterError("spline", designation, 'must name a shaft, such as "W 30 x 1.25 x 22 x 8f"')
    return float(parts["shaft"].gear.root_diameter)


@dataclass(frozen=True, kw_only=True)
class ShaftSegment:
    """A cylinder of a shaft, solid or hollow. Raises ParameterError, or GeometryError for a bore that leaves no wall.

    Strengths (MPa, of a bar of 16 mm), `roughness` Rz (µm) and the `fillet_radius` (mm) of the step to the segment on its right
    are for its strength (DIN 743). A segment with a `spline`, by its designation, has the core diameter of the splined shaft as
    its outer diameter: `core_diameter` gives it.
    """

    length: Annotated[float, LENGTH, Words("length of the segment")]
    outer_diameter: Annotated[float, LENGTH, Words("outer diameter", "d")]
    inner_diameter: Annotated[float, Range("mm", 0, 1e7), Words("inner diameter", "d_i")] = 0.0
    youngs_modulus: Annotated[float, MODULUS, Words("Young's modulus", "E")] = STEEL_MODULUS
    poisson_ratio: Annotated[float, POISSON_RATIO, Words("Poisson's ratio", "ν")] = 0.3
    density: Annotated[float, DENSITY, Words("density", "ρ")] = 7850.0
    tensile_strength: Annotated[float | None, _STRENGTH, Words("tensile strength", "R_m")] = None
    yield_strength: Annotated[float | None, _STRENGTH, Words("yield strength", "R_e")] = None
    roughness: Annotated[float | None, Range("µm", 0.01, 1000), Words("roughness of the surface", "Rz")] = None
    fillet_radius: Annotated[float | None, LENGTH, Words("fillet radius of the step on its right", "r")] = None
    spline: Annotated[str | None, Words("spline on the segment, by its designation")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        if self.spline is not None and abs(self.outer_diameter - (core := core_diameter(self.spline))) > _SAME_CORE:
            permitted = f"must be left out, or {core:.6g} mm, the core of {self.spline}"
            raise GeometryError("outer_diameter", self.outer_diameter, permitted, "mm")
        if self.inner_diameter >= self.outer_diameter:
            permitted = f"must be below {self.outer_diameter:g} mm, the outer diameter"
            raise GeometryError("inner_diameter", self.inner_diameter, permitted, "mm")

    @property
    def area(self) -> float:
        """Area of the section (mm²)."""
        return math.pi / 4 * (self.outer_diameter**2 - self.inner_diameter**2)

    @property
    def second_moment(self) -> float:
        """Second moment of area I (mm⁴); that of torsion is twice as much."""
        return math.pi / 64 * (self.outer_diameter**4 - self.inner_diameter**4)

    @property
    def section_modulus(self) -> float:
        """Section modulus W of bending (mm³); that of torsion is twice as much."""
        return 2 * self.second_moment / self.outer_diameter

    @property
    def shear_modulus(self) -> float:
        """Shear modulus G (MPa)."""
        return self.youngs_modulus / (2 * (1 + self.poisson_ratio))

    @property
    def shear_coefficient(self) -> float:
        """Shear coefficient kappa of hollow round sections (Cowper 1966)."""
        nu, ratio = self.poisson_ratio, (self.inner_diameter / self.outer_diameter) ** 2
        inner = (1 + ratio) ** 2
        return 6 * (1 + nu) * inner / ((7 + 6 * nu) * inner + (20 + 12 * nu) * ratio)

    def shear_deflection(self, length: float) -> float:
        """Return Phi = 12 E I/(kappa G A L^2) of a part of so much length (mm): deflection by shear over that by bending."""
        stiffness = self.shear_coefficient * self.shear_modulus * self.area * length**2
        return 12 * self.youngs_modulus * self.second_moment / stiffness

    def weight(self, length: float, gravity: Sequence[float]) -> Floats:
        """Return the nodal forces (12,) of the weight of a part of so much length (mm); `gravity` in m/s²."""
        line = self.density * _GRAVITY * self.area * np.asarray(gravity, float)
        found = np.zeros(2 * _DOFS)
        found[0:3] = found[6:9] = line * length / 2
        couple = length**2 / 12
        found[4], found[10] = line[0] * couple, -line[0] * couple
        found[3], found[9] = -line[1] * couple, line[1] * couple
        return found


def beam_stiffness(parts: Sequence[ShaftSegment], lengths: Floats) -> Floats:
    """Return the stiffness (n, 12, 12) of parts of these lengths (mm): dofs of the left node, then of the right one."""
    kinds = {id(part): part for part in parts}
    of_kind = {
        key: (part.youngs_modulus * part.second_moment, part.youngs_modulus * part.area, part.shear_deflection(1.0))
        for key, part in kinds.items()
    }
    bending, axial, shear = np.array([of_kind[id(part)] for part in parts]).T
    torsion = bending / np.array([1 + part.poisson_ratio for part in parts])
    shear = shear / lengths**2
    factor, far = bending / ((1 + shear) * lengths**3), 6 * lengths
    near, cross = (4 + shear) * lengths**2, (2 - shear) * lengths**2
    twelve = np.full_like(lengths, 12.0)
    rows = [
        [twelve, far, -twelve, far],
        [far, near, -far, cross],
        [-twelve, -far, twelve, -far],
        [far, cross, -far, near],
    ]
    plane = np.moveaxis(factor * np.array(rows), 2, 0)
    found = np.zeros((len(lengths), 2 * _DOFS, 2 * _DOFS))
    turned = np.array([1.0, -1.0, 1.0, -1.0])
    for places, block in (([0, 4, 6, 10], plane), ([1, 3, 7, 9], plane * np.outer(turned, turned))):
        found[np.ix_(range(len(lengths)), places, places)] = block
    pairs = np.array([[1.0, -1.0], [-1.0, 1.0]])
    for first, spring in ((2, axial / lengths), (5, torsion / lengths)):
        found[np.ix_(range(len(lengths)), [first, first + _DOFS], [first, first + _DOFS])] = spring[:, None, None] * pairs
    return found


@dataclass(frozen=True, kw_only=True)
class ShaftBearing:
    """A bearing: springs between a place of a shaft and the housing, "rigid" or of a stiffness, 0 where it gives no support.

    `offset` (µm, along x and y) is how far its seat lies off the axis. A tapered or angular contact bearing `pushes` the shaft
    to one side, "right" (towards larger z) or "left": face to face the left one pushes right. Neither clearance nor preload is
    taken into account. `kind`, dynamic and static ratings `C` and `C0` (N), `f0` of a deep groove ball bearing, or `e`, `Y`
    (beyond e; `Y1` up to e and `Y2` beyond it of a spherical one), the fatigue limit `C_u` (N) and the `pitch_diameter` (mm)
    are for its life. Bore `d`, outside diameter `D` and width `B` (mm) are for solids and drawings. Raises ParameterError, and
    GeometryError for sizes that do not belong together.
    """

    position: Annotated[float, _POSITION, Words("position of the bearing")]
    name: Annotated[str, Words("name of the bearing")] = ""
    kind: Annotated[str | None, Choice(KINDS), Words("kind of the bearing")] = None
    radial_stiffness: Annotated[float | Literal["rigid"], _STIFFNESS, Words("radial stiffness", "k_r")] = "rigid"
    axial_stiffness: Annotated[float | Literal["rigid"], _STIFFNESS, Words("axial stiffness", "k_a")] = 0.0
    tilting_stiffness: Annotated[float | Literal["rigid"], _TILTING, Words("tilting stiffness", "k_φ")] = 0.0
    offset: Annotated[tuple[float, float], Words("offset of the seat")] = (0.0, 0.0)
    pushes: Annotated[str | None, Choice(SIDES), Words("side to which it pushes the shaft")] = None
    C: Annotated[float | None, _RATING, Words("dynamic load rating", "C", "ISO 281")] = None
    C0: Annotated[float | None, _RATING, Words("static load rating", "C_0", "ISO 76")] = None
    f0: Annotated[float | None, _FACTOR, Words("factor of the axial load", "f_0", "ISO 281")] = None
    e: Annotated[float | None, _FACTOR, Words("limit of the axial load", "e", "ISO 281")] = None
    Y: Annotated[float | None, _FACTOR, Words("axial factor", "Y", "ISO 281")] = None
    Y1: Annotated[float | None, _FACTOR, Words("axial factor up to e", "Y_1", "ISO 281")] = None
    Y2: Annotated[float | None, _FACTOR, Words("axial factor beyond e", "Y_2", "ISO 281")] = None
    C_u: Annotated[float | None, _RATING, Words("fatigue load limit", "C_u", "ISO 281")] = None
    pitch_diameter: Annotated[float | None, LENGTH, Words("pitch diameter of the bearing", "D_pw", "ISO 281")] = None
    d: Annotated[float | None, LENGTH, Words("bore of the bearing", "d", "ISO 15")] = None
    D: Annotated[float | None, LENGTH, Words("outside diameter of the bearing", "D", "ISO 15")] = None
    B: Annotated[float | None, LENGTH, Words("width of the bearing", "B", "ISO 15")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        sizes = {"d": self.d, "D": self.D, "B": self.B}
        missing = [name for name, size in sizes.items() if size is None]
        if 0 < len(missing) < len(sizes):
            raise GeometryError(missing[0], None, "must be given: d, D and B belong together")
        if self.d is not None and self.D is not None and self.D <= self.d:
            raise GeometryError("D", self.D, f"must be above {self.d:g} mm, the bore", "mm")

    @property
    def ring(self) -> tuple[float, float, float] | None:
        """Bore, outside diameter and width (mm); None where they are not given."""
        return None if self.d is None or self.D is None or self.B is None else (self.d, self.D, self.B)

    def springs(self) -> tuple[float, ...]:
        """Stiffness in the six directions (N/mm, N mm/rad): infinite where rigid; the twist is free."""
        radial, axial = _of(self.radial_stiffness, 1e3), _of(self.axial_stiffness, 1e3)
        tilting = _of(self.tilting_stiffness, 1e3)
        return radial, radial, axial, tilting, tilting, 0.0


def _of(stiffness: float | str, factor: float) -> float:
    return math.inf if isinstance(stiffness, str) else stiffness * factor


@dataclass(frozen=True, kw_only=True)
class ShaftForce:
    """A force (N) on a shaft at `at` = (x, y) mm from its axis, with its moment about the axis' point there.

    A `torque` about z and a `moment` (M_x, M_y), in N·m, are added. Raises ParameterError.
    """

    position: Annotated[float, _POSITION, Words("position of the force")]
    force: tuple[float, float, float] = (0.0, 0.0, 0.0)
    at: tuple[float, float] = (0.0, 0.0)
    torque: Annotated[float, Range("N·m", -1e9, 1e9)] = 0.0
    moment: tuple[float, float] = (0.0, 0.0)

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)

    def load(self) -> Floats:
        """Return force and moment (6,) in N and N mm on the node at its position."""
        turning = np.cross([*self.at, 0.0], self.force) + 1000 * np.array([*self.moment, self.torque])
        return np.concatenate([np.asarray(self.force, float), turning])


@dataclass(frozen=True, kw_only=True, repr=False)
class GearForce(ShaftForce):
    """The force of another mesh on a shaft: it grows with the torque of the train."""


@dataclass(frozen=True, kw_only=True)
class SteppedShaft:
    """A shaft of segments from left to right on its bearings.

    The `coupling` (mm) is where its twist is held, and what torque is left over is taken. `gravity` in m/s². Raises
    ParameterError, and GeometryError for a shaft that its bearings do not hold, or what lies beside it.
    """

    segments: tuple[ShaftSegment, ...]
    bearings: tuple[ShaftBearing, ...]
    forces: tuple[ShaftForce, ...] = ()
    coupling: float = 0.0
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    places: tuple[float, ...] = ()
    """Further positions (mm) of which the state is wanted."""

    __repr__ = concise

    def __post_init__(self) -> None:
        if not self.segments:
            raise GeometryError("shaft", 0, "must have at least one segment")
        for name, positions in (
            ("bearing", [each.position for each in self.bearings]),
            ("force", [each.position for each in self.forces]),
            ("coupling", [self.coupling]),
        ):
            for number, position in enumerate(positions):
                if not -_ENDS <= position <= self.length + _ENDS:
                    key = name if name == "coupling" else f"{name}[{number}].position"
                    raise GeometryError(key, position, f"must be from 0 to {self.length:g} mm, on the shaft", "mm")

    @property
    def length(self) -> float:
        """Length of the shaft (mm)."""
        return math.fsum(each.length for each in self.segments)

    @cached_property
    def ends(self) -> tuple[float, ...]:
        """Positions (mm) of the ends of the segments."""
        return tuple(np.concatenate([[0.0], np.cumsum([each.length for each in self.segments])]).tolist())

    @cached_property
    def masses(self) -> Floats:
        """Mass (kg) of each segment."""
        found: Floats = np.array([each.density * 1e-9 * each.area * each.length for each in self.segments])
        return found

    def sizes(self) -> JsonObject:
        """Return length (mm), mass (kg), centre of mass (mm), moments of inertia (kg·m²) about the axis and across it at the
        centre of mass, torsional stiffness (N·m/rad) of the whole length, segments and bearings.
        """
        lengths = np.array([each.length for each in self.segments])
        middles = np.array(self.ends[:-1]) + lengths / 2
        gyration = np.array([(each.outer_diameter**2 + each.inner_diameter**2) / 16 for each in self.segments])
        centre = float(self.masses @ middles / self.masses.sum())
        twist = math.fsum(each.length / (2 * each.shear_modulus * each.second_moment) for each in self.segments)
        return {
            "length": self.length,
            "mass": float(self.masses.sum()),
            "centre_of_mass": centre,
            "polar_inertia": float(2e-6 * self.masses @ gyration),
            "transverse_inertia": float(1e-6 * self.masses @ (gyration + lengths**2 / 12 + (middles - centre) ** 2)),
            "torsional_stiffness": 1e-3 / twist,
            "segments": [
                {
                    "position": start,
                    "length": each.length,
                    "outer_diameter": each.outer_diameter,
                    "inner_diameter": each.inner_diameter,
                    "area": each.area,
                    "second_moment": each.second_moment,
                    "section_modulus": each.section_modulus,
                    "mass": mass,
                }
                for start, each, mass in zip(self.ends, self.segments, self.masses.tolist(), strict=False)
            ],
            "bearings": [{"name": each.name, "position": each.position} for each in self.bearings],
        }

    @cached_property
    def nodes(self) -> Floats:
        """Positions (n,) in mm of steps, bearings, forces, the coupling and further places, each once."""
        wanted = [*self.ends, *(each.position for each in self.bearings), *(each.position for each in self.forces)]
        every = np.sort(np.clip([*wanted, self.coupling, *self.places], 0.0, self.ends[-1]))
        found: Floats = every[np.concatenate([[True], np.diff(every) > _SAME])]
        return found

    def node_at(self, position: float) -> int:
        """Return the number of the node at a position (mm)."""
        return int(np.argmin(np.abs(self.nodes - position)))

    def segment_at(self, position: float) -> ShaftSegment:
        """Return the segment at a position (mm); at a step that on its left."""
        return self.segments[min(max(bisect_left(self.ends, position) - 1, 0), len(self.segments) - 1)]

    @cached_property
    def parts(self) -> tuple[ShaftSegment, ...]:
        """The segment of each part between two nodes."""
        middles = (self.nodes[1:] + self.nodes[:-1]) / 2
        return tuple(map(self.segment_at, middles.tolist()))

    @cached_property
    def elements(self) -> Floats:
        """Stiffness (n - 1, 12, 12) of the parts between the nodes."""
        return beam_stiffness(self.parts, np.diff(self.nodes))

    @cached_property
    def _body(self) -> Floats:
        """Stiffness (6 n, 6 n) of the shaft without its supports."""
        found = np.zeros((_DOFS * len(self.nodes),) * 2)
        for number, part in enumerate(self.elements):
            own = slice(_DOFS * number, _DOFS * (number + 2))
            found[own, own] += part
        return found

    @cached_property
    def _supported(self) -> tuple[Floats, Wholes]:
        """Stiffness with elastic bearings, and the dofs (k,) that are free."""
        matrix, held = self._body.copy(), {_DOFS * self.node_at(self.coupling) + 5}
        for bearing in self.bearings:
            first = _DOFS * self.node_at(bearing.position)
            for number, spring in enumerate(bearing.springs()):
                if math.isinf(spring):
                    held.add(first + number)
                else:
                    matrix[first + number, first + number] += spring
        free: Wholes = np.setdiff1d(np.arange(len(matrix)), sorted(held))
        return matrix, free

    @cached_property
    def compliance(self) -> Floats:
        """Displacements (6 n, 6 n) of all nodes by unit forces: mm/N, rad/(N mm). Raises GeometryError for a loose shaft."""
        if not (replace(self, places=()) if self.places else self)._held:
            permitted = "must hold the shaft: two bearings that are stiff radially, and one that is stiff axially"
            raise GeometryError("bearing", len(self.bearings), permitted)
        matrix, free = self._supported
        found = np.zeros_like(matrix)
        for plane in _PLANES:
            own = free[np.isin(free % _DOFS, plane)]
            part, scales = self._scaled(own)
            found[np.ix_(own, own)] = np.linalg.inv(part) / scales
        return found

    @cached_property
    def _held(self) -> bool:
        """Whether the bearings hold the shaft, by the least eigenvalue; further places do not change it."""
        free = self._supported[1]
        parts = [self._scaled(own)[0] for plane in _PLANES if len(own := free[np.isin(free % _DOFS, plane)])]
        every = [np.linalg.eigvalsh(part) for part in parts]
        return all(values[0] >= _LOOSE * values[-1] for values in every)

    def _scaled(self, own: Wholes) -> tuple[Floats, Floats]:
        """Return the stiffness of some dofs scaled to equal diagonals, and the scales of its entries."""
        part: Floats = self._supported[0][np.ix_(own, own)]
        scale = np.sqrt(np.abs(part.diagonal()))
        scales = np.outer(scale, scale)
        return part / scales, scales

    def plane_stiffness(self) -> tuple[Floats, set[int]]:
        """Return the stiffness (2 n, 2 n) of displacements and turns in one plane with elastic bearings, and what is held."""
        matrix, free = self._supported
        bending = np.flatnonzero(np.isin(np.arange(len(matrix)) % _DOFS, _PLANES[0]))
        return matrix[np.ix_(bending, bending)], set(np.flatnonzero(~np.isin(bending, free)).tolist())

    @cached_property
    def loads(self) -> Floats:
        """Forces and moments (6 n,) of the given forces, and of the weight, on the nodes."""
        found: Floats = self._forces + self._weights.sum(axis=0)
        return found

    @cached_property
    def _forces(self) -> Floats:
        return self.loads_of(self.forces)

    @property
    def gear_loads(self) -> Floats:
        """Forces and moments (6 n,) of other meshes on the nodes: the part of `loads` that grows with the torque."""
        return self.loads_of(tuple(each for each in self.forces if isinstance(each, GearForce)))

    def loads_of(self, forces: tuple[ShaftForce, ...]) -> Floats:
        """Return the forces and moments (6 n,) of some forces on the nodes."""
        found = np.zeros(_DOFS * len(self.nodes))
        for each in forces:
            first = _DOFS * self.node_at(each.position)
            found[first : first + _DOFS] += each.load()
        return found

    @cached_property
    def _weights(self) -> Floats:
        """Nodal forces (n - 1, 6 n) of the weight of each part."""
        found = np.zeros((len(self.parts), _DOFS * len(self.nodes)))
        for number, (part, length) in enumerate(zip(self.parts, np.diff(self.nodes).tolist(), strict=True)):
            found[number, _DOFS * number : _DOFS * (number + 2)] = part.weight(length, self.gravity)
        return found

    def solve(self, more: Floats | None = None) -> ShaftState:
        """Return the state under the loads, and under `more` forces and moments (6 n,) on the nodes."""
        loads = self.loads if more is None else self.loads + more
        matrix, free = self._supported
        moved = np.zeros(len(matrix))
        forced = loads.copy()
        for bearing in self.bearings:  # seats off the axis
            first = _DOFS * self.node_at(bearing.position)
            for number, (spring, shift) in enumerate(zip(bearing.springs(), bearing.offset, strict=False)):
                if math.isinf(spring):
                    moved[first + number] = shift / 1000
                else:
                    forced[first + number] += spring * shift / 1000
        forced -= matrix @ moved
        moved = moved + self.compliance @ np.where(np.isin(np.arange(len(matrix)), free), forced, 0.0)
        return ShaftState(self, moved, loads)


_PLANES = ((0, 4), (1, 3), (2,), (5,))
"""Directions of a node that move together: bending in x-z, bending in y-z, axial, twist. Sections are round."""

_LOOSE = 1e-13
"""Least eigenvalue over the greatest, of the stiffness scaled to equal diagonals, of a shaft that is held."""


@dataclass(frozen=True)
class ShaftState:
    """Displacements (6 n,) in mm and rad of the nodes of a shaft under loads (6 n,) in N and N mm."""

    shaft: SteppedShaft
    moved: Floats
    loads: Floats

    def at(self, position: float) -> Floats:
        """Return displacement and turn (6,) at a node (mm, rad)."""
        first = _DOFS * self.shaft.node_at(position)
        found: Floats = self.moved[first : first + _DOFS]
        return found

    @cached_property
    def _on_nodes(self) -> Floats:
        """Forces that hold each node (n, 6): those of bearings and coupling on the shaft (N, N mm)."""
        return (self.shaft._body @ self.moved - self.loads).reshape(-1, _DOFS)

    @cached_property
    def reactions(self) -> tuple[Floats, ...]:
        """Force and moment (6,) of each bearing on the shaft (N, N mm).

        A rigid direction that several bearings have at one place is shared evenly.
        """
        found = []
        for bearing in self.shaft.bearings:
            here = self.at(bearing.position) - np.array([*bearing.offset, 0, 0, 0, 0]) / 1000
            own = np.zeros(_DOFS)
            for number, spring in enumerate(bearing.springs()):
                if math.isinf(spring):
                    own[number] = self._on_nodes[self.shaft.node_at(bearing.position), number]
                else:
                    own[number] = -spring * here[number]
            found.append(own)
        return tuple(found)

    @property
    def coupling_torque(self) -> float:
        """Torque of the coupling on the shaft (N·m); 0 where it is no more than the rounding of the torques in the shaft."""
        found = float(self._on_nodes[self.shaft.node_at(self.shaft.coupling), 5])
        return 0.0 if abs(found) <= _ROUNDING * np.abs(self.cuts[..., 5]).max() else found / 1000

    @cached_property
    def stresses(self) -> Floats:
        """Nominal equivalent stress (n - 1, 2) in MPa at both ends of each part: (M_b/W + |N|/A)^2 + 3 (T/2W)^2, root."""
        modulus, area = (np.array([getattr(part, name) for part in self.shaft.parts])[:, None] for name in _OF_STRESS)
        cuts = self.cuts
        bending = np.hypot(cuts[..., 3], cuts[..., 4]) / modulus + np.abs(cuts[..., 2]) / area
        found: Floats = np.sqrt(bending**2 + 3 * (cuts[..., 5] / (2 * modulus)) ** 2)
        return found

    @cached_property
    def cuts(self) -> Floats:
        """Forces and moments (n - 1, 2, 6) which the part right of a cut puts on that left of it, at both ends of each part."""
        found = np.zeros((len(self.shaft.parts), 2, _DOFS))
        lengths = np.diff(self.shaft.nodes).tolist()
        for number, (part, length) in enumerate(zip(self.shaft.parts, lengths, strict=True)):
            own = slice(_DOFS * number, _DOFS * (number + 2))
            ends = self.shaft.elements[number] @ self.moved[own] - part.weight(length, self.shaft.gravity)
            found[number, 0], found[number, 1] = -ends[:_DOFS], ends[_DOFS:]
        return found

    def stations(self) -> list[JsonObject]:
        """Return position, deflection, inclination, twist and what is left and right of each node."""
        found: list[JsonObject] = []
        for number, position in enumerate(self.shaft.nodes.tolist()):
            x, y, z, about_x, about_y, about_z = self.at(position).tolist()
            station: JsonObject = {
                "position": position,
                "deflection": [1000 * x, 1000 * y, 1000 * z],
                "inclination": [1000 * about_y, -1000 * about_x],
                "twist": math.degrees(about_z),
            }
            for name, part, end in (("left", number - 1, 1), ("right", number, 0)):
                if 0 <= part < len(self.shaft.parts):
                    station[name] = _cut_document(self.cuts[part, end], float(self.stresses[part, end]))
            found.append(station)
        return found

    def to_dict(self) -> JsonObject:
        """Return reactions of the bearings and of the coupling on the shaft, and the stations."""
        reactions = [
            {"position": bearing.position, "force": own[:3].tolist(), "moment": (own[3:5] / 1000).tolist()}
            for bearing, own in zip(self.shaft.bearings, self.reactions, strict=True)
        ]
        return {"reactions": reactions, "coupling_torque": self.coupling_torque, "stations": self.stations()}


_ROUNDING = 1e-10
"""Share of the greatest torque in a shaft below which a torque is nothing but rounding."""

_OF_STRESS = ("section_modulus", "area")
"""Properties of a section that decide the stress."""


def _cut_document(cut: Floats, stress: float) -> JsonObject:
    """Return the forces of a cut, and the nominal equivalent stress (MPa)."""
    shear_x, shear_y, axial, about_x, about_y, torque = cut.tolist()
    return {
        "shear": [shear_x, shear_y],
        "axial_force": axial,
        "bending_moment": [about_x / 1000, about_y / 1000],
        "torque": torque / 1000,
        "equivalent_stress": stress,
    }
