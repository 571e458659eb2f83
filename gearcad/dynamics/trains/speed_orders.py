"""Orders of the speed at which teeth and torques excite a train, and what there is to know of its torques.

Orders are those of the speed of the first mesh's pinion, or of the first inertia where there is no mesh.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from gearcad.core.records import Notice
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.train import Train, parts_of

_OF_TEETH = 2
"""Harmonics of each tooth frequency that are listed."""

_OF_TORQUES = 6
"""Greatest harmonics of each torque that are listed."""


class SpeedOrder(NamedTuple):
    """An order of the speed of the first pinion, and its sources in words: "teeth", "firing"."""

    order: float
    source: str


def speed_orders(train: Train, excitation: Excitation, more: Sequence[float] = ()) -> tuple[SpeedOrder, ...]:
    """Return the orders to be charted, rising: of teeth, of the torques on inertias, and `more` of them."""
    sources: dict[Fraction, list[str]] = {}
    teeth = train.meshes[0].teeth if train.meshes else 1
    for mesh, own in zip(train.meshes, excitation.meshes, strict=True):
        for harmonic in range(1, _OF_TEETH + 1):
            sources.setdefault(harmonic * own.frequency_ratio * teeth, []).append(mesh.name)
    waves = iter(excitation.torques)
    for each in train.excitations:
        found = [next(waves) for _ in each.harmonics]
        for wave in sorted(found, key=lambda wave: -abs(wave.coefficient))[:_OF_TORQUES]:
            sources.setdefault(wave.frequency_ratio * teeth, []).append(each.name)
    for order in more:
        sources.setdefault(Fraction(order).limit_denominator(1000), [])
    return tuple(SpeedOrder(float(order), ", ".join(dict.fromkeys(of))) for order, of in sorted(sources.items()))


def least_even_speed(train: Train, share: float = 1.0) -> float:
    """Return the speed (rpm) below which harmonic torques swing that of a train free to turn by more than a `share` of it.

    A torque T of order o swings the whole, of inertia J, by T/(o J w) at the speed w. It is 0 for a train that is held.
    """
    if train.held or not train.excitations:
        return 0.0
    parts, ratios = parts_of(train), train.speed_ratios
    names = [inertia.name for inertia in parts.inertias]
    inertia = sum(each.inertia * ratios[each.name] ** 2 for each in parts.inertias)
    swings = sum(
        abs(harmonic.amplitude) / (float(harmonic.order) * inertia)
        for each in train.excitations
        if each.inertia in names
        for harmonic in each.harmonics
    )
    return math.sqrt(swings / share) * 30 / math.pi


_UNEVEN = 0.1
"""Part of the speed that harmonic torques may swing without being told."""


def torque_notices(train: Train, first: float) -> tuple[Notice, ...]:
    """Return notices of torques and means that are left out, and of uneven turns at speeds from `first` rpm on."""
    found, names = list[Notice](), [inertia.name for inertia in parts_of(train).inertias]
    for each in train.excitations:
        if each.inertia not in names:
            text = f"acts on {each.inertia}, which the model {train.model.value!r} does not have: it is left out"
            found.append(Notice("torque-left-out", text, each.name))
        if each.file is not None and abs(each.file.mean) > 1e-9 * max(map(abs, each.file.torque)):
            text = f"the mean of its file, {each.file.mean:.5g} N·m, is left out: the torques at rest stand in train.torques"
            found.append(Notice("mean-left-out", text, each.name))
    uneven = least_even_speed(train, _UNEVEN)
    if uneven > first:
        text = (
            f"below {uneven:.5g} rpm harmonic torques swing the speed of the whole train by more than {100 * _UNEVEN:g} %: "
            "results there are for an even turn"
        )
        found.append(Notice("uneven-turn", text))
    return tuple(found)
