"""The jobs that gearcad does with a design: its verbs in the order of use, and the module of each.

A module of `gearcad.jobs` has the class and the function of a verb: `Check` is what commands and tables do, `check` is
`gearcad.check`. A function of its name in `gearcad.cli` makes it a command, and a step of `gearcad batch --do`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gearcad.designs.design import Design
    from gearcad.jobs.job import Job, Result

__all__ = ["VERBS", "WITHOUT_DESIGN", "job_for", "job_of"]

VERBS = (
    "data",
    "build",
    "draw",
    "picture",
    "verify",
    "check",
    "mesh",
    "rate",
    "stiffness",
    "dynamics",
    "planetary",
    "shafts",
    "modify",
)
WITHOUT_DESIGN = ("identify", "tools")
"""Verbs that begin without a design: functions, and no jobs."""

_MODULES = {
    "data": "job",
    "picture": "draw",
    "check": "strength",
    "rate": "strength",
    "stiffness": "strength",
    "identify": "searches",
    "verify": "verification",
}


def module_of(verb: str) -> str:
    """Return the name of the module of `gearcad.jobs` in which a verb stands."""
    return _MODULES.get(verb, verb)


def job_of(verb: str) -> type[Job[Any, Any]]:
    """Return the class of the job of a verb, imported when it is asked for."""
    found: type[Job[Any, Any]] = getattr(import_module(f"gearcad.jobs.{module_of(verb)}"), verb.capitalize())
    return found


def job_for(job: Job[Any, Result], design: Design) -> Job[Any, Result]:
    """Return the job for a design: of a train of pairs the one that does the same with it and with each of its meshes.

    What trains and gearboxes of planetary sets need is imported for these only.
    """
    if design.kind.value == "planetary_gearbox":
        other: Job[Any, Result] = import_module("gearcad.jobs.gearbox_bodies").suited_to_gearbox(job)
        return other
    if design.kind.value != "train":
        return job
    found: Job[Any, Result] = import_module("gearcad.jobs.train_sheets").job_for(job, design)
    return found
