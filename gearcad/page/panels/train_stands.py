"""Gears of a train of pairs as the page turns them: where they stand, how fast they turn, and the flanks that touch.

Lengths in mm, angles in radians; z is the height.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from gearcad.core.errors import GearcadError
from gearcad.core.records import PerGear, Role
from gearcad.designs.train_designs import TrainDesign
from gearcad.designs.train_meshes import has_pairs
from gearcad.geometry import Gear, GearPair
from gearcad.jobs.train_bodies import gear_train_plan
from gearcad.solids.gear_train_plan import GearKey, GearTrainPlan, StandingShaft, TrainMeshPlan

__all__ = ["PairStand", "PlacedTrainShaft", "TrainGear", "TrainStands", "train_stands"]


class TrainGear(NamedTuple):
    """A gear of a train: its role, the number of its mesh, its axis and the height of its lower end, and its rotation there.

    It turns by `ratio` while the first gear turns once. `slack` brings it to where the left flanks of the first touch. `cut` is
    the height of its section, in the middle of the teeth of the first pair that it is in.
    """

    name: str
    role: Role
    stage: int
    gear: Gear
    place: tuple[float, float, float]
    rotation: float
    ratio: float
    slack: float
    cut: float


class PlacedTrainShaft(NamedTuple):
    """A shaft of a train, and its turns while the first gear turns once."""

    shaft: StandingShaft
    ratio: float


class PairStand(NamedTuple):
    """A pair in mesh: the numbers of its gears, and the direction of the wheel from the pinion (of a ring, away from it).

    `side` is 1 where the pinion's left flanks touch when those of the first gear do, -1 where its right flanks do.
    """

    pair: GearPair
    gears: PerGear[int]
    towards: float
    side: int


class TrainStands(NamedTuple):
    """The gears of a train, the pairs that they make, and the shafts."""

    gears: tuple[TrainGear, ...]
    pairs: tuple[PairStand, ...]
    shafts: tuple[PlacedTrainShaft, ...]


def train_stands(design: TrainDesign) -> TrainStands | None:
    """Return where the gears of a train stand; None unless each mesh has a pair, and all teeth fit."""
    if not has_pairs(design):
        return None
    try:
        plan = gear_train_plan(design)
        return _Turning(design, plan).stands()
    except GearcadError:
        return None


class _Turning:
    """Turns of gears and of their lines of shafts, from the first pinion on."""

    def __init__(self, design: TrainDesign, plan: GearTrainPlan) -> None:
        self._plan, meshes = plan, plan.meshes
        ratios = design.train.speed_ratios
        first = ratios[meshes[0].gears.pinion]
        self._ratios = {
            line: ratios[name] / first for mesh in meshes for name, line in zip(mesh.gears, mesh.lines, strict=True)
        }
        self._slacks = {meshes[0].lines.pinion: 0.0}
        self._cuts: dict[GearKey, float] = {}
        self._sides: dict[str, int] = {}
        for mesh in self._in_order():
            self._turn(mesh)

    def _in_order(self) -> Iterator[TrainMeshPlan]:
        """Yield the meshes from the first one on, each behind one that turns it."""
        waiting = list(self._plan.meshes)
        while waiting:
            mesh = next((each for each in waiting if any(line in self._slacks for line in each.lines)), waiting[0])
            waiting.remove(mesh)
            yield mesh

    def _turn(self, mesh: TrainMeshPlan) -> None:
        """Find which flanks of a mesh touch, and so how far its other line turns.

        The first gear drives, and each line the next.
        """
        driver = Role.PINION if mesh.lines.pinion in self._slacks else Role.WHEEL
        turn = int(math.copysign(1.0, self._ratios[mesh.lines.pinion]))
        side = self._sides[mesh.name] = turn if driver is Role.PINION else -turn
        pair, own = mesh.pair, self._slacks.get(mesh.lines.pick(driver), 0.0)
        ratio = -pair.pinion.teeth / pair.wheel.teeth
        gap = side * pair.circumferential_backlash / pair.working_pitch_diameters.wheel
        other = own * ratio + gap if driver is Role.PINION else (own - gap) / ratio
        self._slacks.setdefault(mesh.lines.pick(driver.mate), other)
        bodies = [self._plan.bodies[GearKey(mesh.name, role)] for role in Role]
        middle = pair.pinion.face_width / 2 + pair.common_width.offset
        low = self._plan.standing[GearKey(mesh.name, Role.PINION)].z
        cut = next((self._cuts[body] for body in bodies if body in self._cuts), low + middle)
        for body in bodies:
            self._cuts.setdefault(body, cut)

    def stands(self) -> TrainStands:
        """Return the gears, in the order of the meshes, the pairs and the shafts."""
        stages = {mesh.name: number for number, mesh in enumerate(self._plan.meshes)}
        gears = tuple(
            TrainGear(
                *(each.name, each.key.role, stages[each.key.mesh], each.gear, (each.x, each.y, each.z)),
                *(math.radians(each.rotation), self._ratios[each.line], self._slacks[each.line], self._cuts[each.key]),
            )
            for each in self._plan.gears
        )
        numbers = {each.key: number for number, each in enumerate(self._plan.gears)}
        pairs = []
        for mesh in self._plan.meshes:
            own = PerGear.each(lambda role, mesh=mesh: numbers[self._plan.bodies[GearKey(mesh.name, role)]])  # type: ignore[misc]
            towards = math.radians(mesh.angle + (180.0 if mesh.pair.internal else 0.0))
            pairs.append(PairStand(mesh.pair, own, towards, self._sides[mesh.name]))
        shafts = tuple(PlacedTrainShaft(each, self._ratios[each.line]) for each in self._plan.standing_shafts)
        return TrainStands(gears, tuple(pairs), shafts)
