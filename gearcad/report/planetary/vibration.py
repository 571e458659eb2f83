"""How a train vibrates: its natural modes."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.modes import ModeFamily, PlanetaryModes
from gearcad.dynamics.planetary.springs import Spring, SpringKind
from gearcad.planetary import PlanetaryTrain
from gearcad.plots.paper import short
from gearcad.plots.planetary.modes import MOST_MODES, modes_inches, plot_modes, shown_families
from gearcad.report.check.figures import Picture
from gearcad.report.dynamics.tables import WordTable
from gearcad.report.planetary.sections import Section, Table, figure, said

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.result import PlanetaryStudy

__all__ = ["sections_of_vibration"]


def sections_of_vibration(study: PlanetaryStudy) -> Iterator[Section]:
    """Natural modes, where they are known."""
    if study.modes is not None:
        yield _modes(study.train, study.modes)


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
