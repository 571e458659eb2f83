"""Machine code that is kept on disk: what an older version has left does no harm."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from io import BytesIO
from pathlib import Path

KERNEL = "from gearcad.core.runtime import compiled\n\n@compiled\ndef f(x):\n    return x + 1.0\n"


def result(folder: Path) -> str:
    paths = os.environ | {"PYTHONPATH": os.pathsep.join([str(folder), *sys.path]), "NUMBA_CACHE_DIR": str(folder / "kept")}
    command = [sys.executable, "-c", "import kernel; print(kernel.f(2.0))"]
    return subprocess.run(command, cwd=folder, env=paths, capture_output=True, text=True, check=True).stdout


def test_a_cache_that_names_a_class_that_is_gone_is_made_anew(tmp_path: Path) -> None:
    (tmp_path / "kernel.py").write_text(KERNEL)
    assert result(tmp_path) == "3.0\n"
    (index,) = tmp_path.rglob("kept/**/*.nbi")
    version = pickle.load(BytesIO(index.read_bytes()))
    index.write_bytes(pickle.dumps(version) + b"cgearcad.core.runtime\nClassOfBefore\n.")
    assert result(tmp_path) == "3.0\n"
    assert b"ClassOfBefore" not in index.read_bytes()
