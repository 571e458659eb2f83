"""TrainPlan: the bodies of a planetary train, their places in mesh or moved apart, their room, and a carrier.

Gears that mesh are judged where teeth are; here are those that only stand side by side: a rim and the central of the other
rim, the two rims of a planet, rings, and the gears of stages.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import chain

from gearcad.core.errors import GeometryError, at_least, at_most
from gearcad.core.records import PerGear, Role
from gearcad.geometry import Gear
from gearcad.geometry.bore_teeth import free_bore
from gearcad.planetary import PairStage, PlanetaryTrain
from gearcad.planetary.poses import PlanetPose, TrainPose
from gearcad.solids.body_plan import STAGE_COLOURS, TRAIN_COLOURS, Axle, Colour, require_rim

_UNNAMED = ("gear", "pinion", "wheel")
"""Default names of gears without a name."""

_DARKER = 0.82
"""A stage's colours against those of the stage before it."""


@dataclass(frozen=True)
class TrainBody:
    """A gear of which a train may have many: called `key` in the train and as a file, `name` as a product."""

    key: str
    name: str
    gear: Gear
    colour: Colour


@dataclass(frozen=True)
class Standing:
    """A body in its place: turned by `rotation` (degrees) about its axle, its teeth from the height z (mm) on."""

    name: str
    body: TrainBody
    axle: Axle
    rotation: float
    z: float

    @property
    def offset(self) -> tuple[float, float, float]:
        """Position (x, y, z) in mm of the body's own origin."""
        return self.axle.x, self.axle.y, self.z

    @property
    def extent(self) -> tuple[float, float]:
        """Lowest and highest z (mm) of the body, hubs included."""
        back, front = self.body.gear.body.hub_ends
        return self.z - back, self.z + self.body.gear.face_width + front


@dataclass(frozen=True)
class TrainLayout:
    """Every body of a train in its place: what stands by itself, and the planets one by one, each with its rims.

    `lifts` says by how much (mm) bodies of a key stand higher than in mesh. With `as_made` the gears are as they are made, and
    all distances are scaled as the first of them shrinks.
    """

    train: PlanetaryTrain
    pose: TrainPose
    lifts: Mapping[str, float] = field(default_factory=dict)
    as_made: bool = False

    @cached_property
    def bodies(self) -> dict[str, TrainBody]:
        """The gears that are made, by their keys: those of the planets once."""
        bodies = train_bodies(self.train)
        return {key: replace(body, gear=body.gear.as_made) for key, body in bodies.items()} if self.as_made else bodies

    @cached_property
    def _scales(self) -> tuple[float, float]:
        """Scale of distances across and along the axis."""
        making = next(iter(self.bodies.values())).gear.making
        return (making.radial_scale, making.axial_scale) if self.as_made else (1.0, 1.0)

    @cached_property
    def carrier(self) -> Axle:
        """The axle of the carrier."""
        return Axle(self.train.carrier.name)

    @cached_property
    def centrals(self) -> tuple[Standing, ...]:
        """Suns and rings, in the order of the train."""
        rotations, heights = self.pose.rotations, self.pose.heights
        names = (central.name for central in self.train.centrals)
        return tuple(self._standing(name, name, Axle(name), rotations[name], heights[name]) for name in names)

    @cached_property
    def planets(self) -> tuple[tuple[Standing, ...], ...]:
        """The rims of each planet. A planet of one rim is called `planet_1`, the rims of a stepped one `planet_1 NAME`."""
        word = "planet"
        while any(name.startswith(f"{word}_") for name in (*self.bodies, *self.train.members)):
            word += "_"
        return tuple(self._planet(f"{word}_{n}", pose) for n, pose in enumerate(self.pose.planets, 1))

    @cached_property
    def stages(self) -> tuple[Standing, ...]:
        """Pinion and wheel of each stage, in their order."""
        found: list[Standing] = []
        for stage, keys, posed in zip(self.train.stages, stage_keys(self.train), self.pose.stages, strict=True):
            for role, place in posed.gears.items():
                shaft, key = getattr(stage, role.value), keys.pick(role)
                axle = self.carrier if shaft == self.carrier.name else Axle(shaft, place.x, place.y)
                found.append(self._standing(key, key, axle, place.rotation, place.height))
        return tuple(found)

    @property
    def standing(self) -> Iterator[Standing]:
        """All bodies in their places: centrals, planets, stages."""
        return chain(self.centrals, chain.from_iterable(self.planets), self.stages)

    def _planet(self, name: str, pose: PlanetPose) -> tuple[Standing, ...]:
        axle, heights, stepped = Axle(name, pose.x, pose.y, self.carrier), self.pose.heights, self.train.stepped
        return tuple(
            self._standing(f"{name} {key}" if stepped else name, key, axle, rotation, heights[key])
            for key, rotation in pose.rotations.items()
        )

    def _standing(self, name: str, key: str, axle: Axle, rotation: float, height: float) -> Standing:
        across, along = self._scales
        place = axle if across == 1 else replace(axle, x=axle.x * across, y=axle.y * across)
        return Standing(name, self.bodies[key], place, rotation, height * along + self.lifts.get(key, 0.0))


def stage_keys(train: PlanetaryTrain) -> list[PerGear[str]]:
    """Return the names of the gears of each stage. A gear has its own name if no other gear has it."""
    taken = [*train.members, *(rim.name for rim in train.rims)]
    taken += [gear.name for stage in train.stages for gear in stage.pair.gears]

    def key(stage: PairStage, role: Role) -> str:
        name = stage.pair.gears.pick(role).name
        return f"{stage.name}-{role.value}" if taken.count(name) > 1 else name

    return [PerGear.each(partial(key, stage)) for stage in train.stages]


def train_bodies(train: PlanetaryTrain) -> dict[str, TrainBody]:
    """Return the gears of a train by their keys: centrals, rims, pinion and wheel of each stage,
    no two of one name or colour.
    """
    gears = {central.name: central.gear for central in train.centrals} | {rim.name: rim.gear for rim in train.rims}
    for stage, keys in zip(train.stages, stage_keys(train), strict=True):
        gears |= {keys.pick(role): gear for role, gear in stage.pair.gears.items()}
    ours = {key: f"{train.name} {key}" for key in gears}
    own = {key: ours[key] if gear.name in (*_UNNAMED, key) else gear.name for key, gear in gears.items()}
    names = own if len({train.name, *own.values()}) == 1 + len(gears) else ours
    colours = _colours(train)
    return {key: TrainBody(key, names[key], gear, next(colours)) for key, gear in gears.items()}


def _colours(train: PlanetaryTrain) -> Iterator[Colour]:
    """Yield a colour for each body: of centrals, rims, and gears of stages."""
    kinds = {internal: iter(TRAIN_COLOURS["rings" if internal else "suns"]) for internal in (False, True)}
    yield from (next(kinds[central.gear.internal]) for central in train.centrals)
    yield from TRAIN_COLOURS["rims"][: len(train.rims)]
    for number in range(len(train.stages)):
        shade = _DARKER**number
        yield from ((red * shade, green * shade, blue * shade) for red, green, blue in STAGE_COLOURS)


_TOUCHING = 1e-9
"""Lengths (mm) that are rounding: bodies may stand face to face."""

_Extent = tuple[float, float]


@dataclass(frozen=True)
class SweptSpace:
    """Room that a part of a body sweeps: between two radii about its own axis, between two heights (mm)."""

    standing: Standing
    radii: _Extent
    heights: _Extent

    @property
    def distance(self) -> float:
        """Distance (mm) of the body's axis from the train's."""
        return math.hypot(self.standing.axle.x, self.standing.axle.y)

    def about_the_train(self) -> _Extent:
        """Return the radii between which it is, seen from the axis of the train (mm)."""
        inner, outer = self.radii
        return max(self.distance - outer, inner - self.distance, 0.0), self.distance + outer


def require_bodies(layout: TrainLayout) -> None:
    """Raise GeometryError, which begins with its name, for a ring without a rim: its teeth alone are no body."""
    for body in layout.bodies.values():
        if body.gear.internal:
            try:
                require_rim(body.gear)
            except GeometryError as error:
                raise error.within(body.key) from error


def require_room(layout: TrainLayout) -> None:
    """Raise GeometryError, with the axial positions that would do, where bodies stand in each other."""
    train, planet = layout.train, layout.planets[0]
    if train.stepped:
        rims = {central.name: central.meshes for central in train.centrals}
        second = train.rims[1]
        upper = [each for each in (*layout.centrals, *planet) if rims.get(each.body.key, each.body.key) == second.name]
        lower = [each for each in (*layout.centrals, *planet) if each not in upper]
        _require_apart(f"{second.name}.axial_position", second.axial_position, upper, lower)
    stages = layout.stages
    for number, stage in enumerate(train.stages):
        own, before = stages[2 * number : 2 * number + 2], stages[: 2 * number]
        _require_apart(f"{stage.name}.axial_position", stage.axial_position, own, [*layout.centrals, *planet, *before])


def _require_apart(parameter: str, value: float, moved: Sequence[Standing], others: Sequence[Standing]) -> None:
    """Raise GeometryError if bodies that an axial position moves intersect any of the others."""
    pairs = [
        (one, other)
        for mine in moved
        for theirs in others
        for one in sweeps(mine)
        for other in sweeps(theirs)
        if _side_by_side(one, other)
    ]
    within = [(one, other) for one, other in pairs if overlap(one.heights, other.heights)]
    if not within:
        return
    one, other = within[0]
    above = value + max(other.heights[1] - one.heights[0] for one, other in pairs)
    below = value - max(one.heights[1] - other.heights[0] for one, other in pairs)
    names = f"{one.standing.body.key} and {other.standing.body.key} stand in each other"
    raise GeometryError(parameter, value, f"must be at least {at_least(above)} or at most {at_most(below)} mm: {names}", "mm")


def sweeps(standing: Standing) -> Iterator[SweptSpace]:
    """Yield the teeth of a gear down to its bore, or out to its rim, and its hubs."""
    gear, body = standing.body.gear, standing.body.gear.body
    bottom, top = standing.z, standing.z + gear.face_width
    tip, bore = abs(gear.tip_diameter) / 2, free_bore(gear) / 2
    yield SweptSpace(standing, (tip, require_rim(gear) / 2) if gear.internal else (bore, tip), (bottom, top))
    back, front = body.hub_ends
    for low, high in ((bottom - back, bottom), (top, top + front)):
        if high > low:
            yield SweptSpace(standing, (bore, body.hub_diameter / 2), (low, high))


def _side_by_side(one: SweptSpace, other: SweptSpace) -> bool:
    """Return whether two bodies would intersect at one height."""
    if _off_axis(one) and _off_axis(other):
        axles = one.standing.axle, other.standing.axle
        apart = math.hypot(axles[0].x - axles[1].x, axles[0].y - axles[1].y)
        same = apart < _TOUCHING
        return overlap(one.radii, other.radii) if same else apart < one.radii[1] + other.radii[1] - _TOUCHING
    return overlap(one.about_the_train(), other.about_the_train())


def _off_axis(sweep: SweptSpace) -> bool:
    """Return whether a body turns about an axis of its own that does not move."""
    return sweep.distance > _TOUCHING and sweep.standing.axle.on is None


def overlap(one: _Extent, other: _Extent) -> bool:
    """Return whether two ranges (mm) have more than an end in common."""
    return one[0] < other[1] - _TOUCHING and other[0] < one[1] - _TOUCHING


_RIM, _THICKNESS, _GAP = 0.6, 0.5, 0.1
"""Rim of a plate beside the pins, its thickness, and its gap to what turns, as shares of the pin's diameter."""


@dataclass(frozen=True)
class CarrierPlan:
    """Pins of one `diameter` about the axes `pins` (x, y), over the heights `reach`, and the plates they stand in (mm).

    The plates are rings from `inner` to `outer` radius; `plates` has the heights between which each lies, one or two.
    """

    pins: tuple[tuple[float, float], ...]
    diameter: float
    inner: float
    outer: float
    reach: _Extent
    plates: tuple[_Extent, ...]

    def lifted(self, by: float) -> CarrierPlan:
        """Return the same plan, higher by so much (mm)."""
        low, high = self.reach
        return replace(self, reach=(low + by, high + by), plates=tuple((bottom + by, top + by) for bottom, top in self.plates))


def carrier_plan(layout: TrainLayout) -> CarrierPlan:
    """Return the carrier of a train in mesh; a plate for which a stage leaves no room is left out.

    Raises GeometryError for planets without bores, and where there is room for no plate.
    """
    rims = layout.planets[0]
    for rim in rims:
        if not rim.body.gear.body.bore:
            permitted = "must be above 0 mm: the pins of the carrier go through it"
            raise GeometryError(f"{rim.body.key}.body.bore", 0.0, permitted, "mm")
    bore, given = min(free_bore(rim.body.gear) for rim in rims), layout.train.carrier.pin_diameter
    if given is not None and given > bore:
        raise GeometryError("carrier.pin_diameter", given, f"must be at most {bore:g} mm, the bore of the planets", "mm")
    diameter = bore if given is None else given
    distance, half = float(layout.train.centre_distance), (0.5 + _RIM) * diameter
    radii = max(distance - half, 0.0), distance + half
    extents = [each.extent for each in chain(layout.centrals, rims)]
    low, high = min(low for low, _ in extents), max(high for _, high in extents)
    gap, thickness = _GAP * diameter, _THICKNESS * diameter
    sides = ((low - gap - thickness, low - gap), (high + gap, high + gap + thickness))
    stages = [sweep for each in layout.stages for sweep in sweeps(each)]
    plates = tuple(_free(sides, radii, ((low - gap, low), (high, high + gap)), stages))
    if not plates:
        words = ", ".join(f"{bottom:.6g} to {top:.6g}" for bottom, top in sides)
        permitted = f"must be left out: the stages are where its plates would be, at heights of {words} mm"
        raise GeometryError("carrier", True, permitted)
    ends = [end for plate in plates for end in plate]
    pins = [rim.extent for rim in rims]
    reach = min(*ends, *(low for low, _ in pins)), max(*ends, *(high for _, high in pins))
    return CarrierPlan(tuple((planet.x, planet.y) for planet in layout.pose.planets), diameter, *radii, reach, plates)


def _free(sides: tuple[_Extent, ...], radii: _Extent, gaps: tuple[_Extent, ...], stages: list[SweptSpace]) -> Iterator[_Extent]:
    """Yield the plates that collide with nothing, and whose pins collide with nothing."""
    for plate, gap in zip(sides, gaps, strict=True):
        reach = min(*plate, *gap), max(*plate, *gap)
        if not any(overlap(reach, sweep.heights) and overlap(radii, sweep.about_the_train()) for sweep in stages):
            yield plate


_EXPLODED_GAP = 0.3
"""Distance between parts that were moved apart, as a share of the widest part, so that an oblique view looks between them."""


def moved_apart(layout: TrainLayout, carrier: CarrierPlan | None = None) -> TrainLayout:
    """Return the layout with members above each other, in the order in which they stand; planets stay beside each
    other, and so do the gears of a stage.

    A carrier, under the name it has in the train, stands above all.
    """
    planet = layout.planets[0]
    extents = {each.body.key: each.extent for each in (*layout.centrals, *planet, *layout.stages)}
    members = ((layout.centrals[0],), planet, (layout.centrals[1],), *zip(*2 * [iter(layout.stages)], strict=True))
    groups = [tuple(each.body.key for each in member) for member in members]
    spans = {keys: (min(extents[key][0] for key in keys), max(extents[key][1] for key in keys)) for keys in groups}
    ordered = sorted(groups, key=lambda keys: round(sum(spans[keys]), 9))  # those at one height stay in the order of the train
    if carrier is not None:
        name = (layout.carrier.name,)
        spans[name] = carrier.reach
        ordered.append(name)
    gap = _EXPLODED_GAP * max(abs(body.gear.tip_diameter) for body in layout.bodies.values())
    lifts: dict[str, float] = {}
    floor = spans[ordered[0]][0]
    for keys in ordered:
        low, high = spans[keys]
        lifts |= dict.fromkeys(keys, floor - low)
        floor += high - low + gap
    return replace(layout, lifts=lifts)


@dataclass(frozen=True)
class TrainPlan:
    """The layout of a train, and its carrier if one is made."""

    layout: TrainLayout
    carrier: CarrierPlan | None = None

    @classmethod
    def of(
        cls,
        train: PlanetaryTrain,
        *,
        carrier_angle: float = 0.0,
        carrier: bool = False,
        exploded: bool = False,
        as_made: bool = False,
    ) -> TrainPlan:
        """Return the plan of a train, its carrier turned by so much (degrees).

        Raises GeometryError for rings without a rim, bodies that stand in each other, a carrier for planets without bores.
        """
        layout = TrainLayout(train, train.pose(carrier_angle), as_made=as_made)
        require_bodies(layout)
        require_room(layout)
        pins = carrier_plan(layout) if carrier else None
        if not exploded:
            return cls(layout, pins)
        apart = moved_apart(layout, pins)
        return cls(apart, pins.lifted(apart.lifts[layout.carrier.name]) if pins else None)

    def turned(self, carrier_angle: float, central_turn: float) -> TrainPlan:
        """Return the plan turned as by `PlanetaryTrain.pose` (degrees). The carrier's plan stays: as a part it turns with the
        pose.
        """
        return replace(self, layout=replace(self.layout, pose=self.layout.train.pose(carrier_angle, central_turn)))
