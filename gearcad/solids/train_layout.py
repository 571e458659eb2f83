"""What bodies a planetary train has, what each is called, and where each stands: for CAD, facets and sections alike."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import chain

from gearcad.geometry import Gear
from gearcad.per_gear import PerGear, Role
from gearcad.planetary import PairStage, PlanetaryTrain
from gearcad.planetary.poses import PlanetPose, TrainPose
from gearcad.solids.axle import Axle
from gearcad.solids.colours import STAGE_COLOURS, TRAIN_COLOURS, Colour

__all__ = ["Standing", "TrainBody", "TrainLayout", "stage_keys", "train_bodies"]

_UNNAMED = ("gear", "pinion", "wheel")
"""Names that a gear has where nobody named it."""

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
        """Where its own origin is (mm)."""
        return self.axle.x, self.axle.y, self.z

    @property
    def extent(self) -> tuple[float, float]:
        """Its lowest and highest z (mm), hubs included."""
        back, front = self.body.gear.body.hub_ends
        return self.z - back, self.z + self.body.gear.face_width + front


@dataclass(frozen=True)
class TrainLayout:
    """Every body of a train in its place: what stands by itself, and the planets one by one, each with its rims.

    `lifts` says by how much (mm) bodies of a key stand higher than in mesh.
    """

    train: PlanetaryTrain
    pose: TrainPose
    lifts: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def bodies(self) -> dict[str, TrainBody]:
        """The gears that are made, by their keys: those of the planets once."""
        return train_bodies(self.train)

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
        return Standing(name, self.bodies[key], axle, rotation, height + self.lifts.get(key, 0.0))


def stage_keys(train: PlanetaryTrain) -> list[PerGear[str]]:
    """What the gears of each stage are called: a gear has its own name if that tells it from all others."""
    taken = [*train.members, *(rim.name for rim in train.rims)]
    taken += [gear.name for stage in train.stages for gear in stage.pair.gears]

    def key(stage: PairStage, role: Role) -> str:
        name = stage.pair.gears.pick(role).name
        return f"{stage.name}-{role.value}" if taken.count(name) > 1 else name

    return [PerGear.each(partial(key, stage)) for stage in train.stages]


def train_bodies(train: PlanetaryTrain) -> dict[str, TrainBody]:
    """The gears of a train by their keys: centrals, rims, pinion and wheel of each stage, no two of one name or colour."""
    gears = {central.name: central.gear for central in train.centrals} | {rim.name: rim.gear for rim in train.rims}
    for stage, keys in zip(train.stages, stage_keys(train), strict=True):
        gears |= {keys.pick(role): gear for role, gear in stage.pair.gears.items()}
    ours = {key: f"{train.name} {key}" for key in gears}
    own = {key: ours[key] if gear.name in (*_UNNAMED, key) else gear.name for key, gear in gears.items()}
    names = own if len({train.name, *own.values()}) == 1 + len(gears) else ours
    colours = _colours(train)
    return {key: TrainBody(key, names[key], gear, next(colours)) for key, gear in gears.items()}


def _colours(train: PlanetaryTrain) -> Iterator[Colour]:
    """A colour for each body: of centrals, rims, and gears of stages."""
    kinds = {internal: iter(TRAIN_COLOURS["rings" if internal else "suns"]) for internal in (False, True)}
    yield from (next(kinds[central.gear.internal]) for central in train.centrals)
    yield from TRAIN_COLOURS["rims"][: len(train.rims)]
    for number in range(len(train.stages)):
        shade = _DARKER**number
        yield from ((red * shade, green * shade, blue * shade) for red, green, blue in STAGE_COLOURS)
