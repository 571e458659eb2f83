"""Places of the gears of a train of pairs: shafts side by side, stages one above the other, teeth in mesh.

Axes lie at the angles that meshes give. Where none does, each further axis lies in the direction of the one before it, and a
second one of the same shaft at a right angle to it. Lengths in mm, angles in radians; z is the height.
"""

from __future__ import annotations

import cmath
import math
from collections import Counter
from collections.abc import Mapping
from typing import NamedTuple

from gearcad.core.records import PerGear, Role
from gearcad.designs.train_designs import TrainDesign
from gearcad.dynamics.trains.members import GROUND, MeshPair, ToothMesh
from gearcad.geometry import Gear, GearPair

__all__ = ["PairStand", "TrainGear", "TrainStands", "train_stands"]

_GAP = 0.15
"""Room between two stages over the height, in face widths of the lower one."""

_DIRECTIONS = (0.0, math.pi / 2, -math.pi / 2, math.pi)
"""Directions of further axes of a shaft, from the direction in which it was reached itself."""


class TrainGear(NamedTuple):
    """A gear of a train by the name of its inertia: its axis, the height of its lower end, and its rotation (rad) there.

    It turns by `ratio` while the first gear turns once. `slack` (rad) brings it to where the left flanks of the first touch.
    `cut` is the height of its section, in the middle of the teeth of the first pair that it is in.
    """

    name: str
    role: Role
    stage: int
    gear: Gear
    axis: complex
    z: float
    rotation: float
    ratio: float
    slack: float
    cut: float


class PairStand(NamedTuple):
    """A pair in mesh: the numbers of its gears, and the direction of the wheel from the pinion (rad).

    `side` is 1 where the pinion's left flanks touch when those of the first gear do, -1 where its right flanks do.
    """

    pair: GearPair
    gears: PerGear[int]
    towards: float
    side: int


class TrainStands(NamedTuple):
    """The gears of a train, and the pairs that they make."""

    gears: tuple[TrainGear, ...]
    pairs: tuple[PairStand, ...]


class _Line(NamedTuple):
    """A line of shafts with one axis: where it is, the direction in which it was reached, and the turn (rad) of its slack."""

    axis: complex
    direction: float
    slack: float


def train_stands(design: TrainDesign) -> TrainStands | None:
    """Return where the gears of a train stand; None unless each mesh has a pair, and no meshes and shafts make a circle."""
    meshes = design.train.meshes
    if not meshes or not all(isinstance(mesh.pair, MeshPair) for mesh in meshes):
        return None
    lines = _lines_of(design)
    return None if len(meshes) >= len(set(lines.values())) else _Standing(design, lines).found()


def _lines_of(design: TrainDesign) -> dict[str, str]:
    """Return the line of shafts of each inertia, called after one of its inertias."""
    line = {each.name: each.name for each in design.train.inertias}
    for shaft in design.train.shafts:
        if GROUND not in (shaft.start, shaft.end):
            first, second = line[shaft.start], line[shaft.end]
            line = {name: first if own == second else own for name, own in line.items()}
    return line


class _Standing:
    """Places gears one mesh after the other, each at one that stands."""

    def __init__(self, design: TrainDesign, lines: Mapping[str, str]) -> None:
        self._meshes, self._line_of = design.train.meshes, lines
        self._ratios = design.train.speed_ratios
        self._has_angles = any(mesh.mesh_angle for mesh in self._meshes)
        first = self._meshes[0].pinion
        self._lines = {lines[first]: _Line(0j, 0.0, 0.0)}
        self._mates = Counter[str]()
        self._gears: list[TrainGear] = []
        self._pairs: list[PairStand] = []
        self._top = 0.0

    def found(self) -> TrainStands | None:
        """Return all gears and pairs; None where meshes are not reached from the first one."""
        waiting = list(self._meshes)
        while waiting:
            mesh = next((each for each in waiting if self._driver(each) is not None), None)
            if mesh is None:
                return None
            waiting.remove(mesh)
            self._place(mesh)
        return TrainStands(tuple(self._gears), tuple(self._pairs))

    def _driver(self, mesh: ToothMesh) -> Role | None:
        """Return the gear of a mesh whose line stands; None if none does."""
        return next((role for role, name in mesh.gears.items() if self._line_of[name] in self._lines), None)

    def _place(self, mesh: ToothMesh) -> None:
        """Place the gears of a mesh, of which the line of one stands, and the line of the other."""
        driver = self._driver(mesh)
        assert driver is not None and isinstance(mesh.pair, MeshPair)
        pair = mesh.pair.mounted
        pose, own = pair.wheel_pose(), self._line_of[mesh.gears.pick(driver)]
        line = self._lines[own]
        if self._has_angles:
            towards = math.radians(mesh.mesh_angle)
            direction = towards if driver is Role.PINION else towards + math.pi
        else:
            direction = line.direction + _DIRECTIONS[self._mates[own] % len(_DIRECTIONS)]
            towards = direction if driver is Role.PINION else direction + math.pi
        self._mates[own] += 1
        across = cmath.rect(pose.x, towards)
        axes = PerGear(line.axis, line.axis + across) if driver is Role.PINION else PerGear(line.axis - across, line.axis)
        side = self._side(mesh, driver)
        slacks = self._slacks(pair, line.slack, driver, side)
        other = driver.mate
        self._lines[self._line_of[mesh.gears.pick(other)]] = _Line(axes.pick(other), direction, slacks.pick(other))
        rotations, low = PerGear(towards, towards + math.radians(pose.rotation)), PerGear(0.0, pose.z)
        known = self._known(mesh.gears.pick(driver), pair.gears.pick(driver))
        if known is None:
            lift = self._top - min(low)
            cut = (max(low) + min(z + gear.face_width for z, gear in zip(low, pair.gears, strict=True))) / 2 + lift
        else:
            lift, cut = self._gears[known].z - low.pick(driver), self._gears[known].cut
            rotations = self._turned(pair, rotations, driver, self._gears[known].rotation - rotations.pick(driver))
        numbers = {driver: known} if known is not None else {}
        for role, gear in pair.gears.items():
            if role in numbers:
                continue
            numbers[role], name, z = len(self._gears), mesh.gears.pick(role), low.pick(role) + lift
            ratio = self._ratio(name)
            stage, rotation = len(self._pairs), rotations.pick(role)
            stand = TrainGear(name, role, stage, gear, axes.pick(role), z, rotation, ratio, slacks.pick(role), cut)
            self._gears.append(stand)
            self._top = max(self._top, z + gear.face_width * (1 + _GAP))
        self._pairs.append(PairStand(pair, PerGear(*(numbers[role] for role in Role)), towards, side))

    def _ratio(self, name: str) -> float:
        """Return the turns of an inertia while the first gear turns once."""
        return self._ratios[name] / self._ratios[self._meshes[0].pinion]

    def _known(self, name: str, gear: Gear) -> int | None:
        """Return the number of a gear that stands already, in another mesh of the same inertia."""
        return next((at for at, each in enumerate(self._gears) if each.name == name and each.gear == gear), None)

    def _side(self, mesh: ToothMesh, driver: Role) -> int:
        """Return which flanks of the pinion touch: the first gear drives, and each line the next."""
        turn = int(math.copysign(1.0, self._ratio(mesh.pinion)))
        return turn if driver is Role.PINION else -turn

    @staticmethod
    def _slacks(pair: GearPair, own: float, driver: Role, side: int) -> PerGear[float]:
        """Return the turns (rad) of both gears, of which that of the driver is given, until these flanks touch."""
        ratio = -pair.pinion.teeth / pair.wheel.teeth
        gap = side * pair.circumferential_backlash / pair.working_pitch_diameters.wheel
        if driver is Role.PINION:
            return PerGear(own, own * ratio + gap)
        return PerGear((own - gap) / ratio, own)

    @staticmethod
    def _turned(pair: GearPair, rotations: PerGear[float], driver: Role, by: float) -> PerGear[float]:
        """Return the rotations of gears in mesh, of which the driver is turned by an angle (rad)."""
        ratio = -pair.pinion.teeth / pair.wheel.teeth
        pinion, wheel = (by, by * ratio) if driver is Role.PINION else (by / ratio, by)
        return PerGear(rotations.pinion + pinion, rotations.wheel + wheel)
