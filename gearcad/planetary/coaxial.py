"""The one centre distance of both meshes of a set: that which is given, or that at which they run without backlash."""

from __future__ import annotations

from dataclasses import replace

from gearcad.errors import GeometryError, InputError
from gearcad.geometry.derived import derive, is_given
from gearcad.geometry.mating import check_mates, check_shift_sum
from gearcad.geometry.pair_data import PairData
from gearcad.planetary.mesh import mates_of
from gearcad.planetary.train_data import TrainData

__all__ = ["settle_centre_distance"]

SAME_DISTANCE = 1e-4
"""Difference of two centre distances, in normal modules, that comes from profile shifts printed to four digits."""


def settle_centre_distance(train: TrainData) -> None:
    """Derive the centre distance unless it is given, and see that both meshes run at it. Raises InputError."""
    pairs = [mates_of(central, train.rim_of(central)) for central in train.centrals]
    distances = [_free_distance(pair) for pair in pairs]
    if is_given(train.centre_distance):
        _check_given(train, pairs, distances)
        return
    if abs(distances[0] - distances[1]) > SAME_DISTANCE * max(pair.pinion.normal_module for pair in pairs):
        raise _not_coaxial(train, pairs, distances)
    derive(train, "centre_distance", distances[0])
    train.meshes  # noqa: B018 - made now, so that what is refused of a mesh is refused here


def _free_distance(pair: PairData) -> float:
    """Centre distance (mm, a magnitude) at which a central and its rim run without backlash."""
    try:
        check_mates(pair)
        check_shift_sum(pair)
    except InputError as error:
        raise error.within(pair.name) from None
    return abs(pair.centre_distance_for(pair.profile_shift_sum))


def _check_given(train: TrainData, pairs: list[PairData], distances: list[float]) -> None:
    """Raise GeometryError, with both distances, where a mesh does not run at the one that is given."""
    try:
        train.meshes  # noqa: B018
    except InputError as error:
        if not error.parameter.endswith(".centre_distance"):
            raise
        failing = next(number for number, pair in enumerate(pairs) if error.parameter == f"{pair.name}.centre_distance")
        would = _shift_for(train, pairs, failing, float(train.centre_distance))
        permitted = f"must suit both meshes, which {_words(pairs, distances)}; {error}{would}"
        raise GeometryError("centre_distance", train.centre_distance, permitted, "mm") from None


def _not_coaxial(train: TrainData, pairs: list[PairData], distances: list[float]) -> GeometryError:
    """The error for meshes that run without backlash at two centre distances."""
    central, words = train.centrals[1], _words(pairs, distances)
    try:
        shift = _placed(pairs[1], distances[0]).zero_backlash_shift_sum - train.rim_of(central).gear.profile_shift
    except InputError:  # not even the base circles stand clear
        permitted = f"must suit one centre distance: the meshes {words}, too far apart for profile shifts"
        return GeometryError(f"{central.name}.teeth", central.gear.teeth, permitted)
    permitted = f"must be {shift:.4f} for one centre distance: the meshes {words}; or give one that suits both"
    return GeometryError(f"{central.name}.profile_shift", central.gear.profile_shift, permitted)


def _words(pairs: list[PairData], distances: list[float]) -> str:
    first, second = (f"{distance:.3f} mm ({pair.name})" for pair, distance in zip(pairs, distances, strict=True))
    return f"run without backlash at {first} and {second}"


def _placed(pair: PairData, distance: float) -> PairData:
    """The pair at a centre distance (mm, a magnitude)."""
    return replace(pair, centre_distance=-distance if pair.internal else distance)


def _shift_for(train: TrainData, pairs: list[PairData], number: int, distance: float) -> str:
    """In words the shift of a central with which its mesh runs at a distance (mm), "" if none: that which leaves the thinning
    as backlash, and with thinning that which leaves none."""
    central = train.centrals[number]
    try:
        placed, other = _placed(pairs[number], distance), train.rim_of(central).gear.profile_shift
        tight, free = placed.fitting_shift_sum - other, placed.zero_backlash_shift_sum - other
    except InputError:  # not even the base circles stand clear
        return ""
    if free >= tight:
        return f"; {central.name}.profile_shift = {tight:.4f} would do, without backlash"
    return f"; {central.name}.profile_shift = {free:.4f} would do, with the thinning as backlash (at {tight:.4f} without any)"
