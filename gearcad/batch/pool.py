"""Where rows are made: threads of this machine that each own a worker process, or the threads of a Dask cluster that do."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from gearcad.batch.interrupt import remembered_interrupt
from gearcad.batch.worker import close_workers, isolated, own_worker
from gearcad.errors import GearcadError, ParameterError, require_whole
from gearcad.version import __version__

__all__ = ["ClusterLostError", "Pool", "available_cores", "open_pool"]

Argument = TypeVar("Argument")
Result = TypeVar("Result")

LOCAL_CLUSTER = "local"
_AHEAD = 3
"""Calls in the pool per thread of it: enough that none waits, few enough that memory does not grow with the table."""

_MOST_JOBS = 1024
_CONNECT_SECONDS = 20
_LOOK_SECONDS = 2.0


class ClusterLostError(GearcadError, RuntimeError):
    """The Dask cluster went away during the run."""


@dataclass(frozen=True)
class Outcome(Generic[Argument, Result]):
    """A call that ended: its argument, and what came of it."""

    argument: Argument
    future: Future[Result]


@dataclass(frozen=True)
class Pool:
    """An executor, how many calls it does at a time, what ends all that is waiting or running, and whether it is there yet.

    `look` raises KeyboardInterrupt where one was lost.
    """

    executor: Executor
    threads: int
    stop: Callable[[], None]
    is_there: Callable[[], bool] = lambda: True
    look: Callable[[], None] = lambda: None

    def run(
        self, function: Callable[[Argument], Result], arguments: Iterable[Argument], time_limit: float
    ) -> Iterator[Outcome[Argument, Result]]:
        """Call `function`, which must be importable, with each argument in a worker process; outcomes as they come.

        Raises ClusterLostError if nobody is left who could do it.
        """
        pending: dict[Future[Result], Argument] = {}
        for argument in arguments:
            pending[self.executor.submit(isolated, function, argument, time_limit)] = argument
            if len(pending) >= _AHEAD * self.threads:
                yield from self._ended(pending)
        while pending:
            yield from self._ended(pending)

    def _ended(self, pending: dict[Future[Result], Argument]) -> Iterator[Outcome[Argument, Result]]:
        """Wait for one call at least, and take all that have ended from `pending`."""
        done: set[Future[Result]] = set()
        while not done and self.is_there():
            done = wait(pending, _LOOK_SECONDS, FIRST_COMPLETED).done
            self.look()
        if not done or any(future.cancelled() for future in done):
            raise ClusterLostError("the cluster is gone: its scheduler does not answer any more")
        for future in done:
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
        with remembered_interrupt() as look, _dask_pool(cluster, count, look) as pool:
            yield pool
        return
    executor = ThreadPoolExecutor(count, thread_name_prefix="gearcad", initializer=own_worker)

    def stop() -> None:
        executor.shutdown(wait=False, cancel_futures=True)
        close_workers()

    try:
        with remembered_interrupt() as look:
            yield Pool(executor, count, stop, look=look)
    finally:
        stop()


@contextmanager
def _dask_pool(address: str, jobs: int, look: Callable[[], None]) -> Iterator[Pool]:
    with _client(address, jobs) as client, _quiet_log():
        _require_our_version(client, address)
        executor = client.get_executor(pure=False)

        def stop() -> None:
            with suppress(Exception):  # the cluster may be what ended the run
                executor.shutdown(wait=False)
                client.run(close_workers)

        try:
            yield Pool(
                executor, sum(client.nthreads().values()), stop, lambda: client.status not in ("closing", "closed"), look
            )
        finally:
            stop()


@contextmanager
def _client(address: str, jobs: int) -> Iterator[Any]:
    """A client of the Dask cluster, which "local" starts and ends."""
    import asyncio

    try:
        from distributed import Client
    except ImportError as error:
        raise ParameterError("cluster", address, 'needs Dask: pip install "gearcad[cluster]"') from error
    if address == LOCAL_CLUSTER:
        with _local_cluster(jobs) as cluster, Client(cluster) as client:
            yield client
        return
    try:
        asyncio.run(_greet(address))
        client = Client(address, timeout=_CONNECT_SECONDS)
    except (OSError, ValueError) as error:
        reason = " ".join(str(error).split()) or f"no answer in {_CONNECT_SECONDS:g} s"
        raise ParameterError("cluster", address, f"cannot be reached ({reason}); give tcp://HOST:PORT or local") from error
    except Exception as error:  # whatever Dask makes of the answer of, say, a web server
        permitted = "answers, but not as a Dask scheduler does; give its tcp://HOST:PORT or local"
        raise ParameterError("cluster", address, permitted) from error
    with client:
        yield client


@contextmanager
def _local_cluster(jobs: int) -> Iterator[Any]:
    """A cluster on this machine that nobody can look into: no dashboard, and no pages behind the ports that Dask opens."""
    import dask
    from distributed import LocalCluster

    unseen = {"dashboard": False, "dashboard_address": "127.0.0.1:0"}  # any port: of None it makes 8787
    with (
        dask.config.set({"distributed.scheduler.http.routes": [], "distributed.worker.http.routes": []}),
        # Without a limit of Dask's: the memory is that of the children, which it does not see.
        LocalCluster(n_workers=jobs, threads_per_worker=1, memory_limit=None, scheduler_kwargs=unseen) as cluster,
    ):
        yield cluster


@contextmanager
def _quiet_log() -> Iterator[None]:
    """Dask logs to stderr, with tracebacks; what a user can do something about becomes an error of ours."""
    loggers = [logging.getLogger(name) for name in ("distributed", "distributed.client", "tornado.application", "asyncio")]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


async def _greet(address: str) -> None:
    """Shake hands once: Dask's client would wait for ever for what is no scheduler."""
    import asyncio

    from distributed.comm import connect
    from distributed.security import Security

    connection = connect(address, timeout=_CONNECT_SECONDS, **Security().get_connection_args("client"))
    await (await asyncio.wait_for(connection, _CONNECT_SECONDS)).close()


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
