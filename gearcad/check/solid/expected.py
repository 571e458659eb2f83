"""The steps of a check of solid bodies, and what they are expected to take."""

from __future__ import annotations

from gearcad.check.convergence import FEW_POSITIONS, SOLID_FACTORS
from gearcad.check.options import Model
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded_left import loaded_left
from gearcad.contact.solid.cost import LEFT, POSITION_SECONDS
from gearcad.contact.solid.pair import SolidSizes, expected_bodies
from gearcad.progress import Expected

__all__ = ["BODIES", "COARSER", "CYCLE", "FINER", "RATING", "SWEEP", "expected_solid", "sizes_of", "solid_steps"]

BODIES, CYCLE, SWEEP, RATING = "bodies of pinion and wheel", "mesh cycle", "torque sweep", "rating"
COARSER, FINER = "coarser bodies, for the error", "finer bodies, for the error"

_SINGLE_POSITIONS = 15

_SOUGHT = 2
"""How many times the positions asked for there are with those between them, where extremes are sought."""
_RATING_SECONDS = 0.2

_PROGRAM = 0.27e9
"""Bytes of Python and its libraries, and of contacts."""


def sizes_of(task: CheckTask, factor: float) -> SolidSizes:
    """Sizes of the check's mesh, refined by a factor."""
    return SolidSizes().refined(factor * task.options.refinement)


def _bodies(task: CheckTask) -> dict[str, Expected]:
    factors = dict(zip((COARSER, BODIES, FINER), SOLID_FACTORS, strict=True))
    wanted = (BODIES, COARSER, FINER) if task.options.refines else (BODIES,)
    pair = loaded_left(task.pair, task.torque)
    return {name: expected_bodies(pair, task.body, sizes_of(task, factors[name]), fields=name == BODIES) for name in wanted}


def solid_steps(task: CheckTask) -> dict[str, float]:
    """Seconds expected of each step, in order."""
    few = _SOUGHT * FEW_POSITIONS * POSITION_SECONDS
    cycle = _SOUGHT * task.options.positions_of(Model.SOLID)
    bodies = {name: each.seconds + cycle * POSITION_SECONDS for name, each in _bodies(task).items()}
    positions = cycle + _SINGLE_POSITIONS
    return {
        BODIES: bodies.pop(BODIES) - cycle * POSITION_SECONDS,
        CYCLE: positions * POSITION_SECONDS,
        SWEEP: len(task.torques) * few,
        **bodies,
        RATING: _RATING_SECONDS,
    }


def expected_solid(task: CheckTask) -> Expected:
    """Of the whole check: the bodies of the check's own mesh are kept, without factors, while the others are solved."""
    own, *others = (each.memory for each in _bodies(task).values())
    return Expected(sum(solid_steps(task).values()), _PROGRAM + max(own, LEFT * own + max(others, default=0.0)))
