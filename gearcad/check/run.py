"""The structural check of a pair, by the model that its teeth ask for."""

from __future__ import annotations

from dataclasses import replace

from gearcad.check.load_distribution import load_distribution
from gearcad.check.options import CheckOptions, Model
from gearcad.check.plane.run import PLANE_MEMORY, check_plane, plane_steps
from gearcad.check.result import CheckResult
from gearcad.check.solid.expected import expected_solid, solid_steps
from gearcad.check.solid.run import check_solid
from gearcad.check.task import check_task
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.mounting import Mounting
from gearcad.progress import Agenda, Expected, Progress
from gearcad.rating.options import RatingOptions

__all__ = ["check_pair", "expected_check"]


def check_pair(
    pair: GearPair,
    material: Materials,
    load: Load,
    options: CheckOptions | None = None,
    progress: Progress | None = None,
    mounting: Mounting | None = None,
    rating: RatingOptions | None = None,
) -> CheckResult:
    """Check a pair under a load: a plane through the middle of the common face width, or solid bodies.

    `rating` is what the references by ISO 6336 or DIN 3990 go by.
    Raises ParameterError and GeometryError for input that cannot be checked, SolverError where a solver fails.
    """
    task = check_task(pair, material, load, options, mounting, rating)
    if task.rating_options.face_load_factor == "fe":
        found = load_distribution(pair, material, load, rating, mounting=mounting, check=options)
        task = replace(task, body_load=found.body_load)
    if task.model is Model.PLANE:
        return check_plane(task, Agenda(progress, plane_steps(task)))
    return check_solid(task, Agenda(progress, solid_steps(task)))


def expected_check(
    pair: GearPair,
    material: Materials,
    load: Load,
    options: CheckOptions | None = None,
    mounting: Mounting | None = None,
    rating: RatingOptions | None = None,
) -> Expected:
    """What `check_pair` is expected to take. Raises what it raises for input that cannot be checked."""
    task = check_task(pair, material, load, options, mounting, rating)
    if task.model is Model.PLANE:
        return Expected(sum(plane_steps(task).values()), PLANE_MEMORY)
    return expected_solid(task)
