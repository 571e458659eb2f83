"""`import gearcad` must stay light: names are imported when first used, heavy libraries inside the functions that need them."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

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
    with pytest.raises(AttributeError, match=r"gearcad.* attribute '?Gaer"):
        gearcad.Gaer  # noqa: B018


def test_type_checkers_are_told_the_same_names() -> None:
    stub = ast.parse(Path(gearcad.__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    names = {each.asname for node in stub.body if isinstance(node, ast.ImportFrom) for each in node.names} - {None}
    names |= {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    rooms = {name for name in names if isinstance(getattr(gearcad, name), ModuleType)}
    assert names - rooms | {"check", "dynamics", "identify", "planetary", "stiffness"} == set(gearcad.__all__)
    assert set(dir(gearcad)) - set(gearcad.__all__) <= names | {name for name in dir(gearcad) if name.startswith("__")}


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
