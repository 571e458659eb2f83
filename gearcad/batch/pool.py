"""Where rows are made: threads of this machine that each own a worker process, or the threads of a Dask cluster that do."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, Generic, TypeVar

from gearcad import __version__
from gearcad.batch.worker import close_workers, isolated
from gearcad.errors import ParameterError, require_whole

__all__ = ["Pool", "available_cores", "open_pool"]

Argument = TypeVar("Argument")
Result = TypeVar("Result")

LOCAL_CLUSTER = "local"
_AHEAD = 3
"""Calls in the pool per thread of it: enough that none waits, few enough that memory does not grow with the table."""

_MOST_JOBS = 1024
_CONNECT_SECONDS = 20


@dataclass(frozen=True)
class Outcome(Generic[Argument, Result]):
    """A call that ended: its argument, and what came of it."""

    argument: Argument
    future: Future[Result]


@dataclass(frozen=True)
class Pool:
    """An executor, and how many calls it does at a time."""

    executor: Executor
    threads: int
    end_workers: Callable[[], None]

    def run(
        self, function: Callable[[Argument], Result], arguments: Iterable[Argument], time_limit: float
    ) -> Iterator[Outcome[Argument, Result]]:
        """Call `function`, which must be importable, with each argument in a worker process; outcomes as they come."""
        pending: dict[Future[Result], Argument] = {}
        for argument in arguments:
            pending[self.executor.submit(isolated, function, argument, time_limit)] = argument
            if len(pending) >= _AHEAD * self.threads:
                yield from _ended(pending)
        while pending:
            yield from _ended(pending)

    def stop(self) -> None:
        """End everything that is waiting or running."""
        self.executor.shutdown(wait=False, cancel_futures=True)
        self.end_workers()


def _ended(pending: dict[Future[Result], Argument]) -> Iterator[Outcome[Argument, Result]]:
    """Wait for one call at least, and take all that have ended from `pending`."""
    for future in wait(pending, return_when=FIRST_COMPLETED).done:
        yield Outcome(pending.pop(future), future)


def available_cores() -> int:
    """Cores this process may use, fewer than the machine's in a container."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def open_pool(jobs: int | None, cluster: str | None) -> Iterator[Pool]:
    """A pool of `jobs` processes (None: the cores) here, or the threads of the Dask cluster at `cluster`.

    `cluster` is an address such as tcp://host:8786, or "local" for a LocalCluster of `jobs`; its workers must have this
    version of gearcad. Raises ParameterError for a cluster that cannot be used.
    """
    if jobs is not None:
        require_whole("jobs", jobs, at_least=1, at_most=_MOST_JOBS)
    count = jobs or available_cores()
    if cluster is not None:
        with _dask_pool(cluster, count) as pool:
            yield pool
        return
    pool = Pool(ThreadPoolExecutor(count, thread_name_prefix="gearcad"), count, close_workers)
    try:
        yield pool
    finally:
        pool.stop()


@contextmanager
def _dask_pool(address: str, jobs: int) -> Iterator[Pool]:
    try:
        from distributed import Client, LocalCluster
    except ImportError as error:
        raise ParameterError("cluster", address, 'needs Dask: pip install "gearcad[cluster]"') from error
    local = address == LOCAL_CLUSTER
    try:
        # Without a limit of Dask's: the memory is that of the children, which it does not see.
        where: Any = (
            LocalCluster(n_workers=jobs, threads_per_worker=1, memory_limit=None, dashboard_address=None) if local else address
        )
        client = Client(where, timeout=_CONNECT_SECONDS)
    except (OSError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise ParameterError("cluster", address, f"cannot be reached ({reason}); give tcp://HOST:PORT or local") from error
    try:
        _require_our_version(client, address)
        threads = sum(client.nthreads().values())
        yield Pool(client.get_executor(pure=False), threads, partial(client.run, close_workers))
    finally:
        with suppress(Exception):  # the cluster may be what ended the run
            client.run(close_workers)
        client.close()
        if local:
            where.close()


def _require_our_version(client: Any, address: str) -> None:
    """Raise ParameterError unless every worker has the gearcad that this is."""
    answers = client.run(_version, on_error="return")
    if not answers:
        raise ParameterError("cluster", address, "has no workers")
    for worker, answer in answers.items():
        if isinstance(answer, BaseException):
            raise ParameterError("cluster", address, f"its worker {worker} cannot run gearcad ({answer})")
        if answer != __version__:
            raise ParameterError("cluster", address, f"its worker {worker} has gearcad {answer}, this is {__version__}")


def _version() -> str:
    return __version__
