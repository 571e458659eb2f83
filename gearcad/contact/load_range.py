"""Loads over which modifications are searched: the [modify] table of a spec, and the statistic over their figures."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Any

import numpy as np

from gearcad.core.errors import ParameterError, is_finite_number
from gearcad.core.quantities import TORQUE, Member, Words, require_fields
from gearcad.core.records import Floats, concise

_MOST_LOADS = 20
_PERMITTED = 'must be a list of [torque in N·m on the pinion, weight]; in a cell "200:0.25 150:0.75"'


class Statistic(StrEnum):
    """Statistic of the transmission errors, peak to peak, under several loads."""

    MEAN = "mean"
    MEDIAN = "median"
    WORST = "worst"


@dataclass(frozen=True, kw_only=True)
class ModifyOptions:
    """The [modify] table: torques (N·m on the pinion) with weights above 0, for which `gearcad modify` searches.

    The torques have one sense; the load factor of the [load] does not count. What is made least is the `objective` of the
    peak to peak of the transmission error under them. Raises ParameterError.
    """

    loads: Annotated[tuple[tuple[float, ...], ...] | None, Words("torques on the pinion, with weights", "T_1")] = None
    objective: Annotated[str, Member(Statistic), Words("statistic of the transmission errors under the loads")] = "mean"

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        if self.loads is not None:
            object.__setattr__(self, "loads", _loads(self.loads))

    @property
    def range(self) -> LoadRange | None:
        """The loads with their statistic; None where no loads are given."""
        if self.loads is None:
            return None
        torques, weights = zip(*self.loads, strict=True)
        return LoadRange(torques, weights, Statistic(self.objective))


def _loads(given: Any) -> tuple[tuple[float, ...], ...]:
    """Return loads from lists of numbers or from the text of a cell. Raises ParameterError."""
    if isinstance(given, str):
        found: list[Any] = [_numbers(item) for item in given.split()]
    elif isinstance(given, list | tuple):
        found = [tuple(each) if isinstance(each, list | tuple) else () for each in given]
    else:
        raise ParameterError("modify.loads", given, _PERMITTED)
    if not 1 <= len(found) <= _MOST_LOADS:
        raise ParameterError("modify.loads", given, f"must have from 1 to {_MOST_LOADS} loads")
    for each in found:
        if len(each) != 2 or not all(map(is_finite_number, each)):
            raise ParameterError("modify.loads", given, _PERMITTED)
        TORQUE.require("modify.loads", each[0])
        if not each[0] or not 0 < each[1] <= 1e9 or each[0] * found[0][0] < 0:
            permitted = "must have torques of one sense, not 0, and weights above 0 up to 1e9"
            raise ParameterError("modify.loads", list(each), permitted)
    if len({each[0] for each in found}) < len(found):
        raise ParameterError("modify.loads", given, "must have each torque once")
    return tuple((float(torque), float(weight)) for torque, weight in found)


def _numbers(item: str) -> tuple[float, ...]:
    """Return the numbers of a text such as 200:0.25; empty if it is no such text. A comma is a decimal sign here."""
    try:
        return tuple(map(float, re.split(":", item.replace(",", "."))))
    except ValueError:
        return ()


@dataclass(frozen=True)
class LoadRange:
    """Torques (k,) in N·m on the pinion with their weights (k,), and the statistic of a figure under them."""

    torques: tuple[float, ...]
    weights: tuple[float, ...]
    statistic: Statistic = Statistic.MEAN

    @property
    def greatest(self) -> float:
        """The torque of the greatest size."""
        return max(self.torques, key=abs)

    def of(self, values: Floats) -> Floats:
        """Return the statistic (...) of values (..., k) under the loads: mean and median by the weights.

        The median is the least value that, with all below it, has half of the weight.
        """
        if self.statistic is Statistic.WORST:
            return np.asarray(values.max(axis=-1))
        shares = np.array(self.weights) / sum(self.weights)
        if self.statistic is Statistic.MEAN:
            return np.asarray((values * shares).sum(axis=-1))
        order = np.argsort(values, axis=-1, kind="stable")
        first = (np.cumsum(shares[order], axis=-1) >= 0.5 - 1e-12).argmax(axis=-1)
        return np.take_along_axis(values, np.take_along_axis(order, first[..., None], -1), -1)[..., 0]
