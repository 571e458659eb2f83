"""Puts `tests/support` within reach of every test, as `support`, and makes random tests repeatable."""

import gc
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

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


def pytest_collection_finish() -> None:
    """What is collected lives until the end: the garbage collector need not look at it each time."""
    gc.freeze()


@pytest.fixture(scope="module")
def one_worker() -> Iterator[None]:
    """Runs of a table with `jobs=1` share one worker: it need not start anew for tests of what becomes of rows."""
    from gearcad.batch import pool, worker

    kept = worker._Worker()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pool, "own_worker", lambda: setattr(worker._here, "worker", kept))
        patch.setattr(pool, "close_workers", lambda: None)
        yield
    kept.close()


_PICTURED = (
    *("check.figures", "check.sections", "check.views", "stiffness.report", "strength.report", "planetary.sections"),
    *("dynamics.displacements", "dynamics.report", "dynamics.side_by_side"),
)


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reports with empty pictures: drawing takes longer than all the rest of a command, and tests of reports have it."""
    for room in _PICTURED:
        for name in ("figure_address", "picture_address"):
            monkeypatch.setattr(f"gearcad.report.{room}.{name}", lambda *_drawing: "data:,", raising=False)


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
