"""Puts `tests/support` within reach of every test, as `support`, and makes random tests repeatable."""

import gc
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings
from support.pictures import leave_out_pictures
from support.published import published

__all__ = ["published"]  # a fixture of all tests

# Several test processes share the cores, and numpy is not imported yet: one thread each, or they fight.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# Tests start hundreds of Python processes: what one compiles is kept for all, whatever is set outside.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# Files that hold a date are compared byte by byte, over midnight too.
os.environ["SOURCE_DATE_EPOCH"] = "1700000000"

settings.register_profile(
    "repeatable",
    derandomize=True,
    deadline=None,  # examples differ in size, and the machine may be busy
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("repeatable")


def pytest_collectstart() -> None:
    """What is collected lives until the end: the garbage collector need not look at it while that grows."""
    gc.disable()


def pytest_collection_finish() -> None:
    """Nor each time after it."""
    gc.enable()
    gc.freeze()


@pytest.fixture(scope="module")
def kept_workers() -> Iterator[None]:
    """Runs of tables share their workers, one for each job: these need not start anew for tests of what becomes of rows."""
    from gearcad.batch import pool

    made: dict[pool._Worker, object] = {}
    idle: list[pool._Worker] = []
    keeper = ThreadPoolExecutor(1)  # a worker dies with the thread that started it, and those of a run end with that

    def start() -> pool._Worker:
        new = pool._Worker()
        made[new] = new._running()
        return new

    def own_worker() -> None:
        try:
            pool._here.worker = idle.pop()
        except IndexError:
            pool._here.worker = keeper.submit(start).result()

    def close_workers() -> None:
        """Those that lost their process have one of a thread that ends."""
        for each in [each for each, process in made.items() if each._process is not process]:
            del made[each]
            each.close()
        idle[:] = made

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pool, "own_worker", own_worker)
        patch.setattr(pool, "close_workers", close_workers)
        yield
    for each in made:
        each.close()
    keeper.shutdown()


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder, which is the current one."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reports with empty pictures."""
    leave_out_pictures(monkeypatch)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system with room for a few rows only."""
    place = tmp_path / "disk"
    place.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=1m", "gearcad-test", str(place)]
    if shutil.which("mount") is None or subprocess.run(command, capture_output=True).returncode != 0:
        pytest.skip("needs the right to mount a small file system")
    yield place
    subprocess.run(["umount", str(place)], check=True)
