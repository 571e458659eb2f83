"""Timings of design tables: rows per second, parallel efficiency, memory of the parent, time outside the solid kernel.

`pytest -m benchmark_suite tests/benchmarks/test_batch_speed.py --benchmark-columns=median,rounds -s`

The figures stand in `extra_info` and are printed; machines are shared and noisy.
"""

from __future__ import annotations

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
from support.batches import write_table
from support.variants import variants

from gearcad.batch import Step, Wanted
from gearcad.batch.row import Task, make_row
from gearcad.spec.table import open_table

pytestmark = pytest.mark.benchmark_suite

_MEASURED = """
import json, resource, sys
from gearcad.cli import main
try:
    main(sys.argv[1:])
finally:
    print(json.dumps({"peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)}))
"""

MOST_GROWTH = 10_000_000
"""Bytes that the parent may grow from 200 to 5,000 rows: nothing in it grows with the table but a little of the database."""


def run(table: Path, folder: Path, *options: str) -> tuple[float, int]:
    """Seconds of `gearcad batch` from start to end, and the peak memory (bytes) of the parent, its workers not counted."""
    command = [sys.executable, "-c", _MEASURED, "batch", str(table), "-o", str(folder), "--quiet", *options]
    began = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True, check=True)
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


def test_data_of_many_rows_and_memory_of_the_parent(benchmark: Any, tmp_path: Path) -> None:
    benchmark.group = "batch: 5,000 pairs, data only"
    lines = variants(5000)
    few = write_table(tmp_path / "few.csv", lines[:201])
    many = write_table(tmp_path / "many.csv", lines)
    _, small = run(few, tmp_path / "few", "--do", "data")
    seconds, large = benchmark.pedantic(lambda: run(many, tmp_path / "many", "--do", "data"), rounds=1)
    again, _ = run(many, tmp_path / "many", "--do", "data")
    tell(benchmark, seconds=seconds, seconds_again=again, MB_200=small / 1e6, MB_5000=large / 1e6)
    assert large - small < MOST_GROWTH


@pytest.mark.parametrize("step", Step)
def test_time_outside_the_solid_kernel(benchmark: Any, step: Step, tmp_path: Path) -> None:
    """Share of the CPU time of a worker by whose code runs: the kernel with CadQuery, gearcad, all else; by the profiler."""
    benchmark.group = f"batch: whose time, {step.value}"
    rows = list(open_table(write_table(tmp_path / "table.csv", variants(21))).rows())
    workspace = tmp_path / "out" / ".work"
    workspace.mkdir(parents=True)
    tasks = [Task(row, Wanted(steps=(step,)), tmp_path / "out", workspace, False) for row in rows]
    assert make_row(tasks[0]).error == ""  # imports are done
    profile = cProfile.Profile(time.process_time)

    def make_all() -> None:
        profile.enable()
        for task in tasks[1:]:
            make_row(task)
        profile.disable()

    benchmark.pedantic(make_all, rounds=1)
    tell(benchmark, **shares(pstats.Stats(profile)))


def shares(stats: pstats.Stats) -> dict[str, float]:
    """Percent of the time inside functions, by whose they are."""
    spent = {"kernel": 0.0, "gearcad": 0.0, "batch": 0.0, "numpy": 0.0, "others": 0.0}
    for (file, _, function), (_, _, own, _, _) in stats.stats.items():  # type: ignore[attr-defined]
        spent[_owner(file.replace(os.sep, "/"), function)] += own
    total = sum(spent.values())
    return {f"percent_{owner}": 100 * own / total for owner, own in spent.items()}


def _owner(file: str, function: str) -> str:
    if "OCP" in function or "/cadquery/" in file:
        return "kernel"
    if "/gearcad/batch/" in file:
        return "batch"
    if "/gearcad/" in file:
        return "gearcad"
    return "numpy" if "numpy" in file or "numpy" in function else "others"
