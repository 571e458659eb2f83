"""`import gearcad` must stay light: heavy libraries are imported inside the functions that need them."""

from __future__ import annotations

import subprocess
import sys

HEAVY = (
    *("scipy", "cadquery", "OCP", "gmsh", "matplotlib", "vtk", "vtkmodules"),
    *("trimesh", "ezdxf", "rich", "skfem", "meshio", "numba"),
)


def test_import_pulls_in_no_heavy_library() -> None:
    code = f"import sys, gearcad; print(*[name for name in {HEAVY!r} if name in sys.modules], 'numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True"]
    assert done.stderr == ""
