"""Shafts of a planetary train: how the members of the set turn with each other, and what turns with each of them."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from gearcad.errors import GeometryError
from gearcad.per_gear import Role
from gearcad.planetary.members import PairStage
from gearcad.planetary.train_data import TrainData

__all__ = ["Link", "Shaft", "check_shafts", "shafts_of", "willis_row"]


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
class Shaft:
    """A member of the set, or a shaft that turns with the `member` through the stages of `path`, from the set outwards.

    `speed_ratio` is its speed over that of the member, exact.
    """

    name: str
    member: str
    speed_ratio: Fraction = Fraction(1)
    path: tuple[Link, ...] = ()

    def behind(self, stage: PairStage) -> Shaft:
        """The shaft at the other end of a stage that is on this one."""
        link = Link(stage=stage, outer=Role.WHEEL if stage.pinion == self.name else Role.PINION)
        inner, outer = link.teeth
        ratio, name = -Fraction(inner, outer), link.shafts[1]
        return Shaft(name=name, member=self.member, speed_ratio=self.speed_ratio * ratio, path=(*self.path, link))


def shafts_of(train: TrainData) -> dict[str, Shaft]:
    """Every shaft by its name, the members of the set first. Raises GeometryError where a stage is not on one other shaft."""
    found = {name: Shaft(name=name, member=name) for name in train.members}
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
