"""The stages of a row: jobs, whose parts are made, kept and made again each on its own."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from gearcad.designs import Design
from gearcad.errors import ParameterError
from gearcad.jobs import VERBS
from gearcad.jobs.data import Data
from gearcad.jobs.job import Job

__all__ = ["DATA", "make_parts", "stages"]

DATA = "data"
"""The part that every row has: the table of results needs it."""


def stages(wanted: Sequence[Job[Any, Any]]) -> tuple[Job[Any, Any], ...]:
    """The jobs in the order in which a row does them: one that fails leaves what those before it have made.

    Raises ParameterError for none.
    """
    if not wanted:
        raise ParameterError("do", "", f"must be one or more of {', '.join(VERBS)}")
    others = sorted((job for job in wanted if job != Data()), key=lambda job: VERBS.index(job.verb))
    return tuple(others) if any(DATA in job.parts for job in others) else (Data(), *others)


def make_parts(job: Job[Any, Any], design: Design, parts: Sequence[str], folder: Path) -> None:
    """Make some of a job's parts in an empty folder."""
    maker = job.for_row(design, parts)
    for name, write in maker.files(maker.run(design)).items():
        if job.part_of(name):
            write(folder / name)
