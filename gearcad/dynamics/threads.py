"""Work that leaves the interpreter to others - compiled code, FFT - on all cores at once."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

__all__ = ["cores", "on_all_cores"]

Item = TypeVar("Item")
Found = TypeVar("Found")


def on_all_cores(
    work: Callable[[Item], Found], items: Sequence[Item], counted: Callable[[int, int], None] = lambda _done, _count: None
) -> list[Found]:
    """What `work` makes of each of the items, in their order; `counted` hears how many are done, and of how many."""
    found: list[Found] = []
    with ThreadPoolExecutor(cores()) as pool:
        try:
            for done, each in enumerate(pool.map(work, items)):
                found.append(each)
                counted(min(done + 1, len(items) - 1), len(items))
        except BaseException:
            pool.shutdown(cancel_futures=True)  # what is raised, such as Ctrl-C, waits for none that has not begun
            raise
    return found


def cores() -> int:
    """That this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
