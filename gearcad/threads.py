"""How many cores work: those of libraries of linear algebra, and work that leaves the interpreter to others, side by side."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TypeVar

__all__ = ["cores", "on_all_cores", "one_thread"]

Item = TypeVar("Item")
Found = TypeVar("Found")

_VARIABLES = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")
"""What a library reads when it is loaded, and never again."""


@contextmanager
def one_thread() -> Iterator[None]:
    """One thread for all that is loaded, and for what is loaded meanwhile."""
    from threadpoolctl import ThreadpoolController

    there = ThreadpoolController()
    given = {name: os.environ.get(name) for name in _VARIABLES}
    os.environ.update(dict.fromkeys(_VARIABLES, "1"))
    try:
        with there.limit(limits=1):
            yield
    finally:
        for name, value in given.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
        known = {each.filepath for each in there.lib_controllers}
        for each in ThreadpoolController().select(user_api="blas").lib_controllers:
            if each.filepath not in known:
                each.set_num_threads(_usual())


def _usual() -> int:
    """Threads that a library has that is loaded elsewhere."""
    asked = next((os.environ[name] for name in _VARIABLES if os.environ.get(name, "").isdecimal()), "")
    return int(asked) if asked else cores()


def on_all_cores(
    work: Callable[[Item], Found], items: Sequence[Item], counted: Callable[[int, int], None] = lambda _done, _count: None
) -> list[Found]:
    """What `work` (compiled code, FFT) makes of each of the items, in order; `counted` hears how many are done, of how many."""
    from concurrent.futures import ThreadPoolExecutor

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
