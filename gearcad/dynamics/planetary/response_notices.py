"""What to know before trusting the response of a planetary train: what its model leaves out, and motions that do not last."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from gearcad.arrays import Bools, Floats
from gearcad.dynamics.charts.over_speed import OverSpeed
from gearcad.dynamics.planetary.disturbances import set_members
from gearcad.dynamics.planetary.mesh_stiffness import MeshStiffness
from gearcad.dynamics.planetary.modes import PlanetaryModes
from gearcad.dynamics.planetary.sharing import share_load
from gearcad.dynamics.response.notices import frequency_ranges
from gearcad.errors import GeometryError, ParameterError, SolverError
from gearcad.notice import Notice
from gearcad.planetary import PlanetaryTrain, TrainLoad

__all__ = ["differences_where_parted", "errors_left_out", "planets_differ", "stages_left_out", "turning_axes"]

_FAST = 0.05
"""Twice the speed of the carrier over the lowest natural frequency from which on turning axes are to be minded."""


def turning_axes(modes: PlanetaryModes, carrier: float, highest_speed: float) -> tuple[Notice, ...]:
    """Where axes that turn with the carrier would show; `carrier` is its speed over that of the input."""
    elastic = modes.circular[modes.rigid :]
    rpm = abs(carrier * highest_speed)
    ratio = 2 * rpm * math.pi / 30 / float(elastic.min(initial=math.inf))
    if ratio < _FAST:
        return ()
    text = (
        f"the carrier turns at up to {rpm:.4g} rpm, of which twice the angular speed is {ratio:.2g} of the lowest natural"
        " frequency: gyroscopic and centrifugal terms, which this model leaves out, would shift it there"
    )
    return (Notice("turning-axes", text),)


def stages_left_out(train: PlanetaryTrain) -> tuple[Notice, ...]:
    """That stages vibrate by themselves here."""
    if not train.stages:
        return ()
    names = " and ".join(stage.name for stage in train.stages)
    return (Notice("stages-left-out", f"inertias and meshes of {names} are no part of the vibrating model", "stages"),)


def errors_left_out(
    train: PlanetaryTrain, load: TrainLoad, stiffness: Mapping[str, MeshStiffness], given_speeds: Mapping[str, float] | None
) -> tuple[Notice, ...]:
    """That planets carry even shares in spite of errors, and what these make of the shares at rest."""
    errors = tuple(_errors(train))
    if not errors:
        return ()
    text = (
        f"errors are left out ({', '.join(errors)}): here every planet carries an even share at rest,"
        f" and factors refer to it; {_shares_at_rest(train, load, stiffness, given_speeds)}"
    )
    return (Notice("errors-left-out", text, "response"),)


def _errors(train: PlanetaryTrain) -> Iterator[str]:
    """Names of those that are not 0."""
    if any(train.carrier.pin_errors):
        yield f"pin errors of {train.carrier.name}"
    for rim in train.rims:
        if any(rim.tooth_errors):
            yield f"tooth errors of {rim.name}"
    for member in set_members(train):
        if member.run_out:
            yield f"run-out of {member.name}"


def _shares_at_rest(
    train: PlanetaryTrain, load: TrainLoad, stiffness: Mapping[str, MeshStiffness], given_speeds: Mapping[str, float] | None
) -> str:
    means = {name: each.mean for name, each in stiffness.items()}
    try:
        sharing = share_load(train, load, means, given_speeds)
    except (ParameterError, GeometryError, SolverError) as error:
        return f"their load sharing at rest could not be had: {error}"
    found = f"with them K_gamma at rest is {sharing.mesh_load_factor:.3g}"
    if not sharing.unloaded:
        return found
    planets = ", ".join(str(planet + 1) for planet in sharing.unloaded)
    return f"{found}, and planets without contact at some angle: {planets}"


def planets_differ(frequencies: Floats, growing: Bools) -> tuple[Notice, ...]:
    """That planets do not go on doing the same at some of the tooth frequencies (s,) in 1/s."""
    if not growing.any():
        return ()
    text = (
        f"planets cease to do the same at tooth frequencies (1/s) {frequency_ranges(frequencies, growing)}: modes in which they"
        " differ grow there while flanks stay in contact, so what is given does not last; what the train does instead is not"
        " computed, and can be greater"
    )
    return (Notice("planets-differ", text),)


def differences_where_parted(over: OverSpeed) -> tuple[Notice, ...]:
    """How planets taken for one are judged where their flanks part."""
    if over.branch is None and over.runs is None:
        return ()
    text = "whether planets go on doing the same where flanks part is judged as if flanks stayed in contact"
    return (Notice("planets-in-contact", text),)
