"""Torsional stiffness of a planetary train at its output, by virtual work: what each spring adds to the twist."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.disturbances import set_members
from gearcad.dynamics.planetary.springs import Spring, SpringKind
from gearcad.dynamics.planetary.stage_forces import mesh_force
from gearcad.dynamics.planetary.statics import TrainStatics, planar_notices, train_statics
from gearcad.errors import ParameterError
from gearcad.notice import Notice, texts
from gearcad.planetary import PlanetaryTrain, TrainLoad

__all__ = ["Contribution", "TorsionalStiffness", "TwistSource", "torsional_stiffness", "twist_of"]

_TURNS = 72
"""Angles of the carrier over which the squares of forces are averaged: exact, as they are harmonics of order 2."""

_ROUNDING = 1e-12
"""Share of the twist that rounding leaves to springs that carry nothing."""


class TwistSource(Enum):
    """What springs are."""

    MESH = "mesh"
    PIN = "pin"
    SUPPORT = "support"
    SHAFT = "shaft"
    STAGE = "stage"


_SOURCES = {
    SpringKind.MESH: TwistSource.MESH,
    SpringKind.PIN_RADIAL: TwistSource.PIN,
    SpringKind.PIN_TANGENTIAL: TwistSource.PIN,
    SpringKind.SUPPORT_X: TwistSource.SUPPORT,
    SpringKind.SUPPORT_Y: TwistSource.SUPPORT,
    SpringKind.TORSION: TwistSource.SHAFT,
}


@dataclass(frozen=True, kw_only=True)
class Contribution:
    """What the springs of `name` add to the twist: `twist` in degrees, `share` of the whole.

    `square_force` (N², of shafts N²·m²) is the sum of the squares of their forces, in the mean over a turn.
    """

    name: str
    source: TwistSource
    square_force: float
    twist: float
    share: float


@dataclass(frozen=True, kw_only=True)
class TorsionalStiffness:
    """Twist (degrees) of the output of a train under `torque` (N·m) on it, with all else held, and what adds to it.

    Without errors, with mean mesh stiffnesses and in the mean over a turn of what stages push across the axis. `rigid` names
    what was given no stiffness.
    """

    train: PlanetaryTrain
    torque: float
    twist: float
    contributions: tuple[Contribution, ...]
    rigid: tuple[str, ...]

    @property
    def stiffness(self) -> float:
        """T/theta (N·m/rad)."""
        return self.torque / float(np.radians(self.twist))

    def share(self, source: TwistSource) -> float:
        """Share of the twist that springs of a kind have (1 is all of it)."""
        return sum(each.share for each in self.contributions if each.source is source)

    def implied_pin_stiffness(self, stiffness: float) -> float:
        """Stiffness of one pin (N/µm) that would make it `stiffness` (N·m/rad), with all other springs as they are.

        Raises ParameterError where that is not softer than the train with rigid pins.
        """
        pins = [each for each in self.contributions if each.source is TwistSource.PIN]
        others = float(np.radians(self.twist - sum(each.twist for each in pins)))
        left = self.torque / stiffness - others
        if left <= 0:
            permitted = f"must be below {self.torque / others:.6g}, what it is with rigid pins"
            raise ParameterError("stiffness", stiffness, permitted, "N·m/rad")
        return sum(each.square_force for each in pins) / (self.torque * left) / 1e6

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What is taken for rigid."""
        found = [*planar_notices(self.train)]
        if self.rigid:
            text = f"taken for rigid, without a stiffness: {', '.join(self.rigid)}; the train is softer"
            found.append(Notice("taken-for-rigid", text))
        return tuple(notice.within("torsional stiffness") for notice in found)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> dict[str, Any]:
        """As `planetary.json` has it: N·m/rad, degrees."""
        return {
            "stiffness": self.stiffness,
            "torque": self.torque,
            "twist": self.twist,
            "contributions": [asdict(each) | {"source": each.source.value} for each in self.contributions],
            "rigid": list(self.rigid),
            "notices": [notice.to_dict() for notice in self.notices],
        }


def twist_of(work: ArrayLike, torque: float) -> Floats:
    """theta = sum F delta/T in degrees, of the sums of forces times what springs yield under them (N·µm), linear or not."""
    return np.degrees(np.asarray(work, float) / (1e6 * torque))


def torsional_stiffness(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: Mapping[str, ArrayLike],
    given_speeds: Mapping[str, float] | None = None,
) -> TorsionalStiffness:
    """That of a train with `stiffness` (N/µm) of each mesh and stage by its name; a stage without one is rigid.

    Raises what `train_statics` does.
    """
    statics = train_statics(_flawless(train), load, stiffness, given_speeds)
    squares = _mean_squares(statics)
    found = [*_of_set(statics, squares), *_of_shafts(statics), *_of_stages(statics, stiffness)]
    whole = sum(each.twist for each in found)
    found = [each for each in found if abs(each.twist) > _ROUNDING * abs(whole) or each.source is TwistSource.PIN]
    return TorsionalStiffness(
        train=train,
        torque=statics.torque,
        twist=whole,
        contributions=tuple(replace(each, share=each.twist / whole) for each in found),
        rigid=(*_rigid(train), *(stage.name for stage in train.stages if stage.name not in stiffness)),
    )


def _flawless(train: PlanetaryTrain) -> PlanetaryTrain:
    """The same without errors."""
    return replace(
        train,
        centrals=tuple(replace(central, run_out=0.0) for central in train.centrals),
        rims=tuple(replace(rim, tooth_errors=()) for rim in train.rims),
        carrier=replace(train.carrier, run_out=0.0, pin_errors=()),
    )


def _mean_squares(statics: TrainStatics) -> Floats:
    """Squares (m,) of the forces, in the mean over a turn of the carrier."""
    angles = np.linspace(0, 2 * np.pi, _TURNS, endpoint=False)[:, None]
    found: Floats = (statics.state(angles).forces ** 2).mean(axis=0)
    return found


def _of_set(statics: TrainStatics, squares: Floats) -> Iterator[Contribution]:
    """Of meshes, pins, supports and what holds members, in the order of the springs."""
    groups: dict[tuple[TwistSource, str], list[int]] = {}
    for place, spring in enumerate(statics.springs.springs):
        groups.setdefault((_SOURCES[spring.kind], _name(spring)), []).append(place)
    for (source, name), places in groups.items():
        work = squares[places] @ statics.compliance[places]
        if work or source is TwistSource.PIN:
            yield _contribution(name, source, float(squares[places].sum()), float(work), statics.torque)


def _name(spring: Spring) -> str:
    kinds = {TwistSource.PIN: "pins", TwistSource.SUPPORT: f"support of {spring.owner}", TwistSource.SHAFT: spring.owner}
    return kinds.get(_SOURCES[spring.kind], spring.owner)


def _of_shafts(statics: TrainStatics) -> Iterator[Contribution]:
    """Of what the output drives through its member."""
    if statics.output_work:
        square = statics.flow.set_torques[statics.output] ** 2
        yield _contribution(statics.output, TwistSource.SHAFT, square, statics.output_work, statics.torque)


def _of_stages(statics: TrainStatics, stiffness: Mapping[str, ArrayLike]) -> Iterator[Contribution]:
    for stage in statics.train.stages:
        if stage.name in stiffness:
            square = mesh_force(stage, statics.flow.stage_torques[stage.name]) ** 2
            work = square / float(np.asarray(stiffness[stage.name]))
            yield _contribution(stage.name, TwistSource.STAGE, square, work, statics.torque)


def _contribution(name: str, source: TwistSource, square: float, work: float, torque: float) -> Contribution:
    """From F delta in N·µm."""
    return Contribution(name=name, source=source, square_force=square, twist=float(twist_of(work, torque)), share=0.0)


def _rigid(train: PlanetaryTrain) -> Iterator[str]:
    """Pins and shafts without a stiffness."""
    if train.carrier.pin_stiffness is None:
        yield "pins"
    yield from (f"shaft of {each.name}" for each in set_members(train) if each.torsional_stiffness is None)
