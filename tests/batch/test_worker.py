"""A worker is a process of its own: what kills it costs one call, it keeps what it imported, and it never outlives us."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import psutil
import pytest
from support import jobs
from support.processes import PATIENCE, wait_for_end, wait_until

from gearcad import GeometryError, SpecError
from gearcad.batch.pool import WorkerLostError, close_workers, isolated, open_pool

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")


OTHERS: set[psutil.Process] = set()
"""What tests of other modules have started and still use, such as a browser."""


def started() -> list[psutil.Process]:
    """The processes below this one, but for `OTHERS` and what is below them."""
    found = [each for each in psutil.Process().children() if each not in OTHERS]
    for each in tuple(found):
        with suppress(psutil.NoSuchProcess):
            found += each.children(recursive=True)
    return found


def no_worker_is_left() -> None:
    close_workers()
    assert wait_for_end(started(), PATIENCE) == []


@pytest.fixture(autouse=True, scope="module")
def _they_end() -> Iterator[None]:
    close_workers()
    OTHERS.update(psutil.Process().children())
    yield
    no_worker_is_left()
    OTHERS.clear()


@pytest.fixture
def none_yet() -> Iterator[None]:
    no_worker_is_left()
    yield
    no_worker_is_left()


def call(function: Any, argument: Any = None, time_limit: float = PATIENCE) -> Any:
    return isolated(function, argument, time_limit)


def test_worker_is_another_process_that_lives_on() -> None:
    first = call(jobs.own_process)
    assert first != os.getpid()
    assert call(jobs.own_process) == first


def test_each_thread_has_a_worker_of_its_own() -> None:
    found: set[int] = {call(jobs.own_process)}
    thread = threading.Thread(target=lambda: found.add(call(jobs.own_process)))
    thread.start()
    thread.join(PATIENCE)
    assert len(found) == 2


def test_large_calls_and_answers_go_both_ways() -> None:
    content = os.urandom(3_000_000)
    assert call(jobs.echo, content) == content
    assert call(jobs.repeat, b"ab") == b"ab" * 3_000_000


def test_libraries_run_on_one_thread() -> None:
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        assert call(os.getenv, variable) == "1"


DEATHS = {
    "exit": "ended its process (exit status 3)",
    "segfault": "killed its process (SIGSEGV)",
    "abort": "killed its process (SIGABRT)",
    "kill": "killed its process (SIGKILL, perhaps for want of memory)",
}


@pytest.mark.parametrize("how", DEATHS)
def test_death_is_told_in_words_and_the_next_call_has_a_new_process(how: str) -> None:
    before = call(jobs.own_process)
    with pytest.raises(WorkerLostError) as caught:
        call(jobs.die, how)
    assert str(caught.value) == DEATHS[how]
    assert call(jobs.own_process) != before


@pytest.mark.parametrize("endless", [jobs.wait, jobs.work, jobs.hold_the_interpreter])
def test_time_limit_ends_a_call_whatever_it_does(endless: Any) -> None:
    call(jobs.echo)  # the process is there, and the time is that of the call alone
    began = time.monotonic()
    with pytest.raises(WorkerLostError, match=r"^was stopped at its time limit of 0\.3 s$"):
        call(endless, 60, time_limit=0.3)
    assert 0.3 <= time.monotonic() - began < 30
    assert call(jobs.echo, 1) == 1


def test_call_within_its_limit_is_not_stopped_later() -> None:
    call(jobs.echo)
    first = call(jobs.own_process, time_limit=1.0)
    call(jobs.wait, 1.2)
    assert call(jobs.own_process) == first


@pytest.mark.parametrize(
    "error", [GeometryError("teeth", 2, "must be more"), SpecError("two\nlines", "gear.teeth"), KeyError(3)]
)
def test_errors_arrive_as_they_were_raised(error: Exception) -> None:
    before = call(jobs.own_process)
    with pytest.raises(type(error)) as caught:
        call(jobs.raise_it, error)
    assert (caught.value.args, vars(caught.value)) == (error.args, vars(error))
    assert call(jobs.own_process) == before


def test_want_of_memory_is_an_error_of_the_call_only() -> None:
    before = call(jobs.own_process)
    with pytest.raises(MemoryError, match="no memory for 3 faces"):
        call(jobs.die, "memory")
    assert call(jobs.own_process) == before


def test_error_that_cannot_be_sent_arrives_as_its_text() -> None:
    before = call(jobs.own_process)
    with pytest.raises(RuntimeError, match=r"^Unsendable: 1 and 2$"):
        call(jobs.raise_unsendable)
    assert call(jobs.own_process) == before


def test_answer_that_cannot_be_sent_is_an_error() -> None:
    with pytest.raises((AttributeError, RuntimeError, TypeError), match="unsendable_answer"):
        call(jobs.unsendable_answer)
    assert call(jobs.echo, "next") == "next"


def test_answer_that_cannot_be_read_is_not_mixed_with_the_next() -> None:
    with pytest.raises(ImportError, match=r"^no$"):
        call(jobs.unreadable)
    assert [call(jobs.echo, number) for number in range(3)] == [0, 1, 2]


def test_call_that_cannot_be_read_is_not_mixed_with_the_next() -> None:
    """As when a worker has another version of gearcad."""
    with pytest.raises(ImportError, match=r"^no$"):
        call(jobs.echo, jobs.unreadable())
    assert [call(jobs.echo, number) for number in range(3)] == [0, 1, 2]


def test_what_a_library_prints_disturbs_neither_the_answer_nor_stdout(capfd: pytest.CaptureFixture[str]) -> None:
    assert call(jobs.print_everywhere) == "said"
    assert call(jobs.echo, "next") == "next"
    assert capfd.readouterr().out == ""


def test_worker_leaves_ctrl_c_to_its_parent() -> None:
    assert call(jobs.interrupt) == "still here"


def test_death_between_calls_costs_nothing() -> None:
    process = call(jobs.own_process)
    os.kill(process, signal.SIGKILL)
    os.waitid(os.P_PID, process, os.WEXITED | os.WNOWAIT)
    assert call(jobs.echo, "next") == "next"


# ---------------------------------------------------------------------- the end of a run


@pytest.mark.usefixtures("none_yet")
def test_close_ends_a_call_in_progress() -> None:
    ended: list[Exception] = []

    def endless() -> None:
        try:
            call(jobs.wait, 600, time_limit=600)
        except WorkerLostError as error:
            ended.append(error)

    thread = threading.Thread(target=endless)
    thread.start()
    wait_until(started, "the worker")
    close_workers()
    thread.join(PATIENCE)
    assert len(ended) == 1 and not thread.is_alive()


@pytest.mark.usefixtures("none_yet")
@pytest.mark.parametrize(
    "seconds", [0.001, 0.1, 0.3, 0.6, *(pytest.param(each, marks=pytest.mark.long) for each in (0.02, 0.2, 0.4))]
)
def test_ctrl_c_leaves_no_process_and_no_thread_whenever_it_comes(seconds: float) -> None:
    """While workers start, while they work, while calls are waiting."""
    before = threading.active_count()

    def interrupt(_signal: int, _frame: object) -> None:
        raise KeyboardInterrupt

    former = signal.signal(signal.SIGALRM, interrupt)
    try:
        with pytest.raises(KeyboardInterrupt), open_pool(jobs=3, cluster=None) as pool:
            signal.setitimer(signal.ITIMER_REAL, seconds)
            list(pool.run(jobs.wait, [0.0] * 4 + [600.0] * 9, 600.0))
    finally:
        signal.signal(signal.SIGALRM, former)
    assert wait_for_end(started(), PATIENCE) == []
    wait_until(lambda: threading.active_count() <= before, "the threads")


_PARENT = """
import sys
from gearcad.batch.pool import isolated
from support import jobs
isolated(jobs.echo, 1, 60)
print("ready", flush=True)
isolated(getattr(jobs, sys.argv[1]), 600, 600)
"""


@pytest.mark.usefixtures("none_yet")
@pytest.mark.parametrize("busy_with", ["wait", pytest.param("work", marks=pytest.mark.long), "hold_the_interpreter"])
def test_death_of_the_parent_ends_the_worker_in_the_middle_of_its_work(busy_with: str) -> None:
    if busy_with == "hold_the_interpreter" and sys.platform != "linux":
        pytest.skip("only Linux tells a process of its parent's death")
    path = os.pathsep.join(filter(None, sys.path))
    command = [sys.executable, "-c", _PARENT, busy_with]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=os.environ | {"PYTHONPATH": path}) as parent:
        assert parent.stdout is not None and parent.stdout.readline() == "ready\n"
        time.sleep(0.2)  # the worker has got its call
        workers = psutil.Process(parent.pid).children()
        parent.kill()
        parent.wait()
    left = wait_for_end(workers, 5.0)
    for worker in left:
        worker.kill()
    assert len(workers) == 1 and left == []
