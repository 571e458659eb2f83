"""Commands from start to end, beside the import of CadQuery, which none of them needs. To see the shares, call

    pytest -m benchmark_suite tests/benchmarks/test_cold_start.py -s

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
    "data spur.toml": 0.15,
    "data volvo-13-44.toml": 0.15,
    "build spur.toml": 0.18,
    "build volvo-13-44.toml": 0.26,
    "build ring-22-70.toml": 0.26,
    "build planetary-24-21-66.toml": 0.32,
}
"""Share of what `import cadquery` takes: half as much again as was measured on a busy machine."""


def _median(*command: str) -> float:
    found = [run([sys.executable, *command], ROOT, ROOT / "templates", 60.0, of_output=False) for _ in range(_RUNS + 1)][1:]
    return statistics.median(each.seconds for each in found if isinstance(each, Run))


@pytest.fixture(scope="module")
def library() -> float:
    """What the import takes (s)."""
    return _median("-c", "import cadquery")


@pytest.mark.parametrize("command", MOST)
def test_a_command_takes_less_than_a_cad_kernel_does(command: str, library: float) -> None:
    seconds = _median("-m", "gearcad", *command.split())
    print(f"gearcad {command}: {seconds:.2f} s, {seconds / library:.3f} of import cadquery ({library:.2f} s)")
    assert seconds < MOST[command] * library
