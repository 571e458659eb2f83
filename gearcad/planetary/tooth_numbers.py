"""Tooth numbers of planetary sets: the task of a search, and the conditions of assembly and mesh of many sets at once.

Magnitudes in mm; angles in radians. The centre distance is the one at which the outer gears of a mesh with a sun have
SHIFT each, as far as no shift sum leaves its limits: 0 to MOST_SHIFT_SUM at a sun, -MOST_SHIFT_SUM to 0 in a ring.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, NamedTuple

import numpy as np

from gearcad.core.errors import ParameterError
from gearcad.core.quantities import Range, Whole, Words, require_fields
from gearcad.core.records import Bools, Floats, Indices, Wholes, concise
from gearcad.geometry import BasicRack
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.planetary.members import SetType

MOST_SHIFT_SUM = 1.2
"""Largest sum of profile shift coefficients of a mesh that makes a set coaxial: 0 to this value at a sun, 0 to its negative in
a ring.
"""

MEMBERS = {
    SetType.A: ("sun", "ring", "carrier"),
    SetType.B: ("sun", "ring", "carrier"),
    SetType.C: ("sun", "sun_2", "carrier"),
    SetType.D: ("ring", "ring_2", "carrier"),
}
"""Names of the members of each type: central a, central b, carrier."""

_RATIO = Range("", -1e4, 1e4)
_LEAST_RATIO = 1e-4
_TOLERANCE = Range("%", 0.0, 1000.0)
_TEETH = Whole(5, 500)
_MODULE = Range("mm", 0.01, 200.0)
"""Permitted normal module, as of a Gear."""

_LENGTH = Range("mm", 0.0, None, ends="(]")


class Roles(NamedTuple):
    """Names of the members that are driven, that drive, and that are held."""

    input: str
    output: str
    fixed: str


_USUAL = {
    SetType.A: Roles(input="sun", output="carrier", fixed="ring"),
    SetType.B: Roles(input="sun", output="carrier", fixed="ring"),
    SetType.C: Roles(input="carrier", output="sun_2", fixed="sun"),
    SetType.D: Roles(input="carrier", output="ring_2", fixed="ring"),
}


@dataclass(frozen=True, kw_only=True)
class SearchTask:
    """Task of a search. Lengths in mm, angles in degrees.

    `ratio` is speed of the input over speed of the output, negative where they turn against each other, met within
    `tolerance` (%). `planets`, `teeth` (of suns and planets) and `ring_teeth` are least and most. `module_2` is that of the
    second mesh of a stepped planet, None the same. `fixed`, `input` and `output` name sun, ring, carrier, sun_2 or ring_2;
    what is left out is as usual: the sun drives the carrier in a fixed ring, and of two suns or two rings the first is
    fixed and the carrier drives the second. `diameter` is the most over all teeth; `face_width` None is 10 modules, and
    `tip_distance` between neighbouring planets None is 1 module. Raises ParameterError.
    """

    ratio: Annotated[float, _RATIO, Words("ratio wanted", "i")]
    module: Annotated[float, _MODULE, Words("normal module of the first mesh", "m_n")]
    types: tuple[SetType, ...] = (SetType.A,)
    planets: tuple[int, int] = (3, 5)
    module_2: Annotated[float | None, _MODULE, Words("normal module of the second mesh")] = None
    fixed: str | None = None
    input: str | None = None
    output: str | None = None
    tolerance: Annotated[float, _TOLERANCE, Words("most deviation of the ratio")] = 1.0
    teeth: tuple[int, int] = (17, 100)
    ring_teeth: tuple[int, int] = (30, 200)
    diameter: Annotated[float | None, _LENGTH, Words("most diameter over all teeth")] = None
    helix_angle: Annotated[float, Range("deg", -75, 75), Words("helix angle of the first central", "β")] = 0.0
    face_width: Annotated[float | None, _LENGTH, Words("face width", "b")] = None
    tip_distance: Annotated[float | None, Range("mm", 0.0, None), Words("least distance between planets")] = None
    mesh_efficiency: Annotated[float, Range("", 0.0, 1.0, ends="(]"), Words("efficiency of a mesh", "η")] = 0.99

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        if abs(self.ratio) < _LEAST_RATIO:
            raise ParameterError("ratio", self.ratio, f"must be at least {_LEAST_RATIO:g} in size")
        if not self.types:
            raise ParameterError("types", self.types, "must have one of A, B, C, D")
        for name, kind in (("planets", Whole(1, 24)), ("teeth", _TEETH), ("ring_teeth", _TEETH)):
            self._check_ends(name, kind)
        if self.ring_teeth[1] <= self.teeth[0] and set(self.types) != {SetType.C}:
            raise ParameterError("ring_teeth", self.ring_teeth, f"must reach above {self.teeth[0]}, the least of the planets")
        if self.module_2 is not None and set(self.types) == {SetType.A}:
            raise ParameterError(
                "module_2", self.module_2, "applies to types B, C and D only: planets of type A have one rim", "mm"
            )
        for each in self.types:
            self.roles(each)

    def _check_ends(self, name: str, kind: Whole) -> None:
        """Check the pairs of least and most."""
        given = getattr(self, name)
        if not isinstance(given, tuple) or len(given) != 2:
            raise ParameterError(name, given, "must be two whole numbers, the least and the most")
        for end in given:
            kind.require(name, end)
        if given[0] > given[1]:
            raise ParameterError(name, given, "must have the least first")

    @property
    def modules(self) -> tuple[float, float]:
        """Normal modules (mm) of the first and the second mesh."""
        return self.module, self.module if self.module_2 is None else self.module_2

    @property
    def width(self) -> float:
        """Face width (mm)."""
        return 10 * self.module if self.face_width is None else self.face_width

    @property
    def least_distance(self) -> float:
        """Least distance (mm) between the tips of neighbouring planets."""
        return self.module if self.tip_distance is None else self.tip_distance

    def roles(self, kind: SetType) -> Roles:
        """Return the roles of members in a set of a type. Raises ParameterError.

        Given roles come first, then usual ones for members that are still free, then the remaining members.

        Raises ParameterError.
        """
        members = MEMBERS[kind]
        given: dict[str, str] = {}
        for role in Roles._fields:
            name = getattr(self, role)
            if name is None:
                continue
            if name not in members:
                raise ParameterError(role, name, f"must be {', '.join(members)} in a set of type {kind.value}")
            if name in given.values():
                raise ParameterError(role, name, "must differ from the members of the other roles")
            given[role] = name
        usual = {
            role: name for role, name in _USUAL[kind]._asdict().items() if role not in given and name not in given.values()
        }
        found = given | usual
        left = [name for name in members if name not in found.values()]
        return Roles(**found, **dict(zip([role for role in Roles._fields if role not in found], left, strict=True)))


class TeethGrid(NamedTuple):
    """Signed numbers of teeth z_a, z_2, z_2', z_b of sets of a type, each (n,)."""

    a: Wholes
    rim_a: Wholes
    rim_b: Wholes
    b: Wholes

    def picked(self, which: Bools | Indices) -> TeethGrid:
        """Return the sets with these indices, or those where a mask is true."""
        return TeethGrid(*(teeth[which] for teeth in self))

    @property
    def row(self) -> tuple[Wholes, Wholes, Wholes]:
        """Whole numbers (three arrays (n,)) by which the speeds of a, b and carrier add up to 0."""
        of_a, of_b = self.a * self.rim_b, self.rim_a * self.b
        return of_a, -of_b, of_b - of_a

    @property
    def positions(self) -> Wholes:
        """q, of which the number of planets must be a divisor."""
        return np.abs(self.row[2]) // np.gcd(self.rim_a, self.rim_b)


def grids(task: SearchTask, kind: SetType) -> Iterator[TeethGrid]:
    """Yield the sets of a type, those with one first central at a time; i_0 = 1 is left out."""
    (low, high), ring = task.teeth, MEMBERS[kind][0].startswith("ring")
    first, last = task.ring_teeth if ring else task.teeth
    planets, most = np.arange(low, high + 1), _window(task)
    for teeth in range(first, last + 1):
        rims = planets[planets < teeth] if ring else planets
        seconds = np.zeros(1, int) if kind is SetType.A else planets
        rim_a, rim_b, offset = (each.ravel() for each in np.meshgrid(rims, seconds, np.arange(-most, most + 1)))
        if kind is SetType.A:
            rim_b = rim_a
        a = np.full_like(rim_a, -teeth if ring else teeth)
        grid = TeethGrid(a, rim_a, rim_b, _second(task, kind, a + rim_a, rim_b, offset))
        yield grid.picked(_within(task, kind, grid))


def _window(task: SearchTask) -> int:
    """Return how many teeth the second central can be away from the number that is coaxial without profile shift.

    A centre distance changes by less than the shift sum in modules, and a tooth is half a module of it.
    """
    first, second = task.modules
    return math.ceil(2 * MOST_SHIFT_SUM * max(first / second, 1))


def _second(task: SearchTask, kind: SetType, total: Wholes, rim_b: Wholes, offset: Wholes) -> Wholes:
    """z_b: m (z_a + z_2) and m' (z_b + z_2') are alike in size, but for the offset."""
    first, second = task.modules
    size = np.rint(np.abs(total) * (first / second)).astype(int) + offset
    return size - rim_b if kind is SetType.C else -(size + rim_b)


def _within(task: SearchTask, kind: SetType, grid: TeethGrid) -> Bools:
    """Return a mask of the sets that are of the type and have a ratio.

    Their second central is within its limits and outside its planets.
    """
    low, high = task.teeth if kind is SetType.C else task.ring_teeth
    size = grid.b if kind is SetType.C else -grid.b
    within: Bools = (low <= size) & (size <= high) & (grid.row[2] != 0)
    if kind is not SetType.C:
        within &= size > grid.rim_b
    if kind is SetType.B and task.modules[0] == task.modules[1]:
        within &= grid.rim_a != grid.rim_b  # else it is of type A
    return within


SHIFT = 0.25
"""Profile shift that planets in rings get, and suns and planets where the centre distance lets them."""

ROUNDING = 1e-9
"""Difference of lengths, in modules, below which they count as equal."""

SHIFT_DIGITS = 4
"""Number of decimals of the profile shifts of planets."""

RACK = BasicRack()


@dataclass(frozen=True, kw_only=True)
class MeshedTeeth:
    """The meshes of centrals with rims, by their signed teeth (n,), at a centre distance that may not be known yet.

    What is an array has one value for each of them (n,); lengths in mm, angles in rad.
    """

    central: Wholes
    rim: Wholes
    module: float
    helix_angle: float

    @property
    def ring(self) -> Bools:
        """Mask of the meshes whose central is a ring."""
        result: Bools = self.central < 0
        return result

    @cached_property
    def transverse_angle(self) -> float:
        """Transverse pressure angle alpha_t."""
        return math.atan(math.tan(math.radians(RACK.pressure_angle)) / math.cos(self.helix_angle))

    @property
    def transverse_module(self) -> float:
        """Transverse module m_t (mm)."""
        return self.module / math.cos(self.helix_angle)

    @property
    def reference_distance(self) -> Floats:
        """Reference centre distance |a_d| (mm)."""
        result: Floats = self.transverse_module * np.abs(self.central + self.rim) / 2
        return result

    @property
    def _involute(self) -> float:
        return involute(math.degrees(self.transverse_angle))

    def distance_for(self, shift_sum: Floats | float) -> Floats:
        """|a| without backlash with x_1 + x_2."""
        total = self.central + self.rim
        value = self._involute + 2 * math.tan(math.radians(RACK.pressure_angle)) * shift_sum / total
        cosine = np.cos(np.radians(inverse_involute(value)))
        result: Floats = self.reference_distance * math.cos(self.transverse_angle) / cosine
        return result

    def working_angle(self, distance: Floats) -> Floats:
        """Working transverse pressure angle alpha_wt."""
        result: Floats = np.arccos(self.reference_distance * math.cos(self.transverse_angle) / distance)
        return result

    def shift_sum_at(self, distance: Floats) -> Floats:
        """x_1 + x_2 without backlash at |a|."""
        change = involute(np.degrees(self.working_angle(distance))) - self._involute
        result: Floats = (self.central + self.rim) * change / (2 * math.tan(math.radians(RACK.pressure_angle)))
        return result

    @property
    def limits(self) -> tuple[Floats, Floats]:
        """Least and the greatest |a| that profile shift permits: a sun's mesh takes a positive sum, a ring's a negative one."""
        most = np.where(self.ring, -MOST_SHIFT_SUM, MOST_SHIFT_SUM)
        return self.reference_distance, self.distance_for(most)

    def base_radius(self, teeth: Wholes) -> Floats:
        """r_b, a magnitude."""
        result: Floats = self.transverse_module * np.abs(teeth) / 2 * math.cos(self.transverse_angle)
        return result

    def form_reach(self, teeth: Wholes, shift: Floats) -> Floats:
        """Return the length of the base tangent out to the root form circle of an outer gear; below 0 it is undercut."""
        result: Floats = self.module * (shift - self.least_shift(teeth)) / math.sin(self.transverse_angle)
        return result

    def least_shift(self, teeth: Wholes) -> Floats:
        """Return the least profile shift of an outer gear without undercut.

        It is h_fP - rho (1 - sin alpha_n) - z sin^2 alpha_t/(2 cos beta).
        """
        straight = RACK.dedendum - float(RACK.root_radius) * (1 - math.sin(math.radians(RACK.pressure_angle)))
        a_tooth = math.sin(self.transverse_angle) ** 2 / (2 * math.cos(self.helix_angle))
        result: Floats = straight - a_tooth * teeth.astype(float)
        return result


@dataclass(frozen=True, kw_only=True)
class SetSizes:
    """Sets of one type with their centre distance and profile shifts; what is not `coaxial` has no meaning."""

    meshes: tuple[MeshedTeeth, MeshedTeeth]
    stepped: bool

    @classmethod
    def of(cls, task: SearchTask, teeth: TeethGrid, *, stepped: bool) -> SetSizes:
        """Return the sizes of the sets of a grid."""
        helix = math.radians(task.helix_angle)
        pairs = ((teeth.a, teeth.rim_a), (teeth.b, teeth.rim_b))
        first, second = (
            MeshedTeeth(central=central, rim=rim, module=module, helix_angle=helix)
            for (central, rim), module in zip(pairs, task.modules, strict=True)
        )
        return cls(meshes=(first, second), stepped=stepped)

    @cached_property
    def _limits(self) -> tuple[Floats, Floats]:
        lows, highs = zip(*(mesh.limits for mesh in self.meshes), strict=True)
        return np.maximum(*lows), np.minimum(*highs)

    @property
    def coaxial(self) -> Bools:
        """Mask of the sets in which one centre distance serves both meshes."""
        low, high = self._limits
        result: Bools = low <= high + ROUNDING * self.meshes[0].module
        return result

    @cached_property
    def distance(self) -> Floats:
        """|a|: the wanted one within the limits, in round figures where these are within them, too."""
        low, high = self._limits
        wanted: Floats = low
        for mesh in self.meshes:
            at_sun = np.where(mesh.ring, 0.0, mesh.distance_for(np.where(mesh.ring, 0.0, 2 * SHIFT)))
            wanted = np.maximum(wanted, at_sun).astype(float)
        wanted = np.minimum(wanted, high).astype(float)
        figures = rounded_up(wanted, -math.floor(math.log10(self.meshes[0].module / 50)))
        return np.where(figures <= high, np.maximum(figures, low), wanted)

    @cached_property
    def rim_shifts(self) -> tuple[Floats, Floats]:
        """Profile shifts x of the rims, to four digits; a plain planet has that of the sun's mesh for both."""
        first = self._rim_shift(self.meshes[0])
        return first, self._rim_shift(self.meshes[1]) if self.stepped else first

    def _rim_shift(self, mesh: MeshedTeeth) -> Floats:
        """Return x of the rims: SHIFT in a ring, half of the sum at a sun; more or less to avoid undercut of either gear."""
        total, least = mesh.shift_sum_at(self.distance), mesh.least_shift(mesh.rim)
        at_sun = np.minimum(total / 2, total - mesh.least_shift(mesh.central))
        shift = np.maximum(np.where(mesh.ring, SHIFT, at_sun), least)
        return rounded_up(shift, SHIFT_DIGITS)

    @cached_property
    def central_shifts(self) -> tuple[Floats, Floats]:
        """x of the centrals, from the centre distance."""
        first, second = (
            mesh.shift_sum_at(self.distance) - shift for mesh, shift in zip(self.meshes, self.rim_shifts, strict=True)
        )
        return first, second

    @cached_property
    def tip_alterations(self) -> tuple[Floats, Floats]:
        """k of both gears of a mesh with a sun, that keeps the tip clearance; 0 in a ring, but a plain planet has one k."""
        first, second = (self._tip_alteration(mesh) for mesh in self.meshes)
        return first, second

    def _tip_alteration(self, mesh: MeshedTeeth) -> Floats:
        change = (self.distance - mesh.reference_distance) / mesh.module - mesh.shift_sum_at(self.distance)
        result: Floats = np.where(mesh.ring, 0.0, np.minimum(change, 0.0))
        return result

    @cached_property
    def central_alterations(self) -> tuple[Floats, Floats]:
        """k of the centrals: of rings what ends their flanks on the planets' root form circles."""
        parts = zip(self.meshes, self.tip_alterations, self.rim_shifts, self.central_shifts, strict=True)
        first, second = (np.where(mesh.ring, self._clear_alteration(mesh, rim, central), k) for mesh, k, rim, central in parts)
        return first, second

    def _clear_alteration(self, mesh: MeshedTeeth, rim_shift: Floats, central_shift: Floats) -> Floats:
        """Return k of a ring that keeps |d_a2| >= 2 sqrt(r_b2^2 + (|T1T2| + t_Ff1)^2)."""
        tangent = self.distance * np.sin(mesh.working_angle(self.distance)) + mesh.form_reach(mesh.rim, rim_shift)
        least = np.hypot(mesh.base_radius(mesh.central), tangent)
        change = (np.abs(tip_radius(mesh, mesh.central, central_shift)) - least) / mesh.module
        return -rounded_up(np.maximum(-change, 0.0), SHIFT_DIGITS) + 0.0

    @cached_property
    def rim_tips(self) -> tuple[Floats, Floats]:
        """Tip radii of the rims."""
        first, second = self.tip_alterations
        alterations = (first, second) if self.stepped else (np.minimum(first, second),) * 2
        one, other = (
            tip_radius(mesh, mesh.rim, shift + k)
            for mesh, shift, k in zip(self.meshes, self.rim_shifts, alterations, strict=True)
        )
        return one, other

    @cached_property
    def central_tips(self) -> tuple[Floats, Floats]:
        """Tip radii of the centrals."""
        one, other = (
            np.abs(tip_radius(mesh, mesh.central, shift + k))
            for mesh, shift, k in zip(self.meshes, self.central_shifts, self.central_alterations, strict=True)
        )
        return one, other

    @property
    def diameter(self) -> Floats:
        """The greatest over all teeth: root circles of rings, and what the planets sweep."""
        reach = [2 * (self.distance + tip) for tip in self.rim_tips]
        for mesh, shift in zip(self.meshes, self.central_shifts, strict=True):
            root = mesh.transverse_module * np.abs(mesh.central) + 2 * mesh.module * (RACK.dedendum - shift)
            reach.append(np.where(mesh.ring, root, 0.0))
        result: Floats = np.max(reach, axis=0)
        return result


def rounded_up(value: Floats, digits: int) -> Floats:
    """Return values rounded up to a number of digits behind the point; rounding errors are not rounded up."""
    result: Floats = np.round(np.ceil(value * 10.0**digits - 1e-6) / 10.0**digits, max(digits, 0)) + 0.0
    return result


def tip_radius(mesh: MeshedTeeth, teeth: Wholes, rise: Floats) -> Floats:
    """Signed r_a with x + k."""
    result: Floats = mesh.transverse_module * teeth / 2 + mesh.module * (RACK.addendum + rise)
    return result


def ratios(task: SearchTask, kind: SetType, teeth: TeethGrid) -> Floats:
    """Return the speed of the input over speed of the output: what is fixed adds nothing to Willis's sum."""
    row, members, roles = teeth.row, MEMBERS[kind], task.roles(kind)
    result: Floats = -row[members.index(roles.output)] / row[members.index(roles.input)]
    return result


@dataclass(frozen=True)
class ManySets:
    """Sets of one type, each with a number of planets, (n,)."""

    task: SearchTask
    kind: SetType
    teeth: TeethGrid
    planets: Wholes

    def picked(self, which: Bools | Indices) -> ManySets:
        """Return the sets with these indices, or those where a mask is true."""
        return ManySets(self.task, self.kind, self.teeth.picked(which), self.planets[which])

    @cached_property
    def sizes(self) -> SetSizes:
        """Centre distances and profile shifts of the sets."""
        return SetSizes.of(self.task, self.teeth, stepped=self.kind is not SetType.A)

    @property
    def ratio(self) -> Floats:
        """Speed of the input over that of the output."""
        return ratios(self.task, self.kind, self.teeth)

    @cached_property
    def efficiency(self) -> Floats:
        """Efficiency from input to output (n,), with the sign of the rolling power that is consistent, as in `balance`."""
        members, roles = MEMBERS[self.kind], self.task.roles(self.kind)
        driving, driven, held = (members.index(name) for name in roles)
        speeds: list[Floats] = [np.ones_like(self.ratio)] * 3
        speeds[driven], speeds[held] = 1 / self.ratio, np.zeros_like(self.ratio)
        of_a, of_b, _ = (each.astype(float) for each in self.teeth.row)
        best = np.full_like(self.ratio, -np.inf)
        for sign in (1, -1):
            lossy = of_b * self.task.mesh_efficiency ** (2 * sign)
            torques = (of_a, lossy, -(of_a + lossy))
            with np.errstate(divide="ignore", invalid="ignore"):
                found = -torques[driven] * speeds[driven] / torques[driving]
                rolls = of_a / torques[driving] * (speeds[0] - speeds[2]) * sign >= 0
            best = np.where(rolls & (found > best), found, best)
        return best

    @property
    def in_phase(self) -> Wholes:
        """Number of meshes (n,) that have all planets in phase: z mod N = 0."""
        result: Wholes = (self.teeth.a % self.planets == 0).astype(int) + (self.teeth.b % self.planets == 0)
        return result

    @property
    def common(self) -> Wholes:
        """Product of the common divisors of the teeth that mesh: 1 is a hunting tooth everywhere."""
        teeth = self.teeth
        result: Wholes = np.gcd(teeth.a, teeth.rim_a) * np.gcd(teeth.b, teeth.rim_b)
        return result


def _fits(sets: ManySets) -> Bools:
    result: Bools = sets.teeth.positions % sets.planets == 0
    return result


def _coaxial(sets: ManySets) -> Bools:
    return sets.sizes.coaxial


def _whole_involutes(sets: ManySets) -> Bools:
    """Return a mask of the sets whose outer gears have no undercut."""
    sizes = sets.sizes
    whole = np.ones(len(sets.planets), bool)
    for mesh, rim, central in zip(sizes.meshes, sizes.rim_shifts, sizes.central_shifts, strict=True):
        whole &= (rim >= mesh.least_shift(mesh.rim) - ROUNDING) & (
            mesh.ring | (central >= mesh.least_shift(mesh.central) - ROUNDING)
        )
    return whole


def _meshing(sets: ManySets) -> Bools:
    """Return a contact ratio of 1 or more between the tips, all of it on involutes,
    and no tips that foul each other in a ring.
    """
    sizes, good = sets.sizes, np.ones(len(sets.planets), bool)
    parts = zip(sizes.meshes, sizes.rim_tips, sizes.central_tips, sizes.rim_shifts, sizes.central_shifts, strict=True)
    for mesh, rim_tip, central_tip, rim_shift, central_shift in parts:
        angle = mesh.working_angle(sizes.distance)
        tangent = sizes.distance * np.sin(angle)
        rim, central = (_reach(mesh, teeth, tip) for teeth, tip in ((mesh.rim, rim_tip), (mesh.central, central_tip)))
        pitch = math.pi * mesh.transverse_module * math.cos(mesh.transverse_angle)
        path = np.where(mesh.ring, rim - (central - tangent), rim + central - tangent)
        begins = np.where(mesh.ring, central > tangent, np.maximum(rim, central) < tangent)
        clear = ~mesh.ring | (_tip_margin(mesh, sizes.distance, (rim_tip, central_tip), (rim_shift, central_shift)) >= 0)
        good &= (path >= pitch) & begins & clear & (central > 0)
    return good


def _reach(mesh: MeshedTeeth, teeth: Wholes, tip: Floats) -> Floats:
    """Return the length of the base tangent out to a tip circle; 0 inside the base circle."""
    base = mesh.base_radius(teeth)
    result: Floats = np.sqrt(np.maximum((tip - base) * (tip + base), 0.0))
    return result


def _tip_margin(mesh: MeshedTeeth, distance: Floats, tips: tuple[Floats, Floats], shifts: tuple[Floats, Floats]) -> Floats:
    """Return the angle by which the tips of planet and ring pass each other where their tip circles cross; infinite where they
    do not.
    """
    outer, inner = tips
    half = []  # tooth angle of the rim, space angle of the ring, at the tips
    for teeth, tip, shift, sign in zip((mesh.rim, -mesh.central), tips, shifts, (1, -1), strict=True):
        thick = (math.pi / 2 + sign * 2 * shift * math.tan(math.radians(RACK.pressure_angle))) / teeth
        at_tip = np.degrees(np.arccos(np.clip(mesh.base_radius(teeth) / tip, -1.0, 1.0)))
        half.append(thick + involute(math.degrees(mesh.transverse_angle)) - involute(at_tip))
    first = (inner**2 - outer**2 - distance**2) / (2 * distance * outer)
    second = (distance**2 + inner**2 - outer**2) / (2 * distance * inner)
    crossing = (np.abs(first) < 1) & (np.abs(second) < 1)
    angles = [np.arccos(np.clip(each, -1.0, 1.0)) for each in (first, second)]
    margin = (angles[0] - half[0]) * mesh.rim / np.abs(mesh.central) + half[1] - angles[1]
    return np.where(crossing, margin, np.inf)


def _tips_clear(sets: ManySets) -> Bools:
    """Tips stay off the roots of a ring and its planets; those at suns keep the clearance of the rack."""
    sizes, good = sets.sizes, np.ones(len(sets.planets), bool)
    parts = zip(sizes.meshes, sizes.rim_tips, sizes.central_tips, sizes.rim_shifts, sizes.central_shifts, strict=True)
    for mesh, rim_tip, central_tip, rim_shift, central_shift in parts:
        root_of_ring = -tip_radius(mesh, mesh.central, central_shift - RACK.addendum - RACK.dedendum)
        root_of_rim = tip_radius(mesh, mesh.rim, rim_shift - RACK.addendum - RACK.dedendum)
        inside = (root_of_ring - sizes.distance > rim_tip) & (central_tip - sizes.distance > root_of_rim)
        good &= ~mesh.ring | inside
    return good


def _neighbours(sets: ManySets) -> Bools:
    """Return a mask of the sets whose neighbouring planets keep their tip distance, rim by rim."""
    apart = 2 * sets.sizes.distance * np.sin(math.pi / sets.planets)
    most = np.maximum(*sets.sizes.rim_tips)
    result: Bools = (sets.planets == 1) | (apart - 2 * most >= sets.task.least_distance)
    return result


def _small(sets: ManySets) -> Bools:
    most = math.inf if sets.task.diameter is None else sets.task.diameter
    result: Bools = sets.sizes.diameter <= most
    return result


def _turns(sets: ManySets) -> Bools:
    result: Bools = sets.efficiency > 0
    return result


CONDITIONS: dict[str, Callable[[ManySets], Bools]] = {
    "planets at equal angles": _fits,
    "one centre distance": _coaxial,
    "no undercut": _whole_involutes,
    "clearance of tips": _tips_clear,
    "contact ratio and interference": _meshing,
    "distance of planets": _neighbours,
    "diameter": _small,
    "no self-locking": _turns,
}
"""Words of each condition, and the function that says where it is met, in the order in which sets must meet them."""
