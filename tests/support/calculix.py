"""CalculiX (Debian: calculix-ccx), where it is installed."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

_CCX = shutil.which("ccx")

needs_ccx = pytest.mark.skipif(_CCX is None, reason="needs CalculiX (ccx)")


def run_ccx(folder: Path, job: str, timeout: float = 900) -> str:
    """Run the deck JOB.inp in a folder, by one thread; what CalculiX said, in which there must be no error."""
    assert _CCX is not None
    threads = {**os.environ, "OMP_NUM_THREADS": "1"}
    run = subprocess.run([_CCX, job], cwd=folder, capture_output=True, text=True, timeout=timeout, env=threads)
    assert "ERROR" not in run.stdout
    assert run.returncode == 0
    return run.stdout
