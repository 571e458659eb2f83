"""Timings of design tables: rows per second, parallel efficiency, memory of the parent, time outside the solid kernel.

`pytest -m benchmark_suite tests/benchmarks/test_batch_speed.py --benchmark-columns=median,rounds -s`

The figures stand in `extra_info` and are printed; machines are shared and noisy.
"""

import cProfile
import json
import os
import pstats
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from support.batches import variants, write_table

from gearcad.batch.row import Task, make_row, stages
from gearcad.designs.table import open_table
from gearcad.jobs.build import Build
from gearcad.jobs.job import Data, Job

pytestmark = pytest.mark.benchmark_suite

_MEASURED = """
import json, os, re, sys
from pathlib import Path
if os.environ.get("WITHOUT_PYARROW"):
    sys.modules["pyarrow"] = None
from gearcad.cli import main
try:
    main(sys.argv[1:])
finally:
    # Not getrusage: its peak is also that of the process that started this one.
    print(json.dumps({"peak": 1024 * int(re.search(r"VmHWM:\\s*([0-9]+) kB", Path("/proc/self/status").read_text())[1])}))
"""

MOST_GROWTH = {"": 20_000_000, "WITHOUT_PYARROW": 4_000_000}
"""Bytes that the parent may grow from 200 to 5,000 rows. Ours do not; Parquet gathers rows, and notes on its groups of them."""


def run(table: Path, folder: Path, *options: str, condition: str = "") -> tuple[float, int]:
    """Seconds of `gearcad batch` from start to end, and the peak memory (bytes) of the parent, its workers not counted."""
    command = [sys.executable, "-c", _MEASURED, "batch", str(table), "-o", str(folder), "--quiet", *options]
    environment = os.environ | ({condition: "yes"} if condition else {})
    began = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    return time.perf_counter() - began, json.loads(done.stdout.splitlines()[-1])["peak"]


def tell(benchmark: Any, **figures: float) -> None:
    benchmark.extra_info.update(figures)
    print("  ".join(f"{name} {value:.4g}" for name, value in figures.items()))


def test_rows_per_second_and_efficiency(benchmark: Any, tmp_path: Path) -> None:
    """200 pairs as STEP and STL with one process and with two."""
    benchmark.group = "batch: 200 pairs, STEP and STL"
    table = write_table(tmp_path / "table.csv", variants(200))
    seconds: dict[int, float] = {}

    def both() -> None:
        for jobs in (1, 2):
            seconds[jobs], _ = run(table, tmp_path / f"out{jobs}", "-j", str(jobs))

    benchmark.pedantic(both, rounds=1)
    efficiency = seconds[1] / (2 * seconds[2])
    tell(benchmark, rows_per_second_1=200 / seconds[1], rows_per_second_2=200 / seconds[2], efficiency=efficiency)


def test_data_of_many_rows(benchmark: Any, tmp_path: Path) -> None:
    """5,000 rows, and the same again when there is nothing to do."""
    benchmark.group = "batch: 5,000 pairs, data only"
    table = write_table(tmp_path / "table.csv", variants(5000))
    seconds, _ = benchmark.pedantic(lambda: run(table, tmp_path / "out", "--do", "data"), rounds=1)
    again, _ = run(table, tmp_path / "out", "--do", "data")
    tell(benchmark, seconds=seconds, seconds_again=again)


@pytest.mark.parametrize("condition", MOST_GROWTH)
def test_memory_of_the_parent_does_not_grow_with_the_table(benchmark: Any, condition: str, tmp_path: Path) -> None:
    benchmark.group = "batch: memory of the parent"
    lines = variants(5000)
    peaks: dict[int, int] = {}

    def both() -> None:
        for rows in (200, 5000):
            table = write_table(tmp_path / "table.csv", lines[: rows + 1])
            _, peaks[rows] = run(table, tmp_path / "out", "--do", "data", condition=condition)

    benchmark.pedantic(both, rounds=1)
    tell(benchmark, MB_200=peaks[200] / 1e6, MB_5000=peaks[5000] / 1e6)
    assert peaks[5000] - peaks[200] < MOST_GROWTH[condition]


@pytest.mark.parametrize("job", [Data(), Build()], ids=lambda job: job.verb)
def test_time_outside_the_solid_kernel(benchmark: Any, job: Job[Any, Any], tmp_path: Path) -> None:
    """Share of a worker's time by whose code runs: the kernel with CadQuery, numpy, the batch, and all else.

    The profiler tells the time inside the kernel, which it does not slow down; a run without it tells the whole.
    """
    benchmark.group = f"batch: whose time, {job.verb}"
    rows = list(open_table(write_table(tmp_path / "table.csv", variants(21))).rows())
    workspace = tmp_path / "out" / ".work"
    workspace.mkdir(parents=True)
    tasks = [Task(row, stages([job]), tmp_path / "out", workspace, True) for row in rows]
    assert make_row(tasks[0]).error == ""  # imports are done

    def make_all() -> float:
        began = time.perf_counter()
        for task in tasks[1:]:
            make_row(task)
        return time.perf_counter() - began

    seconds = benchmark.pedantic(make_all, rounds=1)
    profile = cProfile.Profile()
    profile.runcall(make_all)
    spent = by_owner(pstats.Stats(profile))
    kernel = spent.pop("kernel")
    outside = {f"{owner}_of_this": value / sum(spent.values()) for owner, value in spent.items()}
    tell(benchmark, seconds_per_row=seconds / 20, outside_the_kernel=1.0 - kernel / seconds, **outside)


def by_owner(stats: pstats.Stats) -> dict[str, float]:
    """Seconds inside functions, by whose they are."""
    spent = {"kernel": 0.0, "gearcad": 0.0, "batch": 0.0, "numpy": 0.0, "others": 0.0}
    for (file, _, function), (_, _, own, _, _) in stats.stats.items():  # type: ignore[attr-defined]
        spent[_owner(file, function)] += own
    return spent


def _owner(file: str, function: str) -> str:
    if "OCP" in function or "/cadquery/" in file:
        return "kernel"
    if "/gearcad/batch/" in file:
        return "batch"
    if "/gearcad/" in file:
        return "gearcad"
    return "numpy" if "numpy" in file or "numpy" in function else "others"
