"""`import gearcad` must stay light: names are imported when first used, heavy libraries inside the functions that need them."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import gearcad

HEAVY = (
    *("scipy", "cadquery", "OCP", "gmsh", "matplotlib", "vtk", "vtkmodules"),
    *("trimesh", "ezdxf", "rich", "skfem", "meshio", "numba"),
)


def test_import_pulls_in_no_heavy_library() -> None:
    code = "import sys, gearcad; print('numpy' in sys.modules, gearcad.Gear.__name__, gearcad.geometry.__name__); "
    code += f"print(*[name for name in {HEAVY!r} if name in sys.modules], 'numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "Gear", "gearcad.geometry", "True"]
    assert done.stderr == ""


def test_every_name_is_there_and_no_other() -> None:
    assert [name for name in gearcad.__all__ if getattr(gearcad, name, None) is None] == []
    assert set(gearcad.__all__) <= set(dir(gearcad))
    with pytest.raises(AttributeError, match=r"module 'gearcad' has no attribute 'Gaer'"):
        gearcad.Gaer  # noqa: B018


MUTABLE = {"Run", "_Keeper", "_Trial", "Elimination", "_Rings"}
"""A run of the page, and states of loops inside one function."""


def test_dataclasses_are_frozen() -> None:
    """Inputs and results are values: nothing changes one that another has been handed."""
    found = set()
    for path in Path(gearcad.__file__).parent.rglob("*.py"):
        found |= set(
            re.findall(r"@dataclass(?![^\n]*frozen=True)[^\n]*\n(?:@[^\n]*\n)*class (\w+)", path.read_text(encoding="utf-8"))
        )
    assert found == MUTABLE
