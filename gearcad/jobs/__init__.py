"""What gearcad does with a design, one module a verb."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

from gearcad.verbs import VERBS

if TYPE_CHECKING:
    from gearcad.jobs.job import Job

__all__ = ["JOBS"]


class _Jobs(Mapping[str, "type[Job[Any, Any]]"]):
    """The jobs by their verbs, in the order of use, each imported when it is asked for."""

    def __getitem__(self, verb: str) -> type[Job[Any, Any]]:
        if verb not in VERBS:
            raise KeyError(verb)
        found: type[Job[Any, Any]] = getattr(import_module(f"gearcad.jobs.{verb}"), verb.capitalize())
        return found

    def __iter__(self) -> Iterator[str]:
        return iter(VERBS)

    def __len__(self) -> int:
        return len(VERBS)


JOBS: Mapping[str, type[Job[Any, Any]]] = _Jobs()
