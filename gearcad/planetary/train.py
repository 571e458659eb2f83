"""PlanetaryTrain: a set of planets of any type with one carrier, its assembly, clearances and notices."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from gearcad.core.errors import GeometryError, ParameterError, at_least, at_most, require_name
from gearcad.core.quantities import require_fields, schema_of
from gearcad.core.records import JsonObject, Notice, concise, texts
from gearcad.geometry import Gear
from gearcad.planetary.members import Carrier, Central, PairStage, Rim, SetMesh
from gearcad.planetary.poses import GearPlace, MeshPhases, TrainPose, assembled, mesh_phases, train_pose
from gearcad.planetary.train_data import (
    EQUAL,
    PERMITTED,
    SetTeeth,
    TrainData,
    check_shafts,
    settle_centre_distance,
    settle_heights,
    speeds,
)

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


_APART = 1e-9
"""Overlap of face widths (mm) that is rounding."""


# ---------------------------------------------------------------------- neighbours


class Gap(NamedTuple):
    """The least angle (degrees) between neighbouring planets, and which these are, from 0."""

    angle: float
    planets: tuple[int, int]


def least_gap(train: TrainData) -> Gap:
    """Return the least angle between neighbouring planets, for two planets or more."""
    order = sorted(range(train.planets), key=lambda number: train.angles[number] % 360)
    around = [(*order, order[0])[i : i + 2] for i in range(len(order))]
    return min(Gap((train.angles[b] - train.angles[a]) % 360, (a, b)) for a, b in around)


def most_planets(train: TrainData) -> int:
    """Return the number of planets at equal angles that have room for every rim, whether their teeth fit or not."""
    share = max(_least_axis_distance(train, rim) for rim in train.rims) / (2 * float(train.centre_distance))
    return 1 if share >= 1 else max(math.ceil(math.pi / math.asin(share)) - 1, 1)


def with_room(train: TrainData) -> list[int]:
    """Return the numbers of planets, from 1 on, whose teeth fit at equal angles and that have room."""
    return [number for number in range(1, most_planets(train) + 1) if train.adjusted or train.positions % number == 0]


def free_distance(train: TrainData) -> float | None:
    """Return the least distance (mm) between the tips of neighbouring planets; None of a planet alone."""
    if train.planets == 1:
        return None
    return _apart(train, least_gap(train)) - max(rim.gear.tip_diameter for rim in train.rims)


def check_neighbours(train: TrainData) -> None:
    """Raise GeometryError unless 2 a sin(gap/2) is above tip diameter and tip distance of each rim."""
    if train.planets == 1:
        return
    gap = least_gap(train)
    apart = _apart(train, gap)
    rim = max(train.rims, key=lambda each: _least_axis_distance(train, each))
    if apart > _least_axis_distance(train, rim):
        return
    first, second = (number + 1 for number in gap.planets)
    free = f" and {train.tip_distance:g} mm shall be free" if train.tip_distance else ""
    tips = f"tips of {rim.name} reach {rim.gear.tip_diameter:.6g} mm"
    why = f"the axes of planets {first} and {second} are {apart:.6g} mm apart, {tips}"
    most, fitting = most_planets(train), with_room(train)[-1]
    teeth = "" if fitting == most else f" ({fitting}, for teeth to fit too)"
    if train.planet_angles == EQUAL:
        raise GeometryError("planets", train.planets, f"must be at most {most}{teeth}: {why}{free}")
    permitted = f"must be farther apart: {why}{free}; at equal angles {most} have room{teeth}"
    raise GeometryError("planet_angles", train.planet_angles, permitted)


def _apart(train: TrainData, gap: Gap) -> float:
    """Return the distance (mm) of the axes of neighbours."""
    return 2 * float(train.centre_distance) * math.sin(math.radians(gap.angle) / 2)


def _least_axis_distance(train: TrainData, rim: Rim) -> float:
    """Return the least distance (mm) of axes that a rim needs."""
    return rim.gear.tip_diameter + train.tip_distance


# ---------------------------------------------------------------------- heights


class Span(NamedTuple):
    """Range of heights from `low` to `high` (mm)."""

    low: float
    high: float

    def meets(self, other: Span) -> bool:
        """Return whether two ranges have more than rounding in common."""
        return min(self.high, other.high) - max(self.low, other.low) > _APART


def check_heights(train: TrainData) -> None:
    """Raise ParameterError or GeometryError unless teeth at the same height that do not mesh are clear of each other."""
    first = train.rims[0]
    for name, value, unit in (("axial_position", first.axial_position, "mm"), ("clocking", first.clocking, "deg")):
        if value:
            raise ParameterError(f"{first.name}.{name}", value, f"must be 0 {unit}: positions are measured from this rim", unit)
    fouled = next(_fouled(train), None)
    if fouled is None:
        return
    if not train.stepped:
        raise GeometryError("rims", 1, f"must be two, one above the other: {fouled}")
    low, high = _clear_positions(train)
    permitted = f"must be at least {at_least(high)} or at most {at_most(low)} mm: {fouled}"
    raise GeometryError(f"{train.rims[1].name}.axial_position", train.rims[1].axial_position, permitted, "mm")


def teeth_spans(train: TrainData) -> dict[str, Span]:
    """Return the heights (mm) over which the teeth of rims and centrals stand, by names."""
    spans = {rim.name: Span(rim.axial_position, rim.axial_position + rim.gear.face_width) for rim in train.rims}
    for mesh in train.meshes:
        low = mesh.rim.axial_position + (mesh.rim.gear.face_width - mesh.central.gear.face_width) / 2
        spans[mesh.central.name] = Span(low, low + mesh.central.gear.face_width)
    return spans


def _fouled(train: TrainData) -> Iterator[str]:
    """Yield one sentence for each collision of rims and centrals."""
    spans = teeth_spans(train)
    for one, other in pairwise(train.rims):
        if spans[one.name].meets(spans[other.name]):
            yield f"the rims of a planet, {one.name} and {other.name}, stand at the same height"
    a, b = train.centrals
    if spans[a.name].meets(spans[b.name]) and _centrals_overlap(a, b):
        yield f"{a.name} and {b.name} stand at the same height"
    for central in train.centrals:
        for rim in train.rims:
            if rim.name != central.meshes and spans[rim.name].meets(spans[central.name]):
                if (depth := _reach(train, central, rim)) >= 0:
                    yield f"{rim.name} stands at the height of {central.name} and reaches {at_most(depth)} mm into it"


def _centrals_overlap(a: Central, b: Central) -> bool:
    """Return whether centrals at the same height would overlap: two suns, two rings, or a sun as large as the ring."""
    if a.gear.internal is b.gear.internal:
        return True
    return a.gear.tip_diameter + b.gear.tip_diameter >= 0


def _reach(train: TrainData, central: Central, rim: Rim) -> float:
    """Return how far (mm) the tips of a rim reach beyond those of a central without mesh between them; negative if clear."""
    distance = -float(train.centre_distance) if central.gear.internal else float(train.centre_distance)
    return (rim.gear.tip_diameter + central.gear.tip_diameter) / 2 - distance


def _clear_positions(train: TrainData) -> tuple[float, float]:
    """Return the positions (mm) of the second rim below and above which nothing of both meshes stands at the same height."""
    first, second = train.meshes if train.meshes[0].rim is train.rims[0] else train.meshes[::-1]
    widths = [max(mesh.rim.gear.face_width, mesh.central.gear.face_width) for mesh in (first, second)]
    level = (first.rim.gear.face_width - second.rim.gear.face_width) / 2
    return level - sum(widths) / 2, level + sum(widths) / 2


def stage_notices(train: TrainData) -> Iterator[Notice]:
    """Yield a notice for each gear of a stage that would collide with planets or central gears.

    Tip circles are checked, not shafts and bodies.
    """
    heights, reaches = teeth_spans(train), _reaches(train)
    for stage, pose in zip(train.stages, train_pose(train).stages, strict=True):
        for role, place in pose.gears.items():
            gear = stage.pair.gears.pick(role)
            height, reach = Span(place.height, place.height + gear.face_width), _stage_room_reach(gear, place)
            met = [name for name in heights if height.meets(heights[name]) and reach.meets(reaches[name])]
            if met:
                text = f"its {role.value} stands at the height of {', '.join(met)}: another axial_position is clear of them"
                yield Notice("stage-in-the-way", text, where=stage.name)


def _reaches(train: TrainData) -> dict[str, Span]:
    """Return the radial range (mm, from the axis of the train) over which the teeth of rims and centrals pass, by names."""
    distance = float(train.centre_distance)
    found = {rim.name: Span(distance - rim.gear.tip_diameter / 2, distance + rim.gear.tip_diameter / 2) for rim in train.rims}
    return found | {central.name: _stage_room_reach(central.gear, GearPlace(0.0, 0.0, 0.0, 0.0)) for central in train.centrals}


def _stage_room_reach(gear: Gear, place: GearPlace) -> Span:
    """Return the radial range (mm) of a gear in its place: outside the tips of a ring, or inside those of another gear."""
    off, radius = math.hypot(place.x, place.y), abs(gear.tip_diameter) / 2
    return Span(max(radius - off, 0.0), math.inf) if gear.internal else Span(max(off - radius, 0.0), off + radius)


MISFIT = 1e-7
"""Distance, in pitches, by which teeth may miss their spaces due to rounding."""

_NEAR = 4
"""Largest change of a gear's number of teeth in the search for a set that can be assembled."""

_OFFERED = 4
"""Largest number of such sets that a message names."""


def check_errors(train: TrainData) -> None:
    """Raise ParameterError unless there are as many errors as planets, or none."""
    given = {f"{rim.name}.tooth_errors": rim.tooth_errors for rim in train.rims}
    given[f"{train.carrier.name}.pin_errors"] = train.carrier.pin_errors
    for name, values in given.items():
        if len(values) not in (0, train.planets):
            permitted = f"must be {train.planets} values, one a planet, or none; there are {len(values)}"
            raise ParameterError(name, list(values), permitted)


def check_angles(train: TrainData) -> None:
    """Raise ParameterError unless there are as many angles as planets, or a word in their place."""
    angles = train.planet_angles
    if angles not in (EQUAL, PERMITTED) and (isinstance(angles, str) or len(angles) != train.planets):
        permitted = f'must be "equal", "permitted" or {train.planets} angles, one a planet'
        raise ParameterError("planet_angles", angles, permitted)


def check_assembly(train: TrainData) -> None:
    """Raise GeometryError or ParameterError, with values that would do, unless all parts have room and the teeth fit."""
    check_heights(train)
    try:
        check_neighbours(train)
    except GeometryError as error:
        if misfit := first_misfit(train):
            raise GeometryError(error.parameter, error.value, f"{error.permitted}; and {misfit[1]}", error.unit) from error
        raise
    check_teeth(train)


def check_teeth(train: TrainData) -> None:
    """Raise GeometryError unless the teeth fit where the planets stand.

    The error names the angles where they would fit, and which sets near by can.
    """
    if misfit := first_misfit(train):
        angle, off = misfit
        near = " or ".join(f"{each:.7g}" for each in _fitting_beside(train, angle))
        permitted = f"must let the teeth fit: {off}, it fits at {near} deg; {_what_can(train)}"
        raise GeometryError("planet_angles", train.planet_angles, permitted)


def first_misfit(train: TrainData) -> tuple[float, str] | None:
    """Return the angle (degrees) of the first planet whose teeth miss their spaces, and in words by how much;
    None if all fit.
    """
    for number, (angle, misfit) in enumerate(zip(train.angles, assembled(train).misfits, strict=True), start=1):
        if abs(misfit) > MISFIT:
            return angle, f"planet {number} at {angle:.7g} deg is {abs(misfit):.4g} pitches off in {train.meshes[0].name}"
    return None


def _fitting_beside(train: TrainData, angle: float) -> tuple[float, float]:
    """Return the angles (degrees) next below and above an angle at which the teeth fit."""
    step, start = 360 / train.positions, train.angles[0]
    below = start + math.floor((angle - start) / step) * step
    return below, below + step


def _what_can(train: TrainData) -> str:
    """Return a text that names all angles that fit, and how planets at equal angles would."""
    everywhere = f"all multiples of 360/{train.positions} deg do"
    if train.planet_angles != EQUAL:
        return everywhere
    words = [everywhere, '"permitted" takes the nearest']
    if planets := fitting_planets(train):
        words.append(f"at equal angles planets = {_either(planets)} fit")
    if sets := fitting_teeth(train):
        changed = _either([f"{name}.teeth = {teeth}" for name, teeth in sets])
        words.append(f"{train.planets} fit with {changed} and profile shifts to suit")
    return "; ".join(words)


def _either(values: tuple[int, ...] | list[str]) -> str:
    return " or ".join(map(str, values))


def fitting_planets(train: TrainData) -> tuple[int, ...]:
    """Return the numbers of planets next below and above, from 2 on, that have room and fit at equal angles."""
    fitting = with_room(train)[1:]
    below = [number for number in fitting if number < train.planets][-1:]
    return (*below, *[number for number in fitting if number > train.planets][:1])


def fitting_teeth(train: TrainData) -> tuple[tuple[str, int], ...]:
    """Return tooth numbers of one gear each, nearest to its own, with which the planets fit at equal angles."""
    a, b = train.meshes
    names = (a.central.name, a.rim.name, b.rim.name, b.central.name)
    found = []
    for more in (sign * size for size in range(1, _NEAR + 1) for sign in (-1, 1)):
        for name in dict.fromkeys(names):
            teeth = SetTeeth(*(z + more * (each == name) for z, each in zip(train.teeth, names, strict=True)))
            if teeth.positions and teeth.positions % train.planets == 0:
                found.append((name, teeth[names.index(name)]))
    return tuple(found[:_OFFERED])


_WIDE = 0.1
"""Backlash in normal modules that no gear is made with on purpose."""

_BALANCED = 1e-9
"""Unbalance below which it is rounding."""


def train_notices(train: TrainData) -> Iterator[Notice]:
    """Yield the notices of a train.

    They are about pairs, backlash, teeth that meet too often, stages in the way, and planets that do not balance each other.
    """
    for mesh in train.meshes:
        yield from _named(mesh)
        module, backlash = mesh.pair.pinion.normal_module, mesh.pair.circumferential_backlash
        if backlash > _WIDE * module:
            text = f"its backlash is {backlash:.4g} mm, {backlash / module:.2g} normal modules"
            yield Notice("wide-backlash", text, where=mesh.name)
        central, rim = mesh.central.gear.tooth_count, mesh.rim.gear.tooth_count
        if (common := math.gcd(central, rim)) > 1:
            text = f"{central} and {rim} teeth have the factor {common}: a tooth meets only one in {common} of its mate's"
            yield Notice("no-hunting-tooth", text, where=mesh.name)
    for stage in train.stages:
        yield from (notice.within(stage.name) for notice in stage.pair.notices)
    yield from stage_notices(train)
    if train.adjusted:
        text = "the rims of each planet are clocked by themselves: the planets are not alike, and each fits in its own place"
        yield Notice("adjusted-planets", text)
    if train.unbalance > _BALANCED:
        alone = "a planet alone has nothing that balances it" if train.planets == 1 else "the planets do not balance each other"
        yield Notice("unbalanced", f"{alone}: they pull outwards as {train.unbalance:.4g} of one (|sum exp(i psi)|)")


def _named(mesh: SetMesh) -> Iterator[Notice]:
    """Yield the notices of a pair, with the gears under their names."""
    names = {mesh.central_role.value: mesh.central.name, mesh.rim_role.value: mesh.rim.name}
    for notice in mesh.pair.notices:
        text = re.sub(r"\b(?:the )?(pinion|wheel)\b", lambda found: names[found[1]], notice.text)
        yield replace(notice, text=text).within(mesh.name)


_DOCUMENT_KEYS = ("planets", "input", "output", "fixed", "tip_distance", "basic_ratio", "positions", "unbalance")


def train_document(train: TrainData) -> JsonObject:
    """Return the given and derived values of a train, with its meshes, as a document for JSON.

    The gears have documents of their own.
    """
    parts: list[Central | Rim | Carrier] = [*train.centrals, *train.rims, train.carrier]
    notices = tuple(train_notices(train))
    return {
        "set_type": train.set_type.value,
        **{key: getattr(train, key) for key in _DOCUMENT_KEYS},
        "centre_distance": float(train.centre_distance),
        "free_tip_distance": free_distance(train),
        "planet_angles": list(train.angles),
        "members": {part.name: _fields(part) for part in parts},
        "meshes": {mesh.name: mesh.pair.to_dict() for mesh in train.meshes},
        "stages": {stage.name: _fields(stage) | stage.pair.to_dict() for stage in train.stages},
        "warnings": list(texts(notices)),
        "notices": [notice.to_dict() for notice in notices],
    }


def _fields(part: DataclassInstance) -> dict[str, Any]:
    """Return the given values of a part beside its gears; tuples become lists, as in JSON."""
    fields = {
        name: getattr(part, name) for name, field in schema_of(type(part)).items() if field.part is None and name != "name"
    }
    return {name: list(value) if isinstance(value, tuple) else value for name, value in fields.items()}


@dataclass(frozen=True, kw_only=True)
class PlanetaryTrain(TrainData):
    """Planets on one carrier between two centrals: types A to D are one class, simple or stepped, any member fixed or none.

    Lengths in mm, angles in degrees, speeds in rpm. Raises ParameterError, and GeometryError where it cannot be assembled.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        require_name("name", self.name)
        self._check_parts()
        require_fields(self)
        self._check_names()
        check_shafts(self)
        check_angles(self)
        settle_heights(self)
        settle_centre_distance(self)
        check_assembly(self)
        check_errors(self)  # last: another number of planets is looked at for its assembly first

    @property
    def ratio(self) -> float | None:
        """i, speed of the input over that of the output; None of a differential, where a second speed decides it."""
        if self.fixed is None:
            return None
        found = speeds(self, {self.input: 1.0}).members
        return found[self.input] / found[self.output]

    def to_dict(self) -> JsonObject:
        """Return the given and derived values for JSON (the gears have their own)."""
        return {"ratio": self.ratio, **train_document(self)}

    def _check_parts(self) -> None:
        """Check that the parts are of the right number and types."""
        for name, kind, least, most in (("centrals", Central, 2, 2), ("rims", Rim, 1, 2), ("stages", PairStage, 0, 8)):
            given = getattr(self, name)
            if not isinstance(given, tuple) or not all(isinstance(each, kind) for each in given):
                raise ParameterError(name, given, f"must be a tuple of {kind.__name__}")
            if not least <= len(given) <= most:
                count = f"{least}" if least == most else f"{least} to {most}"
                raise ParameterError(name, len(given), f"must be {count}")
        if not isinstance(self.carrier, Carrier):
            raise ParameterError("carrier", self.carrier, "must be a Carrier")

    def _check_names(self) -> None:
        """Check that every name is used once, and that each name referred to exists."""
        rims = [rim.name for rim in self.rims]
        shafts = [*self.members, *(end for stage in self.stages for end in (stage.pinion, stage.wheel))]
        named = [*self.members, *rims]
        for name in named:
            if named.count(name) > 1:
                raise ParameterError("name", name, "must be given once: members and rims need names of their own")
        for central in self.centrals:
            if central.meshes not in rims:
                raise ParameterError(f"{central.name}.meshes", central.meshes, f"must be {' or '.join(rims)}")
        if unused := set(rims) - {central.meshes for central in self.centrals}:
            raise GeometryError("rims", min(unused), "must mesh with a central")
        for role in ("input", "output", "fixed"):
            value = getattr(self, role)
            if value not in shafts and not (role == "fixed" and value is None):
                raise ParameterError(role, value, f"must be {', '.join(dict.fromkeys(shafts))}")
        if len({self.input, self.output, self.fixed}) < 3:
            raise ParameterError("output", self.output, "must be another member than input and fixed")

    def pose(self, carrier_angle: float = 0.0, central_turn: float = 0.0) -> TrainPose:
        """Return all gears in mesh, with the carrier at an angle and the fixed central (else the second) turned (degrees)."""
        return train_pose(self, carrier_angle, central_turn)

    @cached_property
    def phases(self) -> dict[str, MeshPhases]:
        """Phases of both meshes by name (`mesh_phases`), at carrier angle 0; the input turns counter-clockwise and drives."""
        return mesh_phases(self)

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """Notices on the train, to be read before making it."""
        return tuple(train_notices(self))
