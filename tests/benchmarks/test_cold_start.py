"""Commands from start to end, beside the import of NumPy: `pytest -m benchmark_suite tests/benchmarks/test_cold_start.py -s`

CPU seconds, user and system, medians of five in turn. `beside.py` compares those of two checkouts.
"""

from __future__ import annotations

import statistics
import sys
from pathlib import Path

import pytest
from beside import Run, run

pytestmark = pytest.mark.benchmark_suite

ROOT = Path(__file__).parents[2]

_RUNS = 5

MOST = {
    "data spur.toml": 3.5,
    "data volvo-13-44.toml": 4.0,
    "build spur.toml": 6.0,
    "build volvo-13-44.toml": 12.0,
    "build ring-22-70.toml": 9.0,
    "build planetary-24-21-66.toml": 12.0,
}
"""Times what `import numpy` takes: half as much again as was measured on a busy machine."""


def _median(*command: str) -> float:
    found = [run([sys.executable, *command], ROOT, ROOT / "templates", 60.0, of_output=False) for _ in range(_RUNS + 1)][1:]
    return statistics.median(each.seconds for each in found if isinstance(each, Run))


@pytest.mark.parametrize("command", MOST)
def test_a_command_takes_a_few_times_what_numpy_does(command: str) -> None:
    library = _median("-c", "import numpy")
    seconds = _median("-m", "gearcad", *command.split())
    print(f"gearcad {command}: {seconds:.2f} s, {seconds / library:.1f} times import numpy ({library:.2f} s)")
    assert seconds < MOST[command] * library
