"""Decks of a pair: its gears under its load as input that CalculiX runs, and what our own check finds of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

from gearcad.check.options import CheckOptions, Model
from gearcad.check.task import CheckTask, check_task
from gearcad.decks.pair import PairDecks
from gearcad.decks.plane import PlaneDecks
from gearcad.decks.plane_tooth import plane_tooth_deck
from gearcad.decks.solid import SolidDecks, solid_task
from gearcad.decks.solid_tooth import solid_tooth_deck
from gearcad.designs import PairDesign
from gearcad.material import Material
from gearcad.meshing.options import DeckKind, MeshOptions
from gearcad.meshing.plan import MeshPlan
from gearcad.meshing.result import Deck
from gearcad.per_gear import Role
from gearcad.progress import Agenda, Progress

__all__ = ["make_decks"]


def make_decks(design: PairDesign, plan: MeshPlan, progress: Progress | None) -> dict[str, Deck]:
    """The decks that the options of a plan ask for, by the names of their files.

    Raises ParameterError, GeometryError and SolverError for what cannot be checked.
    """
    if not plan.options.decks:
        return {}
    makers = dict(_makers(plan.options, *_decks(design, plan)))
    agenda = Agenda(progress, dict.fromkeys(makers, 1.0))
    made: dict[str, Deck] = {}
    for name, make in makers.items():
        agenda(name)
        made[name] = make()
    return made


def _decks(design: PairDesign, plan: MeshPlan) -> tuple[PairDecks, Callable[[float, Role], Deck]]:
    """Decks of the pair, and what makes that of one gear at a roll angle (deg)."""
    if plan.solid:
        solid = SolidDecks(solid_task(_task(design, Model.SOLID)))
        return solid, partial(solid_tooth_deck, solid)
    plane = PlaneDecks(_task(design, Model.PLANE))
    return plane, partial(plane_tooth_deck, plane)


def _makers(
    options: MeshOptions, decks: PairDecks, tooth: Callable[[float, Role], Deck]
) -> Iterator[tuple[str, Callable[[], Deck]]]:
    """Names of files, and what makes their decks: at the roll angle of the options, or at so many over one base pitch."""
    count, pitch = options.positions, 360 / decks.pair.pinion.teeth
    for number in range(count):
        place = "" if count == 1 else f"_{number + 1:0{len(str(count))}}"
        angle = options.roll + pitch * ((number + 0.5) / count - 0.5)
        if DeckKind.PAIR in options.decks:
            yield f"pair_deck{place}.inp", partial(decks.at, angle)
        if DeckKind.TOOTH in options.decks:
            yield from ((f"{role.value}_deck{place}.inp", partial(tooth, angle, role)) for role in Role)


def _task(design: PairDesign, model: Model) -> CheckTask:
    options = replace(design.check or CheckOptions(), model=model.value)
    load = design.loaded("a deck is of pressed flanks")
    return check_task(design.pair, design.material or Material(), load, options, design.mounting, design.rating)
