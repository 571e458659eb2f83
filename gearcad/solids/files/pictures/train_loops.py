"""Loops of planetary trains."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

from gearcad.notice import Notice
from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.shafts import shafts_of
from gearcad.solids.files.part import Part
from gearcad.solids.files.pictures.loops import MOST_FRAMES, QUICK, Loop, come_round, frames_for, simpler
from gearcad.solids.files.pictures.plain import plain_train
from gearcad.solids.files.train_products import TrainProduct
from gearcad.solids.files.train_turning import turns_of
from gearcad.solids.train_layout import Standing, TrainLayout

__all__ = ["train_loop"]

_LARGEST = 10**6
"""Denominator of the fractions that turns, which are floats, are taken for."""

_EXACT = 1e-9
"""By how much they may miss them, and whole pitches, relatively."""

_SAME = 1e-6
"""Distance (mm), and share of a pitch, that counts as none."""


def train_loop(product: TrainProduct, *, carrier_held: bool = False) -> Loop:
    """A train as its speeds say, until all of it looks as at first; where that is too long, or if asked for, its carrier held.

    Raises ParameterError for speeds that contradict each other.
    """
    simple = plain_train(product.train)
    if simple != product.train:
        return simpler(train_loop(replace(product, train=simple), carrier_held=carrier_held))
    carrier, central = _driven(product)
    held = _closed(product, 0.0, central - carrier)
    if carrier_held and held is not None:
        return held
    if (loop := _closed(product, carrier, central)) is not None:
        return loop
    if held is not None:
        text = f"it would come round in more than {MOST_FRAMES} frames only: its carrier is held still, as if seen from there"
        return replace(held, notices=(Notice("carrier-held", text, where="turning"),))
    return _cut_short(product, carrier, central)


def _driven(product: TrainProduct) -> tuple[float, float]:
    """Turns of the carrier, and of the central by which a pose is told beside it (see `PlanetaryTrain.pose`)."""
    train = product.train
    turns, (first, second) = turns_of(product.plan.layout, product.speeds), train.centrals
    held_first = train.fixed is not None and shafts_of(train)[train.fixed].member == first.name
    return turns[train.carrier.name], turns[first.name if held_first else second.name]


def _closed(product: TrainProduct, carrier: float, central: float) -> Loop | None:
    """The shortest loop with turns in this proportion; None where nothing turns, or it is too long."""
    turning = _Turning(product, carrier, central)
    rates = turning.rates
    if rates is None or not any(rates):
        return None
    once = come_round(rates)
    for times in range(1, product.train.planets + 1):
        turns = float(times * once)
        pitches = turning.pitches(turns)
        if (frames := frames_for(pitches)) is None:
            return None
        if turning.looks_alike_after(turns):
            return Loop(lambda share: turning.scene(share * turns), frames, pitches)  # noqa: B023 - returned at once
    return None


def _cut_short(product: TrainProduct, carrier: float, central: float) -> Loop:
    """As much of the motion as the longest loop shows."""
    turning = _Turning(product, carrier, central)
    turns = MOST_FRAMES / QUICK / turning.pitches(1.0)
    text = f"it would come round in more than {MOST_FRAMES} frames only: at its end the loop jumps"
    return Loop(
        lambda share: turning.scene(share * turns),
        MOST_FRAMES,
        turning.pitches(turns),
        closes=False,
        notices=(Notice("does-not-close", text, where="turning"),),
    )


@dataclass(frozen=True, eq=False)
class _Turning:
    """A train whose carrier and told central turn in a proportion."""

    product: TrainProduct
    carrier: float
    central: float

    def scene(self, turns: float) -> list[Part]:
        """All in its place after so many times these turns."""
        return self.product.scene(360 * self.carrier * turns, 360 * self.central * turns)

    def layout(self, turns: float) -> TrainLayout:
        """The same without bodies."""
        return self.product.plan.turned(360 * self.carrier * turns, 360 * self.central * turns).layout

    @cached_property
    def _both(self) -> list[tuple[Standing, float]]:
        """What stands, and its own turns each time."""
        begun, turned = self.layout(0.0).standing, self.layout(1.0).standing
        return [(one, (other.rotation - one.rotation) / 360) for one, other in zip(begun, turned, strict=True)]

    @property
    def rates(self) -> list[Fraction] | None:
        """Pitches that pass each time of all with an axis at rest, and equal parts of the carrier; None where not exact."""
        passed = [self.carrier * _symmetry(self.product.train)]
        passed += [turns * each.body.gear.tooth_count for each, turns in self._both if each.axle.on is None]
        found = [Fraction(each).limit_denominator(_LARGEST) for each in passed]
        exact = all(abs(each - one) <= _EXACT * max(1.0, abs(one)) for each, one in zip(found, passed, strict=True))
        return found if exact else None

    def pitches(self, turns: float) -> float:
        """Most pitches that pass of any gear in so many times."""
        return max(abs(turns * each * standing.body.gear.tooth_count) for standing, each in self._both)

    def looks_alike_after(self, turns: float) -> bool:
        """Whether every body then stands where one of its kind stood at first, its teeth where teeth were."""
        begun = list(self.layout(0.0).standing)
        return all(any(_alike(one, other) for one in begun) for other in self.layout(turns).standing)


def _alike(one: Standing, other: Standing) -> bool:
    if one.body.key != other.body.key or math.dist(one.offset, other.offset) > _SAME:
        return False
    passed = (other.rotation - one.rotation) / 360 * one.body.gear.tooth_count
    return abs(passed - round(passed)) < _SAME


def _symmetry(train: PlanetaryTrain) -> int:
    """Of how many equal parts the carrier is."""
    angles = sorted(angle % 360 for angle in train.angles)
    for parts in range(train.planets, 1, -1):
        turned = sorted((angle + 360 / parts) % 360 for angle in angles)
        if all(abs((a - b + 180) % 360 - 180) < _SAME for a, b in zip(angles, turned, strict=True)):
            return parts
    return 1
