"""The structural check of a pair, by the model that its teeth ask for."""

from __future__ import annotations

from collections.abc import Callable

from gearcad.check.options import CheckOptions, Model
from gearcad.check.plane import PLANE_STEPS, check_plane
from gearcad.check.result import CheckResult, Task
from gearcad.check.solid import SOLID_STEPS, check_solid
from gearcad.errors import GeometryError, ParameterError
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.rating.options import RatingOptions

__all__ = ["Progress", "check_pair"]

Progress = Callable[[str, int, int], None]
"""Called with what is being done, how many steps are done, and how many there are."""


def check_pair(
    pair: GearPair,
    material: Material,
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
    options, mounting = options or CheckOptions(), mounting or Mounting()
    task = Task(
        pair=mounting.mounted(pair),
        material=material,
        load=load,
        mounting=mounting,
        options=options,
        rating_options=rating or RatingOptions(),
    )
    _require_meshing(task)
    if options.model_for(pair) is Model.PLANE:
        return check_plane(task, _teller(progress, PLANE_STEPS))
    return check_solid(task, _teller(progress, SOLID_STEPS))


def _teller(progress: Progress | None, steps: tuple[str, ...]) -> Callable[[str], None]:
    return lambda step: progress(step, steps.index(step), len(steps)) if progress is not None else None


def _require_meshing(task: Task) -> None:
    """Raise for what no contact analysis can make sense of."""
    if not task.torque:
        raise ParameterError("load.torque", task.torque, "must not be 0: without torque there is nothing to check", "N·m")
    if task.pair.transverse_contact_ratio < 1:
        ratio = task.pair.transverse_contact_ratio
        raise GeometryError("pair.transverse_contact_ratio", ratio, "must be at least 1: the teeth lose each other")
