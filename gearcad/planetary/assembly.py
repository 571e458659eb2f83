"""Whether a planetary train can be put together: as many values as planets, room for them, teeth that fit at each."""

from __future__ import annotations

import math

from gearcad.errors import GeometryError, ParameterError
from gearcad.planetary.clearances import check_heights, check_neighbours, with_room
from gearcad.planetary.fitting import SetTeeth
from gearcad.planetary.poses import assembled
from gearcad.planetary.train_data import EQUAL, PERMITTED, TrainData

__all__ = ["check_angles", "check_assembly", "check_errors", "fitting_planets", "fitting_teeth"]

MISFIT = 1e-7
"""Pitches by which teeth may miss their spaces from rounding."""

_NEAR = 4
"""By how many teeth a gear is changed in search of a set that can be put together."""

_OFFERED = 4
"""How many of such sets are told."""


def check_errors(train: TrainData) -> None:
    """As many errors as planets. Raises ParameterError."""
    given = {f"{rim.name}.tooth_errors": rim.tooth_errors for rim in train.rims}
    given[f"{train.carrier.name}.pin_errors"] = train.carrier.pin_errors
    for name, values in given.items():
        if len(values) not in (0, train.planets):
            permitted = f"must be {train.planets} values, one a planet, or none; there are {len(values)}"
            raise ParameterError(name, list(values), permitted)


def check_angles(train: TrainData) -> None:
    """As many angles as planets. Raises ParameterError."""
    angles = train.planet_angles
    if angles not in (EQUAL, PERMITTED) and (isinstance(angles, str) or len(angles) != train.planets):
        permitted = f'must be "equal", "permitted" or {train.planets} angles, one a planet'
        raise ParameterError("planet_angles", angles, permitted)


def check_assembly(train: TrainData) -> None:
    """Nothing is in the way of anything, and the teeth fit. Raises ParameterError, GeometryError with what would do."""
    check_heights(train)
    try:
        check_neighbours(train)
    except GeometryError as error:
        if misfit := first_misfit(train):
            raise GeometryError(error.parameter, error.value, f"{error.permitted}; and {misfit[1]}", error.unit) from error
        raise
    check_teeth(train)


def check_teeth(train: TrainData) -> None:
    """The teeth fit where the planets stand. Raises GeometryError with where they would, and which sets near by can."""
    if misfit := first_misfit(train):
        angle, off = misfit
        near = " or ".join(f"{each:.7g}" for each in _fitting_beside(train, angle))
        permitted = f"must let the teeth fit: {off}, it fits at {near} deg; {_what_can(train)}"
        raise GeometryError("planet_angles", train.planet_angles, permitted)


def first_misfit(train: TrainData) -> tuple[float, str] | None:
    """Angle (degrees) of the first planet whose teeth miss their spaces, and in words by how much; None if all fit."""
    for number, (angle, misfit) in enumerate(zip(train.angles, assembled(train).misfits, strict=True), start=1):
        if abs(misfit) > MISFIT:
            return angle, f"planet {number} at {angle:.7g} deg is {abs(misfit):.4g} pitches off in {train.meshes[0].name}"
    return None


def _fitting_beside(train: TrainData, angle: float) -> tuple[float, float]:
    """Where the teeth fit (degrees) next below and above an angle."""
    step, start = 360 / train.positions, train.angles[0]
    below = start + math.floor((angle - start) / step) * step
    return below, below + step


def _what_can(train: TrainData) -> str:
    """In words: all angles that fit, and how planets at equal angles would."""
    everywhere = f"all multiples of 360/{train.positions} deg do"
    if train.planet_angles != EQUAL:
        return everywhere
    words = [everywhere, '"permitted" takes the nearest']
    if planets := fitting_planets(train):
        words.append(f"at equal angles planets = {_either(planets)} fit")
    if sets := fitting_teeth(train):
        changed = _either([f"{name}.teeth = {teeth}" for name, teeth in sets])
        words.append(f"{train.planets} fit with {changed} and profile shifts to suit")
    return "; ".join(words)


def _either(values: tuple[int, ...] | list[str]) -> str:
    return " or ".join(map(str, values))


def fitting_planets(train: TrainData) -> tuple[int, ...]:
    """Numbers of planets next below and above, from 2 on, that have room and fit at equal angles."""
    fitting = with_room(train)[1:]
    below = [number for number in fitting if number < train.planets][-1:]
    return (*below, *[number for number in fitting if number > train.planets][:1])


def fitting_teeth(train: TrainData) -> tuple[tuple[str, int], ...]:
    """One gear each with other teeth, nearest to its own, with which the planets fit at equal angles."""
    a, b = train.meshes
    names = (a.central.name, a.rim.name, b.rim.name, b.central.name)
    found = []
    for more in (sign * size for size in range(1, _NEAR + 1) for sign in (-1, 1)):
        for name in dict.fromkeys(names):
            teeth = SetTeeth(*(z + more * (each == name) for z, each in zip(train.teeth, names, strict=True)))
            if teeth.positions and teeth.positions % train.planets == 0:
                found.append((name, teeth[names.index(name)]))
    return tuple(found[:_OFFERED])
