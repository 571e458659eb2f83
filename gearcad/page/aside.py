"""Aside: what takes long of a design is found in a process beside the server, so that no keystroke waits for it."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any, TypeVar

from gearcad.batch.worker import close_workers, isolated, own_worker
from gearcad.designs.design import Design

__all__ = ["close_aside", "found_aside"]

_LONGEST = 120.0
"""Seconds after which it is given up."""

_NICENESS = 5
"""The page itself goes before."""

_ASIDE = ThreadPoolExecutor(1, thread_name_prefix="gearcad-aside", initializer=own_worker)

Found = TypeVar("Found")


async def found_aside(find: Callable[[Design], Found], design: Design) -> Found:
    """What a function of a module finds of a design, one of all sessions after the other.

    Raises what it raises, and WorkerLostError where its process is gone.
    """
    found: Found = await asyncio.get_running_loop().run_in_executor(_ASIDE, isolated, _found, (find, design), _LONGEST)
    return found


def close_aside() -> None:
    """The server ends: so does what is being found."""
    _ASIDE.shutdown(wait=False, cancel_futures=True)
    close_workers()


def _found(asked: tuple[Callable[[Design], Any], Design]) -> Any:
    """In the process beside the server."""
    with suppress(AttributeError, OSError):
        os.setpriority(os.PRIO_PROCESS, 0, _NICENESS)
    find, design = asked
    return find(design)
