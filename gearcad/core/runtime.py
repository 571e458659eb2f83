"""Runtime: CPU cores, memory of the machine, progress, files that ship with the package, and machine code by numba."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple, Protocol, TypeVar

Item = TypeVar("Item")
Found = TypeVar("Found")

_VARIABLES = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")
"""Variables that a library reads only when it is loaded."""


@contextmanager
def one_thread() -> Iterator[None]:
    """Limit libraries to one thread inside this context, also libraries that are loaded meanwhile."""
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


_DISTRIBUTIONS = {
    "OCP": "cadquery-ocp",
    "PIL": "pillow",
    "fontTools": "fonttools",
    "skfem": "scikit-fem",
    "vtkmodules": "vtk",
}
"""The distribution of each module that is called otherwise."""


def distribution_of(module: str) -> str:
    """Return the name of the package that has a module."""
    top = module.partition(".")[0]
    return _DISTRIBUTIONS.get(top, top)


def installed(module: str) -> bool:
    """Return whether a module can be imported, without importing it."""
    try:
        return find_spec(module) is not None
    except ImportError:
        return False


def _usual() -> int:
    """Return the number of threads of a library that is loaded elsewhere."""
    asked = next((os.environ[name] for name in _VARIABLES if os.environ.get(name, "").isdecimal()), "")
    return int(asked) if asked else cores()


def on_all_cores(
    work: Callable[[Item], Found], items: Sequence[Item], counted: Callable[[int, int], None] = lambda _done, _count: None
) -> list[Found]:
    """Return the results of `work` (compiled code, FFT) for each of the items, in order, computed on all cores.

    `counted` is called with the number of items that are done, and of all.
    """
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
    """Return the number of CPU cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def machine_memory() -> float:
    """Return the memory of the machine (bytes), or less if the system permits less; infinite if not known."""
    try:
        import resource

        machine = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        permitted = resource.getrlimit(resource.RLIMIT_AS)[0]
    except (ImportError, AttributeError, ValueError, OSError):  # Windows has neither
        return math.inf
    return float(machine if permitted == resource.RLIM_INFINITY else min(machine, permitted))


_SETTLED = 0.1
"""Share of a job from which on its own pace tells the time left."""

Progress = Callable[[str, float, float], None]
"""Function that a job calls to report its progress: the present step, the amount done, and the whole amount (0: not yet known).

Both amounts are in files, rows, steps or expected seconds. The step may have more words: "making, 2 failed".
"""

Share = Callable[[float], None]
"""Called with the share (0 ... 1) of one step that is done."""


def unheard(_share: float) -> None:
    """Ignore a share: a Share for callers that do not ask for progress."""


def part(share: Share, begin: float, end: float) -> Share:
    """Return a Share for a part that begins and ends at these shares of the whole."""
    return lambda done: share(begin + done * (end - begin))


def onwards(share: Share) -> Share:
    """Return a Share that never goes backwards, for a part that may have to be done again."""
    most = 0.0

    def tell(done: float) -> None:
        nonlocal most
        most = max(most, min(done, 1.0))
        share(most)

    return tell


class Tell(Protocol):
    """A function that is called with the name of a step and its share that is done."""

    def __call__(self, step: str, share: float = 0.0) -> None: ...


def untold(step: str, share: float = 0.0) -> None:
    """Ignore a step: a Tell for callers that do not ask for progress."""


class Expected(NamedTuple):
    """Expected cost of a job: seconds on a usual computer, and bytes of memory at the most. Both are rough.

    `makes` says in words what comes of it, where that is known beforehand.
    """

    seconds: float
    memory: float
    makes: str = ""


class Agenda:
    """The steps of a job in order, with the seconds that each is expected to take; called at the begin of each, and within."""

    def __init__(self, progress: Progress | None, steps: Mapping[str, float]) -> None:
        self._progress, self._steps = progress, steps
        self._all = sum(steps.values()) or 1.0  # steps that take nothing are still told

    def __call__(self, step: str, share: float = 0.0, detail: str = "") -> None:
        """Report that a share of a step is done; `detail` names the current work more closely."""
        if self._progress is None:
            return
        names = list(self._steps)
        before = sum(self._steps[name] for name in names[: names.index(step)])
        self._progress(f"{step}, {detail}" if detail else step, before + share * self._steps[step], self._all)

    def within(self, step: str, detail: str = "") -> Share:
        """Return a Share for one step."""
        return lambda share: self(step, share, detail)

    def counted(self, step: str, word: str) -> Callable[[int, int], None]:
        """Return a function that reports `done` of `count` things, called `word`."""
        return lambda done, count: self(step, done / count, f"{word} {done + 1} of {count}")


class Clock:
    """Estimate of the time that a job still takes: by its expected time at first, by its own pace later."""

    def __init__(self, expected: Expected | None) -> None:
        self.began, self.expected = time.monotonic(), expected

    def left(self, share: float) -> str:
        """Return the remaining time in words; "" without an expected time."""
        if self.expected is None:
            return ""
        gone = time.monotonic() - self.began
        settled = share > _SETTLED and gone > 1
        seconds = gone * (1 - share) / share if settled else self.expected.seconds * (1 - share)
        return f"{about(seconds)} left"


def about(seconds: float) -> str:
    """Return a time (s) as text, roughly."""
    if seconds < 90:
        step = 1 if seconds < 10 else 5
        return f"about {max(step * round(seconds / step), 1)} s"
    return f"about {round(seconds / 60)} min" if seconds < 5400 else f"about {seconds / 3600:.1f} h"


def about_memory(size: float) -> str:
    """Return a size in bytes as text, roughly."""
    return f"{size / 1e9:.1f} GB" if size >= 0.95e9 else f"{100 * math.ceil(size / 1e8)} MB"


PACKAGE = Path(__file__).parents[1]
"""Folder of the package's code."""


def templates() -> Path:
    """Return the folder of starters and of the templates of reports: inside the package in a wheel, beside it in a checkout."""
    installed = PACKAGE / "templates"
    return installed if installed.is_dir() else PACKAGE.parent / "templates"


Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Return a function as machine code that lets other threads run and rounds as written; cached on disk if possible."""
    import numba

    options = {"nogil": True, "error_model": "numpy"}
    try:
        made: Function = numba.njit(cache=True, **options)(function)
    except RuntimeError:  # no folder for it
        made = numba.njit(**options)(function)
    else:
        _forget_unreadable(made)
    return made


def _forget_unreadable(made: Any) -> None:
    """Empty the cache of a function if it names what is no more, such as a class of an older version of the package."""
    cache = made._cache
    try:
        cache._cache_file._load_index()
    except Exception:  # an index is a pickle: it may raise anything
        with suppress(OSError):
            cache.flush()


def inlined(function: Function) -> Function:
    """Return a function as machine code that is inlined into its callers.

    Passing an array to a function takes longer than using it.
    """
    import numba

    made: Function = numba.njit(nogil=True, error_model="numpy", inline="always")(function)
    return made
