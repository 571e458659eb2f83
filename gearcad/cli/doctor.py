"""Command `doctor`: what is installed, and what is missing for which command."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version

import click

from gearcad.cli.group import debug_option
from gearcad.cli.job import aligned_columns
from gearcad.cli.language import say
from gearcad.core.output import json_text
from gearcad.core.runtime import about_memory, cores, installed, machine_memory
from gearcad.jobs.job import with_summary
from gearcad.version import __version__

_LIGHT = {
    "click": ("click", "every command"),
    "ezdxf": ("ezdxf", "DXF files"),
    "fonttools": ("fontTools", "drawings"),
    "lazy_loader": ("lazy_loader", "every command"),
    "numpy": ("numpy", "every command"),
    "pillow": ("PIL", "pictures, PDF of drawings"),
    "platformdirs": ("platformdirs", "tools and bearings of the user"),
    "reportlab": ("reportlab", "PDF"),
    "rich": ("rich", "data sheets and progress on a terminal"),
    "threadpoolctl": ("threadpoolctl", "rate, planetary, check, dynamics"),
    "tomlkit": ("tomlkit", "specs that are written"),
}
"""Packages of the light installation: the module of each, and what needs it."""

_FULL = {
    "cadquery": ("cadquery", "solids as objects of Python, verify"),
    "filelock": ("filelock", "batch"),
    "gmsh": ("gmsh", "plane checks, meshes of triangles and tetrahedra"),
    "jinja2": ("jinja2", "reports"),
    "matplotlib": ("matplotlib", "reports, charts"),
    "meshio": ("meshio", "mesh files"),
    "numba": ("numba", "check, dynamics"),
    "scikit-fem": ("skfem", "check, stiffness by finite elements"),
    "scipy": ("scipy", "check, stiffness, dynamics, study"),
    "trimesh": ("trimesh", "verify"),
    "vtk": ("vtkmodules", "pictures of solids"),
}
"""Packages that the full installation has beside those."""

_EXTRAS = {
    "distributed": ("distributed", "batch --cluster", "cluster"),
    "h5py": ("h5py", "meshes as .xdmf", "mesh"),
    "nicegui": ("nicegui", "open", "page"),
    "openpyxl": ("openpyxl", "tables as .xlsx", "xlsx"),
    "pyarrow": ("pyarrow", "tables as .parquet", "parquet"),
}
"""Packages of the extras: module, what needs it, and the extra."""

_PROGRAMS = {
    "ccx": (("ccx",), "verify --level full"),
    "Chromium": (("chromium", "chromium-browser", "google-chrome"), "tests of the page"),
}
"""Programs, by the names of their files, and what needs them."""

_BINARY = ("gmsh", "OCP", "vtkmodules.vtkRenderingOpenGL2")
"""Modules that load libraries of the system."""


@dataclass(frozen=True)
class _Found:
    """A package or a program: its version or place, "" where it is missing, what needs it, and how to install it."""

    name: str
    kind: str
    there: str
    needed_by: str
    install: str


def _packages() -> Iterator[_Found]:
    for kind, packages in (("light", _LIGHT), ("full", _FULL)):
        for name, (module, needed_by) in packages.items():
            yield _Found(name, kind, _version(name, module), needed_by, f"pip install {name}")
    for name, (module, needed_by, extra) in _EXTRAS.items():
        yield _Found(name, "extra", _version(name, module), needed_by, f'pip install "gearcad[{extra}]"')


def _version(name: str, module: str) -> str:
    """Return the version of a package that can be imported, "" without one; of a package that has none, a word for it."""
    if not installed(module):
        return ""
    try:
        return version(name)
    except PackageNotFoundError:
        return "installed"


def _programs() -> Iterator[_Found]:
    for name, (files, needed_by) in _PROGRAMS.items():
        places = (shutil.which(file) for file in files)
        yield _Found(name, "program", next(filter(None, places), ""), needed_by, "the package of your system")


def _faults() -> Iterator[str]:
    """Yield a line for each installed module that a missing library of the system keeps from being loaded."""
    for module in _BINARY:
        if installed(module.partition(".")[0]):
            tried = subprocess.run(
                [sys.executable, "-c", f"import {module}"], capture_output=True, encoding="utf-8", errors="replace", check=False
            )
            if tried.returncode:
                why = (tried.stderr.strip().splitlines() or ["no reason given"])[-1]
                yield f"{module.partition('.')[0]} is installed but cannot be loaded: {why}"


@click.command(short_help="What is installed, and what is missing for which command.")
@click.option("--json", "as_json", is_flag=True, help="Print a document and nothing else.")
@debug_option
def doctor(as_json: bool) -> None:
    """List the packages and programs that gearcad uses with their versions, and those that are missing with what needs them.

    The status is 1 where an installed package cannot be loaded, or a package of the light installation is missing.

    gearcad doctor
    """
    found, faults = [*_packages(), *_programs()], list(_faults())
    memory = machine_memory()
    head = {
        "kind": "doctor",
        "gearcad": __version__,
        "python": platform.python_version(),
        "system": platform.platform(),
        "cores": cores(),
        "memory": memory if memory < float("inf") else None,
    }
    missing = [each.name for each in found if not each.there]
    if as_json:
        document = head | {"parts": [asdict(each) for each in found], "missing": missing}
        click.echo(json_text(with_summary(document, faults)), nl=False)
    else:
        say("\n".join(_lines(found, memory)))
        for fault in faults:
            say(f"Warning: {fault}", fg="yellow", color=False if os.environ.get("NO_COLOR") else None)
    if faults or any(not each.there and each.kind == "light" for each in found):
        click.get_current_context().exit(1)


def _lines(found: list[_Found], memory: float) -> Iterator[str]:
    size = f", {about_memory(memory)} of memory" if memory < float("inf") else ""
    yield f"gearcad {__version__}, Python {platform.python_version()}, {platform.platform()}, {cores()} cores{size}"
    yield ""
    rows = [("part", "of", "version or place", "needed by")]
    rows += [(each.name, each.kind, each.there or f"missing: {each.install}", each.needed_by) for each in found]
    yield from aligned_columns(rows, left=(0, 1, 2, 3))
    lacking = [each for each in found if not each.there and each.kind == "full"]
    if lacking:
        yield ""
        light = "This is a light installation: data, build, draw, rate, planetary and identify run"
        yield f"{light}; `pip install gearcad` adds the rest."
