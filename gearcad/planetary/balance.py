"""Torques at which a planetary train is in balance, with what its meshes lose."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from gearcad.errors import SolverError
from gearcad.per_gear import PerGear, Role
from gearcad.planetary.shafts import Link, Shaft, shafts_of, willis_row
from gearcad.planetary.train_data import TrainData

__all__ = ["Balance", "balance", "locking_efficiency", "rolling_power"]

ROUNDING = 1e-12
"""Share of a speed below which a difference of speeds is rounding."""


@dataclass(frozen=True, kw_only=True)
class Balance:
    """Torques from outside, in the unit of the one that was given, positive counter-clockwise seen from +z.

    `torques` are those on the shafts of the train, `members` on the members of the set (through stages, too), `stages` on
    the gears of each stage by their shafts.
    """

    torques: dict[str, float]
    members: dict[str, float]
    stages: dict[str, PerGear[float]]


def balance(
    train: TrainData, speeds: Mapping[str, float], ends: Mapping[str, Shaft], known: Shaft, torque: float, eta: float
) -> Balance:
    """All torques from the `torque` on the shaft `known`, at `speeds` of which only the signs and their zeros matter.

    `ends` has the shaft of each member on which the world acts; `eta` is the efficiency of every mesh.
    Raises SolverError where nothing balances it: the train locks itself.
    """
    stages = dict.fromkeys((stage.name for stage in train.stages), PerGear(0.0, 0.0))
    inward = torque
    for link in reversed(known.path):
        inward = _passed(stages, link, inward, speeds, eta)
    members = _members(train, speeds, known.member, inward, eta**2)
    torques = dict.fromkeys(shafts_of(train), 0.0)
    for member, value in members.items():
        outward = value
        if member == known.member:
            outward = torque
        else:
            for link in ends[member].path:
                outward = _asked(stages, link, outward, speeds, eta)
        torques[known.name if member == known.member else ends[member].name] = outward
    return Balance(torques=torques, members=members, stages=stages)


def _passed(stages: dict[str, PerGear[float]], link: Link, torque: float, speeds: Mapping[str, float], eta: float) -> float:
    """What a torque on the outer shaft of a stage puts on its inner one."""
    inner, outer = link.teeth
    through = -torque * inner / outer * _kept(torque * speeds[link.shafts[1]], eta)
    _note(stages, link, -through, torque)
    return through


def _asked(stages: dict[str, PerGear[float]], link: Link, torque: float, speeds: Mapping[str, float], eta: float) -> float:
    """The torque on the outer shaft of a stage that puts this one on its inner one."""
    inner, outer = link.teeth
    asked = -torque * outer / inner / _kept(torque * speeds[link.shafts[0]], eta)
    _note(stages, link, -torque, asked)
    return asked


def _kept(power: float, eta: float) -> float:
    """Power behind a mesh over that before it, seen in the direction in which `power` is positive."""
    return eta ** ((power > 0) - (power < 0))


def _note(stages: dict[str, PerGear[float]], link: Link, inner: float, outer: float) -> None:
    stages[link.stage.name] = PerGear(outer, inner) if link.outer is Role.PINION else PerGear(inner, outer)


def _members(train: TrainData, speeds: Mapping[str, float], known: str, torque: float, eta: float) -> dict[str, float]:
    """Torques on the members of the set: T_b = -i_0 eta^s T_a, T_a + T_b + T_c = 0, s the sign of T_a (w_a - w_c).

    Where both signs agree with themselves - power that could as well be lost altogether - the one that loses less.
    """
    row = willis_row(train)
    of_a, of_b = (row[central.name] for central in train.centrals)
    found = []
    for sign in (1, -1) if rolling_speed(train, speeds) and eta != 1 else (0,):
        kept = eta**sign
        shares = dict(zip(row, (float(of_a), of_b * kept, -(of_a + of_b * kept)), strict=True))
        if not shares[known]:
            continue
        torques = {name: torque * share / shares[known] + 0.0 for name, share in shares.items()}
        if rolling_power(train, torques, speeds) * sign >= 0:
            found.append(torques)
    if not found:
        least = locking_efficiency(train)
        raise SolverError(
            f"{known}: no torque elsewhere turns it against its load at a mesh efficiency of {math.sqrt(eta):.6g}: the train "
            f"locks itself; it turns where meshes keep more than {least:.6g}"
        )
    return min(found, key=lambda torques: sum(torques[name] * speeds[name] for name in torques))


def rolling_speed(train: TrainData, speeds: Mapping[str, float]) -> float:
    """w_a - w_c, 0 where the set turns as one but for rounding."""
    first, carrier = speeds[train.centrals[0].name], speeds[train.carrier.name]
    difference = first - carrier
    return difference if abs(difference) > ROUNDING * max(abs(first), abs(carrier)) else 0.0


def rolling_power(train: TrainData, torques: Mapping[str, float], speeds: Mapping[str, float]) -> float:
    """T_a (w_a - w_c): what rolls from the first central to the second as seen from the carrier, in N·m·rpm."""
    return torques[train.centrals[0].name] * rolling_speed(train, speeds)


def locking_efficiency(train: TrainData) -> float:
    """The efficiency of a mesh up to which the set cannot be driven by a central to turn the carrier; 0: it always can."""
    of_a, of_b, _ = willis_row(train).values()
    ratio = -of_b / of_a
    return math.sqrt(min(ratio, 1 / ratio)) if ratio > 0 else 0.0
