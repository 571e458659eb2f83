"""Timings of files of a million hexahedra of second order (4.1 million nodes), against those that meshio writes of the same.

`pytest -m benchmark_suite tests/benchmarks/test_mesh_file_speed.py --benchmark-columns=median -s`

Each file is written by a process of its own. Its peak of memory is told beside that of the mesh alone; machines are noisy.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.benchmark_suite

_MEASURED = """
import json, re, sys, time
from pathlib import Path
import numpy as np
from gearcad.meshing import Element, ElementMesh, Faces
from gearcad.meshing.options import write

def block(n):
    shape, every = Element.HEX20.shape, 2 * n + 1
    grid = np.stack(np.meshgrid(*[np.arange(every, dtype=np.int16)] * 3, indexing="ij"), -1)
    used = (grid % 2).sum(-1) <= 1
    number = np.full(used.shape, -1, np.int32)
    number[used] = np.arange(used.sum())
    x, y, z = grid[used].T / 100
    points = np.stack([(5 + x) * np.cos(y + z / 8), (5 + x) * np.sin(y + z / 8), z], 1)
    corners = 2 * np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    local = np.concatenate([corners, corners[np.array(shape.edges)].mean(axis=1).astype(int)])
    start = 2 * np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), -1).reshape(-1, 3)
    cells = np.stack([number[tuple((start + place).T)] for place in local], 1)
    elements = np.arange(n**3, dtype=np.int32).reshape(n, n, n)
    sides = {}
    for tooth in range(n):
        flank = elements[-1, tooth]
        sides[f"left_flank_{tooth}"] = Faces(flank, np.full(n, 3, np.int8))
    sides["bore"] = Faces(elements[0].ravel(), np.full(n * n, 5, np.int8))
    return ElementMesh(Element.HEX20, points, cells, {"gear": slice(0, n**3)}, sides)

def peak():
    return int(re.search(r"VmHWM:\\s*([0-9]+) kB", Path("/proc/self/status").read_text())[1]) * 1024

who, n, *paths = sys.argv[1:]
mesh = block(int(n))
Path("/proc/self/clear_refs").write_text("5")  # the peak from here on
before = peak()
if who == "meshio":
    theirs = mesh.to_meshio()
    theirs.cells, theirs.cell_sets = theirs.cells[:1], {}  # it does not write faces beside elements
kinds = {"inp": "abaqus", "msh": "gmsh"}
began = time.perf_counter()
for path in map(Path, paths):
    if who == "meshio":
        kind = path.suffix[1:]
        theirs.write(path, file_format=kinds.get(kind, kind))
    else:
        write(mesh, path)
seconds = time.perf_counter() - began
print(json.dumps({"seconds": seconds, "GB": peak() / 1e9, "GB_of_mesh": mesh.nbytes / 1e9, "GB_before": before / 1e9}))
"""

SUFFIXES = ("vtu", "inp", "msh", "bdf", "med", "unv", "xdmf")
THEIRS = ("vtu", "inp", "msh", "med", "xdmf")
"""What meshio writes too; its .bdf does not take these numbers."""

MOST_SECONDS, MOST_GIGABYTES = 45.0, 3.0
"""For .vtu and .inp together."""


def written(who: str, folder: Path, *suffixes: str, edges: int = 100) -> dict[str, float]:
    """Seconds, peak memory and size (MB) of files of a cube with so many hexahedra along each edge."""
    paths = [folder / f"mesh.{suffix}" for suffix in suffixes]
    command = [sys.executable, "-c", _MEASURED, who, str(edges), *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=os.environ | {"OMP_NUM_THREADS": "1"})
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return found | {"MB": sum(path.stat().st_size for path in folder.iterdir()) / 1e6}


def tell(benchmark: Any, **figures: float) -> None:
    benchmark.extra_info.update(figures)
    print("  ".join(f"{name} {value:.4g}" for name, value in figures.items()))


def test_vtu_and_inp_together(benchmark: Any, tmp_path: Path) -> None:
    benchmark.group = "files of 1e6 hex20"
    figures = benchmark.pedantic(written, ("gearcad", tmp_path, "vtu", "inp"), rounds=1)
    tell(benchmark, **figures)
    assert figures["seconds"] < MOST_SECONDS
    assert figures["GB"] < MOST_GIGABYTES


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_file_against_meshio(benchmark: Any, suffix: str, tmp_path: Path) -> None:
    if suffix in ("xdmf", "med"):
        pytest.importorskip("h5py")
    benchmark.group = "files of 1e6 hex20"
    (tmp_path / "theirs").mkdir()
    (tmp_path / "ours").mkdir()
    theirs = written("meshio", tmp_path / "theirs", suffix) if suffix in THEIRS else {}
    ours = benchmark.pedantic(written, ("gearcad", tmp_path / "ours", suffix), rounds=1)
    tell(benchmark, **ours, **{f"{name}_of_meshio": value for name, value in theirs.items()})
