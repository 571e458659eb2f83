"""Timings of meshes: `pytest -m benchmark_suite tests/benchmarks/test_mesh_file_speed.py`

Files of a million hexahedra of second order (4.1 million nodes), against those of meshio; a helical gear of as many, against
gmsh. Each way runs in a process of its own, in one thread, and tells its peak memory beside what its imports or its mesh take.
gmsh fills the same section with quadrangles of its own, twists it up in layers and adds the nodes between vertices; it knows no
modified flanks and puts no node on an exact one.
"""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from gearcad.meshing.options import MeshFormat

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

SUFFIXES = [kind.value for kind in MeshFormat]
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


_SHARED = """
import json, math, re, sys, time
from pathlib import Path
import numpy as np
import scipy.sparse.linalg, skfem
from gearcad import Body, FlankModification, Gear

relief = FlankModification(tip_relief=20, tip_relief_length=3, lead_crowning=8, end_relief=10, end_relief_length=2)
gear = Gear(teeth=44, normal_module=2.5, face_width=15.1, helix_angle=-28, profile_shift=-0.378, body=Body(bore=45))
elements, folder = int(sys.argv[1]), Path(sys.argv[2])

def peak():
    return int(re.search(r"VmHWM:\\s*([0-9]+) kB", Path("/proc/self/status").read_text())[1]) * 1024 / 1e9
"""

_OURS = """
from dataclasses import replace
from gearcad.meshing import Element
from gearcad.meshing.bodies.body_mesh import mesh_body
from gearcad.meshing.bodies.quality import quality
from gearcad.meshing.bodies.body_mesh import body_sizes, expected_amount, factor_for
from gearcad.meshing.options import write

gear = replace(gear, modification=relief)
what = dict(teeth=None, held_radius=gear.body.bore / 2, element=Element.HEX20)
usual = body_sizes(gear)
factor = factor_for(elements, lambda factor: expected_amount(gear, **what, sizes=usual.scaled(factor)).elements, 3)
imports = peak()
start = time.perf_counter()
mesh = mesh_body(gear, **what, sizes=usual.scaled(factor), planes=None)
meshed = time.perf_counter()
memory = peak() - imports
least = quality(mesh).least_jacobian
judged = time.perf_counter()
for name in ("gear.vtu", "gear.inp"):
    write(mesh, folder / name)
written = time.perf_counter()
print(json.dumps({
    "elements": len(mesh.cells), "meshing": meshed - start, "quality": judged - meshed, "vtu and inp": written - judged,
    "per second": len(mesh.cells) / (meshed - start), "GB of mesh": mesh.nbytes / 1e9, "GB more": memory, "GB in all": peak(),
    "least scaled Jacobian": least,
}))
"""

_THEIRS = """
import gmsh

sections, layers = 10_000, max(2, round(elements / 10_000))
area = math.pi * (gear.tip_diameter**2 - gear.body.bore**2) / 4
edge = math.sqrt(area / sections)
imports = peak()
start = time.perf_counter()
gmsh.initialize(interruptible=False)
gmsh.option.set_number("General.Terminal", 0)
gmsh.option.set_number("General.NumThreads", 1)
gmsh.option.set_number("Mesh.RecombineAll", 1)
gmsh.option.set_number("Mesh.Algorithm", 8)
gmsh.option.set_number("Mesh.SecondOrderIncomplete", 1)
gmsh.option.set_number("Mesh.MeshSizeMax", edge)
geo = gmsh.model.geo
outline = [geo.add_point(x, y, 0, edge) for x, y in gear.profile.contour(0.02)]
lines = [geo.add_line(a, b) for a, b in zip(outline, outline[1:] + outline[:1])]
middle, radius = geo.add_point(0, 0, 0), gear.body.bore / 2
around = [geo.add_point(radius * math.cos(k * math.pi / 2), radius * math.sin(k * math.pi / 2), 0, edge) for k in range(4)]
arcs = [geo.add_circle_arc(around[k], middle, around[(k + 1) % 4]) for k in range(4)]
face = geo.add_plane_surface([geo.add_curve_loop(lines), geo.add_curve_loop(arcs)])
turn = gear.face_width * math.tan(math.radians(gear.helix_angle)) / (gear.reference_diameter / 2)
geo.twist([(2, face)], 0, 0, 0, 0, 0, gear.face_width, 0, 0, 1, turn, [layers], [], True)
geo.synchronize()
gmsh.model.mesh.generate(3)
gmsh.model.mesh.set_order(2)
kinds, numbers, _ = gmsh.model.mesh.get_elements(3)
seconds = time.perf_counter() - start
made = sum(map(len, numbers))
print(json.dumps({"elements": made, "meshing": seconds, "per second": made / seconds, "GB more": peak() - imports}))
"""

MILLION = 1_000_000

BODY_MOST_SECONDS, BODY_MOST_GIGABYTES = 60.0, 3.0
"""For meshing and both files."""


def run(code: str, elements: int, folder: Path) -> dict[str, float]:
    """What a process of its own tells."""
    command = [sys.executable, "-c", _SHARED + code, str(elements), str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"OMP_NUM_THREADS": "1"})
    assert done.returncode == 0, done.stderr
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return found


def test_a_million_hexahedra(record_property: Any, tmp_path: Path) -> None:
    ours = run(_OURS, MILLION, tmp_path)
    theirs = run(_THEIRS, MILLION // 30, tmp_path)
    for who, figures in (("gearcad", ours), ("gmsh, fewer elements", theirs)):
        record_property(who, figures)
        print(who, "  ".join(f"{name} {value:.4g}" for name, value in figures.items()))
    assert ours["elements"] == pytest.approx(MILLION, rel=0.1)
    assert ours["meshing"] + ours["quality"] + ours["vtu and inp"] < BODY_MOST_SECONDS
    assert ours["GB in all"] < BODY_MOST_GIGABYTES
    assert ours["GB more"] < 2 * ours["GB of mesh"]
