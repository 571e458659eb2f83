"""Torques, powers and efficiency of a planetary train under its load."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from gearcad.per_gear import PerGear
from gearcad.planetary.balance import Balance, balance, rolling_power
from gearcad.planetary.load import TrainLoad
from gearcad.planetary.shafts import Shaft, shafts_of
from gearcad.planetary.speeds import Speeds, speeds
from gearcad.planetary.train_data import TrainData
from gearcad.schema import is_assumed

__all__ = ["PowerFlow", "efficiency", "lossless_flow", "power_flow"]

_WATT = math.pi / 30
"""N·m times rpm."""


@dataclass(frozen=True, kw_only=True)
class PowerFlow:
    """What acts on a train from outside, in N·m, rpm and W; torques and speeds are positive counter-clockwise seen from +z.

    `torques` and `powers` (positive where power goes in) by the names of members and shafts, 0 where nothing acts: those of
    the fixed member are what holds it. `set_torques` act on the members of the set, through stages too; `stage_torques` on
    the gears of each stage by their shafts. `losses` are of both meshes of the set and of each stage.
    `efficiency` is that from input to output, `efficiency_back` that from output to input, 0 or below where no torque
    turns the train in that direction. Of a differential `efficiency` is all power that goes out over all that goes in, and
    `efficiency_back` None. `rolling_power` is what rolls through the meshes of the set as seen from the carrier, and
    `rolling_ratio` the same over the power that goes into the set; None without load.
    """

    load: TrainLoad
    speeds: Speeds
    torques: Mapping[str, float]
    powers: Mapping[str, float]
    set_torques: Mapping[str, float]
    stage_torques: Mapping[str, PerGear[float]]
    losses: Mapping[str, float]
    efficiency: float | None
    efficiency_back: float | None
    rolling_power: float
    rolling_ratio: float | None

    @property
    def self_locking(self) -> bool:
        """Whether the output cannot drive the input."""
        return self.efficiency_back is not None and self.efficiency_back <= 0

    @property
    def circulates(self) -> bool:
        """Whether more power rolls through the meshes than goes into the set."""
        return self.rolling_ratio is not None and self.rolling_ratio > 1

    @property
    def circulation(self) -> str:
        """The same in words."""
        if self.rolling_ratio is None:
            return "no power flows"
        if self.circulates:
            return f"power circulates: {self.rolling_ratio:.4g} times what goes in rolls through the meshes"
        return f"no power circulates: {self.rolling_ratio:.4g} of what goes in rolls through the meshes"

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "speeds": self.speeds.to_dict(),
            "torques": dict(self.torques),
            "powers": dict(self.powers),
            "set_torques": dict(self.set_torques),
            "stage_torques": {name: torques._asdict() for name, torques in self.stage_torques.items()},
            "losses": dict(self.losses),
            "efficiency": self.efficiency,
            "efficiency_back": self.efficiency_back,
            "mesh_efficiency": self.load.mesh_efficiency,
            "mesh_efficiency_source": "assumed" if is_assumed(self.load.mesh_efficiency) else "given",
            "self_locking": None if is_assumed(self.load.mesh_efficiency) else self.self_locking,
            "rolling_power": self.rolling_power,
            "rolling_ratio": self.rolling_ratio,
            "circulation": self.circulation,
        }


def power_flow(train: TrainData, load: TrainLoad, given_speeds: Mapping[str, float] | None = None) -> PowerFlow:
    """The flow of power through a train that runs at `load`, with the second speed (rpm) that a differential needs.

    The torque of `load` is positive where the input takes power and the output gives it away: from outside it then acts along
    the input's motion, or against the output's. At rest the motion is what a positive speed of the input would bring. A
    differential shares torque as a set with a fixed member does; its speeds decide which way power goes.
    Raises ParameterError where speeds are missing or too many, SolverError where the train locks itself against the load.
    """
    given = dict(given_speeds or {})
    actual = speeds(train, {train.input: load.speed, **given})
    signs = actual.members
    if not any(signs.values()):
        signs = speeds(train, {**given, train.input: 1.0}).members
    at, way = (train.input, 1.0) if load.on_input else (train.output, -1.0)
    torque = way * math.copysign(load.given_torque, load.given_torque * (signs[at] or 1.0))
    found = _balance(train, signs, at, torque, load.mesh_efficiency, given)
    rolling = rolling_power(train, found.members, signs)
    entering = sum(max(found.members[name] * signs[name], 0.0) for name in found.members)
    powers = {name: value * actual.members[name] * _WATT + 0.0 for name, value in found.torques.items()}
    return PowerFlow(
        load=load,
        speeds=actual,
        torques=found.torques,
        powers=powers,
        set_torques=found.members,
        stage_torques=found.stages,
        losses=_losses(train, found, actual.members, load.mesh_efficiency),
        efficiency=_efficiency_of_all(found, signs) if train.fixed is None else efficiency(train, load.mesh_efficiency),
        efficiency_back=None if train.fixed is None else efficiency(train, load.mesh_efficiency, back=True),
        rolling_power=abs(rolling_power(train, found.members, actual.members)) * _WATT,
        rolling_ratio=abs(rolling) / entering if entering else None,
    )


def lossless_flow(train: TrainData, load: TrainLoad, given_speeds: Mapping[str, float] | None = None) -> PowerFlow:
    """Return the flow of power without losses under the torque that `load` gives the output; raises as `power_flow`."""
    if load.on_input:
        torque = power_flow(train, load, given_speeds).torques[train.output]
        load = replace(load, input_torque=None, output_torque=math.copysign(torque, load.given_torque))
    return power_flow(train, replace(load, mesh_efficiency=1.0), given_speeds)


def efficiency(train: TrainData, mesh_efficiency: float, *, back: bool = False) -> float:
    """Power out over power in, from the input to the output or `back`, of a train with a fixed member.

    0 or below where the train locks itself: then the driven end would have to be driven, too.
    """
    driving, driven = (train.output, train.input) if back else (train.input, train.output)
    signs = speeds(train, {driving: 1.0}).members
    found = _balance(train, signs, driving, 1.0, mesh_efficiency, {})
    return -found.torques[driven] * signs[driven]


def _balance(
    train: TrainData, signs: Mapping[str, float], at: str, torque: float, eta: float, given: Mapping[str, float]
) -> Balance:
    shafts = shafts_of(train)
    return balance(train, signs, _ends(train, shafts, given), shafts[at], torque, eta)


def _ends(train: TrainData, shafts: Mapping[str, Shaft], given: Mapping[str, float]) -> dict[str, Shaft]:
    """The shaft of each member that the world holds or drives: one of a role, of a given speed, or the member itself."""
    spoken = [train.input, train.output, train.fixed, *given, *train.members]
    ends: dict[str, Shaft] = {}
    for name in spoken:
        if name is not None:
            ends.setdefault(shafts[name].member, shafts[name])
    return ends


def _losses(train: TrainData, found: Balance, members: Mapping[str, float], eta: float) -> dict[str, float]:
    """Power that each mesh of the set and each stage turns into heat (W)."""
    rolling = rolling_power(train, found.members, members)
    first, second = train.centrals
    entering = rolling if rolling > 0 else -rolling * eta**-2
    lost = {
        first.mesh_name: entering * (1 - eta) * (1 if rolling > 0 else eta),
        second.mesh_name: entering * (1 - eta) * (eta if rolling > 0 else 1),
    }
    for stage in train.stages:
        torques = found.stages[stage.name]
        lost[stage.name] = torques.pinion * members[stage.pinion] + torques.wheel * members[stage.wheel]
    return {name: value * _WATT + 0.0 for name, value in lost.items()}


def _efficiency_of_all(found: Balance, signs: Mapping[str, float]) -> float | None:
    """Power that goes out over power that goes in, of all shafts; None without load."""
    powers = [torque * signs[name] for name, torque in found.torques.items()]
    entering = sum(power for power in powers if power > 0)
    return -sum(power for power in powers if power < 0) / entering if entering else None
