"""Worker processes of a batch: threads of this machine, or of a Dask cluster, that each own a process.

`isolated` is what every thread of a pool runs, on this machine or on a Dask worker. Calls and answers are pickles, each after
its length.
"""

from __future__ import annotations

import gc
import logging
import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from itertools import count
from types import FrameType
from typing import IO, Any, Generic, TypeVar

from gearcad.core.child_process import become_child, end_with_input, ending_words, pipes_of, start_child, time_limit_words
from gearcad.core.errors import GearcadError, ParameterError, require_whole
from gearcad.core.runtime import cores
from gearcad.version import __version__


@contextmanager
def remembered_interrupt() -> Iterator[Callable[[], None]]:
    """Yield a function that raises KeyboardInterrupt if Ctrl-C was pressed since, even if the first KeyboardInterrupt was lost.

    Outside the main thread, and if another handler for Ctrl-C is installed, the function does nothing.
    """
    if (
        threading.current_thread() is not threading.main_thread()
        or signal.getsignal(signal.SIGINT) is not signal.default_int_handler
    ):
        yield lambda: None
        return
    pressed = threading.Event()
    told = sys.unraisablehook

    def remember(number: int, frame: FrameType | None) -> None:
        pressed.set()
        signal.default_int_handler(number, frame)

    def tell(unraisable: Any) -> None:
        if not (pressed.is_set() and unraisable.exc_type is KeyboardInterrupt):
            told(unraisable)

    def look() -> None:
        if pressed.is_set():
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, remember)
    sys.unraisablehook = tell
    try:
        yield look
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        sys.unraisablehook = told


Argument = TypeVar("Argument")
Result = TypeVar("Result")

_LENGTH_BYTES = 8

_here = threading.local()
_open: set[_Worker] = set()


class WorkerLostError(GearcadError, RuntimeError):
    """The process that did the work is gone, and why."""


def isolated(function: Callable[[Argument], Result], argument: Argument, time_limit: float) -> Result:
    """Return `function(argument)` as computed in the child process of this thread, which lives on and keeps its imports.

    Raises WorkerLostError if the child dies or needs more than `time_limit` (s) - the next call has a new one - and whatever
    `function` raises.
    """
    worker: _Worker | None = getattr(_here, "worker", None)
    if worker is None or (worker.closed and not worker.only):
        worker = _here.worker = _Worker()
    answer: Result = worker.call(function, argument, time_limit)
    return answer


def own_worker() -> None:
    """Give this thread its only child: once `close_workers` has ended that, `isolated` raises WorkerLostError in this thread.

    A thread that takes calls only after this cannot begin one that `close_workers` does not see.
    """
    _here.worker = _Worker(only=True)


def close_workers() -> None:
    """End the children of all threads of this process, what they are doing included."""
    for worker in list(_open):
        worker.close()


class _Worker:
    """One child process at a time, and what is said to it through its pipes."""

    def __init__(self, *, only: bool = False) -> None:
        self.closed, self.only = False, only
        self._process: subprocess.Popen[bytes] | None = None
        self._starting = threading.Lock()
        _open.add(self)

    def call(self, function: Callable[[Any], Any], argument: Any, time_limit: float) -> Any:
        """Send the call, wait for the answer."""
        message = pickle.dumps((function, argument))
        process = self._running()
        expired = threading.Event()
        watch = threading.Timer(time_limit, _end, (process, expired))
        watch.daemon = True
        watch.start()
        try:
            requests, answers = pipes_of(process)
            _send(requests, message)
            answer = _receive(answers)
        except (EOFError, OSError):
            process.kill()
            status = process.wait()
            raise WorkerLostError(time_limit_words(time_limit) if expired.is_set() else ending_words(status)) from None
        finally:
            watch.cancel()
        succeeded, value = pickle.loads(answer)
        if not succeeded:
            raise value
        return value

    def close(self) -> None:
        """Kill the child; an unfinished call ends with WorkerLostError."""
        with self._starting:  # or a child that is just being started would escape
            self.closed = True
        _open.discard(self)
        if self._process is not None:
            self._process.kill()
            self._process.wait()

    def _running(self) -> subprocess.Popen[bytes]:
        with self._starting:
            if self.closed:
                raise WorkerLostError("the run was ended")
            if self._process is None or self._process.poll() is not None:
                self._process = start_child(__name__)
            return self._process


def _send(pipe: IO[bytes], message: bytes) -> None:
    pipe.write(len(message).to_bytes(_LENGTH_BYTES, "little") + message)
    pipe.flush()


def _receive(pipe: IO[bytes]) -> bytes:
    """Return a whole message, even an unreadable one: the next begins where it ends. Raises EOFError, OSError."""
    length = int.from_bytes(_read(pipe, _LENGTH_BYTES), "little")
    return _read(pipe, length)


def _read(pipe: IO[bytes], count: int) -> bytes:
    content = pipe.read(count)
    if len(content) < count:
        raise EOFError
    return content


def _end(process: subprocess.Popen[bytes], expired: threading.Event) -> None:
    expired.set()
    process.kill()


def serve() -> None:
    """Answer calls from stdin in the child process until it closes, which also ends work in progress."""
    answers = os.fdopen(become_child(), "wb")
    calls: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    end_with_input(partial(_listen, calls), 0)
    for number in count():
        call = calls.get()
        try:
            function, argument = pickle.loads(call)
            answer = pickle.dumps((True, function(argument)))
        except Exception as error:
            answer = pickle.dumps((False, _sendable(error)))
        with suppress(BrokenPipeError):
            _send(answers, answer)
        if number == 0:  # libraries are loaded now; looking through their 400,000 objects again and again is 0.2 s a row
            gc.collect()
            gc.freeze()


def _listen(calls: queue.SimpleQueue[bytes]) -> None:
    while True:
        calls.put(_receive(sys.stdin.buffer))


def _sendable(error: Exception) -> Exception:
    """Return the error, or its text if it cannot be pickled for the parent."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


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
    """Pool of workers: an executor, the number of calls at a time, a function that ends all calls, and whether it has started.

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
        """Call `function`, which must be importable, with each argument in a worker process; yield outcomes as they arrive.

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


@contextmanager
def open_pool(jobs: int | None, cluster: str | None) -> Iterator[Pool]:
    """A pool of `jobs` processes (None: the cores) here, or the threads of the Dask cluster at `cluster`.

    `cluster` is an address such as tcp://host:8786, or "local" for a LocalCluster of `jobs`; its workers must have this
    version of gearcad. Raises ParameterError for a cluster that cannot be used.
    """
    if jobs is not None:
        require_whole("jobs", jobs, at_least=1, at_most=_MOST_JOBS)
    count = jobs or cores()
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
        with ThreadPoolExecutor(1) as own:  # a notebook has an event loop that runs in its thread already
            own.submit(asyncio.run, _greet(address)).result()
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
    """Yield a cluster on this machine without a dashboard or other pages behind the ports that Dask opens."""
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
    """Keep Dask from logging to stderr with tracebacks; faults that a user can mend become errors of ours."""
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
