"""How a train vibrates: its natural modes, what excites them, and loads over speed."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.campbell import PlanetaryCampbell
from gearcad.dynamics.planetary.modes import ModeFamily, PlanetaryModes
from gearcad.dynamics.planetary.response import PlanetaryResponse
from gearcad.dynamics.planetary.springs import Spring, SpringKind
from gearcad.planetary import PlanetaryTrain
from gearcad.plots.paper import short
from gearcad.plots.planetary.campbell import CAMPBELL_INCHES, highest_drawn, plot_train_campbell
from gearcad.plots.planetary.modes import MOST_MODES, modes_inches, plot_modes, shown_families
from gearcad.plots.planetary.response import RESPONSE_INCHES, plot_response
from gearcad.report.check.figures import Picture
from gearcad.report.dynamics.tables import WordTable
from gearcad.report.planetary.sections import Section, Table, figure, on_axes, said

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.result import PlanetaryStudy

__all__ = ["sections_of_vibration"]

_MOST_RESONANCES = 24
"""Resonances that are listed: those in which most of what the meshes could do is done, of the lowest harmonics."""


def sections_of_vibration(study: PlanetaryStudy) -> Iterator[Section]:
    """Natural modes, Campbell diagram, loads over speed: those that are known."""
    if study.modes is not None:
        yield _modes(study.train, study.modes)
    if study.campbell is not None:
        yield _campbell(study.train, study.campbell)
    if study.response is not None:
        yield _response(study.response)


def _modes(train: PlanetaryTrain, modes: PlanetaryModes) -> Section:
    pictures: tuple[Picture, ...] = ()
    if shown_families(modes):
        caption = said("modes", modes, MOST_MODES)
        pictures = (figure("Natural modes", partial(plot_modes, train, modes), modes_inches(modes), caption),)
    return Section(
        "Natural frequencies and modes",
        words=(said("mode_words", modes),),
        tables=(Table("", grid=_mode_table(modes), note=said("mode_note")),),
        figures=pictures,
    )


def _mode_table(modes: PlanetaryModes) -> WordTable:
    heads = ("modes", "kind", "most kinetic energy in", "most potential energy in", "Hz", "1/s")
    return WordTable(heads, [_mode(modes, family) for family in modes.families], 4)


def _mode(modes: PlanetaryModes, family: ModeFamily) -> tuple[str, ...]:
    """A frequency, and in what its modes have most of their energy."""
    first, last = family.first, family.first + family.multiplicity
    number = str(first + 1) if family.multiplicity == 1 else f"{first + 1} to {last}"
    members = modes.springs.members
    bodies = [*members, *["planets"] * (len(modes.bodies) - len(members))]
    kinetic = _most(bodies, modes.kinetic[first:last].mean(axis=0))
    if family.frequency == 0:
        return (number, family.kind.value, kinetic, "turns as a whole", "0", "0")
    springs = [_spring_words(spring) for spring in modes.springs.springs]
    potential = _most(springs, modes.potential[first:last].mean(axis=0))
    numbers = short(family.frequency), short(2 * np.pi * family.frequency)
    return (number, family.kind.value, kinetic, potential, *numbers)


def _spring_words(spring: Spring) -> str:
    """What a spring belongs to, all planets together."""
    if spring.kind is SpringKind.MESH:
        return spring.owner
    if spring.kind in (SpringKind.PIN_RADIAL, SpringKind.PIN_TANGENTIAL):
        return "pins"
    return f"{'hold' if spring.kind is SpringKind.TORSION else 'support'} of {spring.owner}"


def _most(names: list[str], shares: Floats) -> str:
    """The name with the greatest share, and that in percent."""
    summed: dict[str, float] = {}
    for name, share in zip(names, shares.tolist(), strict=True):
        summed[name] = summed.get(name, 0.0) + share
    most = max(summed, key=lambda name: summed[name])
    return f"{most}, {100 * summed[most]:.0f} %"


def _campbell(train: PlanetaryTrain, campbell: PlanetaryCampbell) -> Section:
    draw, table = on_axes(partial(plot_train_campbell, train, campbell)), _resonance_table(campbell)
    note = said("resonance_note", campbell, _MOST_RESONANCES)
    return Section(
        "Campbell diagram",
        words=(said("campbell_words", train, campbell),),
        tables=(Table("Excited modes", grid=table, note=note),) if table.rows else (),
        figures=(figure("Campbell diagram", draw, CAMPBELL_INCHES, said("campbell", campbell, highest_drawn(campbell))),),
    )


def _response(response: PlanetaryResponse) -> Section:
    draw = on_axes(partial(plot_response, response))
    return Section(
        "Loads over speed",
        words=(said("response_words", response),),
        figures=(figure("Loads over speed", draw, RESPONSE_INCHES, said("response", response)),),
    )


def _resonance_table(campbell: PlanetaryCampbell) -> WordTable:
    """Where harmonics of meshes excite modes: those of the largest shares, by speed."""
    found = sorted(campbell.excited, key=lambda each: (-round(each.share or 0.0, 3), campbell.lines[each.line].harmonic))
    rows = []
    for met in sorted(found[:_MOST_RESONANCES], key=lambda each: each.speed):
        family = campbell.families[met.family]
        numbers = (short(met.speed), short(met.frequency), f"{met.share or 0.0:.3f}")
        rows.append((campbell.lines[met.line].name, f"{family.first + 1}, {family.kind.value}", *numbers))
    return WordTable(("line", "mode", "input, rpm", "Hz", "share"), rows, 2)
