"""How many half waves the teeth raise in the shafts of a train, and how many its elements are good for."""

from __future__ import annotations

import math
from dataclasses import replace

from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.notice import Notice

__all__ = ["coarse_elements", "fitted", "good_up_to"]

_PER_HALF_WAVE, _HIGHEST = 3, 40
"""Degrees of an element for each half wave in it, and the highest degree there is."""


def _half_waves(train: Train) -> float:
    """omega L / (pi c) of the longest shaft and the quickest mesh, at 1 rpm of the first pinion; 0 for shafts without mass."""
    quickest = max(abs(train.speed_ratios[mesh.pinion]) * mesh.teeth for mesh in train.meshes) * math.pi / 30
    return quickest / math.pi * max((math.sqrt(shaft.inertia / shaft.stiffness) for shaft in train.shafts), default=0.0)


def fitted(train: Train, speed: float) -> Train:
    """A train of the model "exact", its order raised if it is too low for charts up to a speed (rpm of the first pinion)."""
    wanted = math.ceil(_PER_HALF_WAVE * _half_waves(train) * speed)
    if train.model is not TrainModel.EXACT or wanted <= train.order:
        return train
    return replace(train, order=min(wanted, _HIGHEST))


def good_up_to(train: Train) -> float:
    """The speed (rpm of the first pinion) up to which elements follow the shafts; infinite for models without half waves."""
    each = _half_waves(train)
    if train.model not in (TrainModel.EXACT, TrainModel.ELEMENTS) or not each:
        return math.inf
    return train.order / _PER_HALF_WAVE / each


def coarse_elements(train: Train, speed: float) -> tuple[Notice, ...]:
    """Where charts go on up to a speed (rpm) beyond that."""
    good = good_up_to(train)
    if speed <= good:
        return ()
    more = "" if train.order == _HIGHEST else f"; a greater order, up to {_HIGHEST}, goes further"
    text = (
        f"charts are good up to {good:.5g} rpm of the first pinion: beyond, the teeth raise more half waves in a shaft than"
        f" {train.order / _PER_HALF_WAVE:.3g}, for which elements of order {train.order} are good{more}"
    )
    return (Notice("coarse-elements", text),)
