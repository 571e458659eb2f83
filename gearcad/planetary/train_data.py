"""TrainData: the given values of a planetary train, its shafts, speeds (Willis), axial places and centre distance.

A set meshes central a with rim 2 and central b with rim 2' of the same planet; rings have negative teeth.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import Annotated, Literal, NamedTuple

from gearcad.core.errors import GeometryError, InputError, ParameterError
from gearcad.core.quantities import NOT_GIVEN, SPEED, Derived, Range, Whole, Words, derive, is_given
from gearcad.core.records import JsonObject, Role
from gearcad.geometry import Gear
from gearcad.geometry.mating import check_mates, check_shift_sum
from gearcad.geometry.pair_data import PairData
from gearcad.planetary.members import Carrier, Central, PairStage, Rim, SetMesh, SetType, mates_of

TURN = 2 * math.pi


class SetTeeth(NamedTuple):
    """z_a, z_2, z_2', z_b: those of central a, of its rim, of the rim of central b and of that; z_2 twice without a step."""

    a: int
    rim_a: int
    rim_b: int
    b: int

    @property
    def common(self) -> int:
        """g, the greatest common divisor of z_2 and z_2'."""
        return math.gcd(self.rim_a, self.rim_b)

    @property
    def positions(self) -> int:
        """q = |z_a z_2' - z_2 z_b|/g: planets fit at multiples of a full turn by q, and nowhere else; 0 if i_0 = 1."""
        return abs(self.a * self.rim_b - self.rim_a * self.b) // self.common


class Fit(NamedTuple):
    """Positions of planets: rotations (rad) of central a and of both rims of each planet; how many pitches mesh a is off
    there.
    """

    central_a: float
    rims_a: tuple[float, ...]
    rims_b: tuple[float, ...]
    misfits: tuple[float, ...]

    def adjusted(self, teeth: SetTeeth) -> Fit:
        """Return the fit with rim 2 of each planet turned against its rim 2' until it fits."""
        turned = (rim + misfit * TURN / teeth.rim_a for rim, misfit in zip(self.rims_a, self.misfits, strict=True))
        return self._replace(rims_a=tuple(turned), misfits=(0.0,) * len(self.misfits))


def meshing_angle(teeth: int, towards: float, mate_teeth: int, mate_rotation: float, mate_towards: float) -> float:
    """Rotation (rad) at which a gear has a tooth where its mate has a space, backlash split.

    `towards` and `mate_towards` are the directions from each gear's axis to where they mesh: opposite ones of external
    gears, equal ones of a ring and its pinion.
    """
    return towards + (mate_teeth * (mate_towards - mate_rotation) - math.pi) / teeth


def fit_planets(teeth: SetTeeth, angles: Sequence[float], *, central_b: float = 0.0, clocking: float = 0.0) -> Fit:
    """Planets, all alike, put in at `angles` about the axis (rad), with central b and rim 2' against rim 2 turned as given.

    z_b (psi - phi_b) + z_2' (psi + pi e_b - theta - kappa) = pi and z_a (psi - phi_a) + z_2 (psi + pi e_a - theta) = pi, both
    modulo 2 pi, e = 1 at external centrals: the first equation holds for every planet, and the second for planet 0. A stepped
    planet is turned on by the pitches of rim 2' that bring its rim 2 nearest to fitting; what is left is its misfit.
    """
    inside_a, inside_b = (math.pi * (central > 0) for central in (teeth.a, teeth.b))
    rims_b = [meshing_angle(teeth.rim_b, psi + inside_b, teeth.b, central_b, psi) for psi in angles]
    central_a = meshing_angle(teeth.a, angles[0], teeth.rim_a, rims_b[0] - clocking, angles[0] + inside_a)
    own, pitches = teeth.rim_a // teeth.common, teeth.rim_b // teeth.common
    turned, misfits = [], []
    for psi, rim in zip(angles, rims_b, strict=True):
        off = (teeth.a * (psi - central_a) + teeth.rim_a * (psi + inside_a - rim + clocking) - math.pi) / TURN
        steps = round(off * pitches)  # a pitch of rim 2' moves rim 2 by own/pitches of its pitches
        turned.append(rim + steps * pow(own, -1, pitches) % pitches * TURN / teeth.rim_b)
        misfits.append(off - steps / pitches)
    return Fit(central_a, tuple(rim - clocking for rim in turned), tuple(turned), tuple(misfits))


def permitted_steps(positions: int, planets: int) -> tuple[int, ...]:
    """Return which of the positions, numbers below `positions`, are nearest to equal angles, one for each planet.

    Where two positions are equally near, the planets balance each other as well as they can: the choice has the least
    |sum exp(i psi)|, and of equal ones the greater numbers.
    """
    nearest = []
    for number in range(planets):
        whole, rest = divmod(2 * positions * number, 2 * planets)
        nearest.append((whole + 1, whole) if rest == planets else (whole + (rest > planets),))

    def unbalance(steps: tuple[int, ...]) -> float:
        return round(abs(sum(cmath.exp(1j * TURN * step / positions) for step in steps)), 9)

    return min(product(*nearest), key=unbalance)


EQUAL: Literal["equal"] = "equal"
"""Word for planets at equal angles."""

PERMITTED: Literal["permitted"] = "permitted"
"""Planets where the teeth let them stand, as near to equal angles as can be."""

ADJUSTED: Literal["adjusted"] = "adjusted"
"""A clocking of each planet by itself."""

ANGLE_ROUNDING = 1e-3
"""Largest difference (degrees) between a given angle and the one at which the teeth fit that counts as rounding of printed
digits.
"""


@dataclass(frozen=True, kw_only=True)
class TrainData:
    """The fields of a `PlanetaryTrain`, unchecked. Lengths in mm, angles in degrees.

    `centrals` are two, each of which meshes with a rim of every planet; `rims` one, or two of a stepped planet. `fixed`,
    `input` and `output` are names of centrals, of the carrier, or of the free shaft of a stage; without `fixed` it is a
    differential. `centre_distance` is a magnitude, of both meshes; not given it is the one without backlash.
    """

    name: Annotated[str, Words("name")] = "train"
    planets: Annotated[int, Whole(1, 24), Words("number of planets", "N")]
    centrals: tuple[Central, ...]
    rims: tuple[Rim, ...]
    carrier: Carrier = field(default_factory=Carrier)
    input: Annotated[str, Words("input member")]
    output: Annotated[str, Words("output member")]
    fixed: Annotated[str | None, Words("fixed member")] = None
    stages: tuple[PairStage, ...] = ()
    centre_distance: Annotated[float, Range("mm", 0.0, None, ends="(]"), Words("centre distance", "a", "5.2")] = NOT_GIVEN
    planet_angles: Annotated[
        tuple[float, ...] | Literal["equal", "permitted"], Range("deg", -360.0, 360.0), Words("angles of the planets", "ψ")
    ] = EQUAL
    tip_distance: Annotated[float, Range("mm", 0.0, None), Words("distance planets' tips must keep")] = 0.0

    @cached_property
    def meshes(self) -> tuple[SetMesh, SetMesh]:
        """The mesh of each central with its rim, in the order of the centrals. Raises GeometryError where one cannot mesh."""
        first, second = (SetMesh.of(central, self.rim_of(central), float(self.centre_distance)) for central in self.centrals)
        return first, second

    def rim_of(self, central: Central) -> Rim:
        """Return the rim that a central meshes with."""
        return next(rim for rim in self.rims if rim.name == central.meshes)

    @property
    def gears(self) -> dict[str, Gear]:
        """Gears of the set by the names of their members and rims, then gears of the stages by their own names."""
        of_set = {central.name: central.gear for central in self.centrals} | {rim.name: rim.gear for rim in self.rims}
        return of_set | {gear.name: gear for stage in self.stages for gear in stage.pair.gears}

    @property
    def stepped(self) -> bool:
        """Whether the planets have two rims."""
        return len(self.rims) == 2

    @property
    def adjusted(self) -> bool:
        """Whether the rims of each planet are turned against each other by themselves until they fit."""
        return any(rim.clocking == ADJUSTED for rim in self.rims)

    @property
    def set_type(self) -> SetType:
        """A to D, by the rings among the centrals, and by whether the planets are stepped."""
        rings = sum(central.gear.internal for central in self.centrals)
        if rings == 1:
            return SetType.B if self.stepped else SetType.A
        return SetType.D if rings else SetType.C

    @property
    def basic_ratio(self) -> float:
        """i_0 = (w_a - w_c)/(w_b - w_c) = z_2 z_b/(z_a z_2') with the carrier at rest, a and b the centrals in their order."""
        a, b = self.meshes
        return (a.rim.gear.teeth * b.central.gear.teeth) / (a.central.gear.teeth * b.rim.gear.teeth)

    @property
    def teeth(self) -> SetTeeth:
        """z_a, z_2, z_2', z_b, with signs."""
        a, b = self.meshes
        return SetTeeth(a.central.gear.teeth, a.rim.gear.teeth, b.rim.gear.teeth, b.central.gear.teeth)

    @property
    def positions(self) -> int:
        """q = |z_a z_2' - z_2 z_b|/gcd(z_2, z_2'): planets fit at multiples of a full turn by q, and nowhere else."""
        return self.teeth.positions

    @cached_property
    def angles(self) -> tuple[float, ...]:
        """Angles of the planets on the carrier (degrees).

        Given angles are moved to the angles at which the teeth fit, if they differ by no more than ANGLE_ROUNDING. Angles of an
        `adjusted` train stay as given.
        """
        if self.planet_angles == EQUAL or not self.positions:
            return tuple(360 * number / self.planets for number in range(self.planets))
        step = 360 / self.positions
        if self.planet_angles == PERMITTED:
            return tuple(steps * step for steps in permitted_steps(self.positions, self.planets))
        first, *_ = given = [float(angle) for angle in self.planet_angles]
        if self.adjusted:
            return tuple(given)
        exact = [first + round((angle - first) / step) * step for angle in given]
        return tuple(near if abs(near - angle) <= ANGLE_ROUNDING else angle for near, angle in zip(exact, given, strict=True))

    @property
    def unbalance(self) -> float:
        """|sum exp(i psi)|: 0 where the planets balance each other, 1 of a planet alone."""
        return abs(sum(cmath.exp(1j * math.radians(angle)) for angle in self.angles))

    @property
    def members(self) -> tuple[str, ...]:
        """The members of the set: both centrals, and the carrier."""
        return (*(central.name for central in self.centrals), self.carrier.name)


@dataclass(frozen=True, kw_only=True)
class Link:
    """A stage on the way from the set outwards: `outer` is the gear on its far side."""

    stage: PairStage
    outer: Role

    @property
    def teeth(self) -> tuple[int, int]:
        """Signed numbers of teeth of the inner and the outer gear."""
        gears = self.stage.pair.gears
        return gears.pick(self.outer.mate).teeth, gears.pick(self.outer).teeth

    @property
    def shafts(self) -> tuple[str, str]:
        """Names of the inner and the outer shaft."""
        return getattr(self.stage, self.outer.mate.value), getattr(self.stage, self.outer.value)


@dataclass(frozen=True, kw_only=True)
class TrainShaft:
    """A member of the set, or a shaft that turns with the `member` through the stages of `path`, from the set outwards.

    `speed_ratio` is its speed over that of the member, exact.
    """

    name: str
    member: str
    speed_ratio: Fraction = Fraction(1)
    path: tuple[Link, ...] = ()

    def behind(self, stage: PairStage) -> TrainShaft:
        """Return the shaft at the other end of a stage that is on this one."""
        link = Link(stage=stage, outer=Role.WHEEL if stage.pinion == self.name else Role.PINION)
        inner, outer = link.teeth
        ratio, name = -Fraction(inner, outer), link.shafts[1]
        return TrainShaft(name=name, member=self.member, speed_ratio=self.speed_ratio * ratio, path=(*self.path, link))


def shafts_of(train: TrainData) -> dict[str, TrainShaft]:
    """Return every shaft by its name, the members of the set first. Raises GeometryError where a stage is not on one other
    shaft.
    """
    found = {name: TrainShaft(name=name, member=name) for name in train.members}
    waiting = list(train.stages)
    while waiting:
        stage = next((each for each in waiting if each.pinion in found or each.wheel in found), None)
        if stage is None:
            raise GeometryError(f"{waiting[0].name}.wheel", waiting[0].wheel, f"must be one of {', '.join(found)}")
        if stage.pinion in found and stage.wheel in found:
            permitted = f"must be a shaft of its own: {stage.pinion} and {stage.wheel} turn with each other or the set already"
            raise GeometryError(f"{stage.name}.wheel", stage.wheel, permitted)
        known = found[stage.pinion if stage.pinion in found else stage.wheel]
        shaft = known.behind(stage)
        found[shaft.name] = shaft
        waiting.remove(stage)
    return found


def willis_row(train: TrainData) -> dict[str, int]:
    """Whole numbers by which the speeds of the members are multiplied to add up to 0.

    w_a - i_0 w_b - (1 - i_0) w_c = 0 with i_0 = z_2 z_b/(z_a z_2'), times z_a z_2'.
    """
    a, b = train.centrals
    of_a = a.gear.teeth * train.rim_of(b).gear.teeth
    of_b = b.gear.teeth * train.rim_of(a).gear.teeth
    return dict(zip(train.members, (of_a, -of_b, of_b - of_a), strict=True))


def check_shafts(train: TrainData) -> None:
    """Raise GeometryError unless input, output and fixed turn with three different members, and the set has a ratio."""
    shafts = shafts_of(train)
    used: dict[str, str] = {}
    for role in ("input", "output", "fixed"):
        name = getattr(train, role)
        if name is None:
            continue
        member = shafts[name].member
        if member in used:
            other = used[member]
            raise GeometryError(role, name, f"must turn with another member of the set than {other} = {getattr(train, other)}")
        used[member] = role
    if willis_row(train)[train.carrier.name] == 0:
        a, b = train.centrals
        both = f"{a.name} and {b.name} turn as one and the {train.carrier.name} is free"
        raise GeometryError(f"{b.name}.teeth", b.gear.teeth, f"must give another basic ratio than 1: {both}")


@dataclass(frozen=True, kw_only=True)
class Speeds:
    """Speeds in rpm, positive counter-clockwise seen from +z.

    `members` has those of the set's members and of all shafts of stages by name; `planet` is that of a planet, and
    `planet_relative` the same seen from the carrier, as its pin feels it.
    """

    members: Mapping[str, float]
    planet: float
    planet_relative: float

    def to_dict(self) -> JsonObject:
        """Return the speeds as a document for JSON."""
        return {"members": dict(self.members), "planet": self.planet, "planet_relative": self.planet_relative}


def speeds(train: TrainData, given: Mapping[str, float]) -> Speeds:
    """Return all speeds (rpm) from those `given` by names of members or shafts.

    One speed is needed where a member is fixed, two of a differential.

    Raises ParameterError where a speed is missing, or follows from the others.
    """
    shafts = shafts_of(train)
    known = _member_speeds(train, shafts, given)
    row = willis_row(train)
    (missing,) = set(row) - set(known)
    # Zero is added where a product of signs would print as -0.
    known[missing] = -sum(row[name] * speed for name, speed in known.items()) / row[missing] + 0.0
    members = {shaft.name: float(shaft.speed_ratio * known[shaft.member]) + 0.0 for shaft in shafts.values()}
    central, turning = train.centrals[0], known[train.carrier.name]
    relative = -central.gear.teeth * (known[central.name] - turning) / train.rim_of(central).gear.teeth + 0.0
    return Speeds(members=members, planet=turning + relative, planet_relative=relative)


def check_speeds(train: TrainData, given: Mapping[str, float]) -> None:
    """Raise ParameterError where one of the speeds `given` (rpm) is of no member, or follows from those before it."""
    _given_speeds(train, shafts_of(train), given)


def _member_speeds(train: TrainData, shafts: Mapping[str, TrainShaft], given: Mapping[str, float]) -> dict[str, float]:
    """Return the two given speeds of members. Raises ParameterError."""
    known, by = _given_speeds(train, shafts, given)
    if len(known) < 2:
        free = [shaft.name for shaft in shafts.values() if shaft.member not in by]
        count, reason = ("one", "") if known else ("two", ": no member is fixed")
        raise ParameterError("speeds", sorted(given), f"must have {count} more, of {', '.join(free)}{reason}")
    return known


def _given_speeds(
    train: TrainData, shafts: Mapping[str, TrainShaft], given: Mapping[str, float]
) -> tuple[dict[str, float], dict[str, str]]:
    """Return the given speeds of members, at most two, and the shaft that each belongs to. Raises ParameterError."""
    told = {train.fixed: 0.0} if train.fixed else {}
    known: dict[str, float] = {}
    by: dict[str, str] = {}
    for name, speed in [*told.items(), *given.items()]:
        key = f"speeds.{name}"
        if name not in shafts:
            raise ParameterError(key, speed, f"belongs to no member: the members are {', '.join(shafts)}", "rpm")
        SPEED.require(key, speed)
        member = shafts[name].member
        if member in by:
            other = "is fixed" if by[member] == train.fixed else "is given"
            with_it = f"{by[member]} {other}" if name == by[member] else f"it turns with {by[member]}, which {other}"
            raise ParameterError(key, speed, f"must not be given too: {with_it}", "rpm")
        if len(known) == 2:
            raise ParameterError(key, speed, f"must not be given too: it follows from {_speeds_words(by)}", "rpm")
        by[member] = name
        known[member] = float(speed / shafts[name].speed_ratio) if speed else 0.0
    return known, by


def _speeds_words(by: Mapping[str, str]) -> str:
    return " and ".join(by.values())


_Extent = tuple[float, float]


def settle_heights(train: TrainData) -> None:
    """Let every `axial_position` that is not given be one: second rims above the first, with a module of room.

    Stages on the way to the output stand above the set, all others below, those next to the set first.
    """
    room = max(rim.gear.normal_module for rim in train.rims)
    first, *others = (_rim_extent(train, rim.name, rim.gear) for rim in train.rims)
    heights = [0.0, *(first[1] + room - other[0] for other in others)]
    rims = [
        rim if is_given(rim.axial_position) else replace(rim, axial_position=Derived(height))
        for rim, height in zip(train.rims, heights, strict=True)
    ]
    object.__setattr__(train, "rims", tuple(rims))
    levels = [rim.axial_position for rim in rims]
    ends = [(low + level, high + level) for (low, high), level in zip((first, *others), levels, strict=True)]
    _settle_stages(train, min(low for low, _ in ends), max(high for _, high in ends), room)


def _settle_stages(train: TrainData, low: float, high: float, room: float) -> None:
    """Set every `axial_position` that is not given, for the stages beside a set between two heights (mm)."""
    above = _way(train, train.output) or ()
    found: dict[str, PairStage] = {}
    nearest_first = sorted(train.stages, key=lambda stage: len(_way(train, stage.pinion) or ()))
    for stage in nearest_first:
        if not is_given(stage.axial_position):
            bottom, top = _stage_extent(stage)
            if stage in above:
                height = high + room - bottom
                high = height + top
            else:
                height = low - room - top
                low = height + bottom
            found[stage.name] = replace(stage, axial_position=Derived(height))
    object.__setattr__(train, "stages", tuple(found.get(stage.name, stage) for stage in train.stages))


def _way(train: TrainData, shaft: str, gone: tuple[PairStage, ...] = ()) -> tuple[PairStage, ...] | None:
    """Return the stages between a shaft and the set; None if they do not connect them."""
    if shaft in train.members:
        return gone
    for stage in train.stages:
        if stage not in gone and shaft in (stage.pinion, stage.wheel):
            other = stage.wheel if shaft == stage.pinion else stage.pinion
            if (found := _way(train, other, (*gone, stage))) is not None:
                return found
    return None


def _rim_extent(train: TrainData, name: str, rim: Gear) -> _Extent:
    """Return the lower and upper end (mm) of a rim and of what meshes with it, above the bottom of the rim's teeth."""
    centrals = [central.gear for central in train.centrals if central.meshes == name]
    ends = [_gear_extent(gear, (rim.face_width - gear.face_width) / 2) for gear in (rim, *centrals)]
    return min(low for low, _ in ends), max(high for _, high in ends)


def _stage_extent(stage: PairStage) -> _Extent:
    """Return the lower and upper end (mm) of a stage, above the bottom of the pinion's teeth."""
    ends = [_gear_extent(stage.pair.pinion, 0.0), _gear_extent(stage.pair.wheel, stage.pair.wheel_pose().z)]
    return min(low for low, _ in ends), max(high for _, high in ends)


def _gear_extent(gear: Gear, bottom: float) -> _Extent:
    """Return the lower and upper end (mm) of a gear with its hubs, whose teeth begin at `bottom`."""
    back, front = gear.body.hub_ends
    return bottom - back, bottom + gear.face_width + front


SAME_DISTANCE = 1e-4
"""Difference of two centre distances, in normal modules, that comes from profile shifts printed to four digits."""


def settle_centre_distance(train: TrainData) -> None:
    """Derive the centre distance unless it is given, and see that both meshes run at it. Raises InputError."""
    pairs = [mates_of(central, train.rim_of(central)) for central in train.centrals]
    distances = [_free_distance(pair) for pair in pairs]
    if is_given(train.centre_distance):
        _check_given(train, pairs, distances)
        return
    if abs(distances[0] - distances[1]) > SAME_DISTANCE * max(pair.pinion.normal_module for pair in pairs):
        raise _not_coaxial(train, pairs, distances)
    derive(train, "centre_distance", distances[0])
    train.meshes  # noqa: B018 - made now, so that what is refused of a mesh is refused here


def _free_distance(pair: PairData) -> float:
    """Return the centre distance (mm, a magnitude) at which a central and its rim run without backlash."""
    try:
        check_mates(pair)
        check_shift_sum(pair)
    except InputError as error:
        raise error.within(pair.name) from None
    return abs(pair.centre_distance_for(pair.profile_shift_sum))


def _check_given(train: TrainData, pairs: list[PairData], distances: list[float]) -> None:
    """Raise GeometryError, with both distances, where a mesh does not run at the one that is given."""
    try:
        train.meshes  # noqa: B018
    except InputError as error:
        if not error.parameter.endswith(".centre_distance"):
            raise
        failing = next(number for number, pair in enumerate(pairs) if error.parameter == f"{pair.name}.centre_distance")
        would = _shift_for(train, pairs, failing, float(train.centre_distance))
        permitted = f"must suit both meshes, which {_words(pairs, distances)}; {error}{would}"
        raise GeometryError("centre_distance", train.centre_distance, permitted, "mm") from None


def _not_coaxial(train: TrainData, pairs: list[PairData], distances: list[float]) -> GeometryError:
    """Return the error for meshes that run without backlash at two centre distances."""
    central, words = train.centrals[1], _words(pairs, distances)
    try:
        shift = _placed(pairs[1], distances[0]).zero_backlash_shift_sum - train.rim_of(central).gear.profile_shift
    except InputError:  # not even the base circles stand clear
        permitted = f"must suit one centre distance: the meshes {words}, too far apart for profile shifts"
        return GeometryError(f"{central.name}.teeth", central.gear.teeth, permitted)
    permitted = f"must be {shift:.4f} for one centre distance: the meshes {words}; or give one that suits both"
    return GeometryError(f"{central.name}.profile_shift", central.gear.profile_shift, permitted)


def _words(pairs: list[PairData], distances: list[float]) -> str:
    first, second = (f"{distance:.3f} mm ({pair.name})" for pair, distance in zip(pairs, distances, strict=True))
    return f"run without backlash at {first} and {second}"


def _placed(pair: PairData, distance: float) -> PairData:
    """Return the pair at a centre distance (mm, a magnitude)."""
    return replace(pair, centre_distance=-distance if pair.internal else distance)


def _shift_for(train: TrainData, pairs: list[PairData], number: int, distance: float) -> str:
    """Return a text that names the profile shift of a central with which its mesh runs at a distance (mm); "" if there is none.

    Without thinning that shift leaves no backlash. With thinning the text names the shift that leaves it as backlash, and the
    one that leaves none.
    """
    central = train.centrals[number]
    try:
        placed, other = _placed(pairs[number], distance), train.rim_of(central).gear.profile_shift
        tight, free = placed.fitting_shift_sum - other, placed.zero_backlash_shift_sum - other
    except InputError:  # not even the base circles stand clear
        return ""
    if free >= tight:
        return f"; {central.name}.profile_shift = {tight:.4f} would do, without backlash"
    return f"; {central.name}.profile_shift = {free:.4f} would do, with the thinning as backlash (at {tight:.4f} without any)"
