"""Guarded work leaves nothing half made, jobs work on one thread, and compiled code of an older version does no harm."""

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import psutil
import pytest
from support.processes import PATIENCE, hear_interrupts, wait_for_end, wait_until
from threadpoolctl import ThreadpoolController

from gearcad.core.runtime import one_thread

WORK = """
import sys
from pathlib import Path
from gearcad.core.guard import guarded
from gearcad.core.output import staged_files
from support import jobs

def work():
    {first}
    with staged_files(Path("out/deep")) as staging:
        (staging / "half").write_text("made")
        {inside}

guarded(work)
sys.exit(3)
"""
KERNEL = "jobs.hold_the_interpreter(600)"
"""Holds the interpreter: no handler in Python has a say."""


def start(folder: Path, inside: str, halves: int = 1, first: str = "pass") -> subprocess.Popen[str]:
    """Start minded work in `folder`, as the leader of a group as a terminal does, and wait for so many half files.

    The code `first` runs before the half file is there, `inside` after it.
    """
    process = subprocess.Popen(
        [sys.executable, "-c", WORK.format(inside=inside, first=first)],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=hear_interrupts,
    )
    wait_until(lambda: len(list(folder.glob("out/deep/.unfinished-*/half"))) == halves, "half a file")
    return process


def to_group(process: subprocess.Popen[str], number: signal.Signals) -> None:
    os.killpg(process.pid, number)


def to_keeper(process: subprocess.Popen[str], number: signal.Signals) -> None:
    os.kill(process.pid, number)


def to_worker(process: subprocess.Popen[str], number: signal.Signals) -> None:
    psutil.Process(process.pid).children()[0].send_signal(number)


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("send", [to_group, to_keeper])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_ends_a_kernel_call_at_once_and_leaves_nothing(
    tmp_path: Path, send: Callable[[subprocess.Popen[str], signal.Signals], None], number: signal.Signals
) -> None:
    with start(tmp_path, KERNEL) as process:
        (worker,) = psutil.Process(process.pid).children()
        send(process, number)
        output, errors = process.communicate(timeout=PATIENCE)
    assert (process.returncode, output, errors) == (128 + number, "", "Aborted!\n")
    assert list(tmp_path.iterdir()) == []
    assert wait_for_end([worker], 1) == []


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_worker_to_whom_nobody_listens_goes_without_a_word(tmp_path: Path) -> None:
    """As behind `| head`, where a library has taken SIGPIPE from Python."""
    default = "import signal; signal.signal(signal.SIGPIPE, signal.SIG_DFL)"
    with start(tmp_path, KERNEL, first=default) as process:
        to_worker(process, signal.SIGPIPE)
        assert (process.communicate(timeout=PATIENCE), process.returncode) == (("", ""), 141)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize(
    ("number", "status", "said"),
    [
        (signal.SIGTERM, 143, "Aborted!\n"),  # of the process that is seen to be busy
        (signal.SIGSEGV, 1, "Error: something in the work killed its process (SIGSEGV); nothing was written\n"),
        (
            signal.SIGKILL,
            1,
            "Error: something in the work killed its process (SIGKILL, perhaps for want of memory); nothing was written\n",
        ),
    ],
)
def test_worker_that_dies_is_buried_and_said_to_be_dead(tmp_path: Path, number: signal.Signals, status: int, said: str) -> None:
    with start(tmp_path, KERNEL) as process:
        to_worker(process, number)
        output, errors = process.communicate(timeout=PATIENCE)
    assert (process.returncode, output, errors) == (status, "", said)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_worker_dies_with_its_keeper_and_the_next_one_clears_up(tmp_path: Path) -> None:
    """Nobody is left to bury it, so the folder stays until somebody writes there; one that is in use stays longer."""
    if sys.platform != "linux":
        pytest.skip("Linux only")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "kept").write_text("")
    with start(tmp_path, KERNEL) as process, start(tmp_path, KERNEL, 2) as other:
        (worker,) = psutil.Process(process.pid).children()
        process.kill()
        assert wait_for_end([worker], 5) == []
        assert len(list(tmp_path.glob("out/deep/.unfinished-*"))) == 2
        (tmp_path / "out" / "deep" / ".unfinished-link").symlink_to(tmp_path / "elsewhere")
        with start_and_end(tmp_path) as third:
            assert third.wait(PATIENCE) == 7
        left = sorted(path.name for path in (tmp_path / "out" / "deep").iterdir())
        assert len(left) == 3 and left[1:] == [".unfinished-link", "half"]
        assert (tmp_path / "elsewhere" / "kept").is_file()
        other.send_signal(signal.SIGINT)
        assert other.wait(PATIENCE) == 130
    assert sorted(path.name for path in (tmp_path / "out" / "deep").iterdir()) == [".unfinished-link", "half"]


def start_and_end(folder: Path) -> subprocess.Popen[str]:
    """Minded work that has its way, and an exit status of its own."""
    ends = WORK.format(inside="pass", first="pass").replace("guarded(work)", "guarded(work); sys.exit(7)")
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    return subprocess.Popen([sys.executable, "-c", ends], cwd=folder, env=environment, text=True)


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_renames_that_belong_together_are_not_divided(tmp_path: Path) -> None:
    """Ctrl-C while files move in: all of them do, then the work ends."""
    slow = "import os, time; from gearcad.core import output; replace = Path.replace; "
    slow += "Path.replace = lambda *to: (replace(*to), time.sleep(0.3)); "
    slow += "[(staging / name).write_text('') for name in 'abc']"
    with start(tmp_path, slow) as process:
        wait_until((tmp_path / "out" / "deep" / "a").exists, "the first file")
        to_group(process, signal.SIGINT)
        process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert sorted(path.name for path in (tmp_path / "out" / "deep").iterdir()) == ["a", "b", "c", "half"]


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_signal_that_the_caller_ignores_is_ignored(tmp_path: Path) -> None:
    """As for a program that a shell has started in the background."""
    command = [sys.executable, "-c", WORK.format(inside="__import__('time').sleep(1)", first="pass")]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen(
        command,
        cwd=tmp_path,
        env=environment,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN),
    ) as process:
        wait_until(lambda: list(tmp_path.glob("out/deep/.unfinished-*/half")), "half a file")
        os.killpg(process.pid, signal.SIGINT)
        assert process.wait(PATIENCE) == 3
    assert (tmp_path / "out" / "deep" / "half").is_file()


LOADED_MEANWHILE = """
from gearcad.core.runtime import one_thread
from threadpoolctl import ThreadpoolController
def threads():
    return sorted(each.num_threads for each in ThreadpoolController().select(user_api="blas").lib_controllers)
import numpy
before = threads()
with one_thread():
    import scipy.linalg
    print(threads() == [1] * len(threads()) and len(threads()) > len(before))
print(set(threads()) == set(before))
"""


def test_libraries_that_are_loaded_meanwhile() -> None:
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "2"}
    said = subprocess.run([sys.executable, "-c", LOADED_MEANWHILE], env=environment, capture_output=True, text=True, check=True)
    assert said.stdout.split() == ["True", "True"]


def test_the_environment_is_as_before(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    before = [each.num_threads for each in ThreadpoolController().lib_controllers]
    with pytest.raises(KeyError), one_thread():
        assert os.environ["OMP_NUM_THREADS"] == os.environ["OPENBLAS_NUM_THREADS"] == "1"
        raise KeyError
    assert os.environ["OPENBLAS_NUM_THREADS"] == "2" and "OMP_NUM_THREADS" not in os.environ
    assert [each.num_threads for each in ThreadpoolController().lib_controllers] == before


COMPILED_KERNEL = "from gearcad.core.runtime import compiled\n\n@compiled\ndef f(x):\n    return x + 1.0\n"


def result(folder: Path) -> str:
    paths = os.environ | {"PYTHONPATH": os.pathsep.join([str(folder), *sys.path]), "NUMBA_CACHE_DIR": str(folder / "kept")}
    command = [sys.executable, "-c", "import kernel; print(kernel.f(2.0))"]
    return subprocess.run(command, cwd=folder, env=paths, capture_output=True, text=True, check=True).stdout


def test_a_cache_that_names_a_class_that_is_gone_is_made_anew(tmp_path: Path) -> None:
    (tmp_path / "kernel.py").write_text(COMPILED_KERNEL)
    assert result(tmp_path) == "3.0\n"
    (index,) = tmp_path.rglob("kept/**/*.nbi")
    version = pickle.load(BytesIO(index.read_bytes()))
    index.write_bytes(pickle.dumps(version) + b"cgearcad.core.runtime\nClassOfBefore\n.")
    assert result(tmp_path) == "3.0\n"
    assert b"ClassOfBefore" not in index.read_bytes()
