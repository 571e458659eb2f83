"""What gearcad does with a design, one module a verb."""

from __future__ import annotations

from importlib import import_module

from gearcad.jobs.verbs import VERBS, WITHOUT_DESIGN
from gearcad.lazy import lazily

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from typing import Any

    from gearcad.jobs.job import Job

__all__ = ["VERBS", "WITHOUT_DESIGN", "job_of"]

__getattr__ = lazily(__name__, __all__, (), ("job", "subject", *VERBS, *WITHOUT_DESIGN))


def job_of(verb: str) -> type[Job[Any, Any]]:
    """The job of a verb, imported when it is asked for."""
    found: type[Job[Any, Any]] = getattr(import_module(f"gearcad.jobs.{verb}"), verb.capitalize())
    return found
